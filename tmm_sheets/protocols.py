"""The protocol of a project: what was constructed on its sheets, plan by plan, with the millimetres of those sheets."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING

from tmm_sheets import spelling
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.words import tell, tr

if TYPE_CHECKING:
    from tmm_sheets.construction.scale import Scale
    from tmm_sheets.construction.step import Plan
    from tmm_sheets.project import Project


def lines(project: Project, name: str | None, everything: bool = False) -> Iterator[str]:
    """Sentences of every plan on the sheets, or of one; each plan under its title and scale factor.

    With ``everything`` also those of plans that nobody draws. Plans of many positions are told for the position of the force
    analysis, the one drawn in full.

    Raises
    ------
    BadInput
        when no sheet shows a plan of that name.
    CannotBuild
        when sheets cannot be drawn: after what the others show, or at once when the plan asked for may be on one of these.
    """
    found, shown, problem = drawn_plans(project)
    if name is not None:
        if name not in found:
            if problem is not None:
                raise problem
            raise _unknown(project, name, found, shown, everything)
        found = {name: found[name]}
    elif not everything:
        found = {key: drawn for key, drawn in found.items() if not _internal(key)}
    for i, (plan, scale) in enumerate(found.values()):
        if i:
            yield ""
        yield from _plan_sentences(project, plan, scale)
    if name is None and problem is not None:
        raise problem


def names(project: Project, everything: bool = False) -> list[tuple[str, str]]:
    """Plans that the sheets show, each with its title; with ``everything`` all that there are."""
    found, shown, _ = drawn_plans(project)
    drawn = {plan for of_sheet in shown.values() for plan in of_sheet}
    return [(name, plan.title) for name, (plan, _) in found.items() if everything or name in drawn]


def _internal(name: str) -> bool:
    """Whether a plan is not to be drawn: it only smooths a curve between the numbered positions, or serves a search ("@")."""
    return name.endswith("-between") or "@" in name


def _unknown(project: Project, name: str, found: Collection[str], shown: Mapping[int, Sequence[str]], everything: bool) -> BadInput:
    """That there is no such plan, with those that may be meant, or those that are drawn, sheet by sheet."""
    drawn = [plan for of_sheet in shown.values() for plan in of_sheet]
    hint = spelling.hint(name, found if everything or _internal(name) else drawn, 6) or spelling.hint(name, found, 6)
    if not hint and everything:
        hint = tell("its plans are {plans}").format(plans=", ".join(found))
    elif not hint:
        of_sheet = tell("sheet {n}: {what}")
        lines = [of_sheet.format(n=n, what=", ".join(plans)) for n, plans in shown.items()]
        every = tell("plans that nobody draws, too: {command}").format(command=project.variant.command("protocol", "--all"))
        hint = "\n    ".join([*lines, every])
    return BadInput(tell('{project} has no plan "{plan}"').format(project=project.variant.called, plan=name), hint=hint)


def drawn_plans(project: Project) -> tuple[dict[str, tuple[Plan, Scale | None]], dict[int, list[str]], CannotBuild | None]:
    """Plans by name with the scale factors they are drawn with, in the order of construction; those that each sheet shows.

    Also why some sheets cannot be drawn.
    """
    from tmm_sheets.sheets import sheet

    scales: dict[str, Scale] = {}
    attempt = sheet.views(project)
    problem = attempt.problem()
    if problem is not None:
        _construct(project, problem)
    for canvas in attempt.drawn.values():
        scales |= canvas.scales
    plans = [plan for of_part in project.plans.values() for plan in (of_part or {}).values()]
    found = {plan.name: (plan, scales.get(plan.name)) for plan in plans if plan.steps}
    framed = {n: {frame.plan for frame in canvas.frames} for n, canvas in attempt.drawn.items()}
    return found, {n: [name for name in found if name in there and not _internal(name)] for n, there in framed.items()}, problem


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


def _plan_sentences(project: Project, plan: Plan, scale: Scale | None) -> Iterator[str]:
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
    return plan.labels.index(label) if label in plan.labels else min(2, len(plan.labels) - 1)
