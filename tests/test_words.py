"""Words in three languages: nothing missing, nothing idle; the locale and ``--lang`` choose them, in every process."""

import ast
import json
import os
import re
import subprocess
import sys
import tomllib
from contextvars import ContextVar
from functools import cache
from pathlib import Path

import pytest
from babel.messages.mofile import read_mo

from tests import catalogues
from tests.sources import MODULES, every_node, syntax
from tmm_sheets import __main__, cli, words
from tmm_sheets.errors import BadInput
from tmm_sheets.output import batch
from tmm_sheets.output.building import Order
from tmm_sheets.task import variant

ROOT = Path(__file__).parents[1]
COMMANDS = ((), *((name,) for name in cli.NAMES))
CYRILLIC = re.compile("[\u0400-\u04ff]")
BOTH = [*((language, catalogues.DOMAIN) for language in words.LANGUAGES), ("ru", catalogues.CLICK), ("uk", catalogues.CLICK)]
either = pytest.mark.parametrize(("language", "domain"), BOTH)


@cache
def template():
    """All texts of the program and its templates."""
    return catalogues.collected()


def run(*arguments):
    return __main__.run(list(arguments))


def told(capsys, *arguments):
    """Status, output and messages of a command."""
    status = run(*arguments)
    return status, *capsys.readouterr()


def texts(catalogue):
    """Translations by context and text; a compiled catalogue has its contexts as bytes."""
    found = {}
    for m in catalogue:
        if m.id:
            context = m.context.decode() if isinstance(m.context, bytes) else m.context
            found[context, tuple(m.id) if m.pluralizable else m.id] = tuple(m.string) if m.pluralizable else m.string
    return found


# --- catalogues -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("language", words.LANGUAGES)
def test_no_text_is_missing_or_idle(language):
    there = catalogues.read(language)
    assert set(texts(there)) == set(texts(template()))
    assert catalogues.missing(there) == []


def test_no_text_hides_from_the_catalogues():
    """What collects the texts does not look into f-strings."""
    known = {text[0] if isinstance(text, tuple) else text for _, text in texts(template())}
    asked = catalogues.KEYWORDS.keys() - {"tr_in", "of_language"}  # these begin with the context
    for module in MODULES:
        for node in every_node(syntax(module)):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in asked:
                said = node.args[0]
                assert not isinstance(said, ast.Constant) or said.value in known, (module, said.lineno, said.value)


def test_options_that_are_told_exist():
    """Every --option in a text of the program is one of a command; those of other programs are told apart by their names."""
    every = (cli.commands, *cli.commands.every().values())
    options = {name for command in every for p in command.params for name in p.opts} | {"--help"}
    found = {text: set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", str(text))) for _, text, _ in catalogues.of_program()}
    assert any(found.values())
    assert {text: names - options for text, names in found.items() if names - options} == {}


@pytest.mark.parametrize("language", ["ru", "uk"])
def test_no_word_of_click_is_missing(language):
    there = catalogues.read(language, catalogues.CLICK)
    assert set(texts(catalogues.of_click())) <= set(texts(there))
    assert catalogues.missing(there) == []


@either
def test_translations_have_the_fields_and_braces_of_the_text(language, domain):
    assert catalogues.problems(catalogues.read(language, domain)) == []


@pytest.mark.parametrize(("meant", "said"), [
    ("{n} of {m}", "{n} из {k}"), ("{x:.2f} mm", "мм"), ("M_{{r}} = {x}", "M_{{с} = {x}"), ("M_{r}^{red}", "M_{с^{пр}"),
])  # fmt: skip
def test_a_planted_slip_is_found(meant, said):
    catalogue = catalogues.Catalog("ru")
    catalogue.add(meant, said)
    assert catalogues.problems(catalogue) == [meant]


@either
def test_compiled_catalogues_are_current(language, domain):
    with catalogues.path_of(language, "mo", domain).open("rb") as file:
        compiled = texts(read_mo(file))
    written = texts(catalogues.read(language, domain))
    assert {key: said for key, said in compiled.items() if said != key[1]} == {
        key: said for key, said in written.items() if said and all(said) and said != key[1]}


def test_ukrainian_has_no_russian_letters():
    for domain in (catalogues.DOMAIN, catalogues.CLICK):
        assert [s for s in texts(catalogues.read("uk", domain)).values() if re.search("[ыэёъЫЭЁЪ]", str(s))] == []
        assert [s for s in texts(catalogues.read("ru", domain)).values() if re.search("[іїєґІЇЄҐ]", str(s))] == []


def test_patterns_are_those_of_the_schemes():
    """What schemes fill in is found again in the files that they make."""
    rows = {tomllib.loads(f"x = {found}")["x"] for path in (ROOT / "variants").glob("*/*.toml")
            for found in re.findall(r'^(?:variant|designation) = (".*\$.*")$', path.read_text("utf-8"), re.MULTILINE)}  # fmt: skip
    assert len(rows) >= 3
    for row in rows:
        filled = re.sub(r"\$\w+", "12", row)
        assert CYRILLIC.search(filled)
        with words.on_paper("en"):
            assert not CYRILLIC.search(words.of_file(filled)), filled
        with words.on_paper("ru"):
            assert words.of_file(filled) == filled


def test_somebodys_own_text_stands():
    with words.on_paper("en"):
        assert words.of_file("Пресс Иванова {x}") == "Пресс Иванова {x}"


# --- help -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("command", COMMANDS, ids=lambda c: "".join(c) or "tmm-sheets")
def test_help_in_english_has_no_cyrillic(command, capsys):
    status, out, _ = told(capsys, *command, "--lang", "en", "--help")
    assert status == 0
    assert not CYRILLIC.search(out)


@pytest.mark.parametrize("language", ["ru", "uk"])
@pytest.mark.parametrize("command", COMMANDS, ids=lambda c: "".join(c) or "tmm-sheets")
def test_help_in_another_language_has_no_english_sentence(command, language, capsys):
    status, out, _ = told(capsys, *command, "--lang", language, "--help")
    assert status == 0
    assert not re.search(r"\b[A-Za-z]?[a-z]+ [a-z]+ [a-z]+\b", out), out
    assert not re.search("Usage|Options|Commands|default|message", out)
    assert len(CYRILLIC.findall(out)) > 100


def test_wrong_usage_is_told_in_the_language(capsys):
    """In one process, one language after another: nothing of one stays for the next."""
    before = dict(os.environ)
    first = {"ru": "Применение:", "uk": "Використання:", "en": "Usage:"}
    for language in ("ru", "en", "uk", "ru"):
        status, _, err = told(capsys, "solve", "--lang", language)
        assert status == 2
        assert err.startswith(first[language])
        assert bool(CYRILLIC.search(err)) == (language != "en")
        assert "Missing argument" not in err or language == "en"
    assert dict(os.environ) == before
    assert told(capsys, "solve")[2].startswith("Usage:")
    assert (words.reader(), words.paper(), words.asked()) == ("en", "ru", "")


def test_wrong_value_of_the_option_itself(capsys, monkeypatch):
    monkeypatch.setenv("LANGUAGE", "uk")
    status, _, err = told(capsys, "list", "--lang", "de")
    assert status == 2
    assert "'de' немає серед 'ru', 'uk', 'en'" in err


# --- which language -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("environment", "language"), [
    ({}, "en"), ({"LANG": "ru_RU.UTF-8"}, "ru"), ({"LANG": "C"}, "en"), ({"LANG": "POSIX", "LC_CTYPE": "ru_RU.UTF-8"}, "en"),
    ({"LANG": "ru_RU.UTF-8", "LC_MESSAGES": "uk_UA"}, "uk"), ({"LC_MESSAGES": "uk_UA", "LC_ALL": "en_GB.UTF-8"}, "en"),
    ({"LANGUAGE": "de:uk", "LC_ALL": "ru_RU"}, "uk"), ({"LANGUAGE": "de:fr"}, "en"), ({"LANGUAGE": "", "LANG": "uk_UA"}, "uk"),
    ({"LANG": "en_US.UTF-8"}, "en"), ({"LC_ALL": "de_DE"}, "en"), ({"LC_ALL": "ru"}, "ru"), ({"LANG": "ru_UA.KOI8-U@x"}, "ru"),
])  # fmt: skip
def test_locale_chooses(environment, language):
    assert words.of_locale(environment) == language


def alone(*arguments, **environment):
    """A command in a process of its own, with nothing of the locale but this."""
    kept = {k: v for k, v in os.environ.items() if k not in ("LANGUAGE", "LANG") and not k.startswith("LC_")}
    return subprocess.run([sys.executable, "-m", "tmm_sheets", *arguments], capture_output=True, cwd=ROOT, check=False, timeout=60,
                          encoding="utf-8", env={**kept, "PYTHONPATH": str(ROOT), **environment})  # fmt: skip


def test_a_folder_is_a_language(tmp_path):
    for name in ("uk", "en", "de", ".git"):
        (tmp_path / name).mkdir()
    (tmp_path / ".DS_Store").write_text("")
    (tmp_path / "notes.txt").write_text("")
    assert words.languages(tmp_path) == ("de", "uk", "en")


@pytest.mark.parametrize(("asked", "language"), [
    ("English_United States.1252", "en"), ("Russian_Russia.1251", "ru"), ("Ukrainian_Ukraine", "uk"), ("German_Germany", "en")])
def test_names_of_windows_with_a_language_without_words(monkeypatch, asked, language):
    """Such a language says in English what it is called, too."""
    monkeypatch.setattr(words, "LANGUAGES", ("de", *words.LANGUAGES))
    assert words.of_locale({"LANG": asked}) == language


def test_forms_of_a_number_follow_the_catalogue():
    assert [words.plural_form(["a", "b", "c"], n, "uk") for n in (0, 1, 2, 5, 11, 21, 104, 111)] == list("cabccabc")
    assert [words.plural_form(["a", "b"], n, "ru") for n in (1, 2, 21)] == list("abb")  # no third form: the last for all but one


def test_a_process_of_its_own_speaks_the_locale():
    assert alone("solve", LANG="ru_RU.UTF-8").stderr.startswith("Применение:")
    assert alone("solve", LANG="ru_RU.UTF-8", LC_ALL="C").stderr.startswith("Usage:")
    assert alone("solve", "--lang", "uk", LANG="ru_RU.UTF-8").stderr.startswith("Використання:")
    assert alone("solve", "--lang=en", LANGUAGE="uk").stderr.startswith("Usage:")
    assert "Строгальный станок" in alone("list", LC_ALL="ru_RU.UTF-8").stdout


def test_what_follows_two_hyphens_is_no_option(capsys):
    status, _, err = told(capsys, "solve", "--", "--lang=ru")
    assert status == 2
    assert not CYRILLIC.search(err)


# --- messages -------------------------------------------------------------------------------------------------------

SLIPS = [("length", 'length = "0.08 m"', 'length = "-0.08 m"'), ("unit", 'length = "0.08 m"', 'length = "80 kg"'),
         ("bare", 'length = "0.08 m"', "length = 80"), ("key", "[crank]\n", "[crank]\nlenght = 1\n"),
         ("sense", 'sense = "clockwise"', 'sense = "left"'), ("outer", 'outer = ["B"', 'outer = ["K"'),
         ("toml", "[crank]", "[crank"),
         ("sheets", '"flywheel", "gear"', '"flywhel", "gear"'), ("kind", "kind = 5", "kind = 4"), ("missing", 'pivot = "A"\n', ""),
         ("mass", 'mass = "', 'mass = "many '), ("link", 'link = "1"', 'link = "0"'),
         ("order", 'guide = "x–x"', 'guide = "y–y"')]  # fmt: skip


@pytest.mark.parametrize(("old", "new"), [slip[1:] for slip in SLIPS], ids=[slip[0] for slip in SLIPS])
def test_a_bad_file_is_told_at_the_same_places(old, new, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "variants" / "lugansk" / "shaper.toml").read_text("utf-8")
    assert old in text
    Path("my.toml").write_text(text.replace(old, new, 1), encoding="utf-8")
    found = {language: told(capsys, "check", "my.toml", "--lang", language) for language in words.LANGUAGES}
    assert found["en"][0] == found["ru"][0] == found["uk"][0]
    assert found["en"][0] == 2
    places = {language: re.findall(r"^my\.toml:\d+: (?:[a-z_]+[\w.\[\]]*(?=: ))?", err, re.MULTILINE)
              for language, (_, _, err) in found.items()}  # fmt: skip
    assert places["en"] == places["ru"] == places["uk"] != []
    for language in ("ru", "uk"):
        for line in found[language][2].splitlines():
            assert not re.search(r"\b(?:expected|unknown|not|must|should|needs|write|known|the|is)\b", line), line
    assert not CYRILLIC.search(re.sub(r'"[^"]*"|x–x', "", found["en"][2]))


def test_an_error_names_its_value_once(monkeypatch):
    """Whether a message names the value is known by its kind, not looked for in its words."""
    text = (ROOT / "variants" / "lugansk" / "shaper.toml").read_text("utf-8").replace('"0.08 m"', '"0.08 kg"', 1)
    monkeypatch.setattr(words, "_reader", ContextVar("reader", default="ru"))
    with pytest.raises(BadInput) as e:
        variant.parse(text, "my.toml")
    assert str(e.value).count("0.08 kg") == 1
    assert "ожидается длина, а не '0.08 kg'" in str(e.value)


def test_english_messages_have_no_cyrillic():
    assert [m.id for m in template() if m.id and any(f.startswith("tmm_sheets/") for f, _ in m.locations)
            and CYRILLIC.search("".join(m.id)) and not catalogues.read("en").get(m.id, m.context).string] == []  # fmt: skip


# --- building -------------------------------------------------------------------------------------------------------


def test_another_language_is_another_sheet(tmp_path, capsys):
    arguments = ("build", "lugansk/cam_flat", "--format", "svg", "-o", str(tmp_path))
    russian, english = (run(*arguments) == 0 and (tmp_path / "sheet1.svg").read_text("utf-8") for arguments in
                        (arguments, (*arguments, "--lang", "en")))  # fmt: skip
    assert "unchanged" not in capsys.readouterr().err
    assert 'xml:lang="ru"' in russian
    assert "Кулачок с плоским толкателем. Синтез кулачкового механизма" in russian
    assert 'xml:lang="en"' in english
    assert "Cam with a flat-faced follower. Synthesis of the cam mechanism" in english
    assert run(*arguments, "--lang", "en") == 0
    assert "unchanged" in capsys.readouterr().err


def test_own_title_stands_in_every_language(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "variants" / "lugansk" / "cam_flat.toml").read_text("utf-8")
    own = re.sub(r'(?m)^title = ".*"', 'title = "Мой кулачок"\nlanguage = "uk"', text, count=1)
    Path("my.toml").write_text(own, encoding="utf-8")
    assert run("build", "my.toml", "--format", "svg,pdf", "-o", "out") == 0
    assert "Мой кулачок. Синтез кулачкового механізму" in Path("out/sheet1.svg").read_text("utf-8")
    assert b"/Lang (uk)" in Path("out/sheet1.pdf").read_bytes()


@pytest.mark.parametrize("workers", [1, 2])
def test_an_order_takes_its_languages_along(workers, tmp_path):
    """In processes of their own, which know nothing of the options of the command."""
    order = Order((), ("svg",), language="en", reader="uk", output=tmp_path, jobs=workers)
    tasks = batch.tasks(("lugansk/cam_flat", "lugansk/cam_rocker", "no/such"))
    done = {o.project: o for o in batch.carry_out(tasks, order)}
    assert (words.reader(), words.paper()) == ("en", "ru")
    assert "невідомий проєкт" in done["no/such"].problem
    assert 'xml:lang="en"' in (tmp_path / "lugansk-cam_flat" / "sheet1.svg").read_text("utf-8")
    assert 'xml:lang="en"' in (tmp_path / "lugansk-cam_rocker" / "sheet1.svg").read_text("utf-8")


@pytest.mark.trial
def test_an_order_takes_its_languages_along_to_a_fresh_process(tmp_path, monkeypatch):
    """As on systems without fork, and on a cluster: nothing is inherited but the environment."""
    monkeypatch.setattr(batch.multiprocessing, "get_all_start_methods", lambda: ["spawn"])
    monkeypatch.setattr(batch.multiprocessing, "get_context", lambda method, get=batch.multiprocessing.get_context: get("spawn"))
    test_an_order_takes_its_languages_along(2, tmp_path)


# --- what a project is called ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("project", ["lugansk/shaper", "sixbar/3:2", "transport/diesel@01-Т-27", "press"])
def test_show_in_english_and_ukrainian(project, capsys):
    status, out, _ = told(capsys, "show", project, "--lang", "en")
    assert status == 0
    structure = out[out.index("Links\n"):]
    assert not CYRILLIC.search(structure.replace("кулиса", "")), structure
    assert not CYRILLIC.search(out.splitlines()[0].replace("01-Т-27", ""))
    status, out, _ = told(capsys, "show", project, "--lang", "uk")
    assert status == 0
    assert "стояк" in out
    assert "Формула будови" in out


def test_json_is_the_same_in_every_language(capsys):
    found = [json.loads(told(capsys, "solve", "lugansk/shaper", "--json", "-", "--lang", one)[1]) for one in words.LANGUAGES]
    assert found[0] == found[1] == found[2]
    found = [told(capsys, "list", "--json", "--lang", language)[1] for language in words.LANGUAGES]
    assert found[0] == found[1] == found[2]
