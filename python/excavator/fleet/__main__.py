"""Runs a fleet from the shell: `python -m excavator.fleet MANIFEST --results URL`."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from .._errors import ExcavatorError
from . import Results, Store, page, read_manifest, run


def main(arguments: list[str] | None = None) -> int:
    """Runs a fleet. Returns 0 if all work is done, 1 if any is poisoned, failed, refused or left, and 2 for an error in the arguments or input."""
    words = argparse.ArgumentParser(prog="python -m excavator.fleet", description="A verb on the recordings of many machines.")
    words.add_argument("manifest", metavar="MANIFEST", help="CSV or Parquet: machine, model, identification, validation, map, recorded")
    words.add_argument("--results", required=True, metavar="URL", help="where results go: a folder, or s3://, gs:// or az://")
    words.add_argument("--verb", default="diagnose", choices=["diagnose", "identify"])
    words.add_argument("--accept", action="append", default=[], metavar="NAME", help="overrule a check of recordings")
    words.add_argument("--store", action="append", default=[], metavar="KEY=VALUE", help="option of the store: endpoint=..., region=...")
    words.add_argument("--workers", type=int, metavar="N", help="processes; without, one for each processor")
    words.add_argument("--address", metavar="A", help="a Ray cluster: auto, HOST:PORT or ray://HOST:PORT")
    words.add_argument("--retries", type=int, default=2, metavar="N", help="how often failed work is begun again")
    words.add_argument("--retry-poisoned", action="store_true", help="try the poison list again")
    words.add_argument("--page", metavar="FILE", help="write a page that draws the fleet")
    words.add_argument("--parameter", metavar="NAME", help="the parameter whose drift the page draws")
    given = words.parse_args(arguments)
    if any("=" not in one for one in given.store):
        words.error("--store wants KEY=VALUE")
    store = Store(dict(one.split("=", 1) for one in given.store))
    try:
        pairs = read_manifest(given.manifest, store)
        report = run(
            pairs,
            given.results,
            verb=given.verb,
            options={"accept": given.accept} if given.accept else None,
            store=store,
            address=given.address,
            workers=given.workers,
            retries=given.retries,
            retry_poisoned=given.retry_poisoned,
            progress=sys.stderr.isatty(),
        )
        results = Results(given.results, store)
        tables = results.collect()
        if given.page:
            Path(given.page).write_text(page(tables, results.poison(), parameter=given.parameter), encoding="utf-8")
    except (ExcavatorError, ValueError, ImportError) as error:
        print(f"excavator.fleet: {error}", file=sys.stderr)
        return 2
    print(report)
    for pair, reason in report.refused:
        print(f"{pair.machine}: {reason}", file=sys.stderr)
    is_complete = not (report.poisoned or report.poisoned_before or report.failed or report.refused or report.left)
    return 0 if is_complete else 1


if __name__ == "__main__":
    sys.exit(main())
