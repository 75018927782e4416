"""Drawings compared as pictures: photographs, scans and prints. Nothing of this is imported without OpenCV."""

from importlib.util import find_spec

from tmm_sheets import quoting
from tmm_sheets.errors import BadInput
from tmm_sheets.words import tell


def need_opencv() -> None:
    """Refuse to go on without OpenCV.

    Raises
    ------
    BadInput
        With the command that installs it.
    """
    if find_spec("cv2") is None:
        raise BadInput(tell("comparing a photograph needs OpenCV, which is not installed"), hint=quoting.install("compare"))


need_opencv()
