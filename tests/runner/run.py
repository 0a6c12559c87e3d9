"""One run of the checks: steps that succeed or fail, and what they took."""

import os
import subprocess
import threading
import time
from pathlib import Path

from durations import Durations, in_words, minutes

ROOT = Path(__file__).resolve().parents[2]


class Failed(Exception):
    """A step failed; its text is what the person needs to see."""


class Run:
    """Runs steps, in several threads where they wait more than they compute, and keeps what they took."""

    def __init__(self):
        self.durations = Durations()
        self.failed = []
        self.notes = {}
        self._start = time.monotonic()
        self._lock = threading.Lock()

    def step(self, name, work, *arguments):
        """Runs a step; a failure is printed and kept, and the next step runs all the same. Returns what the step returns."""
        begin = time.monotonic()
        said, result = "", None
        try:
            result = work(self, *arguments)
            said = result if isinstance(result, str) else ""
        except Failed as failure:
            said = f"FAILED\n{failure}"
            with self._lock:
                self.failed.append(name)
        took = time.monotonic() - begin
        with self._lock:
            self.durations.add_step(name, took)
            print(f"{minutes(took):>12}  {name}{': ' if said else ''}{said}", flush=True)
        return result

    def needs(self, name, work, *arguments):
        """Runs a step without which the rest makes no sense."""
        before = len(self.failed)
        result = self.step(name, work, *arguments)
        if len(self.failed) > before:
            raise Failed(name)
        return result

    def beside(self, work):
        """Runs `work(self)` in a thread; call the returned function to wait for it."""
        thread = threading.Thread(target=work, args=(self,))
        thread.start()
        return thread.join

    def command(self, words, directory=ROOT, environment=None, allowed=(0,)):
        """Runs a program and returns what it printed on standard output; its exit status must be one of the allowed ones."""
        words = list(map(str, words))
        try:
            done = subprocess.run(
                words, cwd=directory, env=os.environ | (environment or {}), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                stderr=subprocess.PIPE, text=True, errors="replace",
            )  # fmt: skip
        except OSError as error:
            raise Failed(f"{words[0]} cannot be started: {error}") from None
        if done.returncode not in allowed:
            raise Failed(f"$ {' '.join(words)}\n{done.stdout}{done.stderr}exit status {done.returncode}")
        return done.stdout

    def count(self, kind, timed, counts):
        """Keeps the outcomes of tests; returns them in words."""
        with self._lock:
            self.durations.add_tests(kind, timed, counts)
        return in_words(counts)

    def counted(self, kind):
        """Outcomes of all tests of a kind so far, in words."""
        return in_words(self.durations.counts[kind])

    def skipped(self, reasons):
        """Keeps why tests were skipped, each reason with its number."""
        with self._lock:
            for reason in reasons:
                self.notes[reason] = self.notes.get(reason, 0) + 1

    def elapsed(self):
        return time.monotonic() - self._start
