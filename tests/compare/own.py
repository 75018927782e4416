"""Our own files of the shipped projects, each compared with its project: nothing may be found in any of them.

Usage: python -m tests.compare.own [--png DPI | --pdf | --dxf] [--projects NAME ...] [--sheets one|all] [--minutes M]

``one`` takes one sheet of each project, the next one of the next project.
"""

import argparse
import tempfile
from collections import Counter
from pathlib import Path
from time import perf_counter

import numpy as np

from tmm_sheets import catalogue
from tmm_sheets.backends import dxf, pdf, png
from tmm_sheets.compare.cad import cad_drawing, cad_file
from tmm_sheets.compare.elements import elements
from tmm_sheets.compare.photo import tracing
from tmm_sheets.compare.photo.judging import judge
from tmm_sheets.compare.photo.photograph import read
from tmm_sheets.compare.photo.rectification import rectify
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed


def by_image(project, n, path):
    """Findings (verdict, words) of a print, as ``compare --image`` has them, and how many elements were judged."""
    known = elements(composed(project, n))
    picture = read(path)
    found = rectify(picture, known, path)
    said = [("note", note) for note in (*picture.notes, *found.notes)]
    if not found.check.acceptable:
        return [*said, ("refused", f"fit {found.check}")], 0
    traces, extra = tracing.trace(known, found.ink)
    findings = [judge(t, 0.25, found.uncertainty) for t in traces]
    for f in findings:
        if f.verdict != "green":
            e = f.trace.element
            said.append((f.verdict, f"element {e.number} {e.kind} {e.style} {e.name!r}, {e.length:.0f} mm, about "
                        f"({f.at.real:.1f}, {f.at.imag:.1f}), view {e.view.name!r}: {f.what}"))
    said += [("extra", f"{x.width:.0f} x {x.height:.0f} mm about ({x.middle.real:.1f}, {x.middle.imag:.1f})") for x in extra]
    return said, sum(f.trace.status in ("measured", "missing") for f in findings)


def by_cad(project, n, path):
    """The same of a DXF file, as ``compare --dxf`` has them."""
    found = cad_drawing.examine(project, range(n, n + 1), cad_file.read(path))
    said = [("note", note) for note in found.notes]
    for f in found.outcome.findings:
        e = f.element
        if f.verdict != "green":
            said.append((str(f.verdict), f"element {e.number} {e.kind} {e.style} {e.name!r}, view {e.view.name!r}: "
                        f"{f.what}"))
        elif f.deviation > 0.01:
            said.append(("off", f"element {e.number} {e.kind} {e.style} {f.deviation:.3f} mm"))
    said += [("look", f"{len(x.elements)} {x.lines} {x.what}: {x.elements[:5]} in {x.view and x.view.name!r}") for x in
             found.outcome.looks]
    said += [("extra", f"{x.length:.1f} mm about ({x.at.real:.1f}, {x.at.imag:.1f}) {x.text}") for x in found.outcome.extras]
    return said, len(found.outcome.findings)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--png", type=float, metavar="DPI")
    parser.add_argument("--pdf", action="store_true")
    parser.add_argument("--dxf", action="store_true")
    parser.add_argument("--projects", nargs="+", default=list(catalogue.shipped()))
    parser.add_argument("--sheets", choices=("one", "all"), default="one")
    parser.add_argument("--shift", type=int, default=0, help="with one: begin with another sheet")
    parser.add_argument("--minutes", type=float, default=600.0, help="stop after so long")
    options = parser.parse_args()
    if sum((options.png is not None, options.pdf, options.dxf)) != 1:
        parser.error("give one of --png DPI, --pdf, --dxf")
    name, compared = ("sheet.dxf", by_cad) if options.dxf else ("sheet.pdf" if options.pdf else "sheet.png", by_image)
    told, judged, seconds = Counter(), 0, []
    start = perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        for k, key in enumerate(options.projects):
            project = Project(catalogue.read(key))
            count = len(project.variant.sheets)
            for n in range(1, count + 1) if options.sheets == "all" else [(k + options.shift) % count + 1]:
                drawing = composed(project, n).drawing
                if options.dxf:
                    path.write_bytes(dxf.render(drawing))
                else:
                    path.write_bytes(pdf.render(drawing) if options.pdf else png.render(drawing, options.png))
                before = perf_counter()
                try:
                    said, size = compared(project, n, path)
                except (BadInput, CannotBuild) as e:
                    said, size = [("refused", str(e))], 0
                seconds.append((perf_counter() - before, f"{key} {n}"))
                judged += size
                told.update(what for what, _ in said)
                for what, words in said:
                    print(f"{key} {n}: {what}: {words}", flush=True)
            if perf_counter() - start > 60 * options.minutes:
                break
    worst = max(seconds)
    print(f"{len(seconds)} sheets, {judged} elements judged; {dict(told) or 'nothing found'}; seconds a sheet: median "
          f"{np.median([s for s, _ in seconds]):.2f}, worst {worst[0]:.2f} ({worst[1]})")


if __name__ == "__main__":
    main()
