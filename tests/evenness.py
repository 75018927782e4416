"""How evenly finished sheets are filled, kind by kind, against the aims.

Usage: python -m tests.evenness [--ciphers N --seed S] [--lang L] [--each] [--jobs N] [PROJECT ...]; as :mod:`tests.labels`, with 60
ciphers.

For every arrangement: share of cells of 50 mm without ink (mean, most), sheets with an empty rectangle of more than 160 x 120 mm,
what position plans take of their places, what of the kinematics is below its floor (:mod:`tmm_sheets.sheets.border_solver`), one
line for each, with "told" where the sheet itself says so, and how far details and equations stand from what they are of. Exit
status 1 when an aim is missed. What cannot be built is told.
"""

from __future__ import annotations

import argparse
import statistics
import sys
from collections import defaultdict
from collections.abc import Iterator
from itertools import combinations, pairwise
from math import inf
from multiprocessing import Pool
from typing import NamedTuple

import numpy as np

from tests.labels import add_options, chosen
from tmm_sheets import catalogue
from tmm_sheets.box import Box
from tmm_sheets.drawing import ink_index
from tmm_sheets.drawing.marks import Arc, Drawing, Text
from tmm_sheets.project import Project
from tmm_sheets.sheets.border_solver import CRANK, LETTERED, SHARE, VECTOR, Floor
from tmm_sheets.sheets.composed import Composed
from tmm_sheets.sheets.linkage import details, kinematic_frames, kinematics
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.words import set_paper, tell

EMPTY = 160.0 * 120.0
"""Area of the largest rectangle without ink that no eye stops at, mm^2."""
MEAN, MOST = 0.12, 0.18
"""At most so many cells are empty in the mean of a kind, on one sheet."""
PLANS = 0.60
"""What position plans take of their places, at least, in the median."""
DISTANCE = 200.0
"""So far a detail or an equation stands at most from its view, mm, middle from middle."""
EQUATIONS = {"moments of the lever": ("kinetics.lever",),
             "moments": ("kinetics.group", "kinetics.groups", "kinetics.crank", "friction.mechanism")}
"""Equations and the views they are read from."""


class Size(NamedTuple):
    """Size of a view beside its floor, mm, or the share of its place; ``told`` where the sheet says that it is below."""

    view: str
    size: float
    floor: Floor
    told: bool


class Apart(NamedTuple):
    """How far a detail or an equation stands from what it is of, mm."""

    view: str
    distance: float


class Sheet(NamedTuple):
    """What is measured of a sheet; ``gap`` is the largest empty rectangle, ``plans`` what position plans take of their places."""

    name: str
    kind: str
    empty: float
    gap: Box
    plans: list[float]
    sizes: list[Size]
    apart: list[Apart]

    def below(self) -> list[Size]:
        """What is below its floor."""
        return [s for s in self.sizes if s.size < s.floor.least * (1 - 1e-6)]


def gap(drawing: Drawing, step: float = 2.0) -> Box:
    """The largest rectangle without ink, mm."""
    field = ink_index.FIELD
    nx, ny = int(field.width / step), int(field.height / step)
    inked = np.zeros((ny, nx), bool)
    ink = ink_index.dense((m for m in drawing.marks if m.of != ink_index.FRAME), 1.0)
    z = np.concatenate((ink, *map(ink_index.covering, ink_index.TAKEN)))
    i, j = ((z.real - field.x0) / step).astype(int), ((z.imag - field.y0) / step).astype(int)
    there = (i >= 0) & (i < nx) & (j >= 0) & (j < ny)
    inked[j[there], i[there]] = True
    high, best = np.zeros(nx, int), (0, 0, 0, 0, 0)
    for top, row in enumerate(inked, 1):
        high = np.where(row, 0, high + 1)
        rising = list[tuple[int, int]]()
        for k, h in enumerate((*high.tolist(), 0)):
            begin = k
            while rising and rising[-1][1] >= h:
                begin, tall = rising.pop()
                best = max(best, (tall * (k - begin), begin, k, top - tall, top))
            rising.append((begin, h))
    _, i0, i1, j0, j1 = best
    return Box(field.x0 + step * i0, field.y0 + step * j0, field.x0 + step * i1, field.y0 + step * j1)


def sizes(project: Project, sheet: Composed) -> Iterator[Size]:
    """What the kinematics of a sheet measure beside their floors, by where the plans lie on it."""
    draws = [part.draw for part in sheet.parts]
    told = " ".join(str(remark) for remark in sheet.illegible)
    vectors = defaultdict[str, float](float)
    for n, frame in enumerate(sheet.frames):
        if frame.view < 0 or (view := draws[frame.view]) not in OF_PLANS:
            continue
        study = project.study
        if frame.plan == study.positions.plan.name:
            yield Size(view, 2 * project.mechanism.crank.length / frame.mu[0], CRANK, tell(CRANK.what) in told)
        plan = next((of.plan for of in (study.velocities, study.accelerations) if of.plan.name == frame.plan), None)
        if plan is None:
            continue
        k = project.cycle.labels.index(frame.position)
        points = kinematic_frames.plan_points(plan, k)
        z = np.array(list(points.values())) / frame.mu[0]
        longest = max(abs(complex(seg.head.at(k)) - complex(seg.tail.at(k))) for seg in plan.segments) / frame.mu[0]
        # What is enlarged need not be so large among the others.
        of = "kinematics.velocity_plans" if view == "kinematics.enlarged_velocities" else view
        vectors[of] = max(vectors[of], longest)
        lettered = {m.by.step for m in sheet.drawing.marks if isinstance(m, Text) and m.by is not None and m.by.frame == n}
        at = [complex(frame(complex(plan[name].at(k)))) for name in points if plan[name].path in lettered]
        near = min((abs(a - b) for a, b in combinations(at, 2) if abs(a - b) > 0.5), default=inf)
        if near < kinematics.CLEAR_LETTER:
            yield Size(f"{view} {frame.position}", max(np.ptp(z.real), np.ptp(z.imag)), LETTERED, tell(LETTERED.what) in told)
    yield from (Size(view, size, VECTOR, tell(VECTOR.what) in told) for view, size in vectors.items())


def apart(sheet: Composed) -> Iterator[Apart]:
    """Details, from the middle of the window to the middle of its circle on the view, and equations, to the nearest of their views.

    Of an equation its middle counts, of its views the nearest point.
    """
    marks, parts = sheet.drawing.marks, sheet.parts
    spans = [marks[a.first:b.first] for a, b in pairwise(parts)]
    for k, (part, own) in enumerate(zip(parts, spans, strict=False)):
        if part.draw == details.VIEW and part.title:
            window, circle = (next(m for m in span if isinstance(m, Arc)) for span in (own, spans[k + 1]))
            yield Apart(f"{part.draw} {part.title}", abs(window.centre - circle.centre))
        if own and own[-1].of in EQUATIONS:
            at = Box.around(ink_index.dense(own, 2.0)).centre
            views = [span for other, span in zip(parts, spans, strict=False) if other.draw in EQUATIONS[own[-1].of]]
            inked = [ink_index.dense((m for m in span if m.of not in EQUATIONS), 2.0) for span in views]
            yield Apart(own[-1].of, min((_off(at, Box.around(ink)) for ink in inked if len(ink)), default=inf))


def _off(z: complex, box: Box) -> float:
    x, y = max(box.x0 - z.real, z.real - box.x1, 0.0), max(box.y0 - z.imag, z.imag - box.y1, 0.0)
    return abs(complex(x, y))


OF_PLANS = ("kinematics.position_plans", "kinematics.velocity_plans", "kinematics.acceleration_plan",
            "kinematics.second_accelerations", "kinematics.enlarged_velocities")


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
        found.append(Sheet(f"{name} {n}", kind, ink_index.empty_cells(sheet.drawing), gap(sheet.drawing),
                           [share for title, share in ink_index.fills(sheet.drawing) if title in titles], [*sizes(project, sheet)],
                           [*apart(sheet)]))
    return found


def main(args: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.evenness")
    add_options(parser, 60)
    parser.add_argument("--each", action="store_true", help="a line for every sheet")
    asked = parser.parse_args(args)
    set_paper(asked.lang)
    with Pool(asked.jobs) as pool:
        found = [s for of_project in pool.imap(measured, chosen(asked)) for s in of_project]
    sheets = [s for s in found if isinstance(s, Sheet)]
    kinds = defaultdict(list)
    for s in sheets:
        kinds[s.kind].append(s)
        if asked.each:
            print(f"{s.name:44} {s.empty:5.0%}  {_said(s.gap)}{''.join(f'  plans {share:.0%}' for share in s.plans)}")
    bad = []
    print(f"{'kind':24}{'sheets':>7}{'mean':>7}{'most':>7}{'gaps':>6}  largest empty rectangle")
    for kind, of_kind in sorted(kinds.items()):
        mean, most = statistics.mean(s.empty for s in of_kind), max(of_kind, key=lambda s: s.empty)
        largest = max((s.gap for s in of_kind), key=_area)
        gaps = sum(_area(s.gap) > EMPTY for s in of_kind)
        print(f"{kind:24}{len(of_kind):7}{mean:7.1%}{most.empty:7.0%}{gaps:6}  {_said(largest)}")
        bad += [f"{kind}: {mean:.1%} empty in the mean"] if mean > MEAN else []
    if sheets:
        print(f"cells without ink: {statistics.mean(s.empty for s in sheets):.1%} in the mean of all")
    bad += [f"{s.name}: {s.empty:.0%} empty" for s in sheets if s.empty > MOST]
    bad += [f"{s.name}: empty rectangle {_said(s.gap)}" for s in sheets if _area(s.gap) > EMPTY]
    plans = [share for s in sheets for share in s.plans]
    if plans:
        print(f"position plans take of their places: mean {statistics.mean(plans):.0%}, median {statistics.median(plans):.0%}, "
              f"least {min(plans):.0%}")
        bad += ["position plans: median"] if statistics.median(plans) < PLANS else []
        bad += [f"{s.name}: position plan takes {min(s.plans):.0%}" for s in sheets if s.plans and min(s.plans) < SHARE]
    below = [(s.name, size) for s in sheets for size in s.below()]
    print(f"views below their floors: {len(below)}, of these not told {sum(not size.told for _, size in below)}")
    for floor in dict.fromkeys(size.floor for s in sheets for size in s.sizes):
        every = [size.size for s in sheets for size in s.sizes if size.floor == floor]
        under = sum(size.floor == floor for _, size in below)
        print(f"  {floor.what}: least {min(every):.1f} mm, below {floor.least:.0f}: {under} of {len(every)}")
    every_apart = [(s.name, one) for s in sheets for one in s.apart]
    for of in (details.VIEW, *EQUATIONS):
        own = [one.distance for _, one in every_apart if one.view.partition(" (")[0].rstrip("IVX ") == of]
        far = sum(distance > DISTANCE for distance in own)
        print(f"{of}: {len(own)}, over {DISTANCE:.0f} mm from their views {far}, farthest {max(own, default=0.0):.0f}")
    bad += [f"{name} {one.view}: {one.distance:.0f} mm from its view" for name, one in every_apart if one.distance > DISTANCE]
    bad += [f"{name} {size.view}: {size.floor.what} {size.size:.1f} mm{', told' * size.told}" for name, size in below]
    print(*(f"not built: {s}" for s in found if isinstance(s, str)), *bad, sep="\n")
    return 1 if bad else 0


def _area(box: Box) -> float:
    return box.width * box.height


def _said(box: Box) -> str:
    return f"{box.width:.0f} x {box.height:.0f} mm at {box.x0:.0f}, {box.y0:.0f}"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
