"""Friction laws. Speeds in m/s (rad/s for rotation), forces in N (N m for rotation)."""

from dataclasses import dataclass, replace
from math import exp, tanh


@dataclass(frozen=True)
class Friction:
    """Viscous damping plus Coulomb friction with a smooth sign: `viscous v + level tanh(v / width)`.

    The optional terms change the Coulomb level: `extending` is a factor for v > 0, `per_pressure` [m2] grows it
    with pA + pB, `static` and `stribeck_speed` raise it near standstill, `bump` raises it by a share of the level
    around `bump_place` [m] with a Gaussian of standard deviation `bump_sigma` [m].
    """

    viscous: float
    coulomb: float
    width: float = 1.0e-3
    extending: float = 1.0
    per_pressure: float = 0.0
    static: float = 0.0
    stribeck_speed: float = 0.02
    bump: float = 0.0
    bump_place: float = 0.0
    bump_sigma: float = 0.005

    def force(self, v, x, pressure_sum):
        """Force against the motion at speed v, place x and sum of the chamber pressures [Pa]."""
        level = self.coulomb
        if self.static:
            level += self.static * exp(-((v / self.stribeck_speed) ** 2))
        if self.bump:
            level *= 1.0 + self.bump * exp(-0.5 * ((x - self.bump_place) / self.bump_sigma) ** 2)
        if self.per_pressure:
            level += self.per_pressure * max(pressure_sum, 0.0)
        sign = tanh(v / self.width)
        if self.extending != 1.0:
            level *= 1.0 + 0.5 * (self.extending - 1.0) * (1.0 + sign)
        return self.viscous * v + level * sign

    def plain(self, pressure_sum):
        """The same law without its special term, at the Coulomb level that resembles it most.

        `pressure_sum` [Pa] is the mean sum of the chamber pressures at which the levels are matched.
        """
        level = self.coulomb * 0.5 * (1.0 + self.extending) + self.per_pressure * pressure_sum
        return replace(self, coulomb=level, extending=1.0, per_pressure=0.0, static=0.0, bump=0.0)
