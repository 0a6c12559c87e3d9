"""Fleets: runs a verb on the recordings of many machines, once for each pair.

    from excavator import fleet

    pairs = fleet.read_manifest("fleet.csv")
    print(fleet.run(pairs, "s3://results/spring"))
    tables = fleet.Results("s3://results/spring").collect()

Jobs run on Ray, on this machine or on a cluster. Recordings and results may be in object storage.
"""

from ._page import page
from ._pairs import Job, Pair, read_manifest
from ._results import EFFECT, PARAMETER, ROW, Poison, Results
from ._run import Report, run
from ._store import Copied, Entry, Store
from ._unit import Done, work

__all__ = [
    "EFFECT",
    "PARAMETER",
    "ROW",
    "Copied",
    "Done",
    "Entry",
    "Job",
    "Pair",
    "Poison",
    "Report",
    "Results",
    "Store",
    "page",
    "read_manifest",
    "run",
    "work",
]
