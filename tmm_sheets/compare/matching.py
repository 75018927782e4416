"""The elements of a sheet against the lines of a CAD drawing laid over it: what is off, and by how much.

In this order, so that nothing is taken for what it is not:

1. Elements with ink all along, within the tolerance, are right, whatever entities the ink is made of. They claim it.
2. The others look among what is left for the line, circle or curve that was meant: shifted, turned, too long, with a gap.
3. What no element claims is too long an end of one that does, or it is extra.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare import cad_text
from tmm_sheets.compare.cad_ink import Area, Entity, Space, Stroke, Writing
from tmm_sheets.compare.elements import Element, View
from tmm_sheets.compare.overlaps import (
    Circle,
    Left,
    Numbers,
    Overlaps,
    Run,
    circle,
    gaps,
    left,
    overlaps,
    pieces,
    runs,
    together,
    union,
)
from tmm_sheets.compare.placing import Lines, Placing, lines, shapes
from tmm_sheets.compare.report import Verdict, verdict
from tmm_sheets.drawing.ink import letters
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
FARTHEST = 25.0
"""A line whose ends are farther off than this, mm, is another line."""
CURVE_REACH = 6.0
"""How far from its place a curve is looked for, mm."""
LEAST = 1.0
"""Stretches of extra ink shorter than this do not count, mm."""


@dataclass(frozen=True, eq=False)
class Finding:
    """The outcome for one element.

    ``verdict`` is None when the element was not compared; ``deviation`` mm; ``shift`` mm (right, up), ``turn`` degrees
    counter-clockwise, ``size`` mm (length of lines, radius of circles) where they can be told apart; ``missing`` when it is not
    there at all. ``entities`` are numbers of entities of the drawing, ``at`` and ``reach`` where to look on the sheet.
    """

    element: Element
    verdict: Verdict | None
    deviation: float
    what: str
    at: complex
    reach: float
    shift: complex | None = None
    turn: float | None = None
    size: float | None = None
    missing: bool = False
    entities: tuple[int, ...] = ()


@dataclass(frozen=True)
class Extra:
    """Ink or text of the drawing that belongs to no element: ``length`` mm of it, about ``at``; ``count`` entities in a heap."""

    entity: Entity
    length: float
    at: complex
    reach: float
    count: int = 1
    text: str = ""

    @property
    def verdict(self) -> Verdict:
        """A short piece may be a slip of the pen."""
        return "red" if self.length > 5.0 else "amber"


@dataclass(frozen=True)
class Outcome:
    """Findings for every element in its order, extras longest first."""

    findings: tuple[Finding, ...]
    extras: tuple[Extra, ...]


def placed(space: Space, placing: Placing) -> Space:
    """A space laid on the sheet, mm."""
    size, angle = placing.scale, float(np.angle(placing.turn))
    sign = -1.0 if placing.mirrored else 1.0
    return replace(
        space,
        strokes=tuple(Stroke(placing(s.points), s.entity) for s in space.strokes),
        areas=tuple(Area(placing(a.points), a.entity, a.solid) for a in space.areas),
        writings=tuple(Writing(w.text, complex(placing(w.at)), w.height * size, w.width * size, sign * w.angle + angle, w.entity)
                       for w in space.writings),
    )


def match(elements: Sequence[Element], space: Space, moves: Mapping[View, Placing], tolerance: float,
          say: Callable[[str], None] = lambda _: None) -> Outcome:
    """Compare the elements with a drawing that was laid on the sheet.

    Parameters
    ----------
    elements : of one sheet
    space : the drawing, in mm of the sheet (:func:`placed`)
    moves : where views stand in the drawing that have another place or size there than on the sheet
    tolerance : what a point may be off, mm
    """
    return _Matcher(elements, space, moves, tolerance).outcome(say)


class _Matcher:
    """The state of one comparison: what is still free of their ink."""

    def __init__(self, elements: Sequence[Element], space: Space, moves: Mapping[View, Placing], tolerance: float) -> None:
        self.elements, self.space, self.tolerance = elements, space, tolerance
        self.moves = [moves.get(e.view, Placing()) for e in elements]
        self.theirs = lines(s.points for s in space.strokes)
        self.entity = np.array([s.entity for s in space.strokes], dtype=np.int64)[self.theirs.owner]
        self.paths = [self._paths(e, m) for e, m in zip(elements, self.moves, strict=True)]
        self.heads = [tuple(m(f) for f in e.fills) for e, m in zip(elements, self.moves, strict=True)]
        self.found: dict[int, Finding] = {}
        self.claims: list[Overlaps] = []
        self.owned: dict[int, list[tuple[int, float, float]]] = {}
        self.areas = np.array([complex(a.points.mean()) for a in space.areas], dtype=complex)
        self.used_areas: set[int] = set()
        self.used_writings: set[int] = set()
        self.zones: list[Points] = []
        self.drawn_letters: list[tuple[int, cad_text.Wanted]] = []

    # --- our side -------------------------------------------------------------------------------------------------

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

    def _ours(self, numbers: Sequence[int]) -> tuple[Lines, npt.NDArray[np.int64], Numbers]:
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

    def _whole(self, n: int) -> float:
        return float(sum(np.abs(np.diff(p)).sum() for p in self.paths[n]))

    def _gap(self, e: Element) -> float:
        """The longest gap that is none."""
        pattern = line_type(e.style).pattern
        return 2 * max((-x for x in pattern if x < 0), default=0.0) + JOINT if pattern else JOINT

    # --- the steps ------------------------------------------------------------------------------------------------

    def outcome(self, say: Callable[[str], None]) -> Outcome:
        """Everything in turn."""
        say("comparing lines")
        numbers = [n for n, e in enumerate(self.elements) if self.paths[n] and e.kind != "hatch"]
        self._not_compared()
        ours, of, base = self._ours(numbers)
        every = overlaps(ours, self.theirs, self.tolerance)
        wrong, partly = self._right(numbers, every, of, base)
        say("comparing lettering")
        self._lettering()
        self._hatching()
        say("looking for what was meant")
        rest = left(self.theirs, self._claimed())
        self._circles(wrong, rest)
        self._straight(wrong, partly, rest)
        self._curves(wrong, partly, rest)
        self._partly(wrong, partly)
        self._filled()
        self._arrows()
        say("looking for what is extra")
        extras = self._extra()
        for n, e in enumerate(self.elements):
            if n not in self.found:
                self.found[n] = self._finding(n, 0.0, "")
            assert self.found[n].element is e
        return Outcome(tuple(self.found[n] for n in range(len(self.elements))), extras)

    def _not_compared(self) -> None:
        """Symbols keep their size where a view has another scale: only what grows with it is compared."""
        for n, (e, m) in enumerate(zip(self.elements, self.moves, strict=True)):
            if abs(m.scale - 1) < 1e-3:
                continue
            size = float(np.ptp(e.points.real) + np.ptp(e.points.imag))
            small = e.kind in ("hatch", "fill") or (e.kind in ("curve", "arc") and size < 40)
            if small or (e.kind == "line" and e.length < 16 and e.style != "vector"):
                self.found[n] = Finding(e, None, 0.0, "a symbol in a view of another scale", complex(m(e.middle)), 5.0)

    def _right(self, numbers: list[int], every: Overlaps, of: npt.NDArray[np.int64], base: npt.NDArray[np.float64],
               ) -> tuple[list[int], dict[int, list[tuple[float, float]]]]:
        """Elements with ink all along; the numbers of the others and where they have ink."""
        owner = of[every.ours]
        s0, s1 = base[every.ours] + every.s0, base[every.ours] + every.s1
        order = np.lexsort((s0, owner))
        owner, s0, s1 = owner[order], s0[order], s1[order]
        off = (np.abs(every.off0 + every.off1) / 2)[order]
        bounds = np.searchsorted(owner, np.arange(len(self.elements) + 1))
        wrong, partly, right = [], {}, np.zeros(len(self.elements), bool)
        for n in numbers:
            if n in self.found:
                continue
            p, q = bounds[n], bounds[n + 1]
            e, whole = self.elements[n], self._whole(n)
            parts = union(zip(s0[p:q].tolist(), s1[p:q].tolist(), strict=True), self._gap(e))
            if all(b - a <= self.tolerance + 1e-9 for a, b in gaps(parts, whole)) and parts:
                # Between the dashes only ink of others can lie.
                nearest = _nearest(s0[p:q], s1[p:q], off[p:q], whole)
                typical = float(np.median(nearest) if line_type(e.style).pattern else nearest.max()) if len(nearest) else 0.0
                self.found[n] = self._finding(n, min(typical, self.tolerance), "")
                right[n] = True
            else:
                wrong.append(n)
                partly[n] = parts
        self.claims.append(every.only(right[of[every.ours]]))
        self.pass_one = every, of[every.ours]
        return wrong, partly

    def _claimed(self) -> Overlaps:
        return together(self.claims)

    def _claim(self, parts: Sequence[tuple[int, float, float]], n: int) -> None:
        """Pieces of theirs (piece, from, to) that belong to element ``n``."""
        self.owned[n] = self.owned.get(n, []) + list(parts)
        if parts:
            j, a, b = (np.array(x) for x in zip(*parts, strict=True))
            z = np.zeros(len(parts))
            self.claims.append(Overlaps(np.full(len(parts), -1), z, z, j.astype(np.int64), a.astype(float), b.astype(float), z, z))

    def _finding(self, n: int, deviation: float, what: str, *, shift: complex | None = None, turn: float | None = None,
                 size: float | None = None, missing: bool = False, entities: tuple[int, ...] = (), at: complex | None = None,
                 cap: Verdict | None = None) -> Finding:
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

    # --- what was meant -------------------------------------------------------------------------------------------

    def _circles(self, wrong: list[int], rest: list[Left]) -> None:
        wanted = [n for n in wrong if self.elements[n].kind == "circle"]
        if not wanted:
            return
        made = list(self._fitted(rest))
        centres, radii = np.array([c.centre for c in made], dtype=complex), np.array([c.radius for c in made])
        pairs = []
        for n in wanted:
            e, m = self.elements[n], self.moves[n]
            at, r = complex(m(e.centre)), e.radius * (1.0 if e.radius <= SYMBOL else m.scale)
            if not len(made):
                break
            off = np.abs(centres - at) + np.abs(radii - r)
            pairs += [(float(off[k]), n, int(k)) for k in np.flatnonzero(off < min(max(3.0, 0.5 * r), 12.0))]
        used: set[int] = set()
        for _, n, k in sorted(pairs):
            if n in self.found or k in used:
                continue
            used.add(k)
            e, m, c = self.elements[n], self.moves[n], made[k]
            r = e.radius * (1.0 if e.radius <= SYMBOL else m.scale)
            shift, size = c.centre - complex(m(e.centre)), c.radius - r
            counted = max(abs(size) - SIZE_OF_SYMBOL, 0.0) if e.radius <= SYMBOL else abs(size)
            missing = (1 - c.part) * 2 * pi * c.radius if c.part < 0.97 else 0.0
            said = _moved(shift, self.tolerance) + ([f"radius {_more(size)}"] if counted > self.tolerance else [])
            said += [f"{missing:.1f} mm of it missing"] if missing > 0.5 else []
            self.found[n] = self._finding(n, max(abs(shift) + counted, missing), ", ".join(said), shift=shift, size=size,
                                          entities=self._entities_of_strokes(c.strokes))
            self._claim([(j, 0.0, float(self.theirs.length[j])) for j in self._of_strokes(c.strokes)], n)

    def _fitted(self, rest: list[Left]) -> Iterator[Circle]:
        """Circles and arcs among the lines that are not claimed; parts of one circle put together."""
        free: dict[int, float] = {}
        for piece, a, b in rest:
            k = int(self.theirs.owner[piece])
            free[k] = free.get(k, 0.0) + b - a
        arcs: list[tuple[complex, float, float, int]] = []
        for k, size in free.items():
            z = self.space.strokes[k].points
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

    def _straight(self, wrong: list[int], partly: Mapping[int, list[tuple[float, float]]], rest: list[Left]) -> None:
        wanted = [n for n in wrong if self.elements[n].kind == "line" and n not in self.found]
        free = pieces(self.theirs, rest)
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
        before, after = (np.array(x) for x in zip(*(self._under(r, rest) for r in made), strict=True))
        tip_a, tip_b = np.array([self._tip(r, -1) for r in made]), np.array([self._tip(r, 1) for r in made])
        pairs = []
        for n in wanted:
            p, q = (complex(z) for z in self.moves[n](self.elements[n].points))
            u = (q - p) / abs(q - p)
            farthest = min(max(3.0, 0.35 * abs(q - p)), FARTHEST)
            straight = np.abs(((b - a) * np.conj(u)).imag) < 0.4 * np.abs(b - a)
            if not line_type(self.elements[n].style).pattern:
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
                if n in self.found or (taken and not (again and far < 3.0)):
                    continue
                if far > self._best_partly(n, partly):
                    continue  # more of it is in its place
                used.update(made[k].parts)
                self._line(n, one, other, made[k], rest)

    def _under(self, run: Run, rest: list[Left]) -> tuple[float, float]:
        """How far the lines of a run go on before its beginning (negative) and after its end, mm."""
        u = (run.b - run.a) / abs(run.b - run.a)
        j = [rest[k].piece for k in run.parts]
        t = ((np.concatenate((self.theirs.a[j], self.theirs.b[j])) - run.a) * np.conj(u)).real
        return min(float(t.min()), 0.0), max(float(t.max()) - abs(run.b - run.a), 0.0)

    def _tip(self, run: Run, end: int) -> complex:
        """The end of a run, produced to the point of an arrow head that sits on it."""
        z, other = (run.b, run.a) if end > 0 else (run.a, run.b)
        if not len(self.areas):
            return z
        u = (z - other) / abs(z - other)
        for k in np.flatnonzero(np.abs(self.areas - z) < 8.0):
            t = (self.space.areas[k].points - z) * np.conj(u)
            if np.abs(t.imag).max() < 3.0 and t.real.min() < 0.6 and abs(t.imag[t.real.argmax()]) < 0.3 and t.real.max() > 0:
                return complex(z + u * t.real.max())
        return z

    def _best_partly(self, n: int, partly: Mapping[int, list[tuple[float, float]]]) -> float:
        """How much of an element is missing where most of it is in its place; infinite where it is not."""
        whole = self._whole(n)
        lost = [y - x for x, y in gaps(partly.get(n, []), whole)]
        return max(lost, default=0.0) if sum(lost) < 0.5 * whole else np.inf

    def _line(self, n: int, c: complex, d: complex, run: Run, rest: list[Left]) -> None:
        p, q = (complex(z) for z in self.moves[n](self.elements[n].points))
        u = (q - p) / abs(q - p)
        shift = (c + d) / 2 - (p + q) / 2
        turn = float(np.degrees(np.angle((d - c) / (q - p))))
        size = abs(d - c) - abs(q - p)
        loose = self.elements[n].style in LOOSE_STYLES
        ends = []
        for ours, theirs, out in ((p, c, -u), (q, d, u)):
            v = (theirs - ours) * np.conj(out)
            # A helper line may be longer at its ends.
            ends.append(complex(0.0 if loose and 0 < v.real < BEYOND else v.real, v.imag))
        deviation = max(abs(v) for v in ends)
        across = abs((shift * np.conj(u)).imag)
        said = _moved(1j * u * (shift * np.conj(u)).imag, self.tolerance, "aside ")
        if abs(np.radians(turn)) * abs(q - p) / 2 > max(self.tolerance, 0.3 * across):
            said.append(f"turned {turn:+.2f}°")
        if abs(size) > self.tolerance:
            said.append(f"{abs(size):.2f} mm too {'long' if size > 0 else 'short'}")
        elif abs((shift * np.conj(u)).real) > self.tolerance:
            said.append(f"{abs((shift * np.conj(u)).real):.2f} mm along itself")
        entities = tuple(dict.fromkeys(int(self.entity[rest[k].piece]) for k in run.parts))
        self.found[n] = self._finding(n, deviation, ", ".join(said), shift=shift, turn=turn, size=size, entities=entities)
        self._claim([(rest[k].piece, rest[k].a, rest[k].b) for k in run.parts], n)

    def _curves(self, wrong: list[int], partly: Mapping[int, list[tuple[float, float]]], rest: list[Left]) -> None:
        """Curves, arcs, and lines that no single line stands for: the distance of what lies along them."""
        wanted = [n for n in wrong if n not in self.found]
        free = pieces(self.theirs, rest)
        if not wanted or not len(free.a):
            return
        ours, of, base = self._ours(wanted)
        near = overlaps(ours, free, CURVE_REACH, 0.5, 0.12)
        owner = of[near.ours]
        for n in wanted:
            mine = near.only(owner == n)
            if not len(mine.ours):
                continue
            e, whole = self.elements[n], self._whole(n)
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
            parts = union([*zip(s0.tolist(), s1.tolist(), strict=True), *partly.get(n, [])], self._gap(e) + JOINT)
            lost = [(a, b) for a, b in gaps(parts, whole) if b - a > max(self.tolerance, 0.4)]
            worst = float(np.abs(off[there]).max())
            if worst > self._best_partly(n, partly):
                continue
            missing = max((b - a for a, b in lost), default=0.0)
            units = self._units(n, t)
            m = np.column_stack((units.imag, -units.real))[there]  # the normal to the left is i u: off = shift . (i u)
            solved = np.linalg.lstsq(-m, off[there], rcond=1e-6)[0]
            shift = complex(solved[0], solved[1])
            at = complex(self._at(n, float(t[there][np.abs(off[there]).argmax()])))
            said = []
            if worst > self.tolerance:
                said.append(f"up to {worst:.2f} mm off at ({at.real:.0f}, {at.imag:.0f})")
            if missing > 0:
                said.append(f"{missing:.1f} mm of it missing")
            kept = np.unique(using[there])
            entities = tuple(dict.fromkeys(int(self.entity[rest[mine.theirs[k]].piece]) for k in kept))
            self.found[n] = self._finding(n, max(worst, missing), ", ".join(said), shift=shift, entities=entities)
            claimed = [(rest[mine.theirs[k]], float(mine.w0[k]), float(mine.w1[k])) for k in kept]
            self._claim([(r.piece, r.a + w0, r.a + w1) for r, w0, w1 in claimed], n)

    def _units(self, n: int, t: npt.NDArray[np.float64]) -> Points:
        """Directions along an element's path at distances from its beginning."""
        z = np.concatenate(self.paths[n])
        d = np.diff(z)
        size = np.abs(d)
        d, size = d[size > 1e-9], size[size > 1e-9]
        k = np.clip(np.searchsorted(np.cumsum(size), t), 0, len(d) - 1)
        return np.asarray(d[k] / size[k])

    def _at(self, n: int, t: float) -> complex:
        z = np.concatenate(self.paths[n])
        along = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(z)))))
        return complex(np.interp(t, along, z.real), np.interp(t, along, z.imag))

    def _partly(self, wrong: list[int], partly: Mapping[int, list[tuple[float, float]]]) -> None:
        """What is in its place but not whole, and what is not there at all."""
        every, of = self.pass_one
        for n in wrong:
            if n in self.found:
                continue
            e, whole = self.elements[n], self._whole(n)
            lost = gaps(partly[n], whole)
            if self._best_partly(n, partly) == np.inf:
                small = e.kind == "circle" and e.radius <= SYMBOL and bool(e.fills)
                if small:
                    continue  # a dot: looked for among the filled areas
                self.found[n] = self._finding(n, whole, "missing", missing=True)
                continue
            a, b = max(lost, key=lambda g: g[1] - g[0])
            allowed = self.tolerance
            deviation = b - a if b - a > allowed else self.tolerance
            at = self._at(n, (a + b) / 2)
            where = "too short" if a == 0 or b == whole else "a gap"
            mine = every.only(of == n)
            entities = tuple(dict.fromkeys(self.entity[mine.theirs].tolist()))
            self.found[n] = self._finding(n, deviation, f"{where}: {b - a:.1f} mm missing at ({at.real:.0f}, {at.imag:.0f})",
                                          size=-(b - a), entities=entities, at=at)
            self.claims.append(mine)

    # --- areas, arrow heads, hatching -----------------------------------------------------------------------------

    def _filled(self) -> None:
        """Dots and other filled areas: something filled, or a circle, is there."""
        for n, e in enumerate(self.elements):
            if n in self.found or not (e.kind == "fill" or (e.kind == "circle" and e.fills)):
                continue
            centre = complex(self.heads[n][0].mean())
            off = np.abs(self.areas - centre) if len(self.areas) else np.zeros(0)
            if len(off) and off.min() < 2.0:
                k = int(off.argmin())
                self.used_areas.add(k)
                shift = complex(self.areas[k] - centre)
                counted = abs(shift) if e.kind == "circle" else max(abs(shift) - SIZE_OF_SYMBOL, 0.0)
                self.found[n] = self._finding(n, counted, ", ".join(_moved(shift, self.tolerance)), shift=shift,
                                              entities=(self.space.areas[k].entity,))
            else:
                what = "the dot is missing" if e.kind == "circle" else "not filled"
                self.found[n] = self._finding(n, 2 * self.tolerance, what, missing=True)

    def _arrows(self) -> None:
        """Heads: there, and at the right end."""
        heads = [(n, h) for n, e in enumerate(self.elements) if e.arrow for h in self.heads[n]]
        ours = np.array([complex(h.mean()) for _, h in heads], dtype=complex)
        none_at_all = not len(self.areas)
        for n, h in heads:
            finding = self.found.get(n)
            if finding is None or finding.missing or finding.verdict is None:
                continue
            tip = complex(h[0])
            if finding.shift is not None and finding.verdict != "green" and self.elements[n].kind == "line":
                # The line stands elsewhere, and so does its head.
                tip += finding.shift + (tip - self.moves[n](self.elements[n].middle)) * (
                    np.exp(1j * np.radians(finding.turn or 0.0)) - 1)
            reach = 1.5 + (0.6 * abs(finding.size or 0.0) if finding.verdict != "green" else 0.0)
            back = complex(h.mean() - h[0])
            of_others = ours[np.abs(ours - complex(h.mean())) > 0.3]
            off = self._head_at(tip, back / abs(back), reach, of_others)
            if off is not None and finding.verdict == "green" and off > self.tolerance:
                # The line of a hand drawing goes on under the head: only the head tells where it ends.
                self.found[n] = replace(finding, deviation=off, verdict=verdict(off, self.tolerance),
                                        what=f"the tip is {off:.2f} mm off", at=tip, reach=5.0)
            if none_at_all or off is not None or self._open_head(tip):
                continue
            z = self.moves[n](self.elements[n].points)
            tail = complex(z[0] if abs(z[0] - tip) > abs(z[-1] - tip) else z[-1])
            u = (tip - tail) / max(abs(tip - tail), 1e-9)
            t = (self.areas - tail) * np.conj(u)
            beside = (t.real > -0.5) & (t.real < 7.0) & (np.abs(t.imag) < 0.8)
            strange = [k for k in np.flatnonzero(beside) if np.abs(ours - self.areas[k]).min() > 0.7]
            if strange and self.elements[n].kind == "line" and len(self.heads[n]) == 1:
                self.used_areas.update(int(k) for k in strange)
                what, deviation = "points the other way", self.elements[n].length
            else:
                what, deviation = "no arrow head", 2 * self.tolerance
            said = ", ".join(x for x in (finding.what, what) if x)
            self.found[n] = replace(finding, verdict=verdict(max(deviation, finding.deviation), self.tolerance),
                                    deviation=max(deviation, finding.deviation), what=said)

    def _head_at(self, tip: complex, back: complex, reach: float, of_others: Points) -> float | None:
        """How far from the tip the head is that lies in the direction ``back`` of it: something filled, not the head of another."""
        best: float | None = None
        for k in np.flatnonzero(np.abs(self.areas - tip) < 6.0 + reach):
            z = self.space.areas[k].points
            corner = complex(z[np.abs(z - tip).argmin()])
            way = (complex(self.areas[k]) - corner) * back.conjugate()
            if abs(corner - tip) >= reach or way.real <= 1.5 * abs(way.imag):
                continue
            if len(of_others) and np.abs(of_others - self.areas[k]).min() < 0.3:
                continue
            self.used_areas.add(int(k))
            best = min(abs(corner - tip), reach if best is None else best)
        return best

    def _open_head(self, tip: complex) -> bool:
        """Two short lines that meet at the tip."""
        ends = (np.abs(self.theirs.a - tip) < 0.6) | (np.abs(self.theirs.b - tip) < 0.6)
        whole = np.bincount(self.theirs.owner, self.theirs.length)[self.theirs.owner]
        return int((ends & (whole < 16.0) & (self.theirs.length < 8.0) & (self.theirs.length > 1.0)).sum()) >= 2

    def _hatching(self) -> None:
        """Hatched regions: their own strokes, or anything hatched there."""
        numbers = [n for n, e in enumerate(self.elements) if e.kind == "hatch" and n not in self.found]
        if not numbers:
            return
        ours, of, _ = self._ours(numbers)
        near = overlaps(ours, self.theirs, self.tolerance)
        owner = of[near.ours]
        slanting = np.abs(np.abs(np.angle((self.theirs.b - self.theirs.a) ** 2)) - pi / 2) < 0.6
        middle = (self.theirs.a + self.theirs.b) / 2
        patterns = [a for a in self.space.areas if not a.solid]
        for n in numbers:
            mine = owner == n
            covered = float((near.s1 - near.s0)[mine].sum())
            z = self.moves[n](self.elements[n].points)
            x0, x1, y0, y1 = z.real.min() - 1.5, z.real.max() + 1.5, z.imag.min() - 1.5, z.imag.max() + 1.5
            inside = (middle.real > x0) & (middle.real < x1) & (middle.imag > y0) & (middle.imag < y1)
            theirs = float(self.theirs.length[inside & slanting].sum())
            filled = any(x0 <= p.real <= x1 and y0 <= p.imag <= y1 for a in patterns for p in [complex(a.points.mean())])
            good = covered > 0.8 * self._whole(n)
            if good or filled or theirs > 0.4 * self._whole(n):
                self.found[n] = self._finding(n, 0.0, "")
                self.claims.append(near.only(mine))
                if not good:
                    self.zones.append(np.array([complex(x0, y0), complex(x1, y0), complex(x1, y1), complex(x0, y1)]))
            else:
                self.found[n] = self._finding(n, 2 * self.tolerance, "not hatched", missing=True)

    # --- lettering ------------------------------------------------------------------------------------------------

    def _lettering(self) -> None:
        numbers = [n for n, e in enumerate(self.elements) if e.kind == "text"]
        wanted = []
        for n in numbers:
            e, m = self.elements[n], self.moves[n]
            middle = m(complex(e.points.mean()))
            wanted.append(cad_text.Wanted(e.text, middle + (e.points - complex(e.points.mean())), e.height))
        got = cad_text.read(wanted, self.space.writings)
        rest = [(n, w) for k, (n, w) in enumerate(zip(numbers, wanted, strict=True)) if k not in got]
        for k, answer in got.items():
            n = numbers[k]
            entities = tuple(self.space.writings[i].entity for i in answer.writings)
            self.used_writings.update(answer.writings)
            if answer.says is None:
                shift = complex(np.mean([self.space.writings[i].at for i in answer.writings])) - wanted[k].middle
                self.found[n] = self._finding(n, 0.0, "", shift=shift, entities=entities)
            else:
                self.found[n] = self._finding(n, 4 * self.tolerance, f'reads "{answer.says}" instead of "{self.elements[n].text}"',
                                              entities=entities)
            self._bars(n)
            self.zones.append(_grown(wanted[k].corners, 0.8))
        self._strokes_of_letters(rest)

    def _bars(self, n: int) -> None:
        """Overbars and leader lines of lettering are the draughtsman's: they are looked for only to be no extras."""
        self.claims += [overlaps(lines([self.moves[n](p)]), self.theirs, 1.0) for p in self.elements[n].pieces]

    def _strokes_of_letters(self, rest: Sequence[tuple[int, cad_text.Wanted]]) -> None:
        """Lettering that is drawn with lines, letter by letter."""
        strokes, owner = [], []
        glyphs: list[tuple[int, int]] = []  # element, first stroke
        for n, _ in rest:
            move = self.moves[n]
            for mark in self.elements[n].marks:
                if isinstance(mark, Text):
                    shift = complex(move(complex(self.elements[n].points.mean()))) - complex(self.elements[n].points.mean())
                    for stroke in letters(mark):
                        strokes.append(stroke + shift)
                        owner.append(n)
            glyphs.append((n, len(strokes)))
        ours = lines(strokes)
        near = overlaps(ours, self.theirs, max(self.tolerance, 0.25)) if len(ours.a) and len(self.theirs.a) else None
        covered = np.zeros(len(strokes))
        if near is not None:
            _add_unions(covered, near, ours)
        size = np.array([float(np.abs(np.diff(s)).sum()) for s in strokes])
        of = np.array(owner, dtype=np.int64)
        for n, want in rest:
            mine = of == n
            whole, share = size[mine].sum(), covered[mine].sum()
            # A single stroke of a letter may be short, but it is not mostly absent.
            lost = (size[mine] - covered[mine])[size[mine] > 0.3 * want.height]
            if whole > 0 and share > 0.85 * whole and (not len(lost) or lost.max() < 0.25 * want.height):
                assert near is not None
                self.claims.append(near.only(of[ours.owner[near.ours]] == n))
                self._bars(n)
                self.drawn_letters.append((n, want))
                self.found[n] = self._finding(n, 0.0, "")
            elif share > 0.4 * whole > 0:
                self.found[n] = self._other_letters(n)
                self.zones.append(_grown(want.corners, 0.8))
            else:
                self.found[n] = self._finding(n, 2 * self.tolerance, f'text "{self.elements[n].text}" missing', missing=True)

    def _strange_ink(self, rest: Sequence[Left]) -> None:
        """Letters with short strokes inside their rectangle that belong to nothing: they are other letters."""
        import shapely

        free = np.zeros(len(self.theirs.a))
        for r in rest:
            free[r.piece] += r.b - r.a if r.b - r.a > 0.1 else 0.0
        whole = np.bincount(self.theirs.owner, self.theirs.length)
        for n, want in self.drawn_letters:
            box = shapely.Polygon(np.column_stack((want.corners.real, want.corners.imag))).buffer(-0.1)
            inside = self.theirs.tree.query(box, predicate="contains")
            inside = inside[whole[self.theirs.owner[inside]] < 4 * want.height]
            if free[inside].sum() > 0.45 * want.height:
                self.found[n] = self._other_letters(n)

    def _other_letters(self, n: int) -> Finding:
        return self._finding(n, 4 * self.tolerance, f'the letters are not those of "{self.elements[n].text}"')

    # --- extras ---------------------------------------------------------------------------------------------------

    def _extra(self) -> tuple[Extra, ...]:
        rest = left(self.theirs, self._claimed())
        self._strange_ink(rest)
        rest = self._outside_zones(rest)
        chains = list(self._chains(rest))
        owners = self._owners()
        extra: list[tuple[list[Left], float]] = []
        for chain in chains:
            size = sum(r.b - r.a for r in chain)
            if size <= self.tolerance:
                continue
            ends = self._neighbours(chain, owners)
            if ends[0] is not None and ends[1] is not None and size < 4.5:
                continue  # one line drawn through where ours are two
            n = ends[0] if ends[0] is not None else ends[1]
            if n is not None and self.elements[n].kind in ("line", "arc", "curve") and self._continues(n, chain, owners):
                self._too_long(n, size, chain)
            elif size > LEAST:
                extra.append((chain, size))
        return tuple(sorted((*self._heaps(extra), *self._extra_areas(), *self._extra_text()), key=lambda x: -x.length))

    def _outside_zones(self, rest: list[Left]) -> list[Left]:
        """What is left outside of places where anything goes: symbols, heads, lettering, hatchings."""
        import shapely

        if not rest:
            return rest
        free = pieces(self.theirs, rest)
        zones = [shapely.Polygon(np.column_stack((z.real, z.imag))) for z in self.zones]
        for n, e in enumerate(self.elements):
            if e.kind == "circle" and e.radius <= SYMBOL:
                c = complex(self.moves[n](e.centre))
                zones.append(shapely.Point(c.real, c.imag).buffer(e.radius + 0.2))
            for h in self.heads[n]:
                if len(h) > 2:
                    zones.append(shapely.Polygon(np.column_stack((h.real, h.imag))).buffer(0.35))
        for a in self.space.areas:  # their own heads
            if np.ptp(a.points.real) + np.ptp(a.points.imag) < 20:
                zones.append(shapely.MultiPoint(np.column_stack((a.points.real, a.points.imag))).convex_hull.buffer(0.05))
        if not zones:
            return rest
        tree = shapely.STRtree(zones)
        ink = shapes(free.a, free.b)
        i, _ = tree.query(ink, predicate="within")
        drop = set(i.tolist())
        # Partly inside: what sticks out counts.
        out = []
        touching: dict[int, list[int]] = {}
        for p, q in zip(*tree.query(ink, predicate="intersects").tolist(), strict=True):
            if p not in drop:
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
                t = sorted(abs(z - self.theirs.a[r.piece]) for z in ends)
                out.append(Left(r.piece, float(t[0]), float(t[1])))
        return [r for r in out if r.b - r.a > 0.05]

    def _chains(self, rest: list[Left]) -> Iterator[list[Left]]:
        """Stretches that continue one another along one of their lines."""
        chain: list[Left] = []
        for r in sorted(rest):
            if chain:
                last = chain[-1]
                next_piece = r.piece == last.piece + 1 and self.theirs.owner[r.piece] == self.theirs.owner[last.piece]
                if next_piece and last.b > self.theirs.length[last.piece] - 0.06 and r.a < 0.06:
                    chain.append(r)
                    continue
                yield chain
            chain = [r]
        if chain:
            yield chain

    def _owners(self) -> dict[int, list[tuple[float, float, int]]]:
        """The elements that claim stretches of each piece of theirs."""
        every, of = self.pass_one
        found: dict[int, list[tuple[float, float, int]]] = {}
        for j, a, b, n in zip(every.theirs.tolist(), every.w0.tolist(), every.w1.tolist(), of.tolist(), strict=True):
            if b - a > 0.3 or self.elements[n].kind not in ("line",):
                found.setdefault(j, []).append((a, b, n))
        for n, parts in self.owned.items():
            for j, a, b in parts:
                found.setdefault(j, []).append((a, b, n))
        return found

    def _neighbours(self, chain: list[Left], owners: Mapping[int, list[tuple[float, float, int]]]) -> tuple[int | None, int | None]:
        """Elements whose ink the chain continues at its beginning and its end."""
        first, last = chain[0], chain[-1]
        before = [(b - a, n) for a, b, n in owners.get(first.piece, ()) if abs(b - first.a) < 0.06]
        after = [(b - a, n) for a, b, n in owners.get(last.piece, ()) if abs(a - last.b) < 0.06]
        if not before and first.a < 0.06 and self._same_line(first.piece, first.piece - 1):
            k = first.piece - 1
            before = [(b - a, n) for a, b, n in owners.get(k, ()) if abs(b - self.theirs.length[k]) < 0.06]
        if not after and last.b > self.theirs.length[last.piece] - 0.06 and self._same_line(last.piece, last.piece + 1):
            k = last.piece + 1
            after = [(b - a, n) for a, b, n in owners.get(k, ()) if a < 0.06]
        return max(before)[1] if before else None, max(after)[1] if after else None

    def _same_line(self, j: int, k: int) -> bool:
        return 0 <= k < len(self.theirs.owner) and bool(self.theirs.owner[j] == self.theirs.owner[k])

    def _continues(self, n: int, chain: list[Left], owners: Mapping[int, list[tuple[float, float, int]]]) -> bool:
        """Whether the chain goes on as the element ended: straight on, or in the same curve."""
        # What only crosses or touches it for a short way is another line.
        j = chain[0].piece
        same = self.theirs.owner == self.theirs.owner[j]
        mine = sum(b - a for k, parts in owners.items() if same[k] for a, b, m in parts if m == n)
        if mine < 0.5 * self._whole(n) and mine < 0.3 * float(self.theirs.length[same].sum()):
            return False
        if self.elements[n].kind != "line":
            return True
        z = self.moves[n](self.elements[n].points)
        u = (z[-1] - z[0]) / abs(z[-1] - z[0])
        d = self.theirs.b[chain[0].piece] - self.theirs.a[chain[0].piece]
        middle = complex(self._ends(chain[0]).mean())
        if 0 < ((middle - z[0]) * np.conj(u)).real < abs(z[-1] - z[0]):
            return False  # beside it, not beyond its end
        return bool(abs((d * np.conj(u)).imag) < 0.03 * abs(d)) and len(chain) == 1

    def _too_long(self, n: int, size: float, chain: list[Left]) -> None:
        e, old = self.elements[n], self.found[n]
        if e.style in LOOSE_STYLES and size < BEYOND:
            return
        if old.verdict is None:
            return
        r = chain[0]
        piece = self.theirs.b[r.piece] - self.theirs.a[r.piece]
        at = complex(self.theirs.a[r.piece] + (r.a + r.b) / 2 * piece / abs(piece))
        what = f"{size:.1f} mm too long at ({at.real:.0f}, {at.imag:.0f})"
        if e.kind != "line":
            # A loop beside a curve that is there as well, as when one way of a path there and back is wrong.
            ends = np.concatenate([self._ends(r) for r in chain])
            foot, _, near = lines(self.paths[n]).nearest(ends, CURVE_REACH)
            ends_at = np.concatenate([p[[0, -1]] for p in self.paths[n]])
            if near.all() and np.abs(ends_at - at).min() > size:
                size = float(np.abs(foot - ends).max())
                at = complex(ends[np.abs(foot - ends).argmax()])
                what = f"up to {size:.2f} mm off at ({at.real:.0f}, {at.imag:.0f})"
        said = ", ".join(x for x in (old.what, what) if x)
        deviation = max(old.deviation, size)
        judged = verdict(deviation, self.tolerance)
        if judged == "red" and e.style in LOOSE_STYLES and old.verdict != "red":
            judged = "amber"
        entity = int(self.entity[r.piece])
        where = (at, 5.0) if old.verdict == "green" else (old.at, old.reach)
        self.found[n] = replace(old, deviation=deviation, verdict=judged, what=said, at=where[0], reach=where[1],
                                size=(old.size or 0.0) + size, entities=tuple(dict.fromkeys((*old.entities, entity))))

    def _heaps(self, extra: list[tuple[list[Left], float]]) -> Iterator[Extra]:
        """Extra ink by entity; small strokes that lie together (letters of a drawn text, a symbol) as one."""
        by_entity: dict[int, list[tuple[list[Left], float]]] = {}
        for chain, size in extra:
            by_entity.setdefault(int(self.entity[chain[0].piece]), []).append((chain, size))
        small: list[tuple[int, float, Points]] = []
        whole = np.zeros(len(self.space.entities))
        np.add.at(whole, self.entity, self.theirs.length)
        for k, found in by_entity.items():
            z = np.concatenate([self._ends(r) for chain, _ in found for r in chain])
            size = sum(s for _, s in found)
            if size > 0.5 * whole[k]:  # the rest runs along lines of the sheet by chance
                mine = self.entity == k
                z, size = np.concatenate((self.theirs.a[mine], self.theirs.b[mine])), float(whole[k])
            if np.ptp(z.real) + np.ptp(z.imag) < 14.0:
                small.append((k, size, z))
            else:
                yield Extra(self.space.entities[k], size, _middle(z), _reach(z))
        middles = np.array([_middle(z) for _, _, z in small], dtype=complex)
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
            yield Extra(self.space.entities[small[heap[0]][0]], sum(small[k][1] for k in heap), _middle(z), _reach(z), len(heap))

    def _ends(self, r: Left) -> Points:
        d = self.theirs.b[r.piece] - self.theirs.a[r.piece]
        u = d / abs(d)
        return np.array([self.theirs.a[r.piece] + r.a * u, self.theirs.a[r.piece] + r.b * u])

    def _extra_areas(self) -> Iterator[Extra]:
        ours = [complex(h.mean()) for heads in self.heads for h in heads]
        known = np.array(ours, dtype=complex)
        for k, area in enumerate(self.space.areas):
            z = area.points
            around = float(np.abs(np.diff(np.append(z, z[:1]))).sum())
            if k in self.used_areas or not area.solid or around < 2.0:
                continue
            if len(known) and np.abs(known - self.areas[k]).min() < 3.0:
                continue
            yield Extra(self.space.entities[area.entity], around, _middle(z), _reach(z))

    def _extra_text(self) -> Iterator[Extra]:
        for k, w in enumerate(self.space.writings):
            if k not in self.used_writings:
                yield Extra(self.space.entities[w.entity], 0.0, w.at, max(w.width, 4.0) / 2, 1, w.text.strip())

    def _of_strokes(self, strokes: tuple[int, ...]) -> list[int]:
        return [int(j) for k in strokes for j in np.flatnonzero(self.theirs.owner == k)]

    def _entities_of_strokes(self, strokes: tuple[int, ...]) -> tuple[int, ...]:
        return tuple(dict.fromkeys(self.space.strokes[k].entity for k in strokes))


def _add_unions(covered: npt.NDArray[np.float64], near: Overlaps, ours: Lines) -> None:
    """Adds to each of our lines how much of it the overlaps cover, every place once."""
    order = np.argsort(near.ours, kind="stable")
    i = near.ours[order]
    if not len(i):
        return
    first = np.flatnonzero(np.concatenate(([True], i[1:] != i[:-1])))
    s0, s1 = near.s0[order].tolist(), near.s1[order].tolist()
    for p, q in zip(first.tolist(), [*first[1:].tolist(), len(i)], strict=True):
        covered[ours.owner[i[p]]] += sum(b - a for a, b in union(zip(s0[p:q], s1[p:q], strict=True), 0.02))


def _nearest(s0: Numbers, s1: Numbers, off: Numbers, whole: float) -> Numbers:
    """Distances along an element of the nearest of what lies along it."""
    t = np.linspace(0.0, whole, 25)[1:-1]
    on = (s0 - JOINT <= t[:, None]) & (t[:, None] <= s1 + JOINT)
    nearest = np.where(on, off, np.inf).min(axis=1)
    return np.asarray(nearest[np.isfinite(nearest)])


def _middle(z: Points) -> complex:
    return complex((z.real.min() + z.real.max()) / 2, (z.imag.min() + z.imag.max()) / 2)


def _reach(z: Points) -> float:
    return min(max(float(np.abs(z - _middle(z)).max()), 3.0), 20.0)


def _grown(corners: Points, by: float) -> Points:
    a, b, _, _ = corners
    u = (b - a) / max(abs(b - a), 1e-9)
    v = 1j * u
    return corners + by * np.array([-u - v, u - v, u + v, v - u])


def _moved(shift: complex, tolerance: float, how: str = "") -> list[str]:
    if abs(shift) <= tolerance:
        return []
    return [f"shifted {how}by {abs(shift):.2f} mm ({shift.real:+.2f}, {shift.imag:+.2f})"]


def _more(size: float) -> str:
    return f"{abs(size):.2f} mm too {'large' if size > 0 else 'small'}"
