"""What is told of a compared picture: the table, the tree for JSON, the overlays."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from math import degrees
from pathlib import Path
from typing import Any

import numpy as np

from tmm_sheets.compare.elements import Element, dashed
from tmm_sheets.compare.photo import overlay
from tmm_sheets.compare.photo.judging import SOFT_TOLERANCE, PhotoFinding, judge
from tmm_sheets.compare.photo.rectification import Rectified
from tmm_sheets.compare.photo.traces import ExtraInk, Trace
from tmm_sheets.compare.report import Report


def _called(e: Element) -> str:
    return f"{e.kind} {e.name}".strip()


def image_report(
    name: str, n: int, path: Path, found: Rectified, traces: Sequence[Trace], extra: Sequence[ExtraInk], pencil: float,
    notes: tuple[str, ...],
) -> Report:
    """The table, the tree and the overlays of sheet ``n`` of the project ``name`` compared with the picture at ``path``."""
    findings = [judge(t, pencil, found.uncertainty, found.soft) for t in traces]
    bad = [f for f in findings if f.verdict != "green"]
    order = {"red": 0, "amber": 1, "green": 2}
    bad.sort(key=lambda f: (order[f.verdict], -f.share))
    measured = [f for f in findings if f.trace.status == "measured"]
    lines = [f for f in findings if f.trace.status in ("measured", "missing", "shared") and not f.unknown]
    count = {v: sum(f.verdict == v for f in lines) for v in ("green", "amber", "red")}
    dense, hidden = sum(f.unknown for f in findings), sum(f.hidden_ends for f in findings)
    soft = SOFT_TOLERANCE if found.soft else 0.0
    out = [
        f"Sheet {n} of {name}, {path.name}: {sum(count.values())} elements judged, {count['green']} within a pencil's reach, "
        f"{count['amber']} up to twice that, {count['red']} beyond",
        f"{dense} elements are too near to others to be measured; {hidden} ends of main lines and vectors lie under others and are "
        f"judged only as far as they show; {len(extra)} places with ink that is not on the sheet",
        f"Tolerance {pencil + found.uncertainty + soft:.2f} mm: pencil {pencil:.2f}, rectification {found.uncertainty:.2f}"
        + (f", a picture that is not sharp {soft:.2f}; ends of thin lines are not judged" if soft else ""),
    ]
    rows = [(str(k), f.verdict, f"{f.off:.1f}" if f.off else "", _called(f.trace.element), f.trace.element.view.name, f.said)
            for k, f in enumerate(bad, 1)]  # fmt: skip
    rows += [(str(k), "amber", f"{x.length:.0f}", "extra ink", "", f"{x.width:.0f} x {x.height:.0f} mm about "
              f"x = {x.middle.real:.0f}, y = {x.middle.imag:.0f}") for k, x in enumerate(extra, len(bad) + 1)]  # fmt: skip
    if rows:
        head = ("No.", "", "mm", "Element", "View", "What")
        widths = [min(max(len(r[i]) for r in (head, *rows)), 44) for i in range(5)]
        out.append("")
        for r in (head, *rows):
            cells = [c[:44].rjust(w) if i in (0, 2) else c[:44].ljust(w) for i, (c, w) in enumerate(zip(r, widths, strict=False))]
            out.append("  ".join([*cells, r[5]]).rstrip())
    flags = [overlay.Flag(k, f.verdict, f.place, _shown(f.trace)) for k, f in enumerate(bad, 1)]
    flags += [overlay.Flag(k, "amber", x.middle, np.zeros(0, complex)) for k, x in enumerate(extra, len(bad) + 1)]
    ours = [p for t in traces if t.element.kind != "text" for p in dashed(t.element)]
    title = f"{name}: sheet {n}, {path.name}"
    with ThreadPoolExecutor(1) as aside:  # half of the time goes into packing, which runs beside Python
        drawn = aside.submit(overlay.png, found.ink, found.level, ours, flags)
        page = overlay.pdf(found.ink, found.level, ours, flags, title)
        files = {f"compare_sheet_{n}.png": drawn.result(), f"compare_sheet_{n}.pdf": page}
    tree = {
        "project": name, "sheet": n, "image": path.name, "pixels_per_mm": round(found.scale, 2), "matched": round(found.match, 3),
        "tolerance": round(pencil + found.uncertainty + soft, 3),
        "count": {**count, "dense": dense, "hidden_ends": hidden, "measured": len(measured)},
        "elements": [_row(f) for f in findings if f.trace.status in ("measured", "shared", "missing", "dense", "absent lettering")],
        "extra": [{"x": round(x.middle.real, 1), "y": round(x.middle.imag, 1), "width": round(float(x.width), 1),
                   "height": round(float(x.height), 1)} for x in extra],
        "notes": list(notes),
    }  # fmt: skip
    return Report("\n".join(out), tree, files, notes)


def _shown(t: Trace) -> Any:
    """The line to be drawn in red: where the hand has it, else where it ought to be."""
    if t.element.kind in ("text", "hatch"):
        return np.append(t.element.points, t.element.points[:1])
    return t.at if t.at is not None else t.element.points


def _row(f: PhotoFinding) -> dict[str, Any]:
    t = f.trace
    ends = [round(float(x), 2) if np.isfinite(x) else None for x in t.ends]
    measured = t.status in ("measured", "shared")
    return {
        "number": t.element.number, "view": t.element.view.name, "name": t.element.name, "kind": t.element.kind,
        "status": t.status, "verdict": f.verdict, "said": f.said,
        "shift": [round(t.shift.real, 2), round(t.shift.imag, 2)] if measured else None,
        "turn_deg": round(degrees(t.turn), 3) if measured else None, "growth": round(t.growth, 2) if measured else None,
        "ends": ends, "deviation": round(t.deviation, 2) if measured else None, "tolerance": round(f.tolerance, 2),
    }  # fmt: skip
