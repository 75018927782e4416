"""A chromium without a window that is driven over a pipe: pages opened, expressions evaluated, until something is true."""

import fcntl
import json
import os
import subprocess
from contextlib import contextmanager
from pathlib import Path
from time import monotonic, sleep
from urllib.parse import urlsplit
from urllib.request import url2pathname

from tests.living.javascript import CHROMIUM


class Page:
    """The one page that it has open."""

    def __init__(self, there, back):
        self.there, self.back, self.number, self.session, self.inside, self.said, self.data = there, back, 0, None, None, [], b""
        (target,) = [t for t in self("Target.getTargets")["targetInfos"] if t["type"] == "page"]
        self.session = self("Target.attachToTarget", targetId=target["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self(f"{domain}.enable")
        self("Target.setAutoAttach", autoAttach=True, waitForDebuggerOnStart=False, flatten=True)

    def __call__(self, method, inside=False, **parameters):
        """What a command of the protocol gives, of the frame inside the page if asked; what the page said meanwhile is kept."""
        self.number += 1
        session = self.inside if inside else self.session
        message = {"id": self.number, "method": method, "params": parameters} | ({"sessionId": session} if session else {})
        os.write(self.there, json.dumps(message).encode() + b"\0")
        while True:
            found = self._next()
            if found.get("id") == self.number:
                return found["result"]
            if found.get("method") == "Target.attachedToTarget" and found["params"]["targetInfo"]["type"] == "iframe":
                self.inside = found["params"]["sessionId"]
            if found.get("method") in ("Runtime.exceptionThrown", "Log.entryAdded"):
                self.said.append(found["params"])

    def _next(self):
        while b"\0" not in self.data:
            piece = os.read(self.back, 1 << 16)
            assert piece, "the browser has ended"
            self.data += piece
        whole, _, self.data = self.data.partition(b"\0")
        return json.loads(whole)

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


@contextmanager
def browser(folder):
    """A browser with an empty page; ``folder`` keeps what it keeps."""
    read, there = os.pipe()
    back, write = os.pipe()

    def pipes():
        ends = [fcntl.fcntl(end, fcntl.F_DUPFD, 10) for end in (read, write)]  # which may be 3 and 4 themselves
        for place, end in enumerate(ends, 3):
            os.dup2(end, place)

    command = [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe", f"--user-data-dir={folder}",
               "about:blank"]
    with subprocess.Popen(command, stderr=subprocess.DEVNULL, preexec_fn=pipes, close_fds=False) as process:
        os.close(read)
        os.close(write)
        try:
            yield Page(there, back)
        finally:
            process.kill()
            os.close(there)
            os.close(back)
