"""Publishers."""

from ._entity import Writer
from ._names import TOPIC_PREFIX
from ._wire import MessageCodec


class Publisher:
    def __init__(self, node, msg_type, topic, qos_profile):
        self._node = node
        self.msg_type = msg_type
        self.topic_name = topic
        self.qos_profile = qos_profile
        self._writer = Writer(node._participant, TOPIC_PREFIX + topic, MessageCodec(msg_type), qos_profile)
        self._readers, self._writers = [], [self._writer]

    def publish(self, msg):
        if not isinstance(msg, self.msg_type):
            raise TypeError(f"Expected {self.msg_type}, got {type(msg)}")
        self._writer.dds.write(self._writer.codec.encode(msg))

    def get_subscription_count(self):
        return len(self._writer.matched_readers())

    def destroy(self):
        self._node.destroy_publisher(self)
