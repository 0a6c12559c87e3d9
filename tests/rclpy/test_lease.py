"""A command is a lease: it holds while it is renewed and the valve closes when it is not. command_timeout is 0.1 s."""

import time

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from support.simulator import Simulator, command, cylinder, seconds

AREA = 5e-5
TIMEOUT = 0.1
# From fully open in 0.05 s; AREA is less than half of that.
CLOSING = 0.05
# What a busy machine may add between publication and arrival.
SLACK = 0.15


@pytest.fixture(scope="module")
def simulator(ros, excavator):
    return Simulator(ros, excavator, rate=500.0, command_timeout=None)


def test_the_valve_closes_when_commands_stop(ros, simulator):
    simulator.settle()
    simulator.hold(0.5, arm=AREA)
    sent = time.time()
    simulator.send(command(arm=AREA))
    after = [(seconds(state.header.stamp) - sent, cylinder(state).orifice_area) for state in simulator.watch(1.0)]
    closed = [when for when, area in after if area == 0.0]
    assert closed, "the valve is still open 1 s after the last command"
    assert TIMEOUT < closed[0] < TIMEOUT + CLOSING + SLACK
    assert all(area == pytest.approx(AREA) for when, area in after if 0.0 < when < 0.9 * TIMEOUT)
    # it stays closed
    assert all(area == 0.0 for when, area in after if when > closed[0])


def test_the_valve_closes_by_a_ramp(simulator):
    """Oil that is stopped at once hits like a hammer."""
    simulator.settle()
    states = simulator.hold(0.3, arm=2 * AREA)
    assert cylinder(states[-1]).orifice_area == pytest.approx(2 * AREA)
    areas = [cylinder(state).orifice_area for state in simulator.watch(0.6)]
    falling = [area for area in areas if 0.0 < area < 2 * AREA * 0.999]
    assert len(falling) >= 3
    assert falling == sorted(falling, reverse=True)


def test_the_valve_stays_open_while_commands_come(simulator):
    simulator.settle()
    states = simulator.hold(1.0, arm=-AREA)
    areas = [cylinder(state).orifice_area for state in states[len(states) // 4 :]]
    assert all(area == pytest.approx(-AREA) for area in areas)


def test_diagnostics_tell_that_the_command_ran_out(ros, simulator):
    diagnostics = ros.listen(DiagnosticArray, "/diagnostics")
    simulator.hold(0.3, arm=AREA)

    def warned():
        return any(
            status.level != DiagnosticStatus.OK and "run out" in status.message
            for message in diagnostics
            for status in message.status
        )

    ros.spin_until(warned, "a warning that the command has run out", 5.0)
