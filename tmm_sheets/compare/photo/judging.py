"""Judging what was found of an element: by how much it is off, in words, and whether a pencil may be off so far."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import degrees, isnan
from typing import NamedTuple

import numpy as np

from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.findings import Finding, millimetres, of_radius, shifted, turned
from tmm_sheets.compare.photo.black_and_white import LostToThreshold, may_be_lost, whole
from tmm_sheets.compare.photo.fragmented_lines import HALF
from tmm_sheets.compare.photo.joints import joint
from tmm_sheets.compare.photo.traces import InkTrace, open_line
from tmm_sheets.compare.report import verdict
from tmm_sheets.drawing.styles import line_type
from tmm_sheets.numbers import told
from tmm_sheets.words import marked, tell

LOOSE_STYLES = frozenset({"thin", "construction", "axis", "centre", "hidden", "twodot"})
"""Lines whose ends mean nothing exact: by hand they are overdrawn."""
LOOSE_ROLES = frozenset({"symbol", "curve"})
"""So are the lines of guides and supports, and curves: no end of theirs is a point of a construction."""
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
IN_REACH = marked("within a pencil's reach")
TOO_NEAR = marked("not measurable: too near to others")
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
    """One way in which a line is off: by how much, what is allowed, where, and in words what is beyond that."""

    off: float
    allowed: float
    place: complex
    said: str = ""

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
        What the picture eats of thin lines (see ``black_and_white``): what that may be the reason of is not judged.
    """
    if may_be_lost(t, tolerance := tolerance_of(pencil, uncertainty, soft), eats):
        said = tell("not measurable: eaten by the black and white picture")
        return PhotoFinding(t.element, "green", 0.0, said, t.element.middle, InkTrace(t.element, "eaten"), tolerance)
    return _with_head(_in_pieces(_line(t if eats == "nothing" else whole(t), pencil, uncertainty, soft)))


def tolerance_of(pencil: float, uncertainty: float, soft: bool) -> float:
    """How far off a line may be without being wrong, mm; the parameters are those of :func:`judge`."""
    return pencil + uncertainty + (SOFT_TOLERANCE if soft else 0.0)


def _in_pieces(f: PhotoFinding) -> PhotoFinding:
    """What was found of a line of which the picture may have taken the rest: never more than a remark."""
    if f.verdict != "red" or not f.trace.pieces:
        return f
    if f.trace.status == "missing":
        half = f.trace.covered >= HALF
        if half and f.element.role in FORM_ROLES:
            return replace(f, verdict="green", deviation=0.0, what=tell("only pieces of it are seen"))
        what = (tell("ink in parts of its place only: it was left out, lies elsewhere, or pieces of it are seen") if half else
                tell("not seen; lines as thin as it are in pieces in this picture"))
    else:
        pieces = tell("only pieces of it are seen")
        what = f"{f.what}; {pieces}"
    return replace(f, verdict="amber", what=what)


def _with_head(f: PhotoFinding) -> PhotoFinding:
    """What was found of an arrow, and of its head."""
    e, head = f.element, f.trace.head
    if head == "reversed":
        return replace(f, verdict="red", deviation=e.length, what=tell("the arrow points the other way"))
    if head == "doubled" and f.verdict == "green":
        said = tell("an arrow head at its beginning, where none belongs: it or one in a stroke with it points the other way")
        return replace(f, verdict="amber", what=said, at=complex(e.points[0]))
    if head == "absent" and f.verdict != "green":  # what was drawn elsewhere has its head there
        return f
    if head in ("absent", "left out"):
        no_head = tell("no arrow head here") if head == "absent" else tell("only a thin line here, and no arrow head")
        what = no_head if f.verdict == "green" else f"{f.what}; {no_head}"
        return replace(f, verdict="amber" if f.verdict == "green" else f.verdict, what=what, at=complex(e.fills[0][0]))
    return f


def _line(t: InkTrace, pencil: float, uncertainty: float, soft: bool) -> PhotoFinding:
    """Judge what was found of a line or of lettering, heads aside."""
    e, tolerance = t.element, tolerance_of(pencil, uncertainty, soft)
    if t.status == "measured" and t.deviation > tolerance and not loose_ends(e) and all(by > LOOSE for by in t.ends):
        t = InkTrace(e, "missing")  # what lies there and goes on at both ends is another line
    middle = complex(e.points[len(e.points) // 2]) if e.kind != "line" else complex(e.points.mean())
    if t.status == "measured":
        ends = [*_ends(t, pencil, tolerance, soft)]
        deviations = [_displacement(t, tolerance, middle), *ends]
        if _crowded(t, tolerance):
            del deviations[0]
            if all(d.share <= 1 for d in deviations):
                return PhotoFinding(e, "green", 0.0, tell(TOO_NEAR), middle, replace(t, status="dense"), tolerance)
        elif _tiny(e):
            deviations = _of_tiny(t, tolerance, deviations[0])
        if _loosely_judged(e) and deviations[0].share <= 2 and any(d.share > 1 for d in ends):
            deviations = ends  # how a short line is turned is no matter, where it ends is
        worst = max(deviations, key=lambda d: d.share)
        if 1 < worst.share <= 2 and _loosely_judged(e) and (e.role in FORM_ROLES or worst not in ends):
            said = tell("a little aside, no more than its kind may be")
            return PhotoFinding(e, "green", worst.off, said, worst.place, t, tolerance)
        said = "; ".join(d.said for d in deviations if d.said)
        return PhotoFinding(e, verdict(worst.off, worst.allowed), worst.off, said or tell(IN_REACH), worst.place, t, worst.allowed)
    if t.status == "beside":
        said = (tell("a dot like it stands beside, and none is seen here: {how}") if e.kind == "circle" else
                tell("in one stroke with others, but a line like it lies beside: {how}"))
        at = middle if e.kind == "circle" else _displacement(t, tolerance, middle).place
        return PhotoFinding(e, "amber", t.deviation, said.format(how=_similarity_in_words(t, tolerance)), at, t, tolerance)
    if t.status == "covered":
        said = tell("not seen where no other line covers it")
        return PhotoFinding(e, "amber", 0.0, said, middle, t, tolerance)
    if t.status == "missing":
        return PhotoFinding(e, "red", e.length, tell("missing"), middle, t, tolerance)
    if t.status in ("absent lettering", "part of lettering"):
        said = tell("no lettering here") if t.status == "absent lettering" else tell("part of the lettering is not here")
        if t.at is not None:
            said = tell("not in its place: what stands {how} may be it").format(how=shifted(t.shift))
        return PhotoFinding(e, "amber", t.deviation, said, complex(e.points.mean()), t, tolerance)
    if t.status == "shared" and t.deviation <= tolerance:
        said = tell("within a pencil's reach, with others in one stroke")
        return PhotoFinding(e, "green", t.deviation, said, middle, t, tolerance)
    if t.status == "hidden":
        return PhotoFinding(e, "green", 0.0, tell("hidden in the picture"), middle, t, tolerance)
    word = tell(TOO_NEAR) if t.status in ("dense", "shared") else tell("there")
    return PhotoFinding(e, "green", 0.0, word, middle, t, tolerance)


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
    return [_Deviation(by, tolerance, whole.place, shifted(t.shift) if by > tolerance else "")]


def _displacement(t: InkTrace, tolerance: float, middle: complex) -> _Deviation:
    """How far the line as a whole is off, at the place where it is farthest off."""
    z = t.element.points
    place = complex(z[int(np.abs(t.at - z).argmax())]) if t.at is not None and len(t.at) == len(z) else middle
    return _Deviation(t.deviation, tolerance, place, _similarity_in_words(t, tolerance) if t.deviation > tolerance else "")


_END = {
    (0, True): marked("{by} mm too long at its beginning"), (0, False): marked("{by} mm too short at its beginning"),
    (1, True): marked("{by} mm too long at its end"), (1, False): marked("{by} mm too short at its end"),
}
"""What an end is said to be: the first or the second, too long or too short."""


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
        said = tell(_END[k, bool(end > 0)]).format(by=millimetres(end)) if abs(end) > allowed else ""
        off = min(abs(end), 2 * allowed) if loose else abs(end)  # a thin line drawn over is never more than a remark
        yield _Deviation(off, allowed, complex(at), said)


def _similarity_in_words(t: InkTrace, tolerance: float) -> str:
    """Growth, shift and turn of a line, as far as each matters."""
    e = t.element
    half = 0.5 * e.length if e.kind == "line" else float(np.abs(e.points - e.points.mean()).max())
    said = []
    if abs(t.growth) > 0.5 * tolerance:
        if e.kind in ("circle", "arc"):
            said.append(of_radius(t.growth, e.radius))
        elif e.kind == "curve":
            said.append(_grown(t.growth, half))
    if abs(t.shift) > 0.5 * tolerance:
        said.append(shifted(t.shift))
    if e.kind != "circle" and abs(t.turn) * half > 0.5 * tolerance:
        said.append(turned(degrees(t.turn)))
    return ", ".join(said) or tell("off by up to {by} mm").format(by=told(f"{t.deviation:.1f}"))


def _grown(by: float, half: float) -> str:
    """An excess of a curve that reaches ``half`` mm to each side, mm, in words."""
    said = tell("{by} mm too large in {size} mm") if by > 0 else tell("{by} mm too small in {size} mm")
    return said.format(by=millimetres(by), size=f"{half:.0f}")
