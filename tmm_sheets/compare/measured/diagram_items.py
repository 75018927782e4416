"""What can be measured on the kinematic diagrams and on that of the balancing moment: ordinates at the numbered positions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.compare.measured.measurable import Measurable, Measurables
from tmm_sheets.compare.measured.measured_units import MILLIMETRES
from tmm_sheets.construction.step import Step
from tmm_sheets.words import marked, tr

if TYPE_CHECKING:
    from tmm_sheets.project import Project

TITLES = {
    "graph-S": marked("Graph of displacement"), "graph-V": marked("Graph of velocity"), "graph-a": marked("Graph of acceleration"),
    "graph-omega": marked("Graph of angular velocity"), "graph-epsilon": marked("Graph of angular acceleration"),
    "graph-M": marked("Graph of the balancing moment"),
}


def collect(project: Project, found: Measurables) -> None:
    """Ordinates of the graphs that the sheets show; their signs depend on the sense one begins with, so magnitudes are compared."""
    study = project.study
    for name in project.diagrams:
        if name in project.mechanism.links:
            _graph(found, "graph-omega", f"ω_{name}", study.velocities.omega[name], study.labels)
            _graph(found, "graph-epsilon", f"ε_{name}", study.accelerations.epsilon[name], study.labels)
            continue
        path = np.atleast_1d(study.positions.points[name].value)
        far = complex(path[np.argmax(np.abs(path - path[0]))] - path[0])
        u = far / abs(far) if far else 1 + 0j
        _graph(found, "graph-S", f"S_{name}", study.positions.points[name], study.labels, u, complex(path[0]))
        _graph(found, "graph-V", f"V_{name}", study.velocities.points[name], study.labels, u)
        _graph(found, "graph-a", f"a_{name}", study.accelerations.points[name], study.labels, u)
    if "graph-M" in found.scales and study.forces.balancing is not None:
        _graph(found, "graph-M", "M_ур", study.forces.balancing, study.labels, called=tr("M_b"))


def _graph(found: Measurables, key: str, quantity: str, step: Step, labels: tuple[str, ...], along: complex = 1 + 0j,
           start: complex = 0j, called: str = "") -> None:
    """One curve: the component of a step ``along`` a direction, from ``start``; ``called`` so where its letter is not its name."""
    if key not in found.scales:
        return
    mu = found.scales[key].mu
    values: Any = np.broadcast_to(step.value, (len(labels),))
    for k, label in enumerate(labels):
        value = float((np.conj(along) * (complex(values[k]) - start)).real) / mu
        sign = -1.0 if value < 0 else 1.0
        found.add(Measurable(f"{key}/{label}/y_{quantity}", key, tr(TITLES[key]), label, f"y_{called or quantity}", MILLIMETRES,
                             "length", abs(value), ((step, k, sign * along / mu),), key, 1.0))
