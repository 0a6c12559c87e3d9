"""Plots with Matplotlib."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Protocol

from ._optional import needed

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

WIDTH, HEIGHT = 9.0, 1.9
"""Width and height of one axis, in inches."""


class Signals(Protocol):
    """Signals on one clock, as a recording has them."""

    @property
    def time(self) -> NDArray[np.float64]:
        """Sample times, s."""

    @property
    def signals(self) -> Mapping[str, str]:
        """The unit of each measured signal."""

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        """The values of a signal."""


def of_recording(recording: Signals, names: Sequence[str]) -> Figure:
    """Plots signals over time, with one axis for each unit."""
    units = recording.signals
    chosen = list(names) or list(units)
    by_unit: dict[str, list[str]] = {}
    for name in chosen:
        by_unit.setdefault(units.get(name, ""), []).append(name)
    figure, axes = _axes(len(by_unit))
    for axis, (unit, group) in zip(axes, by_unit.items()):
        for name in group:
            axis.plot(recording.time, recording[name], label=name, linewidth=0.9)
        axis.set_ylabel(unit)
        axis.legend(loc="upper right", fontsize="small")
    axes[-1].set_xlabel("time, s")
    return figure


def of_comparison(measured: Signals, simulated: Mapping[str, Signals], signals: Sequence[str]) -> Figure:
    """Plots measured and simulated signals over time, with one axis for each signal."""
    figure, axes = _axes(len(signals))
    units = measured.signals
    for axis, name in zip(axes, signals):
        axis.plot(measured.time, measured[name], label="measured", color="0.55", linewidth=1.6)
        for label, recording in simulated.items():
            axis.plot(recording.time, recording[name], label=label, linewidth=0.9)
        axis.set_ylabel(f"{name}\n{units.get(name, '')}", fontsize="small")
    axes[0].legend(loc="upper right", fontsize="small")
    axes[-1].set_xlabel("time, s")
    return figure


def of_parameters(parameters: Sequence[Mapping[str, Any]]) -> Figure:
    """Plots the 95 % intervals of identified parameters, relative to their values."""
    figure, (axis,) = _axes(1, rows=len(parameters))
    known = [one for one in parameters if one["margin_95"] is not None and one["value"]]
    places = range(len(known))
    axis.errorbar([1.0] * len(known), places, xerr=[abs(one["margin_95"] / one["value"]) for one in known], fmt="o", capsize=3)
    axis.set_yticks(places, [f"{one['name']} = {one['value']:.4g} {one['unit']}" for one in known], fontsize="small")
    axis.set_xlabel("95 % interval, relative to the value")
    axis.invert_yaxis()
    return figure


def of_candidates(candidates: Sequence[Mapping[str, Any]]) -> Figure:
    """Plots the errors on the validation recordings without and with each effect."""
    figure, (axis,) = _axes(1, rows=len(candidates))
    places = range(len(candidates))
    after = [one["validation_error_after"] for one in candidates]
    axis.barh(places, [float("nan") if error is None else error for error in after], height=0.6)
    before = [one["validation_error_before"] for one in candidates if one["validation_error_before"] is not None]
    if before:
        axis.axvline(before[0], color="0.5", linestyle="--", label="without")
        axis.legend(fontsize="small")
    axis.set_yticks(places, [f"{one['effect']}@{one['cylinder']}" for one in candidates], fontsize="small")
    axis.set_xlabel("NMSE on the validation recordings")
    axis.invert_yaxis()
    return figure


def of_bars(values: Mapping[str, float], label: str) -> Figure:
    """Plots a bar for each value."""
    figure, (axis,) = _axes(1, rows=len(values))
    axis.barh(range(len(values)), list(values.values()), height=0.6)
    axis.set_yticks(range(len(values)), list(values), fontsize="small")
    axis.set_xlabel(label)
    axis.invert_yaxis()
    return figure


def _axes(count: int, rows: int = 0) -> tuple[Figure, Sequence[Any]]:
    """Returns a figure and `count` axes, one below the other, high enough for `rows` rows."""
    pyplot = needed("matplotlib.pyplot", "plot")
    height = max(HEIGHT * max(count, 1), 1.0 + 0.25 * rows)
    figure, axes = pyplot.subplots(
        max(count, 1), 1, sharex=True, squeeze=False, figsize=(WIDTH, height), layout="constrained"
    )
    if "inline" in needed("matplotlib", "plot").get_backend():
        # A notebook shows the return value of a cell. It would show an open figure a second time.
        pyplot.close(figure)
    return figure, axes[:, 0]
