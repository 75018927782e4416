"""The heading of a shipped project, ``[project]``, read without the rest of its file: what ``list`` shows."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from string import Template
from typing import Any


def of(text: str, fields: Mapping[str, str] | None = None) -> dict[str, Any]:
    """Table ``[project]`` of a project file, or of a scheme with the ``fields`` that are filled in there."""
    heading = re.split(r"^\[project\]$", text, maxsplit=1, flags=re.MULTILINE)[1]
    return tomllib.loads(Template(first(heading)).substitute(fields) if fields else first(heading))


def first(text: str) -> str:
    """What stands before the next table."""
    return re.split(r"^\[", text, maxsplit=1, flags=re.MULTILINE)[0]
