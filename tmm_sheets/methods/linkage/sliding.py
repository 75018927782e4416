"""Sliding pairs: velocity of one link on the other, and the Coriolis acceleration it brings.

Both are taken at the pair's own point, for link j on link k: the slider block on its rocker, the slider on what carries its guide.
Source: manual 000, sections 3.3 and 3.4.
"""

from __future__ import annotations

from tmm_sheets.construction.indices import on_link, pair_index
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Rule, Step
from tmm_sheets.mechanism.model import Mechanism, Pair
from tmm_sheets.methods.linkage.velocities import Velocities
from tmm_sheets.words import marked, tr

RELATIVE = Rule("sliding velocity", lambda a, b: a - b, ("point", "point"), "vector",
                marked("Velocity of sliding {name} = {value}, the vector {1}{0} of the velocity polygon."), unit="m/s")
CORIOLIS = Rule("Coriolis acceleration of sliding", lambda w, v: 2j * w * v, ("number", "vector"), "vector",
                marked("Coriolis acceleration {name} = 2ω·V = {value}: the sliding velocity turned by 90° in the sense of ω."),
                unit="m/s2")


class Sliding:
    """Velocities of sliding, m/s, and Coriolis accelerations, m/s2, by the links of the pair: "23" is link 2 on link 3."""

    def __init__(self, vel: Velocities) -> None:
        pos = vel.positions
        self.plan = Plan(f"sliding{pos.where}", tr("Sliding velocities and Coriolis accelerations"), "m/s", pos.plan.labels,
                         search=pos.plan.search)
        self.velocities: dict[str, Step] = {}
        self.coriolis: dict[str, Step] = {}
        for pair in pos.mechanism.pairs:
            if pair.motion == "translation":
                self._of(vel, pair)

    def _of(self, vel: Velocities, pair: Pair) -> None:
        j, k = ordered(vel.positions.mechanism, pair)
        at, index = pair.name.rstrip("′″"), pair_index(j, k)
        v = self.plan.add(f"V{index}", RELATIVE, motion_at(vel, j, at), motion_at(vel, k, at), symbol=f"V_{{{index}}}")
        self.velocities[index] = v
        letters = tr("a_{{{points}}}^c").format(points=index)
        self.coriolis[index] = self.plan.add(f"a{index}к", CORIOLIS, vel.omega[k], v, symbol=letters)


def ordered(m: Mechanism, pair: Pair) -> tuple[str, str]:
    """The link of a sliding pair that slides and the one it slides on: what was there before, or the rocker of a slider block."""
    a, b = pair.links
    placed = [m.frame, m.crank.link]
    for g in m.groups:
        if a in placed and b in g.links:
            return b, a
        placed += g.links
    return a, b


def motion_at(vel: Velocities, link: str, at: str) -> Step:
    """Velocity of the point of a link that coincides with a point of the mechanism."""
    if link == vel.positions.mechanism.frame:
        return vel.pole
    return vel.coincident.get(on_link(at, link), vel.points[at])
