"""A reliable reader of /arm/state with a small queue that says how much it has read, to be stopped in between."""

import rclpy
from excavator_msgs.msg import ArmState
from rclpy.executors import ExternalShutdownException

# States between two words.
STEP = 100


def main():
    rclpy.init()
    node = rclpy.create_node("counting_reader", start_parameter_services=False)
    count = 0

    def take(_):
        nonlocal count
        count += 1
        if count % STEP == 0:
            print(count, flush=True)

    node.create_subscription(ArmState, "/arm/state", take, 10)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
