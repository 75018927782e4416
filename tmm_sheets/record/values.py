"""Values as the record writes them: numbers, [x, y] for complex ones, lists over positions; null where nothing is defined."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from typing import Any

import numpy as np

from tmm_sheets.construction.curve import Curve
from tmm_sheets.construction.given import Given, Over


def written(value: Any) -> Any:
    """A value for JSON."""
    if isinstance(value, complex) and isfinite(value.real) and isfinite(value.imag):  # ends of helper lines: most of all values
        return [value.real, value.imag]
    if isinstance(value, Curve):
        return {name: written(getattr(value, name)) for name in ("x", "y", "left", "right")} | {"law": value.law}
    if isinstance(value, tuple | list):
        return [written(v) for v in value]
    if isinstance(value, str | bool) or value is None:
        return value
    array = np.asarray(value)
    if array.dtype.kind not in "biufc":
        return None  # nothing that a record could hold
    if array.dtype.kind == "c":
        array = np.ascontiguousarray(array, complex).view(float).reshape(*array.shape, 2)
    found = array.tolist()
    return found if array.dtype.kind in "biu" or np.isfinite(array).all() else _defined(found)


def _defined(found: Any) -> Any:
    if isinstance(found, list):
        return [_defined(x) for x in found]
    return found if isfinite(found) else None


def shape(value: Any, positions: int) -> dict[str, Any]:
    """What a value is: "over" none, positions or curve, and the "type" of its numbers."""
    if isinstance(value, Curve):
        return {"over": "curve", "type": "real"}
    if isinstance(value, str):
        return {"over": "none", "type": "choice"}
    array = np.asarray(value)
    over: Over = "none" if not array.ndim else "positions" if array.ndim == 1 and 1 < positions == len(array) else "curve"
    return {"over": over, "type": {"c": "complex", "i": "integer", "u": "integer", "b": "integer"}.get(array.dtype.kind, "real")}


def given(x: Any, positions: int) -> dict[str, Any]:
    """A given number, point or row; a number of the program itself is a constant."""
    if isinstance(x, Given):
        found = {"given": written(x.value), **shape(x.value, positions), **_origin(x)}
        if x.over != "positions":  # what the row itself says of nodes and tables goes before its length
            found["over"] = x.over
        if not x.choice:
            return found
        # Whole numbers and words that a search found; of an angle or a point its own type says how to read it.
        return found | {"criterion": x.choice} | ({"type": "choice"} if found["type"] in ("integer", "choice") else {})
    return {"given": written(x), **shape(x, positions), **_origin(x)}


def _origin(x: Any) -> Mapping[str, str]:
    told = {key: found for key in ("symbol", "unit", "source") if (found := getattr(x, key, ""))}
    return {"name": getattr(x, "name", "constant"), **told}
