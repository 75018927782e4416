"""Pictures of docs/ (``make pictures``; needs pdftoppm): sheets of the gallery by the command above each, schemes of the tutorial
and of the kinds of groups.

``python -m tests.pictures [NAME ...]``: all, or the gallery's of these names; ``schemes``: all schemes.
"""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

from tests import docs
from tmm_sheets import catalogue
from tmm_sheets.__main__ import run
from tmm_sheets.task import new_file

GALLERY = docs.ROOT / "docs" / "gallery.md"
TUTORIAL = docs.ROOT / "docs" / "tutorial.md"
PICTURES = docs.ROOT / "docs" / "pictures"
SHOWN = re.compile(r"^    tmm-sheets (build .*)\n\n!\[.*\]\((pictures/(\w+)\.png)\)$", re.MULTILINE)
STEP = re.compile(r"^```toml\n(.*?)^```\n\n    tmm-sheets check my\.toml --scheme (\w+)\.svg$", re.MULTILINE | re.DOTALL)
WIDTH, GREYS = 640, 4
"""Pixels and greys of a sheet in the gallery: it is looked at, not read, and lies in the repository."""


def gallery(text: str) -> dict[str, list[str]]:
    """Commands of the gallery by the names of their pictures."""
    return {name: shlex.split(command) for command, _, name in SHOWN.findall(text)}


def steps(text: str) -> dict[str, str]:
    """The tutorial's file as it stands at each of its schemes, by their names."""
    found, whole = {}, ""
    for part, name in STEP.findall(text):
        whole += part + "\n"
        found[name] = whole
    return found


GROUPS = {"assur1": "1", "assur2": "2", "assur3": "3", "assur4": "1,4", "assur5": "5"}
"""Pictures of docs/assur.md, and the groups that ``new`` is asked for."""


def kinds() -> dict[str, str]:
    """Project files of the kinds of groups and of class III by the names of their pictures, at four positions: fewer lines."""
    found = {name: new_file.whole(name, name, new_file.of_groups([int(kind) for kind in groups.split(",")]), {})
             for name, groups in GROUPS.items()} | {"class3": catalogue.read("screen").text}
    return {name: re.sub(r"(?m)^positions = 12", "positions = 4", text) for name, text in found.items()}


def scheme(text: str, to: Path) -> None:
    """How a project file is understood."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "my.toml")
        file.write_text(text, encoding="utf-8")
        run(["check", str(file), "--scheme", str(to), "--lang", "ru"])


def small(whole: Path, to: Path) -> None:
    """A picture of few bytes."""
    from PIL import Image

    picture = Image.open(whole).convert("L")
    picture = picture.resize((WIDTH, WIDTH * picture.height // picture.width), Image.Resampling.LANCZOS)
    picture.quantize(GREYS).save(to, optimize=True)


def photographs(sheet: Path, folder: Path) -> None:
    """Three photographs of a sheet on a table that cannot be compared: cut off, shaded, blurred; small."""
    import cv2
    import numpy as np

    paper = cv2.resize(cv2.imread(str(sheet), cv2.IMREAD_GRAYSCALE), (420, 297), interpolation=cv2.INTER_AREA)
    desk = np.full((330, 460), 120, np.uint8)
    corners = np.float32([[0, 0], [420, 0], [420, 297], [0, 297]])
    seen = np.float32([[38, 22], [428, 14], [444, 312], [18, 318]])
    turn = cv2.getPerspectiveTransform(corners, seen)
    inside = cv2.warpPerspective(np.full(paper.shape, 255, np.uint8), turn, (460, 330)) > 0
    whole = np.where(inside, cv2.warpPerspective(paper, turn, (460, 330), flags=cv2.INTER_AREA), desk)
    across = np.hypot(*(np.indices(whole.shape) - np.array([250, 330])[:, None, None])) < 190
    shade = cv2.GaussianBlur(np.where(across, 0.25, 1.0), (31, 31), 0)
    for name, picture in (("cut", whole[70:, 90:]), ("shade", whole * shade), ("blur", cv2.GaussianBlur(whole, (0, 0), 4))):
        taken = cv2.resize(picture.astype(np.uint8), (260, 187), interpolation=cv2.INTER_AREA)
        cv2.imwrite(str(folder / f"photo_{name}.png"), taken)


def main(names: list[str]) -> None:
    """Draw the pictures."""
    schemes = names == ["schemes"]
    for name, command in () if schemes else gallery(GALLERY.read_text("utf-8")).items():
        if names and name not in names:
            continue
        with tempfile.TemporaryDirectory() as folder:
            run([*command, "--format", "pdf", "-o", folder])
            sheet, = Path(folder).glob("*.pdf")
            subprocess.run(["pdftoppm", "-r", "96", "-png", "-gray", "-singlefile", sheet, Path(folder, "whole")], check=True)
            small(Path(folder, "whole.png"), PICTURES / f"{name}.png")
    if not names:
        photographs(docs.ROOT / "templates" / "pictures" / "sheet1.png", PICTURES)
    if schemes or not names:
        for name, text in (steps(TUTORIAL.read_text("utf-8")) | kinds()).items():
            scheme(text, PICTURES / f"{name}.svg")


if __name__ == "__main__":
    main(sys.argv[1:])
