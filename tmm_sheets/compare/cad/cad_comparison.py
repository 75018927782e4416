"""The state of a comparison with a sheet of ours, and its findings: of every element, of extra ink, of line types and widths.

Elements that have ink everywhere along them claim it; later steps look among the rest only.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar, Literal

import numpy as np
import numpy.typing as npt

from tmm_sheets.box import Box
from tmm_sheets.compare.cad.cad_ink import DrawingSpace, Entity
from tmm_sheets.compare.cad.line_fit import (
    ONE_PLACE,
    Interval,
    KnownLines,
    Left,
    Numbers,
    Overlaps,
    gaps,
    left,
    lines,
    overlaps,
    union,
)
from tmm_sheets.compare.codes import Remark
from tmm_sheets.compare.elements import Element, ElementView, grouped, point_along
from tmm_sheets.compare.findings import Finding, Verdict, verdict
from tmm_sheets.compare.placing import Placing, moved
from tmm_sheets.drawing.marks import Fill, Line, Points, Text
from tmm_sheets.drawing.styles import line_type
from tmm_sheets.words import marked, tell

STYLES = {
    "main": marked("main lines"), "curve": marked("curves (main lines)"), "vector": marked("vectors (main lines)"),
    "thin": marked("thin lines"), "construction": marked("construction lines"), "centre": marked("centre lines"),
    "hidden": marked("hidden lines"), "axis": marked("coordinate axes"), "twodot": marked("dash-two-dots lines"),
}
"""Styles of lines whose type and width are compared, as they are told."""


@dataclass(frozen=True, eq=False)
class CadFinding(Finding):
    """The outcome for one element, where the drawing has its view.

    Attributes
    ----------
    reach : radius of a circle round the place, mm
    shift, turn, size : shift (right, up), mm, turn, degrees counter-clockwise, and excess of length or radius, mm, where these can
        be told apart
    missing : whether it is not there at all
    absent : the kind it is left out with, where all of that are, or its name; which is told of the view; else ""
    entities : numbers of the entities of the drawing it is made of
    says : what a text says instead of what it should
    """

    reach: float
    shift: complex | None = None
    turn: float | None = None
    size: float | None = None
    missing: bool = False
    entities: tuple[int, ...] = ()
    absent: str = ""
    says: str | None = None


@dataclass(frozen=True)
class ExtraStroke:
    """Ink or text that belongs to no element: ``length`` mm within ``reach`` of ``at``, from ``count`` entities.

    ``view`` is the one that it was drawn in, and ``ends`` where, if these are known.
    """

    kind: Literal["line", "arc", "text", "fill"]

    entity: Entity
    length: float
    at: complex
    reach: float
    count: int = 1
    text: str = ""
    view: ElementView | None = None
    ends: Points = field(default_factory=lambda: np.zeros(0, complex))

    @property
    def verdict(self) -> Verdict:
        """Amber for a short piece, which may be a slip of the pen."""
        return "red" if self.length > 5.0 else "amber"


@dataclass(frozen=True)
class LookFinding:
    """Elements drawn with a wrong type or width of line.

    Attributes
    ----------
    view : their view, None if they are in several
    styles : those of their lines on the sheet
    remark : how they are drawn
    elements : their numbers
    entities : what they are drawn with
    places : their lines, mm, the longest first
    """

    view: ElementView | None
    styles: tuple[str, ...]
    remark: Remark
    elements: tuple[int, ...]
    entities: tuple[Entity, ...]
    places: tuple[Points, ...]

    verdict: ClassVar[Verdict] = "amber"

    @property
    def what(self) -> str:
        """How they are drawn, as the reader reads it."""
        return self.remark.said()

    @property
    def lines(self) -> str:
        """Their kinds of lines in words."""
        return ", ".join(tell(STYLES[style]) for style in self.styles)


@dataclass(frozen=True)
class CadOutcome:
    """Findings of every element in its order, extra ink, longest first, wrong line types and widths with ``notes`` on them."""

    findings: tuple[CadFinding, ...]
    extras: tuple[ExtraStroke, ...]
    looks: tuple[LookFinding, ...] = ()
    notes: tuple[str, ...] = ()

    @cached_property
    def by_view(self) -> dict[ElementView, list[CadFinding]]:
        """The findings of each view."""
        return grouped(self.findings, lambda f: f.element.view)

    @property
    def absent(self) -> list[tuple[ElementView, str, int]]:
        """What views leave out, view by view: the kind (of :data:`~tmm_sheets.compare.cad.cad_extras.KINDS`), and how many."""
        return [(view, kind, n) for view, found in self.by_view.items()
                for kind, n in Counter(f.absent for f in found if f.absent).items()]


SIZE_OF_SYMBOL = 1.0
"""How much the radius of a hinge or dot may differ, mm: its place counts, its size hardly."""
LOOSE_STYLES = {"construction", "centre", "hatch", "axis"}
"""Auxiliary lines: they may end up to :data:`BEYOND` mm beyond their ends."""
BEYOND = 10.0
CURVE_REACH = 6.0
"""How far from its place a curve or a dot is looked for, mm."""
FARTHEST = 25.0
"""A line whose ends are farther off than this, mm, is another line."""
ELSEWHERE = 12.0
"""A curve or a text that is drawn farther from its place than this, mm, is another one."""


class Comparison:
    """The state of one comparison. Elements, strokes, areas and writings go by their numbers in their sequences, from 0.

    Attributes
    ----------
    elements, space, tolerance : what is compared, where the drawing has its views, mm, and how far a point may be off, mm
    moved : views that stand elsewhere than on the sheet
    paths : by element, the lines it must have ink along; of lettering none, or the strokes of its letters
    theirs, entity : pieces of their lines, and the entity of each
    found : findings by element
    claims : their ink that belongs to elements: by piece from where to where
    in_place, in_place_of, along : what lies along elements in their places, along which, and from where to where along their paths
    inked : for elements that are not right, where along their paths there is ink in place, mm
    owned : for elements found elsewhere, the pieces of theirs they claim, from where to where
    areas : middles of their areas
    used_areas, used_writings : areas and writings that belong to elements
    zones : outlines within which any ink may lie
    """

    in_place: Overlaps
    in_place_of: npt.NDArray[np.int64]
    along: tuple[Numbers, Numbers]

    def __init__(self, elements: Sequence[Element], space: DrawingSpace, moves: Mapping[ElementView, Placing],
                 tolerance: float) -> None:
        self.elements = [moved(e, moves[e.view]) if e.view in moves else e for e in elements]
        self.space, self.tolerance, self.moved = space, tolerance, moves
        self.theirs = space.lines
        self.entity = np.array([s.entity for s in space.strokes], dtype=np.int64)[self.theirs.owner]
        self.paths = [_paths(e) for e in self.elements]
        self.found: dict[int, CadFinding] = {}
        self.claims: dict[int, list[Interval]] = {}
        self.inked: dict[int, list[Interval]] = {}
        self.owned: dict[int, list[tuple[int, float, float]]] = {}
        self.areas = np.array([complex(a.points.mean()) for a in space.areas], dtype=complex)
        self.used_areas: set[int] = set()
        self.used_writings: set[int] = set()
        self.zones: list[Points] = []

    def ours(self, numbers: Sequence[int]) -> tuple[KnownLines, npt.NDArray[np.int64], Numbers]:
        """Straight pieces of the paths of some elements, the element of each piece, and how far along its path it begins, mm."""
        strokes = [(n, path) for n in numbers for path in self.paths[n]]
        made = lines(path for _, path in strokes)
        of = np.array([n for n, _ in strokes], dtype=np.int64)[made.owner]
        along = np.concatenate(([0.0], np.cumsum(made.length)))[:-1]
        start = np.full(len(self.elements), np.inf)
        np.minimum.at(start, of, along)
        return made, of, along - start[of]

    @cached_property
    def everything(self) -> tuple[KnownLines, npt.NDArray[np.int64]]:
        """Straight pieces of the paths of all elements, and the element of each piece."""
        made, of, _ = self.ours([n for n in range(len(self.elements)) if self.paths[n]])
        return made, of

    def free(self, n: int) -> list[Interval]:
        """Stretches of an element without another element of the sheet beside them."""
        mine, _, base = self.ours([n])
        every, of = self.everything
        hit = overlaps(mine, every, 2 * self.tolerance)
        hit = hit.only(of[hit.theirs] != n)
        taken = union(zip((base[hit.ours] + hit.s0).tolist(), (base[hit.ours] + hit.s1).tolist(), strict=True), 0.5)
        return gaps(taken, self.whole(n))

    def whole(self, n: int) -> float:
        """Length of the path of an element, mm."""
        return float(sum(np.abs(np.diff(p)).sum() for p in self.paths[n]))

    def gap(self, e: Element) -> float:
        """The longest gap in an element's ink that counts as none, mm."""
        pattern = line_type(e.style).pattern
        return 2 * max((-x for x in pattern if x < 0), default=0.0) + ONE_PLACE if pattern else ONE_PLACE

    def unclaimed(self) -> list[Left]:
        """Their ink that belongs to no element."""
        return left(self.theirs, self.claims)

    def claim(self, parts: Iterable[tuple[int, float, float]], n: int | None = None) -> None:
        """Claim pieces of theirs (piece, from, to), in their places or for element ``n`` elsewhere."""
        for part in parts:
            self.claims.setdefault(part[0], []).append(part[1:])
            if n is not None:
                self.owned.setdefault(n, []).append(part)

    def finding(self, n: int, deviation: float, remark: Remark | None, *, shift: complex | None = None, turn: float | None = None,
                 size: float | None = None, missing: bool = False, entities: tuple[int, ...] = (),
                 at: complex | None = None) -> CadFinding:
        """A finding for element ``n``, judged by its deviation, mm."""
        e = self.elements[n]
        middle, reach = (e.middle, reach_of(e.points)) if at is None else (at, min(reach_of(e.points), 5.0))
        return CadFinding(e, verdict(deviation, self.tolerance), deviation, remark, middle, reach, shift, turn, size, missing,
                          entities)

    def at(self, n: int, t: float) -> complex:
        """The point at a distance along the path of an element, mm."""
        return point_along(np.concatenate(self.paths[n]), t)

    def entities_of(self, pieces: Iterable[int]) -> tuple[int, ...]:
        """Numbers of the entities of some pieces, each once."""
        return tuple(dict.fromkeys(int(self.entity[j]) for j in pieces))

    def ends(self, r: Left) -> Points:
        """Both ends of an unclaimed stretch."""
        d = self.theirs.b[r.piece] - self.theirs.a[r.piece]
        u = d / abs(d)
        return np.array([self.theirs.a[r.piece] + r.a * u, self.theirs.a[r.piece] + r.b * u])


def _paths(e: Element) -> list[Points]:
    """The lines an element must have ink along."""
    if e.kind in ("text", "fill"):
        return []
    if e.kind == "hatch":
        return list(e.pieces)
    ink = [m for m in e.marks if not isinstance(m, Fill | Text)]
    if e.kind == "line" and len(ink) == 1 and isinstance(ink[0], Line):
        return [np.array([ink[0].a, ink[0].b])]  # the shaft of an arrow, without its head
    return [e.points] if ink else []


def reach_of(z: Points) -> float:
    """Radius of the circle that marks points on an overlay, mm."""
    return min(max(float(np.abs(z - Box.around(z).centre).max()), 3.0), 20.0)
