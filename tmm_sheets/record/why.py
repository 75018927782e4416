"""Explain a result: the steps from the given numbers to it, one a line."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets import results, spelling
from tmm_sheets.construction import protocol
from tmm_sheets.construction.step import Given, GivenNumber, GivenPoint, Reported, Step, value_at
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.numbers import in_a_row, listed
from tmm_sheets.project import LINKAGE
from tmm_sheets.record.recording import book_of, unit
from tmm_sheets.record.step_index import StepIndex, leaves, with_ancestors
from tmm_sheets.words import marked, tell, tell_n

if TYPE_CHECKING:
    from tmm_sheets.project import Project


_ABOUT = ("schema", "project", "variant", "structure", "condition", "scales")
"""Sections of the results about the whole project: read, counted or chosen, not constructed."""


_OF_PART = {"x": marked(", projection on x"), "y": marked(", projection on y"), "abs": marked(", magnitude"),
            "angle": marked(", angle"), "": ""}  # fmt: skip


def lines(project: Project, result: str) -> Iterator[str]:
    """Lines of the with_ancestors of a result, arguments first: name, letters, value with its unit, and origin.

    Of values over positions the line has that at the position of the result, or of the force analysis.

    Raises
    ------
    BadInput
        when the project has no such result; the message suggests similar names.
    CannotBuild
        when its part cannot be computed.
    """
    part = result.partition(".")[0].partition("[")[0]
    if part in _ABOUT:
        raise BadInput(
            tell("{result} has no step behind it: it is read, counted or chosen, not constructed").format(result=result),
            hint=tell("{command} tells what was read, and what follows from it").format(command=project.variant.command("show")),
        )
    of = LINKAGE[0] if part == "cycle" else part
    if of not in project.parts:
        raise _no_part(project, result, part)
    found = dict(leaves(results.told(project, [of])))
    if result not in found:
        raise _unknown(project, result, found)
    told = found[result]
    if not isinstance(told, Reported):
        raise BadInput(tell("{result} has no step behind it: it is a number of the program").format(result=result))
    _ = told.value
    book = book_of(project)
    at = told.at[0] if told.at else force_position(project)
    given: set[str] = set()
    for step in with_ancestors([told.step]):
        for arg in step.args:
            if isinstance(arg, GivenNumber | GivenPoint | Given) and arg.name not in given:
                given.add(arg.name)
                yield _given(arg, at, book, step)
        yield _line(step, at, book)
    yield f"{result}{tell(_OF_PART[told.part])} = {_value_in_words(told, at, book)}"


def _no_part(project: Project, result: str, part: str) -> BadInput:
    """Error for a part that the project does not have; suggests similar results and parts."""
    try:
        known = [name for name, _ in leaves(results.told(project, None, refused={}))]
    except CannotBuild:
        known = []
    hint = spelling.hint(result, (*known, *project.parts), 6) or tell("it has {parts}").format(parts=", ".join(project.parts))
    return BadInput(tell('{project} has no part "{part}"').format(project=project.variant.called, part=part), hint=hint)


def _unknown(project: Project, result: str, known: Any) -> BadInput:
    name, names = project.variant.called, list(known)
    hint = spelling.hint(result, names, 6, 0.5) or tell("there are {names}").format(
        names=", ".join(names[:12]) + (" ..." if len(names) > 12 else ""))
    return BadInput(tell('{project} has no result "{result}"').format(project=name, result=result), hint=hint)


def force_position(project: Project) -> str:
    """Label of the position of the force analysis."""
    cycle = project.variant.cycle
    return "" if cycle is None else cycle.force_position or project.cycle.labels[0]


def _index(step: Step, at: str, book: StepIndex) -> int:
    labels = book.plans[book.plan(step)].labels if step in book else ("",)
    return labels.index(at) if at in labels else 0


def _given(arg: GivenNumber | GivenPoint | Given, at: str, book: StepIndex, step: Step) -> str:
    k = _index(step, at, book)
    value: Any = arg.value if isinstance(arg, Given) else arg
    if isinstance(arg, Given) and (arg.over == "curve" or np.ndim(value) > 1 or (np.ndim(value) == 1 and k >= len(value))):
        n = int(np.shape(value)[-1]) if np.ndim(value) else 1
        shown = tell_n("{n} number", "{n} numbers", n).format(n=n)
    else:
        shown = _number(value_at(arg, k), arg.unit)
    choice = arg.choice if isinstance(arg, Given) else ""
    origin = (
        tell("chosen: {choice}").format(choice=choice)
        if choice
        else tell("given: {source}").format(source=arg.source)
        if arg.source
        else tell("given")
    )
    return f"{arg.name}  {arg.symbol or '-'} = {shown}  {origin}"


def _line(step: Step, at: str, book: StepIndex) -> str:
    k = _index(step, at, book)
    plan = book.plans.get(book.plan(step)) if step in book else None
    name = book.id(step) if step in book else step.name
    value = value_at(step, k) if np.ndim(step.value) < 2 else step.value
    told = unit(step, plan) if plan is not None else step.rule.unit
    return f"{name}  {step.symbol or step.name} = {_number(value, told)}  {sentence(step, at, book)}"


def sentence(step: Step, at: str, book: StepIndex) -> str:
    """What is done in a step at a position, with its numbers."""
    plan = book.plans.get(book.plan(step)) if step in book else None
    return protocol.sentence(step, _index(step, at, book), float, plan.unit if plan is not None else "")


def _value_in_words(told: Reported, at: str, book: StepIndex) -> str:
    value = told.value
    plan = book.plans.get(book.plan(told.step)) if told.step in book else None
    told_unit = "rad" if told.part == "angle" else unit(told.step, plan) if plan is not None else told.step.rule.unit
    if np.ndim(value) == 1:
        labels = told.at or (plan.labels if plan is not None else ())
        if len(labels) == len(value):
            k = labels.index(at) if at in labels else 0
            return tell("{value}, position {label}").format(value=_number(value[k], told_unit), label=labels[k])
    return _number(value, told_unit)


def _number(value: Any, of_unit: str) -> str:
    if not isinstance(value, str) and np.ndim(value):
        n = int(np.shape(value)[0])
        return tell_n("{n} number", "{n} numbers", n).format(n=n)
    if isinstance(value, complex | np.complexfloating):
        text = f"({in_a_row((listed(float(value.real)), listed(float(value.imag))))})"
    elif isinstance(value, int | float | np.number):
        text = listed(float(value))
    else:
        text = tell("curve") if not isinstance(value, str) else value
    return f"{text} {of_unit}".rstrip()
