"""All reactions of a mechanism at once: one linear system of the three equations of equilibrium of every moving link.

Built from links and pairs alone; knows nothing of groups, force plans or their order. Kinematics from ``truth``.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import mpmath
import numpy as np

from tests.methods.linkage import truth
from tmm_sheets.mechanism.model import Mechanism


def cross(u: complex, v: complex) -> float:
    return (np.conj(u) * v).imag


@dataclass
class Solution:
    """Reactions by name (F54: on 5 from 4), couples of sliding pairs about the pair's point, the balancing unknown."""

    reactions: dict = field(default_factory=dict)
    couples: dict = field(default_factory=dict)
    balancing: float = 0.0
    unknowns: int = 0
    friction: float = 0.0


def reaction(j: str, k: str) -> str:
    """F54; F11,0 where the digits would run together."""
    return f"F{j}{k}" if len(j + k) == 2 else f"F{j},{k}"


def slides(m: Mechanism, s: truth.State) -> dict:
    """Direction of each sliding pair, by its two links."""
    found = {}
    for g in m.groups:
        i, j = g.links
        axes = [complex(truth.guide(m, s, name)[1]) for name in g.guides]
        owners = [m.guides[name].link for name in g.guides]
        if g.kind.number == 2:
            found[j, owners[0]] = axes[0]
        elif g.kind.number == 3:
            found[i, j] = complex(s.links[i])
        elif g.kind.number == 4:
            found[owners[0], i], found[j, owners[1]] = axes
        elif g.kind.number == 5:
            found[i, j], found[j, owners[0]] = axes[0] * np.exp(1j * g.slot), axes[0]
    return found


def material(m: Mechanism, motion, link: str, z: complex) -> complex:
    """Velocity of the point of a link that is at a place now."""
    if link == m.frame:
        return 0j
    own = [pair.name.rstrip("′″") for pair in m.pairs if pair.motion == "rotation" and link in pair.links]
    own += [g.inner for g in m.groups if g.kind.number == 5 and g.links[1] == link]
    return motion.v[own[0]] + 1j * motion.omega[link] * (z - motion.z[own[0]])


def friction_of(m: Mechanism, motion, columns, x, turning: float, sliding: float, radii):
    """Loads that Coulomb's friction adds: (link, point, force, couple), for reactions ``x``; signs by the relative velocities."""
    for c in range(0, len(columns), 2):
        pair, at, *_ = columns[c]
        one, other = pair.links
        if pair.motion == "rotation":
            w = motion.omega[one] - motion.omega[other]
            size = abs(complex(x[c], x[c + 1]))
            moment = -np.sign(w) * turning * radii.get(pair.name.rstrip("′″"), 0.0) * size if abs(w) > 1e-9 else 0.0
            force = 0j
        else:
            v = material(m, motion, one, at) - material(m, motion, other, at)
            moment, force = 0.0, -sliding * abs(x[c]) * v / abs(v) if abs(v) > 1e-9 else 0j
        yield one, at, force, moment
        yield other, at, -force, -moment


def solve(m: Mechanism, phi: float, gravity: float, applied=(), couples=(), driver=None, epsilon: float = 0.0,
          friction=None) -> Solution:
    """Reactions at one crank angle.

    ``applied`` are (link, point, force), ``couples`` (link, N m); ``driver`` is (point, direction) of the balancing force,
    None for a balancing moment on the crank; ``friction`` the coefficients of turning and sliding pairs and the radii of journals:
    then Newton's method over all equations, from the reactions without friction.
    """
    motion = truth.motion(m, phi, epsilon=epsilon)
    with mpmath.workdps(30):
        directions = slides(m, truth.state(m, mpmath.mpf(float(phi))))
    moving = [link for link in m.links if link != m.frame]
    columns = []  # (pair, force on the first link, couple on the first link)
    for pair in m.pairs:
        at = motion.z[pair.name.rstrip("′″")]
        if pair.motion == "rotation":
            columns += [(pair, at, 1 + 0j, 0.0), (pair, at, 1j, 0.0)]
        else:
            u = directions[pair.links]
            columns += [(pair, at, 1j * u, 0.0), (pair, at, 0j, 1.0)]
    n = len(columns) + 1
    assert n == 3 * len(moving)
    a, b = np.zeros((n, n)), np.zeros(n)

    def put(link, at, force, couple, column):
        if link != m.frame:
            row = 3 * moving.index(link)
            a[row:row + 3, column] += (force.real, force.imag, cross(at, force) + couple)

    def load(link, at, force, couple=0.0):
        row = 3 * moving.index(link)
        b[row:row + 3] -= (force.real, force.imag, cross(at, force) + couple)

    for column, (pair, at, force, couple) in enumerate(columns):
        put(pair.links[0], at, force, couple, column)
        put(pair.links[1], at, -force, -couple, column)
    if driver is None:
        put(m.crank.link, 0j, 0j, 1.0, n - 1)
    else:
        put(m.crank.link, *driver, 0.0, n - 1)
    for link in m.links.values():
        if link.mass:
            load(link.name, motion.z[link.centre], link.mass * (-1j * gravity - motion.a[link.centre]))
        load(link.name, 0j, 0j, -link.inertia * motion.epsilon[link.name])
    for link, point, force in applied:
        load(link, motion.z[point], force)
    for link, couple in couples:
        load(link, 0j, 0j, couple)
    scale = np.abs(a).max(axis=1, keepdims=True)
    x = np.linalg.solve(a / scale, b / scale[:, 0])
    added = ()
    if friction is not None:
        def residual(x):
            r = a @ x - b
            for link, at, force, couple in friction_of(m, motion, columns, x, *friction):
                if link != m.frame:
                    row = 3 * moving.index(link)
                    r[row:row + 3] += (force.real, force.imag, cross(at, force) + couple)
            return r / scale[:, 0]

        for _ in range(30):
            here, step = residual(x), 1e-6 * np.abs(x).max()
            jacobian = np.array([(residual(x + step * e) - residual(x - step * e)) / (2 * step) for e in np.eye(n)]).T
            change = np.linalg.solve(jacobian, here)
            x = x - change
            if np.abs(change).max() < 1e-13 * np.abs(x).max():
                break
        added = tuple(friction_of(m, motion, columns, x, *friction))
    found = Solution(balancing=float(x[-1]), unknowns=n)
    found.friction = sum((np.conj(force) * material(m, motion, link, at)).real + (couple * motion.omega[link] if couple else 0)
                         for link, at, force, couple in added)
    for column, (pair, _, force, couple) in enumerate(columns):
        i, j = pair.links
        rubbed = next((f for link, at, f, _ in added[column:column + 1]), 0j) if column % 2 == 0 else 0j
        for name, sign in ((reaction(i, j), 1), (reaction(j, i), -1)):
            found.reactions[name] = found.reactions.get(name, 0) + sign * (x[column] * force + rubbed)
            if couple:
                found.couples[name] = sign * float(x[column])
    return found
