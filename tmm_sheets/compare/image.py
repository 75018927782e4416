"""A hand drawing photographed or scanned, compared with the exact sheet element by element."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import degrees, hypot
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.compare import overlay, photographed_views, rectification, tracing, view_places
from tmm_sheets.compare.elements import Element, dashed, elements
from tmm_sheets.compare.elements import views as views_of
from tmm_sheets.compare.photograph import Picture, read
from tmm_sheets.compare.report import Report, Verdict, verdict
from tmm_sheets.compare.tracing import LOOSE_STYLES, Extra, Trace
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.sheets.sheet import composed

if TYPE_CHECKING:
    from tmm_sheets.project import Project

LEAST_SCALE, FAIR_SCALE = 2.0, 3.0
"""Pixels per mm of the sheet below which a photograph is refused, or warned of."""
BLURRED, SOFT = 0.36, 0.31
"""Standard deviation of the smear, mm, above which a picture is refused, or warned of; a fair photograph has 0.2 to 0.3."""
MATCH, CERTAIN = 0.5, 0.12
"""Share of a sheet's lines that must be in the picture where they belong, and by how much another sheet must do better."""
RECTIFIED = 0.15
"""Error of a place after rectification, mm: some 95 % of the places of simulated photographs are within it."""
LOOSE = 2.5  # mm by which lines whose ends mean nothing may be too long or too short
TURNS = {1: "a quarter turn clockwise", 2: "a half turn", 3: "a quarter turn counter-clockwise"}


@dataclass(frozen=True)
class Finding:
    """A trace judged: what is off by how much, and whether that is within a pencil's reach."""

    trace: Trace
    verdict: Verdict
    said: str
    off: float
    tolerance: float
    place: complex

    @property
    def share(self) -> float:
        """Deviation by tolerance."""
        return self.off / self.tolerance


def compare(
    project: Project, n: int, path: Path, views: Path | None = None, pencil: float = 0.25,
    say: Callable[[str], None] = lambda _: None,
) -> Report:
    """Compare a photograph of sheet ``n`` with the exact sheet.

    Parameters
    ----------
    path
        JPG, PNG or PDF.
    views
        File that tells where the views of a sheet with a layout of its own stand (see ``view_places``).
    pencil
        Error of a point drawn by hand, mm.
    say
        Told what is being done.

    Raises
    ------
    BadInput
        When a file is missing or of no use, or there is no such sheet.
    CannotBuild
        When the picture has no frame, shows another sheet, or is too blurred or too small.
    """
    count = len(project.variant.sheets)
    if not 1 <= n <= count:
        raise BadInput(f"{project.variant.project.name} has {count} sheets; there is no sheet {n}",
                       hint=f"--sheet 1 to --sheet {count}")  # fmt: skip
    say("reading the picture")
    picture = read(path)
    say("composing the sheet")
    sheet = composed(project, n)
    known = elements(sheet)
    # The file first: it is quickly read, and what is wrong with it is quickly told.
    places = view_places.read(views, views_of(sheet)) if views is not None else ()
    found = rectify(picture, known, path, say, not places)
    notes = (*picture.notes, *found.notes)
    whole = True
    if places:
        say("placing the views")
        placed = photographed_views.place(known, places, found.map, found.ink)
        known, notes, whole = placed.elements, (*notes, *placed.notes), not placed.left_out
        if all(e.view.n == 0 for e in known):
            raise CannotBuild(f"{path}: none of the views of sheet {n} was found", hint="; ".join(placed.notes))
    elif found.match < MATCH:
        _wrong_sheet(project, n, found, path, say)
    say("measuring the elements")
    traces, extra = tracing.trace(known, found.ink)
    # Ink of views that were left out is not too much.
    return _report(project, n, path, found, traces, extra if whole else (), pencil, notes)


@dataclass(frozen=True)
class Rectified:
    """The sheet seen from straight above: ``ink`` as ``rectification.straighten`` makes it, ``map`` the way there.

    ``match`` is the share of the known lines that were found in place, ``uncertainty`` the error of a place, mm, ``scale`` pixels
    of the picture per mm.
    """

    ink: Any
    map: rectification.Map
    level: float
    match: float
    uncertainty: float
    scale: float
    notes: tuple[str, ...]


def frame_lines(known: Sequence[Element]) -> rectification.Lines:
    """Lines of the title block and of the box for the turned designation, by which a frame is known."""
    return tracing.as_lines([e for e in known if e.of == "title block" and e.length < 800], 4.0)


def rectify(
    picture: Picture, known: Sequence[Element], path: Path, say: Callable[[str], None] = lambda _: None, by_lines: bool = True,
) -> Rectified:
    """Bring a photographed sheet to millimetres; ``by_lines``: the drawing's lines correct what the frame has left.

    Raises
    ------
    CannotBuild
        When there is no frame, or the picture is too blurred or too small.
    """
    say("looking for the frame")
    try:
        found = rectification.find(picture.grey, frame_lines(known))
        m, scatter, smear = rectification.fit_frame(picture.grey, found)
    except CannotBuild as e:
        raise CannotBuild(f"{path}: {e.args[0]}", hint=e.hint) from None
    scale = float(np.abs(np.diff(found.corners)).min() / rectification.FRAME.height)
    if scale < LEAST_SCALE:
        raise CannotBuild(f"{path}: the sheet is {scale:.1f} pixels per millimetre: too few to measure lines 0.2 mm wide",
                          hint="go nearer, or use more pixels: an A1 sheet that fills 12 million pixels has 4.5")  # fmt: skip
    if smear > BLURRED:
        raise CannotBuild(f"{path}: the picture is blurred: edges of lines are smeared over {2 * smear:.1f} mm",
                          hint=rectification.SHARP)  # fmt: skip
    notes = []
    if found.turned:
        notes.append(f"{path.name} was turned by {TURNS[found.turned]} (the title block is known)")
    if scale < FAIR_SCALE:
        notes.append(f"{path.name} has {scale:.1f} pixels per millimetre only: thin lines may be missed")
    if smear > SOFT:
        notes.append(f"{path.name} is not sharp (edges of lines are smeared over {2 * smear:.1f} mm): thin lines may be missed")
    ink = rectification.straighten(picture.grey, m)
    level = tracing.noise_level(ink)
    pale = tracing.line_level(ink)
    say("correcting by the drawing's lines")
    lines = tracing.as_lines([e for e in known if e.length < 2500 and (by_lines or e.of == "title block")])
    better, _, match = rectification.refine(m, ink, lines, pale)
    if by_lines and match >= MATCH:
        m = better
        ink = rectification.straighten(picture.grey, m)
        level = tracing.noise_level(ink)
    return Rectified(ink, m, level, match, hypot(RECTIFIED if by_lines else 2 * RECTIFIED, scatter), scale, tuple(notes))


def _wrong_sheet(project: Project, n: int, found: Rectified, path: Path, say: Callable[[str], None]) -> None:
    """Say which sheet of the project it is rather.

    Raises
    ------
    CannotBuild
        Always.
    """
    best, share = n, found.match
    for k in range(1, len(project.variant.sheets) + 1):
        if k == n:
            continue
        say(f"trying sheet {k}")
        lines = tracing.as_lines([e for e in elements(composed(project, k)) if e.length < 2500], most=2500)
        _, _, match = rectification.refine(found.map, found.ink, lines, found.level)
        if match > share:
            best, share = k, match
    missing = f"only {100 * found.match:.0f} % of the lines of sheet {n} are where they belong"
    if best != n and share > max(MATCH, found.match + CERTAIN):
        raise CannotBuild(f"{path} does not show sheet {n} but sheet {best} of {project.variant.project.name}: {missing}, "
                          f"{100 * share:.0f} % of sheet {best}'s are", hint=f"try --sheet {best}")  # fmt: skip
    raise CannotBuild(f"{path} does not show a sheet of {project.variant.project.name} as it is drawn here: {missing}",
                      hint="is it another project or variant? A drawing with a layout of its own needs --views FILE, "
                      "which tells where its views stand")  # fmt: skip


# --- judging
# ------------------------------------------------------------------------------------------------------------------------------


def judge(t: Trace, pencil: float, uncertainty: float) -> Finding:
    """What a trace tells, in words, and how bad it is."""
    e, tolerance = t.element, pencil + uncertainty
    middle = complex(e.points[len(e.points) // 2]) if e.kind != "line" else complex(e.points.mean())
    if t.status == "missing":
        return Finding(t, "red", "missing", e.length, tolerance, middle)
    if t.status == "absent lettering":
        return Finding(t, "amber", "no lettering here", 0.0, tolerance, complex(e.points.mean()))
    if t.status != "measured":
        return Finding(t, "green", {"dense": "not measurable: too near to others"}.get(t.status, "there"), 0.0, tolerance, middle)
    said, worst, off, limit, place = [], 0.0, t.deviation, tolerance, middle
    if t.at is not None and len(t.at) == len(e.points):
        place = complex(e.points[int(np.abs(t.at - e.points).argmax())])
    if t.deviation > tolerance:
        said.append(_displaced(t, tolerance))
    worst = t.deviation / tolerance
    loose = e.style in LOOSE_STYLES
    for end, which, at in ((t.ends[0], "beginning", e.points[0]), (t.ends[1], "end", e.points[-1])):
        if not np.isfinite(end):
            continue
        allowed = LOOSE if loose else 2 * pencil + uncertainty + 0.2  # 0.2 mm: the steps in which ends are seen
        if abs(end) > allowed:
            said.append(f"{abs(end):.1f} mm too {'long' if end > 0 else 'short'} at its {which}")
        if abs(end) / allowed > worst:
            worst, off, limit, place = abs(end) / allowed, abs(end), allowed, complex(at)
    return Finding(t, verdict(off, limit), "; ".join(said) or "within a pencil's reach", off, limit, place)


def _displaced(t: Trace, tolerance: float) -> str:
    e = t.element
    said = []
    if e.kind in ("circle", "arc") and abs(t.growth) > 0.5 * tolerance:
        word = "large" if t.growth > 0 else "small"
        said.append(f"radius {abs(t.growth):.1f} mm too {word} ({e.radius + t.growth:.1f} for {e.radius:.1f})")
    elif e.kind == "curve" and abs(t.growth) > 0.5 * tolerance:
        half = float(np.abs(e.points - e.points.mean()).max())
        said.append(f"{100 * abs(t.growth) / half:.1f} % too {'large' if t.growth > 0 else 'small'}")
    if abs(t.shift) > 0.5 * tolerance:
        said.append(f"{abs(t.shift):.1f} mm too far {_direction(t.shift)}")
    half = 0.5 * e.length if e.kind == "line" else float(np.abs(e.points - e.points.mean()).max())
    if e.kind != "circle" and abs(t.turn) * half > 0.5 * tolerance:
        said.append(f"turned by {abs(degrees(t.turn)):.2f}° {'counter-clockwise' if t.turn > 0 else 'clockwise'}")
    return ", ".join(said) or f"off by up to {t.deviation:.1f} mm"


def _direction(shift: complex) -> str:
    """Where to: right and up, to a fraction that matters."""
    parts = []
    if abs(shift.imag) > 0.25 * abs(shift):
        parts.append("up" if shift.imag > 0 else "down")
    if abs(shift.real) > 0.25 * abs(shift):
        parts.append("right" if shift.real > 0 else "left")
    return " and ".join(parts)


def _called(e: Element) -> str:
    return f"{e.kind} {e.name}".strip()


def _report(
    project: Project, n: int, path: Path, found: Rectified, traces: Sequence[Trace], extra: Sequence[Extra], pencil: float,
    notes: tuple[str, ...],
) -> Report:
    findings = [judge(t, pencil, found.uncertainty) for t in traces]
    bad = [f for f in findings if f.verdict != "green"]
    order = {"red": 0, "amber": 1, "green": 2}
    bad.sort(key=lambda f: (order[f.verdict], -f.share))
    measured = [f for f in findings if f.trace.status == "measured"]
    lines = [f for f in findings if f.trace.status in ("measured", "missing")]
    count = {v: sum(f.verdict == v for f in lines) for v in ("green", "amber", "red")}
    dense = sum(f.trace.status == "dense" for f in findings)
    name = project.variant.project.name
    out = [
        f"Sheet {n} of {name}, {path.name}: {sum(count.values())} elements judged, {count['green']} within a pencil's reach, "
        f"{count['amber']} up to twice that, {count['red']} beyond",
        f"{dense} elements are too near to others to be measured; {len(extra)} places with ink that is not on the sheet",
        f"Tolerance {pencil + found.uncertainty:.2f} mm: pencil {pencil:.2f}, rectification {found.uncertainty:.2f}",
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
    files = {
        f"compare_sheet_{n}.png": overlay.png(found.ink, found.level, ours, flags),
        f"compare_sheet_{n}.pdf": overlay.pdf(found.ink, found.level, ours, flags, title),
    }
    tree = {
        "project": name, "sheet": n, "image": path.name, "pixels_per_mm": round(found.scale, 2), "matched": round(found.match, 3),
        "tolerance": round(pencil + found.uncertainty, 3), "count": {**count, "dense": dense, "measured": len(measured)},
        "elements": [_row(f) for f in findings if f.trace.status in ("measured", "missing", "dense", "absent lettering")],
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


def _row(f: Finding) -> dict[str, Any]:
    t = f.trace
    ends = [round(float(x), 2) if np.isfinite(x) else None for x in t.ends]
    measured = t.status == "measured"
    return {
        "number": t.element.number, "view": t.element.view.name, "name": t.element.name, "kind": t.element.kind,
        "status": t.status, "verdict": f.verdict, "said": f.said,
        "shift": [round(t.shift.real, 2), round(t.shift.imag, 2)] if measured else None,
        "turn_deg": round(degrees(t.turn), 3) if measured else None, "growth": round(t.growth, 2) if measured else None,
        "ends": ends, "deviation": round(t.deviation, 2) if measured else None, "tolerance": round(f.tolerance, 2),
    }  # fmt: skip
