"""A sixth kind of group, defined here alone: two rods and a third pin on the first of them, to which a further group is hinged.

Everything it must do is asked of it through the package unchanged. Truth: closed forms of the positions, differentiated by mpmath,
and the power of all forces.
"""

from dataclasses import replace

import mpmath
import numpy as np
import pytest

from tests.methods.linkage.mechanisms import mechanism
from tmm_sheets.construction import rules
from tmm_sheets.construction.step import Rule
from tmm_sheets.errors import CannotBuild
from tmm_sheets.lab.stress.invariants import State
from tmm_sheets.mechanism.groups import RRP
from tmm_sheets.mechanism.groups.contexts import Outline
from tmm_sheets.mechanism.groups.dead_centres import PIN_ANGLE
from tmm_sheets.mechanism.groups.two_links import RRRKind
from tmm_sheets.mechanism.model import Crank, Guide, Link, StructuralGroup
from tmm_sheets.methods.linkage.checks import check_turn
from tmm_sheets.methods.linkage.cycle import dead_positions
from tmm_sheets.methods.linkage.forces import external_loads, kinetostatics
from tmm_sheets.methods.linkage.motion import acceleration_plan, velocity_plan
from tmm_sheets.methods.linkage.positions import position_plan
from tmm_sheets.sheets.linkage import link_marks

REACH, AHEAD = 0.12, 0.7
ROD, ROCKER, FRAME, SECOND, AT = 0.28, 0.24, 0.3, 0.35, 0.2
OMEGA, EPSILON, GRAVITY = 10.0, 30.0, 9.81
PULL = Rule("given pull", lambda f: f, ("force",), "force", "", unit="N")
PHI = np.array([-2.9, -1.1, 0.4, 1.3, 2.6])


class Triangle(RRRKind):
    """RRR with a pin E on its first link, ``REACH`` from the outer hinge and ``AHEAD`` of the rod."""

    number, form = 6, "ВВВ+"

    def carried(self, g):
        return super().carried(g) | {"E": g.links[0]}

    def position(self, pos, g):
        super().position(pos, g)
        u = pos.plan.add(pos.plan.free("BE"), rules.TURNED_BY, pos.direction(g.outer[0], g.inner), AHEAD)
        pos.points["E"] = pos.plan.add("E", rules.ALONG, pos.points[g.outer[0]], u, REACH)

    def motion(self, plan, g):
        super().motion(plan, g)
        plan.points["E"] = plan.rotated("E", plan.points[g.outer[0]], g.links[0], g.outer[0], "E")

    def outlines(self, pos, g):
        (i, j), (p, q), c = g.links, g.outer, g.inner
        return [Outline(i, (p, c), arms=((p, "E"), ("E", c))), Outline(j, (q, c))]


def machine(rod=ROD, masses=True):
    m = mechanism(
        StructuralGroup(Triangle(), ("2", "3"), ("B", "D"), "C", (rod, ROCKER)),
        StructuralGroup(RRP, ("4", "5"), ("E",), "F", (SECOND,), ("y",)),
        fixed={"D": FRAME + 0j}, guides=[Guide("y", "0", AT + 0j, np.pi / 2)], crank=Crank("1", "A", "B", 0.1, OMEGA, 1, EPSILON),
    )
    weights = {"2": Link("2", "", 3.0, "E", 0.05), "3": Link("3", "", 2.0, "C", 0.02), "5": Link("5", "", 4.0, "F")}
    return replace(m, links=m.links | weights) if masses else m


def closed(phi):
    """Points B, C, E, F and the angles of links 2 and 3 by the law of cosines."""
    b = mpmath.mpf("0.1") * mpmath.expj(phi)
    d = FRAME - b
    at_b = mpmath.acos((abs(d) ** 2 + mpmath.mpf(ROD) ** 2 - mpmath.mpf(ROCKER) ** 2) / (2 * abs(d) * ROD))
    u = d / abs(d) * mpmath.expj(at_b)
    c, e = b + ROD * u, b + REACH * u * mpmath.expj(AHEAD)
    f = AT + 1j * (e.imag + mpmath.sqrt(mpmath.mpf(SECOND) ** 2 - (AT - e.real) ** 2))
    return {"B": b, "C": c, "E": e, "F": f, "2": mpmath.log(u), "3": mpmath.log((c - FRAME) / ROCKER)}


def motion(name, phi):
    """Value, velocity and acceleration of a point, of ``1j`` times the angle of a link."""
    first, second = (mpmath.diff(lambda x: closed(x)[name], phi, n) for n in (1, 2))
    return tuple(complex(z) for z in (closed(phi)[name], first * OMEGA, second * OMEGA**2 + first * EPSILON))


@pytest.fixture(scope="module")
def plans():
    pos = position_plan(machine(), PHI)
    vel = velocity_plan(pos)
    return pos, vel, acceleration_plan(vel)


@pytest.mark.parametrize("name", ["C", "E", "F"])
def test_points_move_as_the_closed_form(plans, name):
    found = np.array([plan.points[name].value for plan in plans]).T
    with mpmath.workdps(30):
        exact = np.array([motion(name, phi) for phi in PHI])
    assert np.abs(found - exact).max(axis=0) == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("link", ["2", "3"])
def test_links_turn_as_the_closed_form(plans, link):
    with mpmath.workdps(30):
        exact = np.array([motion(link, phi) for phi in PHI])
    assert plans[1].omega[link].value == pytest.approx(exact[:, 1].imag, rel=1e-9)
    assert plans[2].epsilon[link].value == pytest.approx(exact[:, 2].imag, rel=1e-9)


def test_balancing_moment_makes_up_for_the_power_of_all_forces(plans):
    pos, _, acc = plans
    m = machine()
    pull = 200.0 + 50.0j
    loads, couples, _ = external_loads(pos, acc, GRAVITY, [("5", "F", lambda plan: plan.add("Q", PULL, np.full(PHI.shape, pull)))])
    forces = kinetostatics(pos, acc, loads, couples, None)
    power = np.zeros(PHI.shape)
    with mpmath.workdps(30):
        for k, phi in enumerate(PHI):
            for link in ("2", "3", "5"):
                _, v, a = motion(m.links[link].centre, phi)
                force = -m.links[link].mass * (a + 1j * GRAVITY) + pull * (link == "5")
                power[k] += (force * np.conj(v)).real
            for link in ("2", "3"):
                _, w, e = motion(link, phi)
                power[k] -= m.links[link].inertia * e.imag * w.imag
    assert forces.balancing.value * OMEGA == pytest.approx(-power, rel=1e-8)


def test_every_link_of_the_group_is_in_equilibrium(plans):
    pos, _, acc = plans
    loads, couples, _ = external_loads(pos, acc, GRAVITY)
    f = {name: step.value for name, step in kinetostatics(pos, acc, loads, couples, None).reactions.items()}
    own = {link: sum(load.vector.value for load in loads[link]) for link in ("2", "3")}
    assert np.abs(f["F21"] + f["F23"] + f["F24"] + own["2"]).max() < 1e-9 * np.abs(f["F21"]).max()
    assert np.abs(f["F32"] + f["F30"] + own["3"]).max() < 1e-9 * np.abs(f["F32"]).max()


def test_limits_of_assembly():
    check_turn(machine())
    with pytest.raises(CannotBuild, match=r"group 2-3 does .*BC = 100 mm and CD = 240 mm together are 60 mm too short"):
        check_turn(machine(rod=0.1))  # the crank pin comes 400 mm away from D


class Balanced(Triangle):
    """The same with a dead position where E, not C, is in line with the crank: what a kind says of itself is what is built."""

    number = 7

    def dead_positions(self, m, g, plan, centre):
        side = plan.add("E′", rules.ALONG, centre, plan.add("u", rules.GIVEN_DIRECTION, 1j), REACH)
        left = plan.add("W′", rules.ALONG, centre, plan.add("w", rules.GIVEN_DIRECTION, -1 + 0j), REACH)
        return plan.auxiliary("φ′", PIN_ANGLE, centre, side), plan.auxiliary("φ″", PIN_ANGLE, centre, left)


def test_dead_positions():
    """Crank and rod in line, by the law of cosines."""
    m = machine()
    plan, dead = dead_positions(m)
    angles = [np.arccos((FRAME**2 + ac**2 - ROCKER**2) / (2 * FRAME * ac)) for ac in (ROD + 0.1, ROD - 0.1)]
    pins = np.exp(1j * np.array([step.value for step in dead]))
    assert np.abs(pins - np.exp(1j * np.array(angles)) * [1, -1]).max() < 1e-15
    assert [step.rule.name for step in plan][-2:] == ["arc cuts arc"] * 2


def test_dead_positions_are_the_kinds_own():
    m = machine()
    plan, dead = dead_positions(replace(m, groups=(replace(m.groups[0], kind=Balanced()), *m.groups[1:])))
    assert [step.value for step in dead] == pytest.approx([np.pi / 2, np.pi])
    assert "E′" in plan


def test_growth_of_errors_is_the_kinds_own():
    """1/sine under which the links cross, times size over length, of both groups: from the closed form."""
    state = State(machine(), PHI)
    for k, phi in enumerate(PHI):
        z = {name: complex(value) for name, value in closed(phi).items() if name.isalpha()}
        corner = np.sin(np.angle((z["B"] - z["C"]) / (FRAME - z["C"])))
        first = state.size[k] ** 2 / ROCKER / abs(FRAME - z["B"]) / abs(corner)
        second = state.size[k] / SECOND / abs((z["F"] - z["E"]).imag / SECOND)
        assert state.condition[k] == pytest.approx(max(first, 1) * max(second, 1), rel=1e-9)


def test_structure():
    m = machine()
    assert m.mobility == 1
    assert m.structure == "I(0,1) → II(2,3) → II(4,5)"
    assert [f"{p.name} {p.motion} {'-'.join(p.links)}" for p in m.pairs][1:5] == [
        "B rotation 1-2", "C rotation 2-3", "D rotation 3-0", "E rotation 2-4"]
    assert (m.owner("E"), m.owner("C"), m.groups[0].form) == ("2", "2", "ВВВ+")


def test_shapes(plans):
    shapes = {s.link: s for s in link_marks.shapes(plans[0])}
    assert shapes["2"].bar == ("B", "C")
    assert shapes["2"].arms == (("B", "E"), ("E", "C"))
    assert shapes["3"].bar == ("D", "C")
    assert shapes["5"].block == "F"
