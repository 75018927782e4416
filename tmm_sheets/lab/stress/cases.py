"""A stress run: cases in turn, one scene after another, the worst of each invariant against its bound, as a table."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import inf, isnan, pi
from typing import Any

import numpy as np

from tmm_sheets import quoting
from tmm_sheets.construction.arithmetic import halved
from tmm_sheets.errors import CannotBuild
from tmm_sheets.lab.stress import change_points
from tmm_sheets.lab.stress.change_points import folding, hinge_errors, in_a_row, scene
from tmm_sheets.lab.stress.draw import chain, crank_of, loaded, with_rocker, with_slider
from tmm_sheets.lab.stress.features import features
from tmm_sheets.lab.stress.invariants import (
    OneFunction,
    Residual,
    State,
    alike,
    assembled,
    balancing,
    derivatives,
    geometry,
    rigidity,
    statics,
)
from tmm_sheets.mechanism.groups import TRIAD
from tmm_sheets.mechanism.model import Mechanism
from tmm_sheets.numbers import of_reader
from tmm_sheets.words import tell

ANGLES = 24
"""Crank angles of a case."""

BOUNDS = {
    "link lengths": (2e-15, "of the reach"),
    "closure on guides": (2e-15, "of the reach and the way to the guide's point"),
    "assembly side": (2e-15, "of the reach"),
    "NaN exactly where it cannot assemble": (2e-15, "of the reach: what the pin's rounding may decide"),
    "one function = its steps": (2e-14, "of the reach, of the fastest point, of the greatest acceleration, times the condition"),
    "velocity closure": (1e-14, "of the fastest point, times how far beyond the points that tell the turning"),
    "acceleration closure": (1e-14, "of the greatest acceleration, the same"),
    "derivative of position = velocity": (1e-9, "of the fastest point; differences of order 8, condition under 100"),
    "derivative of velocity = acceleration": (1e-8, "of the greatest acceleration; the same"),
    "power = change of energy": (1e-8, "of all powers; the same"),
    "polygon closure": (5e-15, "of the largest force"),
    "equilibrium of every link": (5e-15, "of the largest force"),
    "moments on every link": (1e-14, "of the largest moment about the crank pivot"),
    "lever = kinetostatics": (5e-15, "of the largest moment, times the condition"),
    "power of a project = change of its energy": (1e-8, "of all powers, friction and drive among them"),
    "moment of an uneven crank is constant": (1e-12, "of the same, where the flywheel tells its acceleration"),
    "energy over the turn": (1e-9, "of the work of the load over strokes that formulas tell"),
    "velocity at a dead position": (2e-14, "of itself or of the pin's, against 60 digits"),
    "acceleration at a dead position": (2e-14, "of itself or of the pin's, against 60 digits"),
    "velocity at a change point": (2e-15, "of itself or of the pin's, times the condition, against 60 digits"),
    "acceleration at a change point": (2e-14, "of itself or of the pin's, times the condition, against 60 digits"),
    "velocity through a change point": (1e-13, "of itself or of the pin's, against formulas, whatever the condition"),
    "acceleration through a change point": (1e-12, "of itself or of the pin's, against formulas, whatever the condition"),
    "moment through a change point": (1e-9, "of the powers of all loads, against formulas, whatever the condition"),
    "velocity through a change point in a row": (1e-9, "of the pin's, against formulas, whatever the condition"),
    "acceleration through a change point in a row": (1e-7, "of the pin's, against formulas, whatever the condition"),
    "standstill at the ends of the stroke": (2e-14, "of the pin's velocity"),
    "picture in a mirror": (2e-15, "of reach times condition; of the fastest point, the greatest acceleration, times its square"),
    "memory of a million positions, MB": (64.0, "plans drawn in chunks"),
}
"""Bound of each invariant and what it is a share of."""


@dataclass
class Worst:
    """An invariant over all cases: how many tell of it, the largest value, the case it is from."""

    cases: int = 0
    value: float = 0.0
    case: int = -1
    scene: str = ""

    def take(self, value: float, case: int, scene: str) -> None:
        """One more case."""
        self.cases += 1
        if self.case < 0 or not (value <= self.value or isnan(self.value)):
            self.value, self.case, self.scene = value, case, scene


Make = Callable[..., State]
"""How the plans of a mechanism are evaluated at some crank angles, with the gravity, m/s2."""
Scene = Callable[[np.random.Generator, Make], Iterator[Residual]]


EVERY = (geometry, rigidity, alike, assembled, derivatives, statics)


def _checked(s: State, *checks: Callable[[State], Iterator[Residual]]) -> Iterator[Residual]:
    """Residuals of some invariants of a state, of all unless told."""
    for check in checks or EVERY:
        yield from check(s)


def _gravity(rng: np.random.Generator, m: Mechanism) -> float:
    """None, or of the order of the inertia forces."""
    return 0.0 if rng.random() < 0.3 else m.crank.speed**2 * m.crank.length * float(rng.uniform(0.1, 2))


def _around(rng: np.random.Generator, phi: float) -> Any:
    """Crank angles about one where the mechanism assembles, and anywhere."""
    near = phi + np.concatenate(([0.0], 10.0 ** rng.uniform(-12, 0, ANGLES // 2) * rng.choice((1, -1), ANGLES // 2)))
    return np.concatenate((near, rng.uniform(-pi, pi, ANGLES - len(near))))


def _chain(hard: str, spread: float = 0.3, empty: float = 0.2) -> Scene:
    def scene(rng: np.random.Generator, make: Make) -> Iterator[Residual]:
        m, phi = chain(rng, hard)
        m = loaded(rng, m, spread, empty)
        yield from _checked(make(m, _around(rng, phi), _gravity(rng, m)))

    return scene


def _turns(rng: np.random.Generator, make: Make) -> Iterator[Residual]:
    m, phi = chain(rng)
    m = loaded(rng, m)
    turns = 2 * pi * rng.integers(-(10**6), 10**6, ANGLES)
    s = make(m, phi + turns + rng.uniform(-1e-3, 1e-3, ANGLES), _gravity(rng, m))
    yield from _checked(s, geometry, rigidity, assembled, statics)


def _limited(rng: np.random.Generator) -> tuple[Mechanism, float]:
    """A crank that cannot turn round, with one group to the frame, and the crank angle of its dead position."""
    crank = crank_of(rng, 10.0 ** float(rng.uniform(-3, 3)))
    while True:
        r, psi = crank.length, float(rng.uniform(-pi, pi))
        l2, l3, l0 = (r * float(x) for x in rng.uniform(0.3, 3, 3))
        side, side_of_limit = (int(rng.choice((1, -1))) for _ in range(2))
        if rng.random() < 0.5:
            cos = (r * r + l0 * l0 - (l2 + l3) ** 2) / (2 * r * l0)
            if abs(cos) < 0.98:
                m = with_rocker(l0 * np.exp(1j * psi), (l2, l3), side, crank)
                return m, psi + side_of_limit * float(np.arccos(cos))
        else:
            e = float(rng.uniform(-0.3, 0.3)) * r
            sin = (l2 - e) / r
            if abs(sin) < 0.98:
                through = complex(-1j * np.exp(1j * psi) * e + np.exp(1j * psi) * rng.uniform(-1, 1) * r)
                at = float(np.arcsin(sin))
                return with_slider(through, psi, l2, side, crank), psi + (at if side_of_limit > 0 else pi - at)


def _sharpened(m: Mechanism, angle: float) -> float:
    """The double next to the dead position on the side where the group assembles."""
    inside = change_points.motion(m, angle - 1e-6) is not None
    low, high = halved(lambda at: (change_points.motion(m, at) is not None) == inside, angle - 1e-6, angle + 1e-6)
    return low if inside else high


def _dead(rng: np.random.Generator, make: Make) -> Iterator[Residual]:
    m, angle = _limited(rng)
    m = loaded(rng, m)
    limit = _sharpened(m, angle)
    sense = 1 if change_points.motion(m, limit + 1e-3) is not None else -1
    gaps = np.concatenate(([0.0], 10.0 ** rng.uniform(-15, 0, 6)))
    phi = limit + sense * gaps
    s = make(m, np.concatenate((phi, limit - sense * gaps[1:])))
    # Against exact arithmetic: here even the last bit of the crank angle decides rightly.
    expected = np.array([change_points.motion(m, x) is not None for x in s.phi.tolist()])
    yield "NaN exactly where it cannot assemble", np.where(s.built != expected, 1.0, 0.0)
    # From 1e-15 rad on: the double next to the limit may be nearer to it than two doubles can tell.
    for name, residual in _compared(s, phi):
        yield name, residual[1:]
    yield from _checked(s, geometry, rigidity, statics)


def _change_points(rng: np.random.Generator, make: Make) -> Iterator[Residual]:
    """Parallelograms, kites and four-bars that fold flat, or miss it by some 1e-13; about their change points."""
    size = 2.0 ** int(rng.integers(-9, 10))
    a, b = size * float(rng.integers(1, 64)) / 16, size * float(rng.integers(1, 64)) / 16
    crank, rod, rocker, frame = ((a, b, a, b), (a, a, b, b), (a, b, a + b, 2 * max(a, b)))[int(rng.integers(3))]
    if frame == 2 * max(a, b):
        rocker = frame + crank - rod  # crank + frame = rod + rocker
    rod *= 1 + float(rng.choice((0.0, 0.0, 1e-13, -1e-13, 1e-9)))
    m = with_rocker(frame, (rod, rocker), side=rng.choice((1, -1)), crank=replace(crank_of(rng, size), length=crank))
    near = 10.0 ** rng.uniform(-15, -1, ANGLES // 2)
    yield from _checked(make(m, np.concatenate((near, pi - near, [0.0, pi]))), geometry, assembled)


def _compared(s: State, phi: Any, where: str = "at a dead position") -> Iterator[Residual]:
    """Velocity and acceleration of the first group's hinge against exact arithmetic at the first positions of a state."""
    true = [change_points.motion(s.m, x) for x in phi.tolist()]
    v, a = (np.array([np.nan if t is None else getattr(t, name) for t in true]) for name in "va")
    return hinge_errors(s, v, a, where)
def _stroke_ends(rng: np.random.Generator, make: Make) -> Iterator[Residual]:
    """Crank and rod in line, folded or stretched, exactly or nearly: the slider or rocker stands still."""
    size = 2.0 ** int(rng.integers(-9, 10))
    r, l2 = (size * float(rng.integers(low, high)) / 16 for low, high in ((1, 16), (32, 64)))
    side, turn = int(rng.choice((1, -1))), float(rng.choice((0.0, pi / 2, pi, -pi / 2, rng.uniform(-pi, pi))))
    crank = replace(crank_of(rng, size), length=r)
    if rng.random() < 0.5:
        e = float(rng.choice((0.0, 0.0, r / 2, -r / 2)))
        m = with_slider(e * 1j * np.exp(1j * turn), turn, l2, side, crank)
        ends = [float(np.arcsin(e / (l2 + r))), pi + float(np.arcsin(e / (l2 - r)))]
        ends = [turn + (x if side > 0 else pi - x) for x in ends]
    else:
        l0, l3 = (size * float(rng.integers(low, high)) / 16 for low, high in ((48, 64), (48, 64)))
        m = with_rocker(l0 * np.exp(1j * turn), (l2, l3), side, crank)
        cosines = [(x * x + l0 * l0 - l3 * l3) / (2 * x * l0) for x in (l2 + r, l2 - r)]
        if max(map(abs, cosines)) > 0.98 or r + l0 > l2 + l3:
            return
        ends = [turn + side * float(np.arccos(cosines[0])), pi + turn + side * float(np.arccos(cosines[1]))]
    gaps = np.concatenate(([0.0], 10.0 ** rng.uniform(-16, 0, 5) * rng.choice((1, -1), 5)))
    phi = np.concatenate([end + gaps for end in ends])
    s = make(m, phi)
    yield from _compared(s, phi)
    still = np.abs(s.v["C"][[0, len(gaps)]]) / (crank.speed * r)
    # The angle of the end is a double, the way beside it is of the second order.
    yield "standstill at the ends of the stroke", still
    yield from _checked(make(loaded(rng, m), phi, _gravity(rng, m)))


def _tangent(rng: np.random.Generator, make: Make) -> Iterator[Residual]:
    """A rod just long enough: the pin's circle touches the limit on one side of the guide, or misses it by some 1e-13."""
    size = 2.0 ** int(rng.integers(-9, 10))
    r, e = size * float(rng.integers(1, 64)) / 16, size * float(rng.integers(-16, 17)) / 16
    side, turn = int(rng.choice((1, -1))), float(rng.choice((0.0, pi / 2, pi, -pi / 2)))
    rod = (r + abs(e)) * (1 + float(rng.choice((0.0, 0.0, 1e-13, -1e-13, 1e-9))))
    through = complex(1j * e) * {0.0: 1, pi / 2: 1j, pi: -1, -pi / 2: -1j}[turn]
    m = with_slider(through, turn, rod, side, replace(crank_of(rng, size), length=r))
    near = 10.0 ** rng.uniform(-7, -1, 5)
    top = turn + (-pi / 2 if e > 0 else pi / 2)
    phi = np.concatenate((top + near, top - near, [top]))
    s = make(m, phi)
    yield from _checked(s, geometry, rigidity, assembled)
    # A rod longer by half a unit in its last place lifts the half-chord by that over the half-chord: data, not arithmetic.
    for name, residual in _compared(s, phi[:-1], "at a change point"):
        yield name, residual / s.condition[:-1]


def _mirrored(m: Mechanism) -> Mechanism:
    """The mechanism as its picture in a mirror is: x stays, y and every sense of turning change their sign."""
    guides = {name: replace(g, through=g.through if isinstance(g.through, str) else g.through.conjugate(), direction=-g.direction)
              for name, g in m.guides.items()}
    # On a guide the side is told along it, and that stays.
    groups = tuple(replace(g, side=g.side if len(g.kind.sliders(g)) == 1 else -g.side, slot=-g.slot) for g in m.groups)
    return replace(m, crank=replace(m.crank, sense=-m.crank.sense), fixed={name: z.conjugate() for name, z in m.fixed.items()},
                   guides=guides, groups=groups, points=tuple(replace(p, angle=-p.angle) for p in m.points))


def _mirror(rng: np.random.Generator, make: Make) -> Iterator[Residual]:
    """A mechanism and its picture in a mirror: sides, offsets, slots and senses of both signs."""
    m, phi = chain(rng, str(rng.choice(("", "offset"))))
    m = loaded(rng, m)
    around = _around(rng, phi)
    s, other = make(m, around), make(_mirrored(m), -around)
    grown = s.condition
    # Positions are off by rounding times the condition; so are directions, and lines that cross by as much again.
    for name, scale in (("z", s.reach * grown), ("v", s.fastest * grown**2), ("a", s.sharpest * grown**2)):
        here, there = getattr(s, name), getattr(other, name)
        for point in here:
            yield "picture in a mirror", np.abs(here[point] - np.conj(there[point])) / scale
    mass = sum(link.mass + link.inertia / s.reach**2 for link in m.links.values())
    total = mass * s.sharpest * s.fastest / m.crank.speed
    scale = total * grown**2
    yield "picture in a mirror", np.abs(balancing(s) + balancing(other)) / np.where(scale == 0, 1.0, scale)
def _triads(rng: np.random.Generator, make: Make) -> Iterator[Residual]:
    """A group of class III, now and then before or behind another group."""
    kinds = (TRIAD.number,)
    other = int(rng.integers(0, 6))
    m, phi = chain(rng, kinds=kinds if not other else (other, *kinds) if rng.random() < 0.3 else (*kinds, other))
    m = loaded(rng, m)
    try:
        yield from _checked(make(m, _around(rng, phi), _gravity(rng, m)))
    except CannotBuild:
        return  # after a turn it is another way of assembly: refused


SCENES: dict[str, Scene] = {
    "chain": _chain(""),
    "mixed features": features,
    "dead position": _dead,
    "narrow crossing": _chain("narrow"),
    "collinear": _chain("collinear"),
    "change point": _change_points,
    "guide by the vertical": _chain("guide"),
    "guide point far away": _chain("far"),
    "far from the origin": _chain("away"),
    "million turns": _turns,
    "huge and zero masses": _chain("", 6.0, 0.5),
    "no forces": _chain("", 0.0, 1.0),
    "end of the stroke": _stroke_ends,
    "rod just long enough": _tangent,
    "mirror": _mirror,
    "tiny crank": _chain("tiny crank"),
    "offset next to nothing": _chain("offset"),
    "right angles": _chain("square"),
    "one line, one pivot": _chain("coincident"),
    "pin by the pivot": _chain("pin by the pivot"),
    **{name: scene(name) for name in ("parallelogram", "antiparallelogram", "kite", "slider-crank")},
    "four-bar that folds": folding,
    "parallelograms in a row": in_a_row,
    "class III": _triads,
}
"""Scenes by name, run in turn."""


def run_case(seed: int, case: int) -> tuple[str, list[tuple[str, float]]]:
    """Scene of a case and the worst value of each invariant in it."""
    turn, number = divmod(case, len(SCENES))
    scene, make = list(SCENES)[number], OneFunction if turn % 2 else State  # each scene by steps and by one function in turn
    found: dict[str, float] = {}
    with np.errstate(all="ignore"):
        for name, residual in SCENES[scene](np.random.default_rng((seed, case)), make):
            values = np.asarray(residual, dtype=float)
            values = values[~np.isnan(values)]
            if len(values):
                found[name] = max(found.get(name, 0.0), float(values.max()))
    return scene, list(found.items())


CHUNK = 20_000
"""Positions drawn at once when there are very many."""


def memory(positions: int = 1_000_000) -> float:
    """Most memory, MB, that plans of a six-bar at very many positions take when they are drawn in chunks."""
    import tracemalloc

    m = chain(np.random.default_rng(0), kinds=(1, 2))[0]
    tracemalloc.start()
    total = 0.0
    for first in range(0, positions, CHUNK):
        s = State(m, 2 * pi / positions * np.arange(first, min(first + CHUNK, positions)))
        total = max(total, float(np.nanmax(s.size, initial=-inf)))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return peak / 1e6


MEMORY = "memory of a million positions, MB"
NUMBERS = (1, 2, 3, 4)
"""Columns of the table that hold numbers."""


def run(cases: int, seed: int, say: Callable[[int], None] = lambda case: None, *, first: int = 0,
        million: bool = True) -> dict[str, Worst]:
    """Run so many cases of a seed from the ``first`` on; ``say`` hears the number of each before it is run.

    Returns the worst of every invariant that some case tells of; ``million`` adds the memory of very many positions.
    """
    worst: dict[str, Worst] = {}
    for case in range(first, first + cases):
        say(case)
        scene, values = run_case(seed, case)
        for name, value in values:
            worst.setdefault(name, Worst()).take(value, case, scene)
    if million:
        worst[MEMORY] = Worst(1, memory(), 0, f"chunks of {CHUNK}")
    return {name: worst[name] for name in BOUNDS if name in worst}


def exceeded(worst: dict[str, Worst]) -> list[str]:
    """Invariants whose bound does not hold; a value that is no number holds nothing."""
    return [name for name, w in worst.items() if not w.value <= BOUNDS[name][0]]


def table(worst: dict[str, Worst], seed: int) -> str:
    """The table: invariant, cases that tell of it, worst value, bound, the case it is from, what the value is a share of."""
    rows = [(tell("invariant"), tell("cases"), tell("worst"), tell("bound"), tell("case"), tell("scene"), tell("share"))]
    for name, w in worst.items():
        bound, share = BOUNDS[name]
        number = "-" if name == MEMORY else str(w.case)
        of = share if w.value <= bound else tell("EXCEEDED: {share}").format(share=share)
        rows.append((name, str(w.cases), of_reader(f"{w.value:.1e}"), f"{bound:.0e}", number, w.scene, of))
    widths = [max(len(row[i]) for row in rows) for i in range(6)]
    lines = []
    for row in rows:
        cells = (f"{cell:{'>' if i in NUMBERS else '<'}{w}}" for i, (cell, w) in enumerate(zip(row, widths, strict=False)))
        lines.append("  ".join([*cells, row[6]]))
    # The case that is nearest to a bound, or farthest beyond it.
    shares = ((inf if isnan(w.value) else w.value / BOUNDS[name][0], w.case) for name, w in worst.items() if name != MEMORY)
    again = quoting.command("stress", "--seed", str(seed), "--case", str(max(shares, default=(0.0, 0))[1]))
    return "\n".join([*lines, tell("one case again: {command}").format(command=again)])
