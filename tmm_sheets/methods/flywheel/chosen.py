"""The flywheel of a linkage by the method that its data name."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tmm_sheets.methods.flywheel import mertsalov, wittenbauer
from tmm_sheets.methods.flywheel.flywheel import Flywheel
from tmm_sheets.methods.flywheel.reduced_data import ReducedData

if TYPE_CHECKING:
    from tmm_sheets.task.schema import FlywheelTable


def flywheel(reduced: ReducedData, data: FlywheelTable) -> Flywheel:
    """Flywheel of a linkage by the method its data name.

    Raises
    ------
    ValueError
        when there is no method of that name.
    """
    if data.method == "mertsalov":
        return mertsalov.Mertsalov(reduced, data, mertsalov.SPACE)
    if data.method == "wittenbauer":
        return wittenbauer.Wittenbauer(reduced, data)
    raise ValueError(f"flywheel method {data.method!r} is not known; known: 'wittenbauer', 'mertsalov'")
