"""A context, a node and an executor for one test module, and the programs that it starts."""

import os
import sys
import time

import rclpy
from rcl_interfaces.srv import GetParameters
from rclpy.action import ActionClient
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.utilities import get_rmw_implementation_identifier

from .loopback import free_domain
from .process import Process
from .waiting import ASK_AGAIN, LONGEST_WAIT


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
        self.release()
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.shutdown(context=self._context)

    def mark(self):
        """A mark for `release`."""
        return len(self._undo)

    def release(self, mark=0):
        """Ends the programs and destroys the subscriptions, publishers and clients that were made since the mark."""
        while len(self._undo) > mark:
            self._undo.pop()()

    # programs

    def start(self, *command, environment=None, directory=None):
        """A program in this session's domain. `directory`: where it runs, instead of here."""
        process = Process(command, self._environment() | (environment or {}), directory)
        self._processes.append(process)
        self._undo.append(lambda: self._end(process))
        return process

    def _end(self, process):
        process.interrupt()
        self._processes.remove(process)

    def start_python(self, script, *arguments):
        return self.start(sys.executable, script, *arguments)

    def _environment(self):
        return dict(os.environ, ROS_DOMAIN_ID=str(self.domain), RMW_IMPLEMENTATION=get_rmw_implementation_identifier())

    # waiting

    def spin_until(self, condition, what):
        """Runs callbacks until the condition holds; `what` says in words what was waited for."""
        end = time.monotonic() + LONGEST_WAIT
        while not condition():
            left = end - time.monotonic()
            for process in self._processes:
                process.check_not_failed()
            assert left > 0, f"waited {LONGEST_WAIT} s in vain for {what}{self._last_words()}"
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
        """A list that fills with the messages of the topic while spinning. Which is the first one is left to chance."""
        received = []
        self.listen_with(msg_type, topic, received.append, qos)
        return received

    def hear(self, msg_type, topic, qos=10):
        """As `listen`, with the first message in it: from there on, a reliable reader misses none that its queue can hold."""
        received = self.listen(msg_type, topic, qos)
        self.spin_until(lambda: received, f"the first message on {topic}")
        return received

    def known_to(self, *nodes):
        """Waits until these nodes of ours know every subscription that was made so far, and nothing that they publish is missed.
        Endpoints are announced in the order in which they are made, and to answer a new client a node has to know it."""
        request = GetParameters.Request(names=["use_sim_time"])
        for node in nodes:
            self.call(GetParameters, f"{node}/get_parameters", request)

    def listen_with(self, msg_type, topic, callback, qos=10):
        """Calls back with each message of the topic while spinning."""
        subscription = self.node.create_subscription(msg_type, topic, callback, qos)
        self._undo.append(lambda: self.node.destroy_subscription(subscription))

    def publisher(self, msg_type, topic, qos=10):
        """A publisher that somebody already listens to: what it publishes reliably arrives, as far as its queue reaches."""
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

    def result(self, future, what):
        """What a future becomes, spinning until then."""
        self.spin_until(future.done, what)
        return future.result()

    def call(self, srv_type, name, request):
        """The reply to a new client."""
        mark = self.mark()
        try:
            return self.ask(self.client(srv_type, name), request)
        finally:
            self.release(mark)

    def ask(self, client, request):
        """The reply to a question that may be asked twice: a server that has not seen the client's reader for 0.1 s answers in
        vain, so the client asks again until it has been answered once."""
        futures = []

        def answered():
            if not futures or time.monotonic() > futures[-1][0] + ASK_AGAIN:
                futures.append((time.monotonic(), client.call_async(request)))
            return [future for _, future in futures if future.done()]

        self.spin_until(answered, f"the reply of {client.srv_name}")
        return answered()[0].result()

    def action_client(self, action_type, name):
        client = ActionClient(self.node, action_type, name)
        self._undo.append(client.destroy)
        self.spin_until(client.server_is_ready, f"the action {name}")
        return client
