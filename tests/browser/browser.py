"""A headless Chromium that is asked through its DevTools protocol, over pipes: no port, no package."""

import json
import os
import select
import subprocess
import time

# s; what is waited for comes within a second as a rule, and a busy machine gets the rest.
LONGEST_WAIT = 90.0


class Browser:
    """`with Browser(path, folder) as browser`: a page that can be opened, asked and photographed."""

    def __init__(self, path, folder):
        to_browser, self._write = os.pipe()
        self._read, from_browser = os.pipe()
        # the browser reads its file descriptor 3 and writes 4
        shell = f'exec "$0" "$@" 3<&{to_browser} 4>&{from_browser}'
        flags = [
            "--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--no-first-run",
            "--disable-component-update", "--disable-sync", "--enable-precise-memory-info", "--window-size=1400,1000",
            "--hide-scrollbars",  # as on a phone: they take no room
            f"--user-data-dir={folder}", "--remote-debugging-pipe", "about:blank",
        ]  # fmt: skip
        self._process = subprocess.Popen(
            ["bash", "-c", shell, path, *flags],
            pass_fds=(to_browser, from_browser),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(to_browser)
        os.close(from_browser)
        self._number = 0
        self._rest = b""
        self._session = None
        self.errors = []

    def __enter__(self):
        targets = self._ask("Target.getTargets")["targetInfos"]
        page = next(target for target in targets if target["type"] == "page")
        attached = self._ask("Target.attachToTarget", targetId=page["targetId"], flatten=True)
        self._session = attached["sessionId"]
        for domain in ("Page", "Runtime", "HeapProfiler"):
            self._ask(f"{domain}.enable")
        return self

    def __exit__(self, *_):
        self._process.terminate()
        self._process.wait(10)
        os.close(self._write)
        os.close(self._read)

    def open(self, address):
        self._ask("Page.navigate", url=address)

    def value(self, expression):
        """What a JavaScript expression is."""
        reply = self._ask("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in reply, reply["exceptionDetails"]
        return reply["result"].get("value")

    def wait_for(self, expression, what):
        end = time.monotonic() + LONGEST_WAIT
        while not self.value(expression):
            assert time.monotonic() < end, f"waited {LONGEST_WAIT} s in vain for {what}"
            time.sleep(0.1)

    def heap(self):
        """Bytes of JavaScript that are in use after collecting what is not."""
        self._ask("HeapProfiler.collectGarbage")
        return self._ask("Runtime.getHeapUsage")["usedSize"]

    def picture(self, whole=False, clip=None):
        """PNG of the page, base64; of all of it, of its upper `clip` = (width, height), or of what the window shows."""
        area = {"clip": dict(x=0, y=0, width=clip[0], height=clip[1], scale=1)} if clip else {}
        return self._ask("Page.captureScreenshot", captureBeyondViewport=whole or clip is not None, **area)["data"]

    def screen(self, width, height, scheme="light", media=""):
        """A window of this size, on a system with a light or dark scheme; media="print" shows what a printer gets."""
        self._ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        self._ask("Emulation.setEmulatedMedia", media=media, features=features)

    def before_every_page(self, script):
        """Runs a script in every page that is opened from now on, before its own."""
        self._ask("Page.addScriptToEvaluateOnNewDocument", source=script)

    def press(self, key):
        """A key, as the keyboard sends it."""
        for kind in ("keyDown", "keyUp"):
            text = key if kind == "keyDown" and len(key) == 1 else ""
            self._ask("Input.dispatchKeyEvent", type=kind, key=key, text=text)

    def print_to_pdf(self):
        """The page as it is printed, base64; paper as the page asks for it."""
        return self._ask("Page.printToPDF", preferCSSPageSize=True, printBackground=False)["data"]

    def _ask(self, method, **parameters):
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._write, json.dumps(message).encode() + b"\0")
        while True:
            reply = self._receive()
            if reply.get("method") == "Runtime.exceptionThrown":
                self.errors.append(reply["params"]["exceptionDetails"])
            if reply.get("id") == self._number:
                assert "error" not in reply, f"{method}: {reply['error']}"
                return reply["result"]

    def _receive(self):
        while b"\0" not in self._rest:
            assert select.select([self._read], [], [], LONGEST_WAIT)[0], f"the browser says nothing for {LONGEST_WAIT} s"
            more = os.read(self._read, 1 << 16)
            assert more, "the browser has ended"
            self._rest += more
        message, self._rest = self._rest.split(b"\0", 1)
        return json.loads(message)
