"""A speed-controlled pump straight on both ports of a cylinder, with a charge line."""

from elements import check_valve_flow, flow_energy, orifice_root, smooth_step
from plants import Plant

RPM = 1.0 / 60.0


class PumpPlant(Plant):
    """The command is the pump speed [rpm]; positive speed moves oil from side B to side A.

    `check_gain` [m3/(s sqrt(Pa))] belongs to one check valve from the charge line into each port. `shuttle_gain`
    belongs to a shuttle valve that joins the side of lower pressure to the charge line, both ways; it begins to open
    at a pressure difference `shuttle_crack` [Pa] and is open `shuttle_span` [Pa] further on.
    """

    full = 2000.0

    def __init__(self, actuator, displacement, charge, check_gain, shuttle_gain=0.0, shuttle_crack=1.5e5,
                 shuttle_span=2.5e5):
        self.actuator = actuator
        self.displacement = displacement  # m3/rev
        self.charge = charge
        self.check_gain = check_gain
        self.shuttle_gain = shuttle_gain
        self.shuttle_crack = shuttle_crack
        self.shuttle_span = shuttle_span

    def start(self, x):
        pa = self.charge
        pb = pa * self.actuator.area_a / self.actuator.area_b
        return [x, 0.0, pa, pb, 0.0, 0.0, 0.0]

    def rates(self, state, t):
        x, v, pa, pb, _, _, _ = state
        pumped = self.displacement * self.command_at(t) * RPM
        from_charge_a = check_valve_flow(self.check_gain, self.charge - pa)
        from_charge_b = check_valve_flow(self.check_gain, self.charge - pb)
        if self.shuttle_gain:
            beyond = (abs(pa - pb) - self.shuttle_crack) / self.shuttle_span
            opening = self.shuttle_gain * smooth_step(beyond)
            if pa > pb:
                from_charge_b += opening * orifice_root(self.charge - pb)
            else:
                from_charge_a += opening * orifice_root(self.charge - pa)
        flow_a = pumped + from_charge_a
        flow_b = -pumped + from_charge_b
        acceleration, mechanical = self.actuator.motion(x, v, pa, pb)
        rate_a, rate_b, leaks = self.actuator.chambers(x, v, pa, pb, flow_a, flow_b)
        beta = self.actuator.bulk_modulus
        h_a, h_b, h_charge = flow_energy(pa, beta), flow_energy(pb, beta), flow_energy(self.charge, beta)
        supplied = (h_a - h_b) * pumped + h_charge * (from_charge_a + from_charge_b)
        valves = (h_charge - h_a) * from_charge_a + (h_charge - h_b) * from_charge_b
        return [v, acceleration, rate_a, rate_b, 0.0, supplied, mechanical + leaks + valves]
