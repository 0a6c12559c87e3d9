(function () {
  "use strict";
  var plots = [], SOFT = "#5b6670";
  function number(value) {
    if (value === 0) return "0";
    var size = Math.abs(value);
    return size >= 1e5 || size < 1e-3 ? value.toExponential(2) : String(+value.toPrecision(4));
  }
  function axis(label, size, visible) {
    return {
      label: label, labelSize: visible ? 20 : 0, labelFont: "12px system-ui, sans-serif", font: "11px system-ui, sans-serif",
      stroke: SOFT, size: size, gap: 4, grid: { stroke: "#e9edf0", width: 1 }, ticks: { stroke: "#c3cad0", width: 1, size: 4 },
      values: visible ? function (_, ticks) { return ticks.map(function (t) { return t == null ? "" : String(+t.toPrecision(6)); }); } : function (_, ticks) { return ticks.map(function () { return ""; }); }
    };
  }
  function draw(box) {
    var spec = JSON.parse(box.querySelector("script").textContent);
    var series = [{ label: "time", value: function (_, v) { return v == null ? "" : number(v) + " s"; } }];
    spec.series.forEach(function (s) {
      series.push({
        label: s.label, stroke: s.colour, width: s.width, dash: s.dash, points: { show: false }, spanGaps: false,
        value: function (_, v) { return v == null ? "" : number(v) + " " + spec.unit; }
      });
    });
    var xAxis = axis(spec.last ? "time (s)" : null, spec.last ? 28 : 8, spec.last);
    var yAxis = axis(spec.label + " (" + spec.unit + ")", 52, true);
    if (spec.height < 150) yAxis.space = 26;
    var bands = (spec.bands || []).map(function (b) { return { series: [b.high + 1, b.low + 1], fill: b.fill }; });
    var plot = new uPlot({
      bands: bands,
      width: box.clientWidth || 1000, height: spec.height, series: series, axes: [xAxis, yAxis], padding: [8, 8, 0, 0],
      scales: { x: { time: false } }, legend: { live: true, markers: { dash: function (_, i) { return i > 0 && spec.series[i - 1].dash ? "dashed" : "solid"; } } },
      cursor: { sync: { key: spec.group, setSeries: false }, drag: { x: true, y: false }, points: { size: 6 } }
    }, [spec.time].concat(spec.series.map(function (s) { return s.values; })), box);
    // Edges of bands have no line of their own to hide.
    var rows = box.querySelectorAll(".u-legend .u-series");
    spec.series.forEach(function (s, i) { if (s.edge && rows[i + 1]) rows[i + 1].style.display = "none"; });
    plots.push({ plot: plot, box: box, height: spec.height });
  }
  function fit(width) {
    plots.forEach(function (p) { p.plot.setSize({ width: width || p.box.clientWidth || 1000, height: p.height }); });
  }
  Array.prototype.forEach.call(document.querySelectorAll(".time-plot"), function (box) {
    try { draw(box); } catch (error) { box.appendChild(document.createTextNode("This plot cannot be drawn: " + error.message)); }
  });
  var waiting;
  window.addEventListener("resize", function () { clearTimeout(waiting); waiting = setTimeout(function () { fit(); }, 100); });
  window.addEventListener("beforeprint", function () {
    fit(680);
    Array.prototype.forEach.call(document.querySelectorAll("details"), function (d) { d.open = true; });
  });
  window.addEventListener("afterprint", function () { fit(); });
})();
