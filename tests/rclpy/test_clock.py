"""Simulated time: a simulator that does not run at the speed of the world is the source of time."""

import time

import pytest
from excavator_msgs.msg import ArmState
from rosgraph_msgs.msg import Clock
from support.simulator import Simulator, seconds

SPEED = 3.0


@pytest.fixture(scope="module")
def simulator(ros, excavator):
    return Simulator(ros, excavator, rate=200.0, arguments=["-p", f"speed:={SPEED}"])


def test_the_clock_runs_at_the_speed_of_the_simulation(ros, simulator):
    clocks = ros.listen(Clock, "/clock", 100)
    ros.spin_until(lambda: clocks, "/clock")
    begin, first = time.monotonic(), seconds(clocks[-1].clock)
    ros.spin_for(1.5)
    simulated = seconds(clocks[-1].clock) - first
    assert simulated / (time.monotonic() - begin) == pytest.approx(SPEED, rel=0.1)
    times = [seconds(clock.clock) for clock in clocks]
    assert times == sorted(times)


def test_states_are_stamped_with_simulated_time(ros, simulator):
    clocks = ros.listen(Clock, "/clock", 100)
    states = simulator.watch(0.5)
    ros.spin_until(lambda: clocks, "/clock")
    assert seconds(states[-1].header.stamp) < 3600.0  # began near zero, not in 1970 plus today
    assert seconds(clocks[-1].clock) == pytest.approx(seconds(simulator.last.header.stamp), abs=0.1 * SPEED)


def test_a_simulator_in_real_time_leaves_the_clock_alone(ros, excavator):
    process = ros.start(excavator, "node", "arm-simulator", "--ros-args", "-p", "rate:=100.0", "-r", "__ns:=/real",
                        "-r", "/arm/state:=/real/state")  # fmt: skip
    states = ros.listen(ArmState, "/real/state")
    ros.spin_until(lambda: states, "the second simulator")
    owners = {info.node_namespace for info in ros.node.get_publishers_info_by_topic("/clock")}
    assert "/real" not in owners
    assert abs(seconds(states[-1].header.stamp) - time.time()) < 1.0
    process.interrupt()
