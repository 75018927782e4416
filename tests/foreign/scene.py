"""A picture of a student's sheet: what difficulty it has, how it is taken, and the truth about it."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from tests.foreign import desk as desks, drawing, mistakes, pencil
from tests.foreign.camera import Camera, Picture, document, expose
from tests.foreign.drawing import SIZE, Floats
from tests.foreign.paper import Paper, dog_ear

DIFFICULTIES = (
    "plain",
    "wood",
    "bricks",
    "gravel",
    "tiles",
    "dark",
    "pale",
    "notebook",
    "folds",
    "waves",
    "dogear",
    "thumbs",
    "beneath",
    "tape",
    "corner",
    "side",
    "turned",
    "exif",
    "gradient",
    "flash",
    "shadow",
    "noise",
    "oblique",
    "small",
    "document",
    "mixed",
    "cropped",
)
STEP = 10.0
"""Step of the truth's map, mm."""


@dataclass
class Scene:
    """One picture to be taken."""

    number: int
    difficulty: str
    seed: int
    traits: set[str] = field(default_factory=set)

    @property
    def random(self) -> np.random.Generator:
        return np.random.default_rng((self.seed, self.number))

    @property
    def sheet(self) -> tuple[str, int]:
        return drawing.SHEETS[(self.number + self.number // len(DIFFICULTIES)) % len(drawing.SHEETS)]


def scene(number: int, seed: int, only: tuple[str, ...] = ()) -> Scene:
    """The picture of this number: difficulties go round, `mixed` has two or three of them."""
    among = only or DIFFICULTIES
    difficulty = among[number % len(among)]
    made = Scene(number, difficulty, seed)
    random = np.random.default_rng((seed, number, 1))
    made.traits = (
        {difficulty}
        if difficulty != "mixed"
        else {
            str(random.choice(part))
            for part in (
                ("wood", "tiles", "notebook", "pale", "beneath", "bricks"),
                ("folds", "waves", "dogear", "thumbs", "tape"),
                ("gradient", "shadow", "oblique", "turned", "noise"),
            )
        }
    )
    return made


def _mix(picture: NDArray[Any], where: NDArray[Any], colour: Any) -> None:
    """Put a colour over the picture, softly where `where` is between 0 and 1."""
    weight = np.asarray(where, np.float32)[..., None]
    picture *= 1 - weight
    picture += weight * np.asarray(colour, np.float32)


def _edge(random: np.random.Generator) -> tuple[Floats, Floats]:
    """A place on the edge of the sheet and the direction inwards."""
    side, along = int(random.integers(4)), float(random.uniform(0.12, 0.88))
    place = ((along * SIZE[0], 0), (SIZE[0], along * SIZE[1]), (along * SIZE[0], SIZE[1]), (0, along * SIZE[1]))[side]
    inward = ((0, 1), (-1, 0), (0, -1), (1, 0))[side]
    return np.array(place, float), np.array(inward, float)


def _thumb(picture: Picture, table: Floats, random: np.random.Generator) -> None:
    """A thumb holds the sheet down at its edge."""
    place, inward = _edge(random)
    aside = random.normal(0, 0.25)
    way = np.array([inward[0] - aside * inward[1], inward[1] + aside * inward[0]])
    way /= np.hypot(*way)
    tip = place + way * random.uniform(8, 32)
    along = (table - tip) @ way
    across = (table - tip) @ np.array([-way[1], way[0]])
    half = random.uniform(9, 12)
    flesh = ((along < 0) & (np.abs(across) < half + 0.03 * -along)) & ~(
        (along > -half) & ((along + half) ** 2 + across**2 > half**2)
    )
    around = cv2.GaussianBlur(flesh.astype(np.float32), (0, 0), picture.shape[1] / 300)
    picture *= (1 - 0.35 * around)[..., None]
    round_off = 1 - 0.45 * np.clip(np.abs(across) / (half + 3), 0, 1) ** 3
    _mix(picture, flesh, np.array([0.50, 0.28, 0.20]) * round_off[..., None])
    nail = ((along + 9) / 7.5) ** 2 + (across / (half * 0.62)) ** 2 < 1
    _mix(picture, nail * 0.8, (0.62, 0.42, 0.36))


def _tape(picture: Picture, uv: Floats, random: np.random.Generator) -> None:
    """Strips of adhesive tape across the corners or over the edges."""
    for corner in ((0, 0), (1, 0), (1, 1), (0, 1)):
        if random.random() < 0.25:
            continue
        centre = np.array([6 if corner[0] == 0 else SIZE[0] - 6, 6 if corner[1] == 0 else SIZE[1] - 6], float)
        angle = np.pi / 4 * (1 if corner[0] != corner[1] else -1) + random.normal(0, 0.3)
        way = np.array([np.cos(angle), np.sin(angle)])
        apart = uv - centre
        there = (np.abs(apart @ way) < random.uniform(25, 45)) & (
            np.abs(apart @ np.array([-way[1], way[0]])) < random.uniform(8, 13)
        )
        _mix(picture, there * 0.45, (0.62, 0.56, 0.36) if random.random() < 0.6 else (0.75, 0.75, 0.75))


def _hide_side(picture: Picture, table: Floats, random: np.random.Generator) -> str:
    """A book, a ruler or a blank paper lies over one whole side of the frame."""
    side = int(random.integers(4))
    name = ("left", "right", "lower", "upper")[side]
    depth = (table[..., 0], SIZE[0] - table[..., 0], table[..., 1], SIZE[1] - table[..., 1])[side]
    along = table[..., 1] if side < 2 else table[..., 0]
    limit = (24 if side == 0 else 9) + random.uniform(0, 8)
    slope = random.normal(0, 0.004)
    there = (depth + slope * along < limit) & (depth > -160)
    shade = cv2.GaussianBlur(there.astype(np.float32), (0, 0), picture.shape[1] / 400)
    picture *= (1 - 0.3 * shade)[..., None]
    colour = ((0.70, 0.70, 0.68), (0.08, 0.10, 0.22), (0.55, 0.42, 0.22))[random.integers(3)]
    _mix(picture, there, colour)
    return name


def _light(shape: tuple[int, int], traits: set[str], random: np.random.Generator) -> Floats:
    """Light over the picture (h, w)."""
    y, x = np.mgrid[0 : shape[0], 0 : shape[1]].astype(np.float32)
    x, y = x / shape[1] - 0.5, y / shape[1] - shape[0] / shape[1] / 2
    strength = random.uniform(0.8, 1.5) if "gradient" in traits else random.uniform(0, 0.35)
    angle = random.uniform(0, 2 * np.pi)
    light = np.exp(strength * (x * np.cos(angle) + y * np.sin(angle)))
    light *= 1 - random.uniform(0.1, 0.5) * (x**2 + y**2)
    if "flash" in traits:
        centre = random.uniform(-0.25, 0.25, 2)
        away = (x - centre[0]) ** 2 + (y - centre[1]) ** 2
        light = light * (0.55 + 0.5 * np.exp(-away / 0.12)) + 1.2 * np.exp(-away / random.uniform(0.002, 0.006))
    if "shadow" in traits:
        corner = np.array([random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.1)])
        turn = random.normal(0, 0.3)
        across = (x - corner[0]) * np.cos(turn) + (y - corner[1]) * np.sin(turn)
        down = -(x - corner[0]) * np.sin(turn) + (y - corner[1]) * np.cos(turn)
        phone = ((np.abs(across) < 0.1) & (down > -0.05)).astype(np.float32)
        light *= 1 - random.uniform(0.45, 0.7) * cv2.GaussianBlur(phone, (0, 0), shape[1] * float(random.uniform(0.003, 0.02)))
    return np.asarray(light / np.percentile(light, 80), np.float32)


def _megapixels(traits: set[str], random: np.random.Generator, most: float) -> float:
    if "small" in traits:
        return float(random.uniform(2, 4))
    return min(float(random.choice((6, 8, 10, 12))), most)


def _texture(ink: pencil.Ink, density: float) -> pencil.Ink:
    """The drawing no finer than the picture can show, pixels a millimetre."""
    scale = min(1.0, density / pencil.DENSITY)
    return np.asarray(cv2.resize(ink, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA), np.float32)


def take(what: Scene, folder: Path, most: float = 12.0) -> tuple[NDArray[np.uint8], dict[str, Any]]:
    """The picture (BGR, rows downwards as in the file) and the truth about it; drawings are kept in `folder`."""
    random = what.random
    marks = drawing.read(*what.sheet, folder)
    drawn, wrong = mistakes.plant(marks, int(random.choice((0, 2, 3, 4))), random)
    return taken(what, marks, drawn, wrong, random, most)


def taken(
    what: Scene,
    marks: list[drawing.Mark],
    drawn: list[drawing.Mark],
    wrong: list[mistakes.Mistake],
    random: np.random.Generator,
    most: float = 12.0,
    *,
    ink: pencil.Ink | None = None,
    floor: desks.Grey | None = None,
    fill: tuple[float, float] = (0.8, 0.93),
) -> tuple[NDArray[np.uint8], dict[str, Any]]:
    """The picture of a drawing that ought to have `marks`, and the truth about it.

    `ink` is what lies on the paper if no pencil drew it, `floor` what the paper lies on, `fill` the least and the largest share
    of the picture that the sheet takes.
    """
    traits = what.traits
    project, sheet = what.sheet
    if ink is None:
        ink = pencil.draw(drawn, random)
    paper = Paper(random, **{trait: trait in traits for trait in ("waves", "folds", "rolled", "ridge", "ridges", "lump")})
    tilt = float(random.uniform(20, 32)) if "oblique" in traits else float(abs(random.normal(0, 7)) + 2)
    roll = float(random.choice((-1, 1)) * random.uniform(4, 8) if "corner" in traits else random.normal(0, 2.5))
    megapixels = _megapixels(traits, random, most)
    share = float(random.uniform(*fill))
    camera = Camera(random, megapixels, np.radians(tilt), share, np.radians(roll), wide="wide" in traits)
    if "corner" in traits:
        _move_corner_out(camera, random)
    picture = _seen(what, marks, ink, paper, camera, random, floor)
    told: dict[str, Any] = {}
    if "side" in traits:
        table = _on_grid(camera, camera.on_table)
        told["hidden"] = _hide_side(picture, table, random)
    picture *= _light((camera.height, camera.width), traits, random)[..., None]
    grain = float(random.uniform(0.03, 0.06)) if "noise" in traits else float(random.uniform(0.004, 0.015))
    file = expose(picture, random, grain=grain, blur=float(random.uniform(0.5, 0.9)))
    u, v = np.meshgrid(np.arange(0, SIZE[0] + STEP, STEP), np.arange(0, SIZE[1] + STEP, STEP))
    grid = np.stack((u, v), axis=-1)
    pixels = camera.project(paper.place(grid))
    if traits & {"document", "cropped"}:
        corners = camera.project(paper.place(np.array([(0, 0), (SIZE[0], 0), SIZE, (0, SIZE[1])], float)))
        file, turn = document(file, corners, random, 0.004 if "cropped" in traits else 0.0015)
        lifted = np.concatenate((pixels, np.ones((*pixels.shape[:2], 1))), axis=-1) @ turn.T
        pixels = lifted[..., :2] / lifted[..., 2:]
    quarter = int(random.integers(1, 4)) if traits & {"turned", "exif"} else 0
    for _ in range(quarter):  # np.rot90 counter-clockwise: what was right goes up
        pixels = np.stack((pixels[..., 1], file.shape[1] - 1 - pixels[..., 0]), axis=-1)
        file = np.ascontiguousarray(np.rot90(file))
    truth = {
        "number": what.number,
        "seed": what.seed,
        "difficulty": what.difficulty,
        "traits": sorted(traits),
        "project": project,
        "sheet": sheet,
        "megapixels": round(file.shape[0] * file.shape[1] / 1e6, 2),
        "tilt_deg": round(tilt, 1),
        **told,
        "exif": {0: 1, 1: 6, 2: 3, 3: 8}[quarter] if "exif" in traits else 1,
        "map": {"step": STEP, "shape": list(pixels.shape[:2]), "pixels": pixels.round(3).tolist()},
        "mistakes": [
            {
                "kind": mistake.kind,
                "place": [round(c, 1) for c in mistake.place],
                "size": round(mistake.size, 2),
                "wrong": [
                    {
                        "id": mark.id,
                        "view": mark.view,
                        "step": mark.step,
                        "position": mark.position,
                        "name": mark.name,
                        "kind": mark.kind,
                    }
                    for mark in mistake.wrong
                ],
                "lines": [line.round(2).tolist() for line in mistake.lines],
            }
            for mistake in wrong
        ],
    }
    return file, truth


def _move_corner_out(camera: Camera, random: np.random.Generator) -> None:
    """The corner that reaches furthest to one side goes out of the picture, with the frame's, and it alone."""
    seen = camera.project(np.array([(0, 0, 0), (SIZE[0], 0, 0), (*SIZE, 0), (0, SIZE[1], 0)], float))[:, 0]
    out = random.uniform(0.018, 0.035) * camera.width
    camera.middle[0] += camera.width + out - seen.max() if random.random() < 0.5 else -out - seen.min()


def _on_grid(camera: Camera, what: Any) -> Floats:
    """Something for every pixel (h, w, 2), worked out for every eighth and interpolated."""
    x = np.append(np.arange(0, camera.width - 1, 8), camera.width - 1)
    y = np.append(np.arange(0, camera.height - 1, 8), camera.height - 1)
    coarse = what(np.stack(np.meshgrid(x, y), axis=-1).astype(float))
    columns = np.interp(np.arange(camera.width), x, np.arange(len(x)))
    rows = np.interp(np.arange(camera.height), y, np.arange(len(y)))
    return _bilinear(coarse, rows, columns)


def _bilinear(table: Floats, rows: Floats, columns: Floats) -> Floats:
    j = rows.astype(int).clip(0, table.shape[0] - 2)
    i = columns.astype(int).clip(0, table.shape[1] - 2)
    table = table.astype(np.float32)
    b = (rows - j)[:, None, None].astype(np.float32)
    a = (columns - i)[None, :, None].astype(np.float32)
    upper = table[j] * (1 - b) + table[j + 1] * b
    return np.asarray(upper[:, i] * (1 - a) + upper[:, i + 1] * a, np.float32)


def _seen(
    what: Scene,
    marks: list[drawing.Mark],
    ink: pencil.Ink,
    paper: Paper,
    camera: Camera,
    random: np.random.Generator,
    floor: desks.Grey | None = None,
) -> Picture:
    """The scene in even light, linear RGB."""
    traits = what.traits
    uv = _on_grid(camera, lambda pixels: camera.on_paper(pixels, paper))
    table = _on_grid(camera, camera.on_table)
    if floor is None:
        usual = str(random.choice(("plain", "wood", "dark", "plain")))
        floor = desks.DESKS[next((trait for trait in sorted(traits) if trait in desks.DESKS), usual)](random)
    turn = float(random.uniform(-0.15, 0.15)) if random.random() < 0.7 else float(random.uniform(0, np.pi))
    if "beneath" in traits:
        other = pencil.draw([mark for mark in marks if mark.role in ("frame", "text", "vector", "table", "link")], random)
        floor = desks.lay_beneath(floor, _texture(other, 2.5), random)
        turn = 0.0
    picture = desks.look(floor, table, turn)
    density = float(np.hypot(*np.diff(camera.project(np.array([[0, 300, 0], [841, 300, 0]], float)), axis=0)[0]) / SIZE[0])
    on_it = (uv[..., 0] > 0) & (uv[..., 0] < SIZE[0]) & (uv[..., 1] > 0) & (uv[..., 1] < SIZE[1])
    ears = []
    if "dogear" in traits:
        for _ in range(int(random.integers(1, 3))):
            ears.append(dog_ear(uv, (int(random.integers(2)), int(random.integers(2))), float(random.uniform(14, 75))))
    for gone, _ in ears:
        on_it &= ~gone
    shadow = cv2.GaussianBlur(on_it.astype(np.float32), (0, 0), max(1.0, 2.5 * density))
    picture *= (1 - 0.45 * shadow * ~on_it)[..., None]
    fine = _texture(ink, density * 1.25)
    scale = fine.shape[1] / SIZE[0]
    lines = cv2.remap(
        fine,
        (uv[..., 0] * scale - 0.5).astype(np.float32),
        ((SIZE[1] - uv[..., 1]) * scale - 0.5).astype(np.float32),
        cv2.INTER_LINEAR,
    )
    white = np.array([0.72, 0.715, 0.69]) * random.uniform(0.93, 1.02) * (1, 1, random.uniform(0.88, 1.0))
    colour = np.array([0.07, 0.07, 0.08])
    sheet = white * (1 - lines[..., None]) + colour * lines[..., None]
    sheet *= (1 + 0.012 * pencil.noise(lines.shape, max(2.0, 2 * density), random))[..., None]
    lamp = np.array([random.normal(0, 0.8), random.normal(0, 0.8), 1.0])
    sheet *= (paper.shade(uv, lamp) * (1 - 0.18 * paper.worn(uv, 1 / density)))[..., None]
    for _, back in ears:
        _mix(sheet, back, white * 0.9)
        edge = cv2.morphologyEx(back.astype(np.uint8), cv2.MORPH_GRADIENT, np.ones((3, 3), np.uint8)).astype(bool)
        sheet[edge] *= 0.75
    _mix(picture, cv2.GaussianBlur(on_it.astype(np.float32), (0, 0), 0.6), np.zeros(3))
    picture += sheet.astype(np.float32) * cv2.GaussianBlur(on_it.astype(np.float32), (0, 0), 0.6)[..., None]
    if "tape" in traits:
        _tape(picture, uv, random)
    for _ in range(int(random.integers(1, 5)) if "thumbs" in traits else 0):
        _thumb(picture, table, random)
    return picture


def save(picture: NDArray[np.uint8], truth: dict[str, Any], place: Path, quality: int | None = None) -> Path:
    """Write NAME.jpg and NAME.json; the file of the picture."""
    from PIL import Image

    if quality is None:
        quality = int(np.random.default_rng((truth["seed"], truth["number"], 2)).integers(70, 95))
    name = f"{truth['number']:03d}_{truth['difficulty']}"
    place.mkdir(parents=True, exist_ok=True)
    image = Image.fromarray(cv2.cvtColor(picture, cv2.COLOR_BGR2RGB))
    exif = Image.Exif()
    exif[0x0112] = truth["exif"]
    file = place / f"{name}.jpg"
    image.save(file, quality=quality, exif=exif)
    (place / f"{name}.json").write_text(json.dumps(truth, ensure_ascii=False), encoding="utf-8")
    return file
