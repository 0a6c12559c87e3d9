"""Test suites: those of Rust, and those of pytest. Each is a step that counts its tests."""

import xml.etree.ElementTree
from collections import Counter
from concurrent.futures import ThreadPoolExecutor

import cargo
from durations import in_words
from run import ROOT, Failed

PYTHON = ROOT / ".venv" / "bin" / "python"
PROGRAM = ROOT / "target" / "debug" / "excavator"
# Measures beside programs of others, whose solvers take minutes to build: linted and built in long runs.
SPEED = ["--exclude", "excavator-speed"]
# The site of the book, and changed bytes for every reader: with --all.
SLOW = ["--exclude", "excavator-book", "--exclude", "excavator-fuzzing"]


def crates(everything):
    """The crates whose tests are built."""
    return ["--workspace", *SPEED, *([] if everything else SLOW)]


def rust(run, programs, words):
    """Runs Rust test programs with further words; prints the output of those that failed."""
    total, broken = Counter(), []
    for program, status, output, timed, counts in cargo.run_all(programs, ["--show-output", *words]):
        run.count("Rust", timed, counts)
        run.skipped(line.partition("skipped: ")[2] for line in output.splitlines() if line.startswith("skipped: "))
        total += counts
        if status:
            again = f"cargo test -p {program.crate}"
            broken.append(f"$ {again}\n{output}exit status {status}")
    if broken:
        raise Failed("\n".join(broken))
    return in_words(total)


def nodes(run, kind, words, rclpy, domains):
    """Runs the tests of the nodes on an rclpy. They wait more than they compute, so two halves of the files run at a time,
    each in ROS domains of its own: two ranges."""
    files = sorted(map(str, (ROOT / "tests" / "rclpy").glob("test_*.py")))

    def half(number):
        environment = {"EXCAVATOR_RCLPY": rclpy, "EXCAVATOR_DOMAINS": domains[number]}
        try:
            pytest(run, kind, [*files[number::2], *words], environment, f"{kind}-{number}")
        except Failed as failure:
            return failure
        return None

    with ThreadPoolExecutor(2) as pool:
        failures = [failure for failure in pool.map(half, (0, 1)) if failure]
    if failures:
        raise Failed("\n".join(map(str, failures)))
    return run.counted(kind)


def pytest(run, kind, words, environment=None, report=None):
    """Runs pytest; counts, durations and the reasons of skipped tests come from its report."""
    report = ROOT / "target" / "pytest" / f"{(report or kind).replace(' ', '-')}.xml"
    report.parent.mkdir(parents=True, exist_ok=True)
    report.unlink(missing_ok=True)
    variables = {"EXCAVATOR_BINARY": str(PROGRAM), "EXCAVATOR_PYTHON": str(PYTHON)} | (environment or {})
    command = [PYTHON, "-m", "pytest", "-q", f"--junitxml={report}", *words]
    failure = None
    try:
        run.command(command, environment=variables)
    except Failed as error:
        failure = error
    timed, counts, reasons = read(report)
    run.skipped(reasons)
    said = run.count(kind, timed, counts)
    if failure:
        raise failure
    if not counts:
        raise Failed(f"{' '.join(map(str, words))} selects no test")
    return said


def read(report):
    """Timed tests, counts, and reasons of skipped tests in a JUnit report of pytest; nothing where there is none."""
    timed, counts, reasons = [], Counter(), []
    if not report.exists():
        return timed, counts, reasons
    for case in xml.etree.ElementTree.parse(report).iter("testcase"):
        name = f"{case.get('classname').replace('.', '/')}::{case.get('name')}"
        timed.append((name, float(case.get("time"))))
        skipped = case.find("skipped")
        outcome = "skipped" if skipped is not None else "passed"
        if case.find("failure") is not None or case.find("error") is not None:
            outcome = "failed"
        counts[outcome] += 1
        if skipped is not None:
            reasons.append(skipped.get("message", ""))
    return timed, counts, reasons
