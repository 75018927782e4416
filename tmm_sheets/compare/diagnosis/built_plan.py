"""Plans that were built on a wrong step: what was done, and the plan as it would be with that.

A plan whose lines do not lie where ours do is drawn again with each mistake that can be made in it, and with each of its points
where the drawing has the end of a line; the mistake with which most of the plan has ink is what was done. The plan is then compared
as it was built: its lines are found, though not in their places. A :class:`Drawing` tells what
has ink, in a CAD file or a photograph.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, get_args

import numpy as np
from numpy.typing import NDArray

from tmm_sheets.compare import codes
from tmm_sheets.compare.codes import Own, Remark, Sentence
from tmm_sheets.compare.diagnosis.hypotheses import (
    Change,
    Hypothesis,
    Kind,
    any_of,
    displaced,
    hypotheses,
    of_other_positions,
    replay,
)
from tmm_sheets.compare.elements import Element, ElementView, KnownSheet, plans_of, sampled
from tmm_sheets.compare.findings import FindingRecord, millimetres
from tmm_sheets.compare.placing import HINGE, shafts
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.protocol import letter_of
from tmm_sheets.construction.step import Plan, Step, ordered
from tmm_sheets.drawing.marks import Arc, Fill, PlacedFrame, Points
from tmm_sheets.words import marked, tell

if TYPE_CHECKING:
    from tmm_sheets.project import Project

AT_POINT = 0.03
"""Distance within which an end of a line is at a point of the plan, mm of our sheet."""
BESIDE = 10.0
"""How far from its point a letter may stand, mm of our sheet."""
SHOWS = 1.0
"""How far a point must be moved for a mistake to show, mm of our sheet."""
DRAWN = 1.0
"""A vector that would be shorter than this, mm of our sheet, is not drawn."""
POSITIONS = "positions"
"""Name of the plan of the positions."""
MARK = 6.0
"""How far from its point the middle of a symbol may be, mm of our sheet."""
PAPER = 3000.0
"""A plan that would be wider than this, mm of our sheet, is on nobody's paper: lines of it are nearly parallel."""


@dataclass(frozen=True)
class PlanPoint:
    """A point of a plan: its step, where it is on the sheet, and where it comes to lie.

    ``k`` is the number of its position, ``label`` that of what is drawn of this position only; "" where all is of one.
    """

    step: Step
    was: complex
    now: complex
    k: int = 0
    label: str = ""


@dataclass(frozen=True)
class DrawnPlan:
    """A plan on the sheet: its vectors, and the points at which their ends are; several may be in one place."""

    plan: Plan
    frame: PlacedFrame
    k: int
    vectors: tuple[Element, ...]
    points: tuple[PlanPoint, ...]

    def moved(self, value: Callable[[Step], Any]) -> tuple[PlanPoint, ...]:
        """Its points in a construction drawn again; none where none of them moves or one cannot be built."""
        new = tuple(replace(p, now=now) for p, now in zip(self.points, self.places(value).tolist(), strict=True))
        far = np.abs([p.now - p.was for p in new])
        return new if len(far) and (far <= PAPER).all() and far.max() >= SHOWS else ()  # NaN is on no paper either

    def places(self, value: Callable[[Step], Any]) -> Points:
        """Where its points are in a construction drawn again; NaN of what cannot be built."""
        with np.errstate(all="ignore"):
            return np.array([self.place(value(p.step), p.k) for p in self.points], dtype=complex)

    def place(self, value: Any, k: int) -> complex:
        """Where a point of the plan, or that of a position, is on the sheet."""
        made = np.asarray(value)
        return complex(self.frame(complex(made[k] if made.ndim else made)))

    @property
    def positions(self) -> list[int]:
        """Numbers of the positions it is of."""
        return sorted({p.k for p in self.points if p.label} or {self.k})

    @property
    def of_positions(self) -> bool:
        """Whether it is the mechanism at all its positions."""
        return self.plan.name == POSITIONS

    def back(self, z: complex) -> complex:
        """The point of the plan at a place on the sheet."""
        w = (z - self.frame.origin) * np.exp(-1j * self.frame.turn)
        w = np.conj(w) if self.frame.mirror else w
        return complex(w.real * self.frame.mu[0], w.imag * self.frame.mu[1])


def drawn_plan(known: KnownSheet, plans: Mapping[str, Plan], view: ElementView) -> DrawnPlan | None:
    """The plan that a view shows, None where it shows none of vectors."""
    vectors = [e for e in known.elements if e.view == view and e.role == "vector" and e.kind == "line" and e.by is not None
               and e.by.frame >= 0]
    frames = {known.sheet.frames[e.by.frame] for e in vectors if e.by is not None}
    frame = next(iter(frames)) if len(frames) == 1 else None
    plan = plans.get(frame.plan) if frame is not None else None
    if frame is None or plan is None or frame.position not in plan.labels:
        return None
    shown = DrawnPlan(plan, frame, plan.labels.index(frame.position), tuple(vectors), ())
    ends = np.concatenate([e.points for e in vectors])
    points = []
    for step in plan:
        if np.asarray(step.value).dtype.kind == "c" and step.rule.gives in ("point", "vector", "force"):
            z = shown.place(step.value, shown.k)
            if np.isfinite(z) and np.abs(ends - z).min() < AT_POINT:
                points.append(PlanPoint(step, z, z, shown.k))
    at = np.array([p.was for p in points], dtype=complex)
    both = sum(len(at) > 0 and all(np.abs(at - z).min() < AT_POINT for z in e.points) for e in vectors)
    # Forces at the points of a mechanism are no plan: only one end of each is a point.
    return replace(shown, points=tuple(points)) if both > len(vectors) / 2 else None


def drawn_positions(known: KnownSheet, plans: Mapping[str, Plan], view: ElementView) -> DrawnPlan | None:
    """The positions of the mechanism that a view shows, its links for vectors; None where it shows none."""
    links = [e for e in known.elements if e.view == view and e.role == "link" and e.kind == "line" and e.by is not None
             and e.by.frame >= 0]
    frames = {known.sheet.frames[e.by.frame] for e in links if e.by is not None}
    frame = next(iter(frames)) if len(frames) == 1 else None
    plan = plans.get(POSITIONS)
    if frame is None or plan is None or frame.plan != POSITIONS or frame.position:
        return None
    labels = {e.position for e in links}
    shown = DrawnPlan(plan, frame, 0, tuple(links), ())
    points = []
    for step in plan:
        if step.rule.gives == "point":
            at = [(k, label) for k, label in enumerate(plan.labels) if label in labels] if np.ndim(step.value) else [(0, "")]
            places = [(shown.place(step.value, k), k, label) for k, label in at]
            points += [PlanPoint(step, z, z, k, label) for z, k, label in places if np.isfinite(z)]
    return replace(shown, points=tuple(points))


def _of(e: Element, points: Sequence[PlanPoint]) -> list[PlanPoint]:
    """The points that an element may belong to: those of its position."""
    return [p for p in points if not p.label or p.label == e.position]


def between(e: Element, points: Sequence[PlanPoint]) -> Points:
    """A line through points of the plan where these come to lie; it reaches as far over them as it did."""
    a, b = complex(e.points[0]), complex(e.points[-1])
    u = (b - a) / max(abs(b - a), 1e-9)
    along = [((p.was - a) * np.conj(u), p) for p in _of(e, points)]
    short = HINGE if e.role == "link" else AT_POINT  # a link ends at the circle of its hinge
    on = [(z.real, p) for z, p in along if abs(z.imag) < AT_POINT and -short < z.real < abs(b - a) + short]
    if len(on) < 2:
        return np.array([a, b])
    low, high = min(s for s, _ in on), max(s for s, _ in on)
    first, last = (_meant(e, [p for s, p in on if abs(s - end) < AT_POINT]) for end in (low, high))
    if abs(first.now - first.was) < 1e-9 and abs(last.now - last.was) < 1e-9:
        return np.array([a, b])
    v = (last.now - first.now) / abs(last.now - first.now) if abs(last.now - first.now) > 1e-6 else u
    return np.array([first.now - low * v, last.now + (abs(b - a) - high) * v])


def _meant(e: Element, some: Sequence[PlanPoint]) -> PlanPoint:
    """Of points in one place that which an element is named after: they may come to lie apart."""
    names = e.name.split("–")
    return min(some, key=lambda p: (p.step.path != e.step, letter_of(p.step) not in names))


def rebuilt(e: Element, points: Sequence[PlanPoint]) -> Element:
    """An element of a plan whose points come to lie elsewhere; what hangs over a point, and heads, keep their size."""
    points = _of(e, points)
    at_one = [p for p in points if p.label]
    if at_one and e.role in ("symbol", "point") and e.kind != "circle":
        return _with_its_point(e, at_one)
    if e.kind == "line":
        new = between(e, points)
        if np.array_equal(new, e.points):
            return e
        if abs(new[1] - new[0]) < DRAWN:
            return replace(e, points=new[[0, 0]], fills=(), marks=())
        turn = (new[1] - new[0]) / (e.points[1] - e.points[0])
        turn /= abs(turn)
        fills = tuple(_head(f, e.points, new, turn) for f in e.fills)
        heads = [m._replace(points=_head(np.asarray(m.points), e.points, new, turn)) if isinstance(m, Fill) else m for m in e.marks]
        marks = shafts(e.marks, heads, e.points, new)
        return replace(e, points=new, fills=fills, marks=marks)
    at = e.centre if e.kind == "circle" else e.middle if e.kind == "text" and e.step else None
    off = min((abs(p.was - at) for p in points), default=np.inf) if at is not None else np.inf
    if at is None or off > (AT_POINT if e.kind == "circle" else BESIDE):
        return e
    one = _meant(e, [p for p in points if abs(p.was - at) < off + AT_POINT])
    return _shifted(e, one.now - one.was)


def _with_its_point(e: Element, points: Sequence[PlanPoint]) -> Element:
    """A symbol goes with the point it is drawn at."""
    near = min(points, key=lambda p: abs(p.was - e.middle))
    stays = abs(near.was - e.middle) > MARK or abs(near.now - near.was) < AT_POINT
    return e if stays else _shifted(e, near.now - near.was)


def _shifted(e: Element, by: complex) -> Element:
    """An element elsewhere; heads and arcs go with it."""
    return replace(e, points=e.points + by, centre=e.centre + by, fills=tuple(f + by for f in e.fills),
                   pieces=tuple(p + by for p in e.pieces),
                   marks=tuple(m._replace(centre=m.centre + by) if isinstance(m, Arc) else m for m in e.marks))


def vanished(e: Element) -> bool:
    """Whether a line of a rebuilt plan is too short to be drawn."""
    return e.kind == "line" and not e.marks and e.length == 0


def _head(f: Points, was: Points, now: Points, turn: complex) -> Points:
    """A head goes with the end it is at."""
    k = int(np.abs(was - f[0]).argmin())
    return np.asarray(now[k] + (f - was[k]) * turn)


KINDS = get_args(Kind)
"""Kinds of mistakes, the more usual first."""
Inked = Callable[[Points], float]
"""Share of a line, by both its ends, mm of our sheet, that ink in its direction covers in a drawing."""

WHOLE = 0.85
"""Share of a line that must have ink for the line to be drawn."""
MOST = 0.8
"""Share of a plan, by length, that must have ink where a mistake leads, for the plan to be built on it."""
GAIN, OF_REST = 0.12, 0.6
"""By how much that must be more than has ink in its place, or, where only short lines are wrong, by what share of what has none."""
AS_GOOD = 0.97
"""Share of the best explanation with which a more usual mistake is as good."""
EQUAL = 0.02
"""Difference of shares of ink that tells nothing."""
WEIGHT = 25.0
"""A longer vector tells no more than one of this length, mm of our sheet."""
BEYOND, ASIDE = 1.0, 0.3
"""How far beyond the end of a line it is looked whether it goes on, and how near another one has the same ink, mm of our sheet."""
SAME, TOLD = 0.1, 3
"""How near points of a plan are, mm of our sheet, that two mistakes lead to the same place; how many such mistakes are told."""
NEW_INK = 2
"""Places of ink, 1 mm, that a plan with a point elsewhere must have more: else its line only lies on another one."""
FARTHEST = 250.0
"""A point is sought among the tips of lines no farther than this from its place, mm."""


AT_POSITION = Sentence("built-otherwise", marked("{mistake} (position {position})"))


@dataclass(frozen=True)
class BuiltPlan:
    """A plan that was built on a mistake, and how many of its wrong lines that explains; the point that is off where it is none.

    ``step`` is the one that was done wrong, ``label`` the position of the plan; ``position`` is that label in a plan of several.
    ``alike`` are mistakes that lead to the very same drawing.
    """

    mistake: Hypothesis | Remark
    explains: int
    of: int
    step: Step
    label: str
    position: str = ""
    alike: tuple[Hypothesis, ...] = ()

    @property
    def remark(self) -> Remark:
        """What was done wrong, or whatever draws the same."""
        done = self.mistake if isinstance(self.mistake, Remark) else any_of((self.mistake, *self.alike))
        return AT_POSITION(mistake=done, position=Own(self.position)) if self.position else done

    def said(self) -> str:
        """What was done wrong, as the reader reads it."""
        return self.remark.said()

    def explained(self) -> str:
        """How much of the plan it explains."""
        return tell("this explains {n} of {all} wrong lines of the plan").format(n=self.explains, all=self.of)


def of_built(built: Mapping[ElementView, BuiltPlan]) -> dict[ElementView, FindingRecord]:
    """What is listed of views that were built on mistakes: what was done in a view before is told there, and follows."""
    first: dict[Remark, FindingRecord] = {}
    out = {}
    for view, b in built.items():
        h = b.mistake
        beside = {"kind": h.kind, "mistake": h.words} if isinstance(h, Hypothesis) else {}
        record = FindingRecord(b.remark, "red", view.name, b.step.plan, b.step.path, b.label, whole=True,
                               follows=first.get(b.remark), beside={**beside, "explains": b.explains, "of": b.of})
        out[view] = record
        first.setdefault(b.remark, record)
    return out


@dataclass(frozen=True)
class _Mistake:
    """What was done wrong: one of the usual mistakes, or a point that is off; and what to replay."""

    said: Hypothesis | Remark
    changes: tuple[Change, ...]


@dataclass(frozen=True)
class _Found:
    """A mistake with where it takes the points of a plan, and the share of the plan that has ink there."""

    share: float
    points: Sequence[PlanPoint]
    mistake: _Mistake


@dataclass(frozen=True)
class StudentDrawing:
    """A view of a drawing, by mm of our sheet: what share of a line has ink, which places, the ends of its lines; its scale."""

    inked: Inked
    ink: Callable[[Points], NDArray[np.bool_]]
    tips: Sequence[complex]
    scale: float = 1.0



def errors_of(project: Project, known: KnownSheet) -> tuple[dict[str, Plan], Errors]:
    """The plans of a project by their names, and how those on a sheet are drawn again."""
    plans = plans_of(project, known)
    return plans, Errors([(plans[f.plan], f.mu[0]) for f in known.sheet.frames if f.plan in plans])


def built_otherwise(project: Project, known: KnownSheet, wrong: Mapping[ElementView, Sequence[Element]],
                    seen: Callable[[ElementView], StudentDrawing]) -> dict[
                        ElementView, tuple[BuiltPlan, Sequence[PlanPoint]]]:
    """Views whose plans were built on a mistake, with the mistake and where it takes the points of the plan, mm of our sheet.

    ``wrong`` are the vectors of views that are not where they belong, as they should be.
    """
    if not wrong:
        return {}
    plans, errors = errors_of(project, known)
    shown = {view: drawn for view in dict.fromkeys(e.view for e in known.elements)
             if (drawn := drawn_plan(known, plans, view)) is not None}
    drawings = {view: seen(view) for view in shown}
    share = {view: _share(drawn, drawings[view], drawn.points) for view, drawn in shown.items()}
    before: list[_Mistake] = []

    weight = {view: sum(e.length for e in drawn.vectors) for view, drawn in shown.items()}

    def gain(mistake: _Mistake) -> float:
        """By how much more ink the whole sheet has with a mistake; infinitely less where a plan has it where it should be."""
        value = _replay(errors, (*before, mistake))
        more = {view: _share(drawn, drawings[view], points) - share[view]
                for view, drawn in shown.items() if (points := drawn.moved(value))}
        if min(more.values(), default=0.0) <= -GAIN:
            return -np.inf
        return sum(weight[view] * m for view, m in more.items())

    order, out = list(plans), {}
    alike: dict[int, Sequence[Hypothesis]] = {}
    for view, drawn in sorted(shown.items(), key=lambda x: order.index(x[1].plan.name)):
        found = _explained(drawn, errors, drawings[view], share[view], before, gain) if view in wrong else None
        if found is not None:
            numbers = {e.number for e in wrong[view]}
            there = {e.number: line for e in drawn.vectors for line in [between(e, found.points)]
                     if drawings[view].inked(line) >= WHOLE}
            # A line that goes elsewhere is wrong, though the ink of another one made it look right.
            numbers |= {e.number for e in drawn.vectors
                        if e.number in there and np.abs(there[e.number] - e.points[[0, -1]]).max() >= SHOWS}
            h = found.mistake.said
            share[view] = found.share
            if found.mistake not in before:
                before.append(found.mistake)
            explained = len(numbers & there.keys()), len(numbers)
            if isinstance(h, Remark):
                out[view] = BuiltPlan(h, *explained, found.mistake.changes[0].step, drawn.plan.labels[drawn.k]), found.points
                continue
            if id(h) not in alike:
                of = list(shown.values()) if found.mistake in before else [drawn]
                alike[id(h)] = _alike(h, [m for m in before if m.said is not h], drawn, of, errors)
            label = "" if h.at is None else drawn.plan.labels[h.at]
            first, *others = alike[id(h)]
            out[view] = BuiltPlan(first, *explained, first.step, label, alike=tuple(others)), found.points
    return out


def explains(usual: float, now: float) -> bool:
    """Whether a mistake explains a plan of which so much has ink in its place, and so much with the mistake."""
    return now - usual > min(GAIN, max(EQUAL, OF_REST * (1 - usual)))


def possible(shown: Iterable[DrawnPlan], errors: Errors) -> list[Hypothesis]:
    """Mistakes that can be made in some plans and in what they come from, the more usual kinds first, each once."""
    found: dict[tuple[object, ...], Hypothesis] = {}
    for drawn in shown:
        steps = [p.step for p in drawn.points]
        before = list(ordered(steps, lambda step: [a for a in errors.arguments(step) if isinstance(a, Step)]))
        for k in drawn.positions:
            for h in (*hypotheses(before, k, drawn.plan.labels), *of_other_positions(steps, k, drawn.plan.labels)):
                found.setdefault((h.words, id(h.step), h.at, h.other), h)
    return sorted(found.values(), key=lambda h: KINDS.index(h.kind))


def _replay(errors: Errors, mistakes: Iterable[_Mistake]) -> Callable[[Step], Any]:
    """The construction with mistakes."""
    return replay(errors, [c for m in mistakes for c in m.changes])


def _alike(mistake: Hypothesis, others: Sequence[_Mistake], drawn: DrawnPlan, of: Sequence[DrawnPlan],
           errors: Errors) -> Sequence[Hypothesis]:
    """A mistake that was found in a plan with others that draw the same of it and ``of`` all: no drawing tells these apart."""
    value = _replay(errors, [*others, _Mistake(mistake, mistake.changes)])
    same = [mistake]
    for h in possible([drawn], errors):
        if h.words != mistake.words or h.step is not mistake.step:
            other = _replay(errors, [*others, _Mistake(h, h.changes)])
            if all(np.allclose(plan.places(other), plan.places(value), 0, SAME, equal_nan=True) for plan in (drawn, *of)):
                same.append(h)
    return same[:TOLD]


def _explained(drawn: DrawnPlan, errors: Errors, drawing: StudentDrawing, usual: float, before: Sequence[_Mistake],
               gain: Callable[[_Mistake], float]) -> _Found | None:
    """The mistake with which most of a plan has ink, if that is much more than has ink without it, ``usual``.

    What was done wrong in plans ``before`` it may lead on to this one; where that does, nothing else is looked for. Of mistakes
    with which it has as much ink that one is told which explains most of the whole sheet.
    """
    def tried(mistakes: Iterable[_Mistake], made: Sequence[_Mistake]) -> list[_Found]:
        out = []
        for m in mistakes:
            points = drawn.moved(_replay(errors, (*made, m)))
            share = _share(drawn, drawing, points) if points else 0.0
            if share >= MOST and explains(usual, share):
                out.append(_Found(share, points, m))
        return out

    led_on = tried(before, [])
    if before:
        led_on += [replace(f, mistake=before[-1]) for f in tried(before[-1:], before[:-1])]
    if led_on:
        return max(led_on, key=lambda f: f.share)
    usual_ones = _best(tried((_Mistake(h, h.changes) for h in possible([drawn], errors)), before), gain)
    if usual_ones:
        most = max(gained for gained, _ in usual_ones)
        return next(f for gained, f in usual_ones if gained >= AS_GOOD * most)
    # A point may lie on another one, or on another vector: that only makes what is wrong disappear.
    off = [(_ink(drawn, drawing, f.points), f) for _, f in _best(tried(_points_off(drawn, drawing), before), gain)]
    most, best = max(off, key=lambda x: x[0], default=(0, None))
    return best if most > _ink(drawn, drawing, drawn.points) + NEW_INK else None


def _best(found: Sequence[_Found], gain: Callable[[_Mistake], float]) -> list[tuple[float, _Found]]:
    """Those with which a plan has most ink, or nearly, of those with which the whole sheet has more; with by how much more."""
    gains = [(more, f) for f in found if (more := gain(f.mistake)) > 0]
    best = max((f.share for _, f in gains), default=0.0)
    return [(more, f) for more, f in gains if f.share >= AS_GOOD * best]


def _points_off(drawn: DrawnPlan, drawing: StudentDrawing) -> Iterator[_Mistake]:
    """One of the points of a plan at the end of a line of the drawing, with how far off that is."""
    tips = np.array(drawing.tips, dtype=complex)
    near = tips[np.abs(tips - complex(np.mean([p.was for p in drawn.points]))) < FARTHEST].tolist()
    for p in drawn.points:
        if not isinstance(p.step.args[0] if p.step.args else None, Step):
            continue
        for at in near:
            off = abs(at - p.was)
            if SHOWS < off < FARTHEST:
                by = drawn.back(at) - drawn.back(p.was)
                yield _Mistake(codes.POINT_MOVED_ON(point=letter_of(p.step), distance=millimetres(off * drawing.scale)),
                               (Change(p.step, displaced(by), drawn.k),))


def _share(drawn: DrawnPlan, drawing: StudentDrawing, points: Sequence[PlanPoint]) -> float:
    """Share of a plan's vectors, by length, that are drawn where its points come to lie; what becomes too short is not drawn."""
    there = whole = 0.0
    lines = [(max(length, e.length), line) for e in drawn.vectors for line in [between(e, points)]
             for length in [abs(line[1] - line[0])] if length > DRAWN]
    for length, line in lines:
        weight = min(length, WEIGHT)
        whole += weight
        there += weight * (drawing.inked(line) >= WHOLE)
    return there / whole if whole else 0.0


def _ink(drawn: DrawnPlan, drawing: StudentDrawing, points: Sequence[PlanPoint]) -> int:
    """How much ink a plan's vectors have together where its points come to lie, in places of a millimetre."""
    some = np.concatenate([sampled(between(e, points), 0.5)[0] for e in drawn.vectors if abs(np.diff(between(e, points))[0]) > 0.5])
    return len(np.unique(np.round(some[drawing.ink(some)])))
