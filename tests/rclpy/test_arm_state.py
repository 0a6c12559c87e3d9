"""What the simulator publishes, at its full rate."""

import statistics

import pytest
from excavator_msgs.msg import ArmState
from sensor_msgs.msg import JointState
from support.simulator import Simulator, all_finite, cylinder, seconds

RATE = 1000.0
TIME = 2.0


@pytest.fixture(scope="module")
def simulator(ros, excavator):
    return Simulator(ros, excavator, rate=RATE)


@pytest.fixture(scope="module")
def states(simulator):
    """The fullest of three windows: a processor that has other work takes time from both sides."""
    simulator.watch(0.5)
    windows = []
    while len(windows) < 3 and not any(len(window) > 0.98 * RATE * TIME for window in windows):
        windows.append(simulator.watch(TIME))
    return max(windows, key=len)


def test_states_come_at_the_rate_of_the_parameter(states):
    assert len(states) == pytest.approx(RATE * TIME, rel=0.1)
    span = seconds(states[-1].header.stamp) - seconds(states[0].header.stamp)
    assert (len(states) - 1) / span == pytest.approx(RATE, rel=0.02)


def test_stamps_are_those_of_the_samples(states):
    """One period apart however late they are sent, and none is missing on the way."""
    stamps = [state.header.stamp.sec * 10**9 + state.header.stamp.nanosec for state in states]
    steps = [after - before for before, after in zip(stamps, stamps[1:])]
    assert min(steps) > 0
    assert statistics.median(steps) == pytest.approx(1e9 / RATE, rel=0.01)
    # a schedule that started anew shows as a longer step; more than a few would be lost samples
    assert sum(step > 1.5e9 / RATE for step in steps) <= 0.01 * len(steps)


def test_states_say_what_a_machine_measures(states):
    state = states[-1]
    assert [cylinder.name for cylinder in state.cylinders] == ["arm"]
    arm = cylinder(state)
    measured = (
        arm.joint_angle, arm.displacement, arm.velocity, arm.cap_pressure, arm.rod_pressure, arm.orifice_area,
        state.pump_pressure, state.tank_pressure, state.pump_flow, state.oil_temperature,
    )  # fmt: skip
    assert all_finite(measured)
    assert arm.rod_force != arm.rod_force  # NaN: zx30u-arm has no load cell
    assert abs(arm.displacement) <= 0.31 and 0.0 <= arm.cap_pressure < 4e7 and 0.0 <= arm.rod_pressure < 4e7
    assert state.pump_flow == pytest.approx(3.8e-4)  # [A] Table 1
    assert arm.orifice_area == 0.0  # nobody has commanded anything


def test_joint_states_are_for_the_robot_description(ros, simulator):
    joints = ros.listen(JointState, "/joint_states", 50)
    ros.spin_until(lambda: joints, "/joint_states")
    del joints[:]
    ros.spin_for(1.0)
    assert 40 <= len(joints) <= 60  # 50 Hz
    assert list(joints[-1].name) == ["arm_joint"]
    stamp = joints[-1].header.stamp
    (state,) = [state for state in simulator.states if state.header.stamp == stamp]
    assert list(joints[-1].position) == [cylinder(state).joint_angle]
    assert len(joints[-1].velocity) == 1


def test_two_readers_get_the_same(ros, simulator):
    first, second = (ros.listen(ArmState, "/arm/state", 500) for _ in range(2))
    ros.spin_until(lambda: first and second, "both readers")
    ros.spin_for(0.2)
    theirs = {seconds(state.header.stamp): state.pump_pressure for state in second}
    common = [state for state in first if seconds(state.header.stamp) in theirs]
    assert len(common) > 50
    assert all(theirs[seconds(state.header.stamp)] == state.pump_pressure for state in common)
