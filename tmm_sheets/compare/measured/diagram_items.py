"""What can be measured on the kinematic diagrams and on that of the balancing moment: ordinates at the numbered positions."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from tmm_sheets.compare.measured.measurable import Measurable, Measurables, magnitude
from tmm_sheets.compare.measured.measured_units import MILLIMETRES
from tmm_sheets.construction.step import Step, value_at
from tmm_sheets.errors import CannotBuild
from tmm_sheets.words import marked, tr

if TYPE_CHECKING:
    from tmm_sheets.project import Project

OF_POINT = {"graph-S": marked("Graph of displacement"), "graph-V": marked("Graph of velocity"),
            "graph-a": marked("Graph of acceleration")}
OF_LINK = {"graph-psi": marked("Graph of the angle of rotation"), "graph-omega": marked("Graph of angular velocity"),
           "graph-epsilon": marked("Graph of angular acceleration")}
OF_MOMENT = ("graph-M", marked("Graph of the balancing moment"))


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
        called = tr("M_b") if project.balancing == "Mур" else project.balancing
        _graph(found, OF_MOMENT, "M_ур", project.study.balance["M"], project.study.labels, called)


def _graph(found: Measurables, graph: tuple[str, str], quantity: str, step: Step, labels: tuple[str, ...],
           called: str = "") -> None:
    """The ordinates of one curve, ``called`` so where its letter is not its name."""
    key, title = graph
    if key in found.scales:
        mu = found.scales[key].mu
        for k, label in enumerate(labels):
            ordinate = float(value_at(step, k)) / mu
            found.add(magnitude(Measurable(f"{key}/{label}/y_{quantity}", key, tr(title), label, f"y_{called or quantity}",
                                           MILLIMETRES, "length", ordinate, ((step, k, 1 / mu + 0j),), key, 1.0,
                                           main=graph == OF_MOMENT)))
