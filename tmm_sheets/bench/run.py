"""The whole benchmark in order."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

from tmm_sheets.bench.records import Bench, Record
from tmm_sheets.errors import BadInput

FIELDS = ("linkages", "diagrams", "profiles", "reducers", "emission")
"""Modules with the rows, in the order of the table."""
PEERS = ("peers",)
"""The module that compares other programs, instead."""


def run(quick: bool, say: Callable[[str], None], fields: tuple[str, ...] = FIELDS) -> list[Record]:
    """All rows of the fields; needs mpmath for the truth they are judged by."""
    try:
        import mpmath  # noqa: F401
    except ImportError:
        raise BadInput("bench needs mpmath: the errors are told against a truth of 30 digits and more",
                       hint="pip install 'tmm-sheets[bench]'") from None
    bench = Bench(quick, say)
    for field in fields:
        import_module(f"tmm_sheets.bench.{field}").rows(bench)
    return bench.records


def compare(quick: bool, say: Callable[[str], None]) -> list[Record]:
    """The rows of other programs beside this one."""
    return run(quick, say, PEERS)
