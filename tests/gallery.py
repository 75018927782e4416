"""Contact sheets: every shipped project's sheets, small, side by side (``make gallery``); for looking, not for judging alone.

Usage: python -m tests.gallery [-o DIR] [PROJECT ...]; a name may end in a star. What cannot be built is told on its place.
"""

from __future__ import annotations

import argparse
import sys
from fnmatch import fnmatch
from multiprocessing import Pool
from pathlib import Path

import numpy as np

from tmm_sheets import catalogue
from tmm_sheets.drawing.ink import strokes as dashed
from tmm_sheets.drawing.lettering import strokes as letters
from tmm_sheets.drawing.marks import Fill, Text, flat
from tmm_sheets.drawing.styles import line_types
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed

COLUMNS, ROWS = 3, 4
SIZE = 7.0
"""Width of one sheet on a contact sheet, inches."""
CIPHERS = ("00-T-111", "01-T-27", "05-T-384", "09-T-999")
"""Ciphers of the transport machines that are shown."""


def names(patterns: list[str]) -> list[str]:
    """Shipped projects that match, files, and any other cipher by its name; a transport machine stands for its ciphers."""
    every = []
    for entry in catalogue.entries():
        transport = entry.name.startswith("transport/") and "@" not in entry.name
        every += [f"{entry.name}@{c}" for c in CIPHERS] if transport else [entry.name]
    found = [n for n in every if not patterns or any(fnmatch(n, p) for p in patterns)]
    return found + [p for p in patterns if p.endswith(".toml") or ("@" in p and "*" not in p and p not in found)]


def pictures(name: str) -> list[tuple[str, object, list[str]]]:
    """Marks of each sheet of a project, or why there are none, and the labels without a free place."""
    found: list[tuple[str, object, list[str]]] = []
    try:
        project = Project(catalogue.read(name))
        for n in range(1, len(project.sheets) + 1):
            try:
                sheet = composed(project, n)
                found.append((f"{name} {n}", sheet.drawing.marks, [c.text for c in sheet.crowded]))
            except Exception as e:
                found.append((f"{name} {n}", f"{type(e).__name__}: {e}", []))
    except Exception as e:
        found.append((name, f"{type(e).__name__}: {e}", []))
    return found


def draw(axes: object, title: str, marks: object, crowded: list[str]) -> None:
    from matplotlib.collections import LineCollection, PolyCollection

    axes.set(xlim=(0, 841), ylim=(0, 594), aspect="equal", xticks=[], yticks=[])
    axes.set_title(title + (f"  CROWDED: {', '.join(crowded)}" if crowded else ""), fontsize=7, color="red" if crowded else "black")
    if isinstance(marks, str):
        axes.text(420, 300, marks, ha="center", va="center", wrap=True, fontsize=8, color="red")
        return
    types, lines, widths, fills = line_types(), [], [], []
    for mark in dashed(marks):
        if isinstance(mark, Fill):
            fills.append(np.column_stack((mark.points.real, mark.points.imag)))
        elif isinstance(mark, Text):
            turn = np.exp(1j * mark.angle)
            for s in letters(mark.text, mark.height):
                p = mark.at + turn * s
                lines.append(np.column_stack((p.real, p.imag)))
                widths.append(mark.height / 10)
        else:
            p = flat(mark, 2.0)
            lines.append(np.column_stack((p.real, p.imag)))
            widths.append(types[mark.style].width)
    point = SIZE * 72 / 841
    axes.add_collection(LineCollection(lines, linewidths=np.array(widths) * point * 1.3, colors="black"))
    axes.add_collection(PolyCollection(fills, facecolors="black", edgecolors="none"))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("patterns", nargs="*")
    parser.add_argument("-o", "--output", type=Path, default=Path("out/gallery"))
    given = parser.parse_args()
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib.figure import Figure

    given.output.mkdir(parents=True, exist_ok=True)
    with Pool() as pool:
        shown = [p for of_project in pool.imap(pictures, names(given.patterns)) for p in of_project]
    page = COLUMNS * ROWS
    for start in range(0, len(shown), page):
        figure = Figure(figsize=(COLUMNS * SIZE, ROWS * SIZE * 0.74), dpi=100, layout="constrained")
        for i, (title, marks, crowded) in enumerate(shown[start:start + page]):
            draw(figure.add_subplot(ROWS, COLUMNS, i + 1), title, marks, crowded)
        path = given.output / f"contact{start // page + 1:02}.png"
        figure.savefig(path)
        print(path)
    bad = [title for title, marks, crowded in shown if isinstance(marks, str) or crowded]
    print(f"{len(shown)} sheets, {len(bad)} with something to look at: {', '.join(bad) or 'none'}")
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
