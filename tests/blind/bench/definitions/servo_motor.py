"""A hydraulic motor with gear on a servo valve: draws a true machine and writes its data sheet."""

from dataclasses import dataclass
from math import pi

from actuator import Actuator
from case import around, rounded
from friction import Friction
from servo import ServoPlant

from definitions.common import BAR, edge_gain


@dataclass
class NominalMotor:
    """What is on the drawing, in engineering units; loads and friction on the output shaft."""

    displacement: float  # cm3/rev
    gear: float
    inertia: float  # kg m2
    load: float  # N m
    supply: float  # bar
    full: float
    command_unit: str
    flow: float  # l/min per edge
    drop: float  # bar per edge
    viscous: float  # N m s/rad
    coulomb: float  # N m
    line: float  # cm3 each side, half the motor included
    bulk: float = 1.0e9
    leak_internal: float = 2.0e-12
    leak_external: float = 4.0e-14


class ServoMotor:
    """The true machine drawn around the nominal values, its plants and its data sheet."""

    def __init__(self, nominal, rng, overlap=(0.0, 0.0)):
        n = self.nominal = nominal
        displacement = around(rng, n.displacement, 0.01) * 1e-6
        per_rad = displacement / (2 * pi) * n.gear
        line = [around(rng, n.line * 1e-6, 0.1) for _ in range(2)]
        inertia = around(rng, n.inertia, 0.05)
        self.displacement = displacement
        self.actuator = Actuator(
            per_rad, per_rad, line[0], line[1], inertia, n.load,
            Friction(around(rng, n.viscous, 0.15), around(rng, n.coulomb, 0.15), width=0.01),
            around(rng, n.bulk, 0.12), around(rng, n.leak_internal, 0.2), around(rng, n.leak_external, 0.2),
            rotary=True)
        self.gain_a = around(rng, edge_gain(n.flow, n.drop), 0.04)
        self.gain_b = around(rng, edge_gain(n.flow, n.drop), 0.04)
        self.overlap = overlap
        self.sheet = {
            "kind_of_drive": "hydraulic motor on a 4/3 servo valve at constant supply pressure",
            "actuator": "hydraulic motor with gear",
            "motor_displacement_cm3_rev": n.displacement, "gear_ratio": n.gear,
            "line_volume_a_cm3": rounded(around(rng, line[0] * 1e6, 0.04)),
            "line_volume_b_cm3": rounded(around(rng, line[1] * 1e6, 0.04)),
            "line_volume_note": "hose and half of the motor, each side",
            "supply_pressure_bar": n.supply, "tank_pressure_bar": 0.0,
            "valve_full_command": n.full, "valve_command_unit": n.command_unit,
            "valve_rated_flow_l_min": n.flow, "valve_rated_drop_per_edge_bar": n.drop,
            "nominal_bulk_modulus_bar": rounded(around(rng, self.actuator.bulk_modulus / BAR, 0.15), 2),
            "nominal_inertia_kg_m2": rounded(around(rng, inertia, 0.15), 2),
            "nominal_inertia_at": "output shaft",
            "end_stops_deg": None,
        }

    def plant(self, effect=True, supply=None):
        """The machine, with or without its hidden effect."""
        return ServoPlant(self.actuator, self.nominal.supply * BAR, self.gain_a, self.gain_b, self.nominal.full,
                          self.overlap if effect else (0.0, 0.0))
