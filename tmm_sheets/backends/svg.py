"""SVG 1.1: paths in millimetres, a titled group for each view, in it one for each line type, lettering as strokes.

Letters are strokes, not text: a viewer without the drawing font would show others, wider and upright. Their text is the
``aria-label`` of the path, for search and screen readers. Inside, y points up as on the sheet.
"""

from __future__ import annotations

from cmath import exp
from collections import defaultdict
from collections.abc import Iterable, Sequence
from math import ceil, pi

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.drawing.ink import check, letters, strokes
from tmm_sheets.drawing.lettering import PEN
from tmm_sheets.drawing.marks import Arc, Drawing, Fill, Line, Mark, Polyline, Text
from tmm_sheets.drawing.styles import line_type
from tmm_sheets.words import paper

PIECE = pi / 2  # an arc is written in pieces: the centre of a half turn hangs on the last digit of its ends


def render(drawing: Drawing) -> bytes:
    """SVG file of a drawing, bytes."""
    views, rest = [], set(range(len(drawing.marks)))
    for n, view in enumerate(drawing.views, 1):
        own = [k for first, end in view.spans for k in range(first, end)]
        rest.difference_update(own)
        paths = _paths([drawing.marks[k] for k in own], "class")
        if paths:
            views.append(f'<g id="view-{n}">\n<title>{escaped(view.name)}</title>\n{paths}</g>\n')
    body = [*views, _paths([drawing.marks[k] for k in sorted(rest)], "id")]
    width, height = f"{drawing.width:g}", f"{drawing.height:g}"
    author = f"<desc>{escaped(drawing.author)}</desc>\n" if drawing.author else ""
    text = (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f'<svg xmlns="http://www.w3.org/2000/svg" version="1.1" xml:lang="{paper()}" width="{width}mm" height="{height}mm" '
        f'viewBox="0 0 {width} {height}">\n'
        f"<title>{escaped(drawing.title)}</title>\n{author}"
        f'<g transform="matrix(1 0 0 -1 0 {height})" fill="none" stroke="#000" stroke-linecap="round" stroke-linejoin="round">\n'
        f"{''.join(body)}</g>\n</svg>\n"
    )
    return text.encode("utf-8")


def picture(marks: Iterable[Mark], box: Box) -> bytes:
    """SVG of marks, clipped to a rectangle of the sheet (mm), without titles: a picture in a page of text.

    Units are whole micrometres, y points down, each line type and each height of lettering is one path: only programs read it.
    """
    corner = complex(box.x0, box.y1)
    lines, texts, fills = defaultdict[str, _Trace](_Trace), defaultdict[float, _Trace](_Trace), list[str]()
    for mark in strokes(marks):
        check(mark)
        match mark:
            case Text():
                for points in letters(mark):
                    texts[mark.height].add(points.tolist())
            case Fill():
                trace = _Trace()
                trace.add(mark.points.tolist(), "z")
                fills.append(trace.path(corner))
            case Arc():
                ends, closed = _ends(mark)
                r = round(MICRO * mark.radius)
                lines[mark.style].add(ends, closed, f"A{r} {r} 0 0 0 ")
            case Line():
                lines[mark.style].add((mark.a, mark.b))
            case _:
                lines[mark.style].add(mark.points.tolist(), "z" if mark.closed else "")
    body = "".join((
        *(_group(f'stroke-width="{MICRO * line_type(style).width:g}"', [lines[style].path(corner)]) for style in lines),
        _group('stroke="none" fill="#000"', fills),
        *(_group(f'stroke-width="{MICRO * PEN * height:g}"', [texts[height].path(corner)]) for height in sorted(texts)),
    ))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" version="1.1" width="{box.width:g}mm" height="{box.height:g}mm" '
        f'viewBox="0 0 {MICRO * box.width:.0f} {MICRO * box.height:.0f}">\n'
        f'<g fill="none" stroke="#000" stroke-linecap="round" stroke-linejoin="round">\n{body}</g>\n</svg>\n'
    ).encode()


MICRO = 1000.0
"""Micrometres in a millimetre."""


class _Trace:
    """Lines of one style, collected into one path."""

    def __init__(self) -> None:
        self.points: list[complex] = []
        self.form: list[str] = []

    def add(self, points: Sequence[complex], closed: str = "", to: str = "L") -> None:
        """Add a line through points of the sheet, complex mm; ``to``: the path command from one to the next."""
        self.points += points
        self.form.append("M%d %d" + f"{to}%d %d" * (len(points) - 1) + closed)

    def path(self, corner: complex) -> str:
        """Path element, in micrometres from ``corner``, the upper left one of the picture."""
        z = (np.array(self.points) - corner) * MICRO
        places = np.rint(np.column_stack((z.real, -z.imag))).astype(int)
        data = "".join(self.form) % tuple(places.ravel().tolist())
        return f'<path d="{data}"/>'


def _paths(marks: Iterable[Mark], called: str) -> str:
    """Groups of marks by line type, filled areas and lettering last; ``called``: the attribute with the name of a group."""
    lines: dict[str, list[str]] = {}
    fills: list[str] = []
    texts: dict[float, list[str]] = {}
    for mark in strokes(marks):
        check(mark)
        if isinstance(mark, Text):
            data = "".join(_polyline(points.tolist()) for points in letters(mark))
            texts.setdefault(mark.height, []).append(f'<path aria-label="{escaped(mark.text)}" d="{data}"/>')
        elif isinstance(mark, Fill):
            fills.append(f'<path d="{_polyline(mark.points.tolist())}z"/>')
        else:
            lines.setdefault(mark.style, []).append(f'<path d="{_path(mark)}"/>')
    return "".join((
        *(_group(f'{called}="{style}" stroke-width="{line_type(style).width:g}"', lines[style]) for style in lines),
        _group(f'{called}="fills" stroke="none" fill="#000"', fills),
        *(_group(f'{called}="text-{height:g}" stroke-width="{PEN * height:g}"', texts[height]) for height in sorted(texts)),
    ))


def _group(look: str, paths: list[str]) -> str:
    return "\n".join((f"<g {look}>", *paths, "</g>\n")) if paths else ""


def _path(mark: Line | Arc | Polyline) -> str:
    if isinstance(mark, Line):
        return _polyline((mark.a, mark.b))
    if isinstance(mark, Polyline):
        return _polyline(mark.points.tolist()) + ("z" if mark.closed else "")
    ends, closed = _ends(mark)
    arc = f"A{_number(mark.radius)} {_number(mark.radius)} 0 0 1 "
    return f"M{_place(ends[0])}" + "".join(arc + _place(end) for end in ends[1:]) + closed


def _ends(mark: Arc) -> tuple[list[complex], str]:
    """End points of the pieces of an arc, complex mm, and "z" for a whole circle."""
    n = max(ceil((mark.end - mark.start) / PIECE - 1e-9), 1)
    ends = [mark.centre + mark.radius * exp(1j * (mark.start + (mark.end - mark.start) * i / n)) for i in range(n + 1)]
    return ends, "z" if mark.end - mark.start > 2 * pi - 1e-9 else ""


def _polyline(points: Iterable[complex]) -> str:
    return "M" + "L".join(map(_place, points))


def _place(p: complex) -> str:
    return f"{_number(p.real)} {_number(p.imag)}"


def _number(value: float) -> str:
    """A number with three decimals at most, without trailing zeros."""
    text = f"{value:.3f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


_ESCAPES = {
    **dict.fromkeys((*range(9), 0xb, 0xc, *range(0xe, 0x20), *range(0xd800, 0xe000), 0xfffe, 0xffff), "\ufffd"),
    **{ord(sign): f"&{name};" for sign, name in (("&", "amp"), ("<", "lt"), (">", "gt"), ('"', "quot"))},
}


def escaped(text: str) -> str:
    """Escape text for XML; control characters, which XML cannot hold, are replaced."""
    return text.translate(_ESCAPES)
