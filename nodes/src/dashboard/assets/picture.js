// The machine from its side, and the piston in its stroke.

const picture = (function () {
  // undefined: nobody has asked for a description yet; null: there is none that can be drawn.
  let robot, angles = new Map(), assumed = new Set(), parts = [], size = 1;

  /** Takes a description; without a good one there is no picture. */
  function load(description) {
    robot = readRobot(description);
    angles = new Map(); assumed = new Set(); parts = [];
    byId("machine").classList.toggle("without", robot === null);
    byId("picture").replaceChildren();
    if (!robot) return;
    robot.joints.forEach(function (joint) { angles.set(joint.name, (joint.lower + joint.upper) / 2); assumed.add(joint.name); });
    frameView();
    const order = [robot.root].concat(robot.joints.map(function (joint) { return joint.child; }));
    order.forEach(addLink);
    robot.joints.filter(function (joint) { return joint.moves && !joint.isSwing; }).forEach(addJoint);
  }

  function frameView() {
    const reach = reachOf(robot), wide = reach[2] - reach[0], high = reach[3] - reach[1];
    size = Math.max(wide, high, 0.1);
    const margin = 0.04 * size, view = byId("picture"), floor = reach[1] - margin;
    view.setAttribute("viewBox", [reach[0] - margin, -reach[3] - margin, wide + 2 * margin, high + 3.2 * margin].join(" "));
    view.appendChild(shape("line", { "class": "ground", x1: reach[0] - margin, x2: reach[2] + margin, y1: 0, y2: 0 }));
    addScale(reach[2], floor);
  }

  /** A bar of a round length: the picture has no other scale. */
  function addScale(right, floor) {
    const view = byId("picture"), long = roundUp(size / 8), y = -floor + 0.03 * size;
    view.appendChild(shape("path", { "class": "scale", d: "M" + (right - long) + " " + (y - 0.012 * size) + "v" + 0.024 * size + "m0 " + -0.012 * size + "h" + long + "m0 " + -0.012 * size + "v" + 0.024 * size }));
    view.appendChild(shape("text", { x: right - long - 0.02 * size, y: y + 0.015 * size, "font-size": 0.045 * size, "text-anchor": "end" }, long + " m"));
  }

  function addLink(name) {
    const joint = robot.joints.find(function (other) { return other.child === name; });
    robot.links.get(name).forEach(function (corners) {
      const node = shape("polygon", { "class": "link" });
      byId("picture").appendChild(node);
      parts.push({ node: node, link: name, joint: joint, draw: function (pose) {
        const points = outline(corners.map(function (corner) { const at = place(pose, corner); return [at[0], -at[2]]; }));
        node.setAttribute("points", points.map(function (p) { return p[0].toFixed(4) + "," + p[1].toFixed(4); }).join(" "));
      } });
    });
  }

  function addJoint(joint) {
    const dot = shape("circle", { "class": "joint", r: 0.016 * size });
    byId("picture").appendChild(dot);
    parts.push({ node: dot, link: joint.child, joint: joint, draw: function (pose) { reshape(dot, { cx: pose.shift[0], cy: -pose.shift[2] }); } });
  }

  function draw(frame, chosen) {
    drawStroke(frame.cylinders[chosen] || {}, store.scale(chosen));
    if (!robot) return;
    Object.keys(frame.cylinders).forEach(function (name) {
      const angle = frame.cylinders[name].joint_angle, joint = name + "_joint";
      if (angle !== null && angle !== undefined) { angles.set(joint, angle); assumed.delete(joint); } else if (angles.has(joint)) assumed.add(joint);
    });
    const poses = placeLinks(robot, angles);
    parts.forEach(function (part) {
      part.draw(poses.get(part.link));
      const isHeld = !part.joint || !part.joint.moves, name = part.joint && part.joint.name;
      part.node.classList.toggle("base", isHeld);
      part.node.classList.toggle("chosen", name === chosen + "_joint");
      part.node.classList.toggle("assumed", assumed.has(name) && !isHeld);
    });
  }

  /** The joint of the chosen cylinder in words. */
  function note(chosen) {
    const joint = robot && robot.joints.find(function (other) { return other.name === chosen + "_joint"; });
    if (robot === undefined) return "";
    if (!robot) return "No robot description was received: the machine is not drawn.";
    if (!joint) return "The robot description has no joint " + chosen + "_joint.";
    const isAngle = joint.type !== "prismatic", factor = isAngle ? 180 / Math.PI : 1e3, unit = isAngle ? "°" : " mm";
    if (assumed.has(joint.name)) return "Joint " + chosen + " is not measured. The dashed link is drawn at an assumed angle.";
    if (joint.isSwing) return "Joint " + chosen + ": " + fixed(times(angles.get(joint.name), factor), 1) + unit + ", not drawn in the side view";
    const limits = joint.type === "continuous" ? "" : " (range " + fixed(joint.lower * factor, 0) + unit + " to " + fixed(joint.upper * factor, 0) + unit + ")";
    return "Joint " + chosen + ": " + fixed(times(angles.get(joint.name), factor), 1) + unit + limits;
  }

  const LEFT = 12, LONG = 252, HALF = 6;
  let stroke = null, farthest = 0.01, strokeOf = "";

  function buildStroke() {
    stroke = {
      cap: shape("rect", { "class": "cap", x: LEFT, y: 14, height: 36 }), rodSide: shape("rect", { "class": "rod-side", y: 14, height: 36 }),
      rod: shape("rect", { "class": "rod", y: 27, height: 10, width: LONG + 10 }),
      barrel: shape("rect", { "class": "barrel", x: LEFT, y: 14, width: LONG, height: 36 }),
      piston: shape("rect", { "class": "piston", y: 14, width: 2 * HALF, height: 36 }),
      middle: shape("line", { "class": "scale", x1: LEFT + LONG / 2, x2: LEFT + LONG / 2, y1: 50, y2: 58 }),
      low: shape("text", { x: LEFT, y: 74 }), zero: shape("text", { x: LEFT + LONG / 2, y: 74, "text-anchor": "middle" }, "0"),
      high: shape("text", { x: LEFT + LONG, y: 74, "text-anchor": "middle" })
    };
    byId("stroke").append.apply(byId("stroke"), Object.keys(stroke).map(function (name) { return stroke[name]; }));
  }

  /** The cylinder drawn as one, its piston where it is between its ends. */
  function drawStroke(cylinder, scale) {
    if (!stroke) buildStroke();
    const at = cylinder.displacement, isMotor = unitsOf(scale).isMotor;
    byId("stroke").classList.toggle("hidden", at === null || at === undefined || isMotor);
    if (at === null || at === undefined || isMotor) return;
    const known = scale && scale.ends && scale.ends[0] !== null;
    farthest = Math.max(farthest, Math.abs(at));
    const ends = known ? scale.ends : [-roundUp(farthest), roundUp(farthest)];
    const share = Math.min(Math.max((at - ends[0]) / (ends[1] - ends[0]), 0), 1);
    const x = LEFT + HALF + share * (LONG - 2 * HALF), zero = LEFT + HALF + (LONG - 2 * HALF) * -ends[0] / (ends[1] - ends[0]);
    stroke.cap.setAttribute("width", x - LEFT);
    reshape(stroke.rodSide, { x: x, width: LEFT + LONG - x });
    stroke.piston.setAttribute("x", x - HALF);
    stroke.rod.setAttribute("x", x);
    reshape(stroke.middle, { x1: zero, x2: zero });
    say(stroke.low, fixed(ends[0] * 1e3, 0) + " mm"); say(stroke.high, "+" + fixed(ends[1] * 1e3, 0) + " mm");
    say(byId("stroke-note"), known ? "" : "The stroke is not known. The scale covers the largest displacement seen.");
  }

  function choose(name) {
    if (name !== strokeOf) { strokeOf = name; farthest = 0.01; say(byId("stroke-note"), ""); }
  }

  return { load: load, draw: draw, note: note, choose: choose, name: function () { return robot ? robot.name : ""; } };
})();
