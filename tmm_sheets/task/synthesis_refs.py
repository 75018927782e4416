"""Lengths of a project file that are written as results of its ``[synthesis]``: ``"synthesis l_AB"``, ``"0.5 synthesis l_CD"``.

Works on the raw tables, before they are read: every such text is replaced by the length found.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from copy import deepcopy
from functools import reduce
from operator import getitem
from typing import Any

from tmm_sheets.toml_file import Found, KeyPath, nodes
from tmm_sheets.words import tell

_WRITTEN = r"(?P<sign>-?)\s*(?:(?P<part>[0-9]+(?:[.,][0-9]+)?)\s*[*·]?\s*)?synthesis(?:\s+(?P<name>\S+))?"

PLACES: dict[tuple[str | int, str | int], str] = {("crank", "length"): "l_AB", ("group", "length"): "l_BC"}
"""Places whose length is plain without its name."""


def uses(data: dict[str, Any]) -> Iterator[tuple[KeyPath, re.Match[str]]]:
    """Paths of all lengths that are to be found by synthesis."""
    for path, text in nodes(data):
        of_lengths = path[0] not in ("project", "title_block", "note", "synthesis")
        if of_lengths and isinstance(text, str) and "synthesis" in text and (match := re.fullmatch(_WRITTEN, text.strip())):
            yield path, match


def filled(data: dict[str, Any], lengths: Mapping[str, float] | None) -> tuple[dict[str, Any], list[Found]]:
    """The tables with the lengths in place, and what is wrong; ``lengths`` None stands for conditions that are wrong themselves."""
    result, problems = deepcopy(data), []
    for path, match in uses(data):
        name = match["name"] or PLACES.get((path[0], path[-1]), "")
        length = 1.0  # any will do where something is wrong already
        if "synthesis" not in data:
            problems.append(
                (path, tell("there is no [synthesis] to take the length from"), tell("add the table [synthesis] with conditions"))
            )
        elif lengths is not None and name not in lengths:
            known = ", ".join(lengths)
            problems.append(
                (
                    path,
                    tell('unknown result "{name}"').format(name=name) if name else tell("which length of the synthesis?"),
                    tell('its lengths are {known}; write for example "synthesis {name}"').format(
                        known=known, name=next(iter(lengths))
                    ),
                )
            )
        elif lengths is not None:
            length = share(match) * lengths[name]
        reduce(getitem, path[:-1], result)[path[-1]] = f"{length:.15g} m"  # type: ignore[arg-type, index]
    return result, problems


def share(match: re.Match[str]) -> float:
    """What part of the length is meant, with its sign: -0.5 of "-0.5 synthesis l_CD"."""
    return float(match["sign"] + (match["part"] or "1").replace(",", "."))
