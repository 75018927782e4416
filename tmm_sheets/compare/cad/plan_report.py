"""What plans that were judged title first came to, line by line, as a comparison with a sheet has it. Places are mm of paper."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.compare import codes
from tmm_sheets.compare.cad.cad_comparison import CadFinding, CadOutcome, ExtraStroke
from tmm_sheets.compare.cad.cad_report import ExaminedDrawing, mirror_told
from tmm_sheets.compare.cad.line_fit import KnownLines
from tmm_sheets.compare.cad.plan_ink import CARELESS_MM, DRAWN_SHARE, MAIN, OTHERS, PlanInk
from tmm_sheets.compare.cad.plan_judge import SAME_MM, JudgedPlans, JudgedView
from tmm_sheets.compare.codes import Remark
from tmm_sheets.compare.diagnosis.built_plan import mistake_found
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.findings import FindingRecord, Outcome, StoryTable, Verdict, millimetres, point
from tmm_sheets.compare.placing import Placing
from tmm_sheets.drawing.marks import Drawing, Provenance
from tmm_sheets.words import marked, tell, tell_n

HINT = marked("write over each figure which plan it is and at which position")
LEGEND, MARGIN = 45.0, 25.0
"""Room of the legend of the overlay, to the left, and round it, mm."""


def examined(sheet: int, name: str, judged: JudgedPlans, notes: Sequence[str]) -> ExaminedDrawing:
    """The drawing ``name`` by its plans, those of which ``sheet`` is the first to show."""
    space = judged.ink.space
    views: list[_View] = []
    for v in judged.views:
        views.append(_View(v, judged.ink, len(views) + 1, sum(len(before.lines) for before in views)))
    upright = [v.fit.scale for v in judged.fitting if v.fit is not None]
    whole = [mirror_told(bool(np.median(np.cos(np.angle(upright))) < 0))] if judged.mirrored else []
    if len(views) > 1 and all(v.judged.kind in ("unlike", "bare") for v in views):
        whole.append(FindingRecord(codes.ANOTHER_MECHANISM(), "red", whole=True))
    of_views = {v.view: r for v in views if (r := v.whole) is not None}
    extras = tuple(_extra(judged, v.view, n) for v in views for n in v.judged.unexplained.tolist())
    head = tuple(map(tell, ("title", "plan", "verdict", "right", "wrong", "not drawn")))
    table = StoryTable(tell("Views"), head, tuple(v.row for v in views), tuple(v.verdict for v in views))
    z = np.concatenate([*(s.points for s in space.strokes), np.array([w.at for w in space.writings], dtype=complex)])
    corner = complex(z.real.min() - LEGEND, z.imag.min() - MARGIN)
    blank = Drawing(float(np.ptp(z.real)) + LEGEND + MARGIN, float(np.ptp(z.imag)) + 2 * MARGIN, name, ())
    exact = tuple(e for v in views for e, _ in v.lines)
    outcome = CadOutcome(tuple(f for v in views for _, f in v.lines), extras)
    return ExaminedDrawing(sheet, space, blank, exact, CARELESS_MM, outcome, (*notes, *_notes(judged)), whole, of_views,
                           {"views": [v.tree for v in views]}, Placing(shift=-corner), (table,))


def _extra(judged: JudgedPlans, view: ElementView, n: int) -> ExtraStroke:
    """A stroke that no line of its view explains."""
    ink = judged.ink
    ends = np.array([ink.a[n], ink.b[n]])
    entity = ink.space.entities[ink.space.strokes[int(ink.stroke[n])].entity]
    return ExtraStroke("line", entity, float(abs(ends[1] - ends[0])), complex(ends.mean()), 5.0, view=view, ends=ends)


def _notes(judged: JudgedPlans) -> Iterator[str]:
    n, none = len(judged.views), len(judged.untitled)
    yield tell_n("the layout is the student's own: {n} view, judged by its title and its lines",
                 "the layout is the student's own: {n} views, judged by their titles and their lines", n).format(n=n)
    if judged.askew:
        yield tell("the plans are turned against the lettering; they were judged as they lie")
    if judged.ink.curves:
        yield tell("circles and curves are not judged in a layout of its own: {n}").format(n=judged.ink.curves)
    if none:
        said = tell_n("{n} figure without a title is no plan as it should be: {hint}",
                      "{n} figures without a title are no plans as they should be: {hint}", none)
        yield said.format(n=none, hint=tell(HINT))


@dataclass(frozen=True)
class _View:
    """What is listed of a view, number ``n`` from 1; its lines are numbered from after ``before``."""

    judged: JudgedView
    ink: PlanInk
    n: int
    before: int

    @cached_property
    def view(self) -> ElementView:
        """It as a view of a sheet."""
        v = self.judged
        ends = np.zeros(1, complex) if v.fit is None else v.fit.at(np.concatenate((v.lines.tails, v.lines.heads)))
        return ElementView(self.n, v.title or v.view.plan.title, Box.around(ends),
                           1 / abs(v.fit.scale) if v.fit is not None else None)

    @cached_property
    def lines(self) -> list[tuple[Element, CadFinding]]:
        """Its lines as they should be, each with what became of it; none of another plan."""
        v, pairs = self.judged, self.judged.view.pairs
        if v.fit is None or v.kind == "unlike":
            return []
        exact, built = (dict(zip(of.numbers.tolist(), v.fit.at(np.column_stack((of.tails, of.heads))), strict=True))
                        for of in (v.exact, v.lines))
        seen = set(v.lines.numbers[v.fit.drawn >= DRAWN_SHARE].tolist())
        back = {int(v.lines.numbers[i]) for i in v.reversed_heads or ()}
        kinds = {pairs[n % len(pairs)][2] for n in seen}
        near = KnownLines(self.ink.a[v.strokes], self.ink.b[v.strokes], v.strokes)
        out: list[tuple[Element, CadFinding]] = []
        for n in sorted(exact.keys() | built.keys()):
            _, step, kind, name = pairs[n % len(pairs)]
            was, now = (built | exact)[n], (exact | built)[n]
            size = float(abs(now[1] - now[0]))
            off = float(np.abs(now - was).max()) if n in exact and n in built else size
            if kind == OTHERS and not (n in seen and off > SAME_MM):
                continue
            by = Provenance("link" if v.name == "positions" else "vector", step.path,
                            v.view.plan.labels[v.positions[n // len(pairs)]])
            e = Element(self.before + len(out) + 1, self.view, name, "line", now, by.role, by=by)

            def found(verdict: Verdict | None, by: float, remark: Remark | None, *, e: Element = e, follows: bool = False,
                      absent: str = "") -> CadFinding:
                return CadFinding(e, verdict, by, remark, e.middle, 5.0, absent=absent, follows=follows)

            if n not in built:
                finding = found("red", off, codes.VANISHED(), follows=True)
            elif n not in seen:
                finding = found(None, 0.0, codes.NOT_DRAWN(), absent=kind if kind not in {MAIN, *kinds} else name)
            elif n in back:
                finding = found("red", size, codes.ARROW_POINTS_BACK())
            elif off > SAME_MM:
                finding = found("red", off, codes.AS_FOLLOWS(by=millimetres(off)), follows=True)
            else:
                finding = found("green", float(np.abs(near.nearest(now, CARELESS_MM)[0] - now).max()), None)
            out.append((replace(e, points=was), finding))
        return out

    @cached_property
    def whole(self) -> FindingRecord | None:
        """What is listed of all of it."""
        v, left, name = self.judged, len(self.judged.unexplained), self.view.name
        at = None if v.fit is None else self.view.box.centre
        if v.kind == "mistake":
            moved = sum(f.follows for _, f in self.lines)
            return replace(mistake_found(name, v.view.plan, v.label, v.causes, v.both, moved, moved + left), at=at)
        unread = codes.HEADS_NOT_READ() if v.reversed_heads is None and v.view.plan.pole else None
        remark = {"bare": codes.NO_INK_UNDER_TITLE(view=name), "partly": codes.LINES_DO_NOT_FIT(n=left),
                  "unlike": codes.ANOTHER_PLAN(position=v.label or tell("all"), n=left)}.get(v.kind, unread)
        verdict: Outcome = "red" if v.kind in ("unlike", "partly") else "not-judged"
        return None if remark is None else FindingRecord(remark, verdict, name, v.view.plan.name, "", v.label, whole=True, at=at)

    @property
    def row(self) -> tuple[str, ...]:
        """Its row in the table of views."""
        v, count = self.judged, Counter(f.verdict for _, f in self.lines)
        some = "" if v.kind == "bare" else tell("all") if len(v.positions) == len(v.view.plan.labels) else ", ".join(
            v.view.plan.labels[k] for k in v.positions)
        wrong = count["red"] + (len(v.unexplained) if v.kind in ("partly", "unlike") else 0)
        return (v.title or "–", f"{v.view.plan.name} {some}".strip(), self.whole.remark.said() if self.whole else tell("right"),
                str(count["green"]), str(wrong), str(count[None]))

    @property
    def verdict(self) -> str:
        """That of its row."""
        return "red" if any(f.verdict == "red" for _, f in self.lines) or (self.whole and self.whole.verdict == "red") else ""

    @property
    def tree(self) -> dict[str, Any]:
        """It as JSON has it."""
        v, fit = self.judged, self.judged.fit
        at = {} if fit is None else {"share": round(1 - fit.extra / max(fit.ink, 1e-9), 4), "mu": self.view.mu,
                                     "shift": point(fit.origin)}
        return {"view": self.view.name, "plan": v.view.plan.name, "position": v.label, "kind": v.kind, **at}
