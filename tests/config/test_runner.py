"""The runner of the checks: what it reads from test programs and reports, and what it writes."""

import sys
from collections import Counter
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "runner"))

import cargo  # noqa: E402
import durations  # noqa: E402
import suites  # noqa: E402
from run import Failed, Run  # noqa: E402

OUTPUT = """
running 4 tests
test signals::one_clock ... ok <0.003s>
test tables::panics - should panic ... ok <2.500s>
test hostile::files::a_link ... FAILED <0.100s>
test full::long ... ignored, minutes; tests/run --long

test result: FAILED. 2 passed; 1 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.10s
"""
REPORT = """<?xml version="1.0" encoding="utf-8"?>
<testsuites><testsuite name="pytest">
  <testcase classname="tests.rclpy.test_clock" name="test_a" time="2.5" />
  <testcase classname="tests.rclpy.test_clock" name="test_b" time="0.1"><skipped message="no ROS 2" /></testcase>
  <testcase classname="tests.rclpy.test_clock" name="test_c" time="0.2"><failure message="no" /></testcase>
</testsuite></testsuites>
"""


def test_a_test_program_is_read():
    program = cargo.TestProgram("rosbag2", "it", "it-0123", "rosbag2")
    timed, counts = cargo.read(program, OUTPUT)
    assert counts == Counter(passed=2, failed=1, skipped=1)
    assert timed == [("rosbag2 signals::one_clock", 0.003), ("rosbag2 tables::panics", 2.5), ("rosbag2 hostile::files::a_link", 0.1)]


def test_a_report_of_pytest_is_read(tmp_path):
    report = tmp_path / "report.xml"
    assert suites.read(report) == ([], Counter(), [])
    report.write_text(REPORT)
    timed, counts, reasons = suites.read(report)
    assert counts == Counter(passed=1, failed=1, skipped=1)
    assert timed[0] == ("tests/rclpy/test_clock::test_a", 2.5)
    assert reasons == ["no ROS 2"]


def test_durations_are_listed_longest_first(tmp_path):
    found = durations.Durations()
    found.add_step("lints", 60.0)
    found.add_tests("Rust", [("short", 1.9), ("long", 90.0)], Counter(passed=2))
    found.write(tmp_path / "target" / "durations.tsv", 100.0)
    lines = (tmp_path / "target" / "durations.tsv").read_text().splitlines()
    assert lines == ["name\tseconds\tkind", "total\t100.0\ttotal", "long\t90.0\ttest", "lints\t60.0\tstep"]


def test_a_failed_step_is_kept_and_the_next_one_runs(capsys):
    run = Run()

    def fails(run):
        run.command([sys.executable, "-c", "import sys; print('why'); sys.exit(3)"])

    assert run.step("first", fails) is None
    assert run.step("second", lambda run: "done") == "done"
    assert run.failed == ["first"]
    said = capsys.readouterr().out
    assert "why" in said and "exit status 3" in said and "second: done" in said
    with pytest.raises(Failed):
        run.needs("third", fails)
