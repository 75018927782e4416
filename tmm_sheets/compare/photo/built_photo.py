"""Plans of a photographed sheet that were built on a wrong step: see ``diagnosis/built_plan.py``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import cv2
import numpy as np

from tmm_sheets.compare import codes
from tmm_sheets.compare.codes import joined
from tmm_sheets.compare.diagnosis import built_plan
from tmm_sheets.compare.diagnosis.built_plan import BuiltPlan, StudentDrawing
from tmm_sheets.compare.diagnosis.drawn_plan import PlanPoint, between, rebuilt, vanished
from tmm_sheets.compare.elements import Element, ElementView, sampled
from tmm_sheets.compare.findings import millimetres
from tmm_sheets.compare.known_sheet import KnownSheet
from tmm_sheets.compare.photo import tracing
from tmm_sheets.compare.photo.judging import PhotoFinding, judge
from tmm_sheets.compare.photo.lost_ink import mask_washed_out
from tmm_sheets.compare.photo.occlusion import Mask
from tmm_sheets.compare.photo.occlusion import at as hidden_at
from tmm_sheets.compare.photo.profiles import line_level, pixels, sample
from tmm_sheets.compare.photo.rectification import Rectified
from tmm_sheets.compare.photo.sheet_map import PAPER
from tmm_sheets.compare.photo.traces import ELSEWHERE, ExtraInk, InkTrace
from tmm_sheets.compare.report import verdict
from tmm_sheets.drawing.marks import Points

if TYPE_CHECKING:
    from tmm_sheets.project import Project

STEP = 0.5
"""Between places along a line that are looked at, mm."""
REACH = 0.6
"""How far beside its place a pencil's line may run in a straightened picture, mm."""
OFFSETS = np.arange(-REACH, REACH + 0.05, 0.1)
WIDE = 7
"""Pixels of a picture within which a place has the ink of another."""
ALONG = 7
"""So many neighbouring places are averaged: a line that only crosses is no ink along this one."""
SHOWN = 0.5
"""Share of a line that must show for it to be judged by what shows."""
ENDS = 1.5
"""Beside the ends of a line others begin, mm."""
STAYS, ENDS_STAY = 2.0, 1.0
"""How many tolerances aside a line must be led for it to be seen that it is not there, how many mm along itself by its head; and by
an end that shows, which is told more exactly."""
CONTRADICTED = 3
"""Where every so many wrong lines of a plan have one that stays in its place though it would be led elsewhere, another mistake was
made."""
AT_POINT = 0.5
"""From a point of the plan within which a line ends in it, mm."""
Built = Mapping[ElementView, tuple[BuiltPlan, Sequence[PlanPoint]]]


def built_otherwise(project: Project, known: KnownSheet, findings: Sequence[PhotoFinding], ink: Any,
                    hidden: Mask | None = None) -> Built:
    """Views whose plans were built on a mistake, with the mistake and where it takes the points of the plan, mm of the sheet.

    Parameters
    ----------
    project, known, findings
        The sheet, and what was found of its elements.
    ink, hidden
        The rectified sheet, and where it is hidden.
    """
    wrong: dict[ElementView, list[Element]] = {}
    for f in findings:
        if f.element.role == "vector" and f.element.kind == "line" and f.verdict == "red":
            wrong.setdefault(f.element.view, []).append(f.element)
    if not wrong:
        return {}
    level = line_level(ink)
    near = cv2.dilate(ink, np.ones((WIDE, WIDE), np.uint8))
    tips: dict[ElementView, list[complex]] = {}
    for f in findings:
        if f.verdict == "red" and f.element.kind == "line" and f.trace.at is not None:
            tips.setdefault(f.element.view, []).extend(f.trace.at[[0, -1]].tolist())

    def seen(view: ElementView) -> StudentDrawing:
        return StudentDrawing(lambda line: inked(ink, line, level, hidden), lambda z: sample(near, pixels(z)) > level,
                              tips.get(view, []))

    built = built_plan.built_otherwise(project, known, wrong, seen)
    of = {view: [f for f in findings if f.element.view == view] for view in built}
    return {view: b for view, b in built.items() if not _contradicted(b, of[view]) and _borne_out(b, of[view])}


def _borne_out(built: tuple[BuiltPlan, Sequence[PlanPoint]], findings: Sequence[PhotoFinding]) -> bool:
    """Whether a point that is off is what was measured: all lines agree with it, at two points that it moves.

    What nothing follows from, and what the lines tell otherwise, they tell better themselves.
    """
    mistake, points = built[0].mistake, built[1]
    if not isinstance(mistake, str):
        return True
    moved = {p.was for p in points if abs(p.now - p.was) > ELSEWHERE}
    led = set()
    for f in findings:
        if f.element.role == "vector" and f.element.kind == "line" and f.verdict == "red" and f.trace.at is not None:
            if np.abs(f.trace.at[[0, -1]] - between(f.element, points)).max() > ELSEWHERE:
                return False
            led |= {was for was in moved if np.abs(f.element.points[[0, -1]] - was).min() < AT_POINT}
    return len(led) > 1


def _contradicted(built: tuple[BuiltPlan, Sequence[PlanPoint]], findings: Sequence[PhotoFinding]) -> bool:
    """Whether lines of a plan are seen where they should be that would not be there by the mistake."""
    vectors = [f for f in findings if f.element.role == "vector" and f.element.kind == "line"]
    stay = sum(_stays(f, between(f.element, built[1])) for f in vectors)
    return stay > 0 and CONTRADICTED * stay >= sum(f.verdict == "red" for f in vectors)


def _stays(f: PhotoFinding, now: Points) -> bool:
    """Whether an element that would lie elsewhere, ``now``, is in its place: it itself, an end that shows, or its head."""
    return f.verdict == "green" and f.trace.status == "measured" and _told(f, now)


def _told(f: PhotoFinding, now: Points) -> bool:
    """Whether what was measured of an element tells its place from where it would lie by a mistake, ``now``."""
    t, by = f.trace, now - f.element.points
    if f.element.kind != "line":
        return bool(np.abs(by).max() > STAYS * f.tolerance)
    along = f.element.points[-1] - f.element.points[0]
    by = by * np.conj(along) / abs(along)
    far = np.abs(by.real)
    return bool(np.abs(by.imag).max() > STAYS * f.tolerance or (far > ENDS_STAY)[np.isfinite(t.ends)].any()
                or (t.head == "there" and far[1] > STAYS))


def as_built(findings: Sequence[PhotoFinding], built: Built, found: Rectified, pencil: float) -> tuple[
        list[PhotoFinding], list[ExtraInk]]:
    """Findings on all elements, in order, those of plans compared as they were built; and ink that belongs to none.

    ``findings`` are those by the places where they ought to be.
    """
    elements = [f.element for f in findings]
    now = [rebuilt(e, built[e.view][1]) if e.view in built else e for e in elements]
    traces, extra = tracing.trace([e for e in now if not vanished(e)], found.ink, found.hidden)
    if found.uneven is not None:
        traces = mask_washed_out(traces, found.uneven)
    of = {t.element.number: judge(t, pencil, found.uncertainty, found.soft, found.eats) for t in traces}
    return [_judged(of.get(f.element.number), f, found, pencil) for f in findings], extra


def _judged(f: PhotoFinding | None, first: PhotoFinding, found: Rectified, pencil: float) -> PhotoFinding:
    """A finding on an element that may have been built elsewhere, judged by the place that it should have.

    ``first`` is what was found there: what was measured in its place is not elsewhere, and what was right by what could be seen of
    it may be wrong for sure only by what is measured where the mistake leads it.
    """
    was = first.element
    if f is None:
        tolerance = pencil + found.uncertainty
        return PhotoFinding(was, verdict(was.length, tolerance), was.length, codes.VANISHED(), was.middle,
                            InkTrace(was, "small"), tolerance, follows=True)
    now, f = f.element, replace(f, element=was)
    off = float(np.abs(now.points - was.points).max()) if len(now.points) == len(was.points) else 0.0
    if off <= f.tolerance or was.kind == "text" or f.trace.status not in ("measured", "shared", "missing", "beside") or f.unknown:
        return f
    if _stays(first, now.points):
        return first
    follows = codes.AS_FOLLOWS(by=millimetres(off))
    beyond = f.trace.status == "missing" and not all(map(PAPER.contains, now.points.tolist()))
    rest = codes.OFF_THE_PAPER() if beyond else f.remark
    remark = follows if f.verdict == "green" else joined((follows, rest), "; ")
    deviation = max(off, f.deviation)
    colour = verdict(deviation, f.tolerance)
    if first.verdict == "green" and first.trace.status == "measured" and not _told(f, now.points) and colour == "red":
        colour = "amber"
    return replace(f, verdict=colour, deviation=deviation, remark=remark, at=was.middle if beyond else f.at,
                   follows=f.verdict == "green")


def inked(ink: Any, line: Points, level: float, hidden: Mask | None = None) -> float:
    """Share of a line, by both its ends, mm, that ink in its direction covers; ``level`` is the darkness of ink.

    A line that is hidden in part is judged by the rest of it, if that is the greater part: what is not seen speaks for nothing.
    """
    size = float(abs(line[1] - line[0]))
    if size < 2 * ENDS + STEP:
        return 1.0  # too short to be told
    along = (line[1] - line[0]) / size
    points, normals = sampled(np.array([line[0] + ENDS * along, line[1] - ENDS * along]), STEP)
    profile = sample(ink, pixels(points[:, None] + normals[:, None] * OFFSETS))
    there = cv2.blur(profile, (1, ALONG), borderType=cv2.BORDER_REPLICATE).max(1) > level
    shown = np.ones(len(points), bool) if hidden is None else ~hidden_at(points, hidden)
    return float(there[shown].mean() if shown.mean() > SHOWN else there.mean())
