"""Runs a verb on one pair."""

from __future__ import annotations

import json
import tempfile
import time
import warnings
from dataclasses import dataclass, field
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from .. import _native
from .._errors import ReadError, Remark
from ._pairs import Job
from ._store import Store, joined, local_path

OWN_TOPICS = ("*arm/state", "*arm/orifice_command")
"""Patterns of the topics of this project, in any namespace."""


@dataclass(frozen=True)
class Done:
    """Result of the work on a pair."""

    json: str
    """The exact `--json` text of the program."""
    row: dict[str, Any]
    """One row of the results; see `excavator.fleet.ROW`."""
    remarks: list[str] = field(default_factory=list)
    """Remarks of the program on the recordings."""


def work(job: Job, store: Store) -> Done:
    """Runs the verb on the pair. Bags that are not on this machine are copied into a temporary folder, with only the required topics. Results
    contain the original addresses."""
    began = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="excavator-") as folder, warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always", Remark)
        desk = _Desk(job, store, Path(folder))
        identification = [desk.read(address) for address in job.pair.identification]
        validation = [desk.read(address) for address in job.pair.validation]
        result = _result(job, identification, validation)
        text = desk.named(result.to_json())
        remarks = [desk.named(str(one.message)) for one in told if issubclass(one.category, Remark)]
        stamp = (validation or identification)[0].start_nanoseconds
    recorded = job.pair.recorded
    if recorded is None and stamp > 0:
        recorded = datetime.fromtimestamp(stamp / 1e9, timezone.utc).isoformat()
    row = {
        "key": job.key,
        "machine": job.pair.machine,
        "model": job.pair.model,
        "recorded": recorded,
        "verb": job.verb,
        "seconds": time.monotonic() - began,
        "bytes_read": desk.bytes_read,
        "bytes_total": desk.bytes_total,
        "program": _native.__version__,
    }
    return Done(text, row, remarks)


class _Desk:
    """Makes the recordings of a job available on this machine."""

    def __init__(self, job: Job, store: Store, folder: Path) -> None:
        self.job, self.store, self.folder = job, store, folder
        self.bytes_read = self.bytes_total = 0
        self._addresses: list[tuple[str, str]] = []
        self._map: Path | None = None
        if job.map is not None and job.pair.map is not None:
            # A local map is used in place, because it may refer to neighbouring files.
            self._map = local_path(job.pair.map)
        if job.map is not None and self._map is None:
            self._map = folder / "map.toml"
            self._map.write_text(job.map, encoding="utf-8")

    def read(self, address: str) -> Any:
        from .. import read

        path = local_path(address)
        if path is None:
            # One folder for each recording, because recordings of one machine may have the same name.
            target = self.folder / str(len(self._addresses))
            copied = self.store.thin_copy(address, self._topics(address), target)
            path = copied.path
            self._addresses.append((str(path), address))
            self.bytes_read += copied.bytes_read
            self.bytes_total += copied.bytes_total
        else:
            size = sum(one.stat().st_size for one in (path.iterdir() if path.is_dir() else [path]) if one.is_file())
            self.bytes_read += size
            self.bytes_total += size
        return read(path, self._map)

    def named(self, text: str) -> str:
        """Replaces the paths of the copies in a text by the addresses of the recordings."""
        for path, address in self._addresses:
            text = text.replace(_escaped(path), _escaped(address))
        return text

    def _topics(self, address: str) -> list[str] | None:
        text = self.job.map
        if text is None and not address.rstrip("/").endswith((".mcap", ".db3", ".csv", ".parquet", ".mat", ".xlsx")):
            try:
                text = self.store.get(joined(address, "map.toml")).decode()
            except ReadError:
                text = None
        return list(OWN_TOPICS) if text is None else topics_of(text)


def topics_of(text: str) -> list[str] | None:
    """Returns the topics in a map; `None` if all may be needed: for a map of CAN frames, without topics, or on a Python without `tomllib`."""
    try:
        import tomllib
    except ImportError:
        return None
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ReadError(f"the map cannot be read: {error}") from error
    if "dbc" in content:
        return None
    found: set[str] = set()

    def look(value: Any) -> None:
        if isinstance(value, dict):
            if isinstance(value.get("topic"), str):
                found.add(value["topic"])
            for one in value.values():
                look(one)
        elif isinstance(value, list):
            for one in value:
                look(one)

    look(content)
    return sorted(found) or None


def _escaped(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)[1:-1]


def _result(job: Job, identification: list[Any], validation: list[Any]) -> Any:
    from .. import Model, diagnose, identify

    model = Model.load(job.pair.model) if job.model is None else Model.from_toml(job.model, name=job.pair.model)
    if job.verb == "identify":
        return identify(model, identification, **job.options)
    if job.verb == "diagnose":
        return diagnose(model, identification, validation, **job.options)
    raise ValueError(f'a fleet has no verb "{job.verb}"; there are diagnose and identify')
