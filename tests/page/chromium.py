"""A chromium without a window that is driven over a pipe: pages opened, expressions evaluated, until something is true."""

import atexit
import fcntl
import json
import os
import subprocess
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic, sleep
from urllib.parse import urlsplit
from urllib.request import url2pathname

from tests.living.javascript import CHROMIUM


class Browser:
    """The process, which takes a second to begin: one for all tests of a worker."""

    def __init__(self):
        read, self.there = os.pipe()
        self.back, write = os.pipe()
        self.folder, self.number, self.data = TemporaryDirectory(), 0, b""

        def pipes():
            ends = [fcntl.fcntl(end, fcntl.F_DUPFD, 10) for end in (read, write)]  # which may be 3 and 4 themselves
            for place, end in enumerate(ends, 3):
                os.dup2(end, place)

        command = [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe",
                   f"--user-data-dir={self.folder.name}", "about:blank"]
        self.process = subprocess.Popen(command, stderr=subprocess.DEVNULL, preexec_fn=pipes, close_fds=False)
        os.close(read)
        os.close(write)
        atexit.register(self.end)

    def __call__(self, method, session=None, heard=lambda event: None, **parameters):
        """What a command of the protocol gives; events meanwhile are heard."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters} | ({"sessionId": session} if session else {})
        os.write(self.there, json.dumps(message).encode() + b"\0")
        while True:
            found = self._next()
            if found.get("id") == self.number:
                return found["result"]
            heard(found)

    def _next(self):
        while b"\0" not in self.data:
            piece = os.read(self.back, 1 << 16)
            assert piece, "the browser has ended"
            self.data += piece
        whole, _, self.data = self.data.partition(b"\0")
        return json.loads(whole)

    def end(self):
        self.process.kill()
        self.process.wait()
        self.folder.cleanup()


class Page:
    """An empty page that has nothing in common with those before it."""

    def __init__(self, browser, context):
        self.browser, self.inside, self.said = browser, None, []
        target = browser("Target.createTarget", url="about:blank", browserContextId=context)["targetId"]
        self.session = browser("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self(f"{domain}.enable")
        self("Target.setAutoAttach", autoAttach=True, waitForDebuggerOnStart=False, flatten=True)

    def __call__(self, method, inside=False, **parameters):
        """What a command of the protocol gives, of the frame inside the page if asked; what the page said meanwhile is kept."""
        return self.browser(method, self.inside if inside else self.session, self._heard, **parameters)

    def _heard(self, event):
        if event.get("sessionId") != self.session:
            return  # of a page before
        if event["method"] == "Target.attachedToTarget" and event["params"]["targetInfo"]["type"] == "iframe":
            self.inside = event["params"]["sessionId"]
        if event["method"] in ("Runtime.exceptionThrown", "Log.entryAdded"):
            self.said.append(event["params"])

    def open(self, address):
        """Go to an address; the names of a page from a file are made global, so that tests can ask for them."""
        if address.startswith("file:"):
            path = Path(url2pathname(urlsplit(address).path))
            path.write_text(path.read_text(encoding="utf-8").replace('<script type="module">', "<script>"), encoding="utf-8")
        self("Page.navigate", url=address)

    def now(self, expression, inside=False):
        """The value of an expression in the page, or in the frame inside it."""
        told = self("Runtime.evaluate", inside, expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in told, told
        return told["result"].get("value")

    def until(self, expression, inside=False, seconds=120):
        """Wait until an expression is true, and give it."""
        end = monotonic() + seconds
        while not (found := self.now(expression, inside)):
            assert monotonic() < end, (expression, self.said)
            sleep(0.05)
        return found


running = cache(Browser)


@contextmanager
def browser():
    """A page; after one that fell with its browser there is another browser."""
    if running().process.poll() is not None:
        running.cache_clear()
    context = running()("Target.createBrowserContext")["browserContextId"]
    try:
        yield Page(running(), context)
    finally:
        running()("Target.disposeBrowserContext", browserContextId=context)
