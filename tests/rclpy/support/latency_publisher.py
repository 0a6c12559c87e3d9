"""A node of rclpy that publishes states at 1 kHz, as the simulator does: python latency_publisher.py TOPIC RATE."""

import sys
import time

import rclpy
from excavator_msgs.msg import ArmState, CylinderState
from rclpy.qos import QoSProfile

topic, rate = sys.argv[1], float(sys.argv[2])
rclpy.init()
node = rclpy.create_node("latency_publisher")
publisher = node.create_publisher(ArmState, topic, QoSProfile(depth=50))
state = ArmState(cylinders=[CylinderState(name="arm")])
turn = time.monotonic()
try:
    while rclpy.ok():
        turn += 1.0 / rate
        time.sleep(max(turn - time.monotonic(), 0.0))
        state.header.stamp.sec, state.header.stamp.nanosec = divmod(time.time_ns(), 1_000_000_000)
        publisher.publish(state)
except KeyboardInterrupt:
    pass
