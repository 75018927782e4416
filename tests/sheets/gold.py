"""Accepted display lists: written by ``make gold``, compared as numbers to 0.001 mm with a readable difference."""

from __future__ import annotations

import gzip
import json
from pathlib import Path

import numpy as np

from tmm_sheets.catalogue import read
from tmm_sheets.drawing.marks import Arc, Drawing, Line, Text
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import compose

FOLDER = Path(__file__).parent.parent / "gold"
PROJECTS = {"lugansk/shaper": 4}
"""Projects with the number of their sheets whose display lists are kept."""
TOLERANCE = 0.001
"""Largest difference of a coordinate, mm."""


def listed(drawing: Drawing) -> list[list[object]]:
    """Every mark as [kind, view, style or text, numbers in 0.0001 mm]."""
    found: list[list[object]] = []
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
        found.append([type(mark).__name__, mark.of, style, [round(float(x), 4) + 0.0 for x in flat]])
    return found


def path(project: str, n: int) -> Path:
    return FOLDER / f"{project.replace('/', '-')}-{n}.json.gz"


def draw(project: str, n: int) -> list[list[object]]:
    return listed(compose(Project(read(project)), n))


def load(project: str, n: int) -> list[list[object]]:
    return json.loads(gzip.decompress(path(project, n).read_bytes()))


def difference(accepted: list[list[object]], drawn: list[list[object]], most: int = 12) -> str:
    """What differs, a line a mark; empty when nothing does."""
    lines = []
    if len(accepted) != len(drawn):
        lines.append(f"{len(drawn)} marks drawn, {len(accepted)} accepted")
    for i, (a, b) in enumerate(zip(accepted, drawn, strict=False)):
        if a[:3] != b[:3] or len(a[3]) != len(b[3]):
            lines.append(f"mark {i}: {b[:3]} with {len(b[3])} numbers drawn, {a[:3]} with {len(a[3])} accepted")
            continue
        off = np.abs(np.array(a[3]) - np.array(b[3]))
        if off.size and off.max() > TOLERANCE:
            k = int(off.argmax())
            numbers = f"number {k} is {b[3][k]} mm, accepted {a[3][k]} (off by {off[k]:.4f})"
            lines.append(f"mark {i} {a[0]} {a[2]!r} of {a[1]!r}: {numbers}")
    return "\n".join(lines[:most] + ([f"... and {len(lines) - most} more"] if len(lines) > most else []))


def main() -> None:
    FOLDER.mkdir(exist_ok=True)
    for project, sheets in PROJECTS.items():
        for n in range(1, sheets + 1):
            text = "[\n" + ",\n".join(json.dumps(m, ensure_ascii=False) for m in draw(project, n)) + "\n]\n"
            path(project, n).write_bytes(gzip.compress(text.encode(), mtime=0))
            print(path(project, n))


if __name__ == "__main__":
    main()
