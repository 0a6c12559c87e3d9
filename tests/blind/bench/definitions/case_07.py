"""Case 7: hydraulic motor with gear and flywheel, valve with a dead zone."""

from case import Case, Run, quantity
from sensors import Sensor
from tables import Style

from definitions.common import BAR, DEG, RPM, base_truth, signals
from definitions.servo_motor import NominalMotor, ServoMotor

MEANINGS = {
    "x": "angle of the output shaft, counted on over full turns", "v": "speed of the output shaft",
    "pa": "pressure at port A", "pb": "pressure at port B",
    "command": "valve command, positive opens P to A and turns the shaft forward",
}
IDENTIFICATION = [
    ("hold", 0.4), ("set", 2.0, 1.0), ("hold", 0.4), ("set", -1.5, 0.8), ("set", -4.0, 0.7), ("hold", 0.5),
    ("set", 5.5, 0.8), ("set", 1.0, 0.6), ("sine", 3.0, 1.0, 2), ("hold", 0.3), ("set", -7.0, 0.8), ("set", -1.0, 0.5),
    ("multi", 4.0, 2.0, (0.6, 1.4, 3.1, 5.3)), ("set", 8.5, 0.6), ("set", 3.0, 0.6), ("hold", 0.6), ("set", -2.5, 0.6),
]
VALIDATION = [
    ("hold", 0.3), ("set", 3.5, 0.7), ("set", -2.2, 0.8), ("hold", 0.4), ("set", 1.4, 0.6), ("set", 6.5, 0.6),
    ("multi", 3.5, 1.6, (0.8, 1.9, 4.2)), ("set", -5.0, 0.7), ("set", -1.2, 0.5), ("hold", 0.4), ("sine", 2.5, 1.6, 2),
    ("set", 2.0, 1.0),
]


def build(rng):
    drive = ServoMotor(
        NominalMotor(50.0, 10.0, 40.0, 0.0, 120.0, 10.0, "V", 20.0, 35.0, 25.0, 45.0, 125.0), rng, overlap=(0.07, 0.05))
    sensors = [
        Sensor("Angle [deg]", "x", DEG, 0.05, None, 2, 0, "deg"),
        Sensor("Speed [rpm]", "v", RPM, 0.06, (-100.0, 100.0), 2, 0, "rpm"),
        Sensor("pA [MPa]", "pa", 1e-6, 0.024, (0.0, 16.0), 3, 0, "MPa"),
        Sensor("pB [MPa]", "pb", 1e-6, 0.024, (0.0, 16.0), 3, 0, "MPa"),
        Sensor("Command [V]", "command", 1.0, 0.003, (-10.0, 10.0), 3, 0, "V"),
    ]
    style = Style("t [s]", separator=", ")
    answer = {
        "hidden": "valve_dead_zone", "side": "valve, both directions",
        "coefficients": {
            "positive": quantity(0.05 * 10.0, "V", "5 % of the full command"),
            "negative": quantity(0.07 * 10.0, "V", "7 % of the full command"),
        },
        "base": base_truth(drive.actuator, drive.gain_a, drive.gain_b, 10.0, "V"),
        "sentence": "The valve opens only beyond +0.5 V and below -0.7 V; outside, the opening is the command less this "
                    "dead zone. Side A is named cap here.",
    }
    answer["base"]["motor_displacement"] = quantity(drive.displacement, "m3/rev")
    machine = {"name": "motor with flywheel", **drive.sheet, "orientation": "no constant load", "sampling_hz": 250,
               "signals": signals(sensors, MEANINGS, style.time_heading)}
    slopes = (0.1, 0.25, 0.5)
    runs = [Run("identification", IDENTIFICATION, 12.0, 0.0, slopes), Run("validation", VALIDATION, 8.0, 0.0, slopes)]
    return Case("07", drive.plant, runs, sensors, style, 250, (-60.0, 60.0), (3 * BAR, 130 * BAR), machine, answer)
