"""The least of a function in a box, when all that can be asked is which of two points is better.

First points all over the box, then Nelder and Mead's simplex from the best of them, begun anew where it stopped, at last steps
about the best in all directions, smaller and smaller: a simplex may lie down flat along a wall or in a valley before it is there.
Points that leave the box are put back on its wall. What is found depends on nothing but the function.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import product
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Point = NDArray[np.float64]
Key = TypeVar("Key", bound=tuple[float, ...])
STARTS = 3
"""Best points that a simplex is begun from."""
SMALL = 1e-3
"""Size of a simplex, as a share of the box, at which it has come to an end."""
SMALLEST = 1 / 4096
"""The least step, as a share of the box."""


class Enough(Exception):
    """So many points as may be asked have been."""


def search(ask: Callable[[Point], Key], dimensions: int, tries: int) -> None:
    """Ask for points of the unit box until no better one is found; ``ask`` keeps them, and may end the search by ``Enough``.

    Parameters
    ----------
    ask
        how good a point is, of shape (dimensions,): the least is best.
    dimensions
        of the box.
    tries
        how many points may be asked.
    """
    left = tries

    def counted(x: Point) -> Key:
        nonlocal left
        if left <= 0:
            raise Enough
        left -= 1
        return ask(x)

    try:
        first = [*_spread(dimensions, tries)]
        size = 1 / (round(len(first) ** (1 / dimensions)) - 1)
        asked = sorted(((counted(x), n) for n, x in enumerate(first)))
        best = asked[0][0], first[asked[0][1]]
        for _, n in asked[:STARTS]:
            best = min(best, _simplex(counted, first[n], size / 2), key=lambda found: found[0])
        while (again := _simplex(counted, best[1], size / 4))[0] < best[0]:
            best = again
        _steps(counted, *best)
    except Enough:
        pass


def _spread(dimensions: int, tries: int) -> Iterator[Point]:
    """Points all over the box, its corners with them: a quarter of the tries, 17 along a line at most."""
    along = min(17, max(3, int((tries / 4) ** (1 / dimensions))))
    for at in product(np.linspace(0.0, 1.0, along), repeat=dimensions):
        yield np.array(at)


def _steps(ask: Callable[[Point], Key], key: Key, at: Point) -> None:
    """Steps from a point to better ones, half as long where none is better."""
    ways = [np.array(way) for way in product((-1.0, 0.0, 1.0), repeat=len(at)) if any(way)] if len(at) < 4 else [
        *np.eye(len(at)), *-np.eye(len(at))]
    step = 8 * SMALL
    while step >= SMALLEST:
        for way in ways:
            x = np.clip(at + step * way, 0.0, 1.0)
            if (new := ask(x)) < key:
                key, at = new, x
                break
        else:
            step /= 2


def _simplex(ask: Callable[[Point], Key], start: Point, size: float) -> tuple[Key, Point]:
    """Nelder and Mead's search from a point."""
    inward = np.where(start > 0.5, -size, size)
    points = [start, *(start + step for step in np.diag(inward))]
    keys = [ask(x) for x in points]
    while True:
        order = sorted(range(len(points)), key=lambda k: keys[k])
        points, keys = [points[k] for k in order], [keys[k] for k in order]
        if np.ptp(points, axis=0).max() < SMALL:
            return keys[0], points[0]
        middle = np.mean(points[:-1], axis=0)

        def moved(by: float, middle: Point = middle, worst: Point = points[-1]) -> tuple[Key, Point]:
            x = np.clip(middle + by * (middle - worst), 0.0, 1.0)
            return ask(x), x

        new = moved(1.0)
        if new[0] < keys[0]:
            new = min(new, moved(2.0), key=lambda found: found[0])
        elif not new[0] < keys[-2]:
            new = moved(0.5) if new[0] < keys[-1] else moved(-0.5)
        if new[0] < keys[-1]:
            keys[-1], points[-1] = new
        else:
            points[1:] = [(x + points[0]) / 2 for x in points[1:]]
            keys[1:] = [ask(x) for x in points[1:]]
