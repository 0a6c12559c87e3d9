"""The simulated arm with everything around it: simulator, energy monitor, robot description, and RViz or a recorder.

    ros2 launch config/launch/simulation.launch.py
    ros2 launch config/launch/simulation.launch.py model:=zx30u rate:=500.0 record:=run1 rviz:=true

`excavator` is looked for on the PATH unless `program` says where it is.
"""

from pathlib import Path

from ament_index_python.packages import PackageNotFoundError, get_package_prefix
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, LogInfo, OpaqueFunction
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

CONFIG = Path(__file__).resolve().parents[1]

ARGUMENTS = {
    "program": ("excavator", "the program, if it is not on the PATH"),
    "model": ("zx30u-arm", "built-in model or model file (.toml)"),
    "rate": ("1000.0", "samples per second [Hz]"),
    "seed": ("1", "draws noise, dropouts and losses"),
    "pressure_noise": ("0.0", "standard deviation of pressure sensors [Pa]"),
    "displacement_noise": ("0.0", "standard deviation of displacement sensors [m]"),
    "energy": ("true", "run the energy monitor"),
    "description": ("true", "publish the robot description, where there is one for the model"),
    "rviz": ("false", "show the arm in RViz"),
    "record": ("", "bag to record everything into; empty: none"),
}
SIMULATOR_PARAMETERS = ("model", "rate", "seed", "pressure_noise", "displacement_noise")


def value(context, name):
    return LaunchConfiguration(name).perform(context)


def node(context, kind, parameters):
    command = [value(context, "program"), "node", kind, "--ros-args"]
    for name, setting in parameters.items():
        command += ["-p", f"{name}:={setting}"]
    return ExecuteProcess(cmd=command, name=kind, output="screen", sigterm_timeout="10")


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
    actions = [node(context, "arm-simulator", {name: value(context, name) for name in SIMULATOR_PARAMETERS})]
    if value(context, "energy") == "true":
        actions.append(node(context, "energy-monitor", {}))
    urdf = CONFIG / "description" / f"{Path(value(context, 'model')).stem}.urdf"
    if value(context, "description") == "true" and urdf.is_file():
        actions.append(robot_description(urdf))
    bag = value(context, "record")
    if bag:
        actions.append(ExecuteProcess(cmd=[value(context, "program"), "record", "--all", "-o", bag], output="screen"))
    return actions


def generate_launch_description():
    declared = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in ARGUMENTS.items()
    ]
    rviz = Node(
        package="rviz2",
        executable="rviz2",
        arguments=["-d", str(CONFIG / "layouts" / "arm.rviz")],
        condition=IfCondition(LaunchConfiguration("rviz")),
    )
    return LaunchDescription([*declared, OpaqueFunction(function=start), rviz])
