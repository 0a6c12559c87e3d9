"""A cylinder on a servo valve: draws a true machine and writes its data sheet."""

from dataclasses import dataclass, field
from dataclasses import replace

from actuator import Actuator, Stops
from case import around, rounded
from friction import Friction
from servo import ServoPlant

from definitions.common import BAR, G, MM, areas, edge_gain, sheet_volumes


@dataclass
class Nominal:
    """What is on the drawing, in engineering units, and typical values of what is not."""

    bore: float  # mm
    rod: float  # mm
    stroke: float  # mm
    mass: float  # kg
    supply: float  # bar
    full: float  # full command
    command_unit: str
    flow: float  # l/min per edge
    drop: float  # bar per edge
    viscous: float  # N s/m
    coulomb: float  # N
    dead: float = 3.0  # cm3
    hose: float = 12.0  # cm3
    bulk: float = 0.95e9  # Pa
    leak_internal: float = 2.0e-14  # m3/(s Pa)
    leak_external: float = 3.0e-15  # m3/(s Pa)
    vertical: bool = False
    friction: dict = field(default_factory=dict)
    stop_gap: float = 0.0  # mm that the real stops are inside the stated ones


class ServoCylinder:
    """The true machine drawn around the nominal values, its plants and its data sheet."""

    def __init__(self, nominal, rng, overlap=(0.0, 0.0), lag=0.0, mean_pressure_sum=0.0):
        n = self.nominal = nominal
        area_a, area_b = areas(n.bore, n.rod)
        dead = [around(rng, n.dead * 1e-6, 0.1) for _ in range(2)]
        hose = [around(rng, n.hose * 1e-6, 0.1) for _ in range(2)]
        mass = around(rng, n.mass, 0.05)
        stops = Stops(n.stop_gap * MM, (n.stroke - n.stop_gap) * MM)
        self.actuator = Actuator(
            area_a, area_b, dead[0] + hose[0], dead[1] + hose[1] + area_b * n.stroke * MM, mass,
            mass * G if n.vertical else 0.0,
            Friction(around(rng, n.viscous, 0.15), around(rng, n.coulomb, 0.15), **n.friction),
            around(rng, n.bulk, 0.12), around(rng, n.leak_internal, 0.3), around(rng, n.leak_external, 0.3), stops)
        self.gain_a = around(rng, edge_gain(n.flow, n.drop), 0.04)
        self.gain_b = around(rng, edge_gain(n.flow, n.drop), 0.04)
        self.overlap, self.lag, self.mean_pressure_sum = overlap, lag, mean_pressure_sum
        self.sheet = {
            "kind_of_drive": "cylinder on a 4/3 servo valve at constant supply pressure",
            "actuator": "single-rod cylinder",
            "bore_mm": n.bore, "rod_mm": n.rod, "stroke_mm": n.stroke,
            **sheet_volumes(rng, *dead, *hose),
            "supply_pressure_bar": n.supply, "tank_pressure_bar": 0.0,
            "valve_full_command": n.full, "valve_command_unit": n.command_unit,
            "valve_rated_flow_l_min": n.flow, "valve_rated_drop_per_edge_bar": n.drop,
            "nominal_bulk_modulus_bar": rounded(around(rng, self.actuator.bulk_modulus / BAR, 0.15), 2),
            "nominal_load_mass_kg": rounded(around(rng, mass, 0.15), 2),
            "orientation": "vertical, extending lifts the load" if n.vertical else "horizontal",
            "end_stops_mm": [0.0, n.stroke],
        }

    def plant(self, effect=True, supply=None):
        """The machine, with its hidden effect or with the nearest plain machine."""
        actuator = self.actuator
        if not effect:
            actuator = replace(actuator, friction=actuator.friction.plain(self.mean_pressure_sum))
        return ServoPlant(
            actuator, supply or self.nominal.supply * BAR, self.gain_a, self.gain_b, self.nominal.full,
            self.overlap if effect else (0.0, 0.0), self.lag if effect else 0.0)

    @property
    def span(self):
        """Range of x [m] for manoeuvres that stay off the stops."""
        stroke = self.nominal.stroke * MM
        return 0.08 * stroke, 0.92 * stroke
