"""Kinetostatics against one linear system of all reactions; closed polygons; power balance; arms by moments."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, strategies as st

from tests import project_files as files
from tests.methods.linkage import statics, truth
from tests.methods.linkage.mechanisms import mechanisms, value
from tests.methods.settings import every_kind, tried
from tmm_sheets import catalogue
from tmm_sheets.mechanism.model import Link
from tmm_sheets.methods.linkage.numbering import even_cycle
from tmm_sheets.methods.linkage.study import Study
from tmm_sheets.project import Project
from tmm_sheets.task import variant

F1 = np.exp(-1j * np.radians(20))
"""Unit vector of the tooth force: the pinion above A drives the wheel clockwise and presses it down."""

FORCES = ("F54", "F50", "F45", "F43", "F34", "F21", "F23", "F32", "F30", "F12", "F10")


def whole_system(project, phi):
    """The shaper's fifteen equations; resistance while the ram moves to the right."""
    m = project.mechanism
    working = truth.motion(m, phi).v["S5"].real > 0
    cutting = [("5", "S5", -2800.0 + 0j)] if working else []
    return statics.solve(m, phi, 9.81, cutting, driver=(0.05j, F1))


def cross(u, v):
    return (np.conj(u) * v).imag


# --- the shaper ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("k", range(10))
def test_all_reactions_of_the_shaper(shaper, k):
    forces = shaper.study.forces
    true = whole_system(shaper, shaper.study.positions.phi[k])
    assert true.unknowns == 15
    assert set(forces.reactions) >= set(FORCES)
    largest = max(abs(f) for f in true.reactions.values())
    for name, step in forces.reactions.items():
        # In position 8 the ram neither cuts nor accelerates: F54 and F1 are zero, up to rounding of the others.
        assert abs(value(step, k) - true.reactions[name]) < max(1e-10 * abs(true.reactions[name]), 1e-15 * largest), name
    assert abs(value(forces.balancing, k) - true.balancing * F1) < max(1e-10 * abs(true.balancing), 1e-14 * largest)
    for name, step in forces.couples.items():
        assert abs(value(step, k) - true.couples[name]) < 1e-10 * largest * 0.1, name


@pytest.mark.parametrize(
    ("name", "printed"),
    [("F54", "2981.64"), ("F50", "784.80"), ("F43", "2988.57"), ("F21", "5131.90"), ("F23", "5122.01"), ("F30", "2175.52"),
     ("F10", "4085.10"), ("F1", "7744.884")],
)
def test_shaper_position_2(shaper, name, printed):
    forces = shaper.study.forces
    step = forces.balancing if name == "F1" else forces.reactions[name]
    assert f"{abs(value(step, 2)):.{len(printed.partition('.')[2])}f}" == printed


def test_arms_of_position_2(shaper):
    """h50 from moments of link 5 about D, h45 and h23 are zero: the slider blocks carry no couple."""
    arms = shaper.study.forces.arms
    assert f"{abs(value(arms['h50'], 2)):.5f}" == "0.11338"
    assert abs(value(arms["h45"], 2)) < 1e-15
    assert abs(value(arms["h23"], 2)) < 1e-15
    z, _, a, _, _ = truth.shaper_motion(shaper.study.positions.phi[2], -2 * np.pi * 1.2)
    horizontal = 2800 + 80 * a["S5"].real
    assert abs(value(arms["h50"], 2)) == pytest.approx(horizontal * (z["S5"] - z["D"]).imag / (80 * 9.81), rel=1e-13)


def test_directions_of_reactions_in_sliding_pairs(shaper):
    forces, pos = shaper.study.forces, shaper.study.positions
    for k in range(10):
        rocker = value(pos.directions["3"], k)
        largest = abs(value(forces.reactions["F12"], k))
        assert abs(value(forces.reactions["F50"], k).real) < 1e-13 * largest
        assert abs(value(forces.reactions["F54"], k).imag) < 1e-13 * largest
        assert abs((value(forces.reactions["F23"], k) * np.conj(rocker)).real) < 1e-13 * largest


def test_action_and_reaction(shaper):
    reactions = shaper.study.forces.reactions
    for name, step in reactions.items():
        opposite = reactions.get(f"F{name[2]}{name[1]}")
        if opposite is not None:
            np.testing.assert_array_equal(step.value, -opposite.value)


def physical(project, k):
    """Every force of the shaper by its lettering, from the whole system and the masses."""
    phi = project.study.positions.phi[k]
    true = whole_system(project, phi)
    a = truth.motion(project.mechanism, phi).a
    found = {f"F̅_{{{name[1:]}}}": f for name, f in true.reactions.items()}
    for link in project.mechanism.links.values():
        found[f"G̅_{link.name}"] = -9.81j * link.mass
        found[f"F̅_{{и{link.name}}}"] = -link.mass * a[link.centre]
    working = truth.motion(project.mechanism, phi).v["S5"].real > 0
    found["F̅_{5}"] = -2800.0 * working
    found["F̅_{1}"] = true.balancing * F1
    return found


@pytest.mark.parametrize("k", range(10))
def test_every_polygon_closes_and_its_sides_are_the_forces(shaper, k):
    forces, named = shaper.study.forces, physical(shaper, k)
    assert list(forces.plans) == ["5", "4", "2", "3", "1"]
    for name, plan in forces.plans.items():
        sides = {symbol: value(head, k) - value(tail, k) for symbol, tail, head, _ in plan.sides}
        largest = max(map(abs, sides.values()))
        # The sides one after another come back to where they began ...
        assert abs(sum(sides.values())) < 1e-12 * largest
        for (_, _, head, _), (_, tail, _, _) in zip(plan.sides, plan.sides[1:] + plan.sides[:1], strict=True):
            assert abs(value(head, k) - value(tail, k)) < 1e-12 * largest
        # ... and so do the forces they stand for, found without any polygon.
        if "F̅_{21}^n" in sides:
            sides["F̅_{21}"] = sides.pop("F̅_{21}^n") + sides.pop("F̅_{21}^τ")
        assert abs(sum(named[symbol] for symbol in sides)) < 1e-12 * largest, name
        for symbol, side in sides.items():
            assert abs(side - named[symbol]) < 1e-12 * largest, (name, symbol)


def test_sides_in_the_order_of_the_manual(shaper):
    """Constructions, 6.2 to 6.4: the first and the last side of each plan are as there, inertia before weight on link 5."""
    order = {name: [side[0] for side in plan.sides] for name, plan in shaper.study.forces.plans.items()}
    assert order == {
        "5": ["F̅_{54}", "F̅_{и5}", "G̅_5", "F̅_{5}", "F̅_{50}"],
        "4": ["F̅_{45}", "G̅_4", "F̅_{и4}", "F̅_{43}"],
        "2": ["F̅_{21}^n", "F̅_{21}^τ", "G̅_2", "F̅_{и2}", "F̅_{23}"],
        "3": ["F̅_{32}", "G̅_3", "F̅_{и3}", "F̅_{34}", "F̅_{30}"],
        "1": ["F̅_{12}", "F̅_{1}", "G̅_1", "F̅_{10}"],
    }


def test_unknown_sides_are_those_found_by_closing(shaper):
    unknown = {name: {s[0] for s in plan.sides if s[3]} for name, plan in shaper.study.forces.plans.items()}
    assert unknown == {"5": {"F̅_{54}", "F̅_{50}"}, "4": {"F̅_{43}"}, "2": {"F̅_{21}^n", "F̅_{23}"}, "3": {"F̅_{30}"}, "1": {"F̅_{10}"}}


def test_power_balance(shaper):
    """Driving power covers weights, inertia and cutting at every angle, with no reaction in the sum."""
    turned = np.linspace(0, 2 * np.pi, 37)[:-1] + 0.01
    study = shaper.study_at(turned, tuple(map(str, range(36))))
    for k, phi in enumerate(study.positions.phi):
        motion = truth.motion(shaper.mechanism, phi)
        power = value(study.forces.balancing, k) * np.conj(1j * motion.omega["1"] * 0.05j)
        terms = [power.real]
        for link in shaper.mechanism.links.values():
            force = -link.mass * (9.81j + motion.a[link.centre])
            terms.append((force * np.conj(motion.v[link.centre])).real)
            terms.append(-link.inertia * motion.epsilon[link.name] * motion.omega[link.name])
        terms.append(-2800 * max(motion.v["S5"].real, 0))
        assert abs(sum(terms)) < 1e-11 * max(1.0, *map(abs, terms))


def test_drives_by_a_moment_when_there_is_no_gear():
    text = catalogue.read("lugansk/shaper")
    with_moment = Project(text.model_copy(update={"balancing": text.balancing.model_copy(update={"kind": "moment"})}))
    by_force = Project(text)
    moment = with_moment.study.forces.balancing.value
    force = by_force.study.forces.balancing.value
    # The force turns the wheel about A with the arm of the base circle.
    np.testing.assert_allclose(moment, cross(0.05j, force), rtol=1e-12)
    np.testing.assert_allclose(abs(moment / force), 0.05 * np.cos(np.radians(20)), rtol=1e-12)
    # Without the tooth force the frame carries what comes from the slider block and the weight of the crank alone.
    np.testing.assert_allclose(with_moment.study.forces.reactions["F10"].value,
                               -with_moment.study.forces.reactions["F12"].value + 4.2j * 9.81, rtol=1e-13)


# --- every kind of group, all links with masses and inertias ---------------------------------------------------------


def own_points(m, link):
    names = [p.name for p in m.pairs if link in p.links and p.motion == "rotation"]
    names += [p.name for p in m.points if p.link == link]
    return names + [g.inner for g in m.groups if g.kind.number == 5 and g.links[1] == link]


def loaded(m, random):
    """The mechanism with a mass somewhere on each link and inertias."""
    links = {
        name: Link(name, "", random.uniform(0.5, 2), random.choice(own_points(m, name)), random.uniform(0.5, 2) * m.crank.length**2)
        for name in m.links
    }
    return replace(m, links=links)


@every_kind
def test_against_the_whole_system(kinds):
    @tried(kinds)
    @given(mechanisms(kinds), st.randoms(use_true_random=False))
    def check(drawn, random):
        m, phi = drawn
        m = loaded(m, random)
        gravity = m.crank.speed**2 * m.crank.length
        study = Study(m, even_cycle(m, phi, 4), np.zeros(1), ("0",), gravity, tuple, None)
        true = statics.solve(m, phi, gravity, epsilon=m.crank.sense * m.crank.acceleration)
        largest = max(map(abs, true.reactions.values()))
        for name, step in study.forces.reactions.items():
            assert abs(value(step) - true.reactions[name]) < 1e-10 * largest, name
        for name, step in study.forces.couples.items():
            assert abs(value(step) - true.couples[name]) < 1e-10 * largest * m.crank.length, name
        assert abs(value(study.forces.balancing) - true.balancing) < 1e-10 * largest * m.crank.length
        # Each plan is one closed line: a side begins where the one before it ends.
        for plan in study.forces.plans.values():
            for (_, _, head, _), (_, tail, _, _) in zip(plan.sides, plan.sides[1:] + plan.sides[:1], strict=True):
                assert abs(value(head) - value(tail)) < 1e-12 * largest

    check()


def test_links_with_longer_names(shaper):
    m = shaper.mechanism
    names = {"1": "10", "2": "21", "3": "33", "4": "x4", "5": "ram", "0": "0"}
    renamed = replace(
        m, crank=replace(m.crank, link="10"), links={names[n]: replace(x, name=names[n]) for n, x in m.links.items()},
        groups=tuple(replace(g, links=(names[g.links[0]], names[g.links[1]])) for g in m.groups),
        points=tuple(replace(p, link=names[p.link]) for p in m.points),
    )
    study = Study(renamed, shaper.cycle, shaper.cycle.turned, shaper.cycle.labels, 9.81, tuple, shaper.driver)
    plain = Study(m, shaper.cycle, shaper.cycle.turned, shaper.cycle.labels, 9.81, tuple, shaper.driver)
    np.testing.assert_array_equal(study.forces.reactions["F33,0"].value, plain.forces.reactions["F30"].value)
    np.testing.assert_array_equal(study.forces.balancing.value, plain.forces.balancing.value)


RADIAL = Path(__file__).with_name("radial.toml")
"""Eleven links: the crank's pair with link 10 and the frame's with link 11 must not both be called F110."""


@pytest.fixture(scope="module")
def radial():
    return Project(variant.read(RADIAL))


def radial_truth(project, k):
    loads = [(f.link, f.point, complex(f.vector(project.study.turned[k]))) for f in project.applied]
    return statics.solve(project.mechanism, float(project.study.positions.phi[k]), 9.81, loads)


def test_two_digit_links_lose_no_reaction(radial):
    m, study = radial.mechanism, radial.study
    for k in range(len(study.labels)):
        true = radial_truth(radial, k)
        assert len(true.reactions) == 2 * len(m.pairs) == 32
        assert study.forces.reactions.keys() == true.reactions.keys() - {"F01"} >= {"F1,10", "F11,0", "F0,11", "F10", "F54"}
        largest = max(map(abs, true.reactions.values()))
        for name, step in study.forces.reactions.items():
            assert abs(value(step, k) - true.reactions[name]) < 1e-10 * largest, name
        for name, step in study.forces.couples.items():
            assert abs(value(step, k) - true.couples[name]) < 1e-10 * largest * m.crank.length, name
        assert abs(value(study.forces.balancing, k) - true.balancing) < 1e-10 * largest * m.crank.length
        assert abs(value(study.lever.balancing, k) - true.balancing) < 1e-10 * largest * m.crank.length
    assert {"h30", "h50", "h70", "h90", "h11,0"} == study.forces.arms.keys()


@pytest.fixture(scope="module")
def two_cylinders():
    """The first and the last cylinder of the five."""
    data, links = files.from_file(str(RADIAL)), {"1", "2", "3", "10", "11"}
    data["group"] = [g for g in data["group"] if links.issuperset(g["links"])]
    for part, key in (("link", "name"), ("point", "link"), ("force", "link")):
        data[part] = [row for row in data[part] if row[key] in links]
    data["guide"] = [row for row in data["guide"] if row["name"] in {g["guide"] for g in data["group"]}]
    return files.project(data)


def test_two_digit_links_in_everything_a_user_reads(two_cylinders):
    """The numbers of both pairs stand in the results, the protocol, the table to fill in and on the sheet, each under its name."""
    radial = two_cylinders
    from tmm_sheets import protocols, results
    from tmm_sheets.compare.measured.collecting import measurables
    from tmm_sheets.sheets import sheet

    true = radial_truth(radial, radial.force_index)
    reactions = results.assemble(radial, ("forces",))["forces"]["reactions"]
    told = "\n".join(protocols.lines(radial, None))
    entries = measurables(radial).entries
    drawn = " ".join(group.text for group in sheet.composed(radial, 1).groups)
    for name in ("F10,1", "F11,0"):
        assert complex(*reactions[name][0]) == pytest.approx(true.reactions[name], rel=1e-9)
        assert f"{name} = |" in told
        assert entries[f"results/4/{name}"].value == pytest.approx(abs(true.reactions[name]), rel=1e-9)
        assert f"F_{{{name[1:]}}} = {str(round(abs(true.reactions[name]), 1)).replace('.', ',')} Н" in drawn
    assert complex(*reactions["F1,10"][0]) == pytest.approx(-true.reactions["F10,1"], rel=1e-9)
    assert "F1,10 = −F10,1." in told
    assert "arms/4/h_F1,10(O)" in entries
