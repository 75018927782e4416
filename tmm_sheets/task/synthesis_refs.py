"""Lengths of a project file that are written as results of its ``[synthesis]``: ``"synthesis l_AB"``, ``"0.5 synthesis l_CD"``.

Works on the raw tables, before they are read: every such text is replaced by the length found.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

from tmm_sheets.task.toml_lines import Found, KeyPath
from tmm_sheets.words import tell

_WRITTEN = re.compile(r"(?P<sign>-?)\s*(?:(?P<part>[0-9]+(?:[.,][0-9]+)?)\s*[*·]?\s*)?synthesis(?:\s+(?P<name>\S+))?")

PLACES: dict[tuple[str | int, str | int], str] = {("crank", "length"): "l_AB", ("group", "length"): "l_BC"}
"""Places whose length is plain without its name."""


def uses(data: Any, path: KeyPath = ()) -> Iterator[tuple[KeyPath, re.Match[str]]]:
    """Paths of all lengths that are to be found by synthesis."""
    if isinstance(data, str):
        if match := _WRITTEN.fullmatch(data.strip()):
            yield path, match
    elif isinstance(data, dict):
        for key, value in data.items():
            if path or key not in ("project", "title_block", "note", "synthesis"):
                yield from uses(value, (*path, key))
    elif isinstance(data, list):
        for i, value in enumerate(data):
            yield from uses(value, (*path, i))


def filled(data: dict[str, Any], lengths: Mapping[str, float] | None) -> tuple[dict[str, Any], list[Found]]:
    """The tables with the lengths in place, and what is wrong; ``lengths`` None stands for conditions that are wrong themselves."""
    result, problems = _copy(data), []
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
        _put(result, path, f"{length:.15g} m")
    return result, problems


def share(match: re.Match[str]) -> float:
    """What part of the length is meant, with its sign: -0.5 of "-0.5 synthesis l_CD"."""
    return float(match["sign"] + (match["part"] or "1").replace(",", "."))


def _copy(value: Any) -> Any:
    if isinstance(value, dict):
        return {k: _copy(v) for k, v in value.items()}
    return [_copy(v) for v in value] if isinstance(value, list) else value


def _put(data: Any, path: KeyPath, text: str) -> None:
    for part in path[:-1]:
        data = data[part]
    data[path[-1]] = text
