"""A program that runs beside the test."""

import os
import signal
import subprocess
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path

from .waiting import LONGEST_WAIT


def _hear_interrupts():
    """A shell starts what runs in its background deaf to SIGINT, and that is inherited all the way down to here."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@contextmanager
def stopped(process):
    """A program that does not go on meanwhile, as in a debugger."""
    os.kill(process.pid, signal.SIGSTOP)
    try:
        yield
    finally:
        os.kill(process.pid, signal.SIGCONT)


class Child:
    """A program that a program has started."""

    def __init__(self, pid):
        self.pid = pid

    def times_slept(self):
        """How often it has waited for something."""
        status = Path(f"/proc/{self.pid}/status").read_text()
        (line,) = [line for line in status.splitlines() if line.startswith("voluntary_ctxt_switches")]
        return int(line.split()[1])


class Process:
    """Started at once; its output goes to a file and is shown when a test fails on it."""

    def __init__(self, command, environment, directory=None):
        self.command = [str(word) for word in command]
        self._may_end = False
        self._output = tempfile.TemporaryFile()
        self._process = subprocess.Popen(
            self.command,
            env=environment,
            cwd=directory,
            stdin=subprocess.DEVNULL,
            stdout=self._output,
            stderr=subprocess.STDOUT,
            preexec_fn=_hear_interrupts,
        )

    @property
    def pid(self):
        return self._process.pid

    def children(self):
        """Programs that it has started."""
        return [Child(int(pid)) for pid in Path(f"/proc/{self.pid}/task/{self.pid}/children").read_text().split()]

    def running(self):
        return self._process.poll() is None

    def output(self):
        # without moving the place in the file, which the program shares with us and writes at
        file = self._output.fileno()
        return os.pread(file, os.fstat(file).st_size, 0).decode(errors="replace")

    def check_not_failed(self):
        """AssertionError when it ended with an error that nobody waits for."""
        status = self._process.poll()
        failed = status not in (None, 0) and not self._may_end
        assert not failed, f"{' '.join(self.command)} ended with status {status}:\n{self.output()}"

    def interrupt(self):
        """What Ctrl-C does; returns the exit status, or None when it had to be killed."""
        return self._end(signal.SIGINT)

    def terminate(self):
        """What a service manager does; returns as `interrupt`."""
        return self._end(signal.SIGTERM)

    def vanish(self):
        """What `kill -9` does: nobody is told."""
        self._may_end = True
        self._process.kill()
        self._process.wait()

    def wait(self):
        """The exit status, whatever it is; AssertionError when it does not end."""
        self._may_end = True
        end = time.monotonic() + LONGEST_WAIT
        while self.running():
            assert time.monotonic() < end, f"{' '.join(self.command)} runs after {LONGEST_WAIT} s:\n{self.output()}"
            time.sleep(0.01)
        return self._process.returncode

    def _end(self, how):
        self._may_end = True
        if self.running():
            self._process.send_signal(how)
            # A clean end is announced to peers; a killed node haunts them until its lease ends. So killing is the last resort.
            try:
                self._process.wait(LONGEST_WAIT)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
                return None
        return self._process.returncode
