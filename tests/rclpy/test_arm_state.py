"""What the simulator publishes, at its full rate."""

import statistics

import pytest
from excavator_msgs.msg import ArmState
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState
from support.diagnostics import Diagnostics
from support.simulator import NEWEST_QOS, Simulator, all_finite, cylinder, seconds, steps

pytestmark = pytest.mark.middleware

RATE = 1000.0
WINDOW = 2000


def key(message):
    return message.header.stamp.sec, message.header.stamp.nanosec


@pytest.fixture(scope="module")
def simulator(ros, excavator):
    return Simulator(ros, excavator, rate=RATE, qos=NEWEST_QOS)


@pytest.fixture(scope="module")
def states(ros, simulator):
    """States from the first one on; the queue is longer than what is published meanwhile, however late we are."""
    mark = ros.mark()
    found = ros.listen(ArmState, "/arm/state", QoSProfile(depth=20 * WINDOW))
    ros.spin_until(lambda: len(found) >= WINDOW, f"{WINDOW} states")
    ros.release(mark)
    return found[:WINDOW]


def test_states_come_at_the_rate_of_the_parameter(states):
    assert statistics.median(steps(states)) == pytest.approx(1.0 / RATE, rel=0.01)


def test_stamps_are_those_of_the_samples(ros, simulator, states):
    """Whole periods apart however late they are sent, and none is missing on the way: a gap is where the node started its
    schedule anew, and it counts how often it did."""
    told = Diagnostics(ros)
    told.reach(seconds(states[-1].header.stamp))
    apart = steps(states)
    assert min(apart) > 0.0
    gaps = [step for step in apart if step > 1.5 / RATE]
    assert len(gaps) <= told.count("simulation", "schedule restarts")
    broken = [step for step in apart if step * RATE != pytest.approx(round(step * RATE), rel=0.01)]
    assert len(broken) <= told.count("simulation", "jumps of the clock")
    assert told.count("simulation", "refused states") == 0


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
    angles = {}
    ros.listen_with(ArmState, "/arm/state", lambda state: angles.update({key(state): cylinder(state).joint_angle}), 20 * WINDOW)
    joints = ros.hear(JointState, "/joint_states", 1000)
    ros.spin_until(lambda: len(joints) >= 50, "a second of /joint_states")
    # A node that waits for the processor leaves some out; between the others there is a fiftieth of a second, and never less.
    ros.spin_until(lambda: min(steps(joints)) < 0.021, "two that follow each other")
    assert min(steps(joints)) > 0.019
    assert all(list(joint.name) == ["arm_joint"] and len(joint.velocity) == 1 for joint in joints)
    found = {key(joint): list(joint.position) for joint in joints}
    ros.spin_until(lambda: sum(stamp in angles for stamp in found) > 10, "states of the same times")
    assert all(position == [angles[stamp]] for stamp, position in found.items() if stamp in angles)


def test_two_readers_get_the_same(ros, simulator):
    first, second = {}, {}
    for read in (first, second):
        ros.listen_with(ArmState, "/arm/state", lambda state, read=read: read.update({key(state): state.pump_pressure}), 5000)
    ros.spin_until(lambda: len(first.keys() & second.keys()) > 50, "fifty states that both have")
    assert all(second[stamp] == pressure for stamp, pressure in first.items() if stamp in second)
