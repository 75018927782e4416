"""Structure of a mechanism: links, kinematic pairs and Assur groups; no coordinates.

Kinds of groups of class II (manual 000, table 3.1): 1 RRR, 2 RRP, 3 RPR, 4 PRP, 5 RPP.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Motion = Literal["rotation", "translation"]

KINDS: dict[tuple[str, str, str], int] = {
    ("R", "R", "R"): 1, ("R", "R", "P"): 2, ("P", "R", "R"): 2, ("R", "P", "R"): 3,
    ("P", "R", "P"): 4, ("R", "P", "P"): 5, ("P", "P", "R"): 5,
}
"""Kind of a two-link group by its outer, inner, outer pair; PPP and RPP with parallel guides are no mechanisms."""

FORMS = {1: "ВВВ", 2: "ВВП", 3: "ВПВ", 4: "ПВП", 5: "ВПП"}
ROMAN = {1: "I", 2: "II", 3: "III", 4: "IV", 5: "V"}


@dataclass(frozen=True)
class Link:
    """A link; ``mass`` kg at point ``centre``, ``inertia`` kg m2 about it; None where the task gives none.

    ``pivot_inertia`` kg m2 about the link's fixed pivot, where the task gives it for the energy beside ``inertia``.
    """

    name: str
    title: str = ""
    mass: float = 0.0
    centre: str | None = None
    inertia: float = 0.0
    pivot_inertia: float | None = None


@dataclass(frozen=True)
class Pair:
    """A kinematic pair of class 5 between two links, named after its point; translations carry a prime."""

    name: str
    links: tuple[str, str]
    motion: Motion


@dataclass(frozen=True)
class Guide:
    """A straight guide: on the frame through a fixed point, or on a moving link through one of its points.

    ``direction`` (rad) is a world angle for a fixed guide, the angle from ``from_point`` .. ``towards`` else.
    """

    name: str
    link: str
    through: complex | str
    direction: float
    towards: str | None = None


@dataclass(frozen=True)
class StructuralGroup:
    """An Assur group of class II, order 2 (группа Ассура).

    ``outer`` are the points of its outer turning pairs, ``inner`` the point of its inner turning pair (or, for kinds 3
    and 5, of the guided link on the guide), ``side`` the assembly side, ``guides`` the guides of its outer sliding pairs.
    """

    kind: int
    links: tuple[str, str]
    outer: tuple[str, ...]
    inner: str | None = None
    lengths: tuple[float, ...] = ()
    guides: tuple[str, ...] = ()
    side: int = 1
    offset: float = 0.0
    slot: float = 0.0

    @property
    def name(self) -> str:
        """Link names joined as the manuals write them: 2-3."""
        return "–".join(self.links)

    @property
    def form(self) -> str:
        """Its pairs in Russian letters, outer, inner, outer: В turning, П sliding."""
        return FORMS[self.kind]


@dataclass(frozen=True)
class LinkPoint:
    """A further point fixed on a link: at ``distance`` (m) from ``start`` under ``angle`` (rad) to ``start`` .. ``towards``."""

    name: str
    link: str
    start: str
    towards: str
    distance: float
    angle: float = 0.0


@dataclass(frozen=True)
class Crank:
    """The initial link; ``sense`` is +1 for counter-clockwise, ``speed`` rad/s and ``acceleration`` rad/s2 unsigned sense."""

    link: str
    pivot: str
    pin: str
    length: float
    speed: float
    sense: int
    acceleration: float = 0.0

    @property
    def omega(self) -> float:
        """Angular velocity with its sign, rad/s."""
        return self.sense * self.speed


@dataclass(frozen=True)
class Mechanism:
    """A mechanism of class II: crank and groups in order of attachment, with the points and links they carry."""

    crank: Crank
    fixed: dict[str, complex]
    guides: dict[str, Guide]
    groups: tuple[StructuralGroup, ...]
    points: tuple[LinkPoint, ...]
    links: dict[str, Link]
    frame: str = "0"

    @property
    def pairs(self) -> tuple[Pair, ...]:
        """All kinematic pairs, in order of attachment, named as in the manuals (A, B, B', C, D, D', D'')."""
        c = self.crank
        pairs = [Pair(c.pivot, (self.frame, c.link), "rotation")]
        for g in self.groups:
            pairs += self._group_pairs(g)
        return tuple(pairs)

    def _group_pairs(self, g: StructuralGroup) -> list[Pair]:
        i, j = g.links

        def turn(name: str, a: str, b: str) -> Pair:
            return Pair(name, (a, b), "rotation")

        def slide(name: str, a: str, b: str) -> Pair:
            return Pair(name, (a, b), "translation")

        inner = g.inner or ""
        if g.kind == 1:
            return [turn(g.outer[0], self.owner(g.outer[0]), i), turn(inner, i, j), turn(g.outer[1], j, self.owner(g.outer[1]))]
        if g.kind == 2:
            return [turn(g.outer[0], self.owner(g.outer[0]), i), turn(inner, i, j),
                    slide(inner + "′", j, self.guides[g.guides[0]].link)]
        if g.kind == 3:
            p, q = g.outer
            return [turn(p, self.owner(p), i), slide(p + "′", i, j), turn(q, j, self.owner(q))]
        if g.kind == 4:
            first, second = (self.guides[name].link for name in g.guides)
            return [slide(inner + "′", first, i), turn(inner, i, j), slide(inner + "″", j, second)]
        p = g.outer[0]
        return [turn(p, self.owner(p), i), slide(p + "′", i, j), slide(p + "″", j, self.guides[g.guides[0]].link)]

    def owner(self, point: str) -> str:
        """Link on which a point is fixed; the frame for fixed points, the first to carry it for hinges, the slider for its pin."""
        if point in self.fixed:
            return self.frame
        if point == self.crank.pin:
            return self.crank.link
        for p in self.points:
            if p.name == point:
                return p.link
        for g in self.groups:
            if g.inner == point:
                return g.links[1] if g.kind in (2, 5) else g.links[0]
        raise KeyError(point)

    @property
    def mobility(self) -> int:
        """Degree of freedom by Chebyshev: W = 3n - 2 p5 - p4 (no pairs of class 4 in a class II mechanism)."""
        moving = {name for pair in self.pairs for name in pair.links} - {self.frame}
        return 3 * len(moving) - 2 * len(self.pairs)

    def decompose(self) -> tuple[StructuralGroup, ...]:
        """Groups found from links and pairs alone, the farthest from the crank first.

        From the frame and the crank outwards, two links that touch each other and the links already placed form a group;
        detaching starts at the other end. Raises ValueError when what remains is no mechanism of class II.
        """
        placed, order = {self.frame, self.crank.link}, []
        pairs = [p for p in self.pairs if set(p.links) != placed]
        names = list(dict.fromkeys(n for p in pairs for n in p.links if n not in placed))
        while names:
            found = next(
                ((i, j) for n, i in enumerate(names) for j in names[n + 1:] if self._is_group(i, j, pairs, placed)), None)
            if found is None:
                raise ValueError(f"links {', '.join(names)} form no group of class II with the links before them")
            i, j = found
            outer_i, inner, outer_j = self._group_of(i, j, pairs, placed)
            a, b, c = ("R" if p.motion == "rotation" else "P" for p in (outer_i, inner, outer_j))
            kind = KINDS.get((a, b, c))
            if kind is None:
                raise ValueError(f"links {i} and {j} with pairs {a}-{b}-{c} can slide without turning: no group of class II")
            order.append(StructuralGroup(kind, (i, j), (outer_i.name, outer_j.name), inner.name))
            placed |= {i, j}
            names = [n for n in names if n not in placed]
        return tuple(reversed(order))

    def _is_group(self, i: str, j: str, pairs: list[Pair], placed: set[str]) -> bool:
        try:
            self._group_of(i, j, pairs, placed)
        except LookupError:
            return False
        return True

    @staticmethod
    def _group_of(i: str, j: str, pairs: list[Pair], placed: set[str]) -> tuple[Pair, Pair, Pair]:
        def one(found: list[Pair]) -> Pair:
            if len(found) != 1:
                raise LookupError
            return found[0]

        inner = one([p for p in pairs if set(p.links) == {i, j}])
        outer_i = one([p for p in pairs if i in p.links and set(p.links) & placed])
        outer_j = one([p for p in pairs if j in p.links and set(p.links) & placed])
        return outer_i, inner, outer_j

    @property
    def structure(self) -> str:
        """Formula of structure in Russian, from the initial mechanism outwards."""
        parts = [f"I(0,{self.crank.link})"]
        parts += [f"II({','.join(g.links)})" for g in self.groups]
        return " → ".join(parts)

    @property
    def grade(self) -> int:
        """Class of the mechanism: the highest class among its groups."""
        return 2 if self.groups else 1

    def link_points(self, link: str) -> tuple[str, ...]:
        """Names of the points fixed on a link: its pairs first, then its further points."""
        names = [p.name.rstrip("′″") for p in self.pairs if link in p.links]
        names += [p.name for p in self.points if p.link == link]
        for g in self.groups:
            if g.inner and link == g.links[1]:
                names.append(g.inner)
        return tuple(dict.fromkeys(names))
