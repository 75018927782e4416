"""What was made once and is kept for the next time, in the user's cache folder: bytes under a name that says what they are made of.

Nothing depends on it. What is not there, is torn, or cannot be read is made again; what cannot be written (a full disk, a home that
is read-only) is not kept, and nobody is told. Files appear whole, under names that two processes give to the same content only.
Those not read for longest go when all together are too large.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, suppress
from contextvars import ContextVar
from functools import cache
from hashlib import blake2b
from importlib.util import find_spec
from operator import attrgetter
from pathlib import Path
from time import time_ns
from typing import Any, TypeVar
from zlib import crc32

from tmm_sheets.resources import template
from tmm_sheets.version import __version__
from tmm_sheets.words import meanwhile

FOLDER = "TMM_SHEETS_CACHE"
"""Environment variable that names the folder; empty for none."""
LARGEST = 256_000_000
"""Bytes that all files together may have."""
MARK = b"tmm-kept1\n"
"""What every file begins with; its checksum and then its content follow."""
SELDOM = 16
"""How many files are written, about, between two looks at their size together."""
PASSING = ".part"
"""End of the name of a file that is being written."""
OTHERS = 0o022
"""Rights of others to write."""
LEFT = 86_400.0
"""Seconds after which such a file belongs to nobody."""

T = TypeVar("T")
_used = ContextVar("used", default=True)


used = _used.get
"""Whether anything is read there or written."""


def unused() -> AbstractContextManager[None]:
    """Nothing is read there meanwhile, and nothing written."""
    return meanwhile(_used, False)


def forgo() -> None:
    """Read and write nothing there from here on: for a command that was told so."""
    _used.set(False)


def folder() -> Path | None:
    """Where things are kept; None where nothing is, as in a folder that others can write to."""
    if not _used.get():
        return None
    told = os.environ.get(FOLDER)
    place = _folder() if told is None else Path(told) if told else None
    return place if place is not None and _is_ours(place) else None


def _is_ours(place: Path) -> bool:
    """Whether nobody else can put anything there, or nothing is there yet: what is read there is believed."""
    try:
        found = place.stat()
    except (OSError, ValueError):
        return True
    return os.name == "nt" or (found.st_uid == os.getuid() and not found.st_mode & OTHERS)


@cache
def _folder() -> Path | None:
    from platformdirs import user_cache_dir

    found = Path(user_cache_dir("tmm-sheets", appauthor=False))
    return found if found.is_absolute() else None  # nobody's home: not beside the drawings


def read(name: str) -> bytes | None:
    """What is kept under a name, which is made of letters and figures; None for nothing sound."""
    place = folder()
    if place is None:
        return None
    path = place / name
    try:
        data = path.read_bytes()
    except (OSError, ValueError):
        return None
    at = len(MARK) + 4
    if data[:len(MARK)] != MARK or len(data) < at or int.from_bytes(data[len(MARK):at], "big") != crc32(memoryview(data)[at:]):
        return None
    with suppress(OSError):
        os.utime(path)  # what is read stays longer
    return data[at:]


def taken(data: bytes | None, read: Callable[[Any], T]) -> T | None:
    """What ``read`` makes of JSON that was kept; None where it is none, or another one than is written today."""
    import json

    try:
        return read(json.loads(data or b""))
    except (ValueError, TypeError, LookupError, AttributeError, ArithmeticError, StopIteration, RecursionError):
        return None


def write(name: str, content: bytes) -> None:
    """Keep something under a name, if that can be done."""
    place = folder()
    if place is None:
        return
    part = place / f"{name}.{os.getpid()}{PASSING}"
    try:
        place.mkdir(mode=0o700, parents=True, exist_ok=True)
        part.write_bytes(MARK + crc32(content).to_bytes(4, "big") + content)
        part.replace(place / name)
    except (OSError, ValueError):
        with suppress(OSError, ValueError):
            part.unlink()
        return
    if crc32(name.encode()) % SELDOM == 0:
        tidy(place)


def tidy(place: Path, largest: int = LARGEST) -> None:
    """Remove what was not read for longest until the rest is well below ``largest`` bytes, and what killed processes left."""
    from time import time

    found, size = [], 0
    with suppress(OSError), os.scandir(place) as entries:
        for entry in entries:
            with suppress(OSError):
                stat = entry.stat()
                if entry.name.endswith(PASSING) and time() - stat.st_mtime > LEFT:
                    os.unlink(entry.path)
                else:
                    found.append((stat.st_mtime, stat.st_size, entry.path))
                    size += stat.st_size
    if size <= largest:
        return
    for _, bytes_, path in sorted(found):
        if size <= 0.75 * largest:
            break
        with suppress(OSError):
            os.unlink(path)
        size -= bytes_


LIBRARIES = ("numpy", "shapely", "reportlab", "matplotlib", "ezdxf")
"""Libraries whose numbers stand on the sheets, and those that write files."""
SETTLED = 2_000_000_000
"""Age, ns, from which on a file's date tells that it has not changed: a later change has a later one."""


def fingerprint(*parts: str | bytes) -> str:
    """Digest of a sequence of texts and contents."""
    digest = blake2b(digest_size=16)
    for part in parts:
        data = part.encode() if isinstance(part, str) else part
        digest.update(len(data).to_bytes(8, "big") + data)
    return digest.hexdigest()


def program() -> str:
    """Fingerprint of this program: its version, its source and its templates."""
    return source_fingerprints()[0]


def maker() -> str:
    """Fingerprint of all that makes a drawing of the same inputs: the program, Python and the libraries it counts with."""
    return source_fingerprints()[1]


@cache
def source_fingerprints() -> tuple[str, str]:
    """Fingerprints of this program's sources and libraries, and of what stands in them."""
    files = list(_files())
    stats = [entry.stat() for entry in files]
    libraries = {name: spec.origin for name in LIBRARIES if (spec := find_spec(name)) is not None and spec.origin}
    looked_at = [f"{entry.path} {stat.st_size} {stat.st_mtime_ns}" for entry, stat in zip(files, stats, strict=True)]
    looked_at += [f"{path} {stat.st_size} {stat.st_mtime_ns}" for file in libraries.values()
                  for path in (file, Path(file).parents[1]) if (stat := os.stat(path))]
    name = fingerprint("program", "\n".join((sys.version, *looked_at)))
    if known := taken(read(name), lambda tree: (str(tree[0]), str(tree[1]))):
        return known
    own = fingerprint(__version__, *[f"{entry.name}\n".encode() + _content(entry.path) for entry in files])
    # Installers write the version of a library into the name of a folder beside it.
    whole = fingerprint(own, sys.version, *(
        path.name for name, file in libraries.items() for path in sorted(Path(file).parents[1].glob(f"{name}-*"))))
    if time_ns() - max([stat.st_mtime_ns for stat in stats]) > SETTLED:
        write(name, f'["{own}", "{whole}"]'.encode())
    return own, whole


def _content(path: str) -> bytes:
    with open(path, "rb") as file:  # quicker than by pathlib: there are hundreds
        return file.read()


def _files() -> list[os.DirEntry[str]]:
    """Sources, and templates, in a fixed order."""
    inside = str(template(""))
    sources = [entry for entry in _source_files(str(Path(__file__).parent)) if entry.path.endswith(".py")]
    own = [entry for entry in sources if not entry.path.startswith(inside)]
    return [entry for some in (own, _source_files(inside)) for entry in sorted(some, key=attrgetter("path"))]


def _source_files(folder: str) -> Iterator[os.DirEntry[str]]:
    """The files below a folder that may be sources or templates."""
    with os.scandir(folder) as entries:
        for entry in entries:
            if entry.is_dir():
                if entry.name != "__pycache__":
                    yield from _source_files(entry.path)
            else:
                yield entry
