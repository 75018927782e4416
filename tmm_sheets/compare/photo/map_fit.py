"""Fitting the map of a sheet to lines seen in the picture, by least squares of the distances across the lines.

A single line is easily taken for its neighbour, one of several concentric circles for the next one. All lines of a patch together
fit in one place only; so a patch tells where the sheet is, and that what was taken for a side of the frame is none.

"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import cv2
import numpy as np

from tmm_sheets.compare.photo.profiles import LARGELY, ProfileLines, fit, pixels
from tmm_sheets.compare.photo.sheet_map import AWAY, CORNERS, DEGREE, FRAME, PAPER, WAVES, Floats, Map, heights, projected, waves
from tmm_sheets.drawing.marks import Points

USUAL = 0.015
"""Weight of the priors below: as many mm off at every point cost as much as one parameter off by its usual size."""
LENS = np.array([0.05, 0.03])
"""Usual distortion coefficients."""
HEIGHT = {2: 4.0, 3: 2.0, 4: 1.0, 5: 0.6, 6: 0.4}
"""Usual height of the paper in a term of each degree, mm."""
FOCUS, FOOT = 1.2, 40.0
"""Usual focal length of a telephone, half diagonals of its picture, and error of the camera's foot found by it, mm."""
ANYWHERE = 400.0
"""Usual distance of the foot from the middle of the sheet, mm, where nothing tells of it."""
PARALLEL, CENTRAL = 1.0, 10.0
"""Degrees between the sides of the sheet and those of the picture, and mm between their middles, up to which a picture was made a
rectangle, by an app or a scanner."""
STEPS = 12
SIDE = 3.0
"""Points of the frame count little beyond this distance, mm; they are seldom wrong."""
LEAST_SIDE = 0.25
"""Least share of a side's points that determine how it bends."""
ASTRAY = 1.0
"""Distance, mm, and twice that from which on lines count little, beyond which what was taken for a side is none."""
TAME = 0.02
"""Weight of the prior for an unbent side where its points are hidden, relative to that of all points."""
UNSEEN = 0.3
"""How much a hidden point counts, as one where the side is not bent beside what the lines inside tell, relative to a seen one."""
RIDGE = 0.01
"""Damping of a wave over the whole sheet, relative to its effect on all points."""


class Seen(NamedTuple):
    """Points of lines: where they were seen, pixels, and where they lie on the sheet, mm; unit normals of the lines; weights."""

    picture: Points
    sheet: Points
    normals: Points
    weight: Floats


def fit_map(m: Map, sides: Seen, other: Seen | None = None, degree: int = 0, loose: float | None = None) -> tuple[Map, float]:
    """Fit a map to the sides of the frame and to other lines.

    Homography, lens and relief are fitted together; what is left of each side becomes a polynomial of its own.

    Parameters
    ----------
    m
        Where to start.
    sides
        Points of the frame, bottom side first.
    other
        Points of lines inside.
    degree
        Highest degree of the relief; below 2 the paper is taken for flat.
    loose
        Distance from which on other lines count little, mm; None: three robust standard deviations.

    Returns
    -------
    The map and the scatter of the frame's points about it, mm, of the worst side.
    """
    seen = sides if other is None else Seen(*(np.concatenate(pair) for pair in zip(sides, other, strict=True)))
    of_sides = np.arange(len(seen.weight)) < len(sides.weight)
    m = _fit_base(m, seen, degree, None if loose is None else np.where(of_sides, SIDE, loose))
    r = np.real(np.conj(sides.normals) * (m.to_base(sides.picture) - sides.sheet - m.risen(sides.sheet)))
    p, use = sides.sheet, sides.weight > 0
    if loose is not None:  # lines inside know better than what was taken for a side
        use = use & (np.abs(r) < ASTRAY + 2 * loose)
    polynomials, scatter = np.zeros_like(m.sides), []
    for k, (mine, along) in enumerate((
        (p.imag == FRAME.y0, p.real), (p.real == FRAME.x1, p.imag), (p.imag == FRAME.y1, p.real), (p.real == FRAME.x0, p.imag),
    )):  # fmt: skip
        t = (along[mine] - FRAME.x0) / FRAME.width if k % 2 == 0 else (along[mine] - FRAME.y0) / FRAME.height
        if use[mine].sum() > LEAST_SIDE * mine.sum():
            polynomials[k], sigma = fit_side(t, r[mine], use[mine], m.sides.shape[1] - 1)
            scatter.append(sigma)
    return replace(m, sides=polynomials), float(max(scatter, default=np.inf))


def fit_side(t: Floats, r: Floats, use: Any, degree: int) -> tuple[Floats, float]:
    """Chebyshev coefficients of the residuals ``r`` along a side (t from 0 to 1), and their robust scatter, mm."""
    base = np.polynomial.chebyshev.chebvander(2 * t - 1, degree)
    w, rank = use.astype(float), np.arange(degree + 1) / degree
    # A polynomial runs away beyond the points that it is fitted to.
    tame = np.vstack((TAME * np.sqrt(len(t)) * np.diag(rank), UNSEEN * base[~use]))
    still = np.zeros(len(tame))
    for _ in range(8):
        c = np.linalg.lstsq(np.vstack((base * w[:, None], tame)), np.append(r * w, still), rcond=None)[0]
        d = r - base @ c
        sigma = max(1.4826 * float(np.median(np.abs(d[use]))), 0.03)
        w = use / (1 + (d / (2 * sigma)) ** 2)
    return np.asarray(c), sigma


def fit_waves(m: Map, seen: Seen, loose: float) -> Map:
    """A map whose waves follow the residual of lines inside the frame; the shorter a wave, the more it is damped."""
    x, y = waves(seen.sheet)
    base = np.concatenate((x * seen.normals.real[:, None], y * seen.normals.imag[:, None]), 1)
    plain = replace(m, waves=np.zeros_like(m.waves))
    r = np.real(np.conj(seen.normals) * (m.to_base(seen.picture) - seen.sheet - plain.correction(seen.sheet)))
    i, j = np.indices((WAVES, WAVES)) + 1
    rank = np.tile(np.maximum(i, j).ravel(), 2)
    ridge = (seen.weight > 0).sum() * (RIDGE * rank**1.5) ** 2
    return replace(m, waves=fit(base, r, seen.weight**2, loose, ridge))


def _fit_base(m: Map, seen: Seen, degree: int, loose: Floats | None) -> Map:
    """Homography, lens and relief by Levenberg-Marquardt steps with Geman-McClure weights."""
    active = degree >= DEGREE
    z = heights(seen.sheet, degree)
    first = np.concatenate(((m.matrix / m.matrix[2, 2]).ravel()[:8], m.bend))
    size = np.append(np.maximum(np.abs(first[:8]), 1e-2), (0.05, 0.05)) * 1e-4
    # Paper does not bend the way a lens does: weak priors keep either from imitating the other.
    foot, error = camera_foot(m)
    # From flat paper: what a former fit has bent to suit wrong places is seldom bent back.
    x = np.concatenate((first, np.zeros(active.sum()), (foot.real, foot.imag)))
    usual = np.concatenate((np.full(8, np.inf), LENS, [HEIGHT[int(d)] for d in DEGREE[active]], (error, error)))
    middle = np.concatenate((np.zeros(10 + active.sum()), (foot.real, foot.imag)))
    prior = USUAL / usual * np.sqrt((seen.weight**2).sum())
    q, n = (seen.picture - m.middle) / m.reach, np.conj(seen.normals)

    def residual(x: Floats) -> tuple[Floats, Floats, Floats]:
        here, slopes = lens_and_homography(x[:10], q, n)
        height = np.einsum("nk,k->n", z, x[10:-2])
        return slopes, height, here - np.real(n * (seen.sheet + height * (seen.sheet - complex(*x[-2:])) / AWAY))

    def cost(x: Floats, r: Floats, far: float | Floats) -> float:
        return float((seen.weight**2 * r**2 / (1 + (r / far) ** 2)).sum() + ((prior * (x - middle)) ** 2).sum())

    slopes, height, r = residual(x)
    damping = 1e-9
    for _ in range(STEPS):
        away = seen.sheet - complex(*x[-2:])
        jacobian = np.hstack((
            slopes,
            -np.real(n * away)[:, None] * z / AWAY,
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
            slopes, height, r = residual(x + change)
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


def lens_and_homography(x: Floats, q: Points, n: Points) -> tuple[Floats, Floats]:
    """Where they take points of a normalized picture, along normals, mm, and by how much each parameter moves that, (n, 10).

    ``x`` are the homography's eight and the lens's two parameters, ``n`` the conjugates of the normals.
    """
    r2 = np.abs(q) ** 2
    u = q * (1 + x[8] * r2 + x[9] * r2**2)
    w = x[6] * u.real + x[7] * u.imag + 1
    p = (complex(x[0], x[3]) * u.real + complex(x[1], x[4]) * u.imag + complex(x[2], x[5])) / w
    share = np.stack((u.real, u.imag, np.ones(len(q)))) / w
    along, up = ((complex(x[k], x[3 + k]) - x[6 + k] * p) / w for k in (0, 1))
    bent = np.real(n * (along * q.real + up * q.imag)) * np.stack((r2, r2**2))
    here = np.real(n * p)
    return here, np.concatenate((n.real * share, -n.imag * share, -here * share[:2], bent)).T


def camera_foot(m: Map) -> tuple[complex, float]:
    """The point of the sheet below the camera, by the perspective of a map, and its usual error, mm.

    A picture that was made a rectangle shows no perspective: it was taken from anywhere.
    """
    corners = projected(np.linalg.inv(m.matrix), CORNERS)
    sides = np.angle(np.roll(corners, -1) - corners, deg=True)
    aside = abs(complex(m.to_base(np.array([m.middle]))[0]) - PAPER.centre)
    if np.abs((sides + 45) % 90 - 45).max() < PARALLEL and aside < CENTRAL:
        return PAPER.centre, ANYWHERE
    first, second, away = _camera(m)
    return complex(-first @ away, -second @ away), FOOT


def camera_height(m: Map) -> float:
    """How far above the sheet the camera was by the size of the picture, mm."""
    first, second, away = _camera(m)
    return float(abs(np.cross(first, second) @ away))


def _camera(m: Map) -> Floats:
    """The directions of the sheet's axes, and its origin, mm, as the camera has them."""
    g = np.linalg.inv(m.matrix) / np.array([[FOCUS], [FOCUS], [1.0]])
    return np.asarray((g / np.linalg.norm(g[:, 0])).T)


SIZE = 90.0
"""Side of a patch, mm; one is half of it from the next."""
SCALE = 2.0
"""Pixels per mm in which patches are laid over the picture."""
REACH = 6.0
"""Largest shift of a patch, mm."""
SOFT = 0.6
"""Standard deviation, mm, by which lines are blurred: within a patch they are not all off by the same."""
LIKE = 0.35
"""Least correlation of a patch with the picture."""
ELSEWHERE = 1.5  # mm; a patch tells nothing when it correlates nearly as well farther from its best place
LEAST = 60.0
"""mm of lines in a patch that tells where it is."""


def patches(m: Map, straight: Map, ink: Any, lines: ProfileLines, scale: float, size: float = SIZE) -> Seen:
    """Where patches are seen, as points with normals in x and in y.

    Parameters
    ----------
    m
        The map to be corrected.
    straight, ink, scale
        The picture of ``scale`` pixels per mm that another map straightened, and that map.
    lines
        Where lines are on the sheet.
    size
        Side of a patch, mm; they overlap by half of it.
    """
    at = straight.to_sheet(m.to_picture(lines.points))
    shrunk = cv2.resize(ink, None, fx=SCALE / scale, fy=SCALE / scale, interpolation=cv2.INTER_AREA)
    seen = _blurred(np.minimum(shrunk, 2 * max(float(np.percentile(shrunk, 90)), 10.0)))
    drawn = np.zeros(shrunk.shape, np.uint8)
    where = np.rint(pixels(at, SCALE).view(np.float64).reshape(-1, 2)).astype(np.int32)
    for one in np.split(where, np.flatnonzero(np.diff(lines.line)) + 1):
        cv2.polylines(drawn, [one], False, 255, 1, cv2.LINE_AA)
    wanted = _blurred(drawn)
    reach, half = round(REACH * SCALE), round(size / 2 * SCALE)
    seen = cv2.copyMakeBorder(seen, reach, reach, reach, reach, cv2.BORDER_CONSTANT, value=0.0)
    places: list[complex] = []
    shifts: list[complex] = []
    for x in np.arange(FRAME.x0 + size / 2, FRAME.x1 - size / 2 + size / 2, size / 2):
        for y in np.arange(FRAME.y0 + size / 2, FRAME.y1 - size / 2 + size / 2, size / 2):
            column, row = round(x * SCALE), round((PAPER.y1 - y) * SCALE)
            left, top = max(column - half, 0), max(row - half, 0)
            if drawn[top : row + half, left : column + half].sum(dtype=np.int64) < 255 * LEAST * SCALE:
                continue
            piece = wanted[top : row + half, left : column + half]
            around = seen[top : top + piece.shape[0] + 2 * reach, left : left + piece.shape[1] + 2 * reach]
            if (shift := _shift(cv2.matchTemplate(around, piece, cv2.TM_CCOEFF_NORMED))) is not None:
                places.append(complex(x, y))
                shifts.append(shift)
    p = np.array(places, complex)
    picture = straight.to_picture(straight.to_sheet(m.to_picture(p)) + np.array(shifts, complex)) if places else p
    return Seen(np.tile(picture, 2), np.tile(p, 2), np.repeat([1 + 0j, 1j], len(p)), np.ones(2 * len(p)))


def _blurred(picture: Any) -> Any:
    return cv2.GaussianBlur(picture.astype(np.float32), (0, 0), SOFT * SCALE)


def _shift(score: Any) -> complex | None:
    """The shift of the best score, mm; None when it is poor, at the rim, or hardly better than another."""
    row, column = np.unravel_index(int(score.argmax()), score.shape)
    best = float(score[row, column])
    middle = score.shape[0] // 2
    if best < LIKE or not (0 < row < 2 * middle and 0 < column < 2 * middle):
        return None
    y, x = np.ogrid[: score.shape[0], : score.shape[1]]
    far = np.hypot(y - row, x - column) > ELSEWHERE * SCALE
    if float(score[far].max()) > LARGELY * best:
        return None
    return complex(column - middle, middle - row) / SCALE
