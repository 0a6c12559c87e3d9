"""Quality of service profiles, names and defaults as rclpy's."""

from enum import IntEnum

from cyclonedds.qos import Policy, Qos

from .duration import Duration


class HistoryPolicy(IntEnum):
    SYSTEM_DEFAULT = 0
    KEEP_LAST = 1
    KEEP_ALL = 2
    UNKNOWN = 3


class ReliabilityPolicy(IntEnum):
    SYSTEM_DEFAULT = 0
    RELIABLE = 1
    BEST_EFFORT = 2
    UNKNOWN = 3


class DurabilityPolicy(IntEnum):
    SYSTEM_DEFAULT = 0
    TRANSIENT_LOCAL = 1
    VOLATILE = 2
    UNKNOWN = 3


QoSHistoryPolicy = HistoryPolicy
QoSReliabilityPolicy = ReliabilityPolicy
QoSDurabilityPolicy = DurabilityPolicy


class InvalidQoSProfileException(Exception):
    """Raised when a profile is not complete."""


class QoSProfile:
    def __init__(self, **kwargs):
        unknown = kwargs.keys() - {"history", "depth", "reliability", "durability"}
        assert not unknown, f"Invalid arguments passed to constructor: {unknown}"
        if "history" not in kwargs and "depth" not in kwargs:
            raise InvalidQoSProfileException("History and/or depth settings are required.")
        self.history = HistoryPolicy(kwargs.get("history", HistoryPolicy.KEEP_LAST))
        if self.history == HistoryPolicy.KEEP_LAST and "depth" not in kwargs:
            raise InvalidQoSProfileException("History set to KEEP_LAST without a depth setting.")
        self.depth = kwargs.get("depth", 0)
        self.reliability = ReliabilityPolicy(kwargs.get("reliability", ReliabilityPolicy.RELIABLE))
        self.durability = DurabilityPolicy(kwargs.get("durability", DurabilityPolicy.VOLATILE))

    def __eq__(self, other):
        return isinstance(other, QoSProfile) and vars(self) == vars(other)

    __hash__ = None

    def __repr__(self):
        return f"QoSProfile({', '.join(f'{name}={value!r}' for name, value in vars(self).items())})"


def _from_depth(qos):
    """What rclpy does with a bare number where a profile is expected."""
    return QoSProfile(depth=qos) if isinstance(qos, int) else qos


# Reliable writers of rmw_cyclonedds never give up blocking on a full window; the reader side has no use for the time.
_FOREVER = Duration(seconds=2**31 - 1).nanoseconds


def _to_dds(profile, user_data=""):
    """The profile as Cyclone DDS policies, plain CDR only as all ROS 2 middlewares of Jazzy write."""
    policies = [
        Policy.DataRepresentation(use_cdrv0_representation=True),
        Policy.WriterDataLifecycle(autodispose=False),
        Policy.History.KeepAll
        if profile.history == HistoryPolicy.KEEP_ALL
        else Policy.History.KeepLast(max(profile.depth, 1)),
        Policy.Reliability.BestEffort
        if profile.reliability == ReliabilityPolicy.BEST_EFFORT
        else Policy.Reliability.Reliable(_FOREVER),
    ]
    if profile.durability == DurabilityPolicy.TRANSIENT_LOCAL:
        depth = max(profile.depth, 1)
        service_history = (
            Policy.History.KeepAll if profile.history == HistoryPolicy.KEEP_ALL else Policy.History.KeepLast(depth)
        )
        policies += [Policy.Durability.TransientLocal, Policy.DurabilityService(0, service_history, -1, -1, -1)]
    else:
        policies.append(Policy.Durability.Volatile)
    if user_data:
        policies.append(Policy.Userdata(user_data.encode()))
    return Qos(*policies)


def _from_dds(qos):
    """The profile that an endpoint announces; discovery says nothing about history and depth."""
    reliability = qos[Policy.Reliability]
    durability = qos[Policy.Durability]
    return QoSProfile(
        history=HistoryPolicy.UNKNOWN,
        reliability=ReliabilityPolicy.RELIABLE
        if isinstance(reliability, Policy.Reliability.Reliable)
        else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL
        if durability == Policy.Durability.TransientLocal
        else DurabilityPolicy.VOLATILE,
    )


qos_profile_sensor_data = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
qos_profile_services_default = QoSProfile(depth=10)
qos_profile_parameters = QoSProfile(depth=1000)
qos_profile_action_status_default = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
