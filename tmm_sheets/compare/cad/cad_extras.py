"""What a drawing leaves out of a view, kind by kind, and ink that no element claims: the excess of one that goes on so, or extra.

Twelve construction lines that are not there are one remark on the view, not twelve mistakes, and what lies where they would be is
not theirs. A kind is left out where hardly any of it has ink that nothing else accounts for; one missing line among others that are
drawn is a mistake as ever. Where a view has a place of its own, its letters have too: those not found are a remark as well.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare import codes
from tmm_sheets.compare.cad import cad_lettering
from tmm_sheets.compare.cad.cad_comparison import (
    BEYOND,
    CURVE_REACH,
    LOOSE_STYLES,
    AbsentKind,
    CadFinding,
    Comparison,
    ExtraStroke,
    middle_of,
    reach_of,
)
from tmm_sheets.compare.cad.cad_ink import Entity, normal
from tmm_sheets.compare.cad.line_fit import KnownLines, Left, common, extent, hanging_together, left, lines, pieces, shapes
from tmm_sheets.compare.cad.symbol_matching import AT_TIP
from tmm_sheets.compare.codes import Number, joined
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.findings import farthest, place, verdict
from tmm_sheets.compare.placing import HINGE
from tmm_sheets.drawing.marks import Points
from tmm_sheets.words import tell_n

FEW = 0.35
"""Share of what there should be of a kind below which it is left out."""
SEVERAL = 3
"""Of fewer in a view each is judged by itself, unless the whole drawing leaves the kind out."""
DRAWN_SHARE = 0.6
"""Share of a line that must have ink for the line to be drawn."""
FOUND_LAST = frozenset({"text", "point", "hatch"})
"""Kinds of what is looked for when lines have their ink."""

KINDS = frozenset({"construction", "symbol", "joint", "arrow", "dimension", "table", "hatch", "frame", "axis", "point", "text"})
"""What may be left out."""


def kind_of(e: Element) -> str:
    """The kind an element is left out with; empty for the main lines of a view."""
    if e.kind in ("text", "hatch"):
        return e.kind
    if e.kind == "circle" and e.fills and e.role != "construction":
        return "point"
    if e.kind == "arc" and e.arrow and e.role == "symbol":
        return "arrow"  # of a couple, or of how a link turns: no part of a hinge or support
    if e.kind == "circle" and e.role == "symbol":
        return "joint"  # a guide or a block may be drawn where these are not
    return e.role if e.role in KINDS else ""


def said_absent(kind: str, n: int) -> str:
    """How many elements of a kind, in words."""
    words = {
        "construction": tell_n("{n} construction line", "{n} construction lines", n),
        "symbol": tell_n("{n} line of a symbol", "{n} lines of symbols", n),
        "joint": tell_n("{n} circle of a joint", "{n} circles of joints", n),
        "arrow": tell_n("{n} round arrow", "{n} round arrows", n),
        "dimension": tell_n("{n} line of a dimension", "{n} lines of dimensions", n),
        "table": tell_n("{n} line of a table", "{n} lines of a table", n),
        "hatch": tell_n("{n} hatching", "{n} hatchings", n),
        "frame": tell_n("{n} line of a frame", "{n} lines of a frame", n),
        "axis": tell_n("{n} line of the axes", "{n} lines of the axes", n),
        "point": tell_n("{n} dot", "{n} dots", n),
        "text": tell_n("{n} text", "{n} texts", n),
    }
    return words[kind].format(n=n)


def left_out(state: Comparison, kinds: Collection[str]) -> None:
    """Set aside the kinds that views do not have; of a view in which nothing tells, the whole drawing does."""
    of: dict[tuple[str, ElementView], list[int]] = {}
    for n, e in enumerate(state.elements):
        if e.view.n and kind_of(e) in kinds and (n not in state.found or state.found[n].verdict is not None):
            of.setdefault((kind_of(e), e.view), []).append(n)
    drawn = {n: there > DRAWN_SHARE for some in of.values() for n in some if (there := _share(state, n)) is not None}
    for (kind, view), numbers in of.items():
        if view in state.moved and kind in FOUND_LAST:
            _set_aside(state, [n for n in numbers if state.found[n].missing or _other_words(state, n)], kind)
            continue
        here = [drawn[n] for n in numbers if n in drawn]
        everywhere = [drawn[n] for (k, _), some in of.items() if k == kind for n in some if n in drawn]
        if np.mean(here if len(here) >= SEVERAL else everywhere or [True]) < FEW:
            _set_aside(state, [n for n in numbers if kind not in FOUND_LAST or state.found[n].missing], kind)


def _share(state: Comparison, n: int) -> float | None:
    """How much of an element has ink that nothing else accounts for; None where all of it lies along others."""
    kind, whole = kind_of(state.elements[n]), state.whole(n)
    if kind in FOUND_LAST:
        return float(not state.found[n].missing)
    clear = [(0.0, whole)] if kind == "joint" else state.free(n)  # no line lies along a circle
    inked = common(state.inked.get(n, [(0.0, whole)]), clear)
    return extent(inked) / extent(clear) if extent(clear) > 1.0 else None


def _other_words(state: Comparison, n: int) -> bool:
    """Whether a text that stands there is none for this one: a title, a label without some of its parts, or that of another."""
    e, finding = state.elements[n], state.found[n]
    if e.kind != "text" or finding.says is None:
        return False
    letters = {part for other in state.elements if other.view == e.view and other.kind == "text"
               for part in (cad_lettering.meant(other.text), *cad_lettering.parts(other.text))}
    return not e.step or cad_lettering.meant(finding.says) in letters or cad_lettering.says_less(finding.says, e.text)


def absent_kinds(findings: Iterable[CadFinding]) -> tuple[AbsentKind, ...]:
    """What each view leaves out, by view and kind."""
    left: dict[ElementView, dict[str, set[int]]] = {}
    for f in findings:
        if f.absent:
            left.setdefault(f.element.view, {}).setdefault(f.absent, set()).add(f.element.number)
    return tuple(AbsentKind(view, kind, len(some)) for view, kinds in left.items() for kind, some in kinds.items())


def _set_aside(state: Comparison, numbers: Sequence[int], kind: str) -> None:
    """Leave elements out of the comparison; those of them that are drawn all the same are not extra."""
    for n in numbers:
        e = state.elements[n]
        state.found[n] = CadFinding(e, None, 0.0, codes.NOT_DRAWN(), e.middle, 5.0, missing=True, absent=kind)
        inked = state.inked.pop(n, [])
        if extent(inked) > DRAWN_SHARE * state.whole(n):
            state.claims.append(state.in_place.only(state.in_place_of == n))
    state.zones += [_disc(e.centre) for e in (state.elements[n] for n in numbers) if e.kind == "circle" and e.radius <= HINGE]


def _disc(centre: complex) -> npt.NDArray[np.complex128]:
    return np.asarray(centre + (HINGE + 0.2) * np.exp(2j * np.pi * np.arange(12) / 12))


SHORT = 12.0
"""Strokes shorter than this may belong to lettering, mm."""
LEAST = 1.0
"""Shortest stretch of extra ink, mm."""
ROUND = frozenset({"ARC", "CIRCLE", "ELLIPSE"})
"""Entities that are told as arcs."""
TOUCHING = 0.06
"""Distance of places that count as one, mm."""
FILLED, PART = 3.0, 1.5
"""How far from its place a filled area may be, mm, and a part of one that is there."""
HEAP = 14.0
"""Width plus height of the smallest extra ink that is not put together with its neighbours, mm."""

Owners = Mapping[int, list[tuple[float, float, int]]]
"""Stretches (from, to, element) that elements claim, by the piece of theirs."""


def extra(state: Comparison) -> tuple[ExtraStroke, ...]:
    """The extra ink, longest first; the findings of elements that are too long are changed accordingly."""
    rest = left(state.theirs, state.claimed())
    cad_lettering.strange_ink(state, rest)
    free = _outside_zones(state, rest)
    owners = _owners(state)
    found: list[tuple[list[Left], float]] = []
    excess: list[tuple[float, int, list[Left]]] = []
    for chain in _chains(state, free):
        size = sum(free[r] for r in chain)
        if size <= state.tolerance:
            continue
        before, after = _neighbours(state, chain, owners)
        if before is not None and after is not None and size < 4.5:
            continue  # one line drawn through where ours are two
        n = before if before is not None else after
        goes_on = n is not None and state.elements[n].kind in ("line", "arc", "curve") and _continues(state, n, chain, owners)
        if n is not None and goes_on and state.found[n].verdict is not None:
            excess.append((sum(r.b - r.a for r in chain), n, chain))
        elif size > LEAST:
            found.append((chain, size))
    for size, n, chain in sorted(excess, key=lambda x: -x[0]):
        _too_long(state, n, size, chain)
    drawn = pieces(state.theirs, [r for chain, _ in found for r in chain])
    return tuple(sorted((*_extra_lines(state, found), *_extra_areas(state, drawn), *_extra_text(state)), key=lambda x: -x.length))


def _outside_zones(state: Comparison, rest: list[Left]) -> dict[Left, float]:
    """Unclaimed stretches that are not wholly in zones where any ink, or short strokes, may lie: with their lengths outside, mm."""
    import shapely

    any_ink = shapely.union_all(_free_zones(state))
    both = shapely.union_all([any_ink, *(_polygon(z) for z in state.lettered)])
    free = pieces(state.theirs, rest)
    short = np.bincount(state.theirs.owner, state.theirs.length)[state.theirs.owner[free.owner]] < SHORT
    outside = np.zeros(len(rest))
    for zone, mine in ((both, short), (any_ink, ~short)):
        shapely.prepare(zone)
        ink = shapes(free.a[mine], free.b[mine])
        touched = shapely.intersects(zone, ink)
        outside[np.flatnonzero(mine)[touched]] = shapely.length(shapely.difference(ink[touched], zone))
        outside[np.flatnonzero(mine)[~touched]] = shapely.length(ink[~touched])
    return {r: size for r, size in zip(rest, outside.tolist(), strict=True) if size > 0.05}


def _free_zones(state: Comparison) -> list[Any]:
    """Polygons of hatchings, symbols and arrow heads, ours and theirs, in which any ink may lie."""
    import shapely

    zones = [_polygon(z) for z in state.zones]
    for e in state.elements:
        if e.kind == "circle" and e.radius <= HINGE:
            size = max(state.moved[e.view].scale, 1.0) if e.view in state.moved else 1.0  # it may have grown with the view
            zones.append(shapely.Point(e.centre.real, e.centre.imag).buffer(size * e.radius + 0.2))
        zones += [_polygon(h).buffer(0.35) for h in e.fills if len(h) > 2]
    for a in state.space.areas:
        if np.ptp(a.points.real) + np.ptp(a.points.imag) < 20:
            zones.append(shapely.MultiPoint(np.column_stack((a.points.real, a.points.imag))).convex_hull.buffer(0.05))
    return zones


def _polygon(z: Points) -> Any:
    import shapely

    return shapely.Polygon(np.column_stack((z.real, z.imag)))


def _chains(state: Comparison, rest: Iterable[Left]) -> Iterator[list[Left]]:
    """Stretches that follow one another along one stroke."""
    chain: list[Left] = []
    for r in sorted(rest):
        if chain:
            last = chain[-1]
            next_piece = r.piece == last.piece + 1 and state.theirs.owner[r.piece] == state.theirs.owner[last.piece]
            if next_piece and last.b > state.theirs.length[last.piece] - TOUCHING and r.a < TOUCHING:
                chain.append(r)
                continue
            yield chain
        chain = [r]
    if chain:
        yield chain


def _owners(state: Comparison) -> dict[int, list[tuple[float, float, int]]]:
    """Which elements claim which stretches of their pieces."""
    every, of = state.in_place, state.in_place_of
    found: dict[int, list[tuple[float, float, int]]] = {}
    for j, a, b, n in zip(every.theirs.tolist(), every.w0.tolist(), every.w1.tolist(), of.tolist(), strict=True):
        if b - a > 0.3 or state.elements[n].kind != "line":
            found.setdefault(j, []).append((a, b, n))
    for n, parts in state.owned.items():
        for j, a, b in parts:
            found.setdefault(j, []).append((a, b, n))
    return found


def _neighbours(state: Comparison, chain: list[Left], owners: Owners) -> tuple[int | None, int | None]:
    """The elements whose ink the chain continues at its beginning and at its end."""
    first, last, length = chain[0], chain[-1], state.theirs.length
    before = _ending(owners, first.piece, first.a)
    if before is None and first.a < TOUCHING and _same_line(state, first.piece, first.piece - 1):
        before = _ending(owners, first.piece - 1, length[first.piece - 1])
    after = _beginning(owners, last.piece, last.b)
    if after is None and last.b > length[last.piece] - TOUCHING and _same_line(state, last.piece, last.piece + 1):
        after = _beginning(owners, last.piece + 1, 0.0)
    return before, after


def _ending(owners: Owners, piece: int, at: float) -> int | None:
    """The element with the longest claim that ends at a place on a piece."""
    return max(((b - a, n) for a, b, n in owners.get(piece, ()) if abs(b - at) < TOUCHING), default=(0.0, None))[1]


def _beginning(owners: Owners, piece: int, at: float) -> int | None:
    return max(((b - a, n) for a, b, n in owners.get(piece, ()) if abs(a - at) < TOUCHING), default=(0.0, None))[1]


def _same_line(state: Comparison, j: int, k: int) -> bool:
    return 0 <= k < len(state.theirs.owner) and bool(state.theirs.owner[j] == state.theirs.owner[k])


def _continues(state: Comparison, n: int, chain: list[Left], owners: Owners) -> bool:
    """Whether the chain goes on as the element does: straight, or along the same curve."""
    # A line that only crosses or touches the element is another one.
    j = chain[0].piece
    same = state.theirs.owner == state.theirs.owner[j]
    mine = sum(b - a for k, parts in owners.items() if same[k] for a, b, m in parts if m == n)
    if mine < 0.5 * state.whole(n) and mine < 0.3 * float(state.theirs.length[same].sum()):
        return False
    if state.elements[n].kind != "line":
        return True
    z = state.elements[n].points
    u = (z[-1] - z[0]) / abs(z[-1] - z[0])
    d = state.theirs.b[chain[0].piece] - state.theirs.a[chain[0].piece]
    middle = complex(state.ends(chain[0]).mean())
    if 0 < ((middle - z[0]) * np.conj(u)).real < abs(z[-1] - z[0]):
        return False  # beside the element, not beyond its end
    return bool(abs((d * np.conj(u)).imag) < 0.03 * abs(d)) and len(chain) == 1


def _too_long(state: Comparison, n: int, size: float, chain: list[Left]) -> None:
    """Add an excess to the finding of an element."""
    e, old = state.elements[n], state.found[n]
    if e.style in LOOSE_STYLES and size < BEYOND:
        return
    r = chain[0]
    piece = state.theirs.b[r.piece] - state.theirs.a[r.piece]
    at = complex(state.theirs.a[r.piece] + (r.a + r.b) / 2 * piece / abs(piece))
    remark = codes.TOO_LONG_AT(by=Number(f"{size:.1f}"), place=place(at))
    loop = _loop(state, n, size, at, chain) if e.kind != "line" else None
    if loop is not None:
        size, at = loop
        if size <= old.deviation:
            return  # it is farther off elsewhere
        remark = farthest(size, at)
    deviation = max(old.deviation, size)
    judged = verdict(deviation, state.tolerance)
    if judged == "red" and e.style in LOOSE_STYLES and old.verdict != "red":
        judged = "amber"
    where = (at, 5.0) if old.verdict == "green" else (old.at, old.reach)
    entities = tuple(dict.fromkeys((*old.entities, *state.entities_of([r.piece]))))
    state.found[n] = replace(old, deviation=deviation, verdict=judged, remark=joined((old.remark, remark)),
                             at=where[0], reach=where[1], size=(old.size or 0.0) + size, entities=entities)


def _loop(state: Comparison, n: int, size: float, at: complex, chain: list[Left]) -> tuple[float, complex] | None:
    """How far, and where, a chain is off a curve beside it, as when one way of a path there and back is wrong."""
    ends = np.concatenate([state.ends(r) for r in chain])
    foot, _, near = lines(state.paths[n]).nearest(ends, CURVE_REACH)
    ends_of_curve = np.concatenate([p[[0, -1]] for p in state.paths[n]])
    if not near.all() or np.abs(ends_of_curve - at).min() <= size:
        return None
    off = np.abs(foot - ends)
    return float(off.max()), complex(ends[off.argmax()])


def _extra_lines(state: Comparison, extra: list[tuple[list[Left], float]]) -> Iterator[ExtraStroke]:
    """Extra lines by entity; small ones that lie together (letters of a drawn text, a symbol) as one."""
    by_entity: dict[int, list[tuple[list[Left], float]]] = {}
    for chain, size in extra:
        by_entity.setdefault(int(state.entity[chain[0].piece]), []).append((chain, size))
    small: list[tuple[int, float, Points]] = []
    whole = np.zeros(len(state.space.entities))
    np.add.at(whole, state.entity, state.theirs.length)
    for k, found in by_entity.items():
        z = np.concatenate([state.ends(r) for chain, _ in found for r in chain])
        size = sum(s for _, s in found)
        if size > 0.5 * whole[k]:  # the rest of it coincides with lines of the sheet by chance
            mine = state.entity == k
            z, size = np.concatenate((state.theirs.a[mine], state.theirs.b[mine])), float(whole[k])
        if np.ptp(z.real) + np.ptp(z.imag) < HEAP:
            small.append((k, size, z))
        else:
            yield _stroke(state.space.entities[k], size, z)
    middles = np.array([middle_of(z) for _, _, z in small], dtype=complex)
    for heap in hanging_together(len(small), *np.nonzero(np.abs(middles[:, None] - middles) < 5.0)):
        z = np.concatenate([small[k][2] for k in heap])
        yield _stroke(state.space.entities[small[heap[0]][0]], sum(small[k][1] for k in heap), z, len(heap))


def _stroke(entity: Entity, size: float, z: Points, count: int = 1) -> ExtraStroke:
    """So many mm of line through some points, from an entity and others beside it."""
    return ExtraStroke("arc" if entity.kind in ROUND else "line", entity, size, middle_of(z), reach_of(z), count)


def _extra_areas(state: Comparison, extra: KnownLines) -> Iterator[ExtraStroke]:
    """Extra filled areas; the heads of ``extra`` lines are told with these."""
    known = np.array([complex(h.mean()) for e in state.elements for h in e.fills], dtype=complex)
    used = state.areas[sorted(state.used_areas)]
    # Of what is drawn as an area another piece may be one, too: half a head.
    reach = np.array([PART if (np.abs(used - z) < FILLED).any() else FILLED for z in known])
    for k, area in enumerate(state.space.areas):
        z = area.points
        around = float(np.abs(np.diff(np.append(z, z[:1]))).sum())
        if k in state.used_areas or not area.solid or around < 2.0:
            continue
        if (np.abs(known - state.areas[k]) < reach).any() or extra.nearest(z, AT_TIP)[2].any():
            continue
        yield ExtraStroke("fill", state.space.entities[area.entity], around, middle_of(z), reach_of(z))


def _extra_text(state: Comparison) -> Iterator[ExtraStroke]:
    for k, w in enumerate(state.space.writings):
        if k not in state.used_writings and normal(w.text):
            yield ExtraStroke("text", state.space.entities[w.entity], 0.0, w.at, max(w.width, 4.0) / 2, 1, w.text.strip())
