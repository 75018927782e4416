"""Outlines of teeth from the recorded steps of one tooth: flanks, fillets, tip and root arcs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction.plan import Plan
from tmm_sheets.methods.gears import rack
from tmm_sheets.methods.gears.gear_engagement import on_normal, unrolled
from tmm_sheets.methods.gears.gear_geometry import GearWheel

Points = npt.NDArray[np.complex128]


@dataclass(frozen=True)
class ToothShape:
    """One tooth of a wheel with its working flank through the pole; see :func:`tooth_shape`."""

    centre: complex
    axis: complex
    side: int
    pitch: float
    root: float
    tip: float
    flank: Points

    def other_flank(self) -> Points:
        """The back flank: the working one mirrored in the tooth's axis."""
        return np.asarray(self.centre + self.axis * np.conj((self.flank - self.centre) * np.conj(self.axis)))

    def axis_of(self, k: int) -> complex:
        """Direction of the axis of tooth ``k`` (0 works at the pole, positive ones lie in the direction of the flank)."""
        return complex(self.axis * np.exp(1j * self.side * k * self.pitch))

    def copied(self, points: Any, k: int) -> Any:
        """Points of tooth 0 carried to tooth ``k``."""
        return self.centre + (points - self.centre) * np.exp(1j * self.side * k * self.pitch)

    def outline(self, first: int = -1, last: int = 1, step: float = 1e-4) -> Points:
        """Outline of the teeth ``first`` .. ``last`` from the middle of one space to the middle of another.

        Runs in the sense of ``side``; arcs are cut into chords of at most ``step`` m.
        """
        half = self.pitch / 2
        start, end = (np.angle((p - self.centre) * np.conj(self.axis)) * self.side for p in (self.flank[0], self.flank[-1]))
        parts = []
        for k in range(first, last + 1):
            parts += [
                self._arc(self.root, k * self.pitch - half, k * self.pitch - start, step)[:-1],
                self.copied(self.other_flank(), k),
                self._arc(self.tip, k * self.pitch - end, k * self.pitch + end, step)[1:-1],
                self.copied(self.flank[::-1], k),
                self._arc(self.root, k * self.pitch + start, k * self.pitch + half, step)[1:],
            ]
        return np.concatenate(parts)

    def _arc(self, radius: float, begin: float, end: float, step: float) -> Points:
        n = max(int(np.ceil(abs(end - begin) * radius / step)), 2)
        angles = np.linspace(begin, end, n + 1)
        return np.asarray(self.centre + radius * self.axis * np.exp(1j * self.side * angles))


def tooth_shape(wheel: GearWheel, side: int, engagement: Plan, tooth: Plan, points: int = 32) -> ToothShape:
    """Shape of the tooth recorded in ``tooth``; the flank runs from the root circle to the tip, ``points`` on the involute."""
    i = wheel.number
    centre, foot, pole = (engagement[name].value for name in (f"O{i}", f"N{i}", "Pw"))
    # Even steps of t**2 are even steps of the angle along the involute's arc length.
    lengths = np.sqrt(np.linspace(wheel.t_fillet**2, wheel.t_tip**2, points))
    involute = unrolled(centre, foot, pole, lengths)
    fillet = _arc_between(tooth["C"].value, tooth["R"].value, tooth["Q"].value, max(points // 3, 6))
    if wheel.t_fillet > 0:
        fillet = fillet[:-1]  # its end is the first point of the involute; a radial piece keeps both ends
    return ToothShape(
        centre=complex(centre), axis=complex(tooth["axis"].value), side=side, pitch=wheel.tau, root=wheel.rf, tip=wheel.ra,
        flank=np.concatenate([fillet, involute]),
    )


def generated_shape(wheel: GearWheel, side: int, engagement: Plan, tooth: Plan, points: int = 32) -> ToothShape:
    """Shape of the tooth as the rack cuts it, about the axis recorded in ``tooth``; ``points`` on the involute."""
    centre, axis = complex(engagement[f"O{wheel.number}"].value), complex(tooth["axis"].value)
    flank = rack.flank(wheel.rack, wheel.ra, points)
    if side < 0:
        flank = np.conj(flank)
    return ToothShape(centre=centre, axis=axis, side=side, pitch=wheel.tau, root=wheel.rf, tip=wheel.ra,
                      flank=centre + axis * flank)


def _arc_between(centre: complex, begin: complex, end: complex, n: int) -> Points:
    start = begin - centre
    turn = np.angle((end - centre) / start)
    return np.asarray(centre + start * np.exp(1j * turn * np.linspace(0, 1, n + 1)))


def strip(wheel: GearWheel, engagement: Plan, width: float, points: int = 24) -> Points:
    """Closed strip inside the working part of the flank, from its lowest contact point to the tip, ``width`` m deep."""
    i = wheel.number
    centre, foot, pole = (engagement[name].value for name in (f"O{i}", f"N{i}", "Pw"))
    lengths = np.sqrt(np.linspace(wheel.t_low**2, wheel.t_tip**2, points))
    edge = unrolled(centre, foot, pole, lengths)
    inner = on_normal(centre, foot, pole, edge, lengths, -width)
    return np.concatenate([edge, inner[::-1]])
