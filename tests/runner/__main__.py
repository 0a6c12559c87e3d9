"""Builds and checks everything.

    tests/run          the check of every commit: format, lints, tests, the demo, nodes on ROS 2 Jazzy, a page in a browser
    tests/run --all    the check before a release: also ROS 2 Kilted, the stand-in, every page and notebook, every fault, packages
    tests/run --long   the same, then the Monte-Carlo, practice and fuzzing runs, and DDS Security
"""

import argparse
import os
import sys

import checks
import record
from durations import in_words, minutes
from run import ROOT, Failed, Run
from tier import Tier


def main():
    parser = argparse.ArgumentParser(prog="tests/run", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    group = parser.add_mutually_exclusive_group()
    group.add_argument("--all", dest="tier", action="store_const", const=Tier.ALL, default=Tier.COMMIT, help="check everything")
    group.add_argument("--long", dest="tier", action="store_const", const=Tier.LONG, help="and the runs that take hours")
    tier = parser.parse_args().tier
    os.chdir(ROOT)
    run = Run()
    try:
        checks.check(run, tier)
    except Failed as failure:
        print(f"\nnothing more was checked, because this failed: {failure}")
    return conclude(run, tier)


def conclude(run, tier):
    """Prints and writes what the run took; returns the exit status."""
    total, counts = run.elapsed(), run.durations.total_counts()
    run.durations.write(ROOT / "target" / "durations.tsv", total)
    print("\nTen longest (all: target/durations.tsv)")
    for name, seconds, kind in run.durations.longest():
        print(f"{minutes(seconds):>12}  {kind}  {name}")
    if run.notes:
        print("\nSkipped, because")
        for reason, number in sorted(run.notes.items()):
            print(f"{number:>12}  {reason}")
    print()
    for kind, found in run.durations.counts.items():
        print(f"{kind}: {in_words(found)}")
    if not run.failed and tier >= Tier.ALL:
        record.write(run, tier, total)
    print(f"{minutes(total)}. " + (f"FAILED: {'; '.join(run.failed)}" if run.failed else "Everything passed."))
    print(f"{counts['passed']} passed, {counts['failed']} failed, {counts['skipped']} skipped")
    return 1 if run.failed else 0


sys.exit(main())
