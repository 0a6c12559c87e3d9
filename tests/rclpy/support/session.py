"""A context, a node and an executor for one test module, and the programs that it starts."""

import os
import sys
import time

import rclpy
from rclpy.action import ActionClient
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.utilities import get_rmw_implementation_identifier

from .loopback import free_domain
from .process import Process

# s; what is waited for comes within 0.1 s as a rule, discovery without multicast within 7 s; a busy machine gets the rest.
LONGEST_WAIT = 90.0


class Session:
    """`with Session() as session`: everything that was started is ended at the end."""

    def __init__(self):
        self.domain = free_domain()
        self._context = Context()
        self._processes = []
        self._undo = []

    def __enter__(self):
        rclpy.init(context=self._context, domain_id=self.domain)
        self.node = rclpy.create_node("checker", context=self._context, start_parameter_services=False)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        return self

    def __exit__(self, *_):
        for process in reversed(self._processes):
            process.interrupt()
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.shutdown(context=self._context)

    def mark(self):
        """A mark for `release`."""
        return len(self._undo)

    def release(self, mark=0):
        """Destroys the subscriptions, publishers and clients that were made since the mark."""
        while len(self._undo) > mark:
            self._undo.pop()()

    # programs

    def start(self, *command, environment=None, directory=None):
        """A program in this session's domain. `directory`: where it runs, instead of here."""
        process = Process(command, self._environment() | (environment or {}), directory)
        self._processes.append(process)
        return process

    def start_python(self, script, *arguments):
        return self.start(sys.executable, script, *arguments)

    def _environment(self):
        return dict(os.environ, ROS_DOMAIN_ID=str(self.domain), RMW_IMPLEMENTATION=get_rmw_implementation_identifier())

    # time

    def spin_for(self, seconds):
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self._executor.spin_once(timeout_sec=left)

    def spin_until(self, condition, what, timeout=LONGEST_WAIT):
        """Runs callbacks until the condition holds; `what` says in words what was waited for."""
        end = time.monotonic() + timeout
        while not condition():
            left = end - time.monotonic()
            for process in self._processes:
                process.check_not_failed()
            assert left > 0, f"waited {timeout} s in vain for {what}{self._last_words()}"
            self._executor.spin_once(timeout_sec=min(left, 0.05))

    def _last_words(self):
        """What the programs said last, for the message of a failure."""
        words = ""
        for process in self._processes:
            lines = process.output().splitlines()[-5:]
            state = "runs" if process.running() else "has ended"
            words += f"\n{' '.join(process.command)} ({state}):" + "".join(f"\n    {line}" for line in lines)
        return words

    # topics

    def listen(self, msg_type, topic, qos=10):
        """A list that fills with the messages of the topic while spinning."""
        received = []
        self.listen_with(msg_type, topic, received.append, qos)
        return received

    def listen_with(self, msg_type, topic, callback, qos=10):
        """Calls back with each message of the topic while spinning."""
        subscription = self.node.create_subscription(msg_type, topic, callback, qos)
        self._undo.append(lambda: self.node.destroy_subscription(subscription))

    def publisher(self, msg_type, topic, qos=10):
        """A publisher that somebody already listens to."""
        publisher = self.node.create_publisher(msg_type, topic, qos)
        self._undo.append(lambda: self.node.destroy_publisher(publisher))
        self.spin_until(lambda: publisher.get_subscription_count() > 0, f"a subscription to {topic}")
        return publisher

    # services and actions

    def client(self, srv_type, name):
        client = self.node.create_client(srv_type, name)
        self._undo.append(lambda: self.node.destroy_client(client))
        self.spin_until(client.service_is_ready, f"the service {name}")
        return client

    def result(self, future, what, timeout=LONGEST_WAIT):
        """What a future becomes, spinning until then."""
        self.spin_until(future.done, what, timeout)
        return future.result()

    def call(self, srv_type, name, request, timeout=LONGEST_WAIT, attempts=3):
        """The reply to a new client. A server that has not seen the client's reader yet may answer in vain, so the
        client asks again, within the whole time-out; whoever wants to see that fault asks once."""
        mark = self.mark()
        try:
            client = self.client(srv_type, name)
            for attempt in range(attempts):
                future = client.call_async(request)
                last = attempt == attempts - 1
                try:
                    return self.result(future, f"the reply of {name}", timeout / attempts)
                except AssertionError:
                    if last:
                        raise
        finally:
            self.release(mark)

    def action_client(self, action_type, name):
        client = ActionClient(self.node, action_type, name)
        self._undo.append(client.destroy)
        self.spin_until(client.server_is_ready, f"the action {name}")
        return client
