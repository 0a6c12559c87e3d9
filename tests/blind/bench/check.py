"""Self-check of the simulator and of the cases: python check.py --seed 11

For each run: the energy balance closes; half the solver tolerance, and a hundredth of it, change no signal by more than
a tenth of its noise; the actuator stays in range and the pressures stay physical; the hidden effect changes some signal
by at least three times its noise (root mean square), against the plain machine that resembles it most.
"""

import argparse
import sys

import numpy as np

from plants import simulate
from production import NUMBERS, define, recordings, rehearse
from sensors import SOURCES

BALANCE_SHARE = 1.0e-5
"""Largest error of the energy balance, as a share of the energy that was lost in the run."""
NOISE_SHARE = 0.1
VISIBLE = 3.0
LOWEST_PA = -1.0e5
MEASURED = tuple(SOURCES)


def in_noise(case, difference):
    """Root mean square of a difference of states in each measured signal, in units of its noise."""
    return {
        s.source: float(np.sqrt(np.mean((difference[:, SOURCES[s.source]] * s.scale) ** 2)) / s.noise)
        for s in case.sensors if s.source in MEASURED
    }


def held_share(states, stops):
    """Share of the time in contact with a stop."""
    return float(np.mean((states[:, 0] >= stops.high) | (states[:, 0] <= stops.low))) if stops else 0.0


def check(number, seed):
    """Prints one line for each run of a case and returns what is wrong."""
    case, rng = define(number, seed)
    wrong = []
    for rehearsed in rehearse(case, rng):
        run, states = rehearsed.run, rehearsed.states
        label = f"{case.name} {run.stem}"

        def again(effect=True, tolerance=1.0):
            plant = case.plant(effect, run.supply)
            return simulate(plant, rehearsed.values, rehearsed.times, rehearsed.start, tolerance)

        plant = case.plant(True, run.supply)
        stored = np.array([plant.stored(state) for state in states])
        balance = np.abs(stored - stored[0] - states[:, 5] + states[:, 6]).max() / states[-1, 6]
        halved = max(in_noise(case, again(tolerance=0.5) - states).values())
        tight = max(in_noise(case, again(tolerance=0.01) - states).values())
        stops = plant.actuator.stops
        low, high = (stops.low, stops.high) if stops else (-np.inf, np.inf)
        held = held_share(states, stops)
        lowest = states[:, 2:4].min()
        still = float(np.mean(np.abs(states[:, 1]) < 2e-3))
        wrong += [f"{label}: {text}" for bad, text in (
            (balance > BALANCE_SHARE, f"energy balance off by {balance:.1e}"),
            (halved > NOISE_SHARE, f"half tolerance changes a signal by {halved:.3f} of its noise"),
            (tight > NOISE_SHARE, f"a hundredth of the tolerance changes a signal by {tight:.3f} of its noise"),
            (number != 2 and held > 0.0, "touches a stop"),
            (number == 2 and not 0.2 < held < 0.45, f"held at the stops {held:.0%} of the time"),
            (states[:, 0].min() < low - 2e-3 or states[:, 0].max() > high + 2e-3, "leaves its range"),
            (lowest < LOWEST_PA, f"pressure down to {lowest / 1e5:.1f} bar"),
            (np.diff(states[:, 6]).min() < 0.0, "an element gives energy that should lose it"),
        ) if bad]
        shown = ""
        if case.answer["hidden"] != "nothing":
            effect = in_noise(case, again(effect=False) - states)
            shown = " effect/noise " + " ".join(f"{name} {value:.1f}" for name, value in effect.items())
            if max(effect.values()) < VISIBLE:
                wrong.append(f"{label}: effect hardly visible{shown}")
        if run.pieces:
            recordings(case, rehearsed)
        print(f"{label}: balance {balance:.0e}, halved {halved:.4f}, tight {tight:.4f}, at stops {held:.0%}, "
              f"still {still:.0%}, p >= {lowest / 1e5:.1f} bar{shown}", flush=True)
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=11)
    parser.add_argument("--only", type=int, nargs="*", default=list(NUMBERS))
    arguments = parser.parse_args()
    wrong = [text for number in arguments.only for text in check(number, arguments.seed)]
    print("\n".join(wrong) or "all good")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
