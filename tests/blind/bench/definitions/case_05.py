"""Case 5: pump straight on a double-rod cylinder, without a hidden effect."""

from math import pi

from actuator import Actuator, Stops
from case import Case, Run, around, quantity, rounded
from closed_circuit import PumpPlant
from friction import Friction
from sensors import Sensor
from tables import Style

from definitions.common import BAR, MM, base_truth, edge_gain, sheet_volumes, signals

MEANINGS = {
    "x": "piston position from the end of side A, positive when side A grows",
    "pa": "pressure at port A", "pb": "pressure at port B",
    "command": "pump speed, measured and commanded alike; positive delivers into port A",
}
IDENTIFICATION = [
    ("hold", 0.4), ("move", 500.0, 0.45), ("hold", 0.3), ("move", 900.0, 0.8), ("move", 300.0, 0.65), ("hold", 0.2),
    ("move", 1500.0, 0.2), ("sine", 700.0, 1.0, 2), ("move", 150.0, 0.28), ("move", 1700.0, 0.85),
    ("multi", 900.0, 2.0, (0.6, 1.5, 3.3, 5.9)), ("move", 1200.0, 0.15), ("move", 400.0, 0.35), ("hold", 0.3),
]
VALIDATION = [
    ("hold", 0.3), ("move", 700.0, 0.75), ("move", 350.0, 0.6), ("hold", 0.2), ("move", 1400.0, 0.15),
    ("multi", 1000.0, 1.6, (0.8, 2.1, 4.4)), ("move", 220.0, 0.3), ("sine", 900.0, 1.5, 2), ("move", 1700.0, 0.8),
]


def build(rng):
    stroke = 0.5
    area = pi / 4 * (0.032**2 - 0.020**2)
    dead = [around(rng, 10e-6, 0.1) for _ in range(2)]
    hose = [around(rng, 60e-6, 0.1) for _ in range(2)]
    mass = around(rng, 200.0, 0.05)
    actuator = Actuator(
        area, area, dead[0] + hose[0], dead[1] + hose[1] + area * stroke, mass, 0.0,
        Friction(around(rng, 900.0, 0.15), around(rng, 160.0, 0.15)), around(rng, 1.0e9, 0.12),
        around(rng, 1.6e-12, 0.2), around(rng, 8e-14, 0.2), Stops(0.0, stroke))
    displacement = around(rng, 8.0e-6, 0.01)
    charge = 10.0 * BAR
    check_gain = edge_gain(10.0, 1.0)

    def plant(effect=True, supply=None):
        return PumpPlant(actuator, displacement, charge, check_gain)

    sensors = [
        Sensor("position", "x", 1 / MM, 0.25, (0.0, 500.0), 2, 0, "mm"),
        Sensor("pressure_a", "pa", 1 / BAR, 0.15, (0.0, 100.0), 2, 0, "bar"),
        Sensor("pressure_b", "pb", 1 / BAR, 0.15, (0.0, 100.0), 2, 0, "bar"),
        Sensor("pump_speed", "command", 1.0, 1.0, (-2000.0, 2000.0), 1, 0, "rpm"),
    ]
    style = Style("time", units_row=("s", "mm", "bar", "bar", "rpm"))
    base = base_truth(actuator)
    base["pump_displacement"] = quantity(displacement, "m3/rev")
    base["charge_pressure"] = quantity(charge, "Pa")
    base["check_valve_gain"] = quantity(check_gain, "m3/(s sqrt(Pa))")
    answer = {
        "hidden": "nothing", "side": "none", "coefficients": {}, "base": base,
        "sentence": "The machine is as the base model says: ideal pump, laminar leak across the ports, check valves.",
    }
    machine = {
        "name": "closed circuit with double-rod cylinder 32/20",
        "kind_of_drive": "speed-controlled pump straight on both ports, closed circuit with charge line",
        "actuator": "double-rod cylinder, equal areas",
        "bore_mm": 32.0, "rod_mm": 20.0, "rods": 2, "stroke_mm": 500.0, **sheet_volumes(rng, *dead, *hose),
        "pump_displacement_cm3_rev": 8.0, "pump_speed_max_rpm": 2000.0, "charge_pressure_bar": 10.0,
        "check_valves": "one from the charge line into each port, 10 l/min at 1 bar",
        "cross_port_leakage": "laminar, not specified", "tank_pressure_bar": 0.0,
        "nominal_bulk_modulus_bar": rounded(around(rng, actuator.bulk_modulus / BAR, 0.15), 2),
        "nominal_load_mass_kg": rounded(around(rng, mass, 0.12), 2), "orientation": "horizontal",
        "end_stops_mm": [0.0, 500.0], "sampling_hz": 250,
        "signals": signals(sensors, MEANINGS, style.time_heading),
    }
    slopes = (0.1, 0.2, 0.35)
    runs = [Run("identification", IDENTIFICATION, 12.0, 0.2, slopes), Run("validation", VALIDATION, 8.0, 0.3, slopes)]
    return Case("05", plant, runs, sensors, style, 250, (0.04, 0.46), (6 * BAR, 90 * BAR), machine, answer)
