"""What was found of an element judged: what is off by how much, in words, and whether a pencil may be off so far."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees, isnan

import numpy as np

from tmm_sheets.compare.photo.traces import Trace, open_line
from tmm_sheets.compare.report import Verdict, verdict

LOOSE_STYLES = frozenset({"thin", "construction", "axis", "centre", "hidden", "twodot"})
"""Lines whose ends mean nothing exact: by hand they are drawn over."""
LOOSE = 2.5  # mm by which those may be too long or too short
SOFT_TOLERANCE = 0.15  # mm more in a picture that is not sharp


@dataclass(frozen=True)
class PhotoFinding:
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

    @property
    def unknown(self) -> bool:
        """Whether the ink tells nothing: it cannot be told from others', or all in one stroke are off and any of them may be."""
        return self.trace.status == "dense" or (self.trace.status == "shared" and self.trace.deviation > self.tolerance)

    @property
    def hidden_ends(self) -> int:
        """How many of its ends are hidden by others, of a line whose ends mean something."""
        t = self.trace
        exact = t.status == "measured" and t.element.style not in LOOSE_STYLES and open_line(t.element)
        return sum(map(isnan, t.ends)) if exact else 0


def judge(t: Trace, pencil: float, uncertainty: float, soft: bool = False) -> PhotoFinding:
    """What a trace tells, in words, and how bad it is.

    Parameters
    ----------
    t
        What was found.
    pencil, uncertainty
        Error of a point drawn by hand and of a place of the picture, mm.
    soft
        Whether the picture is not sharp: the tolerance is wider, and nothing is said of ends of thin lines, which fade in it where
        others are near.
    """
    e, tolerance = t.element, pencil + uncertainty + (SOFT_TOLERANCE if soft else 0.0)
    middle = complex(e.points[len(e.points) // 2]) if e.kind != "line" else complex(e.points.mean())
    if t.status == "missing":
        return PhotoFinding(t, "red", "missing", e.length, tolerance, middle)
    if t.status == "absent lettering":
        return PhotoFinding(t, "amber", "no lettering here", 0.0, tolerance, complex(e.points.mean()))
    if t.status == "shared" and t.deviation <= tolerance:
        return PhotoFinding(t, "green", "within a pencil's reach, with others in one stroke", t.deviation, tolerance, middle)
    if t.status != "measured":
        word = "not measurable: too near to others" if t.status in ("dense", "shared") else "there"
        return PhotoFinding(t, "green", word, 0.0, tolerance, middle)
    said, worst, off, limit, place = [], 0.0, t.deviation, tolerance, middle
    if t.at is not None and len(t.at) == len(e.points):
        place = complex(e.points[int(np.abs(t.at - e.points).argmax())])
    if t.deviation > tolerance:
        said.append(_displaced(t, tolerance))
    worst = t.deviation / tolerance
    loose = e.style in LOOSE_STYLES
    for end, which, at in ((t.ends[0], "beginning", e.points[0]), (t.ends[1], "end", e.points[-1])):
        if not np.isfinite(end) or (loose and soft):
            continue
        allowed = LOOSE if loose else tolerance + pencil + 0.2  # 0.2 mm: the steps in which ends are seen
        if abs(end) > allowed:
            said.append(f"{abs(end):.1f} mm too {'long' if end > 0 else 'short'} at its {which}")
        much = min(abs(end), 2 * LOOSE) if loose else abs(end)  # a thin line drawn over is never more than a remark
        if much / allowed > worst:
            worst, off, limit, place = much / allowed, much, allowed, complex(at)
    return PhotoFinding(t, verdict(off, limit), "; ".join(said) or "within a pencil's reach", off, limit, place)


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
