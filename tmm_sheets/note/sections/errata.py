"""What does not agree in the manual of a project: places known to be wrong, numbers of its tables that are suspected to be."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from tmm_sheets.meanings import tables_of
from tmm_sheets.note.document import NumberInText, Rows, Text, lettered
from tmm_sheets.note.phrases import set_text
from tmm_sheets.note.reader import Reader, marked
from tmm_sheets.numbers import written
from tmm_sheets.resources import template, variants
from tmm_sheets.words import decimal_sign, tr

if TYPE_CHECKING:
    from tmm_sheets.project import Project

SHARED = {"gear": ("lugansk/shaper", "lugansk/engine")}
"""Parts that several projects of a manual have in common."""


def of(project: Project) -> list[dict[str, str]]:
    """Places of the manual that are known to be wrong, of the project worked out there; none for one that was changed."""
    name, known = project.variant.project.name, tables_of(template("note/errata.toml"))
    found = [*known.get(name, []), *(e for part, names in SHARED.items() if name in names for e in known[part])]
    shipped = variants() / f"{name}.toml"
    return found if found and shipped.is_file() and shipped.read_text(encoding="utf-8") == project.variant.text else []


def fields(r: Reader) -> dict[str, Any]:
    """Both tables, and whether the project takes the suggested numbers."""
    said = r.words["errata"]
    known = [[_cell(e[k], said) for k in ("place", "what", "printed", "should", "basis")] for e in of(r.project)]
    return {
        "corrected": any(m.corrected for m in r.project.variant.misprints),
        "errata": (tuple((h,) for h in said["head"]), *map(tuple, known)) if known else (),
        "misprints": _misprints(r, said["suspected"]),
    }


def _misprints(r: Reader, head: list[str]) -> Rows:
    rows: list[tuple[Text, ...]] = [tuple((h,) for h in head)]
    for i, m in enumerate(r.project.variant.misprints):
        unit, place = r.unit(m.unit), f"misprint[{i}]"
        numbers = (NumberInText(written(str(x)), place, float(x)) for x in (m.printed, m.suggested))
        rows.append(((lettered(m.symbol), f", {unit}" if unit else ""), *((n,) for n in numbers),
                     tuple(marked(_written(tr(m.reason)), place, "", r.language))))  # fmt: skip
    return tuple(rows) if len(rows) > 1 else ()


def _written(reason: str) -> str:
    """A reason with the signs and the decimal sign of the paper."""
    text = re.sub(r"(?<=\d)\.(?=\d)", decimal_sign(), reason)
    for typed, sign in (("*", "·"), (">=", "≥"), (" - ", " − "), ("..", "…")):
        text = text.replace(typed, sign)
    return re.sub(r"(\d[.,]\d+)\^2", r"\1²", text)


def _cell(text: str, said: dict[str, Any]) -> Text:
    """A cell: words by their keys, places by theirs, letters between dollar signs."""
    if m := re.fullmatch(r"([ts])(\d[\d.]*)", text):
        return (said["table" if m[1] == "t" else "section"].format(n=m[2]),)
    told = set_text(re.sub(r"\{(\w+)\}", lambda m: said["words"].get(m[1], m[0]), text))
    return tuple(re.sub(r"(?<=\d),(?=\d)", decimal_sign(), x) if isinstance(x, str) else x for x in told)
