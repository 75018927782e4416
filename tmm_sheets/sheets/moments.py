"""Views of the moment equations of the force study, in letters and in numbers: of the groups and of Zhukovsky's lever."""

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


def lever_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[tuple[float, float]]:
    """Places that the equation of the lever can do with, mm; none before the lever is drawn."""
    if "lever" not in canvas.scales or not _on_lever(project)[1]:
        return []
    sizes = (220.0, 3.5, STEP), (160.0, 3.5, STEP), (160.0, 3.5, 6.0), (120.0, 3.5, 6.0), (100.0, 2.5, 5.0)
    return [(width + 6.0, 12.0 + step * len(_of_lever(project, canvas, width, height))) for width, height, step in sizes]


def lever(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Sum of the moments about the pole of Zhukovsky's lever, arms in mm of the drawing, and the balancing force it gives."""
    lines, height = _of_lever(project, canvas, box.width - 6.0, 3.5), 3.5
    if 12.0 + 6.0 * len(lines) > box.height + 1e-6:
        lines, height = _of_lever(project, canvas, box.width - 6.0, 2.5), 2.5
    canvas.of = "moments"
    left = canvas.title(box, tr("Equation of moments of the lever"))
    step = min(STEP, (left.y1 - box.y0) / len(lines))
    canvas.lines(complex(box.x0 + 3.0, left.y1 - 0.8 * step), lines, step, height)


def _on_lever(project: Project) -> tuple[Term, list[Term]]:
    """Moment of the balancing force about the pole and those of the others, forces in N, arms as velocities, m/s."""
    k, lv, forces = project.force_index, project.study.lever, project.study.forces
    found = []
    for hung in lv.hung:
        force, arm = abs(complex(hung.force.at(k))), float(hung.arm.at(k))
        sign = hung.symbol.replace(BAR, "")
        arm = arm if np.isfinite(arm) else 0.0  # a force of nothing has none
        found.append(Term(f"{sign}·h_{{{re.sub('F_|[_{}]', '', sign)}}}", 1.0 if arm > 0 else -1.0, (force, abs(arm))))
    largest = max(abs(complex(step.at(k))) for step in lv.velocities.points.values())
    sizes = forces.force_size(k), largest
    return found[-1], [term for term in found[:-1] if not any(map(is_zero, term.values, sizes))]


def _of_lever(project: Project, canvas: Canvas, width: float, height: float) -> list[str]:
    """Lines of the lever's equation, broken between its terms."""
    own, terms = _on_lever(project)
    mu, size = canvas.scales["lever"].mu, project.study.forces.force_size(project.force_index)
    measured = [term._replace(values=(term.values[0], term.values[1] / mu)) for term in terms]
    force, _ = own.letters.split("·")
    asked = tr("{force} = |{sum}|/{length} = {value} N").format(
        force=force, sum=_sum(measured, numbers=True), length=number(own.values[1] / mu), value=number(own.values[0], 5, size))
    return [line for text in (tr("ΣM_{centre} = {sum} = 0").format(centre="p", sum=_sum([own, *terms])), asked)
            for line in _broken(text, width, height)]


def _broken(text: str, width: float, height: float) -> Iterator[str]:
    """A sum on several lines, each but the first beginning with the sign of its first term."""
    line = ""
    for part in re.split(r" (?=[+−] )", text):
        longer = f"{line} {part}" if line else part
        if line and letter(longer, height).width > width:
            yield line
            longer = part
        line = longer
    yield line


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
