"""Plans that were built on a wrong step: what was done, and the plan as it would be with that.

A plan whose lines do not lie where ours do is drawn again with each mistake that can be made in it, and with each of its points
where the drawing has the tip of a line; the mistake with which most of the plan has ink is what was done. The view is then compared
with the plan built so: its lines are found, though not in their places.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, get_args

import numpy as np

from tmm_sheets.compare.cad.cad_findings import CadFinding, CadOutcome
from tmm_sheets.compare.cad.cad_ink import DrawingSpace
from tmm_sheets.compare.cad.line_fit import KnownLines, lines
from tmm_sheets.compare.cad.view_search import FEW_LINES, SURE, FoundView, Search, unused
from tmm_sheets.compare.diagnosis.hypotheses import Hypothesis, Kind, hypotheses
from tmm_sheets.compare.diagnosis.replay import Change, displaced, replay
from tmm_sheets.compare.elements import Element, ElementView, sampled
from tmm_sheets.compare.findings import millimetres
from tmm_sheets.compare.known_sheet import KnownSheet
from tmm_sheets.compare.placing import Placing, shafts
from tmm_sheets.compare.report import verdict
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.protocol import letter_of
from tmm_sheets.construction.step import Step, ordered
from tmm_sheets.drawing.marks import Arc, Fill, PlacedFrame, Points
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.compare.cad.layout import Layout
    from tmm_sheets.project import Project

AT_POINT = 0.03
"""Distance within which an end of a line is at a point of the plan, mm of our sheet."""
BESIDE = 10.0
"""How far from its point a letter may stand, mm of our sheet."""
NEAR = 0.4
"""Distance from ink within which a point of a plan counts as drawn, mm."""
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
MISTAKES = 2
"""So many mistakes are looked for in views that are not found."""
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
class _Drawn:
    """A plan on the sheet: its vectors, and the steps at whose points their ends are, by place."""

    plan: Plan
    frame: PlacedFrame
    k: int
    vectors: tuple[Element, ...]
    steps: Mapping[complex, Step]


@dataclass(frozen=True)
class _Found:
    """A mistake with where it takes the points of a plan, and the share of the plan that has ink there."""

    share: float
    points: Mapping[complex, complex]
    mistake: Hypothesis | str


def built_otherwise(project: Project, known: KnownSheet, space: DrawingSpace, moves: Mapping[ElementView, Placing],
                    outcome: CadOutcome, made: Sequence[Hypothesis] = ()) -> dict[
                        ElementView, tuple[BuiltPlan, Mapping[complex, complex]]]:
    """Views whose plans were built on a mistake, with the mistake and where it takes the points of the plan, mm of our sheet.

    ``made`` are mistakes of the sheet that are known already.
    """
    plans = {plan.name: plan for some in project.plans.values() for plan in (some or {}).values()}
    errors = Errors([(plans[f.plan], f.mu[0]) for f in known.sheet.frames if f.plan in plans])
    wrong: dict[ElementView, list[CadFinding]] = {}
    for f in outcome.findings:
        if f.element.role == "vector" and f.element.kind == "line" and f.verdict == "red":
            wrong.setdefault(f.element.view, []).append(f)
    out = {}
    told_before = list(made)
    shown = {view: drawn for view in wrong if (drawn := _drawn(known, plans, view)) is not None}
    order = list(plans)
    for view, drawn in sorted(shown.items(), key=lambda x: order.index(x[1].plan.name)):
        bad = wrong[view]
        found = _explained(drawn, errors, space, moves.get(view, Placing()), told_before)
        if found is not None:
            numbers = {f.element.number for f in bad}
            move = moves.get(view, Placing())
            told = sum(_inked(space.lines, move, _between(e.points, found.points)) >= WHOLE
                       for e in drawn.vectors if e.number in numbers)
            out[view] = BuiltPlan(found.mistake, told, len(bad)), found.points
            if not isinstance(found.mistake, str) and found.mistake not in told_before:
                told_before.append(found.mistake)
    return out


def lost_views(project: Project, known: KnownSheet, space: DrawingSpace, places: Layout) -> tuple[
        dict[ElementView, FoundView], list[Hypothesis]]:
    """Views of a layout of its own that are not found as they should be because of mistakes: where they are, and the mistakes.

    One mistake leads on from plan to plan: the one with which most of all these views has ink was made, then the one that
    together with it explains most of what is left. All plans that follow from it are sought as they do.
    """
    lost = _Lost(project, known, space, places)
    made: list[Hypothesis] = []
    out: dict[ElementView, FoundView] = {}
    while len(made) < MISTAKES and (h := lost.explaining_most(made)) is not None:
        made.append(h)
        out |= lost.following(made)
    return out, made


class _Lost:
    """Plans of vectors on a sheet, with where they were found as they should be, and how well."""

    def __init__(self, project: Project, known: KnownSheet, space: DrawingSpace, places: Layout) -> None:
        plans = {plan.name: plan for some in project.plans.values() for plan in (some or {}).values()}
        self.errors = Errors([(plans[f.plan], f.mu[0]) for f in known.sheet.frames if f.plan in plans])
        self.known, self.space = known, space
        self.moves, self.share = dict(places.moves), places.share
        views = dict.fromkeys(e.view for e in known.elements)
        self.shown = {view: drawn for view in views if (drawn := _drawn(known, plans, view)) is not None}
        search = self._search(self.shown)
        self.main = dict(search.main)
        self.usual = {v: search.worth(v, FoundView(self.moves[v], places.share[v])) for v in self.shown if v in self.moves}
        self.titled_otherwise = {v for v in self.usual if places.share[v] >= SURE and search.strange(v, self.moves[v])}
        self.doubtful = [v for v in self.shown if self.usual.get(v, 0.0) < SURE]

    def _search(self, views: Collection[ElementView]) -> Search:
        """A search for some views in the ink that no other view has."""
        free = self.space.lines
        for view, move in self.moves.items():
            if view not in views:
                ink = [move(e.points) for e in self.known.elements if e.view == view and e.kind not in ("text", "hatch", "fill")]
                free = unused(free, lines(ink).points(1.0), 1.2)
        left = set(np.unique(free.owner).tolist())
        strokes = [s for k, s in enumerate(self.space.strokes) if k in left]
        others = {v: move for v, move in self.moves.items() if v not in views}
        return Search(self.known.elements, list(views), strokes, free, self.space.writings, others)

    def explaining_most(self, made: Sequence[Hypothesis]) -> Hypothesis | None:
        """The mistake with which, besides those made already, most ink of the doubtful views is explained; None without."""
        mistaken = {self.shown[v].plan for v in self.titled_otherwise}  # plans without a title are taken for one another too
        search = self._search([v for v in self.shown if v in self.doubtful or self.shown[v].plan in mistaken])
        if not self.doubtful or not search.enough():
            return None
        known: dict[tuple[ElementView, bytes], FoundView | None] = {}
        tried: list[tuple[float, Hypothesis]] = []
        for h in _possible([self.shown[v] for v in self.doubtful], self.errors):
            value = replay(self.errors, [c for m in (*made, h) for c in m.changes])
            gain, whole, factors = 0.0, False, set()
            for view in self.doubtful:
                if h.at is not None and view in self.titled_otherwise:
                    continue  # all positions are mistaken for others, or none
                new = _moved(self.shown[view], value)
                if not new:
                    continue
                key = view, np.round(list(new.values()), 1).tobytes()
                if key not in known:
                    least = 1 if view in self.moves else FEW_LINES
                    known[key] = search.changed(view, [rebuilt(e, new) for e in self.main[view]], least)
                one, before = known[key], self.usual.get(view, 0.0)
                more = search.worth(view, one) - before if one is not None else 0.0
                if one is not None and _explains(before, before + more):
                    gain += more * sum(e.length for e in self.shown[view].vectors)
                    whole |= view not in self.moves or _explains(self.share[view], one.share)
                    factors.add(view.mu if view not in self.titled_otherwise else view)
            # A plan that is like ours at another scale is none that a mistake explains, several are.
            if whole or len(factors) > 1:
                tried.append((gain, h))
        most = max((gain for gain, _ in tried), default=0.0)
        return next((h for gain, h in tried if gain >= AS_GOOD * most), None)

    def following(self, made: Sequence[Hypothesis]) -> dict[ElementView, FoundView]:
        """The plans that follow from mistakes, as far as they are found so at least as well as without."""
        value = replay(self.errors, [c for m in made for c in m.changes])
        changed = {view: new for view, drawn in self.shown.items() if (new := _moved(drawn, value))}
        search = self._search(changed)
        out: dict[ElementView, FoundView] = {}
        for view in sorted(changed, key=lambda v: (v not in self.doubtful, -sum(e.length for e in self.shown[v].vectors))):
            one = search.changed(view, [rebuilt(e, changed[view]) for e in self.main[view]], 1)
            if one is not None and search.worth(view, one) >= self.usual.get(view, 0.0) - EQUAL:
                out[view] = one
                self.moves[view] = one.placing
                search.without(view, one.placing)
        self.doubtful = [v for v in self.doubtful if v not in out]
        return out


def _explains(usual: float, now: float) -> bool:
    """Whether a mistake explains a plan of which so much has ink in its place, and so much with the mistake."""
    return now - usual > min(GAIN, max(EQUAL, OF_REST * (1 - usual)))


def _possible(shown: Iterable[_Drawn], errors: Errors) -> list[Hypothesis]:
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
        new = _between(e.points, points)
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


def as_built(finding: CadFinding, was: Element, now: Element, move: Placing, tolerance: float) -> CadFinding:
    """A finding on an element of a rebuilt plan, judged by the place it should have; ``was``, ``now``: before the view's move."""
    off = float(np.abs(move(now.points) - move(was.points)).max()) if len(now.points) == len(was.points) else 0.0
    if finding.verdict is None or off <= tolerance or was.kind == "text":
        return finding
    said = tell("up to {by} mm off, as follows from the mistake").format(by=millimetres(off))
    what = said if finding.verdict == "green" else f"{said}; {finding.what}"
    deviation = max(off, finding.deviation)
    return replace(finding, verdict=verdict(deviation, tolerance), deviation=deviation, what=what)


def _head(f: Points, was: Points, now: Points, turn: complex) -> Points:
    """A head goes with the end it is at."""
    k = int(np.abs(was - f[0]).argmin())
    return np.asarray(now[k] + (f - was[k]) * turn)


def _between(ends: Points, points: Mapping[complex, complex]) -> Points:
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


def _drawn(known: KnownSheet, plans: Mapping[str, Plan], view: ElementView) -> _Drawn | None:
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
    return _Drawn(plan, frame, k, tuple(vectors), steps) if both > len(vectors) / 2 else None


def _explained(drawn: _Drawn, errors: Errors, space: DrawingSpace, move: Placing, before: Sequence[Hypothesis]) -> _Found | None:
    """The mistake with which most of a plan has ink, if that is much more than has ink without it.

    What was done wrong in plans before it may lead on to this one, and is tried first.
    """
    usual = _share(drawn, space.lines, move, {z: z for z in drawn.steps})
    found = [_Found(_share(drawn, space.lines, move, points), points, h) for h, points in _mistakes(drawn, errors, before)]
    best = max((f.share for f in found), default=0.0)
    if best < MOST or not _explains(usual, best):
        found += [_Found(_share(drawn, space.lines, move, points), points, said)
                  for points, said in _points_off(drawn, errors, space, move)]
        best = max((f.share for f in found), default=0.0)
    if best < MOST or not _explains(usual, best):
        return None
    return next(f for f in found if f.share >= AS_GOOD * best)


def _mistakes(drawn: _Drawn, errors: Errors, told: Sequence[Hypothesis]) -> Iterator[tuple[Hypothesis, dict[complex, complex]]]:
    """Where mistakes take the points of a plan: those known already first, then the more usual kinds."""
    for h in (*told, *_possible([drawn], errors)):
        points = _moved(drawn, replay(errors, h.changes))
        if points:
            yield h, points


def _points_off(drawn: _Drawn, errors: Errors, space: DrawingSpace, move: Placing) -> Iterator[tuple[dict[complex, complex], str]]:
    """Where the plan goes when one of its points is at the tip of a line of the drawing, with how far off that is."""
    tips = np.unique(np.round(np.concatenate([s.points[[0, -1]] for s in space.strokes]), 2)) if space.strokes else np.zeros(0)
    middle = complex(np.mean(list(drawn.steps)))
    for z, step in drawn.steps.items():
        if not isinstance(step.args[0] if step.args else None, Step):
            continue
        for tip in tips[np.abs(tips - complex(move(middle))) < FARTHEST * move.scale].tolist():
            at = complex(move.back(tip))
            off = abs(at - z)
            if SHOWS < off < FARTHEST:
                by = _in_plan(drawn.frame, at) - _in_plan(drawn.frame, z)
                points = _moved(drawn, replay(errors, (Change(step, displaced(by), drawn.k),)))
                if points:
                    said = tell("point {point} lies {distance} mm off; what follows from it is drawn from there")
                    yield points, said.format(point=letter_of(step), distance=millimetres(off * move.scale))


def _in_plan(frame: PlacedFrame, z: complex) -> complex:
    """The point of the plan at a place on the sheet."""
    w = (z - frame.origin) * np.exp(-1j * frame.turn)
    w = np.conj(w) if frame.mirror else w
    return complex(w.real * frame.mu[0], w.imag * frame.mu[1])


def _moved(drawn: _Drawn, value: Callable[[Step], Any]) -> dict[complex, complex]:
    """Where the points of a plan come to lie in a construction drawn again; nothing where none moves or one cannot be built."""
    new: dict[complex, complex] = {}
    with np.errstate(all="ignore"):
        for z, step in drawn.steps.items():
            made = np.asarray(value(step))
            new[z] = complex(drawn.frame(complex(made[drawn.k] if made.ndim else made)))
    far = np.abs([w - z for z, w in new.items()])
    return new if len(far) and (far <= PAPER).all() and far.max() >= SHOWS else {}  # NaN is on no paper either


def _share(drawn: _Drawn, theirs: KnownLines, move: Placing, points: Mapping[complex, complex]) -> float:
    """Share of a plan's vectors, by length, that have ink where its points come to lie."""
    inked = whole = 0.0
    for e in drawn.vectors:
        line = _between(e.points, points)
        size = max(abs(line[1] - line[0]), e.length)
        if size > 1.0:  # a vector that shrinks to nothing is none that was drawn
            weight = min(size, WEIGHT)
            whole += weight
            inked += weight * (abs(line[1] - line[0]) > 1.0 and _inked(theirs, move, line) >= WHOLE)
    return inked / whole if whole else 0.0


def _inked(theirs: KnownLines, move: Placing, line: Points) -> float:
    """Share of a line of a plan that ink in nearly its direction covers in the drawing."""
    z = np.asarray(move(line))
    size = abs(z[1] - z[0])
    if size < 0.5:
        return 1.0
    some = sampled(z, max(size / 40, 0.25))[0][1:-1]  # at its ends other lines begin
    _, unit, found = theirs.nearest(some, NEAR)
    along = (z[1] - z[0]) / size
    return float((found & (np.abs((unit * np.conj(along)).imag) < 0.1)).mean())

