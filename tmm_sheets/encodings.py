"""Text as people's programs save it: told apart by its bytes, and freed of signs nobody sees."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple
from unicodedata import category, normalize

from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.words import tell

WINDOWS, CONSOLE = "cp1251", "cp866"
"""Code pages of a Russian Windows: of its editors, and of its console."""
_EXPECTED = frozenset([*map(chr, range(0x410, 0x450)), *"ЁёІіЄєЇїҐґЎў°±·§«»„“”‘’–—…№µ√\u00a0"])
_VARIATIONS = range(0xFE00, 0xFE10)  # selectors of emoji: nothing to be seen by themselves


class DecodedText(NamedTuple):
    """A text and how its bytes were read, for the user; empty for UTF-8."""

    text: str
    note: str = ""


def decoded(data: bytes, file: str, hint: str) -> DecodedText:
    """Text of a file in UTF-8 or UTF-16, with or without byte order mark, or in a code page of a Russian Windows.

    Raises
    ------
    BadInput
        for binary data, damaged UTF-8, another code page, by the line where it is at one; ``hint``, marked, says what to try.
    """
    def refused(why: str, line: int | None = None) -> BadInput:
        return BadInput(Problem(why, file, line, hint=tell(hint)))

    wide = _utf_16(data)
    try:
        text = data.decode(wide or "utf-8-sig").removeprefix("\ufeff")
    except UnicodeDecodeError as e:
        if wide:
            raise refused(tell("UTF-16 text that ends in the middle of a character")) from None
        return _of_windows(data, e, refused)
    if "\0" in text:
        raise refused(tell("not a text file"), text.count("\n", 0, text.index("\0")) + 1)
    meant = _redirected(text)
    if meant is not None:
        return DecodedText(meant, tell(
            "written by PowerShell, which took its letters for those of another code page; they were put right"))
    return DecodedText(text, tell("read as UTF-16") if wide else "")


def _utf_16(data: bytes) -> str:
    """Its name when these bytes are UTF-16: by its mark, or by one byte of most pairs being 0."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return "utf-16"
    even, odd = data[::2].count(0), data[1::2].count(0)
    if len(data) % 2 == 0 and max(even, odd) > len(data) / 8 and not min(even, odd):
        return "utf-16-le" if odd else "utf-16-be"
    return ""


def _of_windows(data: bytes, e: UnicodeDecodeError, refused: Callable[[str, int], BadInput]) -> DecodedText:
    line = data.count(b"\n", 0, e.start) + 1
    read = data.decode("utf-8-sig", "replace")
    broken = read.count("\ufffd")
    if sum(c > "\x7f" for c in read) > 2 * broken:
        raise refused(tell("not UTF-8 text here, though it is elsewhere"), line)
    if any(b < 32 and b not in b"\t\n\f\r" for b in data):
        raise refused(tell("not a text file"), line)
    for page in (WINDOWS, CONSOLE):
        text = data.decode(page, "replace")
        high = [c for c in text if c > "\x7f"]
        if sum(c in _EXPECTED for c in high) > 0.9 * len(high):
            return DecodedText(text, tell("read in code page {page}, it is not UTF-8").format(page=page.removeprefix('cp')))
    raise refused(tell("neither UTF-8 nor in the code page 1251"), line)


def _redirected(text: str) -> str | None:
    """What was meant where PowerShell's ``>`` read this program's UTF-8 in the code page of the console; else None."""
    if not {"╨", "╤"} & set(text):  # the first halves of Russian letters
        return None
    try:
        return text.encode(CONSOLE).decode("utf-8")
    except UnicodeError:
        return None


def cleaned(text: str) -> str:
    """A text with composed letters (NFC), every kind of space as a plain one, and no signs without width."""
    return text if text.isascii() else normalize("NFC", text).translate(_PLAIN)


class _Plain(dict[int, str]):
    """What each character is read as, by its code; found when it is first met."""

    def __missing__(self, code: int) -> str:
        kind = category(chr(code))
        self[code] = " " if kind in ("Zs", "Zl", "Zp") else "" if kind == "Cf" or code in _VARIATIONS else chr(code)
        return self[code]


_PLAIN = _Plain()
