"""Views of a train of gears and of a reducer: scheme, plan of speeds, tables, equations, motion relative to the carriers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import reduce
from itertools import combinations, pairwise
from math import ceil, pi, prod, sin
from operator import mul, truediv
from typing import TYPE_CHECKING, Any

from tmm_sheets.construction.equation import Quantity, digits_for, equation, of_step
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import fitted
from tmm_sheets.drawing.marks import Box
from tmm_sheets.drawing.text_layout import widened
from tmm_sheets.numbers import fixed, is_zero, number
from tmm_sheets.sheets.border_solver import BorderNode, stepped, table_node
from tmm_sheets.sheets.components.listed import LARGE, Lines, Table, letters_in
from tmm_sheets.sheets.gears.gear_marks import ruled_table, sentence
from tmm_sheets.sheets.gears.train_scheme import (
    LINKS,
    NARROWEST,
    OVER,
    POINTS,
    WIDEST,
    TrainScheme,
    draw_scheme,
    ends_of_rays,
    link_name,
    moving_points,
    plan_of_speeds,
    rows_of_links,
    rows_of_points,
    whole_number,
)
from tmm_sheets.words import marked, tr

if TYPE_CHECKING:
    from tmm_sheets.methods.gears.reducer import Reducer
    from tmm_sheets.methods.gears.train import Train
    from tmm_sheets.methods.gears.train_steps import Mesh
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.views import ViewPlace

def scheme_place(project: Project, view: ViewPlace) -> BorderNode:
    """Axial view, picture of velocities and end view of a train or a reducer."""
    views = TrainScheme(_shown_train(project, view))

    def drawn(width: int, height: int) -> float:
        mu = views.fitted(width, height).mu
        whole = 2 * views.side / mu + views.beside(WIDEST + 24.0)
        return min(width, whole) * min(height, (views.top + views.bottom) / mu + OVER)

    return stepped(view, (views.beside(NARROWEST) + 60.0, 130.0), drawn)


def speeds_place(project: Project, view: ViewPlace) -> BorderNode:
    """A plan of speeds of rotation: rays from a pole to a line."""
    return stepped(view, (150.0, 100.0), lambda width, height: 0.6 * width * min(height, 190))


def table_place(project: Project, view: ViewPlace) -> BorderNode:
    """A table, or lines, under its title with the remarks under them: rows from the least height to the greatest of use."""
    of, head = _shown_train(project, view), 16.0
    match view.draw.partition(".")[2]:
        case "choice":  # tooth sets with the line that says how they were chosen
            rows, head = len(project.reducer.sets) + 1, 24.0
        case "conditions":
            rows = 9 + 2 * bool(project.reducer.simple) + len(of.warnings)
        case "points":
            rows = len(moving_points(of)) + 1
        case "table":
            rows = len(of.names) + 1 + len(of.warnings)
        case "willis":  # two lines for each mesh
            rows = 2 * len(of.meshes)
        case _:
            rows = len(dimensions(project))
    return table_node(rows, head, (6.0, LARGE), (150.0, 190.0))


def _shown_train(project: Project, view: ViewPlace) -> Train:
    """The train or reducer that a view shows."""
    train: Train = getattr(project, view.draw.partition(".")[0])
    return train


def scheme(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Axial view, picture of velocities and end view side by side on one main axis, to one scale."""
    draw_scheme(project.train, canvas, box, tr("Scheme of the train, picture of velocities and end view"))


def speeds(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Plan of the speeds of rotation: rays through the pole parallel to the lines of the picture of velocities."""
    plan_of_speeds(_train(project, canvas), canvas, box)


def table(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Tooth numbers and speeds of all wheels and carriers, and what was given."""
    train = project.train
    plan = train.kinematics
    rows = [(tr("Link"), "z", "n"), *(
        (f"{name} — {tr('given')}" if name in train.given else name,
         str(int(plan[f"z{name}"].value)) if name in train.data.teeth else "–", number(float(plan[f"n{name}"].value)))
        for name in train.names)]
    ruled_table(canvas, canvas.title(box, tr("Wheels and speeds of rotation, rpm")), rows, (30.0, 40.0), LARGE,
                list(map(sentence, train.warnings)))


def dimensions(project: Project) -> list[str]:
    """Distances of the axes and pitch diameters in letters and in numbers."""
    return [of_step(step) for step in project.train.kinematics if step.name[0] in "ad"]


sizes = Lines(marked("Dimensions of the train"), lambda project, canvas: dimensions(project))
"""Pitch diameters and distances of axes in letters and in numbers."""


def of_turns(name: str, n: float) -> str:
    """Angular velocity of a link from its speed, rpm."""
    return equation(lambda n: pi * n / 30, [Quantity(f"n_{{{name}}}", n)], Quantity(f"ω_{{{name}}}", n * pi / 30, "rad/s"),
                    in_letters=False)


def mobility_lines(train: Train) -> list[str]:
    """What stands is frame. Passive meshes are none of the formula's: with them it is left out. Planets have no ratio of use.

    Those of a reducer stand among its equations.
    """
    n = {name: float(step.value) for name, step in train.links.items() if not train.stands(name)}
    driving = [train.link(name) for name in train.given if not train.stands(name)]
    planets = {train.link(m.planet) for m in train.meshes if m.carrier}
    links, meshes, lines = len(n), len(train.meshes), list[str]()
    if links - meshes == len(driving):
        lines.append(f"W = 3n − 2p_5 − p_4 = 3·{links} − 2·{links} − {meshes} = {links - meshes}")
    if train.data.part == "train" and len(driving) == 1:
        one = driving[0]
        for name in (name for name in n if name != one and name not in planets and n[name]):
            both = f"{one},{name}" if len(one + name) > 2 else one + name
            lines.append(equation(truediv, [Quantity(f"n_{{{name}}}", n[name]) for name in (one, name)],
                                  Quantity(f"i_{{{both}}}", n[one] / n[name])))
    return lines + [of_turns(name, value) for name, value in n.items()]


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


willis = Lines(marked("Willis equations of the meshes (n in rpm)"),
               lambda project, canvas: (line for m in project.train.meshes for line in willis_lines(project.train, m)))
"""The equation of Willis of every mesh, in letters and in numbers; multiplied out, for a planet may rest on its carrier."""


def _signed(value: float) -> str:
    text = number(value)
    return f"({text})" if value < 0 else text


points = Table(marked("Velocities of the points"), lambda project, canvas: rows_of_points(_train(project, canvas), canvas),
               *POINTS)
"""Points of the picture of velocities: distance from the main axis, segment measured on the picture, velocity."""
links = Table(marked("Speeds of rotation by the plan"), lambda project, canvas: rows_of_links(_train(project, canvas), canvas),
              LINKS)
"""Links on the plan of the speeds of rotation: segment measured on it, speed."""
mobility = Lines(marked("Mobility and speeds of the links"), lambda project, canvas: mobility_lines(_train(project, canvas)))
"""Degree of freedom by Chebyshev's formula, ratios of a train to its driving link, angular velocities."""


def reducer_scheme(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Axial view, picture of velocities and end view side by side on one main axis, to one scale."""
    draw_scheme(project.reducer, canvas, box, tr("Scheme of the reducer, picture of velocities and end view"))


def choice(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Table of the chosen tooth set and the runners-up."""
    reducer = project.reducer
    names = reducer.teeth_names
    rows = [[tr("No."), *(f"z_{n[1:]}" for n in names), "u", "Δu, %", "η"], *(
        [str(i), *(str(found[z].value) for z in names), fixed(found["u"].value, 3), fixed(found["u_deviation"].value * 100, 2),
         fixed(found["eta"].value, 3)] for i, found in enumerate(reducer.sets, 1))]
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
        rows.append((tr("Pitch diameters {names}, mm").format(names="; ".join(f"d_{{{n}}}" for n in some)),
                     "; ".join(number(float(r.kinematics[f"d{n}"].value)) for n in some)))
    ruled_table(canvas, canvas.title(box, tr("Conditions and results of the reducer")), rows, (84.0,), LARGE,
                list(map(sentence, r.warnings)))


def unsigned(ratio: float) -> str:
    """A ratio without its sign, as a factor of one that has none."""
    return fixed(ratio, 3) if ratio > 0 else f"|{fixed(ratio, 3)}|"


def equation_lines(r: Reducer) -> Iterator[str]:
    """Equations by which the teeth of a reducer were chosen."""
    chosen = {step.name: step for step in r.sets[0]}
    one, *_, four = r.stage_wheels[0]
    mesh = next(m for m in r.meshes if m.central == one)
    enters, leaves = {"sun": (one, "H"), "ring": (four, "H"), "carrier": ("H", one)}[r.driver]
    # Where the carrier drives, the ratio is the reciprocal of a small difference.
    inner = Quantity(f"i_{{{one}{four}}}^{{H}}", chosen["i14"].value, digits=7 if r.driver == "carrier" else 4)
    ratio = Quantity(f"u_{{{enters}{leaves}}}", chosen["u_stage"].value)
    own = {id(chosen["i14"]): inner, id(chosen["u_stage"]): ratio}
    own |= {id(chosen["u_planetary"]): ratio} if r.table.stages == 1 else {}
    whole = [*(["u_planetary"] if r.table.stages > 1 else []), *(["u_simple"] if r.simple else [])]
    yield from (of_step(chosen[name], own=own) for name in ("i14", "u_stage", *whole, *(["u"] if whole else [])))
    yield from checks_of(r, r.stage(mesh))
    n = {name: Quantity(f"n_{{{link_name(name)}}}", float(r.kinematics[f"n{name}"].value), "1/min")
         for name in (one, four, mesh.carrier)}
    yield equation(lambda n, i: n * (1 - i), (n[mesh.carrier], inner), n[one]) if r.driver == "carrier" else \
        equation(truediv, (n[enters], ratio), n[mesh.carrier])
    yield from willis_lines(r, mesh)


of_stage = Lines(marked("The reducer in numbers"), lambda project, canvas: equation_lines(project.reducer))
"""Ratio, conditions and speeds of a planetary stage, and the ratio of the whole reducer."""


def _motions(project: Project, canvas: Canvas) -> list[list[str]]:
    """Speeds of the wheels of every carrier as they are, and as one sees them who turns with it (Willis)."""
    found = list(inverted_speeds(_train(project, canvas)))
    several = len({carrier for carrier, *_ in found}) > 1
    return [[tr("Link"), tr("n, rpm"), f"n − n_H, {tr('rpm')}", f"ω, {tr('rad/s')}"], *(
        [f"{name} ({carrier})" if several else name, number(n), number(n - n_carrier), number(n * pi / 30, 5)]
        for carrier, name, n, n_carrier in found)]


inverted = Table(marked("Inverted motion (carrier held)"), _motions, (0.25,) * 4)
"""Speeds of the wheels relative to their carriers; none without a carrier."""


def inverted_speeds(train: Train) -> Iterator[tuple[str, str, float, float]]:
    """Carrier, wheel, its speed and that of the carrier, rpm."""
    for carrier in dict.fromkeys(m.carrier for m in train.meshes if m.carrier):
        for name in dict.fromkeys(name for m in train.meshes if m.carrier == carrier for name in (m.central, m.planet)):
            yield carrier, name, float(train.kinematics[f"n{name}"].value), float(train.kinematics[f"n{carrier}"].value)


def ratio_steps(train: Train) -> Iterator[str]:
    """Ratios of a train by its teeth: of planetary stages, then of the whole."""
    teeth, plan = train.data.teeth, train.kinematics
    for one, other in ((m, o) for m, o in combinations(train.meshes, 2) if m.carrier and train.stage(m) == train.stage(o)):
        (a, b), (c, d) = ((m.central, m.planet) for m in (one, other))
        n_a, n_c, h = (float(plan[f"n{name}"].value) for name in (a, c, one.carrier))
        if is_zero(n_c - h, max(abs(n_c), abs(h))):
            continue  # both turn as one
        sign = one.sign * other.sign
        ratio = f"i_{{{a}{c}}}^{{{one.carrier}}}"
        speeds = [Quantity(f"n_{{{name}}}", n) for name, n in ((a, n_a), (c, n_c), (one.carrier, h))]
        yield equation(lambda one, other, h: (one - h) / (other - h), speeds, Quantity(ratio, (n_a - h) / (n_c - h)))
        names = (c, a) if b == d else (b, c, a, d)
        value = sign * prod(teeth[name] for name in (b, c)) / prod(teeth[name] for name in (a, d))
        yield equation(lambda *z, sign=sign: sign * reduce(mul, z[:len(z) // 2]) / reduce(mul, z[len(z) // 2:]),
                       [Quantity(f"z_{{{name}}}", teeth[name]) for name in names], Quantity(ratio, value))


def checks_of(train: Train, *stages: tuple[Mesh, ...]) -> Iterator[str]:
    """Lines of the conditions of the planets of some stages."""
    teeth, q, over = train.data.teeth, train.data.satellites, 2 * train.data.addendum
    head = "2" if over == 2 else "2h_a^{*}"
    for meshes in (stage for stage in stages if stage[0].carrier):
        signs = ["+" if m.sign > 0 else "−" for m in meshes]
        sums = [train.teeth(m) for m in meshes]
        letters = [f"z_{{{m.central}}} {sign} z_{{{m.planet}}}" for m, sign in zip(meshes, signs, strict=True)]
        numbers = [f"{teeth[m.central]} {sign} {teeth[m.planet]}" for m, sign in zip(meshes, signs, strict=True)]
        if len(meshes) > 1 and not any(map(train.own_module, meshes)):
            same = len(set(sums)) == 1
            yield tr("Coaxiality: {letters}; {numbers}").format(
                letters=(" = " if same else " ≈ ").join(letters),
                numbers=f"{' = '.join(numbers)} = {sums[0]}" if same else "; ".join(map("{} = {}".format, numbers, sums)))
        if q == 1:
            continue
        for other in meshes[1:]:
            yield tr("Assembly: {letters} = {numbers}").format(**_assembly(teeth, q, meshes[0], other))
        largest = max(range(len(meshes)), key=lambda k: teeth[meshes[k].planet])
        between, width = sums[largest] * sin(pi / q), teeth[meshes[largest].planet] + over
        sign = ">" if between > width else "<"
        yield tr("Neighbourhood: {letters}").format(
            letters=f"({letters[largest]})·sin(180°/q) > z_{{{meshes[largest].planet}}} + {head}")
        yield f"{sums[largest]}·sin(180°/{q}) = {fixed(between, 2)} {sign} {number(width)}"


def _assembly(teeth: dict[str, int], q: int, one: Mesh, other: Mesh) -> dict[str, str]:
    """The whole number that lets planets stand at equal angles, of two central wheels of one carrier."""
    join = "−" if one.sign * other.sign > 0 else "+"
    (a, b), (c, d) = ((m.central, m.planet) for m in (one, other))
    divisor, value = tr("gcd({one}; {two})"), whole_number(teeth, one, other) / q
    letters, numbers = (f"({z[a]} {join} {z[c]})/{count}" if b == d else
                        f"({z[a]}·{z[d]} {join} {z[b]}·{z[c]})/({count}·{divisor.format(one=z[b], two=z[d])})"
                        for z, count in (({name: f"z_{{{name}}}" for name in teeth}, "q"), (teeth, q)))
    said = f"{numbers} = {number(value)}"
    return {"letters": letters, "numbers": said if value == int(value) else
            tr("{number} (not whole: no {count} at equal angles)").format(number=said, count=q)}


checks = Lines(marked("Conditions of the planets"), lambda project, canvas: checks_of(project.train, *project.train.stages))
"""Common axis, assembly and neighbourhood of the planets of every carrier, in letters and in numbers."""
ratios = Lines(marked("Ratios of the inverted motion"), lambda project, canvas: ratio_steps(project.train))
"""Ratios of central wheels with their carrier held, from the speeds and from the teeth."""


MEASURED = 5.0
"""Segment below which no ratio is to be measured, mm."""


def _measured(of: Train, canvas: Canvas) -> Iterator[str]:
    """Ratios from the segments that the sheet has, as they are measured, and from the speeds; of segments that can be measured."""
    plan = of.plans[f"{of.data.part}-speeds"]
    mu = canvas.scales[plan.name]
    ends = [(link_name(step.name), round(float(mu.mm(complex(step.value).real)), 1), float(plan[f"n{step.name}"].value))
            for step in ends_of_rays(plan)]
    (one, length, n), *others = [end for end in ends if abs(end[1]) >= MEASURED] or [("", 0.0, 0.0)]
    for two, other, speed in others:
        sign, ratio = -1 if length * other < 0 else 1, f"{one},{two}"
        segments = [Quantity(f"|0–{name}|", abs(mm), "", digits_for(mm, 1), 1)
                    for name, mm in ((one, length), (two, other))]
        measured = equation(lambda a, b, sign=sign: sign * a / b, segments, Quantity(f"i_{{{ratio}}}", length / other))
        yield f"{measured};  n_{{{one}}}/n_{{{two}}} = {number(n / speed)}"


def meshing_pairs(train: Train) -> Iterator[str]:
    """Ratios of the pairs of wheels with fixed axes, in the order of the drive."""
    teeth, plan = train.data.teeth, train.kinematics
    whole, alone = list[tuple[str, str, int, int, int]](), [m for m in train.meshes if not m.carrier]
    for m in alone:
        # From the driving wheel on: the first pair's is given, of the next ones it sits on the shaft that the one before drives.
        before = {train.link(name) for _, name, *_ in whole[-1:]} or {train.link(name) for name in train.given}
        a, b = (m.planet, m.central) if train.link(m.planet) in before else (m.central, m.planet)
        whole.append((a, b, teeth[a], teeth[b], m.sign))
        n, z = ([Quantity(f"{of}_{{{name}}}", float(plan[f"{of}{name}"].value)) for name in names]
                for of, names in (("n", (a, b)), ("z", (b, a))))
        ratio = Quantity(f"i_{{{a}{b}}}", -m.sign * teeth[b] / teeth[a])
        by_teeth = equation(lambda one, two, sign=-m.sign: sign * one / two, z, replace(ratio, symbol=""))
        yield f"{equation(truediv, n, ratio)};  {by_teeth}"
    chained = all(train.link(one[1]) == train.link(two[0]) for one, two in pairwise(whole))
    if len(whole) > 1 and len(alone) == len(train.meshes) and chained:
        sign = prod(-way for *_, way in whole)
        driving, driven = [pair[2] for pair in whole], [pair[3] for pair in whole]
        letters = "·".join(f"i_{{{one}{two}}}" for one, two, *_ in whole)
        count, result = len(whole), Quantity(f"i_{{{whole[0][0]}{whole[-1][1]}}} = {letters}", sign * prod(driven) / prod(driving))
        yield equation(lambda *z: sign * reduce(mul, z[:count]) / reduce(mul, z[count:]),
                       [Quantity("", z) for z in (*driven, *driving)], result, in_letters=False)


by_plan = Lines(marked("Ratios by the plan of speeds"), lambda project, canvas: _measured(_train(project, canvas), canvas))
"""Ratios of the driving link to the others, from the segments of the plan and from the speeds."""
pairs = Lines(marked("Ratios of the pairs"), lambda project, canvas: meshing_pairs(project.train))
"""Ratio of every pair whose axes stand still, by its speeds and by its teeth; of a train of such pairs that of the whole."""


def _title(project: Project, canvas: Canvas) -> str:
    data = _train(project, canvas).data
    return tr("Wheels without shift, h_a^{{*}} = {addendum}, c^{{*}} = {clearance}").format(
        addendum=number(data.addendum), clearance=number(data.clearance))


def rows(train: Train) -> list[list[str]]:
    """Heading and a row for each wheel; no rows with shifts."""
    head = [tr("Wheel"), "z", *(tr("{symbol}, mm").format(symbol=symbol) for symbol in ("d", "d_a", "d_f"))]
    if any(train.teeth(m) != train.teeth(train.stage(m)[0]) for m in train.meshes):
        return [head]
    found, data = dict[str, list[str]](), train.data
    for m in train.meshes:
        for name, out in ((m.central, m.sign), (m.planet, 1)):
            z, over, module = data.teeth[name], 2 * out, 1e3 * (m.module or data.module)
            d = (z, z + over * data.addendum, z - over * (data.addendum + data.clearance))
            found[name] = [name, str(z), *(number(module * teeth, 5) for teeth in d)]
    return [head, *(found[name] for name in train.wheels)]


def _train(project: Project, canvas: Canvas) -> Train:
    """The train, or the reducer whose scheme stands on the sheet."""
    return project.reducer if project.variant.train is None or "reducer-scheme" in canvas.scales else project.train


wheel_table = Table(_title, lambda project, canvas: rows(_train(project, canvas)), (0.2,) * 5)
"""Every wheel with its tooth number and its pitch, tip and root diameters, mm, as they are without shifts (GOST 16532).

None for a train that needs shifts.
"""
