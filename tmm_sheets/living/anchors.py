"""What a mark hangs on: the steps at its ends and the direction it lies along, so that it can be drawn for any crank angle.

A mark of a linkage's view was drawn for one position. Its points stand at a step's place, or so many millimetres from it, measured
along the line it lies on: from one step to another, or along a force or a direction. The drawing has told which; that is all the
page needs to draw it anew.

Markers show where a drawn curve is at an angle of the crank or the cam: on the axis of a graph over the angle, else passed from
one numbered position to the next.
"""

from __future__ import annotations

from cmath import exp, phase
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.drawing.marks import PlacedFrame

if TYPE_CHECKING:
    from tmm_sheets.project import Project

PLACED = ("origin", "mu", "turn", "mirror")
"""What says where a frame stands on the sheet."""
BAR, NEAR, FAR = 2.6, 5.0, 9.0
"""Bar over a letter, at most; a letter farther off than FAR, at the end of a leader, comes as near as NEAR, mm."""
LENGTH = True
"""Behind a place beside a point: it is a length of the mechanism, as large on the screen as that is."""


def hung(record: Mapping[str, Any], sheet: Mapping[str, Any], known: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Views of a sheet that follow the crank, each with its marks and what they hang on; details, which have symbols only, do not.

    ``known`` are the ids of the steps that the page computes. A view is told once, at the position it is drawn for with most
    marks: the highlighted one; one with several plans beside each other once for each.
    """
    plans = {plan["id"]: plan for plan in record["plans"]}
    found: dict[tuple[str, str], list[_Frame]] = {}
    for frame in sheet["frames"]:
        plan = plans.get(frame["plan"])
        if plan is None or not plan["positions"] or not any(key in known for key in plan["steps"]):
            continue
        marks = [m for m in sheet["marks"] if "frame" in m and m["frame"] == frame["id"]]
        thick = [m["position"] for m in marks if m.get("position") and m["style"] == "main"]
        label = frame["position"] or max(sorted(set(thick)), key=thick.count, default="")
        if label in plan["positions"]:
            place = str([frame[name] for name in PLACED])
            found.setdefault((frame["view"], place), []).append(_Frame(record, plan, frame, label, marks, known))
    views = []
    for (view, _), frames in found.items():
        marks = [{name: f.frame[name] for name in PLACED} | told for f in frames for told in f.marks()]
        if sum(m["kind"] != "text" for m in marks) > 2 and any(m["role"] in ("link", "vector", "point") for m in marks):
            views.append({"view": view, "plan": frames[0].plan["id"], "position": frames[0].label, "marks": marks})
    return views


Place = tuple[str, complex, list[str], list[Any] | None]
"""What a lettering hangs on, its place beside that, mm, along which line, and between which points."""


class _Frame:
    """Marks of a plan in one frame at one position."""

    def __init__(self, record: Mapping[str, Any], plan: Mapping[str, Any], frame: Mapping[str, Any], label: str,
                 marks: list[dict[str, Any]], known: Mapping[str, Any]) -> None:
        self.plan, self.frame, self.label, self.drawn = plan, frame, label, marks
        self.k, self.turned = plan["positions"].index(label), _turning(frame)
        self.steps = {key: record["steps"][key] for key in known}
        self.places: dict[str, complex | None] = {}
        self.vectors: dict[tuple[str, ...], None] = {}
        self.letters: dict[int, tuple[complex, Place]] = {}

    def value(self, key: str) -> complex | None:
        """A step's value at the position; None where it is no point or not defined."""
        step = self.steps[key]
        value = step["value"]
        if step["over"] == "positions" and value is not None:
            value = value[self.k] if self.k < len(value) else None
        return complex(*value) if isinstance(value, list) and len(value) == 2 and None not in value else None

    def place(self, key: str) -> complex | None:
        """Where a step's point lies on the sheet, mm; None of what is no point, or none that the page computes."""
        if key not in self.places:
            z = self.value(key) if key in self.steps and self.steps[key]["kind"] in ("point", "vector") else None
            self.places[key] = None if z is None else complex(*self.frame["origin"]) + self.turned(z)
        return self.places[key]

    def marks(self) -> Iterator[dict[str, Any]]:
        """Marks with what they hang on, those on nothing left out; with a pole, hodographs of its vectors."""
        for mark in self.drawn:
            of_all = "position" not in mark and mark["role"] in ("axis", "curve", "construction")
            if (of_all or mark.get("position") == self.label) and (told := self._mark(mark)) is not None:
                yield {"id": mark["id"], "style": mark["style"], "role": mark["role"], **told}
        for key in dict.fromkeys(pair[-1] for pair in self.vectors if pair[0] == self.plan.get("pole")):
            yield {"id": f"hodograph of {key}", "style": "thin", "role": "hodograph", "kind": "path", "of": key}

    def _mark(self, mark: dict[str, Any]) -> dict[str, Any] | None:
        shape, (kind, points), key = mark["geometry"], _points(mark["geometry"]), mark.get("step", "")
        on = mark.get("on", [key])
        ends = {name: z for name in on if (z := self.place(name)) is not None}
        if mark["role"] == "curve":
            return {"kind": "path", "of": key} if ends and self.steps[key]["over"] == "positions" else None
        if not ends or (len(ends) == 1 and mark["role"] == "construction" and kind == "line"):
            return None
        pair = [[*ends][n] for n in (0, -1)] if len(ends) > 1 else []
        along = on[-1:] if on[-1] not in ends else pair
        if mark["role"] == "text":
            return self._letter(mark, kind, points, [*ends], along)
        if pair and key == pair[1] and mark["role"] in ("vector", "link"):
            self.vectors[tuple(pair)] = None
        more = {name: shape[kind][name] for name in ("radius", "from", "to") if name in shape.get(kind, {})}
        if pair and more:
            points, along, more["reach"] = [ends[pair[0]]], [], pair
        u = self.direction(along)
        if u is None:
            u, along = 1 + 0j, []
        if key not in ends:  # of what lies between points each of its own hangs on the nearest
            hung = [min(ends, key=lambda name: abs(ends[name] - z)) for z in points]
        else:
            hung = pair if pair and (kind == "line" or "reach" in more) else [key] * len(points)
        at: list[list[Any]] = [[of, *_mm((z - ends[of]) / u)] for of, z in zip(hung, points, strict=False)]
        if len(on) > 2 and along == on[-1:]:  # the free end of a link is a place of it, not of the paper
            at[-1] = [on[0], *_mm((points[-1] - ends[on[0]]) / u), LENGTH]
        if kind == "arc":
            more |= {"from": more["from"] - phase(u), "to": more["to"] - phase(u)}
        if kind == "polyline" and shape.get("closed"):
            more["closed"] = True
        return {"kind": kind, "at": at, "along": along, **more}

    def _letter(self, mark: dict[str, Any], kind: str, points: list[complex], on: list[str],
                along: list[str]) -> dict[str, Any] | None:
        """A sign of a lettering: it stands where the first sign does, which keeps its place beside its vector, link or point."""
        if kind == "line" and abs(points[1] - points[0]) > BAR:
            return None  # a leader: the letter comes to its place without
        lettering = mark.get("lettering", mark["id"])
        if lettering not in self.letters:
            self.letters[lettering] = points[0], self._place_of_letter(points[0], on, along)
        first, (anchor, local, along, other) = self.letters[lettering]
        at = [[anchor, *_mm(local), *(other or ["", 0.0]), *_mm(z - first)] for z in points]
        shape = mark["geometry"][kind]
        text = {"height": shape["height"], "string": shape["string"]} if kind == "text" else {}
        return {"kind": kind, "at": at, "along": along, "lettering": lettering, **text}

    def _place_of_letter(self, z: complex, on: list[str], along: list[str]) -> Place:
        """What a letter hangs on, its place beside that, mm, along which line, and between which points.

        That of a point stands beside the vector that ends there.
        """
        beside = [along] if len(along) > 1 else [] if along else [list(pair) for pair in self.vectors if pair[-1] == on[0]]
        if beside:
            off, share, pair = min((self._off_line(z, pair) for pair in beside), key=lambda found: abs(found[0]))
            return pair[0], _nearer(off) / (self.direction(pair) or 1), pair, [pair[1], round(share, 6)]
        off = z - (self.place(on[0]) or 0)
        return on[0], (off if along else _nearer(off)) / (self.direction(along) or 1), along, None

    def _off_line(self, z: complex, pair: list[str]) -> tuple[complex, float, list[str]]:
        """How a place lies off a line between two points, mm, and which share of the line is nearest to it."""
        a, b = (self.place(name) or 0j for name in pair)
        share = min(max(((z - a) * (b - a).conjugate()).real / abs(b - a) ** 2, 0.0), 1.0) if a != b else 0.0
        return z - a - share * (b - a), share, pair

    def direction(self, along: list[str]) -> complex | None:
        """Unit vector on the sheet; None of no step, of one that the page does not compute and of points at one place."""
        values = [self.value(key) if key in self.steps else None for key in along]
        if not values or None in values:
            return None
        z = self.turned(values[-1] - (values[0] if len(values) > 1 else 0))  # type: ignore[operator]
        return z / abs(z) if abs(z) > 0 else None


def _nearer(z: complex) -> complex:
    return z if abs(z) <= FAR else NEAR * z / abs(z)


def _mm(z: complex) -> list[float]:
    return [round(z.real, 6), round(z.imag, 6)]


def _points(shape: Mapping[str, Any]) -> tuple[str, list[complex]]:
    """Kind of a shape and the points it is drawn through."""
    ((kind, told),) = [(kind, told) for kind, told in shape.items() if kind != "closed"]
    points = [told["at"]] if kind == "text" else [told["centre"]] if kind in ("arc", "circle") else told
    return kind, [complex(*z) for z in points]


ON_CURVE_MM = 0.3
"""A point of a position lies on its curve, mm."""
FEW = 8
"""Points of a curve within which it passes a place once."""
ON_PAPER = ("cam-motion", "cam-motion-between")
"""Diagrams of the cam whose plans are in millimetres."""
OTHERS = ("cam-zone", "gear", "train", "reducer", "positions", "velocities", "accelerations", "loads")
"""Plans whose curves are not passed with the crank, or are drawn in the page."""


def markers(project: Project, record: Mapping[str, Any], sheet: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Markers of a sheet: each with its curve's mark, and the angle of the crank or the cam over it.

    One on a graph over the angle has ``from``, mm, a unit vector ``along`` the axis and ``mu``, rad/mm; one on another curve
    ``passes``: angles, rad, and numbers of the curve's points.
    """
    found = []
    for frame in sheet["frames"]:
        if frame["plan"].startswith(OTHERS):
            continue
        marks = [m for m in sheet["marks"] if "frame" in m and m["frame"] == frame["id"]]
        of = "cam" if frame["plan"].startswith("cam") else "crank"
        mu = _scale(project, of, frame)
        axis = exp(1j * frame["turn"])
        for mark in (m for m in marks if m["role"] == "curve" and "position" not in m):
            points = [complex(*z) for z in mark["geometry"].get("polyline", mark["geometry"].get("line", ()))]
            told = {"mark": mark["id"], "of": of}
            if mu and _ascending(points, axis):
                found.append(told | {"from": frame["origin"], "along": [round(axis.real, 12), round(axis.imag, 12)], "mu": mu})
            elif len(passes := list(_passes(project, of, points, _places(record, frame, mark.get("step", ""))))) > 2:
                found.append(told | {"passes": passes})
    return found


def _ascending(points: list[complex], axis: complex) -> bool:
    """Whether a curve goes on and on along an axis."""
    steps = [((b - a) * axis.conjugate()).real for a, b in pairwise(points)]
    return len(steps) > 0 and min(steps) > -1e-6 and sum(steps) > 1


def _scale(project: Project, of: str, frame: Mapping[str, Any]) -> float:
    """Radians of the crank or the cam in a millimetre along the axis of a frame; 0 where it is no axis of angles."""
    if frame["plan"] in ON_PAPER:
        return float(project.cam.motion.scales.phi.mu)
    if of == "crank" and frame["mu"][0] == frame["mu"][1] == 1.0:
        return float(project.flywheel.scales.angle.mu) if "flywheel" in vars(project) else 0.0
    return float(frame["mu"][0]) if frame["mu"][0] != frame["mu"][1] else 0.0


def _passes(project: Project, of: str, points: list[complex], there: Any) -> Iterator[list[float]]:
    """Angles at which a curve passes the places of the numbered positions, and the numbers of its own points there."""
    if of == "cam":
        turned, whole = project.cam.law.positions, 2 * np.pi
    else:
        turned, whole = project.cycle.turned, float(project.cycle.period)
    last = -1
    for place, angle in zip(there, turned, strict=False):
        away = np.abs(np.array(points[last + 1:]) - place)
        near = np.flatnonzero(away < ON_CURVE_MM)
        if len(near):
            end = np.searchsorted(near, near[0] + FEW)  # it may come back
            last += 1 + int(near[np.argmin(away[near[:end]])])
            yield [float(angle), last]
    if last >= 0:
        yield [whole, len(points) - 1]


def _places(record: Mapping[str, Any], frame: Mapping[str, Any], key: str) -> Any:
    """Points of the numbered positions, complex (n,) mm, of the step that a curve in a frame is drawn through; none of another."""
    step = record["steps"].get(key.replace("-between/", "/"))
    if step is None or step["over"] != "positions" or step["kind"] != "point":
        return []
    return complex(*frame["origin"]) + _turning(frame)(np.array(step["value"], dtype=float) @ (1, 1j))


def _turning(frame: Mapping[str, Any]) -> PlacedFrame:
    """What makes of differences of a plan's points such of the sheet, mm."""
    return PlacedFrame(-1, "", "", 0j, frame["mu"], frame["turn"], frame["mirror"])
