"""Laying a drawing over the sheet it shows: which sheet, which space of the file, and how it is placed as a whole."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.cad import layout, view_search
from tmm_sheets.compare.cad.cad_ink import CadInk, DrawingSpace
from tmm_sheets.compare.cad.cad_text import meant
from tmm_sheets.compare.cad.line_fit import HIT, RATIOS, KnownLines, candidates, lines, refine, search, snapped
from tmm_sheets.compare.cad.titles import Titles
from tmm_sheets.compare.cad.view_search import ASKEW, FoundView
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.known_sheet import KnownSheet
from tmm_sheets.compare.placing import SAME, Placing, moved
from tmm_sheets.drawing.marks import Points

SIDES = (816.0, 841.0, 584.0, 594.0)
"""Lengths of the sides of the frame and of the paper, mm."""
SURE = 0.5
"""Share of our lines found above which a placing is beyond doubt."""
OWN = 0.4
"""Share of a drawing's ink that views must explain which stand in a layout of its own."""
SIZES = tuple(dict.fromkeys((*RATIOS, *(1 / r for r in RATIOS))))
"""Sizes of the letters, of ours, that a drawing at a scale of GOST 2.302 may have."""
UNITS = (1.0, 25.4, 1000.0, 10.0)
"""Units one draws in, mm."""
ROUGHLY = 1.6
"""How many times higher or lower than ours letters are."""
SURELY_HANDY, BETTER = 0.8, 0.1
"""Share of the plans with a handy scale factor from which on the unit is sure, and by how much another must be better."""
AWAY = 5.0
"""How far from ours a view stands that is elsewhere, mm."""
LETTERS, MANY, MORE = 6, 0.3, 3
"""So many texts tell how a drawing is turned, else its lines, if that share has one direction and so many times less is upright."""
ALIGNED = 1e-3
"""What is one direction, rad."""
PART = 100.0
"""Width plus height of the smallest part of a sheet that is looked for, mm."""


@dataclass(frozen=True)
class Registration:
    """A drawing laid over a known sheet: ``space`` by ``placing``, with ``share`` of the sheet's lines found in it.

    In a drawing with a layout of its own the placing tells scale and turn only, ``views`` where each view is after it; ``titled``
    is the share of its ink that stands under titles of the sheet.
    """

    known: KnownSheet
    space: DrawingSpace
    placing: Placing
    share: float
    views: Mapping[ElementView, FoundView] = field(default_factory=dict)
    titled: float = 0.0

    @property
    def meant(self) -> float:
        """Share of the ink that is known to be of the sheet: by its shape, or by the titles over it."""
        return max(self.share, self.titled)


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
    if laid.share < OWN and (upright := _lay(known, ink)).share > laid.share:
        return upright
    return replace(laid, space=ink.spaces[k], placing=laid.placing.after(back[k] or Placing()))


def _lay(known: Sequence[KnownSheet], ink: CadInk) -> Registration:
    """The same of a drawing whose frame and tables, or lettering, are upright or lie on a side."""
    # With a frame the rest may have another layout: then the lettering tells the sheet.
    tried = _by_frame(known, ink)
    if tried and _best(tried).share < SURE and (own := _own_layout_framed(tried, ink.unit)) is not None:
        return own
    if not tried:
        tried += _by_lines(known, ink, mirrored=False)
        if _best(tried).share < SURE and (own := _own_layout(known, ink)) is not None:
            return own
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
                z = space.lines.moved(scale).points(1.0)
                if not 30 < len(z) < 60_000 or np.ptp(z.real) + np.ptp(z.imag) < PART:
                    continue
                trial = search(z, ours, [1.0], tries=4)
                if trial.share >= SURE:
                    yield Registration(sheet, space, trial.placing.inverse().after(scale), trial.share)


def _own_layout(known: Sequence[KnownSheet], ink: CadInk) -> Registration | None:
    """The drawing by its views, wherever they stand: those of the sheet that most of its ink belongs to; None if little does."""
    best: Registration | None = None
    for space in ink.spaces:
        turn = Placing(1j ** -_quarter(space))
        for sheet in known:
            likely: tuple[float, Registration] | None = None
            for scale in _sizes(sheet, space, ink.unit):
                laid = _by_views(sheet, space, turn._replace(turn=scale * turn.turn))
                handy = _handy(laid)
                if likely is None or handy * laid.share > likely[0] + BETTER:
                    likely = handy * laid.share, laid
                if handy > SURELY_HANDY and laid.share >= OWN:
                    break
            if likely is not None and likely[1].meant >= OWN and (best is None or likely[1].share > best.share):
                best = likely[1]
    return best if best is None else _to_size(best)


def _own_layout_framed(tried: Sequence[Registration], unit: float | None) -> Registration | None:
    """A drawing in a frame by its views, the lettering upright, for the frame alone has four ways; None if little of it is.

    Neither is it one of its own where most views are where ours are, or all are as large and the title block is ours.
    """
    upright = [(laid.known, laid.space, _refined(laid, unit).placing) for laid in tried
               if not laid.placing.mirrored and round(laid.placing.degrees / 90 + _quarter(laid.space)) % 4 == 0]
    best = max((_by_views(*one, framed=True) for one in upright), key=lambda laid: laid.share, default=None)
    if best is None or best.meant < OWN:
        return None
    moved_off = [abs(one.placing(v.box.centre) - v.box.centre) > AWAY for v, one in best.views.items()]
    if sum(moved_off) <= 0.5 * len(moved_off):
        return None
    block = layout.ink([e for e in best.known.elements if not e.view.n])
    ours = best.space.lines.share(best.placing.back(block), HIT / best.placing.scale) > 0.9
    return None if ours and all(abs(one.placing.scale - 1) < SAME for one in best.views.values()) else best


def _by_views(sheet: KnownSheet, space: DrawingSpace, placing: Placing, *, framed: bool = False) -> Registration:
    """A drawing of some size and turn by its views; the share is that of its ink, with the title block if it is ``framed``."""
    laid = space.placed(placing)
    views = list(dict.fromkeys(e.view for e in sheet.elements if e.view.n))
    titles = Titles(sheet.elements, view_search.shaped(sheet.elements), laid)
    found = view_search.Search(sheet.elements, views, laid, laid.lines, {}, titles).found()
    block = {e.view: FoundView(Placing(), 1.0) for e in sheet.elements if framed and not e.view.n}
    return Registration(sheet, space, placing, _explained(sheet, laid, {**found, **block}), found, titles.share)


def _sizes(sheet: KnownSheet, space: DrawingSpace, unit: float | None) -> list[float]:
    """Sizes to try, mm of the sheet per unit of the drawing, the likely one first.

    The declared unit is a hint only: AutoCAD declares inches for drawings in millimetres. The letters tell the size roughly, and
    lines that lie close together are told apart at their own size.
    """
    sizes = {base: _to_size(Registration(sheet, space, Placing(complex(base)), 0.0)).placing.scale
             for base in (unit or 1.0, *UNITS)}
    letters = _letters(Registration(sheet, space, Placing(), 0.0))
    if not letters:
        return list(dict.fromkeys((unit or 1.0, 1.0)))
    high = float(np.median([size for some in letters for size in some]))
    plain = sorted(sizes, key=lambda base: abs(np.log(sizes[base] / base)))
    near = [sizes[base] for base in plain if abs(np.log(sizes[base] / high)) < np.log(ROUGHLY)] or [sizes[unit or 1.0]]
    return [s for k, s in enumerate(near) if all(abs(s / other - 1) > 1e-3 for other in near[:k])]


def _handy(laid: Registration) -> float:
    """Share of the plans found, by their lines, that have a scale factor somebody takes: in a wrong unit few have."""
    plans = Counter(e.view for e in laid.known.elements if e.view.mu is not None and e.view in laid.views)
    return sum(n for v, n in plans.items() if view_search.handy(laid.views[v].placing)) / plans.total() if plans else 1.0


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


def _quarter(space: DrawingSpace) -> int:
    """By how many quarter turns the lettering is turned, counter-clockwise."""
    turns = Counter(round(w.angle / (np.pi / 2)) % 4 for w in space.writings)
    return turns.most_common(1)[0][0] if turns else 0


def _explained(sheet: KnownSheet, space: DrawingSpace, found: Mapping[ElementView, FoundView]) -> float:
    """Share of the drawing's ink, without the frame, that is that of the views."""
    ours = [moved(e, found[e.view].placing) for e in sheet.elements if e.view in found and e.kind not in ("text", "fill")]
    theirs = space.lines
    edge = theirs.length > 0.4 * max(SIDES)
    z = theirs.only(~edge).points(2.0) if not edge.all() else theirs.points(2.0)
    return lines([p for e in ours for p in (e.pieces or (e.points,))]).share(z, 2.0) if ours else 0.0


def _to_size(laid: Registration) -> Registration:
    """The same at the size at which its letters are as high as ours: symbols are as large in every scale of a view."""
    votes: Counter[float] = Counter()
    for sizes in _letters(laid):
        votes.update({min(SIZES, key=lambda r: abs(np.log(laid.placing.scale * r / one))) for one in sizes})
    if not votes:
        return laid
    times = max(votes, key=lambda r: (votes[r], -SIZES.index(r)))
    views = {v: replace(one, placing=Placing(one.placing.turn * times, one.placing.shift * times))
             for v, one in laid.views.items()}
    return replace(laid, placing=Placing(laid.placing.turn * times), views=views)


def _letters(laid: Registration) -> list[list[float]]:
    """For each text that is on the sheet, too, mm of the sheet per unit of the drawing: a number may be of several heights."""
    high: dict[str, set[float]] = {}
    for e in laid.known.elements:
        if e.kind == "text" and (e.view in laid.views or not laid.views):
            high.setdefault(meant(e.text), set()).add(e.height)
    found = ([h / w.height for h in high.get(meant(w.text), ())] for w in laid.space.writings if w.height > 0)
    return [sizes for sizes in found if sizes]


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
