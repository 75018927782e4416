"""What a given number may be, asked of the schema of the project file itself, and the unit that the file has it in."""

from __future__ import annotations

import re
from collections.abc import Mapping
from copy import deepcopy
from functools import reduce
from operator import getitem
from typing import TYPE_CHECKING, Any

from tmm_sheets.task import units
from tmm_sheets.task.toml_lines import KeyPath

if TYPE_CHECKING:
    from tmm_sheets.task.variant import Variant

WIDEST = 4.0
"""A slider goes no farther than so many times the project's own number."""
HALVINGS = 7


def path_of(name: str) -> KeyPath:
    """Keys of a given number in the project file."""
    return tuple(int(part) if part.isdigit() else part for part in re.findall(r"[^.\[\]]+", name))


def slider(variant: Variant, lines: Mapping[KeyPath, int], name: str) -> dict[str, Any]:
    """Line of a given number, its unit with the factor to SI, and limits of what the schema takes, SI; nothing of one left out.

    ``low`` and ``high`` are told where there are any.
    """
    path = path_of(name)
    if path not in lines:
        return {}
    told: dict[str, Any] = {"line": lines[path]}
    try:
        written = reduce(getitem, path, variant.data)  # type: ignore[arg-type]
    except (KeyError, IndexError, TypeError):
        return told
    number, unit = units.split(written[0] if isinstance(written, list) and written else written)
    factor = units.si(f"1 {unit}") if unit else 1.0
    if not number or not factor:
        return told
    told |= {"shown": [unit, factor]} if unit else {}
    if isinstance(written, list):
        return told
    own = units.si(number)

    def taken(x: float) -> bool:
        """Whether the schema takes a number."""
        data = deepcopy(variant.data)
        place = reduce(getitem, path[:-1], data)  # type: ignore[arg-type]
        place[path[-1]] = f"{x!r} {unit}" if unit else x  # type: ignore[index]
        try:
            type(variant).model_validate(data)
        except ValueError:
            return False
        return True

    def end(far: float) -> float | None:
        """Where the schema ends between the own number and a far one."""
        if taken(far):
            return None
        near = own
        for _ in range(HALVINGS):
            middle = (near + far) / 2
            near, far = (middle, far) if taken(middle) else (near, middle)
        return near

    low = 0.0 if taken(0.0) and not taken(-max(abs(own), 1.0)) else end(-abs(own))
    high = end(WIDEST * own) if own > 0 else None
    return told | {key: x * factor for key, x in (("low", low), ("high", high)) if x is not None}
