import struct
import zlib
from io import BytesIO

import numpy as np
import pytest
import shapely
from PIL import Image

from tests.backends.geometry import area, drawn
from tmm_sheets.backends import png
from tmm_sheets.drawing.ink import InkStroke
from tmm_sheets.drawing.marks import Drawing, Fill, Line

DPI = 127.0  # 5 pixels in a millimetre


def read(data):
    image = Image.open(BytesIO(data))
    image.load()
    return image


@pytest.fixture(scope="module")
def picture(drawing):
    return np.asarray(read(png.render(drawing, DPI)))


@pytest.mark.parametrize(("dpi", "size"), [(10, (331, 234)), (72, (2384, 1684)), (127, (4205, 2970))])
def test_size_is_that_of_the_paper(dpi, size):
    image = read(png.render(Drawing(841, 594, "Лист 1", (Line(0j, 1j, "thin"),), "Иванов"), dpi))
    assert image.size == size
    assert image.mode == "L"
    assert image.info["dpi"] == pytest.approx((dpi, dpi), abs=0.013)  # whole pixels per metre
    assert (image.info["Title"], image.info["Author"]) == ("Лист 1", "Иванов")
    assert [p / d * 25.4 for p, d in zip(size, image.info["dpi"], strict=True)] == pytest.approx([841, 594], abs=25.4 / dpi)


def test_chunks_are_whole():
    data = png.render(Drawing(100, 50, "", (Line(0j, 1j, "thin"),)), 20)
    at, kinds = 8, []
    while at < len(data):
        (length,) = struct.unpack_from(">I", data, at)
        kinds.append(data[at + 4 : at + 8])
        assert struct.unpack_from(">I", data, at + 8 + length)[0] == zlib.crc32(data[at + 4 : at + 8 + length])
        at += 12 + length
    assert kinds == [b"IHDR", b"pHYs", b"IDAT", b"IEND"]
    assert at == len(data)


@pytest.mark.parametrize("width", [0.2, 0.35, 0.5, 0.8])
@pytest.mark.parametrize("turn", [1, 1j, (3 + 4j) / 5])
def test_widths_are_true(width, turn):
    """A line of 100 mm covers 100 mm times its width and a round end: measured from the sum of the grey."""
    a = 80 + 80j
    line = InkStroke(np.array([a, a + 100 * turn]), width)
    grey = np.asarray(read(png.picture(200, 200, [line], 254)), dtype=float)
    covered = float((255 - grey).sum()) / 255 / 100
    assert covered / 100 == pytest.approx(width + np.pi * width**2 / 400, abs=0.01)


def test_places_are_true_wherever_a_band_ends(monkeypatch):
    monkeypatch.setattr(png, "BAND", 3000)
    strokes = [InkStroke(np.array([10 + 1j * y, 60 + 1j * y]), 0.8) for y in np.arange(5, 195, 3.7)]
    strokes.append(InkStroke(np.array([62 + 5j, 95 + 195j, 95 + 5j]), 0.8))
    many = np.asarray(read(png.picture(100, 200, strokes, DPI)))
    monkeypatch.setattr(png, "BAND", 10**9)
    whole = np.asarray(read(png.picture(100, 200, strokes, DPI)))
    assert np.abs(whole.astype(int) - many).max() <= 1  # a grey level, of 255: the last digit of a place
    y = np.arange(many.shape[0])
    for stroke in strokes[:-1]:
        column = 255.0 - many[:, 5 * 30]
        near = np.abs(many.shape[0] - y - 0.5 - 5 * stroke.points[0].imag) < 6
        centre = (column * y)[near].sum() / column[near].sum()
        assert (many.shape[0] - centre - 0.5) / 5 == pytest.approx(stroke.points[0].imag, abs=0.01)


@pytest.mark.parametrize("seed", range(8))
def test_lines_across_bands_are_where_they_are_and_nowhere_else(monkeypatch, seed):
    """Corners on whole pixels meet the edges of bands exactly, where matplotlib's own clipping draws lines nobody asked for."""
    rng = np.random.default_rng(seed)
    monkeypatch.setattr(png, "BAND", 500 * (40 + 7 * seed))
    corners = (np.sort(rng.integers(25, 475, 60)) + 1j * rng.integers(100, 400, 60)) / 5
    image = np.asarray(read(png.picture(100, 100, [InkStroke(corners, 0.5)], DPI)))
    line = shapely.LineString(np.column_stack((corners.real, corners.imag)))
    i, j = np.nonzero(image < 255)
    assert shapely.distance(shapely.points((j + 0.5) / 5, (500 - i - 0.5) / 5), line).max() < 0.25 + 0.2
    on = shapely.get_coordinates(line.segmentize(0.2)) * 5
    assert (image[np.floor(500 - on[:, 1]).astype(int), on[:, 0].astype(int)] < 128).all()


def test_ink_is_that_of_the_drawing(picture, drawing):
    """Middles of pixels more than 0.05 mm inside the ink, past the reach of anti-aliasing, are black; as far outside, white."""
    ink = area(drawn(drawing))
    rows, columns = picture.shape
    rim = 0.05 + 0.2 / np.sqrt(2)
    inner, outer = ink.buffer(-rim), ink.buffer(rim)
    shapely.prepare(inner), shapely.prepare(outer)
    i, j = np.nonzero(picture < 255)
    rng = np.random.default_rng(1)
    some = rng.choice(len(i), 40_000, replace=False)
    x, y = (j[some] + 0.5) / 5, (rows - i[some] - 0.5) / 5
    assert shapely.contains_xy(outer, x, y).all()
    x, y = (v.ravel() for v in np.meshgrid((np.arange(columns) + 0.5) / 5, (np.arange(rows)[::3] + 0.5) / 5))
    inside = shapely.contains_xy(inner, x, y)
    assert inside.sum() > 1000
    # Where two strokes meet within a pixel a breath of white shows between them.
    assert (picture[(rows - y[inside] * 5).astype(int), (x[inside] * 5).astype(int)] < 20).all()


def test_filled_areas_have_no_line_round_them():
    data = png.render(Drawing(40, 40, "", (Fill(np.array([10 + 10j, 30 + 10j, 30 + 30j, 10 + 30j]), "main"),)), 254)
    grey = np.asarray(read(data))
    assert (grey[100:300, 100:300] == 0).all()
    assert (grey == 0).sum() == 200 * 200
    assert (grey < 255).sum() == 200 * 200


def test_a_dot_is_as_large_as_its_pen():
    grey = np.asarray(read(png.picture(20, 20, [InkStroke(np.array([10 + 10j, 10 + 10j]), 2.0)], 254)), dtype=float)
    assert float((255 - grey).sum()) / 255 / 100 == pytest.approx(np.pi, abs=0.05)  # Agg's circle has corners


def test_every_resolution_in_reason(drawing):
    for dpi in (9.9, 1201, float("nan")):
        with pytest.raises(ValueError, match="expected 10 to 1200 dots per inch"):
            png.render(drawing, dpi)
