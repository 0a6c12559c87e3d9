"""Names of topics and types on the wire: rt/, rq/, rr/ and pkg::msg::dds_::Type_, as in all middlewares of ROS 2."""

import re

TOPIC_PREFIX = "rt"
REQUEST_PREFIX = "rq"
REPLY_PREFIX = "rr"

_TOKEN = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")


def expanded(name, node_name, namespace):
    """The absolute name of a topic or service that a node calls `name` (absolute, relative or ~private)."""
    prefix = "" if namespace == "/" else namespace
    if name == "~" or name.startswith("~/"):
        full = f"{prefix}/{node_name}{name[1:]}"
    elif name.startswith("/"):
        full = name
    else:
        full = f"{prefix}/{name}"
    for token in full[1:].split("/"):
        if not _TOKEN.match(token):
            raise ValueError(f"invalid topic or service name: {name!r}")
    return full


def dds_type(ros_name):
    """std_msgs/msg/String -> std_msgs::msg::dds_::String_"""
    package, kind, base = ros_name.split("/")
    return f"{package}::{kind}::dds_::{base}_"


def ros_type(dds_name):
    """std_msgs::msg::dds_::String_ -> std_msgs/msg/String; None for a type that is not of ROS."""
    package, found, base = dds_name.partition("::dds_::")
    if not found or not base.endswith("_"):
        return None
    return f"{package.replace('::', '/')}/{base[:-1]}"


def ros_topic(dds_topic):
    """rt/arm/state -> /arm/state; None for a topic that is not of ROS."""
    prefix, _, rest = dds_topic.partition("/")
    return f"/{rest}" if prefix == TOPIC_PREFIX else None


def ros_service(dds_topic, dds_type_name):
    """(rq/nameRequest, type) -> (/name, pkg/srv/Type); None for a topic that carries no service."""
    prefix, _, rest = dds_topic.partition("/")
    for wanted, topic_end, type_end in (
        (REQUEST_PREFIX, "Request", "_Request"),
        (REPLY_PREFIX, "Reply", "_Response"),
    ):
        ros_name = ros_type(dds_type_name)
        if prefix == wanted and rest.endswith(topic_end) and ros_name and ros_name.endswith(type_end):
            return f"/{rest[: -len(topic_end)]}", ros_name[: -len(type_end)]
    return None
