"""Subscriptions."""

from ._entity import Reader
from ._names import TOPIC_PREFIX
from ._wire import MessageCodec


class Subscription:
    def __init__(self, node, msg_type, topic, callback, qos_profile):
        self._node = node
        self.msg_type = msg_type
        self.topic_name = topic
        self.callback = callback
        self.qos_profile = qos_profile
        self._reader = Reader(node._participant, TOPIC_PREFIX + topic, MessageCodec(msg_type), qos_profile)
        self._readers, self._writers = [self._reader], []

    def get_publisher_count(self):
        return len(self._reader.matched_writers())

    def _execute_one(self):
        sample = self._reader.take()
        if sample is None:
            return False
        self.callback(self._reader.codec.decode(sample))
        return True

    def destroy(self):
        self._node.destroy_subscription(self)
