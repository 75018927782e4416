"""Enlarged details (выносные элементы, GOST 2.305) of the corners of vector polygons that cannot be read at their scale factor."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.scale import Scale
from tmm_sheets.construction.step import Step
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.clipping import chord
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import PlacedFrame, Text
from tmm_sheets.drawing.text_boxes import text_box
from tmm_sheets.sheets.frame import together
from tmm_sheets.sheets.linkage import link_marks
from tmm_sheets.sheets.player import PlayerStage

if TYPE_CHECKING:
    from tmm_sheets.project import Project

NEAR = 2.0
"""Corners closer than this, mm, are shown enlarged."""
MOST = 6
"""So many vectors can be told apart in a detail."""
ONE = 0.02
"""Corners closer than this are one, mm."""
TIMES = (5, 10, 20, 40, 50, 100)
"""Enlargements (GOST 2.302)."""
FILLED = 0.6
"""Part of the window that the corners take at most."""
NAMES = ("I", "II", "III", "IV")


class Corner(NamedTuple):
    """Corners of a polygon close together: its vectors with their signs, letters by point, where they are on the sheet, mm."""

    plan: Plan
    frame: PlacedFrame
    vectors: tuple[tuple[str, str, str], ...]
    points: dict[str, complex]
    names: tuple[str, ...]

    @property
    def centre(self) -> complex:
        """Middle of the corners, mm of the sheet."""
        z = np.array([self.points[name] for name in self.names])
        return complex((z.real.min() + z.real.max()) / 2, (z.imag.min() + z.imag.max()) / 2)

    @property
    def reach(self) -> float:
        """Farthest corner from there, mm."""
        return max(abs(self.points[name] - self.centre) for name in self.names)


def corner_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[tuple[float, float]]:
    """Places that an enlarged detail can do with, mm; none where every corner can be read."""
    found = list(_corners(project, canvas))
    nth = int(options.get("nth", 1))
    if nth > len(found):
        return []
    # As wide as its scale factor is in letters of the height that the others have, if there is room.
    least = max(letter(str(_factor(canvas, found[nth - 1], half)[1]), 5.0).width + 2.1 for half in (31.0, 26.0))
    return [(max(62.0, least), 76.0), (max(52.0, least), 66.0), (62.0, 76.0), (52.0, 66.0), (44.0, 58.0), (38.0, 52.0)]


def corner_near(project: Project, canvas: Canvas, options: dict[str, Any]) -> tuple[complex, int, list[int]]:
    """What the detail shows, mm of the sheet, the part of its plan, and those of the plans it could be taken for a detail of."""
    it = list(_corners(project, canvas))[int(options.get("nth", 1)) - 1]
    plans = _polygons(project)
    first = {(frame.plan, frame.position): frame.view for frame in reversed(canvas.frames)}  # later ones are details
    return it.centre, it.frame.view, [view for (plan, _), view in first.items() if plan in plans and view != it.frame.view]


def corner(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """The ``nth`` corner of all plans enlarged, and its circle on the plan."""
    nth = int(options.get("nth", 1))
    it, name = list(_corners(project, canvas))[nth - 1], next_name(canvas)
    window = Box(box.x0, box.y0, box.x1, box.y1 - 16.0)
    half = min(window.width, window.height) / 2
    times, factor = _factor(canvas, it, half)
    canvas.title(box, f"{name} ({times}:1)", str(factor))
    with canvas.as_role("symbol"):
        canvas.window(window.centre, half)
        place = placed(canvas, it.frame, it.centre, window.centre, times)
        _enlarged(PlayerStage(canvas, it.plan, project.force_index, canvas.frames[place], place), it, window.centre, half)
        radius = _free_radius(canvas, it)
        # The sign of a vector that lies in the circle stands in the detail: on the plan it would need a leader out of the corner.
        inside = {sign for sign, *ends in it.vectors if all(abs(it.points[name] - it.centre) < radius for name in ends)}
        canvas.labels[:] = [label for label in canvas.labels
                            if label.part != it.frame.view or label.text not in inside or abs(label.anchor - it.centre) > radius]
        _no_more_zero(canvas, it)
        mark(canvas, it.frame.view, it.centre, radius, name, 1 + 1j)


def placed(canvas: Canvas, frame: PlacedFrame, centre: complex, middle: complex, times: float) -> int:
    """The plan of a frame once more, enlarged about what lies at ``centre`` on the sheet, which gets to ``middle``, mm."""
    origin, mu = middle + times * (frame.origin - centre), (frame.mu[0] / times, frame.mu[1] / times)
    return canvas.placed(frame.plan, frame.position, origin, mu, frame.turn, frame.mirror)


def mark(canvas: Canvas, part: int, centre: complex, radius: float, name: str, away: complex) -> None:
    """Circle of a detail on the picture that it enlarges, and its name."""
    canvas.begin(canvas.parts[part].box, "", "details.corner")
    canvas.window(centre, radius)
    # On a shelf: a slanting I among lines would be one of them (GOST 2.305).
    canvas.label(centre, name, away, 5.0, radius + 2.0, shelf=radius)


def next_name(canvas: Canvas) -> str:
    """Roman number of the next detail of a sheet, by those that stand there."""
    return NAMES[sum(part.title.split(" ")[0] in NAMES for part in canvas.parts)]


def _no_more_zero(canvas: Canvas, it: Corner) -> None:
    """A vector that the detail draws is not told to be about zero beside the plan."""
    drawn = {sign for sign, tail, head in it.vectors if {tail, head} & set(it.names)}
    kept = [replace(note, signs=tuple(sign for sign in note.signs if sign not in drawn)) if note.part == it.frame.view else note
            for note in canvas.notes]
    canvas.notes[:] = [note for note, was in zip(kept, canvas.notes, strict=True) if note.signs or not was.signs]


def _factor(canvas: Canvas, it: Corner, half: float) -> tuple[int, Scale]:
    """How many times corners are enlarged in a window of that half width, mm, and the scale factor that comes of it."""
    times = max((t for t in TIMES if t * it.reach <= FILLED * half), default=TIMES[0])
    scale: Scale = canvas.scales[it.plan.name]
    return times, Scale(scale.symbol, float(f"{scale.mu / times:.6g}"), scale.unit)


def _free_radius(canvas: Canvas, it: Corner) -> float:
    """Radius of the circle round the corners, mm: the least that runs over no lettering, the usual one where all do."""
    boxes = [np.abs(text_box(m) - it.centre) for m in canvas.marks if isinstance(m, Text) and abs(m.at - it.centre) < 40.0]
    usual = it.reach + 1.5
    return next((r for r in usual + 0.5 * np.arange(8) if not any(b.min() < r + 0.2 and b.max() > r - 0.2 for b in boxes)), usual)


def _enlarged(s: PlayerStage, it: Corner, middle: complex, half: float) -> None:
    """Vectors and letters of a corner inside a circle of a radius, mm."""
    at = {name: s.at(name) for name in it.points}
    for sign, tail, head in it.vectors:
        seen = chord(middle, half, at[tail], at[head])
        if seen is None or abs(seen[1] - seen[0]) < 1.0:
            continue
        a, b = seen
        pen = s.pen(head, "symbol", f"{tail}–{head}")
        if abs(b - at[head]) < 1e-9 and abs(b - a) > 3.0:
            pen.arrow(a, b, "vector")
        else:
            pen.line(a, b, "vector")
        pen.label((a + b) / 2, sign, 1j * (b - a), 3.5, 1.0)
    for same in together([at[name] for name in it.names], 0.8):
        first = it.names[same[0]]
        pen = s.pen(first, "symbol")
        pen.dot(at[first], 0.6)
        pen.label(at[first], ", ".join(_letters(it.plan, it.names[i]) for i in same), at[first] - middle, 3.5, 1.0)


def _letters(plan: Plan, name: str) -> str:
    return name if name.isdigit() else link_marks.indexed(plan[name].symbol or name)


def _corners(project: Project, canvas: Canvas) -> Iterator[Corner]:
    """Corners that cannot be read, plan by plan as they stand on the sheet; of one plan the one with most points."""
    k, polygons = project.force_index, _polygons(project)
    for frame in canvas.frames:
        if frame.plan not in polygons:
            continue
        plan, vectors = polygons.pop(frame.plan)
        steps: dict[str, Step] = {step.name: step for _, tail, head in vectors for step in (tail, head)}
        points = {name: complex(frame(complex(step.at(k)))) for name, step in steps.items()}
        drawn = [(s, a.name, b.name) for s, a, b in vectors if abs(points[a.name] - points[b.name]) > ONE]
        there = dict.fromkeys(name for _, a, b in drawn for name in (a, b))
        groups = _together({name: points[name] for name in there}, drawn)
        if groups:
            it = Corner(plan, frame, tuple(drawn), points, max(groups, key=len))
            through = sum(chord(it.centre, 2 * it.reach, points[a], points[b]) is not None for _, a, b in drawn)
            if through <= MOST:
                yield it


def _polygons(project: Project) -> dict[str, tuple[Plan, list[tuple[str, Step, Step]]]]:
    """Plans by their names with their vectors: sign, tail and head."""
    study = project.study
    polygons = {fp.plan.name: (fp.plan, [(s, a, b) for s, a, b, *_ in fp.sides]) for fp in study.forces.plans.values()}
    acc = study.accelerations.plan
    return polygons | {acc.name: (acc, [(seg.symbol, seg.tail, seg.head) for seg in acc.segments])}


def _together(points: dict[str, complex], drawn: list[tuple[str, str, str]]) -> list[tuple[str, ...]]:
    """Points less than ``NEAR`` apart of which some are joined by a vector: what cannot be told apart on the sheet."""
    found = []
    for same in together(list(points.values()), NEAR):
        names = tuple(list(points)[i] for i in same)
        if any(tail in names and head in names for _, tail, head in drawn):
            found.append(names)
    return found
