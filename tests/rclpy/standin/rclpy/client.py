"""Service clients, with the request header of rmw_cyclonedds."""

import itertools
import threading

from ._entity import Reader, Writer
from ._names import REPLY_PREFIX, REQUEST_PREFIX
from ._wire import ServiceCodec
from .task import Future


class Client:
    def __init__(self, node, srv_type, srv_name, qos_profile):
        self._node = node
        self.context = node.context
        self.srv_type = srv_type
        self.srv_name = srv_name
        self.qos_profile = qos_profile
        mark = f"clientid={node._unique_endpoint_id()};"
        participant = node._participant
        self._writer = Writer(
            participant, f"{REQUEST_PREFIX}{srv_name}Request", ServiceCodec(srv_type.Request), qos_profile, mark
        )
        self._reader = Reader(
            participant, f"{REPLY_PREFIX}{srv_name}Reply", ServiceCodec(srv_type.Response), qos_profile, mark
        )
        self._readers, self._writers = [self._reader], [self._writer]
        self._id = self._writer.dds.instance_handle & 0xFFFF_FFFF_FFFF_FFFF  # cyclonedds reads it as signed
        self._numbers = itertools.count(1)
        self._lock = threading.Lock()
        self._pending_requests = {}

    def service_is_ready(self):
        """As rmw_cyclonedds: a matched request reader and a matched reply writer of the same service."""
        readers = [mark for mark in self._writer.user_data_of_readers() if mark is not None]
        writers = [mark for mark in self._reader.user_data_of_writers() if mark is not None]
        services = {mark["serviceid"] for mark in readers if "serviceid" in mark}
        if not services:
            return bool(readers and writers)
        return any(mark.get("serviceid") in services for mark in writers)

    def call_async(self, request):
        if not isinstance(request, self.srv_type.Request):
            raise TypeError()
        future = Future()
        with self._lock:
            number = next(self._numbers)
            self._pending_requests[number] = future
        future.add_done_callback(self.remove_pending_request)
        self._writer.dds.write(self._writer.codec.encode((self._id, number), request))
        return future

    def remove_pending_request(self, future):
        with self._lock:
            for number, pending in list(self._pending_requests.items()):
                if pending is future:
                    del self._pending_requests[number]

    def _execute_one(self):
        sample = self._reader.take()
        if sample is None:
            return False
        (requester, number), response = self._reader.codec.decode(sample)
        # every client of a service hears the replies to all of them
        if requester == self._id:
            with self._lock:
                future = self._pending_requests.get(number)
            if future is not None:
                future.set_result(response)
        return True

    def destroy(self):
        self._node.destroy_client(self)
