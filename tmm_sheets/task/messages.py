"""What is wrong with a value of the project file, said in the words of this project instead of pydantic's."""

from __future__ import annotations

import re
from types import UnionType
from typing import Any, get_args, get_origin

from pydantic_core import ErrorDetails

from tmm_sheets.task.schema import Table
from tmm_sheets.task.toml_lines import KeyPath
from tmm_sheets.task.values import nearest


def said(error: ErrorDetails, whole: type[Table]) -> tuple[KeyPath, str, str]:
    """Path, message and hint of one error of pydantic in the words of this project; ``whole`` is the table of the whole file."""
    path: KeyPath = tuple(p for p in error["loc"] if p != "[key]")
    given = error["input"]
    kind = error["type"]
    if kind == "missing":
        return path, f"missing; expected {_description(whole, path)}", ""
    if kind == "extra_forbidden":
        near, known = nearest(str(path[-1]), _keys(whole, path[:-1]))
        return path, "unknown key", near or f"known here are {known}"
    if kind == "value_error":
        message = str(error["ctx"]["error"])
        if isinstance(given, dict) or " not " in message:
            return path, message, ""
        return path, f"{message}, not {_quoted(given)}", ""
    if kind == "literal_error":
        near, _ = nearest(str(given), [w.strip("'") for w in re.split(r", | or ", error["ctx"]["expected"])])
        return path, f"expected {error['ctx']['expected'].replace(chr(39), chr(34))}, not {_quoted(given)}", near
    if kind in ("tuple_type", "too_short", "too_long"):
        return path, f"expected {_description(whole, path)}", ""
    if kind in ("model_type", "model_attributes_type", "dict_type"):
        return path, f"expected a table, not {_quoted(given)}", f"write it as [{path[0]}] with a line for each key"
    if kind == "string_type":
        return path, f"expected a text in quotes, not {_quoted(given)}", ""
    return path, f"{error['msg']}, not {_quoted(given)}", ""


def _quoted(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, list):
        return "a list"
    return f'"{value}"' if isinstance(value, str) else str(value)


def table_of(annotation: Any) -> type[Table] | None:
    """The table an annotation is about: ``Crank | None``, ``tuple[Guide, ...]``."""
    if isinstance(annotation, type) and issubclass(annotation, Table):
        return annotation
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
    model, key = _fields(whole, path)
    inner = next((f.annotation for n, f in model.model_fields.items() if (f.alias or n) == key), None)
    model = table_of(inner) or model
    return [f.alias or n for n, f in model.model_fields.items()]


def _description(whole: type[Table], path: KeyPath) -> str:
    """What the field at a path is, from the model; a member of ``points`` is what all of them are."""
    for length in range(len(path), 0, -1):
        model, key = _fields(whole, path[:length])
        found = next((f.description for n, f in model.model_fields.items() if (f.alias or n) == key), None)
        if found:
            return found
    return "a value"
