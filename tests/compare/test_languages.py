"""Reports of comparisons in three languages: the same numbers, every word of them, nothing of another language."""

import json
import re
from dataclasses import replace
from functools import cache
from itertools import pairwise, product

import numpy as np
import pytest

from tests.compare.form import faults
from tests.compare.languages import to_reader, told
from tests.compare.simulation import Camera, paper, photograph
from tests.few import few, seldom
from tmm_sheets.backends import dxf
from tmm_sheets.catalogue import read
from tmm_sheets.compare.measured import measurable
from tmm_sheets.compare.measured.collecting import measurables
from tmm_sheets.compare.measured.measured_lengths import NAME
from tmm_sheets.drawing.marks import Line
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.words import LANGUAGES, on_paper, tell

CYRILLIC = re.compile("[\u0400-\u04ff]")
BRACES = re.compile(r"\{\w*\}")
SAID = {"said", "where", "lang", "notes", "space"}
"""Keys of JSON whose values are told; all others are the same in every language."""
PROJECT = "lugansk/cam_flat"


@pytest.fixture(scope="module")
def sheet():
    return composed(Project(read(PROJECT)), 1)


@pytest.fixture(scope="module")
def spoiled(sheet):
    """The sheet with its longest thin line moved by 1.5 mm."""
    marks = list(sheet.drawing.marks)
    thin = [k for k, m in enumerate(marks) if isinstance(m, Line) and m.style == "thin"]
    k = max(thin, key=lambda k: abs(marks[k].b - marks[k].a))
    across = 1.5j * (marks[k].b - marks[k].a) / abs(marks[k].b - marks[k].a)
    marks[k] = marks[k]._replace(a=marks[k].a + across, b=marks[k].b + across)
    return replace(sheet.drawing, marks=tuple(marks))


@pytest.fixture(scope="module")
def drawings(spoiled, tmp_path_factory):
    """What each kind of comparison is given."""
    folder = tmp_path_factory.mktemp("drawings")

    @cache
    def of(kind):
        if kind == "measured":
            numbers = {e.id: e.value for e in measurables(Project(read(PROJECT))).entries.values()}
            rows = [f"{name};{1.3 * value if k == 4 else value:.5g}" for k, (name, value) in enumerate(numbers.items())]
            (folder / "measured.csv").write_text("\n".join(("id;measured", *rows, "")), encoding="utf-8")
            return "--measured", folder / "measured.csv"
        if kind == "dxf":
            (folder / "mine.dxf").write_bytes(dxf.render(spoiled))
            return "--sheet", 1, "--dxf", folder / "mine.dxf"
        rng = np.random.default_rng(1)
        camera = Camera(megapixels=8.0, tilt=0.1, curl=1.0, k1=-0.01, waves=(0.1, 0.1, 0.0), desk=110.0)
        (folder / "photo.jpg").write_bytes(photograph(paper(spoiled, rng, 0.1, scale=6.0), spoiled, camera, rng, 6.0).data)
        return "--sheet", 1, "--image", folder / "photo.jpg"

    return of


@pytest.fixture(scope="module")
def report(drawings, tmp_path_factory):
    """Status, text, messages and JSON of a comparison of a kind in a language."""
    folder = tmp_path_factory.mktemp("reports")

    @cache
    def of(kind, language):
        target = folder / f"{kind}-{language}.json"
        status, out, err = told(language, "compare", PROJECT, *drawings(kind), "--json", target, "-o", folder)
        return status, out, err, json.loads(target.read_text("utf-8"))

    return of


def plain(tree):
    """JSON without what is told."""
    if isinstance(tree, dict):
        return {key: plain(value) for key, value in tree.items() if key not in SAID}
    return [plain(value) for value in tree] if isinstance(tree, list) else tree


KINDS = ("measured", "dxf", "image")
each = pytest.mark.parametrize("kind", few(KINDS, "measured", "dxf"))


SOME = {"measured": LANGUAGES, "dxf": ("ru", "en")}
"""What ``make test`` asks for: tests/test_words.py holds that no text lacks its Ukrainian."""
in_every_language = pytest.mark.parametrize(
    ("kind", "language"), few(product(KINDS, LANGUAGES), *((kind, one) for kind, some in SOME.items() for one in some)))


@pytest.mark.parametrize(("kind", "languages"), [*SOME.items(), *(seldom(kind, LANGUAGES) for kind in KINDS)])
def test_only_words_differ(report, kind, languages):
    status, _, _, tree = report(kind, "ru")
    assert status == 0
    for language in languages:
        assert report(kind, language)[0] == 0
        told = report(kind, language)[3]
        assert (plain(told), [*faults(told)], told["lang"]) == (plain(tree), [], language)
    texts = {report(kind, language)[1] for language in languages}
    assert len(texts) == len(languages)


@in_every_language
def test_words_and_signs_are_the_readers(report, kind, language):
    """No brace of a text is left, and no English; a point is written in English, a comma in Russian and Ukrainian."""
    _, out, err, _ = report(kind, language)
    assert not BRACES.search(out + err)
    told = re.sub(r"\S+\.(csv|dxf|jpg|json|png|pdf)", "", out)
    sign, other = ".," if language == "en" else ",."
    assert re.search(rf"\d\{sign}\d", told)
    assert not re.search(rf"\d\{other}\d", told)
    if language == "en":
        return
    # Words in small Latin letters are names: of the project, of files, of options.
    said = re.sub(r"--\w+|\S+\.(csv|dxf|jpg|json|png|pdf)|\S*/\S*", "", out + err)
    assert set(re.findall(r"(?<![A-Za-z_'′])[a-z]{4,}(?![0-9_])", said)) <= {"lugansk", "cam", "flat"}


@each
def test_nothing_russian_is_left_in_english_but_what_stands_on_the_sheet(report, sheet, kind):
    _, out, err, _ = report(kind, "en")
    found = measurables(Project(read(PROJECT)))
    names = {view.name for view in sheet.drawing.views} | {m.text for m in sheet.drawing.marks if hasattr(m, "text")}
    names |= {e.title for e in found.entries.values()} | {e.quantity for e in found.entries.values()}
    said = out + err
    for name in sorted(names, key=len, reverse=True):
        said = said.replace(name, "")
    assert not CYRILLIC.search(said)


@pytest.mark.parametrize("kind", few(["measured", "dxf"], "measured"))
def test_nothing_russian_is_left_where_the_sheet_is_english_too(drawings, kind, tmp_path):
    with on_paper("en"):
        sheet = composed(Project(read(PROJECT)), 1)
    if any(CYRILLIC.search(view.name) for view in sheet.drawing.views):
        pytest.skip("the sheets are Russian still")
    arguments = drawings(kind)
    if kind == "dxf":
        (tmp_path / "mine.dxf").write_bytes(dxf.render(sheet.drawing))
        arguments = (*arguments[:-1], tmp_path / "mine.dxf")
    status, out, err = told("ru", "compare", PROJECT, *arguments, "-o", tmp_path, "--lang", "en")
    assert status == 0
    assert not CYRILLIC.search(out + err)


# --- the file of measured numbers -------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def templates(tmp_path_factory):
    """The template that is written for each language."""
    found = {}
    for language in LANGUAGES:
        folder = tmp_path_factory.mktemp(language)
        assert told(language, "compare", PROJECT, "--template", "-o", folder)[0] == 0
        found[language] = (folder / NAME).read_text("utf-8-sig")
    return found


HEADINGS = {"ru": "обозначение;план;положение;величина;шаги;единица;измерено",
            "uk": "позначення;план;положення;величина;кроки;одиниця;виміряно",
            "en": "id,plan,position,quantity,steps of the plan,unit,measured"}
NOT_MEASURED = {"ru": "не измерялось", "uk": "не вимірювалося", "en": "not measured"}


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_template_has_the_headings_of_its_language(templates, language):
    lines = templates[language].splitlines()
    assert lines[4] == HEADINGS[language]
    separator = HEADINGS[language][HEADINGS[language].index("plan" if language == "en" else "план") - 1]
    ids = [line.split(separator)[0] for line in lines[5:] if not line.startswith(("#", '"#'))]
    assert ids == [line.split(";")[0] for line in templates["ru"].splitlines()[5:] if not line.startswith(("#", '"#'))]


@pytest.mark.parametrize(("written", "language"), few(product(LANGUAGES, LANGUAGES), *pairwise([*LANGUAGES, LANGUAGES[0]])))
def test_a_template_is_read_in_any_language(templates, written, language, tmp_path):
    """Headings, units and what is said in place of a number, whatever the language of the command."""
    number = "46.5" if written == "en" else "46,5"
    lines = templates[written].splitlines()
    first = next(k for k, line in enumerate(lines) if line.startswith("results/r0"))
    lines[first] += number
    lines[first + 1] += NOT_MEASURED[written]
    path, target = tmp_path / "m.csv", tmp_path / "m.json"
    path.write_text("\n".join(lines), encoding="utf-8-sig")
    status, _, err = told(language, "compare", PROJECT, "--measured", path, "--json", target)
    assert status == 0, err
    assert err == ""
    (judged,) = json.loads(target.read_text("utf-8"))["findings"]
    assert (judged["row"], judged["measured"]) == ("results/r0", 46.5)
    other = tmp_path / "other.csv"
    other.write_text("\n".join(lines).replace(PROJECT, "press"), encoding="utf-8-sig")
    assert told(language, "compare", PROJECT, "--measured", other)[0] == 2


@pytest.mark.parametrize(("unit", "said"), [("rpm", {"rpm", "об/мин", "об/хв"}), ("N·m", {"N·m", "Н·м"}), ("mm", {"mm", "мм"})])
def test_units_are_said_and_read_in_every_language(unit, said):
    found = set()
    for language in LANGUAGES:
        with to_reader(language):
            found.add(tell(unit))
            assert all(measurable.unit_times(other, unit) == 1 for other in said)
    assert found == said


# --- messages ---------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("language", "message"), [
    ("ru", "такого файла нет"), ("uk", "такого файлу немає"), ("en", "there is no such file"),
])  # fmt: skip
def test_what_is_read_beside_is_told_in_the_same_language(language, message, tmp_path):
    """A picture is read in a thread of its own."""
    status, _, err = told(language, "compare", PROJECT, "--sheet", 1, "--image", tmp_path / "none.jpg")
    assert status == 2
    assert message in err


@pytest.mark.parametrize(("count", "ru", "uk"), [
    (1, "1 число: ", "1 число: "), (2, "2 числа: ", "2 числа: "), (5, "5 чисел: ", "5 чисел: "),
])  # fmt: skip
def test_plural_forms(templates, count, ru, uk, tmp_path):
    lines = templates["ru"].splitlines()
    rows = [k for k, line in enumerate(lines) if line.startswith("cam-profile/")][:count]
    for k in rows:
        lines[k] += "5"
    path = tmp_path / "m.csv"
    path.write_text("\n".join(lines), encoding="utf-8-sig")
    for language, said in (("ru", ru), ("uk", uk), ("en", "1 number: " if count == 1 else f"{count} numbers: ")):
        status, out, _ = told(language, "compare", PROJECT, "--measured", path)
        assert status == 0
        assert f"\n{said}" in out
