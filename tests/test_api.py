"""A project in Python: docs/python.md and the notebook do what they say, numbers are those of the commands, messages too."""

import csv
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import tmm_sheets
from tests import notebook
from tests.project_files import EVEN, FOUR_BAR
from tmm_sheets import catalogue, results, words
from tmm_sheets.project import Project
from tmm_sheets.task import variant

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def p():
    return tmm_sheets.open("lugansk/shaper")


def filled(p, folder, **off):
    """A table of what velocities of position 2 measure, right but for those that are ``off``, mm."""
    path = p.template(folder)
    table = path.read_text("utf-8-sig").splitlines()

    def judged(measured):
        path.write_text("\n".join(line + measured(line.split(",")[3].strip("|")) if line.startswith("velocities/2/") else line
                                  for line in table), encoding="utf-8")
        return p.compare(path)

    right = {f["quantity"].strip("|"): f["expected"] for f in judged(lambda name: "50") if "quantity" in f}
    return judged(lambda name: f"{right[name] + off.get(name, 0):.2f}")


def test_importing_loads_next_to_nothing():
    code = "import sys, tmm_sheets; print(*(m for m in sys.modules if m.partition('.')[0] in ('tmm_sheets', 'numpy', 'click')))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert {*done.stdout.split()} == {"tmm_sheets", "tmm_sheets.version"}
    assert (Path(tmm_sheets.__file__).parent / "py.typed").is_file()
    assert {"open", "new", "projects", "BadInput"} <= {*dir(tmm_sheets)}
    with pytest.raises(AttributeError):
        tmm_sheets.shut


def test_numbers_are_those_of_solve(p):
    n = p.numbers(phi_deg=[30, 75])
    told = results.assemble(Project(catalogue.read("lugansk/shaper")), None, phi=tuple(np.radians([30, 75]).tolist()))
    assert n.tree == told
    assert n["velocities.points.B"].tolist() == told["velocities"]["points"]["B"]
    assert n["flywheel.J_flywheel"] == told["flywheel"]["J_flywheel"]
    assert p.numbers("positions", phi=np.radians([30, 75])).tree["positions"] == told["positions"]
    assert len(p.numbers("positions", positions=7)["positions.points.B"]) == 7
    with pytest.raises(tmm_sheets.BadInput, match="one of phi"):
        p.numbers(phi=[1], positions=7)
    with pytest.raises(tmm_sheets.BadInput, match=r"did you mean velocities\.points\.B"):
        n["velocities.point.B"]
    with pytest.raises(tmm_sheets.BadInput, match="no part"):
        p.numbers("reducer")


HUGE, LONG = 10**400, "a" * 5000
STRANGE = {
    "open": (tmm_sheets.open, ("", "\0", LONG, "..", "a\nb", Path("x"))),
    "language": (lambda p, v: tmm_sheets.open("lugansk/cam_flat", language=v), ("x", "\0", LONG)),
    "student": (lambda p, v: tmm_sheets.open("lugansk/cam_flat", student=v), ("\0", LONG, "🙂")),
    "new": (lambda p, v: tmm_sheets.new("m", gear=v), (b"x", object(), Path("x"), [None], 1j, HUGE, {}, np.zeros((2, 2)))),
    "with a value": (lambda p, v: p.with_(crank__length=v), (b"x", [1j], [None], HUGE, -1, float("nan"), "", {}, np.array(["x"]))),
    "with a key": (lambda p, v: p.with_({v: 1}), ("", "\0", LONG, "a[" + "9" * 5000 + "]", "crank.length.x", "🙂")),
    "numbers": (lambda p, v: p.numbers(v), ("", "x", LONG, "🙂")),
    "one": (lambda p, v: p.numbers("positions")[v], ("", "x", LONG)),
    "phi": (lambda p, v: p.numbers("positions", phi=v), (HUGE, "x", [[1], [2, 3]], 1j)),
    "phi_deg": (lambda p, v: p.numbers("positions", phi_deg=v), (HUGE, "x")),
    "positions": (lambda p, v: p.numbers("positions", positions=v), (0, -1, HUGE, float("nan"), float("inf"))),
    "why": (lambda p, v: p.why(v), ("", "x", LONG, "\0", "cam")),
    "protocol": (lambda p, v: p.protocol(v), ("", "x", "\0")),
    "sheet": (lambda p, v: p.sheet(v), (0, -1, HUGE, 9)),
    "view": (lambda p, v: p.view(v), ("\0", "there is no such")),
    "plan": (lambda p, v: p.animate((4,), v), ("x", "\0")),
    "folder": (lambda p, v: p.build(v, formats=["svg"], sheets=[4]), ("\0", LONG, "ftp:x")),
    "format": (lambda p, v: p.build("o", formats=[v]), ("", "x", "\0", "..", LONG)),
    "sheets": (lambda p, v: p.build("o", formats=["svg"], sheets=[v]), (0, -1, HUGE)),
    "compare": (lambda p, v: p.compare(v), ("", LONG, "x.dxf", "..")),
    "template": (lambda p, v: p.template(v), ("\0", LONG)),
    "save": (lambda p, v: p.save(v), ("", "\0", LONG)),
    "picture": (lambda p, v: p.sheet(4).rendered(v), ("", "x", "\0", "..")),
    "dpi": (lambda p, v: p.sheet(4).rendered("png", dpi=v), (0, -1, 1e9, float("nan"))),
    "least": (lambda p, v: p.optimise({"crank.length": "70..90 mm"}, v), ("x", "\0", "(" * 300, LONG)),
    "vary": (lambda p, v: p.optimise([v], "max positions.points.C.x"), ("", "x", "crank.length=2..1 mm", "crank.length=0..inf m")),
    "tries": (lambda p, v: p.optimise({"crank.length": "70..90 mm"}, "max positions.points.C.x", tries=v), (-1, HUGE)),
}  # fmt: skip


@pytest.mark.parametrize(("of", "n"), [(of, n) for of, (_, values) in STRANGE.items() for n in range(len(values))])
def test_an_odd_value_is_refused_in_words(p, of, n, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    call, values = STRANGE[of]
    with pytest.raises((tmm_sheets.BadInput, tmm_sheets.CannotBuild), match=r"\w"):
        call(*((values[n],) if of == "open" else (p, values[n])))
    assert [*tmp_path.iterdir()] == []



def test_columns_are_those_of_the_table(p, tmp_path):
    from tmm_sheets.result_files import write_csv

    n = p.numbers()
    with (tmp_path / "n.csv").open("wb") as file:
        write_csv(n.told, file)
    head, *rows = csv.reader((tmp_path / "n.csv").read_text("utf-8").splitlines())
    assert head == [*n.columns]
    for name, column in zip(head, zip(*rows, strict=True), strict=True):
        assert [*column] == ["" if x != x else str(x) for x in n.columns[name]]
    assert p.numbers("gear").columns == {}


def test_a_part_that_cannot_be_computed_costs_no_other():
    bars = tmm_sheets.new("own", **FOUR_BAR, gear={
        "teeth": [5, 28], "module": "3.5 mm", "shift": "rule", "pressure_angle": "20 deg"})
    n = bars.numbers()
    assert len(n["positions.points.B"])
    with pytest.raises(tmm_sheets.CannotBuild) as e:
        n["gear.a_w"]
    assert str(e.value) == str(n.refused["gear"])


@pytest.mark.parametrize("asked", [{}, {"phi_deg": 280.7}, {"phi": [1.0, 4.9]}, {"positions": 7}])
def test_what_solve_refuses_has_no_numbers_at_other_angles_either(asked):
    p = tmm_sheets.open(Path(__file__).parent / "methods" / "linkage" / "kite_once_a_turn.toml")
    with pytest.raises(tmm_sheets.CannotBuild, match="change point"):
        p.numbers("positions", **asked)


def test_other_values_are_those_of_another_file(p):
    q = p.with_({"points.C": ("0 m", "-0.25 m")}, crank__length="60 mm", cam=None)
    parts = ("positions", "flywheel")
    assert results.assemble(Project(variant.parse(q.text, "again")), parts) == q.numbers(*parts).tree
    assert "cam" not in q.project.parts
    assert 'length = "60 mm"\n' in q.text  # the source of the number before is gone
    assert "# steady running" in q.text
    assert p.text == catalogue.read("lugansk/shaper").text
    assert p.with_().text == p.text
    assert q.project.variant.shipped


@pytest.mark.parametrize(("project", "name", "unit", "spread"), [
    ("lugansk/shaper", "crank.length", "mm", (76, 84)), ("lugansk/shaper", "crank.speed", "rpm", (60, 90)),
    ("four-bar", "crank.length", "mm", (50, 900)), ("sixbar/1:1", "crank.length", "m", (0.01, 0.9))])
def test_a_sweep_is_many_projects_with_other_values(project, name, unit, spread):
    """Where one of them cannot be built it has no numbers at the angles at which it does not assemble."""
    own = tmm_sheets.new(**FOUR_BAR, **EVEN) if project == "four-bar" else tmm_sheets.open(project)
    found = own.sweep(name, f"{spread[0]}..{spread[1]} {unit}", 6)
    n = len(own.project.cycle.labels)
    assert {len(column) for column in found.values()} == {6 * n}
    assert found.keys() == found.units.keys()
    assert (found.units[name], found[name][0], found[name][-1]) == (unit, *spread)
    whole = 0
    for k in range(6):
        here = slice(k * n, (k + 1) * n)
        try:
            other = own.with_({name: f"{found[name][k * n]} {unit}"})
            told = other.numbers("positions", "velocities", "accelerations", phi=found["cycle.phi"][here]).columns
        except tmm_sheets.CannotBuild:
            assert any(np.isnan(column[here]).any() for column in found.values())
            continue
        whole += 1
        for path in told.keys() & found.keys() - {"cycle.phi"}:
            most = np.nanmax(np.abs(told[path]), initial=1e-3)
            assert np.allclose(found[path][here], told[path], rtol=1e-9, atol=1e-9 * most,
                               equal_nan=True), path
    assert whole


def test_a_sweep_of_one_and_of_none(p):
    one = p.sweep("crank__length", "40..49 mm", 1, "velocities", phi_deg=30)
    assert one["crank.length"].tolist() == [40.0]
    assert one.units["velocities.points.D.y"] == "m/s"
    assert not any(path.startswith("positions") for path in one)
    for asked in (("crank.length", "40..49 mm", 0), ("crank.length", "49..40 mm"), ("points.C", "0..1 m"),
                  ("crank.length", "40..49 mm", 5, "forces")):
        with pytest.raises(tmm_sheets.BadInput):
            p.sweep(*asked)
    with pytest.raises(tmm_sheets.CannotBuild, match=re.escape("crank.lenght")):
        p.sweep("crank.lenght", "40..49 mm")
    with pytest.raises(tmm_sheets.CannotBuild, match="it is found"):  # by the synthesis
        tmm_sheets.open("lugansk/engine").sweep("crank.length", "50..60 mm")


def test_only_what_hangs_on_it_is_computed_again(p):
    p.numbers("gear", "cam")
    q = p.with_(crank__length="60 mm", gear__module="4 mm")
    assert q.project.gear is not p.project.gear
    assert q.project.cam is p.project.cam
    assert "study" not in vars(q.project)
    diesel = tmm_sheets.open("transport/diesel@01-Т-27")
    diesel.numbers("gear", "reducer")
    assert diesel.with_(crank__length="0.1 m").project.gear is diesel.project.gear
    assert "gear" not in vars(diesel.with_(reducer__satellites=4).project)


@pytest.mark.parametrize(("changes", "said"), [
    ({"crank__length": 60}, r"lugansk/shaper:27: crank\.length: expected a length with its unit, not the bare number 60"),
    ({"crank__lenght": "60 mm"}, "did you mean"), ({"group[7].kind": 1}, "no such place"), ({"crank.length.x": 1}, "no such place"),
    ({"group[0].outer[5]": "B"}, "no such place"), ({"nothing": None}, "no such place"),
])
def test_what_cannot_be_changed(p, changes, said):
    with pytest.raises(tmm_sheets.BadInput, match=said):
        p.with_(changes)


def test_a_mechanism_made_here():
    bars = tmm_sheets.new("own", **FOUR_BAR)
    assert bars.numbers("positions").tree["structure"]["W"] == 1
    assert np.isfinite(bars.numbers("positions", positions=9)["positions.points.B"]).all()
    longer = bars.with_(group__0__lengths__1="0.26 m")
    assert longer.project.variant.group[0].lengths == (0.4, 0.26)
    with pytest.raises(tmm_sheets.BadInput, match=r"own\.toml:\d+: crank\.length"):
        bars.with_(crank__length=np.float64(0.1))


def test_sheets_and_views(p, tmp_path):
    sheet = p.sheet(1)
    assert sheet.svg.encode() == (p.build(tmp_path / "a", formats=["svg"], sheets=[1])[0]).read_bytes()
    view = p.view("accelerations", position=2)
    assert view.plans == (("accelerations", "2"),)
    assert view.drawing.width < sheet.drawing.width
    assert p.view("энергомасс").drawing.title == "Диаграмма энергомасс"
    for name, begins in (("v.pdf", b"%PDF"), ("v.png", b"\x89PNG"), ("v.dxf", b"  0"), ("v.plt", b""), ("v.svg", b"<?xml")):
        assert view.save(tmp_path / name).read_bytes().startswith(begins)
    with pytest.raises(tmm_sheets.BadInput, match=r"\.plt"):
        view.save(tmp_path / "v.doc")
    with pytest.raises(tmm_sheets.BadInput, match="there are 2"):
        p.view("accelerations", position=3)
    with pytest.raises(tmm_sheets.BadInput, match="there are accelerations"):
        p.view("acelerations")
    with pytest.raises(tmm_sheets.BadInput, match="no sheet 9"):
        p.sheet(9)


def test_language_and_names(tmp_path):
    before = words.paper()
    p = tmm_sheets.open("lugansk/cam_flat", language="en", student="Carnot")
    assert p.view("profile").drawing.title == "Construction of the cam profile"
    assert p.record["lang"] == "en"
    assert "Carnot" in str([m.text for m in p.sheet(1).drawing.marks if hasattr(m, "text")])
    assert words.paper() == before


def test_a_page_in_a_frame(p, tmp_path):
    page = p.animate(sheets=[3])
    assert page.lower().startswith("<!doctype html>")
    assert page._repr_html_().lower().startswith('<iframe srcdoc="&lt;!doctype')
    assert page.save(tmp_path / "p.html").read_text("utf-8") == page
    assert len(repr(page)) < 50


def test_a_drawing_is_judged(p, tmp_path):
    right = filled(p, tmp_path / "right")
    assert {f["verdict"] for f in right} == {"green"}
    assert right.start == []
    wrong = filled(p, tmp_path / "wrong", pd=6)
    assert len(wrong) == len(right) > 8
    assert [f["step"] for f in wrong.start] == ["velocities/d"]
    assert str(wrong) == wrong.report.text
    assert "<iframe" in wrong._repr_html_()
    with pytest.raises(tmm_sheets.BadInput, match="there is no such file"):
        p.compare("sheet.jpg")


# --- docs -------------------------------------------------------------------------------------------------------------------


class Frame(dict):
    """What docs ask of a DataFrame, where there is no pandas."""

    def set_index(self, name):
        return Frame((key, np.asarray(column)) for key, column in self.items() if key != name)


@pytest.fixture
def pandas(monkeypatch):
    try:
        import pandas
    except ImportError:
        pandas = type(sys)("pandas")
        pandas.DataFrame = Frame
        monkeypatch.setitem(sys.modules, "pandas", pandas)


def test_python_in_docs_runs(p, tmp_path, monkeypatch, pandas, capsys):
    monkeypatch.chdir(tmp_path)
    p.save("my.toml")
    filled(p, ".")
    names = {}
    text = "".join((ROOT / "docs" / paper).read_text("utf-8") for paper in ("python.md", "cookbook.md"))
    blocks = re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    assert len(blocks) > 5
    for block in blocks:
        exec(block, names)
    said = capsys.readouterr().out
    assert "not the bare number 60" in said
    assert "does not assemble at" in said
    assert names["table"]["velocities.points.D.y"].max() > 0


def test_without_pandas(p, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(tmm_sheets.CannotBuild, match="pip install pandas"):
        p.numbers("positions").frame()


def test_the_notebook_says_what_it_says():
    text, rich = notebook.current()
    assert text == notebook.NOTEBOOK.read_text("utf-8"), "run: python -m tests.notebook"
    assert rich == ["_repr_svg_", "_repr_svg_", "_repr_svg_", "_repr_html_", "_repr_svg_"]


@pytest.mark.parametrize(("call", "said"), [
    (lambda: tmm_sheets.open(b"\xff"), "project: expected Path | str, not"), (lambda: tmm_sheets.projects(True),
                                                                              "word: expected str, not True"),
    (lambda: tmm_sheets.open("press").sheet("one"), "number: expected int, not 'one'"),
    (lambda: tmm_sheets.open("press").numbers("gear", positions=float("nan")), "positions: expected int | None, not nan"),
    (lambda: tmm_sheets.open("press").animate([None]), r"sheets: expected Iterable\[int\], not \[None\]"),
    (lambda: tmm_sheets.new(project=1), r"project: expected Mapping\[str, Any\] | None, not 1"),
])  # fmt: skip
def test_an_argument_of_another_type_is_refused_by_its_name(call, said):
    with pytest.raises(tmm_sheets.BadInput, match=said.replace(" | ", r" \| ")):
        call()


def test_numbers_and_texts_of_numpy_are_arguments():
    assert tmm_sheets.open(np.str_("press")).sheet(np.int64(1)).svg == tmm_sheets.open("press").sheet(1).svg
