"""What does not agree in the manual of a project: places known to be wrong, numbers of its tables that are suspected to be."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from functools import cache
from typing import TYPE_CHECKING, Any

from tmm_sheets.construction.formula import letters, letters_of
from tmm_sheets.note import phrases
from tmm_sheets.note.document import NumberInText, Symbol, Text
from tmm_sheets.note.phrases import Scope
from tmm_sheets.note.reader import Reader, marked
from tmm_sheets.numbers import written
from tmm_sheets.resources import template, variants
from tmm_sheets.words import decimal_sign, tr

if TYPE_CHECKING:
    from tmm_sheets.project import Project

SHARED = {"gear": ("lugansk/shaper", "lugansk/engine")}
"""Parts that several projects of a manual have in common."""


@cache
def _known() -> dict[str, list[dict[str, str]]]:
    found: dict[str, list[dict[str, str]]] = tomllib.loads(template("note/errata.toml").read_text(encoding="utf-8"))
    return found


def of(project: Project) -> list[dict[str, str]]:
    """Places of the manual that are known to be wrong, of the project worked out there; none for one that was changed."""
    name = project.variant.project.name
    found = [*_known().get(name, []), *(e for part, names in SHARED.items() if name in names for e in _known()[part])]
    shipped = variants() / f"{name}.toml"
    return found if found and shipped.is_file() and shipped.read_text(encoding="utf-8") == project.variant.text else []


def scope(r: Reader) -> Scope:
    """Both tables, and whether the project takes the suggested numbers."""
    said = phrases.words(r.language)["errata"]
    misprints = r.project.variant.misprints
    found = Scope({"corrected": any(m.corrected for m in misprints)})
    head = tuple((h,) for h in said["head"])
    found.tables["errata"] = (head, *(tuple(_cell(r, e[k]) for k in ("place", "what", "printed", "should", "basis"))
                                      for e in of(r.project)))  # fmt: skip
    rows: list[tuple[Text, ...]] = []
    for i, m in enumerate(misprints):
        unit = r.unit(m.unit)
        numbers = (NumberInText(written(str(x)), f"misprint[{i}]", float(x)) for x in (m.printed, m.suggested))
        rows.append(((Symbol(letters(letters_of(m.symbol))), f", {unit}" if unit else ""), *((n,) for n in numbers),
                     tuple(marked(_written(tr(m.reason)), f"misprint[{i}]", "", r.language))))  # fmt: skip
    found.tables["misprints"] = (tuple((h,) for h in said["suspected"]), *rows)
    return found


def _written(reason: str) -> str:
    """A reason with the signs and the decimal sign of the paper."""
    text = re.sub(r"(?<=\d)\.(?=\d)", decimal_sign(), reason)
    for typed, sign in (("*", "·"), (">=", "≥"), (" - ", " − "), ("..", "…")):
        text = text.replace(typed, sign)
    return re.sub(r"(\d[.,]\d+)\^2", r"\1²", text)


def _cell(r: Reader, text: str) -> Text:
    """A cell: words by their keys, places by theirs, letters between dollar signs."""
    return tuple(_parts(r, text))


def _parts(r: Reader, text: str) -> Iterator[Any]:
    said = phrases.words(r.language)["errata"]
    if m := re.fullmatch(r"([ts])(\d[\d.]*)", text):
        yield said["table" if m[1] == "t" else "section"].format(n=m[2])
        return
    sign = decimal_sign()
    for i, part in enumerate(re.sub(r"\{(\w+)\}", lambda m: said["words"].get(m[1], m[0]), text).split("$")):
        if i % 2:
            yield Symbol(letters(letters_of(part)))
        elif part:
            yield re.sub(r"(?<=\d),(?=\d)", sign, part)
