"""Synthesis of a gear pair (manual 000, section 6): numbers, constructions and curves behind sheet 3, built when asked for."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction.plan import Plan, asked_for
from tmm_sheets.construction.scale import Scale, fit_standard
from tmm_sheets.methods.gears import gear_engagement as ge
from tmm_sheets.methods.gears import gear_teeth as gt
from tmm_sheets.methods.gears import rack
from tmm_sheets.methods.gears.gear_geometry import (
    GearWheel,
    MeshingPair,
    PairGeometry,
    pair_geometry,
    shift_without_undercut,
    warnings_of,
)

POSITIONS = 13
"""Positions of the rack that are drawn along one flank."""
ROOM = 360.0
"""Millimetres of paper for the centre distance when the sheet says nothing else: two thirds of its usual place."""


def standard(symbol: str, span: float, room: float) -> Scale:
    """Scale factor (m of the object per mm of paper) of the largest GOST 2.302 scale that fits ``span`` mm in ``room`` mm."""
    real, drawn = fit_standard(span, room)
    return Scale(symbol, real / drawn * 1e-3, "м/мм")


class GearPair(PairGeometry):
    """An external spur gear pair: GOST 16532 values, and plans as lazy properties.

    Plans: ``gear-engagement``, ``gear-involute-1/2``, ``gear-tooth-1/2``, ``gear-sliding``, ``gear-rack``.
    """

    @property
    def plans(self) -> dict[str, Plan]:
        """The plans that were asked for."""
        return asked_for(vars(self).values())

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
        return one, two

    @cached_property
    def _shapes(self) -> tuple[gt.ToothShape, gt.ToothShape]:
        shape = gt.generated_shape if self.profile == "rack" else gt.tooth_shape
        one, two = (shape(w, self.hand, self.engagement, self.tooth(w)) for w in self.wheels)
        return one, two

    def generated(self, wheel: GearWheel) -> gt.ToothShape:
        """Tooth of one wheel as the rack cuts it, in contact at the pole, whatever the pair's own profile."""
        return gt.generated_shape(wheel, self.hand, self.engagement, self.tooth(wheel))

    @property
    def pinion(self) -> GearWheel:
        """The wheel with fewer teeth, the first of two alike: the one whose cutting is shown."""
        return min(self.wheels, key=lambda w: w.teeth)

    @cached_property
    def generating(self) -> Plan:
        """Positions of the rack that cuts the pinion, from the tip of a flank to where it leaves the involute."""
        w = self.pinion
        return rack.generating_plan(w.rack, np.linspace(*w.rack.rolls(w.ra), POSITIONS))

    @property
    def hand(self) -> int:
        """Which way the line of action falls from N1 to N2: +1 to the right, -1 to the left."""
        return ge.hand(self)

    def tooth(self, wheel: GearWheel) -> Plan:
        """Tooth, axis and fillet of one wheel."""
        return self._teeth[wheel.number - 1]

    def shape(self, wheel: GearWheel) -> gt.ToothShape:
        """Tooth of one wheel as a curve, in contact at the pole."""
        return self._shapes[wheel.number - 1]

    def working_strip(self, wheel: GearWheel, width: float) -> npt.NDArray[np.complex128]:
        """Closed strip along the working part of the flank through the pole, ``width`` m deep."""
        return gt.strip(wheel, self.engagement, width)

    def picture_scale(self, room: float = ROOM) -> Scale:
        """Scale factor of the largest GOST 2.302 scale with which the centre distance takes at most ``room`` mm of paper."""
        return standard("μ_l", self.a_w * 1e3, room)

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

    def smooth_involute(self, wheel: GearWheel, points: int = 40, reach: float = 1.0) -> npt.NDArray[np.complex128]:
        """The same construction with many divisions, from the base circle to ``reach`` times the tip's tangent."""
        numbers = np.sqrt(np.linspace(0, (wheel.t_tip / wheel.t_pole * reach) ** 2, points))
        return np.asarray(ge.smooth_involute(wheel, self.engagement, numbers))

    def rolled(self, wheel: GearWheel, points: Any, travel: float) -> Any:
        """Points of a wheel when the contact has moved by ``travel`` m along the line of action from the pole to N2."""
        centre, foot = (self.engagement[f"{name}{wheel.number}"].value for name in "ON")
        shift = travel * self.engagement["N1N2"].value
        return centre + (points - centre) * ge.turn_of(centre, foot, shift)

    def sliding_curve(self, share: Any) -> Plan:
        """Speeds and sliding at any points of the line: -1 at N1, 0 at the pole, 1 at N2."""
        return ge.sliding_between(self, self.engagement, share)

    @cached_property
    def greatest_sliding(self) -> tuple[float, float]:
        """Specific sliding of each wheel where it is worst: at the foot of its working flank."""
        one, two = self.wheels
        ends = self.sliding_curve([one.t_low / one.t_pole - 1, 1 - two.t_low / two.t_pole])
        return float(ends["theta1"].value[0]), float(ends["theta2"].value[1])

    def results(self) -> dict[str, Any]:
        """The ``gear`` section of ``solve --json``; ``theta1``, ``theta2`` at the divisions, NaN where infinite."""
        out = super().results()
        for i in (1, 2):
            theta = self.sliding[f"theta{i}"].value
            out[f"theta{i}"] = [float(v) if np.isfinite(v) else float("nan") for v in theta]
            out[f"theta{i}_greatest"] = self.greatest_sliding[i - 1]
        return out

    @property
    def warnings(self) -> tuple[str, ...]:
        """Remarks for the sheet (Russian)."""
        return warnings_of(self)


def settled(section: Any, reducer: Any = None) -> MeshingPair:
    """Data of a ``[gear]`` section whose teeth may come from the reducer's simple stage, and its shifts from the rule."""
    if section.teeth == "reducer":
        teeth, module, addendum, clearance = reducer.simple_pair
    else:
        teeth, module = section.teeth, section.module
        addendum = 1.0 if section.addendum is None else section.addendum
        clearance = 0.25 if section.clearance is None else section.clearance
    shift = section.shift
    if shift == "rule":
        shift = tuple(shift_without_undercut(z, addendum, section.pressure_angle) for z in teeth)
    return MeshingPair(teeth, module, shift, section.pressure_angle, addendum, clearance, section.driver, section.sense,
                       section.profile)


def gear_pair(data: MeshingPair) -> GearPair:
    """Gear pair of a project; raises :class:`tmm_sheets.errors.CannotBuild` with everything that forbids it."""
    return pair_geometry(data, GearPair)
