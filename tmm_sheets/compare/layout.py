"""Where the views of a sheet stand in a drawing that has a layout of its own: each is placed, and sized, for itself."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tmm_sheets.compare.elements import Element, View
from tmm_sheets.compare.overlaps import left, overlaps, pieces
from tmm_sheets.compare.placing import Lines, Placing, lines, refine, search
from tmm_sheets.compare.view_places import ViewPlace, mu_of
from tmm_sheets.construction.scale import HANDY
from tmm_sheets.drawing.marks import Points
from tmm_sheets.errors import BadInput

NEAR = 0.3
"""A point of ours this near to ink, mm, counts as found."""
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


def find(elements: Sequence[Element], theirs: Lines, given: Sequence[tuple[ViewPlace, Placing]] = (),
         elsewhere: bool = True) -> Layout:
    """Place every view of a sheet.

    Parameters
    ----------
    elements : of the sheet
    theirs : lines of the drawing, laid on the sheet as a whole, mm
    given : places from a file, each with the placing of the whole drawing (drawing to sheet); they are refined, not searched
    elsewhere : whether a view may stand anywhere else; if not, near its place only
    """
    views = list(dict.fromkeys(e.view for e in elements))
    points = {v: ink([e for e in elements if e.view == v]) for v in views}
    moves: dict[View, Placing] = {}
    share: dict[View, float] = {}
    notes: list[str] = []
    for place, whole in given:
        moves[place.view] = _given(place, whole, elements, theirs, points[place.view])
        share[place.view] = _share(points[place.view], theirs, moves[place.view])
        notes.append(f"{_where(place.view, moves[place.view])}, as --views says")
    lost: list[View] = []
    for v in views:
        if v in moves:
            continue
        share[v] = _share(points[v], theirs, Placing())
        if v.n == 0 or len(points[v]) < 30 or share[v] > 0.9:
            continue
        near = refine(points[v], theirs, Placing(), (6.0, 3.0, 1.5, 0.8, 0.4, 0.25), False)
        back = _inverse(near.placing)
        better = _share(points[v], theirs, back)
        if better > max(share[v] + 0.15, 0.5) and abs(near.placing.shift) > 0.1:
            moves[v], share[v] = back, better
            notes.append(f"{_where(v, back)}; compared there")
        elif share[v] < 0.6:
            lost.append(v)
    if elsewhere and lost:
        _search(lost, points, theirs, moves, share, notes)
    return Layout(moves, share, tuple(notes))


def _search(lost: Sequence[View], points: Mapping[View, Points], theirs: Lines, moves: dict[View, Placing],
            share: dict[View, float], notes: list[str]) -> None:
    """Look for views anywhere in what the others leave, the larger ones first."""
    good = [(v, moves.get(v, Placing())) for v, s in share.items() if s >= 0.6]
    for v in sorted(lost, key=lambda v: -len(points[v])):
        known = [m(points[g]) for g, m in good]
        free = _unused(theirs, known)
        if len(free.a) < 4 or len(points[v]) < 60:
            continue
        found = search(points[v], free, [1 / r for r in SCALES], (0,), enough=0.92, tries=6)
        if found.share < 0.6:
            continue
        near = refine(points[v], free, found.placing, (3.0, 1.5, 0.8, 0.4, 0.25))
        back = _inverse(near.placing)
        for r in SCALES:
            if abs(back.scale / r - 1) < 2e-3:
                middle = complex(points[v].mean())
                start = _inverse(Placing(complex(r), complex(back(middle)) - r * middle))
                back = _inverse(refine(points[v], free, start, (1.0, 0.5, 0.25, 0.15), False).placing)
        better = _share(points[v], theirs, back)
        if better > max(share[v] + 0.2, 0.55):
            moves[v], share[v] = back, better
            good.append((v, back))
            notes.append(f"{_where(v, back)}; compared there")


def _unused(theirs: Lines, known: Sequence[Points]) -> Lines:
    """Their lines without those on which points of placed views lie."""
    if not known:
        return theirs
    z = np.concatenate(known)
    # Short strokes through the points stand for what is known.
    cross = lines([p for d in (0.6, 0.6j, 0.42 + 0.42j, 0.42 - 0.42j) for p in np.stack((z - d, z + d), axis=1)])
    return pieces(theirs, left(theirs, overlaps(cross, theirs, 0.3, 0.5, 0.5), 1.0))


def _share(points: Points, theirs: Lines, move: Placing) -> float:
    return theirs.share(move(points), NEAR)


def _inverse(p: Placing) -> Placing:
    return Placing(1 / p.turn, -p.shift / p.turn)


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
    near = refine(points, theirs, _inverse(move), (4.0, 2.0, 1.0, 0.5, 0.25), place.mu is None)
    better = _inverse(near.placing)
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
        said.append(f"turned {move.degrees:+.2f}°")
    return f'"{view.name}" stands {", ".join(said) or "in its place"}'
