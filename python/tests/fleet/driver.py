"""Runs a fleet in a separate process that a test can kill: `driver.py FOLDER`."""

import sys
from pathlib import Path

import ray
from excavator import fleet

sys.path.insert(0, str(Path(__file__).parent))
import cheap

ray.cloudpickle.register_pickle_by_value(cheap)
folder = Path(sys.argv[1])
pairs = cheap.recordings(folder / "recordings", 40)
print(fleet.run(pairs, str(folder / "results"), workers=2, work=cheap.work_of(folder / "log", seconds=0.15)))
