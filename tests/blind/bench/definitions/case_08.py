"""Case 8: winch with a hanging mass, without a hidden effect."""

from case import Case, Run, quantity
from sensors import Sensor
from tables import Style

from definitions.common import BAR, DEG, G, RPM, base_truth, signals
from definitions.servo_motor import NominalMotor, ServoMotor

MEANINGS = {
    "x": "angle of the drum, positive when hoisting", "v": "speed of the drum, positive when hoisting",
    "pa": "pressure at port A (hoisting)", "pb": "pressure at port B (lowering)",
    "command": "valve command, positive opens P to A and hoists",
}
HUNG_KG, RADIUS_M = 500.0, 0.15
IDENTIFICATION = [
    ("hold", 0.4), ("move", 3.5, 0.6), ("hold", 0.3), ("move", 2.0, 0.5), ("move", 6.0, 0.75), ("hold", 0.2),
    ("move", 6.5, 0.35), ("sine", 3.0, 1.0, 1), ("move", 1.2, 0.4), ("move", 8.0, 0.75), ("move", 4.5, 0.55),
    ("multi", 4.0, 2.0, (0.6, 1.4, 3.1, 5.3)), ("hold", 0.3), ("move", 7.0, 0.25), ("move", 3.0, 0.6),
]
VALIDATION = [
    ("hold", 0.3), ("move", 3.5, 0.35), ("move", 2.0, 0.5), ("hold", 0.4), ("move", 6.0, 0.8),
    ("multi", 3.5, 1.6, (0.8, 1.9, 4.2)), ("move", 1.3, 0.7), ("sine", 2.5, 1.6, 2), ("move", 4.5, 0.3),
]


def build(rng):
    drive = ServoMotor(
        NominalMotor(100.0, 20.0, 12.0 + HUNG_KG * RADIUS_M**2, HUNG_KG * G * RADIUS_M, 150.0, 10.0, "V", 40.0, 35.0,
                     40.0, 70.0, 200.0, leak_internal=3.0e-12, leak_external=4.0e-14), rng)
    sensors = [
        Sensor("DRUM_ANGLE(deg)", "x", DEG, 0.05, None, 2, 0, "deg"),
        Sensor("DRUM_SPEED(rpm)", "v", RPM, 0.03, (-50.0, 50.0), 3, 0, "rpm"),
        Sensor("P_A(bar)", "pa", 1 / BAR, 0.25, (0.0, 200.0), 2, 0, "bar"),
        Sensor("P_B(bar)", "pb", 1 / BAR, 0.25, (0.0, 200.0), 2, 0, "bar"),
        Sensor("U(V)", "command", 1.0, 0.003, (-10.0, 10.0), 3, 0, "V"),
    ]
    style = Style("TIME(ms)", 1000.0, 0, separator=";")
    answer = {
        "hidden": "nothing", "side": "none", "coefficients": {},
        "base": base_truth(drive.actuator, drive.gain_a, drive.gain_b, 10.0, "V"),
        "sentence": "The winch is as the base model says; the hanging mass is a constant torque on the drum and part of "
                    "the inertia. Side A is named cap here.",
    }
    answer["base"]["motor_displacement"] = quantity(drive.displacement, "m3/rev")
    machine = {"name": "winch", **drive.sheet, "orientation": "hanging load",
               "hanging_mass_kg": HUNG_KG, "drum_radius_m": RADIUS_M,
               "load_torque_note": "hanging mass times g times radius on the drum, against hoisting; the nominal "
                                   "inertia includes the hanging mass",
               "sampling_hz": 250, "signals": signals(sensors, MEANINGS, style.time_heading)}
    slopes = (0.02, 0.08, 0.2)
    runs = [Run("identification", IDENTIFICATION, 12.0, 1.0, slopes), Run("validation", VALIDATION, 8.0, 2.0, slopes)]
    return Case("08", drive.plant, runs, sensors, style, 250, (-1.0, 4.0), (3 * BAR, 165 * BAR), machine, answer)
