"""The user's folder of configuration: settings and families of tasks for all projects."""

from __future__ import annotations

import os
from pathlib import Path

from tmm_sheets import files

FOLDER = "TMM_SHEETS_CONFIG"
"""Environment variable that names it; empty for none."""


def folder() -> Path | None:
    """Where it is, or would be; None where the user has none, or data of strangers are worked on."""
    if files.confined():
        return None
    told = os.environ.get(FOLDER)
    if told is not None:
        return Path(told) if told else None
    from platformdirs import user_config_dir

    found = Path(user_config_dir("tmm-sheets", appauthor=False))
    return found if found.is_absolute() else None  # nobody's home
