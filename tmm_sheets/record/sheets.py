"""Sheets in the record: where plans lie on the paper, and every mark with its role and its step."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Container
from typing import TYPE_CHECKING, Any

from tmm_sheets.drawing.marks import Arc, Fill, Line, Polyline, Text
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.drawing.canvas import Part
    from tmm_sheets.drawing.marks import Mark, Points
    from tmm_sheets.sheets.composed import Composed

DIGITS = 6
"""Decimals of a millimetre."""
BY_STYLE = {"construction": "construction", "hatch": "hatch", "axis": "axis", "centre": "axis", "curve": "curve",
            "vector": "vector", "text": "text"}
"""Role of a mark that nobody has given one, by its line type; others are parts of symbols."""


def sheet(number: int, composed: Composed, known: Container[str]) -> dict[str, Any]:
    """A drawn sheet; ``known`` are the ids of the recorded steps."""
    parts = composed.parts
    starts, names = [part.first for part in parts], [_name(part) for part in parts]
    frames = [{"id": i, "view": names[f.view] if 0 <= f.view < len(names) else "", "plan": f.plan, "position": f.position,
               "origin": _point(f.origin), "mu": list(f.mu), "turn": f.turn, "mirror": f.mirror}
              for i, f in enumerate(composed.frames)]  # fmt: skip
    several = [g for g in composed.groups if g.kind == "lettering" and g.end - g.first > 1]
    letterings = {i: g.first for g in several for i in range(g.first, g.end)}
    marks = []
    for i, mark in enumerate(composed.drawing.marks):
        view = bisect_right(starts, i) - 1
        block = 0 <= view < len(parts) and parts[view].draw == "title block"
        told = _mark(i, mark, names[view] if view >= 0 else "", block, known)
        marks.append(told | {"lettering": letterings[i]} if i in letterings else told)
    drawing = composed.drawing
    return {"sheet": number, "title": drawing.title, "size": [drawing.width, drawing.height], "frames": frames, "marks": marks}


def _name(part: Part) -> str:
    """Name of a view: what stands over it, without lettering markup, or how the arrangement calls it."""
    return re.sub(r"[_^]\{?|[{}]", "", part.title) or part.draw


def called(view: str) -> str:
    """What a view without a title is called in the language of the sheets; empty for one that has a title."""
    from tmm_sheets.sheets.views import VIEWS

    return tr(VIEWS[view].name) if view in VIEWS and VIEWS[view].name else ""


def _mark(number: int, mark: Mark, view: str, block: bool, known: Container[str]) -> dict[str, Any]:
    found: dict[str, Any] = {"id": number, "view": view}
    by = mark.by
    if by is not None and by.frame >= 0:
        found["frame"] = by.frame
    found |= {"role": _role(mark, block), "style": "text" if isinstance(mark, Text) else mark.style, "geometry": geometry(mark)}
    if by is not None and by.step in known:
        found["step"] = by.step
        if by.position:
            found["position"] = by.position
    if by is not None and (name := getattr(by, "name", "")):
        found["name"] = name
    return found


def _role(mark: Mark, block: bool) -> str:
    if isinstance(mark, Text):
        return "text"
    if mark.by is not None:
        return mark.by.role
    return "frame" if block else BY_STYLE.get(mark.style, "symbol")


def geometry(mark: Mark) -> dict[str, Any]:
    """Shape of a mark, mm and rad."""
    if isinstance(mark, Line):
        return {"line": [_point(mark.a), _point(mark.b)]}
    if isinstance(mark, Arc):
        centre, radius = _point(mark.centre), round(float(mark.radius), DIGITS)
        if abs(mark.end - mark.start) >= 2 * 3.141592653589:
            return {"circle": {"centre": centre, "radius": radius}}
        return {"arc": {"centre": centre, "radius": radius, "from": round(float(mark.start), 9), "to": round(float(mark.end), 9)}}
    if isinstance(mark, Polyline):
        return {"polyline": _points(mark.points), **({"closed": True} if mark.closed else {})}
    if isinstance(mark, Fill):
        return {"fill": _points(mark.points)}
    return {"text": {"at": _point(mark.at), "height": mark.height, "angle": round(float(mark.angle), 9), "string": mark.text,
                     **({"wide": mark.wide} if mark.wide != 1.0 else {})}}


def _point(z: complex) -> list[float]:
    return [round(float(z.real), DIGITS), round(float(z.imag), DIGITS)]


def _points(points: Points) -> list[list[float]]:
    return [_point(z) for z in points.tolist()]
