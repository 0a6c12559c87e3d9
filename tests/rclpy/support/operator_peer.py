"""An operator that commands one opening and writes down, about every 50 ms, when the state arrives.

    python operator_peer.py FILE
"""

import signal
import sys
import time

import rclpy
from excavator_msgs.msg import ArmState, OrificeCommand
from rclpy.executors import ExternalShutdownException

AREA = 2e-5
PERIOD = 0.025
STEP = 0.05


def main():
    # a shell starts what runs in its background deaf to SIGINT
    signal.signal(signal.SIGINT, signal.default_int_handler)
    rclpy.init()
    node = rclpy.create_node("operator", start_parameter_services=False)
    last = 0.0
    with open(sys.argv[1], "w", encoding="ascii", buffering=1) as log:

        def take(_):
            nonlocal last
            now = time.time()
            if now - last > STEP:
                last = now
                log.write(f"{now:.6f}\n")

        node.create_subscription(ArmState, "/arm/state", take, 10)
        publisher = node.create_publisher(OrificeCommand, "/arm/orifice_command", 10)

        def operate():
            # neutral first: the valve may have been closed while the network was down
            for area in (0.0, AREA):
                message = OrificeCommand(names=["arm"], areas=[area])
                message.header.stamp.sec, message.header.stamp.nanosec = divmod(time.time_ns(), 1_000_000_000)
                publisher.publish(message)

        node.create_timer(PERIOD, operate)
        try:
            rclpy.spin(node)
        except (KeyboardInterrupt, ExternalShutdownException):
            pass
        finally:
            node.destroy_node()
            rclpy.try_shutdown()


if __name__ == "__main__":
    main()
