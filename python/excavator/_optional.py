"""Optional packages."""

from __future__ import annotations

import importlib
from typing import Any


def needed(package: str, what: str) -> Any:
    """Imports and returns the module `package`. If it is missing, the `ImportError` contains the command that installs it."""
    try:
        return importlib.import_module(package)
    except ImportError as error:
        distribution = package.partition(".")[0]
        raise ImportError(f"{what} needs {distribution}: pip install {distribution}") from error
