"""Plans of positions, velocities, accelerations and forces for 12 to a million positions."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial
from math import pi
from typing import Any

import numpy as np
import numpy.typing as npt

from tmm_sheets import catalogue
from tmm_sheets.lab.bench import truth
from tmm_sheets.lab.bench.records import Bench
from tmm_sheets.mechanism.groups import RRP, RRR
from tmm_sheets.mechanism.model import Crank, Guide, Link, LinkPoint, Mechanism, StructuralGroup
from tmm_sheets.methods.linkage.numbering import even_cycle
from tmm_sheets.methods.linkage.study import Study
from tmm_sheets.project import Project

COUNTS = (12, 24, 120, 360, 1000, 10_000, 100_000, 1_000_000)
BLOCK = 8192
"""Positions solved at a time: the arrays of a block fit into the processor's cache, and memory stays bounded."""
CHECKED = 8
"""Positions compared with the truth, spread over the turn."""
GRAVITY = 9.81

CRANK = Crank("1", "A", "B", 0.1, 10.0, 1)
ROCKER_DYAD = StructuralGroup(RRR, ("2", "3"), ("B", "D"), "C", (0.35, 0.25), (), 1)
SLIDER_DYAD = StructuralGroup(RRP, ("2", "3"), ("B",), "C", (0.35,), ("x",), 1)
SLIDER_GUIDE = Guide("x", "0", -0.02j, 0.0)


def four_bar() -> Mechanism:
    """Crank 0.1, coupler 0.35, rocker 0.25, frame 0.4 m; centres of mass in the middles of the links."""
    return Mechanism(
        CRANK, {"A": 0j, "D": 0.4 + 0j}, {}, (ROCKER_DYAD,),
        (LinkPoint("S2", "2", "B", "C", 0.175), LinkPoint("S3", "3", "D", "C", 0.125)),
        {"1": Link("1"), "2": Link("2", "", 3.5, "S2", 0.036), "3": Link("3", "", 2.5, "S3", 0.013)})


def slider_crank() -> Mechanism:
    """Crank 0.1, rod 0.35 m, guide 0.02 m below the axis; centre of mass of the rod at a third of its length."""
    return Mechanism(
        CRANK, {"A": 0j}, {"x": SLIDER_GUIDE}, (SLIDER_DYAD,),
        (LinkPoint("S2", "2", "B", "C", 0.35 / 3),),
        {"1": Link("1"), "2": Link("2", "", 3.5, "S2", 0.036), "3": Link("3", "", 5.0, "C")})


def shaper() -> Mechanism:
    """The six-bar shaper of manual 000: a slotted rocker that drives the ram."""
    return Project(catalogue.read("lugansk/shaper")).mechanism


MECHANISMS: tuple[tuple[str, Callable[[], Mechanism]], ...] = (
    ("four-bar", four_bar), ("slider-crank", slider_crank), ("six-bar", shaper),
)
QUANTITIES = {"positions": {"points": ("points", "z")}, "velocities": {"points": ("points", "v"), "links": ("omega", "omega")},
              "accelerations": {"points": ("points", "a"), "links": ("epsilon", "epsilon")}}
"""What the plans give, by kinds of comparable size: its name in the plan, and in the truth."""
PLANS = (*QUANTITIES, "forces")
Values = dict[str, Any]


def _values(study: Study, plan: str) -> dict[str, Values]:
    """What a plan gives, by kinds of comparable size."""
    if plan == "forces":
        found = study.forces
        return {"reactions": {k: s.value for k, s in found.reactions.items()}, "balancing": {"": found.balancing.value}}
    made = getattr(study, plan)
    return {kind: {k: s.value for k, s in getattr(made, name).items()} for kind, (name, _) in QUANTITIES[plan].items()}


def study_of(m: Mechanism, turned: npt.NDArray[np.float64]) -> Study:
    """All plans for crank angles, rad, under weights and inertia, with a balancing moment on the crank."""
    return Study(m, even_cycle(m, 0.0, 1), turned, ("",), GRAVITY, tuple, None)


def _run(m: Mechanism, n: int, plan: str, keep: npt.NDArray[np.int64]) -> dict[tuple[str, str], npt.NDArray[Any]]:
    """A plan for ``n`` positions; the results at the positions in ``keep`` are returned, by kind and name."""
    found: dict[tuple[str, str], list[Any]] = {}
    for start in range(0, n, BLOCK):
        turned = np.asarray(2 * pi / n * np.arange(start, min(start + BLOCK, n)), dtype=np.float64)
        here = keep[(keep >= start) & (keep < start + len(turned))] - start
        for kind, values in _values(study_of(m, turned), plan).items():
            for name, value in values.items():
                found.setdefault((kind, name), []).append(np.broadcast_to(value, turned.shape)[here])
    return {key: np.concatenate(parts) for key, parts in found.items()}


class _Truth:
    """The truth of all plans at ``most`` of ``n`` positions."""

    def __init__(self, m: Mechanism, n: int, most: int) -> None:
        checked = min(n, most)
        self.keep = np.arange(checked) * n // checked + n // (3 * most)
        self.mechanism = m
        self.step = 2 * pi / n

    @cached_property
    def _moved(self) -> list[truth.TrueMotion]:
        return [truth.motion(self.mechanism, self.mechanism.crank.sense * (self.step * k)) for k in self.keep.tolist()]

    def _at(self, moved: truth.TrueMotion, plan: str) -> dict[str, Values]:
        if plan == "forces":
            forces, moment = truth.reactions(self.mechanism, moved, GRAVITY)
            return {"reactions": forces, "balancing": {"": moment}}
        return {kind: getattr(moved, name) for kind, (_, name) in QUANTITIES[plan].items()}
    def error(self, plan: str, found: dict[tuple[str, str], Any]) -> float:
        """Largest error of any kind, relative to the largest value of that kind."""
        off: dict[str, float] = {}
        size: dict[str, float] = {}
        goals = [self._at(moved, plan) for moved in self._moved]
        for (kind, name), values in found.items():
            for goal, value in zip(goals, values.tolist(), strict=True):
                if name in goal[kind]:  # not a foot or another auxiliary point of the construction
                    off[kind] = max(off.get(kind, 0.0), float(abs(value - goal[kind][name])))
                    size[kind] = max(size.get(kind, 0.0), float(abs(goal[kind][name])))
        return max(off[kind] / size[kind] for kind in off)


def rows(bench: Bench) -> None:
    """Every plan of the four-bar, the slider-crank and the six-bar; its time includes the plans before it."""
    for name, build in MECHANISMS:
        m = build()
        truths = {n: _Truth(m, n, 4 if bench.quick else CHECKED) for n in bench.upto(COUNTS, 24)}
        for plan in PLANS:
            for n, true in truths.items():
                bench.row(("linkages", f"{plan} of the {name}", "positions"), n,
                          partial(_run, m, n, plan, true.keep), partial(true.error, plan))
