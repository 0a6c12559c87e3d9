"""A real machine: the bridge that makes arm/state of its topics, with energy monitor, robot description and recorder.

    ros2 launch excavator bridge.launch.py signals:=my-machine.toml
    ros2 launch excavator bridge.launch.py signals:=my-machine.toml model:=my-model.toml record:=run1 namespace:=left

`signals` is the file (.toml) that says which field of which topic is which signal; default signals.toml. When one part ends, all end.
`excavator` is looked for in the ROS package, then on the PATH, unless `program` says where it is.
"""

import subprocess
from pathlib import Path

from ament_index_python.packages import PackageNotFoundError, get_package_prefix
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, EmitEvent, ExecuteProcess, LogInfo, OpaqueFunction
from launch.events import Shutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

ARGUMENTS = {
    "program": ("", "the program, if it is neither in the ROS package nor on the PATH"),
    "namespace": ("", "namespace of all nodes and topics"),
    "signals": ("signals.toml", "file (.toml) that says where the signals come from"),
    "energy": ("true", "run the energy monitor"),
    "model": ("", "model of the machine, built-in or file; empty: the one on arm/model"),
    "record": ("", "bag to record everything into; empty: none"),
}
END = [EmitEvent(event=Shutdown(reason="a part has ended"))]


def value(context, name):
    return LaunchConfiguration(name).perform(context)


def program(context):
    """Where `excavator` is."""
    if value(context, "program"):
        return value(context, "program")
    try:
        return str(Path(get_package_prefix("excavator")) / "lib" / "excavator" / "excavator")
    except PackageNotFoundError:
        return "excavator"


def node(context, kind, parameters):
    command = [program(context), "node", kind, "--ros-args"]
    for name, setting in parameters.items():
        command += ["-p", f"{name}:={setting}"]
    if value(context, "namespace"):
        command += ["-r", f"__ns:=/{value(context, 'namespace').strip('/')}"]
    return ExecuteProcess(cmd=command, name=kind, output="screen", sigterm_timeout="10", on_exit=END)


def robot_description(context):
    """Publishes the links of the model's machine; without robot_state_publisher, which not every ROS 2 has, a word about it."""
    package = "robot_state_publisher"
    try:
        get_package_prefix(package)
    except PackageNotFoundError:
        return LogInfo(msg=f"{package} is not installed: no robot description is published")
    words = [program(context), "model", "urdf", "--model", value(context, "model")]
    urdf = subprocess.run(words, capture_output=True, text=True, check=False)
    if urdf.returncode != 0:
        raise RuntimeError(urdf.stderr.strip())
    parameters = [{"robot_description": urdf.stdout}]
    namespace = value(context, "namespace")
    return Node(package=package, executable=package, namespace=namespace, parameters=parameters, on_exit=END)


def start(context):
    """What depends on the values of the arguments."""
    actions = [node(context, "arm-bridge", {"description": value(context, "signals")})]
    model = value(context, "model")
    if value(context, "energy") == "true":
        actions.append(node(context, "energy-monitor", {"model": model} if model else {}))
    if model:
        actions.append(robot_description(context))
    if value(context, "record"):
        words = [program(context), "record", "--all", "-o", value(context, "record")]
        recorder = ExecuteProcess(cmd=words, name="recorder", output="screen", sigterm_timeout="10", on_exit=END)
        actions.append(recorder)
    return actions


def generate_launch_description():
    declared = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in ARGUMENTS.items()
    ]
    return LaunchDescription([*declared, OpaqueFunction(function=start)])
