"""Proxy on loopback that fails every n-th request, in turn with status 503 or by closing the connection before or after the request."""

from __future__ import annotations

import http.client
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer


class FailingProxy:
    """`with FailingProxy(port, every=10) as address:` forwards requests from `address` to `port`, except one in `every`."""

    def __init__(self, port: int, every: int = 10) -> None:
        self.port, self.every = port, every
        self.requests = self.failures = 0
        self._lock = threading.Lock()

    def _fails(self) -> str | None:
        with self._lock:
            self.requests += 1
            if self.requests % self.every:
                return None
            self.failures += 1
            return ("503", "before", "after")[self.failures % 3]

    def __enter__(self) -> str:
        proxy = self

        class Handler(BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def log_message(self, *_: object) -> None:
                pass

            def handle_any(self) -> None:
                content = self._content()
                how = proxy._fails()
                if how == "503":
                    self.send_response(503)
                    self.send_header("Content-Length", "0")
                    self.end_headers()
                    return
                if how == "before":
                    self.close_connection = True
                    self.connection.close()
                    return
                there = http.client.HTTPConnection("127.0.0.1", proxy.port, timeout=30)
                headers = {name: value for name, value in self.headers.items() if name.lower() not in ("transfer-encoding", "expect")}
                there.request(self.command, self.path, content, headers)
                answer = there.getresponse()
                body = answer.read()
                there.close()
                if how == "after":
                    # The store executed the request, but the client receives no response.
                    self.close_connection = True
                    self.connection.close()
                    return
                self.send_response_only(answer.status)
                for name, value in answer.getheaders():
                    if name.lower() not in ("content-length", "transfer-encoding", "connection"):
                        self.send_header(name, value)
                length = answer.getheader("Content-Length") if self.command == "HEAD" else str(len(body))
                self.send_header("Content-Length", length or "0")
                self.end_headers()
                if self.command != "HEAD":
                    self.wfile.write(body)

            def _content(self) -> bytes:
                if self.headers.get("Expect", "").lower() == "100-continue":
                    self.send_response_only(100)
                    self.end_headers()
                if self.headers.get("Transfer-Encoding", "").lower() == "chunked":
                    parts = []
                    while size := int(self.rfile.readline().split(b";")[0], 16):
                        parts.append(self.rfile.read(size))
                        self.rfile.readline()
                    self.rfile.readline()
                    return b"".join(parts)
                return self.rfile.read(int(self.headers.get("Content-Length") or 0))

            do_GET = do_PUT = do_POST = do_HEAD = do_DELETE = handle_any

        class Server(ThreadingHTTPServer):
            daemon_threads = True

            def handle_error(self, *_: object) -> None:
                pass

        self._server = Server(("127.0.0.1", 0), Handler)
        threading.Thread(target=self._server.serve_forever, daemon=True).start()
        return f"http://127.0.0.1:{self._server.server_address[1]}"

    def __exit__(self, *_: object) -> None:
        self._server.shutdown()
        self._server.server_close()
