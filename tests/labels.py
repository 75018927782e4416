"""Labels of finished sheets: do they read as what they name?

Usage: python -m tests.labels [--ciphers N --seed S] [--lang L] [--jobs N] [PROJECT ...]; without names all of
them: shipped projects, those of the tests, and N ciphers.

For every label: its own line or point is nearer than any other and the shortest way there crosses nothing, or it has a leader; it
covers no line thicker than 0.25 mm. See :mod:`tmm_sheets.drawing.owners`. For every run of letters: no line at all runs over its
ink, no rule of a table (then it is beyond its cell), no other lettering, and it is on the sheet, inside the frame.
Leaders that run over lettering or cross each other are faults, too; labels so near other lettering on their level that both read as
one word are only counted.
"""

from __future__ import annotations

import argparse
import random
import sys
from collections import Counter
from multiprocessing import Pool
from pathlib import Path
from typing import NamedTuple

import numpy as np
from shapely import GeometryCollection, LineString, Point, Polygon, box
from shapely.ops import nearest_points, substring

from tests.gallery import names
from tmm_sheets import catalogue, kept as stored
from tmm_sheets.drawing import ink_index, labels as placing, lettering, owners
from tmm_sheets.drawing.canvas import Label
from tmm_sheets.drawing.ink import strokes
from tmm_sheets.drawing.marks import Box, Fill, Line, Text
from tmm_sheets.drawing.styles import line_type
from tmm_sheets.drawing.text_layout import run_corners, text_box
from tmm_sheets.project import Project
from tmm_sheets.sheets import sheet
from tmm_sheets.words import LANGUAGES, set_paper

THICK = 0.25
CARRIES = ("text", "frame")
"""Roles of lines that belong to lettering: fraction bars, leaders, shelves, the title block."""
LED = ("leader over lettering", "leaders cross")
"""What is told of leaders."""
OWN = Path(__file__).parent / "projects"
"""Mechanisms of nobody's task."""
MACHINES = {"compressor": "В", "crusher": "СДМ", "diesel": "Т", "press": "ЭПС"}
"""Transport machines and the letters of their specialities."""


class Placed(NamedTuple):
    """A label as it was set."""

    label: Label
    box: Box
    leader: list[Line]


class Fault(NamedTuple):
    """What is wrong with a label."""

    sheet: str
    view: str
    text: str
    at: complex
    what: str


def judged(project, n):
    """Faults of the labels of a sheet, and how many labels it has."""
    kept, windows = [], set()
    original = placing.draw_label

    def keeping(canvas, label, box):
        windows.update(canvas.windows)
        first = len(canvas.marks)
        original(canvas, label, box)
        kept.append(Placed(label, box, [m for m in canvas.marks[first:] if isinstance(m, Line) and m.style != "text"]))

    placing.draw_label = keeping
    try:
        with stored.unused():
            composed = sheet.composed(project, n)
    finally:
        placing.draw_label = original
    ink = ink_index.InkIndex([m for n, m in enumerate(composed.drawing.marks[: composed.parts[-1].first]) if n not in windows])
    corners = [text_box(m) for m in composed.drawing.marks[: composed.parts[-1].first] if isinstance(m, Text)]
    written = np.array([(z.real.min(), z.imag.min(), z.real.max(), z.imag.max()) for z in corners]).reshape(-1, 4)
    widths = [line_type(m.style).width if hasattr(m, "style") else 0.0 for m in ink.marks]
    faults = []
    for p in kept:
        what = "" if p.leader else owners.Surroundings(ink, p.label, 60.0).misreading(p.box)
        near = ink.near(p.box, 0.0)
        over = near[ink_index.enters(ink.a[near], ink.b[near] - ink.a[near], *p.box)]
        if any(widths[ink.of[k]] > THICK for k in over):
            what = f"{what} covers".strip()
        what = f"{what} {_badly_led(p, kept, written)} {_of_another(p, ink)}".strip()
        if what:
            faults.append(Fault(f"{project.variant.project.name} {n}", p.label.of, p.label.text, p.label.anchor, what))
    run_on = sum(_runs_on(p, kept, written) for p in kept)
    name = f"{project.variant.project.name} {n}"
    faults += [Fault(name, style, text, at, CELL if role == "table" else CROSSED)
               for text, style, at, role in crossings(composed.drawing)]
    faults += [Fault(name, "", text, at, what) for text, at, what in strayed(composed.drawing)]
    return faults, len(kept), sum(bool(p.leader) for p in kept), run_on


CROSSED, CELL, BEYOND, OVER = "line over letters", "beyond its cell", "beyond the frame", "letters over letters"
"""What is told of runs of letters."""
PEN = 0.35
"""Lettering so near to other lettering touches it, mm."""


def inked(text):
    """Strokes of a run of letters on the sheet."""
    drawn = lettering.strokes(text.text, text.height)
    return [text.at + np.exp(1j * text.angle) * (z if text.wide == 1.0 else lettering.widened(z, text.wide)) for z in drawn]


def strayed(drawing):
    """Runs of letters beyond the frame of the sheet, and those that touch others: what is lettered, where, and which of both."""
    texts = [m for m in drawing.marks if isinstance(m, Text) and lettering.strokes(m.text, m.height) and m.of != ink_index.FRAME]
    if not texts:
        return
    strokes_of = [inked(m) for m in texts]
    field = ink_index.FIELD
    cells = []
    for k, (text, lines) in enumerate(zip(texts, strokes_of, strict=True)):
        z = np.concatenate(lines)
        if z.real.min() < field.x0 or z.real.max() > field.x1 or z.imag.min() < field.y0 or z.imag.max() > field.y1:
            yield text.text, text.at, BEYOND
        points = ink_index.sample(np.concatenate([z[:-1] for z in lines]), np.concatenate([z[1:] for z in lines]), PEN / 2)
        at = np.unique(np.round(points.real / PEN) + 1j * np.round(points.imag / PEN))
        cells.append(np.column_stack([at.real, at.imag, np.full(len(at), k)]))
    cells = np.concatenate(cells)
    cells = cells[np.lexsort(cells.T[[2, 1, 0]])]
    same = (cells[1:, :2] == cells[:-1, :2]).all(axis=1)
    for k, other in {(int(a), int(b)) for a, b in zip(cells[1:, 2][same], cells[:-1, 2][same], strict=True)}:
        yield f"{texts[other].text} {texts[k].text}", texts[k].at, OVER


def crossings(drawing):
    """Lines that cross the ink of level letters: what is lettered, style of the line, where, and its role."""
    marks = list(strokes(drawing.marks))
    ink = ink_index.InkIndex(marks)
    found = []
    for text in marks:
        drawn = inked(text) if isinstance(text, Text) and abs(np.sin(2 * text.angle)) < 0.01 else []
        if drawn:
            z = np.concatenate(drawn)
            box = Box(z.real.min(), z.imag.min(), z.real.max(), z.imag.max())
            near = ink.near(box, 0.0)
            over = near[ink_index.enters(ink.a[near], ink.b[near] - ink.a[near], *box)]
            lines = [ink.marks[k] for k in {ink.of[k] for k in over}]
            found += [(text.text, m.style, text.at, m.by.role if m.by else "") for m in lines
                      if not isinstance(m, Text) and not (m.by and m.by.role in CARRIES)]
    return found


def _badly_led(p, kept, written):
    """Whether the leader of a label runs over lettering of the views or of other labels, or crosses another leader."""
    boxes = np.vstack([written, *(q.box for q in kept if q is not p)])
    a, b = (np.array([getattr(m, end) for q in kept if q is not p for m in q.leader]) for end in "ab")
    for line in p.leader:
        if ink_index.enters(line.a, line.b - line.a, *boxes.T).any():
            return LED[0]
        if len(a) and ink_index.crosses(a, b, line.a, line.b).any():
            return LED[1]
    return ""


THICK_LINE = 0.6
"""Width of the vectors' line, mm."""
SPAN, TIE, ONE, LED_TO, APART, BESIDE = 0.3, 0.1, 0.4, 0.6, 1.0, 3.0
"""A name's anchor lies on its line, mm; distances alike; vectors whose ink is one; a leader this near to a foreign one may be
its; vectors are seen apart; and so far to both sides of a crossing, mm."""


def _vectors(ink, view):
    """Vectors of a view, each with its head, and the steps they come from."""
    marks = [m for m in ink.marks if not isinstance(m, Text) and m.by is not None and m.by.role == "vector" and m.of == view]
    heads = [(Polygon([(z.real, z.imag) for z in m.points]), m.by[1:4]) for m in marks if isinstance(m, Fill)]
    for m in marks:
        if isinstance(m, Line):
            line, by = LineString([(m.a.real, m.a.imag), (m.b.real, m.b.imag)]), m.by[1:4]
            own = [head for head, of in heads if of == by and head.distance(line.boundary) < TIE]
            # The line ends within its head.
            tips = [max(head.exterior.coords, key=lambda z: line.distance(Point(z))) for head in own]
            yield LineString([*line.coords, *tips]), GeometryCollection([line, *own]), by


def _of_another(p, ink):
    """Whether the name of a vector reads as another vector's: by the record, and by shapely, which knows nothing of the placing."""
    by, at = p.label.by, Point(p.label.anchor.real, p.label.anchor.imag)
    if by is None or not by.step:
        return ""
    vectors = list(_vectors(ink, p.label.of))
    same = [(line, whole) for line, whole, of in vectors if of == by[1:4]]
    line, own = min(same, key=lambda v: v[0].distance(at), default=(None, None))
    if own is None or line.distance(at) > SPAN or min(at.distance(end) for end in line.boundary.geoms) < 2 * SPAN:
        return ""
    foreign = [whole for other, whole, _ in vectors if other is not line]
    apart = [whole for whole in foreign if whole.distance(at) > ONE]
    here = line.project(at)
    beside = [line.interpolate(here + way) for way in (-BESIDE, 0.0, BESIDE)]
    if any(max(map(whole.distance, beside)) <= ONE for whole in foreign):  # their ink is one here: is it all along?
        along = [line.interpolate(share, normalized=True) for share in np.linspace(0.1, 0.9, 9)]
        if max(min(whole.distance(z) for whole in foreign) for z in along) > APART:
            return TOGETHER
    if p.leader:
        touched = _first_touched(p, own)
        return LED_ASTRAY if any(max(whole.distance(at), whole.distance(touched)) < LED_TO for whole in apart) else ""
    corner = complex(p.box.x0, p.box.y0)
    runs = GeometryCollection([box(*Box.around(run + corner)) for run in run_corners(p.label.text, p.label.height)])
    gap, way = own.distance(runs), LineString(nearest_points(runs, own))
    if any(whole.distance(runs) < gap - TIE for whole in apart):
        return NEARER
    # Heads of vectors that end at one point overlap: what is met as soon as its own ink is not between.
    way = substring(way, 0.0, max(gap - TIE, 0.0))
    return BETWEEN if any(part.crosses(way) for whole in apart for part in whole.geoms) else ""


NEARER, BETWEEN, LED_ASTRAY, TOGETHER = (
    "another vector is nearer", "another vector is between", "led to several vectors", "where vectors run together")


def _first_touched(p, own):
    """Where an eye that comes along the leader from the name meets the ink of its vector: there it stops."""
    leader, (line, *heads) = p.leader[0], own.geoms
    way = LineString([(z.real, z.imag) for z in (leader.b, leader.a, p.label.anchor)])
    ink = way.intersection(line.buffer(THICK_LINE / 2).union(GeometryCollection(heads).buffer(0)))
    return way.interpolate(way.project(nearest_points(ink, Point(way.coords[0]))[0]))


def _runs_on(p, kept, written):
    boxes = np.vstack([written, *(q.box for q in kept if q is not p)])
    return bool(placing.reads_on(np.array(p.box)[:, None], boxes, placing.WORD * p.label.height)[0])


def of_project(name):
    found, counts = [], np.zeros(3, int)
    try:
        project = Project(catalogue.read(name))
        for n in range(1, len(project.sheets) + 1):
            try:
                faults, *numbers = judged(project, n)
            except Exception as e:
                found.append(Fault(f"{name} {n}", "", "", 0j, f"{type(e).__name__}: {e}"))
                continue
            found += faults
            counts += numbers
    except Exception as e:
        found.append(Fault(name, "", "", 0j, f"{type(e).__name__}: {e}"))
    return found, counts


def add_options(parser, ciphers):
    """Options that say which projects are looked at, and how."""
    parser.add_argument("--ciphers", type=int, default=ciphers)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--lang", choices=LANGUAGES, default=LANGUAGES[0])
    parser.add_argument("--jobs", type=int, help="processes at a time")
    parser.add_argument("project", nargs="*")


def chosen(asked):
    """Projects that are asked for by :func:`add_options`: those named, or all shipped ones, those of the tests and some ciphers."""
    every = [] if asked.project else [*map(str, sorted(OWN.glob("*.toml"))), *drawn_lots(asked.ciphers, asked.seed)]
    return names(asked.project) + every


def drawn_lots(count, seed):
    """Ciphers as students have them, of all machines in turn."""
    lots = random.Random(seed)
    machines = list(MACHINES.items())
    return [f"transport/{machine}@{lots.randrange(12):02}-{letters}-{lots.randrange(1000)}"
            for machine, letters in (machines[n % len(machines)] for n in range(count))]


def main(args):
    parser = argparse.ArgumentParser(prog="python -m tests.labels")
    add_options(parser, 0)
    o = parser.parse_args(args)
    which = chosen(o)
    faults, counts = [], np.zeros(3, int)
    set_paper(o.lang)
    with Pool(o.jobs) as pool:
        for found, numbers in pool.imap(of_project, which):
            faults += found
            counts += numbers
    for f in faults:
        print(f"{f.sheet:34} {f.view:28} {f.text:24} ({f.at.real:.0f}, {f.at.imag:.0f})  {f.what}")
    count, leaders, run_on = counts
    print(f"{len(which)} projects, {count} labels, {leaders} with leaders, {run_on} run on, {len(faults)} faults:",
          dict(Counter(f.what for f in faults)))
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main(sys.argv[1:])
