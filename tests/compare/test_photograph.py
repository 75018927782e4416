"""Pictures of all kinds as grey pixels."""

from io import BytesIO

import cv2
import numpy as np
import pytest

from tmm_sheets.compare.photo.photograph import read
from tmm_sheets.errors import BadInput

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
