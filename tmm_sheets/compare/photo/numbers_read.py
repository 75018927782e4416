"""Numbers in tables and at positions, read where they are known to stand; with the extra ``ocr``.

Reading is not measuring: what was read otherwise is a hint to look there, never more. A comma and a sign are a dot and a short
stroke, which are lost or found too easily: numbers of the same digits are not told apart.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from importlib.util import find_spec
from math import degrees
from typing import Any

import cv2
import numpy as np

from tmm_sheets import quoting
from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.photo.profiles import SCALE, pixels
from tmm_sheets.compare.photo.traces import InkTrace
from tmm_sheets.errors import BadInput
from tmm_sheets.words import tell

NUMBER = re.compile(r"−?(\d+)(?:[.,](\d+))?")
ROW = 48
"""Height in pixels of what the reader is shown."""
SURE = 0.85
"""Score of the reader below which nothing is said to be read."""
MARGINS = (0.8, 1.3)
"""Room round a number that is read with it, mm: another one than ours must read alike with either."""
OFF = 0.05
"""Share by which a number may be otherwise, and one of its last decimals: it was taken off a drawing."""
Reader = Callable[[Any], tuple[str, float]]
"""Reads a line of black on white, grey, ``ROW`` pixels high: what it says and how sure that is, 0 .. 1."""


@dataclass(frozen=True)
class Readings:
    """What was read: of how many numbers, of how many nothing, and by the element's number what is otherwise."""

    asked: int = 0
    unread: int = 0
    otherwise: Mapping[int, str] = field(default_factory=dict)

    @property
    def tree(self) -> dict[str, int]:
        """How many, for JSON."""
        return {"asked": self.asked, "unread": self.unread, "otherwise": len(self.otherwise)}


def reader() -> Reader:
    """The reader of the extra ``ocr``.

    Raises
    ------
    BadInput
        With the command that installs it.
    """
    if find_spec("rapidocr") is None or find_spec("onnxruntime") is None:
        raise BadInput(tell("reading numbers needs rapidocr, which is not installed"), hint=quoting.install("compare", "ocr"))
    from rapidocr import RapidOCR

    engine = RapidOCR(params={"Global.use_det": False, "Global.use_cls": False, "Global.log_level": "critical"})

    def read(line: Any) -> tuple[str, float]:
        found: Any = engine(np.repeat(line[:, :, None], 3, axis=2), use_det=False, use_cls=False, use_rec=True)
        return (str(found.txts[0]), float(found.scores[0])) if found.txts else ("", 0.0)

    return read


def readings(traces: Iterable[InkTrace], ink: Any, read: Reader) -> Readings:
    """Read the numbers of a sheet whose lettering is there; ``ink`` is the darkness of the rectified picture."""
    asked = unread = 0
    otherwise = {}
    for e in (t.element for t in traces if t.status == "lettering" and is_number(t.element)):
        asked += 1
        found = ""
        for margin in MARGINS:
            before, found = found, _number(*read(_upright(e, ink, margin)))
            if found and (found == before or not differs(found, e.text, exact=e.text == e.position)):
                break
        else:
            unread += 1
            continue
        if differs(found, e.text, exact=e.text == e.position):
            otherwise[e.number] = found
    return Readings(asked, unread, otherwise)


def is_number(e: Element) -> bool:
    """Whether an element is a number, nothing else."""
    return e.kind == "text" and NUMBER.fullmatch(e.text) is not None


def _number(text: str, sure: float) -> str:
    """What was read when it is a number and sure to be it, else nothing."""
    text = re.sub("^[-–—]", "−", text.replace(" ", "")).strip(".,")
    return text if sure >= SURE and NUMBER.fullmatch(text) else ""


def differs(found: str, wanted: str, exact: bool = False) -> bool:
    """Whether a number that was read is another one; ``exact``: it names a position, and was not taken off a drawing."""
    ours, theirs = NUMBER.fullmatch(wanted), NUMBER.fullmatch(found)
    if ours is None or theirs is None or _digits(ours) == _digits(theirs):
        return False
    if exact:
        return True
    digits, decimals = _digits(theirs), len(theirs[2] or "")
    if not decimals and len(digits) == len(_digits(ours)):
        decimals = len(ours[2] or "")  # the comma was not seen
    value, theirs_value = int(_digits(ours)) / 10 ** len(ours[2] or ""), int(digits) / 10**decimals
    unit = 1.001 / 10 ** len(ours[2]) if ours[2] else 0.0
    return bool(abs(theirs_value - value) > OFF * max(value, theirs_value) + unit)


def _digits(number: re.Match[str]) -> str:
    return number[1] + (number[2] or "")


def _upright(e: Element, ink: Any, margin: float) -> Any:
    """The lettering of an element and ``margin`` mm round it, black on white, ``ROW`` pixels high."""
    lower_left, lower_right, _, upper_left = e.points
    width, height = abs(lower_right - lower_left) + 2 * margin, abs(upper_left - lower_left) + 2 * margin
    times = ROW / (height * SCALE)
    size = (max(round(width * SCALE * times), ROW), ROW)
    at = complex(pixels(e.points.mean()))
    turn = cv2.getRotationMatrix2D((at.real, at.imag), -degrees(e.angle), times)
    turn[:, 2] += np.array(size) / 2 - np.array([at.real, at.imag])
    line = cv2.warpAffine(ink, turn, size, flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)
    darkest = max(float(line.max()), 1.0)
    return np.asarray(255 - np.clip(line.astype(np.float32) * (255 / darkest), 0, 255), dtype=np.uint8)
