"""Service servers."""

import time

from ._entity import Reader, Writer
from ._names import REPLY_PREFIX, REQUEST_PREFIX
from ._wire import ServiceCodec

# As rmw_cyclonedds: so long a reply waits for the discovery of the client's reader.
_LONGEST_WAIT_FOR_READER = 0.1


class Service:
    def __init__(self, node, srv_type, srv_name, callback, qos_profile):
        self._node = node
        self.srv_type = srv_type
        self.srv_name = srv_name
        self.callback = callback
        self.qos_profile = qos_profile
        mark = f"serviceid={node._unique_endpoint_id()};"
        participant = node._participant
        self._reader = Reader(
            participant, f"{REQUEST_PREFIX}{srv_name}Request", ServiceCodec(srv_type.Request), qos_profile, mark
        )
        self._writer = Writer(
            participant, f"{REPLY_PREFIX}{srv_name}Reply", ServiceCodec(srv_type.Response), qos_profile, mark
        )
        self._readers, self._writers = [self._reader], [self._writer]

    def _execute_one(self):
        sample = self._reader.take()
        if sample is None:
            return False
        call, request = self._reader.codec.decode(sample)
        response = self.callback(request, self.srv_type.Response())
        self._wait_for_reader(sample.sample_info.publication_handle)
        self._writer.dds.write(self._writer.codec.encode(call, response))
        return True

    def _wait_for_reader(self, request_writer):
        mark = self._reader.user_data_of_writer(request_writer)
        if not mark or "clientid" not in mark:
            return
        end = time.monotonic() + _LONGEST_WAIT_FOR_READER
        while time.monotonic() < end:
            if any(seen and seen.get("clientid") == mark["clientid"] for seen in self._writer.user_data_of_readers()):
                return
            time.sleep(0.001)

    def destroy(self):
        self._node.destroy_service(self)
