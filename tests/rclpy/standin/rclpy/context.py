"""A context: one DDS participant, as in rmw_cyclonedds."""

import gc
import os
import threading

from cyclonedds.domain import DomainParticipant
from cyclonedds.qos import Policy, Qos

from ._graph import Graph


class Context:
    def __init__(self):
        self._lock = threading.RLock()
        self._participant = None
        self._domain_id = None
        self._graph = None
        self._nodes = []
        self._on_shutdown = []

    def init(self, args=None, *, domain_id=None):
        with self._lock:
            if self._participant is not None:
                raise RuntimeError("Context.init() must only be called once")
            self._domain_id = int(os.environ.get("ROS_DOMAIN_ID") or 0) if domain_id is None else domain_id
            self._participant = DomainParticipant(self._domain_id, qos=Qos(Policy.Userdata(b"enclave=/;")))
            self._graph = Graph(self._participant)

    def ok(self):
        return self._participant is not None

    def get_domain_id(self):
        if self._participant is None:
            raise RuntimeError("the context is not initialized")
        return self._domain_id

    def on_shutdown(self, callback):
        self._on_shutdown.append(callback)

    def shutdown(self):
        with self._lock:
            if self._participant is None:
                raise RuntimeError("Context must be initialized before it can be shutdown")
            for callback in self._on_shutdown:
                callback()
            self._on_shutdown = []
            for node in list(self._nodes):
                node.destroy_node()
            self._graph = None
            self._participant = None
            # DDS entities go with the last reference to them: not later than now, or peers still see this context
            gc.collect()

    def try_shutdown(self):
        if self.ok():
            self.shutdown()
