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

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import BeforeValidator, Field, model_validator

from tmm_sheets import spelling, toml_file
from tmm_sheets.compare.elements import ElementView
from tmm_sheets.compare.placing import Placing
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.task import messages
from tmm_sheets.task.schema import Table
from tmm_sheets.words import marked, tell, tell_n


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


def _points(value: Any) -> tuple[complex, ...]:
    pairs = [p for p in value if isinstance(p, list) and len(p) == 2 and all(map(_finite, p))] if isinstance(value, list) else []
    if not pairs or len(pairs) < len(value):
        raise ValueError(tell("expected points [[x, y], [x, y]]"))
    return tuple(complex(x, y) for x, y in pairs)


def _positive(value: Any) -> float:
    if not _finite(value) or value <= 0:
        raise ValueError(tell("expected a positive number"))
    return float(value)


def _finite(x: Any) -> bool:
    return isinstance(x, int | float) and not isinstance(x, bool) and isfinite(x)


class ViewTable(Table):
    """``[[view]]``: the place of one view."""

    name: str = Field(description=marked("the title of a view of the sheet"))
    ours: Annotated[Any, BeforeValidator(_points)] = Field(description=marked("points [[x, y], [x, y]]"))
    theirs: Annotated[Any, BeforeValidator(_points)] = Field(description=marked("points [[x, y], [x, y]]"))
    mu: Annotated[float, BeforeValidator(_positive)] | None = None

    @model_validator(mode="after")
    def _two_points(self) -> Self:
        ours, theirs = self.ours, self.theirs
        if len(ours) != len(theirs):
            said = tell_n("{n} point, ours has {ours}", "{n} points, ours has {ours}", len(theirs))
            raise ValueError(said.format(n=len(theirs), ours=len(ours)))
        if len(ours) != 2 and not (len(ours) == 1 and self.mu is not None):
            said = tell_n("{n} point given, expected two (or one with mu)", "{n} points given, expected two (or one with mu)",
                          len(ours))
            raise ValueError(said.format(n=len(ours)))
        if len(ours) == 2 and (abs(ours[1] - ours[0]) < 1 or theirs[0] == theirs[1]):
            raise ValueError(tell("the two points are one"))
        return self


class ViewsTable(Table):
    """A whole file of places."""

    view: tuple[ViewTable, ...] = Field(min_length=1, description=marked("tables [[view]] with name, ours and theirs"))


def read(path: Path, views: Sequence[ElementView]) -> tuple[StatedViewPlace, ...]:
    """Read a file of places.

    Raises
    ------
    BadInput
        If it cannot be read, names a view the sheet does not have, or lacks points; it tells every problem.
    """
    whole, lines = messages.read(ViewsTable, path)
    found: dict[ElementView, StatedViewPlace] = {}
    problems: list[Problem] = []
    for k, table in enumerate(whole.view):
        view = _named(table.name, views)
        if view is None:
            names = [v.name for v in views]
            near = spelling.near(table.name, names, 3, 0.4)
            problems.append(toml_file.problem(
                str(path), lines, ("view", k, "name"), tell('the sheet has no view "{view}"').format(view=table.name),
                tell("it has {views}").format(views=", ".join(f'"{n}"' for n in near or names))))
        elif view in found:
            problems.append(Problem(tell('view "{view}" is given twice').format(view=view.name), str(path)))
        else:
            found[view] = StatedViewPlace(view, table.ours, table.theirs, table.mu)
    if problems:
        raise BadInput(problems)
    return tuple(found.values())


def _named(name: str, views: Sequence[ElementView]) -> ElementView | None:
    """The view of that name, or the only one whose title begins so; spaces and case do not matter."""
    wanted = _plain(name)
    whole = [v for v in views if _plain(v.name) == wanted]
    begin = [v for v in views if wanted and _plain(v.name).startswith(wanted)]
    return (whole or begin)[0] if whole or len(begin) == 1 else None


def _plain(text: str) -> str:
    return "".join(text.split()).casefold()
