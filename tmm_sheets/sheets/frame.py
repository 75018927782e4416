"""From a plan's unit to millimetres of the sheet: a scale factor and a place for the pole."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.construction.scale import Scale, handy
from tmm_sheets.errors import CannotBuild

if TYPE_CHECKING:
    from tmm_sheets.project import Project


class Scales(Protocol):
    """Where chosen scale factors are kept: the canvas, or whatever asks for them without drawing."""

    scales: dict[str, Any]


@dataclass(frozen=True)
class Frame:
    """``origin`` is where the plan's zero lies on the sheet, mm."""

    scale: Scale
    origin: complex

    def __call__(self, z: Any) -> Any:
        """Sheet point of a plan point."""
        return self.origin + self.scale.mm(z)


def extent(points: Any) -> Box:
    """Smallest rectangle round complex points, in their unit; NaN points do not count."""
    p = np.concatenate([np.ravel(np.asarray(q, dtype=complex)) for q in points])
    p = p[~np.isnan(p)]
    return Box(float(p.real.min()), float(p.imag.min()), float(p.real.max()), float(p.imag.max()))


def pick(project: Project, canvas: Scales, name: str, symbol: str, unit: str, least: float) -> Scale:
    """Scale factor of a plan: the project file's, or the smallest handy one that is not less than ``least``.

    It is kept on the canvas under the plan's name. Raises :class:`CannotBuild` when the file's factor is too small.
    """
    wanted = project.variant.scales.get(name)
    if wanted is not None and wanted < least * (1 - 1e-9):
        raise CannotBuild(
            f"scale factor {name} = {wanted:g}: the view does not fit in its place, it needs {handy(least):g} or more",
            f"leave scales.{name} out of the project file, or make its place larger in templates/sheets")
    if wanted is None and not least > 0:
        raise CannotBuild(f"plan {name}: there is nothing to draw, all its vectors are zero",
                          "give the links masses or add a [[force]], or leave this view out of the arrangement")
    scale = Scale(symbol, handy(least) if wanted is None else wanted, unit)
    canvas.scales[name] = scale
    return scale


def fit_frame(project: Project, canvas: Scales, name: str, symbol: str, unit: str, points: Any, offsets: Any, box: Box) -> Frame:
    """Smallest handy scale factor with which everything fits the place; its middle comes to the place's middle.

    ``points`` are in the plan's unit, ``offsets`` reach from each of them in millimetres of paper whatever the scale
    (arrows, blocks, labels). Where even the offsets alone do not fit, the points get half the place.
    """
    z, d = np.ravel(np.asarray(points, dtype=complex)), np.ravel(np.asarray(offsets, dtype=complex))
    real = extent([z])
    size = max(real.width / box.width, real.height / box.height)
    if not size > 0:  # a single point has no scale of its own: that of the position plans will do
        plans = canvas.scales.get("positions")
        size = plans.mu if plans is not None else 1.0
    mu = handy(size)
    for _ in range(12):
        drawn = extent([z / mu + d])
        if drawn.width <= box.width and drawn.height <= box.height:
            break
        mu = handy(mu * 1.0001)
    else:
        mu = handy(2 * size)
    scale = pick(project, canvas, name, symbol, unit, mu)
    return Frame(scale, box.centre - extent([scale.mm(z) + d]).centre)
