"""README and docs/ say what is so: links lead somewhere, commands can be typed, messages are the program's, tables are current."""

import importlib
import io
import re
import shlex
import shutil
import tomllib
from functools import cache
from pathlib import Path

import click
import pytest
from PIL import Image

from tests import catalogues, docs, docs_site, figures, pictures
from tests.few import few
from tmm_sheets import __main__, catalogue, cli, resources
from tmm_sheets.backends import dxf_frame
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.project import Project
from tmm_sheets.task import keys, schema, seldom_tables, variant

ROOT = docs.ROOT
TEXTS = {p.relative_to(ROOT).as_posix(): p.read_text(encoding="utf-8") for p in docs.PAPERS}
EVERYWHERE = "\n".join(TEXTS.values())
SECTIONS = [f.alias or name for name, f in variant.Variant.model_fields.items()]
FENCED = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def test_readmes_are_short():
    assert all(len(TEXTS[paper].encode()) <= 8000 for paper in ("README.md", "README.ru.md"))


def test_docs_stay_short():
    """What is said twice is said once; 45,000 words were not read."""
    assert sum(len(text.split()) for paper, text in TEXTS.items() if re.fullmatch(r"docs/[\w-]+\.md", paper)) <= 33_500


def test_the_two_commands_and_the_picture_come_first():
    for paper in ("README.md", "README.ru.md"):
        first = TEXTS[paper].split("\n##")[0]
        assert re.findall(r"^    (make.*?)  ", first, re.MULTILINE) == ["make", "make test"]
        picture = ROOT / re.search(r"!\[.*\]\((.*)\)", first)[1]
        assert picture.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
        assert picture.stat().st_size < 400_000


def test_papers_travel_in_the_sdist():
    build = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["hatch"]["build"]
    assert {"README.md", "README.ru.md", "docs"} <= set(build["targets"]["sdist"]["include"])


def test_the_wheel_has_what_is_read_and_no_more():
    """Catalogues are read compiled, pictures by readers of the README; the package is typed."""
    wheel = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["hatch"]["build"]["targets"]["wheel"]
    left_out = {name.removeprefix("/") for name in wheel["exclude"]} - {"*.po"}
    assert {"templates/pictures", "templates/fonts/build.py"} <= left_out
    assert all((ROOT / name).exists() for name in left_out)
    written = {f"templates/fonts/{font}.lff" for font in (dxf_frame.COMMON, dxf_frame.OWN)}  # beside each DXF
    assert not written & left_out
    assert wheel["sources"] == {"templates": "tmm_sheets/_templates", "variants": "tmm_sheets/_variants"}
    assert (ROOT / "tmm_sheets/py.typed").is_file()
    for compiled in (p.with_suffix(".mo") for p in (ROOT / "templates/locale").rglob("*.po") if p.parts[-3] != "en"):
        assert compiled.is_file(), compiled


def test_the_docker_file_says_that_nobody_built_it():
    text = (ROOT / "Dockerfile").read_text(encoding="utf-8")
    assert "Built by nobody here" in text
    extras = re.search(r'"/src\[(.*)\]"', text)[1].split(",")
    known = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    assert {*extras} <= {*known}


# --- links ----------------------------------------------------------------------------------------------------------


def anchors(text):
    """Anchors of the headings, as forges make them: small letters, hyphens for spaces, no other signs."""
    headings = re.findall(r"^#+ (.+)$", FENCED.sub("", text), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", h.lower()).replace(" ", "-") for h in headings}


def links(text):
    without_code = re.sub(r"`[^`\n]*`", "", FENCED.sub("", text))
    return re.findall(r"\[[^\]]*\]\(([^)\s]+)\)", without_code)


def test_links_lead_somewhere():
    for paper, link in ((paper, link) for paper, text in TEXTS.items() for link in links(text)):
        if re.match(r"[a-z]+:", link):
            continue
        place, _, anchor = link.partition("#")
        target = (ROOT / paper).parent / place if place else ROOT / paper
        assert target.exists(), f"{paper}: {link}"
        assert not anchor or anchor in anchors(target.read_text(encoding="utf-8")), f"{paper}: {link}"


def test_links_are_found():
    text = "# A `b` – c?\n[x](y.md#z) `[no](no)` [c](#a-b--c)\n```\n# d\n```\n"
    assert links(text) == ["y.md#z", "#a-b--c"]
    assert anchors(text) == {"a-b--c"}


def test_files_named_in_code_are_there():
    """Modules move: a path in backticks is one of this tree, but for places to fill in and what the program writes."""
    for name in re.findall(r"`((?:tmm_sheets|templates|variants|tests|docs)/[^`<>*]*)`", EVERYWHERE):
        assert (ROOT / name).exists(), name


# --- commands -------------------------------------------------------------------------------------------------------


def shown(text):
    """Lines of code blocks, fenced or indented, and code in the text: what can be typed, without its comment."""
    outside = FENCED.sub("", text)
    lines = [line for language, block in FENCED.findall(text) if language in ("", "sh") for line in block.splitlines()]
    lines += [line.strip() for line in outside.splitlines() if line.startswith("    ")]
    lines += re.findall(r"`((?:tmm-sheets|make)[^`\n]*)`", outside)
    return [re.sub(r"\s+#.*", "", line) for line in lines]


def typed(text, program):
    return [shlex.split(line)[1:] for line in shown(text) if re.match(rf"{program}( |$)", line)]


def parsed(arguments):
    """Reads the arguments as the program does, without running anything."""
    context = click.Context(cli.commands, info_name="tmm-sheets", **cli.commands.context_settings)
    name, command, rest = cli.commands.resolve_command(context, arguments)
    return command.make_context(name, rest, parent=context)


def test_commands_can_be_typed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "ciphers.txt").write_text("press\n")
    for arguments in typed(EVERYWHERE, "tmm-sheets"):
        if arguments[:1] not in ([], ["COMMAND"]) and "--help" not in arguments:
            with parsed(arguments):
                pass


def test_commands_are_found():
    assert len(typed(EVERYWHERE, "tmm-sheets")) > 40
    text = "    make help  # x\n```toml\na = 1\n```\n```\ntmm-sheets list\n```\n`tmm-sheets show a` `make` [m](n)\n"
    assert typed(text, "tmm-sheets") == [["list"], ["show", "a"]]
    assert typed(text, "make") == [["help"], []]


def test_wrong_commands_are_found():
    for line in ("draw press", "build press --colour red", "list press screen", "plot press --tile a5", "show"):
        with pytest.raises(click.UsageError):
            parsed(line.split())


def test_make_targets_and_modules_are_there():
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
    assert {t for arguments in typed(EVERYWHERE, "make") for t in arguments if "=" not in t} <= targets
    for module in re.findall(r"python -m (tests[.\w]*)", EVERYWHERE):
        place = ROOT / module.replace(".", "/")
        assert place.with_suffix(".py").is_file() or (place / "__main__.py").is_file()


def test_extras_are_there():
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    assert set(re.findall(r"\.\[(\w+)\]", EVERYWHERE)) <= set(extras)


def first_project():
    """Commands of the way to a first own project."""
    return typed(TEXTS["README.md"].split("## Your first own project")[1].split("\n##")[0], "tmm-sheets")


def test_the_first_project_works(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    commands = first_project()
    assert len(commands) == 11
    for arguments in commands:
        if arguments[0] == "page":  # tests/living makes one of all sheets
            arguments += SHORTER["page my.toml -o"]
        assert __main__.run(arguments) == __main__.DONE, (arguments, capsys.readouterr().err)
    assert {p.name for p in Path("out/my").iterdir()} >= {"sheet1.dxf", "sheet4.pdf", "sheet1-a4.pdf", "measured.csv"}


def test_modules_of_the_tests_can_be_started():
    """What docs tell to run as ``python -m tests...`` is imported without an error, and does something when it is started."""
    modules = set(re.findall(r"python -m (tests[.\w]*)", EVERYWHERE))
    assert len(modules) > 15
    for name in modules:
        module = importlib.import_module(name if not (ROOT / name.replace(".", "/")).is_dir() else f"{name}.__main__")
        assert "__main__" in Path(module.__file__).read_text(encoding="utf-8")


# --- pages in three languages ---------------------------------------------------------------------------------------


def test_the_tutorial_is_drawn_as_it_stands(tmp_path, monkeypatch):
    """Piece by piece the file is understood, and the pictures are what its commands draw."""
    monkeypatch.chdir(tmp_path)
    steps = pictures.steps(TEXTS["docs/tutorial.md"])
    assert len(steps) == 4
    for name, text in steps.items():
        Path("my.toml").write_text(text, encoding="utf-8")
        assert __main__.run(["check", "my.toml", "--scheme", f"{name}.svg", "--lang", "ru"]) == __main__.DONE
        assert Path(f"{name}.svg").read_bytes() == (ROOT / f"docs/pictures/{name}.svg").read_bytes(), "run: make pictures"


@pytest.mark.parametrize("name", few([*pictures.GROUPS, "class3"], "assur5"))
def test_the_kinds_of_groups_are_drawn_as_they_are(name, tmp_path):
    pictures.scheme(pictures.kinds()[name], tmp_path / "my.svg")
    assert (tmp_path / "my.svg").read_bytes() == (ROOT / f"docs/pictures/{name}.svg").read_bytes(), "run: make pictures"


def test_the_tutorial_is_the_same_in_three_languages():
    """Blocks to be typed, and the pictures; so is the page of the kinds of groups."""
    for page in ("tutorial.md", "assur.md"):
        said = [FENCED.findall(text) + re.findall(r"^    tmm.*|pictures/\w+\.svg", text, re.MULTILINE)
                for text in (TEXTS[f"docs/{folder}{page}"] for folder in ("", "ru/", "uk/"))]
        assert said[0] == said[1] == said[2]


@pytest.mark.parametrize("language", ["ru", "uk"])
def test_messages_are_those_of_the_language(language):
    """What a page says of a message is about one that the program tells."""
    told = [message.string for message in catalogues.read(language)]
    rows = re.findall(r"^\| `(.*?)` \|", TEXTS[f"docs/{language}/messages.md"], re.MULTILINE)
    assert len(rows) > 15
    assert [row for row in rows if not any(row in str(s) for s in told)] == []


def test_the_gallery_has_every_kind_of_sheet():
    """Each arrangement with a command that makes it and its picture."""
    shown = pictures.gallery(TEXTS["docs/gallery.md"])
    arrangements = {p.stem for p in (ROOT / "templates/sheets").glob("*.toml")}
    assert arrangements - {*shown} == {"forces"}  # of a mechanism with more groups than the shipped ones have
    for name, (_, project, _, number) in shown.items():
        task = catalogue.read(str(ROOT / project) if project.endswith(".toml") else project)
        assert Project(task).sheets[int(number) - 1] == name
        assert (ROOT / f"docs/pictures/{name}.png").stat().st_size < 60_000


def test_pages_of_the_site():
    """Every paper has its place; links of the READMEs lead to pages."""
    pages = set(re.findall(r"[\w/-]+\.md", (ROOT / "mkdocs.yml").read_text("utf-8").split("nav:")[1]))
    own = {*docs_site.FIRST, "api.md"}
    assert pages - own == {paper.removeprefix("docs/") for paper in TEXTS if paper.startswith("docs/")}
    text = "[a](docs/page.md#b) ![c](templates/pictures/d.png) [e](LICENSE) [f](README.md) [g](https://h) `[i](docs/j.md)`"
    assert docs_site.moved(text, "ru/index.md").startswith(
        "[a](../page.md#b) ![c](../pictures/d.png) e [f](../index.md) [g](https://h)")


def test_no_link_of_the_site_is_dead():
    """Files of the repository that pages link to are put into the site, whose making fails on a link to nothing."""
    papers = {paper.removeprefix("docs/"): text for paper, text in TEXTS.items() if paper.startswith("docs/")}
    linked = {(page, place) for page, text in papers.items() for _, place in docs_site.LINK.findall(text)}
    lost = [(page, place) for page, place in linked if not docs_site.beside(place, page)
            and not (ROOT / "docs" / page).parent.joinpath(place).resolve().is_relative_to(ROOT / "docs")]
    assert lost == []
    assert docs_site.beside("../variants/lugansk/shaper.toml", "project-file.md") == "files/variants/lugansk/shaper.toml"
    assert {docs_site.beside(place, "a.md") for place in ("../pyproject", "page.md", "/etc/passwd")} == {""}
    assert "mkdocs build --strict" in (ROOT / "Makefile").read_text("utf-8")
    assert "not_found: warn, anchors: warn, unrecognized_links: warn" in (ROOT / "mkdocs.yml").read_text("utf-8")


NOT_RUN = {
    "--views": "needs a drawing laid out so; tests/compare/test_image_views.py has some",
    "watch": "goes on until Ctrl-C", "serve": "goes on until Ctrl-C; tests/page asks it",
    "--dask": "needs a cluster; tests/output/test_batch.py has one",
}
"""Commands of docs/ that the next test leaves out, by what they have in them, and why."""
LONG = ("note", "--lang uk", "page my.toml --sheet", "--list", "roster", "optimise", "family check", "tests/projects", "--dxf",
        "lugansk/shaper press my.toml", "bench", "stress", "--image", "build --all", "--group works", "--report mine.html",
        "--json record.json", "record lugansk/shaper --sheet", "sixbar/3:2 --sheet",
        "--marks", "--window", "--preview", "--supervisor", "--paper A3")
"""Commands of docs/ that are run in a trial only, by what they have in them."""
SHORTER = {"stress": ("--cases", "3"), "--summary": ("--quick",), "build --all": ("--sheet", "2", "--format", "svg"),
           "--supervisor": ("--sheet", "1"), "defence": ("--sheet", "4"), **dict.fromkeys(
               ("plot ", "page my.toml -o", "build lugansk/shaper --student",
               "png", "--paper", "--portrait", "--one-file", "--text strokes", "--explain"), ("--sheet", "4"))}
"""Options with which a command is run that takes long as it stands, by what it has in it."""
FILLED = "id;measured\nvelocities/2/pb;30.2\nvelocities/2/pd;46\n"
"""A table of numbers measured, for a command that compares one."""


def papers_folder(every):
    """What the commands of the papers read; for ``every`` command also a drawing to compare, and the sources' own projects."""
    Path("my.toml").write_text(catalogue.read("lugansk/shaper").text, encoding="utf-8")
    Path("ciphers.txt").write_text("press\nlugansk/cam_flat\n", encoding="utf-8")
    Path("group.csv").write_text("student;group;task\nПетренко О. О.;ТМ-21;lugansk/cam_flat\n", encoding="utf-8")
    shutil.copytree(ROOT / "docs/examples/department", "department")
    Path("docs").mkdir()
    shutil.copy(ROOT / "docs/marks.toml", "docs")
    if every:
        shutil.copytree(ROOT / "tests/projects", "tests/projects")
        assert __main__.run(["build", "lugansk/shaper", "--sheet", "1", "--format", "dxf", "-o", "drawn"]) == __main__.DONE
        shutil.copy("drawn/sheet1.dxf", "mine.dxf")
        assert __main__.run(["build", "lugansk/shaper", "--sheet", "1", "--format", "png", "-o", "drawn"]) == __main__.DONE
        Image.open("drawn/sheet1.png").convert("L").save("photo.jpg")


def shape(command):
    """The command with its options, whatever project and files are named."""
    name, *rest = shlex.split(command)
    return name, *sorted({word for word in rest if word.startswith("--")})


@pytest.mark.parametrize("every", few((False, True), False))
def test_other_commands_work(every, tmp_path, monkeypatch, capsys):
    """Each command of all papers once, in one folder, in the order of the papers; of plots and pictures, which are long, one sheet.

    Where not ``every`` command is tried, each has other options than those before it and those of the first own project.
    """
    monkeypatch.chdir(tmp_path)
    papers_folder(every)
    commands = dict.fromkeys(shlex.join(c) for text in TEXTS.values() for c in typed(text, "tmm-sheets") if c and c[0] not in QUICK)
    without = NOT_RUN if every else (*NOT_RUN, *LONG)
    left = [c for c in commands if not any(word in c for word in without) and not re.search("PROJECT|COMMAND", c)]
    assert len(left) > 20
    own = {shape(shlex.join(arguments)) for arguments in first_project()}
    once = list({shape(c): c for c in reversed(left) if shape(c) not in own}.values())[::-1]
    assert 10 < len(once) < len(left)
    for command in left if every else once:
        shutil.rmtree("mine", ignore_errors=True)
        for template in Path().rglob("measured.csv"):
            template.unlink()
        asked = shlex.split(command)
        told = [asked[k + 1] for k, word in enumerate(asked) if word == "--measured"]
        for table in map(Path, (*told, "works/One/measured.csv")):
            table.parent.mkdir(parents=True, exist_ok=True)
            table.write_text(FILLED, encoding="utf-8")
        asked += next((more for word, more in SHORTER.items() if word in command and more[0] not in command), ())
        own = Path(f"{asked[1]}.toml")
        kept = own.rename("kept.toml") if asked[0] == "new" and own.is_file() else None
        monkeypatch.setattr("sys.stdin", io.StringIO("lugansk/cam_flat\nПетренко О. О.\nТМ-21\n"))
        assert __main__.run(asked) == __main__.DONE, (command, capsys.readouterr().err)
        capsys.readouterr()
        if kept is not None:
            assert own.is_file()
            kept.replace(own)
    assert [word for word in (*NOT_RUN, *LONG) if not any(word in c for c in commands)] == []


QUICK = ("list", "show", "check", "solve", "protocol")


def test_quick_commands_work(tmp_path, monkeypatch, capsys):
    """Of commands with the same options the first one."""
    monkeypatch.chdir(tmp_path)
    Path("my.toml").write_text(catalogue.read("lugansk/shaper").text, encoding="utf-8")
    quick = [c for c in typed(EVERYWHERE, "tmm-sheets") if c and c[0] in QUICK and "PROJECT" not in c]
    for arguments in {shape(shlex.join(c)): c for c in reversed(quick)}.values():
        if "-o" in arguments:
            Path(arguments[arguments.index("-o") + 1]).unlink(missing_ok=True)  # what is there already is not overwritten
        assert __main__.run(arguments) == __main__.DONE, (arguments, capsys.readouterr().err)


def test_every_command_has_its_options():
    """A section with the options made from the command; those of several commands stand once."""
    text = TEXTS["docs/commands.md"]
    sections = re.findall(r"^## (\w+)\n(?:(?!^## ).*\n)*?<!-- made: options (\w+) -->$", text, re.MULTILINE)
    assert [name for name, made in sections if name == made] == [name for name, _ in sections]
    assert {name for name, _ in sections} == set(cli.NAMES)
    assert "<!-- made: common_options -->" in text


def test_the_option_of_all_commands_is_told_once():
    assert all(docs.EVERYWHERE in p.opts for command in cli.commands.every().values() for p in command.params[-1:])
    assert len(re.findall(rf"^## .*\n(?:(?!^## ).*\n)*?.*`{docs.EVERYWHERE}", TEXTS["docs/commands.md"], re.MULTILINE)) == 1


def test_no_option_is_named_that_no_command_has():
    known = {o for command in cli.commands.every().values() for p in command.params for o in p.opts} | {"--help"}
    text = re.sub(r"^.*(?:python -m|pip install|dask worker).*$", "", EVERYWHERE, flags=re.MULTILINE)
    assert set(re.findall(r"(?<![\w-])--[a-z]+(?:-[a-z]+)*", text)) <= known


# --- tables made from the program -----------------------------------------------------------------------------------


def test_made_parts_are_current():
    for paper, text in TEXTS.items():
        assert docs.current(text) == text, f"{paper}; run: make docs"
        made, measured = len(docs.PART.findall(text)), len(figures.PART.findall(text))
        assert (text.count("<!-- made"), text.count("<!-- figure")) == (made, measured), paper
        assert text.count("<!-- end -->") == made + measured, paper


def test_the_figures_tell_where_they_come_from():
    assert figures.faults(figures.whole()) == [], "run: make figures"


def test_figures_without_a_source_are_found():
    part = "<!-- figure: stress -->\n```\ntmm-sheets stress\n```\n\n*2026-11-28, 0123abcd, 2 processors*\n\n| a |\n<!-- end -->\n"
    missing = [f"{name} stands nowhere" for name in figures.FIGURES if name != "stress"]
    assert figures.faults(part) == missing
    assert figures.faults(part.replace("*", "")) == ["stress does not say when and where it ran", *missing]
    assert figures.faults(part.replace("sheets stress", "sheets bench")) == [*missing, "stress is another command now"]
    assert figures.faults(part.replace("figure: stress", "figure: luck"))[:2] == ["no command makes luck", "methods stands nowhere"]
    assert figures.faults(part + "x" * figures.LONGEST)[-1].endswith(f"at most {figures.LONGEST}")


def test_every_table_of_the_project_file_is_told():
    told = set(re.findall(r"<!-- made: keys (\S+) -->", TEXTS["docs/project-file.md"]))
    assert told == {s for s in SECTIONS if s not in docs.TOP} | {"flywheel.motor", "group.leg", "train.mesh"}
    assert {"schema", "points", "scales"} <= set(re.findall(r"^- \**`(\w+)`", docs.whole(), re.MULTILINE))


def tables():
    every = [m for room in (schema, seldom_tables) for m in vars(room).values()]
    return [*(m for m in every if isinstance(m, type) and issubclass(m, schema.Table) and m is not schema.Table), variant.Variant]


def test_every_key_has_a_value_and_a_meaning():
    for table in tables():
        assert set(keys.meanings(table)) <= set(table.model_fields), f"{table.__name__}: a string under what is no key"
        for key in () if table is variant.Variant else keys.keys_of(table):
            assert all((key.takes, key.left_out, key.means)), f"{table.__name__}: {key}"


def test_meanings_are_read():
    crank = {key.name: key for key in keys.keys_of(schema.CrankTable)}
    assert crank["length"] == ("length", "length greater than zero", ("m", "mm", "cm"), "needed",
                               "length with its unit, for example `\"0.08 m\"`")
    assert crank["angular_acceleration"][1::2] == ('`"flywheel"` or angular acceleration', "`0`")
    assert [key.left_out for key in keys.keys_of(schema.ForcesTable)] == ['`"9.81 m/s2"`']


# --- messages -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("paper", ["README.md", "docs/project-file.md"])
def test_messages_of_the_example_are_real(paper):
    text = (resources.variants() / "lugansk" / "shaper.toml").read_text(encoding="utf-8")
    text = text.replace('length = "0.08 m"', 'length = "-0.08 m"').replace('\nname = "x–x"', '\nname = "x–x"\nnam = "x–x"')
    with pytest.raises(BadInput) as e:
        variant.parse(text, "my.toml")
    assert re.findall(r"^    (my\.toml.*|    did you mean.*)$", TEXTS[paper], re.MULTILINE) == str(e.value).splitlines()


PLANTS = {
    "with its unit, not the bare number": ('"60 mm"', "60"),
    "is a unit of": ('"90 rpm"', '"90 mm"'),
    "unknown key": ('mass = "6 kg"', 'mas = "6 kg"'),
    "unknown point": ('outer = ["B", "D"]', 'outer = ["B", "K"]'),
    "unknown guide": ('"slot", "column"]', '"slot", "colum"]'),
    "a group of kind": ("kind = 1 ", "kind = 2 "),
    "does not assemble at": ('["190 mm", "140 mm"]', '["90 mm", "140 mm"]'),
    "the guides {} and {} are parallel there": ('["190 mm", "140 mm"]', '["90 mm", "140 mm"]'),
    "needs {} as well": ('working_sense = "+y"\n', ""),
    "the view does not fit in its place, it needs": ("[cycle]", "[scales]\npositions = 0.0001\n\n[cycle]"),
    "no sheet draws a plan of this name": ('"kinematics_forces", "flywheel"]\n', '"flywheel"]\n\n[scales]\nposition = 0.01\n'),
    "unknown sheet, not in templates/sheets": ('"flywheel"]', '"flywheels"]'),
    "not valid TOML": ('"F5"', '"F5'),
}
"""Messages that docs/project-file.md explains, and the change of tests/projects/feeder.toml that brings each."""

ELSEWHERE = {"is probably a misprint of": "sixbar/4:2", "no tooth set": "transport/compressor@09-В-999"}
"""Messages that a shipped project brings."""


def explained(paper):
    section = TEXTS[paper].split("## What does this message mean")[1].split("\n## ")[0]
    rows = re.findall(r"^\| (`.*?`) \|", section, re.MULTILINE)
    return [message for row in rows for message in re.findall(r"`([^`]+)`", row)]


def says(message, text):
    return re.search(".*".join(map(re.escape, message.split("{}"))), text) is not None


def test_every_explained_message_has_a_plant():
    assert sorted(explained("docs/project-file.md")) == sorted([*PLANTS, *ELSEWHERE])


@pytest.mark.parametrize("message", PLANTS)
def test_explained_messages_of_project_files_come(message, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "tests/projects/feeder.toml").read_text(encoding="utf-8")
    old, new = PLANTS[message]
    changed = text.replace(old, new)
    assert changed != text
    Path("my.toml").write_text(changed, encoding="utf-8")
    assert __main__.run(["build", "my.toml", "--format", "svg"]) != __main__.DONE
    assert says(message, capsys.readouterr().err)


@pytest.mark.parametrize("message", ELSEWHERE)
def test_explained_messages_of_shipped_projects_come(message):
    task = catalogue.read(ELSEWHERE[message])
    said = list(task.warnings)
    try:
        Project(task).check()
    except CannotBuild as e:
        said.append(str(e))
    assert any(says(message, line) for line in said)


@cache
def known():
    """Every text of the program: tests/test_words.py holds that the catalogues have them all."""
    return "\n".join("\n".join(m.id) if isinstance(m.id, tuple) else m.id for m in catalogues.read("ru"))


@pytest.mark.parametrize("paper", ["docs/commands.md", "docs/comparing.md"])
def test_other_explained_messages_are_texts_of_the_program(paper):
    for message in explained(paper):
        assert message in known(), message


@pytest.mark.parametrize("paper", ["docs/comparing.md", "docs/judging.md"])
def test_no_paragraph_of_comparing_is_long(paper):
    for paragraph in re.split(r"\n\s*\n|\n(?=- )", FENCED.sub("", TEXTS[paper])):
        assert len(paragraph.split()) <= 80 or paragraph.startswith("|"), paragraph[:60]
