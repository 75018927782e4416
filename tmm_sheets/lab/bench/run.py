"""The whole benchmark in order."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

from tmm_sheets import quoting
from tmm_sheets.errors import BadInput
from tmm_sheets.lab.bench.records import Bench, BenchRecord
from tmm_sheets.words import tell

FIELDS = ("linkages", "diagrams", "profiles", "reducers", "emission")
"""Modules that measure, in the order of the table."""
PEERS = ("peers",)
"""The module that measures other programs."""


def run(quick: bool, say: Callable[[str], None], fields: tuple[str, ...] = FIELDS) -> list[BenchRecord]:
    """Measure fields.

    Parameters
    ----------
    quick
        Only a few small runs.
    say
        Told what is measured next.
    fields
        Modules that measure.

    Raises
    ------
    BadInput
        Without mpmath, which the truth needs.
    """
    try:
        import mpmath  # noqa: F401
    except ImportError:
        raise BadInput(tell("bench needs mpmath: the errors are told against a truth of 30 digits and more"),
                       hint=quoting.install("bench")) from None
    bench = Bench(quick, say)
    for field in fields:
        import_module(f"tmm_sheets.lab.bench.{field}").rows(bench)
    return bench.records


def compare(quick: bool, say: Callable[[str], None]) -> list[BenchRecord]:
    """Measure this program and others on the same mechanisms; see :func:`run`."""
    return run(quick, say, PEERS)
