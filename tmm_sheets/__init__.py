"""Course-project sheets of the theory of mechanisms and machines, drawn by compass-and-ruler constructions.

``tmm_sheets.open("lugansk/shaper")`` is the way in from Python, see docs/python.md; nothing is loaded before it is asked for.
"""

from typing import TYPE_CHECKING, Any

from tmm_sheets.version import __version__

if TYPE_CHECKING:
    from tmm_sheets.api import Opened, new, open, projects
    from tmm_sheets.errors import BadInput, CannotBuild

__all__ = ["BadInput", "CannotBuild", "Opened", "__version__", "new", "open", "projects"]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module 'tmm_sheets' has no attribute {name!r}")
    from tmm_sheets import api

    return getattr(api, name)


def __dir__() -> list[str]:
    return __all__
