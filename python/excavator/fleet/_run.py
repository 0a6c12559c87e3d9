"""A fleet on Ray: many pairs, each done once."""

from __future__ import annotations

import heapq
import os
import time
from collections import Counter, deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from .. import _native
from .._errors import ExcavatorError
from .._optional import needed
from ._pairs import Job, Pair, pairs_of, resolve
from ._results import Poison, Results
from ._store import Store
from ._unit import Done, work

Work = Callable[[Job, Store], Done]

STORE_ATTEMPTS = 6
"""How often a job is tried while the store fails. Requests inside were tried again already: this is for an outage of a minute."""

FIRST_WAIT = 1.0
"""Wait before a job is tried again after the store failed, s; it doubles each time."""

AHEAD = 2
"""Jobs that are handed to Ray, for each worker: one is computed, and one waits, so that no worker does."""

OBJECT_STORE = 100 << 20
"""Memory for objects of a local Ray, bytes: jobs and answers are small, and bags never go through it."""

EVERY = 0.5
"""How often waiting jobs are looked at, s."""


@dataclass
class Report:
    """What a run did."""

    pairs: int = 0
    """Pairs that were given."""
    keys: int = 0
    """Different pieces of work among them."""
    skipped: int = 0
    """Those that were done before."""
    poisoned_before: int = 0
    """Those that were on the poison list and were not tried."""
    done: list[str] = field(default_factory=list)
    """Keys that are done now."""
    poisoned: dict[str, str] = field(default_factory=dict)
    """Keys that were put on the poison list, with the reason."""
    failed: dict[str, str] = field(default_factory=dict)
    """Keys that the store kept from being done, with the reason; the next run tries them again."""
    refused: list[tuple[Pair, str]] = field(default_factory=list)
    """Pairs with a recording, map or model that is not there, with the reason."""
    starts: int = 0
    """How often work was begun."""
    deaths: int = 0
    """How often a worker died during work."""
    seconds: float = 0.0
    """Time that the run took, s."""

    @property
    def left(self) -> int:
        """Pieces of work that are neither done nor given up."""
        return self.keys - self.skipped - self.poisoned_before - len(self.done) - len(self.poisoned) - len(self.failed)

    def __str__(self) -> str:
        parts = [f"{len(self.done)} done", f"{self.skipped} done before"]
        counts = {
            "on the poison list": len(self.poisoned) + self.poisoned_before,
            "kept back by the store": len(self.failed),
            "without their files": len(self.refused),
            "left": self.left,
            "workers died": self.deaths,
        }
        parts += [f"{count} {what}" for what, count in counts.items() if count]
        return f"{', '.join(parts)}, {self.seconds:.1f} s"


Progress = bool | Callable[[Report], object] | None


def run(
    pairs: Iterable[Pair | Mapping[str, Any]],
    results: str | Results,
    *,
    verb: str = "diagnose",
    options: Mapping[str, Any] | None = None,
    store: Store | Mapping[str, str] | None = None,
    address: str | None = None,
    workers: int | None = None,
    retries: int = 2,
    retry_poisoned: bool = False,
    progress: Progress = None,
    work: Work = work,
) -> Report:
    """Does the work on all pairs that is not done yet, and writes results.

    Work is known by the content of everything it depends on: to call `run` again goes on where it stopped. Its result is written once, even if
    it was begun twice because a worker or this process was killed. Needs Ray.

    - `results` is an address, in any store. `store` are options for all addresses.
    - `verb` is `diagnose` or `identify`, with its `options` (`accept`, `where`, `whole`).
    - `address` is that of a Ray cluster. Without, Ray runs on this machine with `workers` processes, one for each processor if not given. On
      a cluster `workers` bounds the jobs that run at a time.
    - Work that raises an error or kills its worker is begun `retries` times more, then it goes on the poison list. Data that cannot be used goes
      there at once. `retry_poisoned` tries the list again.
    - `progress` is `True` for a line on standard error, or a function that gets the `Report` so far.
    """
    began = time.monotonic()
    own = store if isinstance(store, Store) else Store(dict(store or {}))
    place = results if isinstance(results, Results) else Results(results, own)
    every = pairs_of(pairs)
    jobs, refused = resolve(every, own, verb=verb, options=options)
    finished, poisoned = place.done(), set() if retry_poisoned else place.poisoned()
    todo = [job for job in jobs if job.key not in finished and job.key not in poisoned]
    report = Report(pairs=len(every), keys=len(jobs), refused=refused)
    report.skipped = sum(job.key in finished for job in jobs)
    report.poisoned_before = len(jobs) - report.skipped - len(todo)
    if todo:
        with _Ray(address, workers) as engine:
            _Driver(engine, place, own, work, retries, report, _teller(progress, began)).drive(todo)
    report.seconds = time.monotonic() - began
    if progress is True:
        _line(f"{report}\n")
    return report


class _Ray:
    """Ray, begun here if nobody did before, and then ended here."""

    def __init__(self, address: str | None, workers: int | None) -> None:
        self.ray = needed("ray", "excavator.fleet")
        self._address, self._workers = address, workers
        self._is_ours = False

    def __enter__(self) -> _Ray:
        if not self.ray.is_initialized():
            quiet = {"include_dashboard": False, "object_store_memory": OBJECT_STORE} if self._address is None else {}
            cpus = self._workers if self._address is None else None
            self.ray.init(address=self._address or "local", num_cpus=cpus, log_to_driver=False, logging_level="error", **quiet)
            self._is_ours = True
        return self

    def __exit__(self, *_: object) -> None:
        if self._is_ours:
            self.ray.shutdown()

    @property
    def workers(self) -> int:
        """How many jobs can run at a time."""
        found = int(self.ray.cluster_resources().get("CPU", 1))
        return max(1, found if self._workers is None else min(found, self._workers))


class _Driver:
    """Hands out jobs and sees what becomes of them."""

    def __init__(
        self,
        engine: _Ray,
        results: Results,
        store: Store,
        work: Work,
        retries: int,
        report: Report,
        tell: Callable[[Report], object],
    ) -> None:
        self.engine, self.ray = engine, engine.ray
        self.results, self.store, self.work, self.retries, self.report, self.tell = results, store, work, retries, report, tell
        self.tries: Counter[str] = Counter()
        self.outages: Counter[str] = Counter()
        self.waiting: list[tuple[float, str, Job]] = []
        self.queue: deque[Job] = deque()
        # Ray's own retries are off: they would not be counted.
        self.task = self.ray.remote(max_retries=0, num_cpus=1)(_task)

    def drive(self, todo: Iterable[Job]) -> None:
        self.queue.extend(todo)
        flight: dict[Any, Job] = {}
        # Known to all workers, and sent once.
        shared = self.ray.put((self.work, self.results, self.store))
        while self.queue or flight or self.waiting:
            while self.waiting and self.waiting[0][0] <= time.monotonic():
                self.queue.append(heapq.heappop(self.waiting)[2])
            while self.queue and len(flight) < AHEAD * self.engine.workers:
                job = self.queue.popleft()
                self.report.starts += 1
                flight[self.task.remote(job, shared)] = job
            if not flight:
                time.sleep(EVERY)
                continue
            ready, _ = self.ray.wait(list(flight), timeout=EVERY if self.waiting else None)
            for reference in ready:
                self._settle(flight.pop(reference), reference)
                self.tell(self.report)

    def _settle(self, job: Job, reference: Any) -> None:
        try:
            kind, text = self.ray.get(reference)
        except self.ray.exceptions.RayTaskError as error:
            kind, text = "fault", _one_line(error)
        except self.ray.exceptions.RayError as error:
            kind, text = "death", _one_line(error)
            self.report.deaths += 1
        if kind == "done":
            self.report.done.append(job.key)
        elif kind == "store":
            self._wait(job, text)
        else:
            self.tries[job.key] += 1
            if kind == "data" or self.tries[job.key] > self.retries:
                self._refuse(job, kind, text)
            else:
                self.queue.append(job)

    def _wait(self, job: Job, text: str) -> None:
        self.outages[job.key] += 1
        if self.outages[job.key] >= STORE_ATTEMPTS:
            self.report.failed[job.key] = text
            return
        due = time.monotonic() + FIRST_WAIT * 2 ** (self.outages[job.key] - 1)
        heapq.heappush(self.waiting, (due, job.key, job))

    def _refuse(self, job: Job, kind: str, text: str) -> None:
        poison = Poison(job.key, job.pair.machine, kind, text, self.tries[job.key], job.pair.recordings)
        try:
            self.results.refuse(poison)
        except ExcavatorError as error:
            # Without its entry it is tried again next time.
            self.report.failed[job.key] = f"{text}; and the poison list cannot be written: {error}"
            return
        self.report.poisoned[job.key] = text


def _task(job: Job, shared: tuple[Work, Results, Store]) -> tuple[str, str]:
    """What a worker does: the work, and the writing of its result. Errors are told as texts, so that each can be read anywhere."""
    # A worker is one processor: fits of several workers would fight for all of them.
    os.environ.setdefault("RAYON_NUM_THREADS", "1")
    work, results, store = shared
    try:
        results.save(job, work(job, store))
    except _native.StoreError as error:
        return "store", _one_line(error)
    except ExcavatorError as error:
        return "data", _one_line(error)
    except Exception as error:  # noqa: BLE001: whatever it is, other work goes on
        return "fault", f"{type(error).__name__}: {_one_line(error)}"
    return "done", ""


def _one_line(error: BaseException) -> str:
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    # Of Ray's tracebacks the last line says what happened.
    text = lines[-1] if len(lines) > 3 and any("Traceback" in line for line in lines) else " ".join(lines)
    return text[:500] or type(error).__name__


def _teller(progress: Progress, began: float) -> Callable[[Report], object]:
    if progress is None or progress is False:
        return lambda _: None
    if progress is not True:
        return progress

    def tell(report: Report) -> None:
        finished = len(report.done) + len(report.poisoned) + len(report.failed)
        total = report.keys - report.skipped - report.poisoned_before
        elapsed = time.monotonic() - began
        left = elapsed / finished * (total - finished) if finished else 0.0
        _line(f"{finished} of {total}, {len(report.poisoned)} on the poison list, about {left:.0f} s left")

    return tell


def _line(text: str) -> None:
    import sys

    print(f"\r{text:<78}", end="", file=sys.stderr, flush=True)
