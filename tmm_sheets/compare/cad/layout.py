"""Where the views of our sheet are in a drawing of it: in their places, shifted, or where a file says."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tmm_sheets.compare.cad.cad_ink import DrawingSpace
from tmm_sheets.compare.cad.cad_text import meant
from tmm_sheets.compare.cad.line_fit import lines, refine
from tmm_sheets.compare.elements import Element, ElementView
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


def ink(elements: Sequence[Element]) -> Points:
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
        every = {v: ink([e for e in elements if e.view == v]) for v in self.views}
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
