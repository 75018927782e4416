"""Finished notes read by ``check_notes``, and the reader itself: a fault of every kind that is planted is found."""

from dataclasses import replace
from typing import Literal, get_args, get_origin

import pytest

from tests.few import few, seldom
from tests.note import check_notes
from tests.note.opened import composed, noted, opened
from tmm_sheets import words
from tmm_sheets.construction.formula import Figures, FormulaRow, Letters, Sign, Words, letters
from tmm_sheets.note import phrases
from tmm_sheets.note.document import Explained, Formula, Heading, NumberedTable, NumberInText, Paragraph, Symbol, Where
from tmm_sheets.task.schema import Seldom, Table
from tmm_sheets.task.variant import Variant

READ = [(name, "ru") for name in check_notes.SHARE] + [("lugansk/engine", "uk"), ("transport/crusher@12-СДМ-1908", "en")]


@pytest.mark.parametrize(("name", "language"), few(READ, READ[0]))
def test_a_note_has_no_fault(name, language):
    note = noted(name, language)
    assert list(check_notes.content_faults(note)) == []
    assert check_notes.counted(note) > 30


@pytest.mark.parametrize("project", [seldom("feeder"), seldom("pump"), seldom("conveyor"), "boom", "hoist", seldom("geneva")])
def test_the_note_of_an_own_project_has_no_fault(project):
    assert list(check_notes.content_faults(composed(opened(f"tests/projects/{project}.toml")))) == []


def formula(text, number="(1.1)"):
    """A formula whose equation reads like ``text``: numbers are marked as such, all else are signs."""
    nodes = [Figures(t, NumberInText(t, "plan/x", 0.0)) if t[0].isdigit() else Words(t) if t.startswith("\u00a0") else Sign(t)
             for t in text.split(" ")]  # fmt: skip
    return Formula((FormulaRow((Letters("x"), Sign("="), *nodes)),), number)


def explained(symbol, meaning, unit=""):
    return Where("где", (Explained(letters(symbol), (meaning,), unit),))


HEAD = tuple((h,) for h in phrases.words("ru")["task"]["head"])
PLANTED = [
    ("empty", Paragraph(("Наибольшее ускорение возникает в положениях ", "."))),
    ("empty", Paragraph(("См. рис. , там показано.",))),
    ("empty", NumberedTable("1", "", ((("Звено",),), (("1",),)))),
    ("unnamed row", NumberedTable("1", "Данные", (HEAD, (("–",), ("l",), ("м",), ("0,1",))))),
    ("markup", Paragraph(("Момент $M$ равен {value}.",))),
    ("markup", Paragraph(("Работа равна ", NumberInText("5,233e-6", "a/b", 5e-6), "."))),
    ("markup", Paragraph(("Момент, {Nm}",))),
    ("markup", Formula((FormulaRow(tuple(map(Letters, "column"))),))),
    ("unit", NumberedTable("1", "Данные", (HEAD, (("момент",), ("M",), ("N m",), ("8",))))),
    ("unit", Paragraph(("Сила равна ", NumberInText("3", "a/b", 3.0, unit="lbf"), "."))),
    ("alphabet", Paragraph(("Сила force равна нулю.",))),
    ("plural", Paragraph(("Строим ", NumberInText("21", "a/b", 21), " совмещённых плана положений."))),
    ("formula", formula("0,1765 + 0 − 0,1713 = 0,005132")),
    ("formula", formula("2 · = 5")),
    ("sum", Paragraph(("Угол φ = −162° + (−1)·72° = −235°.",))),
    ("where", explained("F_1", "сила", "Н")),
    ("no unit", explained("T", "время одного оборота")),
    ("numbering", Formula((formula("1 = 1").lines[0],), "(7.2)")),
]


@pytest.fixture(scope="module")
def note():
    """A short one that faults are planted in."""
    return composed(opened("lugansk/cam_flat"))


@pytest.mark.parametrize(("kind", "block"), PLANTED)
def test_a_planted_fault_is_found(note, kind, block):
    planted = replace(note, body=(*note.body, Heading(1, "", "Пример"), block))
    assert kind in {fault.kind for fault in check_notes.content_faults(planted)}


def test_an_empty_conclusion_and_a_sheet_without_words_are_found(note):
    at = next(i for i, b in enumerate(note.body) if isinstance(b, Heading) and b.text == "Заключение")
    bare = replace(note, body=tuple(b for b in note.body[at:] if not (isinstance(b, Paragraph) and b.look == "item")))
    assert list(check_notes.inconclusive(bare)) == ["Заключение: no result", "sheet 1 is spoken of nowhere"]


def test_an_angular_velocity_of_two_signs_is_found(note):
    """In a table as it is, in a formula as a magnitude: its letter needs bars there."""
    def of(head):
        line = FormulaRow((head, Sign("="), Figures("2,3", NumberInText("2,3", "velocities/ω3", 2.3, "1"))))
        table = NumberedTable("1", "", (((Symbol(letters("ω_3")),),), ((NumberInText("−2,3", "velocities/ω3", -2.3, "1"),),)))
        return list(check_notes.two_signs(replace(note, body=(*note.body, table, Formula((line,), "(9)")))))

    assert of(letters("ω_3")) == ["velocities/ω3 in position 1"]
    assert of(letters("|ω_3|")) == []


def test_the_note_of_a_train_tells_the_speeds_of_all_links():
    """Wheel 5 by Willis: 24(-400 + 320) = -84(n5 + 320)."""
    note = composed(opened("tests/projects/hoist.toml"))
    table = next(b for b in note.blocks() if isinstance(b, NumberedTable) and b.title == "Частоты вращения звеньев")
    found = {check_notes.said(row[0]): row[2][0].value for row in table.rows[1:]}
    assert found == pytest.approx({"1": 960, "2": -320, "3": -400, "4": -256, "5": -320 + 80 * 24 / 84, "H": -320})


def test_a_letter_without_words_is_found(note):
    line = FormulaRow((letters("Q_7"), Sign("="), *formula("2 · 3 = 6").lines[0].items[2:]))
    planted = replace(note, body=(*note.body, Formula((line,), "(9)")))
    assert any(f.kind == "unexplained" and "Q_{7}" in f.text for f in check_notes.content_faults(planted))


def test_a_given_number_that_the_task_lacks_is_found(note):
    source = NumberInText("3,56", "synthesis.rod_ratio", 3.56)
    line = FormulaRow((Letters("x"), Sign("="), Figures("3,56", source), Sign("="), Figures("3,56")))
    planted = replace(note, body=(*note.body, Formula((line,), "(9)")))
    assert any(f.kind == "not in the task" and f.text == "synthesis.rod_ratio" for f in check_notes.content_faults(planted))


def test_right_blocks_have_no_fault(note):
    right = (
        Heading(1, "", "Пример"),
        Paragraph(("Строим ", NumberInText("21", "a/b", 21), " совмещённый план; |", Symbol(letters("pd")), "| : |ab| = 2 : 3.")),
        Paragraph(("Угол φ = −162° + (−1)·72° = −234°.",)),
        NumberedTable("3", "Данные", (HEAD, (("момент",), ("M",), ("Н·м",), ("8",)))),
        formula("0,17647 + 0 − 0,17134 = 0,00513 \u00a0Н", "(1)"), explained("x", "сила", "Н"),
    )  # fmt: skip
    assert not list(check_notes.content_faults(replace(note, body=(*note.body, *right))))


# --- what the task tells

TOLD_OTHERWISE = {
    "crank.angular_acceleration", "cycle.start", "cycle.end", "cycle.positions", "cycle.working", "cycle.idle", "cycle.turns",
    "cycle.extra", "forces.gravity", "title_block.first_sheet", "group.at", "group.direction", "group.side", "guide.direction",
    "guide.through", "force.direction", "force.first", "force.from", "force.to", "moment.first", "balancing.mate", "scales",
    "points", "synthesis.round", "gear.driver", "gear.addenda", "reducer.simple_ratio", "reducer.least_teeth", "reducer.most_teeth",
    "flywheel.motor.ratio", "input.side", "cam.parts", "cam.table", "cam.fall_table", "cam.displacements", "group.kind",
}  # fmt: skip
"""Numbers of a project file that the note tells elsewhere: in its drawings and sentences, or as a choice of the drawing."""


def fields(model, before=""):
    """Keys of a table of the project file with the types they may have, those of the tables in it too."""
    for name, field in model.model_fields.items():
        key = f"{before}{field.alias or name}"
        types = list(_types(field.annotation))
        tables = [t.table() if issubclass(t, Seldom) else t for t in types if isinstance(t, type) and issubclass(t, Table | Seldom)]
        yield from fields(tables[0], f"{key}.") if tables else [(key, types)]


def _types(annotation):
    inner = get_args(annotation)
    if get_origin(annotation) is Literal:
        yield from map(type, inner)
    elif inner:
        for a in inner:
            yield from _types(a)
    else:
        yield annotation


PARTS = ("crank", "input", "group", "point", "synthesis", "link", "force", "moment", "balancing", "friction", "flywheel", "reducer",
         "gear", "cam", "cycle")  # fmt: skip


@pytest.mark.parametrize("language", words.LANGUAGES)
def test_every_number_of_a_project_file_has_words(language):
    """Rows of the task come from these: a key that is spelt wrongly there, or new in the schema, would be left out in silence."""
    known = dict(fields(Variant))
    told = {".".join(p for p in key.partition(" ")[0].split(".") if p not in "*#") for key in phrases.words(language)["data"]}
    assert told - known.keys() == set()
    numbers = {key for key, types in known.items() if not {str, bool} & set(types) and key.startswith(PARTS)}
    assert numbers - told - TOLD_OTHERWISE == set()
