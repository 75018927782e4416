"""tests/lock.txt fits pyproject.toml: what continuous integration installs is what the project says that it needs, with hashes."""

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]


def version(text):
    return [int(part) for part in re.findall(r"\d+", text)]


def test_every_package_is_locked_with_its_hashes_in_the_range_that_is_open():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    text = (ROOT / "tests" / "lock.txt").read_text(encoding="utf-8")
    locked = dict(re.findall(r"^([\w.-]+)==(\S+)", text, re.MULTILINE))
    extras = project["optional-dependencies"]
    for wanted in (*project["dependencies"], *extras["test"], *extras["frame"]):
        name, least = wanted.split(">=")
        assert version(locked[name]) >= version(least), name
    for block in re.split(r"\n(?=\S)", text)[2:]:
        assert re.fullmatch(r"[\w.-]+==\S+(?: ; [^\\]+)? \\(?:\n    --hash=sha256:[0-9a-f]{64}(?: \\)?)+\s*", block), block[:80]
