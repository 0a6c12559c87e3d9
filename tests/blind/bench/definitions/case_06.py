"""Case 6: pump on a single-rod cylinder with a shuttle valve to the charge line, Stribeck friction."""

from dataclasses import replace

from actuator import Actuator, Stops
from case import Case, Run, around, quantity, rounded
from closed_circuit import PumpPlant
from friction import Friction
from sensors import Sensor
from tables import Style

from definitions.common import BAR, MM, areas, base_truth, edge_gain, sheet_volumes, signals

MEANINGS = {
    "x": "piston position from the retracted end, positive when extending",
    "pa": "pressure on the cap side (A)", "pb": "pressure on the rod side (B)",
    "command": "pump speed, measured and commanded alike; positive delivers into the cap side",
}
STRIBECK_SPEED = 0.03
IDENTIFICATION = [
    ("hold", 0.3), ("set", 60.0, 0.5), ("move", 700.0, 0.6), ("hold", 0.2), ("set", -40.0, 0.6), ("move", 500.0, 0.3),
    ("set", 120.0, 0.5), ("move", 1400.0, 0.85), ("set", -100.0, 0.5), ("move", 1100.0, 0.15),
    ("multi", 200.0, 1.6, (0.6, 1.3, 2.9)), ("set", 90.0, 0.4), ("move", 1700.0, 0.8), ("hold", 0.2),
    ("sine", 600.0, 1.0, 1), ("set", -150.0, 0.4), ("move", 300.0, 0.5), ("set", 30.0, 0.5), ("move", 900.0, 0.2),
]
VALIDATION = [
    ("hold", 0.2), ("set", 80.0, 0.5), ("move", 900.0, 0.75), ("set", -60.0, 0.5), ("move", 1200.0, 0.2),
    ("set", 45.0, 0.5), ("sine", 350.0, 1.2, 2), ("move", 1500.0, 0.85), ("hold", 0.2), ("set", -130.0, 0.5),
    ("multi", 300.0, 1.2, (0.8, 1.9)), ("move", 600.0, 0.3),
]


def build(rng):
    stroke = 0.4
    area_a, area_b = areas(40, 28)
    dead = [around(rng, 15e-6, 0.1) for _ in range(2)]
    hose = [around(rng, 70e-6, 0.1) for _ in range(2)]
    mass = around(rng, 150.0, 0.05)
    coulomb = around(rng, 380.0, 0.1)
    static = 0.5 * coulomb
    actuator = Actuator(
        area_a, area_b, dead[0] + hose[0], dead[1] + hose[1] + area_b * stroke, mass, 0.0,
        Friction(around(rng, 3200.0, 0.15), coulomb, static=static, stribeck_speed=STRIBECK_SPEED),
        around(rng, 1.0e9, 0.12), around(rng, 2.5e-12, 0.2), around(rng, 1.0e-13, 0.2), Stops(0.0, stroke))
    displacement = around(rng, 8.0e-6, 0.01)
    charge = 20.0 * BAR
    check_gain = edge_gain(10.0, 1.0)
    shuttle_gain = edge_gain(20.0, 2.0)

    def plant(effect=True, supply=None):
        real = actuator if effect else replace(actuator, friction=actuator.friction.plain(0.0))
        return PumpPlant(real, displacement, charge, check_gain, shuttle_gain)

    sensors = [
        Sensor("Position/mm", "x", 1 / MM, 0.2, (0.0, 400.0), 2, 0, "mm"),
        Sensor("p_A/bar", "pa", 1 / BAR, 0.12, (0.0, 100.0), 2, 0, "bar"),
        Sensor("p_B/bar", "pb", 1 / BAR, 0.12, (0.0, 100.0), 2, 0, "bar"),
        Sensor("n_pump/rpm", "command", 1.0, 1.0, (-2000.0, 2000.0), 1, 0, "rpm"),
    ]
    style = Style("Time/s", separator="\t", time_digits=4)
    base = base_truth(actuator)
    base["pump_displacement"] = quantity(displacement, "m3/rev")
    base["charge_pressure"] = quantity(charge, "Pa")
    base["check_valve_gain"] = quantity(check_gain, "m3/(s sqrt(Pa))")
    base["shuttle_gain"] = quantity(shuttle_gain, "m3/(s sqrt(Pa)) when open")
    base["shuttle_begins_to_open"] = quantity(1.5 * BAR, "Pa")
    base["shuttle_open"] = quantity(4.0 * BAR, "Pa")
    answer = {
        "hidden": "stribeck_friction", "side": "cylinder, both directions",
        "coefficients": {
            "added_static_level": quantity(static, "N", "level = coulomb + value exp(-(v / speed)^2)"),
            "speed": quantity(STRIBECK_SPEED, "m/s"),
        },
        "base": base,
        "sentence": "Friction rises towards standstill: 50 % above the Coulomb level, gone beyond about 60 mm/s.",
    }
    machine = {
        "name": "closed circuit with single-rod cylinder 40/28",
        "kind_of_drive": "speed-controlled pump straight on both ports, closed circuit with charge line and shuttle valve",
        "actuator": "single-rod cylinder",
        "bore_mm": 40.0, "rod_mm": 28.0, "stroke_mm": 400.0, **sheet_volumes(rng, *dead, *hose),
        "pump_displacement_cm3_rev": 8.0, "pump_speed_max_rpm": 2000.0, "charge_pressure_bar": 20.0,
        "check_valves": "one from the charge line into each port, 10 l/min at 1 bar",
        "shuttle_valve": "joins the port of lower pressure to the charge line, both ways; 20 l/min at 2 bar; begins to "
                         "open at 1.5 bar between the ports, open at 4 bar",
        "cross_port_leakage": "laminar, not specified", "tank_pressure_bar": 0.0,
        "nominal_bulk_modulus_bar": rounded(around(rng, actuator.bulk_modulus / BAR, 0.15), 2),
        "nominal_load_mass_kg": rounded(around(rng, mass, 0.12), 2), "orientation": "horizontal",
        "end_stops_mm": [0.0, 400.0], "sampling_hz": 500,
        "signals": signals(sensors, MEANINGS, style.time_heading),
    }
    slopes = (0.03, 0.1, 0.2)
    runs = [Run("identification", IDENTIFICATION, 12.0, 0.12, slopes), Run("validation", VALIDATION, 8.0, 0.2, slopes)]
    return Case("06", plant, runs, sensors, style, 500, (0.03, 0.37), (10 * BAR, 90 * BAR), machine, answer)
