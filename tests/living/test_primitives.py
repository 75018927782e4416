"""The primitives in JavaScript against those in Python, on arguments by chance and on degenerate ones."""

import numpy as np
import pytest

from tests.few import all_hold, few
from tests.living import javascript
from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction.function import told
from tmm_sheets.mechanism.groups import dead_centres, three_legs
from tmm_sheets.methods.linkage import forces, loads, synthesis

RUN = javascript.modules("digits", "primitives") + """
const result = (asked) => asked.map(({ name, rows }) => rows.map((args) => PRIMITIVES[name](...args)));
"""
pytestmark = javascript.needed


@pytest.fixture(params=few((1_000, 10_000), 1_000))
def n(request):
    """How many arguments."""
    return request.param


def kind(rng, what, n):
    """Arguments of a kind: by chance, every tenth of them one on which constructions end."""
    if what == "side":
        return rng.choice((1.0, -1.0), n)
    if what == "angle":
        x = rng.uniform(-7, 7, n)
        return np.where(rng.random(n) < 0.1, np.pi / 2 * rng.integers(-5, 6, n), x)
    if what == "length":
        return np.where(rng.random(n) < 0.1, rng.choice((0.5, 1.0, 1.5, 1e-9, 1e3), n), rng.uniform(0.1, 2, n))
    if what == "number":
        return np.where(rng.random(n) < 0.1, rng.choice((0.0, 1.0, -1.0, np.nan, 1e9), n), rng.normal(size=n))
    if what == "known":
        return np.where(rng.random(n) < 0.5, np.nan, rng.uniform(-1, 1, n))
    if what == "direction":
        return np.exp(1j * kind(rng, "angle", n))
    z = rng.normal(size=n) + 1j * rng.normal(size=n)
    return np.where(rng.random(n) < 0.1, rng.choice((0j, 1 + 0j, 1j, 0.5 + 0j, 1e6 + 1e6j, complex(np.nan, np.nan)), n), z)


ELEMENTWISE = {
    "cross": (ar.cross, ("point", "point")), "dot": (ar.dot, ("point", "point")),
    "difference of products": (ar.difference_of_products, ("number",) * 4),
    "lines meet": (ar.line_line, ("point", "direction", "point", "direction", "number", "known")),
    "arc cuts arc": (ar.arc_arc, ("point", "length", "point", "length", "side", "length", "length", "direction")),
    "arc cuts line": (ar.arc_line, ("point", "length", "point", "direction", "side", "length")),
    "tangent": (ar.tangent_point, ("point", "point", "length", "side")),
    "tangent direction": (ar.tangent_direction, ("point", "point", "length", "side", "length", "length")),
    "value or its limit": (forces.in_limit, ("number", "known")),
    "fraction of a swing": (loads.swing_done, ("direction", "side", "angle", "length")),
    "unit": (np.vectorize(ar.unit), ("angle",)),
    "round to a step": (np.vectorize(synthesis.nearest_multiple), ("number", "length")),
    "15 digits": (np.vectorize(synthesis.digits_of), ("number",)),
}
SHORTER = {"lines meet": (4, 5, 6), "arc cuts arc": (5, 7, 8), "arc cuts line": (5, 6), "tangent direction": (4, 6)}


def close(found, own, size, some=0.05):
    """Undefined where the other is, else alike to 1e-12 of the sizes."""
    found = np.array([[np.nan if x is None else float(x) for x in np.ravel([row])] for row in found]).T
    found = found[0] if len(found) == 1 else found[0] + 1j * found[1]
    own = np.asarray(own)
    np.testing.assert_array_equal(np.isnan(found), np.isnan(own))
    np.testing.assert_array_equal(np.isinf(found), np.isinf(own))
    there = np.isfinite(own)
    assert there.mean() > some
    assert (np.abs(found[there] - own[there]) <= 1e-12 * (size + np.abs(own))[there]).all()


def all_close(cases, n, folder):
    """Name of each case, the primitive's arguments, own values and sizes: all of them in one process."""
    asked = [{"name": name.partition(",")[0], "rows": listed(args, n)} for name, (args, _, _) in cases.items()]
    found = javascript.run(RUN, asked, folder)
    told = dict(zip(cases, found, strict=True))
    all_hold(lambda name: close(told[name], *cases[name][1:]), cases)


def listed(args, n):
    """Rows of arguments for JSON."""
    columns = [a if isinstance(a, list) else told(np.broadcast_to(a, (n,))) for a in args]
    return [list(row) for row in zip(*columns, strict=True)]


def test_one_by_one(n, tmp_path):
    cases = {}
    for name, (function, takes) in ELEMENTWISE.items():
        for count in SHORTER.get(name, (len(takes),)):
            rng = np.random.default_rng(11)
            args = [kind(rng, what, n) for what in takes[:count]]
            with np.errstate(all="ignore"):
                own = function(*args)
                size = sum(np.nan_to_num(np.abs(a)) for a in args)
            # The greatest number that is met on the way: where lines cross under next to no angle, the point itself.
            if name in ("cross", "dot", "difference of products"):
                size = size * size
            cases[f"{name}, {count}"] = args, own, size
    all_close(cases, n, tmp_path)


def mechanisms(rng, n):
    """Numbers of groups on a crank, some of them with equal lengths, each at ten crank angles, some of them dead positions."""
    few = n // 10
    l1, l2, l3 = (np.round(rng.uniform(0.1, 0.5, few), 2) for _ in range(3))
    l2 = np.where(rng.random(few) < 0.1, l3, l2)
    fixed = np.round(rng.uniform(0.1, 0.9, few), 1) * rng.choice((1, 1j, 0.6 + 0.8j, -1), few)
    ahead, guide = rng.choice((0.0, np.pi / 2, 0.3), few), rng.choice((0.0, np.pi, 1.0, -np.pi / 2), few)
    return kind(rng, "angle", n), *(np.repeat(x, 10) for x in (l1, l2, l3, fixed, ahead, guide))


def test_from_the_crank_angle(n, tmp_path):
    phi, l1, l2, l3, fixed, ahead, guide = mechanisms(np.random.default_rng(5), n)
    zero = np.zeros(n, dtype=complex)
    cases = {}
    for name, (function, args) in {
        "distance from the crank's point": (dead_centres.pin_distance, (phi, l1, ahead, zero, fixed)),
        "half-chord of two arcs": (dead_centres.half_of_arcs, (phi, l1, ahead, zero, fixed, l2, l3)),
        "tangent from the crank's point": (dead_centres.tangent_length, (phi, l1, ahead, zero, fixed, l2 / 4)),
        "half-chord of arc and line": (dead_centres.half_of_line, (phi, l1, ahead, l2, zero, 0.2 * fixed, guide)),
        "foot on a guide": (dead_centres.foot_on_guide, (fixed, 1e3 * fixed * 1j, guide)),
    }.items():
        with np.errstate(all="ignore"):
            cases[name] = args, np.array([function(*(x.item() for x in row)) for row in zip(*args, strict=True)]), 1e-3 * l1
    all_close(cases, n, tmp_path)


def legs_of(rng, does, n):
    """Legs on which a triangle stands by its corner ``k`` in the direction ``u``; one point of theirs is 1 m away."""
    k, u = 0.3 * (rng.normal(size=n) + 1j * rng.normal(size=n)), np.exp(1j * rng.uniform(0, 6.3, n))
    legs = []
    for number, what in enumerate(does):
        corner = np.zeros(n, dtype=complex) if not number else rng.uniform(0.2, 0.6, n) * np.exp(1j * rng.uniform(0, 2, n))
        at, way = k + corner * u, rng.normal(size=n) + 1j * rng.normal(size=n)
        if what == three_legs.SLOT:
            angle = rng.uniform(0, 3, n)
            p, length, d = k + rng.uniform(0.2, 0.6, n) * u * np.exp(1j * angle), angle, np.ones(n, dtype=complex)
            corner = np.zeros(n, dtype=complex)
        else:
            d = way / np.abs(way)
            p = at + 0.4 * way
            length = np.abs(at - p) if what == three_legs.CIRCLE else np.zeros(n)
            if what == three_legs.LINE:
                p = at + 0.4 * d
        legs += [np.full(n, what), p, d, length, corner]
    farthest = np.max([np.abs(p) for p in legs[1::5]], axis=0)
    for i in range(len(legs)):  # every group of one size: what is rounding is told by the largest
        if i % 5 in (1, 4) or (i % 5 == 3 and does[i // 5] != three_legs.SLOT):
            legs[i] = legs[i] / farthest
    return k / farthest, u, legs


@pytest.mark.parametrize("name", ["corner of a triangle on three legs", "direction of a triangle on three legs", "false position",
                                  "side of a false position"])
def test_triangles(name, n, tmp_path):
    rng = np.random.default_rng(2)
    function = {"corner of a triangle on three legs": three_legs.corner_on_legs,
                "direction of a triangle on three legs": three_legs.direction_on_legs,
                "false position": three_legs.false_place, "side of a false position": three_legs.false_side}[name]
    rows, owns, others = [], [], []
    kinds = [(a, b, c) for a in (0.0, 1.0) for b in (0.0, 1.0, 2.0) for c in (0.0, 1.0, 2.0)]
    for does in kinds:
        m = (n // 10 if "false" in name else n) // len(kinds) + 1
        k, u, legs = legs_of(rng, does, m)
        more = (np.full(m, 0.02),) if "false" in name else ()
        if not more:
            k, u = k + 0.002 * rng.normal(size=m), u * np.exp(0.003j * rng.normal(size=m))
        for place, values in ((k, owns), (k * (1 + 1e-15), others)):
            args = (place, u, *more, *legs)  # a false position is moved by a size that many would share
            with np.errstate(all="ignore"):
                values.append([np.ravel(function(*(x[i] for x in args)))[0] for i in range(m)] if more else function(*args))
        rows += listed((k, u, *more, *legs), m)
    own, other = np.concatenate(owns), np.concatenate(others)
    (found,) = javascript.run(RUN, [{"name": name, "rows": rows}], tmp_path)
    # Where the last digit of an argument moves the value there is nothing to compare: normals that all but meet in one point.
    there = np.isnan(own) == np.isnan(other)
    there &= ~(np.abs(own - other) > 1e-13)
    assert there.mean() > 0.95
    close([f for f, t in zip(found, there, strict=True) if t], own[there], np.ones(there.sum()), 0.5)


def test_course(n, tmp_path):
    rng = np.random.default_rng(4)
    angles = np.sort(rng.uniform(0, 2 * np.pi, 40)) + 0.5
    angles = np.append(angles, angles[0] + 2 * np.pi)
    values = np.exp(1j * angles) * np.where(rng.random(41) < 0.2, np.nan, 1.0)
    phi = np.append(rng.uniform(-7, 7, n - 42), [*angles, np.nan])
    with np.errstate(all="ignore"):
        own = three_legs.on_course(phi[:-1], angles, values)
    run = javascript.modules("digits", "primitives") + """
    const result = ({ phi, angles, values }) => phi.map((x) => onCourse(x, angles, values));
    """
    found = javascript.run(run, {"phi": told(phi), "angles": told(angles), "values": told(values)}, tmp_path)
    close(found, np.append(own, np.nan), np.ones(len(phi)))


CURVES = [((0.0, 0.3, 0.3, 1.0), (1.0, 2.0, -1.0, 5.0)), ((0.0, 0.2, 0.5, 0.8, 1.0), (0.0, 3.0, 3.5, 1.0, 0.0)),
          ((0.1, 0.4, 0.9), (2.0, -1.0, 2.0)), ((0.5,), (3.0,))]


TIMES, PLUS = -2.5, 3.0
"""A load is so many times its table, and so much more."""


@pytest.mark.parametrize("smooth", [0.0, 1.0])
@pytest.mark.parametrize("table", CURVES, ids=["jump", "hill", "valley", "one"])
def test_diagrams(table, smooth, n, tmp_path):
    if smooth and len(table[0]) < 2:
        pytest.skip("a smooth curve has two points or more")
    rng = np.random.default_rng(9)
    at = np.concatenate((rng.uniform(-0.5, 9, n), np.repeat(table[0], 3), [np.nan]))
    ahead = rng.choice((1.0, -1.0), len(at))
    x, y = map(np.array, table)
    with np.errstate(all="ignore"):
        once, periodic = (loads.diagram(x, TIMES * y + PLUS, smooth, turns) for turns in (0.0, 1.0))
        own = [loads.ordinate(once, at, ahead), loads.periodic_ordinate(periodic, at, 1.0, -1.0),
               loads.periodic_ordinate(periodic, at, 1.0, 0.0)]
    run = javascript.modules("digits", "primitives", "machine") + """
    const result = ({ drawn, times, plus, factor, at, ahead }) => {
      const [once, periodic] = drawn.map((one) => curveOf({ drawn: one, times, plus }, factor)), p = PRIMITIVES;
      return [at.map((t, i) => p["ordinate of a diagram"](once, t, ahead[i])),
        ...[-1, 0].map((side) => at.map((t) => p["ordinate of a periodic diagram"](periodic, t, 1, side)))];
    };
    """
    data = {"drawn": [told(loads.diagram(x, y, smooth, turns)) for turns in (0.0, 1.0)], "times": TIMES / 0.7, "factor": 0.7,
            "plus": PLUS, "at": told(at), "ahead": told(ahead)}
    for found, values in zip(javascript.run(run, data, tmp_path), own, strict=True):
        close(found, values, np.ones(len(at)))
