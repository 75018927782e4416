"""Paper that is not smooth: waves, creases, what lies beneath it.

Its height is a cubic B-spline over the sheet, with a prior against bending, so that single lines do not lift it; where it is
steep, it also is shorter by as much as paper is that keeps its length, and what that leaves a coarser spline takes up in the plane.
Everything is fitted together with the homography, the lens and the camera's foot.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import cv2
import numpy as np

from tmm_sheets.compare.elements import Element, sampled
from tmm_sheets.compare.photo.lost_ink import Mask, at
from tmm_sheets.compare.photo.map_fit import LENS, Seen, camera_foot, camera_height, lens_and_homography
from tmm_sheets.compare.photo.profiles import LARGELY, fit, follow, peaks, runs
from tmm_sheets.compare.photo.sheet_map import AWAY, FRAME, PAPER, Floats, Map, drawn_in, spline_base, spline_nodes
from tmm_sheets.compare.photo.traces import SAMPLING, Paper, Stations, measurable, similarity_base
from tmm_sheets.drawing.marks import Points
from tmm_sheets.words import tell

CELLS, STRETCHED = (20, 14), (8, 6)
"""Cells along the frame's width and height, of the height and of what is taken up in the plane."""
POINT, SHARPLY = 0.5, 0.6
"""Share of the distance that counts as far off, at most the second number, mm, which at one point costs as much as a prior's usual
size: the nearer by lines are sought, the less the paper's stiffness tells."""
CURVED = 2.0e-3
"""Usual curvature of the height, 1/mm."""
TALL, LONG = 20.0, 1.0
"""Usual height and usual displacement in the plane, mm."""
FREE = 2.0
"""How much more freely the camera's foot may move than in a smooth map: what is wrong in the height is taken up in the plane."""
STEPS, SETTLED = 8, 0.05
"""Most steps, and mm of change at every point below which no further one is done."""


def fit_surface(m: Map, sides: Seen, loose: float, seen: Seen, far: float) -> Map:
    """A map with a curved surface instead of a relief, fitted to points of the frame and of lines inside.

    Parameters
    ----------
    m
        Where to start.
    sides, loose
        Points of the frame, and the distance from which on they count little, mm.
    seen, far
        The same of lines inside.
    """
    loosely = np.repeat((loose, far), (len(sides.weight), len(seen.weight)))
    seen = Seen(*(np.concatenate(pair) for pair in zip(sides, seen, strict=True)))
    shape, flat = (CELLS[1] + 3, CELLS[0] + 3), (STRETCHED[1] + 3, STRETCHED[0] + 3)
    foot, error = camera_foot(m)
    away = camera_height(m)
    if not m.surface.any():
        m = replace(m, surface=np.zeros(shape), stretch=np.zeros((2, *flat)), drawn_in=np.zeros((2, *shape)), foot=foot)
    m = replace(m, sides=np.zeros_like(m.sides), relief=np.zeros_like(m.relief), waves=np.zeros_like(m.waves))
    p, n, q = seen.sheet, np.conj(seen.normals), (seen.picture - m.middle) / m.reach
    here_of, height = spline_nodes(p, shape)
    plane_of, plane = spline_nodes(p, flat)
    count, few = shape[0] * shape[1], flat[0] * flat[1]
    # Of some six hundred unknowns a point knows sixty: all points in one cell of both splines the same ones.
    which = np.hstack((np.tile(np.arange(12), (len(p), 1)), 12 + here_of, 12 + count + plane_of, 12 + count + few + plane_of))
    _, cell = np.unique(here_of[:, 0] * few + plane_of[:, 0], return_inverse=True)
    order = np.argsort(cell, kind="stable")
    cells = np.split(order, np.flatnonzero(np.diff(cell[order])) + 1)
    spacing = FRAME.width / CELLS[0]
    rough, uneven = _bending(shape) / (CURVED * spacing**2), _bending(flat) / LONG
    usual = np.concatenate((np.full(8, np.inf), LENS, (FREE * error, FREE * error), np.full(count, TALL), np.full(2 * few, LONG)))
    middle = np.zeros(len(usual))
    middle[10:12] = foot.real, foot.imag
    prior = np.diag(usual**-2.0)
    prior[12 : 12 + count, 12 : 12 + count] += rough.T @ rough
    for k in range(2):
        mine = slice(12 + count + k * few, 12 + count + (k + 1) * few)
        prior[mine, mine] += uneven.T @ uneven

    def packed(m: Map) -> Floats:
        return np.concatenate(((m.matrix / m.matrix[2, 2]).ravel()[:8], m.bend, (m.foot.real, m.foot.imag), m.surface.ravel(),
                               m.stretch.ravel()))

    def unpacked(x: Floats) -> Map:
        risen = x[12 : 12 + count].reshape(shape)
        return replace(m, matrix=np.append(x[:8], 1.0).reshape(3, 3), bend=(float(x[8]), float(x[9])), foot=complex(x[10], x[11]),
                       surface=risen, stretch=x[12 + count :].reshape(2, *flat), drawn_in=drawn_in(risen, away / AWAY))

    x = packed(m)
    lever_less = np.hstack((-n.real[:, None] * plane, n.imag[:, None] * plane))
    for _ in range(STEPS):
        (here, slopes), lift = lens_and_homography(x[:10], q, n), (height * x[12 + here_of]).sum(1)
        lever = np.real(n * (p - complex(x[10], x[11]))) / AWAY
        aside = drawn_in(x[12 : 12 + count].reshape(shape), away / AWAY).reshape(2, -1)
        shorter = [(height * part[here_of]).sum(1) for part in aside]
        r = here - np.real(n * (p + shorter[0] + 1j * shorter[1])) - lift * lever + (lever_less * x[which[:, 28:]]).sum(1)
        jacobian = np.hstack((
            slopes,
            np.stack((n.real * lift, -n.imag * lift), -1) / AWAY,
            -lever[:, None] * height,
            lever_less,
        ))  # fmt: skip
        w = seen.weight / (1 + (r / loosely) ** 2) / (POINT * np.minimum(loosely, SHARPLY))
        weighted, wanted = jacobian * w[:, None], r * w
        square, down = prior.copy(), -prior @ (x - middle)
        for some in cells:
            mine, part = which[some[0]], weighted[some]
            square[mine[:, None], mine] += part.T @ part
            down[mine] -= wanted[some] @ part
        scale = 1 / np.sqrt(np.maximum(np.diag(square), 1e-12))
        square = square * scale * scale[:, None]
        change = scale * np.linalg.solve(square + 1e-9 * np.eye(len(x)), scale * down)
        x = x + change
        if float(np.abs((jacobian * change[which]).sum(1)).max()) < SETTLED:
            break
    return unpacked(x)


def _bending(shape: tuple[int, int]) -> Any:
    """Second differences of the coefficients of a spline, along, up and across."""
    one = np.eye(shape[0] * shape[1]).reshape(*shape, -1)
    return np.concatenate([d.reshape(-1, one.shape[-1]) for d in (
        np.diff(one, 2, axis=0), np.diff(one, 2, axis=1), np.sqrt(2) * np.diff(np.diff(one, axis=0), axis=1),
    )])  # fmt: skip


REACH, ACROSS = 4.0, 0.2
"""mm to both sides of a line, and between offsets across it."""
PIECE, SHORTEST = 60, 25
"""Stations of a piece of a line that is followed; pieces overlap by half. Stations of the shortest line."""
NEAR = 1.5
"""mm from another line within which a line is not followed."""
LOOSE, STRAIGHT = 0.3, 0.4
"""mm off a similarity from which on a station counts little, and least share of a line that is not."""
BENT, BEND = 0.5, 6
"""mm off a similarity from which on a line is bent, and for how many stations."""
SEVERAL, TOGETHER = 3, 60.0
"""Least number of lines bent near each other by which the paper bulges, and how near that is, mm."""
TABLES = ("frame", "table")
"""Roles of lines too near to lettering to tell of a bulge, but when several are bent alike, by nearly as much, this near, mm."""
ALIKE, BESIDE = 0.5, 40.0
CELL, ABOUT = 12.0, 50.0
"""Side of the cells of the spline by which a map follows a bulge, mm, and how far about its bends it may."""
LOCAL_FAR = 0.5
"""Distance from which on lines count little there, mm."""
LOCAL_POINT, BEND_OF_SPLINE, SIZE = 0.6, 2.0, 20.0
"""Usual error of a followed point, usual second difference of the spline and its usual size, mm."""
MARGIN = 8
"""mm about bent lines in which nothing is judged."""
ROUNDS = 2
"""How often lines are followed anew over a bulge."""
OFFSETS = np.arange(-REACH, REACH + ACROSS / 2, ACROSS)


class TracedLine(NamedTuple):
    """A line followed through its ink: stations, their normals, how far off the ink is, mm, where it was seen, where it is bent."""

    element: Element
    points: Points
    normals: Points
    off: Floats
    seen: Any
    bent: Any


def trace_lines(elements: Sequence[Element], ink: Any, hidden: Mask) -> list[TracedLine]:
    """The lines of a rectified sheet that can be followed."""
    chosen, p, n, real = _pieces(elements)
    if not chosen:
        return []
    paper = Paper.of(elements, ink, hidden)
    of = np.repeat([e.number for e, _ in chosen], [count for _, count in chosen])
    places = p[..., None] + n[..., None] * OFFSETS
    profile = paper.dark(places).astype(np.float32)
    # A line of lettering is as straight as one of ink, and as near to the lines of a table.
    others = paper.foreign(of[:, None, None], places)
    others &= np.abs(OFFSETS) > 0.45
    # Half way to the next line known on either side.
    below = np.where(others & (OFFSETS < 0), -OFFSETS, 2 * REACH).min(-1)
    above = np.where(others & (OFFSETS > 0), OFFSETS, 2 * REACH).min(-1)
    known = (np.minimum(below, above) > NEAR) & real & ~at(p, hidden)
    clear = (0.5 * below[..., None] >= -OFFSETS) & (0.5 * above[..., None] >= OFFSETS) & known[..., None]
    profile = np.where(clear, profile, 0)
    way = OFFSETS[follow(np.minimum(profile, 2 * paper.level), 2)]
    off, strength = (part.reshape(way.shape) for part in peaks(profile.reshape(-1, len(OFFSETS)), OFFSETS, way.ravel(), 0.6, 0.5))
    seen = strength > paper.level
    out: list[TracedLine] = []
    first = 0
    for e, count in chosen:
        mine = slice(first, first + count)
        first += count
        z, w, o, k, s = (_joined(part[mine], real[mine]) for part in (p, n, off, known, seen))
        if s.sum() >= SHORTEST:
            out.append(TracedLine(e, z, w, o, s, _bent(e, z, w, o, k, s)))
    return out


def local_distortion(lines: Sequence[TracedLine]) -> Points:
    """Places at which lines are bent near others that are."""
    bent = [line for line in lines if line.bent.any()]
    alike = _alike([line for line in bent if line.element.role in TABLES])
    bends = [(line, line.points[line.bent]) for line in bent if line.element.role not in TABLES] + alike
    if len(bends) < SEVERAL:
        return np.zeros(0, complex)
    strokes = _strokes([z for _, z in bends])
    # One every few mm is enough to be near to.
    near = [sum((np.abs(z[:, None] - np.concatenate(stroke)[None, ::3]).min(1) < TOGETHER).astype(int) for stroke in strokes)
            for _, z in bends]
    return np.concatenate([z[count >= SEVERAL] for (_, z), count in zip(bends, near, strict=True)])


def _alike(lines: Sequence[TracedLine]) -> list[tuple[TracedLine, Points]]:
    """Bends of lines, most of each like those of several; at the end of the reach it is something else that is followed."""
    bends = [(line.points[here], (line.off * line.normals)[here]) for line in lines
             for here in [line.bent & (np.abs(line.off) < REACH - LOOSE)]]
    out = []
    for line, (z, by) in zip(lines, bends, strict=True):
        same = [((np.abs(z[:, None] - other) < BESIDE) & (np.abs(by[:, None] - its) < ALIKE)).any(1) for other, its in bends]
        some = z[np.sum(same, 0) >= SEVERAL]
        if len(some) > 0.5 * len(z):
            out.append((line, some))
    return out


def _strokes(bends: Sequence[Points]) -> list[list[Points]]:
    """Bends by the strokes they are in: lines that lie in one, a vector and the line it was built on, are bent once."""
    out: list[list[Points]] = []
    for z in bends:
        same = next((s for s in out if (np.abs(z[:, None] - np.concatenate(s)[None]).min(1) < NEAR).mean() > 0.5), None)
        if same is None:
            out.append([z])
        else:
            same.append(z)
    return out


def over_bulges(
    m: Map, ink: Any, elements: Sequence[Element], hidden: Mask, straighten: Callable[[Map], Any],
) -> tuple[Map, Any, Points]:
    """The map corrected where the paper bulges, the picture it straightens, and places where it bulges still."""
    places = local_distortion(lines := trace_lines(elements, ink, hidden))
    if not len(places):
        return m, ink, places
    for _ in range(ROUNDS):
        m = _corrected_map(m, lines, places)
        ink = straighten(m)
        lines = trace_lines(elements, ink, hidden)
        left = local_distortion(lines)
        places = np.concatenate((places, left))
    return m, ink, left


def _corrected_map(m: Map, lines: Sequence[TracedLine], places: Points) -> Map:
    """The map corrected about bulges at ``places`` by all lines there."""
    shape = (round(FRAME.height / CELL) + 3, round(FRAME.width / CELL) + 3)
    x = FRAME.x0 + (np.arange(shape[1]) - 1) * FRAME.width / (shape[1] - 3)
    y = FRAME.y0 + (np.arange(shape[0]) - 1) * FRAME.height / (shape[0] - 3)
    nodes = (x[None, :] + 1j * y[:, None]).ravel()
    free = np.abs(nodes[:, None] - places[None, ::4]).min(1) < ABOUT
    z, n, o = (np.concatenate([part[line.seen] for part, line in zip(parts, lines, strict=True)]) for parts in (
        [line.points for line in lines], [line.normals for line in lines], [line.off for line in lines]))
    here = np.abs(z[:, None] - places[None, ::4]).min(1) < ABOUT
    z, n, o = z[here], n[here], o[here]
    base = spline_base(z, shape)[:, free]
    local = m.local if m.local.size else np.zeros((2, *shape))
    old = local.reshape(2, -1)[:, free].ravel()
    seen = z + n * o
    wanted = np.real(np.conj(n) * (seen + m.correction(seen) - z - m.correction(z)))
    one = np.zeros((np.count_nonzero(free), *shape))
    one.reshape(len(one), -1)[np.arange(len(one)), np.flatnonzero(free)] = 1
    rough = np.concatenate([np.diff(one, 2, axis=k).reshape(len(one), -1) for k in (1, 2)], 1)
    rough = rough[:, rough.any(0)]
    prior = rough @ rough.T / BEND_OF_SPLINE**2 + np.eye(len(one)) / SIZE**2
    prior = np.kron(np.eye(2), prior)
    both = np.hstack((n.real[:, None] * base, n.imag[:, None] * base))
    target = wanted + both @ old
    c = fit(both, target, 1.0, LOCAL_FAR, prior * LOCAL_POINT**2)
    out = local.reshape(2, -1).copy()
    out[:, free] = c.reshape(2, -1)
    return replace(m, local=out.reshape(2, *shape))


def about(places: Points) -> Mask:
    """Where nothing is to be judged, a pixel for each square millimetre, the upper row first."""
    out = np.zeros((round(PAPER.height), round(PAPER.width)), np.uint8)
    out[(PAPER.y1 - places.imag).astype(int).clip(0, len(out) - 1), places.real.astype(int).clip(0, out.shape[1] - 1)] = 1
    return cv2.dilate(out, np.ones((2 * MARGIN + 1, 2 * MARGIN + 1), np.uint8)) > 0


def bulge_notes(path: Path, bulging: Mask) -> Iterator[str]:
    """What is to be said of the places where nothing is judged, a line each."""
    _, _, _, middles = cv2.connectedComponentsWithStats(bulging.astype(np.uint8))
    said = tell("{file}: the paper bulges about x = {x}, y = {y} mm, so what is drawn there is not judged: lay it flat, nothing "
                "beneath it")
    for column, row in middles[1:]:
        yield said.format(file=path.name, x=f"{column:.0f}", y=f"{PAPER.y1 - row:.0f}")


def _bent(e: Element, z: Points, n: Points, o: Floats, known: Any, seen: Any) -> Any:
    """Where a line is off what a hand could have done to it: in part of its length, along one stroke."""
    here = np.zeros(len(z), bool)
    half = max(float(np.abs(z - z.mean()).max()), 1.0)
    raw = similarity_base(z, n, e.centre if e.kind == "circle" else z.mean(), half)
    if e.kind == "line":
        raw[:, 3] = 0.0
    base = Stations(z, n, raw, half).base(seen)
    off = o - base @ fit(base, o, seen, LOOSE)
    if (np.abs(off[seen]) < LOOSE).mean() < STRAIGHT:
        return here
    for sign in (1, -1):
        far = (sign * off > BENT) | ~known
        for a, b in runs(far):
            beside = slice(max(a - BEND, 0), b + BEND)
            if (seen & far)[a:b].sum() >= BEND and seen[beside].sum() >= LARGELY * known[beside].sum():
                here[a:b] |= seen[a:b]
    return here


def _joined(pieces: Any, real: Any) -> Any:
    """The stations of a line from its pieces, of each the middle, where it was followed from both sides."""
    last, quarter = len(pieces) - 1, PIECE // 4
    some = [slice(quarter if k else 0, PIECE - quarter if k < last else PIECE) for k in range(len(pieces))]
    return np.concatenate([row[s][there[s]] for row, there, s in zip(pieces, real, some, strict=True)])


def _pieces(elements: Sequence[Element]) -> tuple[list[tuple[Element, int]], Points, Points, Any]:
    """Lines drawn with a ruler or compasses, and how many pieces each has; of the pieces stations, normals, and which are real."""
    chosen: list[tuple[Element, int]] = []
    p, n, real = [], [], []
    for e in elements:
        if not measurable(e) or e.style == "text" or e.kind == "curve" or e.length < SHORTEST * SAMPLING:
            continue
        z, w = sampled(e.points, SAMPLING)
        starts = range(0, max(len(z) - PIECE // 2, 1), PIECE // 2)
        for first in starts:
            lack = max(first + PIECE - len(z), 0)
            p.append(np.pad(z[first : first + PIECE], (0, lack), mode="edge"))
            n.append(np.pad(w[first : first + PIECE], (0, lack), mode="edge"))
            real.append(np.arange(PIECE) < PIECE - lack)
        chosen.append((e, len(starts)))
    none = np.zeros((0, PIECE), complex)
    return (chosen, np.stack(p), np.stack(n), np.stack(real)) if chosen else (chosen, none, none, none.real > 0)
