"""A photograph, a scan or a print as grey pixels, from JPG, PNG or PDF.

JPG and PNG are read by OpenCV, which turns a picture as its EXIF data say; a page of a PDF, a scan as well as a vector drawing, is
rendered by pypdfium2. Both come with the extra ``compare``.
"""

from __future__ import annotations

from importlib.util import find_spec
from io import BytesIO
from pathlib import Path
from typing import Any, NamedTuple

import cv2
import numpy as np
import numpy.typing as npt

from tmm_sheets import files, quoting
from tmm_sheets.compare.photo import need_opencv, pdf_page
from tmm_sheets.errors import BadInput, CannotBuild, Problem
from tmm_sheets.numbers import told
from tmm_sheets.words import marked, tell, tell_n

Grey = npt.NDArray[np.uint8]

LEAST_PIXELS = 2_000_000
"""Below this the thin lines of an A1 sheet are a third of a pixel wide."""
MOST_PIXELS = 400_000_000
"""A scan of an A1 sheet at 600 dpi has 280 million and takes 0.6 GB. More, which a small file may hold, is not even decoded."""
LONGEST_SIDE = 32_000
"""Pixels of a side that OpenCV can straighten (16 bits)."""
LARGEST = 1_500_000_000
"""Bytes of the largest file that is read."""
BAND = 4_000_000
"""Pixels with transparency that are put on white at once."""
PDF_DPI, MM = 200.0, 72 / 25.4
SMALLER = marked("scan at 300 dpi in grey: A1 is 9930 x 7020 pixels then, more does not help")
PNG, WITH_ALPHA = b"\x89PNG\r\n\x1a\n", (b"\4", b"\6")
"""Beginning of a PNG file, and its colour types with transparency."""
SHOW = marked("expected a photograph or scan as JPG, PNG or PDF")


class Photograph(NamedTuple):
    """Pixels, 255 for white, row 0 at the top, and what was remarkable about the file."""

    grey: Grey
    notes: tuple[str, ...] = ()


def read(path: Path) -> Photograph:
    """Read a photograph.

    Raises
    ------
    BadInput
        When the file is missing, empty or no image, or a library is missing.
    CannotBuild
        When the image has too few pixels, or more than the memory is to hold.
    """
    need_opencv()
    try:
        size = path.stat().st_size
        if size > LARGEST:
            raise CannotBuild(tell("{file}: {size} GB are more than can be read ({most} GB)").format(
                file=path, size=told(f"{size / 1e9:.1f}"), most=told(f"{LARGEST / 1e9:.1f}")), tell(SMALLER))
        data = files.content(path, LARGEST)
    except FileNotFoundError:
        raise BadInput(Problem(tell("there is no such file"), str(path), hint=tell(SHOW))) from None
    except OSError as e:
        raise BadInput(Problem(tell("cannot be read: {why}").format(why=e.strerror or e), str(path), hint=tell(SHOW))) from None
    if not data:
        raise BadInput(Problem(tell("the file is empty"), str(path), hint=tell(SHOW)))
    notes: tuple[str, ...] = ()
    if data.lstrip()[:5] == b"%PDF-":
        grey, notes = _page(data, path)
    else:
        decoded, notes = _decoded(data, path)
        if decoded is None:
            raise BadInput(Problem(tell("is not an image that can be read, or only part of one"), str(path),
                                   hint=tell(SHOW)))
        grey = decoded
    pixels = grey.shape[0] * grey.shape[1]
    if pixels < LEAST_PIXELS:
        raise CannotBuild(
            tell("{file}: {width} x {height} pixels are too few for an A1 sheet: thin lines cannot be seen").format(
                file=path, width=grey.shape[1], height=grey.shape[0]),
            hint=tell("take the picture with at least 8 million pixels, the sheet filling it; messengers shrink pictures, so "
                      "send it as "
                      "a file"),
        )
    _refuse_large(grey.shape[1], grey.shape[0], path)
    return Photograph(grey, notes)


def _refuse_large(width: int, height: int, path: Path, side: int = LONGEST_SIDE) -> None:
    """Refuse a picture that would fill the memory, or has a longer side than that."""
    if width * height > MOST_PIXELS or max(width, height) > side:
        said = tell("{file}: {width} x {height} pixels are more than can be handled: at most {most} million, {side} along a side")
        raise CannotBuild(said.format(file=path, width=width, height=height, most=MOST_PIXELS // 1_000_000, side=LONGEST_SIDE),
                          tell(SMALLER))


def _size(data: bytes) -> tuple[int, int] | None:
    """Width and height an image file says it has; None when it does not."""
    from PIL import Image

    most, Image.MAX_IMAGE_PIXELS = Image.MAX_IMAGE_PIXELS, None  # it has a limit of its own, which does not know A1
    try:
        with Image.open(BytesIO(data)) as image:
            return image.size
    except Exception:  # each format has its own ways to be damaged; OpenCV may still read it
        return None
    finally:
        Image.MAX_IMAGE_PIXELS = most


def _decoded(data: bytes, path: Path) -> tuple[Any, tuple[str, ...]]:
    """Grey pixels of an image file, None when there are none; what is transparent is white paper."""
    size = _size(data)
    if size is not None:
        _refuse_large(*size, path)
    raw = np.frombuffer(data, np.uint8)
    log = cv2.utils.logging.getLogLevel()
    cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)  # what it has to say of a damaged file is told here
    try:
        if data[:8] == PNG and data[25:26] in WITH_ALPHA:
            with_alpha: Any = cv2.imdecode(raw, cv2.IMREAD_UNCHANGED)
            if with_alpha is not None and with_alpha.ndim == 3 and with_alpha.shape[2] == 4:
                if int(with_alpha[:, :, 3].min()) < np.iinfo(with_alpha.dtype).max:
                    return _on_white(with_alpha), (tell("{file} is transparent; it was put on white").format(file=path.name),)
                del with_alpha
        return cv2.imdecode(raw, cv2.IMREAD_GRAYSCALE), ()
    except cv2.error:
        return None, ()
    finally:
        cv2.utils.logging.setLogLevel(log)


def _on_white(with_alpha: Any) -> Grey:
    """Grey pixels of a picture (BGR and opacity) on white paper, a band of rows after the other."""
    most = np.iinfo(with_alpha.dtype).max
    whole = np.empty(with_alpha.shape[:2], np.uint8)
    rows = max(1, BAND // with_alpha.shape[1])
    for k in range(0, len(whole), rows):
        band = with_alpha[k : k + rows]
        seen = cv2.cvtColor(band[:, :, :3], cv2.COLOR_BGR2GRAY).astype(np.float32)
        paper = band[:, :, 3].astype(np.float32) / most
        whole[k : k + rows] = (255 - paper * (255 - seen * np.float32(255 / most))).round()
    return whole


def _page(data: bytes, path: Path) -> tuple[Grey, tuple[str, ...]]:
    """The first page of a PDF."""
    if find_spec("pypdfium2") is None:
        raise BadInput(tell("reading a PDF needs pypdfium2, which is not installed"),
                       hint=tell("{command}, or save the page as PNG").format(command=quoting.install("compare")))  # fmt: skip
    made, pixels = pdf_page.drawn(data, PDF_DPI, MOST_PIXELS, 30e6)
    wrong = {"locked": (tell("the PDF is locked with a password"), tell("save or print it without one")),
             "unreadable": (tell("is not a PDF that can be read: {why}").format(why=made.get("why")), tell(SHOW)),
             "empty": (tell("the PDF has no page"), tell(SHOW))}  # fmt: skip
    if made["kind"] in wrong:
        message, hint = wrong[made["kind"]]
        raise BadInput(Problem(message, str(path), hint=hint))
    width, height = made["width"], made["height"]
    if made["kind"] == "shape":
        raise CannotBuild(tell("{file}: the page of {width} x {height} mm is not that of a sheet").format(
            file=path, width=f"{width / MM:.0f}", height=f"{height / MM:.0f}"),
            hint=tell("scan or print the whole sheet, A1, to one page"))
    if made["kind"] == "large":
        _refuse_large(width, height, path, MOST_PIXELS)
    rows = np.frombuffer(pixels, np.uint8).reshape(height, made["stride"])
    grey, pages = rows[:, : width * made["channels"] : made["channels"]], made["pages"]
    said = tell_n("{file} has {n} page; the first was compared", "{file} has {n} pages; the first was compared", pages)
    note = (said.format(file=path.name, n=pages),) if pages > 1 else ()
    return np.ascontiguousarray(grey), note
