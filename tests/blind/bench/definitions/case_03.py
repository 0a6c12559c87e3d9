"""Case 3: vertical cylinder at two supply pressures, seal friction that grows with pressure, lost cells."""

from case import Case, Run, quantity
from sensors import Sensor
from tables import Style

from definitions.common import BAR, MEANINGS, MM, base_truth, signals
from definitions.servo_cylinder import Nominal, ServoCylinder

COEFFICIENT_M2 = 3.5e-5

FIRST = [
    ("hold", 0.3), ("move", 3.0, 0.8), ("hold", 0.3), ("move", 2.0, 0.5), ("move", 5.0, 0.15), ("move", 1.2, 0.35),
    ("hold", 0.2), ("sine", 3.0, 1.5, 3), ("move", 6.5, 0.9), ("move", 4.0, 0.3), ("move", 1.5, 0.5),
]
SECOND = [
    ("hold", 0.2), ("move", 2.0, 0.3), ("move", 4.5, 0.85), ("hold", 0.25), ("move", 1.3, 0.65),
    ("multi", 4.0, 1.8, (0.7, 1.7, 3.7, 6.1)), ("move", 6.5, 0.1), ("hold", 0.2), ("move", 3.0, 0.6), ("move", 2.2, 0.3),
]
VALIDATION = [
    ("hold", 0.25), ("move", 2.4, 0.75), ("move", 3.4, 0.25), ("hold", 0.3), ("multi", 3.5, 1.5, (0.8, 2.2, 4.9)),
    ("move", 5.5, 0.85), ("move", 1.6, 0.6), ("sine", 2.5, 2.0, 2), ("move", 4.5, 0.15),
]


def build(rng):
    bench = ServoCylinder(
        Nominal(40, 25, 300, 100.0, 140.0, 10.0, "V", 20.0, 35.0, 900.0, 160.0, dead=15.0, hose=60.0,
                leak_internal=6e-14, leak_external=8e-15, vertical=True, friction={"per_pressure": COEFFICIENT_M2}),
        rng, mean_pressure_sum=120.0 * BAR)
    sensors = [
        Sensor("stroke (mm)", "x", 1 / MM, 0.15, (0.0, 300.0), 2, 0, "mm"),
        Sensor("p_cap (bar)", "pa", 1 / BAR, 0.3, (0.0, 200.0), 2, 0, "bar"),
        Sensor("p_rod (bar)", "pb", 1 / BAR, 0.3, (0.0, 200.0), 2, 0, "bar"),
        Sensor("p_supply (bar)", "supply", 1 / BAR, 0.3, (0.0, 200.0), 2, 0, "bar"),
        Sensor("u (V)", "command", 1.0, 0.003, (-10.0, 10.0), 3, 0, "V"),
    ]
    style = Style("time (ms)", 1000.0, 0, quote='"')
    answer = {
        "hidden": "pressure_dependent_friction", "side": "cylinder, both directions",
        "coefficients": {"per_pressure_sum": quantity(COEFFICIENT_M2, "m2", "added Coulomb level = value (pA + pB)")},
        "base": base_truth(bench.actuator, bench.gain_a, bench.gain_b, 10.0, "V"),
        "sentence": "The Coulomb level grows with the sum of both chamber pressures. Two supply pressures are recorded "
                    "because at one alone this resembles a friction that differs between the directions.",
    }
    machine = {"name": "vertical test cylinder 40/25", **bench.sheet, "sampling_hz": 500,
               "note": "The supply is set by hand: 140 bar in identification_1, 90 bar in identification_2, 120 bar in "
                       "validation. About 8 % of the cells were lost.",
               "signals": signals(sensors, MEANINGS, style.time_heading)}
    runs = [
        Run("identification_1", FIRST, 6.0, 0.08, supply=140.0 * BAR),
        Run("identification_2", SECOND, 6.0, 0.15, supply=90.0 * BAR),
        Run("validation", VALIDATION, 7.0, 0.10, supply=120.0 * BAR),
    ]
    return Case("03", bench.plant, runs, sensors, style, 500, bench.span, (2 * BAR, 170 * BAR), machine, answer, lost_cells=0.08)
