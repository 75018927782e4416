"""The exact drawing over the hand's: ink in blue, the exact lines thin and orange, what is off marked and numbered.

As PNG, drawn by OpenCV, and as a one-page PDF of the sheet's size in which the ink is an image and all else are strokes, to be
looked at closely. The PDF is written here: it has nothing but that image and those strokes.
"""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from typing import Any, NamedTuple

import cv2
import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.compare.overlays import Numbered, around, legend, numbered
from tmm_sheets.compare.photo.sheet_map import PAPER
from tmm_sheets.compare.photo.traces import fixed
from tmm_sheets.drawing.ink import letters
from tmm_sheets.drawing.marks import Points, Text
from tmm_sheets.words import tell

INK = (40, 70, 160)
EXACT = (245, 140, 0)
BAD = {"red": (220, 0, 0), "amber": (190, 0, 190)}
"""Colours (red, green, blue): of ink, of the exact lines, of what is off by verdict."""
PNG_SCALE = 4.0  # pixels per mm
CIRCLE = 7.0  # mm, radius around what is off
DIGITS = 6.0  # mm, height of the box of a number; its digits are as high as two thirds of it
BOLD, FINE = 0.4, 0.12  # mm, widths of what is off and of the exact lines


class Flag(NamedTuple):
    """A place to be marked, its number and verdict, and the lines that are off there, mm."""

    number: int
    verdict: str
    at: complex
    lines: tuple[Points, ...] = ()


class Stroke(NamedTuple):
    """A line of the overlay: its points, colour and width, mm."""

    points: Points
    colour: tuple[int, int, int]
    wide: float


def strokes(exact: Sequence[Points], flags: Sequence[Flag], fitted: bool = True) -> list[Stroke]:
    """All that lies over the ink: the exact lines, what is off, a legend; where it was not ``fitted``, what does not fit."""
    entries = [(INK, "line", tell("drawn")), (EXACT, "line", tell("exact"))]
    entries += [(BAD["red"], "red", tell("wrong")), (BAD["amber"], "amber", tell("worth a look"))] if fitted else [
        (BAD["red"], "red", tell("does not fit"))]
    said = legend([(form, words) for _, form, words in entries])
    out = [Stroke(z, colour, BOLD) for (colour, _, _), some in zip(entries, said, strict=True) for z in some]
    out += [Stroke(z, EXACT, FINE) for z in exact]
    for f, number in zip(flags, number_places(flags), strict=True):
        digits = letters(Text(number.at, number.text, DIGITS / 1.5))
        out += [Stroke(z, BAD[f.verdict], BOLD) for z in (*f.lines, around(f.verdict, f.at, CIRCLE), *digits)]
        out += [Stroke(np.array(number.leader), BAD[f.verdict], FINE)] if number.leader else []
    return out


def png(ink: Any, level: float, some: Sequence[Stroke]) -> bytes:
    """The overlay as PNG, :data:`PNG_SCALE` pixels per mm."""
    size = (round(PAPER.width * PNG_SCALE), round(PAPER.height * PNG_SCALE))
    grey = cv2.resize(_clean(ink, level), size, interpolation=cv2.INTER_AREA)
    picture: Any = cv2.LUT(cv2.merge([grey, grey, grey]), _palette()[None, :, ::-1].copy())
    for points, colour, wide in some:
        cv2.polylines(picture, [fixed(points, PNG_SCALE)], False, colour[::-1], max(round(wide * PNG_SCALE), 1), cv2.LINE_AA, 4)
    done, data = cv2.imencode(".png", picture)
    assert done
    return bytes(data.tobytes())


def piece(ink: Any, level: float, box: Box, scale: float) -> bytes:
    """A rectangle of the sheet, mm, as PNG of ``scale`` pixels per mm; parts beyond the sheet are left out."""
    of = ink.shape[1] / PAPER.width
    rows = slice(max(round((PAPER.height - box.y1) * of), 0), round((PAPER.height - box.y0) * of))
    part = _clean(ink[rows, max(round(box.x0 * of), 0) : round(box.x1 * of)], level)
    if scale < of:
        part = cv2.resize(part, None, fx=scale / of, fy=scale / of, interpolation=cv2.INTER_AREA)
    done, data = cv2.imencode(".png", 255 - np.minimum(1.6 * part, 255).astype(np.uint8))
    assert done
    return bytes(data.tobytes())


def number_places(flags: Sequence[Flag]) -> list[Numbered]:
    """Where the numbers of flags stand, none upon another."""
    return numbered([(f.at, CIRCLE, str(f.number)) for f in flags], DIGITS, PAPER)


def _palette() -> Any:
    """Colour of every darkness, (256, 3)."""
    strength = np.minimum(1.6 * np.arange(256) / 255, 1)[:, None]
    return np.round(255 + (np.array(INK) - 255) * strength).astype(np.uint8)


def _clean(ink: Any, level: float) -> Any:
    """Ink without the grain of bare paper."""
    return cv2.threshold(ink, 0.6 * level, 255, cv2.THRESH_TOZERO)[1]


def pdf(ink: Any, level: float, some: Sequence[Stroke], title: str) -> bytes:
    """The overlay as a PDF of the sheet's size."""
    mm = 72 / 25.4
    rows, columns = ink.shape
    palette = _palette().tobytes()
    out = [f"{PAPER.width * mm:.4f} 0 0 {PAPER.height * mm:.4f} 0 0 cm /Ink Do Q q {mm:.6f} 0 0 {mm:.6f} 0 0 cm", "1 J 1 j"]
    out += map(_path, some)
    content = zlib.compress(("q " + "\n".join(out) + " Q").encode("ascii"), 6)
    image = zlib.compress(_clean(ink, level).tobytes(), 1)
    name = "".join(f"{b:02X}" for b in b"\xfe\xff" + title.encode("utf-16-be"))
    objects = [
        b"<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
        b"<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        (f"<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {PAPER.width * mm:.4f} {PAPER.height * mm:.4f}] /Contents 4 0 R "
         "/Resources << /XObject << /Ink 5 0 R >> >> >>").encode("ascii"),
        b"<< /Length %d /Filter /FlateDecode >>\nstream\n" % len(content) + content + b"\nendstream",
        (f"<< /Type /XObject /Subtype /Image /Width {columns} /Height {rows} /BitsPerComponent 8 "
         f"/ColorSpace [/Indexed /DeviceRGB 255 <{palette.hex()}>] /Filter /FlateDecode "
         f"/Length {len(image)} >>\nstream\n").encode("ascii") + image + b"\nendstream",
        f"<< /Title <{name}> /Creator (tmm-sheets) >>".encode("ascii"),
    ]  # fmt: skip
    data, places = b"%PDF-1.4\n", []
    for k, body in enumerate(objects, 1):
        places.append(len(data))
        data += b"%d 0 obj\n" % k + body + b"\nendobj\n"
    start = len(data)
    data += b"xref\n0 %d\n0000000000 65535 f \n" % (len(objects) + 1)
    data += b"".join(b"%010d 00000 n \n" % p for p in places)
    return data + b"trailer\n<< /Size %d /Root 1 0 R /Info 6 0 R >>\nstartxref\n%d\n%%%%EOF\n" % (len(objects) + 1, start)


def _path(stroke: Stroke) -> str:
    colour = " ".join(f"{x / 255:.3f}" for x in stroke.colour)
    places = [f"{p.real:.2f} {p.imag:.2f} {'l' if k else 'm'}" for k, p in enumerate(stroke.points.tolist())]
    return f"{colour} RG {stroke.wide:g} w " + " ".join(places) + " S"
