"""The file of --views: where views of a sheet stand in a photograph or a CAD drawing that has a layout of its own.

A TOML file with a table for each view that is not in its place::

    [[view]]
    name = "План ускорений (положение 2)"     # its title on our sheet, or the arrangement's name for it (kinematics.structure)
    ours = [[512.4, 430.0], [561.0, 402.5]]   # two points of it on our sheet, mm from the lower left corner of the paper
    theirs = [[1033, 820], [1180, 741]]       # the same points in the image, pixels from its upper left corner, or in the drawing,
                                              # its units
    mu = 0.02                                 # may be left out: the scale factor the student took for it, in the unit of ours

With ``mu`` one point is enough; of two the second then only says how the view is turned.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from math import inf, isfinite
from pathlib import Path
from typing import Any

from tmm_sheets import texts
from tmm_sheets.compare.elements import Element, View
from tmm_sheets.errors import BadInput, Problem


@dataclass(frozen=True)
class ViewPlace:
    """One view's place: points of our sheet, mm, and the same in the image or drawing; ``mu`` is None when left out."""

    view: View
    ours: tuple[complex, ...]
    theirs: tuple[complex, ...]
    mu: float | None = None


def read(path: Path, views: Sequence[View]) -> tuple[ViewPlace, ...]:
    """Read a file of places.

    Raises
    ------
    BadInput
        When it cannot be read, names a view the sheet does not have, or lacks points; every problem is told.
    """
    try:
        data = tomllib.loads(texts.cleaned(texts.decoded(path.read_bytes()).text))
    except OSError as e:
        raise BadInput(Problem(f"cannot be read: {e.strerror or e}", str(path))) from None
    except (tomllib.TOMLDecodeError, texts.NotText) as e:
        raise BadInput(Problem(str(e), str(path), hint="it is a TOML file with a [[view]] table for each view")) from None
    tables = data.get("view")
    if not isinstance(tables, list) or not tables or not all(isinstance(t, dict) for t in tables):
        raise BadInput(Problem("has no [[view]] table", str(path), field="view",
                               hint="each view needs name, ours = [[x, y], [x, y]], theirs = [[x, y], [x, y]]"))
    problems: list[Problem] = []
    found = [_place(t, f"view[{k}]", str(path), views, problems) for k, t in enumerate(tables, 1)]
    named = [p.view.name for p in found if p is not None]
    problems += [Problem(f'view "{name}" is given twice', str(path)) for name in sorted({n for n in named if named.count(n) > 1})]
    if problems:
        raise BadInput(problems)
    return tuple(p for p in found if p is not None)


def _place(table: dict[str, Any], field: str, path: str, views: Sequence[View], problems: list[Problem]) -> ViewPlace | None:
    before = len(problems)

    def wrong(key: str, message: str, hint: str = "") -> None:
        problems.append(Problem(message, path, field=f"{field}.{key}" if key else field, hint=hint))

    for key in sorted(set(table) - {"name", "ours", "theirs", "mu"}):
        wrong(key, "is not known here", "a view has name, ours, theirs and mu")
    view = _view(table.get("name"), views)
    if view is None:
        names = [v.name for v in views]
        near = get_close_matches(str(table.get("name")), names, n=3, cutoff=0.4)
        wrong("name", f'the sheet has no view "{table.get("name")}"', "it has " + ", ".join(f'"{n}"' for n in near or names))
    ours, theirs = (_points(table.get(key)) for key in ("ours", "theirs"))
    for key, points in (("ours", ours), ("theirs", theirs)):
        if points is None:
            wrong(key, "expected points [[x, y], [x, y]]")
    mu = table.get("mu")
    if mu is not None and (not isinstance(mu, int | float) or isinstance(mu, bool) or not 0 < mu < inf):
        wrong("mu", f"expected a positive number, not {mu!r}")
        mu = None
    if ours is not None and theirs is not None:
        if len(ours) != len(theirs):
            wrong("theirs", f"{len(theirs)} points, ours has {len(ours)}")
        elif len(ours) != 2 and not (len(ours) == 1 and mu is not None):
            wrong("ours", f"{len(ours)} points given, expected two (or one with mu)")
        elif len(ours) == 2 and (abs(ours[1] - ours[0]) < 1 or theirs[0] == theirs[1]):
            wrong("ours", "the two points are one", "take points far apart")
    if len(problems) > before or view is None or ours is None or theirs is None:
        return None
    return ViewPlace(view, ours, theirs, None if mu is None else float(mu))


def _view(name: Any, views: Sequence[View]) -> View | None:
    """The view of that name; spaces and case do not matter, the beginning of one name only is enough."""
    def plain(text: str) -> str:
        return "".join(text.split()).casefold()

    if not isinstance(name, str) or not name.strip():
        return None
    for key in ("name", "draw"):
        for v in views:
            if plain(getattr(v, key)) == plain(name):
                return v
    begin = [v for v in views if plain(v.name).startswith(plain(name))]
    return begin[0] if len(begin) == 1 else None


def _points(value: Any) -> tuple[complex, ...] | None:
    if not isinstance(value, list) or not value:
        return None
    found = []
    for p in value:
        if not isinstance(p, list) or len(p) != 2 or not all(map(_number, p)):
            return None
        found.append(complex(p[0], p[1]))
    return tuple(found)


def _number(x: Any) -> bool:
    return isinstance(x, int | float) and not isinstance(x, bool) and isfinite(x)


def mu_of(view: View, elements: Sequence[Element]) -> float | None:
    """The scale factor that stands under the title of a view: of "μ_l = 0,0025 м/мм" 0.0025; None when there is none or several."""
    found = set()
    for e in elements:
        if e.view == view and e.kind == "text" and "μ" in e.text:
            found |= {float(m.replace(",", ".")) for m in re.findall(r"=\s*(\d+(?:,\d+)?)\s*\D", e.text)}
    return found.pop() if len(found) == 1 else None
