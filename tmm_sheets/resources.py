"""Where the data folders are: beside the package in a source checkout, inside it in an installed wheel."""

from __future__ import annotations

from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent


@cache
def _folder(name: str) -> Path:
    for folder in (PACKAGE / f"_{name}", PACKAGE.parent / name):
        if folder.is_dir():
            return folder
    raise FileNotFoundError(f"data folder '{name}' is missing beside and inside {PACKAGE}")


def template(path: str) -> Path:
    """Path of a file in ``templates/``, e.g. ``template("linetypes.toml")``; the file itself need not exist.

    Raises
    ------
    FileNotFoundError
        when the folder is missing.
    """
    return _folder("templates") / path


def variants() -> Path:
    """The folder with the shipped project files.

    Raises
    ------
    FileNotFoundError
        when it is missing.
    """
    return _folder("variants")
