"""The text of a project file with other values at some of its keys, everything else in it as it was; and a text of tables."""

from __future__ import annotations

import pickle
import re
from collections.abc import Iterator, Mapping, MutableMapping
from functools import lru_cache, reduce
from itertools import pairwise
from operator import getitem
from typing import Any

from tmm_sheets.errors import BadInput
from tmm_sheets.task import units
from tmm_sheets.toml_file import DEEPEST, dotted, nodes
from tmm_sheets.words import tell

LONGEST = 100
"""Letters of the longest key, or figures of a place in a list, that is looked for."""


def key_path(name: str) -> tuple[str | int, ...]:
    """Keys on the way to a value, by its name: that of the record, or one that Python takes for the name of an argument.

    >>> key_path("group[0].lengths[1]")
    ('group', 0, 'lengths', 1)
    >>> key_path("group__0__lengths__1")
    ('group', 0, 'lengths', 1)
    """
    parts = re.findall(r"[^.\[\]]+", name.replace("__", "."))
    if len(parts) > DEEPEST or any(len(part) > LONGEST for part in parts):
        return (name, 0)  # which there is nowhere
    return tuple(int(part) if part.isdecimal() else part for part in parts)


def numbers(data: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    """Numbers of the tables of a project file that something is computed from, with their units, by their names."""
    for path, value in nodes(data):
        number, unit = units.split(value)
        if number and path[0] not in ("given", "schema") and (unit == "" or units.quantity_of(unit)):  # [given] is shown only
            yield dotted(path), value


def at(table: Any, name: str) -> Any:
    """What stands at a name in the tables of a project file; None where nothing does."""
    try:
        return reduce(getitem, key_path(name), table)
    except (IndexError, KeyError, TypeError):
        return None


def changed(text: str, changes: Mapping[str, Any]) -> str:
    """The text with these values, by the names of their keys; None takes a key away.

    The comment behind a value says where it is from: a value that is changed has it no more.

    Raises
    ------
    BadInput
        when there is nothing on the way to a key.
    """
    import tomlkit

    document = pickle.loads(_document(text))
    for name, value in changes.items():
        try:
            _set_value(document, key_path(name), value)
        except (IndexError, KeyError, TypeError, ValueError):
            raise BadInput(tell("{name}: there is no such place in the project file").format(name=name),
                           hint=tell("places are named as by why, counted from 0: crank.length, group[0].lengths[1]")) from None
    return tomlkit.dumps(document)


@lru_cache(8)
def _document(text: str) -> bytes:
    """The document of a text, to be copied: whoever tries many values changes one text again and again, and reading it is slow."""
    import tomlkit

    return pickle.dumps(tomlkit.parse(text))


def _set_value(document: Any, path: tuple[str | int, ...], value: Any) -> None:
    place = document
    for part, after in pairwise(path):
        if isinstance(place, MutableMapping):
            table, line = place, part
            if isinstance(after, str):
                place.setdefault(part, {})
        place = place[part]
    key = path[-1]
    if value is None:
        del place[key]
        return
    if isinstance(key, int) and key == len(place):
        place.append(_plain(value))
    else:
        place[key] = _plain(value)
    if isinstance(place, MutableMapping):
        table, line = place, key
    if (trivia := getattr(table[line], "trivia", None)) is not None:
        trivia.comment = trivia.comment_ws = ""


def written(tables: Mapping[str, Any]) -> str:
    """A project file of these tables.

    Raises
    ------
    BadInput
        for a value that TOML has none for.
    """
    import tomlkit

    return tomlkit.dumps(_plain(tables))


def _plain(value: Any) -> Any:
    """Lists, tables and numbers that TOML has, of whatever Python has of them."""
    if isinstance(value, Mapping):
        return {str(key): _plain(inner) for key, inner in value.items() if inner is not None}
    if hasattr(value, "tolist"):  # of numpy
        return _plain(value.tolist())
    if isinstance(value, list | tuple):
        return [_plain(inner) for inner in value]
    if isinstance(value, str | int | float):
        return value
    raise BadInput(tell("no project file can hold {value}").format(value=repr(value)))
