"""What the views of a cam need of their places."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, lru_cache
from math import inf
from typing import TYPE_CHECKING, cast

import numpy as np

from tmm_sheets.construction.scale import CURVE, STANDARD, fitting
from tmm_sheets.errors import CannotBuild
from tmm_sheets.sheets.border_solver import BorderNode, Need, leaf, reached, stepped
from tmm_sheets.sheets.cams import cam as cam_views
from tmm_sheets.sheets.cams import cam_profile, cam_zone
from tmm_sheets.sheets.player import standard

if TYPE_CHECKING:
    from tmm_sheets.methods.cams.cam_profile import Cam, RollerCam, TappetCam
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.views import ViewPlace


NUMBERED = CURVE
"""Height of a curve on which all positions are numbered, mm."""


CROWDED = 30.0
"""Height of a curve below which the numbers of its positions stand on one another, mm."""


ORDINATES = 4.0
"""Distance of two ordinates that can be read, mm."""


GRAPH = 45.0
"""Height of a graph that can be read, mm."""


def motion(project: Project, view: ViewPlace) -> BorderNode:
    """The diagrams are as large as their scale factors make them: what they leave is for others."""
    m = project.cam.motion
    left, right = cam_views.reach_of_motion(m)
    width = left + max(right, cam_views.heads_width(m))
    return leaf(view.box, Need(least=(width, (sum(m.heights) + cam_views.TITLE + cam_views.HEADS)), most=(width, view.box.height),
                               drawn=lambda w, h: w * h))


def table(project: Project, view: ViewPlace) -> BorderNode:
    """As high as it is written and no narrower: it takes what the diagrams leave beside them."""
    w, h = view.box.width, view.box.height
    return leaf(view.box, Need(least=(w, h), most=(inf, h), drawn=lambda w, h: w * h))


def wide(project: Project, view: ViewPlace) -> BorderNode:
    """Need of a view that takes what room there is, down to a part of its box below which it cannot be read."""
    w, h = view.box.width, view.box.height
    return leaf(view.box, Need(least=(0.9 * w, 0.8 * h), drawn=lambda w, h: 0.6 * w * h))


def zone_of_tappet(project: Project, view: ViewPlace) -> BorderNode | None:
    """A curve S(S′) with the numbers of all positions on it, which must be so high that they can be read."""
    cam = cast("TappetCam", project.cam)  # others have no such view
    rays = bool(view.options.get("rays"))

    def drawn(width: int, height: int) -> float:
        stroke = cam_zone.stroke_in(cam, rays, width, height)
        return 0.6 * width * height * min(stroke / NUMBERED, 1.0) * reached(stroke, CROWDED)

    return stepped(view, (0.88 * view.box.width, 0.8 * view.box.height), drawn)


def pressure(project: Project, view: ViewPlace) -> BorderNode | None:
    """A graph over the whole turn: beyond its width more height is of no use, and its ordinates are to stand apart."""
    def drawn(width: float, height: float) -> float:
        return 0.6 * width * min(height, width) * min(cam_views.ordinates_apart(project.cam, width) / ORDINATES, 1.0)

    return leaf(view.box, Need(least=(120.0, 80.0), drawn=drawn))


def spring(project: Project, view: ViewPlace) -> BorderNode | None:
    """A graph with its lines beside it or under it, where they leave it the height to be read."""
    def drawn(width: float, height: float) -> float:
        return 0.6 * width * height * min(max(cam_views.spring_height(width, height) / GRAPH, 0.05), 1.0)

    return leaf(view.box, Need(least=(0.8 * view.box.width, 80.0), drawn=drawn))


def profile(project: Project, view: ViewPlace) -> BorderNode | None:
    """The profile at a standard scale, with its table where that leaves the scale."""
    return stepped(view, (180.0, 180.0), _profile_area(project.cam, cam_profile.table_size(project.cam)))


@lru_cache(maxsize=4)
def _profile_area(cam: Cam, table: tuple[float, float]) -> Callable[[int, int], float]:
    """Area that the figure of a profile takes of places of some width and height, mm: the same in all ways to arrange a sheet."""
    sizes = np.array(cam_profile.figure_sizes(cam))
    beside = 2 * (cam_profile.EDGE + cam_profile.margin(cam))
    alone, with_table = cam_profile.over(cam, table)
    mus = [real / drawn * 1e-3 for real, drawn in STANDARD]

    @cache
    def in_place(width: int, height: int) -> float:
        scale, larger = (int(fitting(sizes * 1e3, (width - beside, height - over)).max()) for over in (with_table, alone))
        if scale < 0:
            return 1.0
        mu, over = mus[scale], with_table
        if larger > scale and cam_profile.largest(cam, width, height, table).mu < mu:
            mu, over = mus[larger], alone
        w, h = (sizes / mu + (beside, over)).T
        shown = (w * h)[(w <= width + 1e-6) & (h <= height + 1e-6)]
        return float(shown.max()) if len(shown) else 1.0

    return in_place


def roller(project: Project, view: ViewPlace) -> BorderNode | None:
    """The choice of the roller at a standard scale."""
    cam = cast("RollerCam", project.cam)  # others have no such view
    w, h = cam_profile.roller_extent(cam)
    left, below, right, above = cam_profile.ROLLER

    def drawn(width: int, height: int) -> float:
        try:
            mu = standard((w, width - left - right), (h, height - below - above)).mu
        except CannotBuild:
            return 1.0
        return (w / mu + left + right) * (h / mu + below + above)

    return stepped(view, (cam_profile.roller_width(cam), 104.0), drawn, 0.5)
