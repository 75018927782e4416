"""The protocol in three languages: the same steps and numbers, whole sentences, each in its own letters."""

import re

import pytest

from tests.catalogues import read
from tests.few import few
from tmm_sheets import catalogue, protocols, results, words
from tmm_sheets.compare.measured import collecting
from tmm_sheets.construction import rules
from tmm_sheets.construction.protocol import sentences
from tmm_sheets.construction.scale import times
from tmm_sheets.construction.step import Plan
from tmm_sheets.project import Project
from tmm_sheets.record import recording
from tmm_sheets.result_files import json_pieces

PROJECTS = ("lugansk/engine", "lugansk/cam_flat", "sixbar/9:4", "transport/crusher@12-СДМ-1908", "tests/projects/feeder.toml")
CYRILLIC = re.compile("[\u0400-\u04ff]+")
RUSSIAN_ONLY = re.compile("[ыэъё]", re.IGNORECASE)
NUMBER = re.compile(r"\d+(?:[.,]\d+)?")


@pytest.fixture(scope="module", params=few(PROJECTS, "lugansk/cam_flat", "tests/projects/feeder.toml"))
def protocol(request):
    """Lines in each language, without the scale factors behind the titles, and the names in its file."""
    found = {}
    for language in words.LANGUAGES:
        with words.on_paper(language):
            found[language] = [line.split("; μ_")[0] for line in protocols.lines(Project(catalogue.read(request.param)), None)]
    variant = catalogue.read(request.param)
    return found, {word for named in (*variant.force, *variant.moment, *variant.guide) for word in CYRILLIC.findall(named.name)}


def test_every_language_tells_the_same_steps(protocol):
    steps = {language: [re.match(r" *\d+\.|", line)[0] for line in lines] for language, lines in protocol[0].items()}
    assert len(steps["ru"]) > 300
    assert steps["en"] == steps["uk"] == steps["ru"]


def test_every_language_has_the_same_numbers(protocol):
    """The order of words is a language's own, its numbers are not; only the decimal sign differs."""

    def numbers(line):
        return sorted(NUMBER.findall(line.replace(",", ".")))

    lines = protocol[0]
    assert [(ru, line) for language in ("en", "uk") for ru, line in zip(lines["ru"], lines[language], strict=True)
            if numbers(ru) != numbers(line)] == []


def test_each_language_has_its_own_letters(protocol):
    lines, names = protocol
    assert {word for line in lines["en"] for word in CYRILLIC.findall(line)} <= names
    assert [line for line in lines["uk"] if RUSSIAN_ONLY.search(line)] == []
    assert [line for line in lines["en"] if re.search(r"\d,\d", line)] == []
    assert [line for line in lines["en"] + lines["uk"] if re.search(r"[{}]", line)] == []
    assert {"ru", "uk"} == {x for x in lines if any(re.search(r"\d,\d", line) for line in lines[x])}


@pytest.mark.parametrize("other", few(("en", "uk"), "en"))
def test_names_ids_and_numbers_are_the_same_in_every_language(other):
    """What programs read has no language: steps, rules, results, what can be measured (here with Coriolis and inertia)."""
    found = {}
    for language in ("ru", other):
        with words.on_paper(language):
            project = Project(catalogue.read("tests/projects/feeder.toml"))
            record, _ = recording.record(project)
            entries = collecting.measurables(project).entries
            solved = "".join(json_pieces(results.assemble(project, None)))
            found[language] = ([plan["steps"] for plan in record["plans"]], sorted(record["steps"]), sorted(record["rules"]),
                               record["results"], list(entries), [e.value for e in entries.values()], solved)
            assert any(name.endswith("^k") for name in entries)
            assert any(re.search(r"/Fi\d", name) for name in entries)
    assert found[other] == found["ru"]


@pytest.mark.parametrize(("names", "told"), [
    (("u", "v"), {"ru": "Через точку A параллельно u и через точку B параллельно v проведём прямые до пересечения в точке C.",
                  "en": "Through A parallel to u and through B parallel to v draw lines; they meet at point C.",
                  "uk": "Через точку A паралельно u і через точку B паралельно v проведемо прямі до перетину в точці C."}),
    (("⟂u", "v"), {"ru": "Через точку A перпендикулярно u и через точку B параллельно v проведём прямые до пересечения в точке C.",
                   "en": "Through A perpendicular to u and through B parallel to v draw lines; they meet at point C.",
                   "uk": "Через точку A перпендикулярно до u і через точку B паралельно v проведемо прямі до перетину в точці C."}),
    (("u", "⟂v"), {"ru": "Через точку A параллельно u и через точку B перпендикулярно v проведём прямые до пересечения в точке C.",
                   "en": "Through A parallel to u and through B perpendicular to v draw lines; they meet at point C.",
                   "uk": "Через точку A паралельно u і через точку B перпендикулярно до v проведемо прямі до перетину в точці C."}),
    (("⟂u", "⟂v"), {"ru": "Через точку A перпендикулярно u и через точку B перпендикулярно v "
                          "проведём прямые до пересечения в точке C.",
                    "en": "Through A perpendicular to u and through B perpendicular to v draw lines; they meet at point C.",
                    "uk": "Через точку A перпендикулярно до u і через точку B перпендикулярно до v "
                          "проведемо прямі до перетину в точці C."}),
])  # fmt: skip
def test_perpendiculars_are_said_as_such(names, told):
    plan = Plan("p", "", "m")
    a, b = plan.add("A", rules.GIVEN, 0j), plan.add("B", rules.GIVEN, 1 + 0j)
    u, v = plan.add(names[0], rules.GIVEN_DIRECTION, 1 + 0j), plan.add(names[1], rules.GIVEN_DIRECTION, 1j)
    plan.add("C", rules.LINE_LINE, a, u, b, v)
    for language, text in told.items():
        with words.on_paper(language):
            assert list(sentences(plan, 0, float))[-1] == text


def test_units_of_a_plan_that_no_sheet_draws():
    plan = Plan("p", "", "m/s2")
    plan.add("H", rules.GIVEN_LENGTH, 2.5)
    for language, text in {"ru": "Возьмём отрезок H = 2,5 м/с².", "en": "Take the segment H = 2.5 m/s².",
                           "uk": "Візьмемо відрізок H = 2,5 м/с²."}.items():
        with words.on_paper(language):
            assert list(sentences(plan, 0, float, "m/s2")) == [text]


def test_how_many_times():
    said = {"ru": ("1 раз", "2 раза", "5 раз", "2,5 раза", "11 раз", "22 раза"),
            "uk": ("1 раз", "2 рази", "5 разів", "2,5 раза", "11 разів", "22 рази"),
            "en": ("1 time", "2 times", "5 times", "2.5 times", "11 times", "22 times")}
    for language, expected in said.items():
        with words.on_paper(language):
            assert tuple(times(n) for n in (1, 2, 5, 2.5, 11, 22)) == expected


@pytest.mark.parametrize("language", ["ru", "uk"])
def test_fields_of_the_texts_stay(language):
    """A translation has the fields of its text, no more and no fewer: in another order, but none is lost."""

    def fields(text):
        return sorted(set(re.findall(r"(?<!\{)\{(?:\d|[a-z]\w*)(?::[^}]*)?\}(?!\})|\{\{\w+\}\}", text)))

    wrong = [m.id for m in read(language) if m.id and isinstance(m.id, str) and m.string and "_{" not in m.id
             and fields(m.id) != fields(m.string)]
    assert wrong == []
