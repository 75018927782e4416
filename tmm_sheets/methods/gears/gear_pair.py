"""Synthesis of a gear pair (manual 000, section 6): numbers, constructions and curves behind sheet 3, built when asked for."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.scale import Scale, fit_standard
from tmm_sheets.construction.step import Reported
from tmm_sheets.methods.gears import gear_engagement as ge
from tmm_sheets.methods.gears import gear_teeth as gt
from tmm_sheets.methods.gears import rack
from tmm_sheets.methods.gears.gear_formulas import GearData, given, rack_sizes
from tmm_sheets.methods.gears.gear_geometry import GearWheel, PairGeometry, warnings_of
from tmm_sheets.words import tr

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

    @cached_property
    def engagement(self) -> Plan:
        """Centres, circles, line of action, A and B, overlap angles."""
        return ge.engagement_plan(self)

    @cached_property
    def sliding(self) -> Plan:
        """Speeds and specific sliding at the manual's divisions: 3 parts of P_wN1, 4 of P_wN2."""
        return ge.sliding_plan(self, self.engagement)

    @cached_property
    def _teeth(self) -> tuple[Plan, Plan]:
        one, two = (ge.tooth_plan(self, w, self.engagement) for w in self.wheels)
        record = gt.record_cut if self.profile == "rack" else gt.record_flank
        for wheel, plan in zip(self.wheels, (one, two), strict=True):
            record(wheel, ge.side_of(self, wheel), self.engagement, plan)
        return one, two

    @cached_property
    def _shapes(self) -> tuple[gt.ToothShape, gt.ToothShape]:
        one, two = (gt.tooth_shape(w, ge.side_of(self, w), self.engagement, plan, plan["flank"])
                    for w, plan in zip(self.wheels, self._teeth, strict=True))
        return one, two

    def generated(self, wheel: GearWheel) -> gt.ToothShape:
        """Tooth of one wheel as the rack cuts it, in contact at the pole, whatever the pair's own profile."""
        tooth = self.tooth(wheel)
        return gt.tooth_shape(wheel, self.hand, self.engagement, tooth, gt.record_cut(wheel, self.hand, self.engagement, tooth))

    @property
    def pinion(self) -> GearWheel:
        """The wheel with fewer teeth, the first of two alike: the one whose cutting is shown."""
        return min(self.wheels, key=lambda w: w.teeth)

    @cached_property
    def generating(self) -> Plan:
        """Positions of the rack that cuts the pinion, from the tip of a flank to where it leaves the involute."""
        w = self.pinion
        return rack.drawn_positions(self.rack_sizes, w.step("r"), self.step("alpha"), POSITIONS - 1)

    @cached_property
    def rack_sizes(self) -> Plan:
        """Sizes of the rack that cuts the pinion, and how far it rolls."""
        return rack_sizes(self.geometry, self.pinion.number)

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

    def shape(self, wheel: GearWheel) -> gt.ToothShape:
        """Tooth of one wheel as a curve, in contact at the pole."""
        return self._shapes[wheel.number - 1]

    def working_strip(self, wheel: GearWheel, width: float) -> npt.NDArray[np.complex128]:
        """Closed strip along the working part of the flank through the pole, ``width`` m deep."""
        return gt.strip(wheel, self.engagement, width)

    @property
    def height(self) -> float:
        """What the scale of the picture goes by: the centre distance, the root radius of a ring, m."""
        return self.wheels[1].rf if self.internal else self.a_w

    def picture_scale(self, room: float = ROOM) -> Scale:
        """Scale factor of the largest GOST 2.302 scale with which the height of the picture takes at most ``room`` mm of paper."""
        return standard("μ_l", self.height * 1e3, room)

    def parts(self, wheel: GearWheel, scale: Scale | None = None) -> int:
        """Number of equal parts of P_wN when drawn with this scale factor (that of the picture by default)."""
        return ge.parts_of_pole_segment((scale or self.picture_scale()).mm(wheel.t_pole))

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
        """The same construction with many divisions, from the base circle to ``reach`` times the tip's tangent: steps ``E``."""
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
        return ge.sliding_between(self, self.engagement, share)

    @cached_property
    def smooth_sliding(self) -> Plan:
        """Speeds and sliding along the line, close enough for a smooth curve."""
        return self.sliding_curve(np.concatenate([np.linspace(-1, 0, 241)[:-1], np.linspace(0, 1, 241)]))

    @cached_property
    def worst_sliding(self) -> Plan:
        """Sliding of each wheel where it is worst, at the foot of its working flank: steps ``theta1``, ``theta2``."""
        return ge.greatest_sliding(self, self.engagement)

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


@dataclass(frozen=True)
class MeshingPair:
    """A gear pair as it is to be built: :class:`GearData` with every number settled, or the steps it comes from."""

    teeth: Any
    module: Any
    shift: Any
    pressure_angle: float
    addendum: Any
    clearance: float
    driver: int
    sense: str
    profile: str
    mesh: str = "external"
    centre_distance: Any = None


def settled(section: Any, reducer: Any = None) -> MeshingPair:
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
    return MeshingPair(teeth, module, shift, section.pressure_angle, addendum, clearance, section.driver, section.sense,
                       section.profile, section.mesh, section.centre_distance)


def gear_pair(data: GearData) -> GearPair:
    """Gear pair of a project; raises :class:`tmm_sheets.errors.CannotBuild` with everything that forbids it."""
    return GearPair(data)
