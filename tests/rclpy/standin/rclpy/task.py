"""Futures that executors complete."""

import threading


class Future:
    def __init__(self):
        self._lock = threading.Lock()
        self._done = False
        self._result = None
        self._callbacks = []

    def done(self):
        return self._done

    def result(self):
        return self._result

    def set_result(self, result):
        with self._lock:
            if self._done:
                return
            self._result = result
            self._done = True
            callbacks, self._callbacks = self._callbacks, []
        for callback in callbacks:
            callback(self)

    def add_done_callback(self, callback):
        with self._lock:
            if not self._done:
                self._callbacks.append(callback)
                return
        callback(self)
