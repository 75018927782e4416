"""What stands in a note: its parts in order, numbers, references; nothing empty, nothing unexplained."""

import re
from itertools import pairwise
from math import degrees, isclose
from pathlib import Path

import numpy as np
import pytest

from tests.few import seldom
from tests.note.opened import composed, opened
from tmm_sheets import kept, results, words
from tmm_sheets.construction.formula import Letters, Words
from tmm_sheets.drawing.styles import line_types
from tmm_sheets.meanings import tables_of
from tmm_sheets.note import composing, phrases
from tmm_sheets.note.document import (
    Contents,
    Figure,
    Formula,
    Heading,
    NumberedTable,
    NumberInText,
    Paragraph,
    Reference,
    Sheet,
    Where,
    numbers,
    plain_text,
)
from tmm_sheets.note.pictures import LETTERS, READABLE, Pictures
from tmm_sheets.note.reader import Reader
from tmm_sheets.note.sections import forces, wheels
from tmm_sheets.record.recording import book_of
from tmm_sheets.resources import template
from tmm_sheets.sheets.views import VIEWS


def headings(note):
    return [(b.number, b.text) for b in note.blocks() if isinstance(b, Heading) and b.level == 1]


def test_the_parts_of_manual_000_in_their_order(note):
    said = [text for _, text in headings(note)]
    assert said == [
        "Реферат", "Задание к курсовому проекту", "Введение", "Структурный анализ рычажного механизма",
        "Геометрические размеры механизма", "Кинематический анализ рычажного механизма", "Силовой анализ рычажного механизма",
        "Расчёт маховика", "Синтез зубчатой передачи", "Синтез кулачкового механизма", "Заключение",
        "Список использованной литературы"]  # fmt: skip
    assert [n for n, _ in headings(note) if n] == list("1234567")
    assert sum(isinstance(b, Contents) for b in note.front) == 1
    assert [b.number for b in note.body if isinstance(b, Sheet)] == ["1", "2", "3", "4"]


@pytest.mark.parametrize("kind", [Figure, NumberedTable])
def test_figures_and_tables_are_numbered_through_each_section(note, kind):
    found = [b.number for b in note.blocks() if isinstance(b, kind) and not getattr(b, "further", False)]
    section = {}
    for number in found:
        head, _, nth = number.rpartition(".")
        section.setdefault(head, []).append(int(nth))
    assert all(nths == list(range(1, len(nths) + 1)) for nths in section.values())
    assert len(found) == len(set(found)) > 10


def test_every_reference_leads_somewhere(note):
    targets = {f"figure:{b.number}" for b in note.blocks() if isinstance(b, Figure)}
    targets |= {f"table:{b.number}" for b in note.blocks() if isinstance(b, NumberedTable)}
    targets |= {f"formula:{b.number[1:-1]}" for b in note.blocks() if isinstance(b, Formula) and b.number}
    asked = [x.target for b in note.blocks() if isinstance(b, Paragraph) for x in b.text if isinstance(x, Reference) and x.target]
    assert asked
    assert set(asked) <= targets


def test_every_figure_and_table_is_spoken_of(note):
    asked = {x.target for b in note.blocks() if isinstance(b, Paragraph) for x in b.text if isinstance(x, Reference)}
    assert {f"figure:{b.number}" for b in note.blocks() if isinstance(b, Figure)} <= asked
    assert {f"table:{b.number}" for b in note.blocks() if isinstance(b, NumberedTable)} <= asked


def test_the_abstract_counts_what_is_there(note):
    text = next(plain_text(b.text) for b in note.front if isinstance(b, Paragraph))
    blocks = list(note.blocks())
    sources = sum(bool(re.match(r"\d+\. ", plain_text(b.text))) for b in note.body if isinstance(b, Paragraph) and b.look == "item")
    counted = {int(n) for n in re.findall(r"(?:Ил|Табл|Библиогр)\.:?\s(\d+)", text)}
    drawn = sum(isinstance(b, Figure) and not b.further for b in blocks)
    assert counted == {drawn, sum(isinstance(b, NumberedTable) for b in blocks)} | {sources}


def test_sources_stand_in_the_order_of_citation(note):
    cited = [int(n) for b in note.blocks() if isinstance(b, Paragraph)
             for x in b.text if isinstance(x, Reference) and not x.target for n in re.findall(r"\d+", x.text)]  # fmt: skip
    first = list(dict.fromkeys(cited))
    assert first == sorted(first) == list(range(1, len(first) + 1))


def test_a_letter_is_explained_once(note):
    seen = [(r.symbol, r.meaning) for b in note.blocks() if isinstance(b, Where) for r in b.rows]
    assert len(seen) == len(set(seen)) > 50


def test_letters_of_numbered_formulas_are_explained(note):
    """Each formula of the section on the flywheel and of the gear is followed by words for what is new in it."""
    explained = {plain_text(r.meaning) for b in note.blocks() if isinstance(b, Where) for r in b.rows}
    for meaning in ("момент инерции маховика", "коэффициент неравномерности движения", "угол зацепления",
                    "диаметр маховика, у обода средний",
                    "приведённый момент сил", "угловая скорость звена 3"):  # fmt: skip
        assert meaning in explained


KNOWN = {"sin", "cos", "tg", "arctg", "arcsin", "arccos", "max", "min", "inv", "log", "exp"}


def test_formulas_hold_no_name_of_the_program(note):
    """Words in formulas are functions, units and Russian; letters stand alone or name points."""
    def words(node):
        if isinstance(node, Words):
            yield node.text.strip()
        for part in node.parts():
            yield from words(part)

    def letters(node):
        run = ""
        for part in node.parts():
            yield from letters(part)
            run = run + part.text if isinstance(part, Letters) and part.text.isascii() and part.text.islower() else ""
            yield run

    for b in note.blocks():
        if isinstance(b, Formula):
            for line in b.lines:
                assert all(w in KNOWN or not re.search("[A-Za-z]", w) for w in words(line)), line
                assert not [run for run in letters(line) if len(run) > 3], line


def test_nothing_is_empty_or_unfilled(note):
    for b in note.blocks():
        if isinstance(b, Paragraph):
            text = plain_text(b.text)
            assert any(c.isalpha() for c in text) or len(b.text) > 1
            assert not re.search(r"[{}\[]{2}|\{@|nan|None", text), text
        if isinstance(b, NumberedTable):
            assert len(b.rows) > 1
            assert len({len(row) for row in b.rows}) == 1
            assert b.title
    blocks = list(note.blocks())
    for b, after in pairwise(blocks):
        assert not (isinstance(b, Heading) and isinstance(after, Heading) and b.level == after.level), b.text


def test_figures_show_more_than_their_titles(note):
    """Lines of a thickness that no lettering has."""
    for b in note.blocks():
        if isinstance(b, Figure):
            widths = {float(w) for w in re.findall(rb'<g stroke-width="([\d.]+)"', b.svg)}
            assert widths & {1000 * of.width for of in line_types().values()}, b.title


def test_lettering_of_figures_can_be_read(note):
    """Their lettering of 3.5 mm comes out 2 mm high at least."""
    for b in note.blocks():
        if isinstance(b, Figure):
            width = float(re.search(rb'width="([\d.]+)mm"', b.svg)[1])
            assert b.width / width * LETTERS >= READABLE - 0.01, b.title


def test_numbers_are_those_of_the_steps(note, project):
    """A number that names a step and a position is a value of that step: itself, its size, or in millimetres of the drawing."""
    steps = book_of(project).steps
    labels = {plan.name: plan.labels for of in project.plans.values() for plan in (of or {}).values()}
    checked = 0
    for n in numbers(list(note.blocks())):
        if n.step not in steps or n.digits != 4 or not n.position:
            continue
        step = steps[n.step]
        values = np.atleast_1d(step.value)
        at = labels.get(step.plan, ())
        if n.position in at and len(values) == len(at) and not np.iscomplexobj(values):
            checked += isclose(abs(n.value), abs(float(values[at.index(n.position)])), rel_tol=1e-9, abs_tol=1e-12)
    assert checked > 150


def test_a_note_is_the_same_with_sheets_drawn_now_and_kept():
    """A sheet that was kept makes no steps: the note has all those that results come from."""
    with kept.unused():
        now = composed(opened("tests/projects/geneva.toml"))
    assert composed(opened("tests/projects/geneva.toml")) == composed(opened("tests/projects/geneva.toml")) == now


def test_numbers_as_written_are_their_values(note):
    for n in numbers(list(note.blocks())):
        if not n.digits or "·" in n.text or not re.fullmatch(r"−?[\d,]+", n.text):
            continue
        written = float(n.text.replace("−", "-").replace(",", "."))
        assert isclose(written, n.value, rel_tol=6e-4 if n.digits > 3 else 0.06, abs_tol=0.06 if "," in n.text else 1e-9), n


def test_numbers_agree_with_solve(note, project):
    tree = results.assemble(project, None)
    shown = {round(abs(n.value), 9) for n in numbers(list(note.blocks()))}
    for value in (tree["flywheel"]["J_flywheel"], tree["flywheel"]["D"], tree["flywheel"]["m"], tree["gear"]["a_w"],
                  tree["gear"]["eps_alpha"], tree["forces"]["balancing"]["lever"][0], tree["velocities"]["omega"]["3"][2],
                  tree["flywheel"]["M_constant"],
                  abs(complex(*tree["velocities"]["points"]["D"][2])), abs(complex(*tree["forces"]["reactions"]["F30"][0])),
                  tree["gear"]["alpha_w"]):  # fmt: skip
        assert round(abs(value), 9) in shown


def test_the_ratio_of_strokes_by_the_formula_of_the_manual(note):
    """000, 2 example 1: l_AC sin(theta/2) = 0.0803 was rounded to 0.08; K follows from asin(0.08/0.26)."""
    theta = 2 * degrees(np.arcsin(0.08 / 0.26))
    k = (180 + theta) / (180 - theta)
    assert any(isclose(n.value, k, rel_tol=1e-9) for n in numbers(list(note.blocks())))


def test_templates_hold_no_digit():
    """Numbers come from the record: a digit stands only in letters (ω_1), in names of sources and behind a dash of a remark."""
    for language in words.LANGUAGES:
        for name in phrases.names(language):
            for n, line in enumerate(phrases.text_of(language, name).splitlines(), 1):
                if line.startswith(("#", "%formula", "%figure", "%table", "%if")):
                    line = line.partition("|")[2] if "|" in line else ""
                bare = re.sub(r"\$[^$]*[^\d\s,.$][^$]*\$|\{[^{}]*\}", "", line)
                assert not re.search(r"\d", re.sub("формат[ау] А1|size A1", "", bare)), f"{name}.txt:{n}: {line}"


@pytest.mark.parametrize(("name", "sections"), [
    ("lugansk/cam_flat", ["Синтез кулачкового механизма"]),
    seldom("transport/diesel@01-T-27", ["Структурный анализ рычажного механизма",
                                  "Кинематический анализ рычажного механизма", "Силовой анализ рычажного механизма",
                                  "Синтез планетарного редуктора", "Синтез зубчатой передачи", "Синтез кулачкового механизма"]),
    seldom("lugansk/engine", ["Структурный анализ рычажного механизма", "Геометрический синтез рычажного механизма",
                        "Кинематический анализ рычажного механизма", "Силовой анализ рычажного механизма", "Расчёт маховика",
                        "Синтез зубчатой передачи", "Синтез кулачкового механизма"]),
    ("sixbar/8:3", ["Структурный анализ рычажного механизма", "Геометрические размеры механизма",
                    "Кинематический анализ рычажного механизма", "Силовой анализ рычажного механизма", "Расчёт маховика"]),
])  # fmt: skip
def test_what_a_project_lacks_is_left_out_and_the_rest_renumbered(name, sections):
    made = composed(opened(name))
    assert [(n, t) for n, t in headings(made) if n] == [(str(i), t) for i, t in enumerate(sections, 1)]
    assert not made.problems
    test_nothing_is_empty_or_unfilled(made)
    test_figures_show_more_than_their_titles(made)
    test_every_reference_leads_somewhere(made)
    test_every_figure_and_table_is_spoken_of(made)
    test_formulas_hold_no_name_of_the_program(made)


@pytest.mark.parametrize(("section", "fields", "said", "unsaid"), [
    ("structure", {"mobile": False}, "отличается от числа начальных звеньев", "является механизмом"),
    ("structure", {"turning_only": True}, "все они вращательные", "поступательных"),
    ("synthesis", {"near": False}, "следует учитывать при оценке", "незаметно"),
    ("forces", {"agree": False}, "направления сил и уравнения групп следует проверить", "Результаты совпадают"),
    ("flywheel", {"needed": False}, "маховик не нужен", "принимаем значение"),
    ("flywheel", {"close": False}, "следует увеличить", "допустима, поэтому"),
    ("flywheel", {"above": False}, "меньше предела", "больше предела"),
    ("flywheel", {"slow": False}, "превышает 30\u00a0м/с, допустимые", "для чугунного обода она допустима"),
    ("flywheel", {"even": False}, "следует учитывать", "Это мало"),
    ("gear", {"undercut": True}, "Принимаем коэффициенты", "зубья обоих колёс не подрезаются"),
    ("gear", {"overlaps": False}, "контакт зубьев прерывается", "без разрыва"),
    ("gear", {"worse": ""}, "почти одинаковы", "Сильнее скользит"),
    ("gear", {"radial": False}, "С окружностью впадин эвольвенту", "продолжаем по радиусу"),
    ("cam", {"kept": False}, "Условие нарушено", "Условие выполнено"),
    ("cam", {"exceeds_elsewhere": False}, "График угла давления", "На остальных фазах"),
    ("cam", {"round": False}, "самопересекается", "\0"),
    ("cam", {"central": True}, "Толкатель центральный", "Эксцентриситет равен"),
])  # fmt: skip
def test_what_is_said_follows_the_record(reader, section, fields, said, unsaid):
    """A sentence about a result stands only where the record bears it out; here the record says the contrary of the shaper's."""
    from importlib import import_module

    order = tables_of(template("note/order.toml"))["section"]
    module = next((of["module"] for of in order if of["template"] == section), "task")
    found = getattr(import_module(f"tmm_sheets.note.sections.{module}"), f"{section}_fields")(reader)
    assert fields.keys() <= found.keys()
    assert all(bool(found[k]) != bool(v) for k, v in fields.items())
    text = told(section, reader, found | fields)
    assert said in text
    assert unsaid not in text


def test_an_own_mechanism_without_forces(tmp_path):
    from tmm_sheets.resources import variants

    text = (variants() / "lugansk/shaper.toml").read_text(encoding="utf-8")
    text = text[: text.index("[forces]")]
    text = re.sub(r"^(mass|centre|inertia|sheets) = .*\n", "", text, flags=re.M)
    path = tmp_path / "own.toml"
    path.write_text(text, encoding="utf-8")
    made = composed(opened(str(path)))
    assert [t for n, t in headings(made) if n] == [
        "Структурный анализ рычажного механизма", "Геометрические размеры механизма", "Кинематический анализ рычажного механизма"]
    said = " ".join(plain_text(b.text) for b in made.blocks() if isinstance(b, Paragraph))
    assert "кинетостатик" not in said.lower()
    assert "маховик" not in said.lower()


def test_plural_forms():
    forms = ["лист", "листа", "листов"]
    said = {n: words.plural_form(forms, n, "ru") for n in (1, 2, 5, 11, 12, 21, 22, 25, 111, 112, 101)}
    assert said == {1: "лист", 2: "листа", 5: "листов", 11: "листов", 12: "листов", 21: "лист", 22: "листа", 25: "листов",
                    111: "листов", 112: "листов", 101: "лист"}  # fmt: skip
    assert [words.plural_form(["sheet", "sheets"], n, "en") for n in (1, 2)] == ["sheet", "sheets"]


def test_number_nodes_know_their_step(note):
    found = list(numbers(list(note.blocks())))
    assert len(found) > 800
    assert all(isinstance(n, NumberInText) and n.step for n in found)


def test_words_stay_on_the_paper_alone():
    assert words.paper() == "ru"


@pytest.mark.parametrize("language", words.LANGUAGES)
def test_no_sentence_breaks_off_before_a_number(language):
    """An optional part of a template never ends between the word for a figure and its number."""
    for name in phrases.names(language):
        for n, line in enumerate(phrases.text_of(language, name).splitlines(), 1):
            assert not re.search(r"(рис\.|табл\.|таблице|таблиці|fig\.|table)\s*(\]\]|\[\[|$)", line), f"{name}.txt:{n}"
            assert line.count("[[") == line.count("]]"), f"{name}.txt:{n}"


def test_templates_ask_for_views_and_plans_that_there_are():
    """What is found by its path is left out in silence where a project lacks it, so a name spelt wrongly would never be seen."""
    code = "".join(path.read_text("utf-8") for path in Path(composing.__file__).parents[1].rglob("*.py"))
    for name in phrases.names("ru"):
        text = phrases.text_of("ru", name)
        assert set(re.findall(r"(?:%figure |@figure:)([a-z_]+\.[a-z_]+)", text)) <= VIEWS.keys(), name
        plans = re.findall(r"(?:%formula\?? |\{#?|%if )([a-z-]+)/", text) + re.findall(r"%formulas (\S+)", text)
        assert {plan for plan in plans if not re.search(rf"[\"-]{plan.partition('-')[2] or plan}\"", code)} == set(), name


@pytest.mark.parametrize("language", ["uk", "en"])
def test_the_languages_tell_the_same(language):
    """Every template asks for the same things under the same conditions, and words.toml has the same entries."""
    assert phrases.names(language) == phrases.names("ru")
    for name in phrases.names("ru"):
        asked = {of: [m for line in phrases.text_of(of, name).splitlines() for m in _asked(line)] for of in ("ru", language)}
        assert asked[language] == asked["ru"], name
    for table, entries in phrases.words("ru").items():
        if isinstance(entries, dict) and table not in ("several", "guides", "indices", "lines"):
            assert entries.keys() <= phrases.words(language)[table].keys(), table


def _asked(line):
    """Commands with what they name, and the fields that lead to something else, of a line."""
    if line.startswith("%"):
        yield line.partition("|")[0].split("{")[0].split()[:2] if not line.startswith(("%centre", "%contents")) else line.split()[0]
    yield from sorted(re.findall(r"\{@[^{}]*\}", line))


@pytest.mark.parametrize(("language", "name", "foreign"), [
    ("en", "lugansk/shaper", "[а-яА-Я]"), seldom("uk", "press", "[ыэъёЫЭЪЁ]")])
def test_a_note_in_another_language(language, name, foreign):
    made = composed(opened(name), language)
    sources = [b for b in made.body if isinstance(b, Paragraph) and re.match(r"\d+\. ", plain_text(b.text))]
    said = [plain_text(b.text) for b in made.blocks() if isinstance(b, Paragraph) and b not in sources]
    said += [b.text for b in made.blocks() if isinstance(b, Heading)]
    said += [plain_text(r.meaning) for b in made.blocks() if isinstance(b, Where) for r in b.rows]
    said += [plain_text(cell) for b in made.blocks() if isinstance(b, NumberedTable) for row in b.rows for cell in row]
    assert not [text for text in said if re.search(foreign, text)]
    assert not made.problems
    test_nothing_is_empty_or_unfilled(made)
    test_figures_show_more_than_their_titles(made)
    test_every_reference_leads_somewhere(made)
    test_every_figure_and_table_is_spoken_of(made)


def test_arms_belong_to_the_links_of_their_index():
    """Link 2 has no part in h21,0; one digit each is told without a comma."""
    assert forces.is_of_group("h50", ("4", "5"))
    assert forces.is_of_group("h21,0", ("20", "21"))
    assert not forces.is_of_group("h21,0", ("2", "3"))
    assert forces.is_of_group("h2,10", ("2", "3"))
    assert not forces.is_of_group("h2,10", ("1", "4"))


def undrawn(name):
    """What the sections read, without any sheet."""
    return Reader(opened(name), "ru", Pictures({}), {})


def told(section, reader, fields):
    """Running text of a section with some fields."""
    scope = composing.general(reader).within(fields)
    blocks = phrases.Writer("ru", phrases.Numbering(composing.literature())).blocks(section, scope)
    return " ".join(plain_text(b.text) for b in blocks if isinstance(b, Paragraph))


def test_interference_does_not_contradict_the_conditions():
    """The ring's tip ends on the involute where z5 (z4 s/2 - 1) + 1 - z4^2 s/4 >= 0, s = sin^2 20 deg: nowhere for z4 = 15."""
    s = np.sin(np.radians(20)) ** 2
    assert 15 * s / 2 < 1 < 15**2 * s / 4
    r = undrawn("transport/diesel@01-Т-27")
    text = told("reducer", r, wheels.reducer_fields(r))
    assert "Условия соосности, сборки и соседства выполнены" in text
    assert "при 15 зубьях сателлита её не устраняет никакое число зубьев колеса 5" in text
    assert "Все условия" not in text


@pytest.mark.parametrize("name", ["conveyor", "feeder", "stirrer"])
def test_a_crank_with_a_moment_of_inertia_counts_once(name):
    r = undrawn(str(Path(__file__).parents[1] / "projects" / f"{name}.toml"))
    assert wheels.flywheel_fields(r)["J"].numbers is not None
