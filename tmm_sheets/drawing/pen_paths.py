"""Pen paths of a drawing on a plotter: clipped to its reach, each line once, strokes joined, in an order with little travel.

Paths are in whole plotter steps (0.025 mm), so that points and lines can be compared exactly.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import ceil, dist, gcd, hypot
from typing import Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.drawing.ink import ROUNDING, ink, polyline_inside
from tmm_sheets.drawing.marks import Box, Drawing, Points
from tmm_sheets.drawing.plotters import NEAR, Pen, Plotter

PASS_SPACING_SHARE = 0.85  # of the pen width: neighbouring passes overlap a little
GRID_MM = 1e-5  # areas are rounded to it: a union of unrounded ones may fail
CHORDS_IN_QUARTER = 6  # of the round end of a pass
MAX_WHITE_CORNER_MM = 0.045  # a larger white corner gets a pass of its own
BLEED_MM = 0.02  # the outermost pass of an area goes over its edge by this: sharper corners
WHITE_SPOT_RADIUS_MM = 0.01  # spots narrower than twice this stay white
SHAPE_DECIMALS = 6  # of a millimetre, to which polygons count as equal
SAGITTA_MM = 0.004  # by which a pass may cut corners: a sixth of a plotter step


def line_passes(points: Points, width: float, pen: float) -> Iterator[Points]:
    """Passes of a pen along a polyline, complex (n,) mm, that is ``width`` mm wide; the polyline itself if the pen is as wide.

    A pass at a distance from the polyline goes round it and closes, without lifting the pen.
    """
    spare = width - pen
    if spare <= NEAR + 1e-9:
        yield points
        return
    n = ceil(spare / (PASS_SPACING_SHARE * pen)) + 1
    passes = [ring for i in range(n // 2) for ring in _rings(_band(points, spare * (0.5 - i / (n - 1))))]
    if n % 2:
        passes.append(points)
    yield from passes
    if len(points) > 2:  # between the sides of an acute corner the passes stand apart
        yield from _missed(_band(points, width / 2), passes, pen)


def fill_passes(points: Points, pen: float) -> Iterator[Points]:
    """Passes of a pen that fill a polygon, complex (n,) mm: along its edge, then inwards, into acute corners as far as a pen goes.

    Polygons that differ by a translation and a rotation only share cached passes: arrow heads and dots repeat all over a sheet.
    """
    shape = points - points[0]
    far = complex(shape[np.argmax(np.abs(shape))])
    turn = far / abs(far) if far else 1.0 + 0j
    ways = filled_paths(tuple(np.round(shape / turn, SHAPE_DECIMALS).tolist()), pen)
    yield from (points[0] + turn * way for way in ways)
    if not ways:  # thinner than the pen
        yield _diagonal(points, pen)


@lru_cache(maxsize=256)
def filled_paths(shape: tuple[complex, ...], pen: float) -> tuple[Points, ...]:
    """Passes of a pen of this width, mm, that fill a shape."""
    return tuple(_passes(np.array(shape), pen))


def _passes(points: Points, pen: float) -> Iterator[Points]:
    import shapely

    area = shapely.make_valid(shapely.Polygon(_xy(points)))
    depth, passes = pen / 2 - BLEED_MM, list[Points]()
    while not (inner := area.buffer(-depth, join_style="mitre", mitre_limit=20)).is_empty:
        passes += _rings(inner)
        depth += PASS_SPACING_SHARE * pen
    if not passes:
        return
    edge = np.concatenate(passes)
    for corner in points.tolist():
        start = complex(edge[np.argmin(np.abs(edge - corner))])
        if abs(corner - start) > pen / 2 + MAX_WHITE_CORNER_MM:
            passes.append(np.array([start, corner - pen / 2 * (corner - start) / abs(corner - start)]))
    yield from passes
    yield from _missed(area.buffer(-MAX_WHITE_CORNER_MM), passes, pen)


def _missed(area: Any, passes: Iterable[Points], pen: float) -> Iterator[Points]:
    """One stroke for each spot of an area that the passes leave white, and one for what twice as wide is left of it then."""
    import shapely

    for share in (1, 2):
        covered = shapely.union_all([_band(p, pen / 2) for p in passes], grid_size=GRID_MM)
        area = shapely.difference(area, covered, grid_size=GRID_MM)
        spots = [spot for spot in shapely.get_parts(area.buffer(-share * WHITE_SPOT_RADIUS_MM)) if not spot.is_empty]
        passes = [_diagonal(np.asarray(x) + 1j * np.asarray(y), pen) for x, y in (spot.exterior.xy for spot in spots)]
        yield from passes


def _band(points: Points, radius: float) -> Any:
    """Area that a round pen of ``radius`` mm covers along a polyline.

    Buffered segment by segment: shapely's buffer of a long line with many short segments is sometimes invalid.
    """
    import shapely

    xy = _xy(points)
    pieces = shapely.linestrings(np.stack((xy[:-1], xy[1:]), axis=1)) if len(xy) > 1 else shapely.points(xy)
    return shapely.union_all(shapely.buffer(pieces, radius, quad_segs=CHORDS_IN_QUARTER), grid_size=GRID_MM)


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
    simple = area.simplify(SAGITTA_MM)
    for part in getattr(simple, "geoms", [simple]):
        for ring in (part.exterior, *part.interiors):
            x, y = ring.xy
            yield np.asarray(x) + 1j * np.asarray(y)


STEP = 0.025  # mm
MIN_GAIN_STEPS = 1.0  # plotter steps that a change of the order has to save
Step = tuple[int, int]
Path = tuple[Step, ...]


@dataclass(frozen=True)
class Layer:
    """Work of one pen: paths in drawing order, and areas that the machine fills itself (printers only)."""

    pen: Pen
    paths: tuple[Path, ...]
    areas: tuple[Path, ...] = ()


@dataclass(frozen=True)
class PenPlan:
    """Paths for a plotter, and their cost. Lengths in mm.

    ``travel_before``: travel of the raised pen if strokes were drawn in the order of the drawing, pen by pen; ``doubled``: length
    of lines that would have been drawn twice; ``lost``: length of lines beyond the reach.
    """

    plotter: Plotter
    width: float
    height: float
    layers: tuple[Layer, ...]
    strokes: int
    drawn: float
    travel_before: float
    travel: float
    doubled: float
    lost: float

    @property
    def paths(self) -> int:
        """Number of times the pen goes down."""
        return sum(len(layer.paths) for layer in self.layers)


def plan(drawing: Drawing, plotter: Plotter, window: Box | None = None) -> PenPlan:
    """Pen paths of a drawing, or of a ``window`` of it (mm of the sheet), whose lower left corner becomes that of the paper.

    Raises
    ------
    ValueError
        When a mark has coordinates that are not finite or a letter is missing from the font.
    """
    view = window or Box(0.0, 0.0, drawing.width, drawing.height)
    width, height = view.x1 - view.x0, view.y1 - view.y0
    shift = complex(-view.x0, -view.y0) - (complex(width, height) / 2 if plotter.origin == "centre" else 0)
    lines, areas, strokes, lost = _pen_lines(drawing, plotter, view, shift)
    order = plotter.pens or tuple(sorted({*lines, *areas}, key=lambda pen: pen.width))
    layers, place = list[Layer](), (0, 0)
    for pen in order:
        if lines[pen] or areas[pen]:
            paths = ordered(join_segments(drop_retraced(lines[pen])), place)
            place = paths[-1][-1] if paths else place
            layers.append(Layer(pen, tuple(paths), tuple(areas[pen])))
    as_drawn, as_plotted = [p for pen in order for p in lines[pen]], [p for layer in layers for p in layer.paths]
    drawn = sum(map(_path_length, as_plotted))
    return PenPlan(plotter, width, height, tuple(layers), strokes, STEP * drawn, STEP * raised_travel(as_drawn),
                   STEP * raised_travel(as_plotted), STEP * (sum(map(_path_length, as_drawn)) - drawn),
                   lost if window is None else 0.0)  # fmt: skip


def _pen_lines(drawing: Drawing, plotter: Plotter, view: Box, shift: complex) -> tuple[
        defaultdict[Pen, list[Path]], defaultdict[Pen, list[Path]], int, float]:
    """Lines and filled areas by pen within the view and the plotter's reach, in the order of the drawing.

    Also the number of strokes they come from, and the length beyond the reach, mm.
    """
    reach = Box(*(round(v, 6) for v in (
        max(plotter.reach.x0, view.x0 + shift.real), max(plotter.reach.y0, view.y0 + shift.imag),
        min(plotter.reach.x1, view.x1 + shift.real), min(plotter.reach.y1, view.y1 + shift.imag),
    )))  # fmt: skip
    lines: defaultdict[Pen, list[Path]] = defaultdict(list)
    areas: defaultdict[Pen, list[Path]] = defaultdict(list)
    lost, strokes = 0.0, 0
    for stroke in ink(drawing.marks):
        points = stroke.points + shift
        x0, y0, x1, y1 = bounds = Box.around(points)
        if x0 > reach.x1 or y0 > reach.y1 or x1 < reach.x0 or y1 < reach.y0:  # in a window: another will have it
            lost += 0.0 if stroke.filled else _length(points)
            continue
        strokes += 1
        if stroke.filled and not plotter.pens:
            if all(map(reach.inset(-ROUNDING).contains, bounds.corners)):
                areas[Pen(1, 0.2)].append(_steps(points))
            continue
        pen = plotter.finest if stroke.filled else plotter.pen(stroke.width)
        for way in fill_passes(points, pen.width) if stroke.filled else line_passes(points, stroke.width, pen.width):
            parts = polyline_inside(reach, way)
            lost += 0.0 if parts and parts[0] is way else _length(way) - sum(map(_length, parts))
            lines[pen] += [_steps(part) for part in parts]
    return lines, areas, strokes, lost


def drop_retraced(paths: Iterable[Path]) -> Iterator[Path]:
    """Straight segments of the paths, overlapping stretches once; then the dots, paths of one point."""
    lines: dict[tuple[int, int, int], list[tuple[int, Step, int, Step]]] = defaultdict(list)
    dots = set()
    for path in paths:
        if len(path) == 1:
            dots.add(path)
        for a, b in pairwise(path):
            dx, dy = b[0] - a[0], b[1] - a[1]
            g = gcd(dx, dy)
            u, v = dx // g, dy // g
            if (u, v) < (0, 0):
                a, b, u, v = b, a, -u, -v
            lines[u, v, u * a[1] - v * a[0]].append((u * a[0] + v * a[1], a, u * b[0] + v * b[1], b))
    for pieces in lines.values():
        pieces.sort()
        _, start, end, stop = pieces[0]
        for s, a, e, b in pieces[1:]:
            if s > end:
                yield start, stop
                start = a
            if s > end or e > end:
                end, stop = e, b
        yield start, stop
    yield from sorted(dots)


def join_segments(pieces: Iterable[Path]) -> list[Path]:
    """Join straight segments to paths, straight on where several meet."""
    at, out = defaultdict[Step, list[Step]](list), list[Path]()
    for piece in pieces:
        if len(piece) == 1:
            out.append(piece)
        for a, b in pairwise(piece):
            at[a].append(b)
            at[b].append(a)

    def follow(place: Step) -> None:
        path = [place, place]
        while here := at[path[-1]]:
            (u, v), (x, y) = path[-2:]
            path.append(max(here, key=lambda p: ((x - u) * (p[0] - x) + (y - v) * (p[1] - y)) / hypot(p[0] - x, p[1] - y)))
            here.remove(path[-1])
            at[path[-1]].remove((x, y))
        out.append(tuple(path[1:]))

    # A path that begins where an odd number of pieces meet ends at another such place; what is left then is closed.
    for place, here in at.items():
        if len(here) % 2:
            follow(place)
    for place, here in at.items():
        while here:
            follow(place)
    return out


def ordered(paths: list[Path], start: Step = (0, 0)) -> list[Path]:
    """Order paths for little travel from ``start``, reversing them where that helps.

    Nearest end first, then stretches of the order are reversed as long as that saves travel (2-opt; Croes 1958): the stretch from
    leap i to leap j, which then join their beginnings, and their ends. One of these two is nearer than the longer leap is wide:
    all pairs that can save anything are among the ends so near to each other. Of those that save something the best are taken as
    long as they keep out of each other's way, then it is looked again.
    """
    import shapely

    if not paths:
        return []
    # A path k has the ends k and n + k; the pen is at the one before the last, and goes nowhere when all is drawn.
    n, z = len(paths), np.array([*(complex(*path[k]) for k in (0, -1) for path in paths), complex(*start), np.nan])
    first = _greedy_order(z)
    points = shapely.points(z[:-1].real, z[:-1].imag)
    tree = shapely.STRtree(points)
    at, begins, wide, near = np.zeros(2 * n + 2, int), np.zeros(2 * n + 2, bool), np.full(2 * n + 2, -1.0), np.zeros((2, 0), int)
    while True:
        leaps = np.array([[2 * n, *(first + n) % (2 * n)], [*first, 2 * n + 1]])  # from the end of each path to the next one
        tails, heads = z[leaps]
        leap = np.nan_to_num(np.abs(tails - heads))
        at[leaps], begins[leaps], before = np.arange(n + 1), [[False], [True]], wide.copy()
        wide[leaps] = leap
        other = (wide != before)[:-1]
        asked = np.flatnonzero(other & (2 * wide[:-1] > MIN_GAIN_STEPS))  # no reversal gains more than twice its longer leap
        ends, beside = tree.query(points[asked], "dwithin", wide[asked])
        near = np.hstack((near[:, ~other[near[0]]], (asked[ends], beside)))
        i, j = np.sort(at[near[:, begins[near[0]] == begins[near[1]]]], axis=0)
        gain = leap[i] + leap[j] - np.abs(tails[i] - tails[j]) - np.where(j < n, np.abs(heads[i] - heads[j]), 0.0)
        best = np.flatnonzero((i < j) & (gain > MIN_GAIN_STEPS))
        best = best[np.argsort(-gain[best], kind="stable")]
        within, stretches = np.zeros(n + 1, int), []  # of each leap: the stretch it lies in, -1 at the ends of one
        for a, b in zip(i[best].tolist(), j[best].tolist(), strict=True):
            if within[a] == within[b] >= 0:
                stretches.append((b - a, a, b))
                inner = within[a + 1:b]
                inner[inner == within[a]] = len(stretches)
                within[[a, b]] = -1
        if not stretches:
            return [paths[k] if k < n else paths[k - n][::-1] for k in first.tolist()]
        for _, a, b in sorted(stretches):  # a stretch within another one first
            first[a:b] = (first[a:b][::-1] + n) % (2 * n)


def _greedy_order(z: Points) -> npt.NDArray[np.int64]:
    """The ends with which paths begin in greedy order, each nearest to where the last one stopped; see :func:`ordered`."""
    n, place, first = len(z) // 2 - 1, complex(z[-2]), []
    left = z[:-2].astype(np.complex64)  # plotter steps are whole numbers
    for _ in range(n):
        first.append(k := int(np.argmin(np.abs(left - place))))
        left[k % n::n] = np.inf
        place = complex(z[(k + n) % (2 * n)])
    return np.array(first)


def _steps(points: Points) -> Path:
    """Points, complex (n,) mm, in plotter steps without repeats."""
    x, y = (np.rint(v / STEP).astype(int).tolist() for v in (points.real, points.imag))
    steps = list(zip(x, y, strict=True))
    return (steps[0], *(b for a, b in pairwise(steps) if a != b))


def _length(points: Points) -> float:
    return float(np.abs(np.diff(points)).sum())


def _path_length(path: Path) -> float:
    return sum(dist(a, b) for a, b in pairwise(path))


def raised_travel(paths: list[Path], start: Step = (0, 0)) -> float:
    """Travel of the raised pen, plotter steps."""
    return sum(dist(place, path[0]) for place, path in zip([start, *(path[-1] for path in paths)], paths, strict=False))
