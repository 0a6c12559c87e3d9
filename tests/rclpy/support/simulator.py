"""The simulated arm, as the tests use it."""

import math
import time
from contextlib import contextmanager

from excavator_msgs.msg import ArmState, OrificeCommand
from rclpy.qos import QoSProfile

# A test that is late must not lose samples in its own queue: two seconds at 1 kHz.
STATE_QOS = QoSProfile(depth=2000)
# Time for which a command holds where a test is not about just that, s; the node's own 0.1 s is little when the test
# shares the processor with a compiler.
COMMAND_TIMEOUT = 1.0
# Commands are renewed four times before they would run out with the node's own time.
RENEWAL = 0.025
# Opening in zx30u-arm.toml, m2; commands stay well inside.
MAXIMUM_AREA = 1.15e-4
# With closed valves its weight and the leakage let the arm creep by 2 mm/s, m/s.
CREEP = 5e-3


def seconds(stamp):
    return stamp.sec + stamp.nanosec * 1e-9


def cylinder(state, name="arm"):
    (found,) = [cylinder for cylinder in state.cylinders if cylinder.name == name]
    return found


def stamped(message, offset=0.0):
    """The command, stamped with the time of now plus `offset` seconds."""
    nanoseconds = time.time_ns() + round(offset * 1e9)
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(nanoseconds, 1_000_000_000)
    return message


def command(**areas):
    """`command(arm=1e-5)`, stamped with the time of now."""
    return stamped(OrificeCommand(names=list(areas), areas=[float(area) for area in areas.values()]))


def neutral(names):
    """An area of 0 for each of these cylinders: what a valve that was closed for safety wants first."""
    return command(**{name: 0.0 for name in names})


class Simulator:
    """An `arm-simulator` that runs, with its states and a publisher of commands."""

    def __init__(
        self, ros, excavator, *, rate=250.0, command_timeout=COMMAND_TIMEOUT, under="/arm", namespace="", arguments=()
    ):
        """`command_timeout=None` leaves the node its own. `under`: where its topics are, beside another simulator; `namespace`
        moves the whole node instead, and its topics with it."""
        self._ros = ros
        self.rate = rate
        parameters = ["-p", f"rate:={rate}"]
        if command_timeout is not None:
            parameters += ["-p", f"command_timeout:={command_timeout}"]
        names = [f"/arm/{topic}:={under}/{topic}" for topic in ("state", "orifice_command")] if under != "/arm" else []
        remaps = [word for name in names for word in ("-r", name)]
        if namespace:
            remaps, under = ["-r", f"__ns:={namespace}"], f"{namespace}/arm"
        self.process = ros.start(excavator, "node", "arm-simulator", "--ros-args", *parameters, *remaps, *arguments)
        self.states = ros.listen(ArmState, f"{under}/state", STATE_QOS)
        ros.spin_until(lambda: self.states, f"the first {under}/state")
        self._commands = ros.publisher(OrificeCommand, f"{under}/orifice_command")

    @property
    def last(self):
        return self.states[-1]

    def send(self, message):
        """Sends a command, stamped with the time of now."""
        self._commands.publish(stamped(message))

    def open(self, **areas):
        """Commands neutral, then the areas: a valve that was closed for safety opens again."""
        self.send(neutral(areas))
        self.send(command(**areas))

    def open_until(self, **areas):
        """Commands the areas until the valves are as open."""

        def is_open():
            return all(math.isclose(cylinder(self.last, name).orifice_area, areas[name]) for name in areas)

        with self.holding(**areas):
            self._ros.spin_until(is_open, f"valves to open {areas} m2")

    def hold(self, duration, **areas):
        """Commands the areas, renewed in time, and returns the states of that time."""
        before = len(self.states)
        with self.holding(**areas):
            self._ros.spin_for(duration)
        return self.states[before:]

    @contextmanager
    def holding(self, **areas):
        """Commands the areas, renewed in time, while the caller spins. When a renewal came too late, it opens again."""

        def renew():
            if all(cylinder(self.last, name).orifice_area == 0.0 for name in areas):
                self.open(**areas)
            else:
                self.send(command(**areas))

        renew()
        timer = self._ros.node.create_timer(RENEWAL, renew)
        try:
            yield
        finally:
            self._ros.node.destroy_timer(timer)

    def watch(self, duration):
        """The states of the next seconds."""
        before = len(self.states)
        self._ros.spin_for(duration)
        return self.states[before:]

    def next(self, count):
        """The next states, whenever they come."""
        before = len(self.states)
        self._ros.spin_until(lambda: len(self.states) >= before + count, f"{count} states")
        return self.states[before:]

    def settle(self):
        """Waits until valves are closed and the arm stands still."""
        self._ros.spin_until(
            lambda: cylinder(self.last).orifice_area == 0.0 and abs(cylinder(self.last).velocity) < CREEP,
            "the arm to stand still",
        )
        return self.last


def all_finite(values):
    return all(math.isfinite(value) for value in values)
