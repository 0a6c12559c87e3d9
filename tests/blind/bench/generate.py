"""Makes the ten cases: python generate.py --seed 11 --out cases"""

import argparse
import json
from pathlib import Path

from production import NUMBERS, define, recordings, rehearse
from sensors import lose_cells, true_signal
from tables import write


def generate(number, seed, out):
    """Writes one case and returns its folder."""
    case, rng = define(number, seed)
    folder = out / case.name
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.csv"):
        old.unlink()
    for rehearsed in rehearse(case, rng):
        for recording in recordings(case, rehearsed):
            columns = {
                s.heading: s.read(true_signal(s, recording.states, recording.commands, recording.supply), rng)
                for s in case.sensors
            }
            if case.lost_cells:
                lose_cells(columns, case.lost_cells, rng)
            write(folder / f"{recording.stem}.csv", case.style, case.sensors, recording.times, columns)
    for name, content in (("machine", case.machine), ("answer", case.answer)):
        (folder / f"{name}.json").write_text(json.dumps(content, indent=1) + "\n")
    return folder


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=11)
    parser.add_argument("--out", type=Path, default=Path(__file__).parent / "cases")
    parser.add_argument("--only", type=int, nargs="*", default=list(NUMBERS), help="numbers of the cases to make")
    arguments = parser.parse_args()
    for number in arguments.only:
        folder = generate(number, arguments.seed, arguments.out)
        size = sum(file.stat().st_size for file in folder.iterdir())
        print(f"{folder.name}: {len(list(folder.glob('*.csv')))} recordings, {size / 1e3:.0f} kB", flush=True)


if __name__ == "__main__":
    main()
