"""Tables that people's programs for spreadsheets write and open: CSV, and workbooks (.xlsx), which are read as if saved as CSV."""

from __future__ import annotations

import csv
import io
import re
import warnings
import zipfile
from collections.abc import Iterable, Iterator, Sequence
from datetime import time
from pathlib import Path
from typing import Any

from tmm_sheets import encodings, files, quoting
from tmm_sheets.errors import BadInput, Problem, reason_of
from tmm_sheets.words import marked, tell

LARGEST = 10_000_000
"""Bytes of the largest table that is read."""
UNPACKED, COLUMNS, ROWS = 100_000_000, 100, 20_000
"""Bytes of what a workbook has packed, columns and rows that are read of one, at most."""
WORKBOOKS = b"PK", b"\xd0\xcf\x11\xe0"
"""How workbooks begin, those of today and the old ones, which nothing here reads."""
SAVE = marked("save the table as CSV in UTF-8")
_COMPUTED = re.compile(r"\s*([=@＝＋＠－\t\r]|[+-](?!$))")
"""How a text begins that a program would compute; a sign alone is none."""


def text_of(path: Path, hint: str) -> encodings.DecodedText:
    """Text of a table, and how it was read; ``hint`` says what was expected.

    Raises
    ------
    BadInput
        when it cannot be read, or is no table.
    """
    try:
        data = files.content(path, LARGEST)
    except OSError as e:
        raise BadInput(Problem(tell("cannot be read: {why}").format(why=reason_of(e)), str(path), hint=hint)) from None
    if data.startswith(WORKBOOKS):
        return encodings.DecodedText(_of_workbook(data, str(path)))
    text, note = encodings.decoded(data, str(path), SAVE)
    return encodings.DecodedText(encodings.cleaned(text), note)


def separator(text: str, remark: str = "\0") -> str:
    """What stands between cells: ; or , or a tab, whichever the first row has most of."""
    head = next((line for line in text.splitlines() if line.strip(' \t;,"') and not line.lstrip(' \t"').startswith(remark)), "")
    return max(";\t,", key=head.count)


def rows(text: str, file: str, remark: str = "\0") -> Iterator[tuple[int, list[str]]]:
    """Rows that say something, with the numbers of their lines; those that begin with ``remark`` say nothing.

    Raises
    ------
    BadInput
        for what is no CSV.
    """
    # Strict: a quote that is left open would hide the rows after it.
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator(text, remark), strict=True)
    try:
        for cells in reader:
            told = [" ".join(cell.split()) for cell in cells]
            if any(told) and not told[0].startswith(remark):
                yield reader.line_num, told
    except csv.Error as e:
        raise BadInput(Problem(tell("cannot be read as CSV: {why}").format(why=e), file, reader.line_num)) from None


def written(table: Iterable[Sequence[str]], sign: str = ";") -> bytes:
    """A table as CSV with ``sign`` between cells; texts that a program would compute begin with an apostrophe."""
    out = io.StringIO()
    csv.writer(out, delimiter=sign, lineterminator="\r\n").writerows([safe(cell) for cell in row] for row in table)
    return b"\xef\xbb\xbf" + out.getvalue().encode()


def safe(text: str) -> str:
    """A text of a cell, with an apostrophe before it where a program would compute it."""
    return f"'{text}" if _COMPUTED.match(text) else text


def _of_workbook(data: bytes, file: str) -> str:
    """The first sheet of a workbook as CSV, a line for each row.

    Raises
    ------
    BadInput
        when openpyxl is not installed, or cannot read it.
    """
    try:
        import openpyxl
    except ImportError:
        hint = tell("{install}; or save the table as CSV").format(install=quoting.install("xlsx"))
        raise BadInput(Problem(tell("a workbook is read by openpyxl, which is not installed"), file, hint=hint)) from None
    out = io.StringIO()
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as packed, warnings.catch_warnings(action="ignore"):  # of what it passes over
            if sum(member.file_size for member in packed.infolist()) > UNPACKED:
                raise ValueError(tell("too large"))
            book = openpyxl.load_workbook(io.BytesIO(data), read_only=True, data_only=True)
            csv.writer(out, delimiter=";", lineterminator="\n").writerows(
                [_as_typed(cell) for cell in row]
                for row in book.worksheets[0].iter_rows(max_row=ROWS, max_col=COLUMNS, values_only=True))
    except Exception as e:  # whatever is wrong in a file that somebody else's program wrote
        raise BadInput(Problem(tell("cannot be read as a workbook: {why}").format(why=e), file,
                               hint=tell(SAVE))) from None
    return encodings.cleaned(out.getvalue())


def _as_typed(value: Any) -> str:
    """A cell as it was typed: 3 for 3.0, and the variant 3:2, which a program takes for a time of the day."""
    if isinstance(value, time):
        return f"{value.hour}:{value.minute}"
    return "" if value is None else " ".join(str(int(value) if isinstance(value, float) and value.is_integer() else value).split())
