"""Whether words can be lettered: texts of title blocks wherever they come from, and, in its raw tables, those of a project file."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from typing import Any

from tmm_sheets.encodings import cleaned
from tmm_sheets.task.units import Refused
from tmm_sheets.toml_file import Found, nodes
from tmm_sheets.words import marked, tell

_USUAL = re.compile(r"[ -~А-яЁё°–—№«»]*")
_READ_ELSEWHERE = {("project", "name"), ("project", "variant"), ("project", "title")}
"""Texts that are not drawn, and the title."""
LONGEST = 200
"""Characters of the longest text of a title block: no cell has room for more."""
_HINT = marked("it has those of Russian and other Cyrillic alphabets, Latin ones with all accents of Europe, and Greek")


def freed(value: Any) -> Any:
    r"""Tables whose texts have no invisible signs, such as ``\u200b``, and spaces instead of line breaks."""
    if isinstance(value, str):
        return cleaned(re.sub(r"\s", " ", value))
    if isinstance(value, list):
        return [freed(v) for v in value]
    return {k: freed(v) for k, v in value.items()} if isinstance(value, dict) else value


def title_text(text: str) -> str:
    """Text, 200 characters at most.

    It is made one line, its letters composed (NFC), without signs that nobody sees.

    Raises
    ------
    Refused
        when it is too long, or has a letter that the drawing font lacks.
    """
    found = " ".join(cleaned(text).split())
    if len(found) > LONGEST:
        raise Refused(tell("expected a text of {most} characters at most, not of {n}").format(most=LONGEST, n=len(found)))
    if lacks := _lacking(found):
        raise Refused(f"{lacks}; {tell(_HINT)}")
    return found


def check_letters(data: dict[str, Any]) -> Iterator[Found]:
    """Every text and key with a letter the drawing font lacks; texts of title blocks are read by :func:`title_text`."""
    for path, value in nodes(data):
        if path not in _READ_ELSEWHERE and path[0] != "title_block":
            for text in (path[-1], value):
                if isinstance(text, str) and (lacks := _lacking(text)):
                    yield path, lacks, tell(_HINT)


def _lacking(text: str) -> str:
    """That the drawing font lacks some letters of a text; empty where it has them all."""
    if _USUAL.fullmatch(text):
        return ""
    from tmm_sheets.drawing.lettering import lacking

    lacks = lacking(text)
    return tell("the drawing font has no {letters}").format(letters=", ".join(map(_described, lacks))) if lacks else ""


def _described(char: str) -> str:
    shown = f'"{char}" ' if char.isprintable() else ""
    return f"{shown}({' '.join(filter(None, (f'U+{ord(char):04X}', unicodedata.name(char, ''))))})"
