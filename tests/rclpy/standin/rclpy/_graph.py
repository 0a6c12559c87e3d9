"""The ROS graph: DDS discovery tells the endpoints, topic ros_discovery_info tells which node they belong to."""

import threading
from dataclasses import dataclass

from cyclonedds.builtin import (
    BuiltinDataReader,
    BuiltinTopicDcpsParticipant,
    BuiltinTopicDcpsPublication,
    BuiltinTopicDcpsSubscription,
)
from cyclonedds.core import InstanceState, ReadCondition, SampleState, ViewState
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic

from . import qos
from ._messages import message_class
from ._wire import MessageCodec

_MANY = 10_000  # samples in one read: more than a test's graph has
_TOPIC = "ros_discovery_info"

_Info = message_class("rmw_dds_common/msg/ParticipantEntitiesInfo")
_NodeInfo = message_class("rmw_dds_common/msg/NodeEntitiesInfo")
_Gid = message_class("rmw_dds_common/msg/Gid")


@dataclass(frozen=True)
class Endpoint:
    """A reader or writer somewhere in the domain, as discovery announces it."""

    gid: bytes
    topic: str
    type: str
    qos: object


def gid_of(entity):
    return entity.guid.bytes


def _gid_message(gid):
    return _Gid(data=list(gid))


class _Builtin:
    def __init__(self, participant, topic):
        self._reader = BuiltinDataReader(participant, topic)
        self._alive = ReadCondition(self._reader, ViewState.Any | SampleState.Any | InstanceState.Alive)

    def alive(self):
        return self._reader.read(N=_MANY, condition=self._alive)


class Graph:
    def __init__(self, participant):
        self._lock = threading.RLock()
        self._gid = gid_of(participant)
        self._participants = _Builtin(participant, BuiltinTopicDcpsParticipant)
        self._endpoints = {
            "publication": _Builtin(participant, BuiltinTopicDcpsPublication),
            "subscription": _Builtin(participant, BuiltinTopicDcpsSubscription),
        }
        self._codec = MessageCodec(_Info)
        topic = Topic(participant, _TOPIC, self._codec.sample_type)
        durability = qos.DurabilityPolicy.TRANSIENT_LOCAL
        self._reader = DataReader(
            participant,
            topic,
            qos=qos._to_dds(qos.QoSProfile(history=qos.HistoryPolicy.KEEP_ALL, durability=durability)),
        )
        self._writer = DataWriter(participant, topic, qos=qos._to_dds(qos.QoSProfile(depth=1, durability=durability)))
        self._infos = {}
        self._own = {}
        self._publish()

    def set_node(self, name, namespace, readers, writers):
        """Says which endpoints a node of this context has."""
        with self._lock:
            self._own[(namespace, name)] = _NodeInfo(
                node_namespace=namespace,
                node_name=name,
                reader_gid_seq=[_gid_message(gid_of(reader)) for reader in readers],
                writer_gid_seq=[_gid_message(gid_of(writer)) for writer in writers],
            )
            self._publish()

    def remove_node(self, name, namespace):
        with self._lock:
            self._own.pop((namespace, name), None)
            self._publish()

    def _publish(self):
        info = _Info(gid=_gid_message(self._gid), node_entities_info_seq=list(self._own.values()))
        self._writer.write(self._codec.encode(info))

    def _alive_infos(self):
        with self._lock:
            for sample in self._reader.take(N=_MANY):
                if sample.sample_info.valid_data:
                    info = self._codec.decode(sample)
                    self._infos[bytes(info.gid.data)] = info
            alive = {sample.key.bytes for sample in self._participants.alive()}
            self._infos = {gid: info for gid, info in self._infos.items() if gid in alive}
            return list(self._infos.values())

    def nodes(self):
        """(namespace, name) -> gids of all endpoints of the nodes of that name."""
        found = {}
        for info in self._alive_infos():
            for node in info.node_entities_info_seq:
                gids = found.setdefault((node.node_namespace, node.node_name), [])
                gids.append({bytes(gid.data) for gid in [*node.reader_gid_seq, *node.writer_gid_seq]})
        return found

    def endpoints(self, kind):
        """All endpoints of `kind`, "publication" or "subscription"."""
        with self._lock:
            return [
                Endpoint(sample.key.bytes, sample.topic_name, sample.type_name, sample.qos)
                for sample in self._endpoints[kind].alive()
            ]
