"""Case 1: small servo bench, valve with a dead zone."""

from case import Case, Run, quantity
from sensors import Sensor
from tables import Style

from definitions.common import BAR, MEANINGS, MM, base_truth, signals
from definitions.servo_cylinder import Nominal, ServoCylinder

IDENTIFICATION = [
    ("hold", 0.3), ("move", 1.2, 0.7), ("hold", 0.25), ("move", 0.8, 0.2), ("move", 2.0, 0.8), ("hold", 0.15),
    ("move", 1.5, 0.15), ("move", 3.5, 0.85), ("move", 3.0, 0.3), ("sine", 1.6, 2.0, 3), ("hold", 0.2),
    ("move", 0.6, 0.65), ("multi", 2.2, 2.0, (0.7, 1.9, 4.1, 7.3, 11.0)), ("move", 4.5, 0.9), ("move", 4.5, 0.1),
    ("hold", 0.2), ("move", 1.0, 0.6), ("move", 0.7, 0.3), ("sine", 0.9, 1.0, 1),
]
VALIDATION = [
    ("hold", 0.2), ("move", 0.9, 0.3), ("move", 1.8, 0.75), ("hold", 0.3), ("move", 2.6, 0.2), ("sine", 2.0, 3.0, 4),
    ("hold", 0.15), ("move", 0.7, 0.5), ("multi", 1.6, 1.6, (0.9, 2.3, 5.2)), ("move", 3.8, 0.9), ("move", 1.3, 0.3),
]


def build(rng):
    bench = ServoCylinder(
        Nominal(16, 10, 100, 5.0, 70.0, 5.0, "V", 4.0, 35.0, 120.0, 45.0), rng, overlap=(0.08, 0.06))
    sensors = [
        Sensor("Position [mm]", "x", 1 / MM, 0.05, (0.0, 100.0), 3, 12, "mm"),
        Sensor("Pressure A [bar]", "pa", 1 / BAR, 0.1, (0.0, 100.0), 3, 12, "bar"),
        Sensor("Pressure B [bar]", "pb", 1 / BAR, 0.1, (0.0, 100.0), 3, 12, "bar"),
        Sensor("Valve command [V]", "command", 1.0, 0.002, (-10.0, 10.0), 3, 12, "V"),
    ]
    style = Style("Time [s]", separator=";")
    answer = {
        "hidden": "valve_dead_zone", "side": "valve, both directions",
        "coefficients": {
            "positive": quantity(0.06 * 5.0, "V", "6 % of the full command"),
            "negative": quantity(0.08 * 5.0, "V", "8 % of the full command"),
        },
        "base": base_truth(bench.actuator, bench.gain_a, bench.gain_b, 5.0, "V"),
        "sentence": "The valve opens only beyond +0.30 V and below -0.40 V; outside, the opening is the command less "
                    "this dead zone, with the slope of the data sheet.",
    }
    machine = {"name": "servo bench 16/10", **bench.sheet, "sampling_hz": 500,
               "signals": signals(sensors, MEANINGS, style.time_heading)}
    runs = [Run("identification", IDENTIFICATION, 10.0, 0.03), Run("validation", VALIDATION, 7.0, 0.05)]
    return Case("01", bench.plant, runs, sensors, style, 500, bench.span, (1 * BAR, 80 * BAR), machine, answer)
