"""Picture of velocities of a train of gears and plan of its speeds of rotation, by ruler alone (manual 003, section 4, sheet 3).

In the picture a point is a complex number: its real part the velocity (m/s) of a point of the train, its imaginary part
that point's height over the main axis (m). The velocities of a turning link lie on a straight line through its axis, those
of a satellite on a line through its instant centre; the steeper the line against the heights, the slower the link. A ray
parallel to it through the pole of the plan of speeds cuts off its speed of rotation.
"""

from __future__ import annotations

from itertools import chain, count
from math import pi
from typing import Any

import numpy as np

from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction.given import Given
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.rules import GIVEN, RAY
from tmm_sheets.construction.step import Helper, Rule, Step
from tmm_sheets.methods.gears.train_steps import Found, Mesh, distance_of, order
from tmm_sheets.words import marked, tr

LETTERS = "ABCDEFGKLMNQRST"
"""Names of the points in the order of the power; O is the main axis, P the pole."""


def _over(p: Any, q: Any, u: Any) -> Any:
    return ar.line_line(p, 1 + 0j, q, u)


def _read(at: Any, origin: Any, pole: Any) -> Any:
    return np.real(at - origin) / np.imag(origin - pole) * 30 / pi


AT_RADIUS = Rule("point on a pitch circle", lambda side, d: side * 1j * (d / 2e3), ("number", "number"), "point",
                 marked("At the height of the pitch radius {1}/2 mm from the main axis mark point {name}."), unit="m")
AT_DISTANCE = Rule("point at a distance from the axis", lambda side, a: side * 1j * (a / 1e3), ("number", "number"), "point",
                   marked("At the distance {1} mm from the main axis mark point {name}."), unit="m")
VELOCITY_OF = Rule("velocity of a turning point", lambda n, p, o: n * pi / 30 * (np.imag(p) - np.imag(o)),
                   ("number", "point", "point"), "vector",
                   marked("Velocity of point {1} of the link that turns about {2} at {0} rpm, V = πn/30·{1}{2}: {name} = {value}."),
                   source="003, 4")
LAY_VELOCITY = Rule(
    "lay off a velocity", lambda p, v: p + v, ("point", "vector"), "point",
    marked("From {0} lay off its velocity {1}: end {name}."), lambda a, v: (Helper("line", a[0], v),), laid_off=True,
)
VELOCITY = Rule(
    "velocity from a link's line", _over, ("point", "point", "direction"), "point",
    marked("The horizontal through {0} meets the line of link {2} at point {name}: the segment {0}{name} is the velocity of {0}."),
    lambda a, v: (Helper("line", a[0], v),),
)
PARALLEL = Rule(
    "ray parallel to a link's line", lambda pole, u, origin: ar.line_line(pole, u, origin, 1 + 0j),
    ("point", "direction", "point"), "point",
    marked("Through the pole {0}, parallel to the line of link {1}, draw a ray to the axis of the speeds of rotation: point "
           "{name}."),
    lambda a, v: (Helper("line", a[0], v),),
)
READ = Rule("measure a speed of rotation", _read, ("point", "point", "point"), "number",
            marked("The segment {1}{0} gives the speed of rotation {name} = {value} rpm."), unit="1/min", source="003, 4")
LAID_BESIDE = Rule(
    "velocity of another point of a link", lambda end, n, p, q: end + (1j + n * pi / 30) * np.imag(q - p),
    ("point", "number", "point", "point"), "point",
    marked("At the height of {3} lay off from {0} the difference of the velocities πn/30·{2}{3} at {1} rpm: end {name}."))
FROM_AXIS = Rule("axis at a distance from another", lambda o, side, a: o + side * 1j * (a / 1e3), ("point", "number", "number"),
                 "point", marked("At the distance {2} mm from {0} mark the axis {name}."), unit="m")
ON_PITCH_CIRCLE = Rule("point on a pitch circle about an axis", lambda o, side, d: o + side * 1j * (d / 2e3),
                       ("point", "number", "number"), "point",
                       marked("At the pitch radius {2}/2 mm from {0} mark point {name}."), unit="m")


class SpeedPicture:
    """Adds the links in the order in which their speeds are found; each line goes through two velocities that are there.

    A link that stands has no line: the velocities of its points are the points themselves.
    """

    def __init__(self, train: Any) -> None:
        self.train, self.axes = train, train.axes
        self.plan = Plan(f"{train.data.part}-velocities", tr("Picture of velocities"), "m/s")
        self.axis = self.plan.add("O", GIVEN, 0j)
        self.letters = chain(LETTERS, (f"{letter}{n}" for n in count(1) for letter in LETTERS))
        self.points: dict[tuple[str, str], Step] = {}
        waiting = list(order(train))
        while waiting:
            ready = next(found for found in waiting if self.can(found))
            waiting.remove(ready)
            self.add(ready)

    def line(self, link: str, a: Step, b: Step) -> None:
        """Line of a link's velocities through two of them."""
        self.plan.add(link, RAY, a, b, say=tr("Line of the velocities of link {link}: the line {{0}}{{1}}.").format(link=link))

    def centre(self, link: str) -> Step:
        """Point of the axis a link turns about."""
        axis = self.axes[self.train.link(link)]
        if axis.mesh is None:
            return self.axis
        name = f"O{self.train.link(link)}"
        if name not in self.plan:
            side, distance = 1.0 if axis.height > 0 else -1.0, self.train.kinematics[distance_of(self.train, axis.mesh)]
            if (base := self.centre(axis.base)) is self.axis:
                self.plan.add(name, AT_DISTANCE, side, distance)
            else:
                self.plan.add(name, FROM_AXIS, base, side, distance)
        return self.plan[name]

    def contact(self, m: Mesh) -> Step:
        """Pitch point of a mesh; that of a planet on a carrier over the main axis."""
        if (key := (m.central, m.planet)) not in self.points:
            diameter, centre = self.train.pitch(m), self.centre(m.central)
            side = 1 if m.carrier or self.train.height(m.planet) > self.train.height(m.central) else -1
            rule, base = (AT_RADIUS, ()) if centre is self.axis else (ON_PITCH_CIRCLE, (centre,))
            self.points[key] = self.plan.add(next(self.letters), rule, *base, side, diameter)
        return self.points[key]

    def planet_axis(self, m: Mesh) -> Step:
        """Point of the planet's axis, over the main one."""
        if (key := (distance_of(self.train, m), "")) not in self.points:
            self.points[key] = self.plan.add(next(self.letters), AT_DISTANCE, 1, self.train.kinematics[key[0]])
        return self.points[key]

    def velocity_of(self, point: Step, link: str) -> Step:
        """End of the velocity of a point of a link that stands or whose line is there."""
        if self.train.stands(link):
            return point
        if point.name.lower() in self.plan:
            return self.plan[point.name.lower()]
        line = self.plan[self.train.link(link)]
        return self.plan.add(point.name.lower(), VELOCITY, point, line.args[0], line)

    def mesh_of(self, name: str) -> Mesh:
        """A mesh that a wheel or carrier takes part in, one where it is no planet if there is one."""
        link = self.train.link
        of = [m for m in self.train.meshes if link(name) in (link(m.central), m.carrier and link(m.carrier), link(m.planet))]
        found: Mesh = min(of, key=lambda m: link(m.planet) == link(name))
        return found

    def is_planet(self, found: Found) -> bool:
        """True for a planet on a carrier whose speed is no result of its mesh: its line needs a velocity of another link first."""
        mesh = self.mesh_of(found.name)
        return not found.meshes and bool(mesh.carrier) and self.train.link(mesh.planet) == self.train.link(found.name)

    def known(self, link: str) -> bool:
        """True for a link that stands or whose line is there."""
        return self.train.link(link) in self.plan or self.train.stands(link)

    def beside(self, mesh: Mesh) -> tuple[Step, str, Step] | None:
        """A point of a planet with the link whose line has its velocity, and another point of it; None while there is no line."""
        for link, here, there in ((mesh.central, self.contact, self.planet_axis), (mesh.carrier, self.planet_axis, self.contact)):
            if self.known(link):
                return here(mesh), link, there(mesh)
        return None

    def can(self, found: Found) -> bool:
        """True when the velocities that a line needs are there."""
        if self.known(found.name) or not self.is_planet(found):
            return all(self.known(name) for m in found.meshes for name in (m.central, m.planet, m.carrier)
                       if name and name != found.name and not (len(found.meshes) == 2 and name == m.planet))
        return self.beside(self.mesh_of(found.name)) is not None

    def add(self, found: Found) -> None:
        """Line of a link, through two velocities that are there."""
        link = self.train.link(found.name)
        if self.known(found.name):
            return
        if not found.meshes:
            self.laid_off(link, found.name, self.mesh_of(found.name))
            return
        mesh = found.meshes[0]
        if len(found.meshes) == 2 and (planet := self.train.link(mesh.planet)) not in self.plan:
            points = [(self.contact(m), m.central) for m in found.meshes if m.central != found.name]
            if found.name != mesh.carrier:
                points.insert(0, (self.planet_axis(mesh), mesh.carrier))
            ends = [self.velocity_of(*point) for point in points]
            if self.train.stands(found.meshes[1].central):
                ends.reverse()  # from the centre of the velocities
            self.line(planet, *ends)
        if found.name == mesh.carrier:
            self.line(link, self.axis, self.velocity_of(self.planet_axis(mesh), mesh.planet))
        elif found.name == mesh.planet:
            end = self.velocity_of(self.contact(mesh), mesh.central)
            start = self.velocity_of(self.planet_axis(mesh), mesh.carrier) if mesh.carrier else self.centre(found.name)
            self.line(link, start, end)
        else:
            self.line(link, self.centre(found.name), self.velocity_of(self.contact(mesh), mesh.planet))

    def laid_off(self, link: str, name: str, mesh: Mesh) -> None:
        """Line of a link whose speed is known: through its axis, or of a planet on a carrier through a velocity of its own."""
        n = self.train.kinematics[f"n{name}"]
        beside = self.beside(mesh) if mesh.carrier and self.train.link(mesh.planet) == link else None
        if beside is not None:
            here, other, there = beside
            end = self.velocity_of(here, other)
            self.line(link, end, self.plan.add(f"{there.name.lower()}′", LAID_BESIDE, end, n, here, there))
            return
        point = self.planet_axis(mesh) if self.train.link(mesh.carrier or "-") == link else self.contact(mesh)
        centre = self.centre(name)
        velocity = self.plan.add(f"V{point.name}", VELOCITY_OF, n, point, centre, symbol=f"V_{point.name}")
        self.line(link, centre, self.plan.add(point.name.lower(), LAY_VELOCITY, point, velocity))


def speeds(velocities: Plan, distance: float, part: str) -> Plan:
    """Plan of the speeds of rotation, pole ``distance`` m under the line on which they are read.

    For each line of the picture the end of its ray, named like the link, and the speed ``n<link>`` in 1/min.
    """
    plan = Plan(f"{part}-speeds", tr("Plan of the speeds of rotation"), "m/s")
    given = Given(-1j * distance, f"{part}.speeds.pole", "H", "m", over="none",
                  choice=tr("with it the scale factor μ_n is handy for counting"))
    pole = plan.add("P", GIVEN, given, say=tr("Mark the pole {name}."))
    origin = plan.add("0", GIVEN, 0j, say=tr("Above the pole mark the origin {name} on the axis of the speeds of rotation."))
    for line in (step for step in velocities if step.rule is RAY):
        end = plan.add(line.name, PARALLEL, pole, line, origin)
        plan.add(f"n{line.name}", READ, end, origin, pole)
    return plan
