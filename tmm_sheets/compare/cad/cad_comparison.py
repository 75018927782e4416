"""Both sides of a comparison and what is known of them so far; each step reads and writes here.

Elements with ink all along claim it; the next steps look only among what is left.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.cad import cad_text
from tmm_sheets.compare.cad.cad_findings import Finding
from tmm_sheets.compare.cad.cad_ink import Space
from tmm_sheets.compare.cad.overlaps import Left, Numbers, Overlaps, together
from tmm_sheets.compare.cad.placing import Lines, Placing, lines
from tmm_sheets.compare.elements import Element, View
from tmm_sheets.compare.report import Verdict, verdict
from tmm_sheets.drawing.marks import Fill, Line, Points, Text
from tmm_sheets.drawing.styles import line_type

JOINT = 0.3
"""A gap this short in a line is none, mm."""
SYMBOL = 2.6
"""Circles up to this radius are symbols (hinges, dots): their place counts, their size hardly, mm."""
SIZE_OF_SYMBOL = 1.0
"""What a symbol's radius may differ by, mm."""
LOOSE_STYLES = {"construction", "centre", "hatch", "axis"}
"""Helper lines may end anywhere within :data:`BEYOND` past their ends, mm."""
BEYOND = 10.0
CURVE_REACH = 6.0
"""How far from its place a curve is looked for, mm."""


class Comparison:
    """The state of one comparison: both sides, what is found, what is still free of their ink."""

    def __init__(self, elements: Sequence[Element], space: Space, moves: Mapping[View, Placing], tolerance: float) -> None:
        self.elements, self.space, self.tolerance = elements, space, tolerance
        self.moves = [moves.get(e.view, Placing()) for e in elements]
        self.theirs = lines(s.points for s in space.strokes)
        self.entity = np.array([s.entity for s in space.strokes], dtype=np.int64)[self.theirs.owner]
        self.paths = [self._paths(e, m) for e, m in zip(elements, self.moves, strict=True)]
        self.heads = [tuple(m(f) for f in e.fills) for e, m in zip(elements, self.moves, strict=True)]
        self.found: dict[int, Finding] = {}
        self.claims: list[Overlaps] = []
        self.pass_one: tuple[Overlaps, npt.NDArray[np.int64]]  # what lies along the elements in their places, and along which
        self.along: tuple[Numbers, Numbers]  # where along the elements' paths that begins and ends, mm
        self.owned: dict[int, list[tuple[int, float, float]]] = {}
        self.areas = np.array([complex(a.points.mean()) for a in space.areas], dtype=complex)
        self.used_areas: set[int] = set()
        self.used_writings: set[int] = set()
        self.zones: list[Points] = []  # where any ink may lie
        self.lettered: list[Points] = []  # where short strokes may
        self.drawn_letters: list[tuple[int, cad_text.Wanted]] = []

    def _paths(self, e: Element, move: Placing) -> list[Points]:
        """The lines an element has to have ink along, moved to its view's place."""
        if e.kind in ("text", "fill"):
            return []
        if e.kind == "hatch":
            return [move(p) for p in e.pieces]
        ink = [m for m in e.marks if not isinstance(m, Fill | Text)]
        if ink and e.kind == "circle" and e.radius <= SYMBOL:
            return [move(e.centre) + (e.points - e.centre)]
        if e.kind == "line" and len(ink) == 1 and isinstance(ink[0], Line):
            return [move(np.array([ink[0].a, ink[0].b]))]  # the shaft of an arrow, without its head
        return [move(e.points)] if ink else []

    def ours(self, numbers: Sequence[int]) -> tuple[Lines, npt.NDArray[np.int64], Numbers]:
        """Straight pieces of some elements' paths, the element of each, and where along its path each begins."""
        strokes, owners = [], []
        for n in numbers:
            strokes += self.paths[n]
            owners += [n] * len(self.paths[n])
        made = lines(strokes)
        of = np.array(owners, dtype=np.int64)[made.owner] if owners else np.zeros(0, np.int64)
        along = np.concatenate(([0.0], np.cumsum(made.length)))[:-1]
        start = np.full(len(self.elements), np.inf)
        np.minimum.at(start, of, along)
        return made, of, along - start[of]

    @cached_property
    def everything(self) -> tuple[Lines, npt.NDArray[np.int64]]:
        """Straight pieces of all elements' paths and the element of each."""
        made, of, _ = self.ours([n for n in range(len(self.elements)) if self.paths[n]])
        return made, of

    def whole(self, n: int) -> float:
        """Length of an element's path, mm."""
        return float(sum(np.abs(np.diff(p)).sum() for p in self.paths[n]))

    def gap(self, e: Element) -> float:
        """The longest gap that is none."""
        pattern = line_type(e.style).pattern
        return 2 * max((-x for x in pattern if x < 0), default=0.0) + JOINT if pattern else JOINT

    def claimed(self) -> Overlaps:
        """All of their ink that belongs to some element."""
        return together(self.claims)

    def claim(self, parts: Sequence[tuple[int, float, float]], n: int) -> None:
        """Pieces of theirs (piece, from, to) that belong to element ``n``."""
        self.owned[n] = self.owned.get(n, []) + list(parts)
        if parts:
            j, a, b = (np.array(x) for x in zip(*parts, strict=True))
            z = np.zeros(len(parts))
            self.claims.append(Overlaps(np.full(len(parts), -1), z, z, j.astype(np.int64), a.astype(float), b.astype(float), z, z))

    def finding(self, n: int, deviation: float, what: str, *, shift: complex | None = None, turn: float | None = None,
                 size: float | None = None, missing: bool = False, entities: tuple[int, ...] = (), at: complex | None = None,
                 cap: Verdict | None = None) -> Finding:
        """A finding for element ``n``, judged by its deviation in mm."""
        e, m = self.elements[n], self.moves[n]
        z = m(e.points)
        middle = complex((z.real.min() + z.real.max()) / 2, (z.imag.min() + z.imag.max()) / 2)
        judged = verdict(deviation, self.tolerance)
        if cap == "amber" and judged == "red":
            judged = "amber"
        reach = min(max(float(np.abs(z - middle).max()), 3.0), 20.0)
        if at is not None:
            middle, reach = at, min(reach, 5.0)
        return Finding(e, judged, deviation, what, middle, reach, shift, turn, size, missing, entities)

    def units(self, n: int, t: npt.NDArray[np.float64]) -> Points:
        """Directions along an element's path at distances from its beginning."""
        z = np.concatenate(self.paths[n])
        d = np.diff(z)
        size = np.abs(d)
        d, size = d[size > 1e-9], size[size > 1e-9]
        k = np.clip(np.searchsorted(np.cumsum(size), t), 0, len(d) - 1)
        return np.asarray(d[k] / size[k])

    def at(self, n: int, t: float) -> complex:
        """Place at a distance along an element's path."""
        z = np.concatenate(self.paths[n])
        along = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(z)))))
        return complex(np.interp(t, along, z.real), np.interp(t, along, z.imag))

    def of_strokes(self, strokes: tuple[int, ...]) -> list[int]:
        """Numbers of the pieces of some of their lines."""
        return [int(j) for k in strokes for j in np.flatnonzero(self.theirs.owner == k)]

    def entities_of_strokes(self, strokes: tuple[int, ...]) -> tuple[int, ...]:
        """Numbers of the entities some of their lines come from."""
        return tuple(dict.fromkeys(self.space.strokes[k].entity for k in strokes))

    def ends(self, r: Left) -> Points:
        """Both ends of a stretch that is left."""
        d = self.theirs.b[r.piece] - self.theirs.a[r.piece]
        u = d / abs(d)
        return np.array([self.theirs.a[r.piece] + r.a * u, self.theirs.a[r.piece] + r.b * u])


def middle_of(z: Points) -> complex:
    """Middle of the rectangle round points."""
    return complex((z.real.min() + z.real.max()) / 2, (z.imag.min() + z.imag.max()) / 2)


def reach_of(z: Points) -> float:
    """Radius of a circle round points that shows where to look, mm."""
    return min(max(float(np.abs(z - middle_of(z)).max()), 3.0), 20.0)


def grown(corners: Points, by: float) -> Points:
    """A rectangle larger on all sides."""
    a, b, _, _ = corners
    u = (b - a) / max(abs(b - a), 1e-9)
    v = 1j * u
    return corners + by * np.array([-u - v, u - v, u + v, v - u])
