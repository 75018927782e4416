"""The file of --views: where the views of a sheet are in a photograph or CAD drawing with another layout.

It is a TOML file with a table for each view that is not in its place::

    [[view]]
    name = "План ускорений (положение 2)"     # its title on our sheet
    ours = [[512.4, 430.0], [561.0, 402.5]]   # two points of it on our sheet, mm from the lower left corner of the paper
    theirs = [[1033, 820], [1180, 741]]       # the same points in the image, pixels from its upper left corner, or in the drawing,
                                              # its units
    mu = 0.02                                 # may be left out: the scale factor the student took for it, in the unit of ours

With ``mu`` one point is enough; a second one then only tells how the view is turned.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, isfinite
from pathlib import Path
from typing import Any

from tmm_sheets import spelling
from tmm_sheets.compare.elements import ElementView
from tmm_sheets.compare.placing import Placing
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.task import toml_file
from tmm_sheets.words import tell, tell_n


@dataclass(frozen=True)
class StatedViewPlace:
    """The place of one view: points of our sheet, mm, and the same points in the image, pixels, or in the drawing, its units."""

    view: ElementView
    ours: tuple[complex, ...]
    theirs: tuple[complex, ...]
    mu: float | None = None

    def placing(self, at: Sequence[complex]) -> Placing:
        """The placing of the view by two points, or one and a scale factor; ``at`` is ``theirs`` laid on our sheet, mm.

        Raises
        ------
        BadInput
            If a scale factor is given for a view that has none of its own on our sheet.
        """
        turn = (at[1] - at[0]) / (self.ours[1] - self.ours[0]) if len(at) == 2 else 1 + 0j
        if self.mu is not None:
            if self.view.mu is None:
                said = tell('view "{view}": our sheet gives it no scale factor of its own to compare mu with')
                raise BadInput(said.format(view=self.view.name), tell("leave mu out and give two points"))
            turn *= self.view.mu / self.mu / abs(turn)
        return Placing(turn, at[0] - turn * self.ours[0])


def read(path: Path, views: Sequence[ElementView]) -> tuple[StatedViewPlace, ...]:
    """Read a file of places.

    Raises
    ------
    BadInput
        If it cannot be read, names a view the sheet does not have, or lacks points; it tells every problem.
    """
    _, data, _ = toml_file.read(path)
    tables = data.get("view")
    if not isinstance(tables, list) or not tables or not all(isinstance(t, dict) for t in tables):
        raise BadInput(Problem(tell("has no [[view]] table"), str(path), field="view",
                               hint=tell("each view needs name, ours = [[x, y], [x, y]], theirs = [[x, y], [x, y]]")))
    problems: list[Problem] = []
    found = [_Table(t, f"view[{k}]", str(path), problems).place(views) for k, t in enumerate(tables, 1)]
    places = tuple(p for p in found if p is not None)
    count = Counter(p.view.name for p in places)
    twice = tell('view "{view}" is given twice')
    problems += [Problem(twice.format(view=name), str(path)) for name in sorted(count) if count[name] > 1]
    if problems:
        raise BadInput(problems)
    return places


@dataclass(frozen=True)
class _Table:
    """One ``[[view]]`` table, called ``field`` in messages; what is wrong with it goes to ``problems``."""

    values: dict[str, Any]
    field: str
    path: str
    problems: list[Problem]

    def place(self, views: Sequence[ElementView]) -> StatedViewPlace | None:
        """The place it gives, None where something is wrong."""
        before = len(self.problems)
        for key in sorted(self.values.keys() - {"name", "ours", "theirs", "mu"}):
            self._wrong(key, tell("is not known here"), tell("a view has name, ours, theirs and mu"))
        view = self._view(views)
        ours, theirs = _points(self.values.get("ours")), _points(self.values.get("theirs"))
        for key, points in (("ours", ours), ("theirs", theirs)):
            if points is None:
                self._wrong(key, tell("expected points [[x, y], [x, y]]"))
        mu = self._mu()
        if ours is not None and theirs is not None:
            self._check_points(ours, theirs, mu)
        if view is None or ours is None or theirs is None or len(self.problems) > before:
            return None
        return StatedViewPlace(view, ours, theirs, mu)

    def _wrong(self, key: str, message: str, hint: str = "") -> None:
        self.problems.append(Problem(message, self.path, field=f"{self.field}.{key}", hint=hint))

    def _view(self, views: Sequence[ElementView]) -> ElementView | None:
        view = _named(self.values.get("name"), views)
        if view is None:
            names = [v.name for v in views]
            near = spelling.near(str(self.values.get("name")), names, 3, 0.4)
            self._wrong("name", tell('the sheet has no view "{view}"').format(view=self.values.get("name")),
                        tell("it has {views}").format(views=", ".join(f'"{n}"' for n in near or names)))
        return view

    def _mu(self) -> float | None:
        mu = self.values.get("mu")
        if mu is None:
            return None
        if not isinstance(mu, int | float) or isinstance(mu, bool) or not 0 < mu < inf:
            self._wrong("mu", tell("expected a positive number, not {value}").format(value=repr(mu)))
            return None
        return float(mu)

    def _check_points(self, ours: Sequence[complex], theirs: Sequence[complex], mu: float | None) -> None:
        if len(ours) != len(theirs):
            said = tell_n("{n} point, ours has {ours}", "{n} points, ours has {ours}", len(theirs))
            self._wrong("theirs", said.format(n=len(theirs), ours=len(ours)))
        elif len(ours) != 2 and not (len(ours) == 1 and mu is not None):
            said = tell_n("{n} point given, expected two (or one with mu)", "{n} points given, expected two (or one with mu)",
                          len(ours))
            self._wrong("ours", said.format(n=len(ours)))
        elif len(ours) == 2 and (abs(ours[1] - ours[0]) < 1 or theirs[0] == theirs[1]):
            self._wrong("ours", tell("the two points are one"), tell("take points far apart"))


def _named(name: Any, views: Sequence[ElementView]) -> ElementView | None:
    """The view of that name, or the only one whose title begins so; spaces and case do not matter."""
    if not isinstance(name, str) or not name.strip():
        return None
    wanted = _plain(name)
    whole = [v for v in views if _plain(v.name) == wanted]
    begin = [v for v in views if _plain(v.name).startswith(wanted)]
    return (whole or begin)[0] if whole or len(begin) == 1 else None


def _plain(text: str) -> str:
    return "".join(text.split()).casefold()


def _points(value: Any) -> tuple[complex, ...] | None:
    """Points given as [[x, y], ...], None where it is anything else."""
    if not isinstance(value, list) or not value:
        return None
    pairs = [p for p in value if isinstance(p, list) and len(p) == 2 and all(map(_number, p))]
    return tuple(complex(x, y) for x, y in pairs) if len(pairs) == len(value) else None


def _number(x: Any) -> bool:
    return isinstance(x, int | float) and not isinstance(x, bool) and isfinite(x)
