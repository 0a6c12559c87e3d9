// Small things that every part of the page needs.

function byId(id) { return document.getElementById(id); }

/** Writes a text only where it has changed: the browser lays nothing out again, and a screen reader is silent. */
function say(node, text) {
  if (node.shownText === text) return;
  node.shownText = text;
  node.textContent = text;
}

/** An element with a class and a text. Names come from the network: they become text, never markup. */
function element(tag, className, text) {
  const node = document.createElement(tag);
  if (className) node.className = className;
  if (text !== undefined) node.textContent = text;
  return node;
}

/** An element of a drawing. */
function shape(tag, attributes, text) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  reshape(node, attributes);
  if (text !== undefined) node.textContent = text;
  return node;
}

function reshape(node, attributes) {
  Object.keys(attributes).forEach(function (name) { node.setAttribute(name, attributes[name]); });
}

/** A number with a fixed count of decimals, a true minus, and no "-0.0". */
function fixed(value, decimals) {
  if (value === null || value === undefined || !isFinite(value)) return "–";
  const text = value.toFixed(decimals);
  return Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−");
}

/** The same with a sign before positive numbers too. */
function signed(value, decimals) {
  const text = fixed(value, decimals);
  return Number(text) > 0 ? "+" + text : text;
}

function times(value, factor) { return value === null || value === undefined ? null : value * factor; }

/** The smallest of 1, 2, 5, 10, 20 ... that is at least `value`. */
function roundUp(value) {
  const decade = Math.pow(10, Math.floor(Math.log10(value)));
  const step = [1, 2, 5, 10].find(function (s) { return s * decade >= value * (1 - 1e-9); });
  return (step || 10) * decade;
}

/** A colour of the style sheet, as it is now. */
function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
}

/** Time of day of a Unix time in ms, in the zone of the browser. */
function timeOfDay(milliseconds) {
  const time = new Date(milliseconds);
  return [time.getHours(), time.getMinutes(), time.getSeconds()]
    .map(function (part) { return String(part).padStart(2, "0"); }).join(":");
}

/** Units of a cylinder: a motor turns, and not every drive is commanded by an area. */
function unitsOf(scale) {
  const isMotor = Boolean(scale && scale.motor);
  const command = scale && scale.command ? scale.command : { factor: 1e6, symbol: "mm²" };
  return {
    isMotor: isMotor,
    position: isMotor ? { factor: 0.5 / Math.PI, symbol: "rev", decimals: 3 } : { factor: 1e3, symbol: "mm", decimals: 1 },
    speed: isMotor ? { factor: 30 / Math.PI, symbol: "rpm", decimals: 1 } : { factor: 1e3, symbol: "mm/s", decimals: 1 },
    command: { factor: command.factor, symbol: command.symbol, decimals: command.symbol === "V" ? 2 : 1 },
    commandName: command.symbol === "mm²" ? "orifice area" : "valve input"
  };
}
