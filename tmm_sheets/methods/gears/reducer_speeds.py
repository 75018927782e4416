"""Picture of velocities of a reducer and plan of its speeds of rotation, by ruler alone (manual 003, section 4, sheet 3).

In the picture a point is a complex number: its real part the velocity (m/s) of a point of the reducer, its imaginary part
that point's height over the main axis (m). The velocities of a turning link lie on a straight line through its axis, those
of a satellite on a line through its instant centre; the steeper the line against the heights, the slower the link. A ray
parallel to it through the pole of the plan of speeds cuts off its speed of rotation.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain, count
from math import pi
from typing import Any

import numpy as np

from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction.given import Given
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.rules import GIVEN, RAY
from tmm_sheets.construction.step import Helper, Rule, Step
from tmm_sheets.methods.gears.reducer_stages import ReducerWheel, Stage
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


class SpeedPicture:
    """Adds the links one after another, in the order of the power."""

    def __init__(self, part: str = "reducer") -> None:
        self.plan = Plan(f"{part}-velocities", tr("Picture of velocities"), "m/s")
        self.axis = self.plan.add("O", GIVEN, 0j)
        self.letters = chain(LETTERS, (f"{letter}{n}" for n in count(1) for letter in LETTERS))

    def point(self, at: Rule, size: Step, side: int = 1) -> Step:
        """A point of the reducer over (``side`` -1: under) the main axis, at half a diameter or at a distance."""
        return self.plan.add(next(self.letters), at, side, size)

    def line(self, link: str, a: Step, b: Step) -> Step:
        """Line of a link's velocities through two of them."""
        return self.plan.add(link, RAY, a, b,
                             say=tr("Line of the velocities of link {link}: the line {{0}}{{1}}.").format(link=link))

    def velocity(self, point: Step, axis: Step, line: Step) -> Step:
        """Velocity of a point of a link whose line is there."""
        return self.plan.add(point.name.lower(), VELOCITY, point, axis, line)

    def laid(self, point: Step, n: Step, centre: Step) -> Step:
        """The velocity everything begins with: of a point of a link that turns about ``centre``."""
        velocity = self.plan.add(f"V{point.name}", VELOCITY_OF, n, point, centre, symbol=f"V_{point.name}")
        return self.plan.add(point.name.lower(), LAY_VELOCITY, point, velocity)

    def simple(self, pair: Sequence[ReducerWheel], distance: Step, before: bool, line: Step | None) -> Step:
        """The simple stage over the main axis, where it begins the train, or under it; gives the driven wheel's line."""
        one, two = pair
        up = 1 if before else -1
        other = self.plan.add(f"O{one.number if before else two.number}", AT_DISTANCE, up, distance)
        pitch = self.point(AT_RADIUS, two.d if before else one.d, up)
        if before:
            end = self.laid(pitch, one.n, other)
            self.line(one.number, other, end)
            return self.line(two.number, self.axis, end)
        assert line is not None
        end = self.velocity(pitch, self.axis, line)
        return self.line(two.number, other, end)

    def stage(self, stage: Stage, line: Step | None) -> Step:
        """One planetary stage; ``line`` is that of the driving link, None when the train begins here."""
        one, two, three, four = stage.wheels
        block = two.number if stage.single else f"{two.number}-{three.number}"
        r1, r4, rh = (AT_RADIUS, one.d), (AT_RADIUS, four.d), (AT_DISTANCE, stage.a_H)
        driving = {"sun": one.number, "ring": four.number, "carrier": stage.carrier}[stage.driver]
        entry = self.point(*{"sun": r1, "ring": r4, "carrier": rh}[stage.driver])
        if line is None:
            end = self.laid(entry, stage.entry, self.axis)
            line = self.line(driving, self.axis, end)
        else:
            end = self.velocity(entry, self.axis, line)
        centre = self.point(*(r1 if stage.driver == "ring" else r4))
        satellite = self.line(block, centre, end)
        exit_ = self.point(*(r1 if stage.driver == "carrier" else rh))
        velocity = self.velocity(exit_, centre, satellite)
        return self.line(one.number if stage.driver == "carrier" else stage.carrier, self.axis, velocity)


def picture(simple: Sequence[ReducerWheel], stages: Sequence[Stage], distance: Step | None, before: bool) -> Plan:
    """Picture of velocities: points ``A`` .. with their velocities ``a`` .., and a line named after each link.

    ``distance`` is the step of the simple stage's centre distance (mm), None without one.

    A link that is one with the link before it (a carrier with the next sun) has one line, under its first name.
    """
    drawn = SpeedPicture()
    line = drawn.simple(simple, distance, before, None) if before and distance else None
    for stage in stages:
        line = drawn.stage(stage, line)
    if distance and not before:
        drawn.simple(simple, distance, before, line)
    return drawn.plan


def links_of(velocities: Plan) -> tuple[str, ...]:
    """Links with a line in the picture, in the order in which they were drawn."""
    return tuple(step.name for step in velocities if step.rule is RAY)


def speeds(velocities: Plan, distance: float, part: str = "reducer") -> Plan:
    """Plan of the speeds of rotation, pole ``distance`` m under the line on which they are read.

    For each line of the picture the end of its ray, named like the link, and the speed ``n<link>`` in 1/min.
    """
    plan = Plan(f"{part}-speeds", tr("Plan of the speeds of rotation"), "m/s")
    given = Given(-1j * distance, f"{part}.speeds.pole", "H", "m", over="none",
                  choice=tr("with it the scale factor μ_n is handy for counting"))
    pole = plan.add("P", GIVEN, given, say=tr("Mark the pole {name}."))
    origin = plan.add("0", GIVEN, 0j, say=tr("Above the pole mark the origin {name} on the axis of the speeds of rotation."))
    for link in links_of(velocities):
        end = plan.add(link, PARALLEL, pole, velocities[link], origin)
        plan.add(f"n{link}", READ, end, origin, pole)
    return plan
