"""Comparing a photographed or scanned hand drawing with the exact sheet, and why one cannot be judged."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextvars import copy_context
from dataclasses import dataclass, replace
from functools import cache
from math import hypot
from pathlib import Path
from typing import TYPE_CHECKING, Any

import cv2
import numpy as np

from tmm_sheets import apart
from tmm_sheets.compare import codes
from tmm_sheets.compare.cad.plan_ink import COUNTED_MM, Figure, Fit, Floats
from tmm_sheets.compare.diagnosis import built_plan
from tmm_sheets.compare.diagnosis.built_plan import (
    Built,
    DrawnPlan,
    PlanPoint,
    between,
    led_elsewhere,
    of_built,
    rebuilt,
    vanished,
)
from tmm_sheets.compare.elements import (
    SAMPLED,
    Element,
    ElementView,
    KnownSheet,
    dashed,
    known_sheet,
    sampled,
    sheet_numbers,
    views as views_of,
)
from tmm_sheets.compare.findings import FindingRecord, Report, millimetres, verdict
from tmm_sheets.compare.photo import lost_ink, need_opencv, overlay, photograph, placed_views, rectification, small_marks, tracing
from tmm_sheets.compare.photo.fit_check import MATCH, SIDE, SIDES
from tmm_sheets.compare.photo.judging import PhotoFinding, judge, tolerance_of
from tmm_sheets.compare.photo.lost_ink import Mask, at as hidden_at, lost_to_threshold, mask_washed_out
from tmm_sheets.compare.photo.photo_report import image_report
from tmm_sheets.compare.photo.photograph import SMALLER, Photograph
from tmm_sheets.compare.photo.profiles import HALF, line_level, noise_level, pixels, sample
from tmm_sheets.compare.photo.rectification import LONGEST, Rectified, rectify
from tmm_sheets.compare.photo.sheet_map import FRAME, PAPER, Map
from tmm_sheets.compare.photo.traces import ELSEWHERE, ONE_POINT, ExtraInk, InkTrace, as_lines
from tmm_sheets.compare.placing import Placing, read_places
from tmm_sheets.drawing.marks import Points
from tmm_sheets.errors import CannotBuild
from tmm_sheets.numbers import told
from tmm_sheets.words import marked, tell

if TYPE_CHECKING:
    from tmm_sheets.project import Project

REACH = 0.6
"""How far beside its place a pencil's line may run in a straightened picture, mm."""
OFFSETS = np.arange(-REACH, REACH + 0.05, 0.1)
ALONG = 7
"""So many neighbouring places are averaged: a line that only crosses is no ink along this one."""
ENDS = 1.5
"""Beside the ends of a line others begin, mm."""
STAYS, ENDS_STAY = 2.0, 1.0
"""How many tolerances aside a line must be led for it to be seen that it is not there, how many mm along itself by its head; and by
an end that shows, which is told more exactly."""
CONTRADICTED = 3
"""Where every so many wrong lines of a plan have one that stays in its place though it would be led elsewhere, another mistake was
made."""


def built_otherwise(project: Project, known: KnownSheet, findings: Sequence[PhotoFinding], ink: Any,
                    hidden: Mask | None = None) -> Built:
    """Views whose plans were built on a mistake, with the mistake and where it takes the points of the plan, mm of the sheet.

    Parameters
    ----------
    project, known, findings
        The sheet, and what was found of its elements.
    ink, hidden
        The rectified sheet, and where it is hidden.
    """
    level = line_level(ink)

    def figure(drawn: DrawnPlan, _: Placing) -> Figure | None:
        of = [f for f in findings if f.element.view == drawn.view and f.element.role == "vector"]
        return _PicturedPlan(of, lambda line: inked(ink, line, level, hidden)) if of else None

    built = built_plan.built_otherwise(project, known, findings, {}, figure)
    of = {view: [f for f in findings if f.element.view == view] for view in built}
    return {view: b for view, b in built.items() if not contradicted(b, of[view]) and borne_out(b, of[view])}


class _PicturedPlan(Figure):
    """A plan in a photograph: the picture tells what has ink, no strokes do; points may be where the ends of lines were traced.

    What lies in its place may be the helper line under a vector: that speaks against nothing here.
    """

    def __init__(self, findings: Sequence[PhotoFinding], inked: Callable[[Points], float]) -> None:
        none = np.zeros(0, complex)
        super().__init__(np.zeros(0, np.intp), none, none)
        lines = [f for f in findings if f.element.kind == "line"]
        off = [f.trace.at[[0, -1]] for f in lines if f.verdict == "red" and f.trace.at is not None]
        self.ends = np.array(off, dtype=complex).ravel()
        self.ink = float(sum(min(f.element.length, COUNTED_MM) for f in lines))
        self._inked = cache(lambda a, b: inked(np.array([a, b])))

    def against(self, fit: Fit) -> float:
        """Lines on bare paper: what is not drawn is missing."""
        return fit.bare

    def drawn(self, a: Points, b: Points) -> Floats:
        """Share of each line from a to b that has ink."""
        ends = zip(np.round(a, 2).tolist(), np.round(b, 2).tolist(), strict=True)
        return np.array([self._inked(*line) for line in ends], dtype=np.float64)


def borne_out(built: tuple[FindingRecord, Sequence[PlanPoint]], findings: Sequence[PhotoFinding]) -> bool:
    """Whether a point that is off is what was measured: all lines agree with it, at two points that it moves.

    What nothing follows from, and what the lines tell otherwise, they tell better themselves.
    """
    mistake, points = built
    if "kind" in mistake.beside:
        return True
    moved = {p.was for p in points if abs(p.now - p.was) > ELSEWHERE}
    led = set()
    for f in findings:
        if f.element.role == "vector" and f.element.kind == "line" and f.verdict == "red" and f.trace.at is not None:
            if np.abs(f.trace.at[[0, -1]] - between(f.element, points)).max() > ELSEWHERE:
                return False
            led |= {was for was in moved if np.abs(f.element.points[[0, -1]] - was).min() < ONE_POINT}
    return len(led) > 1


def contradicted(built: tuple[FindingRecord, Sequence[PlanPoint]], findings: Sequence[PhotoFinding]) -> bool:
    """Whether lines of a plan are seen where they should be that would not be there by the mistake."""
    vectors = [f for f in findings if f.element.role == "vector" and f.element.kind == "line"]
    stay = sum(stays(f, between(f.element, built[1])) for f in vectors)
    return stay > 0 and CONTRADICTED * stay >= sum(f.verdict == "red" for f in vectors)


def stays(f: PhotoFinding, now: Points) -> bool:
    """Whether an element that would lie elsewhere, ``now``, is in its place: it itself, an end that shows, or its head."""
    return f.verdict == "green" and f.trace.status == "measured" and _told(f, now)


def _told(f: PhotoFinding, now: Points) -> bool:
    """Whether what was measured of an element tells its place from where it would lie by a mistake, ``now``."""
    t, by = f.trace, now - f.element.points
    if f.element.kind != "line":
        return bool(np.abs(by).max() > STAYS * f.tolerance)
    along = f.element.points[-1] - f.element.points[0]
    by = by * np.conj(along) / abs(along)
    far = np.abs(by.real)
    return bool(np.abs(by.imag).max() > STAYS * f.tolerance or (far > ENDS_STAY)[np.isfinite(t.ends)].any()
                or (t.head == "there" and far[1] > STAYS))


def as_built(findings: Sequence[PhotoFinding], built: Built, found: Rectified, pencil: float) -> tuple[
        list[PhotoFinding], list[ExtraInk]]:
    """Findings on all elements, in order, those of plans compared as they were built; and ink that belongs to none.

    ``findings`` are those by the places where they ought to be.
    """
    elements = [f.element for f in findings]
    now = [rebuilt(e, built[e.view][1]) if e.view in built else e for e in elements]
    traces, extra = tracing.trace([e for e in now if not vanished(e)], found.ink, found.hidden)
    if found.uneven is not None:
        traces = mask_washed_out(traces, found.uneven)
    of = {t.element.number: judge(t, pencil, found.uncertainty, found.soft, found.eats) for t in traces}
    return [judged_where_built(of.get(f.element.number), f, found, pencil) for f in findings], extra


def judged_where_built(f: PhotoFinding | None, first: PhotoFinding, found: Rectified, pencil: float) -> PhotoFinding:
    """A finding on an element that may have been built elsewhere, judged by the place that it should have.

    ``first`` is what was found there: what was measured in its place is not elsewhere, and what was right by what could be seen of
    it may be wrong for sure only by what is measured where the mistake leads it.
    """
    was = first.element
    if f is None:
        tolerance = pencil + found.uncertainty
        return PhotoFinding(was, verdict(was.length, tolerance), was.length, codes.VANISHED(), was.middle,
                            InkTrace(was, "small"), tolerance, follows=True)
    now, f = f.element, replace(f, element=was)
    off = float(np.abs(now.points - was.points).max()) if len(now.points) == len(was.points) else 0.0
    if off <= f.tolerance or was.kind == "text" or f.trace.status not in ("measured", "shared", "missing", "beside") or f.unknown:
        return f
    if stays(first, now.points):
        return first
    beyond = f.trace.status == "missing" and not all(map(PAPER.contains, now.points.tolist()))
    led = led_elsewhere(f, off, f.tolerance, codes.OFF_THE_PAPER() if beyond else f.remark)
    if first.verdict == "green" and first.trace.status == "measured" and not _told(f, now.points) and led.verdict == "red":
        led = replace(led, verdict="amber")
    return replace(led, at=was.middle) if beyond else led


def inked(ink: Any, line: Points, level: float, hidden: Mask | None = None) -> float:
    """Share of a line, by both its ends, mm, that ink in its direction covers; ``level`` is the darkness of ink.

    A line that is hidden in part is judged by the rest of it, if that is the greater part: what is not seen speaks for nothing.
    """
    size = float(abs(line[1] - line[0]))
    if size < 2 * ENDS + SAMPLED:
        return 1.0  # too short to be told
    along = (line[1] - line[0]) / size
    points, normals = sampled(np.array([line[0] + ENDS * along, line[1] - ENDS * along]))
    profile = sample(ink, pixels(points[:, None] + normals[:, None] * OFFSETS))
    there = cv2.blur(profile, (1, ALONG), borderType=cv2.BORDER_REPLICATE).max(1) > level
    shown = np.ones(len(points), bool) if hidden is None else ~hidden_at(points, hidden)
    return float(there[shown].mean() if shown.mean() > HALF else there.mean())


PLACED = 0.25
"""Error of a place after rectification by the lines of placed views, mm."""
HIGHEST = 4  # degree of the relief that views placed by hand can determine
UNLIKE = 0.35
"""Share of its lines in place below which a sheet is another drawing rather than badly fitted."""
CERTAIN = 0.12
"""By how much more of its lines another sheet must match for a picture to be called a picture of it."""
EATEN = marked(
    "{file} is black and white, without grey, which eats thin lines: what of thin lines and small lettering is short, broken or "
    "missing is not judged; photograph again without the filter (no document mode)"
)
UNEVEN = marked(
    "{file}: a flash or the edge of a shadow has taken lettering or thin lines away, about (x; y) = {places} mm: what is not seen "
    "of them is not judged; photograph again in even light"
)
ROUGH = 0.8
"""mm of tolerance from which on it is told at the top that little can be said."""
COARSELY = marked(
    "{file} can be measured to {tolerance} mm only: what is less off is not told; photograph again from straight above, sharp, the "
    "paper flat"
)


@dataclass(frozen=True)
class ExaminedPicture:
    """A picture that was measured.

    Attributes
    ----------
    found : the straightened sheet
    findings : on every element, in their order
    extra : ink that belongs to none
    built : plans that were built on a wrong step, with what that was
    readings : what was read of its numbers, None where nothing was
    notes : what was remarkable
    """

    found: Rectified
    findings: Sequence[PhotoFinding]
    extra: Sequence[ExtraInk]
    built: Mapping[ElementView, FindingRecord]
    readings: small_marks.Readings | None
    notes: tuple[str, ...]


def compare(
    project: Project, n: int | None, path: Path, views: Path | None = None, pencil: float = 0.25,
    say: Callable[[str], None] = lambda _: None, read_numbers: bool = False,
) -> Report:
    """Compare a photograph of sheet ``n``, or of the one that it shows, with the exact sheet; see :func:`examine`."""
    n = sheet_of(project, path, say) if n is None else n
    e = examine(project, n, path, views, pencil, say, read_numbers)
    name = project.variant.project.name
    return image_report(name, n, path, e.found, e.findings, e.extra, pencil, e.notes, e.readings, e.built)


MEMORY = 2_000_000_000
"""Bytes that reading a picture may take: an A1 sheet at 300 dpi and the libraries that decode it."""


def sheet_of(project: Project, path: Path, say: Callable[[str], None] = lambda _: None) -> int:
    """Number of the sheet that a photograph shows, from 1.

    Raises
    ------
    BadInput
        When the file is missing or useless.
    CannotBuild
        When the picture has no frame, or is not plainly one of the sheets.
    """
    if len(project.variant.sheets) == 1:
        return 1
    picture = _read(path)
    matches = _matches(project, 1, rectify(picture, known_sheet(project, 1).elements, path, say, True), say)
    second, best = sorted(matches, key=lambda k: matches[k])[-2:]
    if matches[best] <= max(MATCH, matches[second] + CERTAIN):
        said = tell("{file}: which sheet it shows cannot be seen: sheet {n} fits best, with {share} % of its lines")
        raise CannotBuild(said.format(file=path, n=best, share=round(100 * matches[best])),
                          tell("call it, for instance, sheet 2.jpg, or give --sheet N"))
    return best


def _read(path: Path) -> Photograph:
    need_opencv()
    return apart.carried_out(photograph.read, path, tell(SMALLER), memory=MEMORY)


def examine(
    project: Project, n: int, path: Path, views: Path | None = None, pencil: float = 0.25,
    say: Callable[[str], None] = lambda _: None, read_numbers: bool = False,
) -> ExaminedPicture:
    """Measure a photograph of sheet ``n``, and look for what was done wrong.

    Parameters
    ----------
    project, n
        The sheet, numbered from 1.
    path
        JPG, PNG or PDF.
    views
        File with the places of the views of a sheet with a layout of its own (see ``placing``).
    pencil
        Error of a point drawn by hand, mm.
    say
        Told what is being done.
    read_numbers
        Whether to read the numbers of the sheet too (see ``numbers_read``).

    Raises
    ------
    BadInput
        When a file is missing or useless, there is no such sheet, or numbers cannot be read here.
    CannotBuild
        When the picture has no frame, shows another sheet, or is too blurred or too small, or no view of ``views`` is in it.
    """
    sheet_numbers(project, n)
    reader = small_marks.number_reader() if read_numbers else None
    say(tell("reading the picture and composing the sheet"))
    with ThreadPoolExecutor(1) as aside:  # decoding runs beside Python
        reading = aside.submit(copy_context().run, _read, path)  # in the same language
        ours = known_sheet(project, n)
        picture = reading.result()
    known = ours.elements
    # Before the rectification, so that what is wrong with the file is told at once.
    places = read_places(views, views_of(ours.sheet)) if views is not None else ()
    found = rectify(picture, known, path, say, not places)
    notes = (*picture.notes, *found.notes)
    placed = None
    if places:
        say(tell("placing the views"))
        placed = placed_views.place(known, places, found.map, found.ink)
        if not placed.similarities:
            raise CannotBuild(tell("{file}: none of the views of sheet {n} was found").format(file=path, n=n),
                              hint="; ".join(placed.notes))
        say(tell("correcting by the lines of the views"))
        found = _corrected(picture, found, placed.elements)
        placed = placed_views.place(known, places, found.map, found.ink)
        known, notes = placed.elements, (*notes, *placed.notes)
    elif not found.check.acceptable:
        if found.match < MATCH:
            _other_sheet(project, n, found, path, say)
        raise refusal(picture.grey, found, known, path, n)
    say(tell("measuring the elements"))
    traces, extra = tracing.trace(known, found.ink, found.hidden)
    uneven = lost_ink.uneven_places(picture.grey, found.map)
    seen = lost_ink.mask_washed_out(traces, uneven)
    if dim := lost_ink.taken(traces, seen):
        found, traces = replace(found, uneven=uneven), seen
        where = ", ".join(f"({z.real:.0f}; {z.imag:.0f})" for z in dim)
        notes = (*notes, tell(UNEVEN).format(file=path.name, places=where))
    if (some := lost_to_threshold(picture.grey, traces, found.scale)) != "nothing":
        found = replace(found, eats=some)
        notes = (*notes, tell(EATEN).format(file=path.name))
    findings = [judge(t, pencil, found.uncertainty, found.soft, found.eats) for t in traces]
    if (tolerance := tolerance_of(pencil, found.uncertainty, found.soft)) > ROUGH:
        notes = (tell(COARSELY).format(file=path.name, tolerance=told(f"{tolerance:.1f}")), *notes)
    built: Built = {}
    if placed is None:
        say(tell("looking for what was done wrong"))
        built = built_otherwise(project, ours, findings, found.ink, found.hidden)
    if built:
        findings, extra = as_built(findings, built, found, pencil)
    extra = [x for x in extra if (placed is None or placed.strange(x)) and not ours.tells_who([x.middle])]
    readings = None
    if reader is not None:
        say(tell("reading the numbers"))
        readings = small_marks.readings(traces, found.ink, reader)
    return ExaminedPicture(found, findings, extra, of_built(built), readings, notes)


def _corrected(picture: Photograph, found: Rectified, known: Sequence[Element]) -> Rectified:
    """The map corrected once more, by the lines of views that were placed; as it was when too few of them match."""
    lines = as_lines([e for e in known if e.length < LONGEST])
    better, _, match = rectification.refine(found.map, found.sides, found.ink, lines, line_level(found.ink), highest=HIGHEST)
    if match < MATCH:
        return found
    ink = rectification.straighten(picture.grey, better)
    return replace(found, ink=ink, map=better, level=noise_level(ink), match=match, uncertainty=hypot(PLACED, found.scatter))


def _matches(project: Project, n: int, found: Rectified, say: Callable[[str], None]) -> dict[int, float]:
    """Share of the lines of each sheet that are where they belong in a picture that was laid over sheet ``n``."""
    matches = {n: found.match}
    for k in range(1, len(project.variant.sheets) + 1):
        if k != n:
            say(tell("trying sheet {n}").format(n=k))
            lines = as_lines([e for e in known_sheet(project, k).elements if e.length < LONGEST], most=2500)
            matches[k] = rectification.refine(found.map, found.sides, found.ink, lines, found.level)[2]
    return matches


def _other_sheet(project: Project, n: int, found: Rectified, path: Path, say: Callable[[str], None]) -> None:
    """Refuse a picture that does not match when it shows another sheet of the project, or when its frame fits and its lines do not.

    Raises
    ------
    CannotBuild
        When either is so.
    """
    matches = _matches(project, n, found, say)
    best = max(matches, key=lambda k: matches[k])
    share = matches[best]
    project_name, matched = project.variant.called, round(100 * found.match)
    if best != n and share > max(MATCH, found.match + CERTAIN):
        said = tell("{file} does not show sheet {n} but sheet {best} of {project}: only {matched} % of the lines of sheet {n} "
                    "are where "
                    "they belong, {share} % of sheet {best}'s are")
        raise CannotBuild(said.format(file=path, n=n, best=best, project=project_name, matched=matched, share=round(100 * share)),
                          hint=tell("try --sheet {n}").format(n=best))
    if not found.check.framed or found.match > UNLIKE:
        return
    said = tell("{file} does not show a sheet of {project} as it is drawn here: only {matched} % of the lines of sheet {n} are "
                "where "
                "they belong")
    raise CannotBuild(said.format(file=path, n=n, project=project_name, matched=matched),
                      hint=tell("is it another project or variant? A drawing with a layout of its own needs --views FILE, which "
                                "tells "
                                "where its views stand"))


DARK = 60.0
"""Grey level of the paper below which there was too little light."""
PATTERNED = 0.02
"""Share of the picture beside the sheet, dark as lines are, beyond which the ground is patterned."""
EDGE = 0.01
"""Share of the picture's longer side within which its edge is."""
OUT = 0.2
"""Share of a side outside the picture from which on that is what is wrong with it."""
BENT = 1.0
"""mm by which a part of the frame that is seen is off for its sides not to be hidden but out of reach of any map of paper."""
FLAT_OR_PLACED = marked(
    "lay the sheet flat, weights on its corners, and photograph from straight above; "
    "if a view was drawn in another place, give --views FILE"
)
PRESS = marked(
    "press the sheet flat, under glass or with weights along its edges, nothing beneath it, and photograph from straight above"
)
_HIDDEN = (
    marked("the lower side of the frame is hidden or was not drawn"),
    marked("the right side of the frame is hidden or was not drawn"),
    marked("the upper side of the frame is hidden or was not drawn"),
    marked("the left side of the frame is hidden or was not drawn"),
)
_OUTSIDE = (
    marked("the lower side of the frame is outside the picture"),
    marked("the right side of the frame is outside the picture"),
    marked("the upper side of the frame is outside the picture"),
    marked("the left side of the frame is outside the picture"),
)
"""What is wrong with a side, bottom first."""


def attempt(found: Rectified, known: Sequence[Element]) -> bytes:
    """The sheet laid over the picture as well as it could be, what does not fit circled, as PNG."""
    exact = [p for e in known if e.kind != "text" for p in dashed(e)]
    flags = [overlay.Flag(k, "red", complex(z))
             for k, z in enumerate(np.concatenate((found.check.astray, found.check.adrift, found.check.shifted)), 1)]
    return overlay.png(found.ink, found.level, overlay.strokes(exact, flags, fitted=False))


def refusal(grey: Any, found: Rectified, known: Sequence[Element], path: Path, n: int) -> CannotBuild:
    """What is to be said of a picture on which sheet ``n`` could not be laid so that its lines may be judged."""
    said = tell("{file}: sheet {n} could not be laid over the picture, so nothing was judged: {why}")
    reasons, hints = zip(*_doubts_about_picture(grey, found), strict=True)
    files = {f"compare_sheet_{n}_attempt.png": attempt(found, known)}
    return CannotBuild(said.format(file=path, n=n, why="; ".join(reasons)), "; ".join(dict.fromkeys(hints)), files=files)


def _doubts_about_picture(grey: Any, found: Rectified) -> Iterator[tuple[str, str]]:
    """What is wrong, and what to do about it."""
    check, bent = found.check, _bent(found)
    for k, share in enumerate(check.sides):
        if share < SIDE:
            if _outside(found.map, grey.shape, k) > OUT:
                yield tell(_OUTSIDE[k]), tell("photograph the whole frame, with some of the ground around the paper")
            elif not bent and (int((check.sides >= SIDE).sum()) < SIDES or len(check.lost) or len(check.adrift)):
                yield tell(_HIDDEN[k]), tell("take away what covers the frame, or fold it back, and photograph again")
    if bent:
        off = tell("most of the frame can be followed, but parts of it lie {by} mm off: the paper is not flat (waves, folds that "
                   "do not lie down), or something else was taken for the frame")
        yield off.format(by=told(millimetres(check.rim))), tell(PRESS)
    if float(np.median(grey)) < DARK:
        yield tell("there is too little light"), tell("more light, from a window or two lamps, without the flash")
    if _patterned(grey, found.map):
        yield (tell("the ground has lines that may be taken for the frame"),
               tell("put the sheet on a plain ground that is darker than the paper, nothing under it"))
    if len(check.shifted):
        parts = tell("parts of the sheet lie {by} mm elsewhere, neighbours alike: {n}, circled in the overlay of the attempt")
        yield parts.format(by=told(millimetres(check.shift)), n=len(check.shifted)), tell(FLAT_OR_PLACED)
    elif len(check.adrift) and not bent:
        loose = tell("nothing shows where the sheet ends there, and what is drawn nearby lies elsewhere, circled in the overlay "
                     "of the attempt")
        yield loose, tell("photograph the whole frame, with some of the ground around the paper")
    elif len(check.astray):
        places = tell("parts of the sheet whose lines are elsewhere: {n} of {all}, circled in the overlay of the attempt")
        flat = tell("lay the sheet flat, weights on its corners, and photograph from straight above")
        yield places.format(n=len(check.astray), all=check.judged), tell(FLAT_OR_PLACED) if check.framed else flat
    elif not bent:
        share = tell("only {share} % of its lines are where they belong")
        yield share.format(share=round(100 * check.match)), tell("photograph from straight above, sharp, in even light")


def _bent(found: Rectified) -> bool:
    """Whether the frame is seen, and no map of paper that lies down has it where it is."""
    return found.check.rim > BENT and float((found.sides.weight > 0).mean()) >= HALF


def _outside(m: Map, shape: tuple[int, ...], k: int) -> float:
    """Share of a side of the frame that lies outside the picture, or along its edge: there the rest of it was taken to be."""
    corners = FRAME.corners
    a, b = corners[k], corners[(k + 1) % 4]
    q = m.to_picture(a + np.linspace(0, 1, 50) * (b - a))
    edge = EDGE * max(shape)
    return float(((q.real < edge) | (q.imag < edge) | (q.real > shape[1] - edge) | (q.imag > shape[0] - edge)).mean())


def _patterned(grey: Any, m: Map) -> bool:
    """Whether the ground around the paper has edges like those of lines."""
    f = 1000 / max(grey.shape)
    small = cv2.GaussianBlur(cv2.resize(grey, None, fx=f, fy=f, interpolation=cv2.INTER_AREA), (0, 0), 1.0)
    edges = cv2.morphologyEx(small, cv2.MORPH_BLACKHAT, np.ones((9, 9), np.uint8)) > 0.25 * np.maximum(small, 20)
    q = m.to_picture(PAPER.corners) * f
    paper = np.zeros_like(small)
    cv2.fillPoly(paper, [np.column_stack((q.real, q.imag)).round().astype(np.int32)], 255)
    paper = cv2.dilate(paper, np.ones((9, 9), np.uint8))
    ground = paper == 0
    return bool(ground.mean() > 0.02 and edges[ground].mean() > PATTERNED)
