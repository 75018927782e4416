"""Views for room left beside a train or a reducer: motion relative to the carriers, and whether planets can be put in."""

from __future__ import annotations

from collections.abc import Iterator
from functools import reduce
from itertools import combinations
from math import gcd, pi, prod, sin
from operator import mul
from typing import TYPE_CHECKING

from tmm_sheets.construction.equation import Quantity, equation
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.numbers import fixed, is_zero, number
from tmm_sheets.sheets.components.listed import Lines, Table
from tmm_sheets.words import marked, tr

if TYPE_CHECKING:
    from tmm_sheets.methods.gears.train import Train
    from tmm_sheets.methods.gears.train_steps import Mesh
    from tmm_sheets.project import Project

def _motions(project: Project, canvas: Canvas) -> list[list[str]]:
    """Speeds of the wheels of every carrier as they are, and as one sees them who turns with it (Willis)."""
    rows = [[tr("Link"), tr("n, rpm"), f"n − n_H, {tr('rpm')}", f"ω, {tr('rad/s')}"]]
    found = list(_inverted(project))
    several = len({carrier for carrier, *_ in found}) > 1
    for carrier, name, n, n_carrier in found:
        rows.append([f"{name} ({carrier})" if several else name, number(n), number(n - n_carrier), number(n * pi / 30, 5)])
    return rows


inverted = Table(marked("Inverted motion (carrier held)"), _motions, (0.25,) * 4)
"""Speeds of the wheels relative to their carriers; none without a carrier."""


def _inverted(project: Project) -> Iterator[tuple[str, str, float, float]]:
    """Carrier, wheel, its speed and that of the carrier, rpm."""
    train = project.train if project.variant.train is not None else project.reducer
    for carrier in dict.fromkeys(m.carrier for m in train.meshes if m.carrier):
        for name in dict.fromkeys(name for m in train.meshes if m.carrier == carrier for name in (m.central, m.planet)):
            yield carrier, name, float(train.kinematics[f"n{name}"].value), float(train.kinematics[f"n{carrier}"].value)


def _ratios(train: Train) -> Iterator[str]:
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


def at_equal_angles(train: Train, stage: tuple[Mesh, ...]) -> int:
    """So many planets of a stage can be put in at equal angles, no more than the task has."""
    one, *others = stage
    wanted: int = train.data.satellites
    return next(q for q in range(wanted, 0, -1) if all(_parts(train.data.teeth, one, m) % q == 0 for m in others))


def _parts(teeth: dict[str, int], one: Mesh, other: Mesh) -> int:
    """What the number of planets at equal angles has to divide, of two central wheels of one carrier."""
    (a, b), (c, d), sign = (one.central, one.planet), (other.central, other.planet), -1 if one.sign * other.sign > 0 else 1
    return teeth[a] + sign * teeth[c] if b == d else (teeth[a] * teeth[d] + sign * teeth[b] * teeth[c]) // gcd(teeth[b], teeth[d])


def _assembly(teeth: dict[str, int], q: int, one: Mesh, other: Mesh) -> dict[str, str]:
    """The whole number that lets planets stand at equal angles, of two central wheels of one carrier."""
    join = "−" if one.sign * other.sign > 0 else "+"
    (a, b), (c, d) = ((m.central, m.planet) for m in (one, other))
    if b == d:
        letters, numbers = f"(z_{{{a}}} {join} z_{{{c}}})/q", f"({teeth[a]} {join} {teeth[c]})/{q}"
    else:
        divisor = tr("gcd({one}; {two})")
        letters = f"(z_{{{a}}}·z_{{{d}}} {join} z_{{{b}}}·z_{{{c}}})/(q·{divisor.format(one=f'z_{{{b}}}', two=f'z_{{{d}}}')})"
        numbers = f"({teeth[a]}·{teeth[d]} {join} {teeth[b]}·{teeth[c]})/({q}·{divisor.format(one=teeth[b], two=teeth[d])})"
    value = _parts(teeth, one, other) / q
    said = f"{numbers} = {number(value)}"
    if value != int(value):
        said = tr("{number} (not whole: no equal angles)").format(number=said)
    return {"letters": letters, "numbers": said}


checks = Lines(marked("Conditions of the planets"), lambda project, canvas: checks_of(project.train, *project.train.stages))
"""Common axis, assembly and neighbourhood of the planets of every carrier, in letters and in numbers."""
ratios = Lines(marked("Ratios of the inverted motion"), lambda project, canvas: _ratios(project.train))
"""Ratios of central wheels with their carrier held, from the speeds and from the teeth."""
