// The energy balance of the chosen cylinder as one bar, and where the power goes. All powers are means over two seconds.
//
// dH/dt = supply + dissipation + unexplained holds by definition of the last. In the bar, what adds energy stands on the left
// and what takes it on the right, so both sides are equally long. A term whose sign changes moves to the other side.

const energy = (function () {
  const MEAN = 50, PATIENCE = 10000;
  // Name, key in a frame, colour, and the sign with which a positive value is power in.
  const TERMS = [
    { label: "change of stored energy dH/dt", key: "hamiltonian_rate", colour: "stored", sense: -1, short: "dH/dt" },
    { label: "supply", key: "supply", colour: "supply", sense: 1, short: "supply" },
    { label: "dissipation", key: "dissipation", colour: "dissipation", sense: 1, short: "dissipation" },
    { label: "unexplained", key: "residual", colour: "unexplained", sense: 1, short: "unexplained" }
  ];
  const ORDER = [1, 2, 0, 3];
  let means = [], heard = 0, scale = 10, large = 0;

  function take(frame) {
    if (frame.powers) { means.push(frame.powers); heard = frame.time; }
    if (means.length > MEAN) means.shift();
    // Old powers say nothing about now.
    if (frame.time - heard > 3000) means = [];
  }

  function mean(of) {
    let sum = 0, count = 0;
    means.forEach(function (powers) {
      const value = of(powers);
      if (value !== null && value !== undefined) { sum += value; count += 1; }
    });
    return count ? sum / count : null;
  }

  function meanOf(cylinder, key) {
    return mean(function (powers) { return (powers.cylinders[cylinder] || {})[key]; });
  }

  function watts(value) {
    if (value === null) return "–";
    return scale >= 1e4 ? signed(times(value, 1e-3), 2) + " kW" : signed(value, 0) + " W";
  }

  function build() {
    TERMS.forEach(function (term, index) {
      const box = element("div", "term"), head = element("div", "label mark " + term.colour, term.label);
      term.value = element("div", "watts", "–");
      box.append(head, term.value);
      if (index) byId("equation").appendChild(element("span", "operator", index === 1 ? "=" : "+"));
      byId("equation").appendChild(box);
      term.segment = element("div", "segment " + term.colour);
      byId("bar").appendChild(term.segment);
    });
    byId("bar").appendChild(element("div", "zero"));
    [0, 25, 50, 75, 100].forEach(function () { byId("bar-axis").appendChild(element("span")); });
  }

  function show(chosen) {
    const powers = TERMS.map(function (term) { return meanOf(chosen, term.key); });
    const isKnown = powers.every(function (power) { return power !== null; });
    byId("ledger").classList.toggle("empty", !isKnown);
    say(byId("ledger-note"), isKnown ? "" : "No energy balance is received. Start one with: excavator node energy-monitor");
    const sides = drawBar(isKnown ? powers : [0, 0, 0, 0]);
    TERMS.forEach(function (term, index) { say(term.value, watts(powers[index])); });
    say(byId("power-in"), isKnown ? watts(sides[0]).replace("+", "") : "–");
    say(byId("power-out"), isKnown ? watts(sides[1]).replace("+", "") : "–");
    drawFlow();
    drawTerms(chosen);
  }

  /** Draws the segments from the middle outwards; gives the sums of both sides. */
  function drawBar(powers) {
    const inward = powers.map(function (power, index) { return power * TERMS[index].sense; });
    const side = function (sign) { return inward.reduce(function (sum, power) { return sum + Math.max(sign * power, 0); }, 0); };
    const sides = [side(1), side(-1)];
    rescale(Math.max(sides[0], sides[1]));
    const reached = [0, 0], room = byId("bar").clientWidth;
    const letter = 0.6 * parseFloat(getComputedStyle(TERMS[0].segment).fontSize);
    ORDER.forEach(function (index) {
      const isIn = inward[index] >= 0, which = isIn ? 0 : 1, wide = 50 * Math.abs(inward[index]) / scale;
      const segment = TERMS[index].segment, start = isIn ? 50 - reached[which] - wide : 50 + reached[which];
      segment.style.left = start + "%";
      segment.style.width = wide + "%";
      say(segment, room * wide / 100 > letter * TERMS[index].short.length + 10 ? TERMS[index].short : "");
      reached[which] += wide;
    });
    return sides;
  }

  /** A scale that grows at once and shrinks late: a bar whose scale moves cannot be read. */
  function rescale(most) {
    const wanted = Math.max(roundUp(Math.max(most, 1e-9)), 10), now = performance.now();
    if (wanted >= scale) { scale = wanted; large = now; }
    else if (most > 0.45 * scale) large = now;
    else if (now - large > PATIENCE) { scale = wanted; large = now; }
    Array.from(byId("bar-axis").children).forEach(function (tick, index) {
      const share = Math.abs(index - 2) / 2, value = share * scale;
      say(tick, scale >= 1e4 ? fixed(value * 1e-3, 1) + " kW" : fixed(value, 0) + " W");
    });
  }

  /** A row for each part: name, bar, and power. */
  function drawRows(box, rows, whole) {
    while (box.children.length > rows.length) box.lastChild.remove();
    while (box.children.length < rows.length) {
      const row = element("div", "row"), track = element("div", "track");
      track.appendChild(element("div"));
      row.append(element("span", "name"), track, element("span", "digits"));
      box.appendChild(row);
    }
    rows.forEach(function (row, index) {
      const cells = box.children[index].children, fill = cells[1].firstChild;
      say(cells[0], row[0]);
      fill.className = "fill " + row[2];
      fill.style.width = Math.min(100 * Math.abs(row[1] || 0) / whole, 100) + "%";
      say(cells[2], row[3]);
    });
  }

  function drawFlow() {
    if (!means.length) { drawRows(byId("flow"), [], 1); return; }
    const pump = mean(function (p) { return p.pump_power; });
    const rows = [["pump", pump, "supply"], ["bypass loss", mean(function (p) { return p.bypass_loss; }), "dissipation"], ["metering loss", mean(function (p) { return p.metering_loss; }), "dissipation"]];
    Object.keys(means[means.length - 1].cylinders).forEach(function (name) {
      const power = meanOf(name, "supply");
      rows.push([(power < 0 ? "from cylinder " : "into cylinder ") + name, power, power < 0 ? "supply" : "stored"]);
    });
    const whole = rows.reduce(function (most, row) { return Math.max(most, Math.abs(row[1] || 0)); }, 1e-9);
    rows.forEach(function (row, index) { row.push(fixed(times(index > 2 ? Math.abs(row[1]) : row[1], 1e-3), 2) + " kW"); });
    drawRows(byId("flow"), rows, whole);
  }

  function drawTerms(chosen) {
    const last = means.length ? means[means.length - 1].cylinders[chosen] : null;
    const rows = Object.keys((last && last.terms) || {}).map(function (effect) {
      const power = mean(function (p) { return ((p.cylinders[chosen] || {}).terms || {})[effect]; });
      return [effect.replace(/_/g, " "), power, power > 0 ? "supply" : "dissipation", signed(power, 1) + " W"];
    });
    const whole = rows.reduce(function (most, row) { return Math.max(most, Math.abs(row[1] || 0)); }, 1e-9);
    drawRows(byId("terms"), rows, whole);
  }

  return { build: build, take: take, show: show, mean: mean, clear: function () { means = []; } };
})();
