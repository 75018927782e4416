"""Assur groups of a mechanism, found from its links and pairs alone."""

from __future__ import annotations

from tmm_sheets.mechanism.groups import KINDS
from tmm_sheets.mechanism.model import Mechanism, Pair, StructuralGroup


def decompose(m: Mechanism) -> tuple[StructuralGroup, ...]:
    """Groups found from links and pairs alone, the farthest from the crank first.

    From the frame and the crank outwards, two links that touch each other and the links already placed form a group;
    detaching starts at the other end.

    Raises
    ------
    ValueError
        when what remains is no mechanism of class II.
    """
    placed, order = {m.frame, m.crank.link}, []
    pairs = [p for p in m.pairs if set(p.links) != placed]
    names = list(dict.fromkeys(n for p in pairs for n in p.links if n not in placed))
    while names:
        found = next(
            ((i, j) for n, i in enumerate(names) for j in names[n + 1:] if _is_group(i, j, pairs, placed)), None)
        if found is None:
            raise ValueError(f"links {', '.join(names)} form no group of class II with the links before them")
        i, j = found
        outer_i, inner, outer_j = _group_of(i, j, pairs, placed)
        a, b, c = ("R" if p.motion == "rotation" else "P" for p in (outer_i, inner, outer_j))
        kind = next((k for k in KINDS.values() if a + b + c in k.orders), None)
        if kind is None:
            raise ValueError(f"links {i} and {j} with pairs {a}-{b}-{c} can slide without turning: no group of class II")
        order.append(StructuralGroup(kind, (i, j), (outer_i.name, outer_j.name), inner.name))
        placed |= {i, j}
        names = [n for n in names if n not in placed]
    return tuple(reversed(order))


def _is_group(i: str, j: str, pairs: list[Pair], placed: set[str]) -> bool:
    try:
        _group_of(i, j, pairs, placed)
    except LookupError:
        return False
    return True


def _group_of(i: str, j: str, pairs: list[Pair], placed: set[str]) -> tuple[Pair, Pair, Pair]:
    def one(found: list[Pair]) -> Pair:
        if len(found) != 1:
            raise LookupError
        return found[0]

    inner = one([p for p in pairs if set(p.links) == {i, j}])
    outer_i = one([p for p in pairs if i in p.links and set(p.links) & placed])
    outer_j = one([p for p in pairs if j in p.links and set(p.links) & placed])
    return outer_i, inner, outer_j
