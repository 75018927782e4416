"""How a pen that is thinner than a line, or than an area, covers it: passes side by side, half a pen from the edge."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import lru_cache
from math import ceil
from typing import Any

import numpy as np

from tmm_sheets.drawing.marks import Points
from tmm_sheets.drawing.plotters import NEAR

SPACING = 0.85  # of the pen: neighbouring passes overlap a little
GRID = 1e-5  # mm to which areas are rounded, so that putting them together never fails
ROUND = 6  # chords in a quarter of the round end of a pass
CORNER = 0.045  # mm a corner may stay white before the pen goes into it on purpose
BLEED = 0.02  # mm the outermost pass of an area goes over its edge, so that corners come out sharper
SPOT = 0.01  # mm: white spots narrower than twice this are left
ALIKE = 6  # decimals of a millimetre to which polygons are alike
SAGITTA = 0.004  # mm a pass may cut corners: a sixth of a plotter step


def of_line(points: Points, width: float, pen: float) -> Iterator[Points]:
    """Passes of a pen along a line ``width`` mm wide; the line itself when the pen is wide enough.

    The pass at a distance from the line goes round it and closes, without lifting the pen.
    """
    spare = width - pen
    if spare <= NEAR + 1e-9:
        yield points
        return
    n = ceil(spare / (SPACING * pen)) + 1
    passes = [ring for i in range(n // 2) for ring in _rings(_band(points, spare * (0.5 - i / (n - 1))))]
    if n % 2:
        passes.append(points)
    yield from passes
    if len(points) > 2:  # between the sides of an acute corner the passes stand apart
        yield from _missed(_band(points, width / 2), passes, pen)


def of_area(points: Points, pen: float) -> Iterator[Points]:
    """Passes of a pen that fill a polygon: along its edge, then inwards; into acute corners as far as the round pen can.

    Heads of arrows and dots are alike all over a sheet: polygons that differ by place and direction only are filled alike.
    """
    shape = points - points[0]
    far = complex(shape[np.argmax(np.abs(shape))])
    turn = far / abs(far) if far else 1.0 + 0j
    ways = _filled(tuple(np.round(shape / turn, ALIKE).tolist()), pen)
    yield from (points[0] + turn * way for way in ways)
    if not ways:  # thinner than the pen
        yield _diagonal(points, pen)


@lru_cache(maxsize=256)
def _filled(shape: tuple[complex, ...], pen: float) -> tuple[Points, ...]:
    return tuple(_passes(np.array(shape), pen))


def _passes(points: Points, pen: float) -> Iterator[Points]:
    import shapely

    area = shapely.make_valid(shapely.Polygon(_xy(points)))
    depth, passes = pen / 2 - BLEED, list[Points]()
    while not (inner := area.buffer(-depth, join_style="mitre", mitre_limit=20)).is_empty:
        passes += _rings(inner)
        depth += SPACING * pen
    if not passes:
        return
    edge = np.concatenate(passes)
    for corner in points.tolist():
        start = complex(edge[np.argmin(np.abs(edge - corner))])
        if abs(corner - start) > pen / 2 + CORNER:
            passes.append(np.array([start, corner - pen / 2 * (corner - start) / abs(corner - start)]))
    yield from passes
    yield from _missed(area.buffer(-CORNER), passes, pen)


def _missed(area: Any, passes: Iterable[Points], pen: float) -> Iterator[Points]:
    """A stroke for each spot of an area that the passes leave white."""
    import shapely

    covered = shapely.union_all([_band(p, pen / 2) for p in passes], grid_size=GRID)
    for spot in shapely.get_parts(shapely.difference(area, covered, grid_size=GRID).buffer(-SPOT)):
        if spot.is_empty:
            continue
        x, y = spot.exterior.xy
        yield _diagonal(np.asarray(x) + 1j * np.asarray(y), pen)


def _band(points: Points, radius: float) -> Any:
    """What a round pen of that radius covers along a line.

    Piece by piece: the library's own buffer of a long line with many short pieces now and then comes out invalid.
    """
    import shapely

    xy = _xy(points)
    pieces = shapely.linestrings(np.stack((xy[:-1], xy[1:]), axis=1)) if len(xy) > 1 else shapely.points(xy)
    return shapely.union_all(shapely.buffer(pieces, radius, quad_segs=ROUND), grid_size=GRID)


def _diagonal(points: Points, pen: float) -> Points:
    """Stroke of a pen along the longest diagonal of an area narrower than the pen."""
    span = np.abs(points[:, None] - points[None, :])
    i, j = np.unravel_index(int(np.argmax(span)), span.shape)
    a, b = complex(points[i]), complex(points[j])
    short = min(pen / 2 / abs(b - a), 0.5) if a != b else 0.0
    return np.array([a + short * (b - a), b - short * (b - a)])


def _xy(points: Points) -> Any:
    return np.column_stack((points.real, points.imag))


def _rings(area: Any) -> Iterator[Points]:
    simple = area.simplify(SAGITTA)
    for part in getattr(simple, "geoms", [simple]):
        for ring in (part.exterior, *part.interiors):
            x, y = ring.xy
            yield np.asarray(x) + 1j * np.asarray(y)
