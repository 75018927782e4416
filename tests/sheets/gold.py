"""Accepted display lists: written by ``make gold``, compared as numbers to 0.001 mm with a readable difference.

A line holds one mark: kind, view, line type or text, then numbers in mm; so one mark more is one line of difference.
"""

from __future__ import annotations

import json
from difflib import SequenceMatcher
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tmm_sheets.catalogue import read
from tmm_sheets.drawing.marks import Arc, Drawing, Line, Text
from tmm_sheets.project import Project
from tmm_sheets.sheets.composed import Composed
from tmm_sheets.sheets.sheet import composed

FOLDER = Path(__file__).parent.parent / "gold"
PROJECTS = {"lugansk/shaper": 4, "press": 4, "sixbar/8:3": 2, "transport/press@07-ЭПС-718": 3}
"""Projects, one of each family, with the number of their sheets whose display lists are kept."""
TOLERANCE = 0.001
"""Largest difference of a coordinate, mm."""


class Listed(NamedTuple):
    """A mark as it is kept: kind, view, line type or text, and its numbers in mm."""

    kind: str
    view: str
    style: str
    numbers: tuple[float, ...]

    @property
    def key(self) -> tuple[str, str, str, int]:
        """What is compared as words."""
        return *self[:3], len(self.numbers)

    @property
    def name(self) -> str:
        return f"{self.kind} {self.style!r} of {self.view!r}"

    def line(self) -> str:
        return f"{json.dumps(self[:3], ensure_ascii=False)} {' '.join(f'{x:.4f}'.rstrip('0').rstrip('.') for x in self.numbers)}\n"

    @classmethod
    def read(cls, line: str) -> Listed:
        words, end = json.JSONDecoder().raw_decode(line)
        return cls(*words, tuple(float(x) for x in line[end:].split()))


def listed(drawing: Drawing) -> list[Listed]:
    """Every mark with its points."""
    found: list[Listed] = []
    for mark in drawing.marks:
        if isinstance(mark, Line):
            numbers, style = [mark.a, mark.b], mark.style
        elif isinstance(mark, Arc):
            # The turn is told by points on the arc, so that a difference is a length too.
            ends = [mark.centre + mark.radius * np.exp(1j * t) for t in (mark.start, (mark.start + mark.end) / 2, mark.end)]
            numbers, style = [mark.centre, *ends], mark.style
        elif isinstance(mark, Text):
            numbers, style = [mark.at, mark.at + mark.height * np.exp(1j * mark.angle)], mark.text
        else:
            numbers, style = list(mark.points), mark.style
        flat = np.array(numbers, dtype=complex).view(float)
        found.append(Listed(type(mark).__name__, mark.of, style, tuple(round(float(x), 4) + 0.0 for x in flat)))
    return found


def path(project: str, n: int) -> Path:
    return FOLDER / f"{project.replace('/', '-').replace(':', '-')}-{n}.txt"


def sheet(project: str, n: int) -> Composed:
    return composed(Project(read(project)), n)


def load(project: str, n: int) -> list[Listed]:
    return [Listed.read(line) for line in path(project, n).read_text(encoding="utf-8").splitlines()]


def difference(accepted: list[Listed], drawn: list[Listed], most: int = 12) -> str:
    """What differs, a line for each mark that moved, is new or is gone; empty when nothing does."""
    lines: list[str] = []
    for what, i0, i1, j0, j1 in SequenceMatcher(None, accepted, drawn, autojunk=False).get_opcodes():
        if what == "equal" or i1 - i0 == j1 - j0:
            pairs, gone, new = list(zip(range(i0, i1), range(j0, j1), strict=True)), [], []
        else:
            pairs, gone, new = [], list(range(i0, i1)), list(range(j0, j1))
        for i, j in pairs:
            a, b = accepted[i], drawn[j]
            if a.key != b.key:
                lines.append(f"mark {j}: {b.name} with {len(b.numbers)} numbers drawn, {a.name} with {len(a.numbers)} accepted")
                continue
            off = np.abs(np.array(a.numbers) - np.array(b.numbers))
            if off.size and off.max() > TOLERANCE:
                k = int(off.argmax())
                lines.append(f"mark {j} {b.name}: number {k} is {b.numbers[k]} mm, accepted {a.numbers[k]} (off by {off[k]:.4f})")
        lines += [f"mark {i} {accepted[i].name} is gone" for i in gone]
        lines += [f"mark {j} {drawn[j].name} is new" for j in new]
    return "\n".join(lines[:most] + ([f"... and {len(lines) - most} more"] if len(lines) > most else []))


def main() -> None:
    FOLDER.mkdir(exist_ok=True)
    for project, sheets in PROJECTS.items():
        for n in range(1, sheets + 1):
            path(project, n).write_text("".join(mark.line() for mark in listed(sheet(project, n).drawing)), encoding="utf-8")
            print(path(project, n))


if __name__ == "__main__":
    main()
