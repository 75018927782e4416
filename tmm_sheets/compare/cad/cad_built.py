"""Plans on a sheet of ours that were built on a mistake: judged as plans of any layout are, but where the sheet has them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tmm_sheets.compare import codes
from tmm_sheets.compare.cad.cad_comparison import CadFinding, CadOutcome
from tmm_sheets.compare.cad.cad_ink import DrawingSpace
from tmm_sheets.compare.cad.line_fit import lines
from tmm_sheets.compare.cad.plan_ink import Figure, Numbers, PlanInk, covered
from tmm_sheets.compare.cad.plan_judge import JudgedView, judge_view
from tmm_sheets.compare.cad.plan_views import PlanRecord
from tmm_sheets.compare.codes import joined
from tmm_sheets.compare.diagnosis.built_plan import BuiltPlan, errors_of
from tmm_sheets.compare.diagnosis.drawn_plan import DrawnPlan, PlanPoint, drawn_plan, drawn_positions
from tmm_sheets.compare.diagnosis.replay import replay
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.findings import millimetres
from tmm_sheets.compare.known_sheet import KnownSheet
from tmm_sheets.compare.placing import Placing, moved
from tmm_sheets.compare.report import verdict
from tmm_sheets.drawing.marks import Points

if TYPE_CHECKING:
    from tmm_sheets.project import Project

BESIDE = 15.0
"""How far beyond the box of a view its lines may go where a mistake was made, mm of paper."""


def built_otherwise(project: Project, known: KnownSheet, space: DrawingSpace, moves: Mapping[ElementView, Placing],
                    outcome: CadOutcome) -> dict[ElementView, tuple[BuiltPlan, Sequence[PlanPoint]]]:
    """Views whose plans were built on a mistake, with the mistake and where it takes the points of the plan, mm of our sheet."""
    wrong: dict[ElementView, set[int]] = {}
    for f in outcome.findings:
        if f.element.role in ("vector", "link") and f.element.kind == "line" and f.verdict == "red":
            wrong.setdefault(f.element.view, set()).add(f.element.number)
    if not wrong:
        return {}
    plans, errors = errors_of(project, known)
    record, ink = PlanRecord(project), PlanInk(space, 1.0, scaled=True)
    out = {}
    for view, numbers in wrong.items():
        drawn = drawn_plan(known, plans, view) or drawn_positions(known, plans, view)
        if drawn is None or drawn.plan.name not in {*record.plans, *record.forces}:
            continue
        strokes = _strokes(ink, outcome, drawn, moves.get(view, Placing()))
        judged = _judged(record, ink, strokes, drawn, moves.get(view, Placing())) if len(strokes) else None
        if judged is None or judged.kind != "mistake":
            continue
        made = judged.causes if judged.both else judged.causes[:1]
        points = drawn.moved(replay(errors, [c for cause in made for c in cause.changes]))
        if points:
            out[view] = _built(judged, drawn, len(numbers)), points
    order = list(plans)
    return dict(sorted(out.items(), key=lambda x: order.index(x[1][0].step.plan) if x[1][0].step.plan in order else 0))


def _built(judged: JudgedView, drawn: DrawnPlan, wrong: int) -> BuiltPlan:
    first = judged.causes[0]
    label = drawn.plan.labels[first.changes[0].at] if first.changes[0].at is not None else ""
    alike = tuple(c.mistake for c in judged.causes[1:] if c.mistake is not None and not judged.both)
    said = joined([c.remark for c in judged.causes], "; ") if judged.both else first.mistake or first.remark
    assert said is not None
    return BuiltPlan(said, max(wrong - len(judged.unexplained), 0), wrong, first.step, label or drawn.plan.labels[drawn.k],
                     label if drawn.of_positions else "", alike)


def _judged(record: PlanRecord, ink: PlanInk, strokes: Numbers, drawn: DrawnPlan, move: Placing) -> JudgedView | None:
    """The plan judged where the sheet has it; None where its scale differs along its axes."""
    frame = drawn.frame
    if frame.mirror or frame.mu[0] != frame.mu[1] or move.mirrored:
        return None
    turn = move.turn * np.exp(1j * frame.turn) / frame.mu[0]
    figure = Figure(ink, strokes, place=(complex(turn), complex(move(frame.origin))))
    ks = tuple(drawn.positions)
    return judge_view(record, "", drawn.plan.name, ks, figure, float(np.angle(turn)))


def _strokes(ink: PlanInk, outcome: CadOutcome, drawn: DrawnPlan, move: Placing) -> Numbers:
    """Strokes about a plan that are not those of something else that is right, nor of lettering."""
    mine = {e.number for e in drawn.vectors}
    view = drawn.vectors[0].view
    box = move(np.array(view.box.corners))
    low, high = complex(box.real.min(), box.imag.min()), complex(box.real.max(), box.imag.max())
    middle = (ink.a + ink.b) / 2
    near = np.flatnonzero((middle.real > low.real - BESIDE) & (middle.real < high.real + BESIDE)
                          & (middle.imag > low.imag - BESIDE) & (middle.imag < high.imag + BESIDE))
    others = [f.element for f in outcome.findings
              if f.verdict == "green" and f.element.number not in mine and f.element.kind != "text"]
    ours = lines([p for e in others for p in (e.pieces or (e.points,))])
    about = (np.maximum(ours.a.real, ours.b.real) > low.real - BESIDE) & (np.minimum(ours.a.real, ours.b.real) < high.real + BESIDE)
    a, b = ours.a[about], ours.b[about]
    if not len(near) or not len(a):
        return near
    return np.array([n for n in near.tolist() if not _is_taken(ink.a[n], ink.b[n], a, b)], dtype=np.intp)


def _is_taken(a: complex, b: complex, ours_a: Points, ours_b: Points) -> bool:
    z = a + (b - a) * np.linspace(0.1, 0.9, 7).astype(complex)
    return bool(covered(z, np.full(7, (b - a) / abs(b - a), dtype=complex), ours_a, ours_b).all())


def as_built(finding: CadFinding | None, was: Element, now: Element, move: Placing, tolerance: float) -> CadFinding:
    """A finding on an element of a rebuilt plan, judged by the place it should have; ``was``, ``now``: before the view's move.

    None is found of a line that has vanished.
    """
    if finding is None:
        there = moved(was, move)
        at = complex(move(now.points[0]))
        return CadFinding(there, verdict(there.length, tolerance), there.length, codes.VANISHED(), at, 3.0, follows=True)
    off = float(np.abs(move(now.points) - move(was.points)).max()) if len(now.points) == len(was.points) else 0.0
    if finding.verdict is None or off <= tolerance or was.kind == "text":
        return finding
    if was.role == "symbol" and finding.verdict != "green":
        return replace(finding, verdict=None, deviation=0.0, remark=codes.SYMBOL_ELSEWHERE(), missing=False)
    follows = codes.AS_FOLLOWS(by=millimetres(off))
    remark = follows if finding.verdict == "green" else joined((follows, finding.remark), "; ")
    deviation = max(off, finding.deviation)
    return replace(finding, verdict=verdict(deviation, tolerance), deviation=deviation, remark=remark,
                   follows=finding.verdict == "green")
