"""What the sheet lies on: wood with its grain, bricks, gravel, tiles, a dark or a pale table, a squared notebook, other sheets."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from tests.foreign.drawing import SIZE, Floats
from tests.foreign.pencil import noise

DENSITY = 2.0
EXTENT = (2000.0, 1700.0)
Grey = NDArray[np.float32]


def _blank() -> tuple[Floats, Floats, Grey]:
    shape = (round(EXTENT[1] * DENSITY), round(EXTENT[0] * DENSITY))
    x = np.arange(shape[1]) / DENSITY
    y = np.arange(shape[0]) / DENSITY
    return x, y, np.ones(shape, np.float32)


def _coloured(grey: Grey, colour: tuple[float, float, float]) -> Grey:
    return np.asarray(grey[..., None] * np.array(colour, np.float32), np.float32)


def _streaks(shape: tuple[int, int], long: float, thin: float, random: np.random.Generator) -> Grey:
    """Noise drawn out along x."""
    small = random.standard_normal((int(shape[0] / thin) + 2, int(shape[1] / long) + 2)).astype(np.float32)
    return np.asarray(cv2.resize(small, (shape[1], shape[0]), interpolation=cv2.INTER_CUBIC), np.float32)


def wood(random: np.random.Generator) -> Grey:
    """Boards with grain that runs in long thin dark lines."""
    _, y, grey = _blank()
    board = float(random.uniform(90, 220))
    number = (y / board).astype(int)
    tone = random.uniform(0.75, 1.1, number.max() + 1)[number]
    bend = noise((grey.shape[0], grey.shape[1]), 500, random) * 12
    rows = (np.arange(grey.shape[0], dtype=np.float32)[:, None] + bend).astype(np.float32)
    columns = np.broadcast_to(np.arange(grey.shape[1], dtype=np.float32), grey.shape).astype(np.float32)
    grain = cv2.remap(_streaks(grey.shape, 900, 5, random), columns, rows, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REFLECT)
    fine = cv2.remap(_streaks(grey.shape, 300, 2, random), columns, rows, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REFLECT)
    grey = grey * tone[:, None] * (1 + 0.08 * fine) - 0.45 * np.clip(grain - 1.0, 0, 0.7)
    gap = (y % board) < random.uniform(0.8, 2.5)
    grey[gap] *= 0.25
    colour = ((0.40, 0.24, 0.12), (0.55, 0.38, 0.22), (0.22, 0.12, 0.07), (0.62, 0.50, 0.36))[random.integers(4)]
    return _coloured(np.clip(grey, 0.05, 1.4).astype(np.float32), colour)


def bricks(random: np.random.Generator) -> Grey:
    """Courses of bricks with light joints."""
    x, y, grey = _blank()
    row = (y / 75).astype(int)
    along = x[None, :] + 130 * (row % 2)[:, None]
    joint = ((y % 75) < 9)[:, None] | ((along % 260) < 9)
    tone = random.uniform(0.6, 1.2, (row.max() + 1, 12))[row[:, None], (along / 260).astype(int)]
    grey = (tone * (1 + 0.12 * noise(grey.shape, 4, random))).astype(np.float32)
    colour = _coloured(grey, (0.34, 0.14, 0.09))
    colour[joint] = (0.42, 0.40, 0.37)
    return colour


def gravel(random: np.random.Generator) -> Grey:
    """Stones of a centimetre, sharp edged."""
    _, _, grey = _blank()
    stones = noise(grey.shape, 14, random) + 0.6 * noise(grey.shape, 7, random)
    grey = 0.55 + 0.35 * np.tanh(2.5 * stones) + 0.06 * noise(grey.shape, 2, random)
    return _coloured(np.clip(grey, 0.05, 1.2).astype(np.float32), (0.42, 0.40, 0.37))


def tiles(random: np.random.Generator) -> Grey:
    """Light tiles, straight dark joints at right angles: much like a frame."""
    x, y, grey = _blank()
    side = float(random.choice((150, 200, 300, 450)))
    grey = (1 + 0.03 * noise(grey.shape, 40, random)).astype(np.float32)
    joint = float(random.uniform(1.5, 4))
    grey[((y % side) < joint)[:, None] | ((x % side) < joint)[None, :]] = 0.35
    return _coloured(grey, (0.55, 0.54, 0.50))


def notebook(random: np.random.Generator) -> Grey:
    """Squared or ruled paper, as white as the sheet."""
    x, y, grey = _blank()
    colour = _coloured((1 + 0.01 * noise(grey.shape, 30, random)).astype(np.float32), (0.66, 0.66, 0.64))
    ruled = ((y % (8 if random.random() < 0.5 else 5)) < 0.5)[:, None] | np.zeros(grey.shape, bool)
    if random.random() < 0.6:
        ruled = ruled | ((x % 5) < 0.5)[None, :]
    colour[ruled] *= np.array([0.62, 0.72, 0.9], np.float32)
    return colour


def dark(random: np.random.Generator) -> Grey:
    """A dark table top with a dull shine."""
    _, _, grey = _blank()
    return _coloured(
        (1 + 0.25 * noise(grey.shape, 300, random) + 0.05 * noise(grey.shape, 2, random)).clip(0.1, 2).astype(np.float32),
        (0.05, 0.05, 0.055),
    )


def pale(random: np.random.Generator) -> Grey:
    """A table as light as the paper."""
    _, _, grey = _blank()
    return _coloured(
        (1 + 0.02 * noise(grey.shape, 200, random) + 0.01 * noise(grey.shape, 2, random)).astype(np.float32),
        (0.69, 0.68, 0.66) if random.random() < 0.7 else (0.60, 0.59, 0.57),
    )


def plain(random: np.random.Generator) -> Grey:
    """A grey or brown table without any pattern."""
    _, _, grey = _blank()
    colour = ((0.25, 0.24, 0.23), (0.33, 0.22, 0.13), (0.18, 0.22, 0.25))[random.integers(3)]
    return _coloured((1 + 0.05 * noise(grey.shape, 150, random) + 0.03 * noise(grey.shape, 2, random)).astype(np.float32), colour)


DESKS = {
    "wood": wood,
    "bricks": bricks,
    "gravel": gravel,
    "tiles": tiles,
    "notebook": notebook,
    "dark": dark,
    "pale": pale,
    "plain": plain,
}


def lay_beneath(desk: Grey, ink: Grey, random: np.random.Generator) -> Grey:
    """Another drawing sheet, `ink` as drawn, on the desk under where the sheet will lie: edges and frame look out on some sides."""
    angle = np.radians(random.choice((-1, 1)) * random.uniform(0.3, 7))
    by = random.choice((-1, 1)) * random.uniform(8, 60), random.choice((-1, 1)) * random.uniform(8, 60)
    return lay(desk, ink, float(np.degrees(angle)), by)


def lay(desk: Grey, ink: Grey, turn: float, by: tuple[float, float]) -> Grey:
    """A drawing sheet, `ink` as drawn, on the desk, turned by `turn` degrees, (dx, dy) mm from where the sheet will lie."""
    angle = np.radians(turn)
    c, s = np.cos(angle), np.sin(angle)
    scale = ink.shape[1] / SIZE[0]
    middle = np.array(SIZE) / 2
    shift = np.array(by) + middle - np.array([[c, -s], [s, c]]) @ middle
    # ink pixel -> sheet mm -> table mm -> desk pixel; rows of ink go downwards, those of the desk upwards
    to_sheet = np.array([[1 / scale, 0, 0], [0, -1 / scale, SIZE[1]], [0, 0, 1]])
    to_table = np.array([[c, -s, shift[0]], [s, c, shift[1]], [0, 0, 1]])
    offset = (np.array(EXTENT) - SIZE) / 2
    to_desk = np.array([[DENSITY, 0, offset[0] * DENSITY], [0, DENSITY, offset[1] * DENSITY], [0, 0, 1]])
    whole = (to_desk @ to_table @ to_sheet)[:2]
    size = (desk.shape[1], desk.shape[0])
    small = cv2.GaussianBlur(ink, (0, 0), 0.4 * scale / DENSITY)
    there = cv2.warpAffine(np.ones_like(ink), whole, size, flags=cv2.INTER_LINEAR)[..., None]
    lines = cv2.warpAffine(small, whole, size, flags=cv2.INTER_LINEAR)[..., None]
    shade = cv2.GaussianBlur(there, (0, 0), 6)[..., None]
    return np.asarray(
        desk * (1 - there) * (1 - 0.3 * shade) + there * (0.68 * (1 - 0.8 * lines)) * np.array([1, 0.99, 0.96], np.float32),
        np.float32,
    )


def look(desk: Grey, table: Floats, turn: float) -> Grey:
    """Colours (h, w, 3) of the desk at points (h, w, 2) of the table, mm; its pattern is turned by `turn` rad."""
    c, s = np.cos(turn), np.sin(turn)
    away = table - np.array(SIZE) / 2
    x = (away[..., 0] * c - away[..., 1] * s + EXTENT[0] / 2) * DENSITY
    y = (away[..., 0] * s + away[..., 1] * c + EXTENT[1] / 2) * DENSITY
    return np.asarray(
        cv2.remap(desk, x.astype(np.float32), y.astype(np.float32), cv2.INTER_LINEAR, borderMode=cv2.BORDER_REFLECT), np.float32
    )
