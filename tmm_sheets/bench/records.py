"""Rows of a work-precision table, how they are measured, and how they are told."""

from __future__ import annotations

import gc
import json
import platform
from collections.abc import Callable, Iterable
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from math import isfinite
from time import perf_counter
from typing import Any, TypeVar

from tmm_sheets import __version__
from tmm_sheets.errors import CannotBuild

Found = TypeVar("Found")
SCHEMA = 1


@dataclass(frozen=True)
class Record:
    """One run: what was varied (``parameter``) and its ``value``, error against truth, seconds of the fastest repetition.

    ``error`` and ``seconds`` are None for a run that failed, ``error`` also where there is none to be had; ``note`` says why.
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
        """Seconds for one of what is counted, position or chord."""
        return None if self.seconds is None else self.seconds / self.value


@dataclass
class Bench:
    """Collects the rows. ``quick`` leaves the long ones out and repeats less; ``say`` hears what is measured next."""

    quick: bool = False
    say: Callable[[str], None] = lambda what: None
    records: list[Record] = field(default_factory=list)

    @property
    def patience(self) -> float:
        """Seconds of repetitions after which no further one begins."""
        return 0.0 if self.quick else 0.15

    def upto(self, values: Iterable[int], most: int) -> list[int]:
        """Values of a parameter, in a quick run only those up to ``most``."""
        return [v for v in values if not self.quick or v <= most]

    def row(self, what: tuple[str, str, str], value: float, run: Callable[[], Found], error: Callable[[Found], float] | None,
            note: str | Callable[[Found], str] = "") -> None:
        """Measure ``run`` and judge what it gives; ``what`` is field, method and parameter, ``note`` may tell of what it gave."""
        self.say(f"{what[0]}: {what[1]}, {value:g} {what[2]}")
        try:
            seconds, found = fastest(run, self.patience)
            off = None if error is None else float(error(found))
        except (CannotBuild, ArithmeticError, ValueError, MemoryError) as e:
            reason = str(e).splitlines()[0] if str(e) else type(e).__name__
            self.records.append(Record(*what, value, None, None, reason))
            return
        if off is not None and not isfinite(off):
            self.records.append(Record(*what, value, None, None, "not a number"))
        else:
            self.records.append(Record(*what, value, off, seconds, note if isinstance(note, str) else note(found)))


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
    """Seconds of the fastest of repeated runs after a warm-up, and what the last one gave.

    Three runs at least, more until ``patience`` seconds are spent. One that takes a quarter of a second is not slower for being
    the first: it is run twice in all, and so is any run without patience.
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


def table(records: Iterable[Record]) -> str:
    """The rows as plain text, a heading for each field, the runs of a method one under another."""
    records = list(records)
    order = {key: k for k, key in reversed(list(enumerate((r.field, r.method) for r in records)))}
    records.sort(key=lambda r: order[r.field, r.method])
    lines: list[str] = []
    field_now = ""
    for r in records:
        if r.field != field_now:
            field_now = r.field
            lines += ["", f"{field_now:58}{'':>22}{'error':>10}{'time':>11}{'each':>10}"]
        named = f"{r.value:g} {r.parameter}"
        error = "-" if r.error is None else f"{r.error:.1e}"
        note = f"  {r.note}" if r.note else ""
        lines.append(f"  {r.method:56}{named:>22}{error:>10}{told(r.seconds):>11}{told(r.each):>10}{note}")
    return "\n".join(lines[1:])


def summary(records: Iterable[Record]) -> str:
    """The first and the last run of every method, in Markdown."""
    lines = ["| field | method | from .. to | error | time |", "|---|---|---|---|---|"]
    methods: dict[tuple[str, str], list[Record]] = {}
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
        return "failed"
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


def as_json(records: Iterable[Record]) -> str:
    """The rows as JSON; what failed is null."""
    import numpy as np

    tree = {
        "schema": SCHEMA,
        "program": __version__, "python": platform.python_version(), "numpy": np.__version__, "machine": platform.machine(),
        "records": [asdict(r) for r in records],
    }  # fmt: skip
    return json.dumps(tree, ensure_ascii=False, indent=1, allow_nan=False)
