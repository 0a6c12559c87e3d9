"""What `ros2 node` and `ros2 topic` show, and how the command line changes it."""

import pytest
from excavator_msgs.msg import ArmState
from rclpy.qos import QoSProfile

pytestmark = pytest.mark.middleware

PARAMETER_SERVICES = {
    "describe_parameters": "rcl_interfaces/srv/DescribeParameters",
    "get_parameter_types": "rcl_interfaces/srv/GetParameterTypes",
    "get_parameters": "rcl_interfaces/srv/GetParameters",
    "list_parameters": "rcl_interfaces/srv/ListParameters",
    "set_parameters": "rcl_interfaces/srv/SetParameters",
    "set_parameters_atomically": "rcl_interfaces/srv/SetParametersAtomically",
}


def nodes(ros):
    return set(ros.node.get_node_names_and_namespaces())


@pytest.fixture(scope="module")
def simulator(ros, excavator):
    process = ros.start(excavator, "node", "arm-simulator", "--ros-args", "-p", "rate:=100.0")
    ros.spin_until(lambda: ("arm_simulator", "/") in nodes(ros), "the simulator in the node list")
    return process


@pytest.fixture(scope="module")
def monitor(ros, excavator, simulator):
    process = ros.start(excavator, "node", "energy-monitor")
    ros.spin_until(lambda: ("energy_monitor", "/") in nodes(ros), "the energy monitor in the node list")
    return process


def published(ros, node):
    return dict(ros.node.get_publisher_names_and_types_by_node(node, "/"))


def subscribed(ros, node):
    return dict(ros.node.get_subscriber_names_and_types_by_node(node, "/"))


def check_topics(ros, node, wanted, heard):
    """The node publishes at least these topics with these types, and subscribes to that one."""

    def found(names):
        return {topic: types for topic, types in names.items() if topic in wanted or topic in heard}

    ros.spin_until(lambda: len(found(published(ros, node))) == len(wanted), f"the publishers of {node}")
    ros.spin_until(lambda: set(heard) <= set(subscribed(ros, node)), f"the subscriptions of {node}")
    expected = {topic: [type_name] for topic, type_name in (wanted | heard).items()}
    assert found(published(ros, node)) | {topic: subscribed(ros, node)[topic] for topic in heard} == expected
    assert found(dict(ros.node.get_topic_names_and_types())) == expected


def test_topics_of_the_simulator(ros, simulator):
    wanted = {
        "/arm/state": "excavator_msgs/msg/ArmState",
        "/arm/model": "std_msgs/msg/String",
        "/joint_states": "sensor_msgs/msg/JointState",
        "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
    }
    check_topics(ros, "arm_simulator", wanted, {"/arm/orifice_command": "excavator_msgs/msg/OrificeCommand"})


def test_topics_of_the_energy_monitor(ros, monitor):
    wanted = {"/arm/energy": "excavator_msgs/msg/EnergyState", "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray"}
    check_topics(ros, "energy_monitor", wanted, {"/arm/state": "excavator_msgs/msg/ArmState"})


def check_parameter_services(ros, node):
    wanted = {f"/{node}/{name}": [type_name] for name, type_name in PARAMETER_SERVICES.items()}

    def found():
        services = dict(ros.node.get_service_names_and_types_by_node(node, "/"))
        return {name: services[name] for name in wanted if name in services}

    ros.spin_until(lambda: len(found()) == len(wanted), f"the parameter services of {node}")
    assert found() == wanted


def test_the_simulator_has_the_parameter_services(ros, simulator):
    check_parameter_services(ros, "arm_simulator")


def test_the_energy_monitor_has_the_parameter_services(ros, monitor):
    check_parameter_services(ros, "energy_monitor")


def test_names_can_be_changed_from_the_command_line(ros, excavator):
    process = ros.start(
        excavator, "node", "arm-simulator", "--ros-args", "-p", "rate:=100.0",
        "-r", "__ns:=/left", "-r", "__node:=machine", "-r", "/arm/state:=/left/arm/state",
    )  # fmt: skip
    try:
        ros.spin_until(lambda: ("machine", "/left") in nodes(ros), "the renamed node")
        states = ros.listen(ArmState, "/left/arm/state", QoSProfile(depth=100))
        ros.spin_until(lambda: states, "states under the new name")
        ros.spin_until(
            lambda: "/left/machine/list_parameters" in dict(ros.node.get_service_names_and_types_by_node("machine", "/left")),
            "a service under the new name",
        )
    finally:
        process.interrupt()


@pytest.mark.parametrize("how", ["interrupt", pytest.param("terminate", marks=pytest.mark.full)])
def test_a_node_that_is_told_to_end_leaves_at_once(ros, excavator, how):
    """While one that vanished without a word before it is still there: it stays until its lease has run out."""

    def start(name):
        process = ros.start(
            excavator, "node", "arm-simulator", "--ros-args", "-p", "rate:=100.0",
            "-r", f"__node:={name}", "-r", f"/arm/state:=/{name}/state",
        )  # fmt: skip
        ros.hear(ArmState, f"/{name}/state")
        ros.spin_until(lambda: (name, "/") in nodes(ros), "the node")
        return process

    told, vanished = f"told_{how}", f"vanished_{how}"
    killed, process = start(vanished), start(told)
    killed.vanish()
    assert getattr(process, how)() == 0
    ros.spin_until(lambda: (told, "/") not in nodes(ros), "the node to leave the graph")
    ros.spin_until(lambda: ros.node.count_publishers(f"/{told}/state") == 0, "its topic to be without a publisher")
    assert (vanished, "/") in nodes(ros)


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["-p", "rate:=-5.0"], "rate"),
        (["-p", "rate:=fast"], "rate"),
        (["-p", "model:=no-such-machine"], "no-such-machine"),
        (["-r", "nonsense"], "nonsense"),
    ],
)
def test_what_cannot_be_is_said_in_one_line(ros, excavator, arguments, word):
    process = ros.start(excavator, "node", "arm-simulator", "--ros-args", *arguments)
    assert process.wait() in (1, 2)
    lines = [line for line in process.output().splitlines() if line.strip()]
    assert word in lines[-1]
    assert "panicked" not in process.output()
