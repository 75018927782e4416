"""A sheet that is kept is the sheet itself, in every format and for every reader; what was put in its place is none."""

import pickle
import subprocess
import sys
from dataclasses import fields, is_dataclass
from importlib import import_module
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest

from tests.few import few, seldom
from tests.project_files import FOUR_BAR, write
from tmm_sheets import catalogue, kept, words
from tmm_sheets.__main__ import run
from tmm_sheets.project import Project
from tmm_sheets.sheets import composed, composing, composition, sheet
from tmm_sheets.sheets.composed import Answered, Composed
from tmm_sheets.task.variant import parse
from tmm_sheets.words import Remark

SHEETS = [(name, n) for name, count in (("lugansk/shaper", 4), ("press", 4), ("sixbar/8:3", 2), ("transport/press@07-ЭПС-718", 3))
          for n in range(1, count + 1)]  # fmt: skip
TREES = ("visor", "winder", "sieve")
"""Projects of our own with remarks, trains, groups of class III."""


@pytest.fixture
def place(tmp_path, monkeypatch):
    monkeypatch.setenv(kept.FOLDER, str(tmp_path / "kept"))
    return tmp_path / "kept"


def opened(name):
    variant = catalogue.read(name)
    words.set_paper(words.of_project(variant.project.language))
    return Project(variant)


def same(a, b):
    """Whether two values are equal in all they consist of, numbers to the last bit."""
    if isinstance(a, np.ndarray):
        return isinstance(b, np.ndarray) and a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()
    if is_dataclass(a):
        return type(a) is type(b) and all(same(getattr(a, f.name), getattr(b, f.name)) for f in fields(a))
    if isinstance(a, tuple | list):
        return type(a) is type(b) and len(a) == len(b) and all(map(same, a, b))
    if hasattr(a, "items"):
        return list(a) == list(b) and all(same(a[k], b[k]) for k in a)
    if isinstance(a, complex):
        return same(a.real, b.real) and same(a.imag, b.imag)
    return (a == b or a != a != b != b) and isinstance(a, int) == isinstance(b, int)  # 1 and 1.0 are not written alike


@pytest.mark.parametrize(("name", "n"), few(
    [*SHEETS, *((f"tests/projects/{tree}.toml", 1) for tree in TREES)], ("transport/press@07-ЭПС-718", 3), ("lugansk/shaper", 2),
    ("tests/projects/visor.toml", 1)))
def test_it_is_the_sheet_itself(name, n):
    with kept.unused():
        made = sheet.composed(opened(name), n)
    found = composed.loaded(sheet.stored(made), Composed)
    assert same(made, found)
    for form in ("dxf", "pdf", "svg"):
        writer = import_module(f"tmm_sheets.backends.{form}")
        assert writer.render(found.drawing) == writer.render(made.drawing)


def test_what_differs_is_seen():
    """The comparison above can fail."""
    assert not same((1.0, 2), (1.0, 2.0))
    assert not same(np.array([0.0]), np.array([-0.0]))
    assert not same({"a": 1}, {"a": 2})
    assert not same(Remark("a"), Remark("b"))
    assert same((1 + 2j, "a", np.float64(2)), (np.complex128(1 + 2j), "a", 2.0))


def test_remarks_are_kept_as_they_are():
    inner = Remark("group {name}", {"name": "2–3"})
    several = Remark(("{count} plan", "{count} plans"), {"count": 3, "size": 1.5}, 3)
    for remark in (inner, several, Remark("{what}!", {"what": inner})):
        told = composed._Reader(BytesIO(pickle.dumps(remark))).load()
        assert told == remark
        assert str(told) == str(remark)


def test_the_second_time_nothing_is_composed(place, tmp_path, monkeypatch, capsys):
    """Another format, a plot, a comparison of a drawing: all read what the first build has kept."""
    name = "lugansk/cam_flat"
    assert run(["build", name, "--format", "dxf", "-o", str(tmp_path / "a")]) == 0
    monkeypatch.setattr(composing, "composed", lambda *_: pytest.fail("composed a sheet that is kept"))
    assert run(["build", name, "--format", "svg,pdf", "-o", str(tmp_path / "a")]) == 0
    assert run(["plot", name, "--sheet", "1", "-o", str(tmp_path / "a")]) == 0
    made = tmp_path / "a" / "sheet1.dxf"
    assert run(["compare", name, "--sheet", "1", "--dxf", str(made), "-o", str(tmp_path / "a")]) == 0
    # Sheet, arrangement, what was asked of both, outcomes of two builds and a plot; the program, unless known.
    assert len(list(place.iterdir())) in (7, 8)


def test_steps_of_a_kept_sheet_with_details_are_made():
    """Its views are asked again, without the lettering for which a place is enlarged."""
    made = sheet.composed(opened("lugansk/shaper"), 1)
    assert any(part.draw == "details.dense" for part in made.parts)
    project = opened("lugansk/shaper")
    assert same(made, sheet.composed(project, 1, steps=True))
    assert 1 in project.shown


@pytest.mark.parametrize(("name", "words_"), [
    ("lugansk/shaper", ["record", "--sheet", "1", "--json", "-"]), seldom("press", ["record", "--json", "-"]),
    seldom("sixbar/8:3", ["compare", "--template", "--all"]),
    seldom("sixbar/8:3", ["build", "--sheet", "1", "--format", "svg,pdf,dxf"]),
    seldom("tests/projects/pump.toml", ["record", "--json", "-"]), ("lugansk/cam_flat", ["compare", "--template", "--all"]),
    seldom("tests/projects/pump.toml", ["compare", "--template", "--all"]),
    seldom("sixbar/8:3", ["build", "--format", "hpgl,svg,pdf,dxf"]),
    seldom("tests/projects/pump.toml", ["build", "--format", "hpgl,svg,pdf,dxf"])])
def test_every_reader_says_the_same(place, tmp_path, capsys, name, words_):
    """Whether sheets are kept or not, or the answer itself: to the byte."""
    command, *others = words_
    told = []
    for k, more in enumerate((["--no-cache"], [], [])):
        if k == 1 and command != "build":
            sheets = [word for word in others if word in ("--sheet", "1")]
            assert run(["build", name, *sheets, "--format", "svg", "-o", str(tmp_path / "kept")]) == 0
            capsys.readouterr()
        folder = ["-o", str(tmp_path / str(k))] if command in ("build", "compare") else []
        assert run([command, name, *others, *folder, *more]) == 0
        found = sorted((tmp_path / str(k)).glob("[!.]*")) if folder else []
        said = capsys.readouterr()
        told.append((said.out.replace(f"/{k}/", "//"), said.err, [(p.name, p.read_bytes()) for p in found]))
        assert place.exists() == (k > 0)
    assert told[0] == told[1] == told[2]


def test_what_is_warned_of_is_kept(place, tmp_path, capsys):
    path = write(tmp_path, FOUR_BAR, {"title_block": {"student": "A name too long for its cell " * 3}})
    told = []
    for k in range(2):
        assert run(["build", path, "--format", "svg", "-o", str(tmp_path / str(k))]) == 0
        told.append(capsys.readouterr().err)
    assert "no room for all of" in told[0]
    assert told[0] == told[1]


@pytest.mark.parametrize("data", [
    b"", b"\0\0\0\2{}", b"\xff" * 40, *map(pickle.dumps, (None, {}, Remark("a"), subprocess.call, np.memmap, Path("a")))])
def test_other_bytes_are_no_sheet(data):
    assert composed.loaded(data, Composed) is None


def test_a_sheet_cut_short_is_none():
    data = sheet.stored(sheet.composed(opened("sixbar/8:3"), 1))
    assert composed.loaded(data, Composed) is not None
    for end in (10, len(data) // 3, len(data) // 2, len(data) - 16, len(data) - 8, len(data) - 1):
        assert composed.loaded(data[:end], Composed) is None
    assert composed.loaded(data + bytes(16), Composed) is None


def test_only_the_same_answers_find_what_was_kept(place, monkeypatch):
    def found(project, n=1):
        return [*Answered(project, n, "sheet").found()]

    variant = catalogue.read("press")
    project = Project(variant)
    block = variant.title_block.model_copy(update={"first_sheet": 7})
    others = [Project(variant.model_copy(update={"title_block": block})),
              Project(catalogue.read("lugansk/shaper")), Project(catalogue.read("press"))]  # fmt: skip
    variant.ask([("title_block",), ("sheets",), ("source", "crank", "length")])
    Answered(project, 1, "sheet").keep(b"made")
    assert found(project) == found(others[-1]) == [b"made"]
    assert ("sheets",) in others[-1].variant.asked  # what is used of it later depends on that, too
    assert [found(project, 2), *map(found, others[:-1])] == [[], [b"made"], []]  # names fill in the title block alone
    assert [*Answered(project, 1, "arrangement").found()] == []
    with words.on_paper("uk"):
        assert found(project) == []
    monkeypatch.setattr(composed, "maker", lambda: "another program")
    assert found(project) == []


def changed(*pairs):
    text = catalogue.read("lugansk/shaper").text
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    words.set_paper("ru")
    return Project(parse(text, "x.toml"))


@pytest.mark.parametrize(("n", "pairs", "views_kept", "same_sheet"), [
    (3, ('"0.08 m" ', '"0.0803 m"'), True, True), (3, ("# 000, 6.1: x1", "# mine: x1"), True, True),
    (1, ('student = ""', 'student = "N"'), True, False), (2, ('student = ""', f'student = "{"Ж" * 60}"'), True, False),
    (3, ('"gear", "cam"]', '"gear"]'), False, False), (4, ("teeth = [14, 28]", "teeth = [15, 29]"), True, True),
])  # fmt: skip
def test_what_was_not_asked_for_changes_no_sheet(place, monkeypatch, n, pairs, views_kept, same_sheet):
    before, after = sheet.composed(changed(), n), changed(pairs)
    compose, made = composing.composed, []
    monkeypatch.setattr(composing, "composed", lambda *what: made.append(what) or compose(*what))
    found = sheet.composed(after, n)
    assert (made == []) == views_kept
    with kept.unused():
        assert same(found, sheet.composed(changed(pairs), n))
    assert same(found, before) == same_sheet


def test_loading_imports_nothing_that_draws(place, tmp_path):
    """Neither views nor methods nor the libraries of geometry."""
    run(["build", "lugansk/cam_flat", "--format", "svg", "-o", str(tmp_path)])
    code = ("import sys\nfrom tmm_sheets.__main__ import run\n"
            f"assert run(['build', 'lugansk/cam_flat', '--format', 'svg', '--force', '-o', {str(tmp_path)!r}]) == 0\n"
            "print(*(m for m in sys.modules if m.startswith(('tmm_sheets.', 'shapely', 'scipy'))), file=sys.stderr)")  # fmt: skip
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=Path(__file__).parents[2])
    modules = told.stderr.splitlines()[-1].split()
    assert not [m for m in modules if m.startswith(("shapely", "scipy", "tmm_sheets.methods.", "tmm_sheets.mechanism."))]
    assert {m for m in modules if m.startswith("tmm_sheets.sheets.")} == {
        f"tmm_sheets.sheets.{name}" for name in ("sheet", "composed", "views")}  # fmt: skip


def test_an_odd_arrangement_counts_as_not_kept(place, monkeypatch):
    right = composition.arranged(opened("lugansk/shaper"), 1)
    for data in (b"", b"7", b"[7]", b"[" * 100_000, *map(pickle.dumps, ([], {"a": 1}, Path("a")))):
        monkeypatch.setattr(Answered, "found", lambda self, data=data: iter([data]))
        assert composition.arranged(opened("lugansk/shaper"), 1) == right, data[:60]


def test_an_arrangement_is_kept_as_it_was_found(place, monkeypatch):
    right = composition.arranged(opened("lugansk/shaper"), 1)
    monkeypatch.setattr(composition, "solve", lambda *_: pytest.fail("solved what is kept"))
    found = composition.arranged(opened("lugansk/shaper"), 1)
    assert [(v.draw, v.box, v.options) for v in found.views] == [(v.draw, v.box, v.options) for v in right.views]
    assert found.offers == right.offers
