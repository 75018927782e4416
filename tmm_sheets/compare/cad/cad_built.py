"""Plans of a CAD drawing that were built on a wrong step: see ``diagnosis/built_plan.py``."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tmm_sheets.compare import codes
from tmm_sheets.compare.cad.cad_arrows import Heads, heads_in
from tmm_sheets.compare.cad.cad_findings import CadFinding, CadOutcome
from tmm_sheets.compare.cad.cad_ink import DrawingSpace
from tmm_sheets.compare.cad.line_fit import KnownLines
from tmm_sheets.compare.codes import joined
from tmm_sheets.compare.diagnosis import built_plan
from tmm_sheets.compare.diagnosis.built_plan import BuiltPlan, StudentDrawing
from tmm_sheets.compare.diagnosis.drawn_plan import PlanPoint
from tmm_sheets.compare.diagnosis.hypotheses import Hypothesis
from tmm_sheets.compare.elements import Element, ElementView, sampled
from tmm_sheets.compare.findings import millimetres
from tmm_sheets.compare.known_sheet import KnownSheet
from tmm_sheets.compare.placing import Placing, moved
from tmm_sheets.compare.report import verdict
from tmm_sheets.drawing.marks import Points

if TYPE_CHECKING:
    from tmm_sheets.project import Project

NEAR = 0.4
"""Distance from ink within which a point of a plan counts as drawn, mm."""
OVER = 1.0, 2.5, 4
"""Beyond the end of a line: from where to where ink goes on, mm, and at how many places it is looked for."""


def built_otherwise(project: Project, known: KnownSheet, space: DrawingSpace, moves: Mapping[ElementView, Placing],
                    outcome: CadOutcome, made: Sequence[Hypothesis] = (), absent: Collection[ElementView] = ()) -> dict[
                        ElementView, tuple[BuiltPlan, Sequence[PlanPoint]]]:
    """Views whose plans were built on a mistake, with the mistake and where it takes the points of the plan, mm of our sheet.

    ``made`` are mistakes of the sheet that are known already; ink where views would be that are ``absent`` is that of others.
    """
    wrong: dict[ElementView, list[Element]] = {}
    for f in outcome.findings:
        main = f.element.role in ("vector", "link") and f.element.kind == "line"
        if main and f.verdict == "red" and f.element.view not in absent:
            wrong.setdefault(f.element.view, []).append(f.element)
    tips = np.unique(np.round(np.concatenate([s.points[[0, -1]] for s in space.strokes]), 2)) if space.strokes else np.zeros(0)

    heads = heads_in(space)

    def seen(view: ElementView) -> StudentDrawing:
        move = moves.get(view, Placing())

        return StudentDrawing(lambda line: _inked(space.lines, move, line),
                              lambda z: space.lines.nearest(np.asarray(move(z)), NEAR)[2],
                       move.back(tips).tolist(), move.scale, lambda line: _goes_on(space.lines, move, line),
                       lambda arrow: _headed(heads, move, arrow))

    return built_plan.built_otherwise(project, known, wrong, seen, made, absent, positions=True)


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


def _goes_on(theirs: KnownLines, move: Placing, line: Points) -> bool:
    """Whether ink goes on in the direction of a line of a plan beyond its end: then the line that is drawn is a longer one."""
    z = np.asarray(move(line))
    along = (z[1] - z[0]) / abs(z[1] - z[0])
    _, unit, found = theirs.nearest(z[1] + along * np.linspace(*OVER), NEAR)
    return bool((found & (np.abs((unit * np.conj(along)).imag) < 0.1)).all())


def _headed(heads: Heads, move: Placing, arrow: Element) -> bool:
    """Whether an arrow has its head; which point of one round a hinge stays in place in another scale is up to who draws it."""
    tip, back = complex(arrow.fills[0][0]), complex(arrow.fills[0].mean() - arrow.fills[0][0])
    along = complex(move(tip) - move(tip + back))
    kept = (arrow.middle, arrow.centre) if move.scaled and arrow.kind == "arc" else ()
    return any(heads.at(complex(by(tip)), along / abs(along)) for by in (move, *map(move.unscaled, kept)))


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
