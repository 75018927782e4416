"""Where in a TOML file each value stands, and the comment behind it; the standard reader gives values only.

The text must be valid TOML (``tomllib`` has read it); the scanner walks through it once and keeps, for every key path,
the line of its key, the line where its value ends, and so the comment at the end of that line.
"""

from __future__ import annotations

import re
import tomllib
from bisect import bisect_right
from dataclasses import dataclass, field

KeyPath = tuple[str | int, ...]
Found = tuple[KeyPath, str, str]
"""What is wrong with a value: its key path, message, hint."""

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
DEEPEST = 16
"""So many keys and places in lists lead to a value at most."""
_LONG_KEY = re.compile(r"""(?<![\w-])(?:(?:[\w-]++|"[^"\n]*"|'[^'\n]*')[ \t]*\.[ \t]*){16}""")
_BARE_VALUE = re.compile(r"[^,\]}\n#]+")
_STRINGS = (
    re.compile(r'"""(?:\\.|[^\\])*?"{3,5}', re.DOTALL),
    re.compile(r"'''.*?'{3,5}", re.DOTALL),
    re.compile(r'"(?:\\.|[^"\\\n])*"'),
    re.compile(r"'[^'\n]*'"),
)


@dataclass(frozen=True)
class TomlLines:
    """Lines (counted from 1) and trailing comments of the values of one TOML text; paths as pydantic gives them."""

    lines: dict[KeyPath, int] = field(default_factory=dict)
    ends: dict[KeyPath, int] = field(default_factory=dict)
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
        self.starts = [0, *(m.end() for m in re.finditer("\n", text))]
        self.found = TomlLines()
        self.tables: dict[KeyPath, int] = {}

    def run(self) -> TomlLines:
        prefix: KeyPath = ()
        while True:
            self.skip()
            if self.pos >= len(self.text):
                return self.found
            if self.text[self.pos] == "[":
                prefix = self.header()
            else:
                self.pair(prefix)

    def here(self) -> int:
        return bisect_right(self.starts, self.pos)

    def skip(self, signs: str = " \t\n") -> None:
        """Skip blanks and, when line ends are among them, comments, which are kept by their line."""
        while self.pos < len(self.text):
            if self.text[self.pos] in signs:
                self.pos += 1
            elif self.text[self.pos] == "#" and "\n" in signs:
                end = self.text.find("\n", self.pos)
                end = len(self.text) if end < 0 else end
                self.found.comments[self.here()] = self.text[self.pos + 1 : end].strip()
                self.pos = end
            else:
                return

    def keep(self, path: KeyPath, line: int) -> None:
        if len(path) > DEEPEST:
            raise RecursionError
        for length in range(1, len(path) + 1):
            self.found.lines.setdefault(path[:length], line)

    def header(self) -> KeyPath:
        line = self.here()
        array = self.text.startswith("[[", self.pos)
        self.pos += 2 if array else 1
        keys = self.keys()
        self.pos += 2 if array else 1
        path = self.resolved(keys[:-1]) + keys[-1:]
        if array:
            self.tables[path] = self.tables.get(path, -1) + 1
            self.keep(path, line)
            path = (*path, self.tables[path])
        elif path in self.tables:
            path = (*path, self.tables[path])
        self.keep(path, line)
        return path

    def resolved(self, keys: KeyPath) -> KeyPath:
        """Key path of a header with the indices of the arrays of tables it passes through."""
        path: KeyPath = ()
        for key in keys:
            path = (*path, key)
            if path in self.tables:
                path = (*path, self.tables[path])
        return path

    def keys(self) -> KeyPath:
        found: list[str | int] = []
        while True:
            self.skip(" \t")
            if self.text[self.pos] in "\"'":
                quoted = self.string()
                found.append(str(tomllib.loads(f"k = {quoted}")["k"]))
            else:
                match = _BARE_KEY.match(self.text, self.pos)
                if match is None:
                    raise ValueError(f"line {self.here()}: not a key of valid TOML")
                found.append(match.group())
                self.pos = match.end()
            self.skip(" \t")
            if self.text[self.pos] != ".":
                return tuple(found)
            self.pos += 1

    def pair(self, prefix: KeyPath) -> None:
        line = self.here()
        path = prefix + self.keys()
        self.pos += 1  # the sign of equality
        self.skip(" \t")
        self.keep(path, line)
        self.value(path)
        self.found.ends[path] = self.here()

    def value(self, path: KeyPath) -> None:
        sign = self.text[self.pos]
        if sign == "[":
            self.members(path, "]")
        elif sign == "{":
            self.members(path, "}")
        elif sign in "\"'":
            self.string()
        else:
            match = _BARE_VALUE.match(self.text, self.pos)
            self.pos = match.end() if match else self.pos + 1

    def members(self, path: KeyPath, close: str) -> None:
        self.pos += 1
        index = 0
        while True:
            self.skip()
            if self.text[self.pos] == close:
                self.pos += 1
                return
            if self.text[self.pos] == ",":
                self.pos += 1
            elif close == "}":
                self.pair(path)
            else:
                self.keep((*path, index), self.here())
                self.value((*path, index))
                self.found.ends[*path, index] = self.here()
                index += 1

    def string(self) -> str:
        for pattern in _STRINGS:
            match = pattern.match(self.text, self.pos)
            if match:
                self.pos = match.end()
                return match.group()
        raise ValueError(f"line {self.here()}: not a string of valid TOML")
