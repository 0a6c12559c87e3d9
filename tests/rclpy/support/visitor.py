"""A participant that joins, says when it has heard the state, and stays until it is told to go."""

import rclpy
from excavator_msgs.msg import ArmState
from rclpy.executors import ExternalShutdownException


def main():
    rclpy.init()
    node = rclpy.create_node("visitor", start_parameter_services=False)
    heard = 0

    def take(_):
        nonlocal heard
        heard += 1
        if heard == 10:
            print("heard", flush=True)

    node.create_subscription(ArmState, "/arm/state", take, 10)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
