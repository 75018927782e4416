"""Plan of the speeds of rotation of a train or a reducer, and tables of what is measured on it and on the picture of velocities."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING

from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.scale import Scale, handy
from tmm_sheets.construction.step import Step
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box
from tmm_sheets.drawing.text_boxes import spread
from tmm_sheets.numbers import fixed, number
from tmm_sheets.sheets.gears.train_scheme import OFFERED, link_name
from tmm_sheets.sheets.player import placed, play
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.methods.gears.train import Train

NAME = 30.0
"""Room for a link's speed of rotation on its plan, mm."""
POINTS = (0.16, 0.28, 0.28, 0.28), ((180.0, 8.0), (150.0, 7.0), (120.0, 7.0))
"""Shares of the columns of a table of points; widths and heights of rows that are tried, mm."""
LINKS = (0.24, 0.4, 0.36)
"""Shares of the columns of a table of links."""


def plan_of_speeds(train: Train, canvas: Canvas, box: Box) -> None:
    """Plan of the speeds of rotation: rays through the pole parallel to the lines of the picture of velocities."""
    part = train.data.part
    canvas.of = f"{part}-speeds"
    picture: Scale = canvas.scales[f"{part}-velocities"]
    heights: Scale = canvas.scales[f"{part}-scheme"]
    values = [float(n.value) for n in train.links.values()]
    low, high = min(0.0, *values), max(0.0, *values)
    room, tall = box.width - 30, box.height - 44
    # A speed n takes n/mu_n mm, and with the picture's scale factors H = 30 mu_V/(pi mu_l mu_n).
    least = max((high - low) / room, 30 / pi * picture.mu / (heights.mu * tall))
    mu = Scale("μ_n", handy(least), tr("rpm/mm"))
    distance = 30 / pi * picture.mu / (heights.mu * mu.mu)
    inner = canvas.title(box, tr("Plan of the speeds of rotation"), tr("{scale};  H = {distance} mm").format(
        scale=mu, distance=fixed(distance, 1)))
    canvas.scales[f"{part}-speeds"] = picture
    plan = train.speeds(distance * heights.mu)
    spare = room - mu.mm(high - low)
    # In the middle, or at the left where what is left at the right is then of use to others.
    zero = inner.x0 + 15.0 + (spare / 2 if spare < OFFERED else 10.0) - mu.mm(low)
    y = inner.y1 - max(14.0, (inner.height - distance) * 0.5)
    s = placed(canvas, plan, complex(zero, y), (picture.mu, heights.mu))
    origin, pole = s.at("0"), s.at("P")
    pen = s.pen("0", "axis")
    pen.line(complex(zero + mu.mm(low) - 10, y), complex(zero + mu.mm(high) + 10, y), "axis")
    pen.arrow_head(complex(zero + mu.mm(high) + 12, y), 1)
    pen.line(origin, pole, "thin")
    canvas.label(complex(zero + mu.mm(high) + 12, y), tr("n, rpm"), away=-1j, height=3.5, gap=1.5)
    for name, size, away, height in (("P", 0.9, -1j, 5.0), ("0", 0.8, -1 + 1j, 3.5)):
        s.dot(name, size, "main")
        canvas.label(s.at(name), name, away=away, height=height)
    ends = [(s.at(step), step.name) for step in ends_of_rays(plan)]
    ends.sort(key=lambda pair: pair[0].real)
    places = spread([end.real for end, _ in ends], NAME)
    for i in range(len(places)):
        places[i] = max(places[i], box.x0 + NAME * (i + 0.5))
    for i in range(len(places)):
        places[-1 - i] = min(places[-1 - i], box.x1 - NAME * (i + 0.5))
    for (end, link), x in zip(ends, places, strict=True):
        play(s, [link], "main")
        s.dot(link, 0.8, "main")
        s.line(link, end, complex(x, y + 7), "thin", "text")
        canvas.text(complex(x, y + 9), f"n_{{{link_name(link)}}} = {number(float(plan[f'n{link}'].value))}", 3.5, "centre")


def ends_of_rays(plan: Plan) -> list[Step]:
    """Points of the plan of speeds that rays from its pole lead to, one for each link."""
    return [step for step in plan if step.name not in ("P", "0") and step.rule.gives == "point"]


def rows_of_points(of: Train, canvas: Canvas) -> list[list[str]]:
    """Heading and a row for each point whose velocity the picture has."""
    mu = canvas.scales[of.velocities.name]
    rows = [[tr("Point"), tr("Distance from the axis, mm"), tr("Segment of the picture, mm"), tr("V, m/s")]]
    for end in moving_points(of):
        name, at = end.name.upper(), complex(end.value)
        measured = f"|{name}{end.name}| = {fixed(abs(mu.mm(at.real)), 1)}"
        rows.append([name, number(1e3 * abs(at.imag)), measured, number(at.real)])
    return rows


def moving_points(of: Train) -> list[Step]:
    """Ends of the velocities that the picture has."""
    plan = of.velocities
    return [end for end in plan if end.name.islower() and end.rule.gives == "point" and end.name.upper() in plan]


def rows_of_links(of: Train, canvas: Canvas) -> list[list[str]]:
    """Heading and a row for each link on the plan that the sheet has."""
    plan = of.plans[f"{of.data.part}-speeds"]
    mu = canvas.scales[plan.name]
    rows = [[tr("Link"), tr("Segment of the plan, mm"), tr("n, rpm")]]
    for end in ends_of_rays(plan):
        name = link_name(end.name)
        measured = f"|0–{name}| = {fixed(abs(mu.mm(complex(end.value).real)), 1)}"
        rows.append([name, measured, number(float(plan[f"n{end.name}"].value))])
    return rows
