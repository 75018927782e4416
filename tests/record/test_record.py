"""The record: every number of `solve` has its step, and the steps follow from the givens by the rules alone."""

import json
import re

import numpy as np
import pytest

from tests import docs
from tests.few import few, seldom
from tests.record.printed import strangers
from tests.record.replayer import Replay, number
from tmm_sheets import catalogue, kept, results
from tmm_sheets.__main__ import run
from tmm_sheets.construction import expression
from tmm_sheets.project import Project
from tmm_sheets.record import recording
from tmm_sheets.record.step_index import leaves

PROJECTS = ("lugansk/shaper", "lugansk/engine", "press", "sixbar/1:1", "sixbar/8:3", "transport/press@05-ЭПС-123",
            "transport/crusher@12-СДМ-1908", "lugansk/cam_flat")
OF_LINKAGE = ("dead-positions", "cycle", "positions", "velocities", "loads", "moments", "lever", "balance")
"""Plans that only the linkage has a part in."""
LINKAGE = ("positions", "velocities", "accelerations", "forces")


@pytest.fixture(scope="module", params=few(PROJECTS, "lugansk/shaper", "lugansk/cam_flat"))
def case(request):
    project = Project(catalogue.read(request.param))
    found, problem = recording.record(project)
    assert problem is None
    return project, json.loads(recording.as_json(found)), results.assemble(Project(catalogue.read(request.param)), None)


def test_every_key_is_in_the_tables(case):
    """docs/record.md has them from the docstrings."""
    _, record, _ = case
    steps, marks = list(record["steps"].values()), [mark for sheet in record["sheets"] for mark in sheet["marks"]]
    givens = [a for step in steps for a in step["args"] if "given" in a]
    written = {"record": [record], "_step": steps, "given_argument": givens, "sheet_record": record["sheets"], "_mark": marks}
    for function, parts in written.items():
        told = set(re.findall(r"`([^`]+)`", " ".join(re.findall(r"^- (.*?):", docs.record_keys(function), re.MULTILINE))))
        assert set().union(*parts) - {"schema"} <= told, function


def told(entry, record):
    """Value of a result from its step in the record, as `solve` writes it."""
    step = record["steps"][entry["step"]]
    value = number(step["value"], step["type"])
    part = {"x": np.real, "y": np.imag, "abs": np.abs, "angle": np.angle, None: lambda x: x}[entry.get("part")](value)
    if "at" in entry:
        labels = next(p for p in record["plans"] if p["id"] == step["plan"])["positions"]
        part = np.broadcast_to(part, len(labels))[[labels.index(label) for label in entry["at"]]]
    return part


def at(tree, path):
    for key in path.replace("]", "").replace("[", ".").split("."):
        tree = tree[int(key)] if isinstance(tree, list) else tree[key]
    return tree


def test_results_are_values_of_steps(case):
    _, record, solved = case
    for path, entry in record["results"].items():
        value = told(entry, record)
        if isinstance(value, str):
            assert value == at(solved, path)
            continue
        if np.iscomplexobj(value):
            value = np.stack((np.real(value), np.imag(value)), -1)
        expected = np.array([[np.nan if v is None else v for v in np.ravel(np.array(at(solved, path), dtype=object))]], dtype=float)
        np.testing.assert_array_equal(np.broadcast_to(value, np.shape(at(solved, path))).ravel(), expected.ravel(), err_msg=path)


def test_every_number_of_the_linkage_has_its_step(case):
    project, record, _ = case
    tree = results.told(project, [p for p in project.parts if p in LINKAGE] or None)
    paths = [path for path, _ in leaves(tree) if path.startswith(LINKAGE)]
    assert [path for path in paths if path not in record["results"]] == []


def test_every_number_has_its_step(case):
    project, record, _ = case
    bare = [path for path, _ in leaves(results.told(project, None)) if path not in record["results"]]
    assert bare == []


def test_the_cycle_has_its_steps(case):
    """Angles, angular velocity and acceleration of the crank, as they follow from the keys of the file."""
    project, record, solved = case
    if project.variant.crank is None:
        assert not [path for path in record["results"] if path.startswith("cycle")]
        return
    crank, cycle = project.variant.crank, project.variant.cycle
    sense = 1 if crank.sense == "counter-clockwise" else -1
    of = {name: record["results"][f"cycle.{name}"] for name in ("phi", "omega1", "epsilon1")}
    assert told(of["omega1"], record) == sense * crank.speed == solved["cycle"]["omega1"]
    if crank.angular_acceleration == "flywheel":
        assert len(told(of["epsilon1"], record)) == len(solved["cycle"]["labels"])
    else:
        assert told(of["epsilon1"], record) == sense * crank.angular_acceleration
    phi = told(of["phi"], record)
    if cycle.positions is not None:
        turned = np.exp(1j * (phi - cycle.start)) if isinstance(cycle.start, float) else np.exp(1j * (phi - phi[0]))
        apart = np.exp(sense * 2j * np.pi / cycle.positions)
        even = [k for k, label in enumerate(solved["cycle"]["labels"]) if label not in cycle.extra]
        assert turned[even[1:]] / turned[even[:-1]] == pytest.approx(np.full(len(even) - 1, apart), rel=1e-12)


def test_replay(case):
    """Values follow from the givens, the rules and the primitives: nothing else of the program is asked."""
    _, record, _ = case
    replay = Replay(record)
    off = {key: d for key in replay.values if (d := replay.difference(key)) > 1e-12}
    assert off == {}
    assert replay.lost == set()


def test_arguments_come_first(case):
    _, record, _ = case
    seen = set()
    for key, step in record["steps"].items():
        assert {a["step"] for a in step["args"] if "step" in a} <= seen, key
        seen.add(key)
    listed = [key for plan in record["plans"] for key in plan["steps"]]
    assert sorted(listed) == sorted(record["steps"])
    assert len({plan["id"] for plan in record["plans"]}) == len(record["plans"])


def test_marks_refer_to_what_is_there(case):
    _, record, _ = case
    roles = {"vector", "construction", "point", "curve", "axis", "link", "symbol", "dimension", "hatch", "text", "table", "frame"}
    for sheet in record["sheets"]:
        frames = {frame["id"] for frame in sheet["frames"]}
        assert sheet["marks"]
        for mark in sheet["marks"]:
            assert mark["role"] in roles
            assert mark.get("frame") in frames | {None}
            assert mark.get("step") in record["steps"] or "step" not in mark


def test_givens_of_the_linkage_have_their_places(case):
    """Every number that the linkage takes stands in the project file, or is a constant of a rule, 0, 1 or -1, or a direction."""
    project, record, _ = case
    if project.variant.crank is None:
        pytest.skip("no linkage")
    for key, step in record["steps"].items():
        if step["plan"] in OF_LINKAGE or step["plan"].startswith("force-"):
            for a in step["args"]:
                if a.get("name") == "constant":
                    assert a["over"] == "none", key
                    assert a["given"] in (0.0, 1.0, -1.0, [0.0, 0.0]), (key, a)


# --- the commands -----------------------------------------------------------------------------------------------------


def test_record_of_one_sheet(tmp_path, capsys):
    path = tmp_path / "record.json"
    assert run(["record", "lugansk/shaper", "--sheet", "2", "--json", str(path)]) == 0
    assert capsys.readouterr() == ("", "")
    found = json.loads(path.read_text(encoding="utf-8"))
    assert [sheet["sheet"] for sheet in found["sheets"]] == [2]
    assert {path.partition(".")[0] for path in found["results"]} == {"cycle", "positions", "velocities", "flywheel"}
    assert not [name for name in found["plans"] if name["id"].startswith(("gear", "cam", "force", "lever"))]
    assert found["schema"] == 1
    assert found["lang"] == "ru"


@pytest.mark.parametrize(("arguments", "status", "said"), [
    (["record", "lugansk/shaper", "--sheet", "9", "--json", "-"], 2, "no sheet 9"),
    (["record", "lugansk/shaper"], 2, "--json"),
    (["why", "lugansk/shaper", "forces.arms.h5"], 2, "did you mean forces.arms.h50"),
    (["why", "lugansk/shaper", "flywhel.J_flywheel"], 2, "did you mean flywheel.J_flywheel"),
    (["why", "lugansk/shaper", "structure.W"], 2, "not constructed"),
    (["why", "lugansk/shaper", "cycle.omega"], 2, "did you mean cycle.omega1"),
    (["why", "lugansk/cam_flat", "cycle.phi"], 2, 'has no part "cycle"'),
    (["why", "sixbar/1:1", "gear.z1"], 2, 'has no part "gear"'),
])
def test_wrong_usage(arguments, status, said, capsys):
    assert run(arguments) == status
    captured = capsys.readouterr()
    assert said in captured.err
    assert captured.out == ""


def test_size():
    """A record stays small enough to be read at once."""
    found, _ = recording.record(Project(catalogue.read("sixbar/8:3")))
    assert len(recording.as_json(found).encode()) < 10e6


def test_why(capsys):
    """The velocity of the crank pin: from its length, its speed and its angle, in this order, to the result."""
    assert run(["why", "lugansk/shaper", "velocities.points.B"]) == 0
    lines = capsys.readouterr().out.splitlines()
    names = [line.split()[0] for line in lines]
    assert {"crank.length", "crank.speed", "crank.sense"} <= set(names)
    assert names[-2:] == ["velocities/b", "velocities.points.B"]
    assert names.index("crank.length") < names.index("positions/B") < names.index("velocities/b")
    (length,) = (line for line in lines if line.startswith("crank.length"))
    assert length.startswith("crank.length  l_{AB} = 0.08 m  given")


def test_why_tells_the_values_of_the_force_position(capsys):
    project = Project(catalogue.read("lugansk/shaper"))
    k = project.force_index
    assert k > 0
    steps = {"positions/B": project.study.positions.points["B"], "velocities/b": project.study.velocities.points["B"]}
    assert run(["why", "lugansk/shaper", "velocities.points.B"]) == 0
    lines = {line.split()[0]: line for line in capsys.readouterr().out.splitlines()}
    for name, step in steps.items():
        value = complex(step.value[k])
        assert f" = ({value.real:.6g}, {value.imag:.6g}) " in lines[name]
    assert lines["velocities.points.B"].endswith(f"position {project.cycle.labels[k]}")


@pytest.mark.parametrize(("result", "given", "value"), [("cycle.omega1", "crank.speed", "-7.53982 rad/s"),
                                                          ("cycle.phi", "cycle.working", "rad, position 2")])
def test_why_of_the_cycle(result, given, value, capsys):
    assert run(["why", "lugansk/shaper", result]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert given in {line.split()[0] for line in lines}
    assert lines[-1].startswith(f"{result} = ")
    assert value in lines[-1]


@pytest.mark.parametrize("numbers", [seldom((1,)), (1, 2)])
def test_searches_are_counted(numbers):
    """Every step that is evaluated, or done again at other angles, is one of a drawn plan or of a search."""
    from tmm_sheets.construction import function
    from tmm_sheets.construction.step import Step
    from tmm_sheets.sheets import composing

    total, computed, repeated = 0, Step._computed, function.Replay.__call__

    def counted(step):
        nonlocal total
        total += 1
        return computed(step)

    def again(self, inputs, search=None):
        nonlocal total
        total += len(self)
        return repeated(self, inputs, search)

    project = Project(catalogue.read("sixbar/1:1"))
    with pytest.MonkeyPatch.context() as patch, kept.unused():
        patch.setattr(Step, "_computed", counted)
        patch.setattr(function.Replay, "__call__", again)
        for n in numbers:
            composing.ask_again(project, n, ())
        drawn = sum(step.evaluated for of in project.plans.values() for plan in (of or {}).values()
                    for step in (*plan, *plan.auxiliaries.values(), *plan.conditions.values()))
    searched = sum(search.steps for search in project.searches)
    assert searched > 100
    assert drawn + searched == total


@pytest.mark.trial
def test_printed_numbers_are_those_of_steps():
    """No view works a number out on its own."""
    count, none = strangers("lugansk/engine")
    assert count > 800
    assert not none


def test_typesetting_keeps_the_order_and_adds_parentheses():
    tree = expression.trace(lambda m, w, s, j: (m - w**2 / 2 * s) / j, 4)
    assert recording.latex(tree, ["M", "\\omega", "J'", "J"]) == "\\frac{M - \\frac{\\omega^{2}}{2} \\cdot J'}{J}"
    numbers = recording.latex(tree, ["5", "-3", "-2", "4"])
    assert numbers == "\\frac{5 - \\frac{\\left(-3\\right)^{2}}{2} \\cdot \\left(-2\\right)}{4}"
    assert recording.latex(expression.trace(lambda a, b: a - (a - b), 2), ["a", "b"]) == "a - \\left(a - b\\right)"
    power = expression.trace(lambda a, b: (a / b) ** 0.2, 2)
    assert recording.latex(power, ["4", "7.5"]) == "\\left(\\frac{4}{7.5}\\right)^{1/5}"
    of_function = expression.trace(lambda x: np.maximum(2 * x, 0.0), 1)
    assert recording.latex(of_function, ["-3"]) == "\\max \\left(2 \\cdot \\left(-3\\right);\\, 0\\right)"
