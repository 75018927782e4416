"""The strokes of a drawing as evidence for plans: where its ink is, which figures it forms, and what a plan laid on it costs.

Lengths are mm of the student's paper, points complex. Nothing here knows of mechanisms: :class:`PlanLines` are lines that a plan
should have, :class:`Figure` is ink that may be one, :meth:`Figure.price` how badly the two agree.

Constants are named with what they are: pencil (``_MM``, ``_RAD``: how exactly one draws), paper (sizes of what is drawn), price
(mm of ink).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import itemgetter

import numpy as np
from numpy.typing import NDArray

from tmm_sheets.compare.cad.cad_ink import DrawingSpace, Entity, pointed
from tmm_sheets.compare.cad.line_fit import MOST, KnownLines, hanging_together, shapes
from tmm_sheets.compare.elements import grouped
from tmm_sheets.compare.placing import Placing
from tmm_sheets.drawing.marks import Points

Floats = NDArray[np.float64]
Numbers = NDArray[np.intp]

# --- pencil: how exactly one draws -----------------------------------------------------------------------------------------
TOLERANCE_MM = 0.5       # a stroke may lie beside its line, an end from its point, and ends that are one point from each other
CARELESS_MM = 0.9        # both ends of a stroke may lie so far from those of its line
PARALLEL_RAD = 0.012     # a stroke may be turned against its line
UPRIGHT_RAD = 0.03       # a plan may be turned against the lettering
# --- paper: sizes of what is drawn ------------------------------------------------------------------------------------------
MAX_GAP_MM = 2.5         # strokes nearer than this are one figure
MAX_HEAD_MM = 6.5        # longest stroke of an arrow head
MAX_SYMBOL_MM = 14.0     # a closed outline up to this size is a symbol
SUPPORT_MM = 10.0        # so near to a point of the mechanism, and so long, are the lines of its support
MAX_JOINT_MM = 3.2       # radius of the largest circle of a joint
MAX_HATCH_MM = 6.0       # longest stroke of the hatching of a support, and greatest distance of two
MIN_DRAWN_MM = 0.7       # a shorter vector is not drawn
STEP_MM = 1.0            # distance of the places at which lines are looked at
A1_SIDES = np.array([816 / 584, 841 / 594])
COUNTED_MM = 40.0        # a longer line counts no more than this
LETTERS_MM, LETTER_MM = (2.0, 10.5), 4.0  # heights of letters, and a usual one
# --- price: mm of ink -------------------------------------------------------------------------------------------------------
BARE_PRICE = 0.7         # of a mm of a line on bare paper, where one of unexplained ink is 1
ABSENT_PRICE = 3.0       # of a class of lines that is not drawn at all
DRAWN_SHARE = 0.85       # a line with so much ink is drawn
LEFT_SHARE = 0.08        # of a stroke that may stay without a line, and of all ink that a mistake may leave
PASSES_SHARE = 0.9       # what a line whose ends meet no end of ink counts at most
LONGEST_LINES, LONGEST_STROKES = 12, 40  # laid on each other to find a place

MAIN, CENTRES, RESULTANTS, OTHERS = "main", "centres", "resultants", "others"
"""Classes of lines: those that must be there, may be left out as a whole, and those that explain ink and are never missed."""
NOT_OF_PLANS = ("DIMENSION", "LEADER", "MULTILEADER", "MLEADER", "HATCH", "ACAD_TABLE", "TOLERANCE")
UNITS_MM = (1.0, 25.4, 10.0, 1000.0)


@dataclass(frozen=True, eq=False)
class PlanLines:
    """Lines of a plan in its own unit: ends (n,), class of each, number of each among those of its view.

    ``through``, ``along`` are points and directions (m,) of lines without ends that explain ink, such as guides.
    """

    tails: Points
    heads: Points
    kinds: tuple[str, ...]
    numbers: Numbers
    through: Points
    along: Points


@dataclass(frozen=True, eq=False)
class Fit:
    """A plan at a place: z of the plan is at ``origin + scale * z``.

    Attributes
    ----------
    price, extra, bare : mm of ink: the whole; ink that no line explains; lines on bare paper
    drawn, left : by line the share with ink; by stroke the share without a line
    ink, own : mm of ink of the figure, and of the main lines of the plan
    """

    price: float
    extra: float
    bare: float
    scale: complex
    origin: complex
    drawn: Floats
    left: Floats
    ink: float
    own: float

    def at(self, z: Points) -> Points:
        """Where points of the plan are."""
        return np.asarray(self.origin + self.scale * z)


class PlanInk:
    """The straight strokes of a drawing that may be lines of plans, in mm: without dimensions, hatchings, curves, small symbols.

    Attributes
    ----------
    a, b : ends (n,); ``stroke`` their numbers in the drawing; ``auxiliary`` whether their look is one of construction lines
    heads : tips and directions of arrow heads
    texts : lettering, the lines of one entity joined; ``turn`` how most of it is turned, rad, NaN without any
    space : the drawing, mm; ``scale`` mm per unit of it; ``curves`` number of strokes that are bent and not looked at
    look : by stroke the number of its layer, line type and width together
    """

    def __init__(self, space: DrawingSpace, unit: float | None, scaled: bool = False) -> None:
        self.scale = 1.0 if scaled else _scale(space, unit)
        self.space = space = space.placed(Placing(complex(self.scale)))
        self.texts = [some[0]._replace(text=" ".join(w.text.strip() for w in some))
                      for some in grouped(space.writings, lambda w: w.entity).values()]
        some = {n: s.points for n, s in enumerate(space.strokes) if space.entities[s.entity].kind not in NOT_OF_PLANS}
        bent = {n for n, z in some.items() if _is_bent(z)}
        small = {n: z[:-1] for n, z in some.items() if n not in bent and len(z) > 3 and abs(z[0] - z[-1]) < 0.05
                 and max(np.ptp(z.real), np.ptp(z.imag)) < MAX_SYMBOL_MM}
        self.curves, joints = len(bent), [joint for n in bent for joint in _joint(some[n])]
        straight = np.isin(space.lines.owner, list(some.keys() - bent - small.keys()))
        s2: NDArray[np.complex128] = np.column_stack((space.lines.a, space.lines.b))[straight]
        of = space.lines.owner[straight]
        keep = _each_once(s2)
        keep = np.sort(keep[np.argsort(-np.abs(s2[keep, 1] - s2[keep, 0]), kind="stable")[:MOST]])
        s2, of = s2[keep], of[keep]
        filled = [*(a.points for a in space.areas if a.solid and space.entities[a.entity].kind not in NOT_OF_PLANS),
                  *small.values()]
        heads = [(complex(z.mean()) + far, far / abs(far)) for z in filled
                 if (far := pointed(z)) is not None and abs(far) < MAX_HEAD_MM]
        symbols = _support_strokes(s2)
        s2, of = np.delete(s2, symbols, axis=0), np.delete(of, symbols)
        barbs, more = _open_heads(s2)
        self.a, self.b = (np.delete(z, barbs) for z in s2.T)
        self.stroke = np.delete(of, barbs)
        extend(self.a, self.b, heads, joints)
        self.heads: list[tuple[complex, complex]] = heads + more
        turns = Counter(round(float(np.degrees(t.angle)) % 360, 1) for t in self.texts)
        self.turn = float(np.radians(turns.most_common(1)[0][0])) if turns else float("nan")
        entities = [space.entities[space.strokes[n].entity] for n in self.stroke.tolist()]
        self.auxiliary = _auxiliary(entities)
        numbers: dict[tuple[str, str, float | None], int] = {}
        self.look = np.array([numbers.setdefault((e.layer, e.pattern, e.width), len(numbers)) for e in entities], dtype=np.intp)

    def otherwise(self, turn: float, mirrored: bool = False) -> PlanInk:
        """The drawing with its plans turned so; ``mirrored``: reflected in the x axis, its lettering still read."""
        other = PlanInk(self.space.placed(Placing(mirrored=mirrored)), 1.0, scaled=True)
        other.turn = turn
        return other

    def figures(self, some: Numbers) -> list[Numbers]:
        """Some strokes by the figures they hang together in."""
        if not len(some):
            return []
        lines = KnownLines(self.a[some], self.b[some], some)
        i, j = lines.tree.query(shapes(lines.a, lines.b), predicate="dwithin", distance=MAX_GAP_MM)
        return [some[n] for n in hanging_together(len(some), i, j)]

    def is_frame(self, some: Numbers) -> bool:
        """True if strokes are upright and level only, and reach round most of the drawing."""
        turn = np.exp(1j * (self.turn if np.isfinite(self.turn) else 0.0))
        d, z = (self.b - self.a)[some] / turn, np.concatenate((self.a, self.b)) / turn
        mine = np.concatenate((self.a[some], self.b[some])) / turn
        aside = np.minimum(np.abs(d.real), np.abs(d.imag)) > PARALLEL_RAD * np.abs(d)
        round_it = all(np.ptp(x) > 0.9 * np.ptp(y) for x, y in ((mine.real, z.real), (mine.imag, z.imag)))
        return round_it and len(some) > 3 and not aside.any()

    @property
    def has_sheet_frame(self) -> bool:
        """True if among its longest strokes are two that stand to each other as the sides of an A1 frame."""
        turn = np.exp(1j * (self.turn if np.isfinite(self.turn) else 0.0))
        d = (self.b - self.a)[np.argsort(-np.abs(self.b - self.a))[:12]] / turn
        level, upright = (np.abs(d[np.abs(part) < 1e-3 * np.abs(d)]) for part in (d.imag, d.real))
        ratio = np.maximum(level[:, None], upright) / np.minimum(level[:, None], upright)
        return bool((np.abs(ratio[..., None] / A1_SIDES - 1) < 0.003).any())

    def gap(self, some: Numbers, others: Numbers) -> float:
        """How near strokes come to others, mm, by places along them."""
        z = sample(self.a[some], self.b[some])[0]
        w = np.concatenate((self.a[others], self.b[others], (self.a[others] + self.b[others]) / 2))
        return float(np.abs(z[:, None] - w).min())


def _scale(space: DrawingSpace, unit: float | None) -> float:
    """Millimetres of a unit of the drawing: the declared unit, unless the lettering would be too low or too high in it."""
    units = list(dict.fromkeys((1.0 if space.paper else unit or 1.0, *UNITS_MM)))
    if not space.writings:
        z = np.concatenate([s.points for s in space.strokes] or [np.array([0, 1 + 1j])])
        size = max(float(np.ptp(z.real)), float(np.ptp(z.imag)))
        return next((u for u in units if 40 < u * size < 5000), 300 / max(size, 1e-9))
    high = float(np.median([w.height for w in space.writings])) or 1.0
    if LETTERS_MM[0] <= units[0] * high <= LETTERS_MM[1]:
        return units[0]
    best = min(units, key=lambda u: abs(np.log(u * high / LETTER_MM)))
    return best if LETTERS_MM[0] / 1.5 <= best * high <= 1.5 * LETTERS_MM[1] else LETTER_MM / high


def _is_bent(z: Points) -> bool:
    """True if a polyline is a curve: many chords, each turned a little against the one before."""
    d = np.diff(z)
    d = d[np.abs(d) > 1e-9]
    if len(d) < 7 or np.abs(d).sum() < 1.02 * abs(z[-1] - z[0]):
        return False
    return float(np.median(np.abs(np.angle(d[1:] / d[:-1])))) < 0.5


def _each_once(s: NDArray[np.complex128]) -> Numbers:
    """Numbers of the strokes that have a length, coincident ones once."""
    ends = np.sort(np.round(s, 2) + 0.0, axis=1)
    first = np.sort(np.unique(ends, axis=0, return_index=True)[1])
    return np.asarray(first[ends[first, 0] != ends[first, 1]])


def _close(z: Points, within: float) -> tuple[Numbers, Numbers]:
    """Pairs of points, by their numbers and in both orders, that are no farther from each other, mm."""
    import shapely

    points = shapely.points(z.real, z.imag)
    i, j = shapely.STRtree(points).query(points, predicate="dwithin", distance=within)
    return i[i != j], j[i != j]


def _joint(z: Points) -> list[tuple[complex, float]]:
    """Centre and radius of a small circle."""
    centre = complex(z.real.min() + z.real.max(), z.imag.min() + z.imag.max()) / 2
    radius = np.abs(z - centre)
    closed = abs(z[0] - z[-1]) < 0.05
    return [(centre, float(radius.mean()))] if closed and radius.max() < MAX_JOINT_MM and np.ptp(radius) < 0.1 else []


def extend(a: Points, b: Points, heads: Sequence[tuple[complex, complex]], joints: Sequence[tuple[complex, float]]) -> None:
    """Lengthen strokes in place: to the tip of the head they end under, to the middle of the joint at whose rim they end."""
    tips, ways = (np.array(x, dtype=complex) for x in ([tip for tip, _ in heads], [way for _, way in heads]))
    centres = np.array([c for c, _ in joints], dtype=complex)
    radii = np.array([r for _, r in joints])
    for end, other in ((a, b), (b, a)):
        u = ((end - other) / np.maximum(np.abs(end - other), 1e-9))[:, None]
        for at in (tips, centres):
            w = (at - end[:, None]) * np.conj(u)
            there = (w.real > 0.2) & (w.real < MAX_HEAD_MM) & (np.abs(np.angle(ways / u)) < 0.2) if at is tips else (
                np.abs(w.real - radii) < 0.3)
            there &= np.abs(w.imag) < 0.3
            if at is tips:
                there[(np.abs(w) < TOLERANCE_MM).any(1)] = False  # it has its own
            n = np.flatnonzero(there.any(1))
            end[n] = at[there[n].argmax(1)] if len(n) else 0


def _support_strokes(s: NDArray[np.complex128]) -> list[int]:
    """Numbers of hatching strokes of supports and guides, of the lines they hang on, and of the short lines that stand on these."""
    d = s[:, 1] - s[:, 0]
    size = np.abs(d)
    short = np.flatnonzero(size < MAX_HATCH_MM)
    middle = (s[short, 0] + s[short, 1]) / 2
    i, j = _close(middle, MAX_HATCH_MM)
    alike = (np.abs((d[short[i]] / d[short[j]]).imag) < 0.05) & (np.abs(size[short[i]] / size[short[j]] - 1) < 0.1)
    # They stand beside each other: heads of vectors on one line do not.
    alike &= np.abs(((middle[j] - middle[i]) / d[short[i]]).imag) * size[short[i]] > TOLERANCE_MM
    rows = hanging_together(len(short), i[alike], j[alike])
    hatch = {n for row in rows if len(row) > 3 for n in short[row].tolist()}
    if not hatch:
        return []
    ends = np.concatenate((s[list(hatch), 0], s[list(hatch), 1]))
    w = (ends[:, None] - s[:, 0]) / d
    on = (np.abs(w.imag) * size < 0.3) & (w.real > -0.01) & (w.real < 1.01)
    ground = set(np.flatnonzero(on.sum(0) > 3).tolist()) - hatch
    w = (np.concatenate((s[:, 0], s[:, 1]))[:, None] - s[list(ground), 0]) / d[list(ground)]
    stands = ((np.abs(w.imag) * size[list(ground)] < 0.3) & (w.real > -0.01) & (w.real < 1.01)).any(1).reshape(2, -1).any(0)
    return sorted(hatch | ground | set(np.flatnonzero(stands & (size < SUPPORT_MM)).tolist()))


def _open_heads(s: NDArray[np.complex128]) -> tuple[list[int], list[tuple[complex, complex]]]:
    """Heads of two strokes, and these: alike long, from one point at which a longer stroke ends that halves their angle."""
    if not len(s):
        return [], []
    d = s[:, 1] - s[:, 0]
    size, ends = np.tile(np.abs(d), 2), np.concatenate((s[:, 0], s[:, 1]))
    away, of = np.concatenate((d, -d)) / size, np.tile(np.arange(len(s)), 2)
    used: set[int] = set()
    heads = []
    i, j = _close(ends, TOLERANCE_MM)
    beside = grouped(sorted(zip(i.tolist(), j.tolist(), strict=True)), itemgetter(0))
    half = np.abs(np.angle(away[j] / away[i])) / 2
    goes_on = np.isin(np.arange(len(ends)), i[size[j] > MAX_HEAD_MM])
    alike = (np.maximum(size[i], size[j]) <= MAX_HEAD_MM) & (np.abs(size[j] - size[i]) < 0.02 * size[i] + TOLERANCE_MM)
    alike &= ~(goes_on[i - len(s)] & goes_on[j - len(s)])  # cranks side by side, on whose other ends couplers hang, are none
    pairs = np.column_stack((i, j))[alike & (half > 0.08) & (half < 0.5) & (of[i] != of[j])]
    for p, q in sorted(pairs.tolist()):
        middle = (away[p] + away[q]) / abs(away[p] + away[q])
        slack = 0.02 + TOLERANCE_MM / 4 / size[p]
        if not {of[p], of[q]} & used and any(
                k != q and of[k] not in {of[p], *used} and abs(np.angle(away[k] / middle)) < slack and size[k] > 0.9 * size[p]
                for _, k in beside[p]):
            heads.append((complex(ends[p]), complex(-middle)))
            used |= {int(of[p]), int(of[q])}
    return sorted(used), heads


def _auxiliary(of: Sequence[Entity]) -> NDArray[np.bool_]:
    """By stroke's entity whether its look is that of construction lines: not continuous, or thin where others are twice as wide."""
    widths = np.array([np.nan if e.width is None else e.width for e in of])
    widest = np.nanmax(widths) if np.isfinite(widths).any() else np.nan
    thin = np.nan_to_num(widths, nan=np.inf) <= 0.6 * widest if np.isfinite(widest) else np.zeros(len(of), bool)
    dashed = np.array([e.pattern != "continuous" for e in of], dtype=bool)
    made = thin | dashed
    return made if made.mean() < 0.7 else np.zeros(len(of), bool)


def sample(a: Points, b: Points) -> tuple[Points, Points, Numbers]:
    """Places along lines at most STEP_MM apart (but 30 on one): points, directions, numbers of their lines."""
    size = np.abs(b - a)
    n = np.clip(np.ceil(size / STEP_MM), 2, 30).astype(int)
    of = np.repeat(np.arange(len(a)), n)
    t = (np.arange(len(of)) - np.repeat(np.cumsum(n) - n, n) + 0.5) / n[of]
    return a[of] + t * (b - a)[of], ((b - a) / np.maximum(size, 1e-9))[of], of


def covered(z: Points, u: Points, a: Points, b: Points) -> NDArray[np.bool_]:
    """By place z (its line has direction u) whether a stroke from a to b of nearly that direction passes within tolerance."""
    if not len(a) or not len(z):
        return np.zeros(len(z), bool)
    d = b - a
    size = np.maximum(np.abs(d), 1e-9)
    e = d / size
    w = (z[:, None] - a) * np.conj(e)
    along = np.abs((u[:, None] * np.conj(e)).imag) < np.maximum(PARALLEL_RAD, 2 * TOLERANCE_MM / size)
    near = (np.abs(w.imag) < TOLERANCE_MM) & (w.real > -TOLERANCE_MM) & (w.real < size + TOLERANCE_MM)
    return np.asarray((near & along).any(1))


def lies_along(a: complex, b: complex, ours_a: Points, ours_b: Points) -> bool:
    """True if a stroke runs along some lines nearly all the way."""
    z = a + (b - a) * np.linspace(0.1, 0.9, 7).astype(complex)
    return bool(covered(z, np.full(7, (b - a) / abs(b - a), dtype=complex), ours_a, ours_b).all())


class Figure:
    """Strokes that may be a view, with what is computed of them once.

    ``strokes`` are their numbers in the ink, ``place`` scale and origin of the plan where they are known.
    """

    def __init__(self, strokes: Numbers, a: Points, b: Points, soft: NDArray[np.bool_] | None = None) -> None:
        self.strokes = strokes
        self.place: tuple[complex, complex] | None = None
        self.a, self.b = a, b
        self.size = np.abs(self.b - self.a)
        self.z, self.u, self.of = sample(self.a, self.b)
        self.count = np.bincount(self.of, minlength=len(strokes))
        self.ends = np.concatenate((self.a, self.b))
        self.soft = np.zeros(len(strokes), bool) if soft is None else soft | self._barbs
        if self.soft.all():
            self.soft = np.zeros(len(strokes), bool)
        self.weight = np.where(self.soft, 0.0, np.minimum(self.size, COUNTED_MM))
        self.ink = float(self.weight.sum())
        self.long = np.argsort(-np.where(self.soft, 0.0, self.size))[:LONGEST_STROKES]
        self.span = float(np.hypot(np.ptp(self.ends.real), np.ptp(self.ends.imag))) if len(strokes) else 0.0

    @classmethod
    def of_drawing(cls, ink: PlanInk, strokes: Numbers, vectors: bool = False) -> Figure:
        """Some strokes of a drawing; of ``vectors`` those without heads may be construction lines."""
        a, b = ink.a[strokes], ink.b[strokes]
        soft = ink.auxiliary[strokes]
        return cls(strokes, a, b, soft | _without_heads(ink, a, b, strokes) if vectors else soft)

    def part(self, some: NDArray[np.bool_]) -> Figure:
        """Some of its strokes."""
        return Figure(self.strokes[some], self.a[some], self.b[some], self.soft[some])

    def against(self, fit: Fit) -> float:
        """What speaks against a plan at a place, mm: ink that it does not explain; what is not drawn may be left out."""
        return fit.extra

    @cached_property
    def _barbs(self) -> NDArray[np.bool_]:
        """Half arrow heads that were not read: short, on the end of a longer stroke, the other end free."""
        n = np.tile(np.arange(len(self.a)), 2)
        i, j = _close(self.ends, TOLERANCE_MM)
        i, j = i[n[i] != n[j]], j[n[i] != n[j]]
        longer, alone = np.zeros((2, len(self.a)), bool), np.ones((2, len(self.a)), bool)
        longer.ravel()[i[self.size[n[j]] > 1.5 * self.size[n[i]]]] = True
        alone.ravel()[i] = False
        return np.asarray((self.size < MAX_HEAD_MM) & ((longer[0] & alone[1]) | (longer[1] & alone[0])))

    def price(self, lines: PlanLines, scale: complex, origin: complex) -> Fit:
        """What a plan at a place costs: ink that it does not explain, and lines of it on bare paper."""
        a, b = origin + scale * lines.tails, origin + scale * lines.heads
        size = np.abs(b - a)
        shown = np.flatnonzero(size > MIN_DRAWN_MM)
        left, drawn = np.ones(len(self.a)), np.ones(len(a))
        if len(shown):
            p, q = (np.concatenate((x[shown], y)) for x, y in zip((a, b), self._endless(lines, scale, origin), strict=True))
            over = covered(self.z, self.u, p, q)
            left = 1 - np.bincount(self.of, over, len(self.a)) / self.count
            drawn[shown] = self.drawn(a[shown], b[shown])
            # A stroke from end to end of a line is that line, drawn carelessly.
            n = np.flatnonzero(left > LEFT_SHARE)
            begin, end = self.a[n, None], self.b[n, None]
            off = np.minimum(np.maximum(np.abs(a[shown] - begin), np.abs(b[shown] - end)),
                             np.maximum(np.abs(a[shown] - end), np.abs(b[shown] - begin)))
            close = off.min(1) < CARELESS_MM
            left[n[close]] = 0.0
            drawn[shown[off[close].argmin(1)]] = 1.0
        unexplained = np.where(left > LEFT_SHARE, left, 0.0)
        if len(lines.through):  # supports and blocks stand at points of the mechanism
            points = np.concatenate((a, b))
            near = np.abs((self.a + self.b)[:, None] / 2 - points).min(1) < SUPPORT_MM if len(points) else False
            shortest = min(size[shown].tolist(), default=0.0)
            unexplained = np.where(near & (self.size < min(SUPPORT_MM, 0.6 * shortest)), 0.0, unexplained)
        extra = float((self.weight * unexplained).sum())
        bare = 0.0
        counted = np.minimum(size, COUNTED_MM)
        kinds = np.array(lines.kinds)
        is_shown = size > MIN_DRAWN_MM
        for kind in set(lines.kinds) - {OTHERS}:
            mine = is_shown & (kinds == kind)
            gone = mine & (drawn < DRAWN_SHARE)
            cost = BARE_PRICE * float((counted * (1 - drawn))[gone].sum())
            bare += cost if kind == MAIN else min(ABSENT_PRICE, cost)
        own = float(counted[is_shown & (kinds == MAIN)].sum())
        return Fit(extra + bare, extra, bare, scale, origin, drawn, left, self.ink, own)

    def drawn(self, a: Points, b: Points) -> Floats:
        """Share of each line from a to b that has ink."""
        z, u, of = sample(a, b)
        share = np.bincount(of, covered(z, u, self.a, self.b), len(a)) / np.bincount(of, minlength=len(a))
        # A line that is drawn ends where it should: an end of ink at both its ends, else it only passes over other lines.
        for e in (a, b):
            reach = np.abs(e[:, None] - self.ends).min(1) < 2.5 * TOLERANCE_MM
            share = np.where(reach, share, np.minimum(share, PASSES_SHARE))
        return np.asarray(share)

    def _endless(self, lines: PlanLines, scale: complex, origin: complex) -> tuple[Points, Points]:
        """Lines without ends, as far as the figure reaches, and two beside each: a guide is drawn as one line or as two."""
        if not len(lines.through):
            return np.zeros(0, complex), np.zeros(0, complex)
        at, u = origin + scale * lines.through, scale / abs(scale) * lines.along
        return at - self.span * u, at + self.span * u

    def places(self, lines: PlanLines, turn: float, most: int) -> Iterator[tuple[complex, complex]]:
        """Scales and origins that lay some line of the plan on some stroke, those first that put most points on ends of ink."""
        d = lines.heads - lines.tails
        size = np.abs(d)
        pts: Points = np.unique(np.round(np.concatenate((lines.tails, lines.heads)), 12)).astype(complex)
        extent = float(np.hypot(np.ptp(pts.real), np.ptp(pts.imag))) or 1e-9
        main = [i for i in np.argsort(-size).tolist() if size[i] > 0.03 * extent and lines.kinds[i] != OTHERS][:LONGEST_LINES]
        if not main or not len(self.long):
            return
        i, j = (x.ravel() for x in np.meshgrid(main, self.long, indexing="ij"))
        ratio = (self.b[j] - self.a[j]) / d[i]
        scale = np.concatenate((ratio, -ratio))
        origin = np.concatenate((self.a[j] - ratio * lines.tails[i], self.b[j] + ratio * lines.tails[i]))
        if np.isfinite(turn):
            upright = np.exp(1j * turn)
            ok = np.abs(np.angle(scale / upright)) < UPRIGHT_RAD
            scale, origin = np.abs(scale[ok]) * upright, origin[ok]
        ok = (np.abs(scale) * extent < 1.6 * self.span) & (np.abs(scale) * extent > 0.3 * self.span)
        scale, origin = scale[ok], origin[ok]
        if not len(scale):
            return
        there = origin[:, None] + scale[:, None] * pts
        score = np.zeros(len(origin), int)
        for n in range(0, len(origin), 64):
            score[n:n + 64] = (np.abs(there[n:n + 64, :, None] - self.ends).min(2) < 2 * TOLERANCE_MM).sum(1)
        seen: set[tuple[float, float, complex]] = set()
        for n in np.argsort(-score, kind="stable").tolist():
            log = np.log(scale[n])
            key = (round(float(log.real) * 60), round(float(log.imag) * 60), complex(np.round(origin[n] / 1.5)))
            if key not in seen:
                seen.add(key)
                yield self._refined(pts, complex(scale[n]), complex(origin[n]), bool(np.isfinite(turn)))
                if len(seen) >= most:
                    return

    def _refined(self, pts: Points, scale: complex, origin: complex, keep_turn: bool) -> tuple[complex, complex]:
        """A place by least squares over the points that lie on ends of strokes."""
        for within in (3 * TOLERANCE_MM, 1.5 * TOLERANCE_MM):
            off = np.abs((origin + scale * pts)[:, None] - self.ends)
            near = off.min(1) < within
            if near.sum() < 2:
                break
            p, q = pts[near], self.ends[off.argmin(1)[near]]
            v = float((np.abs(p - p.mean()) ** 2).sum())
            if v < 1e-18:
                break
            new = complex(((q - q.mean()) * np.conj(p - p.mean())).sum() / v)
            if keep_turn:
                unit = scale / abs(scale)
                new = (new * unit.conjugate()).real * unit
            if not abs(new):
                break
            scale, origin = new, complex(q.mean() - new * p.mean())
        return scale, origin

    def laid(self, lines: PlanLines, turn: float, most: int = 5, whole: bool = False) -> Fit | None:
        """The cheapest place of a plan's lines; ``whole``: that where most of it is drawn, whatever else is."""
        if not len(lines.tails):
            return None
        places = self.places(lines, turn, most) if self.place is None else [self.place]
        fits = [self.price(lines, *place) for place in places]
        return min(fits, key=lambda f: f.bare + 0.1 * f.extra if whole else f.price, default=None)

    def away(self, at: complex) -> float:
        """How far a title stands from the figure, mm; more beyond its sides than inside its box."""
        e = self.b - self.a
        t = np.clip(((at - self.a) * np.conj(e)).real / np.abs(e) ** 2, 0, 1)
        x, y = self.ends.real, self.ends.imag
        beside = np.hypot(max(x.min() - at.real, at.real - x.max(), 0), max(y.min() - at.imag, at.imag - y.max(), 0))
        return min(float(np.abs(at - self.a - t * e).min()), 1.5 * float(beside) + 20)


def _without_heads(ink: PlanInk, a: Points, b: Points, strokes: Numbers) -> NDArray[np.bool_]:
    """Of vectors, the strokes of looks of which none has a head, where another look has some."""
    if not len(strokes):
        return np.zeros(0, bool)
    tips = np.array([tip for tip, _ in ink.heads], dtype=complex)
    looks = ink.look[strokes]
    far = np.abs(np.concatenate((a, b))[:, None] - tips)  # a head is of one vector: what else ends by chance near it has none
    some = looks[far.argmin(0)[far.min(0) < 2 * TOLERANCE_MM] % len(a)]
    return ~np.isin(looks, some) & bool(len(some))


def reversed_heads(ink: PlanInk, lines: PlanLines, fit: Fit) -> list[int] | None:
    """Numbers of the lines with a head at the wrong end; None where no head of the view is read.

    A head is of one vector, and a vector has one head: where it is the right one of a vector that has none yet, it is that one's.
    """
    a, b = fit.at(lines.tails), fit.at(lines.heads)
    size = np.abs(b - a)
    shown = sorted((i for i in range(len(a)) if fit.drawn[i] >= DRAWN_SHARE and size[i] > MIN_DRAWN_MM),
                   key=lambda i: lines.kinds[i] == OTHERS)
    pairs = sorted((lines.kinds[i] == OTHERS, abs(np.angle(way / (b[i] - a[i]))), n, i) for n, (tip, way) in enumerate(ink.heads)
                   for i in shown if _aimed(b[i], tip, way, b[i] - a[i]))
    mine: dict[int, int] = {}
    for *_, n, i in pairs:
        if n not in mine.values() and i not in mine:
            mine[i] = n
    wrong = []
    for n, (tip, way) in enumerate(ink.heads):
        back = [i for i in shown if i not in mine and size[i] > 2 and lines.kinds[i] != OTHERS
                and _aimed(a[i], tip, way, a[i] - b[i])]
        wrong += [] if n in mine.values() else back[:1]
    return wrong if mine or wrong else None


def _aimed(at: complex, tip: complex, way: complex, along: complex) -> bool:
    """True if a head stands at a point and points along a direction."""
    return bool(abs(at - tip) < 2 * TOLERANCE_MM and abs(np.angle(way / along)) < 0.2)
