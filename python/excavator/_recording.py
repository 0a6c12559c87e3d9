"""Recordings: signals of one machine on one clock."""

from __future__ import annotations

import html
import os
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._errors import remark
from ._optional import needed

if TYPE_CHECKING:
    import pandas
    import polars
    import pyarrow
    from matplotlib.figure import Figure

Path = str | os.PathLike[str]
Map = Path | Mapping[str, Any]

TIME = "time"
"""Name of the time column in tables."""


def read(
    path: Path,
    map: Map | None = None,
    *,
    namespace: str | None = None,
    start: float | None = None,
    stop: float | None = None,
) -> Recording:
    """Reads a recording.

    `path` is a rosbag2 folder, an `.mcap` or `.db3` file, or a table (CSV, XLSX, Parquet, MATLAB). Data with custom names needs a topic
    `map`: a file, or a `dict` with the same keys. By default, `map.toml` in the folder of the bag or `FILE.map.toml` next to the file is
    used, if it exists. `namespace` selects a machine in a bag with several machines. `start` and `stop` (s after the first sample) select
    a part.

    Flaws in the data are reported as warnings of the category `Remark`.
    """
    given = dict(map) if isinstance(map, Mapping) else map
    recording = Recording(_native.read(path, given, namespace, start, stop))
    remark(f"{recording.source}: {line}" for line in recording.remarks)
    return recording


def guess_map(path: Path, cylinder: str = "arm") -> str:
    """Returns a draft topic map for data with custom names, as TOML with a reason on each line. Check every line.

    `cylinder` is the cylinder for signals whose names do not identify one.
    """
    return _native.guess_map(path, cylinder)


class Recording:
    """Signals of one machine on one clock, in SI units; `NaN` means "not measured".

    `rec.time` and `rec["arm.cap_pressure"]` are NumPy arrays that share memory with the recording. They are read-only; use
    `rec["x"].copy()` for an array that you can modify. `rec.with_signals(...)` returns a recording with other values.
    """

    __slots__ = ("_native",)

    def __init__(self, native: _native.Recording) -> None:
        self._native = native

    @classmethod
    def from_arrays(
        cls,
        time: ArrayLike,
        signals: Mapping[str, ArrayLike],
        *,
        source: str = "arrays",
        start_nanoseconds: int = 0,
    ) -> Recording:
        """Creates a recording from times in s (strictly increasing; shifted so that the first is 0) and values in SI units by signal name
        (`arm.displacement`, `pump_pressure`)."""
        times = _column(time)
        if len(times) and np.isfinite(times[0]):
            start_nanoseconds += round(float(times[0]) * 1e9)
            times = times - times[0]
        columns = [(name, np.broadcast_to(_column(values), times.shape).copy()) for name, values in signals.items()]
        return cls(_native.Recording.from_columns(times, columns, source, start_nanoseconds))

    @property
    def source(self) -> str:
        """Source of the signals."""
        return self._native.source

    @property
    def time(self) -> NDArray[np.float64]:
        """Times of the samples, s after the first."""
        return self._native.time

    @property
    def start_nanoseconds(self) -> int:
        """Timestamp of the first sample, ns since the Unix epoch."""
        return self._native.start_nanoseconds

    @property
    def duration(self) -> float:
        """Time from the first sample to the last, s."""
        return self._native.duration

    @property
    def sample_interval(self) -> float:
        """Median time between samples, s."""
        return self._native.sample_interval

    @property
    def signals(self) -> dict[str, str]:
        """Names of the measured signals, with their units."""
        return {name: unit for name, unit, is_measured in self._native.names() if is_measured}

    @property
    def remarks(self) -> list[str]:
        """Flaws in the data, one line each."""
        return self._native.remarks

    def __len__(self) -> int:
        return len(self._native)

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        return self._native.column(name)

    def __contains__(self, name: object) -> bool:
        return name in self.signals

    def __iter__(self) -> Iterator[str]:
        return iter(self.signals)

    def keys(self) -> list[str]:
        """Names of the measured signals. Required for `dict(rec)`."""
        return list(self.signals)

    def part(self, start: float | None = None, stop: float | None = None) -> Recording:
        """Returns the samples from `start` to `stop`, s after the first sample."""
        return Recording(self._native.part(start, stop))

    def with_signals(self, signals: Mapping[str, ArrayLike]) -> Recording:
        """Returns a recording on the same clock with these signals added or replaced (SI units)."""
        columns = {name: self[name] for name in self} | dict(signals)
        return Recording.from_arrays(self.time, columns, source=self.source, start_nanoseconds=self.start_nanoseconds)

    def write(self, folder: Path, *, namespace: str = "/", replace: bool = False) -> None:
        """Writes a bag that the program and ROS 2 can read (MCAP, with the topics of this project in `namespace`)."""
        self._native.write(folder, namespace, replace)

    def _table(self) -> dict[str, NDArray[np.float64]]:
        return {TIME: self.time} | {name: self[name] for name in self}

    def to_pandas(self) -> pandas.DataFrame:
        """Returns measured signals as columns, with times in s as the index. Requires pandas."""
        pandas = needed("pandas", "to_pandas")
        table = self._table()
        return pandas.DataFrame(table, index=pandas.Index(table.pop(TIME), name=TIME))

    def to_polars(self) -> polars.DataFrame:
        """Returns times (`time`, s) and measured signals as columns. Requires Polars."""
        return needed("polars", "to_polars").DataFrame(self._table())

    def to_arrow(self) -> pyarrow.Table:
        """Returns times (`time`, s) and measured signals as columns that share memory with the recording. Field metadata contains the
        units. Requires PyArrow."""
        pyarrow = needed("pyarrow", "to_arrow")
        units = {TIME: "s"} | self.signals
        table = self._table()
        fields = [pyarrow.field(name, pyarrow.float64(), metadata={"unit": units[name]}) for name in table]
        return pyarrow.table([pyarrow.array(values) for values in table.values()], schema=pyarrow.schema(fields))

    def plot(self, *names: str) -> Figure:
        """Plots signals over time, with one axis for each unit. By default, plots all signals. Requires Matplotlib."""
        from ._plots import of_recording

        return of_recording(self, names)

    def __repr__(self) -> str:
        return f"<Recording {self.source}: {len(self)} samples, {self.duration:.2f} s, {len(self.signals)} signals>"

    def _repr_html_(self) -> str:
        rows = []
        for name, unit in self.signals.items():
            values = self[name]
            known = values[np.isfinite(values)]
            share = len(known) / len(values)
            cells = f"{known.min():.6g}", f"{known.mean():.6g}", f"{known.max():.6g}", f"{100 * share:.0f} %"
            text = "".join(f"<td>{cell}</td>" for cell in cells)
            rows.append(f"<tr><th>{html.escape(name)}</th><td>{html.escape(unit)}</td>{text}</tr>")
        heads = "".join(f"<th>{head}</th>" for head in ("signal", "unit", "least", "mean", "largest", "measured"))
        lead = f"{html.escape(self.source)}: {len(self)} samples, {self.duration:.2f} s"
        return f"<p>{lead}</p><table><thead><tr>{heads}</tr></thead><tbody>{''.join(rows)}</tbody></table>"


def _column(values: ArrayLike) -> NDArray[np.float64]:
    return np.ascontiguousarray(values, dtype=np.float64)
