"""Change points: groups that lie in line for a moment while both of their ways of assembly pass, against formulas of reflection.

In a parallelogram the coupler does not turn; in an antiparallelogram and in a kite the hinge C is a mirror image about the line BD;
of a slider-crank with a rod as long as the crank the slider goes 2 r cos(phi), or stands still. These are smooth through the change
points.
"""

from dataclasses import replace
from math import pi

import mpmath
import numpy as np
import pytest

from tests.methods.linkage import truth
from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.groups import RPR, RRP, RRR
from tmm_sheets.mechanism.model import Crank, Guide, Link, LinkPoint, Mechanism, StructuralGroup
from tmm_sheets.methods.linkage.checks import check_assembly, check_followed
from tmm_sheets.methods.linkage.forces import external_loads, kinetostatics, limits_of_forces
from tmm_sheets.methods.linkage.motion import acceleration_plan, velocity_plan
from tmm_sheets.methods.linkage.numbering import even_cycle, swing_cycle
from tmm_sheets.methods.linkage.positions import Passages, position_plan
from tmm_sheets.methods.linkage.zhukovsky import lever

W, E1 = 10.0, 37.0
NEAR = [0.0, 1e-15, -1e-15, 1e-12, -1e-12, 1e-9, -1e-9, 1e-6, -1e-6, 1e-4, -1e-4, 1e-2, -1e-2, 0.3, -0.3]


@pytest.fixture(autouse=True)
def many_digits():
    with mpmath.workdps(60):
        yield


def four_bar(crank, rod, rocker, pivot, side=1, sense=1, **more):
    g = StructuralGroup(RRR, ("2", "3"), ("B", "D"), "C", (rod, rocker), (), side, **more)
    return Mechanism(Crank("1", "A", "B", crank, W, sense, E1), {"A": 0j, "D": complex(pivot)}, {}, (g,), (),
                     {n: Link(n) for n in "123"})


def slider(r, rod, side=1, sense=1, direction=0.0, through=0j, **more):
    g = StructuralGroup(RRP, ("2", "3"), ("B",), "C", (rod,), ("x",), side, **more)
    return Mechanism(Crank("1", "A", "B", r, W, sense, E1), {"A": 0j}, {"x": Guide("x", "0", through, direction)}, (g,), (),
                     {n: Link(n) for n in "123"})


def motion(m, phi):
    """Plans of positions, velocities and accelerations as arrays, and the rates of turning."""
    phi = np.asarray(phi, dtype=float)
    pos = position_plan(m, phi)
    vel = velocity_plan(pos)
    acc = acceleration_plan(vel)
    return tuple({n: np.broadcast_to(s.value, phi.shape) for n, s in of.items()}
                 for of in (pos.points, vel.points, acc.points, vel.omega, acc.epsilon))


def mp(x):
    """A number as it is meant: the decimals it is written with."""
    return mpmath.mpc(mp(x.real), mp(x.imag)) if isinstance(x, complex) else mpmath.mpf(repr(float(x)))


def derivatives(z, phi, m):
    """Value, velocity and acceleration of a smooth function of the crank angle, by differences of 60 digits."""
    h = mpmath.mpf(10) ** -15
    a, b, c = z(phi - h), z(phi), z(phi + h)
    w, e = mpmath.mpf(m.crank.omega), mpmath.mpf(m.crank.sense * m.crank.acceleration)
    first, second = (c - a) / (2 * h), (a - 2 * b + c) / h**2
    return b, first * w, second * w**2 + first * e


def reflected(m, of):
    """C as the mirror image about BD of D - A + B (``of`` "parallelogram") or of A ("crank")."""
    r, d = mp(m.crank.length), mp(m.fixed["D"])

    def z(phi):
        b = r * mpmath.expj(phi)
        e = d - b
        return b + e * mpmath.conj(d if of == "parallelogram" else -b) / mpmath.conj(e)

    return z


def translated(m):
    return lambda phi: mp(m.crank.length) * mpmath.expj(phi) + mp(m.fixed["D"])


SLANTED = 0.072 + 0.096j  # 0.12 m under the angle whose tangent is 4/3
AT = mpmath.atan2(4, 3)
"""Both ways of each mechanism through its change points, by the side behind the first of them, and the crank angles of these."""


def ways():
    """Name, mechanism that follows, the hinge C as a function of the crank angle, change points."""
    for sense in (1, -1):
        for name, pivot, start in (("level", 0.12, mpmath.mpf(0)), ("slanted", SLANTED, AT)):
            points = (start, start + mpmath.pi)
            at = float(start) + 0.5
            for side in (1, -1):
                m = four_bar(0.06, abs(pivot), 0.06, pivot, side, sense, follow=True, at=at)
                z = translated(m) if side > 0 else reflected(m, "parallelogram")
                yield f"{name} parallelogram {side} {sense}", m, z, points
                m = four_bar(0.06, 0.06, 0.12, pivot, side, sense, follow=True, at=at)
                z = (lambda phi: mpmath.mpc(0)) if side < 0 else reflected(m, "crank")
                yield f"{name} kite {side} {sense}", m, z, points
        for turn in (0.0, pi / 2, pi, 0.7):
            meant = mpmath.pi / 2 * round(turn / (pi / 2)) if turn != 0.7 else mpmath.mpf(0.7)
            for side in (1, -1):
                m = slider(0.06, 0.06, side, sense, turn, follow=True, at=turn)

                def moved(phi, meant=meant, side=side):
                    return 2 * mp(0.06) * mpmath.cos(phi - meant) * mpmath.expj(meant) if side > 0 else mpmath.mpc(0)

                yield f"slider {turn:.2f} {side} {sense}", m, moved, (meant + mpmath.pi / 2, meant - mpmath.pi / 2)


WAYS = {name: of for name, *of in ways()}


@pytest.mark.parametrize("name", WAYS)
def test_what_follows_is_exact_in_change_points_and_beside_them(name):
    m, z, points = WAYS[name]
    phi = np.array([float(point + mpmath.mpf(x)) for point in points for x in NEAR])
    place, v, a, *_ = motion(m, phi)
    for k, angle in enumerate(phi):
        exact = derivatives(z, mpmath.mpf(angle), m)
        for found, true, size in zip((place, v, a), exact, (0.1, W * 0.1, W**2 * 0.1), strict=True):
            assert abs(mp(complex(found["C"][k])) - true) < 5e-15 * size * max(1, abs(true) / size), (angle, k)


@pytest.mark.parametrize("name", WAYS)
def test_what_keeps_its_side_is_exact_on_both_sides_and_the_followed_way_in_the_change_point(name):
    m, z, points = WAYS[name]
    kept = replace(m, groups=(replace(m.groups[0], follow=False),))
    for point in points:
        (at,) = (v["C"][0] for v in motion(kept, [float(point)])[1:2])
        assert abs(mp(complex(at)) - derivatives(z, point, m)[1]) < 1e-14 * W
        # On one side the followed way goes on, on the other one that which the other side would follow.
        both = [motion(kept, [float(point + mpmath.mpf(x))])[1]["C"][0] for x in (1e-9, -1e-9)]
        off = [float(abs(mp(complex(v)) - derivatives(z, point, m)[1])) for v in both]
        assert min(off) < 1e-7
        assert max(off) > 0.1


def test_the_parallelogram_by_its_formulas():
    """The coupler moves without turning: omega2 = 0, omega3 = omega1, epsilon3 = epsilon1, all round and with any --phi alone."""
    m = four_bar(0.06, 0.12, 0.06, 0.12, follow=True)
    sweep = np.linspace(-2 * pi, 6 * pi, 161)
    for phi in (sweep, *([x] for x in sweep[::7])):
        place, v, a, omega, epsilon = motion(m, phi)
        assert np.allclose(place["C"] - place["B"], 0.12, rtol=0, atol=1e-16)
        assert (v["C"] == v["B"]).all()
        assert (a["C"] == a["B"]).all()
        assert (omega["2"] == 0).all()
        assert np.allclose(omega["3"], W, rtol=4e-15)
        assert np.allclose(epsilon["3"], E1, rtol=0, atol=1e-13 * W**2)


@pytest.mark.parametrize("degrees", [180.0, -180.0, 540.0, 0.0, 360.0, 3600180.0])
def test_angles_in_degrees_whose_cosine_is_not_exact(degrees):
    m = four_bar(0.06, 0.12, 0.06, 0.12, -1, follow=True, at=0.5)
    stretched = round(degrees / 180) % 2
    *_, omega, epsilon = motion(m, [np.radians(degrees)])
    # The antiparallelogram is a pair of ellipses that roll: 1/3 or 3 times as fast, the other way.
    assert omega["3"][0] == pytest.approx(-W / 3 if stretched else -3 * W, rel=1e-9)
    assert epsilon["3"][0] == pytest.approx(-E1 / 3 if stretched else -3 * E1, rel=1e-6)


@pytest.mark.parametrize(("rod", "rocker", "at"), [(0.1, 0.07, pi), (0.12, 0.19, 0.0), (0.07, 0.14, 0.0)])
@pytest.mark.parametrize("side", [1, -1])
def test_lengths_that_add_up_in_decimals_only(rod, rocker, at, side):
    """0.05 + 0.12 is not 0.1 + 0.07 in doubles, it is a change point all the same; against the decimals, extrapolated."""
    m = four_bar(0.05, rod, rocker, 0.12, side, follow=True, at=at)
    assert np.exp(1j * np.array(Passages(m).angles(m.groups[0]))) == pytest.approx([np.exp(1j * at)], abs=1e-15)
    point = mpmath.pi * round(at / pi)

    def z(phi):
        """The hinge by the law of cosines, on the side behind the change point, and on the other one before it."""
        b = mp(0.05) * mpmath.expj(phi)
        e = mp(0.12) - b
        d = abs(e)
        cos = (d * d + mp(rod) ** 2 - mp(rocker) ** 2) / (2 * d * mp(rod))
        sine = mpmath.sqrt(1 - cos * cos) * (side if phi > point else -side)
        return b + mp(rod) * (cos + 1j * sine) * e / d

    h = mpmath.mpf("1e-6")  # the mean of both sides is that of the middle but for h^2
    _, v, a, *_ = motion(m, [at])
    for found, n, size in ((v, 1, W), (a, 2, W**2)):
        true = (derivatives(z, point + h, m)[n] + derivatives(z, point - h, m)[n]) / 2
        assert abs(mp(complex(found["C"][0])) - true) < 1e-10 * size


def test_a_real_dead_position_stays_none():
    """Where a crank turns back lines fall together as well, but velocities grow beyond all bounds."""
    m = four_bar(0.06, 0.05, 0.06, 0.12)
    limit = float(mpmath.acos((mp(0.06) ** 2 + mp(0.12) ** 2 - mp(0.11) ** 2) / (2 * mp(0.06) * mp(0.12))))
    assert Passages(m).angles(m.groups[0]) == ()
    _, v, *_ = motion(m, [limit + 1e-12, limit - 1e-12, limit - 1e-9])
    assert np.isnan(v["C"][0])
    assert np.abs(v["C"][1]) > 1e5 * W * 0.06


# --- groups that hang on others -----------------------------------------------------------------------------------------


def in_a_row(follow, sides=(1, 1), frame=0.1, sense=1):
    """Two parallelograms in a row, as wheels with coupling rods: both pass their change points at once."""
    groups = (StructuralGroup(RRR, ("2", "3"), ("B", "D"), "C", (0.12, 0.06), (), sides[0], follow=follow),
              StructuralGroup(RRR, ("4", "5"), ("C", "F"), "E", (frame, 0.06), (), sides[1], follow=follow))
    return Mechanism(Crank("1", "A", "B", 0.06, W, sense, E1), {"A": 0j, "D": 0.12 + 0j, "F": 0.12 + frame + 0j}, {}, groups, (),
                     {n: Link(n) for n in "12345"})


@pytest.mark.parametrize("sense", [1, -1])
def test_two_parallelograms_in_a_row(sense):
    m = in_a_row(True, (sense, sense), sense=sense)
    assert len(Passages(m).angles(m.groups[1])) == 2
    phi = np.array([k * pi + x for k in (-1, 0, 1) for x in NEAR])
    _, v, a, omega, epsilon = motion(m, phi)
    for link in "24":
        assert np.abs(omega[link]).max() < 1e-10 * W
        assert np.abs(epsilon[link]).max() < 1e-9 * W**2
    for link in "35":
        assert np.allclose(omega[link], sense * W, rtol=1e-10)
        assert np.allclose(epsilon[link], sense * E1, rtol=0, atol=1e-9 * W**2)
    assert np.allclose(v["E"], v["B"], rtol=0, atol=1e-11)
    assert np.allclose(a["E"], a["B"], rtol=0, atol=1e-9 * W**2 * 0.06)


def test_kept_sides_in_a_row_have_limits_as_well():
    """Behind the change point the first turns back, and the second with it: against differences of 60 digits a little apart."""
    m = in_a_row(False)
    for x in (1e-9, 1e-7):
        *_, omega, epsilon = motion(m, [pi + x])
        at = truth.motion(m, mpmath.pi + mpmath.mpf("0.01"), epsilon=E1)
        beside = motion(m, [pi + 0.01])[3]["5"][0]
        assert beside == pytest.approx(float(at.omega["5"]), rel=1e-10)
        assert omega["5"][0] == pytest.approx(-W / 3, rel=1e-8)
        assert abs(epsilon["5"][0] + E1 / 3) < 1e-6 * W**2


def test_a_group_on_a_group_in_its_change_point():
    """A slider driven by the rocker of a parallelogram: as if by a crank about D."""
    groups = (StructuralGroup(RRR, ("2", "3"), ("B", "D"), "C", (0.12, 0.06), (), 1, follow=True),
              StructuralGroup(RRP, ("4", "5"), ("C",), "E", (0.2,), ("x",), 1))
    m = Mechanism(Crank("1", "A", "B", 0.06, W, 1, E1), {"A": 0j, "D": 0.12 + 0j}, {"x": Guide("x", "0", 0.02j, 0.0)}, groups, (),
                  {n: Link(n) for n in "12345"})
    alone = replace(slider(0.06, 0.2, through=0.02j), groups=(StructuralGroup(RRP, ("4", "5"), ("B",), "E", (0.2,), ("x",), 1),),
                    links={n: Link(n) for n in "145"})
    phi = np.array([k * pi + x for k in (0, 1) for x in NEAR])
    here, there = motion(m, phi), motion(alone, phi)
    for of, other in list(zip(here, there, strict=True))[1:3]:
        assert np.allclose(of["E"], other["E"], rtol=0, atol=1e-13 * W**2)


# --- forces -------------------------------------------------------------------------------------------------------------


def loaded(m):
    """The links with masses at hinges and in between, and moments of inertia."""
    links = {"1": Link("1"), "2": Link("2", "", 2.0, "B", 0.01), "3": Link("3", "", 3.0, "C", 0.02)}
    return replace(m, links=links)


def balance(m, phi, gravity=9.81):
    """Balancing moment by the force plans and by the lever, N m, reactions, N."""
    phi = np.asarray(phi, dtype=float)
    pos = position_plan(m, phi)
    vel = velocity_plan(pos)
    acc = acceleration_plan(vel)
    loads, couples, _ = external_loads(pos, acc, gravity)
    found = kinetostatics(pos, acc, loads, couples, None, limits=limits_of_forces(pos, acc, loads, couples, None))
    by_lever = lever(vel, [load for of in loads.values() for load in of], couples, None).balancing
    return (*(np.broadcast_to(s.value, phi.shape) for s in (found.balancing, by_lever)),
            {n: np.broadcast_to(s.value, phi.shape) for n, s in found.reactions.items()})


def power(m, z, phi, gravity=9.81):
    """The moment by the power of weights and the change of kinetic energy on a smooth way, N m; ``z`` of the hinge C."""
    b = lambda x: mp(m.crank.length) * mpmath.expj(x)  # noqa: E731
    d = mp(m.fixed["D"])

    def turning(u):
        first = lambda x: (mpmath.diff(lambda y: mpmath.arg(u(y) / u(x)), x))  # noqa: E731
        return first(phi), mpmath.diff(first, phi)

    total = mpmath.mpf(0)
    w, e = mpmath.mpf(m.crank.omega), mpmath.mpf(m.crank.sense * m.crank.acceleration)
    for link, at, u in (("2", b, lambda x: z(x) - b(x)), ("3", z, lambda x: z(x) - d)):
        of = m.links[link]
        _, v, a = derivatives(at, phi, m)
        total += of.mass * ((v * mpmath.conj(a)).real + gravity * v.imag)
        one, two = turning(u)
        total += of.inertia * one * w * (one * e + two * w**2)
    return total / w


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("sense", [1, -1])
def test_the_moment_has_a_limit_where_reactions_have_none(side, sense):
    m = loaded(four_bar(0.06, 0.12, 0.06, SLANTED, side, sense, follow=True, at=float(AT) + 0.5))
    z = translated(m) if side > 0 else reflected(m, "parallelogram")
    for point in (AT, AT + mpmath.pi):
        phi = np.array([float(point + mpmath.mpf(x)) for x in NEAR])
        by_plans, by_lever, reactions = balance(m, phi)
        true = np.array([float(power(m, z, mpmath.mpf(x))) for x in phi])
        size = np.abs(true).max() + 1
        assert np.abs(by_lever - true).max() < 1e-12 * size
        assert np.abs(by_plans - true).max() < 1e-9 * size
        assert np.isnan(reactions["F21"][0])
        assert np.isfinite(reactions["F21"][3:]).all()


def test_the_loaded_parallelogram_of_the_issue():
    """Weights of 2 kg and 3 kg that go down with 0.06 m omega: M = -(2 + 3) 9.81 0.06."""
    m = replace(loaded(four_bar(0.06, 0.12, 0.06, 0.12)), crank=Crank("1", "A", "B", 0.06, 2 * pi, 1))
    by_plans, by_lever, _ = balance(m, [pi])
    assert by_plans[0] == pytest.approx(-2.943, rel=1e-11)
    assert by_lever[0] == pytest.approx(-2.943, rel=1e-14)


def test_reactions_of_what_nothing_loads():
    """Links without masses: nothing divided by nothing is nothing, in the change point too."""
    m = four_bar(0.06, 0.12, 0.06, 0.12, follow=True)
    m = replace(m, links={"1": Link("1", "", 2.0, "B"), "2": Link("2"), "3": Link("3")})
    by_plans, _, reactions = balance(m, [pi, 1.0])
    assert reactions["F21"][0] == reactions["F30"][0] == 0
    assert by_plans[0] == pytest.approx(2.0 * (9.81 * -0.06 + E1 * 0.06**2), rel=1e-12)


# --- one change point, or none of use -----------------------------------------------------------------------------------


def cycle_of(m, **more):
    return even_cycle(m, 0.3, 12, **more)


def test_a_way_that_does_not_come_back_is_refused():
    m = four_bar(0.05, 0.1, 0.07, 0.12, follow=True, at=0.3)
    said = r'group 2-3 with branch = "follow" passes a change point at crank angle 180\.0 deg'
    with pytest.raises(CannotBuild, match=said) as told:
        check_followed(m, cycle_of(m))
    assert "end in [cycle]" in told.value.hint


def test_a_swing_may_pass_one_change_point():
    """Of a crank that swings the way back is the way forth; where the side is told does not matter."""
    begin, end = 2.5, 4.0
    cut = begin - (2 * pi - (end - begin)) / 2
    phi = np.array([2.5, 3.0, pi - 1e-9, pi, pi + 1e-9, 3.5, 4.0])
    found = []
    for at, side in ((2.5, 1), (4.0, -1), (3.0, 1)):
        m = four_bar(0.05, 0.1, 0.07, 0.12, side, follow=True, at=at, cut=cut)
        assert check_assembly(m, swing_cycle(m, begin, end, 6)) == ()
        found.append(motion(m, phi))
    for of in found[1:]:
        for here, there in zip(of, found[0], strict=True):
            assert all(np.array_equal(here[name], there[name]) for name in here)
    _, v, a, *_ = found[0]
    assert np.abs(np.diff(v["C"][2:5])).max() < 1e-7
    assert np.abs(np.diff(a["C"][2:5])).max() < 1e-5


def test_kept_sides_are_told_and_followed_ones_are_not():
    kept, follows = (four_bar(0.06, 0.12, 0.06, 0.12, follow=follow, at=0.3) for follow in (False, True))
    (told,) = check_assembly(kept, cycle_of(kept))
    assert str(told).endswith('to go on smoothly, write branch = "follow" in the group')
    assert check_assembly(follows, cycle_of(follows)) == ()
    # With one change point a turn there is no smooth way round.
    one = four_bar(0.05, 0.1, 0.07, 0.12, at=0.3)
    (told,) = check_assembly(one, cycle_of(one))
    assert str(told).endswith("change a length, or let the crank swing")


def test_strokes_of_what_follows():
    """A parallelogram's output turns back twice a turn, where its path does and not in the change points."""
    m = four_bar(0.06, 0.12, 0.06, 0.12, follow=True, at=0.3)
    cycle = cycle_of(m, output="C", working_sense="+x")
    assert cycle.strokes.length == pytest.approx(0.12, rel=1e-12)
    assert cycle.strokes.end - cycle.strokes.begin == pytest.approx(pi, abs=1e-12)
    kept = replace(m, groups=(replace(m.groups[0], follow=False),))
    with pytest.raises(CannotBuild, match="stretched or folded") as told:
        cycle_of(kept, output="C", working_sense="+x")
    assert "turns back at once there" in told.value.hint
    assert cycle_of(kept, output="B", working_sense="+x").strokes.length == pytest.approx(0.12)


@pytest.mark.parametrize("sense", [1, -1])
def test_four_equal_lengths(sense):
    """A rhombus: the crank's pin passes through the other pivot, where the line of centres has no direction of its own."""
    m = four_bar(0.06, 0.06, 0.06, 0.06, 1, sense, follow=True, at=0.5)
    place, v, _, omega, epsilon = motion(m, [k * pi + x for k in (0, 1, 2) for x in NEAR])
    assert np.allclose(place["C"] - place["B"], 0.06, rtol=0, atol=1e-16)
    assert np.allclose(v["C"], v["B"], rtol=0, atol=1e-15)
    assert np.abs(omega["2"]).max() < 1e-14 * W
    assert np.abs(epsilon["2"]).max() < 1e-12 * W**2


def test_a_pivot_in_the_path_of_the_pin_gives_no_turn_of_its_own():
    """Crank and frame alike, rods alike and longer: the rocker turns half as fast, and after a turn it stands opposite."""
    m = four_bar(0.06, 0.1, 0.1, 0.06, follow=True, at=0.5)
    *_, omega, _ = motion(m, NEAR)
    with pytest.raises(CannotBuild, match="after a turn of the crank it stands on the other side"):
        check_followed(m, cycle_of(m))
    assert np.isfinite(omega["3"]).all()
    assert omega["3"][0] + omega["2"][0] == pytest.approx(W)


def test_other_kinds_are_refused_where_they_have_no_direction():
    """A rocker whose pivot the pin passes, with an offset and without: no angle of theirs is told there."""
    for offset in (0.0, 0.02):
        pivot = 0.06 + offset
        g = StructuralGroup(RPR, ("2", "3"), ("B", "C"), None, (), (), 1, offset)
        m = Mechanism(Crank("1", "A", "B", 0.06, W, 1), {"A": 0j, "C": complex(pivot)}, {}, (g,),
                      (LinkPoint("S", "3", "C", "B", 0.1),), {n: Link(n) for n in "123"})
        with pytest.raises(CannotBuild, match=r"group 2-3 does not assemble"):
            check_assembly(m, cycle_of(m))
