"""Units of measured numbers: said in the reader's language, read in any."""

from __future__ import annotations

import re
from collections.abc import Mapping
from math import degrees, pi

from tmm_sheets.words import marked, tell

MILLIMETRES, DEGREES, METRES, TURNS = marked("mm"), "°", marked("m"), marked("rpm")
SPEED, ANGULAR_SPEED, ACCELERATION, ANGULAR_ACCELERATION = marked("m/s"), marked("rad/s"), marked("m/s²"), marked("rad/s²")
FORCE, MOMENT, MASS, INERTIA, ENERGY = marked("N"), marked("N·m"), marked("kg"), marked("kg·m²"), marked("kg·m²/s²")

_RADIAN = degrees(1)
SCALE = 0.1
"""Times as long as they should be that lengths may be in another unit, or drawn to another scale factor."""
OTHERS: Mapping[str, tuple[tuple[str, float], ...]] = {
    MILLIMETRES: ((METRES, 1e-3), (marked("cm"), SCALE)), DEGREES: ((marked("rad"), 1 / _RADIAN),),
    SPEED: ((marked("mm/s"), 1e3),), ACCELERATION: ((marked("mm/s²"), 1e3),), ANGULAR_SPEED: ((TURNS, 30 / pi),),
    FORCE: ((marked("kgf"), 1 / 9.81), (marked("kN"), 1e-3)), MOMENT: ((marked("N·mm"), 1e3), (marked("kgf·m"), 1 / 9.81)),
}
"""Units that are written by mistake for each, and how many times as large a number is in them."""
_LENGTHS: Mapping[str, float] = {"mm": 1.0, "cm": 10.0, "m": 1000.0}
_ANGLES: Mapping[str, float] = {"°": 1.0, "deg": 1.0, "rad": _RADIAN}
_LATIN: Mapping[str, str] = {
    "м": "m", "с": "s", "рад": "rad", "Н": "N", "кг": "kg", "мм": "mm", "см": "cm", "об": "rev", "мин": "min", "хв": "min",
    "Дж": "J", "град": "deg", "кН": "kN",
}
"""Russian and Ukrainian units."""
_CYRILLIC = re.compile("|".join(sorted(_LATIN, key=len, reverse=True)))


def said(unit: str) -> str:
    """A unit as the reader writes it."""
    return tell(unit)


def latin(unit: str) -> str:
    """One spelling of a unit in any language: Latin letters, no spaces, dots and brackets."""
    bare = re.sub(r"[\s·⋅*^()?.]+", "", unit).replace("²", "2").replace("³", "3")
    bare = _CYRILLIC.sub(lambda name: _LATIN[name[0]], bare)
    return "rev/min" if bare == "rpm" else bare


def times(unit: str, own: str) -> float:
    """How many units ``own`` one of the stated units has.

    Raises
    ------
    ValueError
        if they measure different things.
    """
    stated, wanted = latin(unit), latin(own)
    if not stated or stated == wanted or "?" in unit:  # a code page without superscripts writes м/с?
        return 1.0
    for table in (_LENGTHS, _ANGLES):
        if stated in table and wanted in table:
            return table[stated] / table[wanted]
    if unit.strip().startswith(("к", "k")) and latin(unit.strip()[1:]) == wanted:
        return 1000.0
    raise ValueError(unit)
