"""Families of tasks: folders that write the project file of any variant from a manual's tables, see :mod:`~.family_folder`.

A family answers for all project names ``FOLDER/...``. Those of the program are folders of ``variants/``; others are in the working
folder, in ``families`` of the user's folder of configuration, in a folder that TMM_SHEETS_PATH names, or where a package says by an
entry point of the group ``tmm_sheets.families``; they are looked for in this order. A process that is confined to the data of
strangers knows the program's and those of packages.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from functools import cache, lru_cache
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING, Any

from tmm_sheets import files, resources
from tmm_sheets.errors import BadInput

if TYPE_CHECKING:
    from tmm_sheets.task.family_folder import FolderFamily

FILE, PATH, GROUP = "family.toml", "TMM_SHEETS_PATH", "tmm_sheets.families"
"""File of a folder that is a family, environment variable and entry points that tell where there are some."""
CONFIG_FOLDER = "TMM_SHEETS_CONFIG"
"""Environment variable that names the user's folder; empty for none."""


@cache
def known() -> tuple[str, ...]:
    """Names of the program's families, sorted."""
    return tuple(sorted(file.parent.name for file in resources.variants().glob(f"*/{FILE}")))


def of(project: str) -> FolderFamily | None:
    """The family that a project name belongs to."""
    folder = folder_of(project)
    if folder is None:
        return None
    file = folder / FILE
    return _as_last_written(folder, file.stat().st_mtime_ns if file.is_file() else 0)
def folder_of(project: str) -> Path | None:
    """The folder of the family that a project name belongs to."""
    family, sign, _ = project.partition("/")
    if not sign or not re.fullmatch(r"[\w-]+", family):
        return None
    if family in known():
        return resources.variants() / family
    return None if (resources.variants() / family).is_dir() else _folder(family)


def names() -> Iterator[str]:
    """Names of all families' projects; none of a folder that cannot be read."""
    for folder in (*(resources.variants() / name for name in known()), *folders().values()):
        with suppress(BadInput, OSError, ValueError, LookupError, TypeError, AttributeError):  # somebody has not finished it
            yield from listed(folder)


def listed(folder: Path) -> Iterator[str]:
    """Names of a family's projects, as ``list`` shows them: of each machine the example, or all ciphers that ``shown`` has."""
    rules, family = _rules(folder), folder.resolve().name
    for name, machine in rules["machine"].items():
        for cipher in rules.get("shown") or [machine.get("example") or rules["example"]]:
            yield f"{family}/{name}{rules.get('separator', '@')}{cipher}"


def heading(folder: Path, project: str) -> dict[str, Any]:
    """Table ``[project]`` of one of these names; a KeyError where it needs what tables have."""
    rules = _rules(folder)
    called, _, cipher = project.partition("/")[2].partition(rules.get("separator", "@"))
    machine = rules["machine"][called]
    about = {"name": project, "machine": called, "cipher": cipher, "title": machine.get("title") or called}
    scheme = machine["scheme"][0]
    return table_of_heading(folder / scheme if _is_ours(folder) else files.named(scheme, folder, folder), about)


def table_of_heading(path: Path, fields: Mapping[str, str] | None = None) -> dict[str, Any]:
    """Table ``[project]`` of a project file, or of a scheme with the ``fields`` that are filled in there; no other is read."""
    rest = re.split(r"^\[project\]$", _text(path), maxsplit=1, flags=re.MULTILINE)[1]
    heading = re.split(r"^\[", rest, maxsplit=1, flags=re.MULTILINE)[0]
    return _tables(Template(heading).substitute(fields) if fields else heading, path)


def _text(path: Path) -> str:
    if _is_ours(path):
        return path.read_text(encoding="utf-8")
    from tmm_sheets import toml_file

    return toml_file.text_of(path)[0]


def _tables(text: str, path: Path) -> dict[str, Any]:
    """Tables of the text of a file; of what others wrote within limits."""
    if _is_ours(path):
        import tomllib  # not for --help, which looks for no family

        return tomllib.loads(text)
    from tmm_sheets import toml_file

    return toml_file.parsed(text, str(path))[0]


def _is_ours(path: Path) -> bool:
    return path.is_relative_to(resources.variants())


def user_folder() -> Path | None:
    """Where the user's own settings and families are, or would be; None without such a folder, or for work on data of strangers."""
    if files.confined():
        return None
    told = os.environ.get(CONFIG_FOLDER)
    if told is not None:
        return Path(told) if told else None
    from platformdirs import user_config_dir

    found = Path(user_config_dir("tmm-sheets", appauthor=False))
    return found if found.is_absolute() else None  # nobody's home


def folders() -> dict[str, Path]:
    """Folders that are families, by their names."""
    found: dict[str, Path] = {}
    for place in _places():
        for file in sorted(place.glob(f"*/{FILE}")) if place.is_dir() else ():
            found.setdefault(file.parent.resolve().name, file.parent)
    for name, folder in installed_families():
        found.setdefault(name, folder)
    return {name: folder for name, folder in found.items() if name not in known()}


def state() -> tuple[tuple[Path, int], ...]:
    """What is another one when there is another family, or one of users' was changed; of a scheme, that it is there."""
    found = ((folder.absolute(), path) for folder in folders().values() for path in sorted(folder.glob("*.toml")))
    return tuple((folder / path.name, path.stat().st_mtime_ns if path.is_file() else 0) for folder, path in found)


def _rules(folder: Path) -> dict[str, Any]:
    """What ``family.toml`` of a folder says; nothing is checked."""
    path = folder / FILE
    return _parsed(path, path.stat().st_mtime_ns)


@lru_cache(maxsize=64)
def _parsed(path: Path, changed: int) -> dict[str, Any]:
    """A family's rules, read once however many of its projects are listed."""
    return _tables(_text(path), path)


def _folder(name: str) -> Path | None:
    """The folder of a family."""
    for place in _places():
        if (place / name / FILE).is_file():
            return place / name
    return dict(installed_families()).get(name)


def _places() -> Iterator[Path]:
    """Folders that may have families in them."""
    if files.confined():
        return
    yield Path()
    user = user_folder()
    if user is not None:
        yield user / "families"
    yield from (Path(place) for place in os.environ.get(PATH, "").split(os.pathsep) if place)


@cache
def installed_families() -> tuple[tuple[str, Path], ...]:
    """Families of other packages: an entry point is a path, or a package whose folder it is."""
    from importlib.metadata import entry_points

    told = ((entry.name, entry.load()) for entry in entry_points(group=GROUP))
    found = ((name, Path(there.__path__[0]) if hasattr(there, "__path__") else Path(there)) for name, there in told)
    return tuple((name, folder) for name, folder in found if (folder / FILE).is_file())


@lru_cache(32)
def _as_last_written(folder: Path, changed: int) -> FolderFamily:
    """The family of a folder, as it was written last."""
    from tmm_sheets.task.family_folder import FolderFamily

    return FolderFamily(folder)
