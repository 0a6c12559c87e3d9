"""Simulated time: a simulator that does not run at the speed of the world is the source of time."""

import pytest
from excavator_msgs.msg import ArmState
from rosgraph_msgs.msg import Clock
from support.simulator import Simulator, seconds

pytestmark = pytest.mark.middleware

SPEED = 3.0
# Time of the world after which the speed is told, s.
LONG_ENOUGH = 1.5
# Simulated time begins near zero, that of the world lies in this century, s.
IN_1990 = 20 * 365 * 86400.0


@pytest.fixture(scope="module")
def simulator(ros, excavator):
    return Simulator(ros, excavator, rate=50.0, arguments=["-p", f"speed:={SPEED}"])


@pytest.fixture(scope="module")
def real(ros, excavator):
    """A second simulator, in real time: the clock of the world."""
    return Simulator(ros, excavator, rate=100.0, namespace="/real")


def test_the_clock_runs_at_the_speed_of_the_simulation(ros, simulator, real):
    clocks = ros.hear(Clock, "/clock", 5000)
    simulated, world = seconds(clocks[-1].clock), real.time

    def runs_at_its_speed():
        """Both are late by as much now as at the beginning, or by little beside the time in between."""
        passed = real.time - world
        return passed > LONG_ENOUGH and seconds(clocks[-1].clock) - simulated == pytest.approx(SPEED * passed, rel=0.1)

    ros.spin_until(runs_at_its_speed, f"a clock at {SPEED} times the speed of the world")
    times = [seconds(clock.clock) for clock in clocks]
    assert times == sorted(times)


def test_states_are_stamped_with_simulated_time(ros, simulator):
    times, stamps = set(), set()
    ros.listen_with(Clock, "/clock", lambda clock: times.add(seconds(clock.clock)), 5000)
    ros.listen_with(ArmState, "/arm/state", lambda state: stamps.add(seconds(state.header.stamp)), 5000)
    ros.spin_until(lambda: not times.isdisjoint(stamps), "a clock and a state of the same sample")
    assert simulator.time < IN_1990


def test_a_simulator_in_real_time_leaves_the_clock_alone(ros, simulator, real):
    assert real.time > IN_1990

    def published(namespace):
        return {topic for topic, _ in ros.node.get_publisher_names_and_types_by_node("arm_simulator", namespace)}

    # what is announced right before the clock
    ros.spin_until(lambda: "/real/robot_description" in published("/real"), "the topics of the second simulator")
    ros.spin_until(lambda: "/clock" in published("/"), "the clock of the first one")
    assert "/clock" not in published("/real")
