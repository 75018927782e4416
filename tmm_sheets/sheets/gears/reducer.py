"""Views of the reducer: those of its train, tables of the choice, and what it is counted by in letters and in numbers."""

from __future__ import annotations

from collections.abc import Iterator
from functools import reduce
from math import ceil
from operator import mul, truediv
from typing import TYPE_CHECKING, Any

from tmm_sheets.construction.equation import Quantity, equation
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import fitted
from tmm_sheets.drawing.marks import Box
from tmm_sheets.drawing.text_layout import widened
from tmm_sheets.numbers import fixed, number
from tmm_sheets.sheets.components.listed import LARGE, Lines, Table, letters_in
from tmm_sheets.sheets.gears.gear_marks import ruled_table
from tmm_sheets.sheets.gears.planet_motion import checks_of
from tmm_sheets.sheets.gears.speed_plan import LINKS, POINTS, plan_of_speeds, rows_of_links, rows_of_points
from tmm_sheets.sheets.gears.train import willis_lines
from tmm_sheets.sheets.gears.train_scheme import draw_scheme, link_name
from tmm_sheets.words import marked, tr

if TYPE_CHECKING:
    from tmm_sheets.methods.gears.reducer import Reducer
    from tmm_sheets.project import Project


def scheme(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Axial view, picture of velocities and end view side by side on one main axis, to one scale."""
    draw_scheme(project.reducer, canvas, box, tr("Scheme of the reducer, picture of velocities and end view"))


def speeds(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Plan of the speeds of rotation: rays through the pole parallel to the lines of the picture of velocities."""
    plan_of_speeds(project.reducer, canvas, box)


def choice(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Table of the chosen tooth set and the runners-up."""
    reducer = project.reducer
    names = reducer.teeth_names
    head = [tr("No."), *(f"z_{n[1:]}" for n in names), "u", "Δu, %", "η"]
    rows = [head]
    for i, found in enumerate(reducer.sets):
        rows.append([str(i + 1), *(str(found[z].value) for z in names), fixed(found["u"].value, 3),
                     fixed(found["u_deviation"].value * 100, 2), fixed(found["eta"].value, 3)])
    inner = canvas.title(box, tr("Choice of the tooth numbers (1 is taken)"))
    if len(reducer.sets) > 1:
        by = tr("Chosen by: deviation |Δu| within {tiers} %, then the least height").format(
            tiers=" / ".join(number(100 * t) for t in reducer.tiers))
        laid = fitted(by, box.width, 3.5)
        canvas.put(laid, complex(box.centre.real - laid.width / 2, inner.y1 - 3.5), 0.0, by)
        inner = Box(inner.x0, inner.y0, inner.x1, inner.y1 - 6.0)
    wide = [8.0, *([12.0] * len(names)), 20.0, 20.0, 18.0]
    widths = [w * box.width / sum(wide) for w in wide]
    row, height = letters_in(inner.height / len(rows), widths, rows)
    canvas.table(complex(box.x0, inner.y1), widened(widths, rows, height), rows, row, height)


def conditions(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Split of the ratio, conditions, efficiency, speeds."""
    r = project.reducer
    chosen, held = ({step.name: step.value for step in plan} for plan in (r.sets[0], r.conditions))
    rows: list[tuple[str, ...]] = [
        (tr("Quantity"), tr("Value")),
        (tr("Ratio asked for"), fixed(chosen["u_asked"], 3)),
        *([(tr("Simple stage × planetary part"), f"{fixed(chosen['u_simple'], 3)} × {unsigned(chosen['u_planetary'])}")]
          if "u_simple" in chosen else []),
        (tr("Ratio found; deviation"), f"{fixed(chosen['u'], 3)}; {fixed(chosen['u_deviation'] * 100, 2)} %"),
        (tr("Coaxiality, teeth"), f"{held['coaxiality_left']} = {held['coaxiality_right']}"),
        (tr("Assembly with q = {planets} (whole)").format(planets=held["q"]), number(held["assembly"], 6)),
        (tr("Neighbourhood, modules"), f"{fixed(held['between'], 2)} > {fixed(held['width'], 2)}"),
        (tr("Efficiency: pair; planetary part; whole"), f"{number(chosen['eta_pair'])}; {fixed(chosen['eta_planetary'], 3)}; "
         f"{fixed(chosen['eta'], 3)}"),
    ]
    pair = project.variant.gear
    teeth = [r.data.teeth[name] for name in r.simple]
    if teeth and pair is not None and pair.teeth in ("reducer", tuple(teeth)):
        rows += [(tr("Wheels 1 and 2 of the gear meshing"),
                  tr("{one} (z = {teeth}) and {two} (z = {teeth2})").format(
                      one=r.simple[0], teeth=teeth[0], two=r.simple[1], teeth2=teeth[1]))]
    wheels = r.wheels
    each = ceil(len(wheels) / ceil(len(wheels) / 4))
    for some in (wheels[i:i + each] for i in range(0, len(wheels), each)):
        names = "; ".join(f"d_{{{n}}}" for n in some)
        rows.append((tr("Pitch diameters {names}, mm").format(names=names),
                     "; ".join(number(float(r.kinematics[f"d{n}"].value)) for n in some)))
    inner = canvas.title(box, tr("Conditions and results of the reducer"))
    end = ruled_table(canvas, Box(box.x0, box.y0 + 7 * len(r.warnings), box.x1, inner.y1), rows, (84.0,), LARGE)
    for k, text in enumerate(r.warnings):
        said = f"{text[0].upper()}{text[1:]}."
        canvas.put(fitted(said, box.width, 3.5), complex(box.x0, end - 5.5 - 6 * k), 0.0, said)


points = Table(marked("Velocities of the points"), lambda project, canvas: rows_of_points(project.reducer, canvas), *POINTS)
"""Points of the picture of velocities: distance from the main axis, segment measured on the picture, velocity."""
links = Table(marked("Speeds of rotation by the plan"), lambda project, canvas: rows_of_links(project.reducer, canvas),
              LINKS)
"""Links on the plan of the speeds of rotation: segment measured on it, speed."""


def unsigned(ratio: float) -> str:
    """A ratio without its sign, as a factor of one that has none."""
    return fixed(ratio, 3) if ratio > 0 else f"|{fixed(ratio, 3)}|"


def _lines(r: Reducer) -> Iterator[str]:
    chosen = {step.name: step.value for step in r.sets[0]}
    first, second = r.scheme.signs
    one, *_, four = wheels = r.stage_wheels[0]
    mesh = next(m for m in r.meshes if m.central == one)
    z = [Quantity(f"z_{{{wheels[k]}}}", r.chosen.stage[k]) for k in ((3, 0) if r.scheme.single else (1, 3, 0, 2))]
    # Where the carrier drives, the ratio is the reciprocal of a small difference.
    inner = Quantity(f"i_{{{one}{four}}}^{{H}}", chosen["i14"], digits=7 if r.driver == "carrier" else 4)
    yield equation(lambda *z: first * second * reduce(mul, z[:len(z) // 2]) / reduce(mul, z[len(z) // 2:]), z, inner)
    enters, leaves = {"sun": (one, "H"), "ring": (four, "H"), "carrier": ("H", one)}[r.driver]
    ratio = Quantity(f"u_{{{enters}{leaves}}}", chosen["u_stage"])
    shape: Any = {"sun": lambda i: 1 - i, "ring": lambda i: 1 - 1 / i, "carrier": lambda i: 1 / (1 - i)}[r.driver]
    yield equation(shape, [inner], ratio)
    count, simple = r.table.stages, [Quantity(f"z_{{{name}}}", r.data.teeth[name]) for name in reversed(r.simple)]
    if simple or count > 1:
        yield equation(lambda u, *z: (abs(u) if count == 1 else abs(u) ** count) * (z[0] / z[1] if z else 1), [ratio, *simple],
                       Quantity("u", chosen["u"]))
    yield from checks_of(r, r.stage(mesh))
    n = {name: Quantity(f"n_{{{link_name(name)}}}", float(r.kinematics[f"n{name}"].value), "1/min")
         for name in (one, four, mesh.carrier)}
    if r.driver == "carrier":
        yield equation(lambda n, i: n * (1 - i), (n[mesh.carrier], inner), n[one])
    else:
        yield equation(truediv, (n[enters], ratio), n[mesh.carrier])
    yield from willis_lines(r, mesh)


of_stage = Lines(marked("The reducer in numbers"), lambda project, canvas: _lines(project.reducer))
"""Ratio, conditions and speeds of a planetary stage, and the ratio of the whole reducer."""
