"""What the force study shows on a sheet and how much room that needs, found from its vectors alone: nothing is drawn for it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.construction.indices import pair_index
from tmm_sheets.construction.scale import handy
from tmm_sheets.construction.step import Segment, Step, symbol
from tmm_sheets.numbers import is_zero
from tmm_sheets.sheets.border_solver import Figure
from tmm_sheets.sheets.linkage import link_marks
from tmm_sheets.sheets.player import extent, needed, once
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.drawing.marks import Points
    from tmm_sheets.mechanism.groups.contexts import ForcePlan, Load
    from tmm_sheets.mechanism.model import OuterReaction, StructuralGroup
    from tmm_sheets.methods.linkage.forces import Kinetostatics
    from tmm_sheets.methods.linkage.positions import Positions
    from tmm_sheets.methods.linkage.zhukovsky import Lever
    from tmm_sheets.project import Project

BAR = "\u0305"
LONG, SHORT = 26.0, 13.0
"""Longest and shortest force arrow on a loaded scheme, mm (schemes show directions, plans show magnitudes)."""
LOW, CUT, GAIN = 40.0, 0.6, 1.2
"""Size of a group on its scheme, mm, below which its arrows are cut to a share if that makes it so many times as large."""
WANTED, SHORTER = 100.0, 0.8
"""Size of its links, mm, below which they are shortened to a share if its standard scale factor becomes so many times finer."""


@dataclass(frozen=True)
class Shown:
    """A force on a scheme: sheet markup, the point in the plan's unit, the vector, N, its step and that of its moment or arm.

    ``on``: the point it acts at wherever the mechanism is, empty if it is found for this position only.
    """

    symbol: str
    at: complex
    vector: complex
    step: Step
    arm: Step
    on: tuple[Step, ...]

    @property
    def whole(self) -> bool:
        """Whether it is no part of a reaction that was split."""
        return "^" not in self.symbol

    @property
    def along(self) -> complex:
        """Unit vector of the force."""
        return self.vector / abs(self.vector)

    def foot(self, about: complex) -> complex:
        """Foot of the perpendicular from a point on the line of action, in the plan's unit."""
        return self.at + float(((about - self.at) * np.conj(self.along)).real) * self.along


@dataclass(frozen=True)
class Couple:
    """A couple on a scheme: sheet markup, the point it is drawn at, N m, its step."""

    symbol: str
    at: complex
    value: float
    step: Step


FAR = 0.75
"""Largest distance of a guide's reaction from its block, in sizes of the mechanism; beyond it a force and a couple are shown."""


@once
def outer_forces(project: Project, g: StructuralGroup, k: int) -> tuple[list[Shown], list[Couple]]:
    """External and inertia forces of a group's links and the reactions of the links outside it."""
    forces = project.study.forces
    about = project.study.positions.place(g.kind.about(g))
    shown = [shown_load(forces, load, about, k) for link in g.links for load in forces.loads[link]
             if load.source not in g.links]
    couples: list[Couple] = []
    for reaction in g.kind.outer_reactions(g):
        if reaction.guide is None:
            shown += _hinge(project, about, reaction, k)
        else:
            force, beside = _guided(project, g.inner or reaction.point, reaction, k)
            shown.append(force)
            couples += beside
    return acting(shown, forces.force_size(k)), couples


def shown_load(forces: Kinetostatics, load: Load, about: Step, k: int) -> Shown:
    """A load as it is shown, its arm about a point."""
    arm = forces.sum_about(about, load.vector) or load.vector
    return Shown(load.symbol, complex(load.at.at(k)), complex(load.vector.at(k)), load.vector, arm, (load.at,))


def _hinge(project: Project, about: Step, reaction: OuterReaction, k: int) -> list[Shown]:
    """Reaction in an outer turning pair, as its normal and tangential parts where the method splits it; arms about a point."""
    study = project.study
    name = pair_index(reaction.link, project.mechanism.owner(reaction.point))
    hinge, step = study.positions.points[reaction.point], study.forces.reactions[f"F{name}"]
    at, on = complex(hinge.at(k)), (hinge,)
    total = complex(step.at(k))
    part = study.forces.parts.get(f"F{name}")
    if part is None:
        return [Shown(f"F̅_{{{name}}}", at, total, step, step, on)]
    tangential = complex(part.at(k))
    return [Shown(f"F̅_{{{name}}}^n", at, total - tangential, step, study.forces.about_special(about) or step, on),
            Shown(f"F̅_{{{name}}}^τ", at, tangential, part, study.forces.sum_about(about, part) or step, on)]


def _guided(project: Project, foot: str, reaction: OuterReaction, k: int) -> tuple[Shown, list[Couple]]:
    """Reaction of a guide at the point of its line, near ``foot``, where it balances the moments about the reaction's point.

    A force and a couple where that point lies off the sheet, or where there is none.
    """
    pos, forces, m = project.study.positions, project.study.forces, project.mechanism
    guide = str(reaction.guide)
    name = pair_index(reaction.link, m.guides[guide].link)
    step, turning = forces.reactions[f"F{name}"], forces.couples[f"F{name}"]
    f, u, couple = complex(step.at(k)), complex(pos.guide_directions[guide].at(k)), float(np.real(turning.at(k)))
    at, origin = (complex(pos.points[p].at(k)) for p in (foot, reaction.point))
    off = ((at - origin) * np.conj(u)).real
    at -= u * off
    across = (np.conj(u) * f).imag
    offset = couple / across if across else 0.0
    acts = not is_zero(f, forces.force_size(k))
    couples = []
    if not is_zero(couple, forces.moment_size(k)) and (not acts or abs(offset) > FAR * _size(pos, k)):
        couples.append(Couple(f"M_{{{name}}}", at, couple, turning))
        offset = 0.0
    on = () if max(abs(off), abs(offset)) > 1e-6 * _size(pos, k) else (pos.points[foot],)
    return Shown(f"F̅_{{{name}}}", at + u * offset, f if acts else 0j, step, forces.arms[f"h{name}"], on), couples


def _size(pos: Positions, k: int) -> float:
    """Largest distance of two points of the mechanism, m."""
    members = [complex(step.at(k)) for step in pos.points.values()]
    return max(abs(a - b) for a in members for b in members)


def acting(shown: Iterable[Shown], force_size: float) -> list[Shown]:
    """Those that are forces at all beside ``force_size``, N."""
    return [s for s in shown if not is_zero(s.vector, force_size)]


def scheme_points(project: Project, g: StructuralGroup, drawn: Iterable[link_marks.Shape]) -> tuple[list[str], list[str]]:
    """Hinges and blocks of a group's links, and their centres of mass that are none of these."""
    own = link_marks.centres(project.mechanism)
    hinges = list(dict.fromkeys(n for shape in drawn for n in (*(n for n in shape.bar if n not in own), shape.block or "") if n))
    centres = (project.mechanism.links[link].centre for link in g.links)
    return hinges, [str(c) for c in centres if c and c not in hinges]


def with_arms(project: Project, g: StructuralGroup, shown: Iterable[Shown]) -> list[Shown]:
    """Forces whose arms the equations of a group's moments take.

    A reaction that is split has none about the point where its leg ends; about a special point its parts have theirs, and the
    reaction of a guide the one that gives it, unless a couple moves it off its block.
    """
    forces, k, about = project.study.forces, project.force_index, project.study.positions.place(g.kind.about(g))
    if (normal := forces.about_special(about)) is None:
        return [force for force in shown if force.whole]
    own = [step for step in forces.arms.values() if not is_zero(float(step.at(k)), _size(project.study.positions, k))]
    guides = list(forces.arms.values())
    return [replace(force, arm=normal) if force.arm in guides else force for force in shown if force.arm not in own]


def _loaded(points: Iterable[complex], shown: list[Shown], about: complex, more: Iterable[tuple[complex, complex]] = (),
            armed: Sequence[Shown] | None = None, share: float = 1.0) -> tuple[Points, Points]:
    """Points with forces and their arms about a point, and what reaches from each on paper, mm; ``more`` are further ones.

    ``armed`` are those whose arms are drawn; all without it.
    """
    every = [(s.at, arrow * (1 + 7.0 / abs(arrow))) for s, arrow in arrows(shown, share)]  # with their labels
    every += [(point, beside) for point in points for beside in (11.0 + 0j, -11.0 + 0j, 8.0j, -11.0j)]  # symbols of pairs
    every += [*[(force.foot(about), 0j) for force in (shown if armed is None else armed)], *more]
    z, d = np.array(every, complex).T
    return z, d


@once
def scheme(project: Project, g: StructuralGroup, k: int, share: float = 1.0) -> Figure:
    """The loaded scheme of a group, its arrows this ``share`` of their usual length, and the forces that crowd along its links."""
    pos = project.study.positions
    shown, _ = outer_forces(project, g, k)
    hinges, centres = scheme_points(project, g, [shape for shape in link_marks.shapes(pos) if shape.link in g.links])
    points = [complex(pos.points[name].at(k)) for name in (*hinges, *dict.fromkeys(centres))]
    links = extent([np.array(points[:len(hinges)])])
    about = complex(pos.place(g.kind.about(g)).at(k))
    free = [(complex(end.at[k]), 0j) for link, ends in link_marks.free_ends(pos).items() if link in g.links for end in ends]
    around = _loaded([*points, *(force.at for force in shown)], shown, about, free, with_arms(project, g, shown), share)
    return Figure(f"scheme-{'-'.join(g.links)}", "μ_l", tr("m/mm"), *around, SCHEME, max(links.width, links.height), len(shown))


@once
def share_of_arrows(project: Project, g: StructuralGroup, k: int, box: Box) -> float:
    """Share of the usual length of the arrows on a group's scheme.

    Whole ones would leave the group nothing of a low place, or cost a small one the next finer scale factor of the series.
    """
    needs, figure, inside = {}, scheme(project, g, k), box.inset(*SCHEME)
    for share in (1.0, SHORTER, CUT):
        some = scheme(project, g, k, share)
        needs[share] = max(needed(some.points.real, some.offsets.real, inside.width),
                           needed(some.points.imag, some.offsets.imag, inside.height))
    if not needs[CUT] > 0:
        return 1.0
    if figure.whole < LOW * needs[1.0] and needs[1.0] > GAIN * needs[CUT]:
        return CUT
    whole, finer = handy(needs[1.0]), handy(needs[SHORTER])
    return SHORTER if figure.size < WANTED * whole and whole > GAIN * finer * (1 - 1e-9) else 1.0


@once
def on_crank(project: Project, k: int) -> list[Shown]:
    """Forces on the initial link, that of the frame the last."""
    forces, c = project.study.forces, project.mechanism.crank
    centre = project.study.positions.points[c.pivot]
    from_frame = pair_index(c.link, project.mechanism.frame)
    step = forces.reactions[f"F{from_frame}"]
    shown = [shown_load(forces, load, centre, k) for load in forces.loads[c.link]]
    return acting([*shown, Shown(f"F̅_{{{from_frame}}}", complex(centre.at(k)), complex(step.at(k)), step, step, (centre,))],
                  forces.force_size(k))


def crank_scheme(project: Project, k: int) -> Figure:
    """The initial link's scheme, the arrows of rotation with their signs about it."""
    c, driver, pos, shown = project.mechanism.crank, project.driver, project.study.positions, on_crank(project, k)
    pivot, ends = complex(pos.points[c.pivot].at(k)), [complex(pos.points[name].at(k)) for name in link_marks.crank_pins(pos)]
    wheel = [] if driver is None or driver.wheel is None else [(pivot + driver.wheel[0] * z, 0j) for z in (1, -1, 1j, -1j)]
    outermost = [couple_radius(n) for n, couple in couples_of(project, c.link) if hinge_of(project, couple) is None]
    turning = (max(outermost, default=10.0 if driver is not None else 24.0) + 8.0) * clear(pivot, ends, shown)
    around = _loaded([pivot, *ends, *(force.at for force in shown)], shown, pivot, [(pivot, turning), *wheel])
    return Figure("scheme-crank", "μ_l", tr("m/mm"), *around, CRANK, finest=max(abs(end - pivot) for end in ends) / LONGEST_CRANK)


@once
def on_lever(project: Project, k: int) -> list[Shown]:
    """Forces hung on Zhukovsky's lever."""
    lv = project.study.lever
    balanced = None if project.driver is not None else lv.hung[-1]
    return acting((Shown(f"F̅_{{{flat(balancing_sign(project))}}}" if h is balanced else h.symbol, complex(h.at.at(k)),
                         complex(h.force.at(k)), h.force, h.arm, (h.at,)) for h in lv.hung), project.study.forces.force_size(k))


def balancing_sign(project: Project) -> str:
    """Sign of what drives the crank: the project's own, in every language as it stands; "Mур" or "Fур" of one without."""
    return link_marks.indexed({"Mур": tr("Mb"), "Fур": tr("Fb")}.get(project.balancing, project.balancing))


def flat(sign: str) -> str:
    """The letters of a sign on one line, as they stand in the index of another."""
    return re.sub("F_|[_{}]", "", sign.replace(BAR, ""))


def arm_sign(sign: str) -> str:
    """Sign of a force's arm: its letters as the index, what stands above them above."""
    letters, _, above = flat(sign).partition("^")
    return f"h_{{{letters}}}" + (f"^{above}" if above else "")


def turned_vectors(lv: Lever) -> list[Segment]:
    """Vectors of the velocity plan that the lever shows: none of a guide's point under a slider that no force hangs on."""
    vel = lv.velocities
    held = {seg.tail.name for seg in vel.plan.segments if seg.head.name in lv.points} | set(lv.points)
    under = [step for step in vel.carried if step.name not in held]
    return [seg for seg in vel.plan.segments if seg.tail not in under and seg.head not in under]


def lever_scheme(project: Project, k: int) -> Figure:
    """The lever with the forces on it."""
    lv, shown = project.study.lever, on_lever(project, k)
    points = [complex(step.at(k)) for step in lv.points.values()]
    # The velocity plan itself, turned: also what no force hangs on.
    turned = [1j * complex(step.at(k)) for seg in turned_vectors(lv) for step in (seg.tail, seg.head)]
    around = _loaded([0j, *points], shown, 0j, [*((force.at, 0j) for force in shown), *((z, 0j) for z in turned)])
    size = extent([np.array(points)])
    return Figure("lever", "μ_V", tr("(m/s)/mm"), *around, LEVER, max(size.width, size.height), len(shown))


def couples_of(project: Project, link: str) -> Iterator[tuple[int, Couple]]:
    """Place in the list of each couple on a link that is not zero, and the couple."""
    k, forces = project.force_index, project.study.forces
    for n, step in enumerate(forces.link_couples.get(link, ())):
        value = float(np.real(step.at(k)))
        if not is_zero(value, forces.moment_size(k)):
            yield n, Couple(symbol(step.symbol or step.name).replace(BAR, ""), 0j, value, step)


def couple_radius(n: int) -> float:
    """Radius of the arrow of the n-th couple on the initial link, mm: beyond those of its rotation and of what balances it."""
    return 34.0 + 10.0 * n


def hinge_of(project: Project, couple: Couple) -> str | None:
    """Hinge that a moment of friction acts in; None for another couple."""
    friction = project.study.forces.friction
    return None if friction is None else friction.hinges.get(couple.step.name)


def arrows(shown: Iterable[Shown], share: float = 1.0) -> list[tuple[Shown, complex]]:
    """Arrow of each force in mm, a ``share`` of its usual length; forces along one ray from one point get different lengths."""
    forces = sorted(shown, key=lambda s: abs(s.vector))
    size = max([abs(a.at - b.at) for a in forces for b in forces], default=0.0)
    found: list[tuple[Shown, complex]] = []
    for s in forces:
        length = share * (SHORT + (LONG - SHORT) * (abs(s.vector) / abs(forces[-1].vector)) ** 0.5)
        for other, arrow in found:
            if abs(other.at - s.at) <= 0.01 * size and abs(s.along - other.along) < 0.2 and length < abs(arrow) + 9.0:
                length = abs(arrow) + 9.0
        found.append((s, length * s.along))
    return found


SCHEME, CRANK, LEVER = (3.0, 5.0, 3.0, 19.0), (3.0, 3.0, 3.0, 19.0), (2.0, 2.0, 2.0, 19.0)
"""Room round loaded schemes, at the left, below, right and above (title and scale factor), mm."""
AROUND = (12.0, 19.0, 12.0, 24.0)
"""Room round a force polygon at its left, below (equation and values), right and above (title and scale factor), mm."""


LONGEST = 220.0
"""Longest side of a force polygon that is of use, mm: what room is left is for others."""
LONGEST_CRANK = 120.0
"""Longest arm of the initial link on its scheme that is of use, mm."""


def finest(fp: ForcePlan, k: int) -> float:
    """Scale factor of a force plan, N/mm, at which its longest side is as long as is of use."""
    return max((abs(complex(head.at(k)) - complex(tail.at(k))) for _, tail, head, _ in fp.sides), default=0.0) / LONGEST


def acting_sides(fp: ForcePlan, k: int, force_size: float) -> list[tuple[str, Step, Step, bool]]:
    """Sides of a force polygon that are forces at all beside ``force_size``, N."""
    return [s for s in fp.sides if not is_zero(complex(s[2].at(k)) - complex(s[1].at(k)), force_size)]


def loaded_plans(project: Project, names: Iterable[str]) -> list[ForcePlan]:
    """The force plans of these names that have a force at the position of the force analysis: one without has no view."""
    k, forces = project.force_index, project.study.forces
    return [forces.plans[name] for name in names if acting_sides(forces.plans[name], k, forces.force_size(k))]


def terms(sides: Iterable[tuple[str, Step, Step, bool]]) -> list[str]:
    """Terms of the vector equation of a force plan."""
    return [f"{sign}({tail.name}–{head.name})" for sign, tail, head, _ in sides]


def polygon(fp: ForcePlan, k: int) -> tuple[dict[str, complex], Box]:
    """Vertices of a force polygon and the rectangle round them, N."""
    points = {n: complex(step.at(k)) for n, step in fp.plan.steps.items() if step.rule.gives == "point"}
    return points, extent([np.array(list(points.values()))])


def clear(pivot: complex, pins: Iterable[complex], shown: Iterable[Shown]) -> complex:
    """Direction from the crank's pivot into the widest angle between its arms, base, forces and their arms."""
    lines = [force.vector if force.at == pivot else force.foot(pivot) - pivot for force in shown]
    return link_marks.widest_gap([*(z - pivot for z in pins), -1j, *lines], 6)
