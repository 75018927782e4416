"""Rows of a work-precision table: measuring, printing and storing them."""

from __future__ import annotations

import gc
import json
import platform
from collections.abc import Callable, Iterable
from contextlib import contextmanager
from dataclasses import dataclass, field, fields
from math import isfinite
from time import perf_counter
from typing import Any, TypeVar

from tmm_sheets.errors import CannotBuild
from tmm_sheets.version import __version__
from tmm_sheets.words import tell

Found = TypeVar("Found")
SCHEMA = 1


@dataclass(frozen=True)
class BenchRecord:
    """One run.

    Attributes
    ----------
    field, method : what was measured
    parameter, value : what is varied from run to run, and its value
    error : against the truth; None when the run failed or there is no truth
    seconds : of the fastest repetition; None when the run failed
    note : why it failed, or what else is worth telling
    """

    field: str
    method: str
    parameter: str
    value: float
    error: float | None
    seconds: float | None
    note: str = ""

    @property
    def each(self) -> float | None:
        """Seconds for one of what ``parameter`` counts, a position or a chord."""
        return None if self.seconds is None else self.seconds / self.value


@dataclass
class Bench:
    """Measures and collects rows; ``quick`` leaves the long ones out and repeats less, ``say`` is told what comes next."""

    quick: bool = False
    say: Callable[[str], None] = lambda what: None
    records: list[BenchRecord] = field(default_factory=list)

    @property
    def patience(self) -> float:
        """Seconds after which no further repetition begins."""
        return 0.0 if self.quick else 0.15

    def upto(self, values: Iterable[int], most: int) -> list[int]:
        """Values of a parameter, in a quick run only those up to ``most``."""
        return [v for v in values if not self.quick or v <= most]

    def row(self, what: tuple[str, str, str], value: float, run: Callable[[], Found], error: Callable[[Found], float] | None,
            note: str | Callable[[Found], str] = "") -> None:
        """Measure a run and keep its record; see :meth:`record`."""
        self.records.append(self.record(what, value, run, error, note))

    def record(self, what: tuple[str, str, str], value: float, run: Callable[[], Found], error: Callable[[Found], float] | None,
               note: str | Callable[[Found], str] = "") -> BenchRecord:
        """Measure a run.

        Parameters
        ----------
        what, value
            Field, method and parameter of the record, and the value of the parameter.
        run
            What is timed.
        error
            Judges what ``run`` returns; None without a truth.
        note
            Goes into the record; a function gets what ``run`` returns.
        """
        self.say(f"{what[0]}: {what[1]}, {value:g} {what[2]}")
        try:
            seconds, found = fastest(run, self.patience)
            off = None if error is None else float(error(found))
        except (CannotBuild, ArithmeticError, ValueError, MemoryError) as e:
            reason = str(e).splitlines()[0] if str(e) else type(e).__name__
            return BenchRecord(*what, value, None, None, reason)
        if off is not None and not isfinite(off):
            return BenchRecord(*what, value, None, None, tell("not a number"))
        return BenchRecord(*what, value, off, seconds, note if isinstance(note, str) else note(found))


@contextmanager
def _no_collection() -> Any:
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


def fastest(run: Callable[[], Found], patience: float) -> tuple[float, Found]:
    """Seconds of the fastest of repeated runs after a warm-up, and what the last one returned.

    At least three runs are timed, more until ``patience`` seconds are spent. A run of a quarter of a second or more needs no
    warm-up: it is run twice in all, and so is any run without patience.
    """
    best, spent, count = float("inf"), 0.0, 0
    with _no_collection():
        while count < 2 or (patience and best < 0.25 and (spent < patience or count < 4)):
            start = perf_counter()
            found = run()
            took = perf_counter() - start
            if count or took > 0.25:
                best = min(best, took)
                spent += took
            count += 1
    return best, found


def table(records: Iterable[BenchRecord]) -> str:
    """The rows as plain text, a heading for each field, the runs of a method one below another."""
    records = list(records)
    order = {key: k for k, key in reversed(list(enumerate((r.field, r.method) for r in records)))}
    records.sort(key=lambda r: order[r.field, r.method])
    lines: list[str] = []
    field_now = ""
    for r in records:
        if r.field != field_now:
            field_now = r.field
            lines += ["", "{:80}{:>10}{:>11}{:>10}".format(field_now, tell("error"), tell("time"), tell("each"))]
        named = f"{r.value:g} {r.parameter}"
        error = "-" if r.error is None else f"{r.error:.1e}"
        note = f"  {r.note}" if r.note else ""
        lines.append(f"  {r.method:56}{named:>22}{error:>10}{told(r.seconds):>11}{told(r.each):>10}{note}")
    return "\n".join(lines[1:])


def summary(records: Iterable[BenchRecord]) -> str:
    """The first and the last run of every method, in Markdown."""
    lines = [tell("| field | method | from .. to | error | time |"), "|---|---|---|---|---|"]
    methods: dict[tuple[str, str], list[BenchRecord]] = {}
    for r in records:
        methods.setdefault((r.field, r.method), []).append(r)
    for (name, method), rows in methods.items():
        ends = [rows[0], rows[-1]] if len(rows) > 1 else rows
        values = " .. ".join(f"{r.value:,.0f}" for r in ends)
        errors = " .. ".join("-" if r.error is None else f"{r.error:.0e}" for r in ends)
        times = " .. ".join(told(r.seconds) for r in ends)
        lines.append(f"| {name} | {method} | {values} {rows[0].parameter} | {errors} | {times} |")
    return "\n".join(lines)


def told(seconds: float | None) -> str:
    """Seconds with three digits in the unit that suits them."""
    if seconds is None:
        return tell("failed")
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


def as_json(records: Iterable[BenchRecord]) -> str:
    """The rows as JSON, null for what failed."""
    import numpy as np

    tree = {
        "schema": SCHEMA,
        "program": __version__, "python": platform.python_version(), "numpy": np.__version__, "machine": platform.machine(),
        "records": [{f.name: getattr(r, f.name) for f in fields(BenchRecord)} for r in records],
    }  # fmt: skip
    return json.dumps(tree, ensure_ascii=False, indent=1, allow_nan=False)
