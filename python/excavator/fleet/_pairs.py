"""Pairs of recordings, and a job with a unique key for each pair."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import os
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

from .. import _native
from .._errors import ExcavatorError
from ._store import Store, is_url, joined

AT_A_TIME = 8
"""Number of addresses that are read concurrently. An object costs one request, a folder one more."""

SEPARATOR = ";"
"""Separator between several recordings in a cell of a CSV manifest."""


@dataclass(frozen=True)
class Pair:
    """The recordings of one machine at one time: one unit of work of a fleet."""

    machine: str
    """Name of the machine in the results."""
    model: str
    """Name of a built-in model, or address of a model file (`.toml`)."""
    identification: tuple[str, ...]
    """Addresses of the recordings to which parameters are fitted."""
    validation: tuple[str, ...]
    """Addresses of the validation recordings; `identify` needs none."""
    map: str | None = None
    """Address of a topic map, for data with custom names. By default, `map.toml` in the folder of a bag is used."""
    recorded: str | None = None
    """Time of the recording, ISO 8601 (`2026-05-01T12:00:00Z`). By default, the timestamp of the first sample is used."""

    @classmethod
    def of(cls, row: Mapping[str, Any]) -> Pair:
        """Creates a pair from a row of a manifest, with the fields of `Pair` as keys. Several recordings are a list, or a text separated by `;`."""
        unknown = sorted(set(row) - set(cls.__dataclass_fields__))
        if unknown:
            raise ValueError(f"a manifest has no column {', '.join(unknown)}; there are {', '.join(cls.__dataclass_fields__)}")
        for name in ("machine", "model", "identification"):
            if not row.get(name):
                raise ValueError(f"a row of the manifest has no {name}: {dict(row)}")
        recorded = row.get("recorded") or None
        return cls(
            machine=str(row["machine"]),
            model=str(row["model"]),
            identification=_several(row["identification"]),
            validation=_several(row.get("validation")),
            map=row.get("map") or None,
            recorded=recorded.isoformat() if hasattr(recorded, "isoformat") else recorded,
        )

    @property
    def recordings(self) -> tuple[str, ...]:
        """All recordings of the pair."""
        return self.identification + self.validation


@dataclass(frozen=True)
class Job:
    """A pair with everything on which its result depends."""

    key: str
    """Identity of the job: SHA-256 of the contents of its recordings, model and map, of verb and options, and of the version of the program."""
    pair: Pair
    verb: str
    options: Mapping[str, Any]
    """Options of the verb: `accept`, `where`, `whole`."""
    model: str | None
    """Text of the model file; `None` for a built-in model."""
    map: str | None
    """Text of the topic map."""


def read_manifest(address: str | os.PathLike[str], store: Store | None = None) -> list[Pair]:
    """Reads pairs from a CSV or Parquet file with a column for each field of `Pair`. Paths are relative to the manifest."""
    address, store = os.fspath(address), store or Store()
    content = store.get(address)
    if address.endswith((".parquet", ".pq")):
        import pyarrow.parquet

        rows: Iterable[Mapping[str, Any]] = pyarrow.parquet.read_table(io.BytesIO(content)).to_pylist()
    else:
        rows = csv.DictReader(io.StringIO(content.decode("utf-8-sig")))
    folder = address.rpartition("/")[0] if "/" in address else "."
    return [_beside(Pair.of(row), folder) for row in rows]


def _beside(pair: Pair, folder: str) -> Pair:
    def full(address: str) -> str:
        return address if is_url(address) or address.startswith("/") else joined(folder, address)

    return Pair(
        machine=pair.machine,
        model=full(pair.model) if _is_file(pair.model) else pair.model,
        identification=tuple(map(full, pair.identification)),
        validation=tuple(map(full, pair.validation)),
        map=None if pair.map is None else full(pair.map),
        recorded=pair.recorded,
    )


def pairs_of(given: Iterable[Pair | Mapping[str, Any]]) -> list[Pair]:
    """Converts every `dict` to a `Pair`."""
    return [one if isinstance(one, Pair) else Pair.of(one) for one in given]


def resolve(
    pairs: Sequence[Pair], store: Store, *, verb: str = "diagnose", options: Mapping[str, Any] | None = None
) -> tuple[list[Job], list[tuple[Pair, str]]]:
    """Returns the jobs of the pairs in order, without duplicate keys, and the pairs that cannot be run, with the reason.

    Every address is read once, even if several pairs contain it.
    """
    documents = {pair.model for pair in pairs if _is_file(pair.model)} | {pair.map for pair in pairs if pair.map}
    recordings = {address for pair in pairs for address in pair.recordings}
    with ThreadPoolExecutor(AT_A_TIME) as threads:
        contents = dict(zip(documents, threads.map(_kept(lambda one: store.get(one).decode()), documents)))
        prints = dict(zip(recordings, threads.map(_kept(store.fingerprint), recordings)))
    jobs: dict[str, Job] = {}
    refused: list[tuple[Pair, str]] = []
    for pair in pairs:
        needed = [prints[one] for one in pair.recordings]
        needed += [contents[one] for one in (pair.model, pair.map) if one in contents]
        failed = next((one for one in needed if isinstance(one, ExcavatorError)), None)
        if failed is not None:
            if _is_passing(failed):
                raise failed
            refused.append((pair, str(failed)))
            continue
        model = contents.get(pair.model)
        text = contents.get(pair.map) if pair.map else None
        given = dict(options or {})
        identity = {
            "program": _native.__version__,
            "verb": verb,
            "options": given,
            "model": {"file": model} if model is not None else {"built_in": pair.model},
            "map": text,
            "identification": [prints[one] for one in pair.identification],
            "validation": [prints[one] for one in pair.validation],
        }
        job = Job(key_of(identity), pair, verb, given, model, text)
        jobs.setdefault(job.key, job)
    return list(jobs.values()), refused


def key_of(identity: Mapping[str, Any]) -> str:
    """Returns the SHA-256 of the canonical JSON form: sorted names, no spaces."""
    text = json.dumps(identity, sort_keys=True, separators=(",", ":"), ensure_ascii=True)
    return hashlib.sha256(text.encode()).hexdigest()


def _kept(function):  # type: ignore[no-untyped-def]
    """Wraps `function` to return an `ExcavatorError` instead of raising it."""

    def kept(given: str) -> Any:
        try:
            return function(given)
        except ExcavatorError as error:
            return error

    return kept


def _is_passing(error: ExcavatorError) -> bool:
    return isinstance(error, _native.StoreError)


def _is_file(model: str) -> bool:
    return "/" in model or model.endswith(".toml")


def _several(given: Any) -> tuple[str, ...]:
    if given is None:
        return ()
    if isinstance(given, str):
        return tuple(part.strip() for part in given.split(SEPARATOR) if part.strip())
    return tuple(os.fspath(one) for one in given)
