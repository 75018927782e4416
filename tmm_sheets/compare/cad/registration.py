"""Laying a drawing over the sheet it shows, and its views: which sheet, which space of the file, where each view stands."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tmm_sheets.compare.cad.cad_ink import CadInk, DrawingSpace
from tmm_sheets.compare.cad.cad_lettering import meant
from tmm_sheets.compare.cad.line_fit import (
    DOUBTLESS,
    ONE_PLACE,
    RATIOS,
    KnownLines,
    lay,
    lines,
    longest,
    refine,
    snapped,
)
from tmm_sheets.compare.elements import Element, ElementView, KnownSheet, grouped
from tmm_sheets.compare.placing import Placing, StatedViewPlace
from tmm_sheets.drawing.marks import Points
from tmm_sheets.numbers import decimal, told
from tmm_sheets.words import marked, tell

MOST = 800
"""Most points of a view that are compared."""
WRONG = 0.3
"""Least share of a view that must be found at a place from a file, else the place is wrong."""
ENOUGH = 30
"""Least points of a view that can be placed by its lines alone."""

@dataclass(frozen=True)
class Layout:
    """Where the views are.

    Attributes
    ----------
    moves : for views that are elsewhere, how to take them from our sheet to their places in the drawing laid over it
    share : share of the lines of each view that was found, 0 .. 1
    notes : where they are, in words, of those that a file gives or that were found where they were not expected
    """

    moves: Mapping[ElementView, Placing]
    share: Mapping[ElementView, float]
    notes: tuple[str, ...]


def line_points(elements: Sequence[Element]) -> Points:
    """Points every millimetre along lines, circles, curves."""
    return _lines(elements).points(1.0)


def find(elements: Sequence[Element], space: DrawingSpace, given: Sequence[tuple[StatedViewPlace, Placing]] = ()) -> Layout:
    """Place every view of a sheet: in its place, a little aside, or where its texts are in the drawing.

    Parameters
    ----------
    elements : those of the sheet
    space : the drawing, laid on the sheet as a whole, mm
    given : places from a file, each with the placing of the whole drawing; they are refined, not sought

    Raises
    ------
    BadInput
        If a place gives a scale factor for a view that has none of its own on the sheet.
    """
    words = {text: [w.at for w in some] for text, some in grouped(space.writings, lambda w: meant(w.text)).items()}
    views = {v: _SoughtView(v, [e for e in elements if e.view == v], space.lines, words)
             for v in dict.fromkeys(e.view for e in elements)}
    moves: dict[ElementView, Placing] = {}
    notes = []
    for place, whole in given:
        v = place.view
        move, there = views[v].stated(place, whole)
        if there:
            moves[v] = move
            notes.append(tell('"{view}" stands {place}, as --views says').format(view=v.name, place=_place_in_words(v, move)))
        else:
            told_not = tell('"{view}" is not where --views says: {share} % of its lines are there; it was looked for')
            notes.append(told_not.format(view=v.name, share=round(100 * views[v].inked(move))))
    for v, view in views.items():
        if v.n and v not in moves and (found := view.elsewhere()) is not None:
            moves[v] = found
            notes.append(tell('"{view}" stands {place}; compared there').format(view=v.name, place=_place_in_words(v, found)))
    share = {v: view.inked(moves.get(v, Placing())) for v, view in views.items()}
    return Layout(moves, share, tuple(notes))


class _SoughtView:
    """A view of the sheet that is looked for in a drawing: points along its lines, and its texts."""

    def __init__(self, view: ElementView, elements: Sequence[Element], theirs: KnownLines,
                 words: Mapping[str, list[complex]]) -> None:
        every = line_points(elements)
        self.view, self.theirs, self.points = view, theirs, every[:: max(len(every) // MOST, 1)]
        self.texts = [(words.get(meant(e.text), []), complex(e.points.mean())) for e in elements if e.kind == "text"]

    def inked(self, move: Placing) -> float:
        """Share of its points that have ink."""
        return self.theirs.share(move(self.points), ONE_PLACE)

    def _read(self, move: Placing) -> float:
        """Share of its texts that are where they should be."""
        near = sum(any(abs(at - complex(move(z))) < 8.0 for at in there) for there, z in self.texts)
        return near / len(self.texts) if self.texts else 0.0

    def _score(self, move: Placing) -> float:
        return self.inked(move) + 0.5 * self._read(move)

    def stated(self, place: StatedViewPlace, whole: Placing) -> tuple[Placing, bool]:
        """The place a file gives, refined, and whether the view is there."""
        move = place.placing([complex(whole(z)) for z in place.theirs])
        if len(self.points) < ENOUGH:
            return move, True
        near = refine(self.points, self.theirs, move.inverse(), (4.0, 2.0, 1.0, 0.5, 0.25), place.mu is None)
        move = max(move, near.placing.inverse(), key=self.inked)
        return move, self.inked(move) >= WRONG

    def elsewhere(self) -> Placing | None:
        """A place near its own, or where its texts are, that is clearly better than its own; None without."""
        if self.inked(Placing()) > 0.93:
            return None
        trials = [Placing(shift=d) for d in self._by_texts()]
        if len(self.points) >= ENOUGH:
            reaches = (6.0, 3.0, 1.5, 0.8, 0.4, 0.25)
            trials = [refine(self.points, self.theirs, start.inverse(), reaches, False, 1).placing.inverse()
                      for start in (Placing(), *trials)]
        best = max(trials, key=self._score, default=Placing())
        inked, read = self.inked(best), self._read(best)
        sure = inked > 0.85 or (inked > 0.5 and read > 0.3) or (len(self.points) < ENOUGH and read > 0.5)
        still = abs(complex(best(self.view.box.centre)) - self.view.box.centre) < 0.1
        return best if sure and not still and self._score(best) >= self._score(Placing()) + 0.12 else None

    def _by_texts(self) -> list[complex]:
        """The shift most of its texts agree on, nothing if few do."""
        shifts = np.array([at - z for there, z in self.texts for at in there], dtype=complex)
        if len(shifts) < 2:
            return []
        votes = (np.abs(shifts[:, None] - shifts[None, :]) < 3.0).sum(axis=1)
        k = int(votes.argmax())
        if votes[k] < max(2, 0.25 * len(self.texts)):
            return []
        near = shifts[np.abs(shifts - shifts[k]) < 3.0]
        return [complex(np.median(near.real), np.median(near.imag))]


def _place_in_words(view: ElementView, move: Placing) -> str:
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


SURE = 0.5
"""Share of our lines found above which a placing is beyond doubt."""
PART = 100.0
"""Width plus height of the smallest part of a sheet that is looked for, mm."""
LONGEST = 40
"""Longest lines of a drawing on which ours are laid."""

@dataclass(frozen=True)
class Registration:
    """A drawing laid over a known sheet: ``space`` by ``placing``, with ``share`` of the sheet's lines found in it."""

    known: KnownSheet
    space: DrawingSpace
    placing: Placing
    share: float


def register(known: Sequence[KnownSheet], ink: CadInk) -> Registration:
    """Lay a drawing over the sheet it fits best, turned in any way: by its frame, else by any lines, mirrored, or by one view."""
    tried = [*_by_lines(known, ink, mirrored=False)]
    if _best(tried).share < SURE:
        tried += _by_lines(known, ink, mirrored=True)
    if _best(tried).share < SURE:
        tried += _by_parts(known, ink)
    return _refined(_best(tried), ink.unit)


def fitting(known: Sequence[KnownSheet], ink: CadInk) -> tuple[int, float]:
    """The sheet a drawing seems to be of, and the share of its lines found at a quick look."""
    best = _best([*_by_lines(known, ink, mirrored=False)])
    return best.known.n, best.share


def _by_lines(known: Sequence[KnownSheet], ink: CadInk, *, mirrored: bool) -> Iterator[Registration]:
    """The best placing of each space on each sheet: by the lines of its frame, or those of its views."""
    for sheet in known:
        frame, views = (longest(_lines(e for e in sheet.elements if bool(e.view.n) == of_views), 12) for of_views in (False, True))
        points = line_points(sheet.elements)
        for space in ink.spaces:
            long = longest(space.lines, LONGEST)
            found = max((lay(some, points, long, space.lines, mirrored) for some in (frame, views)), key=lambda f: f.share)
            yield Registration(sheet, space, found.placing, found.share)
            if found.share >= DOUBTLESS:
                return


def _by_parts(known: Iterable[KnownSheet], ink: CadInk) -> Iterator[Registration]:
    """Placings of a drawing of a few views only: those that put most of its own lines on ours."""
    for sheet in known:
        views = dict.fromkeys(e.view for e in sheet.elements if e.view.n)
        of_views = [_lines(e for e in sheet.elements if e.view == view) for view in views]
        ours, long = (KnownLines(*(np.concatenate(x) for x in zip(*((of.a, of.b, of.owner) for of in some), strict=True)))
                      for some in (of_views, [longest(of, 6) for of in of_views]))
        for space in ink.spaces:
            for size in dict.fromkeys(base * ratio for base in (ink.unit or 1.0, 1.0) for ratio in RATIOS):
                scale = Placing(complex(size))
                theirs = space.lines.moved(scale)
                z = theirs.points(max(float(theirs.length.sum()) / 3000, 1.0))
                if len(z) < 30 or np.ptp(z.real) + np.ptp(z.imag) < PART:
                    continue
                trial = lay(longest(theirs, 12), z, long, ours, to_scale=True)
                if trial.share >= SURE:
                    yield Registration(sheet, space, trial.placing.inverse().after(scale), trial.share)


def _lines(some: Iterable[Element]) -> KnownLines:
    """What a draughtsman cannot omit or draw in another way."""
    return lines([e.points for e in some if e.kind not in ("text", "hatch", "fill")])


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
    """The placing refined on all lines; with few of them there, by its shift only."""
    z = line_points(laid.known.elements)
    z = z[:: max(len(z) // 1500, 1)]
    theirs = laid.space.lines
    return replace(laid, placing=snapped(z, theirs, refine(z, theirs, laid.placing, free=laid.share >= SURE).placing, unit))


DRAWN_AT = {2.0: "1:2", 2.5: "1:2.5", 4.0: "1:4", 5.0: "1:5", 10.0: "1:10", 0.5: "2:1", 0.4: "2.5:1", 0.25: "4:1", 0.2: "5:1"}
"""Scales of GOST 2.302 by mm of the sheet per mm drawn."""
UNIT_NAMES = {1000.0: marked("metres"), 25.4: marked("inches"), 10.0: marked("centimetres"), 1.0: marked("millimetres")}
"""Units by mm."""


def laying_told(laid: Registration, unit: float | None) -> Iterator[str]:
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
