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
from operator import attrgetter
from pathlib import Path
from time import time_ns

from tmm_sheets import kept
from tmm_sheets.resources import template
from tmm_sheets.version import __version__

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
    if known := kept.taken(kept.read(name), lambda tree: (str(tree[0]), str(tree[1]))):
        return known
    own = fingerprint(__version__, *[part for entry in files for part in (entry.name, _content(entry.path))])
    # Installers write the version of a library into the name of a folder beside it.
    whole = fingerprint(own, sys.version, *(
        path.name for name, file in libraries.items() for path in sorted(Path(file).parents[1].glob(f"{name}-*"))))
    if time_ns() - max([stat.st_mtime_ns for stat in stats]) > SETTLED:
        kept.write(name, json.dumps([own, whole]).encode())
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
