"""A real machine: the bridge that makes arm/state of its topics, with energy monitor, robot description and recorder.

    ros2 launch excavator bridge.launch.py signals:=my-machine.toml
    ros2 launch excavator bridge.launch.py signals:=my-machine.toml model:=my-model.toml record:=run1 namespace:=left

`signals` is the file (.toml) that says which field of which topic is which signal; default signals.toml. When one part ends, all end.
`excavator` is looked for in the ROS package, then on the PATH, unless `program` says where it is.
"""

import sys
from pathlib import Path

from launch import LaunchDescription
from launch.actions import OpaqueFunction

# launch reads this file by its path, so its folder is not searched
sys.path.insert(0, str(Path(__file__).resolve().parent))

from excavator_parts import declared, links, node, recorder, value  # noqa: E402

ARGUMENTS = {
    "program": ("", "the program, if it is neither in the ROS package nor on the PATH"),
    "namespace": ("", "namespace of all nodes and topics"),
    "signals": ("signals.toml", "file (.toml) that says where the signals come from"),
    "energy": ("true", "run the energy monitor"),
    "model": ("", "model of the machine, built-in or file; empty: the one on arm/model"),
    "record": ("", "bag to record everything into; empty: none"),
}


def start(context):
    """What depends on the values of the arguments."""
    actions = [node(context, "arm-bridge", {"description": value(context, "signals")})]
    model = value(context, "model")
    if value(context, "energy") == "true":
        actions.append(node(context, "energy-monitor", {"model": model} if model else {}))
    if model:
        actions.append(links(context))
    return actions + recorder(context)


def generate_launch_description():
    return LaunchDescription([*declared(ARGUMENTS), OpaqueFunction(function=start)])
