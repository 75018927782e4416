"""Measuring every element of a sheet in the rectified picture, along its normals.

Each element is first looked for in its own place, no farther than half way to the next line known to be there (``own_place``). What
is found is wiped out of the picture with a pencil's width to spare, and so are lettering and arrow heads. Elements not found are
sought in the ink that is left, some millimetres away, turned or of another size (``displacement``). Ink left after that belongs to
nothing (``extra_ink``). Lines that coincide in one stroke are measured together: what the eye cannot tell apart is not told apart.
One that leaves the stroke at a small angle is told by a second ridge beside it (``own_place.narrow_divergence``). The circles of
joints are told by outer edges (``line_ends.with_edges``), dots by spots of their size beside their places (``small_marks``).

The displacement of an element is a similarity, two shifts, a turn and a growth, of which only what shows along its normals is
determined: a straight line has no shift along itself and no growth; its length is measured at its ends (``line_ends``).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import cv2
import numpy as np

from tmm_sheets.compare.elements import Element, grown
from tmm_sheets.compare.photo import small_marks
from tmm_sheets.compare.photo.arrow_heads import with_heads
from tmm_sheets.compare.photo.displacement import beside, better_match, displaced, extra_ink, without_creases
from tmm_sheets.compare.photo.line_ends import ignore_junction_ends, resolve_overlaps, with_edges, with_ends
from tmm_sheets.compare.photo.lost_ink import Mask, at, in_pieces, share_hidden, torn_widths, widened
from tmm_sheets.compare.photo.own_place import in_place, narrow_divergence, strip_of, uncovered
from tmm_sheets.compare.photo.profiles import HALF, LITTLE, MOSTLY, NEARLY_ALL, NO_GREY, SCALE, WHOLE, pixels, sample
from tmm_sheets.compare.photo.sheet_map import FRAME, Floats
from tmm_sheets.compare.photo.small_marks import WRITTEN, displaced_dots
from tmm_sheets.compare.photo.traces import (
    ABOUT_INK,
    ELSEWHERE,
    LEAST,
    PALE,
    ROOM,
    ExtraInk,
    InkTrace,
    Owners,
    Paper,
    Status,
    Strip,
    expected_ink,
    fill,
    fixed,
    measurable,
    paint,
    painted,
    seen_at,
    wipe_found,
    wipe_small,
)
from tmm_sheets.drawing.marks import Points, Text
from tmm_sheets.drawing.styles import line_type
from tmm_sheets.drawing.text_layout import text_box

BAR = 1.5  # mm about lettering within which its bars are
OUT_OF_SIGHT = 0.15  # share of an element that is hidden from which on it is not judged
WASHED_OUT = 12  # mm about hidden places where letters are washed out with the lines
PARTLY = 0.45  # share of the columns of its place with ink below which part of lettering is missing
GAPPY = 0.65  # share of such columns below which it is looked whether lettering stands elsewhere
COVERED = 0.65
"""Share of a line that others cover or run along from which on what was taken for it may be theirs."""
TO_DOT, AT_DOT = 2.5, 0.8
"""Least mm of the half of a line next to a dot at which it ends where it is alone, and mm from its end to the middle of the dot:
other helper lines end anywhere, this one must be seen to its point, if lines are grey at all."""


def trace(elements: Sequence[Element], ink: Any, hidden: Mask | None = None) -> tuple[list[InkTrace], list[ExtraInk]]:
    """Measure elements in a rectified picture, and find the ink that belongs to none.

    Parameters
    ----------
    elements
        All that is on the sheet.
    ink
        Darkness, see :func:`~tmm_sheets.compare.photo.rectification.straighten`.
    hidden
        Where the sheet does not show, see :func:`~tmm_sheets.compare.photo.lost_ink.hidden_places`.

    Returns
    -------
    A trace of each element in their order, and extra ink, the longest first.
    """
    if hidden is None:
        hidden = np.zeros((1, 1), bool)
    paper = Paper.of(elements, ink, hidden)
    out_of_sight = {e.number: InkTrace(e, "hidden") for e in elements if share_hidden(e, hidden) > OUT_OF_SIGHT}
    shown = [e for e in elements if e.number not in out_of_sight]
    small = [e for e in shown if not measurable(e)]
    dots = np.array([e.centre for e in small if e.kind == "circle" and e.fills], complex)
    found, absent, alone = _in_their_places([e for e in shown if measurable(e)], dots, paper)
    wiped = np.zeros_like(ink)
    for e in small:
        wipe_small(wiped, e)
    for t in found:
        wipe_found(wiped, t)
    for t in out_of_sight.values():  # what shows of it belongs to it
        if measurable(t.element):
            paint(wiped, t.element, t.element.points, ROOM)
        else:
            wipe_small(wiped, t.element)
    left = ink.copy()
    covers = np.zeros_like(ink)
    if hidden.any():
        covers = cv2.resize(hidden.astype(np.uint8), ink.shape[::-1], interpolation=cv2.INTER_NEAREST) * np.uint8(255)
        left[covers > 0] = 0
    left[wiped > 0] = 0
    found += _displaced(absent, left, wiped, paper)
    found = doubted(found, alone, left, wiped, paper)
    found = with_edges(_beside_strokes(found, small, paper), paper)
    open_lines = [t for t in found if t.status == "measured" and t.element.kind != "circle"]
    ended = ignore_junction_ends(with_ends(open_lines, paper), elements)
    ended = [replace(t, ends=_shown_ends(t, hidden)) for t in ended]
    lines = {t.element.number: t for t in (*found, *ended)}
    headed = with_heads(list(lines.values()), paper)
    out = {t.element.number: t for t in headed} | _traces_of_small(small, found, paper) | out_of_sight
    unseen = [t for t in out.values() if t.status in ("absent lettering", "part of lettering")
              or (t.status == "lettering" and t.covered < GAPPY)]  # fmt: skip
    out |= {t.element.number: t for t in small_marks.with_places(unseen, found, small, ink, covers, paper.single)}
    out |= {t.element.number: t for t in _dots(small, headed, paper)}
    near = {"missing": widened(hidden)} | dict.fromkeys(("absent lettering", "part of lettering"), widened(hidden, WASHED_OUT))
    for t in [t for t in out.values() if t.status in near]:
        if share_hidden(t.element, near[t.status]) > LITTLE:
            out[t.element.number] = InkTrace(t.element, "hidden")
    for e in elements:  # a hand may have written here
        if e.kind == "text":
            fill(paper.words, grown(e.points, 0.8 * e.height + 1.0))
    left = without_creases(left, ink, paper.single)
    tears = torn_widths(found)
    out |= {t.element.number: replace(t, pieces=True) for t in out.values() if in_pieces(t, tears)}
    return [out[e.number] for e in elements], extra_ink(left, paper.single, paper.words, wiped)


def _shown_ends(t: InkTrace, hidden: Mask) -> tuple[float, float]:
    """The ends of a line, unknown where they are hidden."""
    begin, end = (math.nan if at(z, hidden) else by for z, by in zip(t.element.points[[0, -1]], t.ends, strict=True))
    return begin, end


class _Alone(NamedTuple):
    """How dark the place of a line is where no other covers it, and the share of the usual up to which it is not seen there."""

    dark: Floats
    faint: float


def _in_their_places(
    lines: Sequence[Element], dots: Points, paper: Paper,
) -> tuple[list[InkTrace], list[Element], dict[int, _Alone]]:
    """Traces of the lines that are where they belong, the lines that are not, and the places of the former where they are alone, by
    number, if those may show that others' ink was taken for theirs; ``dots`` are middles.
    """
    found: list[InkTrace] = []
    absent: list[Element] = []
    alone: dict[int, _Alone] = {}
    for strip in (strip_of(e, paper) for e in lines):
        t = in_place(strip)
        if t is None:
            absent.append(strip.element)
        else:
            found.append(t)
        places = alone_on(strip, dots, t is not None)
        if places is not None and expected_ink(strip.element) == 1.0:
            alone[strip.element.number] = places
    return found, absent, alone


def alone_on(strip: Strip, dots: Points, found: bool = True) -> _Alone | None:
    """The places of a line that others cover or run along for the most part, or that was not found, where none does; before a dot
    where it ends, a few.
    """
    e, dark = strip.element, uncovered(strip)
    step, shows = e.length / len(dark), ~np.isnan(dark)
    share = float(shows.mean())
    if (share <= 1 - COVERED or (not found and e.kind == "line")) and share * e.length >= LEAST:
        return _Alone(dark[shows], LITTLE)
    if e.kind != "line" or share > COVERED:
        return None
    half = len(dark) // 2
    for end, part in ((e.points[0], slice(half)), (e.points[-1], slice(-half, None))):
        before = dark[part][shows[part]]
        if len(before) * step >= TO_DOT and (np.abs(dots - end) <= AT_DOT).any():
            return _Alone(before, HALF)
    return None


def _displaced(absent: Sequence[Element], left: Any, wiped: Any, paper: Paper) -> list[InkTrace]:
    """Traces of lines that are not in their places, the longest first; each is wiped out where it is found."""
    found = []
    for e in sorted(absent, key=lambda e: -e.length):
        t = displaced(e, left, wiped, paper)
        if _edge(t):
            t = InkTrace(e, "dense", covered=t.covered, at=e.points)
        found.append(t)
        _claim(t, left, wiped, paper.owners)
    return found


def _claim(t: InkTrace, left: Any, wiped: Any, owners: Owners) -> None:
    """Wipe out the ink by which an element was found elsewhere."""
    if t.at is not None:
        owners.add(t.element, t.at)
        wipe_found(wiped, t)
        wipe_found(left, t, 0)


def _edge(t: InkTrace) -> bool:
    """Whether what was found elsewhere is so near its place that it is the edge of another's ink."""
    return t.status == "measured" and t.deviation < ELSEWHERE and t.element.kind != "circle"


def doubted(
    found: Sequence[InkTrace], alone: Mapping[int, _Alone], left: Any, wiped: Any, paper: Paper,
) -> list[InkTrace]:
    """The traces; those of lines paler than others of their kind, with gaps, or not seen where they are ``alone``, are looked for
    elsewhere once more.
    """
    usual = _usual_darkness(found)
    out = []
    for t in found:
        dark = usual.get(line_type(t.element.style).width, 0.0)
        places = alone.get(t.element.number)
        tells = places is not None and (places.faint <= LITTLE or dark < NO_GREY)
        tells &= t.status != "missing" and t.deviation <= ELSEWHERE
        covered = tells and places is not None and bool((places.dark <= places.faint * dark).mean() >= MOSTLY)
        covered |= t.element.kind == "line" and 0 < t.darkness <= LITTLE * dark  # ends of a hatching in its place
        if covered:
            t = replace(t, status="covered", covered=0.0, darkness=0.0)
        if covered or (t.darkness and (t.darkness < PALE * dark or t.covered < NEARLY_ALL)):
            better = better_match(t, left, wiped, paper)
            if better is not None and not _edge(better) and not (covered and better.darkness < PALE * dark):
                _claim(better, left, wiped, paper.owners)
                t = better
        out.append(t)
    return out


def _usual_darkness(found: Sequence[InkTrace]) -> dict[float, float]:
    """How dark lines of each width usually are; those of one style may nearly all lie under others."""
    widths: dict[float, list[float]] = {}
    for t in found:
        if t.darkness:
            widths.setdefault(line_type(t.element.style).width, []).append(t.darkness)
    return {width: float(np.median(values)) for width, values in widths.items()}


def _beside_strokes(found: Sequence[InkTrace], small: Sequence[Element], paper: Paper) -> list[InkTrace]:
    """The traces; of lines that cannot be told from others it is seen whether a line like them lies beside."""
    # No more of letters than their places: what stands between their edges and paper on both sides is no letter.
    lines = painted(np.zeros_like(paper.ink), seen_at(found), 0)
    taken = painted(paper.words.copy(), [*((e, e.points) for e in small), *seen_at(found)], ABOUT_INK)
    usual = _usual_darkness(found)
    moved: dict[int, InkTrace] = {}
    for t in found:
        if t.element.kind == "line" and (t.status in ("shared", "dense") or t.parts):
            other = beside(t, lines, taken, paper)
            dark = usual.get(line_type(t.element.style).width, 0.0)
            # Paler lines were rubbed out, or are the edges of others.
            if other is None or other.darkness <= PALE * dark:
                other = narrow_divergence(t, paper, dark) if dark else None
            if other is not None:
                moved[t.element.number] = other
    for number in resolve_overlaps(list(moved.values()), paper):
        del moved[number]
    return [moved.get(t.element.number, t) for t in found]


def _dots(small: Sequence[Element], found: Sequence[InkTrace], paper: Paper) -> list[InkTrace]:
    """Traces of the dots that stand beside their places."""
    dots = [e for e in small if e.kind == "circle" and e.fills]
    usual = _usual_darkness(found)
    if not dots or not usual:
        return []
    others = [(e, e.points) for e in small if e not in dots]
    others += [(t.element, t.element.points if t.at is None else t.at) for t in found]
    lines, taken = (painted(np.zeros_like(paper.ink), others, about) for about in (0, ABOUT_INK))
    painted(taken, [(e, e.points) for e in dots], ABOUT_INK / 2)  # paint widens lines, and grows what is filled to all sides
    straight = [t for t in found if t.element.kind == "line"]
    rods, astray = [t.element.points for t in straight], [t.element.points for t in straight if _is_displaced(t)]
    return displaced_dots(dots, rods, lines, taken, paper.ink, paper.words, paper.hidden, max(usual.values()), astray,
                          bars(small, paper.ink))


def _is_displaced(t: InkTrace) -> bool:
    """Whether a line is not in its place."""
    return t.status in ("missing", "covered", "beside") or (t.status == "measured" and t.deviation > ELSEWHERE)


def bars(small: Sequence[Element], ink: Any) -> Any:
    """A picture of the bars over letters, which lie near them all along as their leaders do not, 255 there."""
    out = np.zeros_like(ink)
    for e in small:
        if e.kind != "text" or not e.pieces:
            continue
        box = grown(e.points, BAR)
        for p in e.pieces:
            inside = (p.real > box.real.min()) & (p.real < box.real.max()) & (p.imag > box.imag.min()) & (p.imag < box.imag.max())
            if inside.all():
                cv2.polylines(out, [fixed(p)], False, 255, round(2 * ABOUT_INK * SCALE), cv2.LINE_8, 4)
    return out


def _traces_of_small(small: Sequence[Element], found: Sequence[InkTrace], paper: Paper) -> dict[int, InkTrace]:
    """Traces by number of what is not measured: whether there is any ink in the place of lettering; the rest is not looked at.

    Each run of letters, a letter or its index, is looked for by itself. The ink of lines that run through its place does not
    count, bars over letters among them, nor does a place that they fill.
    """
    out = {e.number: InkTrace(e, "small", covered=1.0) for e in small}
    # What the form has outside its frame is cut off with the margin, and nobody's mistake; a dash is too little to be missed.
    words = [e for e in small if e.kind == "text" and FRAME.contains(e.middle) and any(map(str.isalnum, e.text))]
    if not words:
        return out
    others = painted(np.zeros_like(paper.ink), [*seen_at(found), *((e, e.points) for e in small)], ABOUT_INK)
    runs = [(e.number, len(m.text), text_box(m)) for e in words for m in e.marks if isinstance(m, Text)]
    u, v = (t.ravel() for t in np.meshgrid(np.linspace(0, 1, 60), np.linspace(0, 1, 24)))
    corners = np.stack([grown(box, 0.3) for _, _, box in runs])
    a, b, _, d = corners.T[:, :, None]
    places = pixels(a + u * (b - a) + v * (d - a))
    free = sample(others, places, nearest=True) == 0
    dark = (sample(paper.ink, places) > paper.level) & free
    shares = dark.sum(1) / np.maximum(free.sum(1), 1)
    shown, inked = ((part.reshape(-1, 24, 60).sum(1) >= rows) for part, rows in ((free, 8), (dark, 2)))
    columns = (inked & shown).sum(1) / np.maximum(shown.sum(1), 1)
    there = (shares > WRITTEN) | (free.mean(1) < LITTLE)
    clear = shown.mean(1) > WHOLE
    gone = clear & (~there | ((columns < PARTLY) & (np.array([length for _, length, _ in runs]) > 1)))
    of = np.array([number for number, _, _ in runs])
    for e in words:
        mine = of == e.number
        status: Status = "absent lettering" if not there[mine].any() else "part of lettering" if gone[mine].any() else "lettering"
        out[e.number] = InkTrace(e, status, covered=float(columns[mine & clear].min(initial=1.0)))
    return out
