"""Message classes as rosidl generates them for Python: keyword constructors, defaults, checked assignment."""

import array
import math
import sys

import numpy

from . import _definitions
from ._definitions import store

# ROS type -> (least value, greatest value)
_INTEGERS = {
    "int8": (-(2**7), 2**7 - 1),
    "uint8": (0, 2**8 - 1),
    "char": (0, 2**8 - 1),
    "int16": (-(2**15), 2**15 - 1),
    "uint16": (0, 2**16 - 1),
    "int32": (-(2**31), 2**31 - 1),
    "uint32": (0, 2**32 - 1),
    "int64": (-(2**63), 2**63 - 1),
    "uint64": (0, 2**64 - 1),
}
_FLOATS = {"float32": 3.402823466e38, "float64": sys.float_info.max}
# ROS type -> type code of the array.array that holds a sequence
_ARRAY_CODES = {
    "int8": "b",
    "uint8": "B",
    "char": "B",
    "int16": "h",
    "uint16": "H",
    "int32": "i",
    "uint32": "I",
    "int64": "q",
    "uint64": "Q",
    "float32": "f",
    "float64": "d",
}
_NUMPY = {"char": "uint8"}
# as get_fields_and_field_types() names them
_TYPE_NAMES = {"bool": "boolean", "byte": "octet", "char": "uint8", "float32": "float", "float64": "double"}

_classes = {}


class _Element:
    """What one value of a field may be, and how it crosses the boundary to rosbags' objects."""

    def __init__(self, kind, detail):
        self.message = message_class(detail) if int(kind) == 2 else None
        self.base = None if self.message else detail[0]
        self.limit = 0 if self.message else detail[1]

    def ros_name(self):
        if self.message:
            package, _, name = self.message._ros_name.split("/")
            return f"{package}/{name}"
        return _TYPE_NAMES.get(self.base, self.base)

    def default(self):
        if self.message:
            return self.message()
        return {"bool": False, "string": "", "byte": b"\x00"}.get(self.base, 0.0 if self.base in _FLOATS else 0)

    def problem(self, value):
        """Why the value does not fit, or None."""
        if self.message:
            return None if isinstance(value, self.message) else f"a sub message of type '{self.message.__name__}'"
        if self.base == "string":
            fits = isinstance(value, str) and (not self.limit or len(value) <= self.limit)
            return None if fits else "of type 'str'"
        if self.base == "bool":
            return None if isinstance(value, bool | numpy.bool_) else "of type 'bool'"
        if self.base == "byte":
            return None if isinstance(value, bytes) and len(value) == 1 else "of type 'bytes' and length 1"
        if self.base in _FLOATS:
            if not isinstance(value, float):
                return "of type 'float'"
            fits = math.isinf(value) or not abs(value) > _FLOATS[self.base]
            return None if fits else f"a {self.base}"
        least, greatest = _INTEGERS[self.base]
        if not isinstance(value, int):
            return "of type 'int'"
        return None if least <= value <= greatest else f"an integer in [{least}, {greatest}]"

    def to_bag(self, value):
        if self.message:
            return value._to_bag()
        return value[0] if self.base == "byte" else value

    def from_bag(self, value):
        if self.message:
            return self.message._from_bag(value)
        if self.base == "byte":
            return bytes([value])
        return value.item() if isinstance(value, numpy.generic) else value


class _Field:
    """One field: its element, and whether it is one value, an array of fixed length or a sequence."""

    def __init__(self, name, kind, detail):
        self.name = name
        self.length = None  # of a fixed array
        self.bound = 0  # of a sequence
        self.many = int(kind) in (3, 4)
        if self.many:
            (element_kind, element), size = detail
            self.element = _Element(element_kind, element)
            if int(kind) == 3:
                self.length = size
            else:
                self.bound = size
        else:
            self.element = _Element(kind, detail)
        self.code = _ARRAY_CODES.get(self.element.base)
        self.numpy_type = self.code and _NUMPY.get(self.element.base, self.element.base)

    def ros_type(self):
        name = self.element.ros_name()
        if not self.many:
            return name
        if self.length is not None:
            return f"{name}[{self.length}]"
        return f"sequence<{name}, {self.bound}>" if self.bound else f"sequence<{name}>"

    def default(self):
        if not self.many:
            return self.element.default()
        if self.length is not None:
            if self.numpy_type:
                return numpy.zeros(self.length, dtype=self.numpy_type)
            return [self.element.default() for _ in range(self.length)]
        return array.array(self.code) if self.code else []

    def checked(self, value):
        if not self.many:
            problem = self.element.problem(value)
            assert problem is None, f"The '{self.name}' field must be {problem}"
            return value
        what = f"The '{self.name}' field must be"
        if self.length is not None and self.numpy_type and isinstance(value, numpy.ndarray):
            assert value.dtype == self.numpy_type and value.size == self.length, f"{what} {self.ros_type()}"
            return value
        if self.length is None and self.code and isinstance(value, array.array):
            assert value.typecode == self.code, f"{what} {self.ros_type()}"
            assert not self.bound or len(value) <= self.bound, f"{what} {self.ros_type()}"
            return value
        assert isinstance(value, list | tuple | set | numpy.ndarray | array.array) and not isinstance(value, str), (
            f"{what} a sequence"
        )
        values = list(value)
        for item in values:
            problem = self.element.problem(item.item() if isinstance(item, numpy.generic) else item)
            assert problem is None, f"{what} a sequence whose values are {problem}"
        assert self.length is None or len(values) == self.length, f"{what} {self.ros_type()}"
        assert not self.bound or len(values) <= self.bound, f"{what} {self.ros_type()}"
        if self.length is not None and self.numpy_type:
            return numpy.array(values, dtype=self.numpy_type)
        return array.array(self.code, values) if self.code else values

    def to_bag(self, value):
        if not self.many:
            return self.element.to_bag(value)
        if self.numpy_type:
            return numpy.asarray(value, dtype=self.numpy_type)
        if self.element.base in ("bool", "byte"):
            kind = "bool" if self.element.base == "bool" else "uint8"
            return numpy.array([self.element.to_bag(item) for item in value], dtype=kind)
        return [self.element.to_bag(item) for item in value]

    def from_bag(self, value):
        if not self.many:
            return self.element.from_bag(value)
        if self.length is not None and self.numpy_type:
            return numpy.array(value, dtype=self.numpy_type)
        if self.code:
            return array.array(self.code, numpy.asarray(value).tobytes())
        return [self.element.from_bag(item) for item in value]


class _Message:
    """Base of all message classes; what is not underscored exists on rosidl's classes too."""

    __slots__ = ()
    _fields = ()
    _ros_name = ""
    _fields_and_field_types = {}

    def __init__(self, **kwargs):
        unknown = ", ".join(sorted(kwargs.keys() - self._fields_and_field_types.keys()))
        assert not unknown, f"Invalid arguments passed to constructor: {unknown}"
        for field in self._fields:
            if field.name in kwargs:
                setattr(self, field.name, kwargs[field.name])
            else:
                object.__setattr__(self, "_" + field.name, field.default())

    @classmethod
    def get_fields_and_field_types(cls):
        return dict(cls._fields_and_field_types)

    def __eq__(self, other):
        if not isinstance(other, self.__class__):
            return False
        return all(_same(getattr(self, field.name), getattr(other, field.name)) for field in self._fields)

    __hash__ = None

    def __repr__(self):
        arguments = ", ".join(f"{field.name}={getattr(self, field.name)!r}" for field in self._fields)
        package, kind, _ = self._ros_name.split("/")
        return f"{package}.{kind}.{type(self).__name__}({arguments})"

    def _to_bag(self):
        values = [field.to_bag(getattr(self, "_" + field.name)) for field in self._fields]
        return store.types[self._ros_name](*values)

    @classmethod
    def _from_bag(cls, bag):
        message = cls.__new__(cls)
        for field in cls._fields:
            object.__setattr__(message, "_" + field.name, field.from_bag(getattr(bag, field.name)))
        return message


def _same(a, b):
    if isinstance(a, numpy.ndarray) or isinstance(b, numpy.ndarray):
        return bool(numpy.all(a == b))
    return a == b


def _property(field):
    slot = "_" + field.name

    def get(self):
        return getattr(self, slot)

    def set_(self, value):
        object.__setattr__(self, slot, field.checked(value))

    return property(get, set_)


def message_class(name):
    """The class of `pkg/msg/Type` (or of a part of a service or action that is registered)."""
    if name in _classes:
        return _classes[name]
    if name not in store.fielddefs:
        _definitions.require_message(name)
    constants, fields = store.fielddefs[name]
    made = tuple(_Field(field, kind, detail) for field, (kind, detail) in fields)
    members = {
        "__slots__": ["_" + field.name for field in made],
        "_fields": made,
        "_ros_name": name,
        "_fields_and_field_types": {field.name: field.ros_type() for field in made},
    }
    for field in made:
        members[field.name] = _property(field)
    for constant, kind, value in constants:
        members[constant] = bytes([value]) if kind == "byte" else value
    package, kind, base = name.split("/")
    cls = type(base, (_Message,), members)
    cls.__module__ = f"{package}.{kind}"
    _classes[name] = cls
    return cls


def service_class(name):
    """The class of `pkg/srv/Type` with Request and Response."""
    if name not in _classes:
        _definitions.require_service(name)
        _classes[name] = _service(name)
    return _classes[name]


def _service(name):
    parts = {"Request": message_class(name + "_Request"), "Response": message_class(name + "_Response")}
    return type(name.rsplit("/", 1)[1], (), {**parts, "_ros_name": name})


def action_class(name):
    """The class of `pkg/action/Type` with Goal, Result, Feedback and Impl."""
    if name in _classes:
        return _classes[name]
    _definitions.require_action(name)
    base = name.rsplit("/", 1)[1]
    impl = type(
        "Impl",
        (),
        {
            "SendGoalService": _service(name + "_SendGoal"),
            "GetResultService": _service(name + "_GetResult"),
            "FeedbackMessage": message_class(name + "_FeedbackMessage"),
            "CancelGoalService": service_class("action_msgs/srv/CancelGoal"),
            "GoalStatusMessage": message_class("action_msgs/msg/GoalStatusArray"),
        },
    )
    parts = {part: message_class(f"{name}_{part}") for part in ("Goal", "Result", "Feedback")}
    _classes[name] = type(base, (), {**parts, "Impl": impl, "_ros_name": name})
    return _classes[name]
