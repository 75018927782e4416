"""Pictures that are not what they ought to be: another drawing, a mirrored one, a half-finished one, a screen, a storm.

    python -m tests.foreign.odd --seed 1 -o DIR [--only monitor,mirrored] [--rounds 2] [--keep]

None may be judged by a wrong fit, none may end in an internal error; each is refused or fitted rightly. What was refused is printed
with the reason that the user is told. Pictures of :data:`NEVER` must be refused, for there is nothing to be judged.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from tests.foreign import desk as desks, drawing, judge, mistakes, pencil, scene
from tests.foreign.drawing import SIZE, Mark

Image = NDArray[np.uint8]
Taken = tuple[Image, dict[str, Any]]

OTHERS = {
    "lugansk/shaper": "lugansk/engine",
    "lugansk/engine": "lugansk/shaper",
    "press": "sixbar/3:1",
    "sixbar/3:2": "sixbar/3:1",
    "sixbar/5:1": "sixbar/5:2",
    "transport/diesel@01-Т-27": "transport/diesel@07-ЭПС-718",
}
"""Another project, of the same kind where there is one, whose sheets of the same number look like those of a project."""
NEVER = ("blank", "frame only", "mirrored", "other sheet")
FRAME = ((20.0, 5.0), (SIZE[0] - 5, SIZE[1] - 5))
"""Corners of the frame, mm."""
POSE = {"waves", "oblique", "folds", "side", "corner", "dogear"}
WEATHER = {"gradient", "shadow", "noise", "flash", "beneath", "notebook", "wood", "bricks", "pale", "thumbs"}


class Shot:
    """What a kind of picture is made from."""

    def __init__(self, kind: str, number: int, seed: int, folder: Path) -> None:
        self.what = scene.Scene(number, kind.replace(" ", "_"), seed)
        self.folder = folder
        self.random = self.what.random
        self.marks = drawing.read(*self.what.sheet, folder)

    def take(self, drawn: list[Mark] | None = None, *traits: str, **more: Any) -> Taken:
        """The picture of what was drawn; of the sheet as it ought to be, if nothing else."""
        self.what.traits = set(traits)
        wrong: list[mistakes.Mistake] = []
        return scene.taken(self.what, self.marks, self.marks if drawn is None else drawn, wrong, self.random, **more)


def _pixels(truth: dict[str, Any]) -> NDArray[np.float64]:
    return np.array(truth["map"]["pixels"])


def _with(truth: dict[str, Any], pixels: NDArray[np.float64]) -> dict[str, Any]:
    return truth | {"map": truth["map"] | {"pixels": pixels.round(3).tolist()}}


def two_sheets(shot: Shot) -> Taken:
    """Another sheet lies beside this one on the table; part of it is in the picture."""
    floor = desks.DESKS[str(shot.random.choice(("plain", "wood", "dark")))](shot.random)
    project, sheet = shot.what.sheet
    other = drawing.read(*next(s for s in drawing.SHEETS if s[0] != project or s[1] != sheet), shot.folder)
    away = float(shot.random.choice((-1, 1))) * (SIZE[1] + float(shot.random.uniform(-12, 25)))
    floor = desks.lay(floor, scene._texture(pencil.draw(other, shot.random), 2.5), float(shot.random.normal(0, 1.5)), (0, away))
    return shot.take(floor=floor, fill=(0.5, 0.75))


def other_sheet(shot: Shot) -> Taken:
    """The same sheet of another project."""
    project, sheet = shot.what.sheet
    return shot.take(drawing.read(OTHERS[project], sheet, shot.folder))


def blank(shot: Shot) -> Taken:
    """Paper on which nothing was drawn yet."""
    return shot.take([])


def frame_only(shot: Shot) -> Taken:
    """Frame and title block, as they are drawn first."""
    return shot.take([mark for mark in shot.marks if mark.role == "frame"])


def _view(shot: Shot, share: float) -> tuple[list[Mark], list[Mark]]:
    """Marks of about a share of the views, and all others."""
    views = sorted({mark.view for mark in shot.marks if mark.role != "frame"})
    some = set(shot.random.choice(views, max(1, round(share * len(views))), replace=False).tolist())
    chosen = [mark for mark in shot.marks if mark.view in some and mark.role != "frame"]
    ids = {mark.id for mark in chosen}
    return chosen, [mark for mark in shot.marks if mark.id not in ids]


def half_done(shot: Shot) -> Taken:
    """Some views are not drawn yet."""
    return shot.take(_view(shot, float(shot.random.uniform(0.3, 0.7)))[1])


def erased(shot: Shot) -> Taken:
    """Some views were rubbed out, not quite."""
    gone, rest = _view(shot, float(shot.random.uniform(0.2, 0.5)))
    ink = pencil.draw(rest, shot.random)
    return shot.take(ink=np.maximum(ink, 0.18 * pencil.draw(gone, shot.random)).astype(np.float32))


def shifted_view(shot: Shot) -> Taken:
    """Some views stand a few millimetres elsewhere."""
    moved, rest = _view(shot, float(shot.random.uniform(0.2, 0.6)))
    by = shot.random.uniform(2, 9) * np.exp(1j * shot.random.uniform(0, 2 * np.pi))
    return shot.take([*rest, *(mark.moved(np.array([by.real, by.imag])) for mark in moved)])


def frame_off(shot: Shot) -> Taken:
    """A side of the frame was drawn a few millimetres beside its place, whatever it holds in its place."""
    side, by = int(shot.random.integers(4)), float(shot.random.choice((-1, 1)) * shot.random.uniform(2.5, 8))
    axis, at = side % 2, (FRAME[side // 2])[side % 2]

    def moved(mark: Mark) -> Mark:
        if mark.role != "frame" or mark.kind == "text" or np.ptp(mark.points, axis=0).max() < 400:
            return mark
        points = mark.points.copy()
        points[np.abs(points[:, axis] - at) < 0.1, axis] += by
        return replace(mark, points=points)

    return shot.take([moved(mark) for mark in shot.marks])


def upside_down(shot: Shot) -> Taken:
    """The sheet lies upside down."""
    picture, truth = shot.take()
    pixels = np.array([picture.shape[1] - 1, picture.shape[0] - 1]) - _pixels(truth)
    return np.ascontiguousarray(picture[::-1, ::-1]), _with(truth, pixels)


def mirrored(shot: Shot) -> Taken:
    """Taken with the camera that faces the user, which mirrors."""
    picture, truth = shot.take()
    pixels = _pixels(truth)
    pixels[..., 0] = picture.shape[1] - 1 - pixels[..., 0]
    return np.ascontiguousarray(picture[:, ::-1]), _with(truth, pixels)


def lamp(shot: Shot) -> Taken:
    """A tube lamp is mirrored by the graphite and the paper: a stripe of glare right across."""
    picture, truth = shot.take()
    h, w = picture.shape[:2]
    y, x = np.mgrid[0:h, 0:w].astype(np.float32) / w
    turn = shot.random.uniform(0, np.pi)
    across = (x - 0.5) * np.cos(turn) + (y - h / w / 2) * np.sin(turn) - shot.random.uniform(-0.2, 0.2)
    stripe = np.exp(-((across / shot.random.uniform(0.015, 0.05)) ** 2)) * shot.random.uniform(0.7, 1.6)
    return (255 - (255 - picture) * np.exp(-2 * stripe)[..., None]).astype(np.uint8), truth


def millimetre_paper(shot: Shot) -> Taken:
    """The desk is covered with millimetre paper."""
    _, _, floor = desks._blank()
    x, y = np.arange(floor.shape[1]) / desks.DENSITY, np.arange(floor.shape[0]) / desks.DENSITY
    for every, wide, dark in ((5, 0.5, 0.8), (10, 0.5, 0.7), (50, 1.0, 0.5)):
        floor[(y % every) < wide] *= dark
        floor[:, (x % every) < wide] *= dark
    return shot.take(floor=desks._coloured(floor, (0.68, 0.55, 0.45)))


def _page(shot: Shot) -> pencil.Ink:
    """The drawing as a printer or a screen shows it, no hand in it."""
    hand = pencil.Hand(shot.random)
    hand.waver = hand.slip = 0.0
    hand.width = hand.darkness = 1.0
    for mark in shot.marks:
        hand.draw(mark, 1.0)
    return np.asarray(hand.page, np.float32) / np.float32(255)


def printed(shot: Shot) -> Taken:
    """Printed on A3 with the printer's margins: smaller than the paper, the frame far from its edge."""
    scale = float(shot.random.uniform(0.9, 0.97))
    page = _page(shot)
    h, w = page.shape
    turn = np.array([[scale, 0, (1 - scale) * w / 2], [0, scale, (1 - scale) * h / 2]])
    picture, truth = shot.take(ink=cv2.warpAffine(page, turn, (w, h), flags=cv2.INTER_AREA))
    # the truth about the sheet is that about a smaller part of the paper
    pixels = _pixels(truth).astype(np.float32)
    rows, columns = np.mgrid[0 : pixels.shape[0], 0 : pixels.shape[1]].astype(np.float32)
    middle = np.array(SIZE) / 2 / scene.STEP
    j, i = (rows - middle[1]) * scale + middle[1], (columns - middle[0]) * scale + middle[0]
    return picture, _with(truth, cv2.remap(pixels, i.astype(np.float32), j.astype(np.float32), cv2.INTER_LINEAR).astype(float))


def monitor(shot: Shot) -> Taken:
    """The PDF on a screen: a grid of pixels under the camera's, moire."""
    ink = _page(shot)
    pixel = float(shot.random.uniform(0.30, 0.45)) * pencil.DENSITY  # as large as a pixel of the screen is on the drawing
    small = cv2.resize(ink, None, fx=1 / pixel, fy=1 / pixel, interpolation=cv2.INTER_AREA)
    shown = cv2.resize(small, (ink.shape[1], ink.shape[0]), interpolation=cv2.INTER_NEAREST)
    gap = ((np.arange(ink.shape[1]) % pixel) < 0.25 * pixel)[None, :] | ((np.arange(ink.shape[0]) % pixel) < 0.25 * pixel)[:, None]
    return shot.take(ink=np.where(gap, 0.35 + 0.65 * shown, shown).astype(np.float32), floor=desks.dark(shot.random))


def strong_jpeg(shot: Shot) -> Taken:
    """Sent by a messenger."""
    picture, truth = shot.take()
    done, data = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, 30])
    assert done
    return np.asarray(cv2.imdecode(data, cv2.IMREAD_COLOR), np.uint8), truth


def scanner_app(shot: Shot) -> Taken:
    """Cut out by an app that took the frame for the paper's edge: the picture ends at the frame's line."""
    picture, truth = shot.take()
    pixels, step = _pixels(truth), scene.STEP
    off = float(shot.random.uniform(-1.2, 1.2))
    (x0, y0), (x1, y1) = (FRAME[0][0] - off, FRAME[0][1] - off), (FRAME[1][0] + off, FRAME[1][1] + off)
    grid = pixels.astype(np.float32)
    found = [cv2.remap(grid, np.float32([[x / step]]), np.float32([[y / step]]), cv2.INTER_LINEAR)[0, 0]
             for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]  # fmt: skip
    width = int(np.hypot(*(found[1] - found[0])))
    height = int(width * (y1 - y0) / (x1 - x0))
    target = np.array([(0, height), (width, height), (width, 0), (0, 0)], np.float32)
    turn = cv2.getPerspectiveTransform(np.array(found, np.float32), target)
    flat = cv2.warpPerspective(picture, turn, (width, height), flags=cv2.INTER_AREA)
    lifted = np.concatenate((pixels, np.ones((*pixels.shape[:2], 1))), axis=-1) @ turn.T
    return np.asarray(flat, np.uint8), _with(truth, lifted[..., :2] / lifted[..., 2:])


def rolled(shot: Shot) -> Taken:
    """The sheet came out of a tube: two opposite edges stand up."""
    return shot.take(None, "rolled")


def pencil_beneath(shot: Shot) -> Taken:
    """A pencil lies under the sheet."""
    return shot.take(None, "ridge")


def two_pencils(shot: Shot) -> Taken:
    """Two pencils lie under the sheet."""
    return shot.take(None, "ridges")


def eraser_beneath(shot: Shot) -> Taken:
    """An eraser lies under the sheet."""
    return shot.take(None, "lump")


def wide_angle(shot: Shot) -> Taken:
    """The telephone's other lens, its bend not taken back."""
    return shot.take(None, "wide")


def panorama(shot: Shot) -> Taken:
    """Put together from two pictures by the telephone: what is right of a seam lies some millimetres elsewhere."""
    picture, truth = shot.take()
    pixels = _pixels(truth)
    density = float(np.hypot(*(pixels[30, 80] - pixels[30, 4]))) / 760
    by = density * float(shot.random.uniform(1, 4)) * np.exp(1j * shot.random.uniform(0, 2 * np.pi))
    h, w = picture.shape[:2]
    seam = shot.random.uniform(0.25, 0.75) * w
    y, x = np.mgrid[0:h, 0:w].astype(np.float32)
    step = np.clip((x - seam) / (3 * density) + 0.5, 0, 1)
    where = ((x - step * by.real).astype(np.float32), (y - step * by.imag).astype(np.float32))
    lifted = cv2.remap(picture, *where, cv2.INTER_LINEAR)
    there = np.clip((pixels[..., 0] - seam) / (3 * density) + 0.5, 0, 1)
    return np.asarray(lifted, np.uint8), _with(truth, pixels + there[..., None] * np.array([by.real, by.imag]))


def storm(shot: Shot) -> Taken:
    """Several difficulties at once."""
    traits = [*shot.random.choice(sorted(POSE), 2, replace=False), *shot.random.choice(sorted(WEATHER), 2, replace=False)]
    return shot.take(None, *map(str, traits))


KINDS: dict[str, Callable[[Shot], Taken]] = {
    kind.__name__.replace("_", " "): kind
    for kind in (
        two_sheets,
        other_sheet,
        blank,
        frame_only,
        half_done,
        erased,
        shifted_view,
        frame_off,
        upside_down,
        mirrored,
        lamp,
        millimetre_paper,
        printed,
        monitor,
        strong_jpeg,
        scanner_app,
        rolled,
        pencil_beneath,
        wide_angle,
        panorama,
        storm,
        two_pencils,
        eraser_beneath,
    )
}


def odd(kind: str, number: int, seed: int, folder: Path) -> Path:
    """Take a picture of a kind; its file."""
    picture, truth = KINDS[kind](Shot(kind, number, seed, folder / "drawings"))
    return scene.save(picture, truth, folder / "pictures")


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(prog="python -m tests.foreign.odd", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)  # fmt: skip
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rounds", type=int, default=1, help="pictures of each kind")
    parser.add_argument("--only", default="", help="kinds, separated by commas: " + ", ".join(KINDS))
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--keep", action="store_true", help="keep reports")
    asked = parser.parse_args()
    only = [part for part in asked.only.split(",") if part] or list(KINDS)
    bad = 0
    for number in range(asked.rounds * len(KINDS)):
        kind = list(KINDS)[number % len(KINDS)]
        if kind not in only:
            continue
        file = asked.output / "pictures" / f"{number:03d}_{kind.replace(' ', '_')}.jpg"
        if not file.with_suffix(".json").exists():
            file = odd(kind, number, asked.seed, asked.output)
        row = judge.judge(file, asked.output / "drawings", asked.output / "reports" if asked.keep else None)
        wrong = row.state in ("wrong fit", "broken") or (row.state == "judged" and kind in NEVER)
        bad += wrong
        print(f"{number:3} {kind:<17}{row.project} {row.sheet}: {row.state}{' (BAD)' if wrong else ''} {row.seconds} s, "
              f"worst {row.worst}, matched {row.matched}, red {row.false_red} of {row.sound}", flush=True)  # fmt: skip
        if row.reason:
            print(f"      {row.reason}", flush=True)
    print(f"bad: {bad}")


if __name__ == "__main__":
    main()
