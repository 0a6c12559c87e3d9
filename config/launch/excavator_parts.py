"""What both launch files start their parts with."""

import subprocess
from pathlib import Path

from ament_index_python.packages import PackageNotFoundError, get_package_prefix
from launch.actions import DeclareLaunchArgument, EmitEvent, ExecuteProcess, LogInfo
from launch.events import Shutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

END = [EmitEvent(event=Shutdown(reason="a part has ended"))]


def declared(arguments):
    """Launch arguments of a table from name to default and meaning."""
    return [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in arguments.items()
    ]


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


def part(words, name):
    return ExecuteProcess(cmd=words, name=name, output="screen", sigterm_timeout="10", on_exit=END)


def node(context, kind, parameters):
    """A node of the program in the namespace."""
    command = [program(context), "node", kind, "--ros-args"]
    for name, setting in parameters.items():
        command += ["-p", f"{name}:={setting}"]
    if value(context, "namespace"):
        command += ["-r", f"__ns:=/{value(context, 'namespace').strip('/')}"]
    return part(command, kind)


def recorder(context):
    """The recorder of everything, where a bag is named; else nothing."""
    bag = value(context, "record")
    return [part([program(context), "record", "--all", "-o", bag], "recorder")] if bag else []


def of_ros(context, package, **words):
    """A node of ROS's own, where its package is installed; else a word about it."""
    try:
        get_package_prefix(package)
    except PackageNotFoundError:
        return LogInfo(msg=f"{package} is not installed and is not started")
    namespace = value(context, "namespace")
    return Node(package=package, executable=package, namespace=namespace, on_exit=END, **words)


def links(context):
    """The links of the model's machine as transforms."""
    words = [program(context), "model", "urdf", "--model", value(context, "model")]
    urdf = subprocess.run(words, capture_output=True, text=True, check=False)
    if urdf.returncode != 0:
        raise RuntimeError(urdf.stderr.strip())
    return of_ros(context, "robot_state_publisher", parameters=[{"robot_description": urdf.stdout}])
