"""Where in a TOML file each value stands, and the comment behind it; the standard reader gives values only.

The text must be valid TOML (``tomllib`` has read it); the scanner walks through it once and keeps, for every key path,
the line of its key, the line where its value ends, and so the comment at the end of that line.
"""

from __future__ import annotations

import re
import tomllib
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

from tmm_sheets.words import tell

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
