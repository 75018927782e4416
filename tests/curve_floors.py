"""Graphs, pole distances and teeth of finished sheets against the least sizes at which they are read.

Usage: python -m tests.curve_floors [--ciphers N --seed S] [--each] [PROJECT ...]; without names all shipped projects, those of
the tests and the ciphers.

Of every graph the extent across its axis, of all its curves together (:mod:`tmm_sheets.construction.scale`); of one that is
shown enlarged too that of the enlarged one. What is below its floor is told; it is explained where ``check`` tells it as well.
Exit status 1 when anything is unexplained.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections import defaultdict
from itertools import pairwise
from multiprocessing import Pool
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tests.labels import add_options, chosen
from tmm_sheets import catalogue
from tmm_sheets.construction.scale import CURVE, MAIN, POLE, TOOTH
from tmm_sheets.drawing.marks import flat
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.words import set_paper


class Graph(NamedTuple):
    """Curves of a view that are one graph: those of the steps that match, along y or turned along x; its floor, mm."""

    view: str
    steps: str
    name: str
    floor: float
    turned: bool = False


GRAPHS = (
    Graph("flywheel.force_graph", "reduction/", "F", CURVE),
    Graph(r"flywheel.moments|mertsalov.column", "reduced-moment/M", "M", CURVE),
    Graph(r"flywheel.works|mertsalov.column", "work/", "A", CURVE),
    Graph(r"flywheel.total_work|mertsalov.column", "total-work/", "ΔE", MAIN),
    Graph("mertsalov.column", "first-energy/", "T_I", MAIN),
    Graph("mertsalov.column", "reduced-inertia/|reduction/", "J", CURVE),
    Graph("flywheel.inertia", "reduced-inertia/", "J", CURVE, turned=True),
    Graph("flywheel.energy_mass", "energy-mass/", "ΔE(J)", MAIN),
    Graph("flywheel.energy_mass", "energy-mass/", "J(ΔE)", CURVE, turned=True),
    Graph("enlarged.change", "total-work/", "ΔE enlarged", MAIN),
    Graph("enlarged.energy_mass", "energy-mass/", "ΔE(J) enlarged", MAIN),
    Graph("enlarged.energy_mass", "energy-mass/", "J(ΔE) enlarged", CURVE, turned=True),
    Graph("crank_speed.graph", "energy-mass-speed/", "ω1", CURVE),
    Graph("gear.sliding", "gear-sliding/yV", "V1, V2", CURVE),
    Graph("gear.sliding", "gear-sliding-between/theta", "θ1, θ2", CURVE),
    Graph("cam.motion", "cam-motion-between/", "S''", CURVE),
    Graph("cam.motion", "cam-motion/[Sψ]'$", "S'", CURVE),
    Graph("cam.motion", "cam-motion/[Sψ]$", "S", MAIN),
    Graph("cam_zone.of_tappet", "cam-zone-between/", "S(S')", CURVE),
    Graph("cam_zone.of_rocker", "cam-zone(-fall)?-between/", "D(ψ)", CURVE),
    Graph("cam_zone.sum_graph", "cam-plate-between/", "S + S''", CURVE),
    Graph("cam.pressure", "cam-profile-between/α", "α", CURVE),
    Graph("cam.spring", "cam-spring-between/", "F, Q", CURVE),
    Graph("diagrams.balancing", "balance/", "M_b", CURVE),
    Graph("friction.power", "friction-power/", "N", CURVE),
    Graph("diagrams.motion", "motion/[Sψ]", "S, V, a", MAIN),
    Graph("diagrams.motion", "motion/[^Sψ]", "S, V, a", CURVE),
    Graph("load_diagram.over_turn", "loads/", "F", CURVE),
)


NAMES = {"H1": ("distance H_1",), "H2": ("distance H_2",), "h": ("the tooth",), "S": ("the graph of S", "the graph of ψ")}
"""What ``check`` calls some sizes."""


class Size(NamedTuple):
    """What was measured of a sheet, and the size it should have at least, mm."""

    sheet: str
    view: str
    name: str
    size: float
    floor: float
    told: bool

    @property
    def below(self) -> bool:
        """Whether it is too small, to the millimetre, as ``check`` tells it."""
        return round(self.size) < self.floor


def _graphs(sheet):
    """Views, names, extents and floors of the graphs of a composed sheet."""
    for part, after in pairwise(sheet.parts):
        found = defaultdict(list)
        for mark in sheet.drawing.marks[part.first:after.first]:
            if getattr(mark, "by", None) and mark.by.role == "curve":
                for graph in (g for g in GRAPHS if re.fullmatch(g.view, part.draw) and re.match(g.steps, mark.by.step)):
                    # the quantities of a motion stand each on an axis of its own
                    quantity = mark.by.step.partition("/")[2][:1]
                    found[graph, quantity if graph.view == "diagrams.motion" else ""].append(flat(mark))
        for (graph, quantity), curves in found.items():
            z = np.concatenate(curves)
            yield part.draw, quantity or graph.name, float(np.ptp(z.real if graph.turned else z.imag)), graph.floor


def _others(project, n, sheet):
    """Pole distances and teeth of a sheet, as :func:`_graphs`."""
    views = {part.draw for part in sheet.parts}
    if views & {"flywheel.moments", "mertsalov.column"}:
        yield "moments", "H", project.flywheel.scales.pole, POLE
    if "cam.motion" in views:
        yield "cam.motion", "H1", project.cam.motion.scales.h1, POLE
        yield "cam.motion", "H2", project.cam.motion.scales.h2, POLE
    for view, scale in (("gear.engagement", "gear-engagement"),):
        if view in views:
            tooth = max(abs(w.ra - w.rf) for w in project.gear.wheels)
            yield view, "h", sheet.scales[scale].mm(tooth), TOOTH


def measured(name):
    """The sizes on the sheets of a project, or why one cannot be built."""
    found = []
    try:
        project = Project(catalogue.read(name))
    except Exception as e:
        return [f"{name}: {type(e).__name__}: {e}"]
    for n in range(1, len(project.sheets) + 1):
        try:
            sheet = composed(project, n)
            told = [str(remark) for remark in sheet.illegible]
            every = [*_graphs(sheet), *_others(project, n, sheet)]
            shown = {what.removesuffix(" enlarged") for _, what, *_ in every if what.endswith(" enlarged")}
            for view, what, size, floor in (one for one in every if one[1] not in shown):
                found.append(Size(f"{name} {n}", view, what, float(size), floor,
                                  any(name in said for said in told for name in NAMES.get(what, (f"the graph of {what}",)))))
        except Exception as e:
            found.append(f"{name} {n}: {type(e).__name__}: {e}")
    return found


def main(args):
    parser = argparse.ArgumentParser(prog="python -m tests.curve_floors")
    add_options(parser, 0)
    parser.add_argument("--each", action="store_true", help="a line for every size, not only for those below their floor")
    asked = parser.parse_args(args)
    which = chosen(asked)
    set_paper(asked.lang)
    with Pool(asked.jobs) as pool:
        found = [s for of_project in pool.imap(measured, which) for s in of_project]
    sizes = [s for s in found if isinstance(s, Size)]
    for s in sizes:
        if asked.each or s.below:
            print(f"{Path(s.sheet).name:40} {s.view:24} {s.name:12}{s.size:7.1f} of {s.floor:.0f}"
                  f"{'  told' * s.told if s.below else ''}")
    print(f"{'':24}{'number':>7}{'least':>7}{'below':>7}{'told':>6}")
    kinds = defaultdict(list)
    for s in sizes:
        kinds[s.view, s.name].append(s)
    for (view, name), of_kind in sorted(kinds.items()):
        below = [s for s in of_kind if s.below]
        print(f"{view + ' ' + name:34}{len(of_kind):5}{min(s.size for s in of_kind):7.1f}{len(below):5}"
              f"{sum(s.told for s in below):5}")
    unexplained = [s for s in sizes if s.below and not s.told]
    print(f"{len(which)} projects, {len(sizes)} sizes, {sum(s.below for s in sizes)} below their floor, "
          f"{len(unexplained)} unexplained")
    print(*(f"not built: {s}" for s in found if isinstance(s, str)), sep="\n")
    return 1 if unexplained else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
