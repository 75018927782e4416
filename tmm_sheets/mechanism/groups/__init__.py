"""Kinds of Assur groups: five of class II, order 2, and one of class III, order 3; a new kind is a module here and a line below.

The groups of a mechanism are found from its links and pairs alone.
"""

from __future__ import annotations

from itertools import combinations

from tmm_sheets.mechanism.groups.triad import TRIAD, TriadGroup
from tmm_sheets.mechanism.groups.two_links import PRP, RPP, RPR, RRP, RRR
from tmm_sheets.mechanism.model import GroupKind, Leg, Mechanism, Pair, StructuralGroup

KINDS: dict[int, GroupKind] = {kind.number: kind for kind in (RRR, RRP, RPR, PRP, RPP, TRIAD)}
"""Every kind by its number in the manuals; PPP and RPP with parallel guides are no mechanisms."""

__all__ = ["KINDS", "PRP", "RPP", "RPR", "RRP", "RRR", "TRIAD", "GroupKind", "decompose"]


def decompose(m: Mechanism) -> tuple[StructuralGroup, ...]:
    """Groups found from links and pairs alone, the farthest from the crank first.

    From the frame and the crank outwards, two links that touch each other and the links already placed form a group; where no two
    do, a link with three pairs, each with a link that touches those already placed. Detaching starts at the other end.

    Raises
    ------
    ValueError
        when what remains is no mechanism of class II or III.

    Examples
    --------
    A rod and a slider behind a crank, given in whatever way, are a group of two turning pairs and a sliding one.

    >>> from tmm_sheets import catalogue
    >>> from tmm_sheets.project import Project
    >>> [(group.name, group.form) for group in decompose(Project(catalogue.read("lugansk/shaper")).mechanism)]
    [('4–5', 'RPP'), ('2–3', 'RPR')]
    """
    placed, order = {m.frame, m.crank.link}, []
    pairs = [p for p in m.pairs if set(p.links) != placed]
    names = list(dict.fromkeys(n for p in pairs for n in p.links if n not in placed))
    while names:
        group = next(filter(None, (_group(i, j, pairs, placed) for i, j in combinations(names, 2))), None)
        group = group or next(filter(None, (_triad(i, pairs, placed) for i in names)), None)
        if group is None:
            raise ValueError(f"links {', '.join(names)} form no group of class II or III with the links before them")
        order.append(group)
        placed |= set(group.links)
        names = [n for n in names if n not in placed]
    return tuple(reversed(order))


def _group(i: str, j: str, pairs: list[Pair], placed: set[str]) -> StructuralGroup | None:
    """The group of two links, if each has one pair with the links placed and they have one with each other."""
    joints = (_pairs_between(i, placed, pairs), _pairs_between(i, {j}, pairs), _pairs_between(j, placed, pairs))
    if any(len(found) != 1 for found in joints):
        return None
    (outer_i,), (inner,), (outer_j,) = joints
    motions = ["R" if p.motion == "rotation" else "P" for p in (outer_i, inner, outer_j)]
    kind = next((k for k in KINDS.values() if "".join(motions) in k.orders), None)
    if kind is None:
        raise ValueError(f"links {i} and {j} with pairs {'-'.join(motions)} can slide without turning: no group of class II")
    return StructuralGroup(kind, (i, j), (outer_i.name, outer_j.name), inner.name)


def _triad(i: str, pairs: list[Pair], placed: set[str]) -> TriadGroup | None:
    """The group of class III about a link, if it has three pairs with links that each have one more, with the links placed."""
    every = [(p, next(n for n in p.links if n != i)) for p in pairs if i in p.links]
    found = [(p, leg, outer[0]) for p, leg in every if leg not in placed and len(outer := _pairs_between(leg, placed, pairs)) == 1]
    if len(found) < 3 or any(leg in placed for _, leg in every):
        return None
    found = found[:3]
    return TriadGroup(TRIAD, (i, *(leg for _, leg, _ in found)), tuple(q.name for _, _, q in found), legs=tuple(
        Leg(leg, p.name, "" if q.motion == "translation" else q.name, q.name if q.motion == "translation" else "",
            slot=0.0 if p.motion == "translation" else None) for p, leg, q in found))


def _pairs_between(link: str, others: set[str], pairs: list[Pair]) -> list[Pair]:
    """Pairs of a link with any of the others."""
    return [p for p in pairs if link in p.links and others & set(p.links)]
