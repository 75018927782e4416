"""Files as people fill them in: what is mended is said, what cannot be is told with file, line and column."""

import pytest

from tests.compare.languages import to_reader
from tmm_sheets import catalogue
from tmm_sheets.compare.measured.measurable import Measurable, Measurables, plain
from tmm_sheets.compare.measured.measured_file import read, template
from tmm_sheets.construction.scale import Scale
from tmm_sheets.errors import BadInput
from tmm_sheets.project import Project

PRESS = Project(catalogue.read("press"))
HEAD = "обозначение;план;положение;величина;шаги;единица;измерено"
UNITS = {"velocities/1/pb": "mm", "velocities/2/pb": "mm", "velocities/2/pb3": "mm", "positions/2/angle-AB": "°",
         "results/2/V_B": "m/s", "results/2/omega3": "rad/s", "results/F21": "N", "results/1'/h50": "m"}


@pytest.fixture
def found():
    found = Measurables(scales={"velocities": Scale("μ_V", 0.02, "(м/с)/мм"), "force-2–3": Scale("μ_F", 20.0, "Н/мм")})
    for name, unit in UNITS.items():
        plan = name.split("/")[0]
        kind = "result" if plan == "results" else "angle" if unit == "°" else "length"
        scale = "velocities" if plan == "velocities" else "force-2–3" if name == "results/F21" else ""
        found.add(Measurable(name, plan, "Планы", "", name, unit, kind, 10.0, scale=scale, reading=1.0))
    return found


@pytest.fixture
def filled(tmp_path, found):
    """Read a file made of lines, or of bytes."""

    def filled(*lines, data=None, head=HEAD):
        path = tmp_path / "measured.csv"
        path.write_bytes(data if data is not None else "\n".join((head, *lines)).encode())
        return read(path, PRESS, found)

    return filled


def row(name, value, unit=""):
    return f"{name};;;;;{unit};{value}"


def problems(filled, *lines, **options):
    with pytest.raises(BadInput) as e:
        filled(*lines, **options)
    return list(e.value.problems)


def values(result):
    return {line.entry.id: line.value for line in result.lines}


def test_template_is_read_back(tmp_path, found):
    """Byte order mark, semicolons, decimal commas, no exact values; empty it is refused, filled in it is read without a word."""
    with to_reader("ru"):
        data = template("press", found)
    assert data.startswith(b"\xef\xbb\xbf# ")
    text = data.decode("utf-8-sig")
    assert "mu/velocities;масштабные коэффициенты;;μ_V;;(м/с)/мм;0,02" in text
    assert "10" not in text
    path = tmp_path / "m.csv"
    path.write_bytes(data)
    with pytest.raises(BadInput, match="nothing is filled in"):
        read(path, PRESS, found)
    path.write_bytes(text.replace("pb;мм;", "pb;мм;30,5").replace("velocities/1/pb;Планы;;velocities/1/pb;;мм;",
                                                                 "velocities/1/pb;Планы;;velocities/1/pb;;мм;30,5").encode("utf-8-sig"))
    result = read(path, PRESS, found)
    assert values(result) == {"velocities/1/pb": 30.5}
    assert result.notes == []
    assert result.factors == {"velocities": 0.02, "force-2–3": 20.0}
    assert result.empty == len(UNITS) - 1


def test_ids_are_ascii():
    names = "results/1′/a_B3B^к", "arms/2/h_Fи5(D)", "force-2–3/2/1–2", "results/Mур", "total-work/2/y_ΔE", "lever/2/h F_{Ми3}"
    assert all(plain(name).isascii() for name in names)


@pytest.mark.parametrize(("text", "value"), [
    ("46,5", 46.5), ("46.5", 46.5), (" 46,5 ", 46.5), ("'46,5", 46.5), ("≈46", 46.0), ("1 046,5", 1046.5), ("1\u00a0046,5", 1046.5),
    ("−46,5", -46.5), ("4,65e1", 46.5), (",5", 0.5), ("46,5 мм", 46.5), ("46,5mm", 46.5), ("4,65 см", 46.5), ("0,0465 м", 46.5),
])
def test_numbers(filled, text, value):
    assert values(filled(row("velocities/2/pb", text))) == {"velocities/2/pb": pytest.approx(value)}


@pytest.mark.parametrize(("text", "half"), [("46,5", 0.05), ("46", 0.5), ("46,50", 0.005), ("4,65 см", 0.05), ("1,2e3", 50.0)])
def test_last_digit(filled, text, half):
    assert filled(row("velocities/2/pb", text)).lines[0].half_digit == pytest.approx(half)


def test_a_guess_is_no_rounding(filled):
    """A result of 10 written as 1e1 is rounded to a twentieth of it at most."""
    assert filled(row("results/F21", "1e1")).lines[0].half_digit == pytest.approx(0.5)


@pytest.mark.parametrize(("name", "unit", "value", "expected"), [
    ("positions/2/angle-AB", "рад", "0,5", 28.6479), ("results/F21", "кН", "1,5", 1500.0), ("results/F21", "kN", "1,5", 1500.0),
    ("results/1'/h50", "мм", "115", 0.115), ("results/2/V_B", "m/s", "0,6", 0.6), ("results/2/omega3", "rad/s", "1,5", 1.5),
    ("results/2/omega3", "рад/с?", "1,5", 1.5),  # what a code page without superscripts leaves of рад/с²
])
def test_units_of_the_column(filled, name, unit, value, expected):
    result = filled(row(name, value, unit))
    assert values(result) == {name: pytest.approx(expected, abs=1e-4)}
    assert bool(result.notes) == (expected != float(value.replace(",", ".")))


def test_mended_and_said(filled):
    """Points, other separators, code pages, a missing heading, look-alike letters."""
    assert [note.partition(":")[2] for note in filled(row("velocities/2/pb", "4.65 cm")).notes] == ["2: 4.65 cm taken as 46.5 mm"]
    tabs = filled(row("velocities/2/pb", "46,5").replace(";", "\t"), head=HEAD.replace(";", "\t"))
    assert values(tabs) == {"velocities/2/pb": 46.5}
    assert any("tabs" in note for note in tabs.notes)
    commas = filled("velocities/2/pb,,,,,,46.5", "velocities/1/pb,,,,,,46,5", head=HEAD.replace(";", ","))
    assert values(commas) == {"velocities/2/pb": 46.5, "velocities/1/pb": 46.5}
    assert any("put together, first in line 3" in note for note in commas.notes)
    old = filled(data="\r\n".join((HEAD, row("velocities/2/pb", "46,5"))).encode("cp1251"))
    assert values(old) == {"velocities/2/pb": 46.5}
    assert any("1251" in note for note in old.notes)
    wide = filled(data="\r\n".join((HEAD, row("velocities/2/pb", "46,5"))).encode("utf-16"))
    assert values(wide) == {"velocities/2/pb": 46.5}
    bare = filled(row("velocities/2/pb", "46,5"), head="velocities/1/pb;30,0")
    assert values(bare) == {"velocities/1/pb": 30.0}
    assert any("no heading" in note for note in bare.notes)
    letters = filled(row("velосities/2/рb", "46,5"), row("results/1′/h50", "0,115"))
    assert values(letters) == {"velocities/2/pb": 46.5, "results/1'/h50": 0.115}
    mixed = filled(row("velocities/2/pb", "46,5"), row("velocities/1/pb", "46.5"))
    assert any("decimal points in 1 lines, commas in 1" in note for note in mixed.notes)
    twice = filled(row("velocities/2/pb", "46,5"), row("velocities/2/pb", "46,5"))
    assert len(twice.lines) == 1
    assert any("twice" in note for note in twice.notes)


def test_scale_factors(filled):
    """Of a plan, in lines of their own; of a single line, in a column."""
    result = filled(row("mu/velocities", "0,025"), row("mu/force-2-3", "40"), row("velocities/2/pb", "24"))
    assert result.factors == {"velocities": 0.025, "force-2–3": 40.0}
    result = filled("velocities/2/pb;24;0,025", head="id;измерено;мю")
    assert result.lines[0].factor == 0.025
    assert "did you mean mu/velocities" in problems(filled, row("mu/velocity", "1"))[0].hint
    assert "positive number" in problems(filled, row("mu/velocities", "0"))[0].message
    assert "is it in (м/с)/мм?" in problems(filled, row("mu/velocities", "20"))[0].hint
    assert "is it in (м/с)/мм?" in problems(filled, "velocities/2/pb;24;25", head="id;измерено;мю")[0].hint


def test_problems_name_line_and_column(filled):
    found = problems(filled, row("velocities/2/pb", "46,5"), row("velocities/2/pd", "12"), row("velocities/1/pb", "много"),
                     row("results/2/V_B", "5", "мм"), row("results/2/omega3", "1..5"), row("positions/2/angle-AB", "46,5±0,5"))
    assert [(p.line, p.field) for p in found] == [
        (3, "обозначение"), (4, "измерено"), (5, "измерено"), (6, "измерено"), (7, "измерено")]
    assert "did you mean velocities/2/pb" in found[0].hint
    assert "expected a number" in found[1].message
    assert "expected m/s, not мм" in found[2].message
    assert "expected one number" in found[4].message
    assert "a sheet can have" in problems(filled, row("velocities/2/pb", "1e300"))[0].message
    assert all(p.file.endswith("measured.csv") for p in found)


@pytest.mark.parametrize(("head", "text"), [
    ("обозначение;план;величина", 'the column "measured" is missing'),
    ("план;измерено", 'the column "id" is missing'),
    ("обозначение;измеренно", 'did you mean "измеренно"'),
    ("просто слова", "no separator"),
])
def test_columns(filled, head, text):
    assert text in "\n".join(map(str, problems(filled, "velocities/2/pb;1;1", head=head)))


@pytest.mark.parametrize(("data", "text"), [
    (b"", "empty"), (b"\n \n", "empty"), (b"\xef\xbb\xbf# x\n", "no lines"), (b"PK\x03\x04...", "workbook"),
    (b"\0\1\2" * 50, "not a text"),
    (b"\xd0\xcf\x11\xe0\xa1", "workbook"), (b'id;measured\nvelocities/1/pb;"5\nvelocities/2/pb;5\n', "unexpected end of data"),
    ("# проект: lugansk/shaper\n".encode() + HEAD.encode(), "not of press"),
])
def test_no_table_at_all(filled, data, text):
    assert text in str(problems(filled, data=data)[0])


def test_different_numbers_for_one_quantity(filled):
    found = problems(filled, row("velocities/2/pb", "46,5"), row("velocities/2/pb", "47"))
    assert "stands twice: 46.5 in line 2, 47 here" in found[0].message


def test_file_of_another_project(filled):
    """No remark says so, but nothing fits."""
    found = problems(filled, *(row(f"velocities/{k}/pz{k}", "5") for k in range(30)))
    assert len(found) == 1
    assert "another project" in found[0].hint


def test_many_problems_are_cut_short(filled):
    found = problems(filled, *(row("velocities/2/pb", f"x{k}") for k in range(30)))
    assert len(found) == 21
    assert "10 problems more" in found[-1].message


def test_missing_file(tmp_path, found):
    with pytest.raises(BadInput, match=r"--template writes"):
        read(tmp_path / "none.csv", PRESS, found)
    with pytest.raises(BadInput, match="is a directory"):
        read(tmp_path, PRESS, found)
