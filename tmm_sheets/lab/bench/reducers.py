"""The search for tooth numbers of a reducer, against exhaustive search in whole numbers."""

from __future__ import annotations

from fractions import Fraction
from functools import partial
from itertools import product
from math import pi, sin
from typing import Any

from tmm_sheets import catalogue
from tmm_sheets.lab.bench.records import Bench
from tmm_sheets.methods.gears.tooth_search import TIERS, ToothSet, search

LIMITS = (30, 40, 60, 90, 120)
TRIED = 60
"""Largest tooth number of the exhaustive search."""


def _data(most: int) -> Any:
    """A single-row planetary stage after a simple pair, 1250 to 300 rpm, with at most so many teeth a wheel."""
    found = catalogue.read("transport/diesel@01-T-27").reducer
    assert found is not None
    speeds = {"input_speed": 1250 * pi / 30, "output_speed": 300 * pi / 30}
    return found.model_copy(update={"most_teeth": most, "simple_ratio": (1.0, 4.0), **speeds})


def _best(most: int) -> tuple[int, Fraction]:
    """Tier of the deviation and height in metres of the best permitted set, by loops over exact fractions."""
    d = _data(most)
    asked, pinion = Fraction(1250, 300), d.teeth["z1"]
    module, simple_module = (Fraction(str(m)) for m in (d.module, d.simple_module))
    bounds = [*(Fraction(str(t)) for t in TIERS), Fraction(str(d.tolerance))]
    best: tuple[int, Fraction] | None = None
    for sun, satellite in product(range(d.least_teeth, most + 1), repeat=2):
        ring = sun + 2 * satellite
        if (sun + ring) % d.satellites or (sun + satellite) * sin(pi / d.satellites) <= satellite + 2 * d.addendum:
            continue
        for wheel in range(pinion, min(4 * pinion, most) + 1):
            off = abs((1 + Fraction(ring, sun)) * Fraction(wheel, pinion) / asked - 1)
            if off > bounds[-1]:
                continue
            tier = next(k for k, bound in enumerate(bounds) if off <= bound)
            stage, one, two = ring * module / 2, pinion * simple_module / 2, wheel * simple_module / 2
            found = tier, max(stage, two) + max(stage, two + 2 * one)
            best = found if best is None else min(best, found)
    if best is None:
        raise ValueError("no permitted set")
    return best


def _search(most: int) -> list[ToothSet]:
    return search(_data(most))


def rows(bench: Bench) -> None:
    """The height of the chosen set against the least of its tier of deviation.

    Raises
    ------
    ValueError
        when no set is permitted.
    """
    for most in bench.upto(LIMITS, 40):
        goal = _best(min(most, TRIED))

        def error(found: list[ToothSet], goal: tuple[int, Fraction] = goal) -> float:
            tier = sum(abs(found[0].deviation) > bound * (1 + 1e-12) for bound in TIERS)
            return abs(found[0].height - float(goal[1])) / float(goal[1]) if tier == goal[0] else 1.0

        note = "" if most <= TRIED else f"compared with the best of {TRIED} teeth: larger wheels make a larger reducer"
        bench.row(("reducer", "search of tooth numbers", "teeth at most"), most, partial(_search, most), error, note)
