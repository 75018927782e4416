"""Whether an arrow has its head, or has it at its other end.

A head is wider than its line: near the tip there is more ink across the line than along its middle, or as much when there is no
head. Where others are drawn beside the line, letters may stand or the sheet is hidden, nothing can be told.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.photo.hidden import Mask, at
from tmm_sheets.compare.photo.ink_owner import Owners
from tmm_sheets.compare.photo.profiles import pixels, sample
from tmm_sheets.compare.photo.sheet_map import Floats
from tmm_sheets.compare.photo.traces import Head, Trace
from tmm_sheets.drawing.styles import line_type

LEAST = 2.4
"""mm; shorter heads are not looked for."""
BACK = np.arange(1.2, 5.0, 0.2)
"""mm from the tip backwards at which ink is measured; nearer to it a point is drawn as a dot."""
SHAFT = 1.0
"""mm behind a head, and from the other end, beyond which a line has no head any more."""
SHORTEST = 4.0
"""mm of a vector behind its head by which the line's own ink is known."""
ASIDE = np.arange(0.0, 1.4, 0.15)
"""mm to either side at which it is sampled; ink counts up to :data:`WIDEST`."""
WIDEST = 1.1
FULL = 0.9
"""Share of the darkness of a line's middle up to which it is full; of a blurred one hardly anything is."""
BESIDE = 0.22
"""mm from the edge of the line beyond which nothing of others may be: what runs along under it, a helper line, is no matter."""
BARE, INKED = 0.18, 0.4
"""How much a line widens towards its end, as a share of what a head has by the drawing, up to which there is no head, and from
which on there is one for sure. Pencilled and photographed heads have 0.6 in the middle, 99 of 100 more than 0.23."""
SMALLER, SURE = 0.7, 0.7
"""Size of a small head by that of the drawing, and what such a one needs to be one for sure."""
ENOUGH, SOME = 0.6, 6
"""Least part of a head that must be seen for it to be judged; least number of stations for the line's own ink to be known."""


@dataclass(frozen=True)
class _Paper:
    """The rectified picture, who is drawn where, places of lettering (255 there), where the sheet does not show, tips of arrows."""

    ink: Any
    owners: Owners
    words: Any
    hidden: Mask
    tips: Sequence[complex]

    def beside(self, e: Element, start: complex, along: Floats, way: complex, side: int) -> tuple[Floats, Floats]:
        """Ink across one side of a line at places ``along`` mm from ``start``, and how far it is full, mm; nan where others are."""
        places = start + way * (along[:, None] + side * 1j * ASIDE)
        outside = line_type(e.style).width / 2 + BESIDE < ASIDE
        taken = self.owners.others(e.number, places[:, outside]) | (sample(self.words, pixels(places[:, outside])) > 100)
        dark = sample(self.ink, pixels(places))[:, ASIDE < WIDEST].astype(np.float64)
        full = np.logical_and.accumulate(dark > FULL * dark[:, :1], 1).sum(1) * ASIDE[1] - 0.5 * ASIDE[1]
        unknown = taken.any(1) | at(places[:, 0], self.hidden)
        return np.where(unknown, np.nan, dark.sum(1)), np.where(unknown, np.nan, full)

    def accompanied(self, e: Element, start: complex, way: complex) -> bool:
        """Whether another line leaves the same point beside this one, and would be taken for the edge of a head."""
        aside = ASIDE[(line_type(e.style).width / 2 < ASIDE) & (ASIDE < WIDEST)]
        across = 1j * np.concatenate((-aside, aside))
        return bool(self.owners.others(e.number, start + way * (BACK[:, None] + across)).any())

    def widening(self, e: Element, tip: complex, other: complex) -> tuple[Floats, float]:
        """Ink about a line at :data:`BACK` mm from its tip as a multiple of the line's own, nan where others are; its width, mm."""
        length = abs(other - tip)
        way, behind = (other - tip) / length, _length(e) + SHAFT
        shaft = np.linspace(behind, max(length - behind, behind + 0.5 * SHORTEST), 40)
        out, width = [], line_type(e.style).width
        for side in (1, -1):
            own, full = (values[~np.isnan(values)] for values in self.beside(e, tip, shaft, way, side))
            usual = float(np.median(own)) if len(own) >= SOME else 0.0
            out.append(self.beside(e, tip, BACK, way, side)[0] / usual if usual > 0 else np.full(len(BACK), np.nan))
            width = max(width, 2 * float(np.median(full)) if usual > 0 else 0.0)
        one, two = out
        return np.where(np.isnan(one), two, np.where(np.isnan(two), one, (one + two) / 2)), width


def with_heads(traces: Sequence[Trace], ink: Any, owners: Owners, words: Any, hidden: Mask) -> list[Trace]:
    """Look for the heads of arrows.

    Parameters
    ----------
    traces
        All; those of lines that are no vectors, or were not found, are left as they are.
    ink
        The rectified picture.
    owners
        Who is drawn where.
    words
        A picture of the places of lettering, 255 there.
    hidden
        Where the sheet does not show.

    Returns
    -------
    The traces in the same order, with ``head``.
    """
    paper = _Paper(ink, owners, words, hidden, [complex(f[0]) for t in traces for f in t.element.fills])
    return [replace(t, head=_head(t, paper)) if _wanted(t) else t for t in traces]


def _wanted(t: Trace) -> bool:
    """Whether it is a vector that was found, long enough for its head to be told from it."""
    e = t.element
    if t.status not in ("measured", "shared") or t.at is None or e.style != "vector" or e.kind != "line" or len(e.fills) != 1:
        return False
    return bool(_length(e) >= LEAST and e.length > _length(e) + SHORTEST and abs(e.fills[0][0] - e.points[-1]) < 0.1)


def _length(e: Element) -> float:
    """Length of the head of an arrow, mm."""
    return float(abs(e.fills[0][0] - e.fills[0][1:].mean()))


def _head(t: Trace, paper: _Paper) -> Head:
    """What there is of a head at the tip, and at the other end when there is none."""
    assert t.at is not None
    way = (t.at[1] - t.at[0]) / abs(t.at[1] - t.at[0])
    beyond = [0.0 if np.isnan(by) else by for by in t.ends]
    begin, tip = complex(t.at[0] - way * beyond[0]), complex(t.at[1] + way * beyond[1])
    here = paper.widening(t.element, tip, begin)
    if _is_head(t.element, here):
        return "there"
    # Not even a small one.
    bare = _share(t.element, here) <= BARE and _share(t.element, here, SMALLER) <= INKED
    there = paper.widening(t.element, begin, tip)
    # Where nothing can be told of the tip, others must not have theirs at the other end: it might be drawn a little beside.
    alone = not (any(abs(z - begin) < _length(t.element) for z in paper.tips) or paper.accompanied(t.element, begin, way))
    # Two lines that part at a small angle widen as a head does, up to where they are told apart: a whole head must be seen.
    whole = not np.isnan(_share(t.element, there))
    if whole and _is_head(t.element, there) and (bare or alone):
        return "reversed"
    return "absent" if bare else "unknown"


def _is_head(e: Element, seen: tuple[Floats, float]) -> bool:
    """Whether a line widens as by a head, or by a smaller one."""
    return _share(e, seen) >= INKED or _share(e, seen, SMALLER) >= SURE


def _share(e: Element, seen: tuple[Floats, float], size: float = 1.0) -> float:
    """The widening of a line as a share of that by its head, by least squares; nan where too little of it is seen.

    Of a head of another ``size`` there is the same near its tip, and nothing beyond. A picture in black and white has lines wider
    than they were drawn, and heads that are hardly wider than those: ``seen`` is the widening, and the width of the line.
    """
    widening, line = seen
    corners = (e.fills[0] - e.fills[0][0]) / (e.points[0] - e.fills[0][0])
    width = 2 * float(np.abs(corners.imag).max()) * abs(e.points[0] - e.fills[0][0]) * BACK / _length(e)
    grown = line - line_type(e.style).width
    wanted = np.clip(np.where(size * _length(e) >= BACK, (width + grown) / line, 0) - 1, 0, None)
    told = ~np.isnan(widening)
    weight = float((wanted[told] ** 2).sum())
    if weight < ENOUGH * float((wanted**2).sum()) or not weight:
        return float("nan")
    return float(((widening[told] - 1) * wanted[told]).sum() / weight)
