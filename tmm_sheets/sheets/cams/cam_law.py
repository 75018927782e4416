"""View of the law of motion in formulas, with the greatest second derivative of each phase in numbers."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise, product
from math import inf
from typing import TYPE_CHECKING

from tmm_sheets.construction.arithmetic import BY_PIECES
from tmm_sheets.construction.equation import Quantity, equation, lettered
from tmm_sheets.construction.expression import Expression, Operation, trace
from tmm_sheets.construction.formula import PRODUCT, Letters, Operand, of_tree
from tmm_sheets.drawing.lettering import broken, letter
from tmm_sheets.numbers import number
from tmm_sheets.sheets.components.listed import Form, Formulas
from tmm_sheets.words import marked, tr

if TYPE_CHECKING:
    from tmm_sheets.methods.cams.cam_laws import Law, Phase, PositionFunction

WAYS = (5.0, 12.0, inf), (3.5, 8.0, inf), (3.5, 7.0, inf), (3.5, 6.0, inf), (3.5, 6.0, 62.0)
"""Heights of the letters, distances of the lines and widths at which these are broken that are tried, mm."""
TITLE = marked("Law of motion in formulas")


def formula_layouts(law: PositionFunction) -> Iterator[Form]:
    """The formulas of both phases one under another or side by side, under a title as large as others or in smaller letters."""
    phases = phases_of(law)
    for height, step, most in WAYS:
        rise, fall = ([line for text in lines for line in _broken(text, most, height)] for lines in phases)
        for columns, titled in product(([rise + fall], [rise, fall]), (5.0, 3.5)):
            yield Form(columns, height, step, least=letter(tr(TITLE), titled).width)


equations = Formulas(TITLE, "cam-motion", lambda project, canvas: formula_layouts(project.cam.law))
"""Displacement and both derivatives on the rise and on the return."""


def _broken(text: str, most: float, height: float) -> list[str]:
    """A line of no more than a width, mm: what grows with its numbers broken before a sign, a heading after its word."""
    if letter(text, height).width <= most or text.startswith("|"):
        return broken(text, most, height)
    word, colon, rest = text.partition(": ")
    return [f"{word}:", rest] if colon else [text]


def phases_of(law: PositionFunction) -> tuple[list[str], list[str]]:
    """Formulas of the rise and of the return."""
    rise, fall = law.rise, law.fall
    before = "".join(f" − {p.letters}" for p in (rise, law.upper_dwell) if p.angle > 0)
    return (_formulas(law.symbol, rise, tr("Rise: x = {share}").format(share=f"φ/{rise.letters}")),
            _formulas(law.symbol, fall, tr("Return: x = {share}").format(share=f"(φ{before})/{fall.letters}")))


def _formulas(symbol: str, phase: Phase, head: str) -> list[str]:
    """Formulas of one phase under its heading, of the return those of the way back; its greatest second derivative."""
    most, angle, back = f"{symbol}_{{max}}", phase.letters, phase.travel < 0
    minus, forms = "−" if back else "", written(phase.law)
    lines = [head if forms else head.partition(" ")[0]]  # of a law without formulas its word alone
    for where, (s, ds, dds) in forms:
        lines += [f"{where}:"] if where else []
        lines += [f"{symbol} = {most}·[1 − {s}]" if back else f"{symbol} = {most}·{s}",
                  f"{symbol}' = {minus}{most}/{angle}·{ds}", f"{symbol}'' = {minus}{most}/{angle}^2·{dds}"]
    of = Quantity(number(phase.law.peak), phase.law.peak), Quantity(most, abs(phase.travel)), Quantity(angle, phase.angle)
    return [*lines, equation(lambda peak, most, angle: peak * most / angle**2, of,
                             Quantity(f"|{symbol}''|_{{max}}", phase.amplitude, "m" if symbol == "S" else ""))]


def written(law: Law) -> list[tuple[str, tuple[str, ...]]]:
    """Displacement and both derivatives for unit stroke and unit phase angle, by pieces of the phase, from the law itself.

    A law that is given as a diagram has no formula.
    """
    trees = [] if law.nodes else [tree for form in law.forms if (tree := trace(form, 1)) is not None]
    if len(trees) < len(law.forms):
        return []
    pieces = [_pieces_of(tree) for tree in trees]
    return [(same[0][0], tuple(_of_share(tree, PRODUCT) for _, tree in same)) for same in zip(*pieces, strict=True)]


def _of_share(tree: Expression, least: int = 0) -> str:
    """A formula of the share x of the phase, as a factor if it has to bind as ``least`` says."""
    return lettered(of_tree(tree, [Operand(Letters("x"))], least))


def _pieces_of(tree: Expression) -> list[tuple[str, Expression]]:
    """The formulas of the pieces of a phase, each with the shares where it holds; all of it has no such words."""
    if not isinstance(tree, Operation) or tree.name != BY_PIECES:
        return [("", tree)]
    borders = [_of_share(border) for border in tree.parts[2::2]]
    return list(zip([f"x < {borders[0]}", *(f"{a} < x < {b}" for a, b in pairwise(borders)), f"x > {borders[-1]}"],
                    tree.parts[1::2], strict=True))
