// The page: frames come in, and its parts show the newest.

/** What the machine is: asked for again whenever a frame says that it has changed. */
const store = (function () {
  let cylinders = {}, version = null, isAsking = false;
  function load(wanted, then) {
    if (wanted === version || isAsking) return;
    isAsking = true;
    fetch("/machine").then(function (reply) { return reply.json(); }).then(function (machine) {
      version = machine.version;
      cylinders = machine.cylinders || {};
      picture.load(machine.description);
      then();
    }).catch(function () {}).then(function () { isAsking = false; });
  }
  return { load: load, scale: function (name) { return cylinders[name]; }, forget: function () { version = null; } };
})();

let chosen = null, first = null, latest = null, number = 0, lastNumber = null, missed = 0, isLive = false, heardAt = 0;
const rates = [];
const TEXT_PACE = 200, LOST = 3000, LATE = 50;

function take(frame, live) {
  number += 1;
  // The stream may be a little behind the history, which comes on another connection.
  if (live && lastNumber !== null && frame.number <= lastNumber && frame.number > lastNumber - LATE) return;
  if (lastNumber !== null && frame.number > lastNumber + 1) missed += frame.number - lastNumber - 1;
  // A server that began anew counts anew.
  if (lastNumber !== null && frame.number < lastNumber) { clear(); store.forget(); }
  lastNumber = frame.number;
  latest = frame;
  if (live) alarmsAndRates(frame);
  choose(Object.keys(frame.cylinders || {}));
  energy.take(frame);
  if (frame.stamp === null || frame.stamp === undefined || chosen === null) return;
  if (first === null || frame.stamp < first) { clear(); first = frame.stamp; }
  plots.take(frame.stamp - first, frame, frame.cylinders[chosen] || {}, (frame.powers && frame.powers.cylinders[chosen]) || {});
}

function alarmsAndRates(frame) {
  heardAt = performance.now();
  alarms.take(frame);
  rates.push([heardAt, frame.states, frame.balances]);
  if (rates.length > 50) rates.shift();
}

function clear() { plots.clear(); energy.clear(); first = null; }

function choose(names) {
  const select = byId("cylinder");
  const known = Array.from(select.options).map(function (option) { return option.value; });
  if (names.length && names.join("\n") !== known.join("\n")) {
    select.replaceChildren.apply(select, names.map(function (name) { return element("option", "", name); }));
    if (chosen !== null) select.value = chosen;
  }
  if (names.length && names.indexOf(chosen) < 0) change(names[0]);
}

function change(name) {
  chosen = name;
  byId("cylinder").value = name;
  document.querySelectorAll(".chosen-name").forEach(function (node) { say(node, name); });
  picture.choose(name);
  plots.build(unitsOf(store.scale(name)));
}

/** Takes the last half minute of the server. */
function reload() {
  return fetch("/history").then(function (reply) { return reply.json(); }).then(function (frames) {
    clear();
    lastNumber = null;
    // Alarms of before are known where the page was open.
    frames.forEach(function (frame) { take(frame, false); if (!isLive) alarms.take(frame); });
    redraw();
  }).catch(function () {});
}

/** Whether no frames come. */
function isCut() { return !isLive || performance.now() - heardAt > LOST; }

/** Why the values are not those of now, or nothing. */
function lostBecause() {
  if (!isLive) return "no connection to the dashboard's server";
  if (isCut()) return "the dashboard's server is silent";
  if (!latest || latest.state_age === null) return "no state was received on arm/state";
  return latest.state_age > 2 ? "last state " + fixed(latest.state_age, 0) + " s ago" : "";
}

let written = 0;
function redraw() {
  if (!latest) return;
  picture.draw(latest, chosen);
  plots.show();
  if (performance.now() - written < TEXT_PACE) return;
  written = performance.now();
  write();
}

/** Everything in words and digits. */
function write() {
  const lost = lostBecause();
  document.body.classList.toggle("stale", lost !== "");
  say(byId("clock"), timeOfDay(Date.now()));
  if (!latest) return;
  store.load(latest.machine, function () { say(byId("name"), picture.name() || "excavator"); if (chosen !== null) reload().then(function () { change(chosen); }); });
  commands.show(latest, chosen, lost, isCut());
  values.show(latest, chosen);
  energy.show(chosen);
  alarms.show();
  say(byId("joints"), chosen === null ? "" : picture.note(chosen));
  writeRates();
}

function writeRates() {
  const a = rates[0], b = rates[rates.length - 1];
  if (!a || b[0] <= a[0]) return;
  const rate = function (index) { return Math.round((b[index] - a[index]) / (b[0] - a[0]) * 1e3); };
  say(byId("rate"), rate(1) + " states/s · " + rate(2) + " balances/s" + (missed ? " · " + missed + " frames skipped" : ""));
}

function connect() {
  const stream = new EventSource("/stream");
  let isWaiting = false;
  function link(text, kind) { say(byId("link"), text); byId("link").className = "chip " + kind; }
  stream.onopen = function () { isLive = true; heardAt = performance.now(); link("connected", "live"); };
  stream.onerror = function () { isLive = false; link("no connection", "lost"); };
  stream.onmessage = function (event) {
    take(JSON.parse(event.data), true);
    if (isWaiting) return;
    isWaiting = true;
    requestAnimationFrame(function () { isWaiting = false; redraw(); });
  };
}

/** The colours of the system, or those that were chosen here. */
const theme = (function () {
  const dark = window.matchMedia("(prefers-color-scheme: dark)"), root = document.documentElement;
  function now() { return root.getAttribute("data-theme") || (dark.matches ? "dark" : "light"); }
  function show() {
    const other = now() === "dark" ? "light" : "dark";
    say(byId("theme"), other + " colours");
    plots.build();
  }
  function start() {
    // Without storage the choice lasts as long as the page.
    try { const kept = localStorage.getItem("theme"); if (kept === "dark" || kept === "light") root.setAttribute("data-theme", kept); } catch (refused) { /* nothing is lost */ }
    dark.addEventListener("change", show);
    byId("theme").addEventListener("click", function () {
      root.setAttribute("data-theme", now() === "dark" ? "light" : "dark");
      try { localStorage.setItem("theme", now()); } catch (refused) { /* nothing is lost */ }
      show();
    });
    show();
  }
  return { start: start, now: now };
})();

values.build();
energy.build();
theme.start();
byId("cylinder").addEventListener("change", function () { change(this.value); reload(); });
window.addEventListener("resize", plots.fit);
// Time goes on where no frame comes: what is shown must not look like now.
setInterval(write, 1000);
reload().then(connect);
// For whoever watches the watcher.
window.dashboard = {
  frames: function () { return number; }, points: plots.points, last: plots.last,
  alarms: alarms.list, theme: theme.now
};
