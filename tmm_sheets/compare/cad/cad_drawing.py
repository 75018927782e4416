"""A CAD drawing compared: plans in a layout of its own title first, else element by element with the sheet of ours it shows.

With a sheet the order of the steps keeps ink from being mistaken for that of another element:

1. Elements with ink everywhere along them, within the tolerance, are right, whatever entities the ink is of. They claim it.
2. For each of the others the line, circle or curve that was drawn for it is sought in the rest: shifted, turned, too long,
   with a gap (``displaced_lines.py``).
3. Ink that no element claims is the excess of one that does, or it is extra.
4. The ink of every element should have its line type and width (``line_styles.py``).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tmm_sheets import apart, words
from tmm_sheets.box import Box
from tmm_sheets.compare import codes, overlays
from tmm_sheets.compare.cad import (
    cad_extras,
    cad_file,
    cad_lettering,
    cad_report,
    displaced_lines,
    line_styles,
    plan_report,
    registration,
    symbol_matching,
)
from tmm_sheets.compare.cad.cad_comparison import CadFinding, CadOutcome, Comparison
from tmm_sheets.compare.cad.cad_ink import CadInk, DrawingSpace, normal
from tmm_sheets.compare.cad.line_fit import ONE_PLACE, gaps, lines, overlaps, union
from tmm_sheets.compare.cad.plan_ink import Figure, PlanInk, lies_along
from tmm_sheets.compare.cad.plan_judge import JudgedPlans, judge_plans
from tmm_sheets.compare.cad.plan_views import PlanRecord
from tmm_sheets.compare.cad.registration import fitting, register
from tmm_sheets.compare.diagnosis.built_plan import DrawnPlan, FigureOf, built_otherwise, led_elsewhere, of_built, rebuilt, vanished
from tmm_sheets.compare.elements import (
    Element,
    ElementView,
    KnownSheet,
    drawn,
    interruptions,
    known_sheet,
    sheet_numbers,
    views as views_of,
)
from tmm_sheets.compare.findings import Report, point, verdict, worst
from tmm_sheets.compare.placing import BESIDE, Placing, links, moved, read_places, symbol
from tmm_sheets.drawing.marks import Drawing, Points
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.sheets.views import arrangement
from tmm_sheets.words import name_of, on_paper, paper, tell

if TYPE_CHECKING:
    from tmm_sheets.project import Project

ABOUT_VIEW = 15.0
"""How far beyond the box of a view its lines may go where a mistake was made, mm of paper."""


def _figure_of(space: DrawingSpace, outcome: CadOutcome) -> FigureOf:
    """The strokes about a plan that are not those of something else that is right, nor of lettering."""
    read = cache(lambda: PlanInk(space, 1.0, scaled=True))

    def figure(drawn: DrawnPlan, move: Placing) -> Figure | None:
        ink = read()
        mine = {e.number for e in drawn.vectors}
        box = Box.around(move(np.array(drawn.view.box.corners)), ABOUT_VIEW)
        near = [n for n, z in enumerate(((ink.a + ink.b) / 2).tolist()) if box.contains(z)]
        others = [f.element for f in outcome.findings
                  if f.verdict == "green" and f.element.number not in mine and f.element.kind != "text"]
        ours = lines([p for e in others for p in (e.pieces or (e.points,))])
        about = ours.only((np.maximum(ours.a.real, ours.b.real) > box.x0) & (np.minimum(ours.a.real, ours.b.real) < box.x1))
        left = [n for n in near if not lies_along(ink.a[n], ink.b[n], about.a, about.b)]
        return Figure.of_drawing(ink, np.array(left, dtype=np.intp)) if left else None

    return figure


def as_built(finding: CadFinding | None, was: Element, now: Element, move: Placing, tolerance: float) -> CadFinding:
    """A finding on an element of a rebuilt plan, judged by the place it should have; ``was``, ``now``: before the view's move.

    None is found of a line that has vanished.
    """
    if finding is None:
        there = moved(was, move)
        return CadFinding(there, verdict(there.length, tolerance), there.length, codes.VANISHED(), complex(move(now.points[0])),
                          3.0, follows=True)
    off = float(np.abs(move(now.points) - move(was.points)).max()) if len(now.points) == len(was.points) else 0.0
    if finding.verdict is None or off <= tolerance or was.kind == "text":
        return finding
    if was.role == "symbol" and finding.verdict != "green":
        return replace(finding, verdict=None, deviation=0.0, remark=codes.SYMBOL_ELSEWHERE(), missing=False)
    return led_elsewhere(finding, off, tolerance, finding.remark)


def match(elements: Sequence[Element], space: DrawingSpace, moves: Mapping[ElementView, Placing], tolerance: float) -> CadOutcome:
    """Compare the elements with a drawing that was laid on the sheet.

    Parameters
    ----------
    elements : of one sheet
    space : the drawing, in mm of the sheet
    moves : for views with another place or size in the drawing, how to take them there from the sheet
    tolerance : how far a point may be off, mm
    """
    state = Comparison(elements, space, moves, tolerance)
    _not_compared(state)
    cad_lettering.texts(state)
    _find_in_place(state)
    cad_lettering.drawn_letters(state)
    cad_extras.left_out(state, cad_extras.KINDS.keys() - cad_extras.FOUND_LAST)
    symbol_matching.hatching(state)
    displaced_lines.straight(state, state.unclaimed())
    displaced_lines.shapes(state, state.unclaimed())
    displaced_lines.incomplete(state)
    symbol_matching.filled(state)
    symbol_matching.arrows(state)
    cad_extras.left_out(state, cad_extras.FOUND_LAST)
    _leading_elsewhere(state)
    extras = cad_extras.extra(state)
    for n in range(len(state.elements)):
        if n not in state.found:
            state.found[n] = state.finding(n, 0.0, None)
    looks, notes = line_styles.looks(state)
    return CadOutcome(tuple(state.found[n] for n in range(len(state.elements))), extras, looks, notes)


def _not_compared(state: Comparison) -> None:
    """In a view of another scale symbols keep their size: they are not compared."""
    for n, e in enumerate(state.elements):
        if n not in state.found and e.view in state.moved and state.moved[e.view].scaled and symbol(e):
            state.found[n] = CadFinding(e, None, 0.0, codes.OTHER_SCALE(), e.middle, 5.0)
            if e.role != "dimension":
                state.zones.append(Box.around(e.points, BESIDE).corners)


def _leading_elsewhere(state: Comparison) -> None:
    """Lines from one view to another that are missing where a view is elsewhere are no errors."""
    leading = links(state.elements)
    for n, e in enumerate(state.elements):
        if e.number in leading and e.view in state.moved and state.found[n].missing:
            state.found[n] = CadFinding(e, None, 0.0, codes.LEADS_ELSEWHERE(), e.middle, 5.0)


LETTER = 4
"""A stroke that is more than so many times as long as a letter is high is none of a letter."""


def _find_in_place(state: Comparison) -> None:
    """Find the elements with ink everywhere along them, and where the others have some."""
    numbers = [n for n in range(len(state.elements)) if state.paths[n]]
    ours, of, base = state.ours(numbers)
    every = overlaps(ours, state.theirs, state.tolerance)
    # A long line that runs through a letter is no part of it.
    most = np.array([LETTER * e.height if e.kind == "text" else np.inf for e in state.elements])
    size = np.bincount(state.theirs.owner, state.theirs.length)[state.theirs.owner]
    every = every.only(size[every.theirs] < most[of[every.ours]])
    state.in_place, state.in_place_of = every, of[every.ours]
    state.along = base[every.ours] + every.s0, base[every.ours] + every.s1
    order = np.argsort(state.in_place_of, kind="stable")
    run = every.s1 - every.s0
    rows = np.split(order, np.searchsorted(state.in_place_of[order], np.arange(1, len(state.elements))))
    for n in numbers:
        if n in state.found:
            continue
        e, whole = state.elements[n], state.whole(n)
        lettered = [(a * whole, b * whole) for a, b in interruptions(e)]
        parts = union([*zip(*(x[rows[n]].tolist() for x in state.along), strict=True), *lettered], state.gap(e))
        if len(rows[n]) and all(b - a <= state.tolerance + 1e-9 for a, b in gaps(parts, whole)):
            long = rows[n][run[rows[n]] >= run[rows[n]].max() / 2]  # shorter ones may be of lines that cross it
            state.found[n] = state.finding(n, float(np.abs(every.off0[long] + every.off1[long]).min()) / 2, None)
            state.claim(every.only(rows[n]).inked)
        else:
            state.inked[n] = parts


WORD = re.compile(r"[^\W\d_]{4,}")
"""A label says the same in every language, a word does not."""
READ, MORE, FEWEST = 0.5, 0.2, 3
"""Share of the drawing's words on a sheet in its language; how much more are in another one; fewer texts of words tell nothing."""


def lettered(project: Project, known: Sequence[KnownSheet], ink: CadInk) -> tuple[str, Sequence[KnownSheet]]:
    """The language a drawing is lettered in, and the sheets in it: those given unless another has clearly more of its words."""
    texts = [w.text for space in ink.spaces for w in space.writings if WORD.search(w.text)]
    theirs, here = _words(texts), words.paper()
    if len(texts) < FEWEST or _share(theirs, known) >= READ:
        return here, known
    others = {}
    for language in words.LANGUAGES:
        if language != here:
            with words.on_paper(language):
                others[language] = [known_sheet(type(project)(project.variant), sheet.n) for sheet in known]
    best = max(others, key=lambda language: _share(theirs, others[language]))
    return (best, others[best]) if _share(theirs, others[best]) > _share(theirs, known) + MORE else (here, known)


def _share(theirs: set[str], known: Iterable[KnownSheet]) -> float:
    """Share of the drawing's words that are on the sheets."""
    return len(theirs & _words(e.text for sheet in known for e in sheet.elements if e.kind == "text")) / len(theirs)


def _words(texts: Iterable[str]) -> set[str]:
    return {normal(word.casefold()) for text in texts for word in WORD.findall(text)}


LOST = 0.2
"""Share of a sheet's lines that must be found; a drawing with fewer is not of this sheet."""
MANY_STROKES = 250
"""A drawing with more straight strokes may be a sheet of ours: the plans of a layout of its own have dozens."""
MOSTLY_PLANS = 0.4
"""Share of a drawing's straight ink from which on plans of its own layout are what it shows."""


@dataclass(frozen=True)
class ComparedDrawing:
    """A drawing with its report: its sheet, what it shows, the exact lines there, mm, on paper as large as ``blank``."""

    report: Report
    sheet: int
    blank: Drawing
    space: DrawingSpace
    exact: tuple[Points, ...]


def compare(project: Project, sheet: int | None, path: Path, views: Path | None, pencil: float,
            say: Callable[[str], None]) -> Report:
    """Compare a DXF drawing with a project; the report has two overlays besides text and JSON. Arguments as in :func:`compared`."""
    return compared(project, sheet, path, views, pencil, say).report


def compared(project: Project, sheet: int | None, path: Path, views: Path | None, pencil: float,
             say: Callable[[str], None] = lambda _: None) -> ComparedDrawing:
    """Compare a drawing: plans in a layout of its own title first, else element by element with the sheet of ours that it shows.

    Parameters
    ----------
    project : the project the drawing is of
    sheet : number of the sheet from 1, None for the one it fits best
    path : the drawing
    views : file of the views that are not in their places (:mod:`~tmm_sheets.compare.placing`), None without one
    pencil : how far a point may be off, mm
    say : told what is being done

    Raises
    ------
    BadInput
        If the file cannot be read as DXF, or there is no such sheet.
    CannotBuild
        If the drawing shows none of the sheets and no plan of the project.
    """
    numbers = sheet_numbers(project, sheet)
    if views is not None and len(numbers) > 1:
        raise BadInput(tell("--views needs --sheet N: its views are those of one sheet"))
    say(tell("reading {file}").format(file=path.name))
    ink = apart.carried_out(cad_file.read, path, tell(cad_file.SMALLER))
    space = max(ink.spaces, key=lambda s: len(s.strokes))
    plans = PlanInk(space, ink.unit)
    may_be_ours = views is not None or "positions" not in project.parts or len(plans.a) > MANY_STROKES or plans.has_sheet_frame
    found = examine(project, numbers, ink, views, pencil, say) if may_be_ours else None
    other = _other_sheet(project, ink, sheet) if found is None and may_be_ours else None
    if found is None and other is None and "positions" in project.parts:
        say(tell("judging plans by their titles"))
        judged = judge_plans(PlanRecord(project), plans)
        mostly = bool(judged.fitting) and (judged.explained > MOSTLY_PLANS or may_be_ours)
        if not mostly and not may_be_ours:
            found = examine(project, numbers, ink, views, pencil, say)
        if mostly or (found is None and (judged.fitting or any(v.kind == "unlike" and v.title for v in judged.views))):
            found = plan_report.examined(sheet or _sheet_of(project, judged), path.stem, judged, ink.notes)
    if found is None:
        raise _refusal(project, numbers, ink, sheet, other if may_be_ours else _other_sheet(project, ink, sheet), path)
    return _told(project, found, path, say)


def _sheet_of(project: Project, judged: JudgedPlans) -> int:
    """The first sheet that shows plans of the kinds drawn, by the arrangements alone."""
    names = {v.name for v in judged.fitting} or {"positions"}
    forces = any(name.startswith("force") for name in names)

    def shown(n: int) -> int:
        some = arrangement(project.sheets[n - 1]).views
        return sum(v.kind.plan in names for v in some) + forces * any(v.kind.picture == "force plans" for v in some)

    return max(range(1, len(project.sheets) + 1), key=lambda n: (shown(n), -n))


def _told(project: Project, found: cad_report.ExaminedDrawing, path: Path, say: Callable[[str], None]) -> ComparedDrawing:
    """The report on a drawing, with its overlays."""
    say(tell("overlay"))
    outcome, on_paper = found.outcome, found.paper
    places = [(complex(on_paper(f.at)), f.reach, str(f.element.number), str(f.verdict))
              for f in worst(outcome.findings) if f.element.view not in found.lost]
    places += [(complex(on_paper(x.at)), x.reach, f"+{k}", str(x.verdict)) for k, x in enumerate(outcome.extras, 1)]
    looks = [(look.places, f"~{k}") for k, look in enumerate(outcome.looks, 1)]
    exact, space = tuple(on_paper(p) for e in found.exact for p in drawn(e)), found.space.placed(on_paper)
    files = overlays.files(found.sheet, found.blank, exact, space, places, looks)
    report = replace(cad_report.report(project.variant.project.name, path, found), files=files)
    return ComparedDrawing(report, found.sheet, replace(found.blank, marks=(), views=(), dimensions=(), forms=()), space, exact)


def examine(project: Project, numbers: range, ink: CadInk, views: Path | None = None, pencil: float = 0.25,
            say: Callable[[str], None] = lambda _: None) -> cad_report.ExaminedDrawing | None:
    """A drawing compared with the sheet of ours that it shows, in the language it is lettered in; None if it shows none."""
    known = []
    for n in numbers:
        say(tell("sheet {n}").format(n=n))
        known.append(known_sheet(project, n))
    language, said = lettered(project, known, ink)
    if language == paper():
        return _examined(project, views, pencil, say, ink, known)
    with on_paper(language):
        found = _examined(type(project)(project.variant), views, pencil, say, ink, said)
    note = tell("the drawing is lettered in {language}; it was compared with the sheet in that language")
    return None if found is None else replace(found, notes=(*found.notes, note.format(language=tell(name_of(language)))))


def _examined(project: Project, views: Path | None, pencil: float, say: Callable[[str], None], ink: CadInk,
              known: Sequence[KnownSheet]) -> cad_report.ExaminedDrawing | None:
    """The contents of a drawing compared with the sheets known, in its language."""
    say(tell("laying it over the sheet"))
    laid = register(known, ink)
    given = read_places(views, views_of(laid.known.sheet)) if views is not None else ()
    if laid.share < LOST / 2 and not given:
        return None
    space = laid.space.placed(laid.placing)
    space = replace(space, writings=tuple(w for w in space.writings if not laid.known.tells_who([w.at])),
                    strokes=tuple(s for s in space.strokes if not laid.known.tells_who(s.points)))
    say(tell("placing the views"))
    places = registration.find(laid.known.elements, space, [(p, laid.placing) for p in given])
    absent: set[ElementView] = set()

    def matched(elements: Sequence[Element]) -> CadOutcome:
        return _matched(laid.known.elements, elements, absent, space, places.moves, pencil)

    outcome = matched(laid.known.elements)
    say(tell("looking for what was done wrong"))
    built = built_otherwise(project, laid.known, outcome.findings, places.moves, _figure_of(space, outcome))
    now = [rebuilt(e, built[e.view][1]) if e.view in built else e for e in laid.known.elements]
    kept = {v for v in places.share if not v.n}  # a frame alone is one
    again, gone = bool(built), cad_report.gone(outcome) - kept - built.keys()
    while again or gone:  # ink of a view that is not there after all is that of nothing
        absent |= gone
        outcome, again = matched(now), False
        gone = cad_report.gone(outcome) - absent - kept
    if not _of_this_sheet(outcome):  # one mistake may lead everything elsewhere
        return None
    notes = (*ink.notes, *registration.laying_told(laid, ink.unit), *places.notes, *outcome.notes)
    p, moves = laid.placing, places.moves
    exact = tuple(moved(e, moves[e.view]) if e.view in moves else e for e in laid.known.elements)
    beside = {
        "placing": {"scale": p.scale, "degrees": round(p.degrees, 4), "shift": point(p.shift), "mirrored": p.mirrored,
                    "share": round(laid.share, 4)},
        "views": [{"view": v.name, "share": round(s, 4), **(
            {"shift": point(complex(moves[v](v.box.centre)) - v.box.centre), "size": round(moves[v].scale, 6)}
            if v in moves else {})} for v, s in places.share.items()]}
    whole = [cad_report.mirror_told(round(p.degrees / 90) % 4 == 2)] if p.mirrored else []
    return cad_report.ExaminedDrawing(laid.known.n, space, laid.known.sheet.drawing, exact, pencil, outcome, notes, whole,
                                      of_built(built), beside, Placing())


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
        return judged if was is e and judged is not None else as_built(judged, was, e, move, pencil)

    return replace(outcome, findings=tuple(map(finding, known, now)))


def _green(found: Sequence[CadFinding]) -> float:
    """Share of the findings that are green, or off as follows from a mistake."""
    return sum(f.verdict == "green" or f.follows for f in found) / max(len(found), 1)


def _of_this_sheet(outcome: CadOutcome) -> bool:
    """Whether enough lines are right on the whole sheet, or in one view."""
    by_view = [[f for f in found if f.element.kind != "text" and f.verdict is not None]
               for view, found in outcome.by_view.items() if view.n]
    every = [f for found in by_view for f in found]
    return _green(every) >= LOST or any(len(found) > 10 and _green(found) > 0.7 for found in by_view)


def _other_sheet(project: Project, ink: CadInk, asked: int | None) -> int | None:
    """The sheet that a drawing shows instead of the one asked for; None where it shows none."""
    others = [n for n in range(1, len(project.variant.sheets) + 1) if n != asked] if asked is not None else []
    if not others:
        return None
    other, fit = fitting([known_sheet(project, n) for n in others], ink)
    return other if fit > 0.4 else None


def _refusal(project: Project, numbers: range, ink: CadInk, asked: int | None, other: int | None, path: Path) -> CannotBuild:
    """That the drawing is of none of the sheets; ``other`` is the one that it may be of."""
    hint = tell("is it the right project and variant? in a layout of its own write over each plan what it is and at which position")
    count = len(project.variant.sheets)
    laid = register([known_sheet(project, n) for n in numbers], ink)
    if other is not None:
        hint = tell("it looks like sheet {n}: use --sheet {n}, or leave --sheet out").format(n=other)
    said = tell("only {share} % of the lines of sheet {n} are in this drawing") if asked is not None or count == 1 else tell(
        "only {share} % of the lines of any of the {count} sheets are in this drawing")
    share = laid.space.placed(laid.placing).lines.share(registration.line_points(laid.known.elements), ONE_PLACE)
    said = said.format(share=round(100 * share), n=laid.known.n, count=count)
    return CannotBuild(f"{path}: {said}", "; ".join((*ink.notes, hint)))
