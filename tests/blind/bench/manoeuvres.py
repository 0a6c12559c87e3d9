"""Plans open-loop commands that keep the actuator within its range.

A manoeuvre is a list of steps. The planner simulates the machine while it writes the command, as an operator would
rehearse it; what it returns is the command alone. Steps, with levels in the unit of the command:

    ("hold", duration)                     command zero
    ("set", level, duration)               a level for a time
    ("move", level, target)                this level until the share `target` of the range is reached; the sign follows
    ("sine", level, frequency, cycles)     a sine around a bias that brings it back to where it began
    ("multi", level, duration, frequencies)  a sum of sines, same rule
"""

import numpy as np

from plants import COMMAND_STEP_S, settled, simulate

PLAN_TOLERANCE = 100.0
CHUNK = 50
SECANT_TRIALS = 5
SLOWER_TRIALS = 9
AFTER_RAMP = 150


def ramp(start, end, slope_time):
    """Values from `start` (exclusive) to `end` within `slope_time` [s]."""
    count = max(int(round(slope_time / COMMAND_STEP_S)), 1)
    return [start + (end - start) * (i + 1) / count for i in range(count)]


class Planner:
    """Writes the command of one run, step by step."""

    def __init__(self, plant, rng, x_start, span, pressures):
        self.plant = plant
        self.rng = rng
        self.low, self.high = span
        self.pressures = pressures
        self.values = [0.0]
        self.state = settled(plant, x_start)
        self.start = self.state.copy()

    def trial(self, values):
        """States at each millisecond if `values` followed the command so far."""
        done = len(self.values) - 1
        times = (done + np.arange(len(values) + 1)) * COMMAND_STEP_S
        return simulate(self.plant, self.values + list(values), times, self.state, PLAN_TOLERANCE)

    def append(self, values):
        """Adds values to the command and moves the state on."""
        if len(values):
            self.state = self.trial(values)[-1]
            self.values.extend(values)

    def plan(self, script, duration, slopes=(0.01, 0.04, 0.15)):
        """Command values for `duration` [s]; the moves of the script are repeated when it ends early."""
        total = int(round(duration / COMMAND_STEP_S)) + 1
        moves = [step for step in script if step[0] == "move"]
        queue = list(script)
        while len(self.values) < total:
            step = queue.pop(0) if queue else moves[self.rng.integers(len(moves))]
            getattr(self, step[0])(*step[1:], slope=slopes[self.rng.integers(len(slopes))])
        return self.values[:total]

    def bearable(self, path):
        """Whether both pressures of a path stay within the limits."""
        pressures = path[:, 2:4]
        return self.pressures[0] <= pressures.min() and pressures.max() <= self.pressures[1]

    def towards(self, level, slope):
        """A ramp to a level, slower than `slope` [s] if the pressures would leave their limits, and its slope."""
        for _ in range(SLOWER_TRIALS):
            values = ramp(self.values[-1], level, slope)
            if self.bearable(self.trial(values + [level] * AFTER_RAMP)):
                break
            slope *= 1.5
        return values, slope

    def hold(self, duration, slope):
        self.set(0.0, duration, slope)

    def set(self, level, duration, slope):
        values, _ = self.towards(level, slope)
        self.append(values + [level] * int(round(duration / COMMAND_STEP_S)))

    def move(self, level, target, slope, longest=2.5):
        level *= self.rng.uniform(0.93, 1.07)
        place = self.low + (target + self.rng.uniform(-0.03, 0.03)) * (self.high - self.low)
        sign = 1.0 if place > self.state[0] else -1.0
        pending, slope = self.towards(sign * level, slope)
        for _ in range(int(longest / COMMAND_STEP_S / CHUNK)):
            values = pending + [sign * level] * CHUNK
            pending = []
            path = self.trial(values)[1:]
            # stop early by what the piston runs on while the command falls
            ahead = sign * (path[:, 0] + 0.5 * slope * path[:, 1] - place)
            beyond = np.nonzero(ahead >= 0.0)[0]
            if len(beyond):
                self.append(values[: beyond[0] + 1])
                return
            self.append(values)

    def sine(self, level, frequency, cycles, slope):
        count = int(round(cycles / frequency / COMMAND_STEP_S))
        t = np.arange(1, count + 1) * COMMAND_STEP_S
        self.returning(level, np.sin(2 * np.pi * frequency * t) * self.direction(), slope)

    def multi(self, level, duration, frequencies, slope):
        t = np.arange(1, int(round(duration / COMMAND_STEP_S)) + 1) * COMMAND_STEP_S
        phases = self.rng.uniform(0, 2 * np.pi, len(frequencies))
        shape = sum(np.sin(2 * np.pi * f * t + p) for f, p in zip(frequencies, phases))
        window = np.minimum(1.0, np.minimum(t, t[-1] - t) / 0.1)
        self.returning(level, window * shape / np.abs(shape).max(), slope)

    def direction(self):
        """Starts away from the nearer end of the range."""
        return 1.0 if self.state[0] < 0.5 * (self.low + self.high) else -1.0

    def returning(self, level, shape, slope):
        """Adds level * (shape + bias) with a bias for little net motion; smaller when it would leave its limits."""
        self.append(self.towards(0.0, slope)[0])
        count = np.arange(1, len(shape) + 1)
        window = np.minimum(1.0, np.minimum(count, count[::-1]) / 100.0)
        for _ in range(6):
            biases, drifts = [0.0, 0.1], []
            best = None
            for _ in range(SECANT_TRIALS):
                values = level * (shape + biases[len(drifts)] * window)
                states = self.trial(values)
                path = states[:, 0]
                drifts.append(path[-1] - path[0])
                inside = self.low <= path.min() and path.max() <= self.high and self.bearable(states)
                if inside and (best is None or abs(drifts[-1]) < best[0]):
                    best = (abs(drifts[-1]), values)
                if len(drifts) >= len(biases):
                    slope = (drifts[-1] - drifts[-2]) / (biases[-1] - biases[-2])
                    step = np.clip(-drifts[-1] / slope, -0.4, 0.4) if slope else 0.1
                    biases.append(float(np.clip(biases[-1] + step, -0.8, 0.8)) + 1e-6)
            if best is not None:
                self.append(list(best[1]))
                return
            level *= 0.75
