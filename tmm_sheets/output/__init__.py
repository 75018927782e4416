"""Sheets as files: one project or many, what has not changed, and paper."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from tmm_sheets.errors import BadInput, CannotBuild

if TYPE_CHECKING:
    from tmm_sheets.task.variant import Variant

TOGETHER, APART = "kinematics_forces_wide", ("kinematics", "forces")
"""Arrangements of what a linkage is and what acts on it, on one sheet and on two."""


def with_room(variant: Variant) -> Variant:
    """The variant with two sheets for kinematics and forces if its file names none and one is too small for both."""
    if variant.project.sheets is not None or TOGETHER not in variant.sheets:
        return variant
    from tmm_sheets.project import Project
    from tmm_sheets.sheets import composition

    with suppress(BadInput, CannotBuild):  # whoever needs its parts says why they cannot be had
        if any("names" in remark.values for remark in composition.crowded(Project(variant), [1])):  # another sheet helps
            named = [*APART, *(name for name in variant.sheets if name != TOGETHER)]
            return variant.model_copy(update={"project": variant.project.model_copy(update={"sheets": tuple(named)})})
    return variant
