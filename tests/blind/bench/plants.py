"""What all plants share: the layout of the state, the bound command, and the integration.

State: x, v, pA, pB, extra, supplied energy [J], lost energy [J]. `extra` is the delayed valve command, the pump
pressure, or nothing. The two energies are integrated with the rest, so that the balance can be checked.
"""

import numpy as np
from scipy.integrate import odeint

COMMAND_STEP_S = 1.0e-3
"""Spacing [s] of the values of a command; it is linear between them."""

SIZE = 7
RELATIVE_TOLERANCE = 1.0e-8
ABSOLUTE_TOLERANCE = np.array([1e-10, 1e-8, 1.0, 1.0, 1e-7, 1e-3, 1e-3])


class Plant:
    """A machine that takes one command and has one actuator."""

    extra_tolerance = 1e-7

    def bind(self, values):
        """Takes the values of the command, one each millisecond, in the command's own unit."""
        values = list(values)
        self._command = self.spool(values) + [values[-1]] * 100

    def spool(self, values):
        """What arrives behind the command; a subclass with hysteresis changes it."""
        return values

    def command_at(self, t):
        """The bound command at time t [s]."""
        place = t / COMMAND_STEP_S
        index = int(place)
        value = self._command[index]
        return value + (place - index) * (self._command[index + 1] - value)

    def rates(self, state, t):
        """Time derivatives of the state."""
        raise NotImplementedError

    def start(self, x):
        """State at rest at place x before the settling time."""
        raise NotImplementedError

    def stored(self, state):
        """Energy [J] stored in a state."""
        return self.actuator.stored(*state[:4])


def simulate(plant, values, times, state, tolerance=1.0):
    """States [len(times), 7] under a command; `tolerance` multiplies the standard tolerances of the solver."""
    plant.bind(values)
    absolute = ABSOLUTE_TOLERANCE.copy()
    absolute[4] = plant.extra_tolerance
    states, report = odeint(
        plant.rates, state, times, rtol=RELATIVE_TOLERANCE * tolerance, atol=absolute * tolerance,
        hmax=2.0e-3, mxstep=200_000, full_output=True)
    if report["message"] != "Integration successful.":
        raise RuntimeError(report["message"])
    return states


def settled(plant, x, duration=1.0):
    """State after standing at place x with a closed valve for `duration` [s]; energies start at zero."""
    state = simulate(plant, [0.0] * int(duration * 1000 + 2), [0.0, duration], plant.start(x))[-1]
    state[5:] = 0.0
    return state
