(function () {
  "use strict";
  // Plots over time: drawn from the JSON in their boxes, moved by mouse or keyboard, all of one recording together.
  const plots = [];
  const root = document.documentElement;
  const probe = document.createElement("span");
  const spoken = document.createElement("div");
  probe.hidden = true;
  spoken.className = "spoken";
  spoken.setAttribute("aria-live", "polite");
  document.body.append(probe, spoken);

  // A canvas knows no CSS variables, and no light-dark().
  function colour(text, alpha) {
    probe.style.color = text;
    const found = getComputedStyle(probe).color;
    return alpha === undefined ? found : found.replace(/^rgba?\(([^,]+),([^,]+),([^,)]+).*$/, `rgba($1,$2,$3,${alpha})`);
  }
  function number(value) {
    if (value === 0) return "0";
    const size = Math.abs(value);
    return size >= 1e5 || size < 1e-3 ? value.toExponential(2) : String(+value.toPrecision(4));
  }
  function withUnit(value, unit) { return value == null ? "" : `${number(value)} ${unit}`; }
  function axis(label, size, visible) {
    const texts = (_, ticks) => ticks.map((tick) => (visible && tick != null ? String(+tick.toPrecision(6)) : ""));
    return {
      label, labelSize: visible ? 20 : 0, labelFont: "12px system-ui, sans-serif", font: "11px system-ui, sans-serif",
      stroke: colour("var(--soft)"), size, gap: 4, values: texts,
      grid: { stroke: colour("var(--grid)"), width: 1 }, ticks: { stroke: colour("var(--line)"), width: 1, size: 4 },
    };
  }
  // A missing value where the clock has a gap, so that no line crosses it.
  function torn(values, gaps, filler) {
    if (!gaps || !gaps.length) return values;
    const out = [];
    let next = 0;
    values.forEach((value, index) => {
      out.push(value);
      if (gaps[next] === index) {
        out.push(filler(value, values[index + 1]));
        next += 1;
      }
    });
    return out;
  }
  function series(spec) {
    const time = { label: "time", value: (_, value) => withUnit(value, "s") };
    return [time].concat(spec.series.map((one) => ({
      label: one.label, stroke: colour(one.colour), width: one.width, dash: one.dash, points: { show: false }, spanGaps: false,
      value: (_, value) => withUnit(value, spec.unit),
    })));
  }
  function draw(box) {
    const spec = JSON.parse(box.querySelector("script").textContent);
    const x = axis(spec.last ? "time (s)" : null, spec.last ? 28 : 8, spec.last);
    const y = axis(`${spec.label} (${spec.unit})`, 56, true);
    if (spec.height < 150) y.space = 26;
    const dashed = (_, index) => (index > 0 && spec.series[index - 1].dash ? "dashed" : "solid");
    const data = [torn(spec.time, spec.gaps, (a, b) => (a + b) / 2)]
      .concat(spec.series.map((one) => torn(one.values, spec.gaps, () => null)));
    const plot = new uPlot({
      bands: (spec.bands || []).map((band) => ({ series: [band.high + 1, band.low + 1], fill: colour(band.fill, 0.2) })),
      width: box.clientWidth || 1000, height: spec.height, series: series(spec), axes: [x, y], padding: [8, 8, 0, 0],
      scales: { x: { time: false } }, legend: { live: true, markers: { dash: dashed } },
      cursor: { sync: { key: spec.group, setSeries: false }, drag: { x: true, y: false }, points: { size: 6 } },
    }, data, box);
    // Edges of bands have no line of their own to hide.
    const rows = box.querySelectorAll(".u-legend .u-series");
    spec.series.forEach((one, index) => { if (one.edge && rows[index + 1]) rows[index + 1].style.display = "none"; });
    plots.push({ plot, box, spec });
  }
  function boxes() { return Array.from(document.querySelectorAll(".time-plot")); }
  function drawAll() {
    plots.splice(0).forEach((one) => one.plot.destroy());
    boxes().forEach((box) => {
      try { draw(box); } catch (error) { box.append(`This plot cannot be drawn: ${error.message}`); }
    });
  }
  function fit(width) {
    plots.forEach((one) => one.plot.setSize({ width: width || one.box.clientWidth || 1000, height: one.spec.height }));
  }

  // Keyboard: the cursor, and the part of the recording that is shown.
  function zoom(group, range) {
    plots.filter((one) => one.spec.group === group).forEach((one) => one.plot.setScale("x", range));
  }
  function moved(one, steps) {
    const { plot } = one, time = plot.data[0];
    const shown = plot.scales.x;
    const inside = time.filter((t) => t >= shown.min && t <= shown.max).length;
    const now = plot.cursor.idx == null ? plot.valToIdx((shown.min + shown.max) / 2) : plot.cursor.idx;
    const next = Math.max(0, Math.min(time.length - 1, now + Math.round(steps * Math.max(1, inside / 200))));
    plot.setCursor({ left: plot.valToPos(time[next], "x"), top: plot.over.clientHeight / 2 });
    const values = one.spec.series.filter((own) => !own.edge)
      .map((own) => `${own.label} ${withUnit(plot.data[one.spec.series.indexOf(own) + 1][next], one.spec.unit) || "not measured"}`);
    spoken.textContent = `${number(time[next])} s: ${values.join(", ")}`;
  }
  function zoomed(one, factor) {
    const { plot } = one, time = plot.data[0], { min, max } = plot.scales.x;
    const middle = plot.cursor.idx == null ? (min + max) / 2 : time[plot.cursor.idx];
    const from = Math.max(time[0], middle - (middle - min) * factor), to = Math.min(time[time.length - 1], middle + (max - middle) * factor);
    if (to > from) zoom(one.spec.group, { min: from, max: to });
  }
  const keys = {
    ArrowLeft: (one, event) => moved(one, event.shiftKey ? -10 : -1),
    ArrowRight: (one, event) => moved(one, event.shiftKey ? 10 : 1),
    "+": (one) => zoomed(one, 0.5),
    "=": (one) => zoomed(one, 0.5),
    "-": (one) => zoomed(one, 2),
    0: (one) => zoom(one.spec.group, { min: one.plot.data[0][0], max: one.plot.data[0][one.plot.data[0].length - 1] }),
  };
  function pressed(event) {
    const one = plots.find((candidate) => candidate.box === event.currentTarget);
    const act = keys[event.key];
    if (!one || !act || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    act(one, event);
  }

  // Light and dark: what the system says, until the button says otherwise.
  function scheme(wanted) {
    if (wanted) root.dataset.scheme = wanted; else delete root.dataset.scheme;
    drawAll();
  }
  function isDark() {
    const own = root.dataset.scheme;
    return own ? own === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  }
  const button = document.querySelector(".scheme");
  if (button) {
    button.hidden = false;
    button.addEventListener("click", () => scheme(isDark() ? "light" : "dark"));
  }
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", drawAll);

  boxes().forEach((box) => {
    box.tabIndex = 0;
    box.addEventListener("keydown", pressed);
  });
  // A table that is wider than the page can be scrolled by keyboard.
  function reachable() {
    document.querySelectorAll(".wide").forEach((table) => {
      const scrolls = table.scrollWidth > table.clientWidth;
      if (scrolls) Object.assign(table, { tabIndex: 0, role: "region", ariaLabel: "table, scrolls sideways" });
      else table.removeAttribute("tabindex");
    });
  }
  drawAll();
  reachable();
  let waiting, before;
  window.addEventListener("resize", () => { clearTimeout(waiting); waiting = setTimeout(() => { fit(); reachable(); }, 100); });
  window.addEventListener("beforeprint", () => {
    before = root.dataset.scheme;
    scheme("light");
    fit(680);
    document.querySelectorAll("details").forEach((one) => { one.open = true; });
  });
  window.addEventListener("afterprint", () => { scheme(before); fit(); });
})();
