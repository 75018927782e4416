"""Labels of finished sheets: do they read as what they name? ``python -m tests.labels [PROJECT ...]``.

For every label: its own line or point is nearer than any other and the shortest way there crosses nothing, or it has a leader; it
covers no line thicker than 0.25 mm. See :mod:`tmm_sheets.drawing.owners`.
"""

from __future__ import annotations

import sys
from collections import Counter
from multiprocessing import Pool
from typing import NamedTuple

from tests.gallery import names
from tmm_sheets import catalogue
from tmm_sheets.drawing import labels as placing
from tmm_sheets.drawing import owners
from tmm_sheets.drawing.canvas import Label
from tmm_sheets.drawing.marks import Arc, Box, Line
from tmm_sheets.drawing.styles import line_type
from tmm_sheets.project import Project
from tmm_sheets.sheets import sheet

THICK = 0.25


class Placed(NamedTuple):
    """A label as it was set."""

    label: Label
    box: Box
    leader: bool


class Fault(NamedTuple):
    """What is wrong with a label."""

    sheet: str
    view: str
    text: str
    at: complex
    what: str


def judged(project, n):
    """Faults of the labels of a sheet, and how many labels it has."""
    kept = []
    original = placing._set

    def keeping(canvas, grid, ink, label):
        first = len(canvas.marks)
        found = original(canvas, grid, ink, label)
        marks = canvas.marks[first:]
        texts = [m for m in marks if not isinstance(m, Line) or m.style == "text"]
        x0, y0, x1, y1 = grid.boxes[-1]
        kept.append(Placed(label, Box(x0, y0, x1, y1), len(texts) < len(marks)))
        return found

    placing._set = keeping
    try:
        composed = sheet.composed(project, n)
    finally:
        placing._set = original
    # The circle of an enlarged detail is a window: what is inside is read through it.
    ink = owners.Ink([m for m in composed.drawing.marks[: composed.parts[-1].first]
                      if not (isinstance(m, Arc) and m.of == "details.corner")])
    widths = [line_type(m.style).width if hasattr(m, "style") else 0.0 for m in ink.marks]
    faults = []
    for p in kept:
        what = "" if p.leader else owners.Round(ink, p.label, 60.0).reads(p.box)
        near = ink.near(p.box, 0.0)
        over = near[owners._enters(ink.a[near], ink.b[near] - ink.a[near], p.box)]
        if any(widths[ink.of[k]] > THICK for k in over):
            what = f"{what} covers".strip()
        if what:
            faults.append(Fault(f"{project.variant.project.name} {n}", p.label.of, p.label.text, p.label.anchor, what))
    return faults, len(kept), sum(p.leader for p in kept)


def of_project(name):
    found, count, leaders = [], 0, 0
    try:
        project = Project(catalogue.read(name))
        for n in range(1, len(project.sheets) + 1):
            try:
                faults, labels, led = judged(project, n)
            except Exception as e:
                found.append(Fault(f"{name} {n}", "", "", 0j, f"{type(e).__name__}: {e}"))
                continue
            found += faults
            count += labels
            leaders += led
    except Exception as e:
        found.append(Fault(name, "", "", 0j, f"{type(e).__name__}: {e}"))
    return found, count, leaders


def main(patterns):
    faults, count, leaders = [], 0, 0
    with Pool() as pool:
        for found, n, led in pool.imap(of_project, names(patterns)):
            faults += found
            count += n
            leaders += led
    for f in faults:
        print(f"{f.sheet:34} {f.view:28} {f.text:24} ({f.at.real:.0f}, {f.at.imag:.0f})  {f.what}")
    print(f"{count} labels, {leaders} with leaders, {len(faults)} faults:", dict(Counter(f.what for f in faults)))
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main(sys.argv[1:])
