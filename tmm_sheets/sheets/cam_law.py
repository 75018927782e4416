"""View of the law of motion in formulas, with the greatest second derivative of each phase in numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Box
from tmm_sheets.numbers import number
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.methods.cams.cam_laws import Phase, PositionFunction
    from tmm_sheets.project import Project

FORMS: dict[str, tuple[tuple[str, tuple[str, str, str]], ...]] = {
    "sine": (("", ("(x − sin(2πx)/(2π))", "(1 − cos(2πx))", "2π·sin(2πx)")),),
    "cosine": (("", ("(1 − cos(πx))/2", "π/2·sin(πx)", "π^2/2·cos(πx)")),),
    "constant": (("x < 1/2", ("2x^2", "4x", "4")), ("x > 1/2", ("(1 − 2(1 − x)^2)", "4(1 − x)", "(−4)"))),
    "linearly decreasing": (("", ("x^2(3 − 2x)", "6x(1 − x)", "6(1 − 2x)")),),
}
"""Displacement and both derivatives for unit stroke and unit phase angle, by the name of the law and by pieces of the phase.

A law that is given as a diagram of its second derivative has no formula.
"""
WAYS = (5.0, 12.0), (3.5, 8.0), (3.5, 7.0), (3.5, 6.0)
"""Heights of the letters and distances of the lines that are tried, mm."""
APART = 14.0
"""Distance of the formulas of both phases where they stand side by side, mm."""


def equations_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[tuple[float, float]]:
    """Places that the formulas can do with, mm: those of both phases one under another or side by side."""
    rise, fall = _phases(project.cam.law)
    sizes = []
    for height, step in WAYS:
        one, two = _width(rise, height), _width(fall, height)
        sizes += [(max(one, two) + 6.0, 12.0 + step * (len(rise) + len(fall))),
                  (one + APART + two + 6.0, 12.0 + step * max(len(rise), len(fall)))]
    return sizes


def equations(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Displacement and both derivatives on the rise and on the return."""
    rise, fall = _phases(project.cam.law)
    canvas.of = project.cam.motion.plan.name
    left = canvas.title(box, tr("Law of motion in formulas"))
    for height, most in WAYS:
        wide = box.width >= _width(rise, height) + APART + _width(fall, height)
        columns = [rise, fall] if wide else [rise + fall]
        step = min(most, (left.y1 - box.y0) / max(map(len, columns)))
        if step >= 2 * height and _width(rise + fall, height) <= box.width:
            break
    x = box.x0 + 3.0
    for lines in columns:
        canvas.lines(complex(x, left.y1 - 0.8 * step), lines, step, height)
        x += _width(lines, height) + APART


def _width(lines: list[str], height: float) -> float:
    return max(letter(line, height).width for line in lines)


def _phases(law: PositionFunction) -> tuple[list[str], list[str]]:
    rise, fall = law.rise, law.fall
    before = "".join(f" − {p.letters}" for p in (rise, law.upper_dwell) if p.angle > 0)
    return (_formulas(law.symbol, rise, tr("Rise: x = {share}").format(share=f"φ/{rise.letters}")),
            _formulas(law.symbol, fall, tr("Return: x = {share}").format(share=f"(φ{before})/{fall.letters}")))


def _formulas(symbol: str, phase: Phase, head: str) -> list[str]:
    """Formulas of one phase under its heading, of the return those of the way back; its greatest second derivative."""
    most, angle, back = f"{symbol}_{{max}}", phase.letters, phase.travel < 0
    minus, forms = "−" if back else "", FORMS.get(phase.law.name, ())
    lines = [head] if forms else []
    for where, (s, ds, dds) in forms:
        lines += [f"{where}:"] if where else []
        lines += [f"{symbol} = {most}·[1 − {s}]" if back else f"{symbol} = {most}·{s}",
                  f"{symbol}' = {minus}{most}/{angle}·{ds}", f"{symbol}'' = {minus}{most}/{angle}^2·{dds}"]
    peak, unit = number(phase.law.peak), tr("m") if symbol == "S" else ""
    return [*lines, f"|{symbol}''|_{{max}} = {peak}·{most}/{angle}^2 = {peak}·{number(abs(phase.travel))}/"
            f"{number(phase.angle)}^2 = {number(phase.amplitude)} {unit}".rstrip()]
