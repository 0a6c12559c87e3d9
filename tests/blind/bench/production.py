"""Runs the plans of a case and gives the true signals of each recording."""

from dataclasses import dataclass
from importlib import import_module

import numpy as np

from case import Case
from manoeuvres import Planner
from plants import COMMAND_STEP_S, simulate

NUMBERS = range(1, 11)
PIECE_S = 1.0
MOVING = 0.01
"""Speed [m/s] that a piece must have at its start and end."""


@dataclass
class Recording:
    """One file: its stem, the times [s] from its own start, true states and commands, and the supply [Pa]."""

    stem: str
    times: np.ndarray
    states: np.ndarray
    commands: np.ndarray
    supply: float | None


@dataclass
class Rehearsed:
    """A run with its command and start state, ready to be simulated again in other ways."""

    run: object
    values: list
    start: np.ndarray
    times: np.ndarray
    states: np.ndarray


def define(number, seed) -> tuple[Case, np.random.Generator]:
    """A case and the generator of random numbers that goes on with it."""
    rng = np.random.default_rng([seed, number])
    return import_module(f"definitions.case_{number:02d}").build(rng), rng


def rehearse(case, rng):
    """Plans and simulates all runs of a case."""
    done = []
    for run in case.runs:
        plant = case.plant(True, run.supply)
        planner = Planner(plant, rng, run.x_start, case.span, case.pressures)
        values = planner.plan(run.script, run.duration, run.slopes)
        times = np.arange(int(round(run.duration * case.rate)) + 1) / case.rate
        states = simulate(plant, values, times, planner.start)
        done.append(Rehearsed(run, values, planner.start, times, states))
    return done


def recordings(case, rehearsed):
    """The files of a run: the whole of it, or pieces in motion."""
    run, times, states = rehearsed.run, rehearsed.times, rehearsed.states
    commands = np.interp(times, np.arange(len(rehearsed.values)) * COMMAND_STEP_S, rehearsed.values)
    if not run.pieces:
        return [Recording(run.stem, times, states, commands, run.supply)]
    length = int(PIECE_S * case.rate)
    found, first = [], int(0.3 * case.rate)
    while first + length < len(times) and len(found) < run.pieces:
        if min(abs(states[first, 1]), abs(states[first + length, 1])) > MOVING:
            piece = slice(first, first + length + 1)
            stem = f"{run.stem}_{len(found) + 1:02d}"
            found.append(Recording(stem, times[: length + 1], states[piece], commands[piece], run.supply))
            first += length
        first += int(0.05 * case.rate)
    if len(found) < run.pieces:
        raise RuntimeError(f"only {len(found)} pieces in motion of {run.pieces}")
    return found
