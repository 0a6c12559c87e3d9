"""Makes the MATLAB samples. Needs the Python package scipy.

    make_matlab.py FOLDER   version-4.mat, version-6.mat and version-7.mat (packed)
"""

import sys
from pathlib import Path

import numpy as np
from scipy.io import savemat


def main(folder: Path) -> None:
    """Twenty rows of a drive: row and column vectors, a matrix, whole numbers; beyond version 4 a struct and a text."""
    time = np.arange(20) / 100.0
    plain = {
        "t": time,
        "stroke": (0.2 * np.sin(time)).reshape(-1, 1),
        "pressures": np.column_stack([1e5 + time, 2e5 - time]),
        "counts": np.arange(20, dtype=np.int16),
    }
    more = {"rig": {"force": 1e3 * time, "made": "by hand", "spool": time.astype(np.float32)}, "z": 1j * time}
    savemat(folder / "version-4.mat", plain, format="4")
    savemat(folder / "version-6.mat", plain | more, format="5")
    savemat(folder / "version-7.mat", plain | more, format="5", do_compression=True)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(Path(sys.argv[1]))
