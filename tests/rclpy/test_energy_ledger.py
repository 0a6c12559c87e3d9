"""The energy monitor's ledger: it closes for the machine's own model, and names the equation for another's."""

import math

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from support.simulator import Simulator

AREA = 8e-5
# Sensors as good as can be bought, Pa and m: without any noise the ledger is held against nothing but its tolerance.
PRESSURE_NOISE = 2e3
DISPLACEMENT_NOISE = 5e-5
# Seconds of motion that the ledger is judged over.
WINDOW = 4.0
LEAK = """
[[effects]]
effect = "valve_leakage"
at = "arm"
[effects.parameters]
""" + "".join(
    f'valve_leakage_{path} = {{ value = 2e-11, unit = "m3/(s Pa)" }}\n'
    for path in ("pump_cap", "cap_tank", "pump_rod", "rod_tank")
)


def judged(ros, diagnostics):
    """The first judgement of the ledger over a window in which the arm moved all the time."""

    def windows():
        return [
            status
            for message in diagnostics
            for status in message.status
            if status.name.endswith("ledger") and number(status, "windows judged") >= 2
        ]

    ros.spin_until(windows, "the second window of the ledger", 10.0)
    return windows()[0]


def value(status, key):
    return next((entry.value for entry in status.values if entry.key == key), None)


def number(status, key):
    found = value(status, key)
    return math.nan if found is None else float(found)


def swing(simulator, duration):
    """Out and back in a sine of half a hertz, in steps of the command's renewal."""
    steps = 40
    for step in range(int(duration * steps / 2)):
        simulator.hold(2.0 / steps, arm=AREA * math.sin(2.0 * math.pi * step / steps))


@pytest.fixture
def monitor(ros, excavator, model):
    process = ros.start(
        excavator, "node", "energy-monitor", "--ros-args", "-p", f"model:={model}", "-p", f"ledger_window:={WINDOW}"
    )
    yield process
    process.terminate()


def status_after_swinging(ros, excavator, model):
    noise = ["-p", f"pressure_noise:={PRESSURE_NOISE}", "-p", f"displacement_noise:={DISPLACEMENT_NOISE}"]
    simulator = Simulator(ros, excavator, arguments=["-p", f"model:={model}", *noise])
    diagnostics = ros.listen(DiagnosticArray, "/diagnostics")
    try:
        swing(simulator, 2.5 * WINDOW)
        return judged(ros, diagnostics)
    finally:
        simulator.process.terminate()


def test_the_ledger_of_the_machines_own_model_closes(ros, excavator, model, monitor):
    status = status_after_swinging(ros, excavator, model)
    assert status.level == DiagnosticStatus.OK, status.message


def test_a_leaking_valve_is_missed_at_the_chambers(ros, excavator, model, monitor, tmp_path):
    leaking = tmp_path / "leaking.toml"
    leaking.write_text(model.read_text() + LEAK)
    status = status_after_swinging(ros, excavator, leaking)
    assert status.level == DiagnosticStatus.WARN
    places = [value(status, "equation")] + (value(status, "also at") or "").split(", ")
    assert value(status, "cylinder") == "arm" and value(status, "equation").endswith("_continuity"), status
    assert {"arm.cap_continuity", "arm.rod_continuity"} <= set(places)
    assert "arm cylinder" in status.message and " W " in status.message
    missing, noise = (number(status, f"{what} [W]") for what in ("missing power, root mean square", "explained by noise"))
    assert missing > 2.0 * noise
