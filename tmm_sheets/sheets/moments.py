"""View of the moment equations of the force study in letters and in numbers, with the arms they take."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tmm_sheets.construction.indices import pair_index
from tmm_sheets.construction.plan import symbol
from tmm_sheets.construction.step import Step
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import letter, size_for
from tmm_sheets.drawing.marks import Box
from tmm_sheets.numbers import is_zero, number
from tmm_sheets.sheets.linkage import indexed
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.project import Project

BAR = "\u0305"
STEP = 7.0
"""Distance of the lines, mm."""


class Term(NamedTuple):
    """A term of a sum of moments: its letters, its sign, and its numbers: a force (N) with its arm (m), or a couple (N m)."""

    letters: str
    sign: float
    values: tuple[float, ...]


def equations_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[tuple[float, float]]:
    """Places that the equations can do with, mm."""
    lines = list(_lines(project))
    if not lines:
        return []
    return [(max(letter(line, height).width for line in lines) + 6.0, 12.0 + step * len(lines))
            for height, step in ((3.5, STEP), (3.5, 6.0), (2.5, 5.0))]


def equations(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Every equation of moments that gives a part of a reaction or the balancing moment: letters, then numbers."""
    lines = list(_lines(project))
    canvas.of = "moments"
    left = canvas.title(box, tr("Equations of moments"))
    height = size_for(lines, box.width, 3.5)
    step = min(STEP, (left.y1 - box.y0) / len(lines))
    canvas.lines(complex(box.x0 + 3.0, left.y1 - 0.8 * step), lines, step, height)


def _lines(project: Project) -> Iterator[str]:
    k, forces, pos = project.force_index, project.study.forces, project.study.positions
    for part in forces.from_moments:
        sign, arm = f"F_{{{pair_index(part.link, part.source)}}}^τ", f"{part.at}{part.centre}"
        total, centre, at = part.vector.args
        if not np.isfinite(total.at(k)):
            continue
        length = float(forces.positions.plan.length(centre, at).at(k))
        terms = list(_terms(project, total))
        if not terms:
            continue
        # The part turns counter-clockwise about the centre where the others together turn clockwise.
        turning = -1.0 if float(total.at(k)) > 0 else 1.0
        own = Term(f"{sign}·l_{{{arm}}}", turning, ())
        yield tr("ΣM_{centre} = {sum} = 0").format(centre=indexed(part.centre), sum=_sum([own, *terms]))
        value = number(abs(complex(part.vector.at(k))), 5, forces.force_size(k))
        yield tr("{force} = |{sum}|/{length} = {value} N").format(
            force=sign, sum=_sum(terms, numbers=True), length=number(length), value=value)
    if project.driver is None and forces.balancing is not None:
        total = forces.balancing.args[0]
        terms = list(_terms(project, total)) if np.isfinite(total.at(k)) else []
        if terms:
            name = indexed(tr("Mb") if project.balancing == "Mур" else project.balancing)
            turning = -1.0 if float(total.at(k)) > 0 else 1.0
            centre = indexed(pos.mechanism.crank.pivot)
            yield tr("ΣM_{centre} = {sum} = 0").format(centre=centre, sum=_sum([Term(name, turning, ()), *terms]))
            yield tr("{moment} = |{sum}| = {value} N·m").format(
                moment=name, sum=_sum(terms, numbers=True), value=number(abs(float(total.at(k))), 5, forces.moment_size(k)))


def _terms(project: Project, total: Step) -> Iterator[Term]:
    """Terms of a sum of moments at the analysed position, without those that are nothing."""
    k, forces = project.force_index, project.study.forces
    letters = {id(load.vector): load.symbol for loads in forces.loads.values() for load in loads}
    least = forces.moment_size(k)
    for at, vector, couple in zip(total.args[1::3], total.args[2::3], total.args[3::3], strict=True):
        if isinstance(vector, Step):
            arm = forces.arm_about(total.args[0], at, vector)
            force, length = abs(complex(vector.at(k))), float(arm.at(k))
            sign = letters.get(id(vector), symbol(vector.name)).replace(BAR, "")
            if np.isfinite(length) and not is_zero(force * length, least):  # a force of nothing has no arm
                index = re.sub("F_|[_{}]", "", sign)
                yield Term(f"{sign}·h_{{{index}}}", 1.0 if length > 0 else -1.0, (force, abs(length)))
        if isinstance(couple, Step) and not is_zero(value := float(couple.at(k)), least):
            yield Term(symbol(couple.symbol or couple.name).replace(BAR, ""), 1.0 if value > 0 else -1.0, (abs(value),))


def _sum(terms: list[Term], numbers: bool = False) -> str:
    """Terms with their signs, in letters or in numbers."""
    said = ""
    for n, term in enumerate(terms):
        sign = "−" if term.sign < 0 else "+"
        text = "·".join(number(value) for value in term.values) if numbers else term.letters
        said += (f" {sign} " if n else "−" if term.sign < 0 else "") + text
    return said
