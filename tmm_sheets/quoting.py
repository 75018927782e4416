"""Commands that messages tell to run: what stands there can be copied, and does to the same project what the message is about."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

PROGRAM = "tmm-sheets"


def command(*arguments: str | Path) -> str:
    """A command of the program with these arguments, as it is typed in a shell."""
    return quoted((PROGRAM, *map(str, arguments)))


def quoted(arguments: Iterable[str]) -> str:
    """Arguments as they are typed in a shell: in quotes where one of them has spaces or signs that the shell would take for its."""
    if os.name == "nt":
        import subprocess

        return subprocess.list2cmdline(arguments)
    import shlex

    return " ".join(one if re.fullmatch(r"[\w@%+=:,./-]+", one) else shlex.quote(one) for one in arguments)


def install(*extras: str) -> str:
    """The command that installs the packages of extras of this program, however that was installed itself."""
    from importlib import metadata

    wanted = []
    with suppress(metadata.PackageNotFoundError):
        for line in metadata.requires(PROGRAM) or ():
            package, _, when = line.partition(";")
            if any(re.search(rf"""extra == ['"]{extra}['"]""", when) for extra in extras):
                wanted.append(package.strip().replace(" ", ""))
    # The latter in the folder of the program's source.
    return quoted(("pip", "install", *dict.fromkeys(wanted or ["-e", f".[{','.join(extras)}]"])))
