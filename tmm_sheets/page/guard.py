"""Who may come in: the token in the path, the names of this machine, requests of our own pages, and no more than so many bytes."""

from __future__ import annotations

import asyncio
import ipaddress
import socket
from asyncio import CancelledError
from collections.abc import Mapping
from contextlib import suppress
from hmac import compare_digest

from starlette.exceptions import HTTPException
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from tmm_sheets.words import tell

LARGEST = 2_000_000
"""Bytes of a request that brings no files."""
SILENT, LONGEST = 30.0, 900.0
"""How long a request may bring nothing, and how long it may come, s."""
HEADERS = {
    "content-security-policy": "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
                               "connect-src 'self'; font-src 'self'; frame-src 'self'; "
                               "form-action 'self'; base-uri 'none'; frame-ancestors 'none'",
    "x-content-type-options": "nosniff", "referrer-policy": "same-origin",
    "cross-origin-opener-policy": "same-origin", "cross-origin-resource-policy": "same-origin", "cache-control": "no-store",
}  # fmt: skip
"""Headers of every answer that has no others."""


class Guard:
    """In front of the doors; ``files`` tells of those that take files how many bytes they take."""

    def __init__(self, app: ASGIApp, token: str, host: str, files: Mapping[str, int]) -> None:
        self.app, self.token, self.files = app, token, files
        self.local = is_local(host)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it."""
        if scope["type"] == "lifespan":
            await self.app(scope, receive, send)
        if scope["type"] != "http":
            return
        headers = {name.decode("latin-1"): value.decode("latin-1") for name, value in scope["headers"]}
        _, token, path = [*scope["path"].split("/", 2), "", ""][:3]
        most = self.files.get(path, LARGEST)
        refused = self._refused(scope["method"], token, headers, most)
        if refused is not None:
            await PlainTextResponse(refused[1] + "\n", refused[0], headers=HEADERS)(scope, receive, send)
            return

        async def answer(message: Message) -> None:
            if message["type"] == "http.response.start":
                told = {name.lower() for name, _ in message["headers"]}
                message["headers"] = [*message["headers"], *((name.encode(), value.encode()) for name, value in HEADERS.items()
                                                             if name.encode() not in told)]
            await send(message)

        inside = {**scope, "path": f"/{path}", "raw_path": f"/{path}".encode(), "root_path": ""}
        with suppress(CancelledError):  # the server is ended, which is no mistake
            await self.app(inside, _counted(receive, most), answer)

    def _refused(self, method: str, token: str, headers: Mapping[str, str], most: int) -> tuple[int, str] | None:
        """Status and words for whoever may not come in."""
        host = headers.get("host", "")
        if not self._is_ours(host):
            return 421, tell("this page is not known under that name")
        if not compare_digest(token.encode(), self.token.encode()):
            return 403, tell("open the address that tmm-sheets serve has printed, with all of it")
        origin, site = headers.get("origin"), headers.get("sec-fetch-site", "same-origin")
        if (origin is not None and origin != f"http://{host}") or (method != "GET" and site not in ("same-origin", "none")):
            return 403, tell("the request comes from another page")
        if method == "POST" and not headers.get("content-type", "").startswith("multipart/form-data"):
            return 415, tell("a form is expected")
        length = headers.get("content-length", "0")
        if not length.isdecimal() or len(length) > 12 or int(length) > most:
            return 413, _too_large(most)
        return None

    def _is_ours(self, host: str) -> bool:
        """Whether a name is this machine's: an address, which no foreign name can stand for, or what it calls itself."""
        name = host.rpartition(":")[0] if host.rpartition(":")[2].isdecimal() else host
        if self.local:
            return name in ("127.0.0.1", "localhost", "[::1]")
        try:
            ipaddress.ip_address(name.strip("[]"))
        except ValueError:
            return name.lower() in ("localhost", socket.gethostname().lower(), socket.getfqdn().lower())
        return True


def is_local(host: str) -> bool:
    """Whether a server at this address can be reached from this machine only."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def _counted(receive: Receive, most: int) -> Receive:
    """Take no more than so many bytes, whatever was announced, and wait for them no longer than is sensible."""
    taken, clock = 0, asyncio.get_running_loop().time
    until: float | None = clock() + LONGEST

    async def counted() -> Message:
        nonlocal taken, until
        try:
            message = await (receive() if until is None else asyncio.wait_for(receive(), min(SILENT, until - clock())))
        except TimeoutError:
            raise HTTPException(408, tell("the request does not come to its end")) from None
        if not message.get("more_body"):
            until = None  # from here on it is waited for whoever goes away
        taken += len(message.get("body", b""))
        if taken > most:
            raise HTTPException(413, _too_large(most))
        return message

    return counted


def _too_large(most: int) -> str:
    return tell("more than {n} MB are not taken").format(n=most // 1_000_000)
