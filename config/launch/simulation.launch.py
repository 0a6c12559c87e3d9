"""The simulated arm with everything around it: simulator, energy monitor, robot description, and RViz or a recorder.

    ros2 launch excavator simulation.launch.py
    ros2 launch excavator simulation.launch.py model:=zx30u rate:=500.0 record:=run1 rviz:=true namespace:=left

When one of them ends, all end. `excavator` is looked for in the ROS package, then on the PATH, unless `program` says where it is.
"""

import sys
from pathlib import Path

from launch import LaunchDescription
from launch.actions import OpaqueFunction

# launch reads this file by its path, so its folder is not searched
sys.path.insert(0, str(Path(__file__).resolve().parent))

from excavator_parts import declared, links, node, of_ros, recorder, value  # noqa: E402

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
        actions.append(links(context))
    if value(context, "rviz") == "true":
        actions.append(of_ros(context, "rviz2", arguments=["-d", str(CONFIG / "layouts" / "arm.rviz")]))
    return actions + recorder(context)


def generate_launch_description():
    return LaunchDescription([*declared(ARGUMENTS), OpaqueFunction(function=start)])
