"""What the views of gears need of their places: with standard scales (GOST 2.302) only steps count."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING

from tmm_sheets.construction.scale import TOOTH
from tmm_sheets.sheets.border_solver import BorderNode, Need, reached, stepped
from tmm_sheets.sheets.components import listed
from tmm_sheets.sheets.gears import gear, gear_picture, rack, train, train_scheme
from tmm_sheets.sheets.player import standard

if TYPE_CHECKING:
    from tmm_sheets.methods.gears.train import Train
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.views import ViewPlace

BESIDE = 44.0
"""Room beside the smaller wheel: dimension of the centre distance and what is kept from it, mm."""

OTHER = 0.2
"""What width counts that only shows more of the greater wheel."""


def engagement(project: Project, view: ViewPlace) -> BorderNode:
    """The smaller wheel is to be seen whole, the other may be cut at both sides; teeth that are too low fill nothing."""
    pair = project.gear
    tooth = gear_picture.highest_tooth(pair)

    def drawn(width: int, height: int) -> float:
        mu, broken = gear_picture.picture(pair, width, height)
        if broken:
            return float(width * height) * reached(mu.mm(tooth), TOOTH)
        whole = min(2 * min(w.ra for w in pair.wheels) / mu.mu + BESIDE, width)
        return (whole + (width - whole) * OTHER) * height * reached(mu.mm(tooth), TOOTH)

    return stepped(view, (180.0, 300.0), drawn)


def sliding(project: Project, view: ViewPlace) -> BorderNode:
    """Two graphs under one another; they need height more than width."""
    return stepped(view, (130.0, 240.0), lambda width, height: min(width, 240) * min(height, 320))


def generating(project: Project, view: ViewPlace) -> BorderNode:
    """A pitch and a half of the rack with what it cuts."""
    pair = project.gear
    across, high = rack.PITCHES * pi * pair.m, sum(rack.extent(pair))
    beside = rack.LEFT + rack.MARGIN

    def drawn(width: int, height: int) -> float:
        mu = standard((across, width - beside), (high, height - rack.OVER)).mu
        return min(width, 1.6 * across / mu + beside) * min(height, rack.USUAL * high / mu + rack.OVER)

    return stepped(view, (120.0, 110.0), drawn)


def mesh(project: Project, view: ViewPlace) -> BorderNode:
    """A pitch and a quarter of the wheels about the pole."""
    pair = project.gear

    def drawn(width: int, height: int) -> float:
        mu = gear.mesh_scale(pair, width, height).mu
        return min(width, gear.MOST * pair.p / mu + gear.MESH[0]) * min(height, gear.mesh_height(pair) / mu + gear.MESH[1])

    return stepped(view, (120.0, 90.0), drawn)


def _train(project: Project, view: ViewPlace) -> Train:
    """The train or reducer that a view shows."""
    train: Train = getattr(project, view.draw.partition(".")[0])
    return train


def scheme(project: Project, view: ViewPlace) -> BorderNode:
    """Axial view, picture of velocities and end view of a train or a reducer."""
    views = train_scheme.TrainScheme(_train(project, view))

    def drawn(width: int, height: int) -> float:
        mu = views.fitted(width, height).mu
        whole = 2 * views.side / mu + views.beside(train_scheme.WIDEST + 24.0)
        return min(width, whole) * min(height, (views.top + views.bottom) / mu + train_scheme.OVER)

    return stepped(view, (views.beside(train_scheme.NARROWEST) + 60.0, 130.0), drawn)


def speeds(project: Project, view: ViewPlace) -> BorderNode:
    """A plan of speeds of rotation: rays from a pole to a line."""
    return stepped(view, (150.0, 100.0), lambda width, height: 0.6 * width * min(height, 190))


def table(project: Project, view: ViewPlace) -> BorderNode:
    """A table, or lines, under its title with the remarks under them: rows from the least height to the greatest of use."""
    of, head = _train(project, view), 16.0
    match view.draw.partition(".")[2]:
        case "choice":  # tooth sets with the line that says how they were chosen
            rows, head = len(project.reducer.sets) + 1, 24.0
        case "conditions":
            rows = 9 + 2 * bool(project.reducer.simple) + len(of.warnings)
        case "points":
            rows = len(train_scheme.moving_points(of)) + 1
        case "table":
            rows = len(of.names) + 1 + len(of.warnings)
        case "willis":  # two lines for each mesh
            rows = 2 * len(of.meshes)
        case _:
            rows = len(train.dimensions(project))
    need = Need(least=(150.0, head + 6.0 * rows), most=(190.0, head + listed.LARGE * rows), drawn=lambda w, h: w * h)
    return BorderNode(need, area=need.least[0] * need.most[1])
