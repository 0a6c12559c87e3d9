"""Nodes."""

import itertools

from . import _names
from .client import Client
from .clock import Clock
from .publisher import Publisher
from .qos import _from_dds, _from_depth, qos_profile_services_default
from .service import Service
from .subscription import Subscription
from .timer import Timer
from .topic_endpoint_info import TopicEndpointInfo, TopicEndpointTypeEnum
from .utilities import get_default_context


class Node:
    """A node without parameters of its own: `start_parameter_services=False` has to be said."""

    def __init__(self, node_name, *, context=None, namespace=None, enable_rosout=True, start_parameter_services=True):
        if start_parameter_services:
            raise NotImplementedError("the stand-in has no parameter services: pass start_parameter_services=False")
        self._context = get_default_context() if context is None else context
        if not self._context.ok():
            raise RuntimeError("rclpy.init() has to be called first")
        self._name = node_name
        self._namespace = "/" + (namespace or "").strip("/")
        self._participant = self._context._participant
        self._graph = self._context._graph
        self._endpoint_numbers = itertools.count(1)
        self._entities = []
        self._timers = []
        self._clock = Clock()
        self.executor = None
        self._context._nodes.append(self)
        self._announce()

    @property
    def context(self):
        return self._context

    @property
    def _waitables(self):
        return [entity for entity in self._entities if entity._readers]

    def get_name(self):
        return self._name

    def get_namespace(self):
        return self._namespace

    def get_fully_qualified_name(self):
        return f"{self._namespace.rstrip('/')}/{self._name}"

    def get_clock(self):
        return self._clock

    def create_publisher(self, msg_type, topic, qos_profile):
        return self._add(Publisher(self, msg_type, self._expanded(topic), _from_depth(qos_profile)))

    def create_subscription(self, msg_type, topic, callback, qos_profile):
        return self._add(Subscription(self, msg_type, self._expanded(topic), callback, _from_depth(qos_profile)))

    def create_client(self, srv_type, srv_name, *, qos_profile=qos_profile_services_default):
        return self._add(Client(self, srv_type, self._expanded(srv_name), qos_profile))

    def create_service(self, srv_type, srv_name, callback, *, qos_profile=qos_profile_services_default):
        return self._add(Service(self, srv_type, self._expanded(srv_name), callback, qos_profile))

    def create_timer(self, timer_period_sec, callback):
        timer = Timer(self, callback, timer_period_sec)
        self._timers.append(timer)
        if self.executor:
            self.executor.wake()
        return timer

    def destroy_publisher(self, publisher):
        return self._remove(publisher)

    def destroy_subscription(self, subscription):
        return self._remove(subscription)

    def destroy_client(self, client):
        return self._remove(client)

    def destroy_service(self, service):
        return self._remove(service)

    def destroy_timer(self, timer):
        if timer not in self._timers:
            return False
        self._timers.remove(timer)
        return True

    def destroy_node(self):
        if self not in self._context._nodes:
            return
        for entity in list(self._entities):
            self._remove(entity)
        self._timers = []
        if self.executor:
            self.executor.remove_node(self)
        self._context._nodes.remove(self)
        self._graph.remove_node(self._name, self._namespace)
        self._participant = self._graph = None

    def get_node_names(self):
        return [name for name, _ in self.get_node_names_and_namespaces()]

    def get_node_names_and_namespaces(self):
        nodes = self._graph.nodes()
        return sorted((name, namespace) for (namespace, name), gids in nodes.items() for _ in gids)

    def get_topic_names_and_types(self, no_demangle=False):
        if no_demangle:
            raise NotImplementedError("the stand-in lists demangled names only")
        return self._topics(("publication", "subscription"), lambda endpoint: True)

    def get_service_names_and_types(self):
        return self._services(lambda endpoint: True)

    def get_publisher_names_and_types_by_node(self, node_name, node_namespace, no_demangle=False):
        gids = self._gids_of(node_name, node_namespace)
        return self._topics(("publication",), lambda endpoint: endpoint.gid in gids)

    def get_subscriber_names_and_types_by_node(self, node_name, node_namespace, no_demangle=False):
        gids = self._gids_of(node_name, node_namespace)
        return self._topics(("subscription",), lambda endpoint: endpoint.gid in gids)

    def get_service_names_and_types_by_node(self, node_name, node_namespace):
        gids = self._gids_of(node_name, node_namespace)
        return self._services(lambda endpoint: endpoint.gid in gids, kinds=("subscription",))

    def count_publishers(self, topic_name):
        return len(self.get_publishers_info_by_topic(topic_name))

    def count_subscribers(self, topic_name):
        return len(self.get_subscriptions_info_by_topic(topic_name))

    def get_publishers_info_by_topic(self, topic_name):
        return self._infos(topic_name, "publication", TopicEndpointTypeEnum.PUBLISHER)

    def get_subscriptions_info_by_topic(self, topic_name):
        return self._infos(topic_name, "subscription", TopicEndpointTypeEnum.SUBSCRIPTION)

    def _infos(self, topic_name, kind, endpoint_type):
        wanted = self._expanded(topic_name)
        owners = {gid: owner for owner, instances in self._graph.nodes().items() for gids in instances for gid in gids}
        infos = []
        for endpoint in self._graph.endpoints(kind):
            if _names.ros_topic(endpoint.topic) == wanted:
                namespace, name = owners.get(endpoint.gid, ("_NODE_NAMESPACE_UNKNOWN_", "_NODE_NAME_UNKNOWN_"))
                infos.append(
                    TopicEndpointInfo(
                        node_name=name,
                        node_namespace=namespace,
                        topic_type=_names.ros_type(endpoint.type) or endpoint.type,
                        endpoint_type=endpoint_type,
                        endpoint_gid=list(endpoint.gid),
                        qos_profile=_from_dds(endpoint.qos),
                    )
                )
        return infos

    def _gids_of(self, name, namespace):
        instances = self._graph.nodes().get((namespace, name))
        if not instances:
            raise RuntimeError(f"cannot get entities of node {name!r} in {namespace!r}: it does not exist")
        return set().union(*instances)

    def _topics(self, kinds, wanted):
        found = {}
        for kind in kinds:
            for endpoint in self._graph.endpoints(kind):
                name, type_name = _names.ros_topic(endpoint.topic), _names.ros_type(endpoint.type)
                if name and type_name and wanted(endpoint):
                    found.setdefault(name, set()).add(type_name)
        return [(name, sorted(types)) for name, types in sorted(found.items())]

    def _services(self, wanted, kinds=("publication", "subscription")):
        found = {}
        for kind in kinds:
            for endpoint in self._graph.endpoints(kind):
                service = _names.ros_service(endpoint.topic, endpoint.type)
                if service and wanted(endpoint):
                    found.setdefault(service[0], set()).add(service[1])
        return [(name, sorted(types)) for name, types in sorted(found.items())]

    def _expanded(self, name):
        return _names.expanded(name, self._name, self._namespace)

    def _unique_endpoint_id(self):
        """Marks the reader and the writer of one client or service as belonging together."""
        number = next(self._endpoint_numbers)
        own = self._participant.guid.bytes[:12] + id(self).to_bytes(8, "big")[-2:] + number.to_bytes(2, "big")
        return ".".join(f"{byte:x}" for byte in own)

    def _add(self, entity):
        self._entities.append(entity)
        self._announce()
        if self.executor:
            self.executor.wake()
        return entity

    def _remove(self, entity):
        if entity not in self._entities:
            return False
        self._entities.remove(entity)
        self._announce()
        if self.executor:
            self.executor._forget_conditions()
        for part in [*entity._readers, *entity._writers]:
            part.close()
        return True

    def _announce(self):
        self._graph.set_node(
            self._name,
            self._namespace,
            [reader.dds for entity in self._entities for reader in entity._readers],
            [writer.dds for entity in self._entities for writer in entity._writers],
        )
