"""Futures that executors complete."""

import threading


class Future:
    def __init__(self):
        self._lock = threading.Lock()
        self._done = False
        self._cancelled = False
        self._result = None
        self._exception = None
        self._callbacks = []

    def cancel(self):
        self._finish(cancelled=True)

    def cancelled(self):
        return self._cancelled

    def done(self):
        return self._done or self._cancelled

    def result(self):
        if self._exception is not None:
            raise self._exception
        return self._result

    def exception(self):
        return self._exception

    def set_result(self, result):
        self._finish(result=result)

    def set_exception(self, exception):
        self._finish(exception=exception)

    def add_done_callback(self, callback):
        with self._lock:
            if not self.done():
                self._callbacks.append(callback)
                return
        callback(self)

    def _finish(self, result=None, exception=None, cancelled=False):
        with self._lock:
            if self.done():
                return
            self._result, self._exception = result, exception
            self._cancelled = cancelled
            self._done = not cancelled
            callbacks, self._callbacks = self._callbacks, []
        for callback in callbacks:
            callback(self)
