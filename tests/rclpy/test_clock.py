"""Simulated time: a simulator that does not run at the speed of the world is the source of time."""

import time

import pytest
from excavator_msgs.msg import ArmState
from rosgraph_msgs.msg import Clock
from support.simulator import Simulator, seconds

pytestmark = pytest.mark.middleware

SPEED = 3.0


@pytest.fixture(scope="module")
def simulator(ros, excavator):
    return Simulator(ros, excavator, rate=200.0, arguments=["-p", f"speed:={SPEED}"])


def test_the_clock_runs_at_the_speed_of_the_simulation(ros, simulator):
    heard = []
    ros.listen_with(Clock, "/clock", lambda clock: heard.append((time.monotonic(), seconds(clock.clock))), 100)

    def runs_at_its_speed():
        """For the last 1.5 s, in which the machine had no other work."""
        last, simulated = heard[-1]
        begin, first = next(one for one in heard if one[0] > last - 1.5)
        return last - heard[0][0] > 1.5 and simulated - first == pytest.approx(SPEED * (last - begin), rel=0.1)

    ros.spin_until(lambda: heard and runs_at_its_speed(), f"a clock at {SPEED} times the speed of the world")
    times = [simulated for _, simulated in heard]
    assert times == sorted(times)


def test_states_are_stamped_with_simulated_time(ros, simulator):
    clocks = ros.listen(Clock, "/clock", 100)
    ros.spin_until(
        lambda: clocks and abs(seconds(clocks[-1].clock) - seconds(simulator.last.header.stamp)) < 0.1 * SPEED,
        "a clock and a state of the same time",
    )
    assert seconds(simulator.last.header.stamp) < 3600.0  # began near zero, not in 1970 plus today


def test_a_simulator_in_real_time_leaves_the_clock_alone(ros, excavator):
    words = ["--ros-args", "-p", "rate:=100.0", "-r", "__ns:=/real"]
    process = ros.start(excavator, "node", "arm-simulator", *words)
    states = ros.listen(ArmState, "/real/arm/state")
    ros.spin_until(
        lambda: states and abs(seconds(states[-1].header.stamp) - time.time()) < 1.0, "a second simulator in real time"
    )
    owners = {info.node_namespace for info in ros.node.get_publishers_info_by_topic("/clock")}
    assert "/real" not in owners
    process.interrupt()
