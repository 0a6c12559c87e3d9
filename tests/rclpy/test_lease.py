"""A command is a lease: it holds while it is renewed and the valve closes when it is not. command_timeout is 0.1 s."""

import time

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from support.simulator import Simulator, command, cylinder, seconds

pytestmark = pytest.mark.middleware

AREA = 5e-5
TIMEOUT = 0.1
# From fully open in 0.05 s; AREA is less than half of that.
CLOSING = 0.05
# What a busy machine may add between publication and arrival.
SLACK = 0.5


@pytest.fixture(scope="module")
def simulator(ros, excavator):
    return Simulator(ros, excavator, rate=500.0, command_timeout=None)


def test_the_valve_closes_when_commands_stop(ros, simulator):
    simulator.settle()
    simulator.open_until(arm=AREA)
    sent = time.time()
    simulator.send(command(arm=AREA))
    before = len(simulator.states)
    ros.spin_until(lambda: cylinder(simulator.last).orifice_area == 0.0, "the valve to close")
    simulator.next(250)
    after = [(seconds(state.header.stamp) - sent, cylinder(state).orifice_area) for state in simulator.states[before:]]
    closed = [when for when, area in after if area == 0.0]
    assert TIMEOUT < closed[0] < TIMEOUT + CLOSING + SLACK
    assert all(area == pytest.approx(AREA) for when, area in after if 0.0 < when < 0.9 * TIMEOUT)
    # it stays closed
    assert all(area == 0.0 for when, area in after if when > closed[0])


def test_the_valve_closes_by_a_ramp(ros, simulator):
    """Oil that is stopped at once hits like a hammer."""
    simulator.settle()
    simulator.open_until(arm=2 * AREA)
    before = len(simulator.states)
    ros.spin_until(lambda: cylinder(simulator.last).orifice_area == 0.0, "the valve to close")
    areas = [cylinder(state).orifice_area for state in simulator.states[before:]]
    falling = [area for area in areas if 0.0 < area < 2 * AREA * 0.999]
    assert len(falling) >= 3
    assert falling == sorted(falling, reverse=True)


def test_the_valve_stays_open_while_commands_come(ros, simulator):
    """For a second, ten times as long as a command holds. A test that has to wait for the processor misses a renewal."""
    simulator.settle()

    def is_open():
        return cylinder(simulator.last).orifice_area == pytest.approx(-AREA)

    def stays_open():
        with simulator.holding(arm=-AREA):
            ros.spin_until(is_open, "the valve to open")
            states = simulator.next(500)
        return all(cylinder(state).orifice_area == pytest.approx(-AREA) for state in states)

    ros.spin_until(stays_open, "a second of an open valve")


def test_diagnostics_tell_that_the_command_ran_out(ros, simulator):
    diagnostics = ros.listen(DiagnosticArray, "/diagnostics")
    simulator.open_until(arm=AREA)

    def warned():
        return any(
            status.level != DiagnosticStatus.OK and "run out" in status.message
            for message in diagnostics
            for status in message.status
        )

    ros.spin_until(warned, "a warning that the command has run out")
