"""What no element claims: too long an end of one that does, or extra."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from tmm_sheets.compare.cad import cad_lettering
from tmm_sheets.compare.cad.cad_comparison import BEYOND, CURVE_REACH, LOOSE_STYLES, SYMBOL, Comparison, middle_of, reach_of
from tmm_sheets.compare.cad.cad_findings import Extra
from tmm_sheets.compare.cad.overlaps import Left, left, pieces
from tmm_sheets.compare.cad.placing import lines, shapes
from tmm_sheets.compare.report import verdict
from tmm_sheets.drawing.marks import Points

SHORT = 12.0
"""Strokes up to this length may belong to somebody's lettering, mm."""
LEAST = 1.0
"""Stretches of extra ink shorter than this do not count, mm."""


Owners = Mapping[int, list[tuple[float, float, int]]]
"""Stretches (from, to, element) of each piece of theirs that elements claim."""


def extra(state: Comparison) -> tuple[Extra, ...]:
    """What is extra, longest first; ends that are too long go to the findings of their elements."""
    rest = left(state.theirs, state.claimed())
    cad_lettering.strange_ink(state, rest)
    rest = _outside_zones(state, rest)
    chains = list(_chains(state, rest))
    owners = _owners(state)
    extra: list[tuple[list[Left], float]] = []
    for chain in chains:
        size = sum(r.b - r.a for r in chain)
        if size <= state.tolerance:
            continue
        ends = _neighbours(state, chain, owners)
        if ends[0] is not None and ends[1] is not None and size < 4.5:
            continue  # one line drawn through where ours are two
        n = ends[0] if ends[0] is not None else ends[1]
        if n is not None and state.elements[n].kind in ("line", "arc", "curve") and _continues(state, n, chain, owners):
            _too_long(state, n, size, chain)
        elif size > LEAST:
            extra.append((chain, size))
    return tuple(sorted((*_heaps(state, extra), *_extra_areas(state), *_extra_text(state)), key=lambda x: -x.length))


def _outside_zones(state: Comparison, rest: list[Left]) -> list[Left]:
    """What is left outside of places where anything goes: symbols, heads, lettering, hatchings."""
    import shapely

    if not rest:
        return rest
    free = pieces(state.theirs, rest)
    zones = [shapely.Polygon(np.column_stack((z.real, z.imag))) for z in state.zones]
    for n, e in enumerate(state.elements):
        if e.kind == "circle" and e.radius <= SYMBOL:
            c = complex(state.moves[n](e.centre))
            zones.append(shapely.Point(c.real, c.imag).buffer(e.radius + 0.2))
        for h in state.heads[n]:
            if len(h) > 2:
                zones.append(shapely.Polygon(np.column_stack((h.real, h.imag))).buffer(0.35))
    for a in state.space.areas:  # their own heads
        if np.ptp(a.points.real) + np.ptp(a.points.imag) < 20:
            zones.append(shapely.MultiPoint(np.column_stack((a.points.real, a.points.imag))).convex_hull.buffer(0.05))
    short = np.bincount(state.theirs.owner, state.theirs.length)[state.theirs.owner] < SHORT
    first_lettered = len(zones)
    zones += [shapely.Polygon(np.column_stack((z.real, z.imag))) for z in state.lettered]
    if not zones:
        return rest
    tree = shapely.STRtree(zones)
    ink = shapes(free.a, free.b)
    allowed = np.array([short[r.piece] for r in rest])
    i, k = tree.query(ink, predicate="within")
    drop = set(i[(k < first_lettered) | allowed[i]].tolist())
    # Partly inside: what sticks out counts.
    out = []
    touching: dict[int, list[int]] = {}
    for p, q in zip(*tree.query(ink, predicate="intersects").tolist(), strict=True):
        if p not in drop and (q < first_lettered or allowed[p]):
            touching.setdefault(p, []).append(q)
    for k, r in enumerate(rest):
        if k in drop:
            continue
        if k not in touching:
            out.append(r)
            continue
        cut = shapely.difference(ink[k], shapely.union_all([zones[q] for q in touching[k]]))
        for part in getattr(cut, "geoms", [cut]):
            if part.is_empty:
                continue
            ends = [complex(*part.coords[0]), complex(*part.coords[-1])]
            t = sorted(abs(z - state.theirs.a[r.piece]) for z in ends)
            out.append(Left(r.piece, float(t[0]), float(t[1])))
    return [r for r in out if r.b - r.a > 0.05]


def _chains(state: Comparison, rest: list[Left]) -> Iterator[list[Left]]:
    """Stretches that continue one another along one of their lines."""
    chain: list[Left] = []
    for r in sorted(rest):
        if chain:
            last = chain[-1]
            next_piece = r.piece == last.piece + 1 and state.theirs.owner[r.piece] == state.theirs.owner[last.piece]
            if next_piece and last.b > state.theirs.length[last.piece] - 0.06 and r.a < 0.06:
                chain.append(r)
                continue
            yield chain
        chain = [r]
    if chain:
        yield chain


def _owners(state: Comparison) -> dict[int, list[tuple[float, float, int]]]:
    """The elements that claim stretches of each piece of theirs."""
    every, of = state.pass_one
    found: dict[int, list[tuple[float, float, int]]] = {}
    for j, a, b, n in zip(every.theirs.tolist(), every.w0.tolist(), every.w1.tolist(), of.tolist(), strict=True):
        if b - a > 0.3 or state.elements[n].kind not in ("line",):
            found.setdefault(j, []).append((a, b, n))
    for n, parts in state.owned.items():
        for j, a, b in parts:
            found.setdefault(j, []).append((a, b, n))
    return found


def _neighbours(state: Comparison, chain: list[Left], owners: Owners) -> tuple[int | None, int | None]:
    """Elements whose ink the chain continues at its beginning and its end."""
    first, last = chain[0], chain[-1]
    before = [(b - a, n) for a, b, n in owners.get(first.piece, ()) if abs(b - first.a) < 0.06]
    after = [(b - a, n) for a, b, n in owners.get(last.piece, ()) if abs(a - last.b) < 0.06]
    if not before and first.a < 0.06 and _same_line(state, first.piece, first.piece - 1):
        k = first.piece - 1
        before = [(b - a, n) for a, b, n in owners.get(k, ()) if abs(b - state.theirs.length[k]) < 0.06]
    if not after and last.b > state.theirs.length[last.piece] - 0.06 and _same_line(state, last.piece, last.piece + 1):
        k = last.piece + 1
        after = [(b - a, n) for a, b, n in owners.get(k, ()) if a < 0.06]
    return max(before)[1] if before else None, max(after)[1] if after else None


def _same_line(state: Comparison, j: int, k: int) -> bool:
    return 0 <= k < len(state.theirs.owner) and bool(state.theirs.owner[j] == state.theirs.owner[k])


def _continues(state: Comparison, n: int, chain: list[Left], owners: Owners) -> bool:
    """Whether the chain goes on as the element ended: straight on, or in the same curve."""
    # What only crosses or touches it for a short way is another line.
    j = chain[0].piece
    same = state.theirs.owner == state.theirs.owner[j]
    mine = sum(b - a for k, parts in owners.items() if same[k] for a, b, m in parts if m == n)
    if mine < 0.5 * state.whole(n) and mine < 0.3 * float(state.theirs.length[same].sum()):
        return False
    if state.elements[n].kind != "line":
        return True
    z = state.moves[n](state.elements[n].points)
    u = (z[-1] - z[0]) / abs(z[-1] - z[0])
    d = state.theirs.b[chain[0].piece] - state.theirs.a[chain[0].piece]
    middle = complex(state.ends(chain[0]).mean())
    if 0 < ((middle - z[0]) * np.conj(u)).real < abs(z[-1] - z[0]):
        return False  # beside it, not beyond its end
    return bool(abs((d * np.conj(u)).imag) < 0.03 * abs(d)) and len(chain) == 1


def _too_long(state: Comparison, n: int, size: float, chain: list[Left]) -> None:
    e, old = state.elements[n], state.found[n]
    if e.style in LOOSE_STYLES and size < BEYOND:
        return
    if old.verdict is None:
        return
    r = chain[0]
    piece = state.theirs.b[r.piece] - state.theirs.a[r.piece]
    at = complex(state.theirs.a[r.piece] + (r.a + r.b) / 2 * piece / abs(piece))
    what = f"{size:.1f} mm too long at ({at.real:.0f}, {at.imag:.0f})"
    if e.kind != "line":
        # A loop beside a curve that is there as well, as when one way of a path there and back is wrong.
        ends = np.concatenate([state.ends(r) for r in chain])
        foot, _, near = lines(state.paths[n]).nearest(ends, CURVE_REACH)
        ends_at = np.concatenate([p[[0, -1]] for p in state.paths[n]])
        if near.all() and np.abs(ends_at - at).min() > size:
            size = float(np.abs(foot - ends).max())
            at = complex(ends[np.abs(foot - ends).argmax()])
            what = f"up to {size:.2f} mm off at ({at.real:.0f}, {at.imag:.0f})"
    said = ", ".join(x for x in (old.what, what) if x)
    deviation = max(old.deviation, size)
    judged = verdict(deviation, state.tolerance)
    if judged == "red" and e.style in LOOSE_STYLES and old.verdict != "red":
        judged = "amber"
    entity = int(state.entity[r.piece])
    where = (at, 5.0) if old.verdict == "green" else (old.at, old.reach)
    state.found[n] = replace(old, deviation=deviation, verdict=judged, what=said, at=where[0], reach=where[1],
                            size=(old.size or 0.0) + size, entities=tuple(dict.fromkeys((*old.entities, entity))))


def _heaps(state: Comparison, extra: list[tuple[list[Left], float]]) -> Iterator[Extra]:
    """Extra ink by entity; small strokes that lie together (letters of a drawn text, a symbol) as one."""
    by_entity: dict[int, list[tuple[list[Left], float]]] = {}
    for chain, size in extra:
        by_entity.setdefault(int(state.entity[chain[0].piece]), []).append((chain, size))
    small: list[tuple[int, float, Points]] = []
    whole = np.zeros(len(state.space.entities))
    np.add.at(whole, state.entity, state.theirs.length)
    for k, found in by_entity.items():
        z = np.concatenate([state.ends(r) for chain, _ in found for r in chain])
        size = sum(s for _, s in found)
        if size > 0.5 * whole[k]:  # the rest runs along lines of the sheet by chance
            mine = state.entity == k
            z, size = np.concatenate((state.theirs.a[mine], state.theirs.b[mine])), float(whole[k])
        if np.ptp(z.real) + np.ptp(z.imag) < 14.0:
            small.append((k, size, z))
        else:
            yield Extra(state.space.entities[k], size, middle_of(z), reach_of(z))
    middles = np.array([middle_of(z) for _, _, z in small], dtype=complex)
    free = np.ones(len(small), bool)
    for i in range(len(small)):
        if not free[i]:
            continue
        heap, border = [i], [i]
        free[i] = False
        while border:
            k = border.pop()
            near = np.flatnonzero(free & (np.abs(middles - middles[k]) < 5.0))
            free[near] = False
            heap += near.tolist()
            border += near.tolist()
        z = np.concatenate([small[k][2] for k in heap])
        yield Extra(state.space.entities[small[heap[0]][0]], sum(small[k][1] for k in heap), middle_of(z), reach_of(z), len(heap))


def _extra_areas(state: Comparison) -> Iterator[Extra]:
    ours = [complex(h.mean()) for heads in state.heads for h in heads]
    known = np.array(ours, dtype=complex)
    for k, area in enumerate(state.space.areas):
        z = area.points
        around = float(np.abs(np.diff(np.append(z, z[:1]))).sum())
        if k in state.used_areas or not area.solid or around < 2.0:
            continue
        if len(known) and np.abs(known - state.areas[k]).min() < 3.0:
            continue
        yield Extra(state.space.entities[area.entity], around, middle_of(z), reach_of(z))


def _extra_text(state: Comparison) -> Iterator[Extra]:
    for k, w in enumerate(state.space.writings):
        if k not in state.used_writings:
            yield Extra(state.space.entities[w.entity], 0.0, w.at, max(w.width, 4.0) / 2, 1, w.text.strip())
