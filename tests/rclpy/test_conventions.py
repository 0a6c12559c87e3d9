"""What a ROS 2 user expects of any node: names, log files, time, and a word where something is not followed."""

import os
import subprocess
import time

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from excavator_msgs.msg import ArmState
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from rosgraph_msgs.msg import Clock
from support.simulator import STATE_QOS
from support.waiting import LONGEST_WAIT

SIMULATOR = ("node", "arm-simulator", "--ros-args", "-p", "rate:=50.0")


def refused(excavator, *words, **environment):
    """The line with which a node does not start."""
    done = subprocess.run(
        [excavator, *words], capture_output=True, text=True, timeout=LONGEST_WAIT, env=dict(os.environ, **environment)
    )
    assert done.returncode == 1, done.stderr
    (line,) = done.stderr.strip().splitlines()
    return line


@pytest.mark.parametrize(
    ("variable", "value", "word"),
    [
        ("ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF", "LOCALHOST"),
        ("RMW_IMPLEMENTATION", "rmw_zenoh_cpp", "DDS"),
        ("ROS_DOMAIN_ID", "many", "0 to 232"),
    ],
)
def test_what_cannot_be_followed_is_refused_in_one_line(excavator, variable, value, word):
    line = refused(excavator, *SIMULATOR, **{variable: value})
    assert variable in line and value in line and word in line


def test_what_has_no_effect_is_told(ros, excavator):
    words = ["--enclave", "/pit", "--log-config-file", "log.conf"]
    process = ros.start(excavator, *SIMULATOR, *words, environment={"ROS_STATIC_PEERS": "10.0.0.7"})

    def told():
        output = process.output()
        return all(word in output for word in ("ROS_STATIC_PEERS=10.0.0.7", "--enclave /pit", "--log-config-file log.conf"))

    ros.spin_until(told, "three warnings")
    process.interrupt()


def test_both_words_name_the_node_and_the_log_goes_to_a_file(ros, excavator, tmp_path):
    words = ["-r", "__name:=digger", "--log-file-name", "site"]
    process = ros.start(excavator, *SIMULATOR, *words, environment={"ROS_LOG_DIR": str(tmp_path)})
    ros.spin_until(lambda: "digger" in ros.node.get_node_names(), "the node under its new name")
    assert process.interrupt() == 0
    (file,) = tmp_path.glob(f"site_{process.pid}_*.log")
    assert "[INFO]" in file.read_text() and "[digger]" in file.read_text()


def test_time_can_change_over_to_the_clock_while_a_node_runs(ros, excavator):
    """The stamp of diagnostics is the node's idea of time."""
    started = int(time.time())
    process = ros.start(excavator, "node", "energy-monitor")
    heard = ros.hear(DiagnosticArray, "/diagnostics")
    assert heard[0].header.stamp.sec >= started, "not the system's time"
    value = ParameterValue(type=ParameterType.PARAMETER_BOOL, bool_value=True)
    request = SetParameters.Request(parameters=[Parameter(name="use_sim_time", value=value)])
    reply = ros.call(SetParameters, "/energy_monitor/set_parameters", request)
    assert reply.results[0].successful, reply.results[0].reason
    clock = ros.publisher(Clock, "/clock")

    def follows():
        message = Clock()
        message.clock.sec = 1234
        clock.publish(message)
        return heard[-1].header.stamp.sec == 1234

    ros.spin_until(follows, "the time of /clock")
    process.interrupt()


def test_diagnostics_say_of_which_hardware_they_are(ros, excavator):
    process = ros.start(excavator, *SIMULATOR)
    ros.hear(ArmState, "/arm/state")
    heard = ros.hear(DiagnosticArray, "/diagnostics")
    ros.spin_until(
        lambda: all(status.hardware_id == "zx30u-arm" for status in heard[-1].status), "the hardware of every status"
    )
    process.interrupt()


@pytest.mark.parametrize("words", [[], pytest.param(["-p", "frame_id:=pit/base_link"], marks=pytest.mark.full)])
def test_states_have_the_frame_of_the_root_link(ros, excavator, words):
    states = ros.listen(ArmState, "/arm/state", STATE_QOS)
    process = ros.start(excavator, *SIMULATOR, *words)
    ros.spin_until(lambda: states, "a state")
    assert states[0].header.frame_id == (words[-1].partition(":=")[2] if words else "base_link")
    process.interrupt()


def test_a_node_describes_the_types_of_its_topics(ros, excavator):
    interfaces = pytest.importorskip("type_description_interfaces.srv")
    request = interfaces.GetTypeDescription.Request
    process = ros.start(excavator, *SIMULATOR)

    def asked(**words):
        return ros.call(interfaces.GetTypeDescription, "/arm_simulator/get_type_description", request(**words))

    answer = asked(type_name="excavator_msgs/msg/ArmState", include_type_sources=True)
    assert answer.successful, answer.failure_reason
    fields = answer.type_description.type_description.fields
    assert [field.name for field in fields] == list(ArmState.get_fields_and_field_types())
    nested = {one.type_name for one in answer.type_description.referenced_type_descriptions}
    assert nested == {f"{name}" for name in (
        "builtin_interfaces/msg/Time", "excavator_msgs/msg/CylinderState", "std_msgs/msg/Header")}
    assert {source.type_name for source in answer.type_sources} == nested | {"excavator_msgs/msg/ArmState"}
    refused = asked(type_name="excavator_msgs/msg/ArmState", type_hash="RIHS01_0")
    assert not refused.successful and "RIHS01_" in refused.failure_reason
    assert not asked(type_name="other_msgs/msg/Thing").successful
    process.interrupt()
