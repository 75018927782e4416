"""View of what a gear pair is counted by, in letters and in numbers: what its steps say of themselves, without the words."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, Any

from tmm_sheets.construction.equation import Quantity, digits_for, of_step
from tmm_sheets.construction.step import Step
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import broken, letter
from tmm_sheets.drawing.marks import Box
from tmm_sheets.numbers import fixed
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.construction.plan import Plan
    from tmm_sheets.project import Project

OF_PAIR = ("inv_alpha", "inv_alpha_w", "alpha_w", "x_sum", "y", "dy", "a", "a_w", "p", "pb", "N1N2", "g_alpha", "eps_alpha")
OF_WHEEL = ("r", "rb", "rw", "ra", "rf", "s")
WAYS = ((8.0, 200.0), (7.0, 170.0), (6.0, 150.0), (6.0, 120.0), (6.0, 100.0))
"""Distances of the lines and widths at which equations are broken that are tried, mm."""
HEIGHT = 3.5
DECIMALS = 4, 7
"""So many decimals shifts and what follows from them have at least, and fewer than so many."""


def of_pair_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[tuple[float, float]]:
    """Places that the equations can do with, mm: those of the wheels as well, then those of the pair alone."""
    return [_size(lines, step, width) for lines in _both(project.gear.geometry) for step, width in WAYS]


def of_pair(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Angle of engagement, distances, pitches and contact ratio; radii and thicknesses of the wheels in numbers."""
    canvas.of = project.gear.geometry.name
    left = canvas.title(box, tr("The gear pair in numbers"))
    size, chosen = (box.width, box.height), ((lines, *way) for lines in _both(project.gear.geometry) for way in WAYS)
    lines, step, width = next(way for way in chosen if max(abs(a - b) for a, b in zip(_size(*way), size, strict=True)) < 1e-6)
    canvas.lines(complex(box.x0 + 3.0, left.y1 - 0.8 * step), _broken(lines, width), step, HEIGHT)


def _both(plan: Plan) -> tuple[list[str], list[str]]:
    lines = list(equations(plan, OF_PAIR, True))
    return [*lines, *equations(plan, [f"{name}{i}" for i in (1, 2) for name in OF_WHEEL], False)], lines


def _broken(lines: list[str], width: float) -> list[str]:
    return [part for line in lines for part in broken(line, width, HEIGHT, "(?= = )")]


def _size(lines: list[str], step: float, width: float) -> tuple[float, float]:
    parts = _broken(lines, width)
    return max(letter(part, HEIGHT).width for part in parts) + 6.0, 12.0 + step * len(parts)


def digits_of(plan: Plan) -> Callable[[Step], str]:
    """How the numbers of a pair's geometry are written on its sheet, in tables and in equations; of other steps nothing.

    Lengths in mm have two decimals, but the module has those that it is given with; shifts and y as many as give Δy by what is
    written.
    """
    decimals = _of_shifts(plan)

    def written(step: Step) -> str:
        if step.name.rstrip("12") in ("x", "y", "dy"):
            return fixed(step.value, decimals).rstrip("0").rstrip(".,")
        least = _decimals(step)
        return fixed(step.value, least) if least else ""

    return written


def _of_shifts(plan: Plan) -> int:
    """Decimals of shifts and y with which they add up to Δy."""
    last = plan["dy"]

    def adds_up(decimals: int) -> bool:
        found = last.rule.compute(*(round(float(arg.value), decimals) for arg in last.args))
        return bool(abs(found - round(float(last.value), decimals)) < 0.1 * 10.0**-decimals)

    return next(filter(adds_up, range(*DECIMALS)), DECIMALS[0])


def _decimals(step: Step) -> int:
    """Fixed decimals of a number of the pair, 0 for one that has none."""
    if step.rule.unit == "mm" and step.name != "m":
        return 2
    return {"eps_alpha": 3, "inv_alpha": 5, "inv_alpha_w": 5}.get(step.name, 0)


def equations(plan: Plan, names: Iterable[str], letters: bool) -> Iterator[str]:
    """Those steps of a plan that a formula gives: sign, formula in ``letters``, in numbers, value."""
    shifts = _of_shifts(plan)

    def quantity(symbol: str, value: float, unit: str, of: Any) -> Quantity:
        if symbol[:1] in "xyΔ":
            return Quantity(symbol, value, unit, digits_for(value, shifts))
        least = _decimals(of) if isinstance(of, Step) else 0
        return Quantity(symbol, value, unit, digits_for(value, least), least) if least else Quantity(symbol, value, unit)

    for step in (plan[name] for name in names if name in plan):
        if said := of_step(step, in_letters=letters, quantity=quantity):
            yield said
