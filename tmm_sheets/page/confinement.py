"""A process that gets no other files than its own folder and the program's, and no network, where the system can see to that.

Linux can since 5.13 (Landlock, https://docs.kernel.org/userspace-api/landlock.html): what a process has given up it never gets
back, nor do its children. Elsewhere :func:`tmm_sheets.files.named` alone keeps the names that come from outside within the folder.
"""

from __future__ import annotations

import ctypes
import os
import struct
import sys
import tempfile
from contextlib import suppress
from pathlib import Path

from tmm_sheets import files, kept, resources

CREATE, ADD_RULE, RESTRICT = 444, 445, 446
"""Numbers of Landlock's calls, on all machines but Alpha."""
RIGHTS = {1: 13, 2: 14, 3: 15, 4: 15}
"""How many rights to files a version knows, 16 from the fifth on; the lowest bits stand for them."""
READ, OF_FILES = 0b1101, 0b1100_0000_0000_0111
"""Rights to execute, read files and list folders; those that a single file can have."""
NETWORK, OUTSIDE = 0b11, 0b11
"""TCP; sockets and signals that lead to processes outside."""
NO_NEW_PRIVILEGES = 38
SYSTEM = ("/lib", "/lib64", "/usr/lib", "/usr/lib64", "/usr/local/lib", "/usr/bin", "/usr/share", "/etc/ld.so.cache", "/etc/fonts",
          "/etc/localtime", "/dev/urandom")
"""What programs read wherever they run."""


def confine(folder: Path) -> None:
    """Stand in a folder that is this process's own, and get no other files from here on."""
    os.chdir(folder)
    files.confine(Path())
    tempfile.tempdir = str(Path().resolve())
    kernel = ctypes.CDLL(None, use_errno=True) if sys.platform == "linux" else None
    version = kernel.syscall(CREATE, None, 0, 1) if kernel is not None else -1
    if kernel is None or version < 1:
        return
    everything = (1 << RIGHTS.get(version, 16)) - 1
    told = struct.pack("QQQ", everything, NETWORK, OUTSIDE)[:8 * (1 + (version >= 4) + (version >= 6))]
    rules = kernel.syscall(CREATE, told, len(told), 0)
    packages = (place for place in sys.path if Path(place).name in ("site-packages", "dist-packages"))
    program = [resources.PACKAGE, resources.template(""), resources.variants(), sys.prefix, sys.base_prefix, *packages, *SYSTEM]
    shared = kept.folder()
    with suppress(OSError):
        if shared is not None:
            shared.mkdir(mode=0o700, parents=True, exist_ok=True)
    places = dict.fromkeys(map(str, program), READ) | dict.fromkeys(map(str, (os.devnull, ".", shared or ".")), everything)
    for place, rights in places.items():
        with suppress(OSError):
            end = os.open(place, os.O_PATH | os.O_CLOEXEC)
            own = rights if os.path.isdir(place) else rights & OF_FILES
            kernel.syscall(ADD_RULE, rules, 1, struct.pack("=Qi", own, end), 0)
            os.close(end)
    kernel.prctl(NO_NEW_PRIVILEGES, 1, 0, 0, 0)
    kernel.syscall(RESTRICT, rules, 0)
    os.close(rules)
