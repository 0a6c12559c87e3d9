"""Trivial work in place of a diagnosis, with a log of its starts."""

from __future__ import annotations

import json
import os
import signal
import time
from collections import Counter
from pathlib import Path

VERSION = "cheap"


def recordings(folder: Path, count: int) -> list[dict[str, object]]:
    """Returns pairs whose recordings are small files with different contents."""
    pairs = []
    for number in range(count):
        files = [folder / f"{number}-{name}.csv" for name in ("identification", "validation")]
        for file in files:
            file.write_text(f"{file.name}\n")
        pairs.append(
            {
                "machine": f"machine {number % 5}",
                "model": "zx30u-arm",
                "identification": str(files[0]),
                "validation": str(files[1]),
                "recorded": f"2026-01-{1 + number % 28:02}T00:00:00Z",
            }
        )
    return pairs


def work_of(log: Path, *, seconds: float = 0.0, dies: str | None = None, dies_once: str | None = None, raises: dict[str, str] | None = None):
    """Returns a work function that logs every start in `log`. The pair `dies` kills its worker; `raises` maps pairs to kinds of errors."""

    def work(job, store):
        from excavator import ReadError
        from excavator.fleet import Done

        name = job.pair.identification[0].rpartition("/")[2].partition("-")[0]
        with open(log, "a", encoding="utf-8") as file:
            file.write(f"{job.key} {name} {os.getpid()}\n")
        if dies == name:
            os.kill(os.getpid(), signal.SIGKILL)
        if dies_once == name and not Path(f"{log}.died").exists():
            Path(f"{log}.died").touch()
            os.kill(os.getpid(), signal.SIGKILL)
        kind = (raises or {}).get(name)
        if kind == "data":
            raise ReadError(f"{name}: cannot be read\nat all")
        if kind == "fault":
            raise RuntimeError(f"{name}: a fault")
        time.sleep(seconds)
        content = b"".join(store.get(one) for one in job.pair.recordings)
        text = json.dumps({"verdict": "adequate", "validation_error": {"before": 0.5, "after": 0.5}, "content": content.decode()})
        row = {"key": job.key, "machine": job.pair.machine, "model": job.pair.model, "recorded": job.pair.recorded, "verb": job.verb}
        return Done(text, row | {"seconds": seconds, "bytes_read": len(content), "bytes_total": len(content), "program": "0"})

    return work


def starts(log: Path) -> Counter[str]:
    """Returns how often the work on each pair was started, by the number of the pair."""
    return Counter(line.split()[1] for line in log.read_text().splitlines())
