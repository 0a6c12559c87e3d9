"""Storage of results, and results as tables.

    RESULTS/done/KEY.json        the program's --json, written once
    RESULTS/rows/KEY.json        one row: machine, times, seconds, bytes
    RESULTS/poison/KEY.json      what cannot be done, and why
    RESULTS/results.parquet      all rows, with verdicts and errors
    RESULTS/parameters.parquet   a row for each parameter of each result
    RESULTS/effects.parquet      a row for each effect that was tried
"""

from __future__ import annotations

import io
import json
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from datetime import datetime, timezone
from typing import TYPE_CHECKING, Any

from ._pairs import Job
from ._store import Store, joined
from ._unit import Done

if TYPE_CHECKING:
    import pyarrow

AT_A_TIME = 16
"""Number of small objects that are read concurrently."""

ROW = {
    "key": "string",
    "machine": "string",
    "model": "string",
    "recorded": "timestamp[us, tz=UTC]",
    "verb": "string",
    "verdict": "string",
    "effects": "list<string>",
    "error_before": "double",
    "error_after": "double",
    "seconds": "double",
    "bytes_read": "int64",
    "bytes_total": "int64",
    "program": "string",
}
"""Columns of `results.parquet`. `error_before` and `error_after` are the errors on the validation recordings, as in the JSON; `effects` are
the effects of the verdict, as `EFFECT@PLACE`; `seconds` is the duration of the work."""

PARAMETER = {
    "key": "string",
    "machine": "string",
    "recorded": "timestamp[us, tz=UTC]",
    "effect": "string",
    "parameter": "string",
    "value": "double",
    "std_error": "double",
    "margin_95": "double",
    "unit": "string",
}
"""Columns of `parameters.parquet`. `effect` is empty for refitted parameters of the given model; otherwise it is the effect that the verdict
added. Values and margins are in `unit`, an SI unit."""

EFFECT = {
    "key": "string",
    "machine": "string",
    "recorded": "timestamp[us, tz=UTC]",
    "effect": "string",
    "place": "string",
    "in_verdict": "bool",
    "error_before": "double",
    "error_after": "double",
    "evidence": "double",
}
"""Columns of `effects.parquet`, with a row for every effect that was tried. Errors are on the validation recordings, without and with it."""

TABLES = {"results": ROW, "parameters": PARAMETER, "effects": EFFECT}
"""The tables with their columns and types."""


@dataclass(frozen=True)
class Poison:
    """Work that failed permanently."""

    key: str
    """Key of the job."""
    machine: str
    """Name of the machine."""
    kind: str
    """Cause of the last failure: `data` (an unusable recording, map or model), `fault` (another error), or `death` (the worker died)."""
    error: str
    """Error message."""
    attempts: int
    """Number of failed attempts."""
    recordings: tuple[str, ...] = ()
    """Addresses of the recordings."""


class Results:
    """A folder with results, in any store. Every write is a single object, so there are no partial writes."""

    def __init__(self, address: str, store: Store | None = None) -> None:
        self.address, self.store = address.rstrip("/"), store or Store()

    def _at(self, kind: str, key: str) -> str:
        return joined(self.address, kind, f"{key}.json")

    def _keys(self, kind: str) -> set[str]:
        found = self.store.list(joined(self.address, kind))
        names = (one.url.rpartition("/")[2] for one in found)
        return {name.removesuffix(".json") for name in names if name.endswith(".json")}

    def done(self) -> set[str]:
        """Returns the keys of all completed jobs, with a single listing."""
        return self._keys("done")

    def poisoned(self) -> set[str]:
        """Returns the keys of all jobs on the poison list that have not been completed since."""
        return self._keys("poison") - self.done()

    def save(self, job: Job, done: Done) -> bool:
        """Writes a result. Returns false if it already existed. The row is written first, so that every key in `done` is complete."""
        row = json.dumps(done.row | {"remarks": done.remarks}, ensure_ascii=False)
        self.store.put(self._at("rows", job.key), row.encode())
        return self.store.put_if_absent(self._at("done", job.key), done.json.encode())

    def refuse(self, poison: Poison) -> None:
        """Adds an entry to the poison list."""
        self.store.put(self._at("poison", poison.key), json.dumps(vars(poison), ensure_ascii=False).encode())

    def json(self, key: str) -> str:
        """Returns a result as the `--json` text of the program."""
        return self.store.get(self._at("done", key)).decode()

    def poison(self) -> list[Poison]:
        """Returns the poison list, sorted by machine."""
        texts = self._read("poison", self.poisoned())
        found = [Poison(**(row | {"recordings": tuple(row["recordings"])})) for row in map(json.loads, texts)]
        return sorted(found, key=lambda one: (one.machine, one.key))

    def collect(self) -> dict[str, pyarrow.Table]:
        """Writes `results.parquet`, `parameters.parquet` and `effects.parquet` of all completed jobs, and returns the tables. Requires PyArrow."""
        from .._optional import needed

        pyarrow, parquet = needed("pyarrow", "collect"), needed("pyarrow.parquet", "collect")
        keys = sorted(self.done())
        rows = list(map(json.loads, self._read("rows", keys)))
        texts = list(map(json.loads, self._read("done", keys)))
        content: dict[str, list[dict[str, Any]]] = {name: [] for name in TABLES}
        for row, text in zip(rows, texts):
            row["recorded"] = moment(row["recorded"])
            content["results"].append(row | summary_of(text))
            common = {name: row[name] for name in ("key", "machine", "recorded")}
            content["parameters"] += [common | one for one in parameters_of(text)]
            content["effects"] += [common | one for one in effects_of(text)]
        tables = {}
        for name, columns in TABLES.items():
            schema = pyarrow.schema([(column, _type(pyarrow, kind)) for column, kind in columns.items()])
            table = pyarrow.Table.from_pylist([{one: row.get(one) for one in columns} for row in content[name]], schema=schema)
            table = table.sort_by([("machine", "ascending"), ("recorded", "ascending"), ("key", "ascending")])
            buffer = io.BytesIO()
            parquet.write_table(table, buffer, compression="zstd")
            self.store.put(joined(self.address, f"{name}.parquet"), buffer.getvalue())
            tables[name] = table
        return tables

    def _read(self, kind: str, keys: Iterable[str]) -> list[bytes]:
        with ThreadPoolExecutor(AT_A_TIME) as threads:
            return list(threads.map(lambda key: self.store.get(self._at(kind, key)), keys))


def moment(text: str | None) -> datetime | None:
    """Parses an ISO 8601 time and converts it to UTC. A time without a zone is taken as UTC."""
    if not text:
        return None
    found = datetime.fromisoformat(text.replace("Z", "+00:00"))
    return found.replace(tzinfo=timezone.utc) if found.tzinfo is None else found.astimezone(timezone.utc)


def summary_of(text: dict[str, Any]) -> dict[str, Any]:
    """Returns verdict, effects and errors of a result."""
    errors = text.get("validation_error") or {}
    return {
        "verdict": text.get("verdict"),
        "effects": [f"{one['effect']}@{one['cylinder']}" for one in _in_verdict(text)],
        "error_before": errors.get("before"),
        "error_after": errors.get("after"),
    }


def parameters_of(text: dict[str, Any]) -> list[dict[str, Any]]:
    """Returns the parameters of a result: those of the given model, and those of effects that the verdict added."""
    own = [("", one) for one in text.get("refitted") or text.get("parameters") or []]
    for effect in _in_verdict(text):
        own += [(f"{effect['effect']}@{effect['cylinder']}", one) for one in effect.get("parameters") or []]
    return [
        {
            "effect": effect,
            "parameter": one["name"],
            "value": one.get("value"),
            "std_error": one.get("std_error"),
            "margin_95": one.get("margin_95"),
            "unit": one.get("unit"),
        }
        for effect, one in own
    ]


def effects_of(text: dict[str, Any]) -> list[dict[str, Any]]:
    """Returns the effects that were tried."""
    named = {(one["effect"], one["cylinder"]) for one in _in_verdict(text)}
    tried = [*(text.get("candidates") or []), *(text.get("rejected") or [])]
    return [
        {
            "effect": one["effect"],
            "place": one["cylinder"],
            "in_verdict": (one["effect"], one["cylinder"]) in named,
            "error_before": one.get("validation_error_before"),
            "error_after": one.get("validation_error_after"),
            "evidence": one.get("evidence"),
        }
        for one in tried
    ]


def _in_verdict(text: dict[str, Any]) -> list[dict[str, Any]]:
    if text.get("verdict") != "missing_effect":
        return []
    return text.get("effects") or (text.get("candidates") or [])[:1]


def _type(pyarrow: Any, kind: str) -> Any:
    if kind.startswith("timestamp"):
        return pyarrow.timestamp("us", tz="UTC")
    return {
        "string": pyarrow.string(),
        "double": pyarrow.float64(),
        "int64": pyarrow.int64(),
        "bool": pyarrow.bool_(),
        "list<string>": pyarrow.list_(pyarrow.string()),
    }[kind]
