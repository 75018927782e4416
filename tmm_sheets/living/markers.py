"""Where a drawn curve is at a crank angle, or at the angle of a cam: markers that run along the diagrams of a sheet.

A graph over the angle has it on its axis; any other curve is passed from one numbered position to the next.
"""

from __future__ import annotations

from cmath import exp
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from tmm_sheets.project import Project

NEAR = 0.3
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
        marks = [m for m in sheet["marks"] if m.get("frame") == frame["id"]]
        of, mu = ("cam", _cam_scale(project, frame)) if frame["plan"].startswith("cam") else ("crank", _crank_scale(project, frame))
        axis = exp(1j * frame["turn"])
        for mark in (m for m in marks if m["role"] == "curve" and "position" not in m):
            points = [complex(*z) for z in mark["geometry"].get("polyline", mark["geometry"].get("line", ()))]
            told = {"mark": mark["id"], "of": of}
            if mu and _ascending(points, axis):
                found.append(told | {"from": frame["origin"], "along": [round(axis.real, 12), round(axis.imag, 12)], "mu": mu})
            elif passes := len(points) > 2 and list(_passes(project, of, points, _places(sheet, frame))):
                found.append(told | {"passes": passes})
    return found


def _ascending(points: list[complex], axis: complex) -> bool:
    """Whether a curve goes on and on along an axis."""
    steps = [((b - a) * axis.conjugate()).real for a, b in pairwise(points)]
    return len(steps) > 0 and min(steps) > -1e-6 and sum(steps) > 1


def _crank_scale(project: Project, frame: Mapping[str, Any]) -> float:
    """Radians of the crank in a millimetre along the axis of a frame; 0 where it is no axis of angles."""
    if frame["mu"][0] == frame["mu"][1] == 1.0:
        return float(project.flywheel.scales.angle.mu) if "flywheel" in vars(project) else 0.0
    return float(frame["mu"][0]) if frame["mu"][0] != frame["mu"][1] else 0.0


def _cam_scale(project: Project, frame: Mapping[str, Any]) -> float:
    if frame["plan"] in ON_PAPER:
        return float(project.cam.motion.scales.phi.mu)
    return float(frame["mu"][0]) if frame["mu"][0] != frame["mu"][1] else 0.0


def _passes(project: Project, of: str, points: list[complex], there: Mapping[str, complex]) -> Iterator[list[float]]:
    """Angles at which a curve passes the places of the numbered positions, and the numbers of its own points there."""
    turned, whole = _angles(project, of)
    last = -1
    for label, angle in zip(there, turned, strict=False):
        away = np.abs(np.array(points[last + 1:]) - there[label])
        near = np.flatnonzero(away < NEAR)
        if len(near):
            end = np.searchsorted(near, near[0] + FEW)  # it may come back
            last += 1 + int(near[np.argmin(away[near[:end]])])
            yield [float(angle), last]
    if last >= 0:
        yield [whole, len(points) - 1]


def _places(sheet: Mapping[str, Any], frame: Mapping[str, Any]) -> dict[str, complex]:
    """Points of the numbered positions in the view of a frame, mm, in order."""
    own = {f["id"] for f in sheet["frames"] if f["view"] == frame["view"]}
    there: dict[str, complex] = {}
    for m in sheet["marks"]:
        if m.get("frame") in own and m["role"] == "point" and "position" in m:
            ((kind, shape),) = [(k, v) for k, v in m["geometry"].items() if k in ("circle", "fill")] or [("", None)]
            if shape is not None:
                z = complex(*shape["centre"]) if kind == "circle" else complex(*np.mean(shape, axis=0))
                there.setdefault(m["position"], z)
    return there


def _angles(project: Project, of: str) -> tuple[tuple[float, ...], float]:
    """Angles turned to the numbered positions, rad, and that of the cycle."""
    if of == "cam":
        return tuple(map(float, project.cam.law.positions)), 2 * np.pi
    return tuple(map(float, project.cycle.turned)), float(project.cycle.period)
