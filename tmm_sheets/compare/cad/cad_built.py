"""Plans that were built on a wrong step: what was done, and the plan as it would be with that.

A plan whose lines do not lie where ours do is drawn again with each mistake that can be made in it, and with each of its points
where the drawing has the tip of a line; the mistake with which most of the plan has ink is what was done. The view is then compared
with the plan built so: its lines are found, though not in their places.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tmm_sheets.compare.cad.cad_findings import CadFinding, CadOutcome
from tmm_sheets.compare.cad.cad_ink import DrawingSpace
from tmm_sheets.compare.cad.drawn_plan import DRAWN, SHOWS, DrawnPlan, PlanPoint, between, drawn_plan
from tmm_sheets.compare.cad.line_fit import KnownLines
from tmm_sheets.compare.cad.lost_views import AS_GOOD, explains, possible
from tmm_sheets.compare.diagnosis.hypotheses import Hypothesis
from tmm_sheets.compare.diagnosis.replay import Change, displaced, replay
from tmm_sheets.compare.elements import ElementView, sampled
from tmm_sheets.compare.findings import millimetres
from tmm_sheets.compare.known_sheet import KnownSheet
from tmm_sheets.compare.placing import Placing
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.protocol import letter_of
from tmm_sheets.construction.step import Step
from tmm_sheets.drawing.marks import Points
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.project import Project

NEAR = 0.4
"""Distance from ink within which a point of a plan counts as drawn, mm."""
WHOLE = 0.85
"""Share of a line that must have ink for the line to be drawn."""
MOST = 0.8
"""Share of a plan, by length, that must have ink where a mistake leads, for the plan to be built on it."""
WEIGHT = 25.0
"""A longer vector tells no more than one of this length, mm of our sheet."""
FARTHEST = 250.0
"""A point is sought among the tips of lines no farther than this from its place, mm."""


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
class _Found:
    """A mistake with where it takes the points of a plan, and the share of the plan that has ink there."""

    share: float
    points: Sequence[PlanPoint]
    mistake: Hypothesis | str


def built_otherwise(project: Project, known: KnownSheet, space: DrawingSpace, moves: Mapping[ElementView, Placing],
                    outcome: CadOutcome, made: Sequence[Hypothesis] = ()) -> dict[
                        ElementView, tuple[BuiltPlan, Sequence[PlanPoint]]]:
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
    shown = {view: drawn for view in wrong if (drawn := drawn_plan(known, plans, view)) is not None}
    order = list(plans)
    for view, drawn in sorted(shown.items(), key=lambda x: order.index(x[1].plan.name)):
        bad = wrong[view]
        found = _explained(drawn, errors, space, moves.get(view, Placing()), told_before)
        if found is not None:
            numbers = {f.element.number for f in bad}
            move = moves.get(view, Placing())
            told = sum(_inked(space.lines, move, between(e, found.points)) >= WHOLE
                       for e in drawn.vectors if e.number in numbers)
            out[view] = BuiltPlan(found.mistake, told, len(bad)), found.points
            if not isinstance(found.mistake, str) and found.mistake not in told_before:
                told_before.append(found.mistake)
    return out


def _explained(drawn: DrawnPlan, errors: Errors, space: DrawingSpace, move: Placing, before: Sequence[Hypothesis]) -> _Found | None:
    """The mistake with which most of a plan has ink, if that is much more than has ink without it.

    What was done wrong in plans before it may lead on to this one, and is tried first.
    """
    usual = _share(drawn, space.lines, move, drawn.points)
    found = [_Found(_share(drawn, space.lines, move, points), points, h) for h, points in _mistakes(drawn, errors, before)]
    best = max((f.share for f in found), default=0.0)
    if best >= MOST and explains(usual, best):
        return next(f for f in found if f.share >= AS_GOOD * best)
    found += [_Found(_share(drawn, space.lines, move, points), points, said)
              for points, said in _points_off(drawn, errors, space, move)]
    best = max((f.share for f in found), default=0.0)
    if best < MOST or not explains(usual, best):
        return None
    # A point may lie on another one, or on another vector: that only makes what is wrong disappear.
    return max((f for f in found if f.share >= AS_GOOD * best), key=lambda f: _ink(drawn, space.lines, move, f.points))


def _mistakes(drawn: DrawnPlan, errors: Errors, told: Sequence[Hypothesis]) -> Iterator[tuple[Hypothesis, Sequence[PlanPoint]]]:
    """Where mistakes take the points of a plan: those known already first, then the more usual kinds."""
    for h in (*told, *possible([drawn], errors)):
        points = drawn.moved(replay(errors, h.changes))
        if points:
            yield h, points


def _points_off(drawn: DrawnPlan, errors: Errors, space: DrawingSpace, move: Placing) -> Iterator[tuple[Sequence[PlanPoint], str]]:
    """Where the plan goes when one of its points is at the tip of a line of the drawing, with how far off that is."""
    tips = np.unique(np.round(np.concatenate([s.points[[0, -1]] for s in space.strokes]), 2)) if space.strokes else np.zeros(0)
    middle = complex(np.mean([p.was for p in drawn.points]))
    for p in drawn.points:
        step = p.step
        if not isinstance(step.args[0] if step.args else None, Step):
            continue
        for tip in tips[np.abs(tips - complex(move(middle))) < FARTHEST * move.scale].tolist():
            at = complex(move.back(tip))
            off = abs(at - p.was)
            if SHOWS < off < FARTHEST:
                by = drawn.back(at) - drawn.back(p.was)
                points = drawn.moved(replay(errors, (Change(step, displaced(by), drawn.k),)))
                if points:
                    said = tell("point {point} lies {distance} mm off; what follows from it is drawn from there")
                    yield points, said.format(point=letter_of(step), distance=millimetres(off * move.scale))


def _share(drawn: DrawnPlan, theirs: KnownLines, move: Placing, points: Sequence[PlanPoint]) -> float:
    """Share of a plan's vectors, by length, that have ink where its points come to lie; what becomes too short is not drawn."""
    inked = whole = 0.0
    for e in drawn.vectors:
        line = between(e, points)
        size = max(abs(line[1] - line[0]), e.length)
        if abs(line[1] - line[0]) > DRAWN:
            weight = min(size, WEIGHT)
            whole += weight
            inked += weight * (_inked(theirs, move, line) >= WHOLE)
    return inked / whole if whole else 0.0


def _ink(drawn: DrawnPlan, theirs: KnownLines, move: Placing, points: Sequence[PlanPoint]) -> int:
    """How much ink a plan's vectors have together where its points come to lie, in places of a millimetre."""
    some = np.concatenate([sampled(np.asarray(move(between(e, points))), 0.5)[0] for e in drawn.vectors])
    return len(np.unique(np.round(some[theirs.nearest(some, NEAR)[2]])))


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
