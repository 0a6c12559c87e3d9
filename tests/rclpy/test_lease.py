"""A command is a lease: it holds while it is renewed and the valve closes when it is not."""

import statistics

import pytest
from diagnostic_msgs.msg import DiagnosticStatus
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from support.diagnostics import Diagnostics
from support.simulator import Simulator, cylinder, seconds

pytestmark = pytest.mark.middleware

AREA = 5e-5
# command_timeout of the node itself, and one that a busy machine does not take for it, s.
OWN = 0.1
LONG = 2.0
# One between them, s.
SOME = 0.5


@pytest.fixture(scope="module")
def simulator(ros, excavator):
    return Simulator(ros, excavator, rate=500.0, command_timeout=None)


@pytest.fixture
def lease(ros, simulator):
    """Sets the time for which a command holds (s); in the end it is the node's own again."""

    def set_to(seconds):
        value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=seconds)
        request = SetParameters.Request(parameters=[Parameter(name="command_timeout", value=value)])
        (answer,) = ros.call(SetParameters, "/arm_simulator/set_parameters", request).results
        assert answer.successful, answer.reason
        # the node reads its parameters five times a second
        told.reach(simulator.time)

    told = Diagnostics(ros)
    yield set_to
    set_to(OWN)


def holds(ros, simulator):
    """Time from an open valve, right before its last command, until it is closed, s; it stays closed."""
    simulator.open_until(arm=AREA)
    begin = simulator.time
    return seconds(simulator.closes(len(simulator.states)).header.stamp) - begin


def test_the_valve_closes_when_commands_stop(ros, simulator, lease):
    """After the time of the parameter. What a busy machine adds is little beside the long one."""
    own = statistics.median(holds(ros, simulator) for _ in range(5))
    lease(LONG)
    long = holds(ros, simulator)
    assert long > LONG / 2
    assert own < long / 2


def test_the_valve_closes_by_a_ramp(ros, simulator):
    """Oil that is stopped at once hits like a hammer."""

    def closing():
        simulator.open_until(arm=2 * AREA)
        before = len(simulator.states)
        ros.spin_until(lambda: simulator.area() == 0.0, "the valve to close")
        return simulator.states[before:]

    def closes_by_a_ramp():
        areas = [cylinder(state).orifice_area for state in simulator.undisturbed(closing)]
        falling = [area for area in areas if 0.0 < area < 2 * AREA * 0.999]
        return len(falling) >= 3 and falling == sorted(falling, reverse=True)

    # A command that arrives late opens the valve again on its way. One that never closes by a ramp fails every time.
    ros.spin_until(closes_by_a_ramp, "a valve that closes by a ramp")


def test_the_valve_stays_open_while_commands_come(ros, simulator, lease):
    """For several times as long as a command holds. A test that has to wait for the processor misses a renewal."""
    lease(SOME)

    def stays_open():
        with simulator.holding(arm=-AREA):
            ros.spin_until(lambda: simulator.is_open(arm=-AREA), "the valve to open")
            states = simulator.watch(3 * SOME)
        return all(cylinder(state).orifice_area == pytest.approx(-AREA) for state in states)

    ros.spin_until(stays_open, "a valve that stays open")


def test_diagnostics_tell_that_the_command_ran_out(ros, simulator):
    told = Diagnostics(ros)
    simulator.open_until(arm=AREA)
    ros.spin_until(lambda: told.says("commands", "run out", DiagnosticStatus.WARN), "a warning that the command has run out")
