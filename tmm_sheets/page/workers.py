"""Work in processes of their own: each is a fork of one that has loaded everything, ends with its work, and has limits.

So a file that asks for an endless turn or a thousand megapixels ends in a message: the server itself reads no project. Whoever
goes away takes the work along.
"""

from __future__ import annotations

import asyncio
import ctypes
import json
import multiprocessing
import os
import signal
import struct
import sys
import tempfile
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from multiprocessing.connection import Connection
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Literal, get_args

from tmm_sheets import apart, files, kept, resources, words
from tmm_sheets.errors import BadInput, Problem, reason_of, told_of
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from multiprocessing.context import BaseContext
    from multiprocessing.process import BaseProcess

NICE = {"long": 5, "behind": 10}
"""By how much work in a lane gives way to other work."""
WAITING = 20.0
"""How many times its seconds of processor a piece of work may take by the clock: others work too, and it gives way to them."""

Message = dict[str, object]
Say = Callable[..., None]
"""Sends a message, its keys by name."""
Job = Callable[[Mapping[str, str], Say], Message]
"""Work in the folder that the process stands in, for what was asked; gives what comes last."""


Lane = Literal["at once", "front", "long", "behind"]
"""What takes no time; what somebody looks at; what takes long; what nobody looks at yet. None waits for another."""


@dataclass(frozen=True)
class Limits:
    """What a piece of work may take: seconds of processor, bytes of memory; and the lane it goes in."""

    seconds: int = 30
    memory: int = 2_000_000_000
    lane: Lane = "front"


@dataclass(frozen=True)
class Languages:
    """The reader's language, and that asked for the paper, empty for the project's."""

    reader: str
    asked: str = ""

    def speak_here(self) -> None:
        """Speak them in what comes of this request."""
        words.set_reader(self.reader)
        words.ask_paper(self.asked)

    def speak(self) -> None:
        """Speak them from here on, in all of this process."""
        self.speak_here()
        os.environ["LANGUAGE"] = self.reader  # for commands that are carried out


def told(problem: Problem) -> Message:
    """A problem of a project file for the page."""
    return {"line": problem.line, "field": problem.field, "message": problem.message, "hint": problem.hint}


def _carry_out(end: Connection, job: Job, asked: Mapping[str, str], folder: str, languages: Languages, limits: Limits) -> None:
    """The life of a process: whatever happens, what is sent last has ``done`` or ``problem``."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # it ends the server, which ends its work
    languages.speak()
    _limit(limits)

    def say(**message: object) -> None:
        with suppress(BrokenPipeError):
            end.send_bytes(json.dumps(message, ensure_ascii=False, allow_nan=False).encode())

    try:
        confine(Path(folder))  # which is gone where whoever asked has gone away
        say(done=job(asked, say))
    except BadInput as e:
        say(problem=str(e), mistakes=[told(p) for p in e.problems])
    except MemoryError:
        say(problem=tell("this takes more memory than the page gives one piece of work"))
    except OSError as e:
        say(problem=reason_of(e))
    except Exception as e:
        from tmm_sheets import defects

        file = Path("asked.toml")
        with suppress(OSError):
            file.write_text(asked.get("text", ""), encoding="utf-8")
        say(problem=defects.told(e, ("serve", job.__name__), file,
                                 lambda path: job({**asked, "text": path.read_text(encoding="utf-8")}, lambda **_: None)))


def _limit(limits: Limits) -> None:
    """Let the system hold this process within limits, where it can."""
    if hasattr(os, "nice"):
        os.nice(NICE.get(limits.lane, 0))
    apart.limit(limits.seconds, limits.memory)


@cache
def _context() -> BaseContext:
    """Where processes come from: forks of one that has loaded everything; on Windows each loads for itself."""
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["tmm_sheets.page.loaded"])
    return context


def _process(act: Callable[..., object], *what: object) -> BaseProcess:
    """One that does something; contexts have processes of their own kinds, which the type of all contexts does not tell."""
    made: BaseProcess = _context().Process(target=act, args=what, daemon=True)  # type: ignore[attr-defined]
    return made


def warm() -> None:
    """Let the process that others are forks of load everything now, and wait for it."""
    process = _process(os.getpid)
    _start(process)
    process.join()


def _start(process: BaseProcess) -> None:
    """Start a process that hears no Ctrl-C, nor does the one that it is a fork of: it ends the server, which ends its work."""
    if not hasattr(signal, "pthread_sigmask"):
        process.start()
        return
    from multiprocessing import resource_tracker

    resource_tracker.ensure_running()  # which would let it through again when it is started
    heard = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        process.start()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, heard)


def _begin(job: Job, asked: Mapping[str, str], folder: str, languages: Languages, limits: Limits) -> tuple[BaseProcess, Connection]:
    ours, theirs = _context().Pipe(duplex=False)
    process = _process(_carry_out, theirs, job, asked, folder, languages, limits)
    _start(process)
    theirs.close()
    return process, ours


class Workers:
    """So many pieces of work at a time in each lane; others wait for their turn."""

    def __init__(self, many: int) -> None:
        self.free = {lane: asyncio.Semaphore(many) for lane in get_args(Lane)}

    async def messages(self, job: Job, asked: Mapping[str, str], languages: Languages, limits: Limits,
                       brought: Mapping[str, Path] | None = None) -> AsyncIterator[Message]:
        """What a piece of work says, the last with ``done`` or ``problem``; who stops listening ends it.

        Files that were ``brought`` are put into its folder by their names there, which are no client's. Who listens slowly to what
        comes last keeps nobody waiting.
        """
        last: Message = {}
        free = self.free[limits.lane]
        if free.locked():
            yield {"say": tell("waiting for its turn ...")}
        async with free:
            with TemporaryDirectory(prefix="tmm-sheets-page-", ignore_cleanup_errors=True) as folder:
                try:
                    for name, path in (brought or {}).items():
                        place = files.named(name, Path(folder), Path(folder))
                        place.parent.mkdir(parents=True, exist_ok=True)
                        path.replace(place)
                except (BadInput, OSError) as e:
                    yield {"problem": told_of(e)}
                    return
                process, connection = await asyncio.to_thread(_begin, job, asked, folder, languages, limits)
                try:
                    async for last in _said(process, connection, limits):
                        if not _ends(last):
                            yield last
                finally:
                    process.kill()
                    process.join(5)
        yield last


async def _said(process: BaseProcess, connection: Connection, limits: Limits) -> AsyncIterator[Message]:
    """Messages of a process, and what is to be told of one that was ended."""
    clock = asyncio.get_running_loop().time
    latest = clock() + WAITING * limits.seconds
    try:
        while True:
            data = await asyncio.wait_for(asyncio.to_thread(connection.recv_bytes, apart.LARGEST), latest - clock())
            message = json.loads(data)
            yield message
            if _ends(message):
                return
    except TimeoutError:
        yield {"problem": _too_long(limits)}
    except (EOFError, OSError):
        process.join(5)
        of_time = process.exitcode in (-signal.SIGXCPU, -signal.SIGKILL) if hasattr(signal, "SIGXCPU") else False
        yield {"problem": _too_long(limits) if of_time else tell("the work was ended by the system, perhaps for want of memory")}


def _ends(message: Message) -> bool:
    return "done" in message or "problem" in message


def _too_long(limits: Limits) -> str:
    return tell("stopped: this takes more than {n} seconds of processor").format(n=limits.seconds)


# --- confinement -------------------------------------------------------------------------------------------------------


CREATE, ADD_RULE, RESTRICT = 444, 445, 446
"""Numbers of Landlock's calls, on all machines but Alpha."""
RIGHTS = {1: 13, 2: 14, 3: 15, 4: 15}
"""How many rights to files a version knows, 16 from the fifth on; the lowest bits stand for them."""
READ, OF_FILES = 0b1101, 0b1100_0000_0000_0111
"""Rights to execute, read files and list folders; those that a single file can have."""
NETWORK, OUTSIDE = 0b11, 0b11
"""TCP; sockets and signals that lead to processes outside."""
NO_NEW_PRIVILEGES = 38
SYSTEM = ("/lib", "/lib64", "/usr/lib", "/usr/lib64", "/usr/local/lib", "/usr/bin", "/usr/share", "/etc/ld.so.cache", "/etc/fonts",
          "/etc/localtime", "/dev/urandom")
"""What programs read wherever they run."""


def confine(folder: Path) -> None:
    """Stand in a folder that is this process's own, and get no other files from here on."""
    os.chdir(folder)
    files.confine(Path())
    tempfile.tempdir = str(Path().resolve())
    kernel = ctypes.CDLL(None, use_errno=True) if sys.platform == "linux" else None
    version = kernel.syscall(CREATE, None, 0, 1) if kernel is not None else -1
    if kernel is None or version < 1:
        return
    everything = (1 << RIGHTS.get(version, 16)) - 1
    told = struct.pack("QQQ", everything, NETWORK, OUTSIDE)[:8 * (1 + (version >= 4) + (version >= 6))]
    rules = kernel.syscall(CREATE, told, len(told), 0)
    packages = (place for place in sys.path if Path(place).name in ("site-packages", "dist-packages"))
    program = [resources.PACKAGE, resources.template(""), resources.variants(), sys.prefix, sys.base_prefix, *packages, *SYSTEM]
    shared = kept.folder()
    with suppress(OSError):
        if shared is not None:
            shared.mkdir(mode=0o700, parents=True, exist_ok=True)
    places = dict.fromkeys(map(str, program), READ) | dict.fromkeys(map(str, (os.devnull, ".", shared or ".")), everything)
    for place, rights in places.items():
        with suppress(OSError):
            end = os.open(place, os.O_PATH | os.O_CLOEXEC)
            own = rights if os.path.isdir(place) else rights & OF_FILES
            kernel.syscall(ADD_RULE, rules, 1, struct.pack("=Qi", own, end), 0)
            os.close(end)
    kernel.prctl(NO_NEW_PRIVILEGES, 1, 0, 0, 0)
    kernel.syscall(RESTRICT, rules, 0)
    os.close(rules)
