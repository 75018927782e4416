"""Laying a drawing over the sheet it shows: which sheet, which space of the file, and how it is placed as a whole."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.cad import layout
from tmm_sheets.compare.cad.cad_ink import CadInk, DrawingSpace
from tmm_sheets.compare.cad.cad_text import meant
from tmm_sheets.compare.cad.line_fit import HIT, RATIOS, KnownLines, candidates, lines, refine, search, snapped
from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.known_sheet import KnownSheet
from tmm_sheets.compare.placing import Placing
from tmm_sheets.drawing.marks import Points

SIDES = (816.0, 841.0, 584.0, 594.0)
"""Lengths of the sides of the frame and of the paper, mm."""
SURE = 0.5
"""Share of our lines found above which a placing is beyond doubt."""
ASKEW = 0.008
"""A turn up to this is none, rad."""
LETTERS, MANY, MORE = 6, 0.3, 3
"""So many texts tell how a drawing is turned, else its lines, if that share has one direction and so many times less is upright."""
ALIGNED = 1e-3
"""What is one direction, rad."""
LONGEST_PART = 60_000.0
"""Length of all lines of a part of a sheet, mm."""
PART = 100.0
"""Width plus height of the smallest part of a sheet that is looked for, mm."""


@dataclass(frozen=True)
class Registration:
    """A drawing laid over a known sheet: ``space`` by ``placing``, with ``share`` of the sheet's lines found in it."""

    known: KnownSheet
    space: DrawingSpace
    placing: Placing
    share: float


def register(known: Sequence[KnownSheet], ink: CadInk) -> Registration:
    """Lay a drawing over the sheet it fits best: by its frame, else by any of its lines or views, even mirrored or of one view.

    One turned as a whole, as in a user coordinate system, is turned back first.
    """
    back = [Placing(complex(np.exp(-1j * angle))) if (angle := _askew(space)) else None for space in ink.spaces]
    if not any(back):
        return _lay(known, ink)
    spaces = [space.placed(turn) if turn else space for space, turn in zip(ink.spaces, back, strict=True)]
    laid = _lay(known, replace(ink, spaces=tuple(spaces)))
    k = next(k for k, space in enumerate(spaces) if space is laid.space)
    if laid.share < SURE and (upright := _lay(known, ink)).share > laid.share:
        return upright
    return replace(laid, space=ink.spaces[k], placing=laid.placing.after(back[k] or Placing()))


def _lay(known: Sequence[KnownSheet], ink: CadInk) -> Registration:
    """The same of a drawing whose frame and tables, or lettering, are upright or lie on a side."""
    tried = _by_frame(known, ink)
    if not tried:
        tried += _by_lines(known, ink, mirrored=False)
        if _best(tried).share < SURE:
            tried += _by_lines(known, ink, mirrored=True)
        if _best(tried).share < SURE:
            tried += _by_parts(known, ink)
    return _refined(_best(tried), ink.unit)


def fitting(known: Sequence[KnownSheet], ink: CadInk) -> tuple[int, float]:
    """The sheet a drawing seems to be of, and the share of its lines found at a quick look."""
    best = _best(_by_frame(known, ink) or list(_by_lines(known, ink, mirrored=False)))
    return best.known.n, best.share


def _by_frame(known: Sequence[KnownSheet], ink: CadInk) -> list[Registration]:
    """Placings by the frame alone, of one space after another until one is beyond doubt."""
    frame = _frame(known[0].elements)
    tried: list[Registration] = []
    drawn = [layout.ink(sheet.elements) for sheet in known]
    for space in ink.spaces:
        for placing in _of_frame(frame, space.lines, ink.unit):
            for sheet, points in zip(known, drawn, strict=True):
                picked = points[:: max(len(points) // 3000, 1)]
                share = space.lines.share(placing.back(picked), HIT / placing.scale)
                tried.append(Registration(sheet, space, placing, share))
        if tried and _best(tried).share >= SURE:
            break
    return tried


def _of_frame(frame: Points, theirs: KnownLines, unit: float | None) -> list[Placing]:
    """The four placings that put a frame of theirs on ours, none if there is no frame."""
    scales = candidates(theirs, unit, float(np.ptp(frame.real)), SIDES)[:8]
    long = theirs.only(theirs.length > 0.02 * theirs.length.max())
    trial = search(frame, long, scales, (0, 1), enough=0.97)
    if trial.share < 0.95:
        return []
    x, y = frame.real.min() + frame.real.max(), frame.imag.min() + frame.imag.max()
    ways = (Placing(), Placing(-1 + 0j, complex(x, y)), Placing(-1 + 0j, complex(x, 0), True), Placing(1 + 0j, complex(0, y), True))
    return [way.after(trial.placing) for way in ways]


def _by_lines(known: Sequence[KnownSheet], ink: CadInk, *, mirrored: bool) -> Iterator[Registration]:
    """The best placing of each space on each sheet by all of its lines."""
    drawn = [layout.ink(sheet.elements) for sheet in known]
    for space in ink.spaces:
        for sheet, points in zip(known, drawn, strict=True):
            scales = candidates(space.lines, ink.unit, float(np.ptp(points.real)), SIDES)
            found = search(points, space.lines, scales, mirrored=mirrored)
            yield Registration(sheet, space, found.placing, found.share)
            if found.share > 0.8:
                break


def _by_parts(known: Iterable[KnownSheet], ink: CadInk) -> Iterator[Registration]:
    """Placings of a drawing of a few views only: those that put most of its own lines on ours."""
    for sheet in known:
        ours = lines([e.points for e in sheet.elements if e.view.n and e.kind not in ("text", "hatch", "fill")])
        for space in ink.spaces:
            for size in dict.fromkeys(base * ratio for base in (ink.unit or 1.0, 1.0) for ratio in RATIOS):
                scale = Placing(complex(size))
                if space.lines.length.sum() * size > LONGEST_PART:
                    continue
                z = space.lines.moved(scale).points(1.0)
                if not 30 < len(z) < 60_000 or np.ptp(z.real) + np.ptp(z.imag) < PART:
                    continue
                trial = search(z, ours, [1.0], tries=4)
                if trial.share >= SURE:
                    yield Registration(sheet, space, trial.placing.inverse().after(scale), trial.share)


def _askew(space: DrawingSpace) -> float:
    """The angle by which a drawing is turned beside quarter turns, rad: that of its lettering, else of its lines."""
    angles = np.array([w.angle for w in space.writings])
    weights = np.ones(len(angles))
    if len(angles) < LETTERS:
        angles, weights = np.angle(space.lines.b - space.lines.a), space.lines.length
    if not len(angles) or not weights.any():
        return 0.0
    bins, k = np.unique(np.round(_beside(angles) / ALIGNED), return_inverse=True)
    most = float(bins[np.bincount(k, weights).argmax()]) * ALIGNED
    near, upright = (np.abs(_beside(angles - one)) < ALIGNED for one in (most, 0.0))
    if abs(most) < ASKEW or weights[near].sum() < max(MANY * weights.sum(), MORE * weights[upright].sum()):
        return 0.0
    return most + float(np.median(_beside(angles - most)[near]))


def _beside(angles: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Angles beside the nearest quarter turn, rad."""
    return np.asarray((angles + np.pi / 4) % (np.pi / 2) - np.pi / 4)


def _best(tried: Sequence[Registration]) -> Registration:
    """The first among equals (model space, not mirrored); where little fits, the sheet with more of the words counts."""
    if max(laid.share for laid in tried) >= SURE:
        return max(tried, key=lambda laid: round(laid.share, 2))
    return max(tried, key=lambda laid: round(laid.share + _words(laid), 2))


def _words(laid: Registration) -> float:
    """Share of the words of a sheet that are somewhere in the drawing."""
    there = {meant(w.text) for w in laid.space.writings}
    ours = {meant(e.text) for e in laid.known.elements if e.kind == "text" and len(e.text) > 3}
    return len(ours & there) / max(len(ours), 1)


def _refined(laid: Registration, unit: float | None) -> Registration:
    """The placing refined: on all lines if most are in their places, else on the frame if there is one."""
    theirs, z, free = laid.space.lines, layout.ink(laid.known.elements), True
    if laid.share < SURE:
        frame = _frame(laid.known.elements)
        if theirs.share(laid.placing.back(frame), HIT / laid.placing.scale) > 0.9:
            z = frame
        else:
            free = False  # too few lines for a fit of scale and angle
    z = z[:: max(len(z) // 1500, 1)]
    placing = snapped(z, theirs, refine(z, theirs, laid.placing, free=free).placing, unit)
    return replace(laid, placing=placing)


def _frame(found: Sequence[Element]) -> Points:
    """Points along the frame, the largest rectangle of main lines."""
    rectangles = [e for e in found if e.view.n == 0 and e.kind == "curve" and e.style == "main"]
    return lines([max(rectangles, key=lambda e: e.length).points]).points(2.0)
