"""Measurement chains: scale, noise, converter, digits, lost cells."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Sensor:
    """One column of a recording.

    `source` is "x", "v", "pa", "pb", "extra", "supply" or "command"; `scale` turns its SI value (or the command) into
    the unit of the column; `noise` is a standard deviation and `span` the measuring range (low, high), both in that
    unit; `bits` is the resolution of the converter over the span, 0 for none; `digits` are decimals in the file.
    """

    heading: str
    source: str
    scale: float
    noise: float
    span: tuple
    digits: int
    bits: int = 0
    unit: str = ""

    def read(self, true, rng):
        """Readings for the true values in SI."""
        values = true * self.scale + rng.normal(0.0, self.noise, len(true))
        if self.bits:
            step = (self.span[1] - self.span[0]) / 2**self.bits
            values = np.round(values / step) * step
            values = np.clip(values, self.span[0], self.span[1])
        return np.round(values, self.digits)


SOURCES = {"x": 0, "v": 1, "pa": 2, "pb": 3, "extra": 4}


def true_signal(sensor, states, commands, supply):
    """What the sensor looks at, without noise, in SI or in the command's unit."""
    if sensor.source == "command":
        return np.asarray(commands, float)
    if sensor.source == "supply":
        return np.full(len(states), supply)
    return states[:, SOURCES[sensor.source]]


def lose_cells(columns, share, rng, runs=(20, 60)):
    """Puts NaN into about `share` of the cells: half single, half in runs in one column at a time."""
    names = list(columns)
    rows = len(columns[names[0]])
    single = 0.5 * share
    for name in names:
        columns[name][rng.random(rows) < single] = np.nan
    lost = 0
    while lost < 0.5 * share * rows * len(names):
        length = int(rng.integers(runs[0], runs[1] + 1))
        first = int(rng.integers(0, rows - length))
        columns[names[rng.integers(len(names))]][first : first + length] = np.nan
        lost += length
    return columns
