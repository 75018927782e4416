"""Photographs of sheets drawn by hand, made up: what stood where is known exactly.

A drawing is traced with a pencil (ends that miss, lines that waver, pressure that varies, dashes set by eye), errors are planted,
the paper curls, a camera with a distorting lens looks at it from aside in bad light, and the picture is stored as a JPEG. Nothing
but the display list is shared with the program that reads the picture.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import cv2
import numpy as np

from tmm_sheets.drawing.ink import letters
from tmm_sheets.drawing.marks import Arc, Drawing, Fill, Line, Mark, Polyline, Text, flat
from tmm_sheets.drawing.styles import line_type

RASTER = 10.0  # pixels per millimetre of the paper before it is photographed
FIXED = 16  # fractional steps cv2 draws with
KINDS = ("moved", "turned", "size", "missing", "extra")
PLANT_SCALE = 4.0  # pixels per millimetre in which it is seen whether marks cover one another


@dataclass(frozen=True)
class Planted:
    """An error put into the drawing: of which mark (None: an extra line), how large, where it ought to be and is drawn, mm."""

    kind: str
    mark: int | None
    size: float
    ought: Any
    drawn: Any


@dataclass(frozen=True)
class Camera:
    """What goes wrong between paper and file; the defaults are a fair photograph."""

    megapixels: float = 12.0
    fill: float = 0.9  # share of the picture's width the sheet takes
    tilt: float = 0.15  # rad the camera leans away from straight down
    turn: float = 0.0  # rad about its own axis
    azimuth: float = 0.5  # rad, direction it leans to
    distance: float = 1100.0  # mm
    k1: float = -0.02
    k2: float = 0.0
    curl: float = 3.0  # mm the paper rises
    fold: float = 0.4  # rad, direction in which it curls
    waves: tuple[float, ...] = (1.0, 0.3, 0.1)
    shade: float = 0.3
    vignette: float = 0.2
    blur: float = 0.6  # pixels
    noise: float = 3.0  # grey levels
    quality: int = 88
    paper: float = 215.0
    desk: float = 120.0
    quarter: int = 0  # turns by 90 degrees of the stored picture
    mirrored: bool = False


@dataclass
class Shot:
    """A photograph: the file's bytes, the place in the picture of points of the sheet, what was planted."""

    data: bytes
    place: Any  # complex mm -> complex pixels
    planted: list[Planted] = field(default_factory=list)


def random_camera(rng: Any) -> Camera:
    """A camera in the hand of a student."""
    return Camera(
        megapixels=rng.uniform(8, 20), fill=rng.uniform(0.82, 0.96), tilt=rng.uniform(0, 0.25), turn=rng.normal(0, 0.02),
        azimuth=rng.uniform(0, 2 * np.pi), distance=rng.uniform(900, 1500),
        k1=rng.uniform(-0.06, 0.04), k2=rng.uniform(-0.01, 0.01),
        curl=rng.uniform(0, 6), fold=rng.uniform(0, np.pi), waves=(1.0, *rng.normal(0, (0.3, 0.1))), shade=rng.uniform(0.1, 0.5),
        vignette=rng.uniform(0, 0.35), blur=rng.uniform(0.4, 1.0), noise=rng.uniform(1.5, 5), quality=int(rng.integers(75, 95)),
        paper=rng.uniform(190, 235), desk=rng.choice([60.0, 110.0, 150.0, 180.0]),
    )  # fmt: skip


# --- the pencil --------------------------------------------------------------------------------------------------------


def _waver(rng: Any, n: int, step: float, size: float) -> Any:
    """Smooth noise along a line: wave lengths of some 40 mm."""
    knots = max(int(n * step / 20) + 3, 4)
    rough = rng.normal(0, size, knots)
    smooth = np.convolve(np.pad(rough, 1, "edge"), (0.25, 0.5, 0.25), "valid")
    return np.interp(np.linspace(0, knots - 1, n), np.arange(knots), smooth)


def resample(points: Any, step: float = 1.0) -> Any:
    """Points at most ``step`` mm apart along a polyline, its corners kept roughly."""
    measure = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(points)))))
    n = max(int(np.ceil(measure[-1] / step)), 1)
    at = np.linspace(0, measure[-1], n + 1)
    return np.interp(at, measure, points.real) + 1j * np.interp(at, measure, points.imag)


def trace(mark: Mark, rng: Any, pencil: float) -> Any:
    """A mark as the hand draws it: points about a millimetre apart; ``pencil`` is the error of a point set with it, mm."""
    jitter = pencil * complex(*rng.normal(0, 1, 2).clip(-1.6, 1.6))
    other = pencil * complex(*rng.normal(0, 1, 2).clip(-1.6, 1.6))
    if isinstance(mark, Line):
        p = resample(np.array([mark.a + jitter, mark.b + other]))
        u = (mark.b - mark.a) / max(abs(mark.b - mark.a), 1e-9)
        return p + 1j * u * _waver(rng, len(p), 1.0, 0.2 * pencil)
    if isinstance(mark, Arc):
        # Compasses: a good circle round a centre that is missed, with a radius that is missed.
        r = mark.radius + 0.5 * other.real
        slip = rng.normal(0, 0.5 * pencil / max(mark.radius, 1.0), 2) if mark.end - mark.start < 6.28 else (0.0, 0.0)
        n = max(int(np.ceil((mark.end - mark.start) * mark.radius)), 12)
        return mark.centre + 0.6 * jitter + r * np.exp(1j * np.linspace(mark.start + slip[0], mark.end + slip[1], n + 1))
    points = flat(mark)
    p = resample(points, 1.0) if not isinstance(mark, Fill) else points
    middle = p.mean()
    p = p + 0.7 * jitter + (p - middle) * 0.5 * other / max(np.abs(p - middle).max(), 5.0)
    if isinstance(mark, Polyline) and len(p) > 4:
        p = p + _waver(rng, len(p), 1.0, 0.3 * pencil) + 1j * _waver(rng, len(p), 1.0, 0.3 * pencil)
        if mark.closed:
            p[-1] = p[0]
    return p


def _dashed(points: Any, pattern: tuple[float, ...], rng: Any) -> list[Any]:
    """Strokes of a patterned line by eye."""
    measure = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(points)))))
    out, at = [], 0.0
    while at < measure[-1]:
        for step in pattern:
            end = min(at + abs(step) * rng.uniform(0.8, 1.2), measure[-1])
            if step > 0 and end - at > 0.2:
                t = np.linspace(at, end, max(int(end - at), 1) + 1)
                out.append(np.interp(t, measure, points.real) + 1j * np.interp(t, measure, points.imag))
            at = end
    return out


# --- planted errors ----------------------------------------------------------------------------------------------------


def _raster(lines: list[Any], drawing: Drawing, scale: float, thick: int) -> Any:
    out = np.zeros((int(drawing.height * scale), int(drawing.width * scale)), np.uint8)
    for p in lines:
        xy = np.column_stack((p.real, drawing.height - p.imag)) * scale
        cv2.polylines(out, [np.round(xy * FIXED).astype(np.int32)], False, 255, thick, cv2.LINE_8, 4)
    return out


def _covered(points: Any, others: Any, drawing: Drawing, scale: float) -> float:
    """Share of a line that lies on a raster of other lines."""
    p = resample(points, 0.7)
    x = np.clip((p.real * scale).astype(int), 0, others.shape[1] - 1)
    y = np.clip(((drawing.height - p.imag) * scale).astype(int), 0, others.shape[0] - 1)
    return float((others[y, x] > 0).mean())


def plant(
    drawing: Drawing, rng: Any, count: int, kinds: tuple[str, ...] = KINDS,
) -> tuple[dict[int, Mark | None], list[Planted], list[Mark]]:
    """Errors for a drawing: marks to be drawn otherwise (None: not at all), what they are, marks too many.

    Marks that another line covers are left alone, and none is moved onto another line: nobody could see that.
    """
    changed: dict[int, Mark | None] = {}
    planted: list[Planted] = []
    extra: list[Mark] = []
    marks = drawing.marks
    able = [i for i, m in enumerate(marks) if isinstance(m, Line | Arc | Polyline) and m.of != "title block"
            and m.style not in ("text", "hatch") and np.abs(np.diff(flat(m))).sum() > 10]  # fmt: skip
    for _ in range(200):
        if len(planted) >= count:
            break
        kind = str(rng.choice(kinds))
        size = float(rng.uniform(1, 5))
        if kind == "extra":
            if (line := _extra_line(drawing, rng)) is not None:
                extra.append(line)
                planted.append(Planted(kind, None, abs(line.b - line.a), None, flat(line)))
            continue
        i = int(rng.choice(able))
        mark = marks[i]
        if i in changed:
            continue
        turn = rng.uniform(0, 2 * np.pi)
        new = None if kind == "missing" else _wrong(mark, kind, size, turn, rng)
        if new is mark or not _visible(drawing, i, new):
            continue
        changed[i] = new
        changed |= _head_of(drawing, i, new)
        if kind == "missing":
            size = float(np.abs(np.diff(flat(mark))).sum())
        planted.append(Planted(kind, i, size, flat(mark), flat(new) if new else None))
    return changed, planted, extra


def _extra_line(drawing: Drawing, rng: Any) -> Line | None:
    """A line somewhere on the sheet, None when it is too near to the frame or to what is drawn."""
    length, turn = rng.uniform(15, 60), rng.uniform(0, 2 * np.pi)
    a = complex(rng.uniform(30, 826), rng.uniform(70, 580))
    b = a + length * np.exp(1j * turn)
    if not (25 < b.real < 831 and 65 < b.imag < 584):
        return None
    line = Line(a, b, str(rng.choice(["thin", "main", "vector"])), "extra")
    drawn = [flat(m) for m in drawing.marks if not isinstance(m, Text)]
    drawn += [p for m in drawing.marks if isinstance(m, Text) for p in letters(m)]
    near = _raster(drawn, drawing, PLANT_SCALE, 24)
    return None if _covered(flat(line), near, drawing, PLANT_SCALE) > 0.3 else line


def _wrong(mark: Mark, kind: str, size: float, turn: float, rng: Any) -> Mark:
    """A mark moved, turned or of another size by ``size`` mm; the mark itself when that would not show."""
    if isinstance(mark, Line):
        return _wrong_line(mark, kind, size, rng)
    if isinstance(mark, Arc):
        if kind == "moved" and mark.end - mark.start > 2:
            return mark._replace(centre=mark.centre + size * np.exp(1j * turn))
        if kind == "size" and mark.radius > 3 * size:
            return mark._replace(radius=mark.radius + size * rng.choice([-1, 1]))
        return mark
    assert isinstance(mark, Polyline)
    p = np.asarray(mark.points)
    span = np.abs(p - p.mean()).max()
    if kind == "moved":
        return mark._replace(points=p + size * np.exp(1j * turn))
    if kind == "turned" and np.ptp(p.imag) > 15:
        return mark._replace(points=p.mean() + (p - p.mean()) * np.exp(1j * size / span * rng.choice([-1, 1])))
    if kind == "size":
        return mark._replace(points=p.mean() + (p - p.mean()) * (1 + size / span * rng.choice([-1, 1])))
    return mark


def _wrong_line(mark: Line, kind: str, size: float, rng: Any) -> Line:
    u = (mark.b - mark.a) / abs(mark.b - mark.a)
    sign = rng.choice([-1, 1])
    if kind == "moved":
        return mark._replace(a=mark.a + sign * 1j * u * size, b=mark.b + sign * 1j * u * size)
    if kind == "turned":
        return mark._replace(b=mark.a + (mark.b - mark.a) * np.exp(1j * sign * size / abs(mark.b - mark.a)))
    return mark._replace(b=mark.b + sign * u * size)


def _visible(drawing: Drawing, i: int, new: Mark | None) -> bool:
    """Whether mark ``i``, and what is drawn for it, lie mostly free of other marks."""
    marks = drawing.marks
    drawn = [flat(m) for j, m in enumerate(marks) if j != i and not isinstance(m, Text | Fill)]
    others = _raster(drawn, drawing, PLANT_SCALE, 5)
    return all(_covered(flat(m), others, drawing, PLANT_SCALE) <= 0.35 for m in (marks[i], new) if m is not None)


def _head_of(drawing: Drawing, i: int, new: Mark | None) -> dict[int, Mark | None]:
    """The head of an arrow goes with its shaft, mark ``i``."""
    mark = drawing.marks[i]
    head = drawing.marks[i + 1] if i + 1 < len(drawing.marks) else None
    if not (isinstance(mark, Line) and isinstance(head, Fill) and np.abs(head.points - mark.b).min() < 2):
        return {}
    if not isinstance(new, Line):
        return {i + 1: None}
    spin = (new.b - new.a) / (mark.b - mark.a)
    return {i + 1: head._replace(points=new.b + (np.asarray(head.points) - mark.b) * spin / abs(spin))}


# --- paper and camera --------------------------------------------------------------------------------------------------


def paper(
    drawing: Drawing, rng: Any, pencil: float = 0.12, changed: dict[int, Mark | None] | None = None,
    extra: list[Mark] | None = None, scale: float = RASTER,
) -> Any:
    """The drawing traced by hand: 255 for black, 0 for bare paper, ``scale`` pixels per mm."""
    out = np.zeros((round(drawing.height * scale), round(drawing.width * scale)), np.uint8)
    strokes: list[tuple[float, Any, bool, float]] = []
    for i, m in enumerate([*drawing.marks, *(extra or [])]):
        mark = (changed or {}).get(i, m)
        if mark is None:
            continue
        dark = rng.uniform(0.6, 1.0)
        if isinstance(mark, Text):
            off = 2 * pencil * complex(*rng.normal(0, 1, 2))
            strokes += [(0.1 * mark.height, p + off, False, dark) for p in letters(mark)]
        elif isinstance(mark, Fill):
            strokes.append((0.1, trace(mark, rng, pencil / 2), True, dark))
        else:
            kind = line_type(mark.style)
            width = kind.width * rng.uniform(0.8, 1.25)
            exact = mark.of == "title block"  # printed, or drawn with more care
            p = trace(mark, rng, 0.3 * pencil if exact else pencil)
            strokes += [(width, q, False, dark) for q in (_dashed(p, kind.pattern, rng) if kind.pattern else [p])]
    strokes.sort(key=lambda s: s[0])
    for width, p, filled, dark in strokes:
        xy = np.column_stack((p.real * scale - 0.5, (drawing.height - p.imag) * scale - 0.5))
        fixed = np.round(xy * FIXED).astype(np.int32)
        if filled:
            cv2.fillPoly(out, [fixed], int(255 * dark), cv2.LINE_AA, 4)
        else:
            cv2.polylines(out, [fixed], False, int(255 * dark), max(round(width * scale), 1), cv2.LINE_AA, 4)
    return out


def _profile(camera: Camera, width: float, height: float) -> Any:
    """(along, height above the desk, foreshortened way) of the curled paper across the direction of its fold."""
    reach = 0.5 * abs(complex(width, height))
    t = np.linspace(-3 * reach, 3 * reach, 6001)
    z = sum(w * np.cos((k + 1) * np.pi * t / reach + 0.7 * k * k) for k, w in enumerate(camera.waves))
    z = z - z.min()
    z *= camera.curl / max(z.max(), 1e-9)
    slope = np.gradient(z, t)
    way = np.cumsum(np.sqrt(np.clip(1 - slope**2, 0, 1))) * (t[1] - t[0])
    return t, z, way - np.interp(0.0, t, way)


def projection(camera: Camera, width: float, height: float) -> tuple[Any, tuple[int, int]]:
    """Function from the sheet (complex mm) to the picture (complex pixels), and the picture's width and height."""
    columns = round(np.sqrt(camera.megapixels * 1e6 * 4 / 3))
    rows = round(columns * 3 / 4)
    t, z, way = _profile(camera, width, height)
    fold = np.exp(1j * camera.fold)
    back = complex(np.sin(camera.tilt) * np.cos(camera.azimuth), np.sin(camera.tilt) * np.sin(camera.azimuth))
    eye = camera.distance * np.array([back.real, back.imag, np.cos(camera.tilt)])
    look = -eye / np.linalg.norm(eye)
    right = np.cross(look, [0.0, 1.0, 0.0])
    right /= np.linalg.norm(right)
    down = np.cross(look, right)
    c, s = np.cos(camera.turn), np.sin(camera.turn)

    def rays(p: Any) -> Any:
        q = (np.asarray(p) - complex(width / 2, height / 2)) * fold.conjugate()
        flat_ = (np.interp(q.real, t, way) + 1j * q.imag) * fold
        world = np.stack((flat_.real, flat_.imag, np.interp(q.real, t, z)), -1) - eye
        x, y, d = world @ right, world @ down, world @ look
        ray = x / d + 1j * y / d
        ray = ray * complex(c, s)
        return ray

    corners = rays(np.array([0, width, width + 1j * height, 1j * height]))
    size = np.abs(corners).max()

    def bent(p: Any) -> Any:
        ray = rays(p) / size
        r2 = np.abs(ray) ** 2
        return ray * (1 + camera.k1 * r2 + camera.k2 * r2**2)

    u, v = np.meshgrid([0, width / 2, width], [0, height / 2, height])
    b = bent((u + 1j * v).ravel())
    zoom = min(columns * camera.fill / np.ptp(b.real), rows * min(camera.fill + 0.02, 0.98) / np.ptp(b.imag))
    middle = complex((b.real.min() + b.real.max()) / 2, (b.imag.min() + b.imag.max()) / 2)

    def place(p: Any) -> Any:
        return (bent(p) - middle) * zoom + complex(columns / 2, rows / 2)

    return place, (columns, rows)


def _inverse(place: Any, size: tuple[int, int], width: float, height: float, step: int = 12) -> tuple[Any, Any]:
    """Sheet coordinates of every pixel as two float32 pictures, by Newton's method on a coarse grid."""
    columns, rows = size
    gx, gy = np.meshgrid(np.arange(0, columns + 2 * step, step), np.arange(0, rows + 2 * step, step))
    want = gx + 1j * gy
    # Start: the affine map of the four corners.
    known = np.array([0, width, width + 1j * height, 1j * height])
    seen = place(known)
    a = np.column_stack((seen.real, seen.imag, np.ones(4)))
    fit = np.linalg.lstsq(a, known, rcond=None)[0]
    p = fit[0] * want.real + fit[1] * want.imag + fit[2]
    for _ in range(12):
        f = place(p)
        h = 0.5
        fx, fy = (place(p + h) - f) / h, (place(p + 1j * h) - f) / h
        det = fx.real * fy.imag - fx.imag * fy.real
        e = want - f
        p = p + ((e.real * fy.imag - e.imag * fy.real) + 1j * (fx.real * e.imag - fx.imag * e.real)) / det
    out = []
    for part in (p.real, p.imag):
        # Not by cv2: it rounds to a 32nd of a step.
        wide = np.stack([np.interp(np.arange(columns), gx[0], row) for row in part]).astype(np.float32)
        k = np.arange(rows) // step
        t = ((np.arange(rows) - k * step) / step).astype(np.float32)[:, None]
        out.append(wide[k] * (1 - t) + wide[k + 1] * t)
    return out[0], out[1]


def photograph(ink: Any, drawing: Drawing, camera: Camera, rng: Any, scale: float = RASTER) -> Shot:
    """Photograph a sheet: ``ink`` as :func:`paper` makes it."""
    width, height = drawing.width, drawing.height
    place, (columns, rows) = projection(camera, width, height)
    x, y = _inverse(place, (columns, rows), width, height)
    finest = abs(place(np.array(width / 2 + 1 + 1j * height / 2)) - place(np.array(width / 2 + 1j * height / 2)))  # pixels per mm
    soft = cv2.GaussianBlur(ink, (0, 0), max(0.4 * scale / finest, 0.3))
    seen = cv2.remap(soft, x * scale - 0.5, (height - y) * scale - 0.5, cv2.INTER_LINEAR,
                     borderMode=cv2.BORDER_CONSTANT, borderValue=0)  # fmt: skip
    inside = ((x > 0) & (x < width) & (y > 0) & (y < height)).astype(np.float32)
    inside = cv2.GaussianBlur(inside, (0, 0), 0.7)
    del x, y
    # Light: a slope, a broad shadow, the lens.
    u, v = np.meshgrid(np.linspace(-1, 1, columns // 8, dtype=np.float32), np.linspace(-1, 1, rows // 8, dtype=np.float32))
    a, b, c, d = rng.normal(0, 1, 4)
    light = 1 + camera.shade * (0.35 * (a * u + b * v) / 2 - 0.5 / (1 + np.exp(-(c * u + d * v - 0.3) * 6)))
    light *= 1 - camera.vignette * (u**2 + v**2) / 2
    light = cv2.resize(light.astype(np.float32), (columns, rows), interpolation=cv2.INTER_LINEAR)
    grain = cv2.resize(rng.normal(0, 1, (rows // 3, columns // 3)).astype(np.float32), (columns, rows))
    # Pencil is not black and catches the grain of the paper.
    dark = np.float32(camera.paper) * (1 + np.float32(0.008) * grain)
    dark *= 1 - np.float32(0.72 / 255) * seen * (1 + np.float32(0.12) * grain)
    wood = np.float32(camera.desk) * (1 + np.float32(0.1) * grain)
    wood += inside * (dark - wood)
    wood *= light
    picture = cv2.GaussianBlur(wood, (0, 0), camera.blur)
    picture += camera.noise * rng.standard_normal(picture.shape, dtype=np.float32)
    grey = cv2.convertScaleAbs(np.maximum(picture, 0))
    if camera.mirrored:
        grey = np.ascontiguousarray(grey[:, ::-1])
    grey = np.ascontiguousarray(np.rot90(grey, camera.quarter))
    ok, data = cv2.imencode(".jpg", grey, [cv2.IMWRITE_JPEG_QUALITY, camera.quality])
    assert ok

    def turned(p: Any) -> Any:
        q = place(p)
        if camera.mirrored:
            q = columns - 1 - q.real + 1j * q.imag
        for i in range(camera.quarter % 4):
            wide = columns if i % 2 == 0 else rows
            q = q.imag + 1j * (wide - 1 - q.real)
        return q

    return Shot(data.tobytes(), turned)


def shoot(
    drawing: Drawing, seed: int, errors: int = 0, pencil: float = 0.12, kinds: tuple[str, ...] = KINDS, **changes: Any,
) -> Shot:
    """A random photograph of a hand drawing with so many errors; ``changes`` to the camera."""
    rng = np.random.default_rng(seed)
    changed, planted, extra = plant(drawing, rng, errors, kinds)
    camera = replace(random_camera(rng), **changes)
    shot = photograph(paper(drawing, rng, pencil, changed, extra), drawing, camera, rng)
    shot.planted = planted
    return shot
