"""Paper that is not smooth: waves, creases, what lies beneath it.

Its height is a cubic B-spline over the sheet, with a prior against bending, so that single lines do not lift it; where it is
steep, it also is shorter by as much as paper is that keeps its length, and what that leaves a coarser spline takes up in the plane.
Everything is fitted together with the homography, the lens and the camera's foot.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from tmm_sheets.compare.photo.map_fit import LENS, Seen, camera_foot, camera_height, lens_and_homography
from tmm_sheets.compare.photo.sheet_map import AWAY, FRAME, Floats, Map, drawn_in, spline_nodes

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
