"""A player that begins when it is told to."""

import os
import signal

from .diagnostics import Diagnostics


class Player:
    """`excavator play`, paused before its first message; subscriptions that were made before it miss none."""

    def __init__(self, ros, excavator, bag, *words, node="bag_player"):
        self.process = ros.start(excavator, "play", bag, "--start-paused", *words, "--ros-args", "-r", f"__node:={node}")
        told = Diagnostics(ros, node)
        ros.spin_until(lambda: "player" in told.newest, "the player to be paused")
        ros.known_to(f"/{node}")

    def go_on(self):
        os.kill(self.process.pid, signal.SIGUSR1)
