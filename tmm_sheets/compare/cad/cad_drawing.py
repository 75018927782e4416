"""A student's CAD drawing against a sheet: found, laid over it, matched element by element."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.compare import view_places
from tmm_sheets.compare.cad import cad_file, cad_overlay, cad_report, layout
from tmm_sheets.compare.cad.cad_examined import Examined, Laid
from tmm_sheets.compare.cad.cad_findings import Finding, Outcome
from tmm_sheets.compare.cad.cad_ink import CadInk
from tmm_sheets.compare.cad.cad_text import meant
from tmm_sheets.compare.cad.matching import match, placed
from tmm_sheets.compare.cad.placing import HIT, RATIOS, Lines, Placing, candidates, lines, refine, search, snapped
from tmm_sheets.compare.elements import Element, View, elements
from tmm_sheets.compare.elements import views as views_of
from tmm_sheets.compare.report import Report
from tmm_sheets.drawing.marks import Points
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.numbers import decimal
from tmm_sheets.sheets.sheet import Composed, composed

if TYPE_CHECKING:
    from tmm_sheets.project import Project

SIDES = (816.0, 841.0, 584.0, 594.0)
"""Lengths of the frame's and the paper's sides, mm."""
SURE = 0.5
"""Share of our lines found at which a placing is beyond doubt."""
POOR = 0.25
"""Share of chance: lines of any sheet cross so many places of another."""
LOST = 0.2
"""Share of the elements found below which the drawing is not of this sheet."""
PART = 100.0
"""Width and height together of the least part of a sheet that is looked for, mm."""


def compare(project: Project, sheet: int | None, path: Path, views: Path | None, pencil: float,
            say: Callable[[str], None]) -> Report:
    """Compare a DXF drawing with a sheet of a project; the report has the table, the tree for JSON and two overlays."""
    found = examine(project, sheet, path, views, pencil, say)
    say("overlay")
    outcome, laid = found.outcome, found.laid
    gone = cad_report.gone(outcome)
    shown = [f for f in cad_report.worst(outcome.findings) if f.element.view not in gone]
    marked = [(f.at, f.reach, str(f.element.number)) for f in shown] + \
        [(x.at, x.reach, f"+{k}") for k, x in enumerate(outcome.extras, 1)]
    looks = [(look.places, f"~{k}") for k, look in enumerate(outcome.looks, 1)]
    exact = _exact(laid.elements, found.places.moves)
    files = cad_overlay.files(laid.n, laid.sheet.drawing, exact, placed(laid.space, laid.placing), marked, looks)
    name = project.variant.project.name
    return Report(cad_report.text(name, path, found, pencil), cad_report.tree(name, path, found, pencil), files, found.notes)


def examine(project: Project, sheet: int | None, path: Path, views: Path | None, pencil: float,
            say: Callable[[str], None] = lambda _: None) -> Examined:
    """Compare a DXF drawing with a sheet of a project; with the sheet it fits best when none is named.

    Raises
    ------
    BadInput
        When the file cannot be read as DXF, there is no such sheet, or the drawing is of none of them.
    """
    count = len(project.variant.sheets)
    if sheet is not None and not 1 <= sheet <= count:
        raise BadInput(f"--sheet {sheet}: {project.variant.project.name} has {count} sheet{'s' * (count > 1)}",
                       f"--sheet 1 to --sheet {count}" if count > 1 else "give --sheet 1, or leave it out")
    say(f"reading {path.name}")
    ink = cad_file.read(path)
    numbers = [sheet] if sheet is not None else list(range(1, count + 1))
    sheets = {}
    for n in numbers:
        say(f"sheet {n}")
        sheets[n] = composed(project, n)
    if views is not None and sheet is None and count > 1:
        raise BadInput("--views needs --sheet N: its views are those of one sheet")
    say("laying it over the sheet")
    laid = _lay(sheets, ink)
    given = view_places.read(views, views_of(laid.sheet)) if views is not None else ()
    space = placed(laid.space, laid.placing)
    say("placing the views")
    theirs = lines(s.points for s in space.strokes)
    places = layout.find(laid.elements, theirs, space.writings, [(p, laid.placing) for p in given], say)
    outcome = match(laid.elements, space, places.moves, pencil, say)
    _refuse(project, laid, outcome, ink, sheet, path)
    return Examined(laid, places, outcome, (*ink.notes, *_how(laid, ink), *places.notes, *outcome.notes))


# --- placing ----------------------------------------------------------------------------------------------------------


def _lay(sheets: Mapping[int, Composed], ink: CadInk, thorough: bool = True) -> Laid:
    """The sheet and the space that fit best, with the placing of the drawing as a whole."""
    known = {n: elements(sheet) for n, sheet in sheets.items()}
    ours = {n: layout.ink(found) for n, found in known.items()}
    frame = _frame(next(iter(known.values())))
    tried: list[Laid] = []
    for space in ink.spaces:
        theirs = lines(s.points for s in space.strokes)
        for placing in _by_frame(frame, theirs, ink.unit):
            for n, sheet in sheets.items():
                picked = ours[n][:: max(len(ours[n]) // 3000, 1)]
                share = theirs.share(placing.back(picked), HIT / placing.scale)
                tried.append(Laid(n, sheet, known[n], space, placing, share))
        if tried and _best(tried).share >= SURE:
            return _settled(_best(tried), ours, theirs, ink.unit)
    framed = _best(tried) if tried else None
    if framed is None:
        for mirrored in (False, True) if thorough else (False,):
            for space in ink.spaces:
                theirs = lines(s.points for s in space.strokes)
                for n, sheet in sheets.items():
                    scales = candidates(theirs, ink.unit, float(np.ptp(ours[n].real)), SIDES)
                    found = search(ours[n], theirs, scales, mirrored=mirrored)
                    tried.append(Laid(n, sheet, known[n], space, found.placing, found.share))
                    if found.share > 0.8:
                        break
            if _best(tried).share >= SURE:
                break
        if _best(tried).share < SURE and thorough:
            tried += [part for n, sheet in sheets.items() for part in _parts(n, sheet, known[n], ink)]
    # With a frame the rest may have a layout of its own: then what is written tells the sheet.
    best = framed or _best(tried)
    return _settled(best, ours, lines(s.points for s in best.space.strokes), ink.unit)


def _parts(n: int, sheet: Composed, found: tuple[Element, ...], ink: CadInk) -> Iterator[Laid]:
    """Placings of a drawing of some views only: with most of its own lines on ours."""
    ours = lines([e.points for e in found if e.view.n and e.kind not in ("text", "hatch", "fill")])
    for space in ink.spaces:
        theirs = lines(s.points for s in space.strokes)
        for ratio in RATIOS:
            scale = Placing(complex((ink.unit or 1.0) * ratio))
            z = theirs.moved(scale).points(1.0)
            if not 30 < len(z) < 60_000 or np.ptp(z.real) + np.ptp(z.imag) < PART:
                continue
            trial = search(z, ours, [1.0], tries=4)
            if trial.share >= SURE:
                yield Laid(n, sheet, found, space, trial.placing.inverse().after(scale), trial.share)


def _best(tried: Sequence[Laid]) -> Laid:
    """The first of those that are equal: model space, not mirrored; where little fits, of the sheet with more of the words."""
    if max(laid.share for laid in tried) >= SURE:
        return max(tried, key=lambda laid: round(laid.share, 2))
    return max(tried, key=lambda laid: round(laid.share + _said(laid), 2))


def _said(laid: Laid) -> float:
    """Share of the words of a sheet that are somewhere in the drawing."""
    there = {meant(w.text) for w in laid.space.writings}
    ours = {meant(e.text) for e in laid.elements if e.kind == "text" and len(e.text) > 3}
    return len(ours & there) / max(len(ours), 1)


def _settled(laid: Laid, ours: Mapping[int, Points], theirs: Lines, unit: float | None) -> Laid:
    """The placing refined: on everything where most is in its place, else on the frame if there is one."""
    z = ours[laid.n]
    free = True
    if laid.share < SURE:
        frame = _frame(laid.elements)
        if theirs.share(laid.placing.back(frame), HIT / laid.placing.scale) > 0.9:
            z = frame
        else:
            free = False  # too little to go by: scale and angle stay as they were found
    z = z[:: max(len(z) // 1500, 1)]
    placing = snapped(z, theirs, refine(z, theirs, laid.placing, free=free).placing, unit)
    return replace(laid, placing=placing)


def _frame(found: Sequence[Element]) -> Points:
    """Places along the frame: the largest rectangle of main lines."""
    rectangles = [e for e in found if e.view.n == 0 and e.kind == "curve" and e.style == "main"]
    return lines([max(rectangles, key=lambda e: e.length).points]).points(2.0)


def _by_frame(frame: Points, theirs: Lines, unit: float | None) -> list[Placing]:
    """Placings by the frame alone, all ways round; nothing when there is none."""
    scales = candidates(theirs, unit, float(np.ptp(frame.real)), SIDES)[:8]
    long = theirs.only(theirs.length > 0.02 * theirs.length.max())
    trial = search(frame, long, scales, (0, 1), enough=0.97)
    if trial.share < 0.95:
        return []
    x, y = frame.real.min() + frame.real.max(), frame.imag.min() + frame.imag.max()
    ways = (Placing(), Placing(-1 + 0j, complex(x, y)), Placing(-1 + 0j, complex(x, 0), True), Placing(1 + 0j, complex(0, y), True))
    return [way.after(trial.placing) for way in ways]


def _how(laid: Laid, ink: CadInk) -> list[str]:
    """What was done to the drawing to lay it over the sheet, where it is not as it should be."""
    found = []
    p = laid.placing
    if p.mirrored:
        found.append("the drawing is mirrored; it was turned over for the comparison")
    quarter = round(p.degrees / 90) % 4
    if quarter:
        found.append(f"the drawing lies turned by {(-90 * quarter) % 360} degrees; it was turned back")
    rest = (p.degrees + 45) % 90 - 45
    if abs(rest) > 0.02:
        found.append(f"the drawing is askew by {decimal(-rest)} degrees; it was straightened")
    declared_unit = ink.unit if laid.space.name == "model space" else 1.0  # paper space is in millimetres
    unit = declared_unit or 1.0
    ratio = p.scale / unit
    if abs(ratio - 1) > 1e-3:
        usual = {2.0: "1:2", 2.5: "1:2.5", 4.0: "1:4", 5.0: "1:5", 10.0: "1:10", 0.5: "2:1", 0.4: "2.5:1", 0.25: "4:1", 0.2: "5:1"}
        size = next((s for r, s in usual.items() if abs(ratio / r - 1) < 1e-3), None)
        words = {1000.0: "metres", 25.4: "inches", 10.0: "centimetres", 1.0: "millimetres"}
        word = next((w for s, w in words.items() if abs(p.scale / s - 1) < 1e-3), None)
        declared = next((w for s, w in words.items() if s == unit), f"units of {unit:g} mm")
        if word is not None and (size is None or declared_unit != 1.0):
            declares = f"the file declares {declared}" if declared_unit else "the file declares no units"
            found.append(f"the drawing is in {word} though {declares}; it was scaled accordingly")
        elif size is not None:
            found.append(f"the drawing is at scale {size}; it was scaled to 1:1")
        else:
            found.append(f"one unit of the drawing is {p.scale:.6g} mm of the sheet; it was scaled accordingly")
    if laid.space.name != "model space":
        found.append(f"compared is {laid.space.name}, with what its viewports show")
    return found


def _refuse(project: Project, laid: Laid, outcome: Outcome, ink: CadInk, asked: int | None, path: Path) -> None:
    """Stop where the drawing is of another sheet."""
    lines_only = [f for f in outcome.findings if f.element.kind != "text" and f.element.view.n and f.verdict is not None]
    right = sum(f.verdict == "green" for f in lines_only) / max(len(lines_only), 1)
    by_view: dict[View, list[Finding]] = {}
    for f in lines_only:
        by_view.setdefault(f.element.view, []).append(f)
    one = any(len(found) > 10 and sum(f.verdict == "green" for f in found) > 0.7 * len(found) for found in by_view.values())
    if right >= LOST or one:  # a drawing may be of a single view
        return
    hint = "is it the right project and variant? a drawing with a layout of its own can be told with --views where its views are"
    count = len(project.variant.sheets)
    if asked is not None and count > 1:
        others = _lay({n: composed(project, n) for n in range(1, count + 1) if n != asked}, ink, False)
        if others.share > max(laid.share + 0.15, 0.4):
            hint = f"it looks like sheet {others.n}: use --sheet {others.n}, or leave --sheet out"
    what = f"sheet {laid.n}" if asked is not None or count == 1 else f"any of the {count} sheets"
    hint = "; ".join((*ink.notes, hint))
    raise BadInput(Problem(f"only {right:.0%} of the lines of {what} are in this drawing", str(path), hint=hint))


def _exact(found: Sequence[Element], moves: Any) -> list[Points]:
    """Lines of the exact sheet where the drawing has its views."""
    out: list[Points] = []
    for e in found:
        move = moves.get(e.view, Placing())
        if e.kind == "hatch":
            out += [move(p) for p in e.pieces]
        elif e.kind != "text":
            out.append(move(e.points))
    return out
