// The robot description (URDF): links as outlines in the plane of the arm, seen from its side. x is forwards, z is up.

const MOST_LINKS = 64, MOST_BOXES = 8, FARTHEST = 1000;

function childrenOf(node, tag) {
  return Array.from(node.children).filter(function (child) { return child.tagName === tag; });
}

function numbers(node, name, otherwise) {
  const words = node && node.getAttribute(name);
  if (!words) return otherwise;
  const values = words.trim().split(/\s+/).map(Number);
  const good = values.length === otherwise.length
    && values.every(function (value) { return isFinite(value) && Math.abs(value) < FARTHEST; });
  return good ? values : otherwise;
}

/** Rotation (rows) and shift of an `origin`. */
function poseOf(node) {
  const origin = node && childrenOf(node, "origin")[0];
  return { turn: turnOf(numbers(origin, "rpy", [0, 0, 0])), shift: numbers(origin, "xyz", [0, 0, 0]) };
}

function turnOf(rpy) {
  return product(product(turnAbout([0, 0, 1], rpy[2]), turnAbout([0, 1, 0], rpy[1])), turnAbout([1, 0, 0], rpy[0]));
}

function turnAbout(axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle), x = axis[0], y = axis[1], z = axis[2], r = 1 - c;
  return [
    [c + x * x * r, x * y * r - z * s, x * z * r + y * s],
    [y * x * r + z * s, c + y * y * r, y * z * r - x * s],
    [z * x * r - y * s, z * y * r + x * s, c + z * z * r]
  ];
}

function product(a, b) {
  return a.map(function (row) { return [0, 1, 2].map(function (j) { return row[0] * b[0][j] + row[1] * b[1][j] + row[2] * b[2][j]; }); });
}

function place(pose, point) {
  return pose.turn.map(function (row, i) { return row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + pose.shift[i]; });
}

function compose(outer, inner) { return { turn: product(outer.turn, inner.turn), shift: place(outer, inner.shift) }; }

/** Corners of the boxes around what a link shows. */
function boxesOf(link) {
  return childrenOf(link, "visual").slice(0, MOST_BOXES).map(function (visual) {
    const geometry = childrenOf(visual, "geometry")[0], solid = geometry && geometry.children[0];
    const size = solid ? sizeOf(solid) : null;
    if (!size) return null;
    const pose = poseOf(visual), signs = [-0.5, 0.5], corners = [];
    signs.forEach(function (x) { signs.forEach(function (y) { signs.forEach(function (z) {
      corners.push(place(pose, [x * size[0], y * size[1], z * size[2]]));
    }); }); });
    return corners;
  }).filter(Boolean);
}

function sizeOf(solid) {
  const radius = numbers(solid, "radius", [0])[0];
  if (solid.tagName === "box") return numbers(solid, "size", [0, 0, 0]);
  if (solid.tagName === "cylinder") return [2 * radius, 2 * radius, numbers(solid, "length", [0])[0]];
  return solid.tagName === "sphere" ? [2 * radius, 2 * radius, 2 * radius] : null;
}

function jointOf(node) {
  const type = node.getAttribute("type"), axis = numbers(childrenOf(node, "axis")[0], "xyz", [1, 0, 0]);
  const limit = childrenOf(node, "limit")[0], parent = childrenOf(node, "parent")[0], child = childrenOf(node, "child")[0];
  const long = Math.hypot(axis[0], axis[1], axis[2]) || 1;
  return {
    name: node.getAttribute("name") || "", type: type,
    parent: parent && parent.getAttribute("link"), child: child && child.getAttribute("link"), pose: poseOf(node),
    axis: axis.map(function (value) { return value / long; }),
    lower: type === "continuous" ? -Math.PI : numbers(limit, "lower", [0])[0],
    upper: type === "continuous" ? Math.PI : numbers(limit, "upper", [0])[0],
    moves: type === "revolute" || type === "continuous" || type === "prismatic",
    // A swing turns the arm out of the plane that is drawn.
    isSwing: type !== "prismatic" && Math.abs(axis[2]) > 0.9 * long
  };
}

/** The robot in a text, or null where there is none. Joints are in order from the root. */
function readRobot(text) {
  // Entities can make gigabytes of a few lines. No robot description needs them.
  if (!text || /<!(DOCTYPE|ENTITY)/i.test(text)) return null;
  const parsed = new DOMParser().parseFromString(text, "application/xml"), root = parsed.documentElement;
  if (!root || root.tagName !== "robot" || parsed.querySelector("parsererror")) return null;
  const links = new Map();
  childrenOf(root, "link").slice(0, MOST_LINKS).forEach(function (link) { links.set(link.getAttribute("name"), boxesOf(link)); });
  const joints = childrenOf(root, "joint").slice(0, MOST_LINKS).map(jointOf)
    .filter(function (joint) { return links.has(joint.parent) && links.has(joint.child); });
  const first = Array.from(links.keys()).find(function (name) { return !joints.some(function (joint) { return joint.child === name; }); });
  if (first === undefined) return null;
  const robot = { name: root.getAttribute("name") || "", links: links, root: first, joints: inOrder(joints, first) };
  reachToJoints(robot);
  return robot;
}

/** Each link is drawn as far as the joints that it carries: a pin beside a box is connected, a mesh becomes a line. */
function reachToJoints(robot) {
  robot.links.forEach(function (boxes, name) {
    const pins = robot.joints.filter(function (joint) { return joint.parent === name; }).map(function (joint) { return joint.pose.shift; });
    if (!pins.length) return;
    if (boxes.length) boxes[0] = boxes[0].concat(pins); else boxes.push([[0, 0, 0]].concat(pins));
  });
}

/** Each joint after the one that carries it, once: what goes round in circles is left out. */
function inOrder(joints, root) {
  const reached = new Set([root]), ordered = [];
  for (let more = true; more;) {
    more = false;
    joints.forEach(function (joint) {
      if (!reached.has(joint.parent) || reached.has(joint.child)) return;
      reached.add(joint.child);
      ordered.push(joint);
      more = true;
    });
  }
  return ordered;
}

/** Where each link is, by name; `positions` are those of the joints by name. */
function placeLinks(robot, positions) {
  const poses = new Map([[robot.root, { turn: turnOf([0, 0, 0]), shift: [0, 0, 0] }]]);
  robot.joints.forEach(function (joint) {
    const position = joint.moves && !joint.isSwing ? positions.get(joint.name) || 0 : 0;
    const motion = joint.type === "prismatic"
      ? { turn: turnOf([0, 0, 0]), shift: joint.axis.map(function (value) { return value * position; }) }
      : { turn: turnAbout(joint.axis, position), shift: [0, 0, 0] };
    poses.set(joint.child, compose(compose(poses.get(joint.parent), joint.pose), motion));
  });
  return poses;
}

/** Convex outline of points [x, z]. */
function outline(points) {
  const sorted = points.slice().sort(function (a, b) { return a[0] - b[0] || a[1] - b[1]; });
  function half(list) {
    const hull = [];
    list.forEach(function (p) {
      while (hull.length > 1) {
        const a = hull[hull.length - 2], b = hull[hull.length - 1];
        if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
        hull.pop();
      }
      hull.push(p);
    });
    return hull.slice(0, -1);
  }
  return half(sorted).concat(half(sorted.slice().reverse()));
}

/** What all motions of the robot need: [left, bottom, right, top] in m. The picture keeps still while the arm moves. */
function reachOf(robot) {
  const reach = [Infinity, Infinity, -Infinity, -Infinity];
  for (let sample = 1; sample <= 150; sample += 1) {
    const positions = new Map();
    robot.joints.forEach(function (joint, index) {
      positions.set(joint.name, joint.lower + (joint.upper - joint.lower) * spread(sample, index));
    });
    placeLinks(robot, positions).forEach(function (pose, name) {
      [[[0, 0, 0]]].concat(robot.links.get(name)).forEach(function (corners) { corners.forEach(function (corner) {
        const at = place(pose, corner);
        reach[0] = Math.min(reach[0], at[0]); reach[1] = Math.min(reach[1], at[2]);
        reach[2] = Math.max(reach[2], at[0]); reach[3] = Math.max(reach[3], at[2]);
      }); });
    });
  }
  return reach;
}

/** Numbers from 0 to 1 that fill a square evenly (Halton). */
function spread(number, dimension) {
  const base = [2, 3, 5, 7, 11, 13][dimension % 6];
  let share = 1, sum = 0;
  for (let rest = number; rest > 0; rest = Math.floor(rest / base)) { share /= base; sum += share * (rest % base); }
  return sum;
}
