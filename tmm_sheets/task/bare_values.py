"""Values of a project file that TOML does not read without quotes: ``0,02``, ``2 %``, ``80 mm``, ``"80 mm``, a word.

They are put into quotes so that the rest of the file can be read and its mistakes told, too; what may be meant is tried out.
"""

from __future__ import annotations

import re
import tomllib
from decimal import Decimal
from typing import NamedTuple

from tmm_sheets.task.toml_lines import check_keys

_PAIR = re.compile(r"""(\s*[\w."'-]+\s*=\s*)(["']?[^"'\[\]{}#=]*?["']?)(\s*(?:#.*)?)""")
_NUMBER = re.compile(r"([+-]?)(\d+(?:[ \u00a0]\d{3})*[.,]?\d*|[.,]\d+)")
MOST = 20
"""Lines that are put right; more are no slips."""
LONGEST = 50_000
"""Characters of a text that is put right: it is read anew for each of them, and a person writes no longer one."""


class BareValue(NamedTuple):
    """A value without its quotes: its line, what stands before, itself, what stands behind."""

    line: int
    before: str
    value: str
    behind: str

    @property
    def meant(self) -> tuple[str, ...]:
        """What may be meant, as TOML: a number with a point and, where it is a share, in per cent; else the same in quotes."""
        match = _NUMBER.fullmatch(self.value)
        if match is None:
            return (f'"{self.value}"',)
        plain = re.sub(r"\s", "", match[2]).replace(",", ".")
        number = Decimal(match[1] + plain)
        percent = f'"{(number * 100).normalize():f} %"'
        return (f"{number:f}", *((percent,) if 0 < number < 1 else ()))

    def put(self, text: str, value: str) -> str:
        """The text with another value in this place."""
        lines = text.split("\n")
        lines[self.line - 1] = f"{self.before}{value}{self.behind}"
        return "\n".join(lines)


def quoted(text: str) -> tuple[str, dict[int, BareValue]]:
    """The text with such values in quotes, and these by their lines; it may still be no TOML for other reasons."""
    found: dict[int, BareValue] = {}
    while len(found) < MOST and len(text) < LONGEST:
        try:
            check_keys(text)
            tomllib.loads(text)
        except tomllib.TOMLDecodeError as e:
            match = re.search(r"\(at line (\d+),", str(e))
            line = int(match[1]) if match else 0
            bare = _bare(text, line) if line and line not in found else None
            if bare is None:
                break
            found[line] = bare
            text = bare.put(text, f'"{bare.value}"')
        except (ValueError, RecursionError):  # told by who reads it
            break
        else:
            break
    return text, found


def _bare(text: str, line: int) -> BareValue | None:
    lines = text.split("\n")
    match = _PAIR.fullmatch(lines[line - 1].rstrip("\r")) if line <= len(lines) else None
    value = match[2].strip("\"'") if match else ""
    if match is None or not value or "\\" in value or _reads(match[2]):
        return None
    return BareValue(line, match[1], value, match[3])


def _reads(value: str) -> bool:
    """Whether TOML reads a value: what is wrong with its line is something else."""
    try:
        tomllib.loads(f"x = {value}")
    except ValueError:
        return False
    return True
