// The large values of the chosen cylinder. They are written five times per second: faster digits cannot be read.

const values = (function () {
  const MPA = { factor: 1e-6, symbol: "MPa", decimals: 2 };
  // Name on the page, value in a frame, its unit, and a line below.
  const TILES = [
    { label: "displacement", of: function (f, c) { return c.displacement; }, unit: function (u) { return u.position; } },
    { label: "velocity", of: function (f, c) { return c.velocity; }, unit: function (u) { return u.speed; } },
    { label: "orifice area", of: function (f, c) { return c.orifice_area; }, unit: function (u) { return u.command; }, below: command, name: function (u) { return u.commandName; } },
    { label: "cap pressure", mark: "orange", of: function (f, c) { return c.cap_pressure; }, unit: MPA },
    { label: "rod pressure", mark: "pink", of: function (f, c) { return c.rod_pressure; }, unit: MPA },
    { label: "pump pressure", mark: "blue", of: function (f) { return f.pump_pressure; }, unit: MPA },
    { label: "pump power", of: function () { return energy.mean(function (p) { return p.pump_power; }); }, unit: { factor: 1e-3, symbol: "kW", decimals: 2 }, below: function () { return "mean over 2 s"; } },
    { label: "stored energy H", of: function (f, c, e) { return e.hamiltonian; }, unit: { factor: 1, symbol: "J", decimals: 0 } },
    { label: "oil temperature", of: function (f) { return f.oil_temperature; }, unit: { factor: 1, symbol: "°C", decimals: 0 } }
  ];

  function command(frame, cylinder, units) {
    const text = "command " + fixed(times(cylinder.command, units.command.factor), units.command.decimals) + " " + units.command.symbol;
    return cylinder.command !== null && frame.command_age > 1 ? text + ", " + fixed(frame.command_age, 0) + " s old" : text;
  }

  function build() {
    TILES.forEach(function (tile) {
      const box = element("div", "tile"), big = element("div", "big");
      box.setAttribute("role", "group");
      tile.head = element("div", "label" + (tile.mark ? " mark " + tile.mark : ""), tile.label);
      tile.number = element("span", "number", "–"); tile.symbol = element("span", "unit"); tile.small = element("div", "below");
      box.setAttribute("aria-label", tile.label);
      big.append(tile.number, tile.symbol);
      box.append(tile.head, big, tile.small);
      byId("values").appendChild(box);
    });
  }

  function show(frame, chosen) {
    const cylinder = frame.cylinders[chosen] || {}, units = unitsOf(store.scale(chosen));
    const own = (frame.powers && frame.powers.cylinders[chosen]) || {};
    TILES.forEach(function (tile) {
      const unit = typeof tile.unit === "function" ? tile.unit(units) : tile.unit, value = tile.of(frame, cylinder, own);
      say(tile.number, fixed(times(value, unit.factor), unit.decimals));
      say(tile.symbol, unit.symbol);
      say(tile.small, tile.below ? tile.below(frame, cylinder, units) : "");
      if (tile.name) say(tile.head, tile.name(units));
    });
  }

  return { build: build, show: show };
})();
