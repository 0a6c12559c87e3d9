"""What a case is made of."""

from dataclasses import dataclass
from typing import Callable

from tables import Style


@dataclass(frozen=True)
class Run:
    """One simulated run: file stem, plan and length. With `pieces`, windows of one second are cut out of it."""

    stem: str
    script: list
    duration: float
    x_start: float
    slopes: tuple = (0.01, 0.04, 0.15)
    supply: float | None = None
    pieces: int = 0


@dataclass
class Case:
    """A machine, its runs and sensors, its data sheet and the truth.

    `pressures` [Pa] are the limits that the manoeuvres keep to. `plant(effect, supply)` builds the machine with or without the hidden effect; without it, the other coefficients
    take the values that resemble the effect most. `span` is the range of x that manoeuvres stay in.
    """

    name: str
    plant: Callable
    runs: list
    sensors: list
    style: Style
    rate: int
    span: tuple
    pressures: tuple
    machine: dict
    answer: dict
    lost_cells: float = 0.0


def around(rng, value, share):
    """A value within +- share of another."""
    return float(value * rng.uniform(1.0 - share, 1.0 + share))


def rounded(value, digits=3):
    """A value to a number of significant digits, as on a data sheet."""
    return float(f"{value:.{digits}g}")


def quantity(value, unit, note=""):
    """A value with its unit, for the answer."""
    entry = {"value": float(f"{value:.6g}"), "unit": unit}
    if note:
        entry["note"] = note
    return entry
