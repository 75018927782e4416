"""Schemes filled in: a line of a project file with the values in their places, and behind it where they come from."""

from __future__ import annotations

from collections.abc import Mapping
from string import Template
from typing import Protocol


class Filled(Protocol):
    """A value as it is written, and where it comes from; empty where nothing is to be said of that."""

    @property
    def text(self) -> str:
        """What is written."""

    @property
    def source(self) -> str:
        """Where it comes from."""


def filled(scheme: str, values: Mapping[str, Filled]) -> str:
    """A scheme with its values; behind each line what the numbers on it come from.

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
        written, _, comment = Template(line).substitute({key: values[key].text for key in keys}).partition("#")
        written = written.rstrip()
        sources = [part for part in (comment.strip(), *dict.fromkeys(values[key].source for key in keys)) if part]
        lines.append(f"{written}{'  ' if written and sources else ''}{'# ' if sources else ''}{'; '.join(sources)}")
    return "\n".join(lines) + "\n"
