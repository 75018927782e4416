"""Where the files of one project go, a folder or an archive, and the record there of what each of them was made from.
An object store is ``s3://bucket/folder`` or whatever else fsspec knows.

A file is current when the record names the same inputs for it and its content is the one that was written then; so an
interrupted or repeated build makes only what is missing or has changed. A file of another content than any that was written here
was changed by hand: it stays, and the new one goes beside it.
"""

from __future__ import annotations

import json
import re
import zipfile
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from itertools import count
from pathlib import Path
from types import MappingProxyType
from typing import Any

from tmm_sheets import files, kept
from tmm_sheets.errors import BadInput, Problem, reason_of
from tmm_sheets.files import URL
from tmm_sheets.kept import fingerprint
from tmm_sheets.quoting import install
from tmm_sheets.words import tell

RECORD = ".tmm-sheets.json"
SCHEMA = 1


@dataclass
class BuildRecord:
    """What is known of the files of an earlier build: for each name what it was made from and its content, as fingerprints.

    ``whole`` is the fingerprint of the inputs with which all sheets of the project passed together.
    """

    files: dict[str, tuple[str, str]] = field(default_factory=dict)
    whole: str = ""

    @classmethod
    def read(cls, data: bytes | None) -> BuildRecord:
        """The record of these bytes; an empty one when they are not such a record."""
        return kept.taken(data, lambda tree: cls(
            {str(k): (str(made), str(content)) for k, (made, content) in tree["files"].items()}, str(tree["whole"]))
            if tree["schema"] == SCHEMA else None) or cls()

    def data(self) -> bytes:
        """Its bytes."""
        tree = {"schema": SCHEMA, "whole": self.whole, "files": {k: list(self.files[k]) for k in sorted(self.files)}}
        return (json.dumps(tree, indent=1) + "\n").encode()


class Folder:
    """Files in a folder."""

    def __init__(self, path: Path) -> None:
        self.place = path

    def check(self) -> None:
        """Refuse a place that cannot be written, before any work is done for it."""
        files.check_folder(self.place)

    def sweep(self, names: Iterable[str]) -> None:
        """Remove what killed builds left of these files."""
        for name in (*names, RECORD):
            files.sweep(self.place / name)

    def path(self, name: str) -> Path:
        """Path to tell the user."""
        return self.place / name

    def read(self, name: str) -> bytes | None:
        """Content of a file; None when there is none, or a pipe or a device."""
        path = self.place / name
        try:
            return path.read_bytes() if path.is_file() else None
        except OSError:
            return None

    def write(self, made: Mapping[str, bytes]) -> None:
        """Write files, all or none."""
        files.write_all({self.place / name: data for name, data in made.items()})


class Archive:
    """Files in one zip file."""

    def __init__(self, path: Path) -> None:
        self.place = path if path.suffix == ".zip" else path.with_name(f"{path.name}.zip")

    def check(self) -> None:
        """Check, before any work is done for it, that the place can be written.

        Raises
        ------
        BadInput
            when it cannot, or is something else than a zip file, or a damaged one.
        """
        files.check_folder(self.place.parent)
        if self._members() is None:
            raise BadInput(Problem(tell("expected a zip file"), str(self.place), hint=tell("choose another place with -o")))

    def sweep(self, names: Iterable[str]) -> None:
        """Remove what killed builds left of the archive."""
        files.sweep(self.place)

    def path(self, name: str) -> Path:
        """Path to tell the user."""
        return self.place / name

    def read(self, name: str) -> bytes | None:
        """Content of a member; None when there is none."""
        with suppress(Exception), zipfile.ZipFile(self.place) as archive:
            return archive.read(name)
        return None

    def _members(self) -> dict[str, bytes] | None:
        """All members; None when one of them cannot be read."""
        try:
            with zipfile.ZipFile(self.place) as archive:
                return {name: archive.read(name) for name in archive.namelist()}
        except FileNotFoundError:
            return {}
        except Exception:  # each kind of damage raises an error of its own
            return None

    def write(self, made: Mapping[str, bytes]) -> None:
        """Write members, those not written now stay; the archive appears whole or not at all."""
        members = {**(self._members() or {}), **made}
        files.write_all({self.place: files.zipped({name: members[name] for name in sorted(members)})})


TRIED = ".tmm-sheets.tried"
"""An object that is put and taken away before any work is done: whether one may."""


class Url(type(Path())):  # type: ignore[misc]
    """A place in an object store, called as it was typed."""

    def __str__(self) -> str:
        return re.sub(URL, r"\1://", super().__str__().replace("\\", "/"), count=1)

    def absolute(self) -> Url:
        """The address, which is absolute."""
        return self


def place(told: Path) -> Path:
    """A place of files as it was told: a folder, or one in an object store."""
    return Url(told) if re.match(URL, told.as_posix()) else told


class ObjectStore:
    """Files below a place of an object store.

    An object is there whole or not at all, so nothing passes under another name. Several are not there together: the record is
    put first, and what it tells of but is not there, because the program was killed, is made the next time.
    """

    def __init__(self, place: Url) -> None:
        self.place = place

    @cached_property
    def _store(self) -> Any:
        if str(self.place).startswith("memory:"):
            raise BadInput(Problem(tell("what is put there is gone when the program ends"), str(self.place)))
        try:
            from fsspec.core import url_to_fs

            return url_to_fs(str(self.place))[0]
        except Exception as e:  # no library for it, or what that library says of the place
            raise BadInput(Problem(_reason(e), str(self.place), hint=install("store"))) from None

    def check(self) -> None:
        """Refuse a place that cannot be written, before any work is done for it.

        Raises
        ------
        BadInput
            when it cannot, or no library for it is installed.
        """
        self._store_file(TRIED, b"")
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
            self._store_file(name, made[name])

    def _store_file(self, name: str, data: bytes) -> None:
        store = self._store
        try:
            store.pipe_file(str(self.path(name)), data)
        except Exception as e:  # of whatever library reaches the store: no network, no such bucket, no key
            raise BadInput(Problem(tell("cannot be written: {why}").format(why=_reason(e)), str(self.path(name)),
                                   hint=tell("is the bucket there, and are you known to it?"))) from None


def _reason(e: Exception) -> str:
    """What a library that reaches stores says."""
    if isinstance(e, OSError):
        return reason_of(e)
    return str(e) if isinstance(e, ValueError | ImportError) else f"{type(e).__name__}: {e}"


Outlet = Folder | Archive | ObjectStore


def outlet(place: Path, archive: bool = False) -> Outlet:
    """A place for files: a folder, one of an object store, an ``archive``.

    Raises
    ------
    BadInput
        for an archive in an object store.
    """
    if isinstance(place, Url):
        if archive:
            raise BadInput(tell("--zip writes into a folder"))
        return ObjectStore(place)
    return Archive(place) if archive else Folder(place)


def record_of(outlet: Outlet) -> BuildRecord:
    """The record that stands at a place."""
    return BuildRecord.read(outlet.read(RECORD))


def current(outlet: Outlet, record: BuildRecord, name: str, made_from: str) -> bool:
    """True when the file is there as it was made from these very inputs."""
    known = record.files.get(name)
    if known is None or known[0] != made_from:
        return False
    data = outlet.read(name)
    return data is not None and fingerprint(data) == known[1]


def free_name(outlet: Outlet, record: BuildRecord, name: str) -> str:
    """The name itself where no file of that name was changed by hand, else the first such one with .new (.new2 ...) in it."""
    ours = {content for _, content in record.files.values()}
    stem, dot, suffix = name.rpartition(".")
    names = (f"{stem}.new{n if n > 1 else ''}{dot}{suffix}" if n else name for n in count())
    return next(other for other in names if (data := outlet.read(other)) is None or fingerprint(data) in ours)


def put(outlet: Outlet, made: Mapping[str, bytes], force: bool, made_from: str = "") -> tuple[list[str], list[str]]:
    """Write files that are made anew each time; the names they got, and what is to be said of those that were changed by hand.

    Such a file stays, and the new one goes beside it; with ``force`` it is overwritten. ``made_from`` is the fingerprint of their
    inputs, for who asks whether they are :func:`current`.
    """
    record = record_of(outlet)
    named, stays = dict[str, bytes](), list[str]()
    for name, data in made.items():
        new = name if force or outlet.read(name) == data else free_name(outlet, record, name)
        if new != name:
            stays.append(of_hand(name, new))
        named[new] = data
    keep(outlet, record, named, dict.fromkeys(named, made_from), None)
    return list(named), stays


def put_again(outlet: Outlet, made_from: Mapping[str, str], whole: str | None, contents: Mapping[str, bytes]) -> int | None:
    """Put files of an earlier build where nothing of them is; how many, and None where something else is in their way.

    ``made_from`` and ``whole`` are what the record says of them, other ``contents`` those of files beside them.
    """
    outlet.check()
    outlet.sweep(made_from)
    record = record_of(outlet)
    if whole in (None, record.whole) and all(current(outlet, record, name, of) for name, of in made_from.items()):
        return 0
    if any(outlet.read(name) is not None for name in made_from):
        return None
    beside = {name: data for name, data in contents.items() if name not in made_from and outlet.read(name) in (None, data)}
    keep(outlet, record, {name: contents[name] for name in made_from}, made_from, whole, beside)
    return len(made_from)


def untouched(path: Path) -> bool:
    """Whether a file is just as it was written here."""
    place = Folder(path.parent)
    known, data = record_of(place).files.get(path.name), place.read(path.name)
    return known is not None and data is not None and fingerprint(data) == known[1]


def of_hand(name: str, new: str) -> str:
    """That a file was changed by hand, and where the new one is."""
    return tell("{name} was changed by hand and stays; the new one is {new} (--force overwrites it)").format(name=name, new=new)


def keep(outlet: Outlet, record: BuildRecord, made: Mapping[str, bytes], made_from: Mapping[str, str], whole: str | None,
         beside: Mapping[str, bytes] = MappingProxyType({})) -> None:
    """Write files together with the record of them and of those that lie ``beside`` them, which are written where they are not."""
    both = {**made, **beside}
    known: dict[str, Any] = record.files | {name: (made_from.get(name, ""), fingerprint(data)) for name, data in both.items()}
    told = BuildRecord(known, record.whole if whole is None else whole)
    missing = {name: data for name, data in beside.items() if outlet.read(name) is None}
    outlet.write({**made, **missing, RECORD: told.data()})
