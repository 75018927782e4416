"""Defects of the program: what led to one is kept, with the least input that still leads to it, and the program goes on."""

from __future__ import annotations

import os
import traceback
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from zlib import crc32

from tmm_sheets import files, kept, quoting
from tmm_sheets.errors import BadInput, CannotBuild, told_of
from tmm_sheets.words import tell

SECONDS = 5
"""How long a lesser input is looked for."""
LARGEST = 1_000_000
"""Bytes of the largest input of which a lesser one is looked for."""
Again = Callable[[Path], object]
"""The work that fell over, on a file in the place of its own."""


def told(e: Exception, command: Sequence[str], file: Path | None = None, again: Again | None = None) -> str:
    """What is said of an error by what goes on after it: of a defect also where what led to it is kept.

    That is the ``command``, the place in the program and, where there is a ``file``, the least one with which ``again`` still ends
    there: beside the file, or in the cache folder where that is no place for it.
    """
    said = told_of(e)
    report = None if isinstance(e, BadInput | CannotBuild | OSError | MemoryError) else _report(e, file)
    if report is None:
        return said
    with suppress(OSError):
        made = {report: f"{quoting.command(*command)}\n\n{''.join(traceback.format_exception(e))}".encode(errors="replace")}
        if file is not None and again is not None:
            data = files.content(file, LARGEST)
            made[report] += b"\n" + data
            made[report.with_suffix(file.suffix)] = least(data, file.name, again, _place(e))
        report.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        files.put(made)
        said += "\n    " + tell("what led to it is kept in {file}").format(file=", ".join(map(str, made)))
    return said


def _report(e: Exception, file: Path | None) -> Path | None:
    """Where it is told what led to a defect; in the cache folder each place in the program has one report."""
    if file is not None and not files.confined():
        return file.with_suffix(".defect.txt")
    folder = kept.folder()
    return None if folder is None else folder / f"defect-{crc32(repr(_place(e)).encode()):08x}.txt"


def _place(e: BaseException) -> tuple[str, str, int]:
    """Type of an error and where it was raised."""
    frame = traceback.extract_tb(e.__traceback__)[-1]
    return type(e).__name__, frame.filename, frame.lineno or 0


def least(data: bytes, name: str, again: Again, place: tuple[str, str, int]) -> bytes:
    """The fewest lines of an input with which the work still ends in an error of a place, as far as they are found in time.

    They are tried in a fork of this process, which cannot write into any other file; where there are no forks all are needed.
    """
    with TemporaryDirectory(prefix="tmm-sheets-") as folder:
        found = Path(folder) / "least"
        found.write_bytes(data)
        child = os.fork() if hasattr(os, "fork") else None
        if child == 0:
            try:
                _reduce(found, Path(folder) / f"tried-{name}", again, place)
            finally:
                os._exit(0)
        if child is not None:
            os.waitpid(child, 0)
        return found.read_bytes()


def _reduce(found: Path, tried: Path, again: Again, place: tuple[str, str, int]) -> None:
    """Leave out halves, quarters .. single lines, the last ones first, as long as the work ends in the same error without them."""
    import resource
    import signal

    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.alarm(SECONDS)
    kept.forgo()
    for stream in (0, 1, 2):
        os.dup2(os.open(os.devnull, os.O_RDWR), stream)
    most = resource.getrlimit(resource.RLIMIT_FSIZE)[1]
    lines = found.read_bytes().splitlines(keepends=True)

    def falls(some: Sequence[bytes]) -> bool:
        resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
        tried.write_bytes(b"".join(some))
        resource.setrlimit(resource.RLIMIT_FSIZE, (0, most))
        try:
            again(tried)
        except BaseException as e:
            return _place(e) == place
        return False

    size = len(lines) if falls(lines) else 0
    while size:
        before = len(lines)
        for at in range(before - size, -size, -size):
            fewer = lines[:max(at, 0)] + lines[at + size:]
            if falls(fewer):
                lines = fewer
                tried.replace(found)
        if size > 1 or len(lines) == before:
            size //= 2
