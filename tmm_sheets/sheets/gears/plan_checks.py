"""Views for room left beside a train or a reducer: ratios as they are measured on the plan of speeds, and those of its pairs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import reduce
from itertools import pairwise
from math import prod
from operator import mul, truediv
from typing import TYPE_CHECKING

from tmm_sheets.construction.equation import Quantity, digits_for, equation
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.numbers import number
from tmm_sheets.sheets.components.listed import Lines
from tmm_sheets.sheets.gears.speed_plan import ends_of_rays
from tmm_sheets.sheets.gears.train import mobility_lines
from tmm_sheets.sheets.gears.train_scheme import link_name
from tmm_sheets.words import marked

if TYPE_CHECKING:
    from tmm_sheets.methods.gears.train import Train

MEASURED = 5.0
"""Segment below which no ratio is to be measured, mm."""


def _measured(of: Train, canvas: Canvas) -> Iterator[str]:
    """Ratios from the segments that the sheet has, as they are measured, and from the speeds; of segments that can be measured."""
    plan = of.plans[f"{of.data.part}-speeds"]
    mu = canvas.scales[plan.name]
    ends = [(link_name(step.name), round(float(mu.mm(complex(step.value).real)), 1), float(plan[f"n{step.name}"].value))
            for step in ends_of_rays(plan)]
    (one, length, n), *others = [end for end in ends if abs(end[1]) >= MEASURED] or [("", 0.0, 0.0)]
    for two, other, speed in others:
        sign, ratio = -1 if length * other < 0 else 1, f"{one},{two}"
        segments = [Quantity(f"|0–{name}|", abs(mm), "", digits_for(mm, 1), 1)
                    for name, mm in ((one, length), (two, other))]
        measured = equation(lambda a, b, sign=sign: sign * a / b, segments, Quantity(f"i_{{{ratio}}}", length / other))
        yield f"{measured};  n_{{{one}}}/n_{{{two}}} = {number(n / speed)}"


def _pairs(train: Train) -> Iterator[str]:
    teeth, plan = train.data.teeth, train.kinematics
    whole, alone = list[tuple[str, str, int, int, int]](), [m for m in train.meshes if not m.carrier]
    for m in alone:
        # From the driving wheel on: the first pair's is given, of the next ones it sits on the shaft that the one before drives.
        before = {train.link(name) for _, name, *_ in whole[-1:]} or {train.link(name) for name in train.given}
        a, b = (m.planet, m.central) if train.link(m.planet) in before else (m.central, m.planet)
        whole.append((a, b, teeth[a], teeth[b], m.sign))
        n, z = ([Quantity(f"{of}_{{{name}}}", float(plan[f"{of}{name}"].value)) for name in names]
                for of, names in (("n", (a, b)), ("z", (b, a))))
        ratio = Quantity(f"i_{{{a}{b}}}", -m.sign * teeth[b] / teeth[a])
        by_teeth = equation(lambda one, two, sign=-m.sign: sign * one / two, z, replace(ratio, symbol=""))
        yield f"{equation(truediv, n, ratio)};  {by_teeth}"
    chained = all(train.link(one[1]) == train.link(two[0]) for one, two in pairwise(whole))
    if len(whole) > 1 and len(alone) == len(train.meshes) and chained:
        sign = prod(-way for *_, way in whole)
        driving, driven = [pair[2] for pair in whole], [pair[3] for pair in whole]
        letters = "·".join(f"i_{{{one}{two}}}" for one, two, *_ in whole)
        count, result = len(whole), Quantity(f"i_{{{whole[0][0]}{whole[-1][1]}}} = {letters}", sign * prod(driven) / prod(driving))
        yield equation(lambda *z: sign * reduce(mul, z[:count]) / reduce(mul, z[count:]),
                       [Quantity("", z) for z in (*driven, *driving)], result, in_letters=False)


of_reducer = Lines(marked("Ratios by the plan of speeds"), lambda project, canvas: _measured(project.reducer, canvas))
"""Ratios of the driving link of a reducer to the others, from the segments of the plan and from the speeds."""
of_train = Lines(marked("Ratios by the plan of speeds"), lambda project, canvas: _measured(project.train, canvas))
"""The same of a train."""
mobility = Lines(marked("Mobility and speeds of the links"), lambda project, canvas: mobility_lines(project.reducer, ratios=False))
"""Degree of freedom of a reducer by Chebyshev's formula, angular velocities of its links."""
pairs = Lines(marked("Ratios of the pairs"), lambda project, canvas: _pairs(project.train))
"""Ratio of every pair whose axes stand still, by its speeds and by its teeth; of a train of such pairs that of the whole."""
