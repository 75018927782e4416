"""Arrows of whole CAD drawings spoiled in six ways: is it said only of those turned round that they point the other way?

``python -m tests.compare.arrows_trial [DRAWINGS] [--seed N]`` draws a sheet of one of four projects each time, each in another way,
with eight of its vectors moved aside or along, shortened, lengthened, turned, removed or turned round, whatever lies upon them.
"""

import argparse
import random
from collections import Counter
from dataclasses import replace

import numpy as np

from tests.compare.cad_plants import compared, draw, sheets_of, some_way

PROJECTS = ["lugansk/shaper", "lugansk/engine", "press", "sixbar/3:1"]
KINDS = ("aside", "along", "shorter", "longer", "turned", "removed", "reversed", "reversed")
SPOILED = 8
"""Vectors of a drawing that are spoiled."""
OTHER_WAY = "points the other way"


def spoiled(e, kind, rng):
    """The vector drawn otherwise; None where it is not drawn at all."""
    a, b = e.points
    u, by = (b - a) / abs(b - a), rng.uniform(2, 6)
    ends = {
        "aside": (a + 1j * by * u, b + 1j * by * u), "along": (a + by * u, b + by * u), "shorter": (a, b - by * u),
        "longer": (a, b + by * u), "turned": (a, a + (b - a) * np.exp(1j * by / abs(b - a))), "reversed": (b, a),
    }
    if kind == "removed":
        return None
    tail, tip = ends[kind]
    turn = (tip - tail) / abs(tip - tail) / u
    return replace(e, points=np.array([tail, tip]), fills=tuple(tip + (f - b) * turn for f in e.fills))


def drawing(sheet, exact, rng, count):
    """Spoil some vectors of a drawing and count what is said of them, and of the others."""
    vectors = [e for e in exact if e.kind == "line" and e.role == "vector" and len(e.fills) == 1 and e.length > 12]
    chosen = dict(zip(rng.sample(vectors, min(SPOILED, len(vectors))), rng.sample(KINDS, len(KINDS)), strict=False))
    made = {e: spoiled(e, kind, rng) for e, kind in chosen.items()}
    drawn = [one for e in exact if (one := made.get(e, e)) is not None]
    for f, e in zip(compared(draw(drawn, some_way(rng), rng), sheet, exact).findings, exact, strict=True):
        kind = chosen.get(e, "sound")
        if e in vectors:
            count[kind] += 1
            count[f"{kind}, {OTHER_WAY}"] += OTHER_WAY in f.what
            count[f"{kind}, red or amber"] += f.verdict in ("red", "amber")
            if (OTHER_WAY in f.what) != (kind == "reversed"):
                print(f"   {e.view.name} {e.name}: {kind}, said: {f.what!r}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("drawings", nargs="?", type=int, default=12)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    sheets = [s for s in sheets_of(PROJECTS) if sum(e.role == "vector" and e.kind == "line" for e in s[3]) > 2 * SPOILED]
    count = Counter()
    for k in range(options.drawings):
        _, _, sheet, exact = sheets[k % len(sheets)]
        drawing(sheet, exact, random.Random(options.seed * 1000 + k), count)
    for kind in (*dict.fromkeys(KINDS), "sound"):
        said, bad = count[f"{kind}, {OTHER_WAY}"], count[f"{kind}, red or amber"]
        print(f"{kind:9} {count[kind]:5}, {OTHER_WAY} {said:4}, red or amber {bad:4}")


if __name__ == "__main__":
    main()
