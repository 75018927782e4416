"""A plan of vectors, or of the positions, as it stands on a sheet, and as it would stand there with its points elsewhere."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.known_sheet import KnownSheet
from tmm_sheets.compare.placing import HINGE, shafts
from tmm_sheets.construction.protocol import letter_of
from tmm_sheets.construction.step import Plan, Step
from tmm_sheets.drawing.marks import Arc, Fill, PlacedFrame, Points

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
