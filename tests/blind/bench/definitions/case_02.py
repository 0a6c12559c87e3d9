"""Case 2: bench cylinder driven onto both stops, friction larger when extending."""

from case import Case, Run, quantity
from sensors import Sensor
from tables import Style

from definitions.common import BAR, MEANINGS, MM, base_truth, signals
from definitions.servo_cylinder import Nominal, ServoCylinder

IDENTIFICATION = [
    ("hold", 0.2), ("move", 3.0, 0.92), ("set", 3.0, 1.0), ("move", 4.0, 0.5), ("hold", 0.15), ("move", 2.0, 0.3),
    ("move", 4.0, 0.08), ("set", -3.0, 0.9), ("move", 3.5, 0.45), ("sine", 2.5, 2.0, 2), ("move", 1.4, 0.55),
    ("move", 4.0, 0.92), ("set", 2.0, 1.0), ("move", 5.0, 0.6), ("multi", 4.0, 1.0, (0.9, 2.1, 4.7, 8.0)),
    ("move", 3.5, 0.08), ("set", -4.0, 0.9), ("move", 5.0, 0.7), ("hold", 0.1), ("move", 2.5, 0.4),
]
VALIDATION = [
    ("hold", 0.2), ("move", 3.0, 0.08), ("set", -3.0, 1.0), ("move", 3.5, 0.92), ("set", 3.5, 1.1), ("move", 3.5, 0.4),
    ("hold", 0.2), ("sine", 3.0, 2.5, 2), ("move", 1.6, 0.5), ("move", 3.5, 0.08), ("set", -2.5, 0.6), ("move", 4.0, 0.6),
]


def build(rng):
    bench = ServoCylinder(
        Nominal(25, 16, 200, 20.0, 100.0, 10.0, "V", 10.0, 35.0, 350.0, 300.0, dead=6.0, hose=25.0,
                leak_internal=3e-14, leak_external=4e-15, friction={"extending": 1.6}, stop_gap=3.0), rng)
    sensors = [
        Sensor("x_mm", "x", 1 / MM, 0.1, (0.0, 200.0), 2, 0, "mm"),
        Sensor("pA_bar", "pa", 1 / BAR, 0.24, (0.0, 160.0), 2, 0, "bar"),
        Sensor("pB_bar", "pb", 1 / BAR, 0.24, (0.0, 160.0), 2, 0, "bar"),
        Sensor("u_V", "command", 1.0, 0.003, (-10.0, 10.0), 3, 0, "V"),
    ]
    style = Style("t_s", time_digits=4)
    coulomb = bench.actuator.friction.coulomb
    answer = {
        "hidden": "asymmetric_friction", "side": "cylinder, larger when extending",
        "coefficients": {
            "coulomb_extending": quantity(1.6 * coulomb, "N"),
            "coulomb_retracting": quantity(coulomb, "N"),
            "half_difference": quantity(0.3 * coulomb, "N", "half of extending less retracting"),
            "mean_level": quantity(1.3 * coulomb, "N"),
        },
        "base": base_truth(bench.actuator, bench.gain_a, bench.gain_b, 10.0, "V"),
        "sentence": "Coulomb friction is 60 % larger when extending than when retracting; the base value is that of "
                    "retracting. The real stops are 3 mm inside the stated ones.",
    }
    machine = {"name": "bench cylinder 25/16", **bench.sheet, "sampling_hz": 400,
               "signals": signals(sensors, MEANINGS, style.time_heading)}
    runs = [Run("identification", IDENTIFICATION, 12.0, 0.06), Run("validation", VALIDATION, 8.0, 0.12)]
    return Case("02", bench.plant, runs, sensors, style, 400, bench.span, (-1.0 * BAR, 140 * BAR), machine, answer)
