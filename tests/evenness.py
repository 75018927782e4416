"""How evenly finished sheets are filled, kind by kind, against the aims.

Usage: python -m tests.evenness [--ciphers N --seed S] [--each] [PROJECT ...]; without names all shipped projects and the ciphers.

For every arrangement: share of cells of 50 mm without ink (mean, most), sheets with an empty rectangle of 160 x 120 mm, what
position plans take of their places, and the longest vector of the velocity plans. Exit status 1 when an aim is missed. What cannot
be built is told.
"""

from __future__ import annotations

import argparse
import statistics
import sys
from collections import defaultdict
from multiprocessing import Pool
from typing import NamedTuple

import numpy as np

from tests.gallery import names
from tests.labels import drawn_lots
from tmm_sheets import catalogue
from tmm_sheets.drawing import evenness
from tmm_sheets.drawing.marks import Drawing, Fill, Line, Mark
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed

MEAN, MOST, GAP = 0.12, 0.18, (160.0, 120.0)
"""At most so many cells are empty in the mean of a kind, on one sheet; an empty rectangle of these sides, lying or upright, is a
gap.
"""
PLANS, LEAST_PLAN = 0.60, 0.40
"""What position plans take of their places, at least: in the median, each."""
VECTOR = 30.0, 100.0
"""The longest vector of the velocity plans, mm."""


class Sheet(NamedTuple):
    """What is measured of a sheet; ``gap`` is the lower left corner of an empty rectangle."""

    name: str
    kind: str
    empty: float
    gap: tuple[float, float] | None
    plans: list[float]
    vectors: list[float]


def gap(drawing: Drawing, step: float = 2.0) -> tuple[float, float] | None:
    """Lower left corner of an empty rectangle of GAP's sides, mm, or None."""
    field = evenness.FIELD
    shape = int(field.width / step), int(field.height / step)
    inked = np.zeros(shape, np.int64)
    ink = evenness.dense((m for m in drawing.marks if m.of != evenness.FRAME), 1.0)
    z = np.concatenate((ink, *map(evenness.covering, evenness.TAKEN)))
    i, j = ((z.real - field.x0) / step).astype(int), ((z.imag - field.y0) / step).astype(int)
    there = (i >= 0) & (i < shape[0]) & (j >= 0) & (j < shape[1])
    inked[i[there], j[there]] = 1
    total = np.pad(inked.cumsum(0).cumsum(1), ((1, 0), (1, 0)))
    for sides in (GAP, GAP[::-1]):
        nx, ny = (int(side / step) for side in sides)
        free = np.argwhere(total[nx:, ny:] - total[:-nx, ny:] - total[nx:, :-ny] + total[:-nx, :-ny] == 0)
        if len(free):
            return float(field.x0 + step * free[0][0]), float(field.y0 + step * free[0][1])
    return None


def _length(arrow: tuple[Mark, ...]) -> float:
    """Length of an arrow from its beginning to its tip, mm; 0.0 for a head alone."""
    lines, heads = ([m for m in arrow if isinstance(m, kind)] for kind in (Line, Fill))
    return max((abs(complex(head.points[0]) - line.a) for line in lines for head in heads), default=0.0)


def measured(name: str) -> list[Sheet | str]:
    """The sheets of a project, or why one cannot be built."""
    found: list[Sheet | str] = []
    try:
        project = Project(catalogue.read(name))
    except Exception as e:
        return [f"{name}: {type(e).__name__}: {e}"]
    for n, kind in enumerate(project.sheets, 1):
        try:
            sheet = composed(project, n)
        except Exception as e:
            found.append(f"{name} {n}: {type(e).__name__}: {e}")
            continue
        titles = {part.title for part in sheet.parts if part.draw == "kinematics.position_plans"}
        vectors = [_length(arrow) for g in sheet.groups if g.kind == "arrow" and (arrow := sheet.drawing.marks[g.first : g.end])
                   and arrow[0].of.startswith("velocity plan")]
        found.append(Sheet(f"{name} {n}", kind, evenness.empty_cells(sheet.drawing), gap(sheet.drawing),
                           [share for title, share in evenness.fills(sheet.drawing) if title in titles],
                           [max(vectors)] if vectors else []))
    return found


def main(args: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.evenness")
    parser.add_argument("--ciphers", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--each", action="store_true", help="a line for every sheet")
    parser.add_argument("project", nargs="*")
    asked = parser.parse_args(args)
    which = names(asked.project) + ([] if asked.project else drawn_lots(asked.ciphers, asked.seed))
    with Pool() as pool:
        found = [s for of_project in pool.imap(measured, which) for s in of_project]
    sheets = [s for s in found if isinstance(s, Sheet)]
    kinds = defaultdict(list)
    for s in sheets:
        kinds[s.kind].append(s)
        if asked.each:
            print(f"{s.name:44} {s.empty:5.0%}{'  empty at {:.0f}, {:.0f}'.format(*s.gap) if s.gap else ''}")
    bad = []
    print(f"{'kind':24}{'sheets':>7}{'mean':>7}{'most':>7}{'gaps':>6}")
    for kind, of_kind in sorted(kinds.items()):
        mean, most = statistics.mean(s.empty for s in of_kind), max(of_kind, key=lambda s: s.empty)
        print(f"{kind:24}{len(of_kind):7}{mean:7.1%}{most.empty:7.0%}{sum(bool(s.gap) for s in of_kind):6}")
        bad += [f"{kind}: {mean:.1%} empty in the mean"] if mean > MEAN else []
    bad += [f"{s.name}: {s.empty:.0%} empty" for s in sheets if s.empty > MOST]
    bad += ["{}: empty rectangle at {:.0f}, {:.0f}".format(s.name, *s.gap) for s in sheets if s.gap]
    plans = [share for s in sheets for share in s.plans]
    if plans:
        print(f"position plans take of their places: median {statistics.median(plans):.0%}, least {min(plans):.0%}")
        bad += ["position plans: median"] if statistics.median(plans) < PLANS else []
        bad += [f"{s.name}: position plan takes {min(s.plans):.0%}" for s in sheets if s.plans and min(s.plans) < LEAST_PLAN]
    vectors = [length for s in sheets for length in s.vectors]
    if vectors:
        print(f"longest vectors of velocity plans: {min(vectors):.0f} .. {max(vectors):.0f} mm")
        bad += [f"{s.name}: longest velocity {max(s.vectors):.1f} mm" for s in sheets
                if s.vectors and not VECTOR[0] <= max(s.vectors) <= VECTOR[1]]
    print(*(f"not built: {s}" for s in found if isinstance(s, str)), *bad, sep="\n")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
