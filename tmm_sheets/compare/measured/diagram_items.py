"""What can be measured on the kinematic diagrams and on that of the balancing moment: ordinates at the numbered positions."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from tmm_sheets.compare.measured.measurable import MILLIMETRES, Measurable, Measurables, magnitude
from tmm_sheets.construction.step import Step, value_at
from tmm_sheets.errors import CannotBuild

if TYPE_CHECKING:
    from tmm_sheets.project import Project

OF_POINT = {"graph-S": "График перемещения", "graph-V": "График скорости", "graph-a": "График ускорения"}
OF_LINK = {"graph-psi": "График угла поворота", "graph-omega": "График угловой скорости",
           "graph-epsilon": "График углового ускорения"}
OF_MOMENT = ("graph-M", "График уравновешивающего момента")


def collect(project: Project, found: Measurables) -> None:
    """Ordinates of the graphs that the sheets show; their signs depend on the sense one begins with, so magnitudes are compared."""
    for name in project.diagrams:
        link = name in project.mechanism.links
        graphs = OF_LINK if link else OF_POINT
        with suppress(CannotBuild):  # the sheet shows the graphs of others
            if graphs.keys() & found.scales.keys():
                motion = project.motion.link(name) if link else project.motion.point(name)
                for graph, step in zip(graphs.items(), motion.at_positions, strict=True):
                    _graph(found, graph, step.name, step, project.study.labels)
    if OF_MOMENT[0] in found.scales and project.driver is None:
        _graph(found, OF_MOMENT, "M_ур", project.study.balance["M"], project.study.labels)


def _graph(found: Measurables, graph: tuple[str, str], quantity: str, step: Step, labels: tuple[str, ...]) -> None:
    """The ordinates of one curve."""
    key, title = graph
    if key in found.scales:
        mu = found.scales[key].mu
        for k, label in enumerate(labels):
            found.add(magnitude(Measurable(f"{key}/{label}/y_{quantity}", key, title, label, f"y_{quantity}", MILLIMETRES, "length",
                                           float(value_at(step, k)) / mu, ((step, k, 1 / mu + 0j),), key, 1.0)))
