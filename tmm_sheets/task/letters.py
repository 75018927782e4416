"""Whether the words of a project file can be lettered; works on its raw tables, beside the reader of values."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from typing import Any

from tmm_sheets.encodings import cleaned
from tmm_sheets.task.toml_lines import KeyPath
from tmm_sheets.words import marked, tell

Found = tuple[KeyPath, str, str]
"""Key path, message, hint."""

_USUAL = re.compile(r"[ -~А-яЁё°–—№«»]*")
_NOT_DRAWN = {("project", "name"), ("project", "variant")}
_HINT = marked("it has those of Russian and other Cyrillic alphabets, Latin ones with all accents of Europe, and Greek")


def freed(value: Any) -> Any:
    r"""Tables whose texts have no invisible signs, such as ``\u200b``, and spaces instead of line breaks."""
    if isinstance(value, str):
        return cleaned(re.sub(r"\s", " ", value))
    if isinstance(value, list):
        return [freed(v) for v in value]
    return {k: freed(v) for k, v in value.items()} if isinstance(value, dict) else value


def check_letters(data: dict[str, Any]) -> Iterator[Found]:
    """Every text and key with a letter the drawing font lacks."""
    for path, text in _texts(data, ()):
        if path not in _NOT_DRAWN and not _USUAL.fullmatch(text):
            from tmm_sheets.drawing.lettering import lacking

            lacks = lacking(text)
            if lacks:
                yield path, tell("the drawing font has no {letters}").format(letters=', '.join(map(_told, lacks))), tell(_HINT)


def _told(char: str) -> str:
    shown = f'"{char}" ' if char.isprintable() else ""
    return f"{shown}({' '.join(filter(None, (f'U+{ord(char):04X}', unicodedata.name(char, ''))))})"


def _texts(value: Any, path: KeyPath) -> Iterator[tuple[KeyPath, str]]:
    if isinstance(value, str):
        yield path, value
    elif isinstance(value, list):
        for i, v in enumerate(value):
            yield from _texts(v, (*path, i))
    elif isinstance(value, dict):
        for k, v in value.items():
            yield (*path, k), k
            yield from _texts(v, (*path, k))
