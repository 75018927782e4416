"""Formulas of steps in LaTeX: with letters, and with the numbers of a position."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from tmm_sheets.construction import expression
from tmm_sheets.construction.step import Step, value_at

_LETTERS = {
    "α": "alpha", "β": "beta", "γ": "gamma", "δ": "delta", "ε": "varepsilon", "ζ": "zeta", "η": "eta", "θ": "theta", "λ": "lambda",
    "μ": "mu", "ν": "nu", "ξ": "xi", "π": "pi", "ρ": "rho", "σ": "sigma", "τ": "tau", "φ": "varphi", "χ": "chi", "ψ": "psi",
    "ω": "omega", "Γ": "Gamma", "Δ": "Delta", "Θ": "Theta", "Λ": "Lambda", "Σ": "Sigma", "Φ": "Phi", "Ψ": "Psi", "Ω": "Omega",
    "⟂": "perp",
}  # fmt: skip
_BARRED = re.compile("(.)\u0305")
_CYRILLIC = re.compile(r"[А-Яа-яЁёІіЇїЄє][А-Яа-яЁёІіЇїЄє .]*")
_NUMBERED = re.compile(r"([^\W\d_]+)([\d,]+)([′″]*)")
TOLD = ("number", "length", "ordinate", "angle", "inclination")
"""Kinds of results whose formulas are told; a point is told by its sentence."""


def letters(markup: str) -> str:
    """Lettering markup, or the name of a step, in LaTeX."""
    if "_" not in markup and (numbered := _NUMBERED.fullmatch(markup)):
        markup = f"{numbered[1]}_{{{numbered[2]}}}{numbered[3]}"
    text = markup.replace("\\", "").replace("%", r"\%").replace("#", r"\#").replace("&", r"\&")
    text = _BARRED.sub(r"\\overline{\1}", text)
    text = _CYRILLIC.sub(lambda m: rf"\text{{{m[0]}}}", text)
    text = re.sub(r"_([^{\\])", r"_{\1}", text)
    text = text.replace("·", r"\cdot ").replace("′", "'").replace("″", "''").replace("−", "-").replace("–", r"\text{–}")
    return "".join(f"\\{_LETTERS[c]} " if c in _LETTERS else c for c in text).strip()


def tree_of(step: Step) -> expression.Expression | None:
    """The formula of a step that is told by one; None for a move of ruler and compass and for a number handed on."""
    if step.rule.gives not in TOLD:
        return None
    tree = step.rule.tree(len(step.args))
    return None if isinstance(tree, expression.Argument) or (isinstance(tree, expression.Operation) and tree.function) else tree


def symbols(step: Step, tree: expression.Expression) -> str:
    """The formula with letters."""
    return f"{letters(step.symbol or step.name)} = {expression.latex(tree, [_letter(a) for a in step.args])}"


def numbers(step: Step, tree: expression.Expression, k: int) -> str:
    """The formula with the numbers of a position; empty where one of them has none."""
    values = [value_at(a, k) for a in (*step.args, step)]
    if any(np.ndim(v) or isinstance(v, str) or not isinstance(v, int | float | complex | np.number) for v in values):
        return ""
    *texts, value = map(_number, values)
    return f"{expression.latex(tree, texts)} = {value}"


def _letter(a: Any) -> str:
    named = getattr(a, "symbol", "") or getattr(a, "name", "")
    return letters(named) if named else _number(a) if np.ndim(a) == 0 else "\\ldots"


def _number(x: Any) -> str:
    if isinstance(x, complex | np.complexfloating):
        return f"\\left({_number(x.real)};\\, {_number(x.imag)}\\right)"
    text = f"{float(x):.6g}"
    mantissa, _, power = text.partition("e")
    return f"{mantissa} \\cdot 10^{{{int(power)}}}" if power else text
