"""Every known element of a sheet measured in the rectified picture, along its normals.

First each element is looked for at its own place, no farther than half way to the next line that is known to be there. What is
found is wiped out of the picture, with a pencil's width to spare, lettering and heads of arrows too. Whatever has not been found
is sought in the ink that is left, some millimetres away, turned or of another size (``displaced``). Ink that is left after that
belongs to nothing (``extra_ink``). Lines that lie in one stroke are measured together: what cannot be told apart by the eye is not
told apart here.

An element's displacement is a similarity: two shifts, a turn and a growth, of which only what shows along its normals is
determined (a straight line has no shift along itself and no growth; its length is measured at its ends).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.photo.extra_ink import extra_ink
from tmm_sheets.compare.photo.image_alignment import in_place, strips
from tmm_sheets.compare.photo.image_shifts import displaced
from tmm_sheets.compare.photo.ink_levels import ink_levels
from tmm_sheets.compare.photo.ink_owner import Owners
from tmm_sheets.compare.photo.line_ends import with_ends
from tmm_sheets.compare.photo.profiles import pixels, sample
from tmm_sheets.compare.photo.stations import measurable, stations
from tmm_sheets.compare.photo.traces import Extra, Trace
from tmm_sheets.compare.photo.wiping import fill, grown, wipe_found, wipe_small

WRITTEN = 0.02  # share of its place with ink, from which on lettering is there


def trace(elements: Sequence[Element], ink: Any) -> tuple[list[Trace], list[Extra]]:
    """Measure all elements in a rectified picture (see ``rectification.straighten``); also the ink that belongs to none."""
    level, pale = ink_levels(ink)
    owners = Owners(*ink.shape)
    for e in elements:
        owners.add(e, e.points)
    lines, small = [e for e in elements if measurable(e)], [e for e in elements if not measurable(e)]
    found: list[Trace] = []
    absent: list[Element] = []
    for strip in strips(lines, ink, owners):
        near = in_place(strip, pale)
        if near is None:
            absent.append(strip.element)
        else:
            found.append(near)
    wiped = np.zeros_like(ink)
    for e in small:
        wipe_small(wiped, e)
    for t in found:
        wipe_found(wiped, t)
    left = ink.copy()
    left[wiped > 0] = 0
    for e in sorted(absent, key=lambda e: -e.length):
        t = displaced(e, stations(e, e.kind != "line"), left, wiped, ink, pale)
        found.append(t)
        if t.at is not None:
            owners.add(e, t.at)
            wipe_found(wiped, t)
            wipe_found(left, t, 0)
    open_lines = [t for t in found if t.status == "measured" and t.element.kind != "circle"]
    ended = with_ends(open_lines, ink, owners, _words(elements, ink), pale)
    out = {t.element.number: t for t in (*found, *ended)} | _presence(small, ink, level)
    for e in elements:  # a hand may have written here
        if e.kind == "text":
            fill(left, grown(e, 0.8 * e.height + 1.0), 0)
    return [out[e.number] for e in elements], extra_ink(left, level)


def _words(elements: Sequence[Element], ink: Any) -> Any:
    """Picture of the places of lettering."""
    out = np.zeros_like(ink)
    for e in elements:
        if e.kind == "text":
            fill(out, grown(e, 0.3))
    return out


def _presence(small: Sequence[Element], ink: Any, level: float) -> dict[int, Trace]:
    """Lettering: is there any ink? Of hatching and what is too small to be measured nothing is asked. By number."""
    out = {e.number: Trace(e, "small", covered=1.0) for e in small}
    words = [e for e in small if e.kind == "text"]
    if not words:
        return out
    u, v = (t.ravel() for t in np.meshgrid(np.linspace(0, 1, 40), np.linspace(0, 1, 12)))
    corners = np.stack([grown(e, 1.0) for e in words])
    a, b, _, d = corners.T[:, :, None]
    shares = (sample(ink, pixels(a + u * (b - a) + v * (d - a))) > level).mean(1)
    for e, share in zip(words, shares.tolist(), strict=True):
        out[e.number] = Trace(e, "lettering" if share > WRITTEN else "absent lettering", covered=share)
    return out
