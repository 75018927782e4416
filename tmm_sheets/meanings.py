"""What letters mean, in the words of a language: for the note, and for sentences that tell a formula.

``templates/note/<language>/words.toml`` has them, beside single words of the note and units.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from tmm_sheets.errors import BadInput, CannotBuild, Problem
from tmm_sheets.resources import template
from tmm_sheets.words import tell


def folder(language: str) -> Path:
    """Folder of the templates of a language.

    Raises
    ------
    CannotBuild
        when there are none of it yet; it says of which there are.
    """
    found = template(f"note/{language}")
    if not found.is_dir():
        there = ", ".join(sorted(p.name for p in template("note").iterdir() if (p / "words.toml").is_file()))
        raise CannotBuild(
            tell('there are no templates of the note in the language "{language}"').format(language=language),
            tell("there are templates in {there}: --lang {first}; others can be added as templates/note/{language}").format(
                there=there, first=there.split(", ")[0], language=language),
        )
    return found


@cache
def words(language: str) -> dict[str, Any]:
    """Single words, units and meanings of letters: ``words.toml`` of a language."""
    return tables_of(folder(language) / "words.toml")


@cache
def tables_of(path: Path) -> dict[str, Any]:
    """Tables of a TOML file of the templates, which a department may change.

    Raises
    ------
    BadInput
        when it is not valid.
    """
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError as e:
        raise BadInput(Problem(str(e), str(path))) from None


@cache
def meaning_of(markup: str, language: str, section: str = "") -> str:
    """What a letter means, by the tables ``letters-<section>`` and ``letters`` of words.toml.

    Its own entry, or the pattern with the longest beginning.
    """
    return _meaning(markup, words(language).get(f"letters-{section}", {})) or _meaning(markup, words(language).get("letters", {}))


def _meaning(markup: str, table: Mapping[str, str]) -> str:
    plain, found, longest = bare(markup), "", -1
    for key, meaning in table.items():
        if key.startswith("~"):
            if m := re.fullmatch(key[1:], plain):
                return m.expand(meaning)
            continue
        head, star, tail = bare(key).partition("*")
        if not star and head == plain:
            return meaning
        middle = plain[len(head) : len(plain) - len(tail)]
        if star and middle and len(head) > longest and plain.startswith(head) and plain.endswith(tail):
            found, longest = meaning.replace("*", middle), len(head)
    return found


@cache
def bare(markup: str) -> str:
    """Letters without markup."""
    return re.sub(r"[\\_{}^ ]", "", markup)
