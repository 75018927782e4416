"""Motion and reactions of mechanisms in 100 digits, sharing nothing with the methods.

Loops are closed by trigonometry; velocities and accelerations are central differences of positions: with 100 digits and a step of
1e-33 the former keep 60 digits, the latter 30. Reactions come from one linear system, the three equations of equilibrium of every
moving link. Numbers are those of ``mpmath``; given lengths are the doubles they are.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from mpmath import mp

from tmm_sheets.construction.indices import pair_index
from tmm_sheets.mechanism.model import Guide, Mechanism, StructuralGroup

DIGITS = 100
STEP_DIGITS = 33


@dataclass
class TrueState:
    """Points, m, and a unit vector fixed on every link."""

    points: dict[str, Any] = field(default_factory=dict)
    links: dict[str, Any] = field(default_factory=dict)


@dataclass
class TrueMotion:
    """Positions, velocities and accelerations of points, angular velocities and accelerations of links, at one crank angle; SI."""

    z: dict[str, Any]
    v: dict[str, Any]
    a: dict[str, Any]
    omega: dict[str, Any]
    epsilon: dict[str, Any]
    state: TrueState


def _unit(z: Any) -> Any:
    return z / abs(z)


def _meet(p: Any, u: Any, q: Any, v: Any) -> Any:
    det = u.imag * v.real - u.real * v.imag
    w = q - p
    return p + u * (w.imag * v.real - w.real * v.imag) / det


def state(m: Mechanism, phi: Any) -> TrueState:
    """Points and directions at a crank angle, rad in the world frame."""
    s = TrueState({name: mp.mpmathify(z) for name, z in m.fixed.items()}, {m.frame: mp.mpc(1)})
    c = m.crank
    s.links[c.link] = mp.expj(phi)
    s.points[c.pin] = s.points[c.pivot] + c.length * s.links[c.link]
    _add_link_points(m, s, c.link)
    for g in m.groups:
        _place(m, s, g)
        for link in g.links:
            _add_link_points(m, s, link)
    return s


def _base(m: Mechanism, s: TrueState, link: str, start: str, towards: str) -> Any:
    """Direction from one point of a link to another; towards the pin of a sliding block it is the slot, even if offset."""
    for g in m.groups:
        if g.kind.number == 3 and link in g.links and towards == g.outer[0]:
            return s.links[link]
    return _unit(s.points[towards] - s.points[start])


def _add_link_points(m: Mechanism, s: TrueState, link: str) -> None:
    for p in m.points:
        if p.link == link:
            s.points[p.name] = s.points[p.start] + p.distance * _base(m, s, link, p.start, p.towards) * mp.expj(p.angle)


def _guide(m: Mechanism, s: TrueState, guide: Guide) -> tuple[Any, Any]:
    if isinstance(guide.through, str):
        u = _base(m, s, guide.link, guide.through, guide.towards or "")
        return s.points[guide.through], u * mp.expj(guide.direction)
    return mp.mpmathify(guide.through), mp.expj(guide.direction)


def _place(m: Mechanism, s: TrueState, g: StructuralGroup) -> None:
    i, j = g.links
    outer = [s.points[name] for name in g.outer]
    guides = [_guide(m, s, m.guides[name]) for name in g.guides]
    if g.kind.number == 1:
        p, q = outer
        l1, l2, d = mp.mpf(g.lengths[0]), mp.mpf(g.lengths[1]), abs(q - p)
        c = p + l1 * _unit(q - p) * mp.expj(g.side * mp.acos((d * d + l1 * l1 - l2 * l2) / (2 * d * l1)))
        s.points[str(g.inner)], s.links[i], s.links[j] = c, _unit(c - p), _unit(c - q)
    elif g.kind.number == 2:
        (p,), ((through, u),) = outer, guides
        angle = mp.asin(-((p - through) / u).imag / mp.mpf(g.lengths[0]))
        rod = mp.expj(angle if g.side > 0 else mp.pi - angle) * u
        s.points[str(g.inner)], s.links[i], s.links[j] = p + g.lengths[0] * rod, rod, u
    elif g.kind.number == 3:
        p, q = outer
        turn = mp.asin(abs(mp.mpf(g.offset)) / abs(p - q))
        s.links[i] = s.links[j] = _unit(p - q) * mp.expj(g.side * turn)
    elif g.kind.number == 4:
        (p, u), (q, v) = guides
        s.points[str(g.inner)], s.links[i], s.links[j] = _meet(p, u, q, v), u, v
    else:
        (p,), ((through, u),) = outer, guides
        s.links[i], s.links[j] = u * mp.expj(g.slot), u
        s.points[str(g.inner)] = _meet(p, s.links[i], through, u)


def motion(m: Mechanism, phi: float) -> TrueMotion:
    """Motion at a crank angle, rad, of a uniformly turning crank, in :data:`DIGITS` digits."""
    with mp.workdps(DIGITS):
        w, h = mp.mpf(m.crank.omega), mp.mpf(10) ** -STEP_DIGITS
        low, here, high = (state(m, mp.mpf(float(phi)) + k * h) for k in (-1, 0, 1))

        def first(a: dict[str, Any], b: dict[str, Any]) -> dict[str, Any]:
            return {k: (b[k] - a[k]) / (2 * h) * w for k in a}

        def second(a: dict[str, Any], o: dict[str, Any], b: dict[str, Any]) -> dict[str, Any]:
            return {k: (b[k] - 2 * o[k] + a[k]) / h**2 * w * w for k in a}

        turning, bending = first(low.links, high.links), second(low.links, here.links, high.links)
        return TrueMotion(
            here.points, first(low.points, high.points), second(low.points, here.points, high.points),
            {k: (mp.conj(u) * turning[k]).imag for k, u in here.links.items()},
            {k: (mp.conj(u) * bending[k]).imag for k, u in here.links.items()}, here)


def _axes(m: Mechanism, s: TrueState) -> dict[tuple[str, str], Any]:
    """Direction of each sliding pair by its two links: that of the first link of its group in it."""
    return {pair.links: s.links[next(link for link in g.links if link in pair.links)]
            for g in m.groups for pair in g.kind.pairs(m, g) if pair.motion == "translation"}


def _cross(u: Any, v: Any) -> Any:
    return (mp.conj(u) * v).imag


def reactions(m: Mechanism, moved: TrueMotion, gravity: float) -> tuple[dict[str, Any], Any]:
    """Reactions by name (F54: on 5 from 4), N, and the balancing moment on the crank, N m, under weights and inertia."""
    with mp.workdps(40):
        axes = _axes(m, moved.state)
        rows = {link: 3 * k for k, link in enumerate(name for name in m.links if name != m.frame)}
        unknowns: list[tuple[tuple[str, str], Any, Any, Any]] = []  # links, point, force on the first link, couple on it
        for pair in m.pairs:
            at = moved.z[pair.name.rstrip("′″")]
            if pair.motion == "rotation":
                unknowns += [(pair.links, at, mp.mpc(1), 0), (pair.links, at, mp.mpc(0, 1), 0)]
            else:
                unknowns += [(pair.links, at, 1j * axes[pair.links], 0), (pair.links, at, mp.mpc(0), 1)]
        n = len(unknowns) + 1
        a, b = mp.matrix(n, n), mp.matrix(n, 1)

        def put(target: Any, column: int, link: str, at: Any, force: Any, couple: Any, sign: int) -> None:
            if link in rows:
                for k, part in enumerate((force.real, force.imag, _cross(at, force) + couple)):
                    target[rows[link] + k, column] += sign * part

        for column, ((one, other), at, force, couple) in enumerate(unknowns):
            put(a, column, one, at, force, couple, 1)
            put(a, column, other, at, force, couple, -1)
        put(a, n - 1, m.crank.link, mp.mpc(0), mp.mpc(0), 1, 1)
        for link in m.links.values():
            if link.mass and link.centre is not None:
                put(b, 0, link.name, moved.z[link.centre], link.mass * (mp.mpc(0, -gravity) - moved.a[link.centre]), 0, -1)
            put(b, 0, link.name, mp.mpc(0), mp.mpc(0), -link.inertia * moved.epsilon[link.name], -1)
        x = mp.lu_solve(a, b)
        found: dict[str, Any] = {}
        for column, ((one, other), _, force, _) in enumerate(unknowns):
            for name, sign in ((f"F{pair_index(one, other)}", 1), (f"F{pair_index(other, one)}", -1)):
                found[name] = found.get(name, 0) + sign * x[column] * force
        return found, x[n - 1]
