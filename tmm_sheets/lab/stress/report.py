"""A stress run: cases in turn, the worst of each invariant against its bound, as a table."""

from __future__ import annotations

from collections.abc import Callable
from math import inf, isnan

from tmm_sheets import quoting
from tmm_sheets.lab.stress.cases import BOUNDS, CHUNK, Worst, memory, run_case
from tmm_sheets.numbers import of_reader
from tmm_sheets.words import tell

MEMORY = "memory of a million positions, MB"
NUMBERS = (1, 2, 3, 4)
"""Columns of the table that hold numbers."""


def run(cases: int, seed: int, say: Callable[[int], None] = lambda case: None, *, million: bool = True) -> dict[str, Worst]:
    """Run cases 0 .. ``cases``-1 of a seed; ``say`` hears the number of each before it is run.

    Returns the worst of every invariant that some case tells of; ``million`` adds the memory of very many positions.
    """
    worst: dict[str, Worst] = {}
    for case in range(cases):
        say(case)
        scene, values = run_case(seed, case)
        for name, value in values:
            worst.setdefault(name, Worst()).take(value, case, scene)
    if million:
        worst[MEMORY] = Worst(1, memory(), 0, f"chunks of {CHUNK}")
    return _ordered(worst)


def run_one(seed: int, case: int) -> dict[str, Worst]:
    """The same of a single case."""
    scene, values = run_case(seed, case)
    return _ordered({name: Worst(1, value, case, scene) for name, value in values})


def _ordered(worst: dict[str, Worst]) -> dict[str, Worst]:
    return {name: worst[name] for name in BOUNDS if name in worst}


def exceeded(worst: dict[str, Worst]) -> list[str]:
    """Invariants whose bound does not hold; a value that is no number holds nothing."""
    return [name for name, w in worst.items() if not w.value <= BOUNDS[name][0]]


def table(worst: dict[str, Worst], seed: int) -> str:
    """The table: invariant, cases that tell of it, worst value, bound, the case it is from, what the value is a share of."""
    rows = [(tell("invariant"), tell("cases"), tell("worst"), tell("bound"), tell("case"), tell("scene"), tell("share"))]
    for name, w in worst.items():
        bound, share = BOUNDS[name]
        number = "-" if name == MEMORY else str(w.case)
        of = share if w.value <= bound else tell("EXCEEDED: {share}").format(share=share)
        rows.append((name, str(w.cases), of_reader(f"{w.value:.1e}"), f"{bound:.0e}", number, w.scene, of))
    widths = [max(len(row[i]) for row in rows) for i in range(6)]
    lines = []
    for row in rows:
        cells = (f"{cell:{'>' if i in NUMBERS else '<'}{w}}" for i, (cell, w) in enumerate(zip(row, widths, strict=False)))
        lines.append("  ".join([*cells, row[6]]))
    again = quoting.command("stress", "--seed", str(seed), "--case", str(_nearest(worst)))
    return "\n".join([*lines, tell("one case again: {command}").format(command=again)])


def _nearest(worst: dict[str, Worst]) -> int:
    """The case that is nearest to a bound, or farthest beyond it."""
    shares = ((inf if isnan(w.value) else w.value / BOUNDS[name][0], w.case) for name, w in worst.items() if name != MEMORY)
    return max(shares, default=(0.0, 0))[1]
