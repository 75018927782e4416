"""Diagrams of forces beside the paths of the pistons and sliders they act on (индикаторные диаграммы).

The abscissa is the path itself at the scale of the positions, moved aside; the marks of the path are carried over to it
parallel, and over each mark stands the ordinate of its stroke. Source: manual 000, 3.1 ex. 2.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from tmm_sheets.sheets.frame import pick
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from tmm_sheets.methods.linkage.loads import Applied
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.components.graphs import Floats
    from tmm_sheets.sheets.player import PlayerStage

GAP = 25.0
"""Distance of a diagram's abscissa from the path: room for position numbers, mm."""
HEIGHT, MOST = 40.0, 100.0
"""Greatest ordinate as we choose the scale factor, and by any the project asks for, mm."""
SAMPLES = 361
"""Angles per turn at which the curve is drawn."""


@dataclass(frozen=True)
class Indicator:
    """A diagram beside a path: its force, unit vectors of the path and of the ordinates, and what one unit of ordinate is.

    ``area`` m2 turns the force into a pressure; 1 where the ordinate is the force itself.
    """

    force: Applied
    along: complex
    side: complex
    area: float

    @property
    def text(self) -> str:
        """Sign of the ordinate in lettering markup, with its unit."""
        name = f"{'p' if self.area != 1 else self.force.name[0]}_{{{self.force.name[1:]}}}"
        said = tr("{quantity}, MPa") if self.area != 1 else tr("{quantity}, N")
        return said.format(quantity=name)

    def ordinate(self, turned: ArrayLike, side: int = 0) -> Floats:
        """Pressure, MPa, or force, N, at angles from position 0, rad, in their shape."""
        value = np.asarray(self.force.magnitude(turned, side)) / self.area
        return value * 1e-6 if self.area != 1 else value


def indicators(project: Project) -> list[Indicator]:
    """Diagrams of the forces on sliders of fixed guides that are given as pressures in a cylinder.

    The diagrams of one guide stand on its two sides in turn; a single one stands on the side away from the crank.
    """
    m = project.mechanism
    areas = {f.name: pi * f.bore**2 / 4 for f in project.variant.force if f.bore is not None}
    found: list[Indicator] = []
    taken: list[str] = []
    for force in project.applied:
        group = next((g for g in m.groups if g.inner == force.point and g.guides), None)
        if force.name not in areas or group is None:
            continue
        guide = m.guides[group.guides[-1]]
        if guide.link != m.frame or isinstance(guide.through, str):
            continue
        u = complex(np.cos(guide.direction), np.sin(guide.direction))
        lateral = ((guide.through - m.fixed[m.crank.pivot]) * np.conj(u)).imag
        n = 1j * u if lateral > 1e-9 or (abs(lateral) <= 1e-9 and u.imag < 0) else -1j * u
        found.append(Indicator(force, u, n * (-1) ** taken.count(guide.name), areas[force.name]))
        taken.append(guide.name)
    return found


def height(project: Project, shown: list[Indicator]) -> float:
    """Greatest ordinate, mm: by the scale factor that the project asks for, or as we choose it."""
    mu = project.variant.scales.get("indicator")
    if mu is None:
        return HEIGHT
    top = max(float(np.max(one.ordinate(_angles(project)))) for one in shown)
    return min(top / mu, MOST)


def reach(project: Project) -> tuple[list[complex], list[complex]]:
    """Points of the paths and what the diagrams stick out of them on paper, mm: for the frame of the position plans."""
    z: list[complex] = []
    d: list[complex] = []
    shown = indicators(project)
    high = height(project, shown) if shown else 0.0
    for n, one in enumerate(shown):
        # Over the ordinate axis the scale factor is written, from side to side; that of another one within its length.
        beyond = 28.0 if n == 0 and abs(one.side.real) > 0.5 else 10.0
        at = np.ravel(project.study.positions.points[str(one.force.point)].value)
        for p in (at[np.argmin((at * np.conj(one.along)).real)], at[np.argmax((at * np.conj(one.along)).real)]):
            z.append(complex(p))
            d.append(one.side * (GAP + high + beyond))
    return z, d


def _angles(project: Project) -> Floats:
    cycle = project.cycle
    turns = round(cycle.period / (2 * pi))
    return np.unique(np.concatenate((np.linspace(0, cycle.period, turns * (SAMPLES - 1) + 1), cycle.turned)))


def draw(project: Project, s: PlayerStage) -> None:
    """The diagrams of a project beside the paths of its position plans."""
    shown = indicators(project)
    if not shown:
        return
    canvas, cycle = s.canvas, project.cycle
    turned = _angles(project)
    top = max(float(np.max(one.ordinate(turned))) for one in shown)
    pressure = shown[0].area != 1
    symbol, unit = ("μ_p", tr("MPa/mm")) if pressure else ("μ_F", tr("N/mm"))
    tallest = MOST if "indicator" in project.variant.scales else HEIGHT
    scale = pick(project, canvas, "indicator", symbol, unit, top / tallest)
    pos = project.study_at(turned, tuple("" for _ in turned)).positions
    for one in shown:
        name, load = str(one.force.point), f"loads/{one.force.name}"
        path = s.frame(np.asarray(pos.points[name].value))
        canvas.of = f"indicator {one.force.name}"
        zero = path[0] - one.along * ((path[0] - s.frame(0j)) * np.conj(one.along)).real + one.side * GAP
        mu = (s.frame.mu[0], scale.mu * (1e6 * one.area if pressure else 1.0))  # of the force, which the plan has
        graph = canvas.placed("loads", "", zero, mu, float(np.angle(one.along)), (one.side / one.along).imag < 0)
        with canvas.traced("curve", load, "", graph):
            canvas.polyline(path + one.side * (GAP + one.ordinate(turned) / scale.mu), "curve")
        ways = (path * np.conj(one.along)).real
        low, high = path[int(np.argmin(ways))] + one.side * GAP, path[int(np.argmax(ways))] + one.side * GAP
        top = float(np.max(one.ordinate(turned))) / scale.mu
        outer = low if (low - s.frame(0j)).imag * one.along.imag < 0 else high
        with canvas.traced("axis", load, "", graph):
            canvas.line(low, high, "axis")
            canvas.arrow(outer, outer + one.side * (top + 9.0), "axis", 3.0)
        away = one.along * (1 if outer == high else -1)
        canvas.label(outer + one.side * (top + 4.0), one.text, away, 3.5, 1.2, leader=False)
        out = top + 4.0 if one is shown[0] else 0.4 * top
        canvas.label(outer + one.side * out + 7.0 * away, str(scale), away, 3.5, 1.2)
        marks = s.frame(np.asarray(s.plan[name].value))
        for mark in np.unique(np.round(marks, 6)):
            here = np.flatnonzero(np.abs(marks - mark) < 1e-5)
            y = max(float(one.ordinate(cycle.turned[i])) for i in here) / scale.mu
            s.position(int(here[0])).pen(name, "construction").line(mark, mark + one.side * (GAP + max(y, 0.0)), "thin")
