// The machine from its side at the cursor of the plots over time: as measured, and as each model has it.
(function () {
  "use strict";
  const { number, point, onCursor } = timePlots;
  // Asked of the browser: no address stands in a page.
  const SVG = Object.assign(document.createElement("div"), { innerHTML: "<svg></svg>" }).firstChild.namespaceURI;
  // By how much a deviation is drawn larger, so that the largest is a tenth of the machine or less.
  const MAGNIFICATIONS = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
  const LARGEST_DRAWN = 0.1;
  // Pieces of the path of the tip, coloured by the deviation in them.
  const PIECES = 150;
  const MARGIN = 0.06;

  function shape(tag, attributes) {
    const node = document.createElementNS(SVG, tag);
    Object.entries(attributes).forEach(([name, value]) => node.setAttribute(name, value));
    return node;
  }
  function element(tag, name, text) {
    const node = document.createElement(tag);
    if (name) node.className = name;
    if (text) node.textContent = text;
    return node;
  }
  function millimetres(metres) { return `${number(metres * 1e3)} mm`; }

  // Positions of all joints at a sample; those of a model moved away from the measurement by a factor.
  function positionsAt(spec, sample, model, factor) {
    return new Map(spec.joints.map((joint) => {
      const base = joint.reference[sample] ?? 0;
      const own = model === null ? base : joint.models[model][sample] ?? base;
      return [joint.name, base + factor * (own - base)];
    }));
  }
  // The corner of the last link that is farthest from its joint.
  function tipOf(robot) {
    const last = robot.joints[robot.joints.length - 1];
    const corners = last ? robot.links.get(last.child).flat() : [];
    const farthest = corners.reduce((best, corner) => (Math.hypot(...corner) > Math.hypot(...best) ? corner : best), [0, 0, 0]);
    return { link: last?.child, corner: [farthest[0], 0, farthest[2]] };
  }
  function tipAt(robot, tip, positions) {
    const at = place(placeLinks(robot, positions).get(tip.link), tip.corner);
    return [at[0], -at[2]];
  }
  function paths(spec, robot) {
    const tip = tipOf(robot);
    const samples = spec.time.map((_, sample) => sample);
    const measured = samples.map((sample) => tipAt(robot, tip, positionsAt(spec, sample, null, 1)));
    const deviations = spec.models.map((_, model) => samples.map((sample) => {
      const own = tipAt(robot, tip, positionsAt(spec, sample, model, 1));
      return Math.hypot(own[0] - measured[sample][0], own[1] - measured[sample][1]);
    }));
    return { measured, deviations };
  }
  // What is drawn of the machine at one sample: an outline for each box of each link.
  function outlines(robot, positions, links) {
    const poses = placeLinks(robot, positions);
    const drawn = Array.from(robot.links).filter(([name]) => !links || links.has(name));
    return drawn.map(([name, boxes]) => boxes.map((corners) => outline(corners.map((corner) => {
      const at = place(poses.get(name), corner);
      return [at[0], -at[2]];
    })))).flat();
  }
  // Links that a recorded joint moves: only they can deviate.
  function moved(spec, robot) {
    const names = new Set(spec.joints.map((joint) => joint.name));
    const links = new Set();
    robot.joints.forEach((joint) => { if (names.has(joint.name) || links.has(joint.parent)) links.add(joint.child); });
    return links;
  }
  function pointsText(points) { return points.map((p) => `${p[0].toFixed(4)},${p[1].toFixed(4)}`).join(" "); }
  function frameOf(spec, robot) {
    const frame = [Infinity, Infinity, -Infinity, -Infinity];
    for (let sample = 0; sample < spec.time.length; sample += Math.ceil(spec.time.length / 60)) {
      outlines(robot, positionsAt(spec, sample, null, 1)).flat().forEach(([x, y]) => {
        frame[0] = Math.min(frame[0], x); frame[1] = Math.min(frame[1], y);
        frame[2] = Math.max(frame[2], x); frame[3] = Math.max(frame[3], y);
      });
    }
    return frame;
  }
  function magnificationFor(largest, size) {
    const fitting = MAGNIFICATIONS.filter((factor) => factor * largest <= LARGEST_DRAWN * size);
    return largest > 0 && fitting.length ? fitting[fitting.length - 1] : 1;
  }
  function indexAt(times, time) {
    let low = 0, high = times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] <= time) low = middle; else high = middle;
    }
    return time - times[low] < times[high] - time ? low : high;
  }

  function drawPath(view, spec, { measured, deviations }) {
    const first = deviations[0];
    const largest = Math.max(...first);
    const long = Math.max(1, Math.floor(measured.length / PIECES));
    for (let start = 0; start + 1 < measured.length; start += long) {
      const piece = measured.slice(start, start + long + 1);
      const worst = Math.max(...first.slice(start, start + long + 1));
      const line = shape("polyline", { class: "path", points: pointsText(piece) });
      line.style.stroke = spec.models[0].colour;
      line.style.strokeOpacity = largest > 0 ? 0.08 + 0.92 * (worst / largest) : 0.08;
      view.append(line);
    }
  }
  function controls(box, spec, show) {
    const row = element("div", "machine-controls");
    const play = element("button", "play", "Play");
    play.type = "button";
    const slider = element("input");
    Object.assign(slider, { type: "range", min: 0, max: spec.time.length - 1, step: 1 });
    slider.setAttribute("aria-label", "Time along the recording");
    let started = null;
    function step(now) {
      if (started === null) return;
      const time = started.time + (now - started.at) / 1e3;
      const index = indexAt(spec.time, time);
      show(index);
      if (index >= spec.time.length - 1) stop(); else requestAnimationFrame(step);
    }
    function stop() { started = null; play.textContent = "Play"; }
    play.addEventListener("click", () => {
      if (started !== null) { stop(); return; }
      const from = Number(slider.value) >= spec.time.length - 1 ? 0 : Number(slider.value);
      started = { time: spec.time[from], at: performance.now() };
      play.textContent = "Pause";
      requestAnimationFrame(step);
    });
    slider.addEventListener("input", () => { stop(); show(Number(slider.value)); });
    row.append(play, slider);
    box.append(row);
    return { slider, stop };
  }

  function build(box) {
    const spec = JSON.parse(box.querySelector("script").textContent);
    const robot = readRobot(spec.robot);
    if (!robot || !spec.joints.length) { box.remove(); return; }
    const path = paths(spec, robot);
    const frame = frameOf(spec, robot);
    const size = Math.max(frame[2] - frame[0], frame[3] - frame[1]);
    const largest = Math.max(...path.deviations.flat());
    const factor = magnificationFor(largest, size);
    const margin = MARGIN * size;
    const view = shape("svg", {
      viewBox: [frame[0] - margin, frame[1] - margin, frame[2] - frame[0] + 2 * margin, frame[3] - frame[1] + 2 * margin].join(" "),
      "aria-hidden": "true",
    });
    view.style.setProperty("--thin", `${0.004 * size}px`);
    const bodies = [{ name: "measured", model: null, factor: 1 }]
      .concat(spec.models.map((model, index) => ({ name: "model", model: index, factor, links: moved(spec, robot), ...model })));
    bodies.forEach((body) => {
      body.parts = outlines(robot, positionsAt(spec, 0, null, 1), body.links).map(() => {
        const part = shape("polygon", { class: body.dashed ? `${body.name} dashed` : body.name });
        if (body.colour) part.style.stroke = body.colour;
        view.append(part);
        return part;
      });
      if (body.model === null) drawPath(view, spec, path);
    });
    box.append(view);
    const text = element("p", "machine-text");
    text.setAttribute("aria-live", "off");
    const note = element("p", "hint", explanation(spec, factor));
    let shown = -1;
    function draw(sample) {
      if (sample === shown) return;
      shown = sample;
      bodies.forEach((body) => {
        const parts = outlines(robot, positionsAt(spec, sample, body.model, body.factor), body.links);
        body.parts.forEach((part, index) => part.setAttribute("points", pointsText(parts[index])));
      });
      const off = spec.models.map((model, index) => `${model.label} ${millimetres(path.deviations[index][sample])}`);
      text.textContent = `At ${number(spec.time[sample])} s the tip is off by: ${off.join(", ")}`;
      bar.slider.value = sample;
      bar.slider.setAttribute("aria-valuetext", text.textContent);
    }
    function show(sample) {
      draw(sample);
      point(spec.group, spec.time[sample]);
    }
    const bar = controls(box, spec, show);
    box.append(text, note);
    onCursor(spec.group, (time) => draw(indexAt(spec.time, time)));
    draw(path.deviations[0].indexOf(Math.max(...path.deviations[0])));
  }
  function explanation(spec, factor) {
    const scale = factor === 1 ? "to scale" : `${factor} times as large as it is`;
    const unmeasured = spec.joints.some((joint) => !joint.measured) ? " A joint that is not measured is drawn as simulated." : "";
    return `The machine from its side at the cursor of the plots. Filled: measured. Outlined: ${spec.models.map((model) => model.label).join(", ")}, `
      + `with its deviation drawn ${scale}. The path of the tip is darker where the deviation is larger.${unmeasured}`;
  }

  document.querySelectorAll(".machine").forEach((box) => {
    try { build(box); } catch (error) { box.append(`The machine cannot be drawn: ${error.message}`); }
  });
})();
