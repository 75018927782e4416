"""How students' ciphers are written, and the digits of theirs that choose in the tables."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from string import Template

from pydantic import Field, field_validator

from tmm_sheets.spelling import latin
from tmm_sheets.task.schema import Table
from tmm_sheets.words import marked

MOST = 1000
"""Most ciphers that are gone through."""


class CipherTable(Table):
    """``[cipher]``, where digits at fixed places do not say it."""

    form: str = Field(
        description=marked('a regular expression with named parts, for example "(?P<year>[0-9]+)-(?P<number>[0-9]+)"'))
    written: str = ""
    """how it is printed, `$year-$number`; as it was typed unless told"""
    letters: str = Field(description=marked('a letter for each digit that chooses, for example "abc"'))
    digits: tuple[tuple[str, int], ...] = Field(
        description=marked('the last digits of parts, for example [["year", 1], ["number", 2]]'))
    padding: str = "0"
    """what fills a part with too few digits, at its end"""
    spelling: dict[str, str] = Field(default={})
    """words in another alphabet"""

    @field_validator("form")
    @classmethod
    def _compiles(cls, form: str) -> str:
        try:
            re.compile(form)
        except re.error as e:
            raise ValueError(str(e)) from None
        return form


def of_signs(signs: str) -> CipherTable:
    """A cipher such as ``yy-Т-ab``: small Latin letters are digits; those that it has once choose."""
    parts = [f"p{k}" if "a" <= sign <= "z" else "" for k, sign in enumerate(signs)]
    form = "".join(f"(?P<{part}>[0-9])" if part else _either(sign) for part, sign in zip(parts, signs, strict=True))
    chosen = [(part, sign) for part, sign in zip(parts, signs, strict=True) if part and signs.count(sign) == 1]
    written = "".join(f"${{{part}}}" if part else sign.replace("$", "$$") for part, sign in zip(parts, signs, strict=True))
    return CipherTable(form=form, written=written, letters="".join(sign for _, sign in chosen),
                       digits=tuple((part, 1) for part, _ in chosen))


def _either(sign: str) -> str:
    """A letter of a cipher in either alphabet."""
    return f"[{sign}{latin(sign)}]" if latin(sign) != sign else re.escape(sign)


@dataclass(frozen=True)
class Cipher:
    """A student's cipher as it is printed, its parts by name, its digits by letter."""

    text: str
    parts: Mapping[str, str]
    digits: Mapping[str, str]


class CipherForm:
    """Reads ciphers, and goes through them."""

    def __init__(self, table: CipherTable) -> None:
        self.table = table
        self.letters = table.letters

    @cached_property
    def _words(self) -> dict[str, str]:
        spelling = self.table.spelling
        return {latin(word.upper()): own for own in spelling.values() for word in (own, *spelling)
                if spelling.get(word, own) == own}

    def read(self, text: str) -> Cipher | None:
        """The cipher of a text; None when it is written otherwise."""
        match = re.fullmatch(self.table.form, text.strip())
        return None if match is None else self._of(text.strip(), match.groupdict(default=""))

    def _of(self, text: str, found: Mapping[str, str]) -> Cipher:
        parts = {name: self._words.get(latin(part.upper()), part) for name, part in found.items()}
        figures = "".join(parts[name][-n:].ljust(n, self.table.padding) for name, n in self.table.digits)
        written = Template(self.table.written).substitute(parts) if self.table.written else text
        return Cipher(written, parts, dict(zip(self.letters, figures, strict=True)))

    def every(self, example: str) -> Iterator[str]:
        """Ciphers of all digits in the places of the example's, evenly spread where there are more than :data:`MOST`."""
        like = self.read(example)
        parts = dict.fromkeys(re.compile(self.table.form).groupindex, "0") if like is None else like.parts
        counts = {name: max(n for other, n in self.table.digits if other == name) for name, _ in self.table.digits}
        total = sum(counts.values())
        step = max(1, 10**total // MOST)
        for figures in itertools.islice(itertools.product("0123456789", repeat=total), 0, None, step):
            left = "".join(figures)
            own = dict(parts)
            for name, n in counts.items():
                own[name], left = left[:n], left[n:]
            text = Template(self.table.written or "".join(f"${{{name}}}" for name in own)).substitute(own)
            if self.read(text) is not None:
                yield text
