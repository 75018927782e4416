"""The doors of the page: each request that is let in, and what answers it."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from collections.abc import AsyncIterator, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import get_args

from starlette.applications import Starlette
from starlette.datastructures import UploadFile
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, Response, StreamingResponse
from starlette.routing import Route

from tmm_sheets import words
from tmm_sheets.compare.group import COMPARED
from tmm_sheets.files import confine
from tmm_sheets.output import batch
from tmm_sheets.page import choice, compared, jobs, served_words
from tmm_sheets.page.guard import Guard
from tmm_sheets.page.shown import Shown
from tmm_sheets.page.workers import Job, Lane, Languages, Limits, Workers
from tmm_sheets.resources import template
from tmm_sheets.task import keys
from tmm_sheets.words import LANGUAGES, tell

AT_ONCE, FRONT, _, BEHIND = (Limits(10 if lane == "at once" else 30, lane=lane) for lane in get_args(Lane))
LONG = Limits(240, 4_000_000_000, "long")
JOBS: Mapping[str, tuple[Job, Limits]] = {
    "project": (jobs.project, AT_ONCE), "check": (jobs.check, AT_ONCE), "sheet": (jobs.sheet, FRONT),
    "remarks": (jobs.remarks, BEHIND), "scheme": (jobs.scheme, BEHIND), "living": (jobs.living, LONG),
    "take": (jobs.take, LONG), "compare": (compared.compare, LONG), "group": (jobs.group, LONG),
}  # fmt: skip
FILES = {"compare": 80_000_000, "group": 400_000_000}
"""Doors that take files, and how many bytes."""
NOTHING = "'none'"
MOST_FILES = 1000
TYPES = {".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".ttf": "font/ttf"}
_SCRIPT = re.compile("<script>(.*?)</script>", re.DOTALL)


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

    async def words_of(request: Request) -> Response:
        _languages(request.query_params).speak_here()
        return JSONResponse(served_words.served_words())

    async def tasks(request: Request) -> Response:
        _languages(request.query_params).speak_here()
        confine(Path())  # in what comes of this request: the work can open no other tasks
        return JSONResponse(choice.manuals())

    async def keys_of(request: Request) -> Response:
        _languages(request.query_params).speak_here()
        return JSONResponse(keys.tables())

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
        Route("/", file), Route("/page/{name}", file), Route("/words", words_of), Route("/tasks", tasks), Route("/keys", keys_of),
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
                    place = _place(str(value.filename or ""), request.path_params.get("job") == "group")
                    here = f"{place}/".casefold()
                    if any(here.startswith(other) or other.startswith(here) for other in (f"{name}/".casefold() for name in files)):
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


def _place(name: str, of_group: bool) -> str:
    """Where a file goes: of a group into the folder of its student; the client's name is made of letters and figures."""
    parts = [re.sub(r"[^\w @.+=,()-]+", "-", part)[:80].strip(" -") for part in name.replace("\\", "/").split("/")]
    parts = [part for part in parts if part.strip(".")]
    suffix = Path(parts[-1] if parts else "").suffix.lower()
    if not of_group:
        return f"{compared.NAME}{suffix}" if suffix in COMPARED else f"{compared.NAME}.other"
    if not parts:
        raise HTTPException(422, tell("a file without a name"))
    return "/".join(("group", *parts[1:2], *(parts[2:] and ["-".join(parts[2:])])) if parts[1:] else ("group", parts[0]))
