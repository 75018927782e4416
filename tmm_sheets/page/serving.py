"""The server: its address with the token, the browser, Ctrl-C."""

from __future__ import annotations

import asyncio
import os
import socket
import threading
from collections import defaultdict
from collections.abc import Callable
from importlib.util import find_spec
from secrets import token_urlsafe
from typing import TYPE_CHECKING, Any

from tmm_sheets import quoting
from tmm_sheets.errors import BadInput, CannotBuild, Problem, reason_of
from tmm_sheets.words import both, tell

if TYPE_CHECKING:
    from tmm_sheets.page.doors import Shown

PORT = 8731
"""Where it listens unless told: another free one where somebody is there already."""
PATIENCE = 20.0
"""How long a connection may be without a whole request, s."""
MOST_IDLE = 40
"""Connections from one address that may ask for nothing, of the 200 that there are for all."""
PACKAGES = {"starlette": "starlette", "uvicorn": "uvicorn", "python_multipart": "python-multipart"}


def check_packages() -> None:
    """Tell at once that a package is missing.

    Raises
    ------
    CannotBuild
        which one, and how to install it.
    """
    missing = [package for module, package in PACKAGES.items() if find_spec(module) is None]
    if missing:
        raise CannotBuild(tell("the page needs {names}").format(names=both(missing)), quoting.install("page"))


def serve(shown: Shown, host: str, port: int | None, tell_address: Callable[[str], None]) -> None:
    """Serve until Ctrl-C; ``tell_address`` is told the address when somebody can come.

    Raises
    ------
    BadInput
        when nobody can listen there.
    """
    import uvicorn

    from tmm_sheets.page import doors, workers

    listening = listening_socket(host, port)
    token = token_urlsafe(24)
    named = {"0.0.0.0": "127.0.0.1", "::": "[::1]"}.get(host, f"[{host}]" if ":" in host else host)
    app = doors.app(token, host, shown)
    config = uvicorn.Config(app, log_level="error" if os.environ.get("TMM_SHEETS_TRACEBACK") else "critical", access_log=False,
                            server_header=False, lifespan="off", ws="none", timeout_graceful_shutdown=1, limit_concurrency=200,
                            http=patient(),
                            # What is wrong with a form is told in the answer, not on the terminal.
                            log_config={"version": 1, "loggers": {"python_multipart": {"level": "CRITICAL"}}})
    threading.Thread(target=workers.warm, daemon=True).start()
    tell_address(f"http://{named}:{listening.getsockname()[1]}/{token}/")
    uvicorn.Server(config).run(sockets=[listening])


def patient() -> type[asyncio.Protocol]:
    """The server's protocol, which closes connections that ask for nothing: each takes one of the places that there are for all."""
    from uvicorn.protocols.http.auto import AutoHTTPProtocol

    idle = defaultdict[str, dict[Any, None]](dict)

    class Patient(AutoHTTPProtocol):  # type: ignore[misc, valid-type]
        """Looks now and then whether a request is there, or has been since the last look.

        Where too many connections from one address ask for nothing, the oldest of them goes at once.
        """

        def connection_made(self, transport: Any) -> None:
            """Begin to look."""
            super().connection_made(transport)
            self.address = str((transport.get_extra_info("peername") or ("",))[0])
            self.alike = idle[self.address]
            self.alike[self] = None
            # Many come before one that is told to go has gone.
            waiting = [other for other in self.alike if not other.transport.is_closing()
                       and (other.cycle is None or other.cycle.response_complete)]
            if len(waiting) > MOST_IDLE:
                waiting[0].transport.close()
            self.loop.call_later(PATIENCE, self._look, None)

        def connection_lost(self, exc: Exception | None) -> None:
            """It counts no more."""
            self.alike.pop(self, None)
            if not self.alike:
                idle.pop(self.address, None)
            super().connection_lost(exc)

        def _look(self, seen: Any) -> None:
            if self.transport.is_closing():
                return
            if self.cycle is seen and (seen is None or seen.response_complete):
                self.transport.close()
            else:
                self.loop.call_later(PATIENCE, self._look, self.cycle)

    return Patient


def listening_socket(host: str, port: int | None) -> socket.socket:
    """A socket that listens: at the port asked for, else at ours or at a free one.

    Raises
    ------
    BadInput
        when the port asked for cannot be had.
    """
    if not host:
        raise BadInput(Problem(tell("expected an address, such as 127.0.0.1"), "--host"))
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    for number in (PORT, 0) if port is None else (port,):
        try:
            return socket.create_server((host, number), family=family)
        except OSError as e:
            why = OSError(e.errno, os.strerror(e.errno)) if e.errno and e.errno > 0 else e
    raise BadInput(Problem(tell("nobody can listen there: {why}").format(why=reason_of(why)), f"{host}:{port or PORT}",
                           hint=tell("choose another --port or --host")))
