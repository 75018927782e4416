"""Whether an arrow has its head, or has it at its other end.

About both ends of a line there is looked for ink beside it as a head has it by the drawing: more and more backwards from the tip,
then nothing any more. It is held against what lies beside the line farther along. Only what belongs to nobody else is looked at:
where others are drawn, letters may stand or the sheet is hidden, nothing can be told; among letters a whole head is known all the
same, and so is bare paper. A picture that is not flat, or a hand, may have a head a little farther along the line or a little
smaller.

Of vectors in one stroke with one tip the heads lie on each other: whose is missing cannot be seen. One that was drawn the other
way is told by its head at the beginning of the stroke, where none belongs.

Vectors of which only the helper line under them is there.

A vector that was left out leaves the thin line of its construction in its place, and that is found for it. What tells them apart is
ink: a thin line is narrower and, blurred as it is in a picture, paler, than the vectors about it, all along where no other thick
line lies in its stroke. Letters and lines that cross may add ink there, and take none away.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import Any, NamedTuple

import cv2
import numpy as np

from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.photo.lost_ink import at
from tmm_sheets.compare.photo.own_place import ALONG_STEP
from tmm_sheets.compare.photo.profiles import HALF, LARGELY, LITTLE, MOSTLY, NEARLY_ALL, NOTHING, WHOLE, pixels, sample
from tmm_sheets.compare.photo.sheet_map import Floats
from tmm_sheets.compare.photo.traces import ELSEWHERE, END_STEP, STEP, Head, InkTrace, Owners, Paper
from tmm_sheets.drawing.styles import line_type

LEAST = 2.4
"""mm; shorter heads are not looked for."""
SHAFT = 1.0
"""mm behind a head, and from the other end, beyond which a line has no head any more."""
SHORTEST = 4.0
"""mm of a vector behind its head by which the line's own ink is known."""
ASIDE = np.arange(-14, 15) * STEP
MIDDLE = np.abs(ASIDE) < 0.35
"""Places to its sides, and those of the line itself."""
AHEAD, BEHIND = 2.0, 1.4
"""mm beyond the tip from which on, and behind a head up to which ink is looked at: there a head has none."""
NEAR, FARTHER = END_STEP * np.array(sorted(range(-6, 7), key=abs)), END_STEP * np.arange(-8, 21, 2)
"""mm by which a head may lie farther back than its place, the most likely first; by more it is no head in its place, but a head."""
SIZES = ((1.0, 1.0), (0.85, 1.0), (0.7, 1.0), (1.0, 0.7), (0.7, 0.7))
"""Length and width of heads drawn by hand by those of the drawing."""
BESIDE = 0.22
"""mm from the edge of the line beyond which nothing of others may be: what runs along under it, a helper line, is no matter."""
THICKEST = 0.5
"""mm; half of how thick a link at most is that runs under all of a line and is taken for its own ink."""
NEXT = 15.0
"""mm of a line behind its head by which its own ink is known: a hand presses here more than there, and wavers."""
SOME = 6
"""Least number of places along a line by which its ink is known."""
FAINT = 0.12
"""Darkness as a share of the line's own up to which there is no ink."""
HAS, ALONE, BARE = 0.45, 0.75, 0.2
"""Least share of a head that tells of one in its place; how alike ink must be to one at the other end that is seen as a whole where
no others begin; share up to which there is none in its place, nor one a little off or smaller."""
SIDE = LARGELY * HALF
"""Least part of a head that must be seen of one side for that to be known as a whole."""
ON_LINE = 0.998
"""Cosine of the angle up to which another arrow lies on the same line."""
TOGETHER = 1.5
"""mm between tips up to which two heads on one line cannot be told from each other."""
ENOUGH, NEAREST = 3, 9
"""Least number of vectors with heads that tell how much ink is usual across a line, and of how many about it the middle one is
taken: where the picture is small, all lines are paler."""
CENTRED = 0.45
"""mm from the middle of a line within which the middle of its stroke is."""


class _Likeness(NamedTuple):
    """Ink compared with that of a head: part of it that is seen, its ink as a share of the drawing's, and how alike both are."""

    part: float
    share: float
    alike: float


@dataclass(frozen=True)
class _End:
    """What there is about an end of a line.

    Attributes
    ----------
    back : places, mm from the end backwards
    ink : how much darker it is there than beside the line elsewhere, (places, aside)
    known, legible : where that may be told, and where it might be told if there are no letters
    own : darkness across the line elsewhere
    grown : mm by which the line is wider than it was drawn
    lined : share of the way to the tip on which the line is seen
    aside : mm from where the line was found to the middle of its stroke
    """

    element: Element
    back: Floats
    ink: Any
    known: Any
    legible: Any
    own: Floats
    grown: float
    lined: float
    aside: float

    def likeness(self, shifts: Floats, sizes: Sequence[tuple[float, float]]) -> Iterator[_Likeness]:
        """The likeness to heads of some sizes that lie some mm farther back."""
        for long, wide in sizes:
            wanted = self._head(long, wide)
            for shift in shifts.tolist():
                yield self._like(wanted, long * _length(self.element), shift)

    def _head(self, long: float, wide: float) -> Any:
        """How much darker it would be by a head of a length and a width, as shares of those it has by the drawing."""
        e, length = self.element, long * _length(self.element)
        half = wide * _half_width(e) * self.back / length + self.grown / 2
        inside = (np.abs(ASIDE - self.aside) <= half[:, None]) & ((self.back >= 0) & (self.back <= length))[:, None]
        # As blurred as a line is.
        full = cv2.GaussianBlur(inside.astype(np.float32), (7, 5), sigmaX=0.2 / STEP, sigmaY=0.2 / END_STEP)
        return np.clip(self.own[MIDDLE].max() * full - self.own, 0, None)

    def _like(self, wanted: Any, length: float, shift: float) -> _Likeness:
        by = round(shift / END_STEP)
        wanted = np.roll(wanted, by, 0)
        if by > 0:
            wanted[:by] = 0
        about = (self.back >= shift - 2 * END_STEP) & (self.back <= shift + length + BEHIND)
        flank = about[:, None] & (np.abs(ASIDE) >= 0.25)
        told = flank & self.known
        weight, whole = float((wanted[told] ** 2).sum()), float((wanted[flank] ** 2).sum())
        if not weight:
            return _Likeness(0.0, 0.0, 0.0)
        ink = self.ink[told]
        dark = np.where(ink > FAINT * self.own[MIDDLE].max(), ink, 0)
        both = float((wanted[told] * dark).sum()) / np.sqrt(weight * max(float((dark**2).sum()), 1e-9))
        return _Likeness(weight / whole, float((wanted[told] * ink).sum()) / weight, both)

    def has_head(self, share: float = HAS, alike: float = MOSTLY, part: float = LITTLE) -> bool:
        """Whether there is a head in its place."""
        written = self.written()
        return any(h.part >= part and h.share >= share and h.alike >= alike for h in self.likeness(NEAR, SIZES)) or any(
            h.part >= LARGELY and h.share >= HALF and h.alike >= NEARLY_ALL for h in written.likeness(NEAR, SIZES))

    def written(self) -> _End:
        """It, if there are no letters."""
        return replace(self, known=self.legible)

    def has_whole_head(self) -> bool:
        """Whether all of the place of a head is seen, and one is there where none is expected."""
        seen = next(self.likeness(NEAR, SIZES)).part >= LARGELY
        return seen and self.has_head(HALF, NEARLY_ALL, LARGELY)

    def sides(self) -> list[_Likeness]:
        """The likeness of either side to that of a head in its place."""
        return [next(self._one_side(side).likeness(NEAR, SIZES)) for side in (-1, 1)]

    def _one_side(self, side: int) -> _End:
        """It, seen to one side of its stroke, -1 or 1, alone."""
        return replace(self, known=self.known & (side * (ASIDE - self.aside) > 0))

    def bare(self) -> bool:
        """Whether nothing of a head is in its place, as far as that is seen."""
        here = next(self.likeness(NEAR, SIZES))
        return here.part > NOTHING and here.share <= BARE

    def headless(self) -> bool:
        """Whether the line goes on to its tip and has no head in its place, nor a little off it, nor a small one."""
        if self.lined < WHOLE or not self.bare():
            return False
        sides = self.sides()
        # A head may lie a little aside, on the side that others hide, but not so far that all of the other side is bare.
        half = any(s.part >= SIDE and s.share <= NOTHING for s in sides)
        if not half and (sum(s.part for s in sides) < HAS or min(s.part for s in sides) < NOTHING):
            return False
        looked = chain(self.likeness(NEAR, SIZES), self.likeness(FARTHER, SIZES[:1]))
        return not any(h.part >= LITTLE and h.share >= BARE and h.alike >= MOSTLY for h in looked)


@dataclass(frozen=True)
class Arrows:
    """What shows, and the heads of arrows: the tip of each and the middle of its back."""

    paper: Paper
    heads: Sequence[tuple[complex, complex]]

    def end(self, e: Element, tip: complex, other: complex) -> _End | None:
        """What there is about an end of a line; None where nothing can be told."""
        length, head = abs(other - tip), _length(e)
        way = (other - tip) / length
        far = max(length - head - SHAFT, head + SHAFT + 0.5 * SHORTEST)
        shaft = np.linspace(head + SHAFT, min(far, head + SHAFT + NEXT), 60)
        ink, others, letters, hidden = self._beside(e, tip, way, shaft)
        left, right = _run_under(others, line_type(e.style).width / 2)
        # In steps of pixels a line that lies under all of it shows beside it here and there.
        covered = bool(others[:, MIDDLE].any(1).mean() > WHOLE)
        about = BESIDE + covered * STEP
        close = np.abs(ASIDE - (right - left) / 2) <= (left + right) / 2 + about
        under = close & ((others.mean(0) > LITTLE) | covered)
        free = ~_widened(others & ~close)
        own = _usual(ink, free & ~hidden & ~letters)
        if own is None:
            return None
        back = np.arange(-AHEAD, head + BEHIND + FARTHER[-1] + END_STEP, END_STEP)
        ink, others, letters, hidden = self._beside(e, tip, way, back)
        dark = own[MIDDLE].max()
        inked = own - own.min() > 0.5 * (dark - own.min())
        low = float(ASIDE[~inked & (ASIDE < 0)].max(initial=-np.inf))
        high = float(ASIDE[~inked & (ASIDE >= 0)].min(initial=np.inf))
        # With paper to both sides, or it is others' ink that begins there.
        if np.isfinite(high - low) and high - low - STEP >= LARGELY * 2 * _half_width(e):
            return None
        way_to_tip = (back >= 2 * END_STEP) & (back <= head + 2 * SHAFT)
        lined = float((ink[way_to_tip][:, MIDDLE].max(1) > 0.5 * dark).mean())
        legible = ~_widened(others & ~under) & ~hidden
        aside = (low + high) / 2 if abs(low + high) <= 2 * CENTRED else 0.0
        grown = max(0.0, STEP * float(inked.sum()) - left - right)
        return _End(e, back, ink - own, legible & ~letters, legible, own, grown, lined, aside)

    def _beside(self, e: Element, tip: complex, way: complex, back: Floats) -> tuple[Any, Any, Any, Any]:
        """Ink across a line ``back`` mm from its tip, where others are, where letters may stand, and where it is hidden."""
        places = tip + way * (back[:, None] + 1j * ASIDE)
        paper = self.paper
        return (paper.dark(places).astype(np.float64), paper.owners.others(e.number, places),
                sample(paper.words, pixels(places)) > 100, at(places, paper.hidden))

    def another_points(self, e: Element, start: complex, way: complex) -> bool:
        """Whether another arrow on the same line points to where this one begins: the head there is that one's."""
        return any(abs(z - start) < _length(e) and ((back - z) / abs(back - z) / way).real > ON_LINE for z, back in self.heads)

    def shares_tip(self, e: Element, way: complex) -> bool:
        """Whether the head of another arrow lies on its own."""
        tip = complex(e.fills[0][0])
        return sum(abs(z - tip) < TOGETHER and ((z - back) / abs(z - back) / way).real > ON_LINE for z, back in self.heads) > 1

    def others_begin(self, e: Element, start: complex, way: complex) -> bool:
        """Whether the tip of another arrow, or another line beside this one, is where this one begins."""
        return any(abs(z - start) < _length(e) for z, _ in self.heads) or self.accompanied(e, start, way)

    def accompanied(self, e: Element, start: complex, way: complex) -> bool:
        """Whether another line leaves the same point beside this one, and would be taken for the edge of a head."""
        half = line_type(e.style).width / 2
        aside = np.arange(half + 0.1, 1.1, 0.15)
        places = start + way * (np.arange(1.2, 5.0, 0.2)[:, None] + 1j * np.concatenate((-aside, aside)))
        return bool(self.paper.owners.others(e.number, places).any())


def _run_under(others: Any, pen: float) -> tuple[float, float]:
    """How far to its left and right a thicker line lies under all of a line, mm, or its own width, ``pen`` to either side: it may
    lie aside of the middle of a link.
    """
    bare = others.mean(0) < WHOLE
    left, right = (float(np.abs(ASIDE[bare & side]).min(initial=np.inf)) - 1.5 * STEP for side in (ASIDE <= 0, ASIDE >= 0))
    return (max(left, pen), max(right, pen)) if 2 * pen + 2 * STEP < left + right <= 2 * THICKEST else (pen, pen)


def _widened(others: Any) -> Any:
    """Places of others with those where their ink may reach, as blurred as it is and not quite in its place."""
    return cv2.dilate(others.astype(np.uint8), np.ones((5, 7), np.uint8)) > 0


def _usual(ink: Any, known: Any) -> Floats | None:
    """Darkness across a line along its middle; of a side that is not seen that of the other one, None where neither is."""
    own: Floats = np.full(len(ASIDE), np.nan)
    for k in np.flatnonzero(known.sum(0) >= SOME).tolist():
        own[k] = np.median(ink[known[:, k], k])
    own = np.where(np.isnan(own), own[::-1], own)
    if np.isnan(own[MIDDLE]).any():
        return None
    return np.where(np.isnan(own), np.nanmin(own), own)


def with_heads(traces: Sequence[InkTrace], paper: Paper) -> list[InkTrace]:
    """Look for the heads of arrows.

    Parameters
    ----------
    traces
        All; those of lines that are no vectors, or were not found, are left as they are.
    paper
        What shows.

    Returns
    -------
    The traces in the same order, with ``head``.
    """
    arrows = Arrows(paper, [(complex(f[0]), complex(f[1:].mean())) for t in traces for f in t.element.fills])
    found = {k: _head(t, arrows) for k, t in enumerate(traces) if _wanted(t)}
    thin = construction_only(traces, paper)
    seen = [traces[k].element for k, head in found.items() if head == "there"]
    out = list(traces)
    for k, head in found.items():
        t = traces[k]
        shares = any(_share_an_end(t.element, e, -1) for e in seen if e is not t.element)
        if t.element.number in thin and (head != "there" or shares):
            # What lies elsewhere is a thin line of its own.
            out[k] = replace(t, head="left out") if t.deviation <= ELSEWHERE else InkTrace(t.element, "missing")
        else:
            out[k] = replace(t, head="unknown" if head == "absent" and shares else head)
    told = [t.element for t in out if t.head == "reversed"]
    doubted = {t.element.number for t in out if t.head == "doubled" and any(_share_an_end(t.element, e, 0) for e in told)}
    return [replace(t, head="unknown") if t.element.number in doubted else t for t in out]


def _share_an_end(e: Element, other: Element, end: int) -> bool:
    """Whether two vectors of one direction have this end, 0 or -1, in one place: a head there may be either's."""
    ways = [v.points[-1] - v.points[0] for v in (e, other)]
    alike = (ways[0] / ways[1]).real / abs(ways[0] / ways[1]) > ON_LINE
    return bool(alike and abs(e.points[end] - other.points[end]) < TOGETHER)


def _wanted(t: InkTrace) -> bool:
    """Whether it is a vector that was found, long enough for its head to be told from it."""
    e = t.element
    return bool(vector(t) and _length(e) >= LEAST and e.length > _length(e) + SHORTEST and abs(e.fills[0][0] - e.points[-1]) < 0.1)


def _length(e: Element) -> float:
    """Length of the head of an arrow, mm."""
    return float(abs(e.fills[0][0] - e.fills[0][1:].mean()))


def _half_width(e: Element) -> float:
    """Half the width of the head of an arrow, mm."""
    way = e.points[0] - e.fills[0][0]
    return float(np.abs(((e.fills[0] - e.fills[0][0]) / way).imag).max() * abs(way))


def _head(t: InkTrace, arrows: Arrows) -> Head:
    """What there is of a head at the tip, and at the other end when there is none."""
    assert t.at is not None
    way = (t.at[1] - t.at[0]) / abs(t.at[1] - t.at[0])
    beyond = [0.0 if np.isnan(by) else by for by in t.ends]
    begin, tip = complex(t.at[0] - way * beyond[0]), complex(t.at[1] + way * beyond[1])
    here = arrows.end(t.element, tip, begin)
    if here is None:
        return "unknown"
    alone = not arrows.shares_tip(t.element, way)
    has = here.has_head()
    if has and alone and not here.bare():
        return "there"
    there = arrows.end(t.element, begin, tip)
    if there is None or arrows.another_points(t.element, begin, way):
        return "there" if has else "absent" if here.headless() else "unknown"
    part = next(here.likeness(NEAR, SIZES)).part
    bare = here.bare()
    if bare and there.has_whole_head():
        return "reversed"
    if has and alone:
        return "there"
    # The less is seen of the tip, the more must be seen of the other end.
    if bare and there.has_head(HALF, NEARLY_ALL, LITTLE if part >= LITTLE else HALF):
        return "reversed"
    # Where nothing can be told of the tip, others must not have theirs at the other end: it might be drawn a little beside.
    if here.lined >= WHOLE and not arrows.others_begin(t.element, begin, way) and there.has_head(HALF, ALONE, LARGELY):
        return "reversed"
    if not alone and next(there.likeness(NEAR, SIZES)).part >= SIDE and there.has_head(HALF, NEARLY_ALL, SIDE):
        return "doubled"
    return "there" if has else "absent" if here.headless() else "unknown"


THICK = 0.35
"""mm of width from which on a line hides whether a vector in one stroke with it was drawn."""
THIN_ASIDE = np.arange(-9, 10) * 0.1
"""mm to its sides within which there must be no other thick line."""
OWN = np.abs(THIN_ASIDE) <= 0.75
"""Those within which its ink is."""
SPARED, THIN_LEAST, PIECE = 1.5, 2.4, 5
"""mm at its ends that dots hide, least mm of it that must be seen by itself, and places that are taken together."""
NARROW = 0.62
"""Ink across it, as a share of that usual for the vectors about it, up to which it is a thin line."""
UNIFORM = 0.75
"""The same up to which a piece of it is no vector's."""


class _Stroke(NamedTuple):
    """Ink of a vector where no other thick line is near, across it in pieces of it."""

    element: Element
    across: Any

    @property
    def usual(self) -> float:
        return float(np.median(self.across))


def construction_only(traces: Sequence[InkTrace], paper: Paper) -> set[int]:
    """Numbers of the vectors in whose places there is no more than a thin line; ``traces`` are all lines that were found."""
    thick = replace(paper, owners=Owners(*paper.ink.shape))
    for t in traces:
        if line_type(t.element.style).width >= THICK:
            thick.owners.add(t.element, t.element.points)
    strokes = [s for t in traces if vector(t) and (s := _stroke(t, thick)) is not None]
    return {s.element.number for s in strokes if _thin(s, [o for o in strokes if o is not s])}


def vector(t: InkTrace) -> bool:
    """Whether it is a straight vector that was found."""
    e, found = t.element, t.status in ("measured", "shared") and t.at is not None
    return found and e.style == "vector" and e.kind == "line" and len(e.fills) == 1


def _stroke(t: InkTrace, thick: Paper) -> _Stroke | None:
    assert t.at is not None
    length = abs(t.at[-1] - t.at[0])
    way = (t.at[-1] - t.at[0]) / length
    p = t.at[0] + way * np.arange(SPARED, length - SPARED, ALONG_STEP)
    places = p[:, None] + 1j * way * THIN_ASIDE
    free = ~thick.owners.others(t.element.number, places).any(1) & ~at(p, thick.hidden)
    if free.sum() * ALONG_STEP < THIN_LEAST:
        return None
    profile = thick.dark(places[free]).astype(np.float64)[:, OWN]
    pieces = [np.median(part, 0) for part in np.array_split(profile, max(len(profile) // PIECE, 1))]
    across = np.array([(part - part.min()).sum() for part in pieces])
    return _Stroke(t.element, across)


def _thin(s: _Stroke, others: Sequence[_Stroke]) -> bool:
    if len(others) < ENOUGH:
        return False
    about = sorted(others, key=lambda o: abs(o.element.middle - s.element.middle))[:NEAREST]
    usual = float(np.median([o.usual for o in about]))
    uniform = (s.across <= UNIFORM * usual).mean() >= NEARLY_ALL
    return bool(s.usual <= NARROW * usual and uniform)
