"""A cylinder or a hydraulic motor with its rigid load: geometry, motion, chambers, stored energy.

Coordinates: x [m] from the retracted end, positive when extending; for a motor the output angle [rad].
Side A is the cap side of a cylinder. Areas are m2; for a motor m3 per rad of the output shaft.
"""

from dataclasses import dataclass

from elements import flow_energy
from friction import Friction


@dataclass(frozen=True)
class Stops:
    """One-sided Hunt-Crossley contacts at `low` and `high` [m]: stiffness d^1.5 (1 + damping dd/dt), never pulling."""

    low: float
    high: float
    stiffness: float = 3.0e9
    damping: float = 3.0

    def contact(self, x, v):
        """Force on the piston [N], and the elastic part of it, at place x and speed v."""
        if x > self.high:
            depth, rate, direction = x - self.high, v, -1.0
        elif x < self.low:
            depth, rate, direction = self.low - x, -v, 1.0
        else:
            return 0.0, 0.0
        elastic = self.stiffness * depth**1.5
        return direction * max(elastic * (1.0 + self.damping * rate), 0.0), direction * elastic

    def stored(self, x):
        """Elastic energy [J] of the contact at place x."""
        depth = max(x - self.high, self.low - x, 0.0)
        return self.stiffness * depth**2.5 / 2.5


@dataclass(frozen=True)
class Actuator:
    """Everything that moves and the two chambers that move it."""

    area_a: float
    area_b: float
    volume_a: float  # at x = 0, hose included [m3]
    volume_b: float  # at x = 0, hose included [m3]
    mass: float  # kg, or kg m2 on the output shaft
    load: float  # constant force against +x [N], or torque [N m]
    friction: Friction
    bulk_modulus: float
    leak_internal: float  # across the piston [m3/(s Pa)]
    leak_external: float  # from each chamber to tank [m3/(s Pa)]
    stops: Stops | None = None
    rotary: bool = False

    def volumes(self, x):
        """Oil volumes [m3] of both sides; those of a motor do not change."""
        if self.rotary:
            return self.volume_a, self.volume_b
        return self.volume_a + self.area_a * x, self.volume_b - self.area_b * x

    def motion(self, x, v, pa, pb):
        """Acceleration, and the power [W] lost in friction and stops."""
        friction = self.friction.force(v, x, pa + pb)
        contact = elastic = 0.0
        if self.stops:
            contact, elastic = self.stops.contact(x, v)
        force = self.area_a * pa - self.area_b * pb - friction - self.load + contact
        return force / self.mass, friction * v - (contact - elastic) * v

    def chambers(self, x, v, pa, pb, flow_a, flow_b):
        """Pressure rates [Pa/s] for the flows [m3/s] that enter both ports, and the power [W] lost in leaks."""
        beta = self.bulk_modulus
        volume_a, volume_b = self.volumes(x)
        across = self.leak_internal * (pa - pb)
        out_a = self.leak_external * pa
        out_b = self.leak_external * pb
        rate_a = beta / volume_a * (flow_a - self.area_a * v - across - out_a)
        rate_b = beta / volume_b * (flow_b + self.area_b * v + across - out_b)
        h_a, h_b = flow_energy(pa, beta), flow_energy(pb, beta)
        lost = (h_a - h_b) * across + h_a * out_a + h_b * out_b
        if self.rotary:  # compression energy that the constant displacement carries from side to side
            lost += (h_a - pa) * self.area_a * v - (h_b - pb) * self.area_b * v
        return rate_a, rate_b, lost

    def stored(self, x, v, pa, pb):
        """Kinetic, potential, elastic and compression energy [J]."""
        beta = self.bulk_modulus
        volume_a, volume_b = self.volumes(x)
        energy = 0.5 * self.mass * v * v + self.load * x
        energy += volume_a * (flow_energy(pa, beta) - pa) + volume_b * (flow_energy(pb, beta) - pb)
        return energy + (self.stops.stored(x) if self.stops else 0.0)
