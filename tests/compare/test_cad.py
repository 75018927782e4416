"""CAD drawings of sheets: right ones in any shape are not accused, planted errors are found and told by name."""

import random
import re
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import ezdxf
import numpy as np
import pytest

from tests import project_files
from tests.compare.cad_plants import Way, draw
from tests.compare.form import faults, of_elements
from tests.few import seldom
from tmm_sheets.backends import dxf
from tmm_sheets.catalogue import read
from tmm_sheets.compare import placing
from tmm_sheets.compare.cad import cad_drawing, cad_file
from tmm_sheets.compare.cad.cad_report import SHAPES
from tmm_sheets.compare.cad.line_fit import lines
from tmm_sheets.compare.elements import elements, views as views_of
from tmm_sheets.compare.placing import Placing
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed

SHAPER = Project(read("lugansk/shaper"))


def setup_module():
    """Composed when the first of these tests runs: every worker imports this file."""
    global SHEET, EXACT, ALL_GREEN, LINE, CIRCLE, CURVE, TEXT, ARROW, GREENISH, AMBER, GONE, TURNED, SPOILED
    SHEET = composed(SHAPER, 2)
    EXACT = elements(SHEET)
    ALL_GREEN = (len(EXACT), 0, 0, 0, 0)
    LINE = one(lambda e: e.kind == "line" and e.length > 60 and e.style == "thin"
               and abs(e.points[0].real - e.points[1].real) < 1e-6)
    CIRCLE = one(lambda e: e.kind == "circle" and e.radius > 10)
    CURVE = one(lambda e: e.kind == "curve" and len(e.points) > 50)
    TEXT = one(lambda e: e.kind == "text" and e.text == "H = 142")
    GREENISH, AMBER, GONE, TURNED = (
        [e for e in EXACT if e.view.n and e.kind == "line" and 60 < e.length < 150 and e.role == "construction" and e is not LINE
         and e.points[0].imag == e.points[1].imag and alone(e)][k] for k in range(4))  # fmt: skip
    ARROW = one(lambda e: e.kind == "line" and len(e.fills) == 1 and e.length > 30)
    SPOILED = {
        LINE: {"points": LINE.points + 1.5},
        GREENISH: {"points": GREENISH.points + 0.2j},
        AMBER: {"points": AMBER.points + 0.4j},
        TURNED: {"points": TURNED.points[0] + (TURNED.points - TURNED.points[0]) * TURN},
        CIRCLE: {"centre": CIRCLE.centre + 2j, "radius": CIRCLE.radius - 1},
        CURVE: {"points": bulged(CURVE)},
        TEXT: {"text": "H = 124"},
        ARROW: {"points": ARROW.points[::-1], "fills": (ARROW.points.sum() - ARROW.fills[0],)},
    }


def compare(data, tmp_path, sheet=2, views=None, project=SHAPER):
    """Notes and tree of a comparison, without its overlays."""
    path = tmp_path / "student.dxf"
    path.write_bytes(data)
    if views is not None:
        (tmp_path / "views.toml").write_text(views, encoding="utf-8")
        views = tmp_path / "views.toml"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(cad_drawing.overlays, "files", lambda *_: {})
        report = cad_drawing.compare(project, sheet, path, views, 0.25, lambda _: None)
    assert [*faults(report.tree)] == []
    return report


@cache
def exact():
    """The sheet as it is, drawn once."""
    return drawn(EXACT)


def drawn(found, seed=1, **way):
    return draw(list(found), Way(**way), random.Random(seed))


def summary(report):
    found = [f["verdict"] for f in of_elements(report.tree)]
    return (*(found.count(k) for k in ("green", "amber", "red", "not-judged")), len(report.tree["unclaimed"]))


def judged(report, number):
    return of_elements(report.tree)[number - 1]


def changed(number, **fields):
    """The elements with one of them altered."""
    return [replace(e, **fields) if e.number == number else e for e in EXACT]


def one(test):
    """The first element of a view (not the frame) that passes."""
    return next(e for e in EXACT if e.view.n and test(e))


@pytest.mark.parametrize(("n", "asked", "text"), [
    seldom(1, 1, "live"), seldom(3, None, "live"), seldom(1, None, "strokes"), seldom(3, 3, "strokes")])
def test_our_own_drawing_has_no_deviation(tmp_path, n, asked, text):
    report = compare(dxf.render(composed(SHAPER, n).drawing, text), tmp_path, asked)
    assert report.tree["sheet"] == n
    assert {e["verdict"] for e in of_elements(report.tree)} == {"green"}
    assert max(e["deviation_mm"] for e in of_elements(report.tree)) < 0.002
    assert report.tree["unclaimed"] == []
    assert report.notes == ()


def test_our_own_drawing_worked_on_in_another_program(tmp_path):
    """A number changed, a name filled in, saved by ezdxf: the number is found, nothing else."""
    path = tmp_path / "sheet.dxf"
    path.write_bytes(dxf.render(composed(SHAPER, 1).drawing))
    doc = ezdxf.readfile(path)
    (block,) = doc.modelspace().query("INSERT[name=='TITLE_BLOCK']")
    block.get_attrib("DEVELOPED").dxf.text = "Петренко А. И."
    number = next(e for e in doc.modelspace().query("TEXT") if re.fullmatch(r"= 21\d\d,\d Н", e.dxf.text))
    changed = number.dxf.text[:4] + number.dxf.text[5] + number.dxf.text[4] + number.dxf.text[6:]
    assert changed != number.dxf.text
    number.dxf.text = changed
    doc.saveas(path)
    report = compare(path.read_bytes(), tmp_path, 1)
    (wrong,) = (e for e in of_elements(report.tree) if e["verdict"] != "green")
    assert changed in wrong["said"]
    assert [x for x in report.tree["unclaimed"] if "Петренко" not in x["text"]] == []


@pytest.mark.parametrize("way", [
    {"turn": -2 / 25.4, "unit": 1, "block": True, "split": 0.5, "polylines": 0.7, "shift": 12.5 - 3j},  # inches, upside down
    seldom({"frame": False, "shift": -1000 - 1000j}),  # test_own_layout has none
])  # fmt: skip
def test_a_right_drawing_in_another_shape(tmp_path, way):
    report = compare(drawn(EXACT, **way), tmp_path)
    absent = EXACT[0].view.name if not way.get("frame", True) else ""
    assert [e for e in of_elements(report.tree) if e["verdict"] != "green" and e["view"] != absent] == []
    assert report.tree["unclaimed"] == []


def test_wrong_units_and_turns_are_mended_and_said(tmp_path):
    report = compare(drawn(EXACT, turn=0.001j, unit=4), tmp_path)
    assert summary(report) == ALL_GREEN
    assert "the drawing lies turned by 90°; it was turned back" in report.notes
    assert "the drawing is in metres though the file declares millimetres; it was scaled accordingly" in report.notes


def test_a_mirrored_drawing_at_half_size_is_turned_over_and_said(tmp_path):
    report = compare(drawn(EXACT, mirrored=True, turn=0.5, shift=500), tmp_path)
    assert "the drawing is mirrored; it was turned over for the comparison" in report.notes
    mirrored = "the mechanism is drawn mirrored, top and bottom exchanged, and all plans with it"
    (start,) = report.tree["start"]
    told = next(f for f in report.tree["findings"] if f["id"] == start)  # a mistake, for teachers and marks
    assert (told["code"], told["kind"], told["said"], "view" in told) == ("built-otherwise", "mirror", mirrored, False)
    assert "the drawing is at scale 1:2; it was scaled to 1:1" in report.notes
    assert summary(report) == ALL_GREEN


STRAY = np.array([500 + 430j, 540 + 445j])
TURN = np.exp(1j * np.radians(2))


def alone(e):
    """Whether no other level line lies on the level of this one."""
    return all(o is e or o.kind != "line" or o.points[0].imag != o.points[1].imag or abs(o.points[0].imag - e.points[0].imag) > 5
               or max(o.points.real.min(), e.points.real.min()) > min(o.points.real.max(), e.points.real.max()) for o in EXACT)


def bulged(curve):
    n = len(curve.points)
    across = 1j * np.gradient(curve.points)
    return curve.points + 1.2 * np.exp(-((np.arange(n) - n // 2) / (0.04 * n)) ** 2) * across / np.abs(across)


@pytest.fixture(scope="module")
def spoiled(tmp_path_factory):
    """One drawing with an error of each kind: its path and the report."""
    found = [replace(e, **SPOILED.get(e, {})) for e in EXACT if e is not GONE]
    found.append(replace(LINE, number=-1, points=STRAY))
    path = tmp_path_factory.mktemp("spoiled") / "student.dxf"
    path.write_bytes(drawn(found))
    return path, cad_drawing.compare(SHAPER, 2, path, None, 0.25, lambda _: None)


def test_only_what_was_spoiled_is_accused(spoiled):
    wrong = {e["number"] for e in of_elements(spoiled[1].tree) if e["verdict"] != "green"}
    assert wrong == {e.number for e in (*SPOILED, GONE)} - {GREENISH.number}


def test_a_shifted_line_is_found_with_its_shift_and_its_handle(spoiled):
    path, report = spoiled
    found = judged(report, LINE.number)
    assert (found["verdict"], found["deviation_mm"]) == ("red", pytest.approx(1.5, abs=0.01))
    assert found["shift_mm"] == pytest.approx([1.5, 0], abs=0.01)
    (entity,) = found["entities"]
    (space,) = cad_file.read(path).spaces
    stroke = next(s for s in space.strokes if space.entities[s.entity].handle == entity["handle"])
    assert stroke.points[0].real == pytest.approx(LINE.points[0].real + 1.5)
    assert f'{entity["handle"]} on layer "{entity["layer"]}"' in report.text


def test_the_verdict_follows_the_pencil(spoiled):
    assert [judged(spoiled[1], e.number)["verdict"] for e in (GREENISH, AMBER, LINE)] == ["green", "amber", "red"]
    assert judged(spoiled[1], GREENISH.number)["deviation_mm"] == pytest.approx(0.2, abs=0.01)


def test_a_turned_line(spoiled):
    found = judged(spoiled[1], TURNED.number)
    assert found["code"] in ("displaced", "turned")
    assert found["turn_rad"] == pytest.approx(np.radians(2.0), abs=4e-4)
    assert found["deviation_mm"] == pytest.approx(TURNED.length * np.radians(2), rel=0.01)


def test_a_missing_and_an_extra_line(spoiled):
    assert judged(spoiled[1], GONE.number)["code"] == "missing"
    (extra,) = spoiled[1].tree["unclaimed"]
    assert extra["length_mm"] == pytest.approx(abs(40 + 15j), abs=0.1)
    assert extra["at_mm"] == pytest.approx([520, 437.5], abs=0.1)


def test_a_circle_off_its_centre_and_of_another_size(spoiled):
    found = judged(spoiled[1], CIRCLE.number)
    assert found["shift_mm"] == pytest.approx([0, 2], abs=0.02)
    assert found["growth"] * CIRCLE.radius == pytest.approx(-1, abs=0.02)


def test_a_bulging_curve(spoiled):
    assert judged(spoiled[1], CURVE.number)["deviation_mm"] == pytest.approx(1.2, abs=0.1)


def test_a_wrong_number(spoiled):
    assert judged(spoiled[1], TEXT.number)["code"] == "text"
    assert judged(spoiled[1], TEXT.number)["said"] == 'reads "H = 124" instead of "H = 142"'


def test_an_arrow_the_wrong_way_round(spoiled):
    found = judged(spoiled[1], ARROW.number)
    assert (found["code"], found["verdict"], found["said"]) == ("arrow-reversed", "red", "points the other way")


def test_a_wrong_letter_drawn_with_strokes(tmp_path):
    marks = list(SHEET.drawing.marks)
    k = next(k for k, m in enumerate(marks) if getattr(m, "text", "") == "H = 142")
    marks[k] = marks[k]._replace(text="H = 147")
    found = judged(compare(dxf.render(replace(SHEET.drawing, marks=tuple(marks)), "strokes"), tmp_path), TEXT.number)
    assert (found["verdict"], found["said"]) == ("red", 'the letters are not those of "H = 142"')


@pytest.mark.trial
def test_a_layout_of_ones_own(tmp_path):
    """Views that stand elsewhere are compared there; an error in one of them is still found."""
    rng = random.Random(5)
    shifts = {v: complex(rng.uniform(-30, 30), rng.uniform(-30, 30)) for v in {e.view.n for e in EXACT} if v}
    found = [replace(e, points=e.points + (d := shifts.get(e.view.n, 0)), centre=e.centre + d, fills=tuple(f + d for f in e.fills),
                     pieces=tuple(p + d for p in e.pieces)) for e in EXACT]
    found[LINE.number - 1] = replace(found[LINE.number - 1], points=found[LINE.number - 1].points + 1.5)
    report = compare(drawn(found), tmp_path)
    assert judged(report, LINE.number)["verdict"] == "red"
    assert sum(summary(report)[1:3]) <= 3
    assert any(f'"{LINE.view.name}" stands' in note for note in report.notes)


def test_a_single_view(tmp_path):
    """A drawing may have one view only: the others are told as missing, in a row each."""
    cam = Project(read("lugansk/cam_flat"))
    known = elements(composed(cam, 1))
    view = next(e.view for e in known if e.view.n)
    report = compare(drawn([e for e in known if e.view == view], turn=0.5, shift=70), tmp_path, 1, project=cam)
    mine = [e for e in of_elements(report.tree) if e["view"] == view.name]
    assert {e["verdict"] for e in mine} == {"green"}
    others = {e.view.name for e in known if e.view != view}
    assert set(report.tree["summary"]["missing_views"]) == others
    lost = {f["id"]: f for f in report.tree["findings"] if f["code"] in ("view-missing", "table-missing")}
    assert report.tree["start"] == [*lost]
    assert {f["view"] for f in lost.values()} == others
    assert all(lost[f["follows"][0]]["view"] == f["view"] for f in of_elements(report.tree) if f["view"] in others)
    shaped = {e.view.name for e in known if e.role in SHAPES}
    assert set(report.tree["summary"]["missing_tables"]) == others - shaped
    left = report.tree["summary"]["not_judged"]
    assert left == len(known) - len(mine) + len(others)
    assert report.tree["summary"]["not_drawn"] == len(known) - len(mine)
    views = f"{len(others & shaped)} of {len(shaped)} views"
    assert f"{len(mine)} green (up to 0.00 mm), 0 amber, 0 red, {left} not judged; 0 extra; {views}" in report.text


def test_views_given_by_a_file(tmp_path):
    view = CIRCLE.view
    place = Placing(0.5, 300 + 20j)

    def moved(e):
        points = e.points + place(e.middle) - e.middle if e.kind == "text" else place(e.points)
        return replace(e, points=points, centre=place(e.centre), radius=e.radius * (0.5 if e.radius > 2.6 else 1),
                       fills=tuple(map(place, e.fills)), pieces=tuple(map(place, e.pieces)))

    found = [moved(e) if e.view == view else e for e in EXACT]
    ours = [CIRCLE.centre, CIRCLE.centre + 50]
    pairs = ", ".join(f"[{z.real}, {z.imag}]" for z in ours), ", ".join(f"[{z.real}, {z.imag}]" for z in map(place, ours))
    given = f'[[view]]\nname = "{view.name}"\nours = [{pairs[0]}]\ntheirs = [{pairs[1]}]\n'
    report = compare(drawn(found), tmp_path, views=given)
    told = next(v for v in report.tree["views"] if v["view"] == view.name)
    assert told["size"] == pytest.approx(0.5, abs=1e-3)
    assert judged(report, CIRCLE.number)["verdict"] == "green"
    near = [x for x in report.tree["unclaimed"] if abs(complex(*x["at_mm"]) - place(view.box.centre)) < 60]
    assert near == []  # neither hatching nor the heads of dimensions are compared there, nor are they too much


def test_a_wrong_place_in_the_file_of_views_is_told_and_the_view_looked_for(tmp_path):
    view = CIRCLE.view
    given = f'[[view]]\nname = "{view.name}"\nours = [[100, 100], [200, 200]]\ntheirs = [[-5000, -5000], [-4900, -4900]]\n'
    report = compare(exact(), tmp_path, views=given)
    assert judged(report, CIRCLE.number)["verdict"] == "green"
    assert report.notes[0] == f'"{view.name}" is not where --views says: 0 % of its lines are there; it was looked for'


@pytest.mark.parametrize(("text", "said"), [
    ("[[view]]\nname = 'Эскиз маховика'\nours = [[1, nan], [3, 4]]\ntheirs = [[1, 2], [3, 4]]", "expected points"),
    ("", r"view: missing; expected tables \[\[view\]\]"),
    ("[[view]]\nname = 'Схема'\nours = [[1, 2], [3, 4]]\ntheirs = [[1, 2], [3, 4]]", 'the sheet has no view "Схема"'),
    ("[[view]]\nname = 'Эскиз маховика'\nours = [[1, 2], [30, 4]]\ntheirs = [[1, 2]]", "1 point, ours has 2"),
    ("[[view]]\nname = 'Эскиз маховика'\nours = [1, 2]\ntheirs = [[1, 2]]\nmu = -1", "expected points(.|\n)*a positive number"),
    ("[[view]]\nname = 'Эскиз маховика'\nours = [[1, 2]]\ntheirs = [[1, 2]]\nsize = 2", "unknown key"),
    ("[[view", "Expected|expected"),
])  # fmt: skip
def test_a_bad_file_of_views(tmp_path, text, said):
    path = tmp_path / "views.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(BadInput, match=said):
        placing.read_places(path, views_of(SHEET))


def test_the_wrong_sheet_is_told_and_the_right_one_named(tmp_path):
    both = project_files.project(project_files.CRANK, project_files.REDUCER)
    first = drawn(elements(composed(both, 1)))
    with pytest.raises(CannotBuild, match=r"only \d+ % of the lines of sheet 2 are in this drawing") as e:
        compare(first, tmp_path, 2, project=both)
    assert "it looks like sheet 1: use --sheet 1" in e.value.hint
    assert compare(first, tmp_path, None, project=both).tree["sheet"] == 1


@pytest.mark.trial
def test_a_drawing_of_something_else(tmp_path):
    rng = np.random.default_rng(1)
    z = rng.uniform(0, 800, 60) + 1j * rng.uniform(0, 500, 60)
    other = [replace(LINE, points=np.array([a, b]), number=-1) for a, b in pairwise(z)]
    with pytest.raises(CannotBuild, match="of the lines of sheet 1 are in this drawing"):
        compare(drawn(other), tmp_path, 1, project=Project(read("lugansk/cam_flat")))


def test_no_such_sheet(tmp_path):
    with pytest.raises(BadInput, match="--sheet 5: lugansk/shaper has 4 sheets"):
        compare(b"", tmp_path, 5)


def test_the_overlay_shows_both_and_the_findings(spoiled, tmp_path):
    report = spoiled[1]
    assert set(report.files) == {"sheet2-dxf.pdf", "sheet2-overlay.dxf"}
    assert report.files["sheet2-dxf.pdf"].startswith(b"%PDF")
    path = Path(tmp_path) / "overlay.dxf"
    path.write_bytes(report.files["sheet2-overlay.dxf"])
    (space,) = cad_file.read(path).spaces
    assert {w.text for w in space.writings} == {*(str(e.number) for e in (*SPOILED, GONE) if e is not GREENISH), "+1", "~1"}
    exact = lines([s.points for s in space.strokes if space.entities[s.entity].layer == "SHEET"])
    theirs = lines([s.points for s in space.strokes if space.entities[s.entity].layer == "DRAWN"])
    middle = np.array([LINE.points.mean()])
    assert exact.share(middle, 0.01) == 1
    assert theirs.share(middle, 0.5) == 0
    assert theirs.share(middle + 1.5, 0.01) == 1
