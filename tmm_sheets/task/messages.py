"""What is wrong with a value of the project file, said in the words of this project instead of pydantic's."""

from __future__ import annotations

import re
from pathlib import Path
from types import UnionType
from typing import Any, TypeVar, get_args, get_origin

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from tmm_sheets import toml_file
from tmm_sheets.errors import BadInput
from tmm_sheets.task.schema import PaperTable, Seldom, Table, TitleBlockTable
from tmm_sheets.task.units import Refused, shown
from tmm_sheets.task.values import meant
from tmm_sheets.toml_file import KeyPath, TomlLines
from tmm_sheets.words import either, marked, tell

T = TypeVar("T", bound=Table)


class SettingsTable(Table):
    """A whole settings file, see :mod:`~.title_entries`."""

    title_block: TitleBlockTable = TitleBlockTable.model_construct()
    paper: PaperTable = PaperTable.model_construct()


def read(whole: type[T], path: Path, hint: str = "") -> tuple[T, TomlLines]:
    """The table that a whole file is, and where its keys stand; ``hint`` is told where there is no such file.

    Raises
    ------
    BadInput
        with everything that is wrong in it, by line and key.
    """
    _, data, lines = toml_file.read(path, hint)
    try:
        return whole.model_validate(data), lines
    except ValidationError as e:
        raise BadInput(toml_file.problem(str(path), lines, *said(error, whole)) for error in e.errors()) from None


def said(error: ErrorDetails, whole: type[Table]) -> tuple[KeyPath, str, str]:
    """Path, message and hint of one error of pydantic in the words of this project; ``whole`` is the table of the whole file."""
    path: KeyPath = tuple(p for p in error["loc"] if p != "[key]")
    given = error["input"]
    kind = error["type"]
    if kind == "missing":
        return path, tell("missing; expected {what}").format(what=_description(whole, path)), ""
    if kind == "extra_forbidden":
        near, known = meant(str(path[-1]), _keys(whole, path[:-1]))
        return path, tell("unknown key"), near or tell("known here are {known}").format(known=known)
    if kind == "value_error":
        refusal = error["ctx"]["error"]
        if isinstance(given, dict) or isinstance(refusal, Refused):
            return path, str(refusal), ""
        return path, tell("{expected}, not {given}").format(expected=refusal, given=_quoted(given)), ""
    if kind == "literal_error":
        near, _ = meant(str(given), [w.strip("'") for w in re.split(r", | or ", error["ctx"]["expected"])])
        words = [f'"{w[1:-1]}"' if w[:1] == "'" else w for w in re.split(r", | or ", error["ctx"]["expected"])]
        return path, tell("expected {what}, not {given}").format(what=either(words), given=_quoted(given)), near
    if kind in ("tuple_type", "too_short", "too_long"):
        return path, tell("expected {what}").format(what=_description(whole, path)), _commas(error)
    expected, hint = _OF_TYPES.get(kind, (f"{error['msg']}: {{given}}", ""))
    return path, tell(expected).format(given=_quoted(given)), tell(hint).format(table=path[0])


_TABLE = (marked("expected a table, not {given}"), marked("write it as [{table}] with a line for each key"))
_OF_TYPES = {
    **dict.fromkeys(("model_type", "model_attributes_type", "dict_type"), _TABLE),
    "string_type": (marked("expected a text in quotes, not {given}"), ""),
    **dict.fromkeys(("bool_type", "bool_parsing"), (marked("expected true or false, not {given}"), "")),
}
"""What is said, with a hint, where a value is of another type: by pydantic's names of errors."""


def _commas(error: ErrorDetails) -> str:
    """A hint where decimal commas made two numbers of each: ``[0,5, 0,3]``."""
    given, most = error["input"], error.get("ctx", {}).get("max_length", 0)
    if not isinstance(given, list) or len(given) != 2 * most or not all(type(n) is int for n in given):
        return ""
    meant = ", ".join(f"{whole}.{decimals}" for whole, decimals in zip(given[::2], given[1::2], strict=True))
    return tell("write {what}").format(what=f"[{meant}]")


def _quoted(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else f'"{value}"' if isinstance(value, str) else shown(value)


def table_of(annotation: Any) -> type[Table] | None:
    """The table an annotation is about: ``Crank | None``, ``tuple[Guide, ...]``."""
    if isinstance(annotation, type) and issubclass(annotation, Table | Seldom):
        return annotation.table() if issubclass(annotation, Seldom) else annotation
    if get_origin(annotation) in (UnionType, tuple):
        return next(filter(None, map(table_of, get_args(annotation))), None)
    return None


def _fields(whole: type[Table], path: KeyPath) -> tuple[type[Table], str]:
    """Model and key that a path ends in."""
    model = whole
    keys = [p for p in path if isinstance(p, str)]
    for key in keys[:-1]:
        inner = next((f.annotation for n, f in model.model_fields.items() if (f.alias or n) == key), None)
        model = table_of(inner) or model
    return model, keys[-1] if keys else ""


def _keys(whole: type[Table], path: KeyPath) -> list[str]:
    """Keys of the table at a path."""
    model, _ = _fields(whole, (*path, ""))
    return [f.alias or n for n, f in model.model_fields.items()]


def _description(whole: type[Table], path: KeyPath) -> str:
    """What the field at a path is, from the model; a member of ``points`` is what all of them are."""
    for length in range(len(path), 0, -1):
        model, key = _fields(whole, path[:length])
        found = next((f.description for n, f in model.model_fields.items() if (f.alias or n) == key), None)
        if found:
            return tell(found)
    return tell("a value")
