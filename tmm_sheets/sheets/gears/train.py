"""Views of a train of gears: scheme with the picture of velocities, plan of speeds, table."""

from __future__ import annotations

from math import pi
from operator import mul, truediv
from typing import TYPE_CHECKING, Any

from tmm_sheets.construction.equation import Quantity, equation
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import fitted, size_for
from tmm_sheets.drawing.marks import Box
from tmm_sheets.numbers import number
from tmm_sheets.sheets.components.listed import LARGE, Lines, Table
from tmm_sheets.sheets.gears.gear_marks import ruled_table
from tmm_sheets.sheets.gears.speed_plan import LINKS, POINTS, plan_of_speeds, rows_of_links, rows_of_points
from tmm_sheets.sheets.gears.train_scheme import draw_scheme
from tmm_sheets.words import marked, tr

if TYPE_CHECKING:
    from tmm_sheets.methods.gears.train import Train
    from tmm_sheets.methods.gears.train_steps import Mesh
    from tmm_sheets.project import Project

def scheme(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Axial view, picture of velocities and end view side by side on one main axis, to one scale."""
    draw_scheme(project.train, canvas, box, tr("Scheme of the train, picture of velocities and end view"))


def speeds(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Plan of the speeds of rotation: rays through the pole parallel to the lines of the picture of velocities."""
    plan_of_speeds(project.train, canvas, box)


def table(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Tooth numbers and speeds of all wheels and carriers, and what was given."""
    train = project.train
    plan = train.kinematics
    rows: list[tuple[str, ...]] = [(tr("Link"), "z", "n")]
    for name in train.names:
        teeth = str(int(plan[f"z{name}"].value)) if name in train.data.teeth else "–"
        n = number(float(plan[f"n{name}"].value))
        rows.append((f"{name} — {tr('given')}" if name in train.given else name, teeth, n))
    inner = canvas.title(box, tr("Wheels and speeds of rotation, rpm"))
    end = ruled_table(canvas, Box(box.x0, box.y0 + 7 * len(train.warnings), box.x1, inner.y1), rows, (30.0, 40.0), LARGE)
    for k, text in enumerate(train.warnings):
        said = f"{text[0].upper()}{text[1:]}."
        canvas.put(fitted(said, box.width, 3.5), complex(box.x0, end - 5.5 - 6 * k), 0.0, said)


def sizes(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Pitch diameters and distances of axes in letters and in numbers."""
    lines = dimensions(project)
    left = canvas.title(box, tr("Dimensions of the train, mm"))
    step = min(LARGE, left.height / len(lines))
    canvas.lines(complex(box.x0, left.y1 - 0.8 * step), lines, step, size_for(lines, box.width, 5.0 if step >= 9.0 else 3.5))


def dimensions(project: Project) -> list[str]:
    """Distance of the axes of every stage, half the sum or the difference of its diameters, and diameters of the wheels."""
    train = project.train
    plan = train.kinematics
    m, lines, shown = Quantity("m", float(plan["m"].value)), dict[str, None](), set[Any]()
    for mesh in train.meshes:
        c, p, way = mesh.central, mesh.planet, 1 if mesh.sign > 0 else -1
        z = {name: Quantity(f"z_{{{name}}}", float(plan[f"z{name}"].value)) for name in (c, p)}
        distance = 1e3 * train.distance(mesh)
        if (stage := train.stage(mesh)) not in shown:  # planets that turn together run at one distance
            shown.add(stage)
            lines[equation(lambda m, one, two, way=way: m * (one + way * two) / 2, (m, z[c], z[p]),
                           Quantity(f"a_{{{c}–{p}}}", distance))] = None
        # Where wheels of another sum of teeth run at the same distance they roll on other circles than those of the module.
        rolled = float(train.pitch(mesh).value)
        for name, other in ((c, p), (p, c)):
            size = rolled * z[name].value / z[c].value
            if abs(rolled - m.value * z[c].value) < 1e-9 * rolled:
                said = equation(mul, (m, z[name]), Quantity(f"d_{{{name}}}", size))
            else:
                said = equation(lambda a, own, one, two, way=way: 2 * a * own / (one + way * two),
                                (Quantity("a", distance), z[name], z[c], z[p]), Quantity(f"d_{{w{name}–{other}}}", size))
            lines[said] = None
    return list(lines)


def of_turns(name: str, n: float) -> str:
    """Angular velocity of a link from its speed, rpm."""
    return equation(lambda n: pi * n / 30, [Quantity(f"n_{{{name}}}", n)], Quantity(f"ω_{{{name}}}", n * pi / 30, "rad/s"),
                    in_letters=False)


def mobility_lines(train: Train, ratios: bool = True) -> list[str]:
    """What stands is frame. Passive meshes are none of the formula's: with them it is left out. Planets have no ratio of use."""
    n = {name: float(step.value) for name, step in train.links.items() if not train.stands(name)}
    driving = [train.link(name) for name in train.given if not train.stands(name)]
    planets = {train.link(m.planet) for m in train.meshes if m.carrier}
    links, meshes, lines = len(n), len(train.meshes), list[str]()
    if links - meshes == len(driving):
        lines.append(f"W = 3n − 2p_5 − p_4 = 3·{links} − 2·{links} − {meshes} = {links - meshes}")
    if ratios and len(driving) == 1:
        one = driving[0]
        for name in (name for name in n if name != one and name not in planets and n[name]):
            both = f"{one},{name}" if len(one + name) > 2 else one + name
            speeds = [Quantity(f"n_{{{name}}}", n[name]) for name in (one, name)]
            lines.append(equation(truediv, speeds, Quantity(f"i_{{{both}}}", n[one] / n[name])))
    return lines + [of_turns(name, value) for name, value in n.items()]


def willis(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """The equation of Willis of every mesh, in letters and in numbers; multiplied out, for a planet may rest on its carrier."""
    train = project.train
    lines = [line for m in train.meshes for line in willis_lines(train, m)]
    left = canvas.title(box, tr("Willis equations of the meshes (n in rpm)"))
    step = min(left.height / len(lines), LARGE)
    height = size_for(lines, box.width, 5.0 if step >= 9.0 else 3.5)
    canvas.lines(complex(box.x0, left.y1 - step), lines, step, height)


def willis_lines(train: Train, m: Mesh) -> tuple[str, str]:
    """z_c(n_c - n_H) = -+z_p(n_p - n_H) of a mesh, outer or inner; without a carrier n_H is none."""
    plan = train.kinematics
    c, p, h = m.central, m.planet, m.carrier
    sign = "−" if m.sign > 0 else ""
    # In brackets a number in the equation is what its letter is: with its sign.
    turns = {name: _signed(float(plan[f"n{name}"].value)) for name in (c, p, h) if name}
    teeth = {name: str(train.data.teeth[name]) for name in (c, p)}

    def side(z: dict[str, str], n: dict[str, str], name: str) -> str:
        return f"{z[name]}·({n[name]} − {n[h]})" if h else f"{z[name]}·{n[name]}"

    letters = {name: f"n_{{{name}}}" for name in (c, p, h) if name}
    signs = {name: f"z_{{{name}}}" for name in (c, p)}
    return (f"{c}–{p}:  {side(signs, letters, c)} = {sign}{side(signs, letters, p)}",
            f"{side(teeth, turns, c)} = {sign}{side(teeth, turns, p)}")


def _signed(value: float) -> str:
    text = number(value)
    return f"({text})" if value < 0 else text


points = Table(marked("Velocities of the points"), lambda project, canvas: rows_of_points(project.train, canvas), *POINTS)
"""Points of the picture of velocities: distance from the main axis, segment measured on the picture, velocity."""
links = Table(marked("Speeds of rotation by the plan"), lambda project, canvas: rows_of_links(project.train, canvas),
              LINKS)
"""Links on the plan of the speeds of rotation: segment measured on it, speed."""
mobility = Lines(marked("Mobility and speeds of the links"), lambda project, canvas: mobility_lines(project.train))
"""Degree of freedom by Chebyshev's formula, ratios to the driving link, angular velocities."""
