"""Plans of a CAD drawing that were built on a wrong step, in a layout of its own too: see ``diagnosis/built_plan.py``."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tmm_sheets.compare.cad.cad_findings import CadFinding, CadOutcome
from tmm_sheets.compare.cad.cad_ink import DrawingSpace
from tmm_sheets.compare.cad.line_fit import KnownLines, lines
from tmm_sheets.compare.cad.view_search import FEW_LINES, SURE, FoundView, Search, unused
from tmm_sheets.compare.diagnosis import built_plan
from tmm_sheets.compare.diagnosis.built_plan import (
    AS_GOOD,
    EQUAL,
    BuiltPlan,
    Drawing,
    drawn_plan,
    errors_of,
    explains,
    moved_points,
    possible,
    rebuilt,
)
from tmm_sheets.compare.diagnosis.hypotheses import Hypothesis
from tmm_sheets.compare.diagnosis.replay import replay
from tmm_sheets.compare.elements import Element, ElementView, sampled
from tmm_sheets.compare.findings import millimetres
from tmm_sheets.compare.known_sheet import KnownSheet
from tmm_sheets.compare.placing import Placing
from tmm_sheets.compare.report import verdict
from tmm_sheets.drawing.marks import Points
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.compare.cad.layout import Layout
    from tmm_sheets.project import Project

NEAR = 0.4
"""Distance from ink within which a point of a plan counts as drawn, mm."""
MISTAKES = 2
"""So many mistakes are looked for in views that are not found."""


def built_otherwise(project: Project, known: KnownSheet, space: DrawingSpace, moves: Mapping[ElementView, Placing],
                    outcome: CadOutcome, made: Sequence[Hypothesis] = ()) -> dict[
                        ElementView, tuple[BuiltPlan, Mapping[complex, complex]]]:
    """Views whose plans were built on a mistake, with the mistake and where it takes the points of the plan, mm of our sheet.

    ``made`` are mistakes of the sheet that are known already.
    """
    wrong: dict[ElementView, list[Element]] = {}
    for f in outcome.findings:
        if f.element.role == "vector" and f.element.kind == "line" and f.verdict == "red":
            wrong.setdefault(f.element.view, []).append(f.element)
    tips = np.unique(np.round(np.concatenate([s.points[[0, -1]] for s in space.strokes]), 2)) if space.strokes else np.zeros(0)

    def seen(view: ElementView) -> Drawing:
        move = moves.get(view, Placing())
        return Drawing(lambda line: _inked(space.lines, move, line), move.back(tips).tolist(), move.scale)

    return built_plan.built_otherwise(project, known, wrong, seen, made)


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
        plans, self.errors = errors_of(project, known)
        self.known, self.space = known, space
        self.moves, self.share = dict(places.moves), places.share
        views = dict.fromkeys(e.view for e in known.elements)
        self.shown = {view: drawn for view in views if (drawn := drawn_plan(known, plans, view)) is not None}
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
        for h in possible([self.shown[v] for v in self.doubtful], self.errors):
            value = replay(self.errors, [c for m in (*made, h) for c in m.changes])
            gain, whole, factors = 0.0, False, set()
            for view in self.doubtful:
                if h.at is not None and view in self.titled_otherwise:
                    continue  # all positions are mistaken for others, or none
                new = moved_points(self.shown[view], value)
                if not new:
                    continue
                key = view, np.round(list(new.values()), 1).tobytes()
                if key not in known:
                    least = 1 if view in self.moves else FEW_LINES
                    known[key] = search.changed(view, [rebuilt(e, new) for e in self.main[view]], least)
                one, before = known[key], self.usual.get(view, 0.0)
                more = search.worth(view, one) - before if one is not None else 0.0
                if one is not None and explains(before, before + more):
                    gain += more * sum(e.length for e in self.shown[view].vectors)
                    whole |= view not in self.moves or explains(self.share[view], one.share)
                    factors.add(view.mu if view not in self.titled_otherwise else view)
            # A plan that is like ours at another scale is none that a mistake explains, several are.
            if whole or len(factors) > 1:
                tried.append((gain, h))
        most = max((gain for gain, _ in tried), default=0.0)
        return next((h for gain, h in tried if gain >= AS_GOOD * most), None)

    def following(self, made: Sequence[Hypothesis]) -> dict[ElementView, FoundView]:
        """The plans that follow from mistakes, as far as they are found so at least as well as without."""
        value = replay(self.errors, [c for m in made for c in m.changes])
        changed = {view: new for view, drawn in self.shown.items() if (new := moved_points(drawn, value))}
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


def as_built(finding: CadFinding, was: Element, now: Element, move: Placing, tolerance: float) -> CadFinding:
    """A finding on an element of a rebuilt plan, judged by the place it should have; ``was``, ``now``: before the view's move."""
    off = float(np.abs(move(now.points) - move(was.points)).max()) if len(now.points) == len(was.points) else 0.0
    if finding.verdict is None or off <= tolerance or was.kind == "text":
        return finding
    said = tell("up to {by} mm off, as follows from the mistake").format(by=millimetres(off))
    what = said if finding.verdict == "green" else f"{said}; {finding.what}"
    deviation = max(off, finding.deviation)
    return replace(finding, verdict=verdict(deviation, tolerance), deviation=deviation, what=what)


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

