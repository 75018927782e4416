"""What `compare` says about a picture against the truth.

Three things are read from the program: its exit status and message, its JSON, and its overlay as PDF, in which the photograph
lies as it was rectified, the whole A1 sheet. Where a point of the sheet was taken to be is found by looking for a piece of the
picture, rectified by the truth, in that photograph. So a fit is judged without asking the program how good it thinks it is.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from tests.foreign import drawing
from tests.foreign.drawing import SIZE, Floats, Mark

DENSITY = 3.0
"""Pixels a millimetre at which pictures are laid over each other."""
WINDOW, REACH, GRID = 26.0, 7.0, 20.0
"""Side of a piece that is looked for, how far it is looked for, and how far apart pieces are, mm."""
WRONG = 2.0
"""A fit is wrong when it is off by more than this somewhere, mm."""
CLEARLY = 0.06
"""By how much a farther place must fit better than one near the true one to be believed: lines of a table look alike."""
ABOUT = 1.5
"""mm about the lines of the drawing within which their ink is."""
SLIDES = 0.03
"""A piece that lies better than a millimetre off by no more than this is held by nothing."""
COVERED = 0.5
"""A piece of which less of the lines shows, in relation to the whole sheet, is covered."""
GRAIN = 0.3
"""Paper is paler than this, lines are darker."""
FOUND = ("red", "amber", "ink")
"""What counts as found."""
VISIBLE = 1.5
"""Mistakes from this size on should be found, mm."""
SAME = 4.0
"""Elements of one name whose middles lie this near to each other are told together: a vector and its helper line, mm."""
HIDES, SHOWS = 0.6, 2.0
"""A line hides another that is no farther off, mm; a mistake shows when so many mm of line are gone or new."""


@dataclass
class Outcome:
    """What became of one picture: `state` is judged, refused, wrong fit or broken; errors in mm."""

    name: str
    difficulty: str
    project: str
    sheet: int
    state: str
    seconds: float
    reason: str = ""
    median: float | None = None
    most: float | None = None
    worst: float | None = None
    worst_at: tuple[float, float] | None = None
    sound: int = 0
    false_red: int = 0
    accused: list[str] = field(default_factory=list)
    mistakes: list[dict[str, Any]] = field(default_factory=list)
    matched: float | None = None


def _run(picture: Path, truth: dict[str, Any], folder: Path) -> tuple[int, str, float]:
    """The program's command; exit status, last words, seconds."""
    start = time.monotonic()
    words = [
        sys.executable,
        "-m",
        "tmm_sheets",
        "compare",
        truth["project"],
        "--sheet",
        str(truth["sheet"]),
        "--image",
        str(picture),
        "--json",
        str(folder / "report.json"),
        "-o",
        str(folder),
    ]
    try:
        done = subprocess.run(words, capture_output=True, text=True, timeout=900, env={**os.environ, "LANGUAGE": "en"})
    except subprocess.TimeoutExpired:
        return -1, "took longer than 900 s", time.monotonic() - start
    return done.returncode, " ".join(done.stderr.split())[-600:], time.monotonic() - start


def _rectified(picture: Path, truth: dict[str, Any]) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
    """The picture as the truth rectifies it, grey, DENSITY pixels a millimetre, and what of the sheet is in it."""
    image = cv2.imread(str(picture), cv2.IMREAD_GRAYSCALE | cv2.IMREAD_IGNORE_ORIENTATION)
    places = np.array(truth["map"]["pixels"], np.float32)
    step = truth["map"]["step"]
    x = (np.arange(round(SIZE[0] * DENSITY)) + 0.5) / DENSITY / step
    y = (SIZE[1] - (np.arange(round(SIZE[1] * DENSITY)) + 0.5) / DENSITY) / step
    j, i = y.astype(int).clip(0, places.shape[0] - 2), x.astype(int).clip(0, places.shape[1] - 2)
    b, a = (y - j)[:, None, None], (x - i)[None, :, None]
    rows = places[j] * (1 - b) + places[j + 1] * b
    where = (rows[:, i] * (1 - a) + rows[:, i + 1] * a).astype(np.float32)
    if image is None:
        raise FileNotFoundError(picture)
    flat = cv2.remap(image, where[..., 0], where[..., 1], cv2.INTER_AREA, borderMode=cv2.BORDER_CONSTANT, borderValue=255)
    high, wide = image.shape
    inside = (where[..., 0] >= 0) & (where[..., 0] <= wide - 1) & (where[..., 1] >= 0) & (where[..., 1] <= high - 1)
    return np.asarray(flat, np.uint8), inside


def _believed(folder: Path, sheet: int) -> NDArray[np.uint8] | None:
    """The photograph as the program rectified it, out of its PDF overlay."""
    import pypdfium2

    file = folder / f"compare_sheet_{sheet}.pdf"
    if not file.exists():
        return None
    document = pypdfium2.PdfDocument(file)
    try:
        page = document[0]
        for thing in page.get_objects():
            if isinstance(thing, pypdfium2.PdfImage):
                image = np.asarray(thing.get_bitmap().to_pil().convert("RGB"))
                size = (round(SIZE[0] * DENSITY), round(SIZE[1] * DENSITY))
                return np.asarray(cv2.resize(image.min(axis=2), size, interpolation=cv2.INTER_AREA), np.uint8)
    finally:
        document.close()
    return None


def _ink(grey: NDArray[np.uint8]) -> NDArray[np.float32]:
    """Darker than its surroundings, whatever the light: about 0 on paper, 1 on a strong line."""
    values = cv2.GaussianBlur(grey.astype(np.float32), (0, 0), 0.7)
    around = cv2.blur(cv2.dilate(values, np.ones((15, 15), np.uint8)), (15, 15))
    return np.asarray(np.clip((around - values) / 60, 0, 1), np.float32)


def offsets(believed: NDArray[np.uint8], true: NDArray[np.uint8], inside: NDArray[np.bool_],
            drawn: NDArray[np.bool_] | None = None, lines: NDArray[np.bool_] | None = None) -> tuple[Floats, Floats, float]:
    """Where the program looks for pieces of the sheet that are all in the picture: its edge is no line.

    A piece is told by what was `drawn`, if that is known: the edge of what lies on the sheet is no line either. Where most of its
    `lines` do not show in the picture something else lies on it, a dog-ear's back, say: that is no piece of the sheet.

    Returns places (n, 2) mm, how far from there the program has what belongs there (n, 2) mm, and the share of pieces found again.
    """
    ours, theirs = _ink(true), _ink(believed)
    of_pencil = ours if drawn is None else np.where(drawn, ours, np.float32(0))
    half, reach = int(WINDOW * DENSITY / 2), int(REACH * DENSITY)
    shows = _shows(ours, lines)
    places, apart, tried = [], [], 0
    for y in np.arange(WINDOW / 2 + REACH, SIZE[1] - WINDOW / 2 - REACH, GRID):
        for x in np.arange(WINDOW / 2 + REACH, SIZE[0] - WINDOW / 2 - REACH, GRID):
            column, row = int(x * DENSITY), int((SIZE[1] - y) * DENSITY)
            piece = ours[row - half : row + half, column - half : column + half]
            if not inside[row - half : row + half, column - half : column + half].all() or not _tells(
                    of_pencil[row - half : row + half, column - half : column + half]) or not shows[row, column]:
                continue
            tried += 1
            field_ = theirs[row - half - reach : row + half + reach, column - half - reach : column + half + reach]
            score = np.asarray(cv2.matchTemplate(field_, piece, cv2.TM_CCOEFF_NORMED), np.float32)
            best, at = _best(score, reach)
            if best > 0.6 and _held(score, at):
                places.append((x, y))
                found = field_[at[1] : at[1] + 2 * half, at[0] : at[0] + 2 * half]
                dx, dy = np.array(at) - reach + _rest(found, piece)
                apart.append([dx / DENSITY, -dy / DENSITY])
    return np.array(places).reshape(-1, 2), np.array(apart).reshape(-1, 2), len(places) / max(tried, 1)


def _shows(ink: NDArray[np.float32], lines: NDArray[np.bool_] | None) -> NDArray[np.bool_]:
    """Whether pieces about each place of the picture, as the truth rectifies it, show at least COVERED as much of the lines that
    were drawn there as it shows of all.
    """
    if lines is None:
        return np.ones(ink.shape, bool)
    size = (int(WINDOW * DENSITY),) * 2
    seen = (cv2.dilate(ink, np.ones((5, 5), np.uint8)) > GRAIN) & lines
    there, all_ = (cv2.blur(some.astype(np.float32), size) for some in (seen, lines))
    return np.asarray(there >= COVERED * all_ * seen.sum() / max(int(lines.sum()), 1), np.bool_)


def _best(score: NDArray[np.float32], reach: int) -> tuple[float, tuple[int, int]]:
    """The best score and where it is; a place within WRONG of the true one goes before a farther one that is hardly better."""
    _, best, _, at = cv2.minMaxLoc(score)
    first = reach - int(WRONG * DENSITY)
    _, near, _, there = cv2.minMaxLoc(score[first : 2 * reach + 1 - first, first : 2 * reach + 1 - first])
    if near > best - CLEARLY:
        return near, (there[0] + first, there[1] + first)
    return best, (at[0], at[1])


def _held(score: NDArray[np.float32], at: tuple[int, int]) -> bool:
    """Whether a piece lies worse a millimetre off on all sides.

    One line that ends at the edge of what lies on the sheet may slide along itself: the edge is no line and is not found again.
    """
    row, column = np.ogrid[: score.shape[0], : score.shape[1]]
    off = np.hypot(row - at[1], column - at[0])
    return bool(score[(off > 0.8 * DENSITY) & (off < 1.2 * DENSITY)].max() < score[at[1], at[0]] - SLIDES)


def _tells(piece: NDArray[np.float32]) -> bool:
    """Whether a piece has enough lines, in more than one direction and not all in one corner, to say where it lies."""
    half = len(piece) // 2
    halves = slice(half), slice(half, None)
    lines = np.where(piece > GRAIN, piece, 0)
    quarters = [lines[rows, columns].mean() for rows in halves for columns in halves]
    if lines.mean() < 0.01 or sorted(quarters)[1] < 0.002:  # the tip of a line that reaches in
        return False
    dx, dy = cv2.Sobel(piece, cv2.CV_32F, 1, 0), cv2.Sobel(piece, cv2.CV_32F, 0, 1)
    spread = np.linalg.eigvalsh(np.array([[(dx * dx).sum(), (dx * dy).sum()], [(dx * dy).sum(), (dy * dy).sum()]]))
    return bool(spread[0] > 0.15 * spread[1] and spread[0] > 40)


def _rest(found: NDArray[np.float32], piece: NDArray[np.float32]) -> Floats:
    """What is left of the shift (2,) beside whole pixels, by least squares on the slopes: nothing for equal pictures."""
    slopes = np.stack([np.gradient(piece, axis=1).ravel(), np.gradient(piece, axis=0).ravel()])
    shift = np.linalg.solve(slopes @ slopes.T, slopes @ (piece - found).ravel())
    return np.asarray(np.clip(shift, -1.0, 1.0), np.float64)


def _read(lettering: str) -> str:
    """Lettering as it is read, without the marks of indices; the report has no others."""
    return re.sub(r"[_^{}]", "", lettering)


def _is(element: dict[str, Any], mark: Mark) -> bool:
    """Whether an element of the report is this mark of the record."""
    if (element.get("step", ""), element.get("position", "")) != (mark.step, mark.position) or not mark.step:
        return False
    if mark.kind == "text":
        return bool(element["element"] == "text" and _read(mark.string) in element.get("name", ""))
    name = _read(mark.name)
    names = ("", name, f"{name}({mark.position})") if name else (element.get("name", ""),)
    kinds = {"fill": ("line", "circle"), "circle": ("circle", "arc"), "polyline": ("curve", "line")}.get(mark.kind, (mark.kind,))
    # a view without a title is called by its module in the record, by a name in the report
    return (element["view"] == mark.view or "." in mark.view) and element.get("name", "") in names and element["element"] in kinds


def _those(elements: list[dict[str, Any]], mark: Mark) -> list[dict[str, Any]]:
    """The elements of the report that are a mark: of several of one name (both lines of a guide, a rod in many positions) those in
    its place.
    """
    alike = [element for element in elements if _is(element, mark)]
    if not mark.paths() or not alike:
        return alike
    corners = np.vstack(mark.paths())
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
    away = [float(np.hypot(*(np.array(element["middle_mm"]) - middle))) for element in alike]
    return [element for element, by in zip(alike, away, strict=True) if by < min(away) + SAME]


def _near(marks: list[Mark], lines: list[list[list[float]]]) -> list[Mark]:
    """Marks of which a third or more lies within 2 mm of wrong lines: what is said of them does not count."""
    if not lines:
        return []
    fine = np.vstack([_sampled(np.array(line)) for line in lines])
    excused = []
    for mark in marks:
        samples = np.vstack([_sampled(path) for path in mark.paths()]) if mark.paths() else fine + 1e3
        samples = samples[:: len(samples) // 400 + 1]
        distance = np.hypot(samples[:, None, 0] - fine[None, :, 0], samples[:, None, 1] - fine[None, :, 1]).min(axis=1)
        if (distance < 2).mean() > 0.33:
            excused.append(mark)
    return excused


def _sampled(path: Floats, step: float = 2.0) -> Floats:
    along = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))))
    where = np.linspace(0, along[-1], max(2, int(along[-1] / step) + 1))
    return np.stack([np.interp(where, along, path[:, i]) for i in (0, 1)], axis=1)


def changed(truth: dict[str, Any], marks: list[Mark]) -> list[float]:
    """How much of each mistake shows, mm: lines that are gone or new, farther than HIDES from all other ink.

    A line that was moved onto another, from where a twin of it stays, leaves the drawing as it should be.
    """
    named = {mark.id: mark for mark in marks}
    was = [[path for mark in mistake["wrong"] for path in named[mark["id"]].paths()] for mistake in truth["mistakes"]]
    now = [[np.array(line) for line in mistake["lines"][len(old) :]] for mistake, old in zip(truth["mistakes"], was, strict=True)]
    wrong = {mark["id"] for mistake in truth["mistakes"] for mark in mistake["wrong"]}
    sound = [_sampled(path, 0.25) for mark in marks if mark.id not in wrong for path in _inked(mark)]
    there = np.vstack([*sound, *(_sampled(path, 0.25) for paths in now for path in paths)])
    right = np.vstack([*sound, *(_sampled(path, 0.25) for paths in was for path in paths)])
    return [_alone(old, there) + _alone(new, right) for old, new in zip(was, now, strict=True)]


def _inked(mark: Mark) -> list[Floats]:
    """Lines that are nowhere farther than HIDES from ink of a mark: a head or a dot is filled, within it nothing shows."""
    paths = list(mark.paths())
    if mark.kind == "fill":
        middle = mark.points.mean(axis=0)
        paths += [middle + share * (path - middle) for path in mark.paths() for share in (0.7, 0.4, 0.1)]
    return paths


def _alone(paths: list[Floats], others: Floats) -> float:
    """How many mm of lines are farther than HIDES from others."""
    if not paths:
        return 0.0
    step = 0.5
    samples = np.vstack([_sampled(path, step) for path in paths])
    low, high = samples.min(axis=0) - 2 * HIDES, samples.max(axis=0) + 2 * HIDES
    near = others[((others > low) & (others < high)).all(axis=1)]
    if not len(near):
        return step * len(samples)
    apart = [np.hypot(*(part[:, None] - near[None]).T).min(axis=0) for part in np.array_split(samples, len(samples) // 200 + 1)]
    return float(step * (np.concatenate(apart) > HIDES).sum())


def _pointed_at(mistake: dict[str, Any], extra: list[dict[str, Any]]) -> bool:
    """Whether the report shows ink that belongs to nothing where the wrong line is."""
    samples = np.vstack([_sampled(np.array(line)) for line in mistake["lines"]])
    for spot in extra:
        away = np.abs(samples - spot["at_mm"]) - (spot["width_mm"] / 2 + 1, spot["height_mm"] / 2 + 1)
        if (away.max(axis=1) < 0).any():
            return True
    return False


def _verdict(element: dict[str, Any]) -> str:
    """What is said of an element: its colour, or that it cannot be judged."""
    return "unjudged" if element["verdict"] == "not-judged" else str(element["verdict"])


def _said(outcome: Outcome, report: dict[str, Any], truth: dict[str, Any], marks: list[Mark]) -> None:
    """False reds among the sound elements; which mistakes were found: red, amber, or shown as ink that belongs to nothing.

    "unjudged" is what the report tells that it cannot judge, "silent" what it says nothing of, "same" a mistake that does not show.
    """
    elements = [f for f in report["findings"] if "element" in f]
    named = {mark.id: mark for mark in marks}
    touched: list[Mark] = []
    for mistake, shows in zip(truth["mistakes"], changed(truth, marks), strict=True):
        wrong = [named[mark["id"]] for mark in mistake["wrong"]]
        said = {_verdict(element) for mark in wrong for element in _those(elements, mark)}
        found = next((verdict for verdict in ("red", "amber", "green", "unjudged") if verdict in said), "silent")
        if found != "red" and _pointed_at(mistake, report["unclaimed"]):
            found = "ink"
        if found not in FOUND and shows < SHOWS:
            found = "same"
        outcome.mistakes.append({"kind": mistake["kind"], "size": mistake["size"], "place": mistake["place"], "said": found})
        touched += wrong
    touched += _near(marks, [line for mistake in truth["mistakes"] for line in mistake["lines"]])
    for element in elements:
        if any(_is(element, mark) for mark in touched):
            continue
        outcome.sound += 1
        if element["verdict"] == "red":
            outcome.false_red += 1
            outcome.accused.append(f"{element['view']}: {element.get('name') or element['element']}, {element['said']}")


def judge(picture: Path, drawings: Path, keep: Path | None = None) -> Outcome:
    """Run `compare` on a picture and hold what it says against the truth that lies beside it."""
    truth = json.loads(picture.with_suffix(".json").read_text(encoding="utf-8"))
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) if keep is None else keep / picture.stem
        folder.mkdir(parents=True, exist_ok=True)
        status, words, seconds = _run(picture, truth, folder)
        state = {0: "judged", 1: "refused"}.get(status, "broken")
        outcome = Outcome(
            picture.stem, truth["difficulty"], truth["project"], truth["sheet"], state, round(seconds, 1), words if status else ""
        )
        if status == 0:
            marks = drawing.read(truth["project"], truth["sheet"], drawings)
            _measure(outcome, picture, truth, marks, folder)
            report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
            outcome.matched = report.get("matched")
            _said(outcome, report, truth, marks)
    return outcome


def _drawn(marks: list[Mark], truth: dict[str, Any], about: float = ABOUT) -> NDArray[np.bool_]:
    """Where lines were drawn, right or wrong, and as far about them as wrong ones may lie, DENSITY pixels a millimetre."""
    out = np.zeros((round(SIZE[1] * DENSITY), round(SIZE[0] * DENSITY)), np.uint8)
    wrong = [np.array(line) for mistake in truth["mistakes"] for line in mistake["lines"]]
    for path in [*wrong, *(path for mark in marks for path in mark.paths())]:
        pixels = np.stack((path[:, 0], SIZE[1] - path[:, 1]), axis=1) * DENSITY
        cv2.polylines(out, [pixels.round().astype(np.int32)], False, 1, max(round(2 * about * DENSITY), 1))
    return out > 0


def _measure(outcome: Outcome, picture: Path, truth: dict[str, Any], marks: list[Mark], folder: Path) -> None:
    """Errors of the fit; it is wrong where a piece lies more than WRONG off, or where most pieces are not within reach at all."""
    believed = _believed(folder, truth["sheet"])
    if believed is None:
        outcome.state, outcome.reason = "broken", "there is no overlay with the photograph"
        return
    places, apart, share = offsets(believed, *_rectified(picture, truth), _drawn(marks, truth), _drawn(marks, truth, 0.0))
    if len(places) < 10 or share < 0.5:
        outcome.state, outcome.reason = "wrong fit", f"only {share:.0%} of the pieces within {REACH:g} mm of their places"
        return
    error = np.hypot(*apart.T)
    worst = int(error.argmax())
    outcome.median, outcome.most, outcome.worst = (
        round(float(value), 3) for value in (np.median(error), np.percentile(error, 95), error[worst])
    )
    outcome.worst_at = (round(float(places[worst, 0])), round(float(places[worst, 1])))
    if outcome.worst > WRONG:
        outcome.state, outcome.reason = "wrong fit", f"{outcome.worst:.1f} mm off at {outcome.worst_at}"
