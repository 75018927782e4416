"""How much of a sheet knows where it comes from: marks that tell their step, and whether what they tell is true.

Usage: python -m tests.sheets.traced [PROJECT ...] [--rooms linkage,flywheel,gears,cams]

Counted are lines, arcs and curves inside views; symbols, tables, dimensions, hatching, lettering and the frame are what they are.
"""

from __future__ import annotations

import argparse
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from tmm_sheets.catalogue import read
from tmm_sheets.construction.arithmetic import Curve
from tmm_sheets.construction.step import Helper, Plan, Step, value_at
from tmm_sheets.drawing.marks import Arc, Fill, Line, Mark, PlacedFrame, Points, Polyline, Text, flat
from tmm_sheets.project import Project
from tmm_sheets.sheets.composed import Composed
from tmm_sheets.sheets.linkage.details import NAMES
from tmm_sheets.sheets.sheet import every
from tmm_sheets.sheets.views import arrangement

ROOMS = {
    "linkage": ("kinematics", "false_positions", "kinetics", "friction", "diagrams", "load_diagram", "synthesis", "given_position",
                "hodograph"),
    "flywheel": ("flywheel", "mertsalov"),
    "gears": ("gear", "rack", "reducer"),
    "cams": ("cam", "cam_profile", "cam_zone"),
}
"""Modules of views by room."""
DONE = tuple(ROOMS)
"""Rooms whose marks know their steps."""
PROJECTS = ("lugansk/shaper", "lugansk/engine", "press", "sixbar/8:3", "transport/press@07-ЭПС-718")
"""One project of each family, and an engine."""
UNCOUNTED = {"symbol", "table", "dimension", "hatch", "text", "frame"}
CHECKED = ("point", "vector", "construction", "link", "curve")
EXACT = 0.001
"""mm"""
SMOOTH = 0.05
"""How far a chord of a smooth curve may lie beside it, mm."""
PRODUCED = 4.0
"""How far a helper line is drawn beyond its end at most, mm."""


class View(NamedTuple):
    """A view of a sheet and its marks."""

    draw: str
    title: str
    marks: tuple[Mark, ...]


def views(sheet: Composed) -> Iterator[View]:
    """Views and their titled parts in the order they were drawn, without the frame and the labels."""
    ends = [*(p.first for p in sheet.parts[1:]), len(sheet.drawing.marks)]
    for part, end in zip(sheet.parts, ends, strict=True):
        if part.draw not in ("title block", "labels"):
            yield View(part.draw, part.title, sheet.drawing.marks[part.first:end])


def counted(view: View) -> list[Mark]:
    """Marks of a view that ought to know their step."""
    return [m for m in view.marks if not isinstance(m, Fill | Text) and (m.by is None or m.by.role not in UNCOUNTED)]


def drawn(project: Project, rooms: Iterable[str]) -> dict[int, Composed]:
    """The sheets of a project that have views of some rooms."""
    modules = {module for room in rooms for module in ROOMS[room]}
    numbers = [n for n, name in enumerate(project.sheets, 1)
               if any(view.draw.partition(".")[0] in modules for view in arrangement(name).fitted(project.parts).views)]
    return every(project, numbers=numbers, steps=True).drawn if numbers else {}


def count(sheets: Iterable[Composed], rooms: Iterable[str]) -> dict[str, Counter[str]]:
    """Marks by the name of their view: "known", or what is known of those without a step (role or line type)."""
    modules = {module for room in rooms for module in ROOMS[room]}
    found: dict[str, Counter[str]] = defaultdict(Counter)
    for sheet in sheets:
        for view in views(sheet):
            if view.draw.partition(".")[0] in modules:
                found[view.draw].update("known" if m.by and m.by.step else _unknown(m) for m in counted(view))
    return {draw: c for draw, c in found.items() if c}


def _unknown(m: Mark) -> str:
    return f"{m.by.role if m.by else 'no role'} {getattr(m, 'style', '')}"


# --- is it true -------------------------------------------------------------------------------------------------------


def plans(project: Project) -> dict[str, Plan]:
    """All plans of a project that was drawn by name; those of the numbered positions, not of further angles."""
    found: dict[str, Plan] = {}
    if "positions" in project.parts:
        _ = project.study.loads  # a sheet shows the law of a load without asking for its step
    for of_part in project.plans.values():
        found = {**(of_part or {}), **found}
    return found


def steps(project: Project) -> dict[str, Step]:
    """All steps of these plans, by plan/name."""
    return {step.path: step for plan in plans(project).values() for step in plan}


def places(label: str, plan: Plan) -> list[int]:
    """Positions of a plan with that number: the one that closes the cycle may have the number of the first."""
    asked = label.split(", ")[0]
    return [k for k, other in enumerate(plan.labels) if other == asked] if asked else [0]


def untrue(project: Project, sheets: dict[int, Composed]) -> tuple[Counter[str], list[str]]:
    """How many marks of each role were checked, and those that are not where their step says."""
    known, of, checked, wrong = steps(project), plans(project), Counter[str](), []
    for n, sheet in sheets.items():
        tips = {g.first: sheet.drawing.marks[g.end - 1] for g in sheet.groups if g.kind == "arrow"}
        for i, m in enumerate(sheet.drawing.marks):
            if m.by is None or not m.by.step:
                continue
            if m.by.step not in known:
                wrong.append(f"sheet {n}: {m.by.step} is no step")
                continue
            if m.by.frame < 0:
                continue
            if m.by.role == "symbol" and sheet.parts[sheet.frames[m.by.frame].view].title.split(" ")[0] in NAMES:
                frame, step = sheet.frames[m.by.frame], known[m.by.step]
                off = min(enlarged(m, step, k, frame, known) for k in places(m.by.position, of[step.plan]))
                checked["detail"] += 1
                if not off <= EXACT:
                    wrong.append(f"sheet {n}: {m.by.step} in a detail: off by {off:.4f} mm")
                continue
            if m.by.role not in CHECKED:
                continue
            if isinstance(m, Text) or (isinstance(m, Fill) and m.by.role != "point"):
                continue  # letters and heads
            step, frame = known[m.by.step], sheet.frames[m.by.frame]
            where = places(m.by.position, of[step.plan])
            if sheet.parts[frame.view].draw.partition(".")[0] in ROOMS["linkage"]:
                if m.by.role == "curve":
                    continue  # through further angles than the plan's; test_diagrams looks at them
                off = min(distance(m, step, k, frame, known, tips.get(i)) for k in where)
            else:
                off = min(apart(m, step, k if m.by.position else None, frame, project) for k in where)
            checked[m.by.role] += 1
            if not off <= EXACT:
                wrong.append(f"sheet {n}: {m.by.role} {m.by.step} at {m.by.position or 'all'}: off by {off:.4f} mm")
    return checked, wrong


def enlarged(m: Mark, step: Step, k: int, frame: PlacedFrame, known: dict[str, Step]) -> float:
    """How far what an enlarged detail shows lies from where its step says, mm.

    Dots, hinges and centres of mass at the point, lines towards it, arrows of forces along them, those of couples about a point.
    """
    value = complex(step.at(k))
    if isinstance(m, Fill):
        return min(abs(z - frame(value)) for z in (_middle(m), m.points[0])) if _is_point(step) and len(m.points) > 3 else 0.0
    if isinstance(m, Arc):
        of = [step] if _is_point(step) else [s for s in known.values() if s.plan == frame.plan and _is_point(s)]
        return min(abs(m.centre - frame(complex(s.at(k)))) for s in of)
    if not isinstance(m, Line):
        return np.inf
    along = (m.b - m.a) / abs(m.b - m.a)
    if step.rule.gives == "force":
        force = _split(step, m.by.name, value, k, known)
        return abs((force * np.conj(along)).imag / abs(force)) * abs(m.b - m.a)
    return abs(((frame(value) - m.a) * np.conj(along)).imag) if _is_point(step) else 0.0


def distance(m: Mark, step: Step, k: int, frame: PlacedFrame, known: dict[str, Step], head: Mark | None) -> float:
    """How far a mark lies from where its step, or the step's helper lines, say, mm."""
    if m.by.role == "link":
        return _off_link(m, frame, k, known)
    value, own = step.at(k), frame.plan == step.plan
    if m.by.role == "point":
        return abs(_middle(m) - frame(complex(value)))
    if m.by.role == "vector":
        assert isinstance(m, Line)
        tip = complex(head.points[0]) if isinstance(head, Fill) else m.b
        if step.rule.gives == "force":  # of any length on a scheme: it has its direction there
            return _across(tip, m.a, _split(step, m.by.name, value, k, known))
        starts = {complex(frame(complex(s.at(k)))) for s in known.values() if s.plan == step.plan and _is_point(s)}
        return max(abs(tip - frame(complex(value))), min(abs(m.a - z) for z in starts))
    lines = _helpers(step, k)
    drawn = [_from_helper(m, h, frame) for h in lines]
    if own and _is_point(step) and (frame.plan == "positions" or not lines):  # carried over from there, or about it
        at = frame(complex(value))
        drawn += [abs(m.centre - at)] if isinstance(m, Arc) else [abs(m.a - at), abs(m.b - at)]
    if own and frame.mu[0] != frame.mu[1] and isinstance(m, Line):
        drawn += [abs(abs(m.b.imag - frame.origin.imag) * frame.mu[1] - y) / frame.mu[1] for y in _ordinates(step, k)]
    if step.rule.gives == "length" and isinstance(m, Line):  # an arm, and the line of action it was measured to
        force = next(value_at(a, k) for a in step.args if isinstance(a, Step) and a.rule.gives == "force")
        drawn += [abs(abs(m.b - m.a) - abs(value) / frame.mu[1]), min(_across(m.b, m.a, force), _across(m.b, m.a, -force))]
    return min(drawn, default=np.inf)


def apart(m: Mark, step: Step, k: int | None, frame: PlacedFrame, project: Project) -> float:
    """The same where plans are graphs or one construction for all positions: flywheel, gears and cams, mm.

    A mark of a point or of an ordinate over an axis goes through it, and its curve through all of them; where a curve is drawn
    through points closer together, or in part, its own go through that of the step. A line shows a length, or lies as far from
    the zero of the plan, or goes through the points it was measured between.
    """
    value = step.value if k is None else step.at(k)
    if isinstance(value, Curve):
        inside = (flat(m) - frame.origin) * np.exp(-1j * frame.turn)
        return float(np.abs(inside.imag - value(inside.real * frame.mu[0]) / frame.mu[1]).max())
    drawn = [_from_helper(m, h, frame) for at in range(np.size(value)) for h in _helpers(step, at if k is None else k)]
    if step.rule.gives == "direction":
        along = frame(np.ravel(value)) - frame(0j)
        line = flat(m)
        straight = [(a, b) for a, b in pairwise(line) if abs(b - a) > 1.0 or len(line) == 2]
        return min([*drawn, *(_across(b, a, sense * u) for a, b in straight for u in along for sense in (1, -1))])
    points = _points(m, step, k, frame, project)
    if points is not None and m.by.role == "curve":
        through = max((_from_line(z, m) for z in points), default=np.inf)
        course = Polyline(points, "")
        drawn += [through, max(_from_line(z, course) for z in flat(m))] if len(points) > 1 else [through]
        return max(min(drawn) - SMOOTH, 0.0)
    if points is not None and m.by.role == "point":
        drawn += [abs(_middle(m) - z) for z in points]
        if not np.iscomplexobj(value) and len(points) > 1:
            drawn.append(max(_from_line(_middle(m), Polyline(points, "")) - SMOOTH, 0.0))
    elif points is not None:
        drawn += [_from_line(z, m) for z in points]
        drawn += [abs(m.centre - z) for z in points if isinstance(m, Arc)]
    if not np.iscomplexobj(value) and isinstance(m, Line | Arc):
        size = np.abs(np.ravel(value).astype(float)) / frame.mu[1]
        if isinstance(m, Arc):
            return min([*drawn, *abs(m.radius - size)])
        zero = _from_line(frame.origin, m)
        between = [a for a in step.args if isinstance(a, Step) and _is_point(a) and not np.ndim(a.value)]
        ends = [complex(frame(complex(a.value))) for a in between]
        drawn += [*abs(abs(m.b - m.a) - size), *abs(zero - size)]
        drawn += [max(_from_line(z, m) for z in ends)] if ends else []
    return float(min(drawn))


def _points(m: Mark, step: Step, k: int | None, frame: PlacedFrame, project: Project) -> Points | None:
    """Where the points of a step lie on the sheet, or the ends of its ordinates over the axis of a graph, but those of zero."""
    value = step.value if k is None else step.at(k)
    if np.iscomplexobj(value) and step.rule.gives != "force":
        points = np.ravel(frame(np.asarray(value)))
        return points[~np.isnan(points)]
    x = _abscissae(step, project)
    if x is None:
        return None
    y = np.abs(step.value) if step.rule.gives == "force" else np.asarray(step.value)
    if k is not None:
        again = [project.cycle.period] if step.plan == "reduction" else []  # position 0 closes the cycle
        return np.asarray(frame(x[k] + np.array([0.0, *again]) + 1j * y[k]))
    drawn = ((flat(m) - frame.origin) * np.exp(-1j * frame.turn)).real * frame.mu[0]
    there = np.isfinite(y) & (y != 0) & (x >= drawn.min() - 1e-9) & (x <= drawn.max() + 1e-9)
    return np.asarray(frame(x[there] + 1j * y[there]))


def _abscissae(step: Step, project: Project) -> Any:
    """Angles at which the values of a step were taken, or ways along the line of action; None where it is no row."""
    if not np.ndim(step.value):
        return None
    if step.plan == "reduction":
        return project.cycle.turned
    if step.plan == "energy-mass-speed":
        return project.flywheel.reduced.phi
    rows = {s.name: np.asarray(s.value) for s in step.ancestors() if np.size(s.value) == np.size(step.value)}
    if "K" in rows:
        ways = rows["K"]
        return np.real(ways * np.conj(ways[-1] - ways[0])) / abs(ways[-1] - ways[0])
    return rows.get("φ")


def _from_line(z: complex, m: Mark) -> float:
    """Distance of a point from the line of a mark; a straight one may be produced."""
    if isinstance(m, Arc):
        return float(abs(abs(z - m.centre) - m.radius))
    if isinstance(m, Line):
        return float(abs(((z - m.a) * np.conj(m.b - m.a)).imag) / abs(m.b - m.a))
    line = flat(m)
    a, b = (ends[line[:-1] != line[1:]] for ends in (line[:-1], line[1:]))
    t = np.clip(((z - a) * np.conj(b - a)).real / np.abs(b - a) ** 2, 0, 1)
    return float(np.abs(z - a - t * (b - a)).min())


def _off_link(m: Mark, frame: PlacedFrame, k: int, known: dict[str, Step]) -> float:
    """How far a link's line lies beside that between the points it is called by; a dead position has its prime on both."""
    names = m.by.name.rstrip("″′").split("–")
    primes = m.by.name[len(m.by.name.rstrip("″′")):]
    points = [known.get(f"{frame.plan}/{name}{primes}") or known[f"{frame.plan}/{name}"] for name in names]
    a, b = (complex(frame(complex(point.at(k)))) for point in points)
    along = [(z - a) * np.conj(b - a) / abs(b - a) for z in (m.a, m.b)]
    return max(*(abs(z.imag) for z in along), *(-z.real for z in along), *(z.real - abs(b - a) for z in along))


def _is_point(step: Step) -> bool:
    return step.rule.gives in ("point", "vector")


def _middle(m: Mark) -> complex:
    if isinstance(m, Line):
        return (m.a + m.b) / 2
    return m.centre if isinstance(m, Arc) else complex(np.mean(m.points))


def _across(tip: complex, tail: complex, along: complex) -> float:
    """How far the tip lies beside the ray from the tail."""
    w = (tip - tail) * np.conj(along) / abs(along)
    return abs(w.imag) if w.real > 0 else abs(w)


def _split(step: Step, name: str, value: complex, k: int, known: dict[str, Step]) -> complex:
    """The force shown: of a reaction, when its name says so, the part along the link alone."""
    if name == f"{step.name}n":
        return value - known[f"moments/{step.name}τ"].at(k)
    return value


def _helpers(step: Step, k: int) -> tuple[Helper, ...]:
    return step.rule.helpers(tuple(value_at(a, k) for a in step.args), step.at(k)) if step.rule.helpers else ()


def _from_helper(m: Mark, h: Helper, frame: PlacedFrame) -> float:
    """Distance of a mark from a helper line, which may be produced a little."""
    a, b = (complex(frame(z)) for z in (h.a, h.b))
    if isinstance(m, Arc):
        radius = abs(complex(frame(h.a + h.radius)) - a) if h.kind == "circle" else abs(b - a)
        return np.inf if h.kind == "line" else max(abs(m.centre - a), abs(m.radius - radius))
    if not isinstance(m, Line) or h.kind != "line" or not abs(b - a) > EXACT:
        return np.inf
    over = (m.b - b) * np.conj(b - a) / abs(b - a)
    return max(abs(m.a - a), abs(over.imag), -over.real, over.real - PRODUCED)


def _ordinates(step: Step, k: int) -> list[float]:
    """What an ordinate of a diagram over the crank angle may be."""
    return [float(abs(step.at(k)))]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("projects", nargs="*", default=PROJECTS)
    parser.add_argument("--rooms", default=",".join(ROOMS))
    args = parser.parse_args()
    for name in args.projects:
        project = Project(read(name))
        rooms = args.rooms.split(",")
        sheets = drawn(project, rooms)
        print(name)
        total: Counter[str] = Counter()
        for draw, found in count(sheets.values(), rooms).items():
            total += found
            print(_line(draw, found))
        if total:
            print(_line("together", total))
        checked, wrong = untrue(project, sheets)
        print(f"  where their step says: {dict(checked)}, not: {len(wrong)}")
        for line in wrong[:12]:
            print(f"    {line}")


def _line(name: str, found: Counter[str]) -> str:
    exceptions = ", ".join(f"{n} {what}" for what, n in found.most_common() if what != "known")
    return f"  {name:32} {found['known']:5} of {found.total():5}  {found['known'] / found.total():7.1%}  {exceptions}"


if __name__ == "__main__":
    main()
