// Plots over time: drawn from the JSON in their boxes, all of one group zoomed together.
(function () {
  "use strict";
  const root = document.documentElement;
  const plots = [];
  const SMALL = "11px system-ui, sans-serif";
  const SUPERSCRIPT = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };
  // Least distance of labels along an axis, px.
  const SPACE = { x: 70, y: 26 };

  // A canvas knows no CSS variables.
  function colour(text) {
    const name = /^var\((--\w+)\)$/.exec(text);
    return name ? getComputedStyle(root).getPropertyValue(name[1]).trim() : text;
  }
  function translucent(text) { return `${colour(text)}33`; }
  function powerOfTen(exponent) { return `10${String(exponent).replace(/./g, (digit) => SUPERSCRIPT[digit])}`; }
  function minus(text) { return text.replace("-", "−"); }
  // As in the tables: a power of ten where plain digits would be hard to read.
  function number(value) {
    if (value === 0) return "0";
    const exponent = Math.floor(Math.log10(Math.abs(value)));
    if (exponent >= -3 && exponent <= 5) return minus(String(+value.toPrecision(4)));
    const [digits, power] = value.toExponential(2).split("e");
    return `${minus(digits)} × ${powerOfTen(Number(power))}`;
  }
  function withUnit(value, unit) { return value == null ? "" : `${number(value)} ${unit}`.trim(); }

  // Round numbers in a range, about as many as fit and never fewer than two: as svg.rs does it.
  function step(low, high, most) {
    const power = 10 ** Math.floor(Math.log10((high - low) / most));
    const steps = [10, 5, 2, 1, 0.5, 0.2].map((factor) => factor * power);
    const count = (size) => Math.floor(high / size) - Math.ceil(low / size) + 1;
    const fitting = steps.filter((size) => size * most >= high - low);
    return steps.slice(fitting.length - 1).find((size) => count(size) >= 2) ?? power;
  }
  function ticks(low, high, most) {
    const size = step(low, high, most);
    const found = [];
    for (let k = Math.ceil(low / size - 1e-9); k * size <= high + 1e-9 * size; k += 1) found.push(k * size);
    return found;
  }
  // The power of ten that is taken out of all labels of an axis, a multiple of three.
  function exponentOf(values) {
    const largest = Math.max(...values.map(Math.abs));
    const exponent = largest > 0 ? Math.floor(Math.log10(largest) + 1e-9) : 0;
    return exponent >= 5 || exponent <= -3 ? 3 * Math.floor(exponent / 3) : 0;
  }
  function tickTexts(values, exponent) {
    if (values.length < 2) return values.map(number);
    const size = (values[1] - values[0]) / 10 ** exponent;
    const decimals = Math.min(9, Math.max(0, -Math.floor(Math.log10(size) + 1e-9)));
    return values.map((value) => minus((value / 10 ** exponent).toFixed(decimals)).replace(/^−(0\.?0*)$/, "$1"));
  }
  function axis(own, along) {
    const side = along === "x" ? "width" : "height";
    const most = (plot) => Math.max(2, Math.floor(plot.bbox[side] / devicePixelRatio / SPACE[along]));
    return {
      font: SMALL, labelFont: SMALL, gap: 4, stroke: () => colour("var(--soft)"),
      grid: { stroke: () => colour("var(--grid)"), width: 1 }, ticks: { stroke: () => colour("var(--edge)"), width: 1, size: 4 },
      splits: (plot, _, low, high) => ticks(low, high, most(plot)),
      ...own,
    };
  }
  function axes(spec, quantity) {
    const x = axis({
      size: 24, values: (_, values) => tickTexts(values, 0), ...(spec.last ? { label: "time (s)", labelSize: 18 } : {}),
    }, "x");
    const y = axis({
      size: 52,
      values: (_, values) => {
        const exponent = exponentOf(values);
        const unit = [exponent ? powerOfTen(exponent) : "", spec.unit].join(" ").trim();
        quantity.textContent = unit ? `${spec.label} (${unit})` : spec.label;
        return tickTexts(values, exponent);
      },
    }, "y");
    return [x, y];
  }

  // A missing value where the clock has a gap, so that no line crosses it.
  function torn(values, gaps, filler) {
    if (!gaps || !gaps.length) return values;
    const after = new Set(gaps);
    return values.flatMap((value, index) => (after.has(index) ? [value, filler(value, values[index + 1])] : [value]));
  }
  function series(spec) {
    const time = { label: "time", value: (_, value) => withUnit(value, "s") };
    return [time].concat(spec.series.map((one) => ({
      label: one.label, stroke: () => colour(one.colour), width: one.width, dash: one.dash, points: { show: false }, spanGaps: false,
      value: (_, value) => withUnit(value, spec.unit),
    })));
  }
  // Elements follow the scheme by themselves if their colours stay variables.
  function variable(spec) {
    return (_, index) => (index > 0 ? spec.series[index - 1].colour : "transparent");
  }
  // Names are buttons that show or hide their lines.
  function legend(box, spec, plot) {
    const names = [];
    box.querySelectorAll(".u-legend .u-series").forEach((row, index) => {
      const one = spec.series[index - 1];
      if (!one) return;
      // Edges of bands have no line of their own to hide.
      if (one.edge) { row.style.display = "none"; return; }
      const name = row.querySelector(".u-label");
      name.tabIndex = 0;
      name.setAttribute("role", "button");
      name.addEventListener("keydown", (event) => {
        if (event.key !== "Enter" && event.key !== " ") return;
        event.preventDefault();
        name.click();
      });
      names.push([name, index]);
    });
    const tell = () => names.forEach(([name, index]) => name.setAttribute("aria-pressed", plot.series[index].show));
    box.querySelector(".u-legend").addEventListener("click", tell);
    tell();
  }
  function draw(box) {
    const spec = JSON.parse(box.querySelector("script").textContent);
    const quantity = document.createElement("div");
    quantity.className = "quantity";
    box.append(quantity);
    const dashed = (_, index) => (index > 0 && spec.series[index - 1].dash ? "dashed" : "solid");
    const data = [torn(spec.time, spec.gaps, (a, b) => (a + b) / 2)]
      .concat(spec.series.map((one) => torn(one.values, spec.gaps, () => null)));
    const plot = new uPlot({
      bands: (spec.bands || []).map((band) => ({ series: [band.high + 1, band.low + 1], fill: () => translucent(band.fill) })),
      width: box.clientWidth || 1000, height: spec.height, series: series(spec), axes: axes(spec, quantity), padding: [8, 12, 0, 0],
      scales: { x: { time: false } }, hooks: { setCursor: [tellOf(spec)] }, legend: { live: true, markers: { dash: dashed, stroke: variable(spec) } },
      cursor: {
        sync: { key: spec.group, setSeries: false }, drag: { x: true, y: false },
        points: { size: 6, fill: variable(spec), stroke: variable(spec) },
      },
    }, data, box);
    legend(box, spec, plot);
    plots.push({ plot, box, spec });
  }
  // Who wants to know where the cursor of a group is, by group.
  const listeners = new Map();
  function onCursor(group, listener) { listeners.set(group, (listeners.get(group) || []).concat(listener)); }
  function tellOf(spec) {
    return ({ cursor, data }) => {
      const time = cursor.idx == null || cursor.left < 0 ? null : data[0][cursor.idx];
      if (time != null) (listeners.get(spec.group) || []).forEach((listener) => listener(time));
    };
  }
  // Moves the cursor of each plot of a group by itself: their pixels differ where their widths do.
  function point(group, time) {
    plots.filter(({ spec }) => spec.group === group).forEach(({ plot }) => {
      plot.setCursor({ left: plot.valToPos(time, "x"), top: plot.over.clientHeight / 2 }, true, false);
    });
  }
  // Plots as wide as their boxes, or as wide and with such a part of their height as is asked for.
  function fit(width, share = 1) {
    plots.forEach(({ plot, box, spec }) => plot.setSize({ width: width || box.clientWidth || 1000, height: share * spec.height }));
  }

  document.querySelectorAll(".time-plot").forEach((box) => {
    try { draw(box); } catch (error) { box.append(`This plot cannot be drawn: ${error.message}`); }
  });
  scheme.onChange(() => plots.forEach(({ plot }) => plot.redraw(false)));
  let waiting;
  window.addEventListener("resize", () => { clearTimeout(waiting); waiting = setTimeout(() => fit(), 100); });

  globalThis.timePlots = { plots, fit, number, withUnit, onCursor, point };
})();
