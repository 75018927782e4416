"""Laying a drawing over the sheet it shows, and its views: which sheet, which space of the file, where each view stands."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.cad.cad_ink import CadInk, DrawingSpace
from tmm_sheets.compare.cad.cad_lettering import meant
from tmm_sheets.compare.cad.line_fit import HIT, RATIOS, KnownLines, candidates, lines, refine, search, snapped
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.known_sheet import KnownSheet
from tmm_sheets.compare.placing import Placing
from tmm_sheets.compare.view_places import StatedViewPlace
from tmm_sheets.drawing.marks import Points
from tmm_sheets.numbers import decimal, told
from tmm_sheets.words import tell

MOST = 800
"""Most points of a view that are compared."""
NEAR = 0.3
"""Distance from ink within which a point of ours counts as found, mm."""
WRONG = 0.3
"""Least share of a view that must be found at a place from a file, else the place is wrong."""
ENOUGH = 30
"""Least points of a view that can be placed by its lines alone."""
AT_HOME = 0.6
"""Share of a view from which on it is where it is."""


@dataclass(frozen=True)
class Layout:
    """Where the views are.

    Attributes
    ----------
    moves : for views that are elsewhere, how to take them from our sheet to their places in the drawing laid over it
    share : share of the lines of each view that was found, 0 .. 1
    said : what is told of the places that a file gives
    elsewhere : views that were found where they were not expected
    """

    moves: Mapping[ElementView, Placing]
    share: Mapping[ElementView, float]
    said: tuple[str, ...]
    elsewhere: tuple[ElementView, ...]

    @property
    def notes(self) -> tuple[str, ...]:
        """Where the views are, in words."""
        there = tell('"{view}" stands {place}; compared there')
        return (*self.said, *(there.format(view=v.name, place=_where(v, self.moves[v])) for v in self.elsewhere))


def line_points(elements: Sequence[Element]) -> Points:
    """Points every millimetre along what a draughtsman cannot omit or draw in another way: lines, circles, curves."""
    return lines([e.points for e in elements if e.kind not in ("text", "hatch", "fill")]).points(1.0)


def find(elements: Sequence[Element], space: DrawingSpace, given: Sequence[tuple[StatedViewPlace, Placing]] = (),
         say: Callable[[str], None] = lambda _: None) -> Layout:
    """Place every view of a sheet.

    A view may be in its place, a little aside, where its texts are in the drawing, or anywhere in ink the other views leave.

    Parameters
    ----------
    elements : those of the sheet
    space : the drawing, laid on the sheet as a whole, mm
    given : places from a file, each with the placing of the whole drawing; they are refined, not sought
    say : told what is being done

    Raises
    ------
    BadInput
        If a place gives a scale factor for a view that has none of its own on the sheet.
    """
    return _ViewFinder(elements, space, say).layout(given)


class _ViewFinder:
    """The views of a sheet, and the places found for them so far."""

    def __init__(self, elements: Sequence[Element], space: DrawingSpace, say: Callable[[str], None]) -> None:
        self.elements, self.space, self.theirs, self.say = elements, space, space.lines, say
        self.views = list(dict.fromkeys(e.view for e in elements))
        every = {v: line_points([e for e in elements if e.view == v]) for v in self.views}
        self.points = {v: z[:: max(len(z) // MOST, 1)] for v, z in every.items()}
        self.texts = {v: [(meant(e.text), complex(e.points.mean())) for e in elements if e.view == v and e.kind == "text"]
                      for v in self.views}
        self.words: dict[str, list[complex]] = {}
        for w in space.writings:
            self.words.setdefault(meant(w.text), []).append(w.at)
        self.moves: dict[ElementView, Placing] = {}
        self.share: dict[ElementView, float] = {}
        self.notes: list[str] = []
        self.elsewhere: list[ElementView] = []

    def layout(self, given: Sequence[tuple[StatedViewPlace, Placing]]) -> Layout:
        """Place the views from the file, then the others near their places or their texts."""
        for place, whole in given:
            self._place_given(place, whole)
        for v in self.views:
            if v not in self.moves:
                self._place_near(v)
        return Layout(self.moves, self.share, tuple(self.notes), tuple(self.elsewhere))

    def _place_given(self, place: StatedViewPlace, whole: Placing) -> None:
        v = place.view
        move = place.placing([complex(whole(z)) for z in place.theirs])
        if len(self.points[v]) >= ENOUGH:
            near = refine(self.points[v], self.theirs, move.inverse(), (4.0, 2.0, 1.0, 0.5, 0.25), place.mu is None)
            move = max(move, near.placing.inverse(), key=lambda m: self._inked(v, m))
        share = self._inked(v, move)
        if share < WRONG and len(self.points[v]) >= ENOUGH:
            said = tell('"{view}" is not where --views says: {share} % of its lines are there; it was looked for')
            self.notes.append(said.format(view=v.name, share=round(100 * share)))
        else:
            self.moves[v], self.share[v] = move, share
            self.notes.append(tell('"{view}" stands {place}, as --views says').format(view=v.name, place=_where(v, move)))

    def _place_near(self, v: ElementView) -> bool:
        """Place a view near its place or where its texts are; False if it must be sought elsewhere and is large enough for that."""
        self.share[v] = self._inked(v, Placing())
        if v.n == 0 or self.share[v] > 0.93:
            return True
        starts = [Placing(shift=d) for d in (0j, *self._by_texts(v))]
        trials = [self._nudged(v, s) for s in starts] if len(self.points[v]) >= ENOUGH else starts[1:]
        return self._accept(v, trials) or self.share[v] >= AT_HOME or len(self.points[v]) < 2 * ENOUGH

    def _accept(self, v: ElementView, trials: Sequence[Placing]) -> bool:
        """Take the best of several places if it is clearly better than the view's own."""
        if not trials:
            return False
        best = max(trials, key=lambda m: self._score(v, m))
        inked, read = self._inked(v, best), self._read(v, best)
        sure = inked > 0.85 or (inked > 0.5 and read > 0.3) or (len(self.points[v]) < ENOUGH and read > 0.5)
        still = abs(complex(best(v.box.centre)) - v.box.centre) < 0.1 and abs(best.scale - 1) < 1e-3
        if not sure or still or self._score(v, best) < self._score(v, Placing()) + 0.12:
            return False
        self._take(v, best, inked)
        return True

    def _take(self, v: ElementView, best: Placing, inked: float) -> None:
        """Take a place that is not the view's own."""
        self.moves[v], self.share[v] = best, inked
        self.elsewhere.append(v)

    def _inked(self, v: ElementView, move: Placing) -> float:
        """Share of a view's points that have ink."""
        return self.theirs.share(move(self.points[v]), NEAR)

    def _read(self, v: ElementView, move: Placing) -> float:
        """Share of a view's texts that are where they should be."""
        texts = self.texts[v]
        near = sum(any(abs(at - complex(move(z))) < 8.0 for at in self.words.get(word, ())) for word, z in texts)
        return near / len(texts) if texts else 0.0

    def _score(self, v: ElementView, move: Placing) -> float:
        return self._inked(v, move) + 0.5 * self._read(v, move)

    def _by_texts(self, v: ElementView) -> list[complex]:
        """The shift most texts of a view agree on, nothing if few do."""
        shifts = np.array([at - z for word, z in self.texts[v] for at in self.words.get(word, ())], dtype=complex)
        if len(shifts) < 2:
            return []
        votes = (np.abs(shifts[:, None] - shifts[None, :]) < 3.0).sum(axis=1)
        k = int(votes.argmax())
        if votes[k] < max(2, 0.25 * len(self.texts[v])):
            return []
        near = shifts[np.abs(shifts - shifts[k]) < 3.0]
        return [complex(np.median(near.real), np.median(near.imag))]

    def _nudged(self, v: ElementView, start: Placing) -> Placing:
        """A move refined on the lines, without turn or scale."""
        return refine(self.points[v], self.theirs, start.inverse(), (6.0, 3.0, 1.5, 0.8, 0.4, 0.25), False, 1).placing.inverse()


def _where(view: ElementView, move: Placing) -> str:
    """Where a view is, compared with our sheet, in words."""
    c = view.box.centre
    shift = complex(move(c)) - c
    ways = ((shift.real, tell("{by} mm to the right"), tell("{by} mm to the left")),
            (shift.imag, tell("{by} mm higher"), tell("{by} mm lower")))
    said = [(less if part < 0 else more).format(by=told(f"{abs(part):.1f}")) for part, more, less in ways if abs(part) >= 0.05]
    if abs(move.scale - 1) > 1e-3:
        said.append(tell("{times} times as large").format(times=told(f"{move.scale:.4g}")))
    if abs(move.degrees) > 0.05:
        said.append(tell("turned {degrees}°").format(degrees=told(decimal(move.degrees, sign=True))))
    return ", ".join(said) or tell("in its place")


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
    drawn = [line_points(sheet.elements) for sheet in known]
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
    drawn = [line_points(sheet.elements) for sheet in known]
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
    theirs, z, free = laid.space.lines, line_points(laid.known.elements), True
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
