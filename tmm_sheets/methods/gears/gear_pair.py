"""Synthesis of a gear pair (manual 000, section 6): numbers, constructions and curves behind sheet 3, built when asked for."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction.expression import primitive
from tmm_sheets.construction.scale import Scale, fit_standard
from tmm_sheets.construction.step import Plan, Reported, Rule, Step, planned, record
from tmm_sheets.methods.gears import gear_engagement as ge, rack
from tmm_sheets.methods.gears.gear_engagement import on_normal, unrolled
from tmm_sheets.methods.gears.gear_formulas import RACK_SIZES, GearData, given
from tmm_sheets.methods.gears.gear_geometry import GearWheel, PairGeometry, warnings_of
from tmm_sheets.words import marked, tr

POSITIONS = 13
"""Positions of the rack that are drawn along one flank."""
ROOM = 360.0
"""Millimetres of paper for the centre distance when the sheet says nothing else: two thirds of its usual place."""


def standard(symbol: str, span: float, room: float) -> Scale:
    """Scale factor (m of the object per mm of paper) of the largest GOST 2.302 scale that fits ``span`` mm in ``room`` mm."""
    real, drawn = fit_standard(span, room)
    return Scale(symbol, real / drawn * 1e-3, tr("m/mm"))


class GearPair(PairGeometry):
    """A spur gear pair: GOST 16532 values, and plans as lazy properties.

    Plans: ``gear-geometry``, ``gear-engagement``, ``gear-involute-1/2``, ``gear-tooth-1/2``, ``gear-sliding``,
    ``gear-greatest-sliding``, ``gear-rack``; those that end in ``-between`` only smooth the curves.
    """

    @property
    def plans(self) -> dict[str, Plan]:
        """Plans by name in the order of construction; those that only smooth curves, and the rack's, as far as they were drawn."""
        there = vars(self)
        found = [self.geometry, self.engagement, *(self.involute(w) for w in self.wheels if not self._involutes),
                 *self._involutes.values(), *self._smooth.values(), *self._teeth, self.sliding, self.worst_sliding]
        found += [there[name] for name in ("smooth_sliding", "rack_sizes", "generating") if name in there]
        return {plan.name: plan for plan in found}

    engagement = planned("gear-engagement", marked("Gear meshing"), "m")(ge.record_engagement)
    worst_sliding = planned("gear-greatest-sliding", marked("Greatest specific sliding at the dedenda of the teeth"), "m")(
        ge.record_greatest_sliding)

    @cached_property
    def sliding(self) -> Plan:
        """Speeds and specific sliding at the manual's divisions: 3 parts of P_wN1, 4 of P_wN2, from N1 (division 0) on."""
        plan = Plan("gear-sliding", tr("Specific sliding"), "m", tuple(map(str, range(8))))
        return ge.sliding_plan(plan, self, self.engagement, np.array([3.0, 2, 1, 0, 0, 0, 0, 0]) / 3,
                               np.array([0.0, 0, 0, 0, 1, 2, 3, 4]) / 4)

    @cached_property
    def _teeth(self) -> tuple[Plan, Plan]:
        one, two = (ge.tooth_plan(self, w, self.engagement) for w in self.wheels)
        record_profile = record_cut if self.profile == "rack" else record_flank
        for wheel, plan in zip(self.wheels, (one, two), strict=True):
            record_profile(wheel, ge.side_of(self, wheel), self.engagement, plan)
        return one, two

    @cached_property
    def _shapes(self) -> tuple[ToothShape, ToothShape]:
        one, two = (tooth_shape(w, ge.side_of(self, w), self.engagement, plan, plan["flank"])
                    for w, plan in zip(self.wheels, self._teeth, strict=True))
        return one, two

    def generated(self, wheel: GearWheel) -> ToothShape:
        """Tooth of one wheel as the rack cuts it, in contact at the pole, whatever the pair's own profile."""
        tooth = self.tooth(wheel)
        return tooth_shape(wheel, self.hand, self.engagement, tooth, record_cut(wheel, self.hand, self.engagement, tooth))

    @property
    def pinion(self) -> GearWheel:
        """The wheel with fewer teeth, the first of two alike: the one whose cutting is shown."""
        return min(self.wheels, key=lambda w: w.teeth)

    @cached_property
    def generating(self) -> Plan:
        """Positions of the rack that cuts the pinion, from the tip of a flank to where it leaves the involute."""
        return rack.drawn_positions(self.rack_sizes, self.pinion.step("r"), self.step("alpha"), POSITIONS - 1)

    @planned("gear-rack-sizes", marked("Sizes of the generating rack"), "mm")
    def rack_sizes(self, plan: Plan) -> None:
        """Sizes of the rack that cuts the pinion, and the angles of rolling of the first and last position that touch its flank."""
        record(plan, " ".join(RACK_SIZES), RACK_SIZES, wheel=str(self.pinion.number), given=self.geometry.steps)

    @property
    def hand(self) -> int:
        """Which way the line of action falls from N1 through the pole: +1 to the right, -1 to the left."""
        return ge.hand(self)

    @property
    def beyond_pole(self) -> float:
        """From the pole to where the graphs of sliding end, m."""
        one, two = self.wheels
        return one.t_tip - one.t_pole if self.internal else two.t_pole

    def tooth(self, wheel: GearWheel) -> Plan:
        """Tooth, axis and fillet of one wheel."""
        return self._teeth[wheel.number - 1]

    def shape(self, wheel: GearWheel) -> ToothShape:
        """Tooth of one wheel as a curve, in contact at the pole."""
        return self._shapes[wheel.number - 1]

    def working_strip(self, wheel: GearWheel, width: float) -> npt.NDArray[np.complex128]:
        """Closed strip along the working part of the flank through the pole, ``width`` m deep."""
        return strip(wheel, self.engagement, width)

    @property
    def height(self) -> float:
        """What the scale of the picture goes by: the centre distance, the root radius of a ring, m."""
        return self.wheels[1].rf if self.internal else self.a_w

    def picture_scale(self, room: float = ROOM) -> Scale:
        """Scale factor of the largest GOST 2.302 scale with which the height of the picture takes at most ``room`` mm of paper."""
        return standard("μ_l", self.height * 1e3, room)

    def parts(self, wheel: GearWheel, scale: Scale | None = None) -> int:
        """Number of equal parts of P_wN when drawn with this scale factor (that of the picture by default)."""
        drawn: float = (scale or self.picture_scale()).mm(wheel.t_pole)
        return max(2, round(drawn / 20))  # 15..25 mm each, never fewer than two

    def divisions(self, wheel: GearWheel, scale: Scale | None = None) -> range:
        """Numbers of the divisions of :meth:`involute`, from 0 at the pole to the last beyond N."""
        return ge.divisions(wheel, self.parts(wheel, scale))

    def involute(self, wheel: GearWheel, scale: Scale | None = None) -> Plan:
        """Involute by unrolling with the divisions that are drawn with this scale factor; built once for each number of parts."""
        parts = self.parts(wheel, scale)
        key = wheel.number, parts
        if key not in self._involutes:
            self._involutes[key] = ge.involute_plan(wheel, self.engagement, parts)
        return self._involutes[key]

    @cached_property
    def _involutes(self) -> dict[tuple[int, int], Plan]:
        return {}

    @cached_property
    def _smooth(self) -> dict[tuple[int, float], Plan]:
        return {}

    def smooth_involute(self, wheel: GearWheel, points: int = 40, reach: float = 1.0) -> Plan:
        """The involute with many divisions, from the base circle to ``reach`` times the tip's tangent: steps ``Ek``."""
        key = wheel.number, reach
        if key not in self._smooth:
            numbers = np.sqrt(np.linspace(0, (wheel.t_tip / wheel.t_pole * reach) ** 2, points))
            self._smooth[key] = ge.smooth_involute(wheel, self.engagement, numbers)
        return self._smooth[key]

    def rolled(self, wheel: GearWheel, points: Any, travel: float) -> Any:
        """Points of a wheel when the contact has moved by ``travel`` m along the line of action from N1 through the pole."""
        centre, foot = (self.engagement[f"{name}{wheel.number}"].value for name in "ON")
        shift = travel * self.engagement["N1N2"].value
        return centre + (points - centre) * ge.turn_of(centre, foot, shift)

    def sliding_curve(self, share: Any) -> Plan:
        """Speeds and sliding at any points of the line: -1 at N1, 0 at the pole, 1 at the last point."""
        share = np.asarray(share, dtype=float)
        plan = Plan("gear-sliding-between", tr("Specific sliding between the divisions"), "m", tuple([f"{v:g}" for v in share]))
        return ge.sliding_plan(plan, self, self.engagement, np.maximum(-share, 0), np.maximum(share, 0))

    @cached_property
    def smooth_sliding(self) -> Plan:
        """Speeds and sliding along the line, close enough for a smooth curve."""
        return self.sliding_curve(np.concatenate([np.linspace(-1, 0, 241)[:-1], np.linspace(0, 1, 241)]))

    @property
    def greatest_sliding(self) -> tuple[float, float]:
        """Specific sliding of each wheel at the foot of its working flank."""
        return float(self.worst_sliding["theta1"].value), float(self.worst_sliding["theta2"].value)

    def results(self) -> dict[str, Any]:
        """The ``gear`` section of ``solve --json``; ``theta1``, ``theta2`` at the divisions, undefined where infinite."""
        out = super().results()
        for i in (1, 2):
            out[f"theta{i}"] = Reported(self.sliding[f"theta{i}"])
            out[f"theta{i}_greatest"] = Reported(self.worst_sliding[f"theta{i}"])
        return out

    @property
    def warnings(self) -> tuple[str, ...]:
        """Remarks for the sheet (Russian)."""
        return warnings_of(self)


def settled(section: Any, reducer: Any = None) -> GearData:
    """Data of a ``[gear]`` section whose teeth may come from the reducer's simple stage; ``shift`` may be "rule"."""
    if section.teeth == "reducer":
        teeth, module, addendum, clearance = reducer.simple_pair
    else:
        teeth, module = section.teeth, section.module
        addendum = given(1.0, "gear.addendum", source=tr("GOST 13755-81")) if section.addendum is None else section.addendum
        addendum = section.addenda or addendum
        clearance = given(0.25, "gear.clearance", source=tr("GOST 13755-81")) if section.clearance is None else section.clearance
    shift = section.shift
    if section.centre_distance is not None:
        shift = "rule" if section.first_shift is None else (section.first_shift, None)
    return GearData(teeth, module, shift, section.pressure_angle, addendum, clearance, section.driver, section.sense,
                       section.profile, section.mesh, section.centre_distance)


def gear_pair(data: GearData) -> GearPair:
    """Gear pair of a project; raises :class:`tmm_sheets.errors.CannotBuild` with everything that forbids it."""
    return GearPair(data)


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
        angles = np.linspace(begin, end, max(int(np.ceil(abs(end - begin) * radius / step)), 2) + 1)
        return np.asarray(self.centre + radius * self.axis * np.exp(1j * self.side * angles))


@primitive("flank of a tooth")
def _flank(o: Any, foot: Any, pole: Any, centre: Any, begin: Any, end: Any, low: Any, tip: Any) -> Points:
    """Flank from the root circle: a fillet about a centre, then the involute through ``pole``, between two unrolled lengths."""
    # Even steps of t**2 are even steps of the angle along the involute's arc length.
    involute = unrolled(o, foot, pole, np.sqrt(np.linspace(low**2, tip**2, INVOLUTE)))
    start = begin - centre
    fillet = centre + start * np.exp(1j * np.angle((end - centre) / start) * np.linspace(0, 1, INVOLUTE // 3 + 1))
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
    """The flank as the rack cuts it, of the tooth about the axis recorded in ``tooth``."""
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


def strip(wheel: GearWheel, engagement: Plan, width: float, points: int = 24) -> Points:
    """Closed strip inside the working part of the flank, from its lowest contact point to the tip, ``width`` m deep."""
    i = wheel.number
    centre, foot, pole = (engagement[name].value for name in (f"O{i}", f"N{i}", "Pw"))
    lengths = np.sqrt(np.linspace(wheel.t_low**2, wheel.t_tip**2, points))
    edge = unrolled(centre, foot, pole, lengths)
    inner = on_normal(centre, foot, pole, edge, lengths, width if wheel.ring else -width)
    return np.concatenate([edge, inner[::-1]])
