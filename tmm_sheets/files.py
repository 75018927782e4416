"""Output files that appear whole or not at all, all of a set together."""

from __future__ import annotations

import os
import platform
import re
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from threading import Lock
from time import gmtime, time

from tmm_sheets.errors import BadInput, Problem, reason_of
from tmm_sheets.words import tell

WRITING = Lock()
"""Held while files are written: whoever ends the process at once waits for it, and nothing half-written stays."""
LONG = 86_400.0
"""Seconds after which a passing file belongs to nobody, whatever its name says."""


def write_all(files: Mapping[Path, bytes]) -> None:
    """Write a set of files, making their folders.

    Raises
    ------
    BadInput
        when a folder or a file cannot be written; nothing new is left behind then.
    """
    try:
        for path in files:
            check_folder(path.parent)
            path.parent.mkdir(parents=True, exist_ok=True)
        put(files)
    except OSError as e:
        raise BadInput(_unwritable(Path(e.filename or ""), e)) from None


def put(files: Mapping[Path, bytes]) -> None:
    """Write a set of files into folders that are there: each beside its place under a passing name; all are renamed at the end.

    When anything fails nothing new is left behind, and older files stay as they were.

    Raises
    ------
    IsADirectoryError
        when a folder has the name of a file.
    OSError
        with the name of the file, when the disk is full or there is no permission.
    """
    with WRITING:
        _put(files)


def _put(files: Mapping[Path, bytes]) -> None:
    passing: dict[Path, Path] = {}
    current = Path()
    try:
        for path, data in files.items():
            current = path
            if path.is_dir():
                raise IsADirectoryError(0, tell("expected a file, this is a folder"))
            if path.exists() and not path.is_file():  # a pipe or a device: nothing to rename onto
                path.write_bytes(data)
                continue
            target = path.resolve()
            sweep(target)
            passing[target] = target.with_name(f".{target.name}.{os.getpid()}{_host()}.part")
            passing[target].write_bytes(data)
        for target, part in passing.items():
            current = target
            part.replace(target)
    except OSError as e:
        e.filename = str(current)
        raise
    finally:
        for part in passing.values():
            with suppress(OSError):
                part.unlink(missing_ok=True)


def sweep(path: Path) -> None:
    """Remove what killed processes left of a file: passing files of processes that are no more, here or, after a day, elsewhere."""
    with suppress(OSError):
        for part in path.parent.iterdir():
            name = re.fullmatch(rf"\.{re.escape(path.name)}\.(\d+)(@.*)?\.part", part.name)
            if name is not None and int(name[1]) != os.getpid():
                with suppress(OSError):
                    here = name[2] in (None, _host())
                    if (here and not _alive(int(name[1]))) or time() - part.stat().st_mtime > LONG:
                        part.unlink()


def _host() -> str:
    """Mark of this machine: folders may be shared by several."""
    return "@" + re.sub(r"[^\w-]", "-", platform.node())


def _alive(process: int) -> bool:
    """Whether there is such a process; taken for granted where asking would end it."""
    if os.name == "nt":
        return True
    try:
        os.kill(process, 0)
        state = Path(f"/proc/{process}/stat")  # of Linux: one that is dead may wait there for its parent
        return not state.exists() or state.read_text(encoding="ascii", errors="replace").rpartition(")")[2].split()[0] not in "ZX"
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:
        return True


def check_folder(folder: Path) -> None:
    """Check, before any work is done for it, that a folder can be made and written into; nothing is made yet.

    Raises
    ------
    BadInput
        when it cannot.
    """
    nearest = next(p for p in (folder, *folder.absolute().parents) if p.exists())
    if not nearest.is_dir():
        raise BadInput(Problem(tell("expected a folder, this is a file"), str(nearest), hint=tell("choose another with -o")))
    if not os.access(nearest, os.W_OK | os.X_OK):
        raise BadInput(_unwritable(nearest, PermissionError(0, "permission denied")))


def _unwritable(path: Path, e: OSError) -> Problem:
    why = reason_of(e)
    return Problem(
        tell("cannot be written: {why}").format(why=why),
        str(path),
        hint=tell("choose another place with -o, or make room; nothing was written"),
    )


def seen_from(path: Path, folder: Path) -> str:
    """Where a folder is for who reads a file: relative to it, with slashes; on another drive, whole."""
    with suppress(ValueError):
        return Path(os.path.relpath(folder, path.parent)).as_posix()
    return folder.absolute().as_posix()


def source_date() -> int | None:
    """The date that files shall tell, seconds since 1970, from SOURCE_DATE_EPOCH; None where that is not set.

    Raises
    ------
    BadInput
        when it is something else.
    """
    told = os.environ.get("SOURCE_DATE_EPOCH", "").strip()
    if not told:
        return None
    try:
        seconds, year = int(told), gmtime(int(told)).tm_year
    except (ValueError, OverflowError, OSError):
        seconds, year = -1, 0
    if seconds < 0 or year > 9999:
        raise BadInput(
            Problem(
                tell("expected whole seconds since 1970, not '{told}'").format(told=told),
                tell("environment"),
                field="SOURCE_DATE_EPOCH",
                hint=tell("such as 1700000000; or leave it unset"),
            )
        )
    return seconds
