"""Results as files: JSON, piece by piece, arrays (npz), a table (csv). However many positions there are, no second copy is made.

In Python they are arrays under their paths, as ``why`` takes them: ``velocities.points.B``.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from math import isfinite
from typing import IO, Any

from tmm_sheets import spelling
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.words import tell

PIECE = 4096
"""Positions written at a time."""
OVER_POSITIONS = ("cycle", "positions", "velocities", "accelerations", "forces", "condition")
"""What of the results is told of positions."""
LEVELS = 3
"""Levels of keys with a line for each."""


def json_pieces(tree: dict[str, Any]) -> Iterator[str]:
    """JSON text of a results tree, whose numbers may be steps or arrays; a line for every key down to the third level."""
    yield from _lines(tree, 0)


def _lines(value: Any, level: int) -> Iterator[str]:
    if isinstance(value, dict) and value and level < LEVELS:
        indent, comma = " " * (level + 1), "{\n"
        for key, inner in value.items():
            yield f"{comma}{indent}{json.dumps(key, ensure_ascii=False)}: "
            yield from _lines(inner, level + 1)
            comma = ",\n"
        yield "\n" + " " * level + "}"
        return
    array = row(value)
    if array is None:
        yield json.dumps(plain_numbers(value), ensure_ascii=False, allow_nan=False)
        return
    from pydantic_core import to_json  # eight times as quick as json with numbers

    comma = "["
    for begin in range(0, len(array), PIECE):
        part = to_json((array[begin:begin + PIECE] + 0.0).tolist(), inf_nan_mode="null")  # -0.0 becomes 0.0
        yield comma + part[1:-1].replace(b",", b", ").decode()
        comma = ", "
    yield "]"


def row(value: Any) -> Any:
    """A row of numbers of a results tree as an array, points as two columns; None for anything else, and for an empty row."""
    import numpy as np

    if hasattr(value, "step") or hasattr(value, "rule"):
        value = value.value
    if not isinstance(value, np.ndarray) or value.ndim != 1 or not len(value) or value.dtype.kind not in "fc":
        return None
    if value.dtype.kind == "c":
        return np.ascontiguousarray(value, dtype=complex).view(float).reshape(-1, 2)
    return value.astype(float, copy=False)


def plain_numbers(value: Any) -> Any:
    """Lists, texts and numbers only: values of steps, a point as [x, y]; NaN and infinity become null."""
    if isinstance(value, str):  # most are labels of positions
        return value
    if hasattr(value, "step") or hasattr(value, "rule"):  # Told, or a whole step
        return plain_numbers(value.value)
    if isinstance(value, complex):
        return [plain_numbers(value.real), plain_numbers(value.imag)]
    if isinstance(value, dict):
        return {key: plain_numbers(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [plain_numbers(v) for v in value]
    if hasattr(value, "tolist"):
        return plain_numbers(value.tolist())
    if isinstance(value, float):
        return value + 0.0 if isfinite(value) else None  # -0.0 becomes 0.0
    return value


def write_json(tree: dict[str, Any], file: IO[bytes]) -> None:
    """The tree as UTF-8."""
    for piece in json_pieces(tree):
        file.write(piece.encode())
    file.write(b"\n")


def leaves(tree: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Every row, number or word of a tree under its path, as ``why`` takes it: ``forces.reactions.F54``."""
    if isinstance(tree, dict):
        for key, value in tree.items():
            yield from leaves(value, f"{path}.{key}" if path else str(key))
    elif isinstance(tree, list | tuple) and tree and isinstance(tree[0], dict):
        for n, value in enumerate(tree):
            yield from leaves(value, f"{path}[{n}]")
    elif tree is not None:
        yield path, tree


def write_npz(tree: dict[str, Any], file: IO[bytes]) -> None:
    """Arrays under the paths of the tree, as ``numpy.load`` reads them: points with two columns, NaN where nothing is defined.

    The same bytes each time: the entries of the archive have a fixed date.
    """
    import zipfile

    import numpy as np

    with zipfile.ZipFile(file, "w", zipfile.ZIP_STORED) as archive:
        for path, value in leaves(tree):
            entry = zipfile.ZipInfo(f"{path}.npy", date_time=(1980, 1, 1, 0, 0, 0))
            with archive.open(entry, "w", force_zip64=True) as out:
                np.lib.format.write_array(out, np.asarray(_array(value)), allow_pickle=False)


def write_csv(tree: dict[str, Any], file: IO[bytes]) -> None:
    """Everything that is told of the positions, a row for each: label, crank angle, then columns under the paths of the tree.

    A point has two columns, ``.x`` and ``.y``; what is not defined, or not told of a position, is left empty.

    Raises
    ------
    CannotBuild
        when nothing is told of positions.
    """
    if "cycle" not in tree:
        raise CannotBuild(tell("there is nothing over positions to write a table of"),
                          tell("ask for positions, velocities, accelerations or forces, or take --json"))
    labels: list[str] = tree["cycle"]["labels"]
    found = list(_columns(tree, labels))
    file.write((",".join(["label", *(_quoted(name) for name, _, _ in found)]) + "\n").encode())
    for begin in range(0, len(labels), PIECE):
        here = range(begin, min(begin + PIECE, len(labels)))
        written = [map(_quoted, labels[begin:begin + PIECE]), *(_cells(array, rows, here) for _, array, rows in found)]
        file.write("".join(",".join(cells) + "\n" for cells in zip(*written, strict=True)).encode())


def _columns(tree: dict[str, Any], labels: list[str]) -> Iterator[tuple[str, Any, dict[int, int] | None]]:
    """Name and values of each column; of one that some positions have, which value belongs to which."""
    chosen = tree.get("forces", {}).get("label", labels)
    some = None if list(chosen) == labels else {labels.index(label): n for n, label in enumerate(chosen)}
    for path, value in leaves({key: tree[key] for key in OVER_POSITIONS if key in tree}):
        of_forces = path.startswith("forces.") or path == "condition.forces"
        array = row(value)
        if array is None or len(array) != (len(chosen) if of_forces else len(labels)):
            continue
        rows = some if of_forces else None
        if array.ndim == 1:
            yield path, array, rows
        else:
            yield f"{path}.x", array[:, 0], rows
            yield f"{path}.y", array[:, 1], rows


def columns(tree: dict[str, Any]) -> dict[str, Any]:
    """The columns of the table as arrays with a number for each position, NaN where there is none."""
    labels = tree["cycle"]["labels"]
    return {name: _spread(array, rows, range(len(labels))) for name, array, rows in _columns(tree, labels)}


def _spread(array: Any, rows: dict[int, int] | None, here: range) -> Any:
    import numpy as np

    if rows is None:
        return array[here.start:here.stop] + 0.0
    return np.array([float(array[rows[i]]) if i in rows else np.nan for i in here])


def _cells(array: Any, rows: dict[int, int] | None, here: range) -> Iterator[str]:
    return (repr(x) if isfinite(x) else "" for x in _spread(array, rows, here).tolist())


def _quoted(text: str) -> str:
    return '"' + text.replace('"', '""') + '"' if any(c in text for c in ',"\n\r') else text


# --- results by their paths --------------------------------------------------------------------------------------------


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
        self.told = dict(told)
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
        return plain_numbers(self.told)  # type: ignore[no-any-return]

    @property
    def columns(self) -> dict[str, Any]:
        """What is told of the positions as columns of as many rows: label, angle, and both projections of a point apart."""
        return {} if "cycle" not in self.told else {"label": list(self.told["cycle"]["labels"]), **columns(self.told)}

    def frame(self) -> Any:
        """The columns as a DataFrame of pandas, its rows called after the positions.

        Raises
        ------
        CannotBuild
            where pandas is not installed.
        """
        return frame_of(self.columns, "label")


def frame_of(columns: Mapping[str, Any], index: str = "") -> Any:
    """Columns as a DataFrame of pandas.

    Raises
    ------
    CannotBuild
        where pandas is not installed.
    """
    try:
        from pandas import DataFrame
    except ImportError:
        raise CannotBuild(tell("pandas is not installed"), "pip install pandas") from None
    return DataFrame(columns).set_index(index) if columns and index else DataFrame(columns)


def _array(value: Any) -> Any:
    """A row as an array; anything else as it is, None for a number that is not defined as NaN."""
    import numpy as np

    array = row(value)
    if array is not None:
        return array
    own = plain_numbers(value)
    if not isinstance(own, list):
        return float("nan") if own is None else own
    array = np.asarray(own)
    return np.array(own, dtype=float) if array.dtype.kind == "O" else array
