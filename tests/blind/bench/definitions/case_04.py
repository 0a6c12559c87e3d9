"""Case 4: many short pieces that start and end in motion, valve that lags behind its command."""

from case import Case, Run, quantity
from sensors import Sensor
from tables import Style

from definitions.common import BAR, MEANINGS, MM, base_truth, signals
from definitions.servo_cylinder import Nominal, ServoCylinder

LAG_S = 0.025

MOVES = [
    ("move", 4.0, 0.8), ("move", 2.0, 0.4), ("move", 5.0, 0.15), ("move", 3.0, 0.7), ("hold", 0.1), ("move", 1.5, 0.5),
    ("sine", 3.0, 2.5, 4), ("move", 6.0, 0.9), ("move", 6.5, 0.1), ("move", 2.5, 0.55), ("move", 1.2, 0.3),
    ("multi", 3.5, 2.0, (0.8, 1.9, 4.3, 7.1)), ("move", 1.8, 0.65), ("move", 8.0, 0.2), ("hold", 0.15),
    ("move", 0.9, 0.35), ("sine", 2.0, 1.3, 3), ("move", 3.5, 0.85), ("multi", 4.0, 2.0, (0.6, 2.7, 5.9, 9.1)),
    ("move", 2.8, 0.2), ("move", 1.4, 0.6),
]
OTHER_MOVES = [
    ("move", 2.2, 0.7), ("move", 3.2, 0.3), ("sine", 3.5, 3.1, 4), ("move", 1.1, 0.6), ("move", 7.0, 0.9),
    ("move", 4.5, 0.4), ("multi", 3.0, 2.0, (0.9, 2.3, 5.1)), ("move", 5.5, 0.85), ("move", 1.7, 0.5), ("hold", 0.1),
    ("move", 2.6, 0.2),
]


def build(rng):
    bench = ServoCylinder(
        Nominal(32, 20, 150, 15.0, 100.0, 10.0, "V", 12.0, 35.0, 400.0, 150.0, dead=8.0, hose=30.0,
                leak_internal=4e-14, leak_external=5e-15), rng, lag=LAG_S)
    sensors = [
        Sensor("Piston position [mm]", "x", 1 / MM, 0.075, (0.0, 150.0), 3, 0, "mm"),
        Sensor("Cap pressure [bar]", "pa", 1 / BAR, 0.15, (0.0, 150.0), 2, 0, "bar"),
        Sensor("Rod pressure [bar]", "pb", 1 / BAR, 0.15, (0.0, 150.0), 2, 0, "bar"),
        Sensor("Valve signal [V]", "command", 1.0, 0.003, (-10.0, 10.0), 3, 0, "V"),
    ]
    style = Style("Time [s]", separator=";", decimal=",")
    answer = {
        "hidden": "valve_lag", "side": "valve",
        "coefficients": {"time_constant": quantity(LAG_S, "s")},
        "base": base_truth(bench.actuator, bench.gain_a, bench.gain_b, 10.0, "V"),
        "sentence": "The opening of the valve follows the recorded command as a first-order lag of 25 ms.",
    }
    machine = {"name": "bench cylinder 32/20, short pieces", **bench.sheet, "sampling_hz": 1000,
               "note": "Each file is a piece of 1 s out of a longer run; time starts at 0 in each. Decimal comma.",
               "signals": signals(sensors, MEANINGS, style.time_heading)}
    runs = [Run("identification", MOVES, 22.0, 0.03, pieces=12), Run("validation", OTHER_MOVES, 11.0, 0.05, pieces=6)]
    return Case("04", bench.plant, runs, sensors, style, 1000, bench.span, (2 * BAR, 120 * BAR), machine, answer)
