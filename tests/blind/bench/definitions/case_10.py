"""Case 10: servo bench in other units, friction with a bump around one place of the stroke."""

from math import log, sqrt

from case import Case, Run, quantity
from sensors import Sensor
from tables import Style

from definitions.common import BAR, MEANINGS, MM, base_truth, signals
from definitions.servo_cylinder import Nominal, ServoCylinder

SHARE, PLACE_M, WIDTH_M = 0.7, 0.058, 0.012
SIGMA_M = WIDTH_M / (2.0 * sqrt(2.0 * log(2.0)))

IDENTIFICATION = [
    ("hold", 0.25), ("move", 4.0, 0.8), ("move", 2.5, 0.2), ("hold", 0.15), ("move", 8.0, 0.9), ("move", 6.0, 0.1),
    ("move", 1.6, 0.6), ("hold", 0.1), ("move", 3.0, 0.85), ("sine", 7.0, 2.0, 3), ("move", 12.0, 0.15),
    ("multi", 10.0, 1.5, (0.7, 1.9, 4.1, 7.3)), ("move", 2.0, 0.45), ("move", 5.0, 0.75), ("move", 3.5, 0.3),
]
VALIDATION = [
    ("hold", 0.2), ("move", 3.2, 0.25), ("move", 5.0, 0.8), ("hold", 0.2), ("move", 2.2, 0.4), ("move", 9.0, 0.9),
    ("multi", 8.0, 1.2, (0.9, 2.4, 5.3)), ("move", 4.0, 0.2), ("sine", 6.0, 2.5, 3), ("move", 2.8, 0.7),
]


def build(rng):
    bench = ServoCylinder(
        Nominal(20, 12, 100, 8.0, 70.0, 20.0, "mA", 6.0, 35.0, 150.0, 140.0, dead=4.0, hose=15.0,
                friction={"bump": SHARE, "bump_place": PLACE_M, "bump_sigma": SIGMA_M}), rng)
    sensors = [
        Sensor("position [m]", "x", 1.0, 5e-5, (0.0, 0.1), 6, 12, "m"),
        Sensor("p1 [kPa]", "pa", 1e-3, 12.0, (0.0, 10000.0), 0, 12, "kPa"),
        Sensor("p2 [kPa]", "pb", 1e-3, 12.0, (0.0, 10000.0), 0, 12, "kPa"),
        Sensor("valve current [mA]", "command", 1.0, 0.01, (-20.0, 20.0), 2, 12, "mA"),
    ]
    style = Style("", separator="\t", header=(
        "Test bench 20/12, servo valve", "Recorder: 4 channels, 12 bit", "Sampling rate: {rate} Hz",
        "Samples: {rows}", "Pressures above ambient", ""))
    answer = {
        "hidden": "outside", "side": "cylinder, friction",
        "coefficients": {
            "share_of_coulomb": quantity(SHARE, "1"),
            "place": quantity(PLACE_M, "m", "from the retracted end"),
            "width": quantity(WIDTH_M, "m", "full width at half height"),
            "sigma": quantity(SIGMA_M, "m", "level = coulomb (1 + share exp(-((x - place) / sigma)^2 / 2))"),
        },
        "base": base_truth(bench.actuator, bench.gain_a, bench.gain_b, 20.0, "mA"),
        "sentence": "A scored tube: the Coulomb level is up to 70 % larger around 58 mm, over a width of 12 mm, in both "
                    "directions. The law depends on the place, which the usual catalogues do not hold.",
    }
    machine = {"name": "servo bench 20/12", **bench.sheet, "sampling_hz": 1000,
               "note": "No time column; the sampling rate is in the header of each file.",
               "signals": signals(sensors, MEANINGS)}
    runs = [Run("identification", IDENTIFICATION, 10.0, 0.03), Run("validation", VALIDATION, 7.0, 0.07)]
    return Case("10", bench.plant, runs, sensors, style, 1000, bench.span, (2 * BAR, 80 * BAR), machine, answer)
