"""Least squares of a map: where points of lines were seen in the picture, and where they are on the sheet."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from tmm_sheets.compare.photo.sheet_map import AWAY, DEGREE, FRAME, WAVES, Floats, Map, heights, waves
from tmm_sheets.drawing.marks import Points

USUAL = 0.005  # mm by which all points may be off rather than something be as unusual as this:
LENS = np.array([0.05, 0.03])  # coefficients of distortion,
HEIGHT = {2: 4.0, 3: 2.0, 4: 1.0, 5: 0.6, 6: 0.4}  # mm of the paper's height in a term of so high a degree,
STEPS = 12
SIDE = 3.0  # mm beyond which points of the frame count little: they are seldom wrong
RIDGE = 0.01  # of a wave over the whole sheet, by what it does to all points
FOOT = 400.0  # mm from the middle of the sheet to the camera's foot


class Seen(NamedTuple):
    """Where points of lines were seen, pixels, where they are on the sheet, mm, the lines' unit normals, and what each counts."""

    picture: Points
    sheet: Points
    normals: Points
    weight: Floats


def bent(m: Map, sides: Seen, other: Seen | None = None, degree: int = 0, loose: float | None = None) -> tuple[Map, float]:
    """A map fitted to the frame's sides (in order, bottom first) and other lines, and the scatter about the sides, mm.

    Homography, lens, and the paper's height up to ``degree`` by least squares of the distances across the lines, those farther
    than ``loose`` mm off (None: three deviations) counting little; then polynomials of what is left of each side.
    """
    seen = sides if other is None else Seen(*(np.concatenate(pair) for pair in zip(sides, other, strict=True)))
    of_sides = np.arange(len(seen.weight)) < len(sides.weight)
    m = _fitted(m, seen, degree, None if loose is None else np.where(of_sides, SIDE, loose))
    r = np.real(np.conj(sides.normals) * (m.to_base(sides.picture) - sides.sheet - m.risen(sides.sheet)))
    p, use = sides.sheet, sides.weight > 0
    polynomials, left = np.zeros_like(m.sides), []
    for k, (mine, along) in enumerate((
        (p.imag == FRAME.y0, p.real), (p.real == FRAME.x1, p.imag), (p.imag == FRAME.y1, p.real), (p.real == FRAME.x0, p.imag),
    )):  # fmt: skip
        t = (along[mine] - FRAME.x0) / FRAME.width if k % 2 == 0 else (along[mine] - FRAME.y0) / FRAME.height
        base = np.polynomial.chebyshev.chebvander(2 * t - 1, m.sides.shape[1] - 1)
        w = use[mine].astype(float)
        for _ in range(8):
            c = np.linalg.lstsq(base * w[:, None], r[mine] * w, rcond=None)[0]
            d = r[mine] - base @ c
            sigma = max(1.4826 * float(np.median(np.abs(d[use[mine]]))), 0.03)
            w = use[mine] / (1 + (d / (2 * sigma)) ** 2)
        polynomials[k] = c
        left.append(sigma)
    return replace(m, sides=polynomials), float(max(left))


def waved(m: Map, seen: Seen, loose: float) -> Map:
    """A map with what it leaves of lines inside the frame taken up by waves, the less the shorter they are."""
    x, y = waves(seen.sheet)
    base = np.concatenate((x * seen.normals.real[:, None], y * seen.normals.imag[:, None]), 1)
    plain = replace(m, waves=np.zeros_like(m.waves))
    r = np.real(np.conj(seen.normals) * (m.to_base(seen.picture) - seen.sheet - plain.correction(seen.sheet)))
    i, j = np.indices((WAVES, WAVES)) + 1
    rank = np.tile(np.maximum(i, j).ravel(), 2)
    ridge = (seen.weight > 0).sum() * (RIDGE * rank**1.5) ** 2
    c = m.waves
    for _ in range(8):
        w = (seen.weight / (1 + ((r - np.einsum("nk,k->n", base, c)) / loose) ** 2)) ** 2
        weighted = base * w[:, None]
        c = np.linalg.solve(np.einsum("nk,nj->kj", base, weighted) + np.diag(ridge), np.einsum("nk,n->k", weighted, r))
    return replace(m, waves=c)


def _fitted(m: Map, seen: Seen, degree: int, loose: Floats | None) -> Map:
    """Homography, lens and height by Levenberg and Marquardt's steps with Geman and McClure's weights."""
    z, active = heights(seen.sheet), degree >= DEGREE
    first = np.concatenate(((m.matrix / m.matrix[2, 2]).ravel()[:8], m.bend))
    size = np.append(np.maximum(np.abs(first[:8]), 1e-2), (0.05, 0.05)) * 1e-4
    x = np.concatenate((first, m.relief[active], (m.foot.real, m.foot.imag)))
    # Paper bends, and not as a lens does: weak priors keep all modest.
    usual = np.concatenate((np.full(8, np.inf), LENS, [HEIGHT[int(d)] for d in DEGREE[active]], (FOOT, FOOT)))
    middle = np.concatenate((np.zeros(10 + active.sum()), (FRAME.centre.real, FRAME.centre.imag)))
    prior = USUAL / usual * np.sqrt((seen.weight**2).sum())
    n = np.conj(seen.normals)

    def base(x: Floats) -> Floats:
        at = replace(m, matrix=np.append(x[:8], 1.0).reshape(3, 3), bend=(x[8], x[9])).to_base(seen.picture)
        return np.asarray(np.real(n * at))

    def residual(x: Floats) -> tuple[Floats, Floats, Floats]:
        here, height = base(x), np.einsum("nk,k->n", z[:, active], x[10:-2])
        return here, height, here - np.real(n * (seen.sheet + height * (seen.sheet - complex(*x[-2:])) / AWAY))

    def cost(x: Floats, r: Floats, far: float | Floats) -> float:
        return float((seen.weight**2 * r**2 / (1 + (r / far) ** 2)).sum() + ((prior * (x - middle)) ** 2).sum())

    here, height, r = residual(x)
    damping = 1e-9
    for _ in range(STEPS):
        away = seen.sheet - complex(*x[-2:])
        jacobian = np.hstack((
            np.stack([(base(x[:10] + e) - here) / s for e, s in zip(np.diag(size), size, strict=True)], -1),
            -np.real(n * away)[:, None] * z[:, active] / AWAY,
            np.stack((n.real * height, -n.imag * height), -1) / AWAY,
        ))  # fmt: skip
        far = 3 * max(1.4826 * float(np.median(np.abs(r[seen.weight > 0]))), 0.1) if loose is None else loose
        w = seen.weight / (1 + (r / far) ** 2)
        a = np.vstack((jacobian * w[:, None], np.diag(prior)))
        b = np.concatenate((-r * w, -prior * (x - middle)))
        norm = np.maximum(np.linalg.norm(a, axis=0), 1e-12)
        a /= norm
        # einsum: for so small a product the threads of a matrix library cost more than they bring.
        square, down = np.einsum("ni,nj->ij", a, a), np.einsum("ni,n->i", a, b)
        before = cost(x, r, far)
        while damping < 10:
            change = np.linalg.solve(square + damping * np.eye(len(x)), down) / norm
            here, height, r = residual(x + change)
            if cost(x + change, r, far) < before:
                break
            damping *= 30
        else:
            break
        x, damping = x + change, max(damping / 30, 1e-9)
        if np.abs(change[:10] / size).max() < 1e-1:
            break
    relief = np.zeros(len(DEGREE))
    relief[active] = x[10:-2]
    matrix = np.append(x[:8], 1.0).reshape(3, 3)
    return replace(m, matrix=matrix, bend=(float(x[8]), float(x[9])), relief=relief, foot=complex(*x[-2:]))
