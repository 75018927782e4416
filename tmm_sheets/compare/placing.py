"""Where a drawing, or a view of it, lies; what of the sheet keeps its size there, and what leads to other views.

The file of --views tells where the views of a sheet are in a photograph or CAD drawing with another layout.

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

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from math import isfinite
from pathlib import Path
from typing import Annotated, Any, NamedTuple, Self

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

from tmm_sheets import spelling, toml_file
from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, ElementView, grouped
from tmm_sheets.drawing.marks import Fill, Line, Mark, Points, Role, moved as moved_mark
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.task import messages, units
from tmm_sheets.task.schema import Table
from tmm_sheets.task.values import positive
from tmm_sheets.words import marked, tell, tell_n

BEYOND = 15.0
"""How far such a line must reach beyond everything else in its view, mm."""
LEADING: frozenset[Role] = frozenset({"construction", "axis"})
"""Roles of lines that may do so."""


def links(elements: Sequence[Element]) -> frozenset[int]:
    """Numbers of the elements that lead out of their views."""
    staying = grouped((e for e in elements if e.view.n and e.role not in LEADING), lambda e: e.view)
    boxes = {view: Box.around(np.concatenate([e.points for e in some])) for view, some in staying.items()}
    return frozenset(e.number for e in elements if e.kind == "line" and e.role in LEADING and e.view in boxes
                     and not all(boxes[e.view].contains(complex(z), BEYOND) for z in e.points))


SAME = 0.02
"""A view whose size is off by less than this share is drawn to our scale."""
HINGE, SYMBOL = 2.6, 15.0
"""Circles up to this radius, and other elements up to this extent, are drawn as large in every scale, mm."""
BESIDE = 8.0
"""Ink this near to a symbol of a view in another scale may be the symbol, mm."""
SIGNS: frozenset[Role] = frozenset({"symbol", "point", "axis", "table"})
"""Roles of what is: bodies of sliders, marks of points, ticks, cells. A short vector, link or helper line is not."""


class Placing(NamedTuple):
    """Takes a point ``z``, first reflected in the x axis if ``mirrored``, to ``turn * z + shift``.

    It takes a drawing to the sheet, or a view of the sheet to where somebody has drawn it.
    """

    turn: complex = 1 + 0j
    shift: complex = 0j
    mirrored: bool = False

    def __call__(self, z: Any) -> Any:
        """The point on the sheet, mm, of a point of the drawing."""
        return self.turn * (np.conj(z) if self.mirrored else z) + self.shift

    def back(self, z: Any) -> Any:
        """The point of the drawing of a point on the sheet."""
        z = (z - self.shift) / self.turn
        return np.conj(z) if self.mirrored else z

    def inverse(self) -> Placing:
        """The placing that takes the sheet to the drawing."""
        turn = np.conj(1 / self.turn) if self.mirrored else 1 / self.turn
        shift = np.conj(self.shift) if self.mirrored else self.shift
        return Placing(complex(turn), complex(-turn * shift), self.mirrored)

    @property
    def scale(self) -> float:
        """Millimetres of the sheet per unit of the drawing."""
        return abs(self.turn)

    @property
    def degrees(self) -> float:
        """Angle by which the drawing has to be turned, -180 .. 180."""
        return float(np.degrees(np.angle(self.turn)))

    @property
    def scaled(self) -> bool:
        """Whether it changes sizes noticeably."""
        return abs(self.scale - 1) > SAME

    def unscaled(self, fixed: complex) -> Placing:
        """The turn that takes ``fixed`` where this placing does."""
        turn = self.turn / self.scale
        return Placing(turn, complex(self(fixed)) - turn * fixed)

    def after(self, first: Placing) -> Placing:
        """The placing that does ``first`` and then this one."""
        turn = np.conj(first.turn) if self.mirrored else first.turn
        shift = np.conj(first.shift) if self.mirrored else first.shift
        return Placing(complex(self.turn * turn), complex(self.turn * shift + self.shift), self.mirrored != first.mirrored)


def moved(e: Element, by: Placing) -> Element:
    """An element where a placing, without mirror, has it; symbols, arrow heads and lettering keep their size.

    A symbol of a view in another scale (the block of a slider, a support) becomes a hatching: it is drawn as large as ever, but
    which of its points stays in place is up to whoever draws it, so it is not measured. A dimension is not either, as it may stand
    anywhere, but it grows with what it tells the size of.
    """
    size, angle = by.scale, float(np.angle(by.turn))
    if by.scaled and (e.kind == "text" or (e.kind == "circle" and e.radius <= HINGE)):
        by, size = by.unscaled(complex(e.points.mean()) if e.kind == "text" else e.centre), 1.0
    elif by.scaled and symbol(e):
        if e.role != "dimension":
            by, size = by.unscaled(e.middle), 1.0
        e = replace(e, kind="hatch", pieces=e.pieces or (e.points,))
    marks = tuple(mark._replace(points=_head(np.asarray(mark.points), by)) if isinstance(mark, Fill) else
                  moved_mark(mark, by.shift, by.turn) for mark in e.marks)
    if by.scaled and e.arrow and e.kind == "line":
        marks = shafts(e.marks, marks, e.points, by(e.points))
    return replace(
        e, points=by(e.points), centre=complex(by(e.centre)), radius=e.radius * size, start=e.start + angle, end=e.end + angle,
        height=e.height * size, angle=e.angle + angle, fills=tuple(_head(f, by) for f in e.fills),
        pieces=tuple(by(p) for p in e.pieces), marks=marks,
    )  # fmt: skip


def shafts(marks: Iterable[Mark], moved: Iterable[Mark], was: Points, now: Points) -> tuple[Mark, ...]:
    """The moved marks of a line between two points, its shafts as far short of the ends as they were: heads keep their size."""
    along = now[-1] - now[0]
    turn = along / (was[-1] - was[0]) * abs(was[-1] - was[0]) / abs(along)

    def end(z: complex, k: int) -> complex:
        return complex(now[k] + (z - was[k]) * turn)

    def shaft(m: Line) -> Line:
        # In a short arrow the shaft may end nearer to the tail than to the tip.
        first = 0 if ((m.b - m.a) * np.conj(was[-1] - was[0])).real > 0 else -1
        a, b = end(m.a, first), end(m.b, -1 - first)
        backwards = ((b - a) * np.conj((m.b - m.a) * turn)).real <= 0  # there is no room for the head
        return m._replace(a=complex(now[0]), b=complex(now[-1])) if backwards else m._replace(a=a, b=b)

    return tuple(shaft(m) if isinstance(m, Line) else other for m, other in zip(marks, moved, strict=True))


def symbol(e: Element) -> bool:
    """Whether an element is part of a symbol, the same in every scale, or of a dimension, which may stand anywhere."""
    z = e.points
    small = abs(complex(np.ptp(z.real), np.ptp(z.imag))) < SYMBOL
    return e.kind in ("hatch", "fill") or e.role == "dimension" or (small and e.role in SIGNS and e.kind != "circle")


def _head(points: Points, by: Placing) -> Points:
    """A filled area keeps its size and goes with its first point, the tip of an arrow."""
    return np.asarray(by.unscaled(complex(points[0]))(points))


# --- the file of --views --------------------------------------------------------------------------------------------------------


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


def _finite(x: Any) -> bool:
    return isinstance(x, int | float) and not isinstance(x, bool) and isfinite(x)


class ViewTable(Table):
    """``[[view]]``: the place of one view."""

    name: str = Field(description=marked("the title of a view of the sheet"))
    ours: Annotated[Any, BeforeValidator(_points)] = Field(description=marked("points [[x, y], [x, y]]"))
    theirs: Annotated[Any, BeforeValidator(_points)] = Field(description=marked("points [[x, y], [x, y]]"))
    mu: Annotated[float, positive(units.NUMBER, marked("expected a positive number"))] | None = None

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


def read_places(path: Path, views: Sequence[ElementView]) -> tuple[StatedViewPlace, ...]:
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
