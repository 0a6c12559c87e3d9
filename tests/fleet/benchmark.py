"""A fleet of the blind benchmark on Ray: `benchmark.py --program EXCAVATOR --bags FOLDER`.

Runs the pairs of FOLDER (`blind --only-draw --write FOLDER` makes them) with two workers, out of an S3 server on loopback that fails one request
in ten. A worker and the driver are killed on the way. Then every result is compared with that of the program, byte by byte.

    cargo build --release -p excavator -p excavator-blind
    target/release/blind --seed 9191 --cases 150 --only-draw --write blind-bags
    python tests/fleet/benchmark.py --program target/release/excavator --bags blind-bags --json docs/fleet.json

150 pairs are 300 recordings. On two cores they take an hour and a half, half of it the program's: --compare repeats that part alone.
"""

from __future__ import annotations

import argparse
import json
import logging
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python" / "tests" / "fleet"))

BUCKET = "fleet"
MODEL = "zx30u-arm"


def options_of(endpoint: str) -> dict[str, str]:
    """Options of the store for a server on loopback."""
    keys = {"access_key_id": "x", "secret_access_key": "x"}
    return {"endpoint": endpoint, "allow_http": "true", "region": "us-east-1"} | keys


def cases_of(folder: Path, count: int) -> list[Path]:
    """The first cases of a folder, by number."""
    found = sorted(folder.glob("case*"), key=lambda case: int(case.name.removeprefix("case")))
    if len(found) < count:
        sys.exit(f"{folder} has {len(found)} cases, {count} are wanted: blind --only-draw --cases {count} --write {folder}")
    return found[:count]


def pairs_of(cases: list[Path], prefix: str) -> list[dict[str, str]]:
    """Pairs whose bags are below a prefix."""
    own = {"model": MODEL}
    roles = ("identification", "validation")
    return [own | {"machine": case.name} | {role: f"{prefix}/{case.name}/{role}/" for role in roles} for case in cases]


def upload(client, cases: list[Path]) -> int:
    """Puts the bags into the bucket; gives their bytes."""
    total = 0
    for case in cases:
        for file in sorted(case.glob("*/*")):
            content = file.read_bytes()
            total += len(content)
            client.put_object(Bucket=BUCKET, Key=f"bags/{case.name}/{file.parent.name}/{file.name}", Body=content)
    return total


def drive(endpoint: str, bags: Path, count: int, workers: int, results: str) -> None:
    """The part that is killed: a driver in a process of its own."""
    from excavator import fleet

    pairs = pairs_of(cases_of(bags, count), f"s3://{BUCKET}/bags")
    report = fleet.run(pairs, results, store=options_of(endpoint), workers=workers, retries=4)
    figures = {"done": len(report.done), "skipped": report.skipped, "starts": report.starts, "deaths": report.deaths}
    figures |= {"poisoned": report.poisoned, "failed": report.failed, "left": report.left, "seconds": report.seconds}
    print(json.dumps(figures))


def begin(endpoint: str, bags: Path, count: int, workers: int, results: str) -> subprocess.Popen[str]:
    """Starts a driver."""
    words = ["--drive", endpoint, "--bags", bags, "--counts", count, "--workers", workers, "--results", results]
    return subprocess.Popen([sys.executable, __file__, *map(str, words)], stdout=subprocess.PIPE, text=True)


def worker_of(driver: int) -> int | None:
    """A process of Ray that works for this driver, by its name in /proc."""
    parents = {}
    for status in Path("/proc").glob("[0-9]*/stat"):
        try:
            text = status.read_text()
        except OSError:
            continue
        name, rest = text[text.index("(") + 1 : text.rindex(")")], text[text.rindex(")") + 2 :].split()
        parents[int(status.parent.name)] = (int(rest[1]), name)

    def is_below(process: int) -> bool:
        while process in parents and process > 1:
            process = parents[process][0]
            if process == driver:
                return True
        return False

    busy = (number for number, (_, name) in parents.items() if name.startswith("ray::_task") and is_below(number))
    return next(busy, None)


def objects(client, prefix: str) -> dict[str, str]:
    """Names and times of objects below a prefix."""
    pages = client.get_paginator("list_objects_v2").paginate(Bucket=BUCKET, Prefix=prefix)
    return {one["Key"]: f"{one['LastModified']} {one['ETag']}" for page in pages for one in page.get("Contents", [])}


def measured(client, endpoint: str, bags: Path, count: int, workers: int, *, kill: bool) -> dict[str, object]:
    """Figures of a run."""
    results = f"s3://{BUCKET}/results-{count}"
    began = time.monotonic()
    killed: dict[str, object] = {}
    driver = begin(endpoint, bags, count, workers, results)
    if kill:
        wait_for(client, count, count // 5, driver)
        worker = None
        while worker is None and driver.poll() is None:
            worker = worker_of(driver.pid)
        if worker is not None:
            os.kill(worker, signal.SIGKILL)
        wait_for(client, count, count // 2, driver)
        os.kill(driver.pid, signal.SIGKILL)
        driver.wait()
        before = objects(client, f"results-{count}/done/")
        driver = begin(endpoint, bags, count, workers, results)
        killed = {"worker_killed": worker is not None, "done_when_driver_died": len(before)}
    out, _ = driver.communicate()
    if driver.returncode:
        sys.exit(f"the driver failed with {driver.returncode}")
    after = objects(client, f"results-{count}/done/")
    if kill:
        killed["written_again"] = sum(after.get(name) != stamp for name, stamp in before.items())
    seconds = time.monotonic() - began
    return json.loads(out) | killed | {"results": len(after), "seconds_with_start": seconds, "seconds_per_pair": seconds / count}


def wait_for(client, count: int, wanted: int, driver: subprocess.Popen[str]) -> None:
    """Waits until so many results are there."""
    while len(objects(client, f"results-{count}/done/")) < wanted and driver.poll() is None:
        time.sleep(0.5)


def keep(endpoint: str, count: int, folder: Path) -> None:
    """Copies the results of a run to a folder, a file for each machine."""
    from excavator import fleet

    store = fleet.Store(options_of(endpoint))
    results = fleet.Results(f"s3://{BUCKET}/results-{count}", store)
    folder.mkdir(parents=True, exist_ok=True)
    for one in store.list(f"{results.address}/rows"):
        machine = json.loads(store.get(one.url))["machine"]
        found = results.json(one.url.rpartition("/")[2].removesuffix(".json"))
        (folder / f"{machine}.json").write_text(found)


def compared(program: Path, kept: Path, bags: Path, count: int, workers: int) -> dict[str, object]:
    """Results beside those of the program on the same bags."""

    def is_same(case: Path) -> tuple[str, bool, float]:
        found = (kept / f"{case.name}.json").read_text()
        for role in ("identification", "validation"):
            found = found.replace(f"s3://{BUCKET}/bags/{case.name}/{role}/", str(case / role))
        own = kept / f"{case.name}.program.json"
        began = time.monotonic()
        if not own.exists():  # else from a comparison that was interrupted
            with tempfile.TemporaryDirectory() as folder:
                target = Path(folder) / "own.json"
                roles = ["--identification", case / "identification", "--validation", case / "validation"]
                words = [program, "diagnose", "--model", MODEL, *roles, "--json", target]
                environment = os.environ | {"RAYON_NUM_THREADS": "1"}
                done = subprocess.run([str(word) for word in words], capture_output=True, text=True, env=environment)
                if not target.exists():
                    sys.exit(f"{case}: {done.stderr}")
                own.write_text(target.read_text())
        return case.name, own.read_text() == found, time.monotonic() - began

    with ThreadPoolExecutor(workers) as threads:
        answers = list(threads.map(is_same, cases_of(bags, count)))
    different = [name for name, same, _ in answers if not same]
    return {"compared": len(answers), "different": different, "program_seconds_per_pair": sum(one[2] for one in answers) / len(answers)}


def write(path: Path | None, figures: dict[str, object]) -> None:
    """Writes the figures where they are wanted."""
    if path:
        path.write_text(json.dumps(figures, indent=2) + "\n")


def main() -> None:
    """Runs everything and writes the figures."""
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("--program", type=Path)
    words.add_argument("--bags", type=Path, required=True)
    words.add_argument("--counts", type=int, nargs="+", default=[15, 150], help="pairs of each run")
    words.add_argument("--workers", type=int, default=2)
    words.add_argument("--json", type=Path)
    words.add_argument("--keep", type=Path, default=Path("fleet-results"), help="folder for the results, for --compare")
    words.add_argument("--compare", action="store_true", help="only compare results that an earlier run kept with the program's")
    words.add_argument("--drive", help=argparse.SUPPRESS)
    words.add_argument("--results", help=argparse.SUPPRESS)
    given = words.parse_args()
    bags = given.bags.resolve()
    if given.drive:
        return drive(given.drive, bags, given.counts[0], given.workers, given.results)
    largest = max(given.counts)
    if given.compare:
        return finish(given, json.loads(given.json.read_text()), largest)
    import boto3
    from failing_proxy import FailingProxy
    from moto.server import ThreadedMotoServer

    logging.getLogger("werkzeug").setLevel(logging.ERROR)  # else a line for each request
    server = ThreadedMotoServer(ip_address="127.0.0.1", port=0)
    server.start()
    host, port = server.get_host_and_port()
    own = {"region_name": "us-east-1", "aws_access_key_id": "x", "aws_secret_access_key": "x"}
    client = boto3.client("s3", endpoint_url=f"http://{host}:{port}", **own)
    client.create_bucket(Bucket=BUCKET)
    figures: dict[str, object] = {"workers": given.workers, "bytes": upload(client, cases_of(bags, largest)), "runs": {}}
    proxy = FailingProxy(port, every=10)
    with proxy as endpoint:
        for count in given.counts:
            run = measured(client, endpoint, bags, count, given.workers, kill=count == largest)
            figures["runs"][str(count)] = run
            print(count, run, flush=True)
        keep(endpoint, largest, given.keep)
    figures |= {"requests": proxy.requests, "requests_failed": proxy.failures, "threads": threading.active_count()}
    server.stop()
    finish(given, figures, largest)


def finish(given: argparse.Namespace, figures: dict[str, object], largest: int) -> None:
    """Compares with the program and writes the figures: before it, too, for it takes as long as the run."""
    write(given.json, figures)
    if given.program:
        figures |= compared(given.program.resolve(), given.keep, given.bags.resolve(), largest, given.workers)
        write(given.json, figures)
    print(json.dumps(figures, indent=2))
    last = figures["runs"][str(largest)]
    if last["results"] != largest or last.get("written_again") or figures.get("different"):
        sys.exit("something was lost, done twice, or is different")


if __name__ == "__main__":
    main()
