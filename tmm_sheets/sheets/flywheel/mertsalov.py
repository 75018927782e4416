"""Views of the flywheel by Mertsalov's procedure: energies, angular velocity, inertia of the second group, tables.

The graphs of the moments and of the works are those of :mod:`.flywheel`; the graphs here stand on the same angle
axis: their option ``axis`` is the x of the ordinate axis, mm of the sheet. The manuals name the quantities differently: the
options ``energies`` (change, second group, first group) and ``inertia`` are the signs on the sheet.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, cast

import numpy as np

from tmm_sheets.construction.equation import Quantity, digits_for, of_step
from tmm_sheets.construction.formula import letters_of
from tmm_sheets.construction.scale import Scale
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.ink import segment_inside
from tmm_sheets.drawing.lettering import letter, size_for
from tmm_sheets.drawing.marks import Box
from tmm_sheets.drawing.text_layout import TOGETHER
from tmm_sheets.numbers import clean, decimals_for, degrees_and_minutes, enough, fixed, number
from tmm_sheets.sheets.components import graphs, listed
from tmm_sheets.sheets.flywheel import flywheel
from tmm_sheets.sheets.linkage.kinetic_frames import flat
from tmm_sheets.sheets.player import PlayerStage, stage
from tmm_sheets.words import marked, tell, tr

if TYPE_CHECKING:
    from tmm_sheets.construction.expression import Floats
    from tmm_sheets.construction.step import Step
    from tmm_sheets.methods.flywheel.wheel_methods import Mertsalov
    from tmm_sheets.project import Project

ENERGIES = ("ΔE", "E_{II}", "E_I")
INERTIA = "J_{II}"
OF_SIXBAR = (marked("E_links"), marked("E_f"), marked("J_links"))
"""Signs that templates/sheets/sixbar_2.toml takes instead."""
NAMED = 3
"""So many terms of the inertia are lettered at their curves; more are numbered, with a legend under the heading."""
LOW = 4.0
"""What stays below would run along the axis, mm."""
LEGEND = 6.0
"""Room of the legend, mm."""


def procedure(project: Project) -> Mertsalov:
    """The flywheel by the crank's energy; CannotBuild for one by another method."""
    return cast("Mertsalov",
                flywheel.by_method(project, "mertsalov", tell("take the arrangement flywheel among the project's sheets")))


def _signs(options: graphs.Options) -> tuple[str, str, str, str]:
    change, second, first = map(tr, options.get("energies", ENERGIES))
    return change, second, first, tr(options.get("inertia", INERTIA))


def column(project: Project, canvas: Canvas, box: Box, options: graphs.Options) -> None:
    """All graphs one under another: moments, works, energies, inertia; each as high as it is, the room left over between them."""
    fw = procedure(project)
    s = fw.scales
    energy = np.concatenate(([0.0], fw.energy_curve(fw.samples), np.imag(fw.first_curve(fw.samples))))
    flywheel.stacked(project, canvas, box, options, "mertsalov.column", [
        *flywheel.of_moments(fw), (energies, float(np.ptp(energy)), 8.0),
        (inertia, float(s.inertia.mm(fw.inertia(fw.samples)).max()) + (LEGEND if len(_terms(fw)[0]) > NAMED else 0.0), 8.0)])


def inertia(project: Project, canvas: Canvas, box: Box, options: graphs.Options) -> None:
    """Reduced moment of inertia of the second group with its terms, read as its energy too; the tangent at the chosen position."""
    fw = procedure(project)
    s = fw.scales
    _, second, _, sign = _signs(options)
    mu_e = Scale(f"μ_{{{flat(second)}}}", float(fw.energy_plan.auxiliaries["μ_T"].value), tr("J/mm"))
    x = s.angle.mm(fw.samples)
    curve = s.inertia.mm(fw.inertia(fw.samples))
    heads = tr("Graphs of {inertia}(φ_1) and {energy}(φ_1)").format(inertia=sign, energy=second), f"{s.inertia}, {mu_e}"
    g = graphs.begin(canvas, box, options, heads, 0.0, float(curve.max()), 8.0, "mertsalov.inertia")
    canvas.of = fw.inertia_plan.name
    of = stage(canvas, fw.inertia_plan, None, g.place())
    doubled = s.inertia.mu * fw.reduced.omega1**2  # the terms are doubled energies
    terms = stage(canvas, fw.reduced.numbered.plan, None, g.place(s.angle.mu, doubled))
    of.curve("points", g(x + 1j * curve))
    parts, low = _terms(fw)
    if low:
        canvas.note(box, tr("Not drawn, lower than {height:g}{space}mm: {terms}").format(
            height=LOW, space=TOGETHER, terms=", ".join(low)))
    for n, (name, step, part) in enumerate(parts, 1):
        terms.curve(step, g(x + 1j * part), "main")
        # A narrow peak is named at its left flank, where there is room.
        k = int(np.argmax(part[: len(part) // 2] > 0.7 * part[: len(part) // 2].max()))
        canvas.label(g(x[k] + 1j * part[k]), name if len(parts) <= NAMED else str(n), -1 if k else 1 - 1j, 3.5)
    if len(parts) > NAMED:
        legend = ";  ".join(f"{n} – {name}" for n, (name, *_) in enumerate(parts, 1))
        beside = options["axis"] + 4.0  # the sign of the axis may reach up to it
        canvas.text(complex((beside + box.x1) / 2, box.y1 - 13.0), legend, size_for([legend], box.x1 - beside, 3.5), "centre")
    flywheel.uprights(of, "points")
    flywheel.axes(fw, of, "points", g, (0.0, float(curve.max())), tr("{quantity}, kg·m^2").format(quantity=sign),
                  np.ones(len(fw.labels)))
    k = int(np.argmax(curve))
    canvas.label(g(x[k] + 1j * curve[k]), sign, 1 + 1j, height=5)
    _tangent(fw, of.position(project.force_index), box, graphs.HEAD + (LEGEND if len(parts) > NAMED else 0.0))


def _terms(fw: Mertsalov) -> tuple[list[tuple[str, Step, Floats]], list[str]]:
    """Terms of the reduced moment of inertia, each with its step and its ordinates at the samples, mm; names of those too low."""
    steps = fw.reduced.numbered.terms
    found = [(f"{name.removesuffix('²')}^2/ω_1^2", steps[name], fw.scales.inertia.mm(values))
             for name, values in fw.reduced.parts(fw.at_samples).items()]
    return [term for term in found if term[2].max() > LOW], [name for name, _, part in found if not part.max() > LOW]


def _tangent(fw: Mertsalov, of: PlayerStage, box: Box, head: float) -> None:
    """Tangent of the graph of inertia at the position of the force analysis, which gives the acceleration of the crank there."""
    step = fw.position_acceleration["ψ"]
    psi = float(of.value(step))
    at, u = of.at("points"), complex(np.cos(psi), np.sin(psi))
    # As long as its place allows: a steep one ends under the heading, its legend too, and above the numbers of the axis.
    low, high = segment_inside(box.inset(2.0, 2.0, 2.0, head), at - 26.0 * u, at + 26.0 * u) or (at, at)
    of.canvas.tracing("construction", step.path, of.label).line(low, high, "axis")
    of.dot("points", 0.7, "main")
    # The vertex of the angle lies on the tangent, away from the curve's own label.
    vertex = at + 0.8 * ((low if psi > 0 else high) - at)
    side = 1 if psi > 0 else -1
    of.canvas.tracing("dimension", step.path, of.label).line(vertex, vertex + side * 20, "thin")
    start, end = (0.0, psi) if psi > 0 else (np.pi + psi, np.pi)
    if abs(psi) > 0.02:
        of.canvas.angle_mark(vertex, start, end, 16.0, f"ψ = {degrees_and_minutes(psi)}")


def energies(project: Project, canvas: Canvas, box: Box, options: graphs.Options) -> None:
    """Change of kinetic energy, the second group's energy laid off below it, the first group's curve with the segment ab.

    The same curve measured from the axis through the middle of ab is the angular velocity of the crank.
    """
    fw = procedure(project)
    s, plan = fw.scales, fw.energy_plan
    change, second, first, _ = _signs(options)
    omega = Scale(fw.speed_scale.symbol, float(f"{fw.speed_scale.mu:.4g}"), fw.speed_scale.unit)
    ratio = s.work.mu / s.energy.mu
    against = "" if abs(ratio - 1) < 1e-9 else f" (μ_A/{number(ratio)})" if ratio > 1 else f" ({number(1 / ratio)}μ_A)"
    title = tr("Graphs of {change}(φ_1), {first}(φ_1), ω_1(φ_1)").format(change=change, first=first)
    x = s.angle.mm(fw.samples)
    total, own = fw.energy_curve(fw.samples), np.imag(fw.first_curve(fw.samples))
    low, high = min(0.0, float(own.min())), max(0.0, float(total.max()), float(own.max()))
    g = graphs.begin(canvas, box, options, (title, f"{s.energy}{against}, {omega}"), low, high, 8.0, "mertsalov.energies")
    canvas.of = fw.total_plan.name
    sums, of, speed = (stage(canvas, p, None, g.place()) for p in (fw.total_plan, plan, fw.speed_plan))
    sums.curve("points", g(x + 1j * total))
    canvas.of = plan.name
    of.curve("points", g(x + 1j * own))
    points, upper = plan["points"].value, fw.total_plan["ΔE"].value
    for p, top, label in zip(points, upper, fw.labels, strict=True):
        below, above = (g(complex(p.real, f(0.0, p.imag, top))) for f in (min, max))
        canvas.tracing("construction", plan["T_I"].path, label).line(below, above, "thin")
    flywheel.axes(fw, of, "points", g, (low, high), tr("{quantity}, J").format(quantity=f"{change}, {first}"),
                  np.where(upper > 1e-6, 1.0, -1.0))
    for name, end in (("max", "a"), ("min", "b")):
        # The tangent runs on beyond the point where it touches.
        of.line(f"M_{name}", of.at(end), of.at(f"M_{name}") + 10)
        of.dot(f"M_{name}", 0.7, "main")
        of.letters(end, end, -1 + (1j if end == "a" else -1j), 5)
    of.pen("ab", "dimension").dimension(of.at("b"), of.at("a"), 9.0, f"|ab| = {fixed(fw.ab_mm, 2)}")
    axis, length, pen = speed.at("O"), s.angle.mm(fw.reduced.period), speed.pen("O", "axis")
    pen.line(axis - 5, axis + length + graphs.OVER, "centre")
    pen.label(axis + length - 10, tr("ω_{1m}"), 1j, height=3.5)
    for values, steepness, sign, away in ((total, total, change, 1 + 1j), (own, np.abs(np.gradient(own)), f"{first}, ω_1", 1 - 1j)):
        k = int(np.argmax(steepness))
        canvas.label(g(x[k] + 1j * values[k]), sign, away, height=5)
    k = int(np.argmax(fw.energy_plan["T_II"].value[1:])) + 1
    if fw.energy_plan["T_II"].value[k]:
        canvas.label(g(complex(points[k].real, (points[k].imag + upper[k]) / 2)), second, 1, height=3.5)


def _found(project: Project, options: graphs.Options) -> tuple[str, listed.Rows]:
    """What was found at every position: moment, work, energies, inertia, angular velocity and acceleration of the crank."""
    fw = procedure(project)
    varying, _ = flywheel.indices(fw)
    change, second, first, sign = _signs(options)
    columns: list[tuple[str, str, *tuple[object, ...]]] = [
        (tr("M_{index}^{{red}}").format(index=varying), tr("N·m"), fw.M_reduced), (f"A_{varying}", tr("J"), fw.work),
        (change, tr("J"), fw.delta_E), (sign, tr("kg·m^2"), fw.J_reduced), (second, tr("J"), fw.T_second),
        (first, tr("J"), fw.T_first),
        ("y_ω", tr("mm"), fw.speed_plan["y"].value),
        ("ω_1", tr("rad/s"), fw.omega, 5),  # it hardly changes: a digit more shows it
        ("ε_1", tr("rad/s^2"), fw.position_acceleration["ε1"].value),
    ]
    heads, *rows = graphs.rows(enumerate(fw.labels), [(name, *numbers) for name, _, *numbers in columns])
    return tr("Results by positions"), [heads, ["", *(unit for _, unit, *_ in columns)], *rows]


position_table = listed.Upright(_found)
"""The table of these results."""


def results(project: Project, canvas: Canvas, box: Box, options: graphs.Options) -> None:
    """Formulas with their numbers: segment, moment of inertia, scale factor and check of omega, acceleration, motor, sizes."""
    fw, k = procedure(project), project.force_index
    plan, varying, sign = fw.position_acceleration, flywheel.indices(fw)[0], _signs(options)[3]
    names = {"M_пр": tr("M_{index}^{{red}}").format(index=varying), "J_II": sign, "dJ/dφ": f"d{sign}/dφ"}
    own = flywheel.constant(fw)
    for step in plan:  # what is nothing beside the other positions is nothing
        own[id(step)] = Quantity(names.get(step.name, letters_of(step.symbol or step.name)),
                                 clean(float(step.at(k)), float(np.abs(step.value).max())), step.rule.unit)
    own[id(plan["ψ"])] = Quantity("ψ", float(plan["ψ"].value[k]), "rad")
    moment, inertia, slope, epsilon = (of_step(plan[name], k, own=own) for name in ("M", "J", "dJ/dφ", "ε1"))
    position = f"{tr('Position {label}').format(label=fw.labels[k])}:  ψ = {degrees_and_minutes(float(plan['ψ'].value[k]))}"
    listed.draw_lines(canvas, box, tr("Flywheel design by Mertsalov's method"), [
        _givens(fw), *flywheel.found(fw), *([flywheel.converged(fw)] if fw.given else []), of_step(fw.speed_plan["μ_ω"]),
        *_extremes(fw), f"{position};  {slope}", moment, inertia, epsilon,
        *flywheel.motor(fw), *flywheel.power(fw), *flywheel.frictionless(project), *flywheel.disagreement(fw), *flywheel.sizes(fw)])


def _givens(fw: Mertsalov) -> str:
    """Mean angular velocity, δ or the flywheel that is given, constant moment."""
    said = tr("ω_{{1m}} = {omega} rad/s;  J_f = {flywheel} kg·m^2 (given);  M_{index} = {moment} N·m") if fw.given else \
        tr("ω_{{1m}} = {omega} rad/s;  δ = {delta} (taken);  M_{index} = {moment} N·m") if fw.data.accepted else \
        tr("ω_{{1m}} = {omega} rad/s;  δ = {delta};  M_{index} = {moment} N·m")
    return said.format(omega=fixed(fw.reduced.omega1, 4), delta=number(fw.unevenness), flywheel=number(fw.J_flywheel),
                       index=flywheel.indices(fw)[1], moment=flywheel.constant_moment(fw))


def _extremes(fw: Mertsalov) -> Iterator[str]:
    """Greatest and least angular velocity beside those that are permitted, which they keep to with the flywheel only.

    A given flywheel has to keep to none.
    """
    digits = flywheel.omega_digits(fw.reduced.omega1, [fw.unevenness])
    for name, found, sign in zip(("max", "min"), fw.extremes, "<>", strict=True):
        said = f"ω_{{{name}}} = {fixed(found, digits)}"
        if fw.given:
            yield f"{said} {tr('rad/s')}"
            continue
        bound = fw.speed_plan[f"[ω_{name}]"]
        value = Quantity(f"{said}{';  ' if fw.needed else f' {sign} '}[ω_{{{name}}}]", float(bound.value), "rad/s",
                         digits_for(float(bound.value), digits), digits)
        yield of_step(bound, own={id(bound): value})


def comparison(project: Project, canvas: Canvas, box: Box, options: graphs.Options) -> None:
    """Mertsalov's flywheel beside Wittenbauer's, drawn and exact, each with the exact running of the machine that has it."""
    fw = procedure(project)
    rows = [[tr("Flywheel"), tr("J_I, kg·m^2"), tr("ω_{max}, rad/s"), tr("ω_{min}, rad/s"), "δ"]]
    omega = fw.reduced.omega1
    made = [(c.name, c.first, c.running.fastest, c.running.slowest, c.running.delta) for c in fw.compared]
    if fw.given:
        drawn = ((tr("Mertsalov, construction"), fw.unevenness), (tr("Wittenbauer, construction"), fw.other.unevenness),
                 (tr("Mertsalov, n → ∞"), float(fw.limit_plan["δ∞"].value)))
        made = [(name, fw.J_first, omega * (1 + delta / 2), omega * (1 - delta / 2), delta) for name, delta in drawn] + made
    uneven = [delta for *_, delta in made]
    inertia, digits, places = (decimals_for([first for _, first, *_ in made], 2), flywheel.omega_digits(omega, uneven),
                               decimals_for(uneven, 5))
    rows += [[name, fixed(first, inertia), fixed(fastest, digits), fixed(slowest, digits), fixed(delta, places)]
             for name, first, fastest, slowest, delta in made]
    left = canvas.title(box.inset(0, 0, 0, 2), tr("Comparison of the methods with the exact running"))
    place = listed.table_in(canvas, left, rows, 8.0, [max(letter(line[0], 3.5).width for line in rows) + 3.0], 12.0)
    if fw.given:
        return
    _, _, _, sign = _signs(options)
    text = tr("n → ∞: difference {apart} kg·m^2; theory: ({sign}(φ_{{max}}) + {sign}(φ_{{min}}))/2 = {excess} kg·m^2").format(
        apart=enough(float(fw.comparison_plan["ΔJ"].value), 3, fw.J_first), sign=sign, excess=enough(fw.excess, 3, fw.J_first))
    canvas.text(complex(box.x0, place.y0 - 6.5), text, size_for([text], box.width, 3.5))
