"""The energy monitor's ledger: it closes for the machine's own model, and names the equation for another's."""

import math
from contextlib import contextmanager

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from support.simulator import RENEWAL, Simulator, command

AREA = 8e-5
# Sensors as good as can be bought, Pa and m: without any noise the ledger is held against nothing but its tolerance.
PRESSURE_NOISE = 2e3
DISPLACEMENT_NOISE = 5e-5
# Seconds of motion that the ledger is judged over: the least that the monitor takes, and what shows a leak.
SHORT, LONG = 2.0, 4.0
LEAK = """
[[effects]]
effect = "valve_leakage"
at = "arm"
[effects.parameters]
""" + "".join(
    f'valve_leakage_{path} = {{ value = 2e-11, unit = "m3/(s Pa)" }}\n'
    for path in ("pump_cap", "cap_tank", "pump_rod", "rod_tank")
)


def judged(diagnostics):
    """The judgements of the ledger over windows in which the arm moved all the time: the second and later ones."""
    return [
        status
        for message in diagnostics
        for status in message.status
        if status.name.endswith("ledger") and number(status, "windows judged") >= 2
    ]


def value(status, key):
    return next((entry.value for entry in status.values if entry.key == key), None)


def number(status, key):
    found = value(status, key)
    return math.nan if found is None else float(found)


@contextmanager
def swinging(ros, simulator):
    """Out and back in a sine of half a hertz of the machine's time, in steps of the command's renewal."""
    start = simulator.time
    timer = ros.node.create_timer(
        RENEWAL, lambda: simulator.send(command(arm=AREA * math.sin(math.pi * (simulator.time - start))))
    )
    try:
        yield
    finally:
        ros.node.destroy_timer(timer)


def start_monitor(ros, excavator, model, window):
    words = ["--ros-args", "-p", f"model:={model}", "-p", f"ledger_window:={window}"]
    ros.start(excavator, "node", "energy-monitor", *words)


def status_while_swinging(ros, excavator, model, wanted, what):
    """The first judgement that is wanted."""
    noise = ["-p", f"pressure_noise:={PRESSURE_NOISE}", "-p", f"displacement_noise:={DISPLACEMENT_NOISE}"]
    simulator = Simulator(ros, excavator, arguments=["-p", f"model:={model}", *noise])
    diagnostics = ros.listen(DiagnosticArray, "/diagnostics")
    with swinging(ros, simulator):
        ros.spin_until(lambda: any(map(wanted, judged(diagnostics))), what)
    return next(filter(wanted, judged(diagnostics)))


def test_the_ledger_of_the_machines_own_model_closes(ros, excavator, model):
    start_monitor(ros, excavator, model, SHORT)
    status = status_while_swinging(ros, excavator, model, lambda _: True, "the second window of the ledger")
    assert status.level == DiagnosticStatus.OK, status.message


@pytest.mark.full
def test_a_leaking_valve_is_missed_at_the_chambers(ros, excavator, model, tmp_path):
    start_monitor(ros, excavator, model, LONG)
    leaking = tmp_path / "leaking.toml"
    leaking.write_text(model.read_text() + LEAK)

    def names_both_chambers(status):
        places = [value(status, "equation")] + (value(status, "also at") or "").split(", ")
        return status.level == DiagnosticStatus.WARN and {"arm.cap_continuity", "arm.rod_continuity"} <= set(places)

    status = status_while_swinging(ros, excavator, leaking, names_both_chambers, "a warning that names both chambers")
    assert value(status, "cylinder") == "arm" and value(status, "equation").endswith("_continuity"), status
    assert "arm cylinder" in status.message and " W " in status.message
    missing, noise = (number(status, f"{what} [W]") for what in ("missing power, root mean square", "explained by noise"))
    assert missing > 2.0 * noise
