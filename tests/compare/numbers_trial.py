"""Digits changed before a sheet is traced and photographed: are they read? Needs the extra ``ocr``.

``python -m tests.compare.numbers_trial [PROJECT:SHEET ...] [--changed N] [--seed S]`` changes so many numbers of each sheet. The
lettering is that of the program, photographed as in :mod:`tests.compare.simulation`: no handwriting is tried.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from tests.compare.form import of_elements
from tests.compare.simulation import shoot
from tmm_sheets import catalogue
from tmm_sheets.compare.elements import known_sheet
from tmm_sheets.compare.photo import image, small_marks
from tmm_sheets.drawing.marks import Text
from tmm_sheets.project import Project

SHEETS = ("lugansk/shaper:2", "lugansk/engine:1", "press:3", "sixbar/3:2:1", "transport/diesel@01-Т-27:2")


def changed(text: str, rng: np.random.Generator) -> str:
    """A number with one of its first two digits another one."""
    at = rng.choice([i for i, c in enumerate(text) if c.isdigit()][:2])
    return text[:at] + str((int(text[at]) + int(rng.integers(1, 10))) % 10) + text[at + 1:]


def trial(name: str, n: int, count: int, seed: int) -> tuple[int, int, int, int, int]:
    """Numbers asked for, not readable, changed enough to tell, of those told, others told."""
    project, rng = Project(catalogue.read(name)), np.random.default_rng(seed)
    sheet = known_sheet(project, n)
    marks = list(sheet.sheet.drawing.marks)
    numbers = [e for e in sheet.elements if small_marks.is_number(e)]
    told = {}
    for e in (numbers[i] for i in rng.choice(len(numbers), min(count, len(numbers)), replace=False)):
        at = next(i for i, m in enumerate(marks) if any(m is own for own in e.marks))
        mark = marks[at]
        assert isinstance(mark, Text)
        marks[at] = mark._replace(text=changed(mark.text, rng))
        if small_marks.differs(marks[at].text, e.text, e.text == e.position):
            told[e.number] = marks[at].text
    shot = shoot(replace(sheet.sheet.drawing, marks=tuple(marks)), seed)
    with TemporaryDirectory() as folder:
        path = Path(folder) / "photo.jpg"
        path.write_bytes(shot.data)
        tree = image.compare(project, n, path, read_numbers=True).tree
    said = {row["number"] for row in of_elements(tree) if row["number"] in told and row["verdict"] == "amber"}
    asked = tree["numbers_read"]
    return asked["asked"], asked["unread"], len(told), len(said), asked["otherwise"] - len(said)


def main() -> None:
    """Print a line for each sheet, and all together."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sheets", nargs="*", default=SHEETS)
    parser.add_argument("--changed", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    rows = []
    for k, sheet in enumerate(options.sheets):
        name, _, n = sheet.rpartition(":")
        rows.append(trial(name, int(n), options.changed, options.seed + k))
        print(f"{sheet}: {_row(rows[-1])}", flush=True)
    print(f"together: {_row(tuple(map(sum, zip(*rows, strict=True))))}")


def _row(found: tuple[int, ...]) -> str:
    return "{} numbers, {} not readable; {} changed, {} of them told; {} others told".format(*found)


if __name__ == "__main__":
    main()
