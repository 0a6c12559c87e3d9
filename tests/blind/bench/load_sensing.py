"""A load-sensing pump and one valve section with its own pressure compensator in front of a cylinder."""

from elements import flow_energy, orifice_root, play, smooth_step
from plants import Plant


class LoadSensingPlant(Plant):
    """Metering in is compensated: the drop over the spool edge is `metering_drop` [Pa], or what the pump leaves.

    The compensator lets no oil flow back. Metering out is a plain orifice to tank; both edges of a side share a gain
    [m3/(s sqrt(Pa))] at full opening. The pump line follows the sensed pressure plus `margin` [Pa], at most
    `highest` [Pa], as a first-order system with time constant `lag` [s], within the pump's flow 0 ... `pump_flow`
    [m3/s]. `hysteresis` is the full width of a play in the spool, as a share of the full command.
    """

    extra_tolerance = 1.0

    def __init__(self, actuator, gain_a, gain_b, full, pump_flow, margin, highest, lag, metering_drop, line_volume,
                 hysteresis=0.0):
        self.actuator = actuator
        self.gain_a = gain_a
        self.gain_b = gain_b
        self.full = full
        self.pump_flow = pump_flow
        self.margin = margin
        self.highest = highest
        self.lag = lag
        self.metering_drop = metering_drop
        self.line_volume = line_volume
        self.hysteresis = hysteresis

    def spool(self, values):
        return play(values, 0.5 * self.hysteresis * self.full) if self.hysteresis else values

    def start(self, x):
        actuator = self.actuator
        pb = 5.0e5
        pa = (actuator.area_b * pb + actuator.load) / actuator.area_a
        return [x, 0.0, pa, pb, self.margin, 0.0, 0.0]

    def metered(self, gain, opening, pump, load):
        """Compensated inlet flow [m3/s] from the pump line to a chamber at pressure `load` [Pa]."""
        drop = pump - load
        return gain * opening * orifice_root(min(drop, self.metering_drop)) if drop > 0.0 else 0.0

    def rates(self, state, t):
        x, v, pa, pb, pump, _, _ = state
        opening = self.command_at(t) / self.full
        if opening >= 0.0:
            drawn = flow_a = self.metered(self.gain_a, opening, pump, pa)
            flow_b = -self.gain_b * opening * orifice_root(pb)
            sensed = pa
        else:
            drawn = flow_b = self.metered(self.gain_b, -opening, pump, pb)
            flow_a = self.gain_a * opening * orifice_root(pa)
            sensed = pb
        sensed *= smooth_step(abs(opening) / 0.02)
        target = min(max(sensed, 0.0) + self.margin, self.highest)
        beta = self.actuator.bulk_modulus
        capacity = self.line_volume / beta
        pumped = min(max(drawn + capacity * (target - pump) / self.lag, 0.0), self.pump_flow)
        acceleration, mechanical = self.actuator.motion(x, v, pa, pb)
        rate_a, rate_b, leaks = self.actuator.chambers(x, v, pa, pb, flow_a, flow_b)
        supplied = flow_energy(pump, beta) * pumped
        edges = flow_energy(pump, beta) * drawn - flow_energy(pa, beta) * flow_a - flow_energy(pb, beta) * flow_b
        return [v, acceleration, rate_a, rate_b, (pumped - drawn) / capacity, supplied, mechanical + leaks + edges]

    def stored(self, state):
        pump, beta = state[4], self.actuator.bulk_modulus
        return super().stored(state) + self.line_volume * (flow_energy(pump, beta) - pump)
