"""CAD drawings with single elements done wrongly: is each told once, by its own name, and nothing else?

``python -m tests.compare.one_wrong [DRAWINGS] [--seed N] [--projects NAME ...]`` draws a sheet each time, on it up to ten elements
that stand well apart and are done wrongly: shifted, turned, drawn larger, left out or drawn twice, of every kind (line, arrow, arc,
circle, dot, curve, hatching, text). What is said within their neighbourhood has to be one accusation each: of that element, or of
extra ink where it was drawn twice.
"""

from __future__ import annotations

import argparse
import random
from collections import Counter
from dataclasses import replace

import numpy as np

from tests.compare.cad_plants import Way, compared, covered, draw, sheets_of
from tmm_sheets.box import Box
from tmm_sheets.compare.cad.cad_comparison import LOOSE_STYLES
from tmm_sheets.compare.elements import Element
from tmm_sheets.drawing.marks import Points

PROJECTS = ("lugansk/shaper", "lugansk/engine", "press", "sixbar/3:1", "transport/diesel@01-Т-27", "screen", "loom")
WAYS = ("shifted", "turned", "larger", "left out", "twice")
WRONG = 10
"""Elements of a drawing that are done wrongly, at most."""
APART = 25.0
"""Least distance of their neighbourhoods, mm."""
BY = 3.0
"""How far the farthest point is off, mm."""


def sort_of(e: Element) -> str:
    """What an element is to the eye."""
    if e.kind == "circle" and e.fills:
        return "dot"
    return "arrow" if e.kind == "line" and e.arrow else e.kind


def done(e: Element, way: str, rng: random.Random) -> list[Element] | None:
    """The element as it is drawn; None where that would not show."""
    z, middle = e.points, complex(e.points.mean())
    size = float(np.abs(z - middle).max())
    if way == "larger" and e.kind == "line" and e.style in LOOSE_STYLES:
        return None  # auxiliary lines may end beyond
    if way == "left out":
        return []
    along = (z[-1] - z[0]) / abs(z[-1] - z[0]) if e.kind == "line" else np.exp(2j * np.pi * rng.random())
    if way in ("shifted", "twice"):
        if e.kind == "text" and way == "shifted":
            return None  # its place is the draughtsman's choice
        by = BY * along * 1j * rng.choice((-1, 1))
        off = _mapped(e, lambda w: w + by)
        return [off] if way == "shifted" else [e, off]
    if size < 2 * BY or e.kind in ("text", "hatch"):
        return None
    about = complex(z[0]) if e.kind == "line" else middle
    by = BY / float(np.abs(z - about).max())
    if way == "turned":
        if e.kind == "circle":
            return None
        return [_mapped(e, lambda w: about + (w - about) * np.exp(1j * by), by)]
    return [_mapped(e, lambda w: about + (w - about) * (1 + by), 0.0, 1 + by)]


def _mapped(e: Element, to, turn: float = 0.0, size: float = 1.0) -> Element:
    """Heads keep their size."""
    def head(f: Points) -> Points:
        k = int(np.abs(e.points - f[0]).argmin())
        return to(e.points[k]) + (f - e.points[k]) * np.exp(1j * turn)

    fills = tuple(to(f) if e.kind == "circle" else head(f) for f in e.fills)
    return replace(e, points=to(e.points), centre=to(e.centre), radius=e.radius * size, start=e.start + turn, end=e.end + turn,
                   fills=fills, pieces=tuple(to(p) for p in e.pieces))


def shows(e: Element, made: list[Element], exact: list[Element]) -> bool:
    """Whether it makes a difference that can be seen beside what else is drawn there."""
    if e.kind == "text":
        return True
    if sort_of(e) == "dot":
        return not any(sort_of(o) == "dot" and abs(o.centre - m.centre) < 2.5 for o in exact if o is not e for m in (e, *made))
    return all(covered(p, e.number, exact) < 0.3 for m in (e, *made) for p in (m.pieces or (m.points,)))


def neighbourhood(e: Element, made: list[Element]) -> Box:
    return Box.around(np.concatenate([e.points, *(m.points for m in made)]), 6.0)


def wrongly(exact: list[Element], rng: random.Random, count: Counter[tuple[str, str]]) -> list[
        tuple[Element, str, list[Element], Box]]:
    """Elements far from one another, how they are done wrongly, what is drawn instead, and where; rare kinds first."""
    out: list[tuple[Element, str, list[Element], Box]] = []
    some = [(e, way) for e in exact if e.view.n and e.kind != "fill" and (e.kind == "text" or e.length > 4) for way in WAYS]
    rng.shuffle(some)
    for e, way in sorted(some, key=lambda x: count[sort_of(x[0]), x[1]]):
        if len(out) == WRONG:
            break
        made = done(e, way, rng)
        if made is None:
            continue
        box = neighbourhood(e, made)
        if all(_apart(box, other) for *_, other in out) and shows(e, made, exact):
            out.append((e, way, made, box))
            count[sort_of(e), way] += 1
    return out


def _apart(a: Box, b: Box) -> bool:
    return a.x0 > b.x1 + APART or b.x0 > a.x1 + APART or a.y0 > b.y1 + APART or b.y0 > a.y1 + APART


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("drawings", nargs="?", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--projects", nargs="+", default=PROJECTS)
    options = parser.parse_args()
    sheets = sheets_of(options.projects)
    planted: Counter[tuple[str, str]] = Counter()
    count: Counter[tuple[str, str, str]] = Counter()
    for run in range(options.first, options.first + options.drawings):
        name, n, sheet, exact = sheets[run % len(sheets)]
        rng = random.Random(options.seed * 10_007 + run)
        wrong = wrongly(exact, rng, planted)
        instead = {e.number: made for e, _, made, _ in wrong}
        drawn = [one for e in exact for one in instead.get(e.number, [e])]
        outcome = compared(draw(drawn, Way(), rng), sheet, exact)
        every = [(f.element.number, f.at, f"{f.element.number} {f.element.kind} {f.element.name!r}: {f.what}")
                for f in outcome.findings if f.verdict in ("red", "amber")]
        every += [(0, x.at, f"extra {x.length:.0f} mm {x.text}") for x in outcome.extras]
        said = dict(enumerate(every))
        by_number = {e.number: box for e, *_, box in wrong}
        for e, way, _, box in wrong:
            mine = [i for i, (k, at, _) in said.items() if k == e.number or (k not in by_number and box.contains(at))]
            here = [(k, words) for k, _, words in (said.pop(i) for i in mine)]
            named = sum(k == e.number for k, _ in here) if way != "twice" else sum(k == 0 for k, _ in here)
            allowed = sort_of(e) == "hatch" and way == "shifted"  # its strokes may lie otherwise
            verdict = "as it is" if named == len(here) == 1 or (allowed and not here) else "missed" if not here else (
                "doubled" if named else "another's")
            count[sort_of(e), way, verdict] += 1
            if verdict != "as it is":
                what = f"{way} {e.number} {sort_of(e)} {e.style} {e.role} {e.name!r}, {e.length:.0f} mm at {e.middle:.0f}"
                print(f"   {run} {name} {n}: {verdict}: {what}, {e.view.name}: {'; '.join(w for _, w in here)}", flush=True)
        count["sound", "", "accused"] += len(said)
        for *_, words in said.values():
            print(f"   {run} {name} {n}: far from all: {words}", flush=True)
    for sort in dict.fromkeys(sort for sort, *_ in count):
        for way in dict.fromkeys(w for s, w, _ in count if s == sort):
            print(f"{sort:6} {way:9}", ", ".join(f"{v} {k}" for (s, w, v), k in sorted(count.items()) if (s, w) == (sort, way)))
    together = Counter()
    for (sort, _, v), k in count.items():
        if sort != "sound":
            together[v] += k
    print("together", dict(together))


if __name__ == "__main__":
    main()
