"""Runs a fleet on Ray: many pairs, each once."""

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
"""Number of attempts at a job while the store fails. Single requests are already retried; these attempts cover an outage of about a minute."""

FIRST_WAIT = 1.0
"""Wait before the first retry after a store failure, s. It doubles with each retry."""

AHEAD = 2
"""Jobs submitted to Ray for each worker: one runs and one is queued, so that no worker is idle."""

OBJECT_STORE = 100 << 20
"""Object store memory of a local Ray, bytes. Jobs and results are small, and bags never pass through it."""

EVERY = 0.5
"""Interval between checks of waiting jobs, s."""


@dataclass
class Report:
    """Summary of a run."""

    pairs: int = 0
    """Number of given pairs."""
    keys: int = 0
    """Number of distinct jobs among them."""
    skipped: int = 0
    """Jobs that were completed in an earlier run."""
    poisoned_before: int = 0
    """Jobs that were already on the poison list and were not tried."""
    done: list[str] = field(default_factory=list)
    """Keys of the jobs completed in this run."""
    poisoned: dict[str, str] = field(default_factory=dict)
    """Keys added to the poison list, with the reason."""
    failed: dict[str, str] = field(default_factory=dict)
    """Keys of jobs that failed because of the store, with the reason; the next run tries them again."""
    refused: list[tuple[Pair, str]] = field(default_factory=list)
    """Pairs whose recording, map or model cannot be read, with the reason."""
    starts: int = 0
    """Number of job starts."""
    deaths: int = 0
    """Number of workers that died during a job."""
    seconds: float = 0.0
    """Duration of the run, s."""

    @property
    def left(self) -> int:
        """Number of jobs that are neither done nor given up."""
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
    """Runs all jobs that are not done yet, writes their results, and returns a report.

    A job is identified by the content of everything on which it depends, so a second call of `run` continues where the first one stopped. A
    result is written once, even if its job was started twice because a worker or this process was killed. Requires Ray.

    - `results` is an address in any store. `store` contains options for all addresses.
    - `verb` is `diagnose` or `identify`, with its `options` (`accept`, `where`, `whole`).
    - `address` is the address of a Ray cluster. By default, Ray runs on this machine with `workers` processes, or one for each processor. On
      a cluster, at most `workers` jobs run at a time.
    - A job that raises an error or kills its worker is retried `retries` times and then added to the poison list. A job with unusable data is
      added immediately. `retry_poisoned` retries the jobs on the list.
    - `progress` is `True` for a progress line on standard error, or a function that is called with the current `Report`.
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
    """Context manager that starts Ray unless it is already running, and stops only what it started."""

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
    def in_flight(self) -> int:
        """Number of jobs that are submitted at a time."""
        processors = max(1, int(self.ray.cluster_resources().get("CPU", 1)))
        if self._workers is not None and self._workers < processors:
            return max(1, self._workers)  # Ray would run as many as the cluster has processors
        return AHEAD * processors


class _Driver:
    """Submits jobs and handles their outcomes."""

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
        # Retries by Ray are disabled, because they would not be counted.
        self.task = self.ray.remote(max_retries=0, num_cpus=1)(_task)

    def drive(self, todo: Iterable[Job]) -> None:
        self.queue.extend(todo)
        flight: dict[Any, Job] = {}
        # Shared by all workers, and sent once.
        shared = self.ray.put((self.work, self.results, self.store, os.getcwd()))
        while self.queue or flight or self.waiting:
            while self.waiting and self.waiting[0][0] <= time.monotonic():
                self.queue.append(heapq.heappop(self.waiting)[2])
            while self.queue and len(flight) < self.engine.in_flight:
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
            # Without an entry in the list, the next run tries the job again.
            self.report.failed[job.key] = f"{text}; and the poison list cannot be written: {error}"
            return
        self.report.poisoned[job.key] = text


def _task(job: Job, shared: tuple[Work, Results, Store, str]) -> tuple[str, str]:
    """Runs a job in a worker and writes its result. Returns errors as text, which any process can deserialize."""
    # Each worker uses one processor; otherwise, the fits of all workers would compete for all processors.
    os.environ.setdefault("RAYON_NUM_THREADS", "1")
    work, results, store, directory = shared
    # A relative path means what it means to the caller. Ray may have been started in another folder.
    if os.path.isdir(directory):
        os.chdir(directory)
    try:
        results.save(job, work(job, store))
    except _native.StoreError as error:
        return "store", _one_line(error)
    except ExcavatorError as error:
        return "data", _one_line(error)
    except Exception as error:  # noqa: BLE001: no error may stop the other jobs
        return "fault", f"{type(error).__name__}: {_one_line(error)}"
    return "done", ""


def _one_line(error: BaseException) -> str:
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    # The last line of a traceback from Ray contains the message.
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
