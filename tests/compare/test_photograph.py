"""Pictures of all kinds as grey pixels."""

import os
import struct
import subprocess
import sys
import zlib
from io import BytesIO
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image
from reportlab.pdfgen.canvas import Canvas

from tmm_sheets.compare.photo.photograph import read
from tmm_sheets.errors import BadInput, CannotBuild

ROWS, COLUMNS = 1200, 1800


def pattern():
    grey = np.full((ROWS, COLUMNS), 255, np.uint8)
    grey[100:110] = 0
    grey[:, 300:303] = 128
    return grey


@pytest.fixture
def path(tmp_path):
    return tmp_path / "photo.png"


@pytest.mark.parametrize("depth", [np.uint8, np.uint16])
def test_what_is_transparent_is_white_paper(path, depth):
    most = np.iinfo(depth).max
    picture = np.zeros((ROWS, COLUMNS, 4), depth)
    picture[:, :, 3] = most - pattern().astype(depth) * (most // 255)
    cv2.imwrite(str(path), picture)
    grey, notes = read(path)
    assert np.abs(grey.astype(int) - pattern()).max() <= 1
    assert notes == ("photo.png is transparent; it was put on white",)


def test_a_picture_that_only_could_be_transparent(path):
    picture = np.dstack((*[pattern()] * 3, np.full_like(pattern(), 255)))
    cv2.imwrite(str(path), picture)
    grey, notes = read(path)
    assert (grey == pattern()).all()
    assert notes == ()


def test_sixteen_bits(path):
    cv2.imwrite(str(path), pattern().astype(np.uint16) * 257)
    assert np.abs(read(path).grey.astype(int) - pattern()).max() <= 1


def test_part_of_a_picture(path, capfd):
    path.write_bytes(cv2.imencode(".png", pattern())[1].tobytes()[:300])
    with pytest.raises(BadInput, match="is not an image that can be read, or only part of one"):
        read(path)
    assert capfd.readouterr().err == ""


def test_a_locked_pdf(path):
    canvas = pytest.importorskip("reportlab.pdfgen.canvas")
    encryption = pytest.importorskip("reportlab.lib.pdfencrypt")
    pytest.importorskip("pypdfium2")
    data = BytesIO()
    sheet = canvas.Canvas(data, encrypt=encryption.StandardEncryption("secret", strength=40))
    sheet.drawString(100, 100, "x")
    sheet.save()
    path.write_bytes(data.getvalue())
    with pytest.raises(BadInput, match="the PDF is locked with a password"):
        read(path)


def said_to_be(form, width, height):
    """A small image file that says it has so many pixels."""
    out = BytesIO()
    Image.new("L", (64, 32), 255).save(out, form)
    data = bytearray(out.getvalue())
    if form == "PNG":
        data[16:24] = struct.pack(">II", width, height)
        data[29:33] = struct.pack(">I", zlib.crc32(data[12:29]))
    elif form == "JPEG":
        frame = data.index(b"\xff\xc0")
        data[frame + 5 : frame + 9] = struct.pack(">HH", height, width)
    elif form == "BMP":
        data[18:26] = struct.pack("<ii", width, height)
    elif form == "GIF":
        data[6:10] = struct.pack("<HH", width, height)
    else:
        (start,) = struct.unpack("<I", data[4:8])
        for k in range(struct.unpack("<H", data[start : start + 2])[0]):
            entry = start + 2 + 12 * k
            tag = struct.unpack("<H", data[entry : entry + 2])[0]
            if tag in (256, 257):
                data[entry + 2 : entry + 12] = struct.pack("<HII", 4, 1, width if tag == 256 else height)
    return bytes(data)


@pytest.mark.parametrize("form", ["PNG", "JPEG", "BMP", "GIF", "TIFF"])
@pytest.mark.parametrize(("width", "height"), [(30000, 30000), (20000, 20001), (1000, 33000)])
def test_too_many_pixels_are_not_decoded(form, width, height, path, monkeypatch):
    monkeypatch.setattr(cv2, "imdecode", lambda *_: pytest.fail("decoded"))
    path.write_bytes(said_to_be(form, width, height))
    with pytest.raises(CannotBuild, match=rf"{width} x {height} pixels are more .*at most 400 million(.|\n)*scan at 300 dpi"):
        read(path)
    assert Image.MAX_IMAGE_PIXELS  # is as it was


# Not ru_maxrss: that begins with what the process had before it became this program, and a worker of the tests may be large.
MEASURED = """
import re, sys
from pathlib import Path
from tmm_sheets.compare.photo.photograph import read
try:
    print(read(Path(sys.argv[1])).grey.shape)
finally:
    print(int(re.search(r"VmHWM:\\s+(\\d+)", Path("/proc/self/status").read_text())[1]) // 1024)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="kilobytes are those of Linux")
def test_memory_of_a_transparent_picture(path):
    """Four bytes a pixel as decoded, one as grey, and what is in work: not twenty."""
    picture = np.full((5000, 7000, 4), 255, np.uint8)
    picture[:10, :, 3] = 0
    cv2.imwrite(str(path), picture, [cv2.IMWRITE_PNG_COMPRESSION, 1])
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    done = subprocess.run([sys.executable, "-c", MEASURED, str(path)], env=environment, capture_output=True, text=True, check=True)
    shape, peak = done.stdout.splitlines()
    assert shape == "(5000, 7000)"
    assert int(peak) < 500  # MB; it was 800


@pytest.mark.parametrize(("size", "said"), [((1e6, 10), "is not that of a sheet"), ((10, 1e6), "is not that of a sheet")])
def test_a_page_that_is_no_sheet(size, said, path):
    page = Canvas(str(path), pagesize=size)
    page.line(0, 0, *size)
    page.save()
    with pytest.raises(CannotBuild, match=said):
        read(path)


def test_a_vast_page_and_a_vast_unit(path):
    page = Canvas(str(path), pagesize=(1e7, 7e6))
    page.line(0, 0, 1e7, 7e6)
    page.save()
    assert read(path).grey.size <= 200_100_000
    path.write_bytes(path.read_bytes().replace(b"/MediaBox", b"/UserUnit 70000 /MediaBox"))
    assert read(path).grey.size <= 200_100_000


@pytest.mark.trial
def test_a_vast_image_in_a_pdf(path):
    Image.new("1", (21000, 21000), 1).save(path, "PDF")
    with pytest.raises(CannotBuild, match="21000 x 21000 pixels are more"):
        read(path)


def test_a_vast_file(path):
    with path.open("wb") as file:
        file.truncate(1_600_000_000)  # sparse
    with pytest.raises(CannotBuild, match=r"1\.6 GB are more"):
        read(path)
