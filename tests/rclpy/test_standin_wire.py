"""Bytes of the stand-in against independent makers of the same bytes. With a real rclpy there is nothing to check."""

import math
import struct

import pytest

pytestmark = pytest.mark.middleware


@pytest.fixture(autouse=True)
def _standin_only(uses_standin):
    if not uses_standin:
        pytest.skip("rclpy of ROS 2 is in use, not the stand-in")


def _state():
    from excavator_msgs.msg import ArmState, CylinderState
    from std_msgs.msg import Header

    cylinders = [
        CylinderState(name="boom", joint_angle=0.25, velocity=-0.0, cap_pressure=1.25e7, rod_force=math.nan),
        CylinderState(name="bücket", displacement=math.inf),
    ]
    header = Header(frame_id="base")
    header.stamp.sec, header.stamp.nanosec = 1_700_000_000, 999_999_999
    return ArmState(header=header, cylinders=cylinders, pump_pressure=1.0, pump_flow=math.nan)


def test_messages_are_the_bytes_of_cyclone_dds():
    """rosbags makes the bytes; cyclonedds' own serializer, fed with the same fields, is the judge."""
    from rclpy._wire import MessageCodec, _idl_struct

    message = _state()
    judge = _idl_struct("excavator_msgs/msg/ArmState").__idl__
    expected = judge.serialize(message, use_version_2=False)
    made = MessageCodec(type(message)).encode(message).serialize()
    assert made == bytes(expected)[: len(made)]
    assert len(expected) - len(made) < 4  # padding at most


def test_what_is_written_is_read_back():
    from rclpy._wire import MessageCodec, Received

    message = _state()
    codec = MessageCodec(type(message))
    back = codec.decode(Received(codec.encode(message).serialize()))
    assert math.isnan(back.pump_flow) and math.isnan(back.cylinders[0].rod_force)
    assert math.copysign(1.0, back.cylinders[0].velocity) == -1.0
    # NaN is not equal to itself: put it aside and compare the rest
    for state in (message, back):
        state.pump_flow = 0.0
        state.cylinders[0].rod_force = 0.0
    assert back == message


def test_a_request_starts_with_requester_and_number():
    """rmw_cyclonedds, serdata.hpp: `struct { uint64_t guid; int64_t seq; }` before the request, one CDR stream."""
    from rcl_interfaces.srv import GetParameters
    from rclpy._wire import Received, ServiceCodec

    codec = ServiceCodec(GetParameters.Request)
    data = codec.encode((0x0123_4567_89AB_CDEF, 7), GetParameters.Request(names=["rate"])).serialize()
    expected = b"\x00\x01\x00\x00" + bytes.fromhex("efcdab8967452301") + struct.pack("<q", 7)
    expected += struct.pack("<II", 1, 5) + b"rate\x00"
    assert data == expected
    call, request = codec.decode(Received(data))
    assert call == (0x0123_4567_89AB_CDEF, 7) and request.names == ["rate"]


def test_short_requests_are_refused():
    from rcl_interfaces.srv import GetParameters
    from rclpy._wire import Received, ServiceCodec

    with pytest.raises(ValueError, match="7 bytes"):
        ServiceCodec(GetParameters.Request).decode(Received(b"\x00\x01\x00\x00abc"))


@pytest.mark.parametrize(
    ("ros_name", "dds_name"),
    [
        ("std_msgs/msg/String", "std_msgs::msg::dds_::String_"),
        ("excavator_msgs/action/Identify_SendGoal_Request", "excavator_msgs::action::dds_::Identify_SendGoal_Request_"),
    ],
)
def test_type_names_on_the_wire(ros_name, dds_name):
    from rclpy import _names

    assert _names.dds_type(ros_name) == dds_name
    assert _names.ros_type(dds_name) == ros_name


def test_service_topics_on_the_wire():
    from rclpy import _names

    request = "rcl_interfaces::srv::dds_::GetParameters_Request_"
    assert _names.ros_service("rq/node/get_parametersRequest", request) == (
        "/node/get_parameters",
        "rcl_interfaces/srv/GetParameters",
    )
    assert _names.ros_service("rt/node/get_parametersRequest", request) is None
    assert _names.ros_topic("rq/x") is None and _names.ros_topic("rt/arm/state") == "/arm/state"


def test_names_are_expanded_as_in_ros():
    from rclpy import _names

    assert _names.expanded("~/get", "node", "/") == "/node/get"
    assert _names.expanded("~/get", "node", "/left") == "/left/node/get"
    assert _names.expanded("state", "node", "/left") == "/left/state"
    assert _names.expanded("/state", "node", "/left") == "/state"
    for wrong in ("", "a b", "/a//b", "1a", "a/"):
        with pytest.raises(ValueError, match="invalid"):
            _names.expanded(wrong, "node", "/")


def test_fields_take_only_what_rosidl_takes():
    from diagnostic_msgs.msg import DiagnosticStatus
    from excavator_msgs.msg import OrificeCommand

    with pytest.raises(AssertionError):
        OrificeCommand(areas=[1])  # an integer is no float
    with pytest.raises(AssertionError):
        OrificeCommand(names="arm")
    with pytest.raises(AssertionError):
        OrificeCommand(area=[1.0])
    with pytest.raises(AssertionError):
        DiagnosticStatus(level=2)  # byte is bytes
    with pytest.raises(AttributeError):
        OrificeCommand().area = 1.0
    assert DiagnosticStatus(level=DiagnosticStatus.ERROR).level == b"\x02"


def test_the_stand_in_reads_the_interface_files_of_the_repository():
    from excavator_msgs.action import Identify
    from excavator_msgs.msg import ArmState

    fields = ArmState.get_fields_and_field_types()
    assert fields["cylinders"] == "sequence<excavator_msgs/CylinderState>" and fields["pump_flow"] == "double"
    assert list(Identify.Goal.get_fields_and_field_types()) == ["model", "bags", "effects"]
    with pytest.raises(ImportError):
        from excavator_msgs.msg import NoSuchMessage  # noqa: F401
