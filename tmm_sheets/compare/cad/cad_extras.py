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

from tmm_sheets.box import Box
from tmm_sheets.compare import codes
from tmm_sheets.compare.cad import cad_lettering
from tmm_sheets.compare.cad.cad_comparison import (
    BEYOND,
    LOOSE_STYLES,
    CadFinding,
    Comparison,
    ExtraStroke,
    reach_of,
)
from tmm_sheets.compare.cad.cad_ink import Entity, normal
from tmm_sheets.compare.cad.line_fit import KnownLines, Left, Numbers, common, extent, hanging_together, pieces, shapes
from tmm_sheets.compare.cad.plan_ink import CENTRES, RESULTANTS
from tmm_sheets.compare.cad.symbol_matching import AT_TIP, NEAR
from tmm_sheets.compare.codes import Number, joined
from tmm_sheets.compare.elements import Element, grouped, grown
from tmm_sheets.compare.findings import place, verdict
from tmm_sheets.compare.placing import HINGE
from tmm_sheets.drawing.marks import Points
from tmm_sheets.words import marked_n

FEW = 0.35
"""Share of what there should be of a kind below which it is left out."""
SEVERAL = 3
"""Of fewer in a view each is judged by itself, unless the whole drawing leaves the kind out."""
DRAWN_SHARE = 0.6
"""Share of a line that must have ink for the line to be drawn."""
FOUND_LAST = frozenset({"text", "point", "hatch"})
"""Kinds of what is looked for when lines have their ink."""

KINDS: Mapping[str, tuple[str, str]] = {
    "construction": marked_n("{n} construction line", "{n} construction lines"),
    "symbol": marked_n("{n} line of a symbol", "{n} lines of symbols"),
    "joint": marked_n("{n} circle of a joint", "{n} circles of joints"),
    "arrow": marked_n("{n} round arrow", "{n} round arrows"),
    "dimension": marked_n("{n} line of a dimension", "{n} lines of dimensions"),
    "table": marked_n("{n} line of a table", "{n} lines of a table"),
    "hatch": marked_n("{n} hatching", "{n} hatchings"),
    "frame": marked_n("{n} line of a frame", "{n} lines of a frame"),
    "axis": marked_n("{n} line of the axes", "{n} lines of the axes"),
    "point": marked_n("{n} dot", "{n} dots"),
    "text": marked_n("{n} text", "{n} texts"),
    CENTRES: marked_n("{n} vector to a centre of mass", "{n} vectors to centres of mass"),
    RESULTANTS: marked_n("{n} resultant", "{n} resultants"),
}
"""What may be left out, and how many of a kind in words."""


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


def left_out(state: Comparison, kinds: Collection[str]) -> None:
    """Set aside the kinds that views do not have; of a view in which nothing tells, the whole drawing does."""
    judged = [n for n, e in enumerate(state.elements)
              if e.view.n and kind_of(e) in kinds and (n not in state.found or state.found[n].verdict is not None)]
    of = grouped(judged, lambda n: (kind_of(state.elements[n]), state.elements[n].view))
    drawn = {n: there > DRAWN_SHARE for some in of.values() for n in some if (there := _share(state, n)) is not None}
    for (kind, view), numbers in of.items():
        if view in state.moved and kind in FOUND_LAST:
            _set_aside(state, [n for n in numbers if state.found[n].missing or _is_other_text(state, n)], kind)
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


def _is_other_text(state: Comparison, n: int) -> bool:
    """Whether a text that stands there is none for this one: a title, a label without some of its parts, or that of another."""
    e, finding = state.elements[n], state.found[n]
    if e.kind != "text" or finding.says is None:
        return False
    letters = {part for other in state.elements if other.view == e.view and other.kind == "text"
               for part in (cad_lettering.meant(other.text), *cad_lettering.parts(other.text))}
    return not e.step or cad_lettering.meant(finding.says) in letters or cad_lettering.says_less(finding.says, e.text)


def _set_aside(state: Comparison, numbers: Sequence[int], kind: str) -> None:
    """Leave elements out of the comparison; those of them that are drawn all the same are not extra."""
    for n in numbers:
        e = state.elements[n]
        state.found[n] = CadFinding(e, None, 0.0, codes.NOT_DRAWN(), e.middle, 5.0, missing=True, absent=kind)
        if extent(state.inked.pop(n, [])) > DRAWN_SHARE * state.whole(n):
            state.claim(state.in_place.only(state.in_place_of == n).inked)
    disc = (HINGE + 0.2) * np.exp(2j * np.pi * np.arange(12) / 12)
    state.zones += [e.centre + disc for e in (state.elements[n] for n in numbers) if e.kind == "circle" and e.radius <= HINGE]


SHORT = 12.0
"""Strokes shorter than this may belong to lettering, mm."""
LEAST = 1.0
"""Shortest stretch of extra ink, mm."""
ROUND = frozenset({"ARC", "CIRCLE", "ELLIPSE"})
"""Entities that are told as arcs."""
SHORT_GAP = 4.5
"""Gap between two lines of the sheet, mm, that a line drawn through may close."""
TOUCHING = 0.06
"""Distance of places that count as one, mm."""
HEAP = 14.0
"""Width plus height of the smallest extra ink that is not put together with its neighbours, mm."""


def extra(state: Comparison) -> tuple[ExtraStroke, ...]:
    """The extra ink, longest first; the findings of elements that are too long are changed accordingly."""
    rest = state.unclaimed()
    free = _outside_zones(state, rest)
    length, owner = state.theirs.length, state.theirs.owner
    along = np.cumsum(length) - length + owner  # strokes lie a millimetre apart
    whole, first = np.bincount(owner, length), np.searchsorted(owner, np.arange(len(state.space.strokes)))
    mostly = _main_owners(state)
    found: list[tuple[list[Left], float]] = []
    excess: list[tuple[float, int, list[Left]]] = []
    for chain in _chains(along, free):
        size, stroke = sum(free[r] for r in chain), int(owner[chain[0].piece])
        if size <= state.tolerance:
            continue
        begin, end = (along[r.piece] + at - along[first[stroke]] for r, at in ((chain[0], chain[0].a), (chain[-1], chain[-1].b)))
        if begin > TOUCHING and end < whole[stroke] - TOUCHING and size < SHORT_GAP:
            continue  # one line drawn through where ours are two
        mine, n = mostly.get(stroke, (0.0, -1))
        sure = n >= 0 and state.found[n].verdict is not None and (mine >= 0.5 * state.whole(n) or mine >= 0.3 * whole[stroke])
        if sure and _continues(state, n, chain):
            excess.append((sum(r.b - r.a for r in chain), n, chain))
        elif size > LEAST:
            found.append((chain, size))
    for size, n, chain in sorted(excess, key=lambda x: -x[0]):
        _too_long(state, n, size, chain)
    drawn = pieces(state.theirs, [r for chain, _ in found for r in chain])
    texts = (ExtraStroke("text", state.space.entities[w.entity], 0.0, w.at, max(w.width, 4.0) / 2, 1, w.text.strip())
             for k, w in enumerate(state.space.writings) if k not in state.used_writings and normal(w.text))
    return tuple(sorted((*_extra_lines(state, found), *_extra_areas(state, drawn), *texts), key=lambda x: -x.length))


def _main_owners(state: Comparison) -> dict[int, tuple[float, int]]:
    """The element that most of a stroke belongs to, and how much, mm, by the number of the stroke."""
    every = state.in_place
    owned = np.array([(j, n, b - a) for n, parts in state.owned.items() for j, a, b in parts]).reshape(-1, 3)
    piece, owner = (np.concatenate((x, owned[:, k].astype(np.int64))) for k, x in ((0, every.theirs), (1, state.in_place_of)))
    pairs, k = np.unique(np.stack((state.theirs.owner[piece], owner)), axis=1, return_inverse=True)
    sums = np.bincount(k.ravel(), np.concatenate((every.w1 - every.w0, owned[:, 2])), pairs.shape[1])
    return {int(stroke): (float(most), int(n)) for most, stroke, n in sorted(zip(sums, *pairs, strict=True))}


def _outside_zones(state: Comparison, rest: list[Left]) -> dict[Left, float]:
    """Unclaimed stretches that are not wholly in zones where any ink, or short strokes, may lie: with their lengths outside, mm."""
    import shapely

    any_ink = shapely.union_all(_free_zones(state))
    lettering = (grown(f.element.points, 0.8) for f in state.found.values() if f.element.kind == "text" and not f.missing)
    both = shapely.union_all([any_ink, *map(_polygon, lettering)])
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


def _chains(along: Numbers, rest: Iterable[Left]) -> Iterator[list[Left]]:
    """Stretches that follow one another along one stroke."""
    chain: list[Left] = []
    for r in sorted(rest):
        if chain and along[r.piece] + r.a > along[chain[-1].piece] + chain[-1].b + TOUCHING:
            yield chain
            chain = []
        chain.append(r)
    if chain:
        yield chain


def _continues(state: Comparison, n: int, chain: list[Left]) -> bool:
    """Whether the chain goes on as the element does: straight, or along the same curve."""
    e, j = state.elements[n], chain[0].piece
    if e.kind != "line":
        return e.kind in ("arc", "curve")
    u = (e.points[-1] - e.points[0]) / abs(e.points[-1] - e.points[0])
    d = state.theirs.b[j] - state.theirs.a[j]
    middle = complex(state.ends(chain[0]).mean())
    beyond = not 0 < ((middle - e.points[0]) * np.conj(u)).real < abs(e.points[-1] - e.points[0])  # its end, not beside it
    return bool(beyond and abs((d * np.conj(u)).imag) < 0.03 * abs(d)) and len(chain) == 1


def _too_long(state: Comparison, n: int, size: float, chain: list[Left]) -> None:
    """Add an excess to the finding of an element."""
    e, old = state.elements[n], state.found[n]
    if e.style in LOOSE_STYLES and size < BEYOND:
        return
    at = complex(state.ends(chain[0]).mean())
    remark = codes.TOO_LONG_AT(by=Number(f"{size:.1f}"), place=place(at))
    deviation = max(old.deviation, size)
    judged = verdict(deviation, state.tolerance)
    if judged == "red" and e.style in LOOSE_STYLES and old.verdict != "red":
        judged = "amber"
    where = (at, 5.0) if old.verdict == "green" else (old.at, old.reach)
    entities = tuple(dict.fromkeys((*old.entities, *state.entities_of([chain[0].piece]))))
    state.found[n] = replace(old, deviation=deviation, verdict=judged, remark=joined((old.remark, remark)),
                             at=where[0], reach=where[1], size=(old.size or 0.0) + size, entities=entities)


def _extra_lines(state: Comparison, extra: list[tuple[list[Left], float]]) -> Iterator[ExtraStroke]:
    """Extra lines by entity; small ones that lie together (letters of a drawn text, a symbol) as one."""
    by_entity = grouped(extra, lambda chain: int(state.entity[chain[0][0].piece]))
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
    middles = np.array([Box.around(z).centre for _, _, z in small], dtype=complex)
    for heap in hanging_together(len(small), *np.nonzero(np.abs(middles[:, None] - middles) < 5.0)):
        z = np.concatenate([small[k][2] for k in heap])
        yield _stroke(state.space.entities[small[heap[0]][0]], sum(small[k][1] for k in heap), z, len(heap))


def _stroke(entity: Entity, size: float, z: Points, count: int = 1) -> ExtraStroke:
    """So many mm of line through some points, from an entity and others beside it."""
    return ExtraStroke("arc" if entity.kind in ROUND else "line", entity, size, Box.around(z).centre, reach_of(z), count)


def _extra_areas(state: Comparison, extra: KnownLines) -> Iterator[ExtraStroke]:
    """Extra filled areas; the heads of ``extra`` lines are told with these."""
    known = np.array([complex(h.mean()) for e in state.elements for h in e.fills], dtype=complex)
    for k, area in enumerate(state.space.areas):
        z = area.points
        around = float(np.abs(np.diff(np.append(z, z[:1]))).sum())
        if k in state.used_areas or not area.solid or around < 2.0:
            continue
        if (np.abs(known - state.areas[k]) < NEAR).any() or extra.nearest(z, AT_TIP)[2].any():
            continue
        yield ExtraStroke("fill", state.space.entities[area.entity], around, Box.around(z).centre, reach_of(z))
