"""Schemes filled in: a line of a project file with the values in their places, and behind it where they come from."""

from __future__ import annotations

from collections.abc import Mapping
from string import Template
from typing import Protocol

SOURCE = "_source"
"""What the name of a quantity's source ends with."""


class Filled(Protocol):
    """A value as it is written, and where it comes from; empty where nothing is to be said of that."""

    @property
    def text(self) -> str:
        """What is written."""

    @property
    def source(self) -> str:
        """Where it comes from."""


def filled(scheme: str, values: Mapping[str, Filled]) -> str:
    """A scheme with its values; behind each line what the numbers on it come from, unless the line says it, as in ``$l_source``.

    Raises
    ------
    KeyError
        for a name that is none of the values.
    ValueError
        for a sign $ that stands before no name.
    """
    lines = []
    for line in scheme.splitlines():
        keys = Template(line).get_identifiers()
        line = Template(line).substitute({key: values[key].text for key in keys})
        told = any(key.endswith(SOURCE) for key in keys)
        sources = [part for part in dict.fromkeys(values[key].source for key in keys) if part and not told]
        if sources:
            written, _, comment = line.partition("#")
            line = f"{written.rstrip()}  # {'; '.join(filter(None, (comment.strip(), *sources)))}".lstrip()
        lines.append(line)
    return "\n".join(lines) + "\n"
