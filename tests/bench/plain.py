"""The same sheets written the plain way, for ``build`` to beat: one ezdxf call an entity, one of reportlab's canvas a stroke.

Run as ``python plain.py LISTS FOLDER`` in a process of its own, so that it imports the two libraries and nothing of this package.
``LISTS`` is a pickle that :mod:`tests.bench.whole` prepares: nothing is composed here, no letter is laid out.
"""

from __future__ import annotations

import math
import pickle
import sys
from pathlib import Path
from typing import Any

import ezdxf
from reportlab.pdfbase import pdfmetrics
from reportlab.pdfbase.ttfonts import TTFont
from reportlab.pdfgen.canvas import Canvas

MM = 72 / 25.4
CAP = 0.7


def dxf(sheet: dict[str, Any], styles: dict[str, Any], path: Path) -> None:
    """One modelspace call for every stroke."""
    doc = ezdxf.new("R2010", units=ezdxf.units.MM)  # type: ignore[attr-defined]
    for look in styles.values():
        if look["linetype"] not in doc.linetypes:
            doc.linetypes.add(look["linetype"], [sum(map(abs, look["pattern"])), *look["pattern"]])
        if look["layer"] not in doc.layers:
            doc.layers.add(look["layer"], color=look["colour"], linetype=look["linetype"], lineweight=look["weight"])
    msp = doc.modelspace()
    for kind, style, *what in sheet["strokes"]:
        attributes = {"layer": styles[style]["layer"], "linetype": "Continuous"}
        if kind == "line":
            msp.add_line(*what, dxfattribs=attributes)  # type: ignore[misc]
        elif kind == "circle":
            msp.add_circle(*what, dxfattribs=attributes)  # type: ignore[misc]
        elif kind == "arc":
            centre, radius, start, end = what
            msp.add_arc(centre, radius, math.degrees(start), math.degrees(end), dxfattribs=attributes)
        elif kind == "polyline":
            points, closed = what
            msp.add_lwpolyline(points, close=closed, dxfattribs=attributes)
        elif len(what[0]) in (3, 4):
            p = what[0]
            msp.add_solid([p[0], p[1], p[-1], p[2]], dxfattribs=attributes)
        else:
            msp.add_hatch(color=256, dxfattribs=attributes).paths.add_polyline_path(what[0])
    for points, weight in sheet["letters"]:
        msp.add_lwpolyline(points, dxfattribs={"layer": styles["TEXT"]["layer"], "lineweight": weight})
    doc.saveas(path)


def pdf(sheet: dict[str, Any], styles: dict[str, Any], path: Path) -> None:
    """One canvas call for every stroke and run of lettering."""
    page = Canvas(str(path), pagesize=(sheet["width"] * MM, sheet["height"] * MM))
    page.scale(MM, MM)
    page.setLineCap(1)
    page.setLineJoin(1)
    for kind, style, *what in sheet["strokes"]:
        page.setLineWidth(styles[style]["width"])
        if kind == "line":
            (ax, ay), (bx, by) = what
            page.line(ax, ay, bx, by)
        elif kind == "circle":
            (x, y), r = what
            page.circle(x, y, r)
        elif kind == "arc":
            (x, y), r, start, end = what
            page.arc(x - r, y - r, x + r, y + r, math.degrees(start), math.degrees(end - start))
        else:
            points, closed = (what[0], True) if kind == "fill" else what
            outline = page.beginPath()
            outline.moveTo(*points[0])
            for x, y in points[1:]:
                outline.lineTo(x, y)
            if closed:
                outline.close()
            page.drawPath(outline, stroke=kind != "fill", fill=kind == "fill")
    for (x, y), text, height, angle in sheet["texts"]:
        page.setFont("lettering", height / CAP)
        if angle:
            page.saveState()
            page.translate(x, y)
            page.rotate(math.degrees(angle))
            page.drawString(0, 0, text)
            page.restoreState()
        else:
            page.drawString(x, y, text)
    page.showPage()
    page.save()


def main(lists: str, folder: str) -> None:
    """Write every sheet in both formats."""
    prepared = pickle.loads(Path(lists).read_bytes())
    pdfmetrics.registerFont(TTFont("lettering", prepared["font"], asciiReadable=False))
    for n, sheet in enumerate(prepared["sheets"], 1):
        dxf(sheet, prepared["styles"], Path(folder, f"sheet{n}.dxf"))
        pdf(sheet, prepared["styles"], Path(folder, f"sheet{n}.pdf"))


if __name__ == "__main__":
    main(*sys.argv[1:])
