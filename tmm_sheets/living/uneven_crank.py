"""How unevenly a crank runs with its flywheel, as the page is told it: the reduced quantities as a program, where they jump.

The page divides the cycle, draws the works and finds their greatest change itself whenever a given number is another, see
``templates/living/flywheel.js``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.program import rows_of
from tmm_sheets.construction.rules import GIVEN_NUMBER
from tmm_sheets.construction.step import Step, value_of
from tmm_sheets.methods.flywheel.flywheel import Flywheel
from tmm_sheets.methods.flywheel.reduced import Reduction, turning_back
from tmm_sheets.methods.linkage.numbering import PARTS, PARTS_OF_TURNS

if TYPE_CHECKING:
    from tmm_sheets.methods.linkage.study import Study
    from tmm_sheets.project import Project


class UnevenCrank:
    """What makes a crank run unevenly.

    ``steps`` are the reduced moment before (``before``) and behind a jump, the reduced moment of inertia (``mass``), the crank's
    own (``crank``), that of the ``rotor``, the coefficient ``delta`` or what a given flywheel has ``added``, the mean speed
    ``omega``. ``found`` says what the page takes in the place of steps and rows, ``sides`` of which side of a jump rows are, by
    their identity. ``turning_back`` are the angles of change points, rad.
    """

    def __init__(self, project: Project, study: Study) -> None:
        wheel: Flywheel = project.flywheel
        reduced = project.reduced
        at = Reduction(reduced, "@page", study.turned, study.labels)
        self.steps = {"behind": at.moment(1)}
        behind = len(at.chosen)
        self.steps |= {"before": at.moment(-1), "mass": at.inertia}
        drawn = reduced.at("acceleration", study.turned)
        self.sides = {id(row): side for rows, side in ((at.chosen[:behind], 1), (at.chosen[behind:], -1), (drawn.chosen, 1))
                      for row in rows}
        self.found: list[tuple[Any, dict[str, str]]] = [(wheel.driving_plan["M"], {"wheel": "M"}),
                                                        (wheel.first_plan["J_вр"], {"wheel": "J"})]
        crank = self.steps["crank"] = reduced.crank
        if isinstance(crank.args[0], Step):  # by the place of its centre of mass, at any angle
            self.found += [(crank, {"wheel": "crank"}), *((x, {"angle": "world"}) for x in rows_of([crank], 1))]
            self.steps["crank"] = crank.args[0]
        if wheel.given:
            self.steps["added"] = wheel.added
        else:
            self.steps["delta"] = wheel.data_plan["δ"]
        if "J_рот" in wheel.rotor_plan:
            self.steps["rotor"] = wheel.rotor_plan["J_рот"]
        self.steps["omega"] = Step("ω_1", GIVEN_NUMBER, (reduced.omega,))
        loads = [load for load in reduced.forces if not hasattr(load.law, "strokes")]
        self.turning_back = turning_back(reduced.mechanism, reduced.cycle)
        self.told = {"method": wheel.method, "alone": at.crank_alone, "jumps": [float(t) for load in loads for t in load.jumps],
                     **self._positions(project)}

    @staticmethod
    def _positions(project: Project) -> dict[str, Any]:
        """Angles turned to the numbered positions, or how many parts each stroke has and how many turns there are."""
        cycle = project.cycle
        turned = cycle.numbering["φ_п"] if cycle.numbering is not None else None
        if turned is not None and turned.rule in (PARTS, PARTS_OF_TURNS):
            _, *parts = (int(value_of(x)) for x in turned.args)
            return {"parts": parts if len(parts) > 2 else [*parts, 1]}
        return {"positions": np.asarray(cycle.turned).tolist()}
