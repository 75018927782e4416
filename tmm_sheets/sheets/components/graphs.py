"""Diagrams over an axis on a sheet: axes, headings, numbers of positions, cells of the tables beside them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import floor, inf, log10
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tmm_sheets.drawing.canvas import SMALLEST, Canvas
from tmm_sheets.drawing.lettering import letter, size_for
from tmm_sheets.drawing.marks import Box, PlacedFrame, Points
from tmm_sheets.drawing.paper import A1
from tmm_sheets.errors import CannotBuild
from tmm_sheets.numbers import fixed
from tmm_sheets.words import tell, tr

Floats = NDArray[np.float64]
Options = dict[str, Any]
OVER = 8.0
"""How far an axis runs beyond its graph, mm."""
HEAD = 9.0
"""Room of a heading on one line, mm."""


@dataclass(frozen=True)
class Graph:
    """A diagram on the sheet: ``origin`` of its axes and their direction (1, or -1j when turned clockwise)."""

    origin: complex
    turn: complex = 1

    def __call__(self, p: ArrayLike) -> Any:
        """Points of the sheet of points of the diagram, mm, complex, in their shape."""
        return self.origin + self.turn * np.asarray(p)

    def place(self, along: float = 1.0, across: float = 1.0) -> PlacedFrame:
        """Where a plan with these scale factors of its abscissae and ordinates lies on the sheet; 1 for a plan in millimetres."""
        return PlacedFrame(-1, "", "", self.origin, (along, across), float(np.angle(self.turn)))


def one(values: ArrayLike) -> float:
    """The only number of an array."""
    return float(np.asarray(values).reshape(-1)[0])


def check_room(box: Box, view: str, top: float = -inf, right: float = -inf) -> None:
    """Refuse a place that ends below or to the left of what has to be drawn."""
    for lack, said in ((top - box.y1, tell("view {view} needs {lack:.0f} mm more height than its place has")),
                       (right - box.x1, tell("view {view} needs {lack:.0f} mm more width than its place has"))):
        if lack > 0.5:
            raise CannotBuild(said.format(view=view, lack=lack), tell("make its box in the arrangement larger"))


def heading(canvas: Canvas, box: Box, options: Options, title: str, factor: str, under: str = "") -> None:
    """Title and scale factor on one line over the angle axis: the left column has no height to give away.

    A long one begins at the left of the axis, under the turned designation. ``under`` is said of the graph's ordinates right
    beneath.
    """
    turned = A1.designation
    left = box.x0 if box.y1 < turned.y0 else max(box.x0, min(turned.x1 + 4.0, options["axis"]))
    for size, x0 in ((5.0, options["axis"]), (5.0, left), (3.5, left), (2.5, left)):
        name, scale = letter(title, size), letter(factor, size)
        if x0 + name.width + scale.width + 8 <= box.x1:
            break
    start = (x0 + box.x1 - name.width - scale.width - 8) / 2
    canvas.put(name, complex(start, box.y1 - 6.0))
    canvas.text(complex(start + name.width + 8, box.y1 - 6.0), factor, size)
    if under:
        middle = (options["axis"] + box.x1) / 2
        canvas.text(complex(middle, box.y1 - 12.5), under, size_for([under], box.x1 - options["axis"] - 4.0, 3.5), "centre")


def begin(canvas: Canvas, box: Box, options: Options, heads: tuple[str, ...], low: float, high: float, below: float,
          view: str) -> Graph:
    """A graph of a column with its heading: axes in a place so that the ordinates ``low`` .. ``high``, mm, find room.

    ``heads`` are title, scale factors and what is said under them, ``below`` the room under the lowest ordinate, mm.
    """
    heading(canvas, box, options, *heads)
    g = Graph(complex(options["axis"], box.y0 + below - low))
    check_room(box, view, g.origin.imag + high + HEAD)
    return g


def axes(canvas: Canvas, g: Graph, length: float, low: float, high: float, ordinate: str) -> None:
    """Angle axis of a length and ordinate axis over a range, mm, with their signs."""
    canvas.arrow(g(0j), g(length + OVER), "axis", 3.0)
    canvas.label(complex(g(length + OVER)) - 5.0, tr("{symbol}, rad").format(symbol="φ_1"), -1j, 3.5, 1.5, leader=False)
    canvas.arrow(g(1j * (low - 3 if low else 0)), g(1j * (high + OVER)), "axis", 3.0)
    canvas.text(complex(g(1j * (high + OVER))) - 2.0 - 2.5j, ordinate, 3.5, "right")


def numbers(canvas: Canvas, g: Graph, x: Floats, labels: Sequence[str], heights: Floats) -> None:
    """Numbers of the positions along the angle axis, on the side where the graph is not: of one height, that their distance allows.

    ``x`` and ``heights`` are abscissae and ordinates of the graph at them, mm, of shape (labels,).
    What else is drawn they make way for, see :mod:`~tmm_sheets.drawing.placing`.
    """
    gaps = np.concatenate(([np.inf], np.diff(x), [np.inf]))
    size = 3.5 if np.ptp(x) >= (letter("00", 3.5).width + 2.0) * (len(x) - 1) else SMALLEST
    for abscissa, name, height, pitch in zip(x, labels, heights, np.minimum(gaps[1:], gaps[:-1]), strict=True):
        at, width = complex(g(abscissa)), letter(name, size).width
        canvas.line(at - 0.8j, at + 0.8j, "axis")
        below = -1j * (1.5 + size)
        shift = -1.5 - width + below if abscissa == 0 else -width / 2 + below if height > 1e-9 else 1.2 + 1.3j
        canvas.number(at, at + shift, name, size, float(pitch), first=bool(abscissa == 0))


def dense(curve: Points) -> Points:
    """Points along a curve, no farther apart than a third of a millimetre."""
    way = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(curve)))))
    return np.interp(np.arange(0.0, way[-1], 0.3), way, curve) if way[-1] > 0 else curve


def ranged(labels: list[str]) -> str:
    """Numbers of neighbouring positions: 7, 8 or 7–10."""
    return f"{labels[0]}–{labels[-1]}" if len(labels) > 2 else ", ".join(labels)


def in_ranges(labels: Sequence[str] | Mapping[int, str], numbers: Sequence[int]) -> str:
    """Labels of rising ``numbers``, neighbours as a range: 1, 7–10."""
    starts = [i for i, n in enumerate(numbers) if not i or numbers[i - 1] != n - 1]
    return ", ".join(ranged([labels[n] for n in numbers[a:b]]) for a, b in pairwise([*starts, len(numbers)]))


def column(values: Sequence[float] | Floats, digits: int = 4, least: int = 0) -> list[str]:
    """Numbers of a column, all with the same decimals: ``digits`` significant ones for the largest, ``least`` decimals at least."""
    largest = float(np.max(np.abs(values)))
    decimals = max(least, digits - 1 - floor(log10(largest))) if largest > 0 else 0
    return [fixed(float(v), decimals) for v in values]


def row(name: str, values: Sequence[float] | Floats) -> list[str]:
    """One row of a table, all numbers with the same decimals: four significant digits for the largest, three in a long row.

    Small numbers are written enlarged, the power of ten stands in the name before its unit.
    """
    largest = float(np.max(np.abs(values)))
    order = floor(log10(largest)) if largest > 0 else 0
    if order < -1:
        power = 3 * -(order // 3)
        name, values, order = name.replace(",", f"·10^{{{power}}},", 1), np.asarray(values) * 10.0**power, order + power
    decimals = max(0, (3 if len(values) <= 13 else 2) - order)
    return [name, *(fixed(float(v), decimals) for v in values)]
