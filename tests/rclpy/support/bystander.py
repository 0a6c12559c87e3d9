"""A participant that has nothing to do with anybody, as the daemon of the command line, until it is told to go."""

import rclpy

rclpy.init()
node = rclpy.create_node("bystander", start_parameter_services=False)
try:
    while True:
        print("here", flush=True)
        rclpy.spin_once(node, timeout_sec=0.2)
except KeyboardInterrupt:
    pass
