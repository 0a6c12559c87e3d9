// The last half minute over time.

const plots = (function () {
  // Half a minute at 25 frames per second; arrays never grow beyond it.
  const KEPT = 750, HEIGHT = 190;
  const POWER = { factor: 1, symbol: "W", decimals: 1 }, MPA = { factor: 1e-6, symbol: "MPa", decimals: 3 };
  const SPECS = [
    { name: "displacement", unit: function (u) { return u.position; }, lines: [["displacement", "blue", function (f, c) { return c.displacement; }]] },
    { name: "orifice area", unit: function (u) { return u.command; }, title: function (u) { return u.commandName; }, lines: [["command", "grey", function (f, c) { return c.command; }], ["measured", "blue", function (f, c) { return c.orifice_area; }]] },
    { name: "pressure", unit: MPA, lines: [["cap", "orange", function (f, c) { return c.cap_pressure; }], ["rod", "pink", function (f, c) { return c.rod_pressure; }], ["pump", "blue", function (f) { return f.pump_pressure; }]] },
    { name: "stored energy H", unit: { factor: 1, symbol: "J", decimals: 1 }, lines: [["stored energy H", "ink", function (f, c, e) { return e.hamiltonian; }]] },
    { name: "power", unit: POWER, lines: [["dH/dt", "stored", function (f, c, e) { return e.hamiltonian_rate; }], ["supply", "supply", function (f, c, e) { return e.supply; }], ["dissipation", "dissipation", function (f, c, e) { return e.dissipation; }]] },
    { name: "unexplained power", unit: POWER, lines: [["unexplained", "unexplained", function (f, c, e) { return e.residual; }]] }
  ];
  const all = SPECS.map(function (spec) { return { spec: spec, data: [[]].concat(spec.lines.map(function () { return []; })), plot: null, box: null }; });
  let units = unitsOf(null);

  function unitOf(spec) { return typeof spec.unit === "function" ? spec.unit(units) : spec.unit; }

  function seriesOf(spec) {
    const unit = unitOf(spec);
    return spec.lines.map(function (line) {
      return {
        label: line[0], stroke: colour(line[1]), width: 1.6, points: { show: false },
        value: function (_, value) { return fixed(value, unit.decimals) + " " + unit.symbol; }
      };
    });
  }

  /** Numbers of an axis, written like all others on the page. */
  function ticks(_, splits) {
    return splits.map(function (value) { return String(Number(value.toPrecision(6))).replace("-", "−"); });
  }

  function axesOf(spec) {
    const font = "12px system-ui, sans-serif", title = spec.title ? spec.title(units) : spec.name;
    const style = { stroke: colour("soft"), font: font, labelFont: font, labelSize: 18, grid: { stroke: colour("line"), width: 1 }, ticks: { stroke: colour("line"), width: 1, size: 4 } };
    return [
      Object.assign({}, style, { values: ticks, size: 28, label: "time (s)", space: 60 }),
      Object.assign({}, style, { values: ticks, size: 54, label: title + " (" + unitOf(spec).symbol + ")", space: 30 })
    ];
  }

  /** Builds all plots anew: colours and units are those of now. */
  function build(newUnits) {
    units = newUnits || units;
    all.forEach(function (own) {
      if (own.plot) own.plot.destroy();
      if (!own.box) { own.box = element("div", "plot"); byId("plots").appendChild(own.box); }
      own.plot = new uPlot({
        width: own.box.clientWidth || 600, height: HEIGHT, padding: [8, 10, 0, 0], scales: { x: { time: false } },
        series: [{ label: "time", value: function (_, value) { return fixed(value, 1) + " s"; } }].concat(seriesOf(own.spec)),
        axes: axesOf(own.spec), cursor: { sync: { key: "live" }, drag: { x: false, y: false } }
      }, own.data, own.box);
    });
  }

  function fit() { all.forEach(function (own) { own.plot.setSize({ width: own.box.clientWidth, height: HEIGHT }); }); }

  function take(time, frame, cylinder, powers) {
    const known = all[0].data[0];
    if (known.length && time <= known[known.length - 1]) return;
    all.forEach(function (own) {
      const factor = unitOf(own.spec).factor;
      own.data[0].push(time);
      own.spec.lines.forEach(function (line, index) {
        const value = times(line[2](frame, cylinder, powers), factor);
        own.data[index + 1].push(value === undefined ? null : value);
      });
      if (own.data[0].length > KEPT) own.data.forEach(function (column) { column.shift(); });
    });
  }

  /** Draws what somebody sees: a phone that shows the large values draws no plots. */
  function show() {
    all.forEach(function (own) {
      const place = own.box.getBoundingClientRect();
      if (place.top < window.innerHeight && place.bottom > 0) own.plot.setData(own.data);
    });
  }

  return {
    build: build, fit: fit, take: take, show: show,
    clear: function () { all.forEach(function (own) { own.data.forEach(function (column) { column.length = 0; }); }); },
    points: function () { return all[0].data[0].length; },
    last: function () { return all.map(function (own) { return own.data.map(function (column) { return column[column.length - 1]; }); }); }
  };
})();
