"""One function of the crank angle against the steps it is written from, for every kind of linkage."""

from pathlib import Path

import numpy as np
import pytest

from tests.methods.linkage.mechanisms import mechanism
from tmm_sheets import catalogue
from tmm_sheets.construction.function import Function
from tmm_sheets.construction.program import rows_of
from tmm_sheets.construction.step import value_of
from tmm_sheets.mechanism.groups import RRR
from tmm_sheets.mechanism.model import StructuralGroup
from tmm_sheets.methods.linkage.motion import Watched, velocity_plan
from tmm_sheets.methods.linkage.positions import position_plan
from tmm_sheets.project import Project
from tmm_sheets.resources import variants

OWN = Path(__file__).parents[2] / "projects"
ALONE = {n: variants() / f"{n}.toml" for n in catalogue.shipped() if not n.startswith(("transport/", "sixbar/"))}
ALONE |= {str(p): p for p in sorted(OWN.glob("*.toml"))}
NAMES = [n for n, path in ALONE.items() if "[crank]" in path.read_text(encoding="utf-8")]
NAMES += [f"sixbar/{task}:{task % 5 + 1}" for task in range(1, 11)]
NAMES += ["transport/diesel@01-Т-27", "transport/compressor@09-В-5", "transport/press@05-ЭПС-123", "transport/crusher@12-СДМ-1908"]
N = 73
CLOSE = 1e-13


def studied(name):
    project = Project(catalogue.read(name))
    study = project.study_at(np.linspace(0, project.cycle.period, N), tuple(map(str, range(N))), "")
    _ = study.positions, study.velocities, study.accelerations, study.sliding
    if "forces" in project.parts:
        _ = study.forces, study.lever, study.balance
    return study


def over_positions(study):
    """Steps whose values differ from position to position, by their paths, with the group of quantities they belong to."""
    for plan in study.plans.values():
        for step in (*plan, *plan.auxiliaries.values()):
            value = np.asarray(step.value)
            if value.shape == (N,) and not step.rule.beyond_paper and step.name != "Δ":  # that is nothing but rounding
                yield step, (plan.name.partition("-")[0], step.rule.gives, step.rule.unit)


@pytest.mark.parametrize("name", NAMES, ids=[Path(n).stem if n.endswith(".toml") else n for n in NAMES])
def test_one_function_is_its_steps(name):
    """All plans of positions, velocities, accelerations, forces and the lever, relative to the greatest of each kind."""
    study = studied(name)
    found = list(over_positions(study))
    wanted = {step.path: step for step, _ in found}
    rows = rows_of(wanted.values(), N)
    values = Function(wanted, rows)(*map(value_of, rows))
    size = {}
    for step, kind in found:
        size[kind] = max(size.get(kind, 0.0), np.nanmax(np.abs(step.value), where=np.isfinite(step.value), initial=0.0))
    for step, kind in found:
        value, own = values[step.path], np.asarray(step.value)
        np.testing.assert_array_equal(np.isnan(value), np.isnan(own), err_msg=step.path)
        told = np.isfinite(own) & np.isfinite(value) & ~forceless(step)
        assert np.abs(value[told] - own[told]).max(initial=0.0) <= CLOSE * size[kind], step.path


def forceless(step):
    """Where an arm is that of next to no force: it is nothing but rounding."""
    force = next((np.abs(value_of(a)) for a, kind in zip(step.args, step.rule.takes, strict=False)
                  if kind == "force" and step.rule.gives in ("length", "ordinate")), None)
    return np.zeros(N, dtype=bool) if force is None else np.broadcast_to(force < 1e-9 * np.nanmax(force), (N,))


def test_a_length_as_an_argument():
    """The shaper with another crank: its plans recorded anew give the same."""
    study = studied("lugansk/shaper")
    row = study.positions.angle
    f = Function({**study.velocities.points, **study.velocities.omega}, [row], ["crank.length"])
    variant = catalogue.read("lugansk/shaper")
    longer = Project(variant.model_copy(update={"crank": variant.crank.model_copy(update={"length": 0.09})}))
    other = velocity_plan(position_plan(longer.mechanism, row.value))
    found = f(row.value, given={"crank.length": 0.09})
    for name, step in {**other.points, **other.omega}.items():
        if np.ndim(step.value):
            np.testing.assert_allclose(found[name], step.value, rtol=1e-13, atol=1e-14)


def test_undefined_where_it_does_not_assemble():
    m = mechanism(StructuralGroup(RRR, ("2", "3"), ("B", "D"), "C", (0.3, 0.08), (), 1), fixed={"D": 0.4 + 0j})
    pos = position_plan(m, np.linspace(-np.pi, np.pi, 181))
    vel = velocity_plan(pos)
    own = vel.points["C"].value
    found = Function({"C": vel.points["C"]}, [pos.angle])(pos.angle)["C"]
    assert 20 < np.isnan(own).sum() < 170
    np.testing.assert_array_equal(np.isnan(found), np.isnan(own))
    there = ~np.isnan(own)
    assert (np.abs(found - own)[there] / np.abs(own[there])).max() < CLOSE


@pytest.mark.parametrize("name", ["lugansk/shaper", "loom"])
def test_watched_at_any_angles(name):
    """A search that records once sees what plans recorded for these very angles show."""
    m = Project(catalogue.read(name)).mechanism
    watched, last = Watched(m, "trial"), m.groups[-1].links[-1]
    point = str(m.groups[-1].inner or m.groups[-1].legs[0].corner)
    looks = watched.point(point), watched.velocity(point), watched.direction(last), watched.omega(last)
    for phi in (np.linspace(0, 6, 11), np.array([1.0, 1.1]), np.array([2.5])):
        pos = position_plan(m, phi)
        vel = velocity_plan(pos)
        own = pos.points[point], vel.points[point], pos.directions[last], vel.omega[last]
        for look, step in zip(looks, own, strict=True):
            np.testing.assert_allclose(look(phi), np.broadcast_to(step.value, phi.shape), rtol=1e-12, atol=1e-14)
    assert m.searches["trial"].plans == (2 if name == "lugansk/shaper" else m.searches["trial"].plans)


def test_searches_share_one_recording():
    """Dead positions, assembly, strokes: the plans are recorded by the first and done again by the others."""
    project = Project(catalogue.read("lugansk/shaper"))
    _ = project.study.forces
    found = {search.purpose: search for search in project.searches}
    assert {purpose: search.plans for purpose, search in found.items()} == {"dead points": 2, "assembly": 0, "strokes of forces": 0}
    assert all(search.steps > 0 for search in found.values())


def test_steps_made_and_evaluated(monkeypatch):
    """What solve makes for the positions of the shaper, no scale with it: no more than this."""
    from tmm_sheets import results
    from tmm_sheets.construction.step import Step

    made, init = [], Step.__init__

    def counted(step, *args, **kwargs):
        init(step, *args, **kwargs)
        made.append(step)

    monkeypatch.setattr(Step, "__init__", counted)
    results.assemble(Project(catalogue.read("lugansk/shaper")), ["positions"])
    assert (sum(step.evaluated for step in made), len(made)) == (31, 71)
