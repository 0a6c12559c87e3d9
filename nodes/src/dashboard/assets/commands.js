// Who commands the valves, which are closed and why, and whether the machine is stopped: what the command gates report.

const commands = (function () {
  let shown = "";

  /** [kind, word, reason] of the whole machine. */
  function situation(frame, chosen, lost, isCut) {
    const gates = frame.gates || [], stopping = gates.find(function (gate) { return gate.stopped_by; });
    // A gate speaks of a stop also where no state is published.
    if (stopping && !isCut) return ["stopped", "STOPPED", "by " + stopping.stopped_by];
    if (lost) return ["unknown", "NO DATA", lost];
    if (!gates.length) return ["unknown", "UNKNOWN", "no node reports who commands the valves"];
    const all = valvesOf(frame), own = all.find(function (valve) { return valve.name === chosen; });
    if (own && own.closed_because) return ["closed", "VALVE CLOSED", "it opens again after a command of 0"];
    const owned = all.filter(function (valve) { return valve.commanded_by; });
    if (!owned.length) return ["idle", "NO COMMAND", "valves are closed"];
    return ["commanded", "COMMANDED", owned.length + " of " + all.length + (all.length === 1 ? " valve" : " valves")];
  }

  /** All valves; of two gates that know the same valve, the one that has an owner for it. */
  function valvesOf(frame) {
    const found = new Map();
    (frame.gates || []).forEach(function (gate) {
      Object.keys(gate.valves).forEach(function (name) {
        const known = found.get(name);
        if (!known || !known.commanded_by) found.set(name, Object.assign({ name: name }, gate.valves[name]));
      });
    });
    return Array.from(found.values());
  }

  function show(frame, chosen, lost, isCut) {
    const now = situation(frame, chosen, lost, isCut), valves = valvesOf(frame);
    const own = valves.find(function (valve) { return valve.name === chosen; });
    byId("state").className = now[0];
    say(byId("state-word"), now[1]);
    say(byId("state-why"), now[2]);
    say(byId("valve-name"), (chosen || "") + " valve");
    say(byId("valve-owner"), !own || lost ? "–" : own.commanded_by ? "commanded by " + own.commanded_by : own.closed_because ? "closed because " + own.closed_because : "commanded by nobody");
    say(byId("valve-age"), own && own.age !== null && !lost ? "last command " + fixed(own.age, 2) + " s old" : "");
    fill(valves);
  }

  function fill(valves) {
    const key = JSON.stringify(valves);
    if (key === shown) return;
    shown = key;
    byId("valves").replaceChildren.apply(byId("valves"), valves.map(function (valve) {
      const row = element("tr");
      row.append(element("th", "", valve.name), element("td", "", valve.commanded_by || "–"), element("td", "digits", fixed(valve.age, 3)), element("td", "", valve.closed_because || "–"));
      row.firstChild.scope = "row";
      return row;
    }));
  }

  return { show: show };
})();
