"""Log-log diagrams of a work-precision table: error and time over the parameter, error over time."""

from __future__ import annotations

import re
from collections.abc import Sequence
from io import BytesIO
from typing import Any

from tmm_sheets.lab.bench.records import BenchRecord

LEAST = 2.0**-54
"""Stands for an error of zero, which has no place on a log scale: half of the rounding unit."""


def diagrams(records: Sequence[BenchRecord]) -> dict[str, bytes]:
    """An SVG file for each field, by file name; a point for each run, a line for each method."""
    found = {}
    for field in dict.fromkeys(r.field for r in records):
        name = f"{re.sub(r'[^a-z]+', '-', field.lower()).strip('-')}.svg"
        found[name] = _svg(field, [r for r in records if r.field == field and r.seconds is not None])
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
        _draw(axes, method, runs, {"marker": "o", "markersize": 3, "linewidth": 1, "color": colours(k)})
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


def _draw(axes: Any, method: str, runs: Sequence[BenchRecord], look: dict[str, Any]) -> None:
    """One method in each of the diagrams of its field."""
    value, seconds = [r.value for r in runs], [float(r.seconds or 0) for r in runs]
    axes[-1].loglog(value, seconds, label=method, **look)
    if len(axes) > 1:
        errors = [max(r.error or 0.0, LEAST) for r in runs]
        axes[0].loglog(value, errors, **look)
        axes[1].loglog(seconds, errors, **look)
