"""What is off in a picture, place by place: one mistake is told once.

A point that was drawn elsewhere takes all its lines with it, a stroke may be any of several lines that belong near it, and of a
line that was moved the ink lies in pieces. All that is one place for who looks at the drawing: it has one row in the table and one
number on the overlay. What is accused most speaks for it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.compare import codes
from tmm_sheets.compare.elements import sampled
from tmm_sheets.compare.findings import Verdict, of_radius, worst
from tmm_sheets.compare.photo.judging import PhotoFinding
from tmm_sheets.compare.photo.line_ends import one_line
from tmm_sheets.compare.photo.profiles import HALF, LARGELY
from tmm_sheets.compare.photo.small_marks import ALIKE, MOVED, TOGETHER
from tmm_sheets.compare.photo.traces import ELSEWHERE, FARTHEST_OFF, ONE_POINT, SAMPLING, ExtraInk, InkTrace
from tmm_sheets.drawing.marks import Points

ONE = 5.0
"""mm between places of one view that are off, within which they are one: the circles round them would lie upon each other."""
ON = 1.5  # mm from a line within which ink is its own
LIKE = (0.5, 1.5)
"""Extent of ink that may be lettering that is not there, in that of the lettering."""
ROOM = 2.0
"""mm about the place where lettering stands that was moved within which ink is its own."""
NEXT = 6.0
"""mm between pieces of ink that are one thing to the eye."""
GAP, IN_LINE = 30.0, 0.5
"""mm between pieces of one straight stroke at most, and mm by which they may be out of line."""
LEAST_RADIUS, OTHER, ROUND = 4.0, (0.8, 6.0), 0.5
"""mm: circles that are looked about, by how much ink may be off them, and how exactly it is round."""
TURN, PART = 90.0, 5.0
"""Degrees of a circle that ink must take, counted by parts."""
EITHER = 2
"""Most lines of which one may have been drawn where there is ink for them to be named."""
UNDER = 0.7
"""Least share of a line that lies under others for the ink in its place to be no sign of it."""
AS_LONG, SWUNG = 2.5, (1.0, 8.0)
"""By how many mm the length of a line that was drawn askew may be another, and how far its other end lies from where it belongs."""


@dataclass(frozen=True)
class FindingCluster:
    """What is off in one place: findings, the worst first, and ink of no element; at least one of both.

    Attributes
    ----------
    number : on the overlay and in the table, from 1
    findings : what is off there
    own : ink by which a finding's line was found
    ink : other ink there
    likely : lines in strokes with others of which one may have been drawn where there is only ink
    """

    number: int
    findings: tuple[PhotoFinding, ...] = ()
    own: tuple[ExtraInk, ...] = ()
    ink: tuple[ExtraInk, ...] = ()
    likely: tuple[PhotoFinding, ...] = ()

    @property
    def verdict(self) -> Verdict:
        """The worst there."""
        return "red" if any(f.verdict == "red" for f in self.findings) else "amber"

    @property
    def box(self) -> Box:
        """What its ink takes, mm."""
        return Box.around(np.concatenate([x.points for x in self.ink]))

    @property
    def at(self) -> complex:
        """Where it is circled, mm: on ink, for in the middle of several pieces there may be none."""
        if self.findings:
            return self.findings[0].at
        ink = np.concatenate([x.points for x in self.ink])
        return complex(ink[np.abs(ink - ink.mean()).argmin()])


def places(findings: Sequence[PhotoFinding], extra: Sequence[ExtraInk]) -> list[FindingCluster]:
    """The places where something is off: those with findings first, the worst first, then ink alone, the longest first."""
    groups: list[list[PhotoFinding]] = []
    for f in worst(findings):
        place = next((g for g in groups if one_place(g[0], f) or any(one_point(h, f) for h in g)), None)
        if place is None:
            groups.append([f])
        else:
            place.append(f)
    own: list[list[ExtraInk]] = [[] for _ in groups]
    beside: list[list[ExtraInk]] = [[] for _ in groups]
    alone: list[ExtraInk] = []
    for x in extra:
        for some, belongs in ((own, _is_ink_of), (beside, _runs_along), (beside, _letters)):
            home = next((k for k, g in enumerate(groups) if any(belongs(f, x) for f in g)), None)
            if home is not None:
                some[home].append(x)
                break
        else:
            alone.append(x)
    circles = _circles(findings, alone)
    rest = [x for x in alone if not any(x is y for _, some in circles for y in some)]
    ink = sorted(_pieces(rest), key=lambda some: -sum(x.length for x in some))
    out = [FindingCluster(0, tuple(g), tuple(mine), tuple(near)) for g, mine, near in zip(groups, own, beside, strict=True)]
    out += [FindingCluster(0, (f,), tuple(some)) for f, some in circles]
    out += [FindingCluster(0, ink=tuple(some), likely=_likely(findings, some)) for some in ink]
    return [replace(p, number=k) for k, p in enumerate(out, 1)]


def one_place(f: PhotoFinding, g: PhotoFinding) -> bool:
    """Whether two findings are about one place: lines off there, or one stroke that may be either's; lettering is apart, and
    together where it was moved together.
    """
    a, b = f.element, g.element
    if a.view is b.view and a.kind == b.kind == "text":
        return _moved_alike(f, g)
    if a.view is not b.view or "text" in (a.kind, b.kind):
        return False
    near = np.abs(_off(f)[:, None] - _off(g)).min() < ONE
    return bool(near) or ("beside" in (f.trace.status, g.trace.status) and one_line(f.trace, g.trace))


def may_be_either(f: PhotoFinding, g: PhotoFinding) -> bool:
    """Whether one line that was found beside its stroke may be either element."""
    lines = all(h.trace.status == "beside" and h.element.kind == "line" for h in (f, g))
    return lines and one_line(f.trace, g.trace)


def _moved_alike(f: PhotoFinding, g: PhotoFinding) -> bool:
    """Whether two pieces of lettering that stand near each other were moved by the same."""
    near = abs(f.element.middle - g.element.middle) < TOGETHER
    return near and f.trace.at is not None and g.trace.at is not None and abs(f.trace.shift - g.trace.shift) < ALIKE


def one_point(f: PhotoFinding, g: PhotoFinding) -> bool:
    """Whether two lines are off at an end they have in common: it is the point that was drawn elsewhere."""
    if f.element.view is not g.element.view or "text" in (f.element.kind, g.element.kind):
        return False
    a, b = _ends_off(f), _ends_off(g)
    return bool((np.abs(a[:, None] - b) < ONE_POINT).any())


def _ends_off(f: PhotoFinding) -> Points:
    """The ends of a straight line, where they belong, that were found elsewhere, or that may be: of what is seen in pieces both."""
    e, at = f.element, f.trace.at
    if f.trace.status == "missing" and f.trace.pieces and e.kind == "line":
        return e.points
    if at is None or e.kind != "line" or len(at) != len(e.points):
        return np.zeros(0, complex)
    return e.points[np.abs(at - e.points) > f.tolerance]


def _off(f: PhotoFinding) -> Points:
    """Where an element is off, mm: the place that counts most, and ends of its line that were found elsewhere."""
    return np.append(_ends_off(f), f.at)


def _share(points: Points, line: Points, within: float) -> float:
    """Share of points that lie so near a line, given by close points."""
    return float((np.abs(points[:, None] - line).min(1) <= within).mean())


def _is_ink_of(f: PhotoFinding, x: ExtraInk) -> bool:
    """Whether ink is that by which an element was found elsewhere."""
    at = f.trace.at
    if at is None or f.element.kind == "text" or f.trace.deviation <= f.tolerance:
        return False
    return _share(x.points, sampled(at, SAMPLING)[0], ON) >= HALF


def _runs_along(f: PhotoFinding, x: ExtraInk) -> bool:
    """Whether ink runs along an element that is off, so that it may be its own."""
    e = f.element
    if e.kind not in ("line", "arc", "circle", "curve") or (e.kind == "circle" and e.fills):
        return False
    line, normal = sampled(e.points, SAMPLING)
    away = np.abs(x.points[:, None] - line)
    if (away.min(1) <= FARTHEST_OFF).mean() < LARGELY:
        return False
    way = _main_direction(x.points)
    return bool(abs((way * np.conj(normal[away.argmin(1)])).real).mean() < 0.5)  # within some 30 degrees of its direction


def _letters(f: PhotoFinding, x: ExtraInk) -> bool:
    """Whether ink may be the lettering that is not in its place."""
    if f.trace.status not in ("absent lettering", "part of lettering"):
        return False
    if f.trace.at is not None:
        return Box.around(f.trace.at, ROOM).contains(x.middle)
    box = Box.around(f.element.points)
    alike = all(LIKE[0] * size <= found <= LIKE[1] * size + 1.0 for found, size in ((x.width, box.width), (x.height, box.height)))
    return alike and abs(x.middle - f.element.middle) <= MOVED


def _main_direction(points: Points) -> complex:
    """The direction in which points lie."""
    _, way = np.linalg.eigh(np.cov(points.real, points.imag))
    return complex(way[0, 1], way[1, 1])


def _likely(findings: Sequence[PhotoFinding], ink: Sequence[ExtraInk]) -> tuple[PhotoFinding, ...]:
    """The line that may have been drawn askew where there is a straight stroke of ink, where that is one of few.

    Near the end that stays others hide its ink. Its own place must be one where it cannot be told from others.
    """
    z = np.concatenate([x.points for x in ink])
    if np.std((z * np.conj(way := _main_direction(z))).imag) > IN_LINE:
        return ()
    along = (z * np.conj(way)).real
    ends = z[[along.argmin(), along.argmax()]]
    lines = [f for f in findings if f.element.kind == "line" and len(f.element.points) == 2]
    some = [f for f in lines if _is_turned_about_end(f.element.points, ends, way) and _may_be_others_ink(f, lines)]
    return tuple(some) if len({(f.element.view, f.element.name, f.element.position) for f in some}) <= EITHER else ()


def _may_be_others_ink(f: PhotoFinding, lines: Sequence[PhotoFinding]) -> bool:
    """Whether it cannot be told that a line stands in its own place: the ink there may be that of others."""
    if f.trace.status in ("dense", "shared", "covered") or f.trace.head in ("absent", "left out"):
        return True
    if f.trace.status != "measured" or f.verdict != "green":
        return False
    z = sampled(f.element.points, SAMPLING)[0]
    under = np.zeros(len(z), bool)
    for g in lines:
        if g is not f:
            begin, end = g.element.points
            share = (z - begin) / (end - begin)
            under |= (np.abs(share.imag) * abs(end - begin) <= ONE_POINT) & (share.real >= 0) & (share.real <= 1)
    return bool(under.mean() >= UNDER)


def _is_turned_about_end(line: Points, ends: Points, way: complex) -> bool:
    """Whether a straight stroke in the direction ``way`` may be a line with one end in its place."""
    length = abs(line[-1] - line[0])
    for stays, other in ((line[0], line[-1]), (line[-1], line[0])):
        far = ends[np.abs(ends - stays).argmax()]
        if (abs(((stays - far) * np.conj(way)).imag) <= ELSEWHERE and abs(abs(far - stays) - length) <= AS_LONG
                and SWUNG[0] < abs(far - other) <= SWUNG[1]):
            return True
    return False


def _pieces(some: Sequence[ExtraInk]) -> list[list[ExtraInk]]:
    """Pieces of ink, those that are one thing to the eye together."""
    groups: list[list[ExtraInk]] = []
    for x in some:
        same = [g for g in groups if any(_are_one_stroke(x, y) for y in g)]
        groups = [g for g in groups if all(g is not h for h in same)] + [[x, *(y for g in same for y in g)]]
    return groups


def _are_one_stroke(x: ExtraInk, y: ExtraInk) -> bool:
    """Whether two pieces of ink lie side by side or are of one straight stroke."""
    gap = float(np.abs(x.points[:, None] - y.points).min())
    if gap <= NEXT or gap > GAP:
        return gap <= NEXT
    both = np.concatenate((x.points, y.points))
    return bool(np.std((both * np.conj(_main_direction(both))).imag) <= IN_LINE)


def _circles(findings: Sequence[PhotoFinding], ink: Sequence[ExtraInk]) -> list[tuple[PhotoFinding, list[ExtraInk]]]:
    """Findings on circles about whose centres ink lies on another circle, with that ink.

    Circles that coincide are both in their place when one of them was drawn elsewhere, so only the ink tells of it.
    """
    out: list[tuple[PhotoFinding, list[ExtraInk]]] = []
    rest = list(ink)
    about = [f for f in findings if f.element.kind == "circle" and not f.element.fills and f.element.radius > LEAST_RADIUS]
    while found := max((c for f in about if (c := _circle_elsewhere(f, rest)) is not None), key=lambda c: len(c[1]), default=None):
        out.append(found)
        rest = [x for x in rest if not any(x is y for y in found[1])]
    return out


def _circle_elsewhere(f: PhotoFinding, ink: Sequence[ExtraInk]) -> tuple[PhotoFinding, list[ExtraInk]] | None:
    """The circle about the centre of another on which most ink lies, None where that is too little of one to be told."""
    e = f.element
    away = [np.abs(x.points - e.centre) for x in ink]
    radii = [float(np.median(r)) for r in away]
    some = [(r, x) for r, a, x in zip(radii, away, ink, strict=True)
            if OTHER[0] <= abs(r - e.radius) <= OTHER[1] and float(np.std(a)) <= ROUND]  # fmt: skip
    most, best = 0.0, None
    for radius, _ in some:
        mine = [x for r, x in some if abs(r - radius) <= ROUND]
        points = np.concatenate([x.points for x in mine]) - e.centre
        angles = np.round(np.angle(points, deg=True) % 360, 6)
        turn = PART * len(np.unique(angles[angles % PART > 0] // PART))  # an end on the border of a part takes none of it
        if turn >= max(TURN, most + PART):
            most, best = turn, (mine, float(np.median(np.abs(points))), complex(points[0]))
    if best is None:
        return None
    mine, radius, at = best
    by = radius - e.radius
    remark = codes.OTHER_CIRCLE(how=of_radius(by, e.radius))
    trace = InkTrace(e, "measured", growth=by, deviation=abs(by), at=e.centre + (e.points - e.centre) * radius / e.radius)
    return replace(f, verdict="amber", deviation=abs(by), remark=remark, at=e.centre + at, trace=trace), mine
