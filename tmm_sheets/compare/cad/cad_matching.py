"""What was meant: for an element that is not in its place the line, circle or curve that was drawn for it, and how it is off."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import pi

import numpy as np

from tmm_sheets.compare.cad.cad_comparison import BEYOND, CURVE_REACH, JOINT, LOOSE_STYLES, SIZE_OF_SYMBOL, SYMBOL, Comparison
from tmm_sheets.compare.cad.cad_findings import more, moved
from tmm_sheets.compare.cad.overlaps import Circle, Left, Run, circle, gaps, overlaps, pieces, runs, union
from tmm_sheets.drawing.styles import line_type
from tmm_sheets.numbers import decimal

FARTHEST = 25.0
"""A line whose ends are farther off than this, mm, is another line."""


def circles(state: Comparison, wrong: list[int], rest: list[Left]) -> None:
    """Circles: the nearest of those that are left, by centre and radius."""
    wanted = [n for n in wrong if state.elements[n].kind == "circle"]
    if not wanted:
        return
    made = list(_fitted(state, rest))
    centres, radii = np.array([c.centre for c in made], dtype=complex), np.array([c.radius for c in made])
    pairs = []
    for n in wanted:
        e, m = state.elements[n], state.moves[n]
        at, r = complex(m(e.centre)), e.radius * (1.0 if e.radius <= SYMBOL else m.scale)
        if not len(made):
            break
        off = np.abs(centres - at) + np.abs(radii - r)
        pairs += [(float(off[k]), n, int(k)) for k in np.flatnonzero(off < min(max(3.0, 0.5 * r), 12.0))]
    used: set[int] = set()
    for _, n, k in sorted(pairs):
        if n in state.found or k in used:
            continue
        used.add(k)
        e, m, c = state.elements[n], state.moves[n], made[k]
        r = e.radius * (1.0 if e.radius <= SYMBOL else m.scale)
        shift, size = c.centre - complex(m(e.centre)), c.radius - r
        counted = max(abs(size) - SIZE_OF_SYMBOL, 0.0) if e.radius <= SYMBOL else abs(size)
        missing = (1 - c.part) * 2 * pi * c.radius if c.part < 0.97 else 0.0
        said = moved(shift, state.tolerance) + ([f"radius {more(size)}"] if counted > state.tolerance else [])
        said += [f"{missing:.1f} mm of it missing"] if missing > 0.5 else []
        state.found[n] = state.finding(n, max(abs(shift) + counted, missing), ", ".join(said), shift=shift, size=size,
                                      entities=state.entities_of_strokes(c.strokes))
        state.claim([(j, 0.0, float(state.theirs.length[j])) for j in state.of_strokes(c.strokes)], n)


def _fitted(state: Comparison, rest: list[Left]) -> Iterator[Circle]:
    """Circles and arcs among the lines that are not claimed; parts of one circle put together."""
    free: dict[int, float] = {}
    for piece, a, b in rest:
        k = int(state.theirs.owner[piece])
        free[k] = free.get(k, 0.0) + b - a
    arcs: list[tuple[complex, float, float, int]] = []
    for k, size in free.items():
        z = state.space.strokes[k].points
        whole = float(np.abs(np.diff(z)).sum())
        if len(z) < 5 or size < 0.5 * whole:
            continue
        fit = circle(z)
        if fit is None or fit[2] > 0.03 + 0.01 * fit[1]:
            continue
        arcs.append((fit[0], fit[1], min(whole / (2 * pi * fit[1]), 1.0), k))
    while arcs:
        c, r, part, k = arcs.pop()
        same = [a for a in arcs if abs(a[0] - c) < 0.05 + 0.01 * r and abs(a[1] - r) < 0.05 + 0.01 * r]
        if part < 0.97 and same:
            arcs = [arc for arc in arcs if arc not in same]
            part = min(part + sum(arc[2] for arc in same), 1.0)
            yield Circle(c, r, part, (k, *(arc[3] for arc in same)))
        elif part > 0.2:
            yield Circle(c, r, part, (k,))


def straight(state: Comparison, wrong: list[int], partly: Mapping[int, list[tuple[float, float]]], rest: list[Left]) -> None:
    """Lines: of those that are left the one whose ends are nearest."""
    wanted = [n for n in wrong if state.elements[n].kind == "line" and n not in state.found]
    free = pieces(state.theirs, rest)
    made = runs(free, 0.1)
    wide = [r for r in runs(free, 4.5) if len(r.parts) > 1]
    plain = {r.parts for r in made}
    first_wide = len(made)
    made += [r for r in wide if r.parts not in plain]
    if not made or not wanted:
        return
    a, b = np.array([r.a for r in made]), np.array([r.b for r in made])
    along = (b - a) / np.abs(b - a)
    # Where other elements have claimed a stretch at its end, the line goes on under them.
    before, after = (np.array(x) for x in zip(*(_under(state, r, rest) for r in made), strict=True))
    tip_a, tip_b = np.array([_tip(state, r, -1) for r in made]), np.array([_tip(state, r, 1) for r in made])
    pairs = []
    for n in wanted:
        p, q = (complex(z) for z in state.moves[n](state.elements[n].points))
        u = (q - p) / abs(q - p)
        farthest = min(max(3.0, 0.35 * abs(q - p)), FARTHEST)
        straight = np.abs(((b - a) * np.conj(u)).imag) < 0.4 * np.abs(b - a)
        if not line_type(state.elements[n].style).pattern:
            straight[first_wide:] = False  # only what is dashed may have gaps
        to_p, to_q = ((z - a) * np.conj(along) for z in (p, q))
        size = np.abs(b - a)
        forth = a + along * np.clip(to_p.real, before, 0), b + along * np.clip(to_q.real - size, 0, after)
        back = b + along * np.clip(to_p.real - size, 0, after), a + along * np.clip(to_q.real, before, 0)
        for c, d in (forth, back, (tip_a, tip_b), (tip_b, tip_a)):
            off = np.maximum(np.abs(c - p), np.abs(d - q))
            near = np.flatnonzero(straight & (off < farthest)).tolist()
            pairs += [(float(off[k]), n, k, complex(c[k]), complex(d[k])) for k in near]
    pairs.sort(key=lambda x: x[0])
    used: set[int] = set()
    for again in (False, True):
        for far, n, k, one, other in pairs:
            taken = any(part in used for part in made[k].parts)
            if n in state.found or (taken and not (again and far < 3.0)):
                continue
            if far > _best_partly(state, n, partly):
                continue  # more of it is in its place
            used.update(made[k].parts)
            _line(state, n, one, other, made[k], rest)


def _under(state: Comparison, run: Run, rest: list[Left]) -> tuple[float, float]:
    """How far the lines of a run go on before its beginning (negative) and after its end, mm."""
    u = (run.b - run.a) / abs(run.b - run.a)
    j = [rest[k].piece for k in run.parts]
    t = ((np.concatenate((state.theirs.a[j], state.theirs.b[j])) - run.a) * np.conj(u)).real
    return min(float(t.min()), 0.0), max(float(t.max()) - abs(run.b - run.a), 0.0)


def _tip(state: Comparison, run: Run, end: int) -> complex:
    """The end of a run, produced to the point of an arrow head that sits on it."""
    z, other = (run.b, run.a) if end > 0 else (run.a, run.b)
    if not len(state.areas):
        return z
    u = (z - other) / abs(z - other)
    for k in np.flatnonzero(np.abs(state.areas - z) < 8.0):
        t = (state.space.areas[k].points - z) * np.conj(u)
        if np.abs(t.imag).max() < 3.0 and t.real.min() < 0.6 and abs(t.imag[t.real.argmax()]) < 0.3 and t.real.max() > 0:
            return complex(z + u * t.real.max())
    return z


def _best_partly(state: Comparison, n: int, partly: Mapping[int, list[tuple[float, float]]]) -> float:
    """How much of an element is missing where most of it is in its place; infinite where it is not."""
    whole = state.whole(n)
    lost = [y - x for x, y in gaps(partly.get(n, []), whole)]
    return max(lost, default=0.0) if sum(lost) < 0.5 * whole else np.inf


def _line(state: Comparison, n: int, c: complex, d: complex, run: Run, rest: list[Left]) -> None:
    p, q = (complex(z) for z in state.moves[n](state.elements[n].points))
    u = (q - p) / abs(q - p)
    shift = (c + d) / 2 - (p + q) / 2
    turn = float(np.degrees(np.angle((d - c) / (q - p))))
    size = abs(d - c) - abs(q - p)
    loose = state.elements[n].style in LOOSE_STYLES
    ends = []
    for ours, theirs, out in ((p, c, -u), (q, d, u)):
        v = (theirs - ours) * np.conj(out)
        # A helper line may be longer at its ends.
        ends.append(complex(0.0 if loose and 0 < v.real < BEYOND else v.real, v.imag))
    deviation = max(abs(v) for v in ends)
    across = abs((shift * np.conj(u)).imag)
    said = moved(1j * u * (shift * np.conj(u)).imag, state.tolerance, "aside ")
    if abs(np.radians(turn)) * abs(q - p) / 2 > max(state.tolerance, 0.3 * across):
        said.append(f"turned {decimal(turn, sign=True)}°")
    if abs(size) > state.tolerance:
        said.append(f"{abs(size):.2f} mm too {'long' if size > 0 else 'short'}")
    elif abs((shift * np.conj(u)).real) > state.tolerance:
        said.append(f"{abs((shift * np.conj(u)).real):.2f} mm along itself")
    entities = tuple(dict.fromkeys(int(state.entity[rest[k].piece]) for k in run.parts))
    state.found[n] = state.finding(n, deviation, ", ".join(said), shift=shift, turn=turn, size=size, entities=entities)
    state.claim([(rest[k].piece, rest[k].a, rest[k].b) for k in run.parts], n)


def curves(state: Comparison, wrong: list[int], partly: Mapping[int, list[tuple[float, float]]], rest: list[Left]) -> None:
    """Curves, arcs, and lines that no single line stands for: the distance of what lies along them."""
    wanted = [n for n in wrong if n not in state.found]
    free = pieces(state.theirs, rest)
    if not wanted or not len(free.a):
        return
    ours, of, base = state.ours(wanted)
    near = overlaps(ours, free, CURVE_REACH, 0.5, 0.12)
    owner = of[near.ours]
    for n in wanted:
        mine = near.only(owner == n)
        if not len(mine.ours):
            continue
        e, whole = state.elements[n], state.whole(n)
        t = np.linspace(0.0, whole, max(int(whole / 0.5), 8))
        off, using = np.full(len(t), np.nan), np.full(len(t), -1)
        s0, s1 = base[mine.ours] + mine.s0, base[mine.ours] + mine.s1
        for k in np.argsort(-np.abs(mine.off0 + mine.off1)):  # the nearest last: it stays
            on = (t >= s0[k] - 0.15) & (t <= s1[k] + 0.15)
            x = np.clip((t[on] - s0[k]) / max(s1[k] - s0[k], 1e-9), 0, 1)
            off[on], using[on] = mine.off0[k] + x * (mine.off1[k] - mine.off0[k]), k
        there = ~np.isnan(off)
        if there.mean() < 0.5:
            continue
        parts = union([*zip(s0.tolist(), s1.tolist(), strict=True), *partly.get(n, [])], state.gap(e) + JOINT)
        lost = [(a, b) for a, b in gaps(parts, whole) if b - a > max(state.tolerance, 0.4)]
        worst = float(np.abs(off[there]).max())
        if worst > _best_partly(state, n, partly):
            continue
        missing = max((b - a for a, b in lost), default=0.0)
        units = state.units(n, t)
        m = np.column_stack((units.imag, -units.real))[there]  # the normal to the left is i u: off = shift . (i u)
        solved = np.linalg.lstsq(-m, off[there], rcond=1e-6)[0]
        shift = complex(solved[0], solved[1])
        at = complex(state.at(n, float(t[there][np.abs(off[there]).argmax()])))
        said = []
        if worst > state.tolerance:
            said.append(f"up to {worst:.2f} mm off at ({at.real:.0f}, {at.imag:.0f})")
        if missing > 0:
            said.append(f"{missing:.1f} mm of it missing")
        kept = np.unique(using[there])
        entities = tuple(dict.fromkeys(int(state.entity[rest[mine.theirs[k]].piece]) for k in kept))
        state.found[n] = state.finding(n, max(worst, missing), ", ".join(said), shift=shift, entities=entities)
        claimed = [(rest[mine.theirs[k]], float(mine.w0[k]), float(mine.w1[k])) for k in kept]
        state.claim([(r.piece, r.a + w0, r.a + w1) for r, w0, w1 in claimed], n)


def partly(state: Comparison, wrong: list[int], partly: Mapping[int, list[tuple[float, float]]]) -> None:
    """What is in its place but not whole, and what is not there at all."""
    every, of = state.pass_one
    for n in wrong:
        if n in state.found:
            continue
        e, whole = state.elements[n], state.whole(n)
        lost = gaps(partly[n], whole)
        if _best_partly(state, n, partly) == np.inf:
            small = e.kind == "circle" and e.radius <= SYMBOL and bool(e.fills)
            if small:
                continue  # a dot: looked for among the filled areas
            state.found[n] = state.finding(n, whole, "missing", missing=True)
            continue
        a, b = max(lost, key=lambda g: g[1] - g[0])
        allowed = state.tolerance
        deviation = b - a if b - a > allowed else state.tolerance
        at = state.at(n, (a + b) / 2)
        where = "too short" if a == 0 or b == whole else "a gap"
        mine = every.only(of == n)
        entities = tuple(dict.fromkeys(state.entity[mine.theirs].tolist()))
        state.found[n] = state.finding(n, deviation, f"{where}: {b - a:.1f} mm missing at ({at.real:.0f}, {at.imag:.0f})",
                                      size=-(b - a), entities=entities, at=at)
        state.claims.append(mine)
