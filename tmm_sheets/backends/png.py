"""PNG at any resolution: black on white, 8 bits of grey, anti-aliased, true widths; the size on paper is in the file.

matplotlib's Agg draws band by band, and the bands go into the file one after another: A1 at 600 dots per inch has 279 million
pixels, four bytes each, too many for the memory.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable, Iterator
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.path import Path as AggPath
from matplotlib.transforms import Affine2D

from tmm_sheets.drawing.ink import SAGITTA, InkStroke, ink, polyline_inside
from tmm_sheets.drawing.marks import Box, Drawing, Points

DPI = 150.0
LEAST_DPI, MOST_DPI = 10.0, 1200.0
BAND = 8_000_000  # pixels drawn at a time
INCH = 25.4


def render(drawing: Drawing, dpi: float = DPI) -> bytes:
    """PNG file of a drawing, bytes."""
    chord = min(max(SAGITTA, 0.02 * INCH / max(dpi, LEAST_DPI)), 0.02)
    return picture(drawing.width, drawing.height, ink(drawing.marks, chord), dpi, drawing.title, drawing.author)


def picture(
    width: float, height: float, strokes: Iterable[InkStroke], dpi: float = DPI, title: str = "", author: str = ""
) -> bytes:
    """PNG of strokes on paper of ``width`` x ``height`` mm.

    Raises
    ------
    ValueError
        When ``dpi`` is out of range.
    """
    if not LEAST_DPI <= dpi <= MOST_DPI:
        raise ValueError(f"expected {LEAST_DPI:g} to {MOST_DPI:g} dots per inch, not {dpi:g}")
    columns, rows = round(width / INCH * dpi), round(height / INCH * dpi)
    packer = zlib.compressobj(6)
    data = b"".join(packer.compress(lines) for lines in _filtered(_bands(columns, rows, list(strokes), dpi)))
    per_metre = round(1000 * dpi / INCH)
    words = [(key, text.encode("utf-8")) for key, text in ((b"Title", title), (b"Author", author)) if text]
    chunks = [
        (b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 0, 0, 0, 0)),
        (b"pHYs", struct.pack(">IIB", per_metre, per_metre, 1)),
        *((b"iTXt", key + b"\0\0\0\0\0" + text) for key, text in words),
        (b"IDAT", data + packer.flush()),
        (b"IEND", b""),
    ]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body)) for kind, body in chunks)
def _filtered(bands: Iterable[npt.NDArray[np.uint8]]) -> Iterator[bytes]:
    """Rows as the file wants them, each as its difference from the row above (filter 2): blank paper becomes zeros."""
    above: npt.NDArray[np.uint8] | None = None
    for band in bands:
        if above is None:
            above = np.zeros((1, band.shape[1]), np.uint8)
        lines = np.full((band.shape[0], band.shape[1] + 1), 2, np.uint8)
        lines[:, 1:] = band - np.concatenate((above, band[:-1]))
        above = band[-1:]
        yield lines.tobytes()


def _bands(columns: int, rows: int, strokes: list[InkStroke], dpi: float) -> Iterator[npt.NDArray[np.uint8]]:
    """Bands of the picture from the top down, uint8 (rows, width): 255 paper, 0 ink."""
    pixel = dpi / INCH
    # Lines are cut a little outside of a band, by half a pen and more, where their round ends do not show.
    rim = int(max((s.width for s in strokes), default=0.0) * pixel) + 4
    low = np.array([s.points.imag.min() for s in strokes]) * pixel
    high = np.array([s.points.imag.max() for s in strokes]) * pixel
    deep = max(BAND // columns, 1)
    for top, bottom in pairwise([*range(0, rows, deep), rows]):
        tall = bottom - top + 2 * rim
        agg: Any = RendererAgg(columns, tall, dpi)  # type: ignore[no-untyped-call]
        pen = agg.new_gc()
        pen.set_capstyle("round")
        pen.set_joinstyle("round")
        pen.set_snap(False)
        floor = rows - bottom - rim  # row of the sheet, counted from below, at the lower edge of the picture
        place = Affine2D().scale(pixel).translate(0, -floor)
        box = Box(-1 / pixel, (floor + 1) / pixel, (columns + 1) / pixel, (floor + tall - 1) / pixel)
        for i in np.flatnonzero((high > floor) & (low < floor + tall)):
            stroke = strokes[i]
            pen.set_linewidth(stroke.width / INCH * 72)
            for path in _paths(stroke, box):
                agg.draw_path(pen, path, place, (0.0, 0.0, 0.0) if stroke.filled else None)
        # The empty picture is transparent: how opaque a pixel has become is how much of it the ink covers.
        yield 255 - np.asarray(agg.buffer_rgba())[rim : tall - rim, :, 3]


def _paths(stroke: InkStroke, box: Box) -> Iterator[AggPath]:
    """Paths of a stroke for Agg, clipped to a box: matplotlib draws stray lines where a curve leaves the picture."""
    points = stroke.points
    if stroke.filled:
        yield _path(np.append(points, points[:1]), True)
    elif (points == points[0]).all():
        yield _path(np.append(points[:1], points[0] + 1e-4), False)  # a dot: Agg leaves out what has no length
    else:
        for part in polyline_inside(box, points):
            yield _path(part, False)


def _path(points: Points, closed: bool) -> AggPath:
    path = AggPath(np.column_stack((points.real, points.imag)), closed=closed)
    path.should_simplify = False
    return path
