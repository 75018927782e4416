"""What a reader takes a label for: the line or point nearest to it, if nothing lies between.

A label names what it was asked for. Read without knowing that, it names what stands nearest; so its own line or point must be
nearer than any other, and the shortest way there must cross none. Where there is no such place a leader line says it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from math import inf
from typing import Any, NamedTuple

import numpy as np

from tmm_sheets.drawing.canvas import Label
from tmm_sheets.drawing.ink_index import (
    LEADER,
    ROUNDING,
    Flags,
    Floats,
    InkIndex,
    Numbers,
    are_near,
    crosses,
    distance,
    enters,
    sides,
)
from tmm_sheets.drawing.marks import Box, Fill, Points, flat
from tmm_sheets.drawing.text_layout import run_corners

AT = 0.3
"""Lines that pass this near the anchor meet there: a letter at a point is nearer to all of them than to any other, mm."""
SLACK = 0.1
"""By so much another line may be nearer before anybody takes the label for its letter, mm."""

CLEARLY, HARDLY, SEEN = 1.0, 0.4, 9.0
"""By so much its own vector is nearer to a letter that nobody, or hardly anybody, takes for another's, of all within so many mm."""
SYMBOL = 0.6
"""By so much a symbol about the anchor may reach beyond the distance its letter keeps, mm."""

PARALLEL, BESIDE = 0.15, 1.5
"""A leader runs along a line when it turns from it by less than this (sine of the angle) and is nearer than so many mm."""
LED = 10
"""Crossing another leader, which GOST 2.316 forbids, or ending at several vectors is as bad as crossing so many strong lines."""
EVEN = 1e-9
"""Distances that differ by less, mm, are one: what ends on the line that is named does not part it from its letter."""
SPOT = 3.0
"""How vague lettering is whose spot on its vector may be that of another line."""
UNSURE = 0.7
"""A leader that ends so near to a foreign strong line, mm, may be its."""
SHARES = (0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.12, 0.88, 0.05, 0.95)
"""Places along a vector where its letter may stand."""
FINE = 91
"""So many places are tried for the one where a vector is most alone."""
ALONG = 3.0
"""Lines that part within so many mm are seen to be two."""
IN_HEAD = 0.8
"""Part of an arrow head's length, from its tip, at which a leader ends in it: of lines close together it is the widest."""


_Subject = tuple[list[int], tuple[complex, complex] | None]
"""What a label names: numbers of marks, and the ends of its vector if it stands beside one."""


class Surroundings:
    """Segments about a label's anchor, and which of them are its own."""

    def __init__(self, ink: InkIndex, label: Label, reach: float) -> None:
        p = label.anchor
        self.anchor, self._ink, self._label, self._reach = p, ink, label, reach
        near = ink.parting(p, reach)
        a, b, of = ink.a[near], ink.b[near], ink.of[near]
        named, self.vector = subject = _subject(ink, label)
        own, twin = _own_segments(ink, [label], [subject], np.zeros(len(of), int), a, b, of)
        self._lines: tuple[Any, ...] = a, b, of, ink.strong[near], own, twin, ink.sides[:, near]
        rivals = ink.strong[near] & ~own | twin
        self._rivals = a[rivals], b[rivals]
        self._met: Any = None
        self.meet_leaders()
        self.unsure = 0 if self.vector is None else int(self.count_unsure(np.array([p]))[0])
        heads = [mark for n in named if isinstance(mark := ink.marks[n], Fill)] if self.unsure else []
        self._heads = [mark.points for mark in heads if mark.by and mark.by.role == "vector"]
        self.head = next((points for points in self._heads if _is_inside(p, points)), None)

    def meet_leaders(self) -> None:
        """Know the leaders that are near by now: those of other labels name nothing, but for one that runs along the vector."""
        if self._met is self._ink.leaders:
            return
        self._met = a, b = self._ink.leaders
        lines = self._lines
        if len(a) and (near := distance(a, b, self.anchor) <= self._reach).any():
            a, b = a[near], b[near]
            none = np.zeros(len(a), bool)
            own = none if self.vector is None else _lies_along(*self.vector, a, b)
            led = a, b, none + LEADER, none, own, none, sides(a, b)
            lines = tuple([np.concatenate(pair, axis=-1) for pair in zip(lines, led, strict=True)])
        self.a, self.b, self.of, self.strong, self.own, self.twin, self.sides = lines
        self.leaders = self.of == LEADER

    def misreading(self, box: Box) -> str:
        """What is wrong with lettering in a rectangle: "crossed", "nearer", or "" for nothing."""
        boxes = np.array(box)[:, None]
        margin = self._pairs(boxes).margins(boxes, np.array([self.anchor]))[0]
        return "crossed" if margin == -inf else "nearer" if margin < -SLACK else ""

    def judge(self, boxes: Floats) -> tuple[Flags, Floats]:
        """Where lettering in rectangles, shape (4, m), is read as another line's, and how vague it is."""
        m = boxes.shape[1]
        runs = np.empty((4, 0)) if self.vector is None else _runs(self._label.text, self._label.height)
        begins = np.zeros(m, int)
        bad, vague = self._pairs(boxes).judge(boxes, begins + self.anchor, Runs(runs, begins, begins + runs.shape[1]))
        return bad, vague + SPOT * self.unsure

    def _pairs(self, boxes: Floats) -> Pairs:
        """Segments no farther from each rectangle than the anchor is: nothing beyond it is nearer."""
        gap = np.abs(nearest(self.anchor, boxes) - self.anchor)[:, None]
        which, near = self._pairs_within_reach(boxes, np.maximum(gap + ROUNDING, 0.0 if self.vector is None else SEEN))
        return Pairs(which, self.a[near], self.b[near], self.of[near], self.own[near], self.twin[near], self.strong[near])

    def _pairs_within_reach(self, boxes: Floats, reach: Any) -> tuple[Numbers, Numbers]:
        """Pairs of a rectangle, shape (4, m), and a segment within reach of it, by their numbers."""
        which, near = are_near(self.sides, boxes[:, :, None], reach).nonzero()
        return which, near

    def count_crossed(self, starts: Points, ends: Points) -> Numbers:
        """How many strong lines but its own each leader crosses, and lines it runs along or ends at.

        Other leaders count more. ``starts``, at what is named, and ``ends``: shape (m,).
        """
        which, near = self._pairs_within_reach(sides(starts, ends), BESIDE + ROUNDING)
        along, d, foreign = (ends - starts)[which], (self.b - self.a)[near], ~self.own[near]
        parallel = np.abs((d * np.conj(along)).imag) < PARALLEL * np.abs(d) * np.abs(along)
        met = LED * self.count_unsure(self.first_met(starts, ends))
        # Each is asked of those pairs only that it may be true of.
        for asked, meets, weight in ((parallel, _run_along, 1), (foreign & self.strong[near], crosses, 1),
                                     (foreign & self.leaders[near], meet, LED)):
            some = asked.nonzero()[0]
            of, line = which[some], near[some]
            met += weight * np.bincount(of[meets(self.a[line], self.b[line], starts[of], ends[of])], minlength=len(ends))
        return met

    def first_met(self, starts: Points, ends: Points) -> Points:
        """Where an eye that comes along each leader meets what is named: at the edge of the head in which the leader ends."""
        if self.head is None:
            return starts
        a, b, p, q = self.head, np.roll(self.head, -1), starts[:, None], ends[:, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            share = ((a - p) * np.conj(b - a)).imag / ((q - p) * np.conj(b - a)).imag
        return np.asarray(starts + np.where(crosses(a, b, p, q), share, 0.0).max(axis=1) * (ends - starts))

    def count_unsure(self, starts: Points) -> Numbers:
        """How many foreign strong lines, or other vectors on its line, a leader from each point, shape (m,), might name as well."""
        once = starts[:1] if (starts == starts[:1]).all() else starts  # most leaders begin at one anchor
        return np.asarray(np.add.reduce(self._apart(once) < UNSURE, axis=1) + np.zeros(len(starts), int))

    def _apart(self, points: Any) -> Floats:
        """Distances of points, shape (m,), to foreign strong lines and other vectors on the label's line, mm, shape (m, n)."""
        return distance(*self._rivals, points[:, None])

    def runs_together(self) -> bool:
        """Whether another line is one with the vector for a while where its name stands."""
        if self.vector is None or not self._heads:
            return False
        a, b = self.vector
        beside = self.anchor + ALONG * np.array([-1.0, 0.0, 1.0]) * (b - a) / abs(b - a)
        return bool((self._apart(beside).max(axis=0) <= HARDLY).any())

    def places_along(self) -> list[complex]:
        """Other places on the vector that the label names, the nearer the middle the sooner; none where it names no vector."""
        if self.vector is None:
            return []
        a, b = self.vector
        within = [complex(z[0] + IN_HEAD * (z[1:].mean() - z[0])) for z in self._heads]
        places = [z for z in (*[a + share * (b - a) for share in SHARES], *within) if abs(z - self.anchor) > SYMBOL]
        return [*places, self._farthest_from_others(a, b)] if self._heads else places

    def _farthest_from_others(self, a: complex, b: complex) -> complex:
        """Where other lines are farthest from the vector: at the wide end of a fan, or beyond the end of one that runs along it."""
        along = a + np.linspace(min(SHARES), max(SHARES), FINE) * (b - a)
        far = Surroundings(self._ink, self._label, abs(b - a))
        return complex(along[np.argmax(far._apart(along).min(axis=1))])


def _run_along(a: Points, b: Points, start: Points, end: Points) -> Flags:
    """Which segments a .. b, parallel to leaders, each to its own, are beside them, or where they end."""
    apart = (distance(start, end, a), distance(start, end, b), distance(a, b, start + 0.5 * (end - start)), distance(a, b, end))
    return np.asarray(np.minimum.reduce(apart) < BESIDE)


def meet(a: Points, b: Points, start: Any, end: Any) -> Flags:
    """Which leaders, from ``a`` to ``b``, are crossed by another one, or run past the spot where it starts."""
    return np.asarray(crosses(a, b, start, end) | ((distance(a, b, start) < UNSURE) & (np.abs(a - start) > UNSURE)))


class Runs(NamedTuple):
    """Rectangles, shape (4, k), of the parts of letterings from the corner of each: ``counts`` of each from ``begins`` on."""

    boxes: Floats
    begins: Numbers
    counts: Numbers


class Pairs(NamedTuple):
    """Segments ``a`` .. ``b`` of the marks ``of`` that may be near rectangles: ``which`` of them, in ascending order.

    ``own`` are those that the rectangle's lettering names, ``twin`` those of them that are other vectors on one line with it,
    ``strong`` such as are no thin lines.
    """

    which: Numbers
    a: Points
    b: Points
    of: Numbers
    own: Flags
    twin: Flags
    strong: Flags

    def judge(self, boxes: Floats, anchors: Points, runs: Runs) -> tuple[Flags, Floats]:
        """Where lettering in rectangles, shape (4, m), is read as another line's, and how vague it is: see :meth:`clearances`."""
        margins, (clear, hardly) = self.margins(boxes, anchors), self.clearances(boxes, runs)
        return (margins < -SLACK) | (clear < -EVEN), (clear < CLEARLY - EVEN) + 3.0 * hardly

    def margins(self, boxes: Floats, anchors: Points) -> Floats:
        """How much nearer to lettering in each rectangle, shape (4, m), its own line or its anchor is than any other line, mm.

        -inf where a line is between, inf where there is none but its own.
        """
        m, (which, a, b, _, own, *_) = boxes.shape[1], self
        margins, least = np.full((2, m), inf)
        if not len(which):
            return margins
        gaps, starts, ends = _to_box(a, b, boxes[:, which])
        first = _group_starts(which)
        begin, end, rows = nearest(anchors, boxes), anchors.copy(), which[first]
        gap = np.abs(begin - end)
        own_gaps = np.where(own, gaps, inf)
        least[rows] = np.minimum.reduceat(own_gaps, first)
        margins[rows] = np.minimum.reduceat(np.where(own, inf, gaps), first)
        at = np.zeros(m, int)  # the first of its own that is nearest
        hits = (own & (own_gaps == least[which])).nonzero()[0][::-1]
        at[which[hits]] = hits
        nearer = (least < gap).nonzero()[0]
        begin[nearer], end[nearer] = starts[at[nearer]], ends[at[nearer]]
        gap[nearer] = np.abs(begin[nearer] - end[nearer])
        margins -= gap
        way = gap[which]
        between = (~own & (gaps < way - EVEN) & (way > SLACK)).nonzero()[0]
        if len(between):
            row = which[between]
            margins[row[crosses(a[between], b[between], begin[row], end[row])]] = -inf
        return margins

    def clearances(self, boxes: Floats, runs: Runs) -> tuple[Floats, Numbers]:
        """How much nearer the ink of a vector's letter is to its own line than to another strong one, mm; inf where none is seen.

        And how many other lines are as near as its own: of vectors on one line each has its name where it lies with the fewest.

        ``runs`` are those of the lettering in each rectangle; none where it names no vector.
        """
        m = boxes.shape[1]
        found, hardly = np.zeros(m) + inf, np.zeros(m, int)
        if not runs.boxes.size:
            return found, hardly
        near = are_near(sides(self.a, self.b), boxes[:, self.which], SEEN)
        # Of its own the vector alone, not the thin line on which it was laid off and which goes on beyond it.
        drawn = np.bincount(self.which[self.own & self.strong], minlength=m)[self.which] > 0
        asked = (near & (self.strong | self.own & ~drawn) & (runs.counts[self.which] > 0)).nonzero()[0]
        which, alone = self.which[asked], (self.own & ~self.twin)[asked]
        both = (np.bincount(which[alone], minlength=m) > 0) & (np.bincount(which[~alone], minlength=m) > 0)
        asked = asked[both[which]]
        if not len(asked):
            return found, hardly
        count = runs.counts[self.which[asked]]
        pair = asked.repeat(count)  # each segment and each run
        which, own, twin = self.which[pair], (self.own & ~self.twin)[pair], self.twin[pair]
        run = runs.begins[which] + np.arange(len(pair)) - (count.cumsum() - count).repeat(count)
        gaps = _to_box(self.a[pair], self.b[pair], runs.boxes[:, run] + boxes[[0, 1, 0, 1]][:, which])[0]
        first = _group_starts(which)
        rows = which[first]
        foreign, nearest_own = [np.minimum.reduceat(np.where(of, gaps, inf), first) for of in (~own & ~twin, own)]
        found[rows] = foreign - nearest_own
        least = np.zeros(m)
        least[rows] = nearest_own
        beside = (~own & (gaps < least[which] + HARDLY - EVEN)).nonzero()[0]
        for row, _ in {*zip(which[beside].tolist(), self.of[pair[beside]].tolist(), strict=True)}:
            hardly[row] += 1
        return found, hardly


def _group_starts(which: Numbers) -> Numbers:
    """Where each number begins among numbers in ascending order."""
    return np.concatenate(([True], which[1:] != which[:-1])).nonzero()[0]


def read_well(ink: InkIndex, labels: Sequence[Label], boxes: Floats) -> Flags:
    """Which of some labels read as what they name, and clearly, in rectangles of shape (4, n); no leader is looked at.

    As :meth:`Surroundings.judge`, of all labels in one go.
    """
    p = np.array([label.anchor for label in labels])
    subjects = [_subject(ink, label) for label in labels]
    reach = np.maximum(np.abs(nearest(p, boxes) - p) + 2 * AT + ROUNDING,
                       [0.0 if vector is None else SEEN for _, vector in subjects])
    which, near = (ink.parts & are_near(ink.sides, boxes[:, :, None], reach[:, None])).nonzero()
    a, b, of = ink.a[near], ink.b[near], ink.of[near]
    own, twin = _own_segments(ink, labels, subjects, which, a, b, of)
    runs = [_runs(label.text, label.height)[:, :None if vector else 0] for (_, vector), label in zip(subjects, labels, strict=True)]
    counts = np.array([run.shape[1] for run in runs])
    pairs = Pairs(which, a, b, of, own, twin, ink.strong[near])
    misread, vague = pairs.judge(boxes, p, Runs(np.hstack(runs), counts.cumsum() - counts, counts))
    return np.asarray(~misread & (vague == 0))


@lru_cache(maxsize=8192)
def _runs(text: str, height: float) -> Floats:
    return np.array([Box.around(run) for run in run_corners(text, height)]).reshape(-1, 4).T


def _subject(ink: InkIndex, label: Label) -> _Subject:
    if label not in ink.subjects:
        ink.subjects[label] = (named := _named(ink, label)), _vector(ink, label, named)
    return ink.subjects[label]


def _own_segments(ink: InkIndex, labels: Sequence[Label], subjects: Sequence[_Subject], which: Numbers, a: Points, b: Points,
                  of: Numbers) -> tuple[Flags, Flags]:
    """Which segments, near the labels numbered ``which``, these may stand for; and which of them are other vectors on their line.

    A label stands for the step it names and for what meets or lies about its anchor; but the letter of a vector or a curve stands
    beside it: there lines that only pass by the anchor are foreign. What lies on a vector is named together with it.
    """
    at = np.array([label.anchor for label in labels])[which]
    steps = np.zeros((len(labels), len(ink.marks)), bool)
    for k, (named, _) in enumerate(subjects):
        steps[k, named] = True
    found, apart = steps[which, of], distance(a, b, at)
    alone, on = np.bincount(which[found], minlength=len(labels)) > 0, np.zeros(len(labels), bool)
    for k, number in dict.fromkeys(zip(*[v[found & (apart <= 2 * AT)].tolist() for v in (which, of)], strict=True)):
        on[k] = True
        alone[k] &= np.abs(flat(ink.marks[number])[[0, -1]] - labels[k].anchor).min() > 2 * AT
    of_vector = np.array([vector is not None for _, vector in subjects])
    alone = alone & on | of_vector
    gaps = np.array([label.gap + SYMBOL for label in labels])[which]
    own = found | ~alone[which] & ((np.maximum(np.abs(a - at), np.abs(b - at)) <= gaps) | (apart <= AT))
    twin = np.zeros(len(which), bool)
    if of_vector.any():
        beside = of_vector[which].nonzero()[0]
        u, v = np.array([vector or (inf, inf) for _, vector in subjects])[which[beside]].T
        along = _lies_along(u, v, a[beside], b[beside])
        for k in beside[along & ~own[beside]].tolist():
            twin[k] = (by := ink.marks[of[k]].by) is not None and by.role == "vector"
        own[beside] |= along
    return own, twin


def _lies_along(u: Any, v: Any, a: Points, b: Points) -> Flags:
    """Which segments a .. b lie on the line u .. v, or each on its own."""
    return np.asarray(np.maximum(distance(u, v, a), distance(u, v, b)) <= AT)


def nearest(p: Any, boxes: Floats) -> Points:
    """The point of each rectangle, shape (4, m), nearest to a point, or each to its own."""
    x0, y0, x1, y1 = boxes
    found: Points = np.minimum(np.maximum(p.real, x0), x1) + 1j * np.minimum(np.maximum(p.imag, y0), y1)
    return found


def _named(ink: InkIndex, label: Label) -> list[int]:
    """Numbers of the marks of the step that a label names; of its vectors only the one on which its anchor lies, without the point.

    Several forces of a plan end at one of its points, and so in one step: a letter at the point itself names them all.
    """
    if label.by is None or not label.by.step:
        return []
    found = ink.of_step(label.by)
    vectors = {n: ends for n, (ends, role) in ink.lines_of(label.by).items() if role == "vector"}
    apart = {n: _apart(*ends, label.anchor) for n, ends in vectors.items()}
    least = min(apart.values(), default=inf)
    foreign = {n for n in apart if apart[n] > least + 1e-3}
    if least > AT:
        return found
    others = {ink.marks[n].by for n in foreign} - {ink.marks[n].by for n in vectors.keys() - foreign}
    return [n for n in found if n not in foreign and (by := ink.marks[n].by) not in others and by and by.role != "point"]


def _vector(ink: InkIndex, label: Label, named: Sequence[int]) -> tuple[complex, complex] | None:
    """Ends of the vector, or of the construction line or line of a detail named by its own letter, beside which a label stands."""
    if label.by is None:
        return None
    roles = {"vector"} | {"construction", "symbol"} & {label.by.role}
    lines = ink.lines_of(label.by) if named else {}
    return next((ends for n, (ends, role) in lines.items() if role in roles and n in named
                 and _apart(*ends, label.anchor) <= 2 * AT and min([abs(z - label.anchor) for z in ends]) > 2 * AT), None)


def _apart(a: complex, b: complex, p: complex) -> float:
    """Distance of a point to a line, without an array."""
    t = ((p - a) * (b - a).conjugate()).real / max(abs(b - a) ** 2, 1e-18)
    return abs(a + (0.0 if t < 0.0 else 1.0 if t > 1.0 else t) * (b - a) - p)


def _is_inside(p: complex, corners: Points) -> bool:
    """Whether a point lies inside a convex polygon, or on its edge."""
    sides_ = ((corners - p) * np.conj(np.roll(corners, -1) - p)).imag
    return bool((sides_ >= -EVEN).all() or (sides_ <= EVEN).all())


def _to_box(a: Any, b: Any, box: Iterable[Any]) -> tuple[Floats, Any, Any]:
    """Distances of segments to a rectangle, or each to its own (x0, y0, x1, y1, shape (n,) then), 0 where they meet;
    the nearest points on the rectangle and on the segment.
    """
    x0, y0, x1, y1 = box
    corners = np.array([x0 + 1j * y0, x1 + 1j * y0, x1 + 1j * y1, x0 + 1j * y1]).reshape(4, -1)
    d = b - a
    length2 = np.maximum(d.real**2 + d.imag**2, 1e-18)
    t = np.minimum(np.maximum(((corners - a) * np.conj(d)).real / length2, 0.0), 1.0)
    on = np.concatenate((a + t * d, [a, b]))
    at = np.minimum(np.maximum(on.real, x0), x1) + 1j * np.minimum(np.maximum(on.imag, y0), y1)
    gaps = np.abs(on - at)
    best = gaps.argmin(axis=0)
    k = np.arange(len(a))
    gap = gaps[best, k]
    gap[enters(a, d, x0, y0, x1, y1)] = 0.0
    return gap, at[best, k], on[best, k]
