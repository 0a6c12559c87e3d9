"""Two machines on one network, each in a namespace: commanded apart, watched apart, recorded together, read apart."""

import json
import subprocess

import pytest
from excavator_msgs.msg import EnergyState
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from support.recorder import start_recorder
from support.simulator import STATE_QOS, Simulator, cylinder
from support.waiting import LONGEST_WAIT

pytestmark = pytest.mark.middleware

RATE = 200.0
SIDES = ("left", "right")
AREA = 5e-5
TOPICS = ["arm/state", "arm/orifice_command", "arm/energy"]


class Machine(Simulator):
    """A simulator and its monitor in a namespace, seen from outside."""

    def __init__(self, ros, excavator, side, displacement):
        start = ["-p", f"start_displacement:=[{displacement}]"]
        super().__init__(ros, excavator, rate=RATE, namespace=f"/{side}", arguments=start)
        self.monitor = ros.start(excavator, "node", "energy-monitor", "--ros-args", "-r", f"__ns:=/{side}")
        ros.hear(EnergyState, f"/{side}/arm/energy", STATE_QOS)


@pytest.fixture(scope="module")
def machines(ros, excavator):
    return {side: Machine(ros, excavator, side, number / 20) for number, side in enumerate(SIDES)}


def test_a_command_moves_the_machine_of_its_namespace_alone(ros, machines):
    left, right = machines.values()
    before = len(right.states)
    left.open_until(arm=AREA)
    right.next(50)
    left.close()
    assert all(cylinder(state).orifice_area == 0.0 for state in right.states[before:])


def test_nothing_is_left_outside_the_namespaces(ros, machines):
    # Topics and services are announced one by one.
    topics = lambda: {name for name, _ in ros.node.get_topic_names_and_types()}  # noqa: E731
    services = lambda: {name for name, _ in ros.node.get_service_names_and_types()}  # noqa: E731
    own = {f"/{side}/{topic}" for side in SIDES for topic in (*TOPICS, "arm/model", "joint_states")}
    ros.spin_until(lambda: own <= topics(), "the topics of both machines")
    asked = {f"/{side}/arm_simulator/get_parameters" for side in SIDES}
    ros.spin_until(lambda: asked <= services(), "the services of both machines")
    names = topics()
    assert not {name for name in names if name.startswith("/arm/")} and "/joint_states" not in names


def test_joint_states_and_description_agree(ros, machines):
    from rclpy.qos import DurabilityPolicy, QoSProfile

    joints = ros.listen(JointState, "/left/joint_states")
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    descriptions = ros.listen(String, "/left/robot_description", latched)
    ros.spin_until(lambda: joints and descriptions, "joint states and the robot description")
    assert all(f'<joint name="{name}"' in descriptions[0].data for name in joints[0].name)


def test_both_are_recorded_together_and_read_apart(ros, machines, excavator, tmp_path):
    bag = tmp_path / "both"
    topics = [f"/{side}/{topic}" for side in SIDES for topic in TOPICS]
    recorder = start_recorder(ros, excavator, bag, topics)
    left, right = machines.values()
    for machine in (left, right):
        machine.next(50)
    left.open_until(arm=AREA)
    with left.holding(arm=AREA):
        for machine in (left, right):
            machine.next(200)
    assert recorder.interrupt() == 0, recorder.output()

    def run(*words):
        return subprocess.run([excavator, *words], capture_output=True, text=True, timeout=LONGEST_WAIT)

    def info(*words):
        return run("info", bag, *words)

    whole = info()
    assert "say which with --namespace" in whole.stdout and "/left, /right" in whole.stdout, whole.stdout
    for side, moved in (("left", True), ("right", False)):
        result = tmp_path / f"{side}.json"
        assert info("--namespace", side, "--json", result).returncode == 0
        measured = {one["name"]: one for one in json.loads(result.read_text())["signals"]["measured"]}
        opening = measured["arm.orifice_area"]
        assert (opening["most"] > 0.5 * AREA) == moved, opening
    assert "--namespace" in run("energy", "--model", "zx30u-arm", "--bag", bag).stderr
