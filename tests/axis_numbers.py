"""Numbers of positions at the axes of graphs on finished sheets: does a line run through them?

Usage: python -m tests.axis_numbers [PROJECT ...]; without names all shipped projects; a name that ends in .toml is a file.

Judged from the drawing alone. A number stands within ``BESIDE`` of a level axis, or bears a prime and stands by an upright one;
it is struck where any line enters the rectangle of its figures, ``TOUCH`` mm narrower on each side.
"""

from __future__ import annotations

import re
import sys
from typing import NamedTuple

import numpy as np

from tests.gallery import names
from tmm_sheets import catalogue
from tmm_sheets.drawing import ink_index
from tmm_sheets.drawing.ink import interrupted
from tmm_sheets.drawing.marks import Box, Line, Text
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.project import Project
from tmm_sheets.sheets import sheet

GRAPHS = ("flywheel.", "mertsalov.", "diagrams.", "cam.motion", "crank_speed.", "load_diagram.")
NUMBER = re.compile(r"\d+[a-z]?([′'](, \d+[a-z]?[′'])*)?(, \d+|–\d+)*")
BESIDE, LONG = 9.0, 30.0
"""Distance of a number from its axis, and how long an axis is at least, mm."""
TOUCH = 0.2


class Number(NamedTuple):
    """A number at an axis; ``struck`` tells the line types that run through it."""

    text: str
    box: Box
    struck: tuple[str, ...]
    primed: bool


def of_sheet(composed):
    """All numbers at the axes of the graphs of a finished sheet."""
    drawing = composed.drawing
    ink = ink_index.InkIndex(m for mark in drawing.marks for m in interrupted(mark))  # as they are drawn: lines yield to lettering
    found = []
    for n in sorted({n for view in drawing.views for a, b in view.spans for n in range(a, b)}):
        mark = drawing.marks[n]
        if isinstance(mark, Text) and not mark.angle and NUMBER.fullmatch(mark.text) and _of_graph(composed, n):
            z = text_box(mark)
            box = Box(z.real.min(), mark.at.imag, z.real.max(), z.imag.max())
            primed = "′" in mark.text or "'" in mark.text
            if _at_axis(composed, box, upright=primed):
                inner = box.inset(TOUCH, TOUCH, TOUCH, TOUCH)
                near = ink.near(inner, 0.0)
                over = near[ink_index.enters(ink.a[near], ink.b[near] - ink.a[near], *inner)]
                styles = tuple(sorted({ink.marks[k].style for k in ink.of[over]}))
                found.append(Number(mark.text, box, styles, primed))
    return found


def _part(composed, n):
    """Number of the part that a mark belongs to."""
    if n >= composed.parts[-1].first:
        return next((group.part for group in composed.groups if group.first <= n < group.end), -1)
    return max(k for k, part in enumerate(composed.parts) if part.first <= n)


def _of_graph(composed, n):
    k = _part(composed, n)
    return k >= 0 and composed.parts[k].draw.startswith(GRAPHS)


def _at_axis(composed, box, *, upright):
    turn = -1j if upright else 1  # an upright axis turned level
    corners = np.array([complex(box.x0, box.y0), complex(box.x1, box.y1)]) * turn
    x, y = np.sort(corners.real), np.sort(corners.imag)
    for m in composed.drawing.marks:
        if isinstance(m, Line) and m.style == "axis" and m.by is not None and m.by.role == "axis":
            a, b = sorted((m.a * turn, m.b * turn), key=lambda z: z.real)
            level = abs((b - a).imag) < 1e-6 and b.real - a.real > LONG
            if level and a.real - BESIDE < x[1] and b.real + BESIDE > x[0] and y[0] - BESIDE < a.imag < y[1] + BESIDE:
                return True
    return False


def of_project(name):
    """Numbers of all sheets of a project, with the sheet of each."""
    project = Project(catalogue.read(name))
    return [(n, number) for n in range(1, len(project.sheets) + 1) for number in of_sheet(sheet.composed(project, n))]


def main(args):
    files = [a for a in args if a.endswith(".toml")]
    struck = primes = total = 0
    for name in files + (names([a for a in args if a not in files]) if len(files) < len(args) or not args else []):
        try:
            numbers = of_project(name)
        except Exception as e:
            print(f"{name}: {type(e).__name__}: {e}")
            continue
        for n, number in numbers:
            if number.struck:
                at = f"({number.box.x0:.0f}, {number.box.y0:.0f})"
                print(f"{name} {n}  {number.text:8} {at}  {', '.join(number.struck)}", flush=True)
        total += len(numbers)
        struck += sum(bool(number.struck) and not number.primed for _, number in numbers)
        primes += sum(bool(number.struck) and number.primed for _, number in numbers)
    print(f"{total} numbers at axes, {struck} struck; besides {primes} with a prime")
    return struck


if __name__ == "__main__":
    sys.exit(bool(main(sys.argv[1:])))
