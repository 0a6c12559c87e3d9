"""Case 9: load-sensing pump and compensated section, vertical cylinder, play in the spool."""

from actuator import Actuator, Stops
from case import Case, Run, around, quantity, rounded
from friction import Friction
from load_sensing import LoadSensingPlant
from sensors import Sensor
from tables import Style

from definitions.common import BAR, G, LITRE_PER_MINUTE, MM, MEANINGS, areas, base_truth, edge_gain, sheet_volumes, signals

PLAY = 0.06
IDENTIFICATION = [
    ("hold", 0.3), ("move", 35.0, 0.4), ("set", -3.0, 0.4), ("move", 20.0, 0.3), ("set", 3.0, 0.3), ("move", 60.0, 0.8),
    ("move", 12.0, 0.88), ("move", 45.0, 0.3), ("hold", 0.4), ("sine", 30.0, 1.0, 2), ("move", 85.0, 0.85),
    ("set", -3.0, 0.3), ("move", 70.0, 0.2), ("multi", 40.0, 2.0, (0.6, 1.5, 3.1)), ("move", 25.0, 0.5),
]
VALIDATION = [
    ("hold", 0.3), ("move", 28.0, 0.5), ("move", 50.0, 0.2), ("set", 3.0, 0.3), ("multi", 35.0, 1.8, (0.7, 1.8, 3.9)),
    ("move", 75.0, 0.85), ("set", -3.0, 0.3), ("move", 16.0, 0.75), ("sine", 40.0, 1.4, 2), ("move", 40.0, 0.3),
]


def build(rng):
    stroke = 0.4
    area_a, area_b = areas(50, 30)
    dead = [around(rng, 25e-6, 0.1) for _ in range(2)]
    hose = [around(rng, 120e-6, 0.1) for _ in range(2)]
    mass = around(rng, 300.0, 0.05)
    actuator = Actuator(
        area_a, area_b, dead[0] + hose[0], dead[1] + hose[1] + area_b * stroke, mass, mass * G,
        Friction(around(rng, 1800.0, 0.15), around(rng, 300.0, 0.15)), around(rng, 1.0e9, 0.12),
        around(rng, 2.0e-13, 0.2), around(rng, 2.5e-14, 0.2), Stops(0.0, stroke))
    drop = 7.0 * BAR
    gain_a = around(rng, edge_gain(38.0, 7.0), 0.04)
    gain_b = around(rng, edge_gain(46.0, 7.0), 0.04)
    line = around(rng, 300e-6, 0.05)

    def plant(effect=True, supply=None):
        return LoadSensingPlant(
            actuator, gain_a, gain_b, 100.0, 45.0 * LITRE_PER_MINUTE, 20.0 * BAR, 200.0 * BAR, 0.05, drop, line,
            PLAY if effect else 0.0)

    sensors = [
        Sensor("cylinder_mm", "x", 1 / MM, 0.2, (0.0, 400.0), 2, 0, "mm"),
        Sensor("cap_bar", "pa", 1 / BAR, 0.25, (0.0, 250.0), 2, 0, "bar"),
        Sensor("rod_bar", "pb", 1 / BAR, 0.25, (0.0, 250.0), 2, 0, "bar"),
        Sensor("pump_bar", "extra", 1 / BAR, 0.25, (0.0, 250.0), 2, 0, "bar"),
        Sensor("command_pct", "command", 1.0, 0.03, (-100.0, 100.0), 2, 0, "%"),
    ]
    style = Style("time_s", time_digits=4)
    base = base_truth(actuator, gain_a, gain_b, 100.0, "%")
    base["metering_drop"] = quantity(drop, "Pa")
    base["line_volume"] = quantity(line, "m3")
    base["pump_time_constant"] = quantity(0.05, "s")
    base["load_sensing_margin"] = quantity(20.0 * BAR, "Pa")
    base["pump_flow_max"] = quantity(45.0 * LITRE_PER_MINUTE, "m3/s")
    answer = {
        "hidden": "valve_hysteresis", "side": "valve",
        "coefficients": {
            "full_width": quantity(PLAY * 100.0, "%", "distance between the rising and the falling branch, of command"),
            "half_width": quantity(PLAY * 50.0, "%"),
        },
        "base": base,
        "sentence": "The spool follows the command with a play of 6 % of the full command in all, 3 % to each side.",
    }
    machine = {
        "name": "load-sensing section with vertical cylinder 50/30",
        "kind_of_drive": "load-sensing pump, one valve section with its own pressure compensator",
        "actuator": "single-rod cylinder",
        "bore_mm": 50.0, "rod_mm": 30.0, "stroke_mm": 400.0, **sheet_volumes(rng, *dead, *hose),
        "pump_flow_max_l_min": 45.0, "pump_pressure_max_bar": 200.0, "load_sensing_margin_bar": 20.0,
        "pump_controller_time_constant_ms": 50.0, "pump_line_volume_cm3": rounded(line * 1e6, 2),
        "tank_pressure_bar": 0.0, "valve_full_command": 100.0, "valve_command_unit": "%",
        "metering_drop_bar": 7.0, "valve_rated_flow_cap_l_min": 38.0, "valve_rated_flow_rod_l_min": 46.0,
        "valve_rated_drop_per_edge_bar": 7.0,
        "valve_note": "The compensator keeps the metering drop from pump to cylinder; it lets no oil flow back. The "
                      "edge to tank of a side is as large as its edge from the pump, and is not compensated.",
        "nominal_bulk_modulus_bar": rounded(around(rng, actuator.bulk_modulus / BAR, 0.15), 2),
        "nominal_load_mass_kg": rounded(around(rng, mass, 0.15), 2), "orientation": "vertical, extending lifts the load",
        "end_stops_mm": [0.0, 400.0], "sampling_hz": 400,
        "signals": signals(sensors, MEANINGS | {"extra": "pump pressure"}, style.time_heading),
    }
    slopes = (0.04, 0.1, 0.25)
    runs = [Run("identification", IDENTIFICATION, 11.0, 0.1, slopes), Run("validation", VALIDATION, 8.0, 0.25, slopes)]
    return Case("09", plant, runs, sensors, style, 400, (0.035, 0.365), (1 * BAR, 80 * BAR), machine, answer)
