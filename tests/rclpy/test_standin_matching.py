"""Readers that come and go while a writer of the stand-in is asked for them. With a real rclpy there is nothing to check."""

import threading

import pytest

pytestmark = pytest.mark.middleware

# Some that come and go in a second.
CROWDS = 200


@pytest.fixture(autouse=True)
def _standin_only(uses_standin):
    if not uses_standin:
        pytest.skip("rclpy of ROS 2 is in use, not the stand-in")


def test_readers_that_come_and_go_do_not_disturb_those_who_ask_for_them(ros):
    from rclpy._entity import Reader, Writer
    from rclpy._wire import MessageCodec
    from rclpy.qos import QoSProfile
    from std_msgs.msg import String

    participant, codec, profile = ros.node._participant, MessageCodec(String), QoSProfile(depth=1)
    writer = Writer(participant, "rt/crowd", codec, profile)
    done = threading.Event()
    crowds = 0

    def come_and_go():
        nonlocal crowds
        while not done.is_set():
            crowds += 1
            for reader in [Reader(participant, "rt/crowd", codec, profile) for _ in range(20)]:
                reader.close()

    crowd = threading.Thread(target=come_and_go)
    crowd.start()
    try:
        # The binding alone fails some 700 times meanwhile.
        seen = {len(writer.matched_readers()) for _ in iter(lambda: crowds < CROWDS and crowd.is_alive(), False)}
    finally:
        done.set()
        crowd.join()
    assert max(seen) > 1
    assert writer.matched_readers() == []
