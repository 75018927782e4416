"""Views for room left beside a train or a reducer: ratios as they are measured on the plan of speeds, and those of its pairs."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING

from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.numbers import fixed, number
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
        sign = "" if length * other > 0 else "−"
        yield (f"i_{{{one},{two}}} = {sign}|0–{one}|/|0–{two}| = "
               f"{sign}{fixed(abs(length), 1)}/{fixed(abs(other), 1)} = {number(length / other)}; "
               f"n_{{{one}}}/n_{{{two}}} = {number(n / speed)}")


def _pairs(train: Train) -> Iterator[str]:
    teeth, plan = train.data.teeth, train.kinematics
    whole, alone = list[tuple[str, str, int, int, int]](), [m for m in train.meshes if not m.carrier]
    for m in alone:
        # From the driving wheel on: the first pair's is given, of the next ones it sits on the shaft that the one before drives.
        before = {train.link(name) for _, name, *_ in whole[-1:]} or {train.link(name) for name in train.given}
        a, b = (m.planet, m.central) if train.link(m.planet) in before else (m.central, m.planet)
        whole.append((a, b, teeth[a], teeth[b], m.sign))
        n = [float(plan[f"n{name}"].value) for name in (a, b)]
        sign = "−" if m.sign > 0 else ""
        turns = f"{number(n[0])}/{number(n[1]) if n[1] >= 0 else f'({number(n[1])})'}"
        yield (f"i_{{{a}{b}}} = n_{{{a}}}/n_{{{b}}} = {sign}z_{{{b}}}/z_{{{a}}};  {turns} = {sign}{teeth[b]}/{teeth[a]} = "
               f"{number(-m.sign * teeth[b] / teeth[a])}")
    chained = all(train.link(one[1]) == train.link(two[0]) for one, two in pairwise(whole))
    if len(whole) > 1 and len(alone) == len(train.meshes) and chained:
        ratio, sign = 1.0, ""
        for _, _, z, other, way in whole:
            ratio *= -way * other / z
        sign = "−" if ratio < 0 else ""
        a, b = whole[0][0], whole[-1][1]
        letters = "·".join(f"i_{{{one}{two}}}" for one, two, *_ in whole)
        driven, driving = ("·".join(str(pair[k]) for pair in whole) for k in (3, 2))
        yield f"i_{{{a}{b}}} = {letters} = {sign}{driven}/({driving}) = {number(ratio)}"


of_reducer = Lines(marked("Ratios by the plan of speeds"), lambda project, canvas: _measured(project.reducer, canvas))
"""Ratios of the driving link of a reducer to the others, from the segments of the plan and from the speeds."""
of_train = Lines(marked("Ratios by the plan of speeds"), lambda project, canvas: _measured(project.train, canvas))
"""The same of a train."""
mobility = Lines(marked("Mobility and speeds of the links"), lambda project, canvas: mobility_lines(project.reducer, ratios=False))
"""Degree of freedom of a reducer by Chebyshev's formula, angular velocities of its links."""
pairs = Lines(marked("Ratios of the pairs"), lambda project, canvas: _pairs(project.train))
"""Ratio of every pair whose axes stand still, by its speeds and by its teeth; of a train of such pairs that of the whole."""
