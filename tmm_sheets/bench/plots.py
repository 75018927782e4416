"""Log-log diagrams of a work-precision table: error and time over the parameter, error over time."""

from __future__ import annotations

import re
from collections.abc import Sequence
from io import BytesIO
from typing import Any

from tmm_sheets.bench.records import Record


def diagrams(records: Sequence[Record]) -> dict[str, bytes]:
    """An SVG file for each field, by file name; a point for each run, a line for each method."""
    from matplotlib import colormaps, rc_context
    from matplotlib.figure import Figure

    found = {}
    for field in dict.fromkeys(r.field for r in records):
        rows = [r for r in records if r.field == field and r.seconds is not None]
        methods = list(dict.fromkeys(r.method for r in rows))
        judged = any(r.error is not None for r in rows)
        figure = Figure(figsize=(15 if judged else 6, 2.6 + 0.2 * len(methods)), layout="constrained")
        axes = figure.subplots(1, 3 if judged else 1, squeeze=False)[0]
        colours = colormaps["tab10" if len(methods) <= 10 else "tab20"]
        for k, method in enumerate(methods):
            drawn: dict[str, Any] = {"marker": "o", "markersize": 3, "linewidth": 1, "color": colours(k)}
            mine = [r for r in rows if r.method == method]
            # A log scale has no place for an error of nothing: half of the rounding unit stands for it.
            errors = [max(r.error or 0.0, 2.0**-54) for r in mine]
            value, seconds = [r.value for r in mine], [float(r.seconds or 0) for r in mine]
            axes[-1].loglog(value, seconds, label=method, **drawn)
            if judged:
                axes[0].loglog(value, errors, **drawn)
                axes[1].loglog(seconds, errors, **drawn)
        labels = list(dict.fromkeys(r.parameter for r in rows))
        axes[-1].set(xlabel=", ".join(labels), ylabel="time, s")
        if judged:
            axes[0].set(xlabel=", ".join(labels), ylabel="error")
            axes[1].set(xlabel="time, s", ylabel="error")
        for ax in axes:
            ax.grid(which="major", linewidth=0.4, alpha=0.6)
        figure.legend(loc="outside lower center", ncols=3 if judged else 1, fontsize="small", frameon=False)
        figure.suptitle(field)
        buffer = BytesIO()
        with rc_context({"svg.hashsalt": field, "svg.fonttype": "none"}):
            figure.savefig(buffer, format="svg", metadata={"Date": None})
        found[f"{re.sub(r'[^a-z]+', '-', field.lower()).strip('-')}.svg"] = buffer.getvalue()
    return found
