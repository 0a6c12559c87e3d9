"""Each pair is done once, even if a worker or the driver dies."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import pytest
from excavator import fleet
from excavator.fleet import _run

from . import cheap

pytestmark = pytest.mark.usefixtures("engine")


@pytest.fixture
def places(tmp_path):
    (tmp_path / "recordings").mkdir()
    return tmp_path / "recordings", str(tmp_path / "results"), tmp_path / "log"


def test_everything_is_done_once_and_not_again(places):
    folder, results, log = places
    pairs = cheap.recordings(folder, 20)
    report = fleet.run(pairs + pairs[:7], results, work=cheap.work_of(log))
    assert (report.pairs, report.keys, len(report.done), report.left) == (27, 20, 20, 0)
    assert set(cheap.starts(log).values()) == {1}
    again = fleet.run(pairs, results, work=cheap.work_of(log))
    assert (again.skipped, again.starts, again.done) == (20, 0, [])
    # A renamed machine is the same job; changed content is a new one.
    (folder / "0-validation.csv").write_text("changed")
    assert fleet.run([pairs[0] | {"machine": "renamed"}, pairs[1] | {"machine": "renamed"}], results, work=cheap.work_of(log)).starts == 1


def test_relative_paths_are_those_of_the_caller(places, monkeypatch):
    folder, results, log = places
    monkeypatch.chdir(folder)
    pairs = [
        pair | {name: Path(pair[name]).name for name in ("identification", "validation")} for pair in cheap.recordings(folder, 2)
    ]
    report = fleet.run(pairs, "results", work=cheap.work_of(log))
    assert (len(report.done), report.left) == (2, 0)
    assert len(list((folder / "results" / "done").iterdir())) == 2


@pytest.mark.parametrize(("workers", "wanted"), [(2, 2), (16, 16 * _run.AHEAD), (None, 16 * _run.AHEAD)])
def test_a_cluster_runs_no_more_jobs_than_there_are_workers(workers, wanted):
    engine = _run._Ray("ray://elsewhere", workers)
    engine.ray = SimpleNamespace(cluster_resources=lambda: {"CPU": 16.0})
    assert engine.in_flight == wanted


def test_results_are_what_the_work_gave(places):
    folder, results, log = places
    fleet.run(cheap.recordings(folder, 6), results, work=cheap.work_of(log))
    place = fleet.Results(results)
    keys = place.done()
    contents = {json.loads(place.json(key))["content"] for key in keys}
    assert contents == {f"{n}-identification.csv\n{n}-validation.csv\n" for n in range(6)}
    pytest.importorskip("pyarrow")
    table = place.collect()["results"]
    assert table.num_rows == 6 and set(table["key"].to_pylist()) == keys
    assert set(table["verdict"].to_pylist()) == {"adequate"}


def test_a_worker_that_is_killed_costs_nothing(places):
    folder, results, log = places
    report = fleet.run(cheap.recordings(folder, 12), results, work=cheap.work_of(log, dies_once="5"))
    assert (len(report.done), report.deaths, report.poisoned) == (12, 1, {})
    starts = cheap.starts(log)
    assert starts.pop("5") == 2 and set(starts.values()) == {1}
    assert len(fleet.Results(results).done()) == 12


def test_what_always_fails_goes_on_the_poison_list(places):
    folder, results, log = places
    pairs = cheap.recordings(folder, 8)
    report = fleet.run(pairs, results, work=cheap.work_of(log, dies="1", raises={"2": "data", "3": "fault"}), retries=2)
    assert (len(report.done), len(report.poisoned), report.deaths, report.left) == (5, 3, 3, 0)
    starts = cheap.starts(log)
    assert (starts["1"], starts["2"], starts["3"]) == (3, 1, 3)
    poison = {one.kind: one for one in fleet.Results(results).poison()}
    assert set(poison) == {"death", "data", "fault"}
    assert poison["data"].error == "2: cannot be read at all"
    assert poison["fault"].error == "RuntimeError: 3: a fault" and poison["fault"].attempts == 3
    again = fleet.run(pairs, results, work=cheap.work_of(log))
    assert (again.poisoned_before, again.starts) == (3, 0)
    healed = fleet.run(pairs, results, work=cheap.work_of(log), retry_poisoned=True)
    assert len(healed.done) == 3 and fleet.Results(results).poison() == []


def test_a_recording_that_is_not_there_is_told(places):
    folder, results, log = places
    pairs = cheap.recordings(folder, 3)
    (folder / "1-validation.csv").unlink()
    report = fleet.run(pairs, results, work=cheap.work_of(log))
    assert len(report.done) == 2
    ((pair, reason),) = report.refused
    assert pair.machine == "machine 1" and "1-validation.csv" in reason


def test_a_driver_that_is_killed_goes_on(places, tmp_path):
    _, results, log = places
    command = [sys.executable, str(Path(__file__).with_name("driver.py")), str(tmp_path)]
    first = subprocess.Popen(command, start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    done = tmp_path / "results" / "done"
    while len(list(done.glob("*.json")) if done.exists() else []) < 8:
        assert first.poll() is None
        time.sleep(0.02)
    os.kill(first.pid, signal.SIGKILL)
    first.wait()
    before = {file.name: (file.stat().st_ino, file.stat().st_mtime_ns) for file in done.glob("*.json")}
    assert 8 <= len(before) < 40
    second = subprocess.run(command, capture_output=True, text=True)
    assert second.returncode == 0, second.stderr
    after = {file.name: (file.stat().st_ino, file.stat().st_mtime_ns) for file in done.glob("*.json")}
    assert len(after) == 40
    assert all(after[name] == one for name, one in before.items())
    # Only the jobs that were running when the driver died were started twice: at most one on each of the two workers.
    starts = cheap.starts(log)
    assert len(starts) == 40 and sum(starts.values()) <= 42
