"""The report on a comparison with a CAD drawing as it is read: view by view what is wrong, with a picture, worst first."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from tmm_sheets.compare import codes
from tmm_sheets.compare.cad import cad_report, omissions
from tmm_sheets.compare.cad.cad_findings import CadFinding
from tmm_sheets.compare.diagnosis.hypotheses import built_otherwise
from tmm_sheets.compare.elements import ElementView, drawn
from tmm_sheets.compare.findings import called, counted, millimetres, worst
from tmm_sheets.compare.story import Story, StoryPicture, StoryTable, ToldMistake, clipped
from tmm_sheets.numbers import told
from tmm_sheets.words import tell, tell_n

SHOWN = 10
"""Most findings of a view that are told in words beside its picture; the table has all."""


def story(name: str, path: Path, found: cad_report.ExaminedDrawing, pencil: float) -> Story:
    """The report on a drawing of project ``name``; ``pencil`` is the tolerance, mm."""
    lost = cad_report.gone(found.outcome)
    title = tell("{project}, sheet {sheet}: {file}").format(project=name, sheet=found.laid.known.n, file=path.name)
    tolerance = tell("tolerance {tolerance} mm").format(tolerance=told(f"{pencil:g}"))
    about = (tolerance, cad_report.summary(found, lost, pencil), *found.notes)
    tables = [StoryTable(said[:1].upper() + said[1:], head, tuple(rows)) for said, head, rows in cad_report.tables(found, lost)
              if rows]
    return Story(title, about, tuple(mistakes(found, lost)), tuple(tables), tuple(_unjudged(found, lost)))


def mistakes(found: cad_report.ExaminedDrawing, lost: set[ElementView]) -> list[ToldMistake]:
    """What is wrong, view by view: those built on a wrong step first, then those with the most red."""
    of_view: dict[ElementView, list[CadFinding]] = {}
    for f in worst(found.outcome.findings):
        if f.element.view not in lost:
            of_view.setdefault(f.element.view, []).append(f)
    first: dict[str, ElementView] = {}
    for v, built in found.built.items():  # in the order of drawing
        first.setdefault(built.said(), v)

    def place(v: ElementView) -> tuple[bool, int, int]:
        if v in found.built:
            return False, list(found.built).index(v), 0
        return True, -sum(f.verdict == "red" for f in of_view[v]), v.n

    turned = [replace(_mistake(found, v, of_view.pop(v, []), None), what=remark.said(), verdict="red", named=True)
              for v, remark in found.turned.items() if v not in lost]
    order = sorted(of_view, key=place)
    one_by_one = [_mistake(found, v, of_view[v], first.get(found.built[v].said()) if v in found.built else None) for v in order]
    named = sum(m.named for m in one_by_one)
    whole = [ToldMistake(tell("the whole drawing"), built_otherwise(key).said(), "red", named=True)
             for key in filter(None, (found.mirrored,))]
    return [*whole, *one_by_one[:named], *turned, *one_by_one[named:]]


def _mistake(found: cad_report.ExaminedDrawing, view: ElementView, bad: Sequence[CadFinding],
             first: ElementView | None) -> ToldMistake:
    """What is wrong in a view, its picture beside it; ``first`` is the view in which the same was done, of one that is built so."""
    red = sum(f.verdict == "red" for f in bad)
    built = found.built.get(view)
    what = built.said() if built is not None else counted(bad)
    others = [f for f in bad if not f.follows]
    details = [tell("no. {number}, {element}: {what}").format(number=f.element.number, element=called(f.element), what=f.what)
               for f in others[:SHOWN]]
    if len(others) > SHOWN:
        details.append(tell("and {n} more, in the table").format(n=len(others) - SHOWN))
    again = ""
    if built is not None:
        after = [f for f in bad if f.follows and f.element.kind == "line" and f.element.role in ("vector", "link")]
        said = [built.explained()]
        if first is not None and first != view:
            again = tell('the same as in view "{view}": it follows from there').format(view=first.name)
        if after:
            told_all = tell("up to {by} mm off, as follows from the mistake: {lines}")
            said.append(told_all.format(by=told(millimetres(max(f.deviation for f in after))),
                                        lines=", ".join(dict.fromkeys(f.element.name for f in after))))
        details = [*said, *details]
    return ToldMistake(view.name, what, "red" if red else "amber", tuple(details), _picture(found, view, bad),
                   named=built is not None, again=again[:1].upper() + again[1:])


def _picture(found: cad_report.ExaminedDrawing, view: ElementView, bad: Sequence[CadFinding]) -> StoryPicture | None:
    """The view: ours where the drawing has it, theirs, what is wrong in it."""
    ours = tuple(p for f, e in zip(found.outcome.findings, found.exact, strict=True) if e.view == view and not f.absent
                 for p in drawn(e))
    entities = {k for f in bad for k in f.entities}
    wrong = [s.points for s in found.space.strokes if s.entity in entities]
    # Where a line is missing nothing is drawn wrong: the exact one and its number tell it.
    wrong += [p for f in bad if view in found.built and not f.missing for p in drawn(f.element)]
    lines = [f for f in bad if f.element.kind != "text"]
    if not lines:
        return None
    size = max(float(np.ptp(z.real) + np.ptp(z.imag)) for z in ours) if ours else 100.0
    places = [(f.at, min(f.reach, max(0.04 * size, 1.5)), str(f.element.number)) for f in lines if not f.follows]
    # What follows from a mistake is called as on the plan: the points where it has dots, else the lines.
    after = [f for f in lines if f.follows and f.element.name]
    dots = [f for f in after if f.element.kind == "circle"]
    places += [(f.at, 0.0, f.element.name) for f in dots or after]
    picture = StoryPicture(ours, (), tuple(wrong), tuple(places))
    box = picture.box
    theirs = clipped([s.points for s in found.space.strokes], box)
    return StoryPicture(ours, theirs, clipped(wrong, box), tuple(places))


def _unjudged(found: cad_report.ExaminedDrawing, lost: set[ElementView]) -> list[str]:
    """What could not be judged, and why."""
    beside = cad_report.tables_and_texts(found.outcome)
    out = [codes.VIEW_MISSING(view=v.name).said()
           for v in sorted(lost - beside, key=lambda v: v.n)]
    out += cad_report.not_as_ours(lost & beside)
    by_view: dict[str, list[str]] = {}
    for x in found.outcome.absent:
        if x.view not in lost:
            by_view.setdefault(x.view.name, []).append(omissions.said(x.kind, x.count))
    out += [tell('view "{view}": not drawn: {what}').format(view=name, what=", ".join(what)) for name, what in by_view.items()]
    skipped = Counter(f.what for f in found.outcome.findings if f.verdict is None and not f.absent and f.element.view not in lost)
    out += [tell("not compared: {what} ({n})").format(n=n, what=what) for what, n in skipped.items()]
    extra = len(found.outcome.extras)
    if extra:
        said = tell_n("{n} line or text that belongs to nothing on the sheet is in the table, but not judged as a mistake",
                      "{n} lines or texts that belong to nothing on the sheet are in the table, but not judged as mistakes", extra)
        out.append(said.format(n=extra))
    return out
