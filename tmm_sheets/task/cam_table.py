"""``[cam]``: a turn of the cam given by ordinates, divided into its phases; keys of one kind of follower or of law only.

Both work on the raw table of the file, so that what is wrong is told beside the errors of the values.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import isclose
from typing import Any

from tmm_sheets.task import units
from tmm_sheets.task.values import diagram, levelled
from tmm_sheets.toml_file import Found, wrong
from tmm_sheets.words import marked, tell

LAW = "displacements"
OWN = ("fall_law", "table", "fall_table", "rise", "upper_dwell", "fall", "stroke", "swing")
"""Keys of ``[cam]`` that the table tells."""
TURN = units.parse("360 deg", units.ANGLE)
FOLLOWER_KEYS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "translating roller": (
        ("stroke", "pressure_angle"),
        ("base_radius", "eccentricity", "limit", "centre", "roller", "curvature_share", "follower_mass")),
    "oscillating roller": (
        ("arm", "swing", "pressure_angle"),
        ("base_radius", "centre_distance", "rotation", "limit", "centre", "roller", "curvature_share", "follower_inertia")),
    "flat": (("stroke",), ("base_radius", "follower_mass")),
}
"""Keys that a follower must and may have beside those that all have."""

EXAMPLES = {"stroke": '"10 mm"', "pressure_angle": '"30 deg"', "arm": '"90 mm"', "swing": '"30 deg"',
            "table": "[[0, 1], [0.5, 0], [1, -1]]", "fall_table": "[[0, 1], [0.5, 0], [1, -1]]"}


def ordinates(cam: dict[str, Any]) -> tuple[list[float], list[float]]:
    """Cam angles, rad, and displacements, m or rad of a rocker, of the raw table ``[cam]``.

    Raises
    ------
    ValueError
        when they are no pairs with units, or no turn that rises once and falls once.
    """
    pairs = cam[LAW]
    if not isinstance(pairs, list | tuple) or not all(isinstance(p, list | tuple) and len(p) == 2 for p in pairs):
        raise ValueError(tell('expected displacements = [["0 deg", "0 mm"], ["30 deg", "4 mm"], ...]'))
    rocker = cam.get("follower") == "oscillating roller"
    phi, s = diagram(pairs, units.ANGLE, units.ANGLE if rocker else units.LENGTH)
    s = levelled(s, max(map(abs, s), default=0.0))
    _check(phi, s)
    return phi, s


def _check(phi: list[float], s: list[float]) -> None:
    if len(phi) < 3 or any(b <= a for a, b in pairwise(phi)):
        raise ValueError(tell("displacements: expected three pairs or more, with angles that rise"))
    if phi[0] != 0 or not isclose(phi[-1], TURN, rel_tol=1e-12):
        raise ValueError(tell("displacements: expected angles from 0 to 360 deg"))
    if s[0] != 0 or s[-1] != 0 or min(s) < 0 or not max(s) > 0:
        raise ValueError(tell("displacements: expected a turn that begins and ends at 0 and nowhere lies below"))
    if s[1] == 0:
        began = next(a for a, b in zip(phi, s[1:], strict=False) if b > 0)
        raise ValueError(tell("displacements: expected the rise to begin at 0 deg, it begins at {angle:g} deg: count from "
                              "there").format(
            angle=began / TURN * 360))
    a, b, c = _corners(s)
    for k, (before, after) in enumerate(pairwise(s)):
        right = after > before if k < a else after == before if k < b or k >= c else after < before
        if not right:
            raise ValueError(tell("displacements: the follower turns back at {angle:g} deg; expected one rise and one fall").format(
                angle=phi[k] / TURN * 360))


def _corners(s: list[float]) -> tuple[int, int, int]:
    """Places where the rise ends, the fall begins and the fall ends."""
    top = max(s)
    first, last = s.index(top), len(s) - 1 - s[::-1].index(top)
    return first, last, next(k for k in range(last, len(s)) if s[k] == 0)


def filled(cam: Any) -> Any:
    """The raw table ``[cam]`` with the phases and the stroke that its displacements tell; as it is without them.

    Raises
    ------
    ValueError
        when they cannot be read, or what they tell is there as well.
    """
    if not isinstance(cam, dict) or LAW not in cam:
        return cam
    doubled = [key for key in OWN if key in cam] + (["law"] if cam.get("law", LAW) != LAW else [])
    if doubled:
        raise ValueError(tell("displacements tells {keys} itself: leave it out").format(keys=", ".join(doubled)))
    phi, s = ordinates(cam)
    a, b, c = _corners(s)
    stroke = {"swing": f"{max(s)!r} rad"} if cam.get("follower") == "oscillating roller" else {"stroke": f"{max(s)!r} m"}
    phases = {"rise": phi[a], "upper_dwell": phi[b] - phi[a], "fall": phi[c] - phi[b]}
    return cam | {"law": LAW, "fall_law": LAW} | stroke | {key: f"{angle!r} rad" for key, angle in phases.items()}


def phase_ordinates(cam: dict[str, Any], fall: bool) -> tuple[list[float], list[float]]:
    """Shares of the rise or the fall and shares of its travel, both from 0 to 1."""
    phi, s = ordinates(cam)
    a, b, c = _corners(s)
    first, last = (b, c) if fall else (0, a)
    start, travel = phi[first], s[last] - s[first]
    return ([(p - start) / (phi[last] - start) for p in phi[first : last + 1]],
            [(v - s[first]) / travel for v in s[first : last + 1]])


# --- keys of one kind of follower or law ----------------------------------------------------------------------------


def check_cam(data: dict[str, Any]) -> Iterator[Found]:
    """Every missing or superfluous key of the follower, the law and the closure."""
    cam = data.get("cam")
    if not isinstance(cam, dict):
        return
    follower = str(cam.get("follower"))
    must, may = FOLLOWER_KEYS.get(follower, ((), ()))
    others = {key for keys in FOLLOWER_KEYS.values() for key in (*keys[0], *keys[1])} - {*must, *may} if must else {*()}
    for key in (*(key for key in must if key not in cam and not (key in OWN and LAW in cam)), *others.intersection(cam)):
        yield from wrong((
            (key not in cam, ("cam", key), marked('missing; follower = "{follower}" needs it, for example {key} = {example}'), ""),
            (key in cam, ("cam", key), marked('follower = "{follower}" has no such key'), marked("its own keys are {keys}")),
        ), follower=follower, key=key, example=EXAMPLES.get(key), keys=", ".join((*must, *may)))
    for law, table in (("law", "table"), ("fall_law", "fall_table")):
        yield from wrong((
            (cam.get(law) == "table" and table not in cam, ("cam", table),
             marked('missing; {law} = "table" needs it, for example {table} = {example}'), ""),
            (cam.get(law) == LAW and LAW not in cam, ("cam", law), marked("needs the table displacements"), ""),
            (table in cam and cam.get(law) != "table", ("cam", table), marked('is read with {law} = "table" only'), ""),
        ), law=law, table=table, example=EXAMPLES[table])
    yield from wrong((
        (follower == "flat" and cam.get("closure") == "geometric", ("cam", "closure"),
         marked('expected "force": the second disc of a geometric closure needs a roller'), ""),
        ("centre" in cam and "base_radius" in cam, ("cam", "centre"), marked("a given base_radius tells where the axis is"),
         marked("leave one of them out")),
        ("centre_distance" in cam and "base_radius" not in cam, ("cam", "centre_distance"),
         marked("goes with base_radius only"), ""),
    ))
