(function () {
  "use strict";
  // Half a minute at 25 frames per second; arrays never grow beyond it.
  var KEPT = 750, MEAN = 50, chosen = null, first = null, columns = {}, plots = [], latest = null, means = [];
  var number = 0, lastNumber = null, missed = 0, rates = [];
  var C = { black: "#2b2f33", blue: "#0072b2", green: "#009e73", orange: "#d55e00", pink: "#cc79a7", purple: "#7b4a9a", grey: "#9aa4ad" };
  var SPECS = [
    ["displacement", "mm", 110, [["displacement", C.blue, function (f, c) { return scaled(c.displacement, 1e3); }]]],
    ["opening", "mm²", 110, [["command", C.grey, function (f, c) { return scaled(c.command, 1e6); }], ["spool", C.blue, function (f, c) { return scaled(c.orifice_area, 1e6); }]]],
    ["pressure", "MPa", 140, [["cap", C.orange, function (f, c) { return scaled(c.cap_pressure, 1e-6); }], ["rod", C.pink, function (f, c) { return scaled(c.rod_pressure, 1e-6); }], ["pump", C.blue, function (f) { return scaled(f.pump_pressure, 1e-6); }]]],
    ["H", "J", 120, [["H", C.black, function (f, c, e) { return scaled(e.hamiltonian, 1); }]]],
    ["power", "W", 160, [["dH/dt", C.black, function (f, c, e) { return scaled(e.hamiltonian_rate, 1); }], ["supply", C.blue, function (f, c, e) { return scaled(e.supply, 1); }], ["dissipation", C.orange, function (f, c, e) { return scaled(e.dissipation, 1); }]]],
    ["not explained", "W", 120, [["ledger residual", C.purple, function (f, c, e) { return scaled(e.residual, 1); }]]]
  ];
  function byId(id) { return document.getElementById(id); }
  function scaled(value, factor) { return value == null ? null : value * factor; }
  function short(value) { return value == null ? "–" : String(+value.toPrecision(3)); }

  function build() {
    var box = byId("plots");
    SPECS.forEach(function (spec, index) {
      var own = document.createElement("div"), last = index === SPECS.length - 1;
      own.className = "plot"; box.appendChild(own);
      var series = [{ label: "time", value: function (_, v) { return v == null ? "" : v.toFixed(1) + " s"; } }];
      spec[3].forEach(function (s) {
        series.push({ label: s[0], stroke: s[1], width: 1.3, points: { show: false }, value: function (_, v) { return v == null ? "" : short(v) + " " + spec[1]; } });
      });
      var axis = { stroke: "#5b6670", font: "11px system-ui, sans-serif", grid: { stroke: "#e9edf0", width: 1 }, ticks: { stroke: "#c3cad0", width: 1, size: 4 } };
      var data = series.map(function () { return []; });
      var plot = new uPlot({
        width: own.clientWidth || 800, height: spec[2] + (last ? 20 : 0), series: series, padding: [6, 8, 0, 0], scales: { x: { time: false } },
        axes: [Object.assign({}, axis, { size: last ? 26 : 8, values: last ? undefined : function (_, t) { return t.map(function () { return ""; }); } }),
          Object.assign({}, axis, { size: 50, label: spec[0] + " (" + spec[1] + ")", labelSize: 18, labelFont: "11px system-ui, sans-serif", space: 26 })],
        cursor: { sync: { key: "live" }, drag: { x: false, y: false } }
      }, data, own);
      plots.push({ plot: plot, data: data, lines: spec[3], box: own, height: spec[2] + (last ? 20 : 0) });
    });
    window.addEventListener("resize", function () { plots.forEach(function (p) { p.plot.setSize({ width: p.box.clientWidth, height: p.height }); }); });
  }

  function clear() { plots.forEach(function (p) { p.data.forEach(function (column) { column.length = 0; }); }); means.length = 0; }

  function take(frame, live) {
    number += 1;
    if (lastNumber !== null && frame.number > lastNumber + 1) missed += frame.number - lastNumber - 1;
    // A server that began anew counts anew.
    if (lastNumber !== null && frame.number < lastNumber) { clear(); first = null; }
    lastNumber = frame.number; latest = frame;
    var names = Object.keys(frame.cylinders || {});
    if (names.length && (chosen === null || names.indexOf(chosen) < 0)) { chosen = names[0]; choices(names); }
    if (frame.stamp == null || chosen === null) return;
    if (first === null || frame.stamp < first) { clear(); first = frame.stamp; }
    var t = frame.stamp - first, time = plots[0].data[0];
    if (time.length && t <= time[time.length - 1]) return;
    var c = frame.cylinders[chosen] || {}, e = (frame.powers && frame.powers.cylinders[chosen]) || {};
    plots.forEach(function (p) {
      p.data[0].push(t);
      p.lines.forEach(function (line, i) { p.data[i + 1].push(line[2](frame, c, e)); });
      if (p.data[0].length > KEPT) p.data.forEach(function (column) { column.shift(); });
    });
    if (frame.powers) { means.push(frame.powers); if (means.length > MEAN) means.shift(); }
    if (live) rates.push([performance.now(), frame.states, frame.balances]);
    if (rates.length > 50) rates.shift();
  }

  function choices(names) {
    var select = byId("cylinder");
    if (select.options.length === names.length) return;
    select.textContent = "";
    names.forEach(function (name) { var o = document.createElement("option"); o.textContent = name; select.appendChild(o); });
    select.value = chosen;
  }

  function mean(of) {
    var sum = 0, count = 0;
    means.forEach(function (p) { var v = of(p); if (v != null) { sum += v; count += 1; } });
    return count ? sum / count : 0;
  }

  function own(p) { return p.cylinders[chosen] || { terms: {} }; }

  // Left the pump, in the middle what it splits into, right what takes the cylinder's part.
  function drawFlow() {
    if (!means.length) return;
    var last = own(means[means.length - 1]), others = Object.keys(means[0].cylinders).filter(function (n) { return n !== chosen; });
    var pump = mean(function (p) { return p.pump_power; }), supply = mean(function (p) { return own(p).supply; });
    var middle = [["into " + chosen, supply, C.green], ["metering", mean(function (p) { return p.metering_loss; }), C.orange], ["bypass", mean(function (p) { return p.bypass_loss; }), C.orange]];
    others.forEach(function (name) { middle.push(["into " + name, mean(function (p) { return (p.cylinders[name] || {}).supply; }), C.green]); });
    var right = Object.keys(last.terms || {}).map(function (effect) { return [effect.replace(/_/g, " "), -mean(function (p) { return own(p).terms[effect]; }), C.orange]; });
    right.push(["stored", mean(function (p) { return own(p).hamiltonian_rate; }), C.blue]);
    right.push(["not explained", -mean(function (p) { return own(p).residual; }), C.purple]);
    right = right.filter(function (r) { return Math.abs(r[1]) > 5e-3 * Math.max(Math.abs(supply), 0.02 * pump); });
    var scale = 150 / Math.max(pump, 1e-9), out = [];
    function watts(w) { return short(w) + " W"; }
    // Names come from the network: they become text, never markup.
    function draw(tag, attributes, text) {
      var node = document.createElementNS("http://www.w3.org/2000/svg", tag);
      Object.keys(attributes).forEach(function (name) { node.setAttribute(name, attributes[name]); });
      if (text !== undefined) node.textContent = text;
      out.push(node);
    }
    function ribbon(x0, y0, x1, y1, w, colour) {
      var m = (x0 + x1) / 2;
      draw("path", { d: "M" + x0 + " " + y0 + "C" + m + " " + y0 + " " + m + " " + y1 + " " + x1 + " " + y1, fill: "none", stroke: colour, "stroke-opacity": 0.4, "stroke-width": Math.max(w, 0.7) });
    }
    function bar(x, y, h, colour, label, w) {
      draw("rect", { x: x, y: y, width: 9, height: Math.max(h, 1), fill: colour });
      draw("text", { x: x + 13, y: y + 10 }, label);
      draw("text", { "class": "watts", x: x + 13, y: y + 23 }, watts(w));
    }
    bar(4, 20, pump * scale, C.blue, "pump", pump);
    var leaving = 20, y = 20, from = null;
    middle.forEach(function (part) {
      var h = Math.max(part[1], 0) * scale;
      ribbon(13, leaving + h / 2, 130, y + h / 2, h, part[2]);
      bar(130, y, h, part[2], part[0], part[1]);
      if (from === null) from = y;
      leaving += h; y += Math.max(h, 1) + 30;
    });
    // The cylinder's own part is small beside the bypass: it has a scale of its own.
    var whole = right.reduce(function (sum, r) { return sum + Math.max(r[1], 0); }, 0), own_scale = 110 / Math.max(whole, 1e-9), at = 20;
    var narrow = Math.max(Math.max(supply, 0) * scale, 1), start = from;
    right.forEach(function (part) {
      var h = Math.max(part[1], 0) * own_scale, w = narrow * Math.max(part[1], 0) / Math.max(whole, 1e-9);
      // Widens from its share of the cylinder's bar to the scale of the right side.
      draw("path", { d: "M139 " + start + "C215 " + start + " 215 " + at + " 290 " + at + "V" + (at + h) + "C215 " + (at + h) + " 215 " + (start + w) + " 139 " + (start + w) + "Z", fill: part[2], "fill-opacity": 0.4 });
      start += w;
      bar(290, at, h, part[2], part[1] < 0 ? part[0] + " (gives)" : part[0], part[1]);
      at += Math.max(h, 1) + 28;
    });
    byId("flow").setAttribute("viewBox", "0 0 420 " + Math.max(y, at, 200));
    byId("flow").replaceChildren.apply(byId("flow"), out);
  }

  function drawTerms() {
    var last = means.length ? own(means[means.length - 1]) : null;
    if (!last) return;
    var rows = Object.keys(last.terms || {}).map(function (effect) { return [effect, mean(function (p) { return own(p).terms[effect]; })]; });
    var table = byId("terms");
    while (table.rows.length > rows.length) table.deleteRow(-1);
    while (table.rows.length < rows.length) { var row = table.insertRow(); row.insertCell(); row.insertCell(); }
    rows.forEach(function (r, i) { table.rows[i].cells[0].textContent = r[0]; table.rows[i].cells[1].textContent = short(r[1]) + " W"; });
  }

  var shown = "";
  function drawAlarms() {
    var alarms = latest ? latest.alarms : [], key = JSON.stringify(alarms);
    if (key === shown) return;
    shown = key;
    var box = byId("alarms");
    box.textContent = "";
    alarms.slice(0, 8).forEach(function (alarm) {
      var line = document.createElement("div"), part = document.createElement("b"), more = document.createElement("small");
      line.className = "alarm" + (alarm.level > 1 ? " error" : "");
      part.textContent = alarm.part;
      more.textContent = Object.keys(alarm.values).map(function (k) { return k + ": " + alarm.values[k]; }).join(" · ");
      line.appendChild(part); line.appendChild(document.createTextNode(alarm.message)); line.appendChild(more);
      box.appendChild(line);
    });
  }

  function redraw() {
    plots.forEach(function (p) { p.plot.setData(p.data); });
    drawFlow(); drawTerms(); drawAlarms();
    var a = rates[0], b = rates[rates.length - 1];
    if (a && b && b[0] > a[0]) {
      var seconds = (b[0] - a[0]) / 1e3;
      byId("rate").textContent = Math.round((b[1] - a[1]) / seconds) + " states/s · " + Math.round((b[2] - a[2]) / seconds) + " balances/s" + (missed ? " · " + missed + " frames left out" : "");
    }
  }

  var waiting = false;
  function connect() {
    var stream = new EventSource("/stream");
    function link(text, kind) { var chip = byId("link"); chip.textContent = text; chip.className = "chip " + kind; }
    stream.onopen = function () { link("live", "live"); };
    stream.onerror = function () { link("no connection", "lost"); };
    stream.onmessage = function (event) {
      take(JSON.parse(event.data), true);
      if (!waiting) { waiting = true; requestAnimationFrame(function () { waiting = false; redraw(); }); }
    };
  }

  build();
  byId("cylinder").addEventListener("change", function () { chosen = this.value; clear(); });
  fetch("/history").then(function (reply) { return reply.json(); }).then(function (frames) { frames.forEach(function (frame) { take(frame, false); }); redraw(); }).catch(function () {}).then(connect);
  // For whoever watches the watcher.
  window.dashboard = { frames: function () { return number; }, points: function () { return plots[0].data[0].length; }, last: function () { return plots.map(function (p) { return p.data.map(function (c) { return c[c.length - 1]; }); }); } };
})();
