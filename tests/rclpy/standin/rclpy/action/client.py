"""Action client: three services and two topics under NAME/_action/."""

import uuid
import weakref

from .._messages import message_class, service_class
from ..qos import QoSProfile, qos_profile_action_status_default, qos_profile_services_default
from ..task import Future


class ClientGoalHandle:
    """A goal that a server has answered."""

    def __init__(self, action_client, goal_id, goal_response):
        self._action_client = action_client
        self._goal_id = goal_id
        self._goal_response = goal_response
        self._status = 0  # GoalStatus.STATUS_UNKNOWN until the server says more

    @property
    def goal_id(self):
        return self._goal_id

    @property
    def stamp(self):
        return self._goal_response.stamp

    @property
    def accepted(self):
        return self._goal_response.accepted

    @property
    def status(self):
        return self._status

    def cancel_goal_async(self):
        return self._action_client._cancel_goal_async(self)

    def get_result_async(self):
        return self._action_client._get_result_async(self)


class ActionClient:
    def __init__(
        self,
        node,
        action_type,
        action_name,
        *,
        goal_service_qos_profile=qos_profile_services_default,
        result_service_qos_profile=qos_profile_services_default,
        cancel_service_qos_profile=qos_profile_services_default,
        feedback_sub_qos_profile=QoSProfile(depth=10),
        status_sub_qos_profile=qos_profile_action_status_default,
    ):
        self._node = node
        self._action_type = action_type
        self._feedback_callbacks = {}
        self._goal_handles = weakref.WeakValueDictionary()
        impl = action_type.Impl
        prefix = f"{action_name}/_action"
        self._goal_client = node.create_client(
            impl.SendGoalService, f"{prefix}/send_goal", qos_profile=goal_service_qos_profile
        )
        self._result_client = node.create_client(
            impl.GetResultService, f"{prefix}/get_result", qos_profile=result_service_qos_profile
        )
        self._cancel_client = node.create_client(
            service_class("action_msgs/srv/CancelGoal"), f"{prefix}/cancel_goal", qos_profile=cancel_service_qos_profile
        )
        self._feedback = node.create_subscription(
            impl.FeedbackMessage, f"{prefix}/feedback", self._on_feedback, feedback_sub_qos_profile
        )
        self._status = node.create_subscription(
            message_class("action_msgs/msg/GoalStatusArray"),
            f"{prefix}/status",
            self._on_status,
            status_sub_qos_profile,
        )

    def server_is_ready(self):
        """As rcl_action: all three services and the publishers of both topics are there."""
        clients = (self._goal_client, self._result_client, self._cancel_client)
        topics = (self._feedback, self._status)
        return all(client.service_is_ready() for client in clients) and all(
            topic.get_publisher_count() > 0 for topic in topics
        )

    def send_goal_async(self, goal, feedback_callback=None, goal_uuid=None):
        if not isinstance(goal, self._action_type.Goal):
            raise TypeError()
        goal_id = goal_uuid or message_class("unique_identifier_msgs/msg/UUID")(uuid=list(uuid.uuid4().bytes))
        key = bytes(goal_id.uuid)
        if feedback_callback is not None:
            self._feedback_callbacks[key] = feedback_callback
        handed_over = Future()

        def answered(future):
            handle = ClientGoalHandle(self, goal_id, future.result())
            if handle.accepted:
                self._goal_handles[key] = handle
            else:
                self._feedback_callbacks.pop(key, None)
            handed_over.set_result(handle)

        request = self._action_type.Impl.SendGoalService.Request(goal_id=goal_id, goal=goal)
        self._goal_client.call_async(request).add_done_callback(answered)
        return handed_over

    def _cancel_goal_async(self, goal_handle):
        request = self._cancel_client.srv_type.Request()
        request.goal_info.goal_id = goal_handle.goal_id
        return self._cancel_client.call_async(request)

    def _get_result_async(self, goal_handle):
        request = self._action_type.Impl.GetResultService.Request(goal_id=goal_handle.goal_id)
        future = self._result_client.call_async(request)
        key = bytes(goal_handle.goal_id.uuid)
        future.add_done_callback(lambda _: self._feedback_callbacks.pop(key, None))
        return future

    def _on_feedback(self, message):
        callback = self._feedback_callbacks.get(bytes(message.goal_id.uuid))
        if callback is not None:
            callback(message)

    def _on_status(self, message):
        for status in message.status_list:
            handle = self._goal_handles.get(bytes(status.goal_info.goal_id.uuid))
            if handle is not None:
                handle._status = status.status

    def destroy(self):
        for client in (self._goal_client, self._result_client, self._cancel_client):
            self._node.destroy_client(client)
        for subscription in (self._feedback, self._status):
            self._node.destroy_subscription(subscription)
