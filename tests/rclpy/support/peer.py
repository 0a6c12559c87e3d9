"""An ordinary rclpy program: topics, a service and an action for the tests of the plumbing."""

import sys

import rclpy
from action_msgs.msg import GoalStatus, GoalStatusArray
from action_msgs.srv import CancelGoal
from excavator_msgs.action import Identify
from rcl_interfaces.msg import ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters
from rclpy.executors import ExternalShutdownException
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy, qos_profile_action_status_default
from std_msgs.msg import String


class Peer:
    def __init__(self):
        self.node = rclpy.create_node("peer", start_parameter_services=False)
        self.count = 0
        self.echo = self.node.create_publisher(String, "/peer/echo", 10)
        # a reader that is late loses none
        self.ticks = self.node.create_publisher(String, "/peer/ticks", 1000)
        self.loose_ticks = self.node.create_publisher(
            String, "/peer/loose_ticks", QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
        )
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.latched = self.node.create_publisher(String, "/peer/latched", latched)
        self.latched.publish(String(data="first"))
        self.latched.publish(String(data="kept"))
        self.node.create_subscription(String, "/peer/call", lambda message: self.echo.publish(message), 10)
        self.node.create_timer(0.02, self.tick)
        self.node.create_service(GetParameters, "~/get_parameters", self.get_parameters)
        self._offer_action()

    def tick(self):
        self.count += 1
        self.ticks.publish(String(data=str(self.count)))
        self.loose_ticks.publish(String(data=str(self.count)))

    def get_parameters(self, request, response):
        response.values = [
            ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=name) for name in request.names
        ]
        return response

    def _offer_action(self):
        """The services and topics of an action, without rclpy's action server, whose work is not the point here."""
        self.goals = {}
        impl = Identify.Impl
        self.feedback = self.node.create_publisher(impl.FeedbackMessage, "/peer/run/_action/feedback", 10)
        self.status = self.node.create_publisher(
            GoalStatusArray, "/peer/run/_action/status", qos_profile_action_status_default
        )
        self.node.create_service(impl.SendGoalService, "/peer/run/_action/send_goal", self.send_goal)
        self.node.create_service(impl.GetResultService, "/peer/run/_action/get_result", self.get_result)
        self.node.create_service(CancelGoal, "/peer/run/_action/cancel_goal", self.cancel_goal)

    def send_goal(self, request, response):
        response.accepted = bool(request.goal.bags)
        if response.accepted:
            self.goals[bytes(request.goal_id.uuid)] = (request.goal, GoalStatus.STATUS_EXECUTING)
            for step in range(3):
                message = Identify.Impl.FeedbackMessage(goal_id=request.goal_id)
                message.feedback.stage = f"step {step}"
                message.feedback.progress = step / 2
                self.feedback.publish(message)
        return response

    def cancel_goal(self, request, response):
        key = bytes(request.goal_info.goal_id.uuid)
        if key not in self.goals:
            response.return_code = CancelGoal.Response.ERROR_UNKNOWN_GOAL_ID
            return response
        self.goals[key] = (self.goals[key][0], GoalStatus.STATUS_CANCELED)
        response.goals_canceling = [request.goal_info]
        return response

    def get_result(self, request, response):
        goal, status = self.goals[bytes(request.goal_id.uuid)]
        done = status == GoalStatus.STATUS_EXECUTING
        response.status = GoalStatus.STATUS_SUCCEEDED if done else status
        response.result.success = done
        response.result.message = goal.model
        response.result.nmse_after = [float(len(bag)) for bag in goal.bags]
        message = GoalStatusArray(status_list=[GoalStatus(status=response.status)])
        message.status_list[0].goal_info.goal_id = request.goal_id
        self.status.publish(message)
        return response


def main():
    rclpy.init()
    peer = Peer()
    try:
        rclpy.spin(peer.node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        peer.node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    sys.exit(main())
