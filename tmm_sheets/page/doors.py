"""The doors of the page: who is let in, what answers each request, and the project that the page opens with."""

from __future__ import annotations

import asyncio
import base64
import hashlib
import ipaddress
import json
import re
import socket
from asyncio import CancelledError
from collections import defaultdict
from collections.abc import AsyncIterator, Awaitable, Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from hmac import compare_digest
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TypedDict, get_args
from unicodedata import normalize

from starlette.applications import Starlette
from starlette.datastructures import UploadFile
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, PlainTextResponse, Response, StreamingResponse
from starlette.routing import Route
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from tmm_sheets import catalogue, files, toml_file, words
from tmm_sheets.compare.group import COMPARED
from tmm_sheets.errors import BadInput
from tmm_sheets.files import alike, confine
from tmm_sheets.output import batch
from tmm_sheets.page import jobs
from tmm_sheets.page.workers import Job, Lane, Languages, Limits, Workers
from tmm_sheets.resources import template
from tmm_sheets.task import keys
from tmm_sheets.words import LANGUAGES, marked, reader, tell

AT_ONCE, FRONT, _, BEHIND = (Limits(10 if lane == "at once" else 30, lane=lane) for lane in get_args(Lane))
LONG = Limits(240, 4_000_000_000, "long")
JOBS: Mapping[str, tuple[Job, Limits]] = {
    "project": (jobs.project, AT_ONCE), "check": (jobs.check, AT_ONCE), "sheet": (jobs.sheet, FRONT),
    "remarks": (jobs.remarks, BEHIND), "scheme": (jobs.scheme, BEHIND), "living": (jobs.living, LONG),
    "take": (jobs.take, LONG), "compare": (jobs.compare, LONG), "group": (jobs.group, LONG),
}  # fmt: skip
FILES = {"compare": 80_000_000, "group": 400_000_000}
"""Doors that take files, and how many bytes."""
NOTHING = "'none'"
MOST_FILES = 1000
TYPES = {".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".ttf": "font/ttf"}
_SCRIPT = re.compile('<script type="module">(.*?)</script>', re.DOTALL)


def app(token: str, host: str, shown: Shown, processes: int | None = None) -> Guard:
    """The application behind its guard; ``shown`` is the project that it opens with."""
    workers = Workers(processes or batch.processors())
    ways = {path.name: path for path in sorted(template("page").iterdir()) if path.suffix in TYPES}
    ways["font.ttf"] = template("fonts/TMMSheetsB.ttf")

    def file(request: Request) -> Response:
        name = request.path_params.get("name", "index.html")
        if name not in ways:
            return Response(status_code=404)
        return Response(ways[name].read_bytes(), media_type=TYPES[ways[name].suffix])

    def telling(make: Callable[[], object]) -> Callable[[Request], Awaitable[Response]]:
        async def answer(request: Request) -> Response:
            _languages(request.query_params).speak_here()
            confine(Path())  # in what comes of this request: the work can open no other tasks
            return JSONResponse(make())

        return answer

    async def opened(request: Request) -> Response:
        return JSONResponse(shown.now())

    async def saved(request: Request) -> Response:
        async def texts() -> AsyncIterator[str]:
            async for now in shown.saved():
                yield f"data: {json.dumps(now)}\n\n"

        return StreamingResponse(texts(), media_type="text/event-stream")

    async def work(request: Request) -> Response:
        name = request.path_params["job"]
        if name not in JOBS:
            return Response(status_code=404)
        asked, folder, files = await _asked(request)
        job, limits = JOBS[name]
        limits = BEHIND if limits is FRONT and asked.get("behind") else limits

        async def lines() -> AsyncIterator[str]:
            with folder:
                async for message in workers.messages(job, asked, _languages(asked), limits, files):
                    yield json.dumps(message, ensure_ascii=False) + "\n"

        return StreamingResponse(lines(), media_type="application/x-ndjson")

    async def living(request: Request) -> Response:
        asked, folder, _ = await _asked(request)
        with folder:
            job, limits = JOBS["living"]
            *_, last = [message async for message in workers.messages(job, asked, _languages(asked), limits)]
        done = last.get("done")
        page = str(done["html"]) if isinstance(done, dict) else jobs.refusal(str(last["problem"]))
        return HTMLResponse(page, headers={"content-security-policy": _own_policy(page)})

    return Guard(Starlette(routes=[
        Route("/", file), Route("/page/{name}", file), Route("/words", telling(served_words)), Route("/tasks", telling(manuals)),
        Route("/keys", telling(keys.tables)),
        Route("/opened", opened), Route("/saved", saved), Route("/living", living, methods=["POST"]),
        Route("/{job}", work, methods=["POST"]),
    ]), token, host, FILES)  # fmt: skip


def _own_policy(page: str) -> str:
    """What the living page may do: carry out its own scripts, as they are, and nothing else; it has no origin."""
    own = " ".join(f"'sha256-{base64.b64encode(hashlib.sha256(s.encode()).digest()).decode()}'" for s in _SCRIPT.findall(page))
    return (f"sandbox allow-scripts allow-downloads; default-src 'none'; script-src {own or NOTHING}; style-src 'unsafe-inline'; "
            "font-src data:; img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'self'")


def _languages(asked: Mapping[str, str]) -> Languages:
    """The languages of a request: as ``--lang`` where it tells one, else those of the server."""
    told = asked.get("lang", "")
    return Languages(told, told) if told in LANGUAGES else Languages(words.reader(), words.asked())


async def _asked(request: Request) -> tuple[dict[str, str], TemporaryDirectory[str], dict[str, Path]]:
    """Fields of a form, and its files in a folder under names of our own."""
    asked: dict[str, str] = {}
    files: dict[str, Path] = {}
    folder = TemporaryDirectory(prefix="tmm-sheets-files-", ignore_cleanup_errors=True)
    try:
        async with request.form(max_files=MOST_FILES, max_fields=40, max_part_size=2_000_000) as form:
            for key, value in form.multi_items():
                if isinstance(value, UploadFile):
                    path = Path(folder.name) / str(len(files))
                    with path.open("wb") as file:
                        while piece := await value.read(1 << 20):
                            file.write(piece)
                    place = place_of_file(str(value.filename or ""), request.path_params.get("job") == "group")
                    here = alike(f"{place}/")
                    if any(here.startswith(other) or other.startswith(here) for other in (alike(f"{name}/") for name in files)):
                        raise HTTPException(422, tell("two files of one name: {name}").format(name=place))
                    files[place] = path
                else:
                    asked[key] = value
        return asked, folder, files
    except HTTPException as e:
        folder.cleanup()
        if e.status_code != 400:
            raise
        raise HTTPException(400, tell("a form is expected, with at most {n} files").format(n=MOST_FILES)) from None
    except BaseException:
        folder.cleanup()
        raise


LONGEST_PART, LONGEST_ENDING = 80, 8
"""Letters of the name of a file or folder that is kept here, and of its ending."""


def place_of_file(name: str, of_group: bool) -> str:
    """Where a file goes: of a group into the folder of its student; the client's name is made of letters and figures.

    Raises
    ------
    HTTPException
        for a name that is no place in the folder.
    """
    parts = [re.sub(r"[^\w @.+=,()-]+", "-", part).strip(" -") for part in normalize("NFC", name).replace("\\", "/").split("/")]
    parts = [part for part in parts if part.strip(".")]
    suffix = Path(parts[-1] if parts else "").suffix.lower()
    if not of_group:
        return f"{jobs.DROPPED}{suffix}" if suffix in COMPARED else f"{jobs.DROPPED}.other"
    if not parts:
        raise HTTPException(422, tell("a file without a name"))
    *student, last = parts[1:] or parts
    file = "-".join((*student[1:], last))
    ending = "" if len(file) <= LONGEST_PART else suffix[:LONGEST_ENDING]
    return "/".join(("group", *(one[:LONGEST_PART] for one in student[:1]), f"{file[:LONGEST_PART]}{ending}"))


# --- what the page says and what there is to choose --------------------------------------------------------------------


def served_words() -> dict[str, str]:
    """Texts by their keys."""
    return {
        "all reports": tell("All reports (zip)"),
        "and also": tell("And also"),
        "begins": tell("begins ..."),
        "between theirs and ours": tell("Between theirs and ours"),
        "busy": tell("Too many are at work here; try again in a minute."),
        "checking": tell("checking ..."),
        "designation": tell("Designation"),
        "doubtful numbers": tell("Doubtful numbers"),
        "drawing": tell("drawing ..."),
        "drop a drawing": tell("Drop a photograph, a DXF drawing or a measured table, or choose one"),
        "drop a project file": tell("Drop a project file, or choose one"),
        "drop a folder": tell("Drop the folder of a group, or choose it"),
        "find a task": tell("Find a task"),
        "group": tell("Group"),
        "handed in": tell("Handed in"),
        "institution": tell("Institution"),
        "it begins here": tell("It begins here"),
        "keys that may be added": tell("Keys that may be added"),
        "language": reader(),
        "language of the task": tell("Language: as it is"),
        "living sheet": tell("Living sheet"),
        "made {n} files": tell("Files made: {n}"),
        "make": tell("Make"),
        "mistakes": tell("Mistakes"),
        "most made": tell("Mistakes most made"),
        "no answer": tell("The server does not answer: was tmm-sheets serve ended?"),
        "note": tell("Explanatory note"),
        "nothing is wrong": tell("Nothing is wrong."),
        "one PDF": tell("all in one PDF"),
        "one upon the other": tell("one upon the other"),
        "open": tell("Open"),
        "ours": tell("Ours"),
        "pages to glue together": tell("Pages to glue together"),
        "project file": tell("Project file"),
        "project file alone": tell("The project file alone"),
        "recent": tell("Open lately"),
        "record": tell("Record (JSON)"),
        "remarks": tell("Remarks"),
        "sheet {n}": tell("Sheet {n}"),
        "sheets to print and to work with": tell("Sheets"),
        "stop": tell("Stop"),
        "stopped": tell("Stopped."),
        "student": tell("Student"),
        "supervisor": tell("Head of the project"),
        "tab check": tell("Check"),
        "tab choose": tell("Choose"),
        "tab file": tell("File"),
        "tab language": tell("Language"),
        "tab sheets": tell("Sheets"),
        "tab take": tell("Take"),
        "tab turn": tell("Living sheet"),
        "table to measure": tell("Table to fill in by measuring"),
        "take the suggested values": tell("Take the suggested values"),
        "theirs": tell("Theirs"),
        "title block": tell("Title block"),
        "variants": tell("variants"),
        "which sheet": tell("Which sheet the picture shows"),
        "whole report": tell("Whole report"),
        "whole sheet": tell("Whole sheet"),
        "your cipher": tell("your cipher"),
        "zoom in": tell("Zoom in"),
        "zoom out": tell("Zoom out"),
        "{green} right, {amber} to look at, {red} wrong": tell("{green} right, {amber} to look at, {red} wrong"),
    }


MANUALS = {
    "lugansk": marked("Manual 000: shaper, engine, cams"), "sixbar": marked("Manual 001: ten six-bar mechanisms"),
    "transport": marked("Manual 003: transport, by cipher"), "": marked("Manual 002, and class III"),
}  # fmt: skip
"""Titles of the manuals by the first part of the names of their projects."""
CIPHER = "@"
"""What stands between the machine and the cipher in a project's name."""


class ListedTask(TypedDict):
    """A task: its title, the machine whose cipher may be typed, the project of the picture, variants with ``name`` and ``said``."""

    title: str
    machine: str
    scheme: str
    variants: list[dict[str, str]]


class Manual(TypedDict):
    """A manual and its tasks."""

    title: str
    tasks: list[ListedTask]


def manuals() -> list[Manual]:
    """Manuals with their tasks."""
    found = defaultdict[str, dict[str, ListedTask]](dict, {manual: {} for manual in MANUALS})
    for entry in catalogue.entries():
        manual = entry.name.partition("/")[0] if "/" in entry.name else ""
        machine, cipher, _ = entry.name.partition(CIPHER)
        title = words.of_file(entry.title, tell)
        task = found[manual].setdefault(f"{entry.name.partition(':')[0]} {title}", {
            "title": title, "machine": machine if cipher else "", "scheme": entry.name, "variants": []})  # fmt: skip
        task["variants"].append({"name": entry.name, "said": words.of_file(entry.variant, tell)})
    return [{"title": tell(MANUALS.get(manual, manual)), "tasks": list(tasks.values())} for manual, tasks in found.items()]


# --- who is let in -----------------------------------------------------------------------------------------------------


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
            await self.app(inside, limited(receive, most), answer)

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


def limited(receive: Receive, most: int) -> Receive:
    """Take no more than so many bytes, whatever was announced, and wait for them no longer than is sensible.

    Raises
    ------
    HTTPException
        for more bytes than are taken, or none in time.
    """
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


# --- the project that the page opens with ------------------------------------------------------------------------------


@dataclass(frozen=True)
class Shown:
    """Its name and text, empty for none; a file that is ``followed`` is read anew each time it is saved."""

    name: str = ""
    text: str = ""
    followed: Path | None = None

    def now(self) -> dict[str, str | bool]:
        """What the page opens with."""
        text = self.text
        if self.followed is not None:
            with suppress(BadInput):
                text = toml_file.text_of(self.followed)[0]
        return {"name": self.name, "text": text, "followed": self.followed is not None}

    async def saved(self) -> AsyncIterator[dict[str, str | bool]]:
        """The project, read again each time that the file is saved."""
        if self.followed is None:
            return
        before = files.state(self.followed)
        while True:
            await asyncio.sleep(files.EACH_LOOK)
            state = files.state(self.followed)
            if state != before:
                before = state
                if state is not None:
                    yield self.now()


def shown_project(project: str, corrected: bool) -> Shown:
    """A shipped project, or a file with whatever mistakes it has."""
    if catalogue.is_shipped(project):
        found = catalogue.read(project, corrected)
        return Shown(found.stem, found.text)
    path = catalogue.located(project)
    return Shown(path.stem, toml_file.text_of(path)[0])


def followed_file(path: Path) -> Shown:
    """A file that is worked on elsewhere."""
    path = catalogue.located(str(path))
    toml_file.text_of(path)
    return Shown(path.stem, "", path)
