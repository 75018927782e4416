"""The commands as a user meets them: exit status, output, messages without a traceback, nothing half written."""

import errno
import json
import os
import re
import subprocess
import sys
from itertools import product
from pathlib import Path

import pytest

from tests.few import few, seldom
from tests.project_files import EVEN, SLIDER, from_file, write
from tmm_sheets import catalogue
from tmm_sheets.__main__ import run
from tmm_sheets.output.build_store import RECORD
from tmm_sheets.sheets import composing
from tmm_sheets.version import __version__

SHAPER = from_file("lugansk/shaper")
ROOT = Path(__file__).parents[1]


def command(*arguments, **options):
    """The console program in a process of its own."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTHONWARNINGS": "error"}
    options = {"capture_output": True, "text": True, "timeout": 60, "env": environment} | options
    return subprocess.run([sys.executable, "-m", "tmm_sheets", *map(str, arguments)], **options)


def listing(folder):
    return sorted(p.relative_to(folder).as_posix() for p in folder.rglob("*"))


# --- help, version, list, show, check -------------------------------------------------------------------------------


def test_version_loads_nothing_heavy():
    done = command("--version", env={**os.environ, "PYTHONPATH": str(ROOT), "PYTHONPROFILEIMPORTTIME": "1"})
    assert done.returncode == 0
    assert done.stdout == f"tmm-sheets {__version__}\n"
    assert not {m for m in ("numpy", "pydantic", "ezdxf", "reportlab", "shapely") if f" {m}\n" in done.stderr}
    assert "click" in done.stderr


@pytest.mark.parametrize("arguments", [["-h"], ["--help"], ["build", "-h"], ["solve", "--help"]])
def test_help(arguments, capsys):
    assert run(arguments) == 0
    assert "Usage: tmm-sheets" in capsys.readouterr().out


def test_list(capsys):
    assert run(["list"]) == 0
    listed = {line.split(maxsplit=1)[0]: line.split(maxsplit=1)[1] for line in capsys.readouterr().out.splitlines()}
    assert listed["lugansk/shaper"] == "Shaping machine, example 1; sheets: kinematics_forces, flywheel, gear, cam"


def test_list_json(capsys):
    assert run(["list", "--json"]) == 0
    entries = {e["name"]: e for e in json.loads(capsys.readouterr().out)}
    assert entries["lugansk/shaper"]["sheets"] == ["kinematics_forces", "flywheel", "gear", "cam"]


def test_headings_are_those_of_the_whole_files():
    for entry in catalogue.entries():
        variant = catalogue.read(entry.name)
        assert entry == catalogue.ShippedProject(entry.name, variant.project.title, variant.project.variant, variant.sheets)


def test_what_reads_no_project_loads_neither_models_nor_numbers():
    words = [[], ["--help"], ["--version"], ["list"], ["build", "--help"]]
    code = f"import sys; from tmm_sheets.__main__ import run; [*map(run, {words})]; print(*sys.modules, sep='\\n')"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60,
                          env={**os.environ, "PYTHONPATH": str(ROOT)})  # fmt: skip
    loaded = set(done.stdout.splitlines())
    assert "tmm_sheets.cli" in loaded
    assert not loaded & {"numpy", "pydantic", "shapely", "ezdxf", "reportlab", "tmm_sheets.task.variant"}


def test_show(capsys):
    assert run(["show", "lugansk/shaper"]) == 0
    out = capsys.readouterr().out
    for line in (
        "  crank.length                0.08 m                    000, 2 ex. 1: l_AC sin(theta/2) = 0.0803, rounded to 0.08",
        "  D″  5–0  sliding",
        "Mobility W = 3n - 2 p5 - p4 = 3*5 - 2*7 - 0 = 1",
        "  4–5  class 2, order 2  kind 5 (RPP)",
        "Formula of structure: I(0,1) → II(2,3) → II(4,5)",
    ):
        assert f"{line}\n" in out


def test_check_writes_nothing(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run(["check", "lugansk/shaper"]) == 0
    assert capsys.readouterr().out == "lugansk/shaper: OK\n"
    assert listing(tmp_path) == []


# --- wrong usage and unreadable input: 2 ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["draw"], "No such command 'draw'"),
        (["build"], "Missing argument 'PROJECT'"),
        (["build", "lugansk/shaper", "--shet", "1"], "No such option"),
        (["build", "lugansk/shaper", "--sheet", "5"], "no sheet 5: lugansk/shaper has sheets 1 to 4"),
        (["build", "lugansk/shaper", "--sheet", "0"], "no sheet 0"),
        (["build", "lugansk/shaper", "--sheet", "x"], "'x' is not a valid integer"),
        (["build", "lugansk/shaper", "--format", "dwg"], "'dwg' is not one of dxf, pdf"),
        (["check", "lugansk/shapper"], "did you mean lugansk/shaper"),
        (["check", "nothing/like/it"], "neither a shipped name nor a file"),
        (["check", "no/such/file.toml"], "no/such/file.toml: no such file"),
        (["check", "."], "this is a folder"),
        (["solve", "lugansk/shaper", "--part", "reduser"], "'reduser' is not one of"),
        (["solve", "lugansk/shaper", "--part", "reducer"], 'no part "reducer"'),
        (["solve", "lugansk/shaper", "--phi", "1,x"], "expected angles in degrees"),
        (["solve", "lugansk/shaper", "--phi", "nan"], "expected angles in degrees"),
        (["solve", "lugansk/shaper", "--phi", "1", "--positions", "5"], "not both"),
        (["solve", "lugansk/shaper", "--positions", "0"], "0 is not in the range"),
        (["protocol", "lugansk/shaper", "--plan", "velocites"], "did you mean"),
    ],
)
def test_wrong_usage(arguments, said, capsys):
    assert run(arguments) == 2
    captured = capsys.readouterr()
    assert said in captured.err
    assert "Traceback" not in captured.err
    assert captured.out == ""


def test_file_with_problems(tmp_path, capsys):
    file = tmp_path / "my.toml"
    text = catalogue.read("lugansk/shaper").text
    file.write_text(text.replace('"0.08 m"', '"-0.08 m"').replace("delta = 0.025", "delta = nan"), encoding="utf-8")
    assert run(["check", str(file)]) == 2
    err = capsys.readouterr().err
    assert f'{file}:27: crank.length: expected a length greater than zero, not "-0.08 m"\n' in err
    assert "flywheel.delta: expected a number, not nan" in err


# --- understood, but cannot be built: 1 -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "said", "refused"),
    [
        seldom({"points.C": ["0 m", "-0.08 m"]}, "B passes through C", {1, 2}),
        seldom({"gear.shift": [-0.5, 0.0]}, "undercut", {3}),
        seldom({"gear.shift": [1.4, 0.0]}, "its flanks meet below the tip circle", {3}),
        ({"cam.roller": "9 mm"}, "cusp", {4}),
        seldom({"cycle.force_position": "12"}, "there is no position 12", {1}),
    ],
)  # fmt: skip
def test_what_cannot_be_built_costs_nothing_else(changes, said, refused, tmp_path, monkeypatch, capsys):
    """Every other sheet is there, byte for byte as built alone, and every other part is solved."""
    file = write(tmp_path, SHAPER, changes)
    work = tmp_path / "work"
    work.mkdir()
    monkeypatch.chdir(work)
    assert run(["check", file]) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count(said) == 1
    sound = sorted({1, 2, 3, 4} - refused)
    for words in (["build", file, "-o", "out", "--format", "svg"], ["protocol", file], ["solve", file, "--json", "-"]):
        assert run(words) == 1
        captured = capsys.readouterr()
        assert captured.err.count(said) == 1
        assert captured.err.count("\n") <= 8
        assert "internal error" not in captured.err
        if words[0] == "build":
            assert captured.out.split() == [f"out/sheet{n}.svg" for n in sound]
            assert all(f"sheet {n} (" in captured.err for n in refused)
        else:
            assert captured.out
    tree = json.loads(captured.out)
    assert all(said in reason for reason in tree["not_computed"].values())
    assert not tree["not_computed"].keys() & tree.keys()
    assert set(listing(work)) == {"out", *(f"out/sheet{n}.svg" for n in sound), "out/.tmm-sheets.json"}
    assert run(["build", file, "-o", "alone", "--format", "svg", *(f"--sheet={n}" for n in sound)]) == 0
    for n in sound:
        assert Path(f"out/sheet{n}.svg").read_bytes() == Path(f"alone/sheet{n}.svg").read_bytes()
    assert run(["build", file, "-o", "none", f"--sheet={min(refused)}"]) == 1
    assert not Path("none").exists()


def test_sheets_in_part_are_remembered_rightly(tmp_path, capsys, composed):
    """Built again, the sound sheets are unchanged and the other is still told; mended, only what depends on the change is new."""
    bad, out = {"cam.roller": "9 mm"}, tmp_path / "out"
    words = ["build", write(tmp_path, SHAPER, bad), "-o", str(out), "--format", "svg"]
    assert run(words) == 1
    first = capsys.readouterr()
    times = {p.name: p.stat().st_mtime_ns for p in out.iterdir()}
    assert run(words) == 1
    again = capsys.readouterr()
    assert again.out == first.out
    assert "3 of 3 files unchanged" in again.err
    assert first.err in again.err
    assert {p.name: p.stat().st_mtime_ns for p in out.iterdir()} == times
    write(tmp_path, SHAPER)
    composed.clear()
    assert run(words) == 0
    assert {*composed} <= {4}
    assert {p.name for p in out.glob("*.svg")} == {f"sheet{n}.svg" for n in (1, 2, 3, 4)}
    # The file of a sheet that cannot be drawn any more is not passed off as new.
    capsys.readouterr()
    good = (out / "sheet4.svg").read_bytes()
    write(tmp_path, SHAPER, bad)
    assert run(words) == 1
    told = capsys.readouterr()
    assert "sheet4.svg: left as they were made before" in told.err
    assert "sheet4" not in told.out
    assert (out / "sheet4.svg").read_bytes() == good


@pytest.fixture
def composed():
    """Numbers of the sheets that are composed, not read: a list that grows."""
    found, whole = [], composing.composed
    with pytest.MonkeyPatch.context() as patch:  # a plain one: what is noted changes no sheet, kept ones serve
        patch.setattr(composing, "composed", lambda project, n: found.append(n) or whole(project, n))
        yield found


def pages(path):
    return len(re.findall(rb"/Type /Page\n|/Type /Page ", path.read_bytes()))


def test_all_sheets_in_one_pdf(tmp_path, capsys):
    """A sheet that cannot be drawn is not in it, and it is not current then."""
    out = tmp_path / "out"
    words = ["-o", str(out), "--format", "pdf,svg", "--one-file"]
    assert run(["build", write(tmp_path, SHAPER, {"cam.roller": "9 mm"}), *words]) == 1
    assert listing(out) == [RECORD, "sheet1.svg", "sheet2.svg", "sheet3.svg", "sheets.pdf"]
    assert pages(out / "sheets.pdf") == 3
    capsys.readouterr()
    assert run(["build", write(tmp_path, SHAPER), *words]) == 0
    assert capsys.readouterr().out.split() == [str(out / name) for name in ("sheets.pdf", *(f"sheet{n}.svg" for n in (1, 2, 3, 4)))]
    assert pages(out / "sheets.pdf") == 4
    assert run(["build", write(tmp_path, SHAPER), *words]) == 0
    assert "5 of 5 files unchanged" in capsys.readouterr().err
    assert run(["build", write(tmp_path, SHAPER), "--sheet", "2", *words]) == 0
    assert pages(out / "sheets.pdf") == 1
    assert run(["build", write(tmp_path, SHAPER), "--format", "svg", "--one-file", "-o", str(out)]) == 2
    assert "--one-file is for PDF" in capsys.readouterr().err


def test_a_reducer_without_a_solution(tmp_path, capsys):
    """Manual 003: the two other sheets do not need it; alone they are done without a word."""
    name = "transport/compressor@09-В-999"
    assert run(["build", name, "-o", str(tmp_path), "--format", "svg"]) == 1
    captured = capsys.readouterr()
    assert captured.out.count("\n") == 2
    assert "sheet 3 (gear_reducer) cannot be drawn: reducer: no tooth set" in captured.err
    assert run(["build", name, "-o", str(tmp_path / "1"), "--format", "svg", "--sheet", "1"]) == 0
    assert capsys.readouterr().err == ""
    assert run(["solve", name, "--json", "-"]) == 1
    captured = capsys.readouterr()
    tree = json.loads(captured.out)
    assert {"positions", "forces", "cam"} <= tree.keys()
    assert not {"gear", "reducer"} & tree.keys()
    assert set(tree["not_computed"]) == {"gear", "reducer"}
    assert captured.err.startswith("gear, reducer cannot be computed: reducer: no tooth set")
    assert run(["solve", name, "--part", "reducer"]) == 1
    assert capsys.readouterr().out == ""
    assert run(["solve", name, "--part", "cam,positions"]) == 0


def test_rod_too_short_in_some_positions(tmp_path, capsys):
    """The pin rises 0.34 m over the guide, the rod reaches 0.3 m: positions with sin > 0.6 fail."""
    file = write(tmp_path, SLIDER, EVEN, {"guide[1].through": ["0 m", "-0.24 m"], "group[1].length": "0.3 m"})
    for words in (["check"], ["build", "-o", str(tmp_path / "out")], ["solve"]):
        assert run([words[0], file, *words[1:]]) == 1
        captured = capsys.readouterr()
        assert "group 2-3 does not assemble at positions 2, 3, 4: rod AB = 300 mm is 40 mm too short" in captured.err
        assert captured.out == ""
    assert not (tmp_path / "out").exists()
    # Asked for angle by angle, what cannot be assembled is null and the rest is there: B is sqrt(0.3^2 - 0.24^2) from O's foot.
    assert run(["solve", file, "--phi", "90,0", "--part", "positions", "--json", "-"]) == 0
    b = json.loads(capsys.readouterr().out)["positions"]["points"]["B"]
    assert b == [[None, None], pytest.approx([0.28, -0.24], rel=1e-14)]


# --- build ----------------------------------------------------------------------------------------------------------


def test_default_folder_and_formats(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run(["build", "lugansk/shaper", "--sheet", "3", "--sheet", "4"]) == 0
    names = ["sheet3.dxf", "sheet3.pdf", "sheet4.dxf", "sheet4.pdf"]
    there = sorted([RECORD, *names, "OFL.txt", "TMMSheetsB.ttf"])
    assert listing(tmp_path) == ["out", "out/lugansk-shaper", *(f"out/lugansk-shaper/{name}" for name in there)]
    assert sorted(capsys.readouterr().out.split()) == [f"out/lugansk-shaper/{name}" for name in names]
    assert (tmp_path / "out/lugansk-shaper/sheet3.pdf").read_bytes()[:5] == b"%PDF-"


def test_all_sheets(tmp_path, capsys):
    assert run(["build", "lugansk/shaper", "--format", "pdf", "-o", str(tmp_path)]) == 0
    assert listing(tmp_path) == [RECORD, "sheet1.pdf", "sheet2.pdf", "sheet3.pdf", "sheet4.pdf"]
    assert capsys.readouterr().err == ""


def test_same_bytes_every_time(tmp_path):
    for n in "12":
        assert command("build", "lugansk/shaper", "--sheet", "3", "-o", tmp_path / n).returncode == 0
    for name in ("sheet3.dxf", "sheet3.pdf"):
        assert (tmp_path / "1" / name).read_bytes() == (tmp_path / "2" / name).read_bytes()


def test_full_disk(tmp_path, monkeypatch, capsys):
    def write(path, data):
        path.touch()
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Path, "write_bytes", write)
    assert run(["build", "lugansk/shaper", "--sheet", "3", "-o", str(tmp_path)]) == 2
    assert "no space left on device" in capsys.readouterr().err
    assert listing(tmp_path) == []


def test_scale_factors_of_the_project_file(tmp_path, capsys):
    file = write(tmp_path, SHAPER, {"scales": {"positions": 0.005}})
    assert run(["protocol", file, "--plan", "positions"]) == 0
    assert "μ_l = 0,005 м/мм" in capsys.readouterr().out
    file = write(tmp_path, from_file("lugansk/cam_flat"), {"scales": {"position": 0.005}})
    assert run(["build", file, "-o", str(tmp_path / "out")]) == 2
    assert "scales.position: no sheet draws a plan of this name" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_output_folder_that_is_a_file(tmp_path, capsys):
    (tmp_path / "out").touch()
    assert run(["build", "lugansk/shaper", "-o", str(tmp_path / "out")]) == 2
    assert "out: expected a folder, this is a file" in capsys.readouterr().err


ALONE = """
import sys
from tmm_sheets import catalogue
from tmm_sheets.project import Project
from tmm_sheets.sheets import sheet
project = Project(catalogue.read("lugansk/shaper"))
sheet.composed(project, {n}).drawing
print(" ".join(m for m in sys.modules if m.startswith("tmm_sheets.")))
print(" ".join(name for name, plans in project.plans.items() if plans is not None))
print(" ".join(p.name for plans in project.plans.values() if plans for p in plans.values() if any(s.evaluated for s in p)))
"""


@pytest.mark.parametrize(("n", "part", "only"), [(3, "gear", {"gear"}), (4, "cam", {"cam"})])
def test_one_sheet_alone(n, part, only):
    """A gear or cam sheet imports and evaluates nothing of the linkage, the flywheel or the other."""
    done = subprocess.run([sys.executable, "-c", ALONE.format(n=n)], capture_output=True, text=True, check=True,
                          env={**os.environ, "PYTHONPATH": str(ROOT), "TMM_SHEETS_CACHE": ""}, timeout=60)  # fmt: skip
    modules, built, evaluated = (line.split() for line in done.stdout.splitlines())
    foreign = ("positions", "velocities", "accelerations", "forces", "zhukovsky", "study", "cycle", "reduced", "flywheel",
               "energy_mass", {"gear": "cam", "cam": "gear"}[part])  # fmt: skip
    run = [m for m in modules if m.startswith(("tmm_sheets.methods.", "tmm_sheets.sheets."))]
    assert [m for m in run if m.rpartition(".")[2].startswith(foreign)] == []
    assert "tmm_sheets.mechanism" not in modules
    assert set(built) == only
    assert evaluated


def test_explain(tmp_path, capsys):
    assert run(["build", "lugansk/shaper", "--sheet", "3", "--explain", "--no-cache", "-o", str(tmp_path)]) == 0
    out = capsys.readouterr().out
    assert "flywheel: not built\n" in out
    assert "gear: built\n" in out
    assert "cam: not built\n" in out
    assert "numpy" in out
    row = next(line.split() for line in out.splitlines() if line.startswith("  gear-engagement"))
    steps, evaluated, skipped = map(int, row[1:4])
    assert steps == evaluated + skipped
    assert evaluated > 0


# --- solve ----------------------------------------------------------------------------------------------------------


def solved(capsys, *arguments):
    assert run(["solve", "lugansk/shaper", "--json", "-", *arguments]) == 0
    return json.loads(capsys.readouterr().out)


def test_solve_all(tmp_path, capsys):
    """Position 2 is 72° from position 0, where the independent solver has it: the strokes are divided as the manual does."""
    assert run(["solve", write(tmp_path, SHAPER, {"cycle.division": "nominal"}), "--json", "-"]) == 0
    tree = json.loads(capsys.readouterr().out)
    assert tree["schema"] == 1
    assert (tree["project"], tree["variant"]) == ("lugansk/shaper", "пример 1")
    groups = [{"links": ["2", "3"], "class": 2, "order": 2, "kind": 3}, {"links": ["4", "5"], "class": 2, "order": 2, "kind": 5}]
    assert {k: tree["structure"][k] for k in ("W", "class", "groups")} == {"W": 1, "class": 2, "groups": groups}
    assert tree["cycle"]["labels"] == [str(i) for i in range(10)]
    assert tree["cycle"]["omega1"] == pytest.approx(-7.5398223686155035, rel=1e-15)
    # Values of an independent solver, six digits: V_B3, V_D, eps3, F54, F30, F1.
    assert abs(complex(*tree["velocities"]["points"]["D"][2])) == pytest.approx(0.92076, abs=5e-6)
    assert abs(tree["velocities"]["omega"]["3"][2]) == pytest.approx(1.62678, abs=5e-6)
    assert abs(tree["accelerations"]["epsilon"]["3"][2]) == pytest.approx(3.67017, abs=5e-6)
    assert tree["forces"]["label"] == ["2"]
    assert abs(complex(*tree["forces"]["reactions"]["F54"][0])) == pytest.approx(2981.64, abs=5e-3)
    assert abs(complex(*tree["forces"]["reactions"]["F30"][0])) == pytest.approx(2175.52, abs=5e-3)
    assert tree["forces"]["arms"]["h50"][0] == pytest.approx(0.11338, abs=5e-6)
    balancing = tree["forces"]["balancing"]
    assert balancing["kind"] == "force"
    assert balancing["kinetostatics"][0] == pytest.approx(7744.884, abs=5e-4)
    assert balancing["lever"][0] == pytest.approx(balancing["kinetostatics"][0], rel=1e-12)
    assert tree["flywheel"]["J_flywheel_converged"] == pytest.approx(315.8, abs=0.05)
    assert tree["gear"]["m"] == 3.5
    assert tree["cam"]["r0"] == pytest.approx(8.86465e-3, abs=5e-9)
    assert tree["scales"]["mu_A"]["unit"] == "J/mm"


CONTRACT = {
    "positions": {"points", "angles"},
    "velocities": {"points", "omega"},
    "accelerations": {"points", "epsilon"},
    "forces": {"label", "reactions", "couples", "arms", "balancing"},
    "flywheel": {"method", "M_reduced", "work", "M_constant", "delta_E", "J_reduced", "ab_mm", "J_flywheel",
                 "J_flywheel_converged", "D", "B", "m"},
    "gear": {"z1", "z2", "m", "x1", "x2", "alpha_w", "a_w", "y", "dy", "r1", "r2", "rb1", "rb2", "rw1", "rw2", "ra1", "ra2",
             "rf1", "rf2", "s1", "s2", "sa1", "sa2", "p", "eps_alpha", "theta1", "theta2"},
    "cam": {"phi", "s", "ds", "dds", "r0", "e", "s0", "r_roller", "rho_min", "pressure_angle", "pitch_curve", "profile"},
}  # fmt: skip


@pytest.mark.parametrize("part", CONTRACT)
def test_one_part_alone(part, capsys):
    tree = solved(capsys, "--part", part)
    assert CONTRACT[part] <= set(tree[part])
    assert set(CONTRACT) & set(tree) == {part}


def test_positions_and_angles(capsys):
    """The same angles asked for in both ways give the same numbers, one entry each."""
    tree = solved(capsys, "--part", "positions,forces", "--positions", "4")
    degrees = [phi * 180 / 3.141592653589793 for phi in tree["cycle"]["phi"]]
    same = solved(capsys, "--part", "positions,forces", "--phi", ",".join(map(repr, degrees)))
    assert tree["forces"]["label"] == ["0", "1", "2", "3"]
    for a, b in zip(tree["positions"]["points"]["D"], same["positions"]["points"]["D"], strict=True):
        assert a == pytest.approx(b, rel=1e-12)
    assert len(same["forces"]["balancing"]["lever"]) == 4
    b = solved(capsys, "--part", "positions", "--phi", "90")["positions"]["points"]["B"]
    assert b == [pytest.approx([0.0, 0.08], abs=1e-16)]


def test_solve_imports_no_drawing():
    code = "import sys; from tmm_sheets.__main__ import run; run(['solve', 'lugansk/shaper']); print(*sys.modules, sep='\\n')"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60,
                          env={**os.environ, "PYTHONPATH": str(ROOT)})  # fmt: skip
    loaded = set(done.stdout.splitlines())
    assert "tmm_sheets.results" in loaded
    # Scale factors follow from the places on the sheets, and these from what all views of the sheet need.
    views = ("linkage.kinematics", "linkage.kinetics", "cams.cam", "gears.gear", "flywheel.flywheel", "flywheel.mertsalov",
             "gears.train", "sheet")
    assert loaded & {f"tmm_sheets.sheets.{m}" for m in views} == set()
    assert {m for m in loaded if m.startswith(("tmm_sheets.drawing.labels", "tmm_sheets.backends"))} == set()
    assert loaded & {"shapely", "ezdxf", "reportlab", "matplotlib"} == set()


def test_json_file(tmp_path, capsys):
    assert run(["solve", "lugansk/shaper", "--part", "gear", "--json", str(tmp_path / "a" / "r.json")]) == 0
    assert json.loads((tmp_path / "a" / "r.json").read_text(encoding="utf-8"))["gear"]["z2"] == 28
    assert capsys.readouterr().out == ""


def test_sections_left_out(tmp_path, capsys):
    file = write(tmp_path, SHAPER, {"gear": None})
    assert run(["solve", file, "--json", "-"]) == 0
    assert "gear" not in json.loads(capsys.readouterr().out)
    assert run(["solve", file, "--part", "gear"]) == 2
    assert 'has no part "gear"' in capsys.readouterr().err
    assert run(["build", file, "--sheet", "4"]) == 2
    assert "has sheets 1 to 3" in capsys.readouterr().err


# --- protocol -------------------------------------------------------------------------------------------------------


def test_protocol_of_one_plan(capsys):
    """The crank and the rocker of position 2 in millimetres of the sheet: 0.08 m and 0.566 m by the scale in the heading."""
    assert run(["protocol", "lugansk/shaper", "--plan", "positions"]) == 0
    heading, *said = capsys.readouterr().out.splitlines()
    match = re.fullmatch(r"Планы положений механизма \(positions\), положение 2; μ_l = ([\d,]+) м/мм", heading)
    mu = float(match[1].replace(",", "."))
    for length in (0.08, 0.566, 0.283):
        assert any(f"{length / mu:.1f}".replace(".", ",") + " мм" in line for line in said), length
    assert [line.split(".")[0].strip() for line in said] == [str(i + 1) for i in range(len(said))]


def test_protocol_of_all_plans(capsys):
    assert run(["protocol", "lugansk/shaper"]) == 0
    out = capsys.readouterr().out
    for plan in ("positions", "velocities", "accelerations", "force-5", "lever", "energy-mass", "gear-engagement", "cam-zone"):
        assert f"({plan})" in out
    assert "nan" not in out
    assert not re.search(r"\d\.\d", out), "a decimal point in Russian text"


# --- the last output ------------------------------------------------------------------------------------------------


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
@pytest.mark.parametrize(("arguments", "unbuffered"), few(
    product((["solve", "lugansk/shaper", "--part", "gear"], ["--version"], ["list"]), ("", "1")),
    (["solve", "lugansk/shaper", "--part", "gear"], ""), (["--version"], ""), (["list"], "1")))
def test_standard_output_is_full(arguments, unbuffered, monkeypatch):
    """A full buffer fails when it is flushed, and once more at the end; without one every line does."""
    monkeypatch.setenv("PYTHONUNBUFFERED", unbuffered)
    with open("/dev/full", "w") as full:
        done = command(*arguments, capture_output=False, stdout=full, stderr=subprocess.PIPE)
    assert done.returncode == 2
    assert done.stderr == "output cannot be written: no space left on device\n"


def test_reader_that_goes_away_is_no_news():
    read, write = os.pipe()
    os.close(read)
    done = command("list", capture_output=False, stdout=write, stderr=subprocess.PIPE)
    os.close(write)
    assert (done.returncode, done.stderr) == (141, "")


def test_interrupt_is_quiet(monkeypatch, capsys):
    def interrupted(project, corrected):
        raise KeyboardInterrupt

    monkeypatch.setattr(catalogue, "read", interrupted)
    assert run(["check", "lugansk/shaper"]) == 130
    assert capsys.readouterr() == ("", "")


def test_a_defect_shows_no_traceback(monkeypatch, capsys):
    def broken(project, corrected):
        raise ZeroDivisionError("nobody thought of this")

    monkeypatch.setattr(catalogue, "read", broken)
    assert run(["check", "lugansk/shaper"]) == 1
    err = capsys.readouterr().err
    assert err.startswith("internal error: ZeroDivisionError: nobody thought of this\n")
    assert "Traceback" not in err


# --- suspected misprints --------------------------------------------------------------------------------------------


def test_misprints_are_told_and_the_printed_value_is_used(capsys):
    assert run(["show", "sixbar/5:2"]) == 0
    out, err = capsys.readouterr()
    assert re.search(r"points\.O3 +0 m, -0\.21 m", out)
    assert err.count("\n") == 2
    assert err.startswith("sixbar/5:2: a, 2: 0.21 m is probably a misprint of 0.27 m (")


def test_corrected_takes_the_suggested_value(capsys):
    assert run(["show", "sixbar/5:2", "--corrected"]) == 0
    assert re.search(r"points\.O3 +0 m, -0\.27 m +001, task 5, variant 2: a, printed 0\.21", capsys.readouterr().out)


def test_project_file_of_a_variant_is_a_project(tmp_path, capsys):
    """What show --file prints can be changed and used as one's own."""
    assert run(["show", "sixbar/3:2", "--file"]) == 0
    own = tmp_path / "own.toml"
    own.write_text(capsys.readouterr().out, encoding="utf-8")
    assert run(["check", str(own)]) == 0
