"""Judging what was found of an element: by how much it is off, what that is, and whether a pencil may be off so far."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import degrees, isnan
from typing import NamedTuple

import numpy as np

from tmm_sheets.compare import codes
from tmm_sheets.compare.codes import Number, Remark, joined
from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.findings import Finding, Outcome, Verdict, millimetres, of_radius, shifted, turned, verdict
from tmm_sheets.compare.photo.line_ends import joint
from tmm_sheets.compare.photo.lost_ink import HALF_THERE, LostToThreshold, may_be_lost, whole
from tmm_sheets.compare.photo.traces import LOOSE_STYLES, InkTrace, open_line
from tmm_sheets.drawing.styles import line_type

LOOSE_ROLES = frozenset({"symbol", "curve"})
"""Beside :data:`LOOSE_STYLES`: the lines of guides and supports, and curves, no end of which is a point of a construction."""
LOOSE, SCARCELY = 2.5, 1.7
"""mm by which those may be too long or too short, a dashed one shorter by its last dash; and by which a line of a construction may
be too short, which is drawn to a point, a curve or another line and not seldom beyond it."""
TINY = 8.0
"""mm; a closed outline of no more to each side is judged by where it is: its sides, each off by a pencil, give it a turn and a size
that say nothing unless they are off by twice as much."""
FORM_ROLES = frozenset({"frame", "table"})
"""Rules of tables and of the form: no construction hangs on them, nor on a circle about a designation, so doubt about them is not
told."""
SHORT = 12.0
"""mm; a helper line of no more, each end off by a pencil, is turned as well: it is off for sure only by twice as much."""
SOFT_TOLERANCE = 0.15  # mm added in a picture that is not sharp
CROWDED, CROWDED_THIN = 0.55, 0.8
"""Share of a line near which no other is drawn below which its own ink cannot be told from theirs to twice a tolerance: it takes
the edge of theirs, a thin line more so."""


@dataclass(frozen=True, eq=False)
class PhotoFinding(Finding):
    """A trace judged: the deviation that counts most, and the ``tolerance`` for it, mm."""

    trace: InkTrace
    tolerance: float

    @property
    def share(self) -> float:
        """Deviation by tolerance."""
        return self.deviation / self.tolerance

    @property
    def outcome(self) -> Outcome:
        """The verdict, unless nothing can be told."""
        untold = self.unknown or self.trace.status in ("hidden", "eaten")
        return "not-judged" if untold and self.verdict == "green" else self.verdict or "not-judged"

    @property
    def unknown(self) -> bool:
        """Whether nothing can be told: its ink is lost among others', or a stroke of several is off and any of them may be."""
        return self.trace.status == "dense" or (self.trace.status == "shared" and self.trace.deviation > self.tolerance)

    @property
    def hidden_ends(self) -> int:
        """How many of its ends are hidden by others, if they mean anything exact."""
        t = self.trace
        exact = t.status == "measured" and not loose_ends(t.element) and open_line(t.element)
        return sum(map(isnan, t.ends)) if exact else 0


def loose_ends(e: Element) -> bool:
    """Whether the ends of an element mean nothing exact."""
    return e.style in LOOSE_STYLES or e.role in LOOSE_ROLES


class _Deviation(NamedTuple):
    """One way in which a line is off: by how much, what is allowed, where, and what is beyond that."""

    off: float
    allowed: float
    place: complex
    said: Remark | None = None

    @property
    def share(self) -> float:
        return self.off / self.allowed


def judge(t: InkTrace, pencil: float, uncertainty: float, soft: bool = False, eats: LostToThreshold = "nothing") -> PhotoFinding:
    """Judge a trace.

    Parameters
    ----------
    t
        What was found.
    pencil, uncertainty
        Error of a point drawn by hand and of a place of the picture, mm.
    soft
        Whether the picture is not sharp: the tolerance is wider, and the ends of thin lines, which fade near others, are not
        judged.
    eats
        What the picture eats of thin lines (see ``lost_ink``): what that may be the reason of is not judged.
    """
    if may_be_lost(t, tolerance := tolerance_of(pencil, uncertainty, soft), eats):
        return PhotoFinding(t.element, "green", 0.0, codes.EATEN(), t.element.middle, InkTrace(t.element, "eaten"), tolerance)
    return _with_head(_in_pieces(_line(t if eats == "nothing" else whole(t), pencil, uncertainty, soft)))


def tolerance_of(pencil: float, uncertainty: float, soft: bool) -> float:
    """How far off a line may be without being wrong, mm; the parameters are those of :func:`judge`."""
    return pencil + uncertainty + (SOFT_TOLERANCE if soft else 0.0)


def _in_pieces(f: PhotoFinding) -> PhotoFinding:
    """What was found of a line of which the picture may have taken the rest: never more than a remark."""
    if f.verdict != "red" or not f.trace.pieces:
        return f
    if f.trace.status == "missing":
        half = f.trace.covered >= HALF_THERE
        if half and f.element.role in FORM_ROLES:
            return replace(f, verdict="green", deviation=0.0, remark=codes.IN_PIECES())
        remark: Remark | None = codes.HALF_SEEN() if half else codes.THIN_NOT_SEEN()
    else:
        remark = joined((f.remark, codes.IN_PIECES()), "; ")
    return replace(f, verdict="amber", remark=remark)


def _with_head(f: PhotoFinding) -> PhotoFinding:
    """What was found of an arrow, and of its head."""
    e, head = f.element, f.trace.head
    if head == "reversed":
        return replace(f, verdict="red", deviation=e.length, remark=codes.ARROW_POINTS_BACK())
    if head == "doubled" and f.verdict == "green":
        return replace(f, verdict="amber", remark=codes.HEAD_AT_BEGINNING(), at=complex(e.points[0]))
    if head == "absent" and f.verdict != "green":  # what was drawn elsewhere has its head there
        return f
    if head in ("absent", "left out"):
        no_head = codes.NO_HEAD_HERE() if head == "absent" else codes.THIN_LINE_ONLY()
        remark = no_head if f.verdict == "green" else joined((f.remark, no_head), "; ")
        return replace(f, verdict="amber" if f.verdict == "green" else f.verdict, remark=remark, at=complex(e.fills[0][0]))
    return f


def _line(t: InkTrace, pencil: float, uncertainty: float, soft: bool) -> PhotoFinding:
    """Judge what was found of a line or of lettering, heads aside."""
    e, tolerance = t.element, tolerance_of(pencil, uncertainty, soft)
    middle = complex(e.points[len(e.points) // 2]) if e.kind != "line" else complex(e.points.mean())
    if t.status == "measured":
        ends = [*_ends(t, pencil, tolerance, soft)]
        deviations = [_displacement(t, tolerance, middle), *ends]
        if _crowded(t, tolerance):
            del deviations[0]
            if all(d.share <= 1 for d in deviations):
                return PhotoFinding(e, "green", 0.0, codes.TOO_NEAR(), middle, replace(t, status="dense"), tolerance)
        elif _tiny(e):
            deviations = _of_tiny(t, tolerance, deviations[0])
        if _loosely_judged(e) and deviations[0].share <= 2 and any(d.share > 1 for d in ends):
            deviations = ends  # how a short line is turned is no matter, where it ends is
        worst = max(deviations, key=lambda d: d.share)
        if 1 < worst.share <= 2 and _loosely_judged(e) and (e.role in FORM_ROLES or worst not in ends):
            return PhotoFinding(e, "green", worst.off, codes.A_LITTLE_ASIDE(), worst.place, t, tolerance)
        said = joined((d.said for d in deviations), "; ") or codes.IN_REACH()
        return PhotoFinding(e, verdict(worst.off, worst.allowed), worst.off, said, worst.place, t, worst.allowed)
    if t.status == "beside":
        beside = codes.DOT_BESIDE if e.kind == "circle" else codes.LINE_BESIDE
        at = middle if e.kind == "circle" else _displacement(t, tolerance, middle).place
        return PhotoFinding(e, "amber", t.deviation, beside(how=_similarity(t, tolerance)), at, t, tolerance)
    if t.status in ("absent lettering", "part of lettering"):
        said = codes.NO_LETTERING() if t.status == "absent lettering" else codes.PART_OF_LETTERING()
        if t.at is not None:
            said = codes.LETTERING_BESIDE(how=shifted(t.shift))
        return PhotoFinding(e, "amber", t.deviation, said, complex(e.points.mean()), t, tolerance)
    seen: dict[str, tuple[Verdict, float, Remark]] = {
        "covered": ("amber", 0.0, codes.ONLY_COVERED()),
        "missing": ("red", e.length, codes.MISSING()),
        "hidden": ("green", 0.0, codes.HIDDEN()),
        "dense": ("green", 0.0, codes.TOO_NEAR()),
        "shared": ("green", 0.0, codes.TOO_NEAR()),
    }
    if t.deviation <= tolerance:
        seen["shared"] = ("green", t.deviation, codes.IN_REACH_SHARED())
    colour, off, said = seen.get(t.status, ("green", 0.0, codes.THERE()))
    return PhotoFinding(e, colour, off, said, middle, t, tolerance)


def _loosely_judged(e: Element) -> bool:
    """Whether an element is told to be off only when it is so for sure."""
    about_letters = e.kind == "circle" and not e.step and e.radius <= TINY
    return e.role in FORM_ROLES or about_letters or (e.kind == "line" and e.style in LOOSE_STYLES and e.length <= SHORT)


def _crowded(t: InkTrace, tolerance: float) -> bool:
    """Whether a line or a joint seems off in its place for the ink of others near most of it; a small outline by any ink there."""
    e = t.element
    thin = e.kind == "line" and e.style in LOOSE_STYLES
    long = e.kind == "circle" and not joint(e)
    if long or t.free >= (CROWDED_THIN if thin else CROWDED) or t.deviation <= tolerance:
        return False
    return t.deviation <= 2 * tolerance or _tiny(e)


def _tiny(e: Element) -> bool:
    """Whether an element is a small closed outline, a slider for instance."""
    half = float(np.abs(e.points - e.middle).max())
    return e.kind == "curve" and abs(e.points[0] - e.points[-1]) < 1e-6 and half <= TINY


def _of_tiny(t: InkTrace, tolerance: float, whole: _Deviation) -> list[_Deviation]:
    """How far a small closed outline is off: its middle, and all of it where that is more than two sides by a pencil each."""
    if whole.off > 2 * tolerance:
        return [whole._replace(allowed=2 * tolerance)]
    by = abs(t.shift)
    return [_Deviation(by, tolerance, whole.place, shifted(t.shift) if by > tolerance else None)]


def _displacement(t: InkTrace, tolerance: float, middle: complex) -> _Deviation:
    """How far the line as a whole is off, at the place where it is farthest off."""
    z = t.element.points
    place = complex(z[int(np.abs(t.at - z).argmax())]) if t.at is not None and len(t.at) == len(z) else middle
    return _Deviation(t.deviation, tolerance, place, _similarity(t, tolerance) if t.deviation > tolerance else None)


def _ends(t: InkTrace, pencil: float, tolerance: float, soft: bool) -> Iterator[_Deviation]:
    """How far the ends that could be seen are off."""
    e, loose = t.element, loose_ends(t.element)
    dash = sum(map(abs, line_type(e.style).pattern))
    for k, at in ((0, e.points[0]), (1, e.points[-1])):
        end = t.ends[k]
        if not np.isfinite(end) or (e.style in LOOSE_STYLES and soft):
            continue
        # 0.2 mm: the steps in which ends are seen. By hand a dashed line may end a dash and its gap before.
        drawn_to = SCARCELY if e.role == "construction" else LOOSE
        allowed = (LOOSE if end > 0 else drawn_to + dash) if loose else tolerance + pencil + 0.2
        said = codes.END[k, 1 if end > 0 else -1](by=millimetres(end)) if abs(end) > allowed else None
        off = min(abs(end), 2 * allowed) if loose else abs(end)  # a thin line drawn over is never more than a remark
        yield _Deviation(off, allowed, complex(at), said)


def _similarity(t: InkTrace, tolerance: float) -> Remark:
    """Growth, shift and turn of a line, as far as each matters."""
    e = t.element
    half = 0.5 * e.length if e.kind == "line" else float(np.abs(e.points - e.points.mean()).max())
    said = []
    if abs(t.growth) > 0.5 * tolerance:
        if e.kind in ("circle", "arc"):
            said.append(of_radius(t.growth, e.radius))
        elif e.kind == "curve":
            said.append(_curve_excess(t.growth, half))
    if abs(t.shift) > 0.5 * tolerance:
        said.append(shifted(t.shift))
    if e.kind != "circle" and abs(t.turn) * half > 0.5 * tolerance:
        said.append(turned(degrees(t.turn)))
    return joined(said) or codes.OFF_BY(by=Number(f"{t.deviation:.1f}"))


def _curve_excess(by: float, half: float) -> Remark:
    """An excess of a curve that reaches ``half`` mm to each side, mm."""
    return codes.GROWN[1 if by > 0 else -1](by=millimetres(by), size=Number(f"{half:.0f}"))
