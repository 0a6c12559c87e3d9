// The last alarms: when each came, and for how long it was there.

const alarms = (function () {
  const KEPT = 10, AGAIN = 10000, MOST_VALUES = 4;
  let log = [], isFirst = true, drawn = "", newest = 0;

  /** The same alarm with other numbers in its text is the same alarm. */
  function keyOf(alarm) { return alarm.part + "\n" + alarm.message.replace(/\d+(\.\d+)?/g, "#"); }

  function take(frame) {
    const now = frame.time, present = new Set();
    // The half minute that was taken already. A clock that was set back by more is no reason to miss alarms.
    if (now <= newest && now > newest - 60000) return;
    newest = now;
    (frame.alarms || []).forEach(function (alarm) {
      const key = keyOf(alarm);
      present.add(key);
      const known = log.find(function (entry) { return entry.key === key && (entry.end === null || now - entry.end < AGAIN); });
      if (known) renew(known, alarm); else open(key, alarm, frame);
    });
    log.forEach(function (entry) { if (entry.end === null && !present.has(entry.key)) entry.end = now; });
    isFirst = false;
    while (log.length > KEPT) drop();
  }

  function open(key, alarm, frame) {
    say(byId("announced"), alarm.part + ": " + alarm.message);
    // Whoever opens the page late does not know since when.
    log.unshift({ key: key, alarm: alarm, start: frame.time, isEarlier: isFirst && frame.number > 1, end: null, count: 1 });
  }

  /** An alarm that comes and goes is one line with a count. */
  function renew(entry, alarm) {
    if (entry.end !== null) { entry.end = null; entry.count += 1; }
    entry.alarm = alarm;
  }

  /** Makes room: what is over goes first, the oldest of it. */
  function drop() {
    const over = log.map(function (entry) { return entry.end !== null; }).lastIndexOf(true);
    log.splice(over < 0 ? log.length - 1 : over, 1);
  }

  function textOf(entry) {
    if (entry.end === null) return "active";
    const seconds = Math.max((entry.end - entry.start) / 1000, 0);
    return "cleared after " + (seconds < 9.95 ? fixed(seconds, 1) : fixed(seconds, 0)) + " s";
  }

  function lineOf(entry) {
    const alarm = entry.alarm, line = element("li", "alarm " + (entry.end !== null ? "over" : alarm.level > 1 ? "error" : "warning"));
    const level = alarm.level > 2 ? "stale" : alarm.level > 1 ? "error" : "warning";
    const when = (entry.isEarlier ? "before " : "") + timeOfDay(entry.start), how = textOf(entry) + (entry.count > 1 ? ", " + entry.count + " times" : "");
    line.append(element("b", "when", when + " " + level + ", " + how), element("span", "message", alarm.part + ": " + alarm.message));
    const more = Object.keys(alarm.values || {}).slice(0, MOST_VALUES).map(function (name) { return name + ": " + alarm.values[name]; }).join(" · ");
    if (more && entry.end === null) line.appendChild(element("small", "", more));
    return line;
  }

  function show() {
    const sorted = log.slice().sort(function (a, b) { return (a.end !== null) - (b.end !== null) || b.start - a.start; });
    const key = JSON.stringify(sorted.map(function (entry) { return [entry.key, entry.end, entry.count, entry.alarm.level, entry.alarm.message, entry.alarm.values]; }));
    if (key === drawn) return;
    drawn = key;
    const lines = sorted.length ? sorted.map(lineOf) : [element("li", "none", "no alarm since this page was opened")];
    byId("alarms").replaceChildren.apply(byId("alarms"), lines);
  }

  return { take: take, show: show, list: function () { return log.slice(); } };
})();
