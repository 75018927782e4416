"""CAD drawings of a sheet as students make them, with errors planted: what is found, what is accused wrongly.

``python -m tests.compare.cad_plants [DRAWINGS] [PROJECT ...]`` draws that many, each in another way (layers, blocks, units, scale,
turn, entities), plants errors of every kind and prints rates.
"""

from __future__ import annotations

import random
import sys
from collections import Counter
from dataclasses import dataclass, replace
from io import StringIO
from math import cos, degrees, pi, radians, sin
from pathlib import Path
from tempfile import TemporaryDirectory

import ezdxf
import numpy as np

from tmm_sheets.catalogue import read
from tmm_sheets.compare.cad import cad_drawing, cad_file, registration
from tmm_sheets.compare.cad.line_fit import lines
from tmm_sheets.compare.cad.registration import register
from tmm_sheets.compare.elements import Element, KnownSheet, elements
from tmm_sheets.compare.placing import Placing
from tmm_sheets.project import Project
from tmm_sheets.sheets.composed import Composed
from tmm_sheets.sheets.sheet import composed

KINDS = ("shift", "end", "turn", "remove", "extra", "text", "radius", "centre", "bump", "reverse", "gap", "long")


@dataclass(frozen=True)
class Way:
    """How a drawing is made: ``turn`` is units of the drawing per mm of the sheet (complex), ``unit`` the $INSUNITS code; ``looks``
    whether lines have types and widths (else all is continuous, of default width).
    """

    turn: complex = 1 + 0j
    shift: complex = 0j
    unit: int = 4
    block: bool = False
    split: float = 0.0
    polylines: float = 0.0
    mirrored: bool = False
    frame: bool = True
    looks: bool = False


PATTERNS = {"centre": "CENTER", "hidden": "DASHED", "twodot": "PHANTOM"}


def look_of(e: Element, place: int) -> dict:
    """Line type and weight of an element, said by itself (0) or by its layer (1)."""
    wide = e.style in ("main", "curve", "vector")
    if place == 1:
        return {"layer": f"{PATTERNS.get(e.style, 'Continuous')}-{'wide' if wide else 'thin'}"}
    return {"linetype": PATTERNS.get(e.style, "Continuous"), "lineweight": 70 if wide else 25}


def some_way(rng: random.Random) -> Way:
    """Units, scale, turn, entities at random."""
    unit, per_mm = rng.choice(((4, 1.0), (6, 1e-3), (1, 1 / 25.4), (0, 1.0), (4, 1.0)))
    scale = rng.choice((1.0, 1.0, 2.0, 0.5, 5.0))
    shift = complex(rng.uniform(-3000, 3000), rng.uniform(-3000, 3000)) * per_mm
    return Way(scale * per_mm * 1j ** rng.choice((0, 0, 1, 2, 3)), shift, unit, rng.random() < 0.3, rng.choice((0.0, 0.3)),
               rng.choice((0.0, 0.5)), False, rng.random() < 0.8)


def draw(found: list[Element], way: Way, rng: random.Random) -> bytes:
    """A DXF file of elements, none of it made by the project's own writer."""
    doc = ezdxf.new("R2010", setup=way.looks)
    doc.header["$INSUNITS"] = way.unit
    names = ("0", "Линии", "тонкие", "Layer3", "Размеры")
    for name in names[1:]:
        doc.layers.add(name, color=rng.randrange(1, 8))
    doc.header["$LTSCALE"] = 4.0 * abs(way.turn)  # strokes of 3.2 and 1.3 units become 13 and 5 mm
    for name in ("Continuous", *PATTERNS.values()) if way.looks else ():
        for suffix, weight in (("wide", 70), ("thin", 25)):
            doc.layers.add(f"{name}-{suffix}", linetype=name, lineweight=weight)
    space = doc.modelspace()
    if way.block:
        space = doc.blocks.new("SHEET")
        doc.modelspace().add_blockref("SHEET", (0, 0))
    place = Placing(way.turn, way.shift, way.mirrored)
    k = abs(way.turn)
    angle = float(np.angle(way.turn))

    def xy(z):
        p = place(complex(z))
        return (p.real, p.imag)

    for e in found:
        if not way.frame and e.view.n == 0:
            continue
        look = {"layer": rng.choice(names)}
        if way.looks:
            look = look_of(e, e.number % 2)
        for f in e.fills:
            points = [xy(z) for z in f]
            if len(points) == 3:
                space.add_solid([points[0], points[1], points[2], points[2]], dxfattribs=look)
            else:
                space.add_hatch(color=7, dxfattribs=look).paths.add_polyline_path(points, is_closed=True)
        if e.kind == "text":
            text = space.add_text(e.text, height=e.height * k, rotation=degrees(e.angle + angle), dxfattribs=look)
            text.set_placement(xy(complex(e.points.mean())), align=ezdxf.enums.TextEntityAlignment.MIDDLE_CENTER)
        elif e.kind == "line":
            line(space, e.points, xy, look, way, rng)
        elif e.kind == "circle" and not e.fills:
            space.add_circle(xy(e.centre), e.radius * k, dxfattribs=look)
        elif e.kind == "arc":
            if rng.random() < way.polylines:
                space.add_lwpolyline([xy(z) for z in e.points], dxfattribs=look)
            else:
                start, end = (degrees(t + angle) for t in ((-e.end, -e.start) if way.mirrored else (e.start, e.end)))
                space.add_arc(xy(e.centre), e.radius * k, start, end, dxfattribs=look)
        elif e.kind == "curve":
            z = e.points[np.concatenate(([True], np.abs(np.diff(e.points)) > 1e-6))]
            d = np.diff(z)
            corners = np.abs(np.angle(d[1:] / d[:-1])).max(initial=0) > 0.25
            if rng.random() < way.polylines and not corners and len(z) > 20:
                space.add_cad_spline_control_frame([xy(p) for p in z], dxfattribs=look)
            else:
                space.add_lwpolyline([xy(z) for z in e.points], dxfattribs=look)
        elif e.kind == "hatch":
            for p in e.pieces:
                space.add_line(xy(p[0]), xy(p[-1]), dxfattribs=look)
    text = StringIO()
    doc.write(text)
    return text.getvalue().encode()


def line(space, points, xy, look, way, rng):
    """A line in one, split in two, or as a polyline."""
    a, b = points
    if rng.random() < way.split and abs(b - a) > 5:
        m = a + rng.uniform(0.2, 0.8) * (b - a)
        space.add_line(xy(a), xy(m), dxfattribs=look)
        space.add_line(xy(b), xy(a + 0.9 * (m - a)), dxfattribs=look)  # they overlap a little
    elif rng.random() < way.polylines:
        space.add_lwpolyline([xy(a), xy(b)], dxfattribs=look)
    else:
        space.add_line(xy(a), xy(b), dxfattribs=look)


# --- errors -----------------------------------------------------------------------------------------------------------


def plant(found: list[Element], kind: str, rng: random.Random, taken: set[int]):
    """The elements with one error more, the number of the wrong one (or the place of what is extra), its size, mm, and the line
    that makes the difference; None when there is nothing of the kind to spoil.
    """
    size = rng.choice((0.8, 1.0, 1.5, 2.0, 3.0, 5.0))
    way = complex(cos(t := rng.uniform(0, 2 * pi)), sin(t))

    def pick(test):
        good = [k for k, e in enumerate(found) if e.view.n and e.number > 0 and e.number not in taken and test(e)]
        return rng.choice(good) if good else None

    if kind == "extra":
        a = complex(rng.uniform(60, 780), rng.uniform(80, 560))
        length = rng.uniform(6, 60)
        e = replace(found[0], number=-1, kind="line", points=np.array([a, a + length * way]), fills=(), marks=(), style="thin",
                    view=next(e.view for e in found if e.view.n))
        return [*found, e], a + length * way / 2, length, e.points
    tests = {
        "shift": lambda e: e.kind == "line" and e.length > 4,
        "end": lambda e: e.kind == "line" and e.length > 12,
        "turn": lambda e: e.kind == "line" and e.length > 15,
        "remove": lambda e: e.kind in ("line", "curve", "arc") and e.length > 5,
        "text": lambda e: e.kind == "text" and len(e.text) > 1 and any(c.isdigit() for c in e.text),
        "radius": lambda e: e.kind == "circle" and not e.fills and e.radius > 4,
        "centre": lambda e: e.kind == "circle" and not e.fills,
        "bump": lambda e: e.kind == "curve" and len(e.points) > 40 and e.length > 40,
        "reverse": lambda e: e.kind == "line" and len(e.fills) == 1 and e.length > 12,
        "gap": lambda e: e.kind == "line" and e.length > 25 and e.style not in ("centre", "hidden", "twodot"),
        "long": lambda e: e.kind == "line" and e.length > 12 and e.style in ("main", "vector", "thin", "curve") and not e.fills,
    }
    k = pick(tests[kind])
    if k is None:
        return None
    e = found[k]
    out = list(found)
    z = changed = e.points
    u = (z[-1] - z[0]) / abs(z[-1] - z[0]) if e.kind == "line" else 1
    if kind == "shift":
        # Aside: along itself a line may run on in another one.
        d = size * (1j * u + 0.3 * u * way.real)
        out[k] = replace(e, points=z + d, fills=tuple(f + d for f in e.fills))
    elif kind == "end":
        d = size * 1j * u if rng.random() < 0.5 else -size * u
        changed = np.array([z[1], z[1] + d]) if abs((d * np.conj(u)).real) > 0.1 else z
        out[k] = replace(e, points=np.array([z[0], z[1] + d]), fills=tuple(f + d for f in e.fills))
    elif kind == "turn":
        turn = np.exp(1j * max(size / e.length, radians(0.3)) * rng.choice((-1, 1)))
        out[k] = replace(e, points=z[0] + (z - z[0]) * turn, fills=tuple(z[0] + (f - z[0]) * turn for f in e.fills))
        size = float(abs(out[k].points[1] - z[1]))
    elif kind == "remove":
        del out[k]
        size = e.length
    elif kind == "text":
        i = rng.choice([i for i, c in enumerate(e.text) if c.isdigit()])
        out[k] = replace(e, text=e.text[:i] + str((int(e.text[i]) + rng.randrange(1, 9)) % 10) + e.text[i + 1:])
    elif kind == "radius":
        size = rng.choice((-1, 1)) * min(size, 0.3 * e.radius)
        out[k] = replace(e, radius=e.radius + size)
        size = abs(size)
    elif kind == "centre":
        size = min(size, 2.5)
        out[k] = replace(e, centre=e.centre + size * way)
    elif kind == "bump":
        t = np.linspace(0, 1, len(z))
        at = rng.uniform(0.2, 0.8)
        d = size * np.exp(-((t - at) / 0.05) ** 2)
        n = 1j * np.gradient(z)
        out[k] = replace(e, points=z + d * n / np.maximum(np.abs(n), 1e-9))
    elif kind == "reverse":
        (f,) = e.fills
        out[k] = replace(e, points=z[::-1], fills=(z[0] + z[-1] - f,))
        size = e.length
    elif kind == "gap":
        size = max(size, 1.5)
        at = rng.uniform(0.3, 0.7) * e.length
        changed = np.array([z[0] + at * u, z[0] + (at + size) * u])
        out[k] = replace(e, points=np.array([z[0], z[0] + at * u]), fills=())
        out.append(replace(e, points=np.array([z[0] + (at + size) * u, z[-1]]), number=-2))
    elif kind == "long":
        size = max(size, 1.5)
        out[k] = replace(e, points=np.array([z[0], z[1] + size * u]))
        changed = np.array([z[1], z[1] + size * u])
    return out, e.number, size, changed


def covered(changed, number, others: list[Element]) -> float:
    """Share of a line over which lines of others lie: nobody can tell whether it is there."""
    near = lines([o.points for o in others if o.number != number and o.kind not in ("text", "fill", "hatch")])
    return near.share(lines([changed]).points(0.5), 0.3)


def compared(data: bytes, sheet, found):
    """What the comparison says of a drawing."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "drawing.dxf"
        path.write_bytes(data)
        ink = cad_file.read(path)
    laid = register([KnownSheet(1, sheet, tuple(found))], ink)
    space = laid.space.placed(laid.placing)
    places = registration.find(found, space)
    return cad_drawing.match(found, space, places.moves, 0.25)


def sheets_of(projects: list[str]) -> list[tuple[str, int, Composed, list[Element]]]:
    """Name, number, sheet and elements of all sheets of some projects."""
    out = []
    for name in projects:
        project = Project(read(name))
        for n in range(1, len(project.variant.sheets) + 1):
            sheet = composed(project, n)
            out.append((name, n, sheet, list(elements(sheet))))
    return out


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    projects = sys.argv[2:] or ["lugansk/shaper", "lugansk/engine", "press", "sixbar/3:1", "transport/diesel@01-Т-27"]
    rng = random.Random(int(count))
    found_of, planted = Counter(), Counter()
    wrong = extra = total = 0
    sheets = sheets_of(projects)
    for run in range(count):
        name, n, sheet, exact = sheets[run % len(sheets)]
        drawn, errors, taken = list(exact), [], set()
        for kind in rng.sample(KINDS, 6):
            made = plant(drawn, kind, rng, taken)
            if made is None:
                continue
            drawn, which, size, changed = made
            if isinstance(which, int):
                taken.add(which)
            errors.append((kind, which, size, changed))
        way = some_way(rng)
        rng.shuffle(drawn)
        outcome = compared(draw(drawn, way, rng), sheet, exact)
        bad = {f.element.number: f for f in outcome.findings if f.verdict in ("amber", "red") and (way.frame or f.element.view.n)}
        explained = set()
        by_number = {e.number: e for e in exact}
        for kind, which, size, changed in errors:
            if isinstance(which, complex):
                hit = any(abs(x.at - which) < 0.5 * size for x in outcome.extras)
                hit = hit or any("long" in f.what and abs(f.at - which) < 40 for f in bad.values())
            else:
                explained.add(which)
                if kind not in ("text", "reverse") and covered(changed, which, exact) > 0.5:
                    continue  # under other lines: it cannot be told
                hit = which in bad or (kind == "long" and any(abs(x.at - changed.mean()) < size for x in outcome.extras))
            planted[kind] += 1
            found_of[kind] += hit
            if not hit:
                print(f"  missed: {name} {n} {kind} {size:.2f} {which} {way}")
        total += len(exact)
        for number, f in bad.items():
            if number not in explained:
                wrong += 1
                print(f"  false: {name} {n} {number} {f.element.kind} {f.element.name!r} {f.what} ({f.verdict})",
                      [x[:3] for x in errors])
        for x in outcome.extras:
            near = any(isinstance(w, complex) and abs(x.at - w) < 40 for _, w, *_ in errors) or any(
                abs(x.at - by_number[w].middle) < max(by_number[w].length, 12) for _, w, *_ in errors if isinstance(w, int))
            if not near and (way.frame or x.at):
                extra += 1
                print(f"  false extra: {name} {n} {x}; planted {[x[:3] for x in errors]}")
    for kind in KINDS:
        if planted[kind]:
            print(f"{kind:8} {found_of[kind]:4} of {planted[kind]:4} found")
    print(f"all      {found_of.total():4} of {planted.total():4} found; {wrong} of {total} elements accused wrongly, "
          f"{extra} extras wrongly; {count} drawings")


if __name__ == "__main__":
    main()
