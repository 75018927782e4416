"""Outlines of teeth from the recorded steps of one tooth: flanks, fillets, tip and root arcs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction.expression import primitive
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Rule, Step
from tmm_sheets.methods.gears import rack
from tmm_sheets.methods.gears.gear_engagement import on_normal, unrolled
from tmm_sheets.methods.gears.gear_geometry import GearWheel
from tmm_sheets.words import marked

Points = npt.NDArray[np.complex128]


@dataclass(frozen=True)
class ToothShape:
    """One tooth of a wheel with its working flank through the pole, the value of ``step``; see :func:`tooth_shape`."""

    centre: complex
    axis: complex
    side: int
    pitch: float
    root: float
    tip: float
    flank: Points
    step: Step

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


@primitive("flank of a tooth")
def _flank(o: Any, foot: Any, pole: Any, centre: Any, begin: Any, end: Any, low: Any, tip: Any) -> Points:
    """Flank from the root circle: a fillet about a centre, then the involute through ``pole``, between two unrolled lengths."""
    # Even steps of t**2 are even steps of the angle along the involute's arc length.
    involute = unrolled(o, foot, pole, np.sqrt(np.linspace(low**2, tip**2, INVOLUTE)))
    fillet = _arc_between(centre, begin, end, INVOLUTE // 3)
    # Its end is the first point of the involute; a radial piece keeps both ends.
    return np.concatenate([fillet[:-1] if low > 0 else fillet, involute])


@primitive("flank cut by a rack")
def _cut(centre: Any, axis: Any, side: Any, m: Any, alpha: Any, addendum: Any, clearance: Any, teeth: Any, shift: Any,
         tip: Any) -> Points:
    """Flank from the root circle to the tip as a rack cuts it, of the tooth about an axis, on the ``side`` of its rolling."""
    found = rack.flank(rack.Rack(m, alpha, addendum, clearance, int(teeth), shift), tip, INVOLUTE)
    return np.asarray(centre + axis * (np.conj(found) if side < 0 else found))


INVOLUTE = 32
"""Points on the involute of a flank."""
FLANK = Rule("flank of a tooth", _flank, (*("point",) * 6, "length", "length"), "curve",
             marked("Trace the tooth profile: the fillet and the involute up to the tip circle."), exact=True)
CUT = Rule("flank cut by a rack", _cut, ("point", "direction", "number", "length", "angle", *("number",) * 4, "length"), "curve",
           marked("Trace the tooth profile as the envelope of the positions of the rack."), exact=True)


def record_flank(wheel: GearWheel, side: int, engagement: Plan, tooth: Plan) -> Step:
    """Step ``flank`` of the tooth recorded in ``tooth``: its working flank from the root circle to the tip."""
    i = wheel.number
    low: Any = tooth.steps.get("t", 0.0)
    tip = tooth.add("t_a", rack.TAKEN, wheel.step("rho_a"))
    return tooth.add("flank", FLANK, engagement[f"O{i}"], engagement[f"N{i}"], engagement["Pw"], tooth["C"], tooth["R"], tooth["Q"],
                     low, tip)


def record_cut(wheel: GearWheel, side: int, engagement: Plan, tooth: Plan) -> Step:
    """The same as the rack cuts it, of the tooth about the axis recorded in ``tooth``."""
    of = wheel.of_pair
    if "flank" in tooth and tooth["flank"].rule is CUT:
        return tooth["flank"]
    # Beside a tooth with a fillet it is the picture of the cutting alone.
    add, name = (tooth.auxiliary, "cut") if "flank" in tooth else (tooth.add, "flank")
    m, tip = (add(name, rack.TAKEN, step) for name, step in (("m", of("m")), ("r_a", wheel.step("ra"))))
    return add(name, CUT, engagement[f"O{wheel.number}"], tooth["axis"], float(side), m,
               of("alpha"), wheel.depth, of("c"), wheel.step("z"), wheel.step("x"), tip)


def tooth_shape(wheel: GearWheel, side: int, engagement: Plan, tooth: Plan, flank: Step) -> ToothShape:
    """Shape of the tooth recorded in ``tooth`` with the flank of that step."""
    return ToothShape(centre=complex(engagement[f"O{wheel.number}"].value), axis=complex(tooth["axis"].value), side=side,
                      pitch=wheel.tau, root=wheel.rf, tip=wheel.ra, flank=flank.value, step=flank)


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
    inner = on_normal(centre, foot, pole, edge, lengths, width if wheel.ring else -width)
    return np.concatenate([edge, inner[::-1]])
