"""The search as a picture: what was tried over each number, and how the wish came down, SVG."""

from __future__ import annotations

from io import BytesIO
from math import isfinite

from tmm_sheets.optimising.optimum import Optimum, Trial
from tmm_sheets.words import tell


def svg(of: Optimum) -> bytes:
    """A diagram for each number that was varied, with the best marked, and one of the tries in their order."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    sign = -1 if of.most else 1
    found = [t for t in of.trials if isfinite(t.value)]
    kept, missed = [t for t in found if not t.missed], [t for t in found if t.missed]
    figure = Figure(figsize=(4.5 * (len(of.varied) + 1), 4), layout="constrained")
    axes = figure.subplots(1, len(of.varied) + 1, sharey=True, squeeze=False)[0]

    def values(some: list[Trial]) -> list[float]:
        return [sign * t.value for t in some]

    for k, v in enumerate(of.varied):
        axes[k].plot([t.numbers[k] for t in missed], values(missed), "x", color="0.7", markersize=4, label=tell("misses a bound"))
        axes[k].plot([t.numbers[k] for t in kept], values(kept), ".", color="tab:blue", label=tell("tried"))
        axes[k].plot(of.best.numbers[k], sign * of.best.value, "o", color="tab:red", fillstyle="none", markersize=9,
                     label=tell("best"))
        axes[k].set(xlabel=", ".join(filter(None, (v.name, v.unit))), xlim=(v.low, v.high))
    best, so_far = [], of.trials[0]
    for t in of.trials:
        so_far = min(so_far, t, key=lambda one: one.key)
        best.append(sign * so_far.value if isfinite(so_far.value) and not so_far.missed else float("nan"))
    axes[-1].step(range(1, len(best) + 1), best, where="post", color="tab:red")
    axes[-1].set(xlabel=tell("tries"))
    axes[0].set(ylabel=of.wish.text)
    if kept:  # far outliers among the others leave nothing to be seen
        low, high = min(values(kept)), max(values(kept))
        axes[0].set_ylim(low - 0.05 * (high - low or 1), high + 0.05 * (high - low or 1))
    for ax in axes:
        ax.grid(linewidth=0.4, alpha=0.6)
    axes[0].legend(fontsize="small")
    buffer = BytesIO()
    with rc_context({"svg.hashsalt": of.wish.text, "svg.fonttype": "none"}):
        figure.savefig(buffer, format="svg", metadata={"Date": None})
    return buffer.getvalue()
