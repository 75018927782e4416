"""Files that are read and written: whole or not at all, a set together, never through a link; pipes and devices are told by name.

What is named outright below ``/dev`` or ``/proc`` (``/dev/stdout``, ``/dev/fd/63`` of a shell) is open already: it is read and
written as it is.
"""

from __future__ import annotations

import errno
import os
import platform
import re
import stat
import unicodedata
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from contextvars import ContextVar
from pathlib import Path, PureWindowsPath
from threading import Lock
from time import gmtime, sleep, time
from typing import IO

from tmm_sheets.errors import BadInput, Problem, reason_of
from tmm_sheets.words import marked, tell

WRITING = Lock()
"""Held while files are written: whoever ends the process at once waits for it, and nothing half-written stays."""
LONG = 86_400.0
"""Seconds after which a passing file belongs to nobody, whatever its name says."""
LARGEST = 500_000_000
"""Bytes of the largest file that is read."""
MOST_POSITIONS = 1_000_000
"""Rows of the largest table that is written: positions of a turn that are computed, or numbers that are tried, at most."""
URL = r"([a-z][a-z0-9+.-]+):/+"
"""How a place in an object store begins; one letter is a drive of Windows."""
_ELSEWHERE = r"([A-Za-z][A-Za-z0-9+.-]*)?:"
"""How a place begins that some system takes for one on another drive, or on another machine."""
ENDINGS = {"dxf": "dxf", "pdf": "pdf", "svg": "svg", "png": "png", "hpgl": "plt"}
"""Formats of drawings, each written by the module of its name in ``backends``, and what names of their files end in."""
_root: ContextVar[Path | None] = ContextVar("root", default=None)
_SPECIAL = (
    (stat.S_ISFIFO, marked("expected a file, this is a pipe")), (stat.S_ISSOCK, marked("expected a file, this is a socket")),
    (stat.S_ISCHR, marked("expected a file, this is a device")), (stat.S_ISBLK, marked("expected a file, this is a device")),
)  # fmt: skip
"""What a name may stand for that is no file, and no folder either."""


def check_format(form: str) -> None:
    """Refuse what is no format of drawings.

    Raises
    ------
    BadInput
        with those that there are.
    """
    if form not in ENDINGS:
        raise BadInput(tell("'{part}' is not one of {known}").format(part=form, known=", ".join(ENDINGS)))


def confine(root: Path) -> None:
    """From here on take names for files below a folder alone: data of strangers name them."""
    _root.set(root.resolve())


def confined() -> bool:
    """Whether :func:`confine` was called."""
    return _root.get() is not None


def named(name: str, folder: Path = Path(), inside: Path | None = None) -> Path:
    """Path of a file that data, or a command, call by a name seen from a folder; whether there is one is not looked at.

    Raises
    ------
    BadInput
        when it is not below ``inside``, or below the folder that this process is confined to: always with the same words.
    """
    root, path, sort = inside or _root.get(), folder / name, PureWindowsPath(name)
    if root is None:
        return path
    with suppress(OSError, ValueError, RuntimeError):  # names that no file can have, links that lead round
        if not sort.anchor and ".." not in sort.parts and path.resolve().is_relative_to(root.resolve()):
            return path
    raise BadInput(Problem(tell("expected the name of a file below the folder that names it"), name.replace("\0", " ")))


def content(path: Path, most: int = LARGEST) -> bytes:
    """Bytes of a file.

    Raises
    ------
    OSError
        when there is none, it is a folder, a pipe or a device, its links lead round, or it has more than ``most`` bytes.
    """
    check_file(path)
    with path.open("rb") as file:
        data = file.read(most + 1)
    if len(data) > most:
        raise OSError(errno.EFBIG, os.strerror(errno.EFBIG), str(path))
    return data


def check_file(path: Path) -> None:
    """Refuse, as :func:`content` does, what is there under a name and is no file.

    Raises
    ------
    OSError
        when it is a pipe, a device or a socket, or cannot be looked at.
    """
    try:
        mode = os.stat(path).st_mode
    except ValueError:  # a name that no file can have
        raise OSError(errno.ENOENT, os.strerror(errno.ENOENT), str(path)) from None
    _refuse_special(path, mode)


def _refuse_special(path: Path, mode: int) -> None:
    for is_so, said in _SPECIAL:
        if is_so(mode) and not _is_open(path):
            raise OSError(errno.EINVAL, tell(said), str(path))


def _is_open(path: Path) -> bool:
    """Whether a name is one of the system's for what is open already, or for nothing."""
    place = os.path.abspath(path)
    return place.startswith(("/dev/fd/", "/dev/std", "/proc/")) or place in ("/dev/null", "/dev/full", "/dev/tty", os.devnull)


Content = bytes | Callable[[IO[bytes]], None]
"""What a file holds, or what writes it piece by piece."""


def write_all(files: Mapping[Path, Content]) -> None:
    """Write a set of files, making their folders.

    Raises
    ------
    BadInput
        when a folder or a file cannot be written; nothing new is left behind then.
    """
    try:
        for path in files:
            refuse_elsewhere(path)
            check_folder(path.parent)
            path.parent.mkdir(parents=True, exist_ok=True)
        put(files)
    except OSError as e:
        raise BadInput(_unwritable(Path(e.filename or ""), e)) from None


def put(files: Mapping[Path, Content]) -> None:
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


def _put(files: Mapping[Path, Content]) -> None:
    passing: dict[Path, Path] = {}
    current = Path()
    try:
        for path in files:
            current = path
            _check_name(path)
        for path, data in files.items():
            current = path
            if _is_open(path):
                _write(path, data)
                continue
            sweep(path)
            passing[path] = path.with_name(f".{path.name}.{os.getpid()}{_host()}.part")
            _write(passing[path], data)
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


def _check_name(path: Path) -> None:
    """Refuse a name that is taken by what is no file: it would be lost, or waited for. A link is replaced, whatever it leads to."""
    if path.is_dir():
        raise IsADirectoryError(0, tell("expected a file, this is a folder"))
    try:
        mode = path.lstat().st_mode
    except FileNotFoundError:
        return
    _refuse_special(path, mode)
    if stat.S_ISLNK(mode) and not _is_open(path):
        with suppress(FileNotFoundError):
            path.stat()  # tells of links that lead round


def _write(path: Path, data: Content) -> None:
    if isinstance(data, bytes):
        path.write_bytes(data)
        return
    with path.open("wb") as file:
        data(file)


def zipped(members: Mapping[str, bytes]) -> bytes:
    """A zip file of members in their order: the same bytes at any time on every system, of the earliest date that it knows."""
    import zipfile
    from io import BytesIO

    data = BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        for name, content in members.items():
            member = zipfile.ZipInfo(name)
            member.external_attr, member.create_system = 0o644 << 16, 3
            archive.writestr(member, content, zipfile.ZIP_DEFLATED)
    return data.getvalue()


def sweep(path: Path) -> None:
    """Remove what killed processes left of a file: passing files of processes that are no more, here or, after a day, elsewhere."""
    with suppress(OSError):
        for part in path.parent.iterdir():
            name = re.fullmatch(rf"\.{re.escape(path.name)}\.(\d+)(@.*)?\.part", part.name)
            if name is not None and int(name[1]) != os.getpid():
                with suppress(OSError):
                    here = name[2] in (None, _host())
                    if (here and not _is_running(int(name[1]))) or time() - part.stat().st_mtime > LONG:
                        part.unlink()


def _host() -> str:
    """Mark of this machine: folders may be shared by several."""
    return "@" + re.sub(r"[^\w-]", "-", platform.node())


def _is_running(process: int) -> bool:
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


def refuse_other(path: Path, data: bytes, force: bool) -> None:
    """Refuse to write over a file that says something else, unless forced to.

    Raises
    ------
    BadInput
        when it does: it may be somebody's own work.
    """
    if not force and path.is_file() and path.read_bytes() != data:
        refuse_present(path, force, tell("is there already and says something else; nothing was written"))


def refuse_present(path: Path, force: bool, said: str = "") -> None:
    """Refuse to write over what there is, unless forced to.

    Raises
    ------
    BadInput
        when there is something.
    """
    refuse_elsewhere(path)
    if path.exists() and not force:
        raise BadInput(Problem(said or tell("is there already; nothing was written"), str(path),
                               hint=tell("choose another name, or overwrite it with --force")))


def check_folder(folder: Path) -> None:
    """Check, before any work is done for it, that a folder can be made and written into; nothing is made yet.

    Raises
    ------
    BadInput
        when it cannot.
    """
    refuse_elsewhere(folder)
    try:
        nearest = next(p for p in (folder, *folder.absolute().parents) if os.path.lexists(p))
        nearest.stat()
    except OSError as e:  # links that lead round, or to nothing
        raise BadInput(_unwritable(Path(e.filename or folder), e)) from None
    if not nearest.is_dir():
        raise BadInput(Problem(tell("expected a folder, this is a file"), str(nearest), hint=tell("choose another with -o")))
    if not os.access(nearest, os.W_OK | os.X_OK):
        raise BadInput(_unwritable(nearest, PermissionError(0, "permission denied")))


def refuse_elsewhere(path: Path) -> None:
    """Refuse a place that is called as if it were elsewhere, such as ``s3:x``: nobody means a folder of that name.

    Raises
    ------
    BadInput
        when it is; a drive is a place where systems have drives.
    """
    told = path.as_posix()
    if "\0" in told:
        raise BadInput(_unwritable(path, OSError(errno.EINVAL, os.strerror(errno.EINVAL))))
    if re.match(URL, told):
        raise BadInput(Problem(tell("only build and roster write into an object store"), re.sub(URL, r"\1://", told)))
    if not path.drive and re.match(_ELSEWHERE, told):
        raise BadInput(Problem(tell("expected a folder or a file here, not one of another drive or machine"), told,
                               hint=tell("an object store is called as in s3://bucket/folder; write the whole path of a folder "
                                         "that has such a name")))


def _unwritable(path: Path, e: OSError) -> Problem:
    return Problem(
        tell("cannot be written: {why}").format(why=reason_of(e)),
        str(path),
        hint=tell("choose another place with -o, or make room; neither it nor what belongs to it was written"),
    )


_RESERVED = r"(?i:con|prn|aux|nul|com[0-9¹²³]|lpt[0-9¹²³]|conin\$|conout\$) *(\..*)?"
LONGEST_NAME = 200
"""Bytes of the longest name that is made of a text: systems take 255."""


def name_of(text: str, spaced: bool = False) -> str:
    """Name of a file or a folder for what is called so, which any system takes; empty where nothing is left of it.

    Signs that are not for names become hyphens, and where it is not ``spaced``, as names of people are, all that a shell would
    take for something else; what Windows keeps for devices (CON, COM1) has an underscore behind it.
    """
    signs, ends = (r'[\\/:*?"<>|\x00-\x1f]+', " .-_") if spaced else (r"[^\w@.+=-]+", "-.")
    name = re.sub(signs, "-", text).strip(ends).encode()[:LONGEST_NAME].decode(errors="ignore").strip(ends)
    return re.sub(r"^([^.]*)", r"\1_", name) if re.fullmatch(_RESERVED, name) else name


def folder_name(stem: str) -> str:
    """Name of a folder for what is called so, see :attr:`~tmm_sheets.task.variant.Variant.stem`."""
    return name_of(stem) or "project"


def alike(name: str) -> str:
    """What names have in common that some systems take for the same."""
    return unicodedata.normalize("NFC", name).casefold()


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


# --- files that somebody works on --------------------------------------------------------------------------------------


EACH_LOOK = 0.5
"""Seconds between two looks."""


def saved(paths: Sequence[Path], wait: Callable[[float], None] = sleep) -> Iterator[None]:
    """At once, and then each time that one of some files is written, made or removed, until nobody asks."""
    before = None
    while True:
        now = [state(path) for path in paths]
        if now != before:
            before = now
            yield
        else:
            wait(EACH_LOOK)


def state(path: Path) -> tuple[int, int] | None:
    """What is another one when a file has been written; None where there is none."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size
