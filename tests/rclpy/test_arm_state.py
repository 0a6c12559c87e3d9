"""What the simulator publishes, at its full rate."""

import statistics

import pytest
from excavator_msgs.msg import ArmState
from sensor_msgs.msg import JointState
from support.simulator import Simulator, all_finite, cylinder, seconds

pytestmark = pytest.mark.middleware

RATE = 1000.0
WINDOW = 2000


def key(message):
    return message.header.stamp.sec, message.header.stamp.nanosec


@pytest.fixture(scope="module")
def simulator(ros, excavator):
    return Simulator(ros, excavator, rate=RATE)


@pytest.fixture(scope="module")
def states(ros, simulator):
    """Two seconds in which the simulator had the processor when it wanted it: on a busy one it leaves samples out."""

    def span():
        return seconds(simulator.states[-1].header.stamp) - seconds(simulator.states[-WINDOW].header.stamp)

    ros.spin_until(lambda: len(simulator.states) >= WINDOW and span() < 1.01 * WINDOW / RATE, "two seconds at the full rate")
    return simulator.states[-WINDOW:]


def test_states_come_at_the_rate_of_the_parameter(states):
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
    ros.spin_until(lambda: len(joints) >= 50, "a second of /joint_states")
    stamps = [seconds(joint.header.stamp) for joint in joints]
    assert statistics.median(later - earlier for earlier, later in zip(stamps, stamps[1:])) == pytest.approx(0.02, rel=0.05)
    joint = joints[-1]
    assert list(joint.name) == ["arm_joint"]
    assert len(joint.velocity) == 1

    def same():
        return [state for state in simulator.states[-1000:] if state.header.stamp == joint.header.stamp]

    ros.spin_until(same, "the state of the same time")
    assert list(joint.position) == [cylinder(same()[0]).joint_angle]


def test_two_readers_get_the_same(ros, simulator):
    first, second = {}, {}
    for read in (first, second):
        ros.listen_with(ArmState, "/arm/state", lambda state, read=read: read.update({key(state): state.pump_pressure}), 500)
    ros.spin_until(lambda: len(first.keys() & second.keys()) > 50, "fifty states that both have")
    assert all(second[stamp] == pressure for stamp, pressure in first.items() if stamp in second)
