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

from tmm_sheets.compare.diagnosis.hypotheses import Hypothesis, Kind, hypotheses
from tmm_sheets.compare.diagnosis.replay import Change, displaced, replay
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.findings import millimetres
from tmm_sheets.compare.known_sheet import KnownSheet
from tmm_sheets.compare.placing import shafts
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.protocol import letter_of
from tmm_sheets.construction.step import Step, ordered
from tmm_sheets.drawing.marks import Arc, Fill, PlacedFrame, Points
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.project import Project

Inked = Callable[[Points], float]
"""Share of a line, by both its ends, mm of our sheet, that ink in its direction covers in a drawing."""

AT_POINT = 0.03
"""Distance within which an end of a line is at a point of the plan, mm of our sheet."""
BESIDE = 10.0
"""How far from its point a letter may stand, mm of our sheet."""
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
SHOWS = 1.0
"""How far a point must be moved for a mistake to show, mm of our sheet."""
FARTHEST = 250.0
"""A point is sought among the tips of lines no farther than this from its place, mm."""
PAPER = 3000.0
"""A plan that would be wider than this, mm of our sheet, is on nobody's paper: lines of it are nearly parallel."""


@dataclass(frozen=True)
class BuiltPlan:
    """A plan that was built on a mistake, and how many of its wrong lines that explains; the point that is off where it is none."""

    mistake: Hypothesis | str
    explains: int
    of: int

    def said(self) -> str:
        """What was done wrong."""
        return self.mistake if isinstance(self.mistake, str) else self.mistake.said()

    def explained(self) -> str:
        """How much of the plan it explains."""
        return tell("this explains {n} of {all} wrong lines of the plan").format(n=self.explains, all=self.of)


@dataclass(frozen=True)
class DrawnPlan:
    """A plan on the sheet: its vectors, and the steps at whose points their ends are, by place."""

    plan: Plan
    frame: PlacedFrame
    k: int
    vectors: tuple[Element, ...]
    steps: Mapping[complex, Step]


@dataclass(frozen=True)
class _Mistake:
    """What was done wrong: one of the usual mistakes, or, in words, a point that is off; and what to replay."""

    said: Hypothesis | str
    changes: tuple[Change, ...]


@dataclass(frozen=True)
class _Found:
    """A mistake with where it takes the points of a plan, and the share of the plan that has ink there."""

    share: float
    points: Mapping[complex, complex]
    mistake: _Mistake


@dataclass(frozen=True)
class Drawing:
    """A view of a drawing: what ink it has, the ends of its lines, mm of our sheet, and its scale, its mm by ours."""

    inked: Inked
    tips: Sequence[complex]
    scale: float = 1.0


def errors_of(project: Project, known: KnownSheet) -> tuple[dict[str, Plan], Errors]:
    """The plans of a project by their names, and how those on a sheet are drawn again."""
    plans = {plan.name: plan for some in project.plans.values() for plan in (some or {}).values()}
    return plans, Errors([(plans[f.plan], f.mu[0]) for f in known.sheet.frames if f.plan in plans])


def built_otherwise(project: Project, known: KnownSheet, wrong: Mapping[ElementView, Sequence[Element]],
                    seen: Callable[[ElementView], Drawing], made: Sequence[Hypothesis] = ()) -> dict[
                        ElementView, tuple[BuiltPlan, Mapping[complex, complex]]]:
    """Views whose plans were built on a mistake, with the mistake and where it takes the points of the plan, mm of our sheet.

    ``wrong`` are the vectors of views that are not where they belong, as they should be; ``made`` are mistakes of the sheet that
    are known already.
    """
    if not wrong:
        return {}
    plans, errors = errors_of(project, known)
    shown = {view: drawn for view in dict.fromkeys(e.view for e in known.elements)
             if (drawn := drawn_plan(known, plans, view)) is not None}
    drawings = {view: seen(view) for view in shown}
    share = {view: _share(drawn, drawings[view].inked, {z: z for z in drawn.steps}) for view, drawn in shown.items()}
    before = [_Mistake(h, h.changes) for h in made]

    def agrees(mistake: _Mistake) -> bool:
        """Whether no other plan of the sheet has less ink with the mistake than it has without."""
        value = replay(errors, [c for m in (*before, mistake) for c in m.changes])
        return all(not points or _share(drawn, drawings[view].inked, points) > share[view] - GAIN
                   for view, drawn in shown.items() if (points := moved_points(drawn, value)) is not None)

    order, out = list(plans), {}
    for view, drawn in sorted(shown.items(), key=lambda x: order.index(x[1].plan.name)):
        found = _explained(drawn, errors, drawings[view], share[view], before, agrees) if view in wrong else None
        if found is not None:
            numbers = {e.number for e in wrong[view]}
            told = sum(drawings[view].inked(between(e.points, found.points)) >= WHOLE
                       for e in drawn.vectors if e.number in numbers)
            out[view] = BuiltPlan(found.mistake.said, told, len(numbers)), found.points
            share[view] = found.share
            if found.mistake not in before:
                before.append(found.mistake)
    return out


def explains(usual: float, now: float) -> bool:
    """Whether a mistake explains a plan of which so much has ink in its place, and so much with the mistake."""
    return now - usual > min(GAIN, max(EQUAL, OF_REST * (1 - usual)))


def possible(shown: Iterable[DrawnPlan], errors: Errors) -> list[Hypothesis]:
    """Mistakes that can be made in some plans and in what they come from, the more usual kinds first, each once."""
    found: dict[tuple[object, ...], Hypothesis] = {}
    for drawn in shown:
        before = list(ordered(drawn.steps.values(), lambda step: [a for a in errors.arguments(step) if isinstance(a, Step)]))
        for h in hypotheses(before, drawn.k, drawn.plan.labels):
            found.setdefault((h.words, id(h.step), h.at, h.other), h)
    kinds = get_args(Kind)
    return sorted(found.values(), key=lambda h: kinds.index(h.kind))


def rebuilt(e: Element, points: Mapping[complex, complex]) -> Element:
    """An element of a plan whose points come to lie elsewhere; what hangs over a point, and heads, keep their size."""
    if e.kind == "line":
        new = between(e.points, points)
        if np.array_equal(new, e.points) or abs(new[1] - new[0]) < 1e-6:
            return e
        turn = (new[1] - new[0]) / (e.points[1] - e.points[0])
        turn /= abs(turn)
        fills = tuple(_head(f, e.points, new, turn) for f in e.fills)
        heads = [m._replace(points=_head(np.asarray(m.points), e.points, new, turn)) if isinstance(m, Fill) else m for m in e.marks]
        marks = shafts(e.marks, heads, e.points, new)
        return replace(e, points=new, fills=fills, marks=marks)
    at = e.centre if e.kind == "circle" else e.middle if e.kind == "text" and e.step else None
    near = min(points, key=lambda z: abs(z - at), default=None) if at is not None else None
    if at is None or near is None or abs(near - at) > (AT_POINT if e.kind == "circle" else BESIDE):
        return e
    by = points[near] - near
    return replace(e, points=e.points + by, centre=e.centre + by, fills=tuple(f + by for f in e.fills),
                   marks=tuple(m._replace(centre=m.centre + by) if isinstance(m, Arc) else m for m in e.marks))


def _head(f: Points, was: Points, now: Points, turn: complex) -> Points:
    """A head goes with the end it is at."""
    k = int(np.abs(was - f[0]).argmin())
    return np.asarray(now[k] + (f - was[k]) * turn)


def between(ends: Points, points: Mapping[complex, complex]) -> Points:
    """A line through points of the plan where these come to lie; it reaches as far over them as it did."""
    a, b = complex(ends[0]), complex(ends[-1])
    u = (b - a) / max(abs(b - a), 1e-9)
    on = [(((z - a) * np.conj(u)).real, z) for z in points if abs(((z - a) * np.conj(u)).imag) < AT_POINT
          and -AT_POINT < ((z - a) * np.conj(u)).real < abs(b - a) + AT_POINT]
    if len(on) < 2:
        return np.array([a, b])
    (s, first), (t, last) = min(on, key=lambda x: x[0]), max(on, key=lambda x: x[0])
    p, q = points[first], points[last]
    if abs(p - first) < 1e-9 and abs(q - last) < 1e-9:
        return np.array([a, b])
    v = (q - p) / abs(q - p) if abs(q - p) > 1e-6 else u
    return np.array([p - s * v, q + (abs(b - a) - t) * v])


def drawn_plan(known: KnownSheet, plans: Mapping[str, Plan], view: ElementView) -> DrawnPlan | None:
    """The plan that a view shows, None where it shows none of vectors."""
    vectors = [e for e in known.elements if e.view == view and e.role == "vector" and e.kind == "line" and e.by is not None
               and e.by.frame >= 0]
    frames = {known.sheet.frames[e.by.frame] for e in vectors if e.by is not None}
    frame = next(iter(frames)) if len(frames) == 1 else None
    plan = plans.get(frame.plan) if frame is not None else None
    if frame is None or plan is None or frame.position not in plan.labels:
        return None
    k = plan.labels.index(frame.position)
    ends = np.concatenate([e.points for e in vectors])
    steps: dict[complex, Step] = {}
    for step in plan:
        value = np.asarray(step.value)
        if value.dtype.kind == "c" and step.rule.gives in ("point", "vector", "force"):
            z = complex(frame(value[k] if value.ndim else value))
            if np.isfinite(z) and np.abs(ends - z).min() < AT_POINT:
                steps.setdefault(z, step)
    at = np.array(list(steps), dtype=complex)
    both = sum(len(at) > 0 and all(np.abs(at - z).min() < AT_POINT for z in e.points) for e in vectors)
    # Forces at the points of a mechanism are no plan: only one end of each is a point.
    return DrawnPlan(plan, frame, k, tuple(vectors), steps) if both > len(vectors) / 2 else None


def _explained(drawn: DrawnPlan, errors: Errors, drawing: Drawing, usual: float, before: Sequence[_Mistake],
               agrees: Callable[[_Mistake], bool]) -> _Found | None:
    """The mistake with which most of a plan has ink, if that is much more than has ink without it, ``usual``.

    What was done wrong in plans ``before`` it may lead on to this one; where that does, nothing else is looked for. A mistake
    that shows elsewhere, too, must agree with what is drawn there.
    """
    def tried(mistakes: Iterable[_Mistake], made: Sequence[_Mistake]) -> list[_Found]:
        out = []
        for m in mistakes:
            points = moved_points(drawn, replay(errors, [c for one in (*made, m) for c in one.changes]))
            if points and (share := _share(drawn, drawing.inked, points)) >= MOST and explains(usual, share):
                out.append(_Found(share, points, m))
        return out

    led_on = tried(before, [])
    if before:
        led_on += [replace(f, mistake=before[-1]) for f in tried(before[-1:], before[:-1])]
    if led_on:
        return max(led_on, key=lambda f: f.share)
    for mistakes in ((_Mistake(h, h.changes) for h in possible([drawn], errors)), _points_off(drawn, drawing)):
        found = tried(mistakes, before)
        while found:
            best = max(f.share for f in found)
            first = next(f for f in found if f.share >= AS_GOOD * best)
            if agrees(first.mistake):
                return first
            found.remove(first)
    return None


def _points_off(drawn: DrawnPlan, drawing: Drawing) -> Iterator[_Mistake]:
    """One of the points of a plan at the end of a line of the drawing, with how far off that is."""
    tips = np.array(drawing.tips, dtype=complex)
    near = tips[np.abs(tips - complex(np.mean(list(drawn.steps)))) < FARTHEST].tolist()
    for z, step in drawn.steps.items():
        if not isinstance(step.args[0] if step.args else None, Step):
            continue
        for at in near:
            off = abs(at - z)
            if SHOWS < off < FARTHEST:
                by = _in_plan(drawn.frame, at) - _in_plan(drawn.frame, z)
                said = tell("point {point} lies {distance} mm off; what follows from it is drawn from there")
                yield _Mistake(said.format(point=letter_of(step), distance=millimetres(off * drawing.scale)),
                               (Change(step, displaced(by), drawn.k),))


def _in_plan(frame: PlacedFrame, z: complex) -> complex:
    """The point of the plan at a place on the sheet."""
    w = (z - frame.origin) * np.exp(-1j * frame.turn)
    w = np.conj(w) if frame.mirror else w
    return complex(w.real * frame.mu[0], w.imag * frame.mu[1])


def moved_points(drawn: DrawnPlan, value: Callable[[Step], Any]) -> dict[complex, complex]:
    """Where the points of a plan come to lie in a construction drawn again; nothing where none moves or one cannot be built."""
    new: dict[complex, complex] = {}
    with np.errstate(all="ignore"):
        for z, step in drawn.steps.items():
            made = np.asarray(value(step))
            new[z] = complex(drawn.frame(complex(made[drawn.k] if made.ndim else made)))
    far = np.abs([w - z for z, w in new.items()])
    return new if len(far) and (far <= PAPER).all() and far.max() >= SHOWS else {}  # NaN is on no paper either


def _share(drawn: DrawnPlan, inked: Inked, points: Mapping[complex, complex]) -> float:
    """Share of a plan's vectors, by length, that have ink where its points come to lie."""
    there = whole = 0.0
    for e in drawn.vectors:
        line = between(e.points, points)
        size = max(abs(line[1] - line[0]), e.length)
        if size > 1.0:  # a vector that shrinks to nothing is none that was drawn
            weight = min(size, WEIGHT)
            whole += weight
            there += weight * (abs(line[1] - line[0]) > 1.0 and inked(line) >= WHOLE)
    return there / whole if whole else 0.0
