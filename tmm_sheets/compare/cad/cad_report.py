"""The report on a CAD drawing, whatever its layout: table, JSON, and the story view by view with pictures, and its overlays."""

from __future__ import annotations

from collections import Counter
from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import radians
from pathlib import Path
from typing import Any

import numpy as np

from tmm_sheets.compare import codes
from tmm_sheets.compare.cad import cad_extras
from tmm_sheets.compare.cad.cad_comparison import CadFinding, CadOutcome
from tmm_sheets.compare.cad.cad_ink import DrawingSpace, Entity
from tmm_sheets.compare.diagnosis.built_plan import SHOWN, told_view
from tmm_sheets.compare.diagnosis.hypotheses import built_otherwise
from tmm_sheets.compare.elements import Element, ElementView, drawn, grouped
from tmm_sheets.compare.findings import (
    FindingRecord,
    Report,
    StoryPicture,
    StoryTable,
    ToldMistake,
    called,
    clipped,
    millimetres,
    of_element,
    place,
    point,
    reported,
    said_verdict,
    worst,
)
from tmm_sheets.compare.placing import Placing
from tmm_sheets.drawing.marks import Drawing, Role
from tmm_sheets.numbers import told
from tmm_sheets.words import tell, tell_n

SHAPES: frozenset[Role] = frozenset({"vector", "link", "curve"})
"""Roles of lines without which a view is a table or a text."""
MANY = 4
"""Most numbers of elements in a row on line types and widths."""
VIEW_GONE = 0.15
"""A view with most of it missing is told as missing if less than this share of it is right."""


@dataclass(frozen=True)
class ExaminedDrawing:
    """A drawing compared with a sheet, or with the plans that its titles promise.

    Attributes
    ----------
    sheet : number of the sheet, or of one with such plans
    space : the drawing, mm
    blank, paper : paper for all of it, and how it comes to lie on that
    exact : what the findings are on as it should be, where the drawing has its view; the findings have it as it was built
    tolerance : how far a line may be off, mm
    outcome : what was found
    notes : what was done to the drawing and what deserves a warning, one line each
    whole : what is listed of the whole drawing
    of_views : what is listed of whole views: plans that were built on a wrong step, or are others
    tables : before those of what deviates
    beside : further keys of JSON
    """

    sheet: int
    space: DrawingSpace
    blank: Drawing
    exact: tuple[Element, ...]
    tolerance: float
    outcome: CadOutcome
    notes: tuple[str, ...]
    whole: Sequence[FindingRecord]
    of_views: Mapping[ElementView, FindingRecord]
    beside: Mapping[str, Any]
    paper: Placing
    tables: tuple[StoryTable, ...] = ()

    @cached_property
    def lost(self) -> set[ElementView]:
        """Views that are missing from the drawing."""
        return gone(self.outcome)


def mirror_told(across: bool) -> FindingRecord:
    """That the whole drawing lies as in a mirror: paper may be turned, not that."""
    key = "mechanism across" if across else "mechanism upside down"
    return FindingRecord(built_otherwise(key), "red", beside={"kind": "mirror", "mistake": key}, whole=True)


def gone(outcome: CadOutcome) -> set[ElementView]:
    """Views that are missing from the drawing."""
    return {v for v, found in outcome.by_view.items() if _is_gone(found)}


def _is_gone(found: Sequence[CadFinding]) -> bool:
    """Whether hardly anything of a view is there, of what it does not leave out; what follows from a mistake is."""
    judged = [f for f in found if not f.absent]
    there = sum(f.verdict == "green" or f.follows for f in judged)
    return (len(found) > 5 or all(f.missing for f in judged)) and sum(f.missing for f in judged) >= 0.6 * len(judged) and (
        there < VIEW_GONE * len(judged) or not judged)


def tables_and_texts(outcome: CadOutcome) -> set[ElementView]:
    """Views that have no shape: a student may have them in another form, so that they are not found, or leave them out."""
    return {v for v, found in outcome.by_view.items() if not any(f.element.role in SHAPES for f in found)}


def _found_by(entities: Sequence[Entity]) -> str:
    if not entities:
        return ""
    said = tell("{entity} and {n} more") if len(entities) > 1 else "{entity}"
    return said.format(entity=entities[0], n=len(entities) - 1)


def _tables(found: ExaminedDrawing) -> Iterator[StoryTable]:
    """Of what deviates, what is extra, and what has another type or width of line."""
    last = (tell("verdict"), tell("in the drawing"))
    no, view = tell("no."), tell("view")
    for title, head, rows in (
            (tell("deviations"), (no, view, tell("element"), tell("deviation"), *last), _deviations(found)),
            (tell("extra, on no element of the sheet"), (no, tell("what"), tell("about, mm"), *last), _extras(found.outcome)),
            (tell("of another type or width of line"), (no, view, tell("lines"), tell("what"), *last), _looks(found))):
        if rows:
            yield StoryTable(title[:1].upper() + title[1:], head, tuple(rows))


def _summary(found: ExaminedDrawing, records: Sequence[FindingRecord]) -> str:
    """How many findings got each verdict: the numbers of the JSON."""
    outcome, lost = found.outcome, found.lost
    beside = tables_and_texts(outcome)
    colours = Counter(r.verdict for r in records)
    most = max((f.deviation for f in outcome.findings if f.verdict == "green" and f.element.view not in lost), default=0.0)
    skipped = colours["not-judged"]
    said = [tell("{green} green (up to {most} mm), {amber} amber, {red} red, {skipped} not judged") if skipped else
            tell("{green} green (up to {most} mm), {amber} amber, {red} red"), tell("{extra} extra")]
    if lost - beside:
        said.append(tell("{lost} of {views} views not found"))
    if lost & beside:
        said.append(tell("{lost_tables} of {tables} tables, texts and details not found"))
    if outcome.looks:
        said.append(tell("{unlike} of another type or width of line"))
    return "; ".join(said).format(
        green=colours["green"], amber=colours["amber"], red=colours["red"], skipped=skipped, most=told(f"{most:.2f}"),
        extra=len(outcome.extras), lost=len(lost - beside), views=len({f.element.view for f in outcome.findings} - beside),
        lost_tables=len(lost & beside), tables=len(beside),
        unlike=len({n for look in outcome.looks for n in look.elements}))


def _deviations(found: ExaminedDrawing) -> list[tuple[str, ...]]:
    """A row for every element that is not green, except those of missing views; one for all in a view that a mistake led on to."""
    entities = found.space.entities
    bad = [f for f in worst(found.outcome.findings) if f.element.view not in found.lost]
    rows: list[tuple[str, ...]] = [
        (str(f.element.number), f.element.view.name, called(f.element), f.what, said_verdict(f.verdict),
         _found_by([entities[k] for k in f.entities])) for f in bad if not f.follows]
    for view, led in grouped([f for f in bad if f.follows], lambda f: f.element.view).items():
        by = codes.AS_FOLLOWS(by=millimetres(max(f.deviation for f in led)))
        numbers = sorted(f.element.number for f in led)
        rows.append(("", view.name, _numbered(tell("lines"), numbers), by.said(), said_verdict("red"), ""))
    return rows


def _numbered(lines: str, numbers: Sequence[int]) -> str:
    """Some lines and the numbers of their elements."""
    said = tell("{lines}, {n}: no. {numbers}, ...") if len(numbers) > MANY else tell("{lines}: no. {numbers}")
    return said.format(lines=lines, n=len(numbers), numbers=", ".join(map(str, numbers[:MANY])))


def _extras(outcome: CadOutcome) -> list[tuple[str, ...]]:
    """A row for everything extra."""
    rows: list[tuple[str, ...]] = []
    for k, x in enumerate(outcome.extras, 1):
        said = (tell('text "{text}"') if x.text else tell("{length} mm of line in {n} entities") if x.count > 1 else
                tell("{length} mm of line"))
        what = said.format(text=x.text, length=told(f"{x.length:.1f}"), n=x.count)
        rows.append((f"+{k}", what, told(place(x.at)), said_verdict(x.verdict), str(x.entity)))
    return rows


def _looks(found: ExaminedDrawing) -> list[tuple[str, ...]]:
    """A row for every group of lines of a wrong type or width."""
    rows: list[tuple[str, ...]] = []
    for k, look in enumerate(found.outcome.looks, 1):
        where = _found_by(look.entities)
        view = look.view.name if look.view is not None else tell("all views")
        rows.append((f"~{k}", view, _numbered(look.lines, look.elements), look.what, said_verdict(look.verdict), where))
    return rows


def report(name: str, path: Path, found: ExaminedDrawing) -> Report:
    """The report on a drawing of project ``name``: table, JSON, findings, story."""
    outcome = found.outcome
    lost = sorted(found.lost, key=lambda v: v.n)
    beside = tables_and_texts(outcome) & found.lost
    records, start = _records(found, lost, beside)
    tolerance = tell("tolerance {tolerance} mm").format(tolerance=told(f"{found.tolerance:g}"))
    return reported(
        "cad", name, found.sheet, path, (tolerance, _summary(found, records)), records, start, _mistakes(found),
        [*found.tables, *_tables(found)], _unjudged(found), found.notes,
        [{"kind": x.kind, "length_mm": round(x.length, 3), "at_mm": point(x.at), "where": str(x.entity), "number": k,
          "verdict": x.verdict, "count": x.count, "text": x.text, "entity": x.entity.tree}
         for k, x in enumerate(outcome.extras, 1)],
        {"missing_views": [v.name for v in lost], "missing_tables": [v.name for v in lost if v in beside]},
        drawing=path.name, space=found.space.name, tolerance=found.tolerance, **found.beside,
        not_drawn=[{"view": view.name, "kind": kind, "count": n} for view, kind, n in outcome.absent])


def _records(found: ExaminedDrawing, lost: Sequence[ElementView],
             tables: Container[ElementView]) -> tuple[list[FindingRecord], list[FindingRecord]]:
    """What is listed: the mistakes, views that are missing, lines of another type or width, every element; and where it starts."""
    missing = {v: FindingRecord((codes.TABLE_MISSING(views=v.name) if v in tables else codes.VIEW_MISSING(view=v.name)),
                                "not-judged", v.name, whole=True) for v in lost}
    mistakes = [*found.whole, *found.of_views.values(), *missing.values()]
    looks = (FindingRecord(look.remark, look.verdict, look.view.name if look.view is not None else "", beside={
        "styles": list(look.styles), "numbers": list(look.elements), "entities": [e.tree for e in look.entities]})
        for look in found.outcome.looks)
    # What a mistake leads on to follows from where that was made first.
    reasons = {v: r.follows or r for v, r in found.of_views.items()}
    elements = (_record(found, f, missing.get(f.element.view) or (reasons.get(f.element.view) if f.follows else None))
                for f in found.outcome.findings)
    return [*mistakes, *looks, *elements], [r for r in mistakes if r.follows is None and r.remark.code != "not-compared"]


def _record(found: ExaminedDrawing, f: CadFinding, follows: FindingRecord | None) -> FindingRecord:
    """What is listed of an element; of one in a view that is not there, that it is not drawn."""
    e = f.element
    if follows is not None and follows.remark.code in ("view-missing", "table-missing"):
        return of_element(replace(f, remark=codes.NOT_DRAWN()), "not-judged", follows=follows)
    own = e.radius if e.kind == "circle" else e.length
    beside = {"missing": True} if f.missing else {}
    return of_element(f, f.verdict or "not-judged", shift=f.shift, turn=None if f.turn is None else radians(f.turn),
                      growth=f.size / own if f.size is not None and own else None, tolerance=found.tolerance, follows=follows,
                      beside={**beside, "entities": [found.space.entities[k].tree for k in f.entities]})


def _mistakes(found: ExaminedDrawing) -> list[ToldMistake]:
    """What is wrong, view by view: those wrong as a whole first, as they are drawn, then those with the most red."""
    by_view = found.outcome.by_view
    of_view = {v: bad for v, some in by_view.items() if v not in found.lost and (bad := worst(some))}
    whole = {v: r for v, r in found.of_views.items() if r.verdict == "red" and (v in of_view or v not in found.lost)}
    others = sorted(of_view.keys() - whole.keys(), key=lambda v: (-sum(f.verdict == "red" for f in of_view[v]), v.n))
    return [_mistake(found, v, of_view.get(v, []), whole.get(v)) for v in (*whole, *others)]


def _mistake(found: ExaminedDrawing, view: ElementView, bad: Sequence[CadFinding], whole: FindingRecord | None) -> ToldMistake:
    """What is wrong in a view, its picture beside it; ``whole`` is what is listed of all of it."""
    after, again = [], ""
    rows = [(f.element.number, f.element, f.what) for f in bad if not f.follows]
    if whole is not None and whole.follows is not None:
        again = tell('the same as in view "{view}": it follows from there').format(view=whole.follows.view)
    if led := [f for f in bad if f.follows and f.element.kind == "line" and f.element.role in ("vector", "link")]:
        told_all = tell("up to {by} mm off, as follows from the mistake: {lines}")
        after = [told_all.format(by=told(millimetres(max(f.deviation for f in led))),
                                 lines=", ".join(dict.fromkeys(f.element.name for f in led)))]
    return told_view(view, whole, bad, rows, _picture(found, view, bad), after, again[:1].upper() + again[1:])


def _picture(found: ExaminedDrawing, view: ElementView, bad: Sequence[CadFinding]) -> StoryPicture | None:
    """The view: ours where the drawing has it, theirs, what is wrong in it."""
    ours = tuple(p for f, e in zip(found.outcome.findings, found.exact, strict=True)
                 if e.view == view and f.absent in ("", e.name) for p in drawn(e))
    entities = {k for f in bad for k in f.entities}
    wrong = [s.points for s in found.space.strokes if s.entity in entities]
    # Where a line is missing nothing is drawn wrong: the exact one and its number tell it.
    wrong += [p for f in bad if (view in found.of_views or not f.entities) and not f.missing for p in drawn(f.element)]
    extras = [x.ends for x in found.outcome.extras if x.view == view]
    lines = [f for f in bad if f.element.kind != "text"]
    if not lines and not extras:
        return None
    wrong += extras
    size = max(float(np.ptp(z.real) + np.ptp(z.imag)) for z in ours) if ours else 100.0
    places = [(f.at, min(f.reach, max(0.04 * size, 1.5)), str(f.element.number)) for f in lines if not f.follows]
    # What follows from a mistake is called as on the plan: the points where it has dots, else the lines.
    after = [f for f in lines if f.follows and f.element.name]
    dots = [f for f in after if f.element.kind == "circle"]
    places += [(f.at, 0.0, f.element.name) for f in dots or after]
    box = StoryPicture(ours, (), tuple(wrong), tuple(places)).box
    return StoryPicture(ours, clipped([s.points for s in found.space.strokes], box), clipped(wrong, box), tuple(places))


def _unjudged(found: ExaminedDrawing) -> list[str]:
    """What could not be judged, and why."""
    beside, lost = tables_and_texts(found.outcome), found.lost
    out = [codes.VIEW_MISSING(view=v.name).said() for v in sorted(lost - beside, key=lambda v: v.n)]
    if tables := sorted(lost & beside, key=lambda v: v.n):
        out.append(codes.TABLE_MISSING(views=", ".join(tell('"{view}"').format(view=v.name) for v in tables)).said())
    by_view: dict[str, list[str]] = {}
    for view, kind, n in found.outcome.absent:
        if view not in lost:
            of_kind = cad_extras.KINDS.get(kind)
            by_view.setdefault(view.name, []).append(kind if of_kind is None else tell_n(*of_kind, n).format(n=n))
    out += [tell('view "{view}": not drawn: {what}').format(view=name, what=", ".join(what[:SHOWN] + ["…"] * (len(what) > SHOWN)))
            for name, what in by_view.items()]
    skipped = Counter(f.what for f in found.outcome.findings if f.verdict is None and not f.absent and f.element.view not in lost)
    out += [tell("not compared: {what} ({n})").format(n=n, what=what) for what, n in skipped.items()]
    extra = sum(x.view is None for x in found.outcome.extras)  # in a plan they are told with it
    if extra:
        said = tell_n("{n} line or text that belongs to nothing on the sheet is in the table, but not judged as a mistake",
                      "{n} lines or texts that belong to nothing on the sheet are in the table, but not judged as mistakes", extra)
        out.append(said.format(n=extra))
    return out
