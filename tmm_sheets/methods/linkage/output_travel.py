"""How far an output is on its way, and how fast: along a line, or of a point that swings about a fixed hinge along its arc."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.model import Mechanism
from tmm_sheets.methods.linkage.strokes import SWEEP, TURN, Floats
from tmm_sheets.methods.linkage.watched import Watched
from tmm_sheets.words import marked, tell

BY_ANGLE = marked('give the crank angle of position 0 instead: start = "90 deg"')
SAME_PLACE = 1e-9
"""Share of the crank's length within which distances are the same."""


@dataclass(frozen=True)
class Way:
    """The way of an output in its working sense, m, and its speed, m/s: functions of the angles turned, rad, shape (n,)."""

    travelled: Callable[[Floats], Any]
    speed: Callable[[Floats], Any]


def way_of(m: Mechanism, watched: Watched, output: str, axis: complex, round_about: bool = False) -> Way:
    """The way of a point, positive where it goes along the unit vector ``axis``, of a swing where its chord does.

    One that goes ``round_about`` a fixed hinge has no dead positions, but where these are not asked for it goes to and fro
    along the axis.

    Raises
    ------
    CannotBuild
        when the point goes round a fixed hinge and may not, or does not move that way.
    """
    sense, point, velocity = m.crank.sense, watched.point(output), watched.velocity(output)
    path = np.asarray(point(sense * np.linspace(0.0, TURN, SWEEP + 1)))
    hinge = None if np.isnan(path).any() else _hinge_of(m, path)
    straight = Way(lambda turned: (point(sense * turned) * np.conj(axis)).real,
                   lambda turned: (velocity(sense * turned) * np.conj(axis)).real)
    if hinge is None:
        return straight
    centre = m.fixed[hinge]
    radius, swept = float(abs(path[0] - centre)), np.unwrap(np.angle(path - centre))
    if round(float(swept[-1] - swept[0]) / TURN):
        if round_about:
            return straight
        raise CannotBuild(tell("point {output} turns all the way round {centre}: it has no dead positions").format(
            output=output, centre=hinge), tell(BY_ANGLE))
    ahead = float((complex(path[np.argmax(swept)] - path[np.argmin(swept)]) * np.conj(axis)).real)
    if not abs(ahead) > SAME_PLACE * m.crank.length:
        raise CannotBuild(tell("point {output} has no working stroke: it does not move that way").format(output=output),
                          tell("give another working_sense"))
    way, middle = float(np.sign(ahead)), (swept.max() + swept.min()) / 2

    def travelled(turned: Floats) -> Any:
        return way * radius * np.angle((point(sense * turned) - centre) * np.exp(-1j * middle))

    def speed(turned: Floats) -> Any:
        return way * (velocity(sense * turned) * np.conj(1j * (point(sense * turned) - centre))).real / radius

    return Way(travelled, speed)


def _hinge_of(m: Mechanism, path: Any) -> str | None:
    """The fixed hinge that a point of this path keeps its distance from; None where there is none."""
    hinges = {pair.name for pair in m.pairs if pair.motion == "rotation" and m.frame in pair.links}
    for name in sorted(hinges & set(m.fixed)):
        apart = np.abs(path - m.fixed[name])
        if apart.min() > 0 and np.ptp(apart) < SAME_PLACE * m.crank.length:
            return name
    return None
