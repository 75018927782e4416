"""What lies on a sheet, as areas of ink, found without the code that writes: shapely on points taken from the marks."""

from math import cos, sin

import numpy as np
import shapely

from tmm_sheets.drawing.ink import strokes
from tmm_sheets.drawing.lettering import strokes as letter_strokes
from tmm_sheets.drawing.marks import Fill, Text, flat
from tmm_sheets.drawing.styles import line_type


def shape(points):
    """Line string of complex points; a point when there is no way between them."""
    xy = np.column_stack((np.real(points), np.imag(points)))
    return shapely.LineString(xy) if len(xy) > 1 and np.ptp(xy, axis=0).any() else shapely.Point(xy[0])


def polygon(points):
    return shapely.Polygon(np.column_stack((np.real(points), np.imag(points))))


def drawn(drawing):
    """(line, width) of every stroke and (polygon, 0) of every filled area of a drawing."""
    for mark in strokes(drawing.marks):
        if isinstance(mark, Text):
            turn = complex(cos(mark.angle), sin(mark.angle))
            for stroke in letter_strokes(mark.text, mark.height):
                yield shape(mark.at + turn * stroke), mark.height / 10
        elif isinstance(mark, Fill):
            yield polygon(mark.points), 0.0
        else:
            yield shape(flat(mark, 0.1)), line_type(mark.style).width


def area(strokes):
    """Area covered by (line, width)."""
    return shapely.union_all([s.buffer(w / 2, quad_segs=32) if w else s for s, w in strokes])


def beyond(a, b, margin):
    """Area of what of ``a`` lies more than ``margin`` mm outside ``b``, square mm."""
    return a.difference(b.buffer(margin)).area
