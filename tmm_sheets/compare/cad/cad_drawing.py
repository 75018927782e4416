"""A student's CAD drawing against a sheet: laid over it, its views placed, compared element by element."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from tmm_sheets.compare import codes, view_places
from tmm_sheets.compare.cad import cad_built, cad_file, cad_overlay, cad_report, cad_story, layout
from tmm_sheets.compare.cad.cad_findings import CadFinding, CadOutcome
from tmm_sheets.compare.cad.cad_ink import CadInk, DrawingSpace
from tmm_sheets.compare.cad.cad_language import lettered
from tmm_sheets.compare.cad.matching import match
from tmm_sheets.compare.cad.rebuilt_views import lost_views
from tmm_sheets.compare.cad.registration import Registration, fitting, register
from tmm_sheets.compare.cad.view_search import AS_DRAWN
from tmm_sheets.compare.diagnosis.drawn_plan import rebuilt, vanished
from tmm_sheets.compare.diagnosis.hypotheses import Hypothesis
from tmm_sheets.compare.elements import Element, ElementView, drawn
from tmm_sheets.compare.elements import views as views_of
from tmm_sheets.compare.findings import worst
from tmm_sheets.compare.known_sheet import KnownSheet, known_sheet, sheet_numbers
from tmm_sheets.compare.placing import Placing
from tmm_sheets.compare.report import Report
from tmm_sheets.compare.story import listed
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.numbers import decimal, told
from tmm_sheets.words import marked, name_of, on_paper, paper, tell

if TYPE_CHECKING:
    from tmm_sheets.project import Project

LOST = 0.2
"""Share of a sheet's lines that must be found; a drawing with fewer is not of this sheet."""
DRAWN_AT = {2.0: "1:2", 2.5: "1:2.5", 4.0: "1:4", 5.0: "1:5", 10.0: "1:10", 0.5: "2:1", 0.4: "2.5:1", 0.25: "4:1", 0.2: "5:1"}
"""Scales of GOST 2.302 by mm of the sheet per mm drawn."""
UNIT_NAMES = {1000.0: marked("metres"), 25.4: marked("inches"), 10.0: marked("centimetres"), 1.0: marked("millimetres")}
"""Units by mm."""


def compare(project: Project, sheet: int | None, path: Path, views: Path | None, pencil: float,
            say: Callable[[str], None]) -> Report:
    """Compare a DXF drawing with a sheet of a project; the report has two overlays besides text and JSON.

    Parameters and errors are those of :func:`examine`.
    """
    found = examine(project, sheet, path, views, pencil, say)
    say(tell("overlay"))
    outcome, laid = found.outcome, found.laid
    gone = cad_report.gone(outcome)
    shown = [f for f in worst(outcome.findings) if f.element.view not in gone]
    marked = [(f.at, f.reach, str(f.element.number), str(f.verdict)) for f in shown]
    marked += [(x.at, x.reach, f"+{k}", str(x.verdict)) for k, x in enumerate(outcome.extras, 1)]
    looks = [(look.places, f"~{k}") for k, look in enumerate(outcome.looks, 1)]
    exact = [p for e in found.exact for p in drawn(e)]
    files = cad_overlay.files(laid.known.n, laid.known.sheet.drawing, exact, found.space, marked, looks)
    name = project.variant.project.name
    report = cad_report.report(name, path, found, pencil)
    said = "\n".join([*listed(cad_story.mistakes(found, gone)), report.text])
    return replace(report, text=said, files=files, story=cad_story.story(name, path, found, pencil))


def examine(project: Project, sheet: int | None, path: Path, views: Path | None, pencil: float,
            say: Callable[[str], None] = lambda _: None) -> cad_report.ExaminedDrawing:
    """Compare a DXF drawing with a sheet of a project.

    Parameters
    ----------
    project : the project the drawing is of
    sheet : number of the sheet from 1, None for the one it fits best
    path : the drawing
    views : file of the views that are not in their places (:mod:`~tmm_sheets.compare.view_places`), None without one
    pencil : how far a point may be off, mm
    say : told what is being done

    Raises
    ------
    BadInput
        If the file cannot be read as DXF, there is no such sheet, or the drawing is of none of them.
    """
    numbers = sheet_numbers(project, sheet)
    say(tell("reading {file}").format(file=path.name))
    ink = cad_file.read(path)
    known = []
    for n in numbers:
        say(tell("sheet {n}").format(n=n))
        known.append(known_sheet(project, n))
    if views is not None and len(known) > 1:
        raise BadInput(tell("--views needs --sheet N: its views are those of one sheet"))
    language, said = lettered(project, known, ink)
    if language == paper():
        return _examined(project, sheet, path, views, pencil, say, ink, known)
    with on_paper(language):
        found = _examined(type(project)(project.variant), sheet, path, views, pencil, say, ink, said)
    note = tell("the drawing is lettered in {language}; it was compared with the sheet in that language")
    return replace(found, notes=(*found.notes, note.format(language=tell(name_of(language)))))


def _examined(project: Project, sheet: int | None, path: Path, views: Path | None, pencil: float,
              say: Callable[[str], None], ink: CadInk, known: Sequence[KnownSheet]) -> cad_report.ExaminedDrawing:
    """The contents of a drawing compared with the sheets known, in its language."""
    say(tell("laying it over the sheet"))
    laid = register(known, ink)
    given = view_places.read(views, views_of(laid.known.sheet)) if views is not None else ()
    space = laid.space.placed(laid.placing)
    space = replace(space, writings=tuple(w for w in space.writings if not laid.known.tells_who([w.at])),
                    strokes=tuple(s for s in space.strokes if not laid.known.tells_who(s.points)))
    say(tell("placing the views"))
    places = layout.find(laid.known.elements, space, [(p, laid.placing) for p in given], say, laid.views)
    made: list[Hypothesis] = []
    shaped = places.share
    if laid.views:
        lost, made = lost_views(project, laid.known, space, places)
        shaped = {v: share for v, share in places.share.items() if v not in lost}  # these are where a mistake leads them
        places = places.with_more(lost)
    absent = {v for v in places.share if places.absent(v)}

    def matched(elements: Sequence[Element]) -> CadOutcome:
        return _matched(laid.known.elements, elements, absent, space, places.moves, pencil)

    outcome = matched(laid.known.elements)
    say(tell("looking for what was done wrong"))
    by_chance = _by_chance(outcome, shaped) if places.own else set()
    built = cad_built.built_otherwise(project, laid.known, space, places.moves, outcome, made, absent | by_chance)
    now = [rebuilt(e, built[e.view][1]) if e.view in built else e for e in laid.known.elements]
    kept = absent | {v for v in places.share if not v.n}  # a frame alone is one
    again, gone = bool(built), cad_report.gone(outcome) - kept - built.keys()
    while again or gone:  # ink of a view that is not there after all is that of nothing
        absent |= gone
        outcome, again = matched(now), False
        gone = cad_report.gone(outcome) - absent - kept
    if not _of_this_sheet(outcome, places.own):  # one mistake may lead everything elsewhere
        _refuse(project, laid, outcome, ink, sheet, path)
    notes = (*ink.notes, *_how(laid, ink.unit), *places.notes, *outcome.notes)
    return cad_report.ExaminedDrawing(laid, space, places, outcome, notes, {view: plan for view, (plan, _) in built.items()})


def _by_chance(outcome: CadOutcome, shaped: Mapping[ElementView, float]) -> set[ElementView]:
    """Views that were taken for ink of their shape that has nothing else of them."""
    return {v for v in cad_report.gone(outcome) if shaped.get(v, 0.0) >= AS_DRAWN}


def _matched(known: Sequence[Element], now: Sequence[Element], absent: Collection[ElementView], space: DrawingSpace,
             moves: Mapping[ElementView, Placing], pencil: float) -> CadOutcome:
    """The outcome with plans compared as they were built, judged by how they should have been.

    ``known`` and ``now`` are the elements of the sheet as they should be and as they were built; ``absent`` views have no ink.
    """
    outcome = match([e for e in now if e.view not in absent and not vanished(e)], space, moves, pencil)
    found = {f.element.number: f for f in outcome.findings}

    def finding(was: Element, e: Element) -> CadFinding:
        if e.view in absent:
            return CadFinding(e, "red", e.length, codes.MISSING(), e.middle, 5.0, missing=True)
        judged, move = found.get(e.number), moves.get(was.view, Placing())
        return judged if was is e and judged is not None else cad_built.as_built(judged, was, e, move, pencil)

    return replace(outcome, findings=tuple(map(finding, known, now)))


def _how(laid: Registration, unit: float | None) -> Iterator[str]:
    """What was done to a drawing to lay it over the sheet."""
    degrees = laid.placing.degrees
    if laid.placing.mirrored:
        yield tell("the drawing is mirrored; it was turned over for the comparison")
    quarter = round(degrees / 90) % 4
    if quarter:
        yield tell("the drawing lies turned by {degrees}°; it was turned back").format(degrees=(-90 * quarter) % 360)
    rest = (degrees + 45) % 90 - 45
    if abs(rest) > 0.02:
        yield tell("the drawing is askew by {degrees}°; it was straightened").format(degrees=told(decimal(-rest)))
    declared = 1.0 if laid.space.paper else unit  # paper space is in millimetres
    if abs(laid.placing.scale / (declared or 1.0) - 1) > 1e-3:
        yield _scaled(laid.placing.scale, declared)
    if laid.space.paper:
        yield tell("compared is {space}, with what its viewports show").format(space=laid.space.name)


def _scaled(scale: float, declared: float | None) -> str:
    """A scale, mm of the sheet per unit of the drawing, that is not the unit the file declares, in words."""
    unit = declared or 1.0
    drawn_at = next((said for r, said in DRAWN_AT.items() if abs(scale / unit / r - 1) < 1e-3), None)
    units = next((name for mm, name in UNIT_NAMES.items() if abs(scale / mm - 1) < 1e-3), None)
    declares = (tell("no units") if not declared else tell(UNIT_NAMES[unit]) if unit in UNIT_NAMES else
                tell("units of {unit} mm").format(unit=told(f"{unit:g}")))
    if units is not None and (drawn_at is None or declared != 1.0):
        said = tell("the drawing is in {units} though the file declares {declares}; it was scaled accordingly")
        return said.format(units=tell(units), declares=declares)
    if drawn_at is not None:
        return tell("the drawing is at scale {scale}; it was scaled to 1:1").format(scale=told(drawn_at))
    other = next(((name, at) for mm, name in reversed(UNIT_NAMES.items()) for r, at in DRAWN_AT.items()
                  if abs(scale / mm / r - 1) < 1e-3), None)
    if other is not None:
        said = tell("the drawing is in {units} at scale {scale} though the file declares {declares}; it was scaled accordingly")
        return said.format(units=tell(other[0]), scale=told(other[1]), declares=declares)
    said = tell("one unit of the drawing is {size} mm of the sheet; it was scaled accordingly")
    return said.format(size=told(f"{scale:.6g}"))


def _judged_lines(outcome: CadOutcome) -> list[CadFinding]:
    return [f for f in outcome.findings if f.element.kind != "text" and f.element.view.n and f.verdict is not None]


def _green(found: Sequence[CadFinding]) -> float:
    """Share of the findings that are green, or off as follows from a mistake."""
    return sum(f.verdict == "green" or f.follows for f in found) / max(len(found), 1)


def _of_this_sheet(outcome: CadOutcome, own: bool) -> bool:
    """Whether enough lines are right on the whole sheet, or of what a layout of its ``own`` shows; or in one view."""
    gone = cad_report.gone(outcome) if own else ()
    found = [f for f in _judged_lines(outcome) if f.element.view not in gone]
    by_view: dict[ElementView, list[CadFinding]] = {}
    for f in found:
        by_view.setdefault(f.element.view, []).append(f)
    return _green(found) >= LOST or any(len(of_view) > 10 and _green(of_view) > 0.7 for of_view in by_view.values())


def _refuse(project: Project, laid: Registration, outcome: CadOutcome, ink: CadInk, asked: int | None, path: Path) -> None:
    """Say that the drawing is not of this sheet, and of which it may be."""
    hint = tell("is it the right project and variant? a drawing with a layout of its own can be told with --views where its "
                "views are")
    count = len(project.variant.sheets)
    if asked is not None and count > 1:
        other, fit = fitting([known_sheet(project, n) for n in range(1, count + 1) if n != asked], ink)
        if fit > max(laid.share + 0.15, 0.4):
            hint = tell("it looks like sheet {n}: use --sheet {n}, or leave --sheet out").format(n=other)
    said = tell("only {share} % of the lines of sheet {n} are in this drawing") if asked is not None or count == 1 else tell(
        "only {share} % of the lines of any of the {count} sheets are in this drawing")
    hint = "; ".join((*ink.notes, hint))
    share = round(100 * _green(_judged_lines(outcome)))
    raise BadInput(Problem(said.format(share=share, n=laid.known.n, count=count), str(path), hint=hint))
