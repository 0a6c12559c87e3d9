"""Messages as DDS samples: CDR bytes made by rosbags, with the type description that Cyclone DDS announces.

Requests and replies start with the header of rmw_cyclonedds: the requester's 64-bit id and its 64-bit sequence number.
"""

import functools
import struct

from cyclonedds.idl import annotations as annotate
from cyclonedds.idl import make_idl_struct, types

from ._definitions import store
from ._names import dds_type

_PRIMITIVES = {
    "bool": bool,
    "byte": types.byte,
    "char": types.uint8,
    "string": str,
    **{name: getattr(types, name) for name in ("float32", "float64")},
    **{f"{sign}int{bits}": getattr(types, f"{sign}int{bits}") for sign in ("", "u") for bits in (8, 16, 32, 64)},
}
_HEADER = struct.Struct("<Qq")
_ENCAPSULATION = b"\x00\x01\x00\x00"  # CDR, little endian

_structs = {}


def _idl_type(kind, detail):
    kind = int(kind)
    if kind == 1:
        base, limit = detail
        return types.bounded_str[limit] if base == "string" and limit else _PRIMITIVES[base]
    if kind == 2:
        return _idl_struct(detail)
    element, size = detail
    if kind == 3:
        return types.array[_idl_type(*element), size]
    return types.sequence[_idl_type(*element), size] if size else types.sequence[_idl_type(*element)]


def _idl_struct(ros_name, prefix=None):
    key = (ros_name, prefix is not None)
    if key not in _structs:
        fields = dict(prefix or {})
        fields |= {name: _idl_type(*description) for name, description in store.fielddefs[ros_name][1]}
        made = make_idl_struct(ros_name.rsplit("/", 1)[1], dds_type(ros_name), fields)
        annotate.final(made)
        _structs[key] = made
    return _structs[key]


class Received:
    """CDR bytes of a sample; the reader adds its `sample_info`."""

    def __init__(self, data):
        self.data = data


@functools.cache  # one class for each type: a participant refuses a second class for the same topic
def _sample_type(ros_name, with_header):
    header = {"requester_id": types.uint64, "request_number": types.int64} if with_header else None
    described = _idl_struct(ros_name, header)

    class Sample(described, typename=dds_type(ros_name)):
        """Announces the described type, but carries bytes that are encoded already."""

        def __init__(self, data):
            self.data = data

        def serialize(self, **_):
            return self.data

        @classmethod
        def deserialize(cls, data, **_):
            return Received(data)

    # the description, not this class, is what the participant announces
    Sample.__idl__ = described.__idl__
    return Sample


def _encode(message):
    return bytes(store.serialize_cdr(message._to_bag(), message._ros_name, little_endian=True))


def _decode(data, cls):
    return cls._from_bag(store.deserialize_cdr(data, cls._ros_name))


class MessageCodec:
    """Topics: the sample is the message."""

    def __init__(self, message_class):
        self._class = message_class
        self.sample_type = _sample_type(message_class._ros_name, False)

    def encode(self, message):
        return self.sample_type(_encode(message))

    def decode(self, received):
        return _decode(received.data, self._class)


class ServiceCodec:
    """Requests and replies: header, then message. `(requester, sequence_number)` names one call."""

    def __init__(self, message_class):
        self._class = message_class
        self.sample_type = _sample_type(message_class._ros_name, True)

    def encode(self, call, message):
        return self.sample_type(_ENCAPSULATION + _HEADER.pack(*call) + _encode(message)[4:])

    def decode(self, received):
        """The call and the message; the 16 bytes of the header keep the alignment of what follows."""
        data = received.data
        if bytes(data[:2]) != _ENCAPSULATION[:2] or len(data) < 4 + _HEADER.size:
            raise ValueError(f"{len(data)} bytes with encapsulation {bytes(data[:2])!r} are no request or reply")
        call = _HEADER.unpack_from(data, 4)
        return call, _decode(_ENCAPSULATION + bytes(data[4 + _HEADER.size :]), self._class)


__all__ = ["MessageCodec", "ServiceCodec"]
