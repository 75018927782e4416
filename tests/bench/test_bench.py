"""The benchmark tells the truth: its truth against the tests' own, known orders of the methods, failures as null."""

import json
import sys
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from math import log2, pi
from pathlib import Path
from time import sleep

import numpy as np
import pytest

from tests.bench import costs, plain, whole
from tests.methods.linkage import shaper_truth, statics, truth as other
from tmm_sheets.__main__ import run
from tmm_sheets.errors import CannotBuild
from tmm_sheets.lab.bench import diagrams, linkages, profiles, records as records_of, truth
from tmm_sheets.lab.bench.records import Bench, BenchRecord, as_json, diagrams as drawn_fields, fastest, table


def measured(*modules):
    bench = Bench(quick=True)
    for module in modules:
        module.rows(bench)
    return bench.records


@pytest.fixture(scope="module")
def records():
    return measured(linkages, diagrams, profiles)


def of(records, method):
    found = [r for r in records if r.method == method]
    assert found, method
    return found


# --- truth ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("build", [b for _, b in linkages.MECHANISMS], ids=[name for name, _ in linkages.MECHANISMS])
def test_truth_against_other_truths(build):
    m, phi = build(), 0.7
    moved, goal = truth.motion(m, phi), other.motion(m, phi)
    for quantity in ("z", "v", "a", "omega", "epsilon"):
        mine, theirs = getattr(moved, quantity), getattr(goal, quantity)
        assert set(mine) == set(theirs)
        size = max(map(abs, theirs.values()))
        assert all(abs(mine[k] - theirs[k]) <= 1e-15 * size for k in theirs)
    forces, moment = truth.reactions(m, moved, 9.81)
    system = statics.solve(m, phi, 9.81)
    assert set(forces) == set(system.reactions)
    largest = max(map(abs, system.reactions.values()))
    assert all(abs(forces[k] - system.reactions[k]) < 1e-12 * largest for k in forces)
    assert float(moment) == pytest.approx(system.balancing, rel=1e-12)


def test_thirty_digits_of_truth(monkeypatch):
    """A step ten thousand times smaller with more digits changes nothing in the first thirty."""
    m = linkages.shaper()
    coarse = truth.motion(m, 1.0)
    monkeypatch.setattr(truth, "DIGITS", 140)
    monkeypatch.setattr(truth, "STEP_DIGITS", 37)
    fine = truth.motion(m, 1.0)
    with truth.mp.workdps(50):
        for a, b in ((coarse.a, fine.a), (coarse.v, fine.v), (coarse.epsilon, fine.epsilon)):
            size = max(map(abs, b.values()))
            assert all(abs(a[k] - b[k]) < 1e-30 * size for k in b)


def test_flywheel_truth_against_closed_forms():
    first = diagrams.ShaperEnergy(diagrams.shaper_of(10)).first(mertsalov=False)
    assert float(first) == pytest.approx(315.8003979742, rel=1e-12)  # by the tests of the flywheel
    t = np.linspace(0, 2 * pi, 7)
    shaper = diagrams.ShaperEnergy(diagrams.shaper_of(10))
    assert [float(shaper.inertia(x)) for x in t] == pytest.approx(shaper_truth.inertia(t).tolist(), rel=1e-13)


# --- what the methods must show ---------------------------------------------------------------------------------------


def test_rows_of_everything(records):
    assert {r.field for r in records} == {"linkages", "graphical integration", "excess work", "flywheel", "cam",
                                          "involute by unrolling", "rack generation", "reducer"}
    assert all(r.error is not None and r.seconds is not None and r.seconds > 0 for r in records)


def test_exact_constructions_are_at_rounding_level(records):
    for plan in linkages.PLANS:
        for name, _ in linkages.MECHANISMS:
            assert max(r.error for r in of(records, f"{plan} of the {name}")) < 5e-15
    for method in ("r0 by tangents", "search of tooth numbers", "Wittenbauer, limit", "Mertsalov, limit"):
        assert max(r.error for r in of(records, method)) < 1e-12, method
    for r in records:
        if r.method in ("profile, points (mm)", "points (mm)", "points of contact (mm)"):
            assert r.error < 1e-12, r


@pytest.mark.parametrize(
    ("method", "order"),
    [("smooth, equal intervals", 2), ("force with jumps, jumps as borders", 2), ("smooth curve, extremes between", 1.7),
     ("Wittenbauer, construction", 2), ("Mertsalov, construction", 2), ("profile, chords between the points (mm)", 2),
     ("chords between the points (mm)", 2), ("arcs stepped off as chords (mm)", 2)],
)  # fmt: skip
def test_orders_of_approximate_methods(records, method, order):
    rows = sorted(of(records, method), key=lambda r: r.value)
    a, b = rows[-2:]
    assert log2(a.error / b.error) / log2(b.value / a.value) == pytest.approx(order, abs=0.25)


def test_known_errors_of_chords(records):
    """Printed in the literature of the method: mid-ordinate chords of the squared sine."""
    found = {r.value: r.error for r in of(records, "smooth, equal intervals")}
    assert found[12] == pytest.approx(3.3e-3, abs=5e-5)
    assert found[24] == pytest.approx(9.2e-4, abs=5e-6)
    assert {r.value: r.error for r in of(records, "extremes among the ends of the chords")}[12] == pytest.approx(0.093, abs=5e-4)


def test_jumps_that_are_no_borders_spoil_the_order(records):
    with_borders, without = (of(records, f"force with jumps, {way}")[-1] for way in ("jumps as borders", "equal intervals"))
    assert without.error > 10 * with_borders.error


def test_files_have_no_error_but_a_time():
    bench = Bench(quick=True)
    records_of.files_written(bench)
    found = bench.records
    assert [r.method for r in found] == ["dxf", "pdf", "svg", "png, 100 dots per inch", "hpgl"]
    assert all(r.error is None and r.seconds > 0 and r.note.endswith("kB") for r in found)


# --- rows, table, diagrams, costs -------------------------------------------------------------------------------------


def refused():
    raise CannotBuild("too large\n    take less")


@pytest.mark.parametrize(
    ("way", "error", "note"),
    [(refused, None, "too large"), (lambda: 1, lambda _: float("nan"), "not a number"), (lambda: 1 / 0, None, "division by zero")],
)
def test_failed_runs_are_null(way, error, note):
    bench = Bench(quick=True)
    bench.row(("field", "method", "steps"), 3, way, error)
    assert bench.records == [BenchRecord("field", "method", "steps", 3, None, None, note)]
    assert "failed" in table(bench.records)
    assert json.loads(as_json(bench.records))["records"][0]["seconds"] is None
    assert bench.records[0].each is None


def test_fastest_of_repeated_runs():
    calls = []

    def slow_first():
        calls.append(1)
        sleep(0.02 if len(calls) < 3 else 0.001)
        return len(calls)

    seconds, found = fastest(slow_first, 0.01)
    assert 0.001 <= seconds < 0.02
    assert found == len(calls) >= 4


def test_diagrams(records):
    some = [r for r in records if r.field in ("cam", "rack generation")]
    drawn = drawn_fields([*some, BenchRecord("cam", "a failed one", "positions", 3, None, None, "why")])
    assert set(drawn) == {"cam.svg", "rack-generation.svg"}
    assert b"r0 by tangents" in drawn["cam.svg"]
    assert b"a failed one" not in drawn["cam.svg"]
    for data in drawn.values():
        assert ElementTree.fromstring(data).tag.endswith("svg")


def test_command(tmp_path, monkeypatch, capsys, records):
    monkeypatch.setattr("tmm_sheets.lab.bench.records.run", lambda quick, say: [replace(r, seconds=1.0) for r in records[:3]])
    assert run(["bench", "--quick", "--json", str(tmp_path / "b.json"), "--plot", str(tmp_path / "plots")]) == 0
    assert "positions of the four-bar" in capsys.readouterr().out
    assert json.loads((tmp_path / "b.json").read_text())["schema"] == 1
    assert [p.name for p in (tmp_path / "plots").iterdir()] == ["linkages.svg"]
    assert run(["bench", "--json", "-"]) == 0
    assert len(json.loads(capsys.readouterr().out)["records"]) == 3
    assert run(["bench", "--summary"]) == 0
    assert "| linkages | positions of the four-bar | 12 .. 24 positions |" in capsys.readouterr().out
def test_without_mpmath(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "mpmath", None)
    assert run(["bench", "--quick"]) == 2
    assert "pip install 'mpmath>=1.3'" in capsys.readouterr().err


def test_costs():
    build = costs.measure(["build", "lugansk/cam_flat", "--format", "svg", "-o", "{out}"], runs=1)
    again = costs.measure(["build", "lugansk/cam_flat", "--format", "svg", "-o", "{out}"], runs=1, forced=False)
    assert build.command == "build lugansk/cam_flat --format svg"
    assert build.evaluated > 100
    assert build.marks > 500
    assert "ezdxf" not in build.heavy
    assert (again.steps, again.marks) == (0, 0)
    assert "numpy" not in again.heavy
    assert again.seconds < build.seconds
    names = [" ".join(arguments) for arguments, _ in costs.commands("lugansk/cam_flat")]
    assert "solve lugansk/cam_flat --part cam" in names


def entities(path):
    """Kind, layer, numbers of every entity of a DXF file."""
    import ezdxf

    for e in ezdxf.readfile(path).modelspace():
        kind = e.dxftype()
        if kind == "LINE":
            numbers = [*e.dxf.start.vec2, *e.dxf.end.vec2]
        elif kind == "LWPOLYLINE":
            numbers = [e.closed, *(x for point in e.get_points("xy") for x in point)]
        elif kind == "SOLID":
            numbers = [x for name in ("vtx0", "vtx1", "vtx2", "vtx3") for x in getattr(e.dxf, name).vec2]
        elif kind == "HATCH":
            numbers = [x for point in e.paths[0].vertices for x in point[:2]]
        else:
            numbers = [*e.dxf.center.vec2, e.dxf.radius]
            if kind == "ARC":
                numbers += [e.dxf.start_angle % 360, e.dxf.end_angle % 360]
        yield kind, e.dxf.layer, tuple(round(float(x), 3) + 0.0 for x in numbers)


def test_the_plain_writer_draws_the_same(tmp_path):
    """The baseline is honest: entity by entity what ``build`` writes, and a PDF with the same words."""
    lists = tmp_path / "lists"
    count = whole.prepare("lugansk/cam_flat", lists)
    plain.main(str(lists), str(tmp_path))
    assert run(["build", "lugansk/cam_flat", "--text", "strokes", "-o", str(tmp_path / "build")]) == 0
    ours, theirs = list(entities(tmp_path / "build/sheet1.dxf")), list(entities(tmp_path / "sheet1.dxf"))
    assert len(ours) == len(theirs) == count > 1000
    for alike in {(kind, layer, len(numbers)) for kind, layer, numbers in ours}:
        # Sorting would part what differs by the last digit of rounding: each is looked for among those that are left.
        a, b = (np.array([n for kind, layer, n in of if (kind, layer, len(n)) == alike]) for of in (ours, theirs))
        assert a.shape == b.shape, alike
        left = np.ones(len(b), bool)
        for row in a:
            same = np.flatnonzero(left & (np.abs(b - row) <= 1.1e-3).all(axis=1))
            assert same.size, (alike, row)
            left[same[0]] = False
    assert (tmp_path / "sheet1.pdf").read_bytes().startswith(b"%PDF")


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="tells its memory on Linux alone")
def test_a_process_tells_its_memory():
    assert 1_000 < int(costs.timed("import sys\n" + whole.PEAK, []).done.stderr) < 1_000_000


@pytest.mark.trial
def test_whole():
    found = whole.measure("lugansk/cam_flat", lambda what: None, rounds=1)
    assert found.entities > 1000
    assert found.build.wall > 0
    assert found.imports.processor < found.plain.processor
    assert 20 < found.build.memory < 120
    assert "| `build lugansk/cam_flat`, cold |" in whole.table(found)
