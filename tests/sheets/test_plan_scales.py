"""Scale factors of the plans: each plan is lettered, what is too short is said, a file's factor is refused by the true need."""

import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from tests import project_files as files
from tests.few import seldom
from tests.sheets.unlettered import unlettered, words
from tmm_sheets import catalogue, output
from tmm_sheets.errors import CannotBuild
from tmm_sheets.project import Project
from tmm_sheets.sheets import composition
from tmm_sheets.sheets.linkage.kinematic_frames import own_factors
from tmm_sheets.sheets.player import joined, needed
from tmm_sheets.sheets.sheet import composed

HERE = Path(__file__).parent
CLOSE, CONVEYOR, PLANER = map(str, (HERE / "close.toml", *(HERE.parent / "projects" / f"{name}.toml" for name in
                                                          ("conveyor", "planer"))))


# --- next to a dead point ---------------------------------------------------------------------------------------------


def plan_sizes(phi):
    """Sizes of the velocity plans of close.toml by the formulas of the slotted link, m/s."""
    r, away, reach, omega = 0.1, 0.1005, 0.3, 2 * np.pi
    b = r * np.exp(1j * phi)
    from_c, v = b - away, 1j * omega * b
    omega3 = np.imag(np.conj(from_c) * v) / np.abs(from_c) ** 2
    points = np.array([0 * b, v, 1j * omega3 * from_c, 1j * omega3 * reach * from_c / np.abs(from_c)])
    return np.maximum(np.ptp(points.real, axis=0), np.ptp(points.imag, axis=0))


@pytest.fixture(scope="module")
def drawn():
    return unlettered(files.project(files.from_file(CLOSE)))


def test_every_plan_can_be_lettered_with_a_factor_of_its_own_if_need_be(drawn):
    """The one next to the dead point is 400 times as large as usual: with one factor the others would be dots."""
    sizes = plan_sizes(np.radians(np.arange(0, 360, 30)))
    assert sizes[0] / np.median(sizes) > 400
    frames = [frame for frame in reversed(drawn.frames) if frame.plan == "velocities" and not frame.turn]
    factors = {int(frame.position): frame.mu[0] for frame in frames}
    assert sorted(factors) == [*range(12)]
    assert all(25 <= sizes[i] / mu <= 100 for i, mu in factors.items())
    assert {factors[i] for i in range(1, 12)} == {drawn.scales["velocities"].mu}
    assert str(drawn.scales["velocities-2"]) in words(drawn)


def test_sizes_of_one_kind_have_one_factor():
    assert len(set(own_factors(np.array([30.0, 60.0, 45.0]), 1.0))) == 1
    assert len(set(own_factors(np.array([0.0, 60.0, 1e-15]), 1.0))) == 1, "what is nothing is not enlarged"
    first, *others = own_factors(np.array([100.0, 1.0, 24.0]), 1.0)
    assert first == 1.0
    assert 25 <= 24.0 / others[1] <= 100
    assert 25 <= 1.0 / others[0] <= 100


def test_two_sheets_are_taken_where_one_is_too_small():
    planer = files.read(files.from_file(PLANER), {"project.sheets": None})
    alone = files.project(files.from_file(PLANER), {"project.sheets": ["kinematics_forces_wide"]})
    (said,) = composition.crowded(alone, [1])
    assert 'sheets = ["kinematics", "forces"]' in str(said)
    assert output.with_room(planer).sheets == ("kinematics", "forces", "flywheel")
    assert not list(composition.crowded(Project(output.with_room(planer)), [1]))
    assert output.with_room(alone.variant) is alone.variant, "who names one has it"


def every_sheet(project):
    return range(1, len(project.sheets) + 1)


def test_the_plans_of_the_dead_point_itself_say_what_is_too_short():
    """At the dead point the centrifugal acceleration of D, omega3^2 l, is 1e4 times that of the pin: omega3 = omega r / 0.5 mm."""
    found = composed(files.project(files.from_file(CLOSE), {"cycle.force_position": "0"}), 1)
    mu = found.scales["accelerations"].mu
    pin, centre = (2 * np.pi) ** 2 * 0.1, (2 * np.pi * 0.1 / 0.0005) ** 2 * 0.3
    assert centre / mu > 50
    assert pin / mu < 1e-2
    notes = " ".join(g.text for g in found.groups if "a̅" in g.text or "Меньше" in g.text)
    assert "Меньше 1 мм, ≈ 0: a̅_B" in notes
    drawn = [g for p, q in pairwise(found.parts) if p.title.startswith("План ускорений (положение 0)")
             for g in found.groups if p.first <= g.first < q.first and g.kind == "arrow"]
    assert len(drawn) == 1, "only the acceleration of D is an arrow"


def test_nothing_is_left_out_of_plans_of_one_size():
    for name in ("lugansk/shaper", "press", "sixbar/5:2"):
        opened = Project(catalogue.read(name))
        assert not list(composition.left_out(opened, every_sheet(opened)))


def test_points_that_share_a_dot():
    points = {"p": 0j, "a": 0.7 + 0j, "b": 0.1j, "c": 20 + 0j, "d": 20.1 + 0j, "e": 21 + 0j}
    assert joined(points, []) == [["p", "b"], ["a"], ["c", "d"], ["e"]]
    assert joined(points, [("p", "a"), ("e", "d")]) == [["p", "a", "b"], ["c", "d", "e"]]
    assert joined({"x": 0j, "y": 3 + 0j, "z": 1.5 + 0j}, [("x", "z"), ("z", "y")]) == [["x", "z", "y"]] or \
        joined({"x": 0j, "y": 3 + 0j, "z": 1.5 + 0j}, [("x", "z"), ("z", "y")]) == [["x", "y", "z"]]


# --- many positions ---------------------------------------------------------------------------------------------------


@pytest.mark.trial
def test_forty_plans_are_as_large_as_their_lettering_allows():
    """With 36 working positions the letters of all plans take more than the place: every second plan is drawn, and it is said."""
    project = files.project(files.from_file(CONVEYOR), {"cycle.working": 36})
    found = unlettered(project)
    parts = [p for p in found.parts if p.title.startswith("План скоростей")]
    assert [p.title.split()[-1] for p in parts] == [str(i) for i in range(40) if i % 2 == 0 or i == 3]
    assert max(project.study.velocities.points["D"].value.__abs__()) / found.scales["velocities"].mu > 10
    assert "Начерчены планы скоростей" in " ".join(words(found))
    (said,) = map(str, composition.left_out(project, every_sheet(project)))
    assert said == "there is no room for 40 velocity plans: one in 2 is drawn"
    view = next(p.box for p in found.parts if p.draw == "kinematics.velocity_plans")
    for p, q in pairwise([*parts, next(p for p in found.parts if p.first > parts[-1].first)]):
        ends = [z for m in found.marks[p.first:q.first] if hasattr(m, "a") for z in (m.a, m.b)]
        assert all(p.box.x0 <= z.real <= p.box.x1 for z in ends)
        assert all(view.y0 <= z.imag <= view.y1 for z in ends)


# --- the file's scale factors -------------------------------------------------------------------------------------------


def with_scale(name, **factors):
    v = catalogue.read(name)
    return Project(v.model_copy(update={"scales": factors}))


def test_a_factor_that_fits_is_taken():
    found = unlettered(with_scale("sixbar/8:3", positions=0.0075))
    assert found.scales["positions"].mu == 0.0075


@pytest.mark.parametrize(
    ("plan", "name"),
    [("positions", "sixbar/8:3"), seldom("positions", "lugansk/shaper"), ("velocities", "lugansk/shaper"),
     seldom("velocities", "lugansk/engine"), seldom("accelerations", "lugansk/shaper"), seldom("lever", "lugansk/engine")],
)
def test_the_refusal_names_the_true_need(plan, name):
    """What it says it needs fits, a hundredth less does not."""
    with pytest.raises(CannotBuild, match="it needs") as refused:
        unlettered(with_scale(name, **{plan: 1e-9}))
    need = float(re.search(r"it needs (\S+) or more", str(refused.value))[1])
    assert unlettered(with_scale(name, **{plan: need})).scales[plan].mu == need
    with pytest.raises(CannotBuild, match="it needs"):
        unlettered(with_scale(name, **{plan: 0.99 * need}))


def test_the_ink_fills_the_place_at_the_need():
    """At the need of 8:3's positions the drawing reaches from side to side of its place, and not beyond."""
    with pytest.raises(CannotBuild) as refused:
        unlettered(with_scale("sixbar/8:3", positions=1e-9))
    need = float(re.search(r"it needs (\S+) or more", str(refused.value))[1])
    found = unlettered(with_scale("sixbar/8:3", positions=need))
    k = next(k for k, p in enumerate(found.parts) if p.draw == "kinematics.position_plans")
    last = next(p.first for p in found.parts[k + 1:] if p.draw != "kinematics.position_plans")
    x = [z.real for m in found.marks[found.parts[k].first:last] if type(m).__name__ == "Line" for z in (m.a, m.b)]
    place = found.parts[k].box
    assert place.x0 <= min(x) <= max(x) <= place.x1
    assert max(x) - min(x) > 0.9 * place.width


# --- nothing but rounding -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("name", "label"), [
    seldom("transport/compressor@00-В-000", None), ("sixbar/3:1", "0"), seldom("sixbar/3:1", "12"), seldom("sixbar/2:1", "12"),
    seldom("lugansk/engine", "0"), seldom("lugansk/engine", "6")])
def test_no_rounding_noise_on_the_sheets(name, label):
    """No number on the sheets of linkages is smaller than 1e-7 unless it is 0; there is no minus zero."""
    v = catalogue.read(name)
    if label is not None:
        v = v.model_copy(update={"cycle": v.cycle.model_copy(update={"force_position": label})})
    project = Project(v)
    for n in (1, 2):
        for text in words(unlettered(project, n)):
            assert not re.search(r"0,0{7}|10\^\{−\d\d\}|(?<!φ)−0(?![\d,])|−0,0+(?!\d)", text), text


# --- the least factor --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("spread", [1.0, 1e-3, 1e-17, 1e-18, 0.0])
def test_what_is_drawn_keeps_to_its_room_and_lies_on_a_line_but_for_rounding(spread):
    """Points of one x differ by rounding beside arrows of 10 mm: an end is found, and what can be told apart keeps to the room."""
    random = np.random.default_rng(5)
    for _ in range(300):
        n = random.integers(1, 9)
        x, offset = random.normal(size=n) * spread + random.choice([0.0, 1.0, 100.0]), random.uniform(-9.0, 9.0, size=n)
        mu = needed(x, offset, 20.0)
        assert mu >= 0
        if spread > 1e-10 and mu > 0:
            assert np.ptp(x / mu + offset) <= 20.0 * (1 + 1e-9)


def test_a_place_squeezed_to_nothing_still_has_a_scale():
    """A full sheet may leave a plan no height: it is drawn a millimetre high, not refused."""
    assert needed(np.array([0.0, 5.0]), np.zeros(2), 0.0) == 5.0
