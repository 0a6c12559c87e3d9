"""The simulated arm with everything around it: simulator, energy monitor, robot description, and RViz or a recorder.

    ros2 launch excavator simulation.launch.py
    ros2 launch excavator simulation.launch.py model:=zx30u rate:=500.0 record:=run1 rviz:=true namespace:=left

When one of them ends, all end. `excavator` is looked for in the ROS package, then on the PATH, unless `program` says where it is.
"""

import subprocess
from pathlib import Path

from ament_index_python.packages import PackageNotFoundError, get_package_prefix
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, EmitEvent, ExecuteProcess, LogInfo, OpaqueFunction
from launch.events import Shutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

CONFIG = Path(__file__).resolve().parents[1]

ARGUMENTS = {
    "program": ("", "the program, if it is neither in the ROS package nor on the PATH"),
    "namespace": ("", "namespace of all nodes and topics"),
    "model": ("zx30u-arm", "built-in model or model file (.toml)"),
    "rate": ("1000.0", "samples per second [Hz]"),
    "seed": ("1", "draws noise, dropouts and losses"),
    "pressure_noise": ("0.0", "standard deviation of pressure sensors [Pa]"),
    "displacement_noise": ("0.0", "standard deviation of displacement sensors [m]"),
    "energy": ("true", "run the energy monitor"),
    "description": ("true", "publish the links of the arm as transforms"),
    "rviz": ("false", "show the arm in RViz"),
    "record": ("", "bag to record everything into; empty: none"),
}
SIMULATOR_PARAMETERS = ("model", "rate", "seed", "pressure_noise", "displacement_noise")
NUMBERS = ("rate", "seed", "pressure_noise", "displacement_noise")
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


def is_installed(package):
    try:
        get_package_prefix(package)
    except PackageNotFoundError:
        return False
    return True


def node(context, kind, parameters):
    command = [program(context), "node", kind, "--ros-args"]
    for name, setting in parameters.items():
        command += ["-p", f"{name}:={setting}"]
    if value(context, "namespace"):
        command += ["-r", f"__ns:=/{value(context, 'namespace').strip('/')}"]
    return ExecuteProcess(cmd=command, name=kind, output="screen", sigterm_timeout="10", on_exit=END)


def of_ros(context, package, **words):
    """A node of ROS's own, where its package is installed; else a word about it."""
    if not is_installed(package):
        return LogInfo(msg=f"{package} is not installed and is not started")
    namespace = value(context, "namespace")
    return Node(package=package, executable=package, namespace=namespace, on_exit=END, **words)


def start(context):
    """What depends on the values of the arguments."""
    for name in NUMBERS:
        try:
            float(value(context, name))
        except ValueError:
            raise RuntimeError(f"{name}:={value(context, name)} is not a number") from None
    actions = [node(context, "arm-simulator", {name: value(context, name) for name in SIMULATOR_PARAMETERS})]
    if value(context, "energy") == "true":
        actions.append(node(context, "energy-monitor", {}))
    if value(context, "description") == "true":
        words = [program(context), "model", "urdf", "--model", value(context, "model")]
        urdf = subprocess.run(words, capture_output=True, text=True, check=False)
        if urdf.returncode != 0:
            raise RuntimeError(urdf.stderr.strip())
        actions.append(of_ros(context, "robot_state_publisher", parameters=[{"robot_description": urdf.stdout}]))
    if value(context, "rviz") == "true":
        actions.append(of_ros(context, "rviz2", arguments=["-d", str(CONFIG / "layouts" / "arm.rviz")]))
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
