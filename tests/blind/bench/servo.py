"""A 4/3 servo valve at constant supply pressure in front of a cylinder or motor."""

from elements import dead_zone, flow_energy, orifice_root
from plants import Plant


class ServoPlant(Plant):
    """Both edges of side A share `gain_a`, both of side B `gain_b` [m3/(s sqrt(Pa))] at full opening.

    `overlap` is (negative, positive) as shares of the full command; `lag` [s] delays the opening behind the command.
    """

    def __init__(self, actuator, supply, gain_a, gain_b, full, overlap=(0.0, 0.0), lag=0.0):
        self.actuator = actuator
        self.supply = supply
        self.gain_a = gain_a
        self.gain_b = gain_b
        self.full = full
        self.overlap = overlap
        self.lag = lag

    def start(self, x):
        actuator = self.actuator
        pb = 0.4 * self.supply
        pa = (actuator.area_b * pb + actuator.load) / actuator.area_a
        return [x, 0.0, pa, pb, 0.0, 0.0, 0.0]

    def rates(self, state, t):
        x, v, pa, pb, delayed, _, _ = state
        command = self.command_at(t) / self.full
        delayed_rate = 0.0
        if self.lag:
            delayed_rate = (command - delayed) / self.lag
            command = delayed
        opening = dead_zone(command, *self.overlap)
        beta = self.actuator.bulk_modulus
        if opening >= 0.0:
            flow_a = self.gain_a * opening * orifice_root(self.supply - pa)
            flow_b = -self.gain_b * opening * orifice_root(pb)
            drawn = flow_a
        else:
            flow_a = self.gain_a * opening * orifice_root(pa)
            flow_b = -self.gain_b * opening * orifice_root(self.supply - pb)
            drawn = flow_b
        acceleration, mechanical = self.actuator.motion(x, v, pa, pb)
        rate_a, rate_b, leaks = self.actuator.chambers(x, v, pa, pb, flow_a, flow_b)
        supplied = flow_energy(self.supply, beta) * drawn
        edges = supplied - flow_energy(pa, beta) * flow_a - flow_energy(pb, beta) * flow_b
        return [v, acceleration, rate_a, rate_b, delayed_rate, supplied, mechanical + leaks + edges]
