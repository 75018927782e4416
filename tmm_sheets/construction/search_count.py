"""Counts of plans that only search: dead points, assembly, scales, quadrature. They are drawn by nobody and kept by nobody."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class SearchCount:
    """How many plans a search has made, how many of their steps it has evaluated, and in what time, s."""

    purpose: str
    plans: int = 0
    steps: int = 0
    seconds: float = 0.0

    def append(self, seconds: float) -> None:
        """Count a step: a searching step keeps its time here, a drawn one in a list of its own."""
        self.steps += 1
        self.seconds += seconds

    def again(self, steps: int, seconds: float) -> None:
        """Count so many steps done again at other angles."""
        self.steps += steps
        self.seconds += seconds
