"""Where the data folders are: beside the package in a source checkout, inside it in an installed wheel."""

from __future__ import annotations

import os
from functools import cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

PACKAGE = os.path.dirname(os.path.realpath(__file__))


@cache
def folder(name: str) -> str:
    """The folder of some data.

    Raises
    ------
    FileNotFoundError
        when it is missing.
    """
    for found in (os.path.join(PACKAGE, f"_{name}"), os.path.join(os.path.dirname(PACKAGE), name)):
        if os.path.isdir(found):
            return found
    raise FileNotFoundError(f"data folder '{name}' is missing beside and inside {PACKAGE}")


@cache
def _path(name: str) -> Path:
    from pathlib import Path  # not for --help, whose start it would make a tenth longer

    return Path(folder(name))


def template(path: str) -> Path:
    """Path of a file in ``templates/``, e.g. ``template("linetypes.toml")``; the file itself need not exist.

    Raises
    ------
    FileNotFoundError
        when the folder is missing.
    """
    return _path("templates") / path


def variants() -> Path:
    """The folder with the shipped project files.

    Raises
    ------
    FileNotFoundError
        when it is missing.
    """
    return _path("variants")
