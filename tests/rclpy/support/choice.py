"""Which rclpy the tests run on, and starting the run anew in the Python that has it.

EXCAVATOR_RCLPY=jazzy or kilted is ROS 2 from PyPI, made by tests/ros2/setup, over Fast DDS; standin is the stand-in over
Cyclone DDS. Without the variable: an rclpy that this Python can import (a ROS 2 that was sourced), else jazzy where it was
made, else the stand-in.
"""

import importlib.util
import os
import sys
from pathlib import Path

VARIABLE = "EXCAVATOR_RCLPY"
STANDIN = "standin"
SOURCED = "sourced"
FROM_PYPI = ("jazzy", "kilted")
_ROOT = Path(__file__).resolve().parents[3]
# Starts with the variables of the environment in $0 and the arguments of pytest.
_START = '. "$0/setup.sh" && exec python -m pytest "$@"'


def _place(name):
    # resolved: a Python knows itself by the path without links
    return (_ROOT / ".ros2" / name).resolve()


def _is_ready(name):
    # written by tests/ros2/setup when both halves are done
    return all((_place(name) / half).is_file() for half in ("packages.sha256", "messages.sha256"))


def _is_importable():
    # a folder named rclpy on the path is found too, but as a namespace without an origin
    spec = importlib.util.find_spec("rclpy")
    return spec is not None and spec.origin is not None


def choose():
    """The name of the rclpy that the tests run on; ValueError when it is not there."""
    wanted = os.environ.get(VARIABLE)
    if wanted in FROM_PYPI:
        if not _is_ready(wanted):
            raise ValueError(f"{VARIABLE}={wanted}, but there is no {_place(wanted)}: run tests/ros2/setup {wanted}")
        return wanted
    if wanted == STANDIN:
        return wanted
    if wanted:
        raise ValueError(f"{VARIABLE}={wanted} is none of {', '.join((*FROM_PYPI, STANDIN))}")
    if _is_importable():
        return SOURCED
    return "jazzy" if _is_ready("jazzy") else STANDIN


def is_here(name):
    """Whether this Python, with the variables it was started with, has this rclpy."""
    if name not in FROM_PYPI:
        return True
    return Path(sys.prefix) == _place(name) and str(_place(name)) in os.environ.get("AMENT_PREFIX_PATH", "")


def start_anew(name, config):
    """Puts the same run of pytest in the Python of this rclpy in the place of this one. LD_LIBRARY_PATH is read when a
    program starts, so it cannot be set from within."""
    # gives the run its own standard output back
    config.pluginmanager.getplugin("capturemanager").stop_global_capturing()
    os.environ[VARIABLE] = name
    os.chdir(config.invocation_params.dir)
    os.execvp("sh", ["sh", "-c", _START, str(_place(name)), *map(str, config.invocation_params.args)])
