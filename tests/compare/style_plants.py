"""CAD drawings with lines of wrong types and widths: what is found, what is accused wrongly.

``python -m tests.compare.style_plants [DRAWINGS] [PROJECT ...]`` draws that many sheets with right types and widths, some of them
dash by dash, spoils six lines of each and prints rates.
"""

from __future__ import annotations

import random
import sys
from collections import Counter
from dataclasses import replace

from tests.compare.cad_plants import compared, covered, draw, sheets_of, some_way
from tmm_sheets.compare.cad.cad_comparison import STYLES
from tmm_sheets.compare.cad.line_styles import BROAD
from tmm_sheets.drawing.ink import cut
from tmm_sheets.drawing.styles import line_type

WRONG = {
    "main": ("thin", "hidden", "centre"), "curve": ("thin", "hidden"), "vector": ("thin", "centre"), "thin": ("main", "centre"),
    "construction": ("main", "hidden"), "centre": ("thin", "hidden", "main", "twodot"), "hidden": ("thin", "main", "centre"),
    "twodot": ("thin", "centre", "hidden"),
}  # fmt: skip
"""What lines of each style are drawn as."""


def spoiled(found, rng):
    """The elements with the styles of some of them changed, and what they were changed to by number."""
    changed = {}
    out = list(found)
    good = [k for k, e in enumerate(found) if e.kind in ("line", "arc", "circle", "curve") and e.style in WRONG and e.length > 8
            and not (e.kind == "circle" and e.fills)]  # fmt: skip
    rng.shuffle(good)
    for k in good:
        e = found[k]
        style = rng.choice(WRONG[e.style])
        pattern = line_type(e.style).pattern
        if (pattern and len(cut(e.length, pattern)) < 7) or covered(e.points, e.number, found) > 0.4:
            continue  # too short to show its strokes; or under others
        out[k] = replace(e, style=style)
        changed[e.number] = style
        if len(changed) == 6:
            break
    return out, changed


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    projects = sys.argv[2:] or ["lugansk/shaper", "lugansk/engine", "press", "sixbar/3:1", "transport/diesel@01-Т-27"]
    rng = random.Random(count)
    sheets = sheets_of(projects)
    planted, found_of = Counter(), Counter()
    wrong = total = rows = 0
    for run in range(count):
        name, n, sheet, exact = sheets[run % len(sheets)]
        drawn, changed = spoiled(exact, rng)
        rng.shuffle(drawn)
        way = replace(some_way(rng), looks=True, frame=True)
        looks = compared(draw(drawn, way, rng), sheet, exact).looks
        rows += len(looks)
        said = {number: look.what for look in looks for number in look.elements}
        by_number = {e.number: e for e in exact}
        for number, style in changed.items():
            was = by_number[number].style
            kind = "width" if (was in BROAD) != (style in BROAD) and line_type(was).pattern == line_type(style).pattern else "type"
            planted[kind] += 1
            found_of[kind] += number in said
            if number not in said:
                print(f"  missed: {name} {n} {number} {by_number[number].kind} {was} drawn as {style}, "
                      f"{by_number[number].length:.0f} mm")
        total += sum(e.style in STYLES for e in exact)
        for number in said.keys() - changed.keys():
            wrong += 1
            e = by_number[number]
            print(f"  false: {name} {n} {number} {e.kind} {e.style} {e.name!r} {e.length:.0f} mm: {said[number]}")
    for kind in planted:
        print(f"{kind:6} {found_of[kind]:4} of {planted[kind]:4} found")
    print(f"{wrong} of {total} elements accused wrongly, {rows} rows, {count} drawings")


if __name__ == "__main__":
    main()
