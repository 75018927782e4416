"""Results as arrays under their paths, as ``why`` takes them: ``velocities.points.B``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tmm_sheets import spelling
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.result_files import columns, leaves, plain_numbers, row
from tmm_sheets.words import tell


class Numbers(dict[str, Any]):
    """Arrays, numbers and words by the paths of the results.

    A quantity over the positions is an array of shape (n,), a point one of shape (n, 2); NaN where nothing is defined. SI and
    rad; lengths of gears, reducers and trains in mm.

    Attributes
    ----------
    tree
        the same as ``solve --json`` writes it.
    refused
        parts that cannot be computed, with the reasons.
    """

    def __init__(self, told: Mapping[str, Any], refused: Mapping[str, CannotBuild]) -> None:
        super().__init__((path, _array(value)) for path, value in leaves(told))
        self._told = dict(told)
        self.refused = dict(refused)

    def __missing__(self, path: str) -> Any:
        """Raise what there is to say of a path that is none.

        Raises
        ------
        BadInput
            with the nearest paths.
        CannotBuild
            when its part cannot be computed.
        """
        part = path.partition(".")[0]
        if part in self.refused:
            raise self.refused[part]
        raise BadInput(tell('there is no result "{result}"').format(result=path), spelling.hint(path, self, 6, 0.5))

    @property
    def tree(self) -> dict[str, Any]:
        """Nested lists and numbers, None where nothing is defined."""
        return plain_numbers(self._told)  # type: ignore[no-any-return]

    @property
    def columns(self) -> dict[str, Any]:
        """What is told of the positions as columns of as many rows: label, angle, and both projections of a point apart."""
        if "cycle" not in self._told:
            return {}
        return {"label": list(self._told["cycle"]["labels"]), **columns(self._told)}

    def frame(self) -> Any:
        """The columns as a DataFrame of pandas, its rows called after the positions.

        Raises
        ------
        CannotBuild
            where pandas is not installed.
        """
        try:
            from pandas import DataFrame
        except ImportError:
            raise CannotBuild(tell("pandas is not installed"), "pip install pandas") from None
        return DataFrame(self.columns).set_index("label") if self.columns else DataFrame()


def _array(value: Any) -> Any:
    """A row as an array; anything else as it is, None for a number that is not defined as NaN."""
    import numpy as np

    array = row(value)
    if array is not None:
        return array
    own = plain_numbers(value)
    if isinstance(own, list) and any(x is None for x in own):
        return np.array(own, dtype=float)
    return float("nan") if own is None else np.asarray(own) if isinstance(own, list) else own
