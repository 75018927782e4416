"""Results as files: the same numbers in JSON, arrays and tables, however many positions there are."""

import csv
import io
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tmm_sheets import catalogue, result_files, results
from tmm_sheets.__main__ import run
from tmm_sheets.project import Project

MANY = 3 * result_files.PIECE // 2


def flat(tree):
    return {path: result_files.plain_numbers(value) for path, value in result_files.leaves(tree)}


@pytest.fixture(scope="module")
def many():
    return results.told(Project(catalogue.read("lugansk/shaper")), None, positions=MANY)


def test_one_function_tells_what_steps_tell(many, monkeypatch):
    monkeypatch.setattr(results, "MANY", 10 * MANY)
    by_steps = results.told(Project(catalogue.read("lugansk/shaper")), results_of("linkage"), positions=MANY)
    for path, value in result_files.leaves(by_steps):
        own = result_files.row(value)
        if own is None or "difference" in path or "arms" in path:
            continue
        found = result_files.row(at(many, path))
        table = path.rpartition(".")[0]
        size = max(np.nanmax(np.abs(a)) for p, v in result_files.leaves(by_steps)
                   if p.rpartition(".")[0] == table and (a := result_files.row(v)) is not None)
        np.testing.assert_array_equal(np.isnan(found), np.isnan(own), err_msg=path)
        assert np.nanmax(np.abs(found - own)) <= 1e-13 * size, path


def results_of(part):
    return {"linkage": ("positions", "velocities", "accelerations", "forces")}[part]


def at(tree, path):
    for key in path.split("."):
        tree = tree[key]
    return tree


def test_json_in_pieces_is_json(many):
    """Row by row what json writes of the plain tree."""
    text = "".join(result_files.json_pieces(many))
    plain = result_files.plain_numbers(many)
    assert json.loads(text) == plain
    row = f'"F54": {json.dumps(plain["forces"]["reactions"]["F54"])}'
    assert row in text


@pytest.mark.parametrize("value", [[], [1.0, float("nan"), -0.0, float("inf")], [1 + 2j, complex("nan")]])
def test_null_and_zero(value):
    tree = {"a": {"b": np.array(value)}}
    text = "".join(result_files.json_pieces(tree))
    assert json.loads(text) == {"a": {"b": result_files.plain_numbers(np.array(value))}}
    assert "-0.0" not in text


def test_npz(many, tmp_path):
    path = tmp_path / "r.npz"
    with path.open("wb") as file:
        result_files.write_npz(many, file)
    once = path.read_bytes()
    with np.load(path) as found:  # nothing in it is pickled
        assert found["forces.reactions.F54"].shape == (MANY, 2)
        np.testing.assert_array_equal(found["positions.angles.3"], at(many, "positions.angles.3").value)
        np.testing.assert_array_equal(found["positions.points.B"], result_files.row(at(many, "positions.points.B")))
        assert found["cycle.labels"][:3].tolist() == ["0", "1", "2"]
        assert set(found.files) == set(flat(many))
    with path.open("wb") as file:
        result_files.write_npz(many, file)
    assert path.read_bytes() == once


def test_csv_of_the_numbered_positions(tmp_path, capsys):
    """Forces are told of one position: the others are empty there."""
    target = tmp_path / "r.csv"
    assert run(["solve", "lugansk/shaper", "--csv", str(target)]) == 0
    assert capsys.readouterr().out == ""
    rows = list(csv.DictReader(io.StringIO(target.read_text(encoding="utf-8"))))
    tree = results.assemble(Project(catalogue.read("lugansk/shaper")), None)
    assert [row["label"] for row in rows] == tree["cycle"]["labels"]
    assert [float(row["positions.points.D.x"]) for row in rows] == [x for x, _ in tree["positions"]["points"]["D"]]
    told = [row["label"] for row in rows if row["forces.reactions.F54.y"]]
    assert told == tree["forces"]["label"]
    (force,) = (row for row in rows if row["label"] in told)
    assert float(force["forces.reactions.F54.y"]) == tree["forces"]["reactions"]["F54"][0][1]


def test_a_table_of_nothing_is_refused(tmp_path, capsys):
    assert run(["solve", "lugansk/shaper", "--part", "gear", "--csv", str(tmp_path / "r.csv")]) == 1
    assert "positions" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_several_files_at_once(tmp_path):
    names = {kind: tmp_path / f"r.{kind}" for kind in ("json", "npz", "csv")}
    asked = [x for kind, path in names.items() for x in (f"--{kind}", str(path))]
    assert run(["solve", "press", "--part", "velocities", *asked]) == 0
    tree = json.loads(names["json"].read_text(encoding="utf-8"))
    with np.load(names["npz"]) as found:
        assert found["velocities.points.B"].tolist() == tree["velocities"]["points"]["B"]


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="tells its memory on Linux alone")
def test_memory_of_very_many_positions(tmp_path):
    """Written as it is computed: 30,000 positions with all reactions, 210 MB as a tree, in 150 MB."""
    program = ("import sys; from pathlib import Path; from tmm_sheets.__main__ import run; run(sys.argv[1:]); "
               "print(Path('/proc/self/status').read_text().partition('VmHWM:')[2].split()[0])")
    asked = ["solve", "lugansk/shaper", "--positions", "30000", "--part", "forces", "--json", str(tmp_path / "r.json")]
    done = subprocess.run([sys.executable, "-c", program, *asked], capture_output=True, text=True, check=True)
    assert int(done.stdout) < 150_000  # kB
