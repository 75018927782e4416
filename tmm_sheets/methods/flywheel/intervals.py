"""The cycle of a flywheel divided into intervals: by the positions, the jumps of the moment, and where it bends much."""

from __future__ import annotations

from functools import cached_property
from itertools import count, pairwise
from typing import Any

import numpy as np

from tmm_sheets.methods.flywheel.energy_mass import AtAngles
from tmm_sheets.methods.flywheel.reduced_data import ReducedData
from tmm_sheets.methods.integration import Floats
from tmm_sheets.methods.linkage.cycle import closed
from tmm_sheets.numbers import is_zero

BENT = 0.05
"""An interval is halved when its ordinate in the middle tells its work wrongly by more, share of the range of the work."""


def lettered(n: int) -> str:
    """Letters of the n-th point between two numbers: none, a, b ... z, aa, ab ..."""
    text = ""
    while n > 0:
        n, last = divmod(n - 1, 26)
        text = chr(ord("a") + last) + text
    return text


def _fresh(number: str, taken: set[str]) -> str:
    """The number with the first letters with which it is not taken; it is from now on."""
    found = next(name for n in count() if (name := number + lettered(n)) not in taken)
    taken.add(found)
    return found


class Intervals:
    """Division of the angle axis, and the reduced quantities at its borders, in the middles and close together between them."""

    reduced: ReducedData
    where: str
    """Behind the names of the plans, where a project has two flywheels."""

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """Numbers of the positions with the one that closes the cycle."""
        return closed(self.reduced.labels)

    @cached_property
    def edges(self) -> Floats:
        """Borders of the intervals: the positions, the jumps and kinks of the moment, and where it bends much, rad."""
        inside = [b for b in self.reduced.breaks if 0 < b < self.reduced.period]
        edges = np.unique(np.concatenate((self.reduced.phi, inside)))
        # A break that falls on a position up to rounding is that position.
        keep = np.concatenate(([True], np.diff(edges) > 1e-9 * self.reduced.period))
        edges = edges[keep]
        while len(bent := self._bent(edges)):
            edges = np.sort(np.concatenate((edges, bent)))
        return np.asarray(edges)

    def _bent(self, edges: Floats) -> Floats:
        """Middles of the intervals whose ordinate there tells the work wrongly by more than BENT, by Simpson's rule."""
        middles, moment = (edges[:-1] + edges[1:]) / 2, self.reduced.moment
        y, sides = moment(middles), moment(edges, 1)[:-1] + moment(edges, -1)[1:]
        span = float(np.ptp(np.append(0.0, np.cumsum(np.diff(edges) * y))))
        if is_zero(span, self._kinetic):  # forces across the motion: what is left of their moment is rounding
            return middles[:0]
        return np.asarray(middles[np.diff(edges) * np.abs(2 * y - sides) / 6 > BENT * span])

    @property
    def _kinetic(self) -> float:
        """The greatest kinetic energy of the moving links at the positions, J: what work is measured by where it is little."""
        return float(np.max(self.reduced.numbered.inertia.value)) * self.reduced.omega1**2 / 2

    @cached_property
    def at_positions(self) -> tuple[int, ...]:
        """Index of each position among the edges."""
        return tuple(int(np.argmin(np.abs(self.edges - p))) for p in self.reduced.phi)

    @cached_property
    def _numbered(self) -> dict[int, str]:
        """Index among the edges and number of each position that counts; 1′ is a further one between 0 and 1.

        A name that begins with a letter stands in brackets: P, m1, c2 are points of the construction.
        """
        return {k: name if name[0].isdigit() else f"({name})" for k, name in zip(self.at_positions, self.labels, strict=True)
                if not name.endswith(("′", "″"))}

    @cached_property
    def borders(self) -> tuple[str, ...]:
        """Names of the edges: numbers of the positions, letters after the last number for what lies between them."""
        last, result, taken = "", [], set(self._numbered.values())
        for k in range(len(self.edges)):
            last = self._numbered.get(k, last)
            result.append(last if k in self._numbered else _fresh(last, taken))
        if result[0] == result[-1]:
            result[0] = _fresh("0", taken)  # position 12 is the first and the last point of the graph
        return tuple(result)

    @cached_property
    def intervals(self) -> tuple[str, ...]:
        """Names of the intervals: the number of the position that ends them; the shorter parts get letters."""
        result, taken = [""] * (len(self.edges) - 1), set(self._numbered.values())
        widths = np.diff(self.edges)
        for (start, _), (end, name) in pairwise(self._numbered.items()):
            first, *others = sorted(range(start, end), key=lambda k: -round(float(widths[k]), 9))
            result[first] = name
            for k in others:
                result[k] = _fresh(name, taken)
        return tuple(result)

    @property
    def mark(self) -> str:
        """Mark of the points carried to the ordinate axis: ″ where there are positions named 1′."""
        return "″" if len(self._numbered) < len(self.labels) else "′"

    def at(self, where: str, phi: Any, labels: tuple[str, ...] | None = None) -> AtAngles:
        """Reduced quantities at angles of this flywheel only."""
        return self.reduced.at(f"{where}{self.where}", phi, labels)

    @cached_property
    def at_borders(self) -> AtAngles:
        """Reduced quantities at the borders of the intervals."""
        return self.reduced.at("borders", self.edges, self.borders)

    @cached_property
    def at_samples(self) -> AtAngles:
        """Reduced quantities at the :attr:`samples`."""
        return self.reduced.at("samples", self.samples)

    @cached_property
    def at_middles(self) -> AtAngles:
        """Reduced quantities in the middles of the intervals."""
        return self.reduced.at("middles", (self.edges[:-1] + self.edges[1:]) / 2, self.intervals)

    @cached_property
    def samples(self) -> Floats:
        """Angles for drawing curves and for finding contacts: close together, the edges among them, rad."""
        return np.unique(np.concatenate((np.linspace(0, self.reduced.period, 721), self.edges)))
