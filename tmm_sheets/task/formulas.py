"""Small formulas in files of tables: ``(b - a) / 2``, ``l * sin(theta)``, ``a > b``; numbers and names, nothing that runs."""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable, Mapping

_TWO: dict[type[ast.operator], Callable[[float, float], float]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv, ast.Pow: operator.pow}
_OF_DEGREES: dict[str, Callable[[float], float]] = {
    "sin": lambda x: math.sin(math.radians(x)), "cos": lambda x: math.cos(math.radians(x)),
    "tan": lambda x: math.tan(math.radians(x)), "asin": lambda x: math.degrees(math.asin(x)),
    "acos": lambda x: math.degrees(math.acos(x)), "atan": lambda x: math.degrees(math.atan(x))}
KNOWN: dict[str, Callable[[float], float]] = {**_OF_DEGREES, "sqrt": math.sqrt, "abs": abs, "round": round}
"""Functions of one number; angles are degrees."""


def value(text: str, numbers: Mapping[str, float]) -> float:
    """The number that a formula gives; of a comparison, 1 where it holds.

    Raises
    ------
    ValueError
        for what is no formula, a name that is no number, or a number that there is not.
    """
    try:
        return float(_value(ast.parse(text.strip().replace("^", "**"), mode="eval").body, numbers))
    except (SyntaxError, ZeroDivisionError, OverflowError, TypeError, RecursionError) as e:
        raise ValueError(str(e)) from None


def _value(node: ast.expr, numbers: Mapping[str, float]) -> float:
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        return float(node.value)  # type: ignore[arg-type]
    if isinstance(node, ast.Name) and (node.id in numbers or node.id == "pi"):
        return numbers.get(node.id, math.pi)
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        return -_value(node.operand, numbers)
    if isinstance(node, ast.BinOp) and type(node.op) in _TWO:
        return _TWO[type(node.op)](_value(node.left, numbers), _value(node.right, numbers))
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in KNOWN and len(node.args) == 1:
        return KNOWN[node.func.id](_value(node.args[0], numbers))
    if isinstance(node, ast.Compare) and [type(sign) for sign in node.ops] in ([ast.Lt], [ast.Gt]):
        left, right = _value(node.left, numbers), _value(node.comparators[0], numbers)
        return float(left < right if isinstance(node.ops[0], ast.Lt) else left > right)
    raise ValueError(ast.unparse(node))
