"""A TOML file that a person wrote: its text, where each value stands, the comment behind it, what is wrong by line and key.

Values that TOML does not read without quotes (``0,02``, ``2 %``, ``80 mm``, a word) are put into quotes, so that the rest of the
file can be read and its mistakes told, too; what may be meant is tried out. The standard reader gives values only: a scanner walks
once through what it has read and keeps, for every key path, the line of its key and where its value ends.
"""

from __future__ import annotations

import re
import tomllib
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from decimal import Decimal
from pathlib import Path
from typing import Any, NamedTuple

from tmm_sheets import encodings, files, spelling
from tmm_sheets.errors import BadInput, Problem, reason_of
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


KeyPath = tuple[str | int, ...]
Found = tuple[KeyPath, str, str]
"""What is wrong with a value: its key path, message, hint."""

Suspect = tuple[object, KeyPath, str, str]
"""Whether something is wrong, its key path, message and hint, texts of the catalogues."""

DEEPEST = 16
"""So many keys and places in lists lead to a value at most."""
_LONG_KEY = re.compile(r"""(?<![\w-])(?:(?:[\w-]++|"[^"\n]*"|'[^'\n]*')[ \t]*\.[ \t]*){16}""")
_OF_A_LINE = r'"(?:\\.|[^"\\\n])*"' r"|'[^'\n]*'"
_OF_LINES = r'"""(?:\\.|[^\\])*?"{3,5}' r"|'''.*?'{3,5}"
_KEY = re.compile(rf"[ \t]*({_OF_A_LINE}|[A-Za-z0-9_-]+)[ \t]*(\.?)")
_VALUE = re.compile(rf"(?s:{_OF_LINES})|{_OF_A_LINE}|[^,\]}}\n#]*")
_EQUALS = re.compile(r"=[ \t]*")
_COMMENT = re.compile(r"#([^\n]*)")
_SPACE = re.compile(rf"(?:[ \t\n]|{_COMMENT.pattern})*")


@dataclass(frozen=True)
class TomlLines:
    """Lines (counted from 1), places and trailing comments of the values of one TOML text; paths as pydantic gives them."""

    lines: dict[KeyPath, int] = field(default_factory=dict)
    ends: dict[KeyPath, int] = field(default_factory=dict)
    places: dict[KeyPath, tuple[int, int]] = field(default_factory=dict)
    comments: dict[int, str] = field(default_factory=dict)

    def line(self, path: KeyPath) -> int:
        """Line of a key path; of its table when the key itself is not in the file; the first when that is not either."""
        for length in range(len(path), 0, -1):
            if path[:length] in self.lines:
                return self.lines[path[:length]]
        return 1

    def comment(self, path: KeyPath) -> str:
        """Comment behind the value of a key path, without its sign; empty when there is none."""
        return self.comments.get(self.ends.get(path, 0), "")


def nodes(data: Any, path: KeyPath = ()) -> Iterator[tuple[KeyPath, Any]]:
    """Everything that is in tables and lists, tables and lists too, each with its path, the outer before the inner."""
    for key, value in data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ():
        yield (*path, key), value
        yield from nodes(value, (*path, key))


def dotted(path: Iterable[str | int], first: int = 0) -> str:
    """A key path as text, places in lists counted from ``first``: ``group[1].length``."""
    return "".join([f"[{part + first}]" if isinstance(part, int) else f".{part}" for part in path]).removeprefix(".")


def wrong(suspects: Iterable[Suspect], **names: object) -> Iterator[Found]:
    """What is wrong, its message and its hint filled in."""
    for is_so, path, said, hint in suspects:
        if is_so:
            yield path, tell(said).format(**names), tell(hint).format(**names)


def check_keys(text: str) -> None:
    """Refuse keys of more parts than a project file has, before a reader takes the square of their number for them.

    Raises
    ------
    RecursionError
        when there is one.
    """
    if _LONG_KEY.search(text):
        raise RecursionError


def scan(text: str) -> TomlLines:
    """Scan a valid TOML text.

    Raises
    ------
    RecursionError
        when its tables and lists are nested more deeply than those of a project file.
    """
    return _Scanner(text.replace("\r\n", "\n")).run()


class _Scanner:
    def __init__(self, text: str) -> None:
        self.text = text
        self.pos = 0
        self.starts = [0, *[m.end() for m in re.finditer("\n", text)]]
        self.found = TomlLines()
        self.tables: dict[KeyPath, int] = {}

    def run(self) -> TomlLines:
        table: KeyPath = ()
        while self.space() < len(self.text):
            if self.text[self.pos] == "[":
                table = self.header()
            else:
                self.pair(table)
        return self.found

    def line(self, at: int | None = None) -> int:
        """Line of a place, of the next sign unless told."""
        return bisect_right(self.starts, self.pos if at is None else at)

    def take(self, pattern: re.Pattern[str]) -> re.Match[str]:
        """Pass over what comes next."""
        match = pattern.match(self.text, self.pos)
        if match is None:
            raise ValueError(f"line {self.line()}: not valid TOML")
        self.pos = match.end()
        return match

    def space(self) -> int:
        """Pass over blanks, ends of lines and comments, which are kept by their line; returns the place of what comes next."""
        start = self.pos
        for comment in _COMMENT.finditer(self.text, start, self.take(_SPACE).end()):
            self.found.comments[self.line(comment.start())] = comment[1].strip()
        return self.pos

    def keep(self, path: KeyPath, line: int) -> None:
        if len(path) > DEEPEST:
            raise RecursionError
        for length in range(1, len(path) + 1):
            self.found.lines.setdefault(path[:length], line)

    def header(self) -> KeyPath:
        """Name of a table, with its place where it is one of several, and those of the tables that it is in."""
        line, brackets = self.line(), 2 if self.text.startswith("[[", self.pos) else 1
        self.pos += brackets
        *above, last = self.keys()
        self.pos += brackets
        path: KeyPath = ()
        for key in above:
            path = self.placed((*path, key))
        path = (*path, last)
        if brackets == 2:
            self.tables[path] = self.tables.get(path, -1) + 1
        self.keep(path, line)
        path = self.placed(path)
        self.keep(path, line)
        return path

    def placed(self, path: KeyPath) -> KeyPath:
        """A key path with the place of the last table of that name, if there are several."""
        return (*path, self.tables[path]) if path in self.tables else path

    def keys(self) -> KeyPath:
        found: list[str | int] = []
        more = "."
        while more:
            key, more = self.take(_KEY).groups()
            found.append(tomllib.loads(f"k = {key}")["k"] if key[0] in "\"'" else key)
        return tuple(found)

    def pair(self, table: KeyPath) -> None:
        line = self.line()
        path = table + self.keys()
        self.keep(path, line)
        self.take(_EQUALS)
        self.value(path)

    def value(self, path: KeyPath) -> None:
        start, close = self.pos, {"[": "]", "{": "}"}.get(self.text[self.pos])
        if close:
            self.members(path, close)
        else:
            self.take(_VALUE)
        self.found.ends[path] = self.line()
        self.found.places[path] = start, self.pos

    def members(self, path: KeyPath, close: str) -> None:
        self.pos += 1
        index = 0
        while self.text[self.space()] != close:
            if self.text[self.pos] == ",":
                self.pos += 1
            elif close == "}":
                self.pair(path)
            else:
                self.keep((*path, index), self.line())
                self.value((*path, index))
                index += 1
        self.pos += 1
