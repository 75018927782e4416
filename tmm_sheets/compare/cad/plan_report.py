"""The report on plans that were judged title first: findings, table, pictures, overlay. Places are mm of the student's paper."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.compare import codes
from tmm_sheets.compare.cad.cad_ink import DrawingSpace
from tmm_sheets.compare.cad.plan_ink import DRAWN_SHARE, MAIN, OTHERS, Fit
from tmm_sheets.compare.cad.plan_judge import SAME_MM, JudgedPlans, JudgedView
from tmm_sheets.compare.cad.plan_views import CLASSES
from tmm_sheets.compare.codes import Remark, joined
from tmm_sheets.compare.diagnosis.built_plan import SHOWN
from tmm_sheets.compare.diagnosis.hypotheses import TOLD, built_otherwise
from tmm_sheets.compare.findings import (
    FindingRecord,
    Outcome,
    Report,
    StoryPicture,
    StoryTable,
    ToldMistake,
    clipped,
    millimetres,
    point,
    reported,
)
from tmm_sheets.drawing.marks import Points
from tmm_sheets.numbers import told
from tmm_sheets.words import marked, tell, tell_n

HINT = marked("write over each figure which plan it is and at which position")


@dataclass
class _OfView:
    """What is listed of a view: the finding that is on all of it, and those on its lines, by their numbers."""

    view: JudgedView
    name: str
    whole: FindingRecord | None = None
    lines: dict[int, FindingRecord] = field(default_factory=dict)

    @property
    def wrong(self) -> list[tuple[int, FindingRecord]]:
        return [(n, r) for n, r in self.lines.items() if r.verdict == "red"]


def plan_report(project: str, sheet: int, path: Path, space: DrawingSpace, judged: JudgedPlans, pencil: float,
                notes: Sequence[str]) -> Report:
    """The report on a drawing of ``project``; ``space`` is the drawing in its own units, ``pencil`` the tolerance, mm."""
    views = [_of_view(v, pencil) for v in judged.views]
    start = [*_of_all(judged, views)]
    start += [v.whole for v in views
              if v.whole is not None and (v.whole.verdict == "red" or v.whole.remark.code == "view-missing")]
    records = [*(r for r in start), *(v.whole for v in views if v.whole is not None and v.whole not in start),
               *(r for v in views for r in v.lines.values())]
    extra = _unclaimed(space, judged)
    count = Counter(r.verdict for r in records)
    said = tell("{green} green, {amber} amber, {red} red, {skipped} not judged; {extra} extra").format(
        green=count["green"], amber=count["amber"], red=count["red"], skipped=count["not-judged"], extra=len(extra))
    mistakes = tuple(_told(v, judged) for v in views if (v.whole is not None and v.whole.verdict == "red") or v.wrong)
    head = tuple(map(tell, ("title", "plan", "verdict", "right", "wrong", "not drawn")))
    verdicts = tuple("red" if v.wrong or (v.whole is not None and v.whole.verdict == "red") else "" for v in views)
    return reported(
        "cad", project, sheet, path, (tell("tolerance {tolerance} mm").format(tolerance=told(f"{pencil:g}")), said), records, start,
        mistakes, [StoryTable(tell("Views"), head, tuple(map(_row, views)), verdicts)],
        (*_not_drawn(views), *_figures_without_title(judged)), [*notes, *_notes(judged)], extra,
        drawing=path.name, space=space.name, tolerance=pencil, views=[_listed_view(v) for v in views])


def exact_lines(judged: JudgedPlans) -> list[Points]:
    """The lines of all views as they should be, where the drawing has them, mm."""
    return [z for v in judged.views if v.fit is not None and v.kind != "unlike" for z in _drawn_as(v, v.fit)]


def marked_places(judged: JudgedPlans) -> list[tuple[complex, float, str, str]]:
    """Centre, radius, mm, number and verdict of what is wrong: lines that a mistake moved, ink that nothing explains."""
    places = []
    for v in judged.views:
        of_view = _of_view(v, 1.0)
        places += [(r.at, 5.0, "red") for _, r in of_view.wrong if r.at is not None]
        places += [((complex(judged.ink.a[n]) + complex(judged.ink.b[n])) / 2, 5.0, "red") for n in v.unexplained.tolist()]
    return [(at, reach, str(k), verdict) for k, (at, reach, verdict) in enumerate(places, 1)]


# --- findings -------------------------------------------------------------------------------------------------------------------


def _of_view(v: JudgedView, pencil: float) -> _OfView:
    """What is listed of a view."""
    plan = v.view.plan
    name = v.title or plan.title
    out = _OfView(v, name)

    ends = v.fit.at(np.concatenate((v.lines.tails, v.lines.heads))) if v.fit is not None else v.lines.heads[:0]

    def whole(remark: Remark, verdict: Outcome, **beside: Any) -> FindingRecord:
        return FindingRecord(remark, verdict, name, plan.name, v.causes[0].step.path if v.causes else "", v.label, whole=True,
                             at=Box.around(ends).centre if len(ends) else None, beside=beside)

    if v.kind == "bare":
        out.whole = whole(codes.NO_INK_UNDER_TITLE(view=name), "not-judged")
        return out
    lines = v.lines
    off = _moved_lines(v)
    if v.kind == "mistake":
        done = joined([c.remark for c in v.causes[:TOLD]], "; " if v.both else codes.OR)
        assert done is not None
        h = v.causes[0].mistake
        named = {"kind": h.kind, "mistake": h.words} if h is not None else {}
        drawn = [n for n in off if v.fit is not None and v.fit.drawn[n] >= DRAWN_SHARE]
        out.whole = whole(done, "red", **named, explains=len(drawn), of=len(drawn) + len(v.unexplained))
    elif v.kind == "unlike":
        label = v.label or tell("all")
        out.whole = whole(codes.ANOTHER_PLAN(position=label, n=len(v.unexplained)), "red")
        return out
    elif v.kind == "partly":
        out.whole = whole(codes.LINES_DO_NOT_FIT(n=len(v.unexplained)), "red")
    assert v.fit is not None
    for n, kind in enumerate(lines.kinds):
        if kind == OTHERS and not (v.fit.drawn[n] >= DRAWN_SHARE and n in off):
            continue
        z = v.fit.at(np.array([lines.tails[n], lines.heads[n]]))
        _, step, _, name_of = v.view.pairs[int(lines.numbers[n]) % len(v.view.pairs)]
        k = v.positions[int(lines.numbers[n]) // len(v.view.pairs)]
        follows: FindingRecord | None = None
        verdict: Outcome = "green"
        if v.fit.drawn[n] < DRAWN_SHARE:
            remark, verdict = codes.NOT_DRAWN(), "not-judged"
        elif v.reversed_heads and n in v.reversed_heads:
            remark, verdict = codes.ARROW_POINTS_BACK(), "red"
        elif n in off:
            remark, verdict, follows = codes.AS_FOLLOWS(by=millimetres(off[n])), "red", out.whole
        else:
            remark = codes.IN_REACH()
        out.lines[n] = FindingRecord(remark, verdict, name, plan.name, step.path, plan.labels[k], length=float(abs(z[1] - z[0])),
                                     tolerance=pencil, follows=follows, at=complex(z.mean()),
                                     beside={"element": "line", "name": name_of})
    if v.reversed_heads is None and plan.pole:
        out.whole = out.whole or whole(codes.HEADS_NOT_READ(), "not-judged")
    return out


def _moved_lines(v: JudgedView) -> dict[int, float]:
    """Lines of a plan that was built otherwise, by how many mm they lie elsewhere."""
    if v.kind != "mistake" or v.fit is None:
        return {}
    exact = {int(n): i for i, n in enumerate(v.exact.numbers.tolist())}
    out = {}
    for i, n in enumerate(v.lines.numbers.tolist()):
        was = exact.get(int(n))
        now = v.fit.at(np.array([v.lines.tails[i], v.lines.heads[i]]))
        there = now * np.nan if was is None else v.fit.at(np.array([v.exact.tails[was], v.exact.heads[was]]))
        off = float(abs(now[1] - now[0])) if was is None else float(np.abs(now - there).max())
        if off > SAME_MM:
            out[i] = off
    return out


def _of_all(judged: JudgedPlans, views: Sequence[_OfView]) -> Iterator[FindingRecord]:
    """What is wrong with the drawing as a whole: mirrored, or nothing fits."""
    if judged.mirrored:
        upright = [v.fit.scale for v in judged.fitting if v.fit is not None]
        across = np.median(np.cos(np.angle(upright))) < 0
        key = "mechanism across" if across else "mechanism upside down"
        yield FindingRecord(built_otherwise(key), "red", beside={"kind": "mirror", "mistake": key}, whole=True)
    if len(views) > 1 and all(v.view.kind in ("unlike", "bare") for v in views):
        yield FindingRecord(codes.ANOTHER_MECHANISM(), "red", whole=True)


def _unclaimed(space: DrawingSpace, judged: JudgedPlans) -> list[dict[str, Any]]:
    """Ink of views that no line explains, an entry a stroke."""
    out: list[dict[str, Any]] = []
    for v in judged.views:
        for n in v.unexplained.tolist():
            a, b = complex(judged.ink.a[n]), complex(judged.ink.b[n])
            e = space.entities[space.strokes[int(judged.ink.stroke[n])].entity]
            out.append({"kind": "line", "length_mm": round(abs(b - a), 3), "at_mm": point((a + b) / 2), "where": str(e),
                        "number": len(out) + 1, "count": 1, "entity": e.tree})
    return out


# --- telling ----------------------------------------------------------------------------------------------------------------------


def _notes(judged: JudgedPlans) -> Iterator[str]:
    n = len(judged.views)
    yield tell_n("the layout is the student's own: {n} view, judged by its title and its lines",
                 "the layout is the student's own: {n} views, judged by their titles and their lines", n).format(n=n)
    if judged.askew:
        yield tell("the plans are turned against the lettering; they were judged as they lie")
    if judged.ink.curves:
        yield tell("circles and curves are not judged in a layout of its own: {n}").format(n=judged.ink.curves)


def _figures_without_title(judged: JudgedPlans) -> list[str]:
    n = len(judged.untitled)
    said = tell_n("{n} figure without a title is no plan as it should be: {hint}",
                  "{n} figures without a title are no plans as they should be: {hint}", n)
    return [said.format(n=n, hint=tell(HINT))] if n else []


def _not_drawn(views: Sequence[_OfView]) -> list[str]:
    """A line for each view that leaves something out; a class of lines is named as a class."""
    out = []
    for v in views:
        gone = [n for n, r in v.lines.items() if r.verdict == "not-judged"]
        of = Counter(v.view.lines.kinds[n] for n in v.lines)
        kinds = Counter(v.view.lines.kinds[n] for n in gone)
        classes = [k for k in kinds if k != MAIN and kinds[k] == of[k]]
        names = [tell(CLASSES[k]) for k in classes]
        names += [str(v.lines[n].beside["name"]) for n in gone if v.view.lines.kinds[n] not in classes]
        if names:
            shown = ", ".join(dict.fromkeys(names[:SHOWN]))
            more = " …" if len(names) > SHOWN else ""
            out.append(tell('view "{view}": not drawn: {what}').format(view=v.name, what=shown + more))
    return out


def _row(v: _OfView) -> tuple[str, ...]:
    plan, count = v.view.view.plan, Counter(r.verdict for r in v.lines.values())
    some = "" if v.view.kind == "bare" else tell("all") if len(v.view.positions) == len(plan.labels) else ", ".join(
        plan.labels[k] for k in v.view.positions)
    what = v.whole.remark.said() if v.whole is not None else tell("right")
    wrong = count["red"] + (len(v.view.unexplained) if v.view.kind in ("partly", "unlike") else 0)
    return (v.view.title or "–", f"{plan.name} {some}".strip(), what, str(count["green"]), str(wrong), str(count["not-judged"]))


def _listed_view(v: _OfView) -> dict[str, Any]:
    fit = v.view.fit
    at = {} if fit is None else {"share": round(1 - fit.extra / max(fit.ink, 1e-9), 4), "mu": 1 / abs(fit.scale),
                                 "shift": point(fit.origin)}
    return {"view": v.name, "plan": v.view.view.plan.name, "position": v.view.label, "kind": v.view.kind, **at}


def _told(v: _OfView, judged: JudgedPlans) -> ToldMistake:
    """What is wrong in a view, with its picture; lines that follow from a mistake are one line of text."""
    named = v.whole is not None and v.whole.verdict == "red"
    reversed_ = [str(r.beside["name"]) for _, r in v.wrong if r.remark.code == "arrow-reversed"]
    details = [tell("the arrow points the other way: {lines}").format(lines=", ".join(reversed_))] if reversed_ else []
    after = [r for _, r in v.wrong if r.follows is not None]
    if after:
        names = dict.fromkeys(str(r.beside["name"]) for r in after)
        details.append(tell("follows from it: {lines}").format(lines=", ".join(names)))
    if named and v.view.unexplained.size:
        n = v.view.unexplained.size
        details.append(tell_n("{n} line of the figure is explained by nothing", "{n} lines of the figure are explained by nothing",
                              n).format(n=n))
    what = v.whole.remark.said() if named and v.whole is not None else tell("arrows point the other way")
    return ToldMistake(v.name, what, "red", tuple(details), _picture(v, judged), named=v.view.kind == "mistake")


def _picture(v: _OfView, judged: JudgedPlans) -> StoryPicture:
    """The view: as it should be, as it is drawn, and what of that is wrong."""
    ink, view = judged.ink, v.view
    ours = tuple(_drawn_as(view, view.fit)) if view.fit is not None and view.kind != "unlike" else ()
    strokes = [np.array([ink.a[n], ink.b[n]]) for n in view.strokes.tolist()]
    wrong = [np.array([ink.a[n], ink.b[n]]) for n in view.unexplained.tolist()]
    places = []
    if view.fit is not None:
        for n, r in v.wrong:
            z = view.fit.at(np.array([view.lines.tails[n], view.lines.heads[n]]))
            wrong.append(z)
            places.append((complex(z.mean()), 0.0, str(r.beside["name"])))
    picture = StoryPicture(ours or tuple(strokes), (), tuple(wrong), tuple(places))
    return StoryPicture(picture.ours if ours else (), clipped(strokes, picture.box), tuple(wrong), tuple(places))


def _drawn_as(v: JudgedView, fit: Fit) -> list[Points]:
    """The lines of a view as they should be, of those that are always missed and those that are drawn."""
    there = {int(n): d >= DRAWN_SHARE for n, d in zip(v.lines.numbers.tolist(), fit.drawn.tolist(), strict=True)}
    return [fit.at(np.array([v.exact.tails[i], v.exact.heads[i]])) for i, n in enumerate(v.exact.numbers.tolist())
            if v.exact.kinds[i] != OTHERS and (v.exact.kinds[i] == MAIN or there.get(int(n), False))]
