"""The protocol of a project: what was constructed on its sheets, plan by plan, with the millimetres of those sheets."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from difflib import get_close_matches
from typing import TYPE_CHECKING

from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.words import tell, tr

if TYPE_CHECKING:
    from tmm_sheets.construction.plan import Plan
    from tmm_sheets.construction.scale import Scale
    from tmm_sheets.project import Project


def lines(project: Project, name: str | None) -> Iterator[str]:
    """Sentences of every plan on the sheets, or of one; each plan under its title and scale factor.

    Plans of many positions are told for the position of the force analysis, the one drawn in full.

    Raises
    ------
    BadInput
        when no sheet shows a plan of that name.
    CannotBuild
        when sheets cannot be drawn: after what the others show, or at once when the plan asked for may be on one of these.
    """
    found, problem = _drawn(project)
    if name is not None:
        if name not in found:
            if problem is not None:
                raise problem
            near = get_close_matches(name, found, n=1)
            hint = (
                tell('did you mean "{near}"?').format(near=near[0])
                if near
                else tell("its plans are {plans}").format(plans=", ".join(found))
            )
            raise BadInput(
                tell('{project} has no plan "{plan}"').format(project=project.variant.project.name, plan=name), hint=hint
            )
        found = {name: found[name]}
    else:
        # What lies between the numbered positions only smooths the curves, and what has "@" in its name nobody draws.
        found = {key: drawn for key, drawn in found.items() if not key.endswith("-between") and "@" not in key}
    for i, (plan, scale) in enumerate(found.values()):
        if i:
            yield ""
        yield from _told(project, plan, scale)
    if name is None and problem is not None:
        raise problem


def _drawn(project: Project) -> tuple[dict[str, tuple[Plan, Scale | None]], CannotBuild | None]:
    """Plans by name with the scale factors they were drawn with, in the order of the sheets, and which of these cannot be drawn."""
    from tmm_sheets.sheets import sheet

    scales: dict[str, Scale] = {}
    attempt = sheet.attempt(project, range(1, len(project.variant.drawable()) + 1))
    problem = attempt.problem()
    if problem is not None:
        _construct(project, problem)
    for composed in attempt.drawn.values():
        scales |= composed.scales
    plans = [plan for of_part in project.plans.values() for plan in (of_part or {}).values()]
    return {plan.name: (plan, scales.get(plan.name)) for plan in plans if plan.steps}, problem


def _construct(project: Project, problem: CannotBuild) -> None:
    """Where sheets cannot be drawn the linkage is constructed all the same: its plans are told without a scale factor.

    Raises the problem when there is nothing to construct.
    """
    with suppress(CannotBuild):
        if "positions" in project.parts:
            _ = project.study.accelerations
        if "forces" in project.parts:
            _ = project.study.forces, project.study.lever
    if not any(project.plans.values()):
        raise problem


def _told(project: Project, plan: Plan, scale: Scale | None) -> Iterator[str]:
    from tmm_sheets.construction.protocol import sentences

    k = _position(project, plan)
    title = tr("{title} ({name}), position {position}") if len(plan.labels) > 1 else "{title} ({name})"
    factor = f"; {scale}" if scale is not None and scale.mu != 1 else ""
    yield title.format(title=plan.title, name=plan.name, position=plan.labels[k]) + factor
    to_mm, unit = (scale.mm, "mm") if scale is not None else (float, plan.unit)
    for i, said in enumerate(sentences(plan, k, to_mm, unit), 1):
        yield f"{i:3}. {said}"


def _position(project: Project, plan: Plan) -> int:
    """Number of the position a plan is told for: that of the force analysis, or one where something has moved already."""
    cycle = project.variant.cycle
    label = cycle.force_position if cycle is not None else None
    if label in plan.labels:
        return plan.labels.index(label)
    return min(2, len(plan.labels) - 1)
