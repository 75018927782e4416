"""A TOML file that a person wrote: its text, and what is wrong with it by line and key.

Values that TOML does not read without quotes (``0,02``, ``2 %``, ``80 mm``, a word) are put into quotes, so that the rest of the
file can be read and its mistakes told, too; what may be meant is tried out.
"""

from __future__ import annotations

import re
import tomllib
from decimal import Decimal
from pathlib import Path
from typing import Any, NamedTuple

from tmm_sheets import encodings, files, spelling
from tmm_sheets.errors import BadInput, Problem, reason_of
from tmm_sheets.toml_lines import KeyPath, TomlLines, check_keys, dotted, nodes, scan
from tmm_sheets.words import marked, tell

DIGITS, BITS = 4301, 63
"""Digits of the shortest whole number that Python does not read; bits of the longest one that TOML has, beside its sign."""


LARGEST = 1_000_000
"""Bytes, and characters, of the largest file that is read: shipped project files have 8,000 at most."""


class NoSuchFile(BadInput):
    """There is no file of this name."""


def text_of(path: Path, hint: str = "", most: int = LARGEST) -> tuple[str, str]:
    """Text of a file of at most ``most`` bytes, and what is to be said of its encoding.

    Raises
    ------
    NoSuchFile
        when there is none, with a hint.
    BadInput
        when it cannot be read, or is no text.
    """
    file = str(path)
    try:
        data = files.content(path, most)
    except (FileNotFoundError, NotADirectoryError):
        raise NoSuchFile(Problem(tell("no such file"), file, hint=hint)) from None
    except IsADirectoryError:
        raise BadInput(Problem(tell("expected a project file, this is a folder"), file)) from None
    except OSError as e:
        raise BadInput(Problem(tell("cannot be read: {why}").format(why=reason_of(e)), file)) from None
    text, note = encodings.decoded(data, file, marked("save the file in the encoding UTF-8"))
    return encodings.cleaned(text), note


def read(path: Path, hint: str = "") -> tuple[str, dict[str, Any], TomlLines]:
    """Text of a file, its tables and where its keys stand, as :func:`text_of` and :func:`parsed` give them."""
    text, _ = text_of(path, hint)
    return text, *parsed(text, str(path))


def parsed(text: str, file: str, data: dict[str, Any] | None = None) -> tuple[dict[str, Any], TomlLines]:
    """The tables of a text, those that were read of it already or else read now, and where its keys stand.

    Raises
    ------
    BadInput
        when it is not valid TOML, has a whole number of more than 64 bits or is nested too deeply.
    """
    try:
        check_keys(text)
        data, lines = tomllib.loads(text) if data is None else data, scan(text)
    except tomllib.TOMLDecodeError as e:
        raise BadInput(syntax(str(e), text, file)) from None
    except RecursionError:
        raise BadInput(Problem(tell("lists or tables are nested too deeply"), file)) from None
    except ValueError:  # Python reads no whole number of more than 4300 digits
        line = next((n for n, row in enumerate(text.split("\n"), 1) if re.search(rf"[0-9_]{{{DIGITS}}}", row)), None)
        raise BadInput(Problem(tell("the number has too many digits"), file, line)) from None
    long = [path for path, value in nodes(data) if isinstance(value, int) and value.bit_length() > BITS]
    if long:
        raise BadInput(problem(file, lines, path, tell("the number has too many digits")) for path in long)
    return data, lines


def syntax(message: str, text: str, file: str) -> Problem:
    """What Python's reader of TOML says of a text, with the line that it means."""
    match = re.search(r"\(at line (\d+), column (\d+)\)", message)
    line = int(match[1]) if match else text.count("\n") + 1
    message = re.sub(r" \(at .*\)", "", message)
    lines = text.splitlines()
    written = lines[line - 1].strip() if 0 < line <= len(lines) else ""
    key = written.strip("[]").partition("=")[0].strip()
    hint = (tell("write {what}").format(what=f"{spelling.latin(key)} ({spelling.other_letters(key, spelling.latin(key))})")
            if key and not key.isascii() and re.fullmatch(r"[\w.-]+", spelling.latin(key), re.ASCII) else
            tell("the line is: {line}").format(line=written) if written else
            tell("the file ends too early: a quote or a bracket is not closed"))
    why = _of_parser(message[:1].lower() + message[1:])
    said = (tell("not valid TOML, column {column}: {why}").format(column=match[2], why=why) if match else
            tell("not valid TOML: {why}").format(why=why))
    return Problem(said, file, line, hint=hint)


_OF_PARSER = (
    marked("invalid statement"), marked("expected newline or end of document after a statement"), marked("expected {what}"),
    marked("found invalid character {what}"), marked("cannot declare {what} twice"), marked("cannot overwrite a value"),
    marked("expected ']' at the end of a table declaration"), marked("expected ']]' at the end of an array declaration"),
    marked("cannot mutate immutable namespace {what}"), marked("cannot redefine namespace {what}"),
    marked("expected '=' after a key in a key/value pair"), marked("invalid initial character for a key part"),
    marked("unclosed array"), marked("unclosed inline table"), marked("duplicate inline table key {what}"),
    marked("unescaped '\\' in a string"), marked("invalid hex value"), marked("escaped character is not a unicode scalar value"),
    marked("unterminated string"), marked("illegal character {what}"), marked("invalid date or datetime"), marked("invalid value"),
)  # fmt: skip
"""What Python's reader of TOML says."""


def _of_parser(message: str) -> str:
    """A message of Python's reader of TOML in the reader's words; itself where it is a new one."""
    for text in sorted(_OF_PARSER, key=lambda text: "{what}" in text):
        if match := re.fullmatch(re.escape(text).replace(r"\{what\}", "(?P<what>.*)"), message):
            return tell(text).format(**match.groupdict())
    return message


def problem(file: str, lines: TomlLines, path: KeyPath, message: str, hint: str = "") -> Problem:
    """A problem placed at a key of a file."""
    return Problem(message, file, lines.line(path), dotted(path, 1), hint)


# --- values without their quotes ---------------------------------------------------------------------------------------


_PAIR = r"""(\s*[\w."'-]+\s*=\s*)(["']?[^"'\[\]{}#=]*?["']?)(\s*(?:#.*)?)"""
_NUMBER = r"([+-]?)(\d+(?:[ \u00a0]\d{3})*[.,]?\d*|[.,]\d+)"
MOST_PUT_RIGHT = 20
"""Lines that are put right; more are no slips."""
LONGEST_PUT_RIGHT = 50_000
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
        match = re.fullmatch(_NUMBER, self.value)
        if match is None:
            return (f'"{self.value}"',)
        number = Decimal(match[1] + re.sub(r"\s", "", match[2]).replace(",", "."))
        return (f"{number:f}", *((f'"{(number * 100).normalize():f} %"',) if 0 < number < 1 else ()))

    def put(self, text: str, value: str) -> str:
        """The text with another value in this place."""
        lines = text.split("\n")
        lines[self.line - 1] = f"{self.before}{value}{self.behind}"
        return "\n".join(lines)


def quoted(text: str) -> tuple[str, dict[int, BareValue], dict[str, Any] | None]:
    """The text with such values in quotes, these by their lines, and its tables: None where it still is no TOML."""
    found: dict[int, BareValue] = {}
    while len(found) < MOST_PUT_RIGHT and len(text) < LONGEST_PUT_RIGHT:
        try:
            check_keys(text)
            return text, found, tomllib.loads(text)
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
    return text, found, None


def _bare(text: str, line: int) -> BareValue | None:
    lines = text.split("\n")
    match = re.fullmatch(_PAIR, lines[line - 1].rstrip("\r")) if line <= len(lines) else None
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
