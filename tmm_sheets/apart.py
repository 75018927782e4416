"""Work on a stranger's file in a process of its own, within limits: whatever the file asks for, it ends, and in words.

A drawing of a few kilobytes may hold arrays of millions of lines, or forms that hold forms: read here, it would cost hours, or
gigabytes before the system ends the program. Run as a script this file is that process, which imports what it needs only: it is
told on standard input what to carry out, and what came of it goes to standard output.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from threading import Timer
from typing import TypeVar

SECONDS, MEMORY = 20, 1_000_000_000
"""Seconds of processor and bytes of memory for reading one file."""
LARGEST = 400_000_000
"""Bytes of the largest file that is written within limits, and of the largest answer that is taken."""
WAITING = 6.0
"""How many times its seconds it may take by the clock: others work too."""
T = TypeVar("T")


def carried_out(work: Callable[[Path], T], path: Path, hint: str, seconds: int = SECONDS, memory: int = MEMORY) -> T:
    """What a function of a module makes of a file.

    Raises
    ------
    BadInput, CannotBuild
        as it does.
    CannotBuild
        when it takes more than it may; ``hint`` says what to try.
    """
    from tmm_sheets import words
    from tmm_sheets.errors import CannotBuild

    asked = work.__module__, work.__qualname__, path, (words.reader(), words.paper()), seconds, memory
    process = subprocess.Popen([sys.executable, "-P", __file__], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                               stderr=subprocess.DEVNULL)
    late = Timer(WAITING * seconds, process.kill)
    late.start()
    try:
        with process:
            assert process.stdin is not None
            assert process.stdout is not None
            with suppress(BrokenPipeError):
                pickle.dump(asked, process.stdin)
                process.stdin.close()
            came, outcome = pickle.load(process.stdout)
    except (EOFError, pickle.UnpicklingError):
        came, outcome = "", None
    finally:
        late.cancel()
    if came == "raised":
        raise outcome
    if came != "made":
        said = words.tell("{file}: reading it takes more than {seconds} s or {memory} GB")
        raise CannotBuild(said.format(file=path, seconds=seconds, memory=f"{memory / 1e9:g}"), hint)
    made: T = outcome
    return made


def limit(seconds: int, memory: int) -> None:
    """Let the system hold this process within limits, where it can."""
    with suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))
        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_FSIZE, (LARGEST, LARGEST))


def _answer(module: str, name: str, path: Path, languages: tuple[str, str], seconds: int, memory: int) -> tuple[str, object]:
    from tmm_sheets import words
    from tmm_sheets.errors import BadInput, CannotBuild

    words.set_reader(languages[0])
    words.set_paper(languages[1])
    work = getattr(import_module(module), name)
    limit(seconds, memory)
    try:
        return "made", work(path)
    except MemoryError:
        return "", None
    except Exception as e:
        return "raised", e if isinstance(e, BadInput | CannotBuild | OSError) else RuntimeError(f"{type(e).__name__}: {e}")


def _main() -> None:
    out = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # where libraries print
    # By its place: where this process may list no folder but the program's own, as behind the page, no path leads to it.
    package = Path(__file__).parent
    spec = spec_from_file_location("tmm_sheets", package / "__init__.py", submodule_search_locations=[str(package)])
    assert spec is not None
    assert spec.loader is not None
    sys.modules["tmm_sheets"] = module_from_spec(spec)
    spec.loader.exec_module(sys.modules["tmm_sheets"])
    with out:
        pickle.dump(_answer(*pickle.load(sys.stdin.buffer)), out, 5)


if __name__ == "__main__":
    _main()
