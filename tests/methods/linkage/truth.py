"""Motion of mechanisms in 50 digits: positions by trigonometry, velocities and accelerations by differences of them.

Shares nothing with the methods: no polygons, no plans, no doubles. With 50 digits and a step of 1e-15 the central
differences keep 20 digits.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import mpmath
import numpy as np

from tmm_sheets.mechanism.model import Mechanism

DIGITS = 50
STEP = mpmath.mpf(10) ** -15


@dataclass
class State:
    """Points and, for every link, a unit vector fixed on it."""

    points: dict = field(default_factory=dict)
    links: dict = field(default_factory=dict)


def unit(z):
    return z / abs(z)


def meet(p, u, q, v):
    """Intersection of two lines, by Cramer's rule for p + s u = q + t v."""
    det = -u.real * v.imag + u.imag * v.real
    w = q - p
    return p + u * (-w.real * v.imag + w.imag * v.real) / det


def state(m: Mechanism, phi) -> State:
    """Points and link directions at a crank angle (mpmath number)."""
    s = State()
    s.points |= {name: mpmath.mpmathify(z) for name, z in m.fixed.items()}
    s.links[m.frame] = mpmath.mpc(1)
    c = m.crank
    s.links[c.link] = mpmath.expj(phi)
    s.points[c.pin] = s.points[c.pivot] + c.length * s.links[c.link]
    further(m, s, c.link)
    for g in m.groups:
        KINDS[g.kind.number](m, s, g)
        for link in g.links:
            further(m, s, link)
    return s


def base(m, s, link, start, towards):
    """Direction start..towards on a link; towards the pin of a slider block: along the slot, also when there is an offset."""
    for g in m.groups:
        if g.kind.number == 3 and link in g.links and towards == g.outer[0]:
            return s.links[link]
    return unit(s.points[towards] - s.points[start])


def further(m, s, link):
    for p in m.points:
        if p.link == link:
            s.points[p.name] = s.points[p.start] + p.distance * base(m, s, link, p.start, p.towards) * mpmath.expj(p.angle)


def guide(m, s, name):
    """A point and the direction of a guide."""
    g = m.guides[name]
    if g.link == m.frame:
        return mpmath.mpmathify(g.through), mpmath.expj(g.direction)
    return s.points[g.through], base(m, s, g.link, g.through, g.towards) * mpmath.expj(g.direction)


def rrr(m, s, g):
    p, q = (s.points[n] for n in g.outer)
    l1, l2 = (mpmath.mpf(x) for x in g.lengths)
    d = abs(q - p)
    at_p = mpmath.acos((d * d + l1 * l1 - l2 * l2) / (2 * d * l1))
    c = p + l1 * unit(q - p) * mpmath.expj(g.side * at_p)
    s.points[g.inner] = c
    s.links[g.links[0]], s.links[g.links[1]] = unit(c - p), unit(c - q)


def rrp(m, s, g):
    p = s.points[g.outer[0]]
    through, u = guide(m, s, g.guides[0])
    z = (p - through) / u
    angle = mpmath.asin(-z.imag / g.lengths[0])
    rod = mpmath.expj(angle if g.side > 0 else mpmath.pi - angle) * u
    s.points[g.inner] = p + g.lengths[0] * rod
    s.links[g.links[0]], s.links[g.links[1]] = rod, u


def rpr(m, s, g):
    p, q = (s.points[n] for n in g.outer)
    turn = mpmath.asin(abs(mpmath.mpf(g.offset)) / abs(p - q))
    s.links[g.links[0]] = s.links[g.links[1]] = unit(p - q) * mpmath.expj(g.side * turn)


def prp(m, s, g):
    (p, u), (q, v) = (guide(m, s, name) for name in g.guides)
    s.points[g.inner] = meet(p, u, q, v)
    s.links[g.links[0]], s.links[g.links[1]] = u, v


def rpp(m, s, g):
    q, u = guide(m, s, g.guides[0])
    s.points[g.inner] = meet(s.points[g.outer[0]], u * mpmath.expj(g.slot), q, u)
    s.links[g.links[0]] = s.links[g.links[1]] = u


KINDS = {1: rrr, 2: rrp, 3: rpr, 4: prp, 5: rpp}


@dataclass
class Motion:
    """Positions, velocities, accelerations of points; angular velocities and accelerations of links. Doubles, one angle."""

    z: dict
    v: dict
    a: dict
    omega: dict
    epsilon: dict


def motion(m: Mechanism, phi: float, omega: float | None = None, epsilon: float = 0.0) -> Motion:
    """Motion at one crank angle; ``omega``, ``epsilon`` of the crank, counter-clockwise positive."""
    w = mpmath.mpf(m.crank.omega if omega is None else omega)
    e = mpmath.mpf(epsilon)
    with mpmath.workdps(DIGITS):
        low, here, high = (state(m, mpmath.mpf(float(phi)) + k * STEP) for k in (-1, 0, 1))

        def rates(pick):
            out = {}
            for name, z in pick(here).items():
                first = (pick(high)[name] - pick(low)[name]) / (2 * STEP)
                second = (pick(high)[name] - 2 * z + pick(low)[name]) / STEP**2
                out[name] = z, first * w, second * w * w + first * e
            return out

        points = rates(lambda s: s.points)
        links = rates(lambda s: s.links)
        turning = {name: (mpmath.conj(u) * du).imag for name, (u, du, _) in links.items()}
        accelerating = {name: (mpmath.conj(u) * ddu).imag for name, (u, _, ddu) in links.items()}
    return Motion(
        *({name: complex(values[i]) for name, values in points.items()} for i in range(3)),
        *({name: float(x) for name, x in found.items()} for found in (turning, accelerating)),
    )


def motions(m: Mechanism, phis, **crank) -> list[Motion]:
    return [motion(m, phi, **crank) for phi in np.ravel(phis)]


# --- the shaper of manual 000, example 1 -----------------------------------------------------------------------------

AB, AC, CD, CS3, RAM = (mpmath.mpf(x) for x in ("0.08", "0.26", "0.566", "0.283", "0.33"))


def shaper_position(phi):
    """Points of the shaper from the swing of its rocker, by the tangent of its angle from the vertical."""
    x, y = AB * mpmath.cos(phi), AC + AB * mpmath.sin(phi)
    swing = mpmath.atan2(x, y)
    up = mpmath.mpc(mpmath.sin(swing), mpmath.cos(swing))
    c = mpmath.mpc(0, -AC)
    return {"B": AB * mpmath.expj(phi), "D": c + CD * up, "S3": c + CS3 * up, "S5": mpmath.mpc(CD * mpmath.sin(swing), RAM)}, swing


def shaper_motion(phi: float, omega: float) -> tuple[dict, dict, dict, float, float]:
    """Positions, velocities and accelerations of the shaper's points, and omega, epsilon of its rocker, by differentiation."""
    with mpmath.workdps(40):
        w, at = mpmath.mpf(omega), mpmath.mpf(phi)
        names = shaper_position(at)[0]

        def rate(f, n):
            return mpmath.diff(f, at, n) * w**n

        z = {k: complex(p) for k, p in names.items()}
        v = {k: complex(rate(lambda t, k=k: shaper_position(t)[0][k], 1)) for k in names}
        a = {k: complex(rate(lambda t, k=k: shaper_position(t)[0][k], 2)) for k in names}
        # The swing is measured clockwise from the vertical.
        return z, v, a, -float(rate(lambda t: shaper_position(t)[1], 1)), -float(rate(lambda t: shaper_position(t)[1], 2))
