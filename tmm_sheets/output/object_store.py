"""Files in an object store, ``s3://bucket/folder`` and whatever else fsspec knows.

An object is there whole or not at all, so nothing passes under another name. Several are not there together: the record is put
first, and what it tells of but is not there, because the program was killed, is made the next time.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

from tmm_sheets.errors import BadInput, Problem, reason_of
from tmm_sheets.files import URL
from tmm_sheets.quoting import install
from tmm_sheets.words import tell

TRIED = ".tmm-sheets.tried"
"""An object that is put and taken away before any work is done: whether one may."""


class Url(type(Path())):  # type: ignore[misc]
    """A place in an object store, called as it was typed."""

    def __str__(self) -> str:
        return URL.sub(r"\1://", super().__str__().replace("\\", "/"), count=1)

    def absolute(self) -> Url:
        """The same: it is."""
        return self


def place(told: Path) -> Path:
    """A place of files as it was told: a folder, or one in an object store."""
    return Url(told) if URL.match(told.as_posix()) else told


class ObjectStore:
    """Files below a place of an object store."""

    def __init__(self, place: Url) -> None:
        self.place = place

    @cached_property
    def _store(self) -> Any:
        protocol = str(self.place).partition(":")[0]
        try:
            import fsspec

            return fsspec.filesystem(protocol)
        except (ImportError, ValueError) as e:
            raise BadInput(Problem(str(e), str(self.place), hint=install("store"))) from None

    def check(self) -> None:
        """Refuse a place that cannot be written, before any work is done for it.

        Raises
        ------
        BadInput
            when it cannot, or no library for it is installed.
        """
        self._put(TRIED, b"")
        self._store.rm_file(str(self.path(TRIED)))

    def sweep(self, names: Iterable[str]) -> None:
        """Nothing: what is killed leaves no part of an object."""

    def path(self, name: str) -> Path:
        """Path to tell the user."""
        return Path.__truediv__(self.place, name)

    def read(self, name: str) -> bytes | None:
        """Content of an object; None when there is none."""
        try:
            return bytes(self._store.cat_file(str(self.path(name))))
        except OSError:
            return None

    def write(self, made: Mapping[str, bytes]) -> None:
        """Put objects, the last first: that is the record.

        Raises
        ------
        BadInput
            when one of them cannot be put.
        """
        for name in reversed([*made]):
            self._put(name, made[name])

    def _put(self, name: str, data: bytes) -> None:
        store = self._store
        try:
            store.pipe_file(str(self.path(name)), data)
        except Exception as e:  # of whatever library reaches the store: no network, no such bucket, no key
            why = reason_of(e) if isinstance(e, OSError) else f"{type(e).__name__}: {e}"
            raise BadInput(Problem(tell("cannot be written: {why}").format(why=why), str(self.path(name)),
                                   hint=tell("is the bucket there, and are you known to it?"))) from None
