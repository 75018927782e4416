"""Keys of ``[cam]`` that belong to one kind of follower or one kind of law only.

Works on the raw table of the file, so that it can report beside the errors of the values.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tmm_sheets.task import cam_table
from tmm_sheets.task.toml_lines import KeyPath
from tmm_sheets.words import tell

Found = tuple[KeyPath, str, str]
"""Key path, message, hint."""

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


def check_cam(data: dict[str, Any]) -> Iterator[Found]:
    """Every missing or superfluous key of the follower, the law and the closure."""
    cam = data.get("cam")
    if not isinstance(cam, dict):
        return
    follower = cam.get("follower")
    if isinstance(follower, str) and follower in FOLLOWER_KEYS:
        yield from _of_follower(cam, follower)
    yield from _of_laws(cam)
    if "centre" in cam and "base_radius" in cam:
        yield ("cam", "centre"), tell("a given base_radius tells where the axis is"), tell("leave one of them out")
    if "centre_distance" in cam and "base_radius" not in cam:
        yield ("cam", "centre_distance"), tell("goes with base_radius only"), ""


def _of_follower(cam: dict[str, Any], follower: str) -> Iterator[Found]:
    must, may = FOLLOWER_KEYS[follower]
    told = cam_table.OWN if cam_table.LAW in cam else ()
    for key in must:
        if key not in cam and key not in told:
            yield (
                ("cam", key),
                tell('missing; follower = "{follower}" needs it, for example {key} = {example}').format(
                    follower=follower, key=key, example=EXAMPLES[key]
                ),
                "",
            )
    others = {key for keys in FOLLOWER_KEYS.values() for key in (*keys[0], *keys[1])} - {*must, *may}
    for key in cam:
        if key in others:
            yield (
                ("cam", key),
                tell('follower = "{follower}" has no such key').format(follower=follower),
                tell("its own keys are {keys}").format(keys=", ".join((*must, *may))),
            )
    if follower == "flat" and cam.get("closure") == "geometric":
        yield ("cam", "closure"), tell('expected "force": the second disc of a geometric closure needs a roller'), ""


def _of_laws(cam: dict[str, Any]) -> Iterator[Found]:
    for law, table in (("law", "table"), ("fall_law", "fall_table")):
        if cam.get(law) == "table" and table not in cam:
            yield (
                ("cam", table),
                tell('missing; {law} = "table" needs it, for example {table} = {example}').format(
                    law=law, table=table, example=EXAMPLES[table]
                ),
                "",
            )
        if cam.get(law) == cam_table.LAW and cam_table.LAW not in cam:
            yield ("cam", law), tell("needs the table displacements"), ""
        if table in cam and cam.get(law) != "table":
            yield ("cam", table), tell('is read with {law} = "table" only').format(law=law), ""
