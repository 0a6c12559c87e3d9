"""Joint commands as topic_based_ros2_control sends them (sensor_msgs/JointState) move the simulated arm to where they say."""

import pytest
from sensor_msgs.msg import JointState
from support.simulator import Simulator, cylinder

# The sensor's resolution is finer; half a degree is what a trajectory controller allows at its goal by default.
NEAR = 0.01


@pytest.fixture(scope="module")
def simulator(ros, excavator):
    return Simulator(ros, excavator)


@pytest.fixture(scope="module")
def commands(ros, excavator, simulator):
    ros.start(excavator, "node", "joint-controller")
    return ros.publisher(JointState, "/robot_joint_commands")


def go(ros, simulator, commands, target, velocity=()):
    """Sends a target with each message that comes until the arm is there and stands."""

    def is_there():
        commands.publish(JointState(name=["arm_joint"], position=[target] if target is not None else [], velocity=velocity))
        arm = cylinder(simulator.last)
        return target is not None and abs(arm.joint_angle - target) < NEAR and abs(arm.velocity) < 0.01

    ros.spin_until(is_there, f"the arm at {target:.2f} rad")


def test_the_arm_goes_where_it_is_told(ros, simulator, commands):
    here = cylinder(simulator.last).joint_angle
    states = ros.hear(JointState, "/robot_joint_states")
    for step in (0.3, -0.2, 0.0):
        go(ros, simulator, commands, here + step)
    assert states[-1].name == ["arm_joint"]
    ros.spin_until(lambda: abs(states[-1].position[0] - here) < 2 * NEAR, "the last place on robot_joint_states")
    assert len(states[-1].velocity) == 1


def test_a_rate_alone_moves_it(ros, simulator, commands):
    before = cylinder(simulator.last).joint_angle

    def has_moved():
        commands.publish(JointState(name=["arm_joint"], velocity=[0.3]))
        return cylinder(simulator.last).joint_angle > before + 0.1

    ros.spin_until(has_moved, "a joint that turns")


def test_the_valve_closes_when_nobody_commands_any_more(ros, simulator, commands):
    """By a command of the controller: what it commanded last would hold for long."""
    go(ros, simulator, commands, cylinder(simulator.last).joint_angle)
    ros.spin_until(lambda: cylinder(simulator.last).orifice_area == 0.0, "a closed valve")
    commands.publish(JointState(name=["tail_joint"], position=[1.0]))
    simulator.next(100)
    assert cylinder(simulator.last).orifice_area == 0.0
