// Plots over time by keyboard: the cursor, and the part of the recording that is shown.
(function () {
  "use strict";
  const { plots, number, withUnit, point } = timePlots;
  // Steps of the cursor across what is shown, and steps at once with the shift key.
  const STEPS = 200;
  const LARGE = 10;

  const spoken = document.createElement("div");
  spoken.className = "spoken";
  spoken.setAttribute("aria-live", "polite");
  document.body.append(spoken);

  function ofGroup(one) { return plots.filter((other) => other.spec.group === one.spec.group); }
  function whole({ plot }) { return [plot.data[0][0], plot.data[0][plot.data[0].length - 1]]; }
  function cursorTime({ plot }) {
    const { min, max } = plot.scales.x;
    const time = plot.cursor.idx == null ? null : plot.data[0][plot.cursor.idx];
    return time != null && time >= min && time <= max ? time : (min + max) / 2;
  }
  function announce(one, index) {
    const { plot, spec } = one;
    const values = spec.series
      .map((own, place) => (own.edge ? null : `${own.label} ${withUnit(plot.data[place + 1][index], spec.unit) || "not measured"}`))
      .filter((text) => text !== null);
    spoken.textContent = `${number(plot.data[0][index])} s: ${values.join(", ")}`;
  }
  function moved(one, steps) {
    const { plot } = one;
    const time = plot.data[0];
    const { min, max } = plot.scales.x;
    const wanted = Math.min(max, Math.max(min, cursorTime(one) + (steps * (max - min)) / STEPS));
    let index = plot.valToIdx(wanted);
    // Where samples are further apart than a step, the next one.
    if (index === plot.cursor.idx) index = Math.min(time.length - 1, Math.max(0, index + Math.sign(steps)));
    if (time[index] < min || time[index] > max) return;
    point(one.spec.group, time[index]);
    announce(one, index);
  }
  function show(one, min, max) {
    const { idx } = one.plot.cursor;
    ofGroup(one).forEach(({ plot }) => plot.setScale("x", { min, max }));
    // Scales change after this; the cursor then stays at its time and not at its pixel.
    if (idx != null) queueMicrotask(() => point(one.spec.group, one.plot.data[0][idx]));
    spoken.textContent = `${number(min)} s to ${number(max)} s`;
  }
  function zoomed(one, factor) {
    const { min, max } = one.plot.scales.x;
    const [first, last] = whole(one);
    const middle = cursorTime(one);
    const from = Math.max(first, middle - (middle - min) * factor);
    const to = Math.min(last, middle + (max - middle) * factor);
    // Closer than a few samples there is nothing to see.
    if (to > from && (factor > 1 || one.plot.valToIdx(to) - one.plot.valToIdx(from) > 4)) show(one, from, to);
  }
  function reset(one) { show(one, ...whole(one)); }

  const KEYS = {
    ArrowLeft: (one, event) => moved(one, event.shiftKey ? -LARGE : -1),
    ArrowRight: (one, event) => moved(one, event.shiftKey ? LARGE : 1),
    "+": (one) => zoomed(one, 0.5),
    "=": (one) => zoomed(one, 0.5),
    "-": (one) => zoomed(one, 2),
    0: reset,
    Escape: reset,
  };
  plots.forEach((one) => {
    one.box.addEventListener("keydown", (event) => {
      const act = KEYS[event.key];
      // Names in the legend have keys of their own.
      if (!act || event.target !== one.box || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      act(one, event);
    });
  });
})();
