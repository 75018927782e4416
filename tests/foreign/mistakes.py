"""Mistakes of a student, planted in the geometry before anything is drawn."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from tests.foreign.drawing import SIZE, Floats, Mark

Random = np.random.Generator
FRAMES = ("frame", "table")


@dataclass(frozen=True)
class Mistake:
    """What was done wrong: kind, place and size in mm, the marks that are wrong by it and the lines they were and have become."""

    kind: str
    place: tuple[float, float]
    size: float
    wrong: tuple[Mark, ...]
    lines: tuple[Floats, ...]


Planted = tuple[dict[int, Mark | None], str, float] | None


def _length(mark: Mark) -> float:
    return float(np.hypot(*np.diff(mark.path(), axis=0).T).sum())


def _lines(
    marks: list[Mark], least: float, roles: tuple[str, ...] = ("vector", "construction", "link", "symbol", "axis")
) -> list[Mark]:
    return [mark for mark in marks if mark.kind == "line" and mark.step and mark.role in roles and _length(mark) >= least]


def _head(marks: list[Mark], line: Mark) -> Mark | None:
    """The arrowhead of a vector: the filled mark of the same name at its end."""
    for mark in marks:
        if (
            mark.kind == "fill"
            and mark.view == line.view
            and mark.key == line.key
            and np.hypot(*(mark.points - line.points[1]).T).min() < 3
        ):
            return mark
    return None


def _turned(points: Floats, about: Floats, angle: float) -> Floats:
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray((points - about) @ np.array([[c, s], [-s, c]]) + about)


def line_turned(marks: list[Mark], random: Random) -> Planted:
    """A line starts right and goes off by 1.5 to 6 mm at its end."""
    from_where = _lines(marks, 18)
    if not from_where:
        return None
    line = from_where[random.integers(len(from_where))]
    size = float(random.uniform(1.5, 6))
    angle = size / _length(line) * random.choice((-1, 1))
    change: dict[int, Mark | None] = {line.id: replace(line, points=_turned(line.points, line.points[0], angle))}
    head = _head(marks, line)
    if head:
        change[head.id] = replace(head, points=_turned(head.points, line.points[0], angle))
    return change, "line turned", size


def point_displaced(marks: list[Mark], random: Random) -> Planted:
    """A point lies 1.5 to 5 mm off and all lines that end there go where it lies."""
    lines = _lines(marks, 10, ("vector", "construction", "link"))
    if not lines:
        return None
    line = lines[random.integers(len(lines))]
    head = _head(marks, line)
    point = head.points[0] if head else line.points[1]
    size, angle = float(random.uniform(1.5, 5)), random.uniform(0, 2 * np.pi)
    by = size * np.array([np.cos(angle), np.sin(angle)])
    change: dict[int, Mark | None] = {}
    for mark in marks:
        if (
            mark.view != line.view
            or mark.kind not in ("line", "fill")
            or mark.role not in ("vector", "construction", "link", "point")
        ):
            continue
        near = np.hypot(*(mark.points - point).T)
        if mark.kind == "fill" and near.min() < 0.7:
            change[mark.id] = mark.moved(by)
        elif mark.kind == "line" and near.min() < (5.5 if mark.role == "vector" else 0.3):
            ends = mark.points.copy()
            ends[int(near.argmin())] += by
            change[mark.id] = replace(mark, points=ends)
    return (change, "point displaced", size) if change else None


def circle_wrong(marks: list[Mark], random: Random) -> Planted:
    """A circle of a radius that is wrong by 1.5 to 4 mm."""
    circles = [mark for mark in marks if mark.kind == "circle" and mark.step and mark.radius > 6]
    if not circles:
        return None
    circle = circles[random.integers(len(circles))]
    size = float(random.uniform(1.5, 4))
    sign = random.choice((-1, 1)) if circle.radius > 8 else 1
    return {circle.id: replace(circle, radius=circle.radius + sign * size)}, "circle of wrong radius", size


def joint_wrong(marks: list[Mark], random: Random) -> Planted:
    """The small circle of a joint, a third too large."""
    circles = [mark for mark in marks if mark.kind == "circle" and mark.step and 1 < mark.radius < 3 and mark.role == "symbol"]
    if not circles:
        return None
    circle = circles[random.integers(len(circles))]
    size = circle.radius * float(random.uniform(0.3, 0.5))
    return {circle.id: replace(circle, radius=circle.radius + size)}, "joint too large", size


def _covered(line: Mark, marks: list[Mark]) -> bool:
    """Whether other lines of the view run along most of this one: what is left when it is left out."""
    samples = line.points[0] + np.linspace(0, 1, 30)[:, None] * (line.points[1] - line.points[0])
    under = np.zeros(len(samples), bool)
    for other in marks:
        if other.kind == "line" and other.view == line.view and other.id != line.id:
            start, way = other.points[0], other.points[1] - other.points[0]
            along = ((samples - start) @ way / max(way @ way, 1e-9)).clip(0, 1)
            under |= np.hypot(*(samples - start - along[:, None] * way).T) < 0.5
    return bool(under.mean() > 0.7)


def vector_left_out(marks: list[Mark], random: Random) -> Planted:
    """A vector was forgotten."""
    vectors = _lines(marks, 8, ("vector",))
    if not vectors:
        return None
    line = vectors[random.integers(len(vectors))]
    head = _head(marks, line)
    change: dict[int, Mark | None] = {line.id: None}
    if head:
        change[head.id] = None
    return change, "left out over a helper" if _covered(line, marks) else "left out", _length(line)


def label_moved(marks: list[Mark], random: Random) -> Planted:
    """A letter stands 5 to 12 mm beside its place."""
    labels = [mark for mark in marks if mark.kind == "text" and mark.step and mark.letters]
    if not labels:
        return None
    label = labels[random.integers(len(labels))]
    size, angle = float(random.uniform(5, 12)), random.uniform(0, 2 * np.pi)
    by = size * np.array([np.cos(angle), np.sin(angle)])
    near = [mark for mark in labels if mark.step == label.step and np.hypot(*(mark.points[0] - label.points[0])) < 8]
    return {mark.id: mark.moved(by) for mark in near}, "label moved", size


def arrow_reversed(marks: list[Mark], random: Random) -> Planted:
    """The arrow of a vector stands at its other end."""
    vectors = [(line, head) for line in _lines(marks, 15, ("vector",)) if (head := _head(marks, line))]
    if not vectors:
        return None
    line, head = vectors[random.integers(len(vectors))]
    tip = head.points[0]
    middle = (line.points[0] + tip) / 2
    change: dict[int, Mark | None] = {
        head.id: replace(head, points=_turned(head.points, middle, np.pi)),
        line.id: replace(line, points=_turned(line.points, middle, np.pi)),
    }
    return change, "arrow reversed", _length(line)


def digits_swapped(marks: list[Mark], random: Random) -> Planted:
    """Two cells of a table have changed places."""
    cells = [
        mark
        for mark in marks
        if mark.kind == "text"
        and not mark.step
        and mark.letters
        and mark.string[:1].isdigit()
        and len(mark.string) >= 3
        and mark.view != "title block"
    ]
    random.shuffle(cells)
    for one in cells:
        for other in cells:
            if other.string != one.string and len(other.string) == len(one.string) and other.view == one.view:
                by = other.points[0] - one.points[0]
                return {one.id: one.moved(by), other.id: other.moved(-by)}, "digits swapped", one.height
    return None


KINDS: tuple[Callable[[list[Mark], Random], Planted], ...] = (
    line_turned,
    point_displaced,
    circle_wrong,
    joint_wrong,
    vector_left_out,
    label_moved,
    arrow_reversed,
    digits_swapped,
)
WEIGHTS = np.array([5, 5, 3, 2, 4, 2, 2, 1], float)


def _inside(mark: Mark | None) -> bool:
    """Whether a mark stays within the frame."""
    if mark is None:
        return True
    return all(bool(((path > (22, 7)) & (path < (SIZE[0] - 7, SIZE[1] - 7))).all()) for path in mark.paths())


def plant(marks: list[Mark], count: int, random: Random) -> tuple[list[Mark], list[Mistake]]:
    """`count` mistakes that do not touch each other; the marks as the student draws them, and what is wrong."""
    now = {mark.id: mark for mark in marks}
    mistakes: list[Mistake] = []
    for _ in range(count * 12):
        if len(mistakes) == count:
            break
        made = KINDS[random.choice(len(KINDS), p=WEIGHTS / WEIGHTS.sum())](marks, random)
        if made is None or not all(_inside(mark) for mark in made[0].values()):
            continue
        change, kind, size = made
        was = tuple(mark for mark in marks if mark.id in change)
        place = np.mean([np.vstack(mark.paths()).mean(axis=0) for mark in was], axis=0)
        if any(np.hypot(*(place - other.place)) < 45 for other in mistakes) or any(
            now.get(i) is not mark for i, mark in ((m.id, m) for m in was)
        ):
            continue
        lines = [path for mark in (*was, *(mark for mark in change.values() if mark)) for path in mark.paths()]
        for number, mark in change.items():
            if mark is None:
                del now[number]
            else:
                now[number] = mark
        mistakes.append(Mistake(kind, (float(place[0]), float(place[1])), size, was, tuple(lines)))
    return list(now.values()), mistakes
