"""Crossings too flat to be drawn: where lines or arcs meet at so small an angle that a pencil cannot find the point.

Nature, not the program, takes these digits away, so the sheet says it beside the view, with the position to take instead. Looked
for are points whose lines cross under less than 30 degrees (condition number 2); told are those that a pencil of 0.25 mm misses by
more than a millimetre, the errors of everything drawn before included. Where no crossing is flat, which one product for each
crossing tells, nothing else is computed.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from math import asin, degrees
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tmm_sheets.construction import condition, rules
from tmm_sheets.numbers import fixed
from tmm_sheets.sheets import composition
from tmm_sheets.sheets.components import graphs
from tmm_sheets.sheets.linkage import kinematic_frames
from tmm_sheets.words import marked, on_paper, reader, tr

if TYPE_CHECKING:
    from tmm_sheets.box import Box
    from tmm_sheets.construction.error import Errors
    from tmm_sheets.construction.scale import Scale
    from tmm_sheets.construction.step import Plan, Step
    from tmm_sheets.drawing.canvas import Canvas
    from tmm_sheets.project import Project

FLAT = 2.0
"""Condition number from which a crossing is looked at: lines under 30 degrees."""
STEEP = 1.5
"""Condition number up to which a position is recommended instead: lines over 40 degrees."""
COARSE = 1.0
"""Error of a point, mm, above which it is told."""
GAIN = 0.8
"""Share of its error up to which another position is better: above it nothing is gained that a pencil shows."""
_KINEMATIC = {"positions": "mu_l", "velocities": "mu_V", "accelerations": "mu_a"}


@dataclass(frozen=True)
class Flat:
    """A crossing that cannot be drawn at some positions, named by their numbers.

    ``worst`` is where it is told: the position of the force analysis if that is among them, the worst else; ``mm`` its error
    there, None where it is no smaller than half of the plan: the pencil does not find it at all. ``angle`` is that between the
    lines, rad, ``sines`` that of the angle at every position. ``better`` is the nearest position of the same stroke where every
    crossing is steep, with this one's error there, None when there is none.
    """

    plan: Plan
    step: Step
    positions: tuple[int, ...]
    worst: int
    mm: float | None
    angle: float
    better: int | None
    better_mm: float
    sines: NDArray[Any]


def find(project: Project, plan: Plan, drawn: Iterable[int], scales: dict[str, Any],
         own: Mapping[int, Scale] = MappingProxyType({})) -> list[Flat]:
    """Crossings of a plan that cannot be drawn at the positions ``drawn``; ``scales`` are those of the plans on the sheet.

    ``own`` are those of the plan at positions that have another.
    """
    places = list(drawn)
    errors: dict[float, Errors] = {}
    found = []
    for name, number in condition.crossings(plan).items():
        steep = np.broadcast_to(number, (len(project.study.labels),))
        if not (steep[places] > FLAT).any():
            continue
        errors = errors or {scale.mu: _errors(project, plan, scales | {plan.name: scale})
                            for scale in (scales[plan.name], *own.values())}
        of = [own.get(i, scales[plan.name]) for i in range(len(steep))]
        with_factor = {mu: np.broadcast_to(some.in_mm(plan[name]), steep.shape) for mu, some in errors.items()}
        mm = np.array([with_factor[scale.mu][i] for i, scale in enumerate(of)])
        bad = tuple(i for i in places if steep[i] > FLAT and not mm[i] <= COARSE)
        if bad:
            sizes = np.nan_to_num(mm, nan=np.inf).tolist()
            worst = max(bad, key=lambda i: (_analysed(project, i), sizes[i]))
            size = kinematic_frames.plan_extent(plan, worst)
            hopeless = not of[worst].real(mm[worst]) < 0.5 * max(size.width, size.height)
            # Lines that meet steeper, but are longer, may gain nothing.
            better = _better(project, worst, [k for k in range(len(mm)) if hopeless or mm[k] < GAIN * mm[worst]])
            found.append(Flat(plan, plan[name], bad, worst, None if hopeless else float(mm[worst]), asin(1 / float(steep[worst])),
                              better, float("nan") if better is None else float(mm[better]), np.nan_to_num(1 / steep)))
    return found


def _drawn(project: Project, i: int) -> int:
    """The position of the first turn that a position repeats; itself in the first."""
    turned = project.cycle.turned
    return next(k for k, _ in project.cycle.drawn if abs(np.exp(1j * turned[k]) - np.exp(1j * turned[i])) < 1e-9)


def _analysed(project: Project, i: int) -> bool:
    """True for the position of the force analysis, in whichever turn."""
    return _drawn(project, i) == _drawn(project, project.force_index)


def _errors(project: Project, plan: Plan, scales: dict[str, Any]) -> Errors:
    """Errors of a plan and of those it was measured on, at the scale factors of the sheets."""
    from tmm_sheets.construction.error import Errors

    study = project.study
    order = list(_KINEMATIC)
    before = {name: getattr(study, name).plan for name in (order if plan.name not in order else order[:order.index(plan.name)])}
    elsewhere = {name for name in before if name not in scales}
    kept = composition.scales(project, elsewhere) if elsewhere else {}
    known = {name: scales[name] if name in scales else kept[_KINEMATIC[name]][0]
             for name in before if name in scales or _KINEMATIC[name] in kept}
    return Errors([*((before[name], scale.mu) for name, scale in known.items()), (plan, scales[plan.name].mu)])


def _better(project: Project, i: int, among: Collection[int]) -> int | None:
    """The nearest of the drawn positions ``among`` some on the same stroke where every crossing is steep, the steeper of two.

    Plans of accelerations and forces cross the same lines as those of velocities.
    """
    study, cycle = project.study, project.cycle
    flattest = condition.of_plans((study.positions.plan, study.velocities.plan), len(study.labels))
    stroke = np.zeros(len(study.labels)) if cycle.strokes is None else cycle.strokes.working(cycle.turned, 1)
    order = [k for k, _ in cycle.drawn]
    at = order.index(_drawn(project, i))

    def away(k: int) -> int:
        n = abs(order.index(k) - at)
        return min(n, len(order) - n)

    return min([k for k in order if k in among and flattest[k] < STEEP and stroke[k] == stroke[i]],
               key=lambda k: (away(k), flattest[k]), default=None)


# --- in words ---------------------------------------------------------------------------------------------------------


def warn(project: Project, canvas: Canvas, box: Box, plan: Plan, drawn: Iterable[int] | None = None,
         own: Mapping[int, Scale] = MappingProxyType({})) -> None:
    """Ask for a note beside a view for every crossing of its plan that cannot be drawn; by default at the analysed position.

    ``own`` are the scale factors of the plan at positions that have another than the usual one.

    The same two links meet in all plans under one angle: the note of the first of them names the others.
    """
    for flat in find(project, plan, [project.force_index] if drawn is None else drawn, canvas.scales, own):
        n = next((n for n, note in enumerate(canvas.notes)
                  if note.about is not None and np.allclose(flat.sines, note.about.sines, atol=1e-6)), None)
        if n is None:
            canvas.note(box, said(project, flat), about=flat)
        else:
            again = likewise(project, flat, _drawn(project, canvas.notes[n].about.worst))
            canvas.notes[n] = replace(canvas.notes[n], text=f"{canvas.notes[n].text}; {again}")


_LIKEWISE = {
    "positions": marked("likewise point {name} ({error})"),
    "velocities": marked("likewise on the velocity polygon point {name} ({error})"),
    "accelerations": marked("likewise on the acceleration polygon point {name} ({error})"),
    "link": marked("likewise on the force polygon of link {links} vertex {name} ({error})"),
    "group": marked("likewise on the force polygon of group {links} vertex {name} ({error})"),
}
"""What is said of a further point that the same lines give."""


def likewise(project: Project, flat: Flat, at: int) -> str:
    """What the note of another plan, told of position ``at``, says of this one, lettering markup."""
    from tmm_sheets.sheets.linkage import link_marks

    kind, links = _kind(project, flat)
    error = tr("not at all") if flat.mm is None else tr("{value} mm").format(value=fixed(flat.mm, 1))
    if _drawn(project, flat.worst) != at:
        error = f"{tr('position {label}').format(label=_labels(project)[flat.worst])}: {error}"
    return tr(_LIKEWISE[kind]).format(name=link_marks.indexed(flat.step.name), links="–".join(links), error=error)


def _kind(project: Project, flat: Flat) -> tuple[str, tuple[str, ...]]:
    """Kind of a plan as it is named, and the links of a force plan."""
    if flat.plan.name in ("positions", "velocities", "accelerations"):
        return flat.plan.name, ()
    links = next(fp.links for fp in project.study.forces.plans.values() if fp.plan is flat.plan)
    return "group" if len(links) > 1 else "link", links


_CANNOT = {
    "line": (marked("At position {at} point {name} cannot be drawn"), marked("At positions {at} point {name} cannot be drawn"),
             marked("At position {at} point {name} cannot be drawn better than to {mm} mm"),
             marked("At positions {at} point {name} cannot be drawn better than to {mm} mm")),
    "arcs": (marked("At position {at} the arcs at point {name} cannot be drawn"),
             marked("At positions {at} the arcs at point {name} cannot be drawn"),
             marked("At position {at} the arcs at point {name} cannot be drawn better than to {mm} mm"),
             marked("At positions {at} the arcs at point {name} cannot be drawn better than to {mm} mm")),
    "velocities": (marked("On the velocity polygon at position {at} point {name} cannot be found"),
                   marked("On the velocity polygon at positions {at} point {name} cannot be found"),
                   marked("On the velocity polygon at position {at} point {name} cannot be found better than to {mm} mm"),
                   marked("On the velocity polygon at positions {at} point {name} cannot be found better than to {mm} mm")),
    "accelerations": (marked("On the acceleration polygon at position {at} point {name} cannot be found"),
                      marked("On the acceleration polygon at positions {at} point {name} cannot be found"),
                      marked("On the acceleration polygon at position {at} point {name} cannot be found better than to {mm} mm"),
                      marked("On the acceleration polygon at positions {at} point {name} cannot be found better than to {mm} mm")),
    "link": (marked("On the force polygon of link {links} at position {at} vertex {name} cannot be found"),
             marked("On the force polygon of link {links} at positions {at} vertex {name} cannot be found"),
             marked("On the force polygon of link {links} at position {at} vertex {name} cannot be found better than to {mm} mm"),
             marked("On the force polygon of link {links} at positions {at} vertex {name} cannot be found better than to {mm} mm")),
    "group": (marked("On the force polygon of group {links} at position {at} vertex {name} cannot be found"),
              marked("On the force polygon of group {links} at positions {at} vertex {name} cannot be found"),
              marked("On the force polygon of group {links} at position {at} vertex {name} cannot be found better than to {mm} mm"),
              marked("On the force polygon of group {links} at positions {at} vertex {name} cannot be found better than to "
                     "{mm} mm")),
}
"""What is said of a point by what it is found with: at one position, at several; the same with its error."""
_MEET = ((marked("the lines meet at {angle}°"), marked("the lines meet at less than {angle}°")),
         (marked("at position {worst} the lines meet at {angle}°"),
          marked("at position {worst} the lines meet at less than {angle}°")))
"""How lines meet, at one position and at the worst of several: at an angle, and at less than can be told."""


def said(project: Project, flat: Flat) -> str:
    """The warning in the language of the paper, lettering markup."""
    from tmm_sheets.sheets.linkage import link_marks

    labels = _labels(project)
    several = len(flat.positions) > 1
    kind, links = _kind(project, flat)
    kind = kind if kind != "positions" else "line" if flat.step.rule is rules.LINE_LINE else "arcs"
    what = tr(_CANNOT[kind][several + 2 * (flat.mm is not None)]).format(
        at=_listed(project, flat.positions), name=link_marks.indexed(flat.step.name), links="–".join(links),
        mm=fixed(flat.mm or 0.0, 1))
    angle = degrees(flat.angle)
    why = tr(_MEET[several][angle < 0.1]).format(worst=labels[flat.worst], angle=fixed(max(angle, 0.1), 0 if angle >= 10 else 1))
    advice = tr("no position of this stroke is better") if flat.better is None else (
        tr("for the force analysis take position {better} ({mm} mm)") if _analysed(project, flat.worst) else
        tr("position {better} is better ({mm} mm)")).format(better=labels[flat.better], mm=fixed(flat.better_mm, 1))
    return f"{what}: {why}; {advice}"


def _labels(project: Project) -> dict[int, str]:
    """What the sheet calls each position: those drawn by all their labels, a repetition of one by its own."""
    return dict(enumerate(project.cycle.labels)) | dict(project.cycle.drawn)


def _listed(project: Project, positions: tuple[int, ...]) -> str:
    """Labels of positions; three and more in a row as 5–7."""
    order = [i for i, _ in project.cycle.drawn]
    labels = {order.index(_drawn(project, i)): project.cycle.labels[i] for i in positions}
    return graphs.in_ranges(labels, list(labels))


def lines(project: Project) -> Iterator[str]:
    """Flat crossings of the position plans in words, for messages: those of velocities cross at the same angles."""
    plan, labels = project.study.positions.plan, _labels(project)
    places = [i for i, _ in project.cycle.drawn]
    if not any((np.broadcast_to(c, (len(labels),))[places] > FLAT).any() for c in condition.crossings(plan).values()):
        return
    kept = composition.scales(project, {"positions"})
    if "mu_l" not in kept:  # no sheet draws it
        return
    for flat in find(project, plan, places, {"positions": kept["mu_l"][0]}):
        with on_paper(reader()):
            told = re.sub("[_{}]", "", said(project, flat))
        yield told
