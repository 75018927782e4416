"""README says what is so: its example is the shipped file, its commands and its messages are the program's."""

import re
from pathlib import Path

import pytest

from tmm_sheets import cli, resources
from tmm_sheets.errors import BadInput
from tmm_sheets.task import variant
from tmm_sheets.task.names import GROUP_KEYS

README = (Path(__file__).parents[1] / "README.md").read_text(encoding="utf-8")


def test_examples_are_files():
    shaper, own = re.findall(r"```toml\n(.*?)```", README, re.DOTALL)
    assert shaper == (resources.variants() / "lugansk" / "shaper.toml").read_text(encoding="utf-8")
    assert own == (Path(__file__).parent / "projects" / "feeder.toml").read_text(encoding="utf-8")


def test_arrangements_are_there():
    (row,) = (line for line in README.splitlines() if line.startswith("| `[project] sheets` |"))
    for name in re.findall(r"`(\w+)`", row):
        assert (resources.template("sheets") / f"{name}.toml").is_file()


def test_every_command_and_option_is_named():
    documented = dict(re.findall(r"\| `tmm-sheets (\w+)(.*?)` \|", README))
    assert set(documented) == set(cli.commands.commands)
    for name, command in cli.commands.commands.items():
        options = {o for p in command.params for o in p.opts if o.startswith("--") and o not in ("--output", "--help")}
        assert options <= set(re.findall(r"--[a-z]+(?:-[a-z]+)*", documented[name])), name


def test_every_section_is_named():
    tables = set(re.findall(r"`\[+(\w+)\]+`", README))
    assert {f.alias or name for name, f in variant.Variant.model_fields.items()} - {"schema"} <= tables


@pytest.mark.parametrize("kind", GROUP_KEYS)
def test_keys_of_every_kind_of_group(kind):
    row = next(line for line in README.splitlines() if line.startswith(f"| {kind} |")).split("|")
    must, may = (set(re.findall(r"`(\w+)`", cell)) for cell in row[3:5])
    assert (must - {"links"}, may) == tuple(map(set, GROUP_KEYS[kind]))


def test_messages_of_the_example_are_real():
    text = (resources.variants() / "lugansk" / "shaper.toml").read_text(encoding="utf-8")
    text = text.replace('length = "0.08 m"', 'length = "-0.08 m"').replace('\nname = "x–x"', '\nname = "x–x"\nnam = "x–x"')
    with pytest.raises(BadInput) as e:
        variant.parse(text, "my.toml")
    said = re.findall(r"^    (my\.toml.*|    did you mean.*)$", README, re.MULTILINE)
    assert said == str(e.value).splitlines()


def test_picture_is_there():
    picture = Path(__file__).parents[1] / re.search(r"!\[.*\]\((.*)\)", README)[1]
    assert picture.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    assert picture.stat().st_size < 400_000
