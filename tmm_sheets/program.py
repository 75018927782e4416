"""What this program is made of: the fingerprint by which what was made once is known to be what would be made now.

It is that of the contents of sources and templates, whatever machine they are on. Reading all of them takes a while: what was found
is kept under their sizes and dates, and is read instead as long as none of these has changed.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterator
from functools import cache
from hashlib import blake2b
from importlib.util import find_spec
from pathlib import Path
from time import time_ns
from typing import Any

from tmm_sheets import kept
from tmm_sheets.resources import template
from tmm_sheets.version import __version__

LIBRARIES = ("numpy", "shapely")
"""Libraries whose numbers stand on the sheets."""
SETTLED = 2_000_000_000
"""Age, ns, from which on a file's date tells that it has not changed: a later change has a later one."""


def fingerprint(*parts: str | bytes) -> str:
    """Digest of a sequence of texts and contents."""
    digest = blake2b(digest_size=16)
    for part in parts:
        data = part.encode() if isinstance(part, str) else part
        digest.update(len(data).to_bytes(8, "big"))
        digest.update(data)
    return digest.hexdigest()


def program() -> str:
    """Fingerprint of this program: its version, its source and its templates."""
    return _fingerprints()[0]


def maker() -> str:
    """Fingerprint of all that makes a drawing of the same inputs: the program, Python and the libraries it counts with."""
    return _fingerprints()[1]


@cache
def _fingerprints() -> tuple[str, str]:
    there, latest = _looked_at()
    name = fingerprint("program", "\n".join(there))
    if known := kept.taken(kept.read(name), lambda tree: (str(tree[0]), str(tree[1]))):
        return known
    from importlib.metadata import version

    own = fingerprint(__version__, *(part for path in _files() for part in (os.path.basename(path), Path(path).read_bytes())))
    whole = fingerprint(own, sys.version, *(f"{name} {version(name)}" for name in LIBRARIES))
    if time_ns() - latest > SETTLED:
        kept.write(name, json.dumps([own, whole]).encode())
    return own, whole


def _files() -> list[str]:
    """Paths of sources and templates, in a fixed order."""
    own, templates = (sorted(entry.path for entry in _walk(str(folder))) for folder in (Path(__file__).parent, template("")))
    return [*(path for path in own if path.endswith(".py") and not path.startswith(str(template("")))), *templates]


def _looked_at() -> tuple[list[str], int]:
    """Name, size and date of every file, without reading any; and the latest date, ns."""
    found, latest = [sys.version], 0
    for folder in (Path(__file__).parent, template("")):
        for entry in _walk(str(folder)):
            stat = entry.stat()
            latest = max(latest, stat.st_mtime_ns)
            found.append(f"{entry.path} {stat.st_size} {stat.st_mtime_ns}")
    for library in LIBRARIES:
        spec = find_spec(library)
        path = spec.origin if spec is not None else None
        if path:
            stat = os.stat(path)
            found.append(f"{path} {stat.st_size} {stat.st_mtime_ns}")
    return sorted(found), latest


def _walk(folder: str) -> Iterator[os.DirEntry[Any]]:
    """The files below a folder that may be sources or templates."""
    with os.scandir(folder) as entries:
        for entry in entries:
            if entry.is_dir():
                if entry.name != "__pycache__":
                    yield from _walk(entry.path)
            else:
                yield entry
