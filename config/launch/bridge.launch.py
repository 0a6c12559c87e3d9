"""A real machine: the bridge that makes /arm/state of its topics, with energy monitor, robot description and recorder.

    ros2 launch config/launch/bridge.launch.py signals:=my-machine.toml
    ros2 launch config/launch/bridge.launch.py signals:=my-machine.toml description:=zx30u record:=run1

`signals` is the file (.toml) that says which field of which topic is which signal; default signals.toml.
`excavator` is looked for on the PATH unless `program` says where it is.
"""

from pathlib import Path

from ament_index_python.packages import PackageNotFoundError, get_package_prefix
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, LogInfo, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

CONFIG = Path(__file__).resolve().parents[1]

ARGUMENTS = {
    "program": ("excavator", "the program, if it is not on the PATH"),
    "signals": ("signals.toml", "file (.toml) that says where the signals come from"),
    "energy": ("true", "run the energy monitor"),
    "model": ("", "model of the energy monitor, built-in or file; empty: the one on /arm/model"),
    "description": ("", "robot description to publish, a file in config/description without .urdf; empty: none"),
    "record": ("", "bag to record everything into; empty: none"),
}


def value(context, name):
    return LaunchConfiguration(name).perform(context)


def robot_description(urdf):
    """Publishes a URDF file; without robot_state_publisher, which not every ROS 2 has, a word about it."""
    package = "robot_state_publisher"
    try:
        get_package_prefix(package)
    except PackageNotFoundError:
        return LogInfo(msg=f"{package} is not installed: no robot description is published")
    return Node(package=package, executable=package, parameters=[{"robot_description": urdf.read_text()}])


def start(context):
    """What depends on the values of the arguments."""
    program = value(context, "program")
    bridge = [program, "node", "arm-bridge", "--ros-args", "-p", f"description:={value(context, 'signals')}"]
    actions = [ExecuteProcess(cmd=bridge, name="arm-bridge", output="screen", sigterm_timeout="10")]
    if value(context, "energy") == "true":
        monitor = [program, "node", "energy-monitor", "--ros-args"]
        if value(context, "model"):
            monitor += ["-p", f"model:={value(context, 'model')}"]
        actions.append(ExecuteProcess(cmd=monitor, name="energy-monitor", output="screen"))
    if value(context, "description"):
        urdf = CONFIG / "description" / f"{value(context, 'description')}.urdf"
        actions.append(robot_description(urdf))
    if value(context, "record"):
        recorder = [program, "record", "--all", "-o", value(context, "record")]
        actions.append(ExecuteProcess(cmd=recorder, name="recorder", output="screen", sigterm_timeout="10"))
    return actions


def generate_launch_description():
    declared = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in ARGUMENTS.items()
    ]
    return LaunchDescription([*declared, OpaqueFunction(function=start)])
