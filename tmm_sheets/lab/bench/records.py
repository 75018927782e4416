"""The benchmark in order, and rows of a work-precision table: measuring, printing, storing and drawing them."""

from __future__ import annotations

import json
import platform
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, fields
from functools import partial
from importlib import import_module
from io import BytesIO
from math import isfinite
from timeit import Timer
from typing import Any, TypeVar

from tmm_sheets import catalogue, quoting
from tmm_sheets.drawing.marks import Drawing
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.files import ENDINGS
from tmm_sheets.project import Project
from tmm_sheets.version import __version__
from tmm_sheets.words import tell

Found = TypeVar("Found")
SCHEMA = 1
PATIENCE = 0.15
"""Seconds after which no further repetition begins."""
DIGITS = 40
"""Of the numbers of mpmath that the methods are measured against."""


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

    def upto(self, values: Iterable[int], most: int) -> list[int]:
        """Values of a parameter, in a quick run only those up to ``most``."""
        return [v for v in values if not self.quick or v <= most]

    def row(self, what: tuple[str, str, str], value: float, run: Callable[[], Found], error: Callable[[Found], float] | None,
            note: str | Callable[[Found], str] = "") -> None:
        """Measure a run and keep its record.

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
            seconds, found = fastest(run, 0.0 if self.quick else PATIENCE)
            off = None if error is None else float(error(found))
            said = note if isinstance(note, str) else note(found)
        except (CannotBuild, ArithmeticError, ValueError, MemoryError) as e:
            seconds, off, said = None, None, str(e).splitlines()[0] if str(e) else type(e).__name__
        if off is not None and not isfinite(off):
            seconds, off, said = None, None, tell("not a number")
        self.records.append(BenchRecord(*what, value, off, seconds, said))

    def rows(self, what: tuple[str, str, str], values: Iterable[int], most: int, run: Callable[[int], Found],
             error: Callable[[int, Found], float]) -> None:
        """Measure runs of the values of a parameter, in a quick run of those up to ``most``."""
        for value in self.upto(values, most):
            self.row(what, value, partial(run, value), partial(error, value))


def fastest(run: Callable[[], Found], patience: float) -> tuple[float, Found]:
    """Seconds of the fastest of repeated runs after a warm-up, and what the last one returned.

    At least three runs are timed, more until ``patience`` seconds are spent. A run of a quarter of a second or more needs no
    warm-up: it is run twice in all, and so is any run without patience.
    """
    found: list[Found] = []

    def once() -> None:
        found[:] = [run()]

    timer, best, spent, count = Timer(once), float("inf"), 0.0, 0  # which lets nobody collect garbage meanwhile
    while count < 2 or (patience and best < 0.25 and (spent < patience or count < 4)):
        took = timer.timeit(1)
        if count or took > 0.25:
            best = min(best, took)
            spent += took
        count += 1
    return best, found[0]


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


FIELDS = ("linkages", "diagrams", "profiles")
"""Modules that measure, in the order of the table."""


def run(quick: bool, say: Callable[[str], None]) -> list[BenchRecord]:
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
    for module in FIELDS:
        import_module(f"tmm_sheets.lab.bench.{module}").rows(bench)
    files_written(bench)
    return bench.records


DPI = 100
FEW = 100
"""Marks of a sheet in a quick run."""


def files_written(bench: Bench) -> None:
    """Every format with the smallest and the largest sheet of the shaper, without errors: there is no truth for them."""
    from tmm_sheets.sheets.sheet import composed

    project = Project(catalogue.read("lugansk/cam_flat" if bench.quick else "lugansk/shaper"))
    drawings: list[Drawing] = []
    for n in range(1, len(project.sheets) + 1):
        bench.say(f"sheet {n}")
        drawing = composed(project, n).drawing
        drawings.append(Drawing(drawing.width, drawing.height, drawing.title, drawing.marks[:FEW]) if bench.quick else drawing)
    drawings.sort(key=lambda d: len(d.marks))
    for form in ENDINGS:
        settings, name = ({"dpi": DPI}, f"png, {DPI} dots per inch") if form == "png" else ({}, form)
        render = partial(import_module(f"tmm_sheets.backends.{form}").render, **settings)
        for drawing in drawings[::max(len(drawings) - 1, 1)]:
            bench.row(("files", name, "marks"), len(drawing.marks), partial(render, drawing), None,
                      lambda data: f"{len(data) / 1000:.0f} kB")


LEAST = 2.0**-54
"""Stands for an error of zero, which has no place on a log scale: half of the rounding unit."""


def diagrams(records: Sequence[BenchRecord]) -> dict[str, bytes]:
    """An SVG file for each field, by file name; a point for each run, a line for each method."""
    found = {}
    for measured in dict.fromkeys(r.field for r in records):
        name = f"{re.sub(r'[^a-z]+', '-', measured.lower()).strip('-')}.svg"
        found[name] = _svg(measured, [r for r in records if r.field == measured and r.seconds is not None])
    return found


def _svg(field: str, rows: Sequence[BenchRecord]) -> bytes:
    """The diagrams of a field: time over the parameter, and two of the errors where there are any."""
    from matplotlib import colormaps, rc_context
    from matplotlib.figure import Figure

    by_method = {method: [r for r in rows if r.method == method] for method in dict.fromkeys(r.method for r in rows)}
    judged = any(r.error is not None for r in rows)
    figure = Figure(figsize=(15 if judged else 6, 2.6 + 0.2 * len(by_method)), layout="constrained")
    axes = figure.subplots(1, 3 if judged else 1, squeeze=False)[0]
    colours = colormaps["tab10" if len(by_method) <= 10 else "tab20"]
    for k, (method, runs) in enumerate(by_method.items()):
        look: dict[str, Any] = {"marker": "o", "markersize": 3, "linewidth": 1, "color": colours(k)}
        value, seconds = [r.value for r in runs], [float(r.seconds or 0) for r in runs]
        axes[-1].loglog(value, seconds, label=method, **look)
        if judged:
            errors = [max(r.error or 0.0, LEAST) for r in runs]
            axes[0].loglog(value, errors, **look)
            axes[1].loglog(seconds, errors, **look)
    labels = ", ".join(dict.fromkeys(r.parameter for r in rows))
    axes[-1].set(xlabel=labels, ylabel="time, s")
    if judged:
        axes[0].set(xlabel=labels, ylabel="error")
        axes[1].set(xlabel="time, s", ylabel="error")
    for ax in axes:
        ax.grid(which="major", linewidth=0.4, alpha=0.6)
    figure.legend(loc="outside lower center", ncols=3 if judged else 1, fontsize="small", frameon=False)
    figure.suptitle(field)
    buffer = BytesIO()
    with rc_context({"svg.hashsalt": field, "svg.fonttype": "none"}):
        figure.savefig(buffer, format="svg", metadata={"Date": None})
    return buffer.getvalue()
