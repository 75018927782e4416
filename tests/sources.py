"""The program's modules as syntax trees, read once by each worker."""

import ast
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[1] / "tmm_sheets"
MODULES = {".".join(p.relative_to(ROOT).with_suffix("").parts): p for p in ROOT.rglob("*.py")}


@cache
def syntax(module):
    return ast.parse(MODULES[module].read_text(encoding="utf-8"))


@cache
def every_node(tree):
    """All every_node of a tree."""
    return [*ast.walk(tree)]
