"""Marks as text of DXF entities, ten times quicker than one object of a library each."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache
from math import degrees, pi

import numpy as np

from tmm_sheets.backends.dxf_frame import weight
from tmm_sheets.drawing.lettering import PEN, glyph, widened
from tmm_sheets.drawing.marks import Arc, Fill, Line, Mark, Points, Polyline, Text

ALONG = 128
"""Flag of a polyline whose line type runs on through its corners."""


def head(kind: str, owner: str, layer: str, more: str = "") -> str:
    """Tags from the owner of an entity to the mark of its class."""
    return f"330\n{owner}\n100\nAcDbEntity\n8\n{layer}\n{more}100\n{kind}\n"


def flat(code: int, z: complex) -> str:
    """Tags of a point in the plane of the drawing, whose height goes without saying: there are thousands of them in lettering."""
    return f"{code}\n{short(z.real)}\n{code + 10}\n{short(z.imag)}\n"


def place(code: int, z: complex) -> str:
    """Tags of a point."""
    return f"{flat(code, z)}{code + 20}\n0\n"


def short(value: float, digits: int = 4) -> str:
    """A number with so many decimals; zeros at the end say nothing."""
    return f"{value:.{digits}f}".rstrip("0").rstrip(".")


def entity(mark: Line | Arc | Polyline | Fill, handle: int, owner: str, layer: str, dashed: bool = False,
           solid: bool = False) -> str:
    """A mark as an entity; ``dashed``: of a line type with a pattern, ``solid``: continuous whatever its layer says."""
    plain = "6\nContinuous\n" if solid else ""
    if isinstance(mark, Line):
        return f"0\nLINE\n5\n{handle:X}\n{head('AcDbLine', owner, layer, plain)}{flat(10, mark.a)}{flat(11, mark.b)}"
    if isinstance(mark, Arc):
        whole = mark.end - mark.start > 2 * pi - 1e-9
        text = (f"0\n{'CIRCLE' if whole else 'ARC'}\n5\n{handle:X}\n{head('AcDbCircle', owner, layer, plain)}"
                f"{place(10, mark.centre)}40\n{short(mark.radius)}\n")
        if not whole:
            text += f"100\nAcDbArc\n50\n{short(degrees(mark.start) % 360, 6)}\n51\n{short(degrees(mark.end) % 360, 6)}\n"
        return text
    n = len(mark.points)
    if isinstance(mark, Polyline):
        flags = int(mark.closed) + (ALONG if dashed else 0)
        return (f"0\nLWPOLYLINE\n5\n{handle:X}\n{head('AcDbPolyline', owner, layer, plain)}90\n{n}\n70\n{flags}\n"
                f"{_vertices(n) % _xy(mark.points)}")
    # Some programs draw the outline of a filled area too, and with the width of the layer it would grow.
    thin = f"{plain}370\n0\n"
    if n in (3, 4):
        corners = mark.points[[0, 1, -1, 2]].tolist()  # those of a SOLID run as in the letter Z
        return (f"0\nSOLID\n5\n{handle:X}\n{head('AcDbTrace', owner, layer, thin)}"
                f"{''.join(place(10 + i, z) for i, z in enumerate(corners))}")
    return (f"0\nHATCH\n5\n{handle:X}\n{head('AcDbHatch', owner, layer, thin)}10\n0\n20\n0\n30\n0\n210\n0\n220\n0\n230\n1\n"
            f"2\nSOLID\n70\n1\n71\n0\n91\n1\n92\n3\n72\n0\n73\n1\n93\n{n}\n"
            f"{_vertices(n) % _xy(mark.points)}97\n0\n75\n0\n76\n1\n98\n0\n")


@cache
def _vertices(n: int) -> str:
    return "10\n%.4f\n20\n%.4f\n" * n


def _xy(points: Points) -> tuple[float, ...]:
    return tuple(np.column_stack((points.real, points.imag)).ravel().tolist())


def letter_strokes(texts: Iterable[Text], owner: str, layer: str, handles: Iterator[int]) -> str:
    """Strokes of all letters: placed together as arrays, then written one polyline each.

    Raises
    ------
    ValueError
        When a letter is missing from the font.
    """
    parts: list[Points] = []
    factors: list[complex] = []
    origins: list[complex] = []
    heads: list[str] = []
    for mark in texts:
        u = mark.height * complex(np.cos(mark.angle), np.sin(mark.angle))
        at = mark.at
        start = head("AcDbPolyline", owner, layer, f"370\n{weight(PEN * mark.height)}\n")
        for char in mark.text:
            letter = glyph(char)
            for stroke in letter.strokes:
                parts.append(stroke if mark.wide == 1.0 else widened(stroke, mark.wide))
                factors.append(u)
                origins.append(at)
                heads.append(start)
            at += u * letter.advance * mark.wide
    if not parts:
        return ""
    counts = [len(p) for p in parts]
    points = np.concatenate(parts) * np.repeat(factors, counts) + np.repeat(origins, counts)
    form = [f"0\nLWPOLYLINE\n5\n{handle:X}\n{start}90\n{n}\n70\n0\n{_vertices(n)}"
            for start, n, handle in zip(heads, counts, handles, strict=False)]
    # One formatting of all numbers: three times quicker than one of each stroke.
    return "".join(form) % _xy(points)


def extents(marks: Iterable[Mark]) -> tuple[float, float, float, float]:
    """Least x and y, greatest x and y of the lines of the marks, mm; zeros for none."""
    found: list[complex] = []
    for mark in marks:
        if isinstance(mark, Line):
            found += (mark.a, mark.b)
        elif isinstance(mark, Arc):
            found += _reach(mark)
        elif isinstance(mark, Polyline | Fill) and len(mark.points):
            xs, ys = mark.points.real, mark.points.imag
            found += (complex(xs.min(), ys.min()), complex(xs.max(), ys.max()))
    if not found:
        return (0.0, 0.0, 0.0, 0.0)
    x, y = [z.real for z in found], [z.imag for z in found]
    return min(x), min(y), max(x), max(y)


def _reach(arc: Arc) -> list[complex]:
    """The ends of an arc and where it meets the axes of its circle."""
    turns = [arc.start, arc.end]
    quarter = pi / 2
    k = np.ceil(arc.start / quarter) if np.isfinite(arc.start) else 0.0
    while np.isfinite(arc.end) and k * quarter < arc.end and len(turns) < 7:
        turns.append(float(k * quarter))
        k += 1
    return [arc.centre + arc.radius * complex(np.cos(t), np.sin(t)) for t in turns]
