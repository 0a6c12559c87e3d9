"""What discovery tells about a publisher or subscription."""

from enum import IntEnum


class TopicEndpointTypeEnum(IntEnum):
    INVALID = 0
    PUBLISHER = 1
    SUBSCRIPTION = 2


class TopicEndpointInfo:
    def __init__(self, **kwargs):
        self.node_name = kwargs["node_name"]
        self.node_namespace = kwargs["node_namespace"]
        self.topic_type = kwargs["topic_type"]
        self.endpoint_type = kwargs["endpoint_type"]
        self.endpoint_gid = kwargs["endpoint_gid"]
        self.qos_profile = kwargs["qos_profile"]
