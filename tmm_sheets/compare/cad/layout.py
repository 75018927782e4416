"""Where the views of a sheet stand in a drawing that has a layout of its own: each is placed, and sized, for itself."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tmm_sheets.compare.cad.cad_ink import Writing
from tmm_sheets.compare.cad.cad_text import meant
from tmm_sheets.compare.cad.placing import Lines, Placing, lines, refine, search
from tmm_sheets.compare.elements import Element, View
from tmm_sheets.compare.view_places import ViewPlace, mu_of
from tmm_sheets.construction.scale import HANDY
from tmm_sheets.drawing.marks import Points
from tmm_sheets.errors import BadInput
from tmm_sheets.numbers import decimal

MOST = 800
"""Points of a view that are looked at."""
MOST_STEP = 6.0
"""About how far apart they are at most, mm."""
NEAR = 0.3
"""A point of ours this near to ink, mm, counts as found."""
WRONG = 0.3
"""A place from a file at which less than this of a view is found is wrong."""
SCALES = tuple(sorted({a / b * 10.0**k for a in HANDY for b in HANDY for k in (-1, 0, 1) if 0.15 < a / b * 10.0**k < 7},
                      key=lambda r: abs(np.log(r))))
"""Ratios of handy scale factors: how much larger or smaller a student may have drawn a view."""


@dataclass(frozen=True)
class Layout:
    """``moves`` takes each view that stands elsewhere from our sheet to its place in the drawing laid over it; ``share`` is what is
    found of each view, 0 .. 1.
    """

    moves: Mapping[View, Placing]
    share: Mapping[View, float]
    notes: tuple[str, ...]


def ink(elements: Sequence[Element]) -> Points:
    """Places every millimetre along what a drawer cannot leave out or do in another way: lines, circles, curves."""
    return lines([e.points for e in elements if e.kind not in ("text", "hatch", "fill")]).points(1.0)


def find(elements: Sequence[Element], theirs: Lines, writings: Sequence[Writing] = (),
         given: Sequence[tuple[ViewPlace, Placing]] = (), say: Callable[[str], None] = lambda _: None) -> Layout:
    """Place every view of a sheet.

    A view may be in its place, a little aside, where its texts stand in the drawing, or anywhere in the ink the others leave.

    Parameters
    ----------
    elements : of the sheet
    theirs, writings : lines and texts of the drawing, laid on the sheet as a whole, mm
    given : places from a file, each with the placing of the whole drawing (drawing to sheet); they are refined, not searched
    say : told what is being done
    """
    return _Finder(elements, theirs, writings, say).layout(given)


class _Finder:
    """The views of a sheet with what has been found of them."""

    def __init__(self, elements: Sequence[Element], theirs: Lines, writings: Sequence[Writing], say: Callable[[str], None]) -> None:
        self.elements, self.theirs, self.say = elements, theirs, say
        self.views = list(dict.fromkeys(e.view for e in elements))
        every = {v: ink([e for e in elements if e.view == v]) for v in self.views}
        self.points = {v: z[:: max(len(z) // MOST, 1)] for v, z in every.items()}
        self.texts = {v: [(meant(e.text), complex(e.points.mean())) for e in elements if e.view == v and e.kind == "text"]
                      for v in self.views}
        self.words: dict[str, list[complex]] = {}
        for w in writings:
            self.words.setdefault(meant(w.text), []).append(w.at)
        self.moves: dict[View, Placing] = {}
        self.share: dict[View, float] = {}
        self.notes: list[str] = []

    def layout(self, given: Sequence[tuple[ViewPlace, Placing]]) -> Layout:
        """Every view in turn, those that are nowhere near last."""
        for place, whole in given:
            v = place.view
            move = _given(place, whole, self.elements, self.theirs, self.points[v])
            share = self._inked(v, move)
            if share < WRONG and len(self.points[v]) >= 30:
                self.notes.append(f'"{v.name}" is not where --views says: {share:.0%} of its lines are there; it was looked for')
                continue
            self.moves[v], self.share[v] = move, share
            self.notes.append(f"{_where(v, self.moves[v])}, as --views says")
        lost = []
        for v in self.views:
            if v in self.moves:
                continue
            self.share[v] = self._inked(v, Placing())
            if v.n == 0 or self.share[v] > 0.93:
                continue
            starts = [Placing(shift=d) for d in (0j, *self._by_texts(v))]
            trials = [self._nudged(v, s) for s in starts] if len(self.points[v]) >= 30 else starts[1:]
            if not self._accept(v, trials) and self.share[v] < 0.6 and len(self.points[v]) >= 60:
                lost.append(v)
        self._search(lost)
        return Layout(self.moves, self.share, tuple(self.notes))

    def _accept(self, v: View, trials: Sequence[Placing], anywhere: bool = False) -> bool:
        """Take the best of several places when it is clearly better than its own; ``anywhere`` else its words must be there too."""
        if not trials:
            return False
        before = self._score(v, Placing())
        best = max(trials, key=lambda m: self._score(v, m))
        inked, read = self._inked(v, best), self._read(v, best)
        sure = inked > 0.85 or (inked > 0.5 and read > 0.3) or (len(self.points[v]) < 30 and read > 0.5)
        if anywhere and self.words and self.texts[v] and read < 0.2:
            return False
        still = abs(complex(best(v.box.centre)) - v.box.centre) < 0.1 and abs(best.scale - 1) < 1e-3
        if not sure or still or self._score(v, best) < before + 0.12:
            return False
        self.moves[v], self.share[v] = best, inked
        self.notes.append(f"{_where(v, best)}; compared there")
        return True

    def _inked(self, v: View, move: Placing) -> float:
        return _share(self.points[v], self.theirs, move)

    def _read(self, v: View, move: Placing) -> float:
        """Share of a view's texts that stand where they should."""
        texts = self.texts[v]
        near = sum(any(abs(at - complex(move(z))) < 8.0 for at in self.words.get(word, ())) for word, z in texts)
        return near / len(texts) if texts else 0.0

    def _score(self, v: View, move: Placing) -> float:
        return self._inked(v, move) + 0.5 * self._read(v, move)

    def _by_texts(self, v: View) -> list[complex]:
        """The shift most texts of a view agree on, when several do."""
        shifts = np.array([at - z for word, z in self.texts[v] for at in self.words.get(word, ())], dtype=complex)
        if len(shifts) < 2:
            return []
        votes = (np.abs(shifts[:, None] - shifts[None, :]) < 3.0).sum(axis=1)
        k = int(votes.argmax())
        if votes[k] < max(2, 0.25 * len(self.texts[v])):
            return []
        return [complex(np.median(near.real), np.median(near.imag)) for near in [shifts[np.abs(shifts - shifts[k]) < 3.0]]]

    def _nudged(self, v: View, start: Placing) -> Placing:
        """A move made better on the lines, without changing its size."""
        return refine(self.points[v], self.theirs, start.inverse(), (6.0, 3.0, 1.5, 0.8, 0.4, 0.25), False, 1).placing.inverse()

    def _search(self, lost: Sequence[View]) -> None:
        """Look for views anywhere in what the others leave, the larger ones first."""
        if not lost:
            return
        free = self.theirs
        for v, s in self.share.items():
            if s >= 0.6:
                free = _unused(free, self.moves.get(v, Placing())(self.points[v]))
        for v in sorted(lost, key=lambda v: -len(self.points[v])):
            if len(free.a) < 4:
                return
            self.say(f'looking for view "{v.name}"')
            found = search(self.points[v], free, [1 / r for r in SCALES], (0,), enough=0.95, tries=6)
            back = found.placing.inverse()
            scale = min(SCALES, key=lambda r: abs(back.scale / r - 1))
            middle = complex(self.points[v].mean())
            start = Placing(complex(scale), complex(back(middle)) - scale * middle).inverse()
            nudged = refine(self.points[v], free, start, (3.0, 1.5, 0.8, 0.4, 0.25), False, 1).placing
            if self._accept(v, [nudged.inverse()], True):
                free = _unused(free, self.moves[v](self.points[v]))


def _unused(theirs: Lines, known: Points) -> Lines:
    """Their lines without those on which the points of a placed view lie."""
    import shapely

    if not len(theirs.a) or not len(known):
        return theirs
    _, j = theirs.tree.query(shapely.points(known.real, known.imag), predicate="dwithin", distance=NEAR)
    keep = np.ones(len(theirs.a), bool)
    hits = np.bincount(j, minlength=len(keep))
    keep[hits * MOST_STEP >= 0.5 * theirs.length] = False
    keep[hits == 0] = True
    return theirs.only(keep)


def _share(points: Points, theirs: Lines, move: Placing) -> float:
    return theirs.share(move(points), NEAR)


def _given(place: ViewPlace, whole: Placing, elements: Sequence[Element], theirs: Lines, points: Points) -> Placing:
    """The move two points (or one and a scale factor) ask for, refined where the ink allows it."""
    at = [complex(whole(z)) for z in place.theirs]
    turn = (at[1] - at[0]) / (place.ours[1] - place.ours[0]) if len(at) == 2 else 1 + 0j
    if place.mu is not None:
        mu = mu_of(place.view, elements)
        if mu is None:
            raise BadInput(f'view "{place.view.name}": our sheet gives it no scale factor of its own to compare mu with',
                           "leave mu out and give two points")
        turn = turn / abs(turn) * mu / place.mu
    move = Placing(turn, at[0] - turn * place.ours[0])
    if len(points) < 30:
        return move
    near = refine(points, theirs, move.inverse(), (4.0, 2.0, 1.0, 0.5, 0.25), place.mu is None)
    better = near.placing.inverse()
    return better if _share(points, theirs, better) > _share(points, theirs, move) else move


def _where(view: View, move: Placing) -> str:
    """How a view stands against our sheet, in words."""
    c = view.box.centre
    shift = complex(move(c)) - c
    said = [f"{abs(part):.1f} mm {words[part < 0]}" for part, words in ((shift.real, ("to the right", "to the left")),
                                                                      (shift.imag, ("higher", "lower"))) if abs(part) >= 0.05]
    if abs(move.scale - 1) > 1e-3:
        said.append(f"{move.scale:.4g} times as large")
    if abs(move.degrees) > 0.05:
        said.append(f"turned {decimal(move.degrees, sign=True)}°")
    return f'"{view.name}" stands {", ".join(said) or "in its place"}'
