"""Constructions that lengths and positions come from: geometric synthesis, groups of class III by false positions.

Of the synthesis the dead positions it starts from and the lengths with their derivation; of a group in one position its false
positions, the locus that the third leg cuts, Assur's special point.
"""

from __future__ import annotations

from cmath import phase, rect
from collections.abc import Iterator
from dataclasses import replace
from itertools import islice
from math import asin, atan2, cos, pi, sin, sqrt
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from tmm_sheets.construction.step import Step
from tmm_sheets.drawing import symbols
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box
from tmm_sheets.sheets.border_solver import BorderNode, Figure, fixed, leaf
from tmm_sheets.sheets.components import listed
from tmm_sheets.sheets.linkage import link_marks
from tmm_sheets.sheets.player import PlanFrame, PlayerStage, fit_frame, play, stage
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.mechanism.groups.contexts import SpecialPoint
    from tmm_sheets.mechanism.groups.triad import TriadGroup
    from tmm_sheets.methods.linkage.positions import Positions
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.views import ViewPlace

def figure(project: Project, canvas: Canvas, box: Box) -> None:
    """The mechanism where the pin enters its slot; the locking disc leaves the cross there."""
    found, conditions = project.synthesis, project.variant.synthesis
    assert conditions is not None
    assert conditions.slots is not None
    x, z, roller = found.exact, conditions.slots, float(conditions.roller or 0.0)
    plan = found.plan
    c, b = (complex(plan[name].value) for name in "CB")
    reach = x["l_AB"] + roller
    points = [-reach + 0j, reach * 1j, -reach * 1j, *(c + x["l_BC"] * u for u in (1, 1j, -1j))]
    frame = fit_frame(project, canvas, "synthesis", "μ_l", tr("m/mm"), points, [0j] * len(points), box.inset(6.0, 18.0, 6.0, 32.0))
    canvas.title(box, tr("Geneva cross and crank with its locking disc"), str(frame.scale))
    s, mm = stage(canvas, plan, 0, frame), frame.scale.mm
    pen = s.pen("B", "link", name="cross")
    centre, width, bottom = frame(c), float(mm(roller)), float(mm(x["l_BC"] - x["h"] + roller))
    outer, lock, apart, first = (float(mm(x[name])) for name in ("l_BC", "r_f", "l_AC", "l_AB"))
    slots = [phase(b - c) + 2 * pi * k / z for k in range(z)]
    mouth = asin(width / outer)
    horn = found.horn
    turn = atan2(outer * sin(horn), apart - outer * cos(horn))
    for angle in slots:
        u = rect(1.0, angle)
        for side in (1, -1):
            edge = side * width * 1j * u
            pen.line(centre + bottom * u + edge, centre + sqrt(outer**2 - width**2) * u + edge, "main")
        pen.arc(centre + bottom * u, width, angle + pi / 2, angle + 3 * pi / 2, "main")
        middle = angle + pi / z
        pen.arc(centre, outer, angle + mouth, middle - horn, "main")
        pen.arc(centre, outer, middle + horn, angle + 2 * pi / z - mouth, "main")
        pen.arc(centre + rect(apart, middle), lock, middle + pi - turn, middle + pi + turn, "main")
    _crank(s.pen("A", "link", name="crank"), (frame(0j), frame(b)), lock, pi / 2 - pi / z, min(0.35 * lock, 0.7 * (apart - outer)))
    s.pen("B", "link", name="roller").circle(frame(b), width, "main")
    s.pen("A", "construction", name="way of the pin").circle(frame(0j), first, "thin")
    for name in "AC":
        symbols.hinge(s.pen(name, "symbol"), s.at(name), "main", 1.6)
        s.letters(name, found.called(name), -1 - 0.8j if name == "A" else 1 - 0.8j, gap=2.4)
    s.letters("B", found.called("B"), b / abs(b) * 1j, gap=width + 1.0)
    s.pen("CA", "axis").line(frame(-reach + 0j) - 3.0, centre + outer + 3.0, "centre")
    factor, pivot, slot = 1e3 * frame.scale.mu, frame(0j), rect(1.0, slots[z // 2])
    for end, radius, turn, name in ((pivot, first, 2.4, found.called("l_AB")), (pivot, lock, 3.6, tr("r_{l}")),
                                    (frame(b), width, phase(b) + 0.3, "r_p")):
        pen = s.pen("B", "dimension")
        pen.arrow(end, end + rect(radius, turn), "thin", 2.5)
        pen.label(end + rect(radius, turn), name, rect(1.0, turn), 3.5, 1.0)
    canvas.angle_mark(pivot, 0.0, phase(b), 0.75 * lock, "β")
    canvas.dimension(pivot, centre, -max(first, outer) - 9.0, found.called("l_AC"), factor=factor)
    canvas.dimension(centre + (bottom - width) * slot, centre + outer * slot, 9.0, "h", factor=factor)


def _crank(pen: Canvas, ends: tuple[complex, complex], lock: float, half: float, hollow: float) -> None:
    """Crank with its locking disc, round but for ``half`` to both sides of the pin; its ``hollow``, mm, lets the cross pass."""
    pivot, pin = ends
    u = (pin - pivot) / abs(pin - pivot)
    angle = phase(u)
    pen.arc(pivot, lock, angle + half, angle + 2 * pi - half, "main")
    pen.line(pivot + symbols.HINGE * u, pin, "main")
    for side in (1, -1):
        pen.line(pivot + rect(lock, angle + side * half), pivot + hollow * u, "main")


LINE = 7.0
"""Distance of the lines of formulas, mm."""


def place(project: Project, view: ViewPlace) -> BorderNode | None:
    """The given sizes and what is found from them."""
    return fixed(view.box) if project.variant.synthesis is not None else None


def sizes(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Figure of the dead positions beside the formulas; nothing for a project whose lengths are given.

    ``figure`` is the share of the place's width for the figure.
    """
    if project.variant.synthesis is None:
        return
    share = float(options.get("figure", 0.55 if project.variant.synthesis.kind == "geneva" else 0.4))
    lines = project.synthesis.derivation
    canvas.of = "synthesis"
    left = Box(box.x0, box.y0, box.x0 + share * box.width, box.y1)
    right = Box(left.x1 + 4.0, box.y0, box.x1, box.y1)
    draw = {"quick return": _quick_return, "engine": _engine, "geneva": figure}[project.variant.synthesis.kind]
    draw(project, canvas, left)
    listed.draw_lines(canvas, right, tr("Geometric synthesis"), lines)


def sizes_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[tuple[float, float]]:
    """Places that the figure beside its formulas can do with, mm; none for a project whose lengths are given."""
    if project.variant.synthesis is None:
        return []
    high = 12.0 + LINE * len(project.synthesis.derivation)
    places = ((200.0, 90.0), (180.0, 70.0), (170.0, 60.0))
    if project.variant.synthesis.kind == "geneva":
        places = ((260.0, 130.0), (220.0, 105.0), (190.0, 85.0))
    return [(width, max(high, tall)) for width, tall in places]


def _frame(project: Project, canvas: Canvas, box: Box, points: list[complex], around: tuple[complex, ...]) -> PlanFrame:
    z = [p for p in points for _ in around]
    return fit_frame(project, canvas, "synthesis", "μ_l", tr("m/mm"), z, list(around) * len(points), box)


def _quick_return(project: Project, canvas: Canvas, box: Box) -> None:
    """Rocker in its dead positions, the crank across it."""
    found = project.synthesis
    a, c, b, d = (complex(found.plan[name].value) for name in "ACBD")
    crank = found.exact["l_AB"]
    mirrored = [complex(-p.real, p.imag) for p in (b, d)]
    frame = _frame(project, canvas, box.inset(0, 8.0, 0, 0), [a, c, a + crank, a - crank, b, d, *mirrored], (12, -12, 11j, -9j))
    canvas.text(complex(box.x0, box.y0 + 1.5), str(frame.scale), 3.5)
    right = stage(canvas, found.plan, 0, frame)
    left = stage(canvas, found.plan, 0, replace(frame, turn=pi, mirror=True))
    right.pen("A", "construction", name="B′–B″").circle(frame(a), frame.scale.mm(crank), "thin")
    right.pen("C", "axis").line(frame(c) - 6j, frame(complex(0, max(d.imag, crank))) + 4j, "centre")
    for s, prime in ((right, "′"), (left, "″")):
        for link in ("CD", "AB"):
            symbols.bar(s.pen(link[1], "link", name=f"{link[0]}–{link[1]}{prime}"), map(s.at, link), map(s.at, "ABCD"), "main", 1.0)
        for name, away in (("B", s.at("B") - s.at("A")), ("D", 1j)):
            _hinge(s, name, found.called(name) + prime, away, 1.4)
        u, v = (2.5 * (s.at(end) - s.at("B")) / abs(s.at(end) - s.at("B")) for end in "CA")  # a right angle
        s.pen("B", "symbol").polyline((s.at("B") + u, s.at("B") + u + v, s.at("B") + v), "thin")
    symbols.pivot(canvas, frame(c))
    symbols.hinge(canvas, frame(a), "main", 1.0)
    for name in "AC":
        canvas.label(right.at(name), found.called(name), -1 + 0.5j, 3.5, 2.8)
    half, radius = float(found.plan["θ"].value) / 2, min(0.45 * frame.scale.mm(found.exact["l_AC"]), 22.0)
    canvas.angle_mark(frame(c), pi / 2 - half, pi / 2 + half, radius, "θ")
    canvas.dimension(left.at("D"), right.at("D"), 5.0, "H", factor=1e3 * frame.scale.mu)


def _hinge(s: PlayerStage, name: str, letters: str, away: complex, gap: float) -> None:
    """A small hinge at a point with its letters."""
    symbols.hinge(s.pen(name, "symbol"), s.at(name), "main", 1.0)
    s.letters(name, letters, away, gap=gap)


def _engine(project: Project, canvas: Canvas, box: Box) -> None:
    """Crank and rod in both dead positions, along the longer side of the place."""
    found = project.synthesis
    turn = -1j if box.width > box.height else 1.0
    crank = found.lengths["l_AB"]
    pins = ("B′", "C′", "B″", "C″")
    points = [0j, *(turn * complex(found.plan[name].value) for name in pins)]
    frame = _frame(project, canvas, box, [*points, *(crank * u for u in (1, -1, 1j, -1j))], (10, -10, 9j, -9j))
    canvas.text(complex(box.x0, box.y1 - 5.0), str(frame.scale), 3.5)
    s = stage(canvas, found.plan, 0, replace(frame, turn=float(np.angle(turn))))
    s.pen("A", "construction", name="B′–B″").circle(frame(0j), frame.scale.mm(crank), "thin")
    axis = turn * 1j
    s.pen("AC", "axis").line(s.at("B″") - 4 * axis, s.at("C′") + 9 * axis, "centre")
    for prime in "′″":
        for link, hinges in ((("A", f"B{prime}"), (*pins, "A")), ((f"B{prime}", f"C{prime}"), pins)):
            symbols.bar(s.pen(link[1], "link", *link), map(s.at, link), map(s.at, hinges), "main", 1.0)
        symbols.block(s.pen(f"C{prime}", "symbol"), s.at(f"C{prime}"), axis, "main", (7.0, 4.2))
        for name in (f"B{prime}", f"C{prime}"):
            _hinge(s, name, found.called(name), axis * -1j, 2.8)
    symbols.pivot(canvas, frame(0j))
    canvas.label(frame(0j), found.called("A"), -1 + 1j, 3.5, 2.8)
    canvas.dimension(s.at("C″"), s.at("C′"), 8.0 if turn == -1j else -8.0, "H", factor=1e3 * frame.scale.mu)


AROUND = (6.0, 10.0, 6.0, 24.0)
"""Room round the group at its left, below, right and above (title and scale factor), mm."""
NEAR = 1.6
"""A special point so many sizes of the group away from its middle is not drawn, but told."""


def triads(project: Project) -> list[TriadGroup]:
    """Groups of class III, in order of attachment."""
    return [cast("TriadGroup", g) for g in project.mechanism.groups if g.kind.grade == 3]


def _triad(project: Project, options: dict[str, Any]) -> TriadGroup | None:
    """The one that a view shows: option ``group`` counts those of class III from 1."""
    return next(islice(triads(project), int(options.get("group", 1)) - 1, None), None)


def group_place(project: Project, view: ViewPlace) -> BorderNode | None:
    """A group of class III by false positions."""
    g = _triad(project, view.options)
    return None if g is None else leaf(view.box, _figure(project, g).need(view.box, (110.0, 90.0)))


def group(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """False positions of a group of class III at the position of the force analysis; ``group`` counts those of class III from 1."""
    if (g := _triad(project, options)) is None:
        return
    pos, k = project.study.positions, project.force_index
    special = pos.special[g.kind.about(g)]
    frame = _figure(project, g).frame(project, canvas, box)
    canvas.title(box, tr("False positions of group {name} (position {label})").format(
        name=g.name, label=project.cycle.labels[k]), str(frame.scale))
    s = stage(canvas, pos.plan, k, frame)
    there = [steps for steps in g.false_points(pos.false[g.name]) if not any(np.isnan(step.at(k)) for step in steps)]
    false = stage(canvas, pos.false[g.name], k, frame)
    play(false, cut=2.0)
    for n, steps in enumerate(there, 1):
        false.dot(steps[2], 0.5, "thin")
        for step in (steps[0], steps[2]):  # where leg 1 is put, and the point of the locus that follows
            false.letters(step, str(n), false.at(step) - s.at(special.step), 2.5, 0.8)
    third = g.legs[2]
    play(s, [pos.points[third.corner]], "thin", cut=16.0)
    _locus(false, there, pos.points[third.corner])
    link_marks.draw_guides(s, pos, g.links)
    link_marks.draw(s, pos, "main", g.links)
    if _is_near(pos, g, k):
        _normals(s, pos, special)
    else:
        at = s.value(special.step)
        canvas.note(box, tr("{point} lies off the sheet").format(point=link_marks.indexed(special.name)) if np.isfinite(at) else "")
    drawn = [shape for shape in link_marks.shapes(pos) if shape.link in g.links]
    for name in dict.fromkeys(n for shape in drawn for n in (*shape.bar, shape.block or "") if n):
        s.letters(name, link_marks.indexed(name), 1 - 0.5j if name in pos.mechanism.fixed else 0j, gap=symbols.HINGE + 1.2)
    link_marks.number_links(s, pos, g.links, 0.4)


def _locus(s: PlayerStage, there: list[tuple[Step, ...]], found: Step) -> None:
    """Smooth curve through the points of the locus, the true one among them."""
    half = len(there) // 2
    z = [s.at(steps[2]) for steps in there]
    if len(z) != 6:
        return
    nodes = np.array([-3, -2, -1, 0, 1, 2, 3], dtype=float)
    values = np.array([*z[:half], s.at(found), *z[half:]])
    t = np.linspace(-3, 3, 97)
    weights = [np.prod([(t - m) / (n - m) for m in nodes if m != n], axis=0) for n in nodes]
    s.curve(there[-1][2], sum(w * v for w, v in zip(weights, values, strict=True)))


def _normals(s: PlayerStage, pos: Positions, special: SpecialPoint) -> None:
    """Normals of two legs produced to the special point."""
    w = special.step
    for leg in special.pair:
        s.line(w, s.at(pos.points[leg.at]), s.at(w), "thin")
    s.dot(w, 0.9, "main")
    s.letters(w, link_marks.indexed(special.name), gap=1.5)


def _points(pos: Positions, g: TriadGroup) -> Iterator[Step]:
    yield from (pos.points[leg.corner] for leg in g.legs)
    yield from (pos.points[name] for name in g.outer)


def _is_near(pos: Positions, g: TriadGroup, k: int) -> bool:
    """Whether the special point of a group is drawn."""
    z = np.array([step.at(k) for step in _points(pos, g)])
    return bool(abs(pos.special[g.kind.about(g)].step.at(k) - z.mean()) < NEAR * np.abs(z - z.mean()).max())


def _figure(project: Project, g: TriadGroup) -> Figure:
    """Points of the view and what sticks out of them."""
    pos, k = project.study.positions, project.force_index
    special = pos.special[g.kind.about(g)].step
    z = [complex(step.at(k)) for step in _points(pos, g)]
    if _is_near(pos, g, k):
        z.append(complex(special.at(k)))
    z += [complex(step.at(k)) for steps in g.false_points(pos.false[g.name]) for step in steps if step.rule.gives == "point"]
    around = (10.0, -10.0, 8.0j, -10.0j)
    return Figure(f"false-positions-{g.name}", "μ_l", tr("m/mm"), np.repeat(z, len(around)), np.tile(around, len(z)), AROUND)
