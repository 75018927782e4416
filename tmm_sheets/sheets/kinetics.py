"""Views of the force study: loaded groups with their force plans, the crank, Zhukovsky's lever, the comparison."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.indices import pair_index
from tmm_sheets.construction.plan import symbol
from tmm_sheets.construction.scale import Scale, times
from tmm_sheets.drawing import symbols
from tmm_sheets.drawing.canvas import Align, Canvas
from tmm_sheets.drawing.marks import Box
from tmm_sheets.drawing.notes import TOGETHER
from tmm_sheets.errors import CannotBuild
from tmm_sheets.numbers import clean, fixed, is_zero, number
from tmm_sheets.sheets import flat_crossings, linkage
from tmm_sheets.sheets.frame import SHORTEST, Frame, extent, fit_frame, joined, pick

if TYPE_CHECKING:
    from tmm_sheets.construction.step import Step
    from tmm_sheets.mechanism.groups.force_plan import ForcePlan
    from tmm_sheets.mechanism.model import StructuralGroup
    from tmm_sheets.methods.linkage.forces import GearForce, Kinetostatics
    from tmm_sheets.methods.linkage.positions import Positions
    from tmm_sheets.project import Project

BAR = "\u0305"
LONG, SHORT = 26.0, 13.0
"""Longest and shortest force arrow on a loaded scheme, mm (schemes show directions, plans show magnitudes)."""


@dataclass(frozen=True)
class Shown:
    """A force on a scheme: sheet markup, the point in the plan's unit, the vector, N."""

    symbol: str
    at: complex
    vector: complex


GAP = 4.0
"""Distance of groups that share a place, mm."""
STACKED = 90.0
"""Height from which on the plans of a group stand one over another, mm; in lower places side by side."""


def groups(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """All Assur groups of a mechanism, the farthest on top, in equal parts of the place.

    ``scheme`` is the share of the width for the loaded schemes, one number or one for each group.
    """
    count = len(project.mechanism.groups)
    if not count:
        return
    shares = options.get("scheme", 0.42)
    height = (box.height - GAP * (count - 1)) / count
    for i in range(count):
        top = box.y1 - i * (height + GAP)
        share = shares[min(i, len(shares) - 1)] if isinstance(shares, list) else shares
        group(project, canvas, Box(box.x0, top - height, box.x1, top), {"group": i + 1, "scheme": share})


def group(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Loaded scheme of one Assur group beside the force plans of its links; ``group`` counts from the farthest.

    ``scheme`` is the scheme's share of the place, ``stacked`` puts it above its plans.
    """
    k, forces = project.force_index, project.study.forces
    m = project.mechanism
    nth = int(options.get("group", 1))
    if not 1 <= nth <= len(m.groups):
        raise CannotBuild(f"the mechanism has no group {nth} to draw, it has {len(m.groups)}",
                          "take an arrangement with the view kinetics.groups, or leave kinetics.group out of it")
    g = tuple(reversed(m.groups))[nth - 1]
    share = float(options.get("scheme", 0.42))
    left = Box(box.x0, box.y0, box.x0 + share * box.width, box.y1)
    right = Box(left.x1 + 6.0, box.y0, box.x1, box.y1)
    if options.get("stacked"):
        left = Box(box.x0, box.y1 - share * box.height, box.x1, box.y1)
        right = Box(box.x0, box.y0, box.x1, left.y0 - 2.0)
    _scheme(project, canvas, left, g, k)
    names = g.kind.force_plans(g)
    if right.height / len(names) < STACKED and len(names) > 1:
        width = (right.width + GAP) / len(names)
        places = [Box(right.x0 + i * width, right.y0, right.x0 + (i + 1) * width - GAP, right.y1) for i in range(len(names))]
    else:
        places = _stacked(right, [forces.plans[name] for name in names], k)
    for name, place in zip(names, places, strict=True):
        _force_plan(project, canvas, place, forces.plans[name], k)


def _stacked(box: Box, plans: list[ForcePlan], k: int) -> list[Box]:
    """Places of force plans one under another: as high as each polygon is when it fills the width, the rest in equal parts."""
    left, below, right, above = AROUND
    width = box.width - left - right
    wanted = []
    for fp in plans:
        real = _polygon(fp, k)[1]
        wanted.append(width * real.height / real.width if real.width > 0 else box.height)
    free = box.height - len(plans) * (below + above)
    spare = (free - sum(wanted)) / len(plans)
    heights = [h + spare for h in wanted] if spare > 0 else [free / len(plans)] * len(plans)
    places, y = [], box.y1
    for h in heights:
        places.append(Box(box.x0, y - h - below - above + 2.0, box.x1, y))
        y -= h + below + above
    return places


@dataclass(frozen=True)
class Couple:
    """A couple on a scheme: sheet markup, the point it is drawn at, N m."""

    symbol: str
    at: complex
    value: float


FAR = 0.75
"""Largest distance of a guide's reaction from its block, in sizes of the mechanism; beyond it a force and a couple are shown."""


def _outer_forces(project: Project, g: StructuralGroup, k: int) -> tuple[list[Shown], list[Couple]]:
    """External and inertia forces of a group's links and the reactions of the links outside it."""
    forces, pos = project.study.forces, project.study.positions
    m = project.mechanism
    shown: list[Shown] = []
    couples: list[Couple] = []
    members = [complex(step.at(k)) for step in pos.points.values()]
    size = max(abs(a - b) for a in members for b in members)
    for link in g.links:
        for load in forces.loads[link]:
            if load.source not in g.links:
                shown.append(Shown(load.symbol, complex(load.at.at(k)), complex(load.vector.at(k))))

    def hinge(link: str, point: str) -> None:
        """Reaction in an outer turning pair, as its normal and tangential parts where the method splits it."""
        name = pair_index(link, m.owner(point))
        at = complex(pos.points[point].at(k))
        total = complex(forces.reactions[f"F{name}"].at(k))
        part = forces.tangential_part(link, point)
        if part is None:
            shown.append(Shown(f"F̅_{{{name}}}", at, total))
            return
        tangential = complex(part.at(k))
        shown.append(Shown(f"F̅_{{{name}}}^n", at, total - tangential))
        shown.append(Shown(f"F̅_{{{name}}}^τ", at, tangential))

    def guided(link: str, guide: str, about: str) -> None:
        """Reaction of a guide, at the point of the guide line where it balances the moments about ``about``."""
        name = pair_index(link, m.guides[guide].link)
        f = complex(forces.reactions[f"F{name}"].at(k))
        u = complex(pos.guide_directions[guide].at(k))
        foot, origin = (complex(pos.points[p].at(k)) for p in (str(g.inner), about))
        couple = float(np.real(forces.couples[f"F{name}"].at(k)))
        across = (np.conj(u) * f).imag
        foot -= u * ((foot - origin) * np.conj(u)).real
        offset = couple / across if across else 0.0
        acts = not is_zero(f, forces.force_size(k))
        if not is_zero(couple, forces.moment_size(k)) and (not acts or abs(offset) > FAR * size):
            # The line of action lies off the sheet, or there is none: the force in the block and the couple of its walls.
            couples.append(Couple(f"M_{{{name}}}", foot, couple))
            offset = 0.0
        shown.append(Shown(f"F̅_{{{name}}}", foot + u * offset, f if acts else 0j))

    for reaction in g.kind.outer_reactions(g):
        if reaction.guide is None:
            hinge(reaction.link, reaction.point)
        else:
            guided(reaction.link, reaction.guide, reaction.point)
    return acting(shown, forces.force_size(k)), couples


def acting(shown: Iterable[Shown], force_size: float) -> list[Shown]:
    """Those that are forces at all beside ``force_size``, N."""
    return [s for s in shown if not is_zero(s.vector, force_size)]


def _scheme(project: Project, canvas: Canvas, box: Box, g: StructuralGroup, k: int) -> None:
    """Loaded scheme of a group: its links, all forces and couples on it, the arms of its moment equations."""
    pos = project.study.positions
    shown, couples = _outer_forces(project, g, k)
    drawn = [s for s in linkage.shapes(pos) if s.link in g.links]
    names = [n for s in drawn for n in (*s.bar, s.block or "") if n]
    centres = [str(c) for c in (project.mechanism.links[link].centre for link in g.links) if c and c not in names]
    names = list(dict.fromkeys((*names, *centres)))
    at = [complex(pos.points[n].at(k)) for n in names] + [s.at for s in shown]
    z, d = _reach(at, shown)
    feet = _feet(complex(pos.points[g.kind.about(g)].at(k)), shown)
    frame = fit_frame(project, canvas, f"scheme-{'-'.join(g.links)}", "μ_l", "м/мм", [*z, *feet], [*d, *(0j for _ in feet)],
                      box.inset(3.0, 5.0, 3.0, 19.0))
    canvas.of = f"group {g.name}"
    canvas.title(box, f"Группа Ассура {g.name} ({g.kind.number}-й вид)", str(frame.scale))
    if g.kind.ram(g) is None:
        linkage.draw_guides(canvas, pos, k, frame, g.links)
    linkage.draw(canvas, pos, k, frame, "main", g.links)
    for name in names:
        away = 1 - 0.5j if name in project.mechanism.fixed else 0j
        canvas.label(frame(complex(pos.points[name].at(k))), linkage.indexed(name), away, 3.5, 2.8)
    _link_numbers(canvas, pos, drawn, k, frame)
    for name in centres:
        symbols.centre_of_mass(canvas, frame(complex(pos.points[name].at(k))))
    _arms(canvas, project, frame, g, k, shown)
    draw_forces(canvas, frame, shown)
    _from_moments(project, canvas, box, g, k, frame.scale)
    for c in couples:
        symbols.rotation_arrow(canvas, frame(c.at), 10.0, -1 - 0.4j, c.value, c.symbol)
    for s in drawn:
        centre = project.mechanism.links[s.link].centre or s.block or s.bar[0]
        for n, sign, value in _couples(project, s.link):
            symbols.rotation_arrow(canvas, frame(complex(pos.points[centre].at(k))), 7.0 + 4.0 * n, -1 + 0.2j, value, sign)


def _link_numbers(canvas: Canvas, pos: Positions, drawn: Iterable[linkage.Shape], k: int, frame: Frame) -> None:
    """Numbers of the links, near the first ends of bars: their middles are left to forces and arms."""
    for s in drawn:
        z = frame(complex(pos.points[s.block or s.bar[-1]].at(k)))
        if s.bar:
            p = linkage.bar_points(pos, s, k)
            a, b = frame(p[0]), frame(p[-1])
            z = a + 0.3 * (b - a)
        canvas.label(z, s.link, 1 + 0.3j, 5.0, 2.0 if s.bar else 6.5)


def _couples(project: Project, link: str) -> Iterator[tuple[int, str, float]]:
    """Place in the list, sheet markup and value (N m) of each couple on a link that is not zero."""
    k, forces = project.force_index, project.study.forces
    for n, couple in enumerate(forces.link_couples.get(link, ())):
        value = float(np.real(couple.at(k)))
        if not is_zero(value, forces.moment_size(k)):
            yield n, symbol(couple.name).replace(BAR, ""), value


def _from_moments(project: Project, canvas: Canvas, box: Box, g: StructuralGroup, k: int, scale: Scale) -> None:
    """What the moment equations of a group gave: tangential parts of its reactions, arms of its outer guides' reactions."""
    forces, m = project.study.forces, project.mechanism
    said = []
    for part in forces.from_moments:
        if part.link in g.links:
            value = newtons(clean(abs(complex(part.vector.at(k))), forces.force_size(k)))
            said.append(f"ΣM_{part.centre} = 0: F_{{{pair_index(part.link, part.source)}}}^τ = {value} Н")
    about = g.kind.about(g)
    for pair in (pair_index(link, m.guides[guide].link) for guide in g.guides for link in g.links):
        arm = forces.arms.get(f"h{pair}")
        length = scale.mm(abs(float(arm.at(k)))) if arm is not None else np.inf
        if 0.05 < length < max(box.width, box.height):
            said.append(f"ΣM_{about} = 0: h_{{{pair}}} = {fixed(length, 1)} мм")
    if said:
        _fitted(canvas, complex(box.x0 + 2.0, box.y0), "; ".join(said), 3.5, box.width - 4.0, "left")


def _arrows(shown: Iterable[Shown]) -> list[tuple[Shown, complex]]:
    """Arrow of each force in mm; forces along one ray from one point get different lengths."""
    forces = [s for s in shown if abs(s.vector) > 0]
    largest = max((abs(s.vector) for s in forces), default=1.0)
    size = max((abs(a.at - b.at) for a in forces for b in forces), default=0.0)
    taken: list[tuple[complex, complex, float]] = []
    found = []
    for s in sorted(forces, key=lambda s: abs(s.vector)):
        u = s.vector / abs(s.vector)
        length = SHORT + (LONG - SHORT) * (abs(s.vector) / largest) ** 0.5
        for at, v, used in taken:
            if abs(at - s.at) <= 0.01 * size and abs(u - v) < 0.2 and length < used + 9.0:
                length = used + 9.0
        taken.append((s.at, u, length))
        found.append((s, length * u))
    return found


def _reach(points: Iterable[complex], shown: Iterable[Shown]) -> tuple[list[complex], list[complex]]:
    """Points and what sticks out of them on paper: arrows with their labels, symbols of pairs."""
    z, d = [], []
    for s, arrow in _arrows(shown):
        z.append(s.at)
        d.append(arrow * (1 + 7.0 / abs(arrow)))
    for p in points:
        z += [p, p, p, p]
        d += [11.0 + 0j, -11.0 + 0j, 8.0j, -11.0j]
    return z, d


def draw_forces(canvas: Canvas, frame: Frame, shown: Iterable[Shown]) -> None:
    """Arrows with their tails at the points they act at."""
    for s, arrow in _arrows(shown):
        tail = frame(s.at)
        canvas.arrow(tail, tail + arrow, "vector")
        u = arrow / abs(arrow)
        canvas.label(tail + arrow - 2.0 * u, s.symbol, u + 0.35j * u, 3.5, 2.0)


def _arms(canvas: Canvas, project: Project, frame: Frame, g: StructuralGroup, k: int, shown: list[Shown]) -> None:
    """Arms of the forces about the point of the moment equations."""
    draw_arms(canvas, frame, complex(project.study.positions.points[g.kind.about(g)].at(k)), shown)


def _foot(s: Shown, about: complex) -> complex:
    """Foot of the perpendicular from a point on the line of action of a force, in the plan's unit."""
    u = s.vector / abs(s.vector)
    return s.at + float(((about - s.at) * np.conj(u)).real) * u


def _feet(about: complex, shown: Iterable[Shown]) -> list[complex]:
    """Feet of the arms that are drawn about a point, in the plan's unit."""
    return [_foot(s, about) for s in shown if abs(s.vector) > 0 and "^" not in s.symbol]


def draw_arms(canvas: Canvas, frame: Frame, about: complex, shown: Iterable[Shown], prefix: str = "h",
              points: Iterable[complex] = ()) -> None:
    """Perpendiculars from a point to the lines of action; equal arms once. Their signs keep clear of ``points``, mm."""
    shown = [s for s in shown if abs(s.vector) > 0]
    seen: list[complex] = []
    centre = frame(about)
    busy = [centre, *points, *(frame(s.at) for s in shown), *(frame(_foot(s, about)) for s in shown)]
    for s in sorted(shown, key=lambda s: -abs(s.vector)):  # forces on one line share the arm of the largest
        u = s.vector / abs(s.vector)
        tail = frame(s.at)
        foot = tail + ((centre - tail) * np.conj(u)).real * u
        if abs(foot - centre) < 1.5 or "^" in s.symbol:
            continue
        if any(abs(foot - f) < 0.6 for f in seen):
            continue
        seen.append(foot)
        if abs(foot - tail) > 0.5:
            canvas.line(tail, foot + 2.0 * (foot - tail) / abs(foot - tail), "thin")
        canvas.line(centre, foot, "thin")
        canvas.dot(foot, 0.35, "thin")
        index = s.symbol.replace(BAR, "").replace("F_", "").replace("_", "").strip("{}").replace("{", "").replace("}", "")
        places = [centre + t * (foot - centre) for t in (0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8)]
        at = max(places, key=lambda z: min(6.0, *(abs(z - q) for q in busy)))
        canvas.label(at, f"{prefix}_{{{index}}}", 1j * (foot - centre), 2.5, 0.8)
        busy.append(at)


AROUND = (12.0, 19.0, 12.0, 24.0)
"""Room round a force polygon at its left, below (equation and values), right and above (title and scale factor), mm."""


def _polygon(fp: ForcePlan, k: int) -> tuple[dict[str, complex], Box]:
    """Vertices of a force polygon and the rectangle round them, N."""
    points = {n: complex(step.at(k)) for n, step in fp.plan.steps.items() if step.rule.gives == "point"}
    return points, extent([np.array(list(points.values()))])


def _force_plan(project: Project, canvas: Canvas, box: Box, fp: ForcePlan, k: int) -> None:
    """Force polygon with numbered vertices, its equation and the values found."""
    points, real = _polygon(fp, k)
    canvas.of = fp.plan.name
    inside = box.inset(*AROUND)
    size = project.study.forces.force_size(k)
    sides = [s for s in fp.sides if not is_zero(complex(s[2].at(k)) - complex(s[1].at(k)), size)]
    if not sides:
        _fitted(canvas, canvas.title(box, fp.plan.title).centre, "В этом положении сил нет", 3.5, box.width - 4.0)
        return
    need = max(real.width / inside.width, real.height / inside.height)
    scale = pick(project, canvas, fp.plan.name, "μ_F", "Н/мм", need)
    frame = Frame(scale, inside.centre - scale.mm(real.centre))
    canvas.title(box, fp.plan.title, str(scale), 5.0)
    flat_crossings.warn(project, canvas, box, fp.plan)
    tiny = _draw_sides(canvas, fp, sides, frame, frame(real.centre), k)
    extra = [seg for seg in fp.plan.segments if not any(seg.symbol == s[0] for s in fp.sides)]
    for seg in extra:
        canvas.arrow(frame(complex(seg.tail.at(k))), frame(complex(seg.head.at(k))), "vector")
        canvas.label(frame((complex(seg.tail.at(k)) + complex(seg.head.at(k))) / 2), seg.symbol, 0j, 3.5, 1.0)
    for names in joined({name: frame(z) for name, z in points.items()}, tiny, 0.5):
        q = frame(points[names[0]])
        canvas.label(q, ", ".join(sorted(names, key=int)), q - frame(real.centre), 2.5, 0.8)
    if tiny:
        canvas.note(box, f"Меньше 1{TOGETHER}мм: {', '.join(tiny.values())}")
    vertex = _vertices(fp)
    terms = [f"{s}({vertex[id(t)]}–{vertex[id(h)]})" for s, t, h, _ in sides]
    _equation(canvas, complex(box.centre.real, box.y0 + 9.5), terms, box.width - 4.0)
    asked = [(s, t, h) for s, t, h, unknown in sides if unknown] + [(seg.symbol, seg.tail, seg.head) for seg in extra]
    found = [f"{s.replace(BAR, '')} = {newtons(clean(abs(complex(h.at(k)) - complex(t.at(k))), size))} Н" for s, t, h in asked]
    _fitted(canvas, complex(box.centre.real, box.y0 + 3.0), "; ".join(found), 3.5, box.width - 4.0)


def _vertices(fp: ForcePlan) -> dict[int, str]:
    """Number of each vertex of a force polygon by its step's identity."""
    return {id(step): n for n, step in fp.plan.steps.items()}


def _draw_sides(canvas: Canvas, fp: ForcePlan, sides: list[tuple[str, Step, Step, bool]], frame: Frame, centre: complex,
                k: int) -> dict[tuple[str, str], str]:
    """Sides of a force polygon with their signs outside it; those too short to be drawn are told by their vertices."""
    vertex, tiny = _vertices(fp), {}
    for sign, tail, head, _ in sides:
        a, b = frame(complex(tail.at(k))), frame(complex(head.at(k)))
        if abs(b - a) < SHORTEST:
            value = newtons(frame.scale.real(abs(b - a)))
            tiny[vertex[id(tail)], vertex[id(head)]] = f"{sign} = {value} Н".replace(" ", TOGETHER)
            continue
        canvas.arrow(a, b, "vector")
        middle = (a + b) / 2
        n = 1j * (b - a)
        if (np.conj(n) * (middle - centre)).real < 0:
            n = -n
        canvas.label(middle, sign, n, 3.5, 1.0)
    return tiny


def newtons(force: float) -> str:
    """A force for the sheet: tenths of a newton, small ones with four figures."""
    return fixed(force, 1) if force >= 10 else number(force, 4)


def balancing_sign(project: Project) -> str:
    """Sign of the balancing force or moment in lettering markup, from its name in the project file."""
    name = project.balancing
    return f"{name[0]}_{{{name[1:]}}}" if name[1:] else name


def _equation(canvas: Canvas, at: complex, terms: list[str], width: float) -> None:
    """Vector equation of a force plan; one that would become unreadably small in its width goes on two lines."""
    from tmm_sheets.drawing.lettering import letter

    if letter(" + ".join(terms) + " = 0", 2.5).width > width:
        half = (len(terms) + 1) // 2
        _fitted(canvas, at + 6.0j, " + ".join(terms[:half]) + " +", 3.5, width)
        terms = terms[half:]
    _fitted(canvas, at, " + ".join(terms) + " = 0", 3.5, width)


def _fitted(canvas: Canvas, at: complex, text: str, height: float, width: float, align: Align = "centre") -> None:
    from tmm_sheets.drawing.lettering import letter

    w = letter(text, height).width
    canvas.text(at, text, height if w <= width else max(height * width / w, 2.5), align)


def crank(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """The initial link with its forces and arms beside its force plan."""
    k, study = project.force_index, project.study
    forces, pos, m = study.forces, study.positions, project.mechanism
    c = m.crank
    share = float(options.get("scheme", 0.5))
    left = Box(box.x0, box.y0, box.x0 + share * box.width, box.y1)
    right = Box(left.x1 + 4.0, box.y0, box.x1, box.y1)
    shown = [Shown(load.symbol, complex(load.at.at(k)), complex(load.vector.at(k))) for load in forces.loads[c.link]]
    from_frame = pair_index(c.link, m.frame)
    frame_force = complex(forces.reactions[f"F{from_frame}"].at(k))
    pivot = complex(pos.points[c.pivot].at(k))
    shown.append(Shown(f"F̅_{{{from_frame}}}", pivot, frame_force))
    shown = acting(shown, forces.force_size(k))
    pins = linkage.crank_pins(pos)
    at = [pivot, *(complex(pos.points[name].at(k)) for name in pins), *(s.at for s in shown)]
    driver = project.driver
    if driver is not None:
        at += [pivot + driver.radius * z for z in (1, -1, 1j, -1j)]
    away = _clear(pivot, [complex(pos.points[name].at(k)) for name in pins], shown)
    z, d = _reach(at, shown)
    # The arrows of rotation, with their signs.
    feet = _feet(pivot, shown)
    z += [pivot, *feet]
    d += [(18.0 if driver is not None else 32.0) * away, *(0j for _ in feet)]
    frame = fit_frame(project, canvas, "scheme-crank", "μ_l", "м/мм", z, d, left.inset(3.0, 3.0, 3.0, 19.0))
    canvas.title(left, "Начальное звено", str(frame.scale))
    if driver is not None:
        _draw_driver(canvas, frame, pivot, driver)
    linkage.draw(canvas, pos, k, frame, "main", [c.link])
    for name in (c.pivot, *pins):
        canvas.label(frame(complex(pos.points[name].at(k))), linkage.indexed(name), 0j, 3.5, 2.8)
    draw_arms(canvas, frame, pivot, [s for s in shown if s.at != pivot])
    draw_forces(canvas, frame, shown)
    symbols.rotation_arrow(canvas, frame(pivot), 14.0, away, c.omega, f"ω_{c.link}")
    if driver is None and forces.balancing is not None and not is_zero(forces.balancing.at(k), forces.moment_size(k)):
        symbols.rotation_arrow(canvas, frame(pivot), 24.0, away, float(forces.balancing.at(k)), balancing_sign(project))
    _crank_couples(project, canvas, left, frame(pivot), away)
    _force_plan(project, canvas, right, forces.plans[c.link], k)


def _draw_driver(canvas: Canvas, frame: Frame, pivot: complex, driver: GearForce) -> None:
    """Pitch circle of the wheel on the crank shaft with its pitch point."""
    canvas.circle(frame(pivot), driver.radius / frame.scale.mu, "centre")
    contact = frame(pivot + driver.radius * np.exp(1j * driver.mate))
    canvas.dot(contact, 0.6, "thin")
    canvas.label(contact, "P", 1j * np.exp(1j * driver.mate), 3.5, 1.5)


def _clear(pivot: complex, pins: Iterable[complex], shown: Iterable[Shown]) -> complex:
    """Direction from the crank's pivot into the widest angle between its arms, base, forces and their arms."""
    lines = [*(z - pivot for z in pins), -1j]
    for s in shown:
        if abs(s.vector) > 0:
            foot = _foot(s, pivot)
            lines.append(s.vector if s.at == pivot else foot - pivot)
    angles = sorted({round(float(np.angle(z)), 6) for z in lines if abs(z) > 0})
    gaps = [(b - a, (a + b) / 2) for a, b in zip(angles, [*angles[1:], angles[0] + 2 * np.pi], strict=True)]
    middle = max(gaps, key=lambda gap: round(gap[0], 9))[1]
    return complex(np.cos(middle), np.sin(middle))


def _crank_couples(project: Project, canvas: Canvas, box: Box, at: complex, away: complex) -> None:
    """Couples on the crank, its inertia couple among them, as arrows and with their values."""
    k, forces = project.force_index, project.study.forces
    said = []
    for n, sign, value in _couples(project, project.mechanism.crank.link):
        symbols.rotation_arrow(canvas, at, 34.0 + 10.0 * n, away, value, sign)
        said.append(f"{sign} = {number(abs(value), 5)} Н·м")
    if said and project.driver is None and forces.balancing is not None:
        said.append(f"{balancing_sign(project)} = {number(abs(float(forces.balancing.at(k))), 5, forces.moment_size(k))} Н·м")
    if said:
        _fitted(canvas, complex(box.centre.real, box.y0 + 3.0), "; ".join(said), 3.5, box.width - 4.0)


def lever(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Zhukovsky's lever: the velocity plan turned by 90 degrees with every force and its arm."""
    k, lv = project.force_index, project.study.lever
    points = {name: complex(step.at(k)) for name, step in lv.points.items()}
    size = project.study.forces.force_size(k)
    shown = acting((Shown(h.symbol, complex(h.at.at(k)), complex(h.force.at(k))) for h in lv.hung), size)
    place = box.inset(2.0, 2.0, 2.0, 19.0)
    at, around = _reach([0j, *points.values()], shown)
    arms = [*(s.at for s in shown), *_feet(0j, shown)]
    frame = fit_frame(project, canvas, "lever", "μ_V", "(м/с)/мм", [*at, *arms], [*around, *(0j for _ in arms)], place)
    scale = frame.scale
    plain: Scale | None = canvas.scales.get("velocities")
    text = str(scale)
    if plain is not None and plain.mu > scale.mu * 1.01:
        text += f" (увеличен в {times(plain.mu / scale.mu)})"
    canvas.title(box, f"Рычаг Жуковского (положение {project.cycle.labels[k]})", text)
    pole = frame(0j)
    for seg in lv.velocities.plan.segments:
        a, b = (1j * complex(s.at(k)) for s in (seg.tail, seg.head))
        canvas.line(frame(a), frame(b), "axis")
    canvas.dot(pole, 0.9, "vector")
    canvas.label(pole, "p", 0j, 3.5, 1.2)
    _turned_letters(canvas, {name: frame(z) for name, z in points.items()}, pole)
    if lv.contact is not None and project.driver is not None:
        z = frame(complex(lv.contact.at(k)))
        canvas.line(pole, z, "axis")
        canvas.label(z, "f′", 0j, 3.5, 1.2)
    draw_arms(canvas, frame, 0j, shown, points=[frame(z) for z in points.values()])
    draw_forces(canvas, frame, shown)


def _turned_letters(canvas: Canvas, at: Mapping[str, complex], pole: complex) -> None:
    """Dots of the turned plan's points, mm, and their letters with a prime; those of one place together."""
    joint: dict[tuple[int, int], list[str]] = {}
    for name, q in at.items():
        joint.setdefault((round(q.real * 2), round(q.imag * 2)), []).append(name)
    for names in joint.values():
        q = at[names[0]]
        canvas.dot(q, 0.6, "vector")
        canvas.label(q, ", ".join(f"{n[0]}_{{{n[1:]}}}′" if n[1:] else f"{n}′" for n in names), q - pole, 3.5, 1.2)


def results(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """The balancing force by both methods and their difference."""
    k, study = project.force_index, project.study
    forces: Kinetostatics = study.forces
    assert forces.balancing is not None
    assert study.lever.balancing is not None
    force, sign = project.driver is not None, balancing_sign(project)
    kind = forces.force_size(k) if force else forces.moment_size(k)
    kinetic, hung = (clean(abs(step.at(k)), kind) for step in (forces.balancing, study.lever.balancing))
    unit = "Н" if force else "Н·м"
    difference = abs(kinetic - hung) / hung * 100 if hung else 0.0
    rows = [["Уравновешивающая сила" if force else "Уравновешивающий момент", "Значение"],
            [f"Силовой расчёт: {sign}, {unit}", fixed(kinetic, 2)],
            [f"Рычаг Жуковского: {sign}, {unit}", fixed(hung, 2)],
            ["Расхождение, %", number(difference, 2, 100.0)]]
    row = min(box.height / len(rows), 9.0)
    canvas.table(complex(box.x0, box.y1), [box.width * 0.66, box.width * 0.34], rows, row, 3.5)


