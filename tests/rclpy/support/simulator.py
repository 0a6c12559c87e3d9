"""The simulated arm, as the tests use it."""

import math
import time
from contextlib import contextmanager

from excavator_msgs.msg import ArmState, OrificeCommand
from rclpy.qos import QoSProfile

# A test that is late must not lose samples in its own queue: eight seconds at the rate that is usual here.
STATE_QOS = QoSProfile(depth=2000)
# At 1 kHz, a test on a busy machine cannot keep up, and would see what was long ago: the newest states only.
NEWEST_QOS = QoSProfile(depth=10)
# Commands that a late node has not taken yet wait here, and are not replaced by later ones.
COMMAND_QOS = QoSProfile(depth=1000)
# Time for which a command holds, and age that it may have, where a test is not about just that, s: the largest values that
# the node takes. Its own 0.1 s and 0.5 s are little when the test shares the processor with others.
COMMAND_TIMEOUT = 10.0
COMMAND_AGE = 3600.0
# Commands are renewed four times before they would run out with the node's own time, s.
RENEWAL = 0.025
# States after which a valve that is still closed stays so.
STAYS_CLOSED = 150
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
    """An `arm-simulator` that runs, with its states and a publisher of commands. Time is that of its stamps."""

    def __init__(
        self,
        ros,
        excavator,
        *,
        rate=250.0,
        command_timeout=COMMAND_TIMEOUT,
        under="/arm",
        namespace="",
        arguments=(),
        qos=STATE_QOS,
    ):
        """`command_timeout=None` leaves the node its own limits. `under`: where its topics are, and how it is called, beside
        another simulator; `namespace` moves the whole node instead, and its topics with it."""
        self._ros = ros
        self.rate = rate
        self.node = "arm_simulator"
        parameters = ["-p", f"rate:={rate}"]
        if command_timeout is not None:
            parameters += ["-p", f"command_timeout:={command_timeout}", "-p", f"command_max_age:={COMMAND_AGE}"]
        remaps = []
        if under != "/arm":
            self.node = under.strip("/")
            names = [f"/arm/{topic}:={under}/{topic}" for topic in ("state", "orifice_command", "stop")]
            remaps = [word for name in [f"__node:={self.node}", *names] for word in ("-r", name)]
        if namespace:
            remaps, under = ["-r", f"__ns:={namespace}"], f"{namespace}/arm"
        self.process = ros.start(excavator, "node", "arm-simulator", "--ros-args", *parameters, *remaps, *arguments)
        self.states = ros.hear(ArmState, f"{under}/state", qos)
        self._commands = ros.publisher(OrificeCommand, f"{under}/orifice_command", COMMAND_QOS)

    @property
    def last(self):
        return self.states[-1]

    @property
    def time(self):
        """Stamp of the last state, s."""
        return seconds(self.last.header.stamp)

    def area(self, name="arm"):
        return cylinder(self.last, name).orifice_area

    # commands

    def send(self, message):
        """Sends a command, stamped with the time of now."""
        self._commands.publish(stamped(message))

    def open(self, **areas):
        """Commands neutral, then the areas: a valve that was closed for safety opens again."""
        self.send(neutral(areas))
        self.send(command(**areas))

    def is_open(self, **areas):
        return all(math.isclose(self.area(name), area) for name, area in areas.items())

    def open_until(self, **areas):
        """Commands the areas until the valves are as open."""
        with self.holding(**areas):
            self._ros.spin_until(lambda: self.is_open(**areas), f"valves to open {areas} m2")

    def hold(self, duration, **areas):
        """Commands the areas, renewed in time, and returns the states of that time (s).

        It begins with the first state that shows them: a reader that is still busy with its first messages has older
        states waiting."""
        with self.holding(**areas):
            self._ros.spin_until(lambda: self.is_open(**areas), f"valves to open {areas} m2")
            return self.watch(duration)

    @contextmanager
    def holding(self, **areas):
        """Commands the areas, renewed in time, while the caller spins. When a renewal came too late, it opens again."""

        def renew():
            if all(self.area(name) == 0.0 for name in areas):
                self.open(**areas)
            else:
                self.send(command(**areas))

        renew()
        timer = self._ros.node.create_timer(RENEWAL, renew)
        try:
            yield
        finally:
            self._ros.node.destroy_timer(timer)

    def close(self):
        """Commands neutral until every valve is closed."""
        names = [one.name for one in self.last.cylinders]
        with self.holding(**{name: 0.0 for name in names}):
            self._ros.spin_until(lambda: all(self.area(name) == 0.0 for name in names), "closed valves")

    def closes(self, since, name="arm"):
        """The first state behind state number `since` from which on the valve stays closed. Commands that were sent before, neutral
        and open again, may be on their way still and close it for a moment only."""

        def is_closed(state):
            return cylinder(state, name).orifice_area == 0.0

        def stays_closed():
            return len(self.states) > since + STAYS_CLOSED and all(map(is_closed, self.states[-STAYS_CLOSED:]))

        self._ros.spin_until(stays_closed, f"the valve of the {name} to stay closed")
        first = len(self.states)
        while first > since and is_closed(self.states[first - 1]):
            first -= 1
        return self.states[first]

    def settle(self):
        """Closes the valves, and waits until the arm stands still."""
        self.close()
        self._ros.spin_until(
            lambda: self.area() == 0.0 and abs(cylinder(self.last).velocity) < CREEP, "the arm to stand still"
        )
        return self.last

    # states

    def next(self, count):
        """The next states, whenever they come."""
        before = len(self.states)
        self._ros.spin_until(lambda: len(self.states) >= before + count, f"{count} states")
        return self.states[before:]

    def watch(self, duration):
        """As many states as there are in this time (s) of the machine. A late node leaves some out, and it takes longer."""
        return self.next(round(duration * self.rate))

    def is_whole(self, states):
        """Whether no sample is missing in between. A node that waits for the processor leaves samples out."""
        return all(step < 1.5 / self.rate for step in steps(states))

    def undisturbed(self, attempt):
        """The states of the first attempt in which the simulator had the processor when it wanted it."""
        found = []
        self._ros.spin_until(lambda: found.append(attempt()) or self.is_whole(found[-1]), "states without a gap")
        return found[-1]


def steps(states):
    """Times from stamp to stamp, s."""
    stamps = [state.header.stamp for state in states]
    pairs = zip(stamps, stamps[1:])
    return [later.sec - earlier.sec + (later.nanosec - earlier.nanosec) * 1e-9 for earlier, later in pairs]


def all_finite(values):
    return all(math.isfinite(value) for value in values)
