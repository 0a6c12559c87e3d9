"""A program that runs beside the test."""

import os
import signal
import subprocess
import tempfile
import time

# A clean end is announced to peers; a killed node haunts them until its lease ends. So killing is the last resort.
LONGEST_CLEAN_END = 10.0


def _hear_interrupts():
    """A shell starts what runs in its background deaf to SIGINT, and that is inherited all the way down to here."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


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

    def wait(self, timeout):
        """The exit status, whatever it is; AssertionError when it takes longer."""
        self._may_end = True
        end = time.monotonic() + timeout
        while self.running():
            assert time.monotonic() < end, f"{' '.join(self.command)} runs after {timeout} s:\n{self.output()}"
            time.sleep(0.01)
        return self._process.returncode

    def _end(self, how):
        self._may_end = True
        if self.running():
            self._process.send_signal(how)
            try:
                self._process.wait(LONGEST_CLEAN_END)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
                return None
        return self._process.returncode
