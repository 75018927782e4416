"""The vocabulary of moves shared by all constructions; rules of one method only live beside that method.

In the wordings ``{0}``, ``{1}`` ... are the arguments: points and directions by name, lengths in millimetres of the
drawing, angles in degrees; ``{name}`` is the result.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction.expression import primitive
from tmm_sheets.construction.step import DISTANCE as DISTANCE, Helper, Rule
from tmm_sheets.words import marked


def _same(x: Any) -> Any:
    return x


def arm(about: Any, at: Any, force: Any) -> tuple[Helper, ...]:
    """The line of action of a force, from its point to the foot of the perpendicular, and the arm itself; none of no force."""
    if not abs(force) > 0:
        return ()
    foot = ar.foot(about, at, force / abs(force))
    return Helper("line", at, foot), Helper("line", about, foot)


@primitive("values at positions", "real")
def take(row: Any, at: Any) -> Any:
    """Values of a row at the positions with these numbers, or at one; of what is the same at all positions, as often."""
    at = np.asarray(at, dtype=int)
    return row[at] if np.ndim(row) else row + np.zeros(at.shape)


def taken(name: str, unit: str, wording: str) -> Rule:
    """Rule that takes numbers from a plan with other positions: arguments are a row and the numbers of its positions.

    Each has the error of the very position it was taken from.
    """
    return Rule(name, take, ("number", "number"), "number", wording, unit=unit)


GIVEN = Rule("given point", _same, ("point",), "point", marked("Mark point {name}."))
GIVEN_NUMBER = Rule("given number", _same, ("number",), "number", marked("Given: {name} = {value}."))
GIVEN_INERTIA = Rule("given moment of inertia", _same, ("number",), "number", marked("Given: {name} = {value}."), unit="kg*m2")
GIVEN_LENGTH = Rule("given length", _same, ("length",), "length", marked("Take the segment {name} = {value}."))
GIVEN_DIRECTION = Rule("given direction", _same, ("direction",), "direction", marked("Draw the direction {name}."))

UNDER = Rule("direction of an angle", ar.unit, ("angle",), "direction", marked("Draw the direction {name}."))

LAY_OFF = Rule(
    "lay off under an angle", ar.polar, ("point", "length", "angle"), "point",
    marked("About {0} with the radius {1} draw a circle and mark point {name} on it at the angle {2}."),
    lambda a, v: (Helper("circle", a[0], radius=a[1]), Helper("line", a[0], v)),
)
RAY = Rule("ray", ar.ray, ("point", "point"), "direction", marked("Draw the line {0}{1}."),
           lambda a, v: (Helper("line", a[0], a[1]),))
ALONG = Rule(
    "lay off along a line", ar.along, ("point", "direction", "length"), "point",
    marked("On the line {1} mark off the radius {2} from {0}: point {name}."),
    lambda a, v: (Helper("arc", a[0], v, abs(a[2])),),
)
OFFSET = Rule(
    "lay off to one side", ar.along, ("point", "direction", "ordinate"), "point",
    marked("From {0} lay off {2} along {1}: point {name}."),
    lambda a, v: (Helper("arc", a[0], v, abs(a[2])),), laid_off=True,
)
SHIFT = Rule("lay off a vector", lambda p, v: p + v, ("point", "vector"), "point", marked("From {0} lay off {1}: point {name}."),
             lambda a, v: (Helper("line", a[0], v),), laid_off=True)
TURN = Rule("turn by 90 degrees", ar.turned, ("direction",), "direction", marked("Turn the direction {0} by 90°."))
PERPENDICULAR = Rule(
    "perpendicular", lambda p, q: 1j * ar.ray(p, q), ("point", "point"), "direction",
    marked("Draw the perpendicular to {0}{1}."),
)
ARC_ARC = Rule(
    "arc cuts arc", ar.arc_arc, ("point", "length", "point", "length", "number"), "point",
    marked("Strike arcs about {0} with the radius {1} and about {2} with the radius {3}: point {name}."),
    lambda a, v: (Helper("arc", a[0], v, a[1]), Helper("arc", a[2], v, a[3])),
)
ARC_LINE = Rule(
    "arc cuts line", ar.arc_line, ("point", "length", "point", "direction", "number"), "point",
    marked("About {0} with the radius {1} strike an arc across the line {3}: point {name}."),
    lambda a, v: (Helper("arc", a[0], v, a[1]),),
)
LINE_LINE = Rule(
    "lines meet", ar.line_line, ("point", "direction", "point", "direction"), "point",
    marked("Through {0} parallel to {1} and through {2} parallel to {3} draw lines; they meet at point {name}."),
    lambda a, v: (Helper("line", a[0], v), Helper("line", a[2], v)),
)
TANGENT = Rule(
    "tangent", ar.tangent_point, ("point", "point", "length", "number"), "point",
    marked("From {0} draw the tangent to the circle with the centre {1} and the radius {2}; it touches at point {name}."),
    lambda a, v: (Helper("line", a[0], v),),
)
FOOT = Rule("foot of a perpendicular", ar.foot, ("point", "point", "direction"), "point",
            marked("From {0} drop the perpendicular to the line {2}: point {name}."),
            lambda a, v: (Helper("line", a[0], v),))
ARM = Rule("measure an arm", ar.arm, ("point", "point", "force"), "length",
           marked("Measure the arm of the force {2} about {0}: {value}."), lambda a, v: arm(*a))
TURNED_BY = Rule("turn a direction", lambda u, angle: u * ar.unit(angle), ("direction", "angle"), "direction",
                 marked("At the angle {1} to {0} draw the direction {name}."))
