"""Reduced quantities that are known in closed form, handed to the flywheel as given rows instead of velocity plans."""

from __future__ import annotations

import numpy as np

from tmm_sheets.construction import rules
from tmm_sheets.construction.step import Given, Plan, Step


class Rows:
    """Rows at some angles; each step is recorded when it is asked for."""

    def __init__(self, of, where, phi, labels):
        self.of, self.phi, self.labels = of, phi, labels
        self.plan = Plan(f"reduction{where}", "Дано", "", labels)

    @property
    def plans(self):
        return (self.plan,)

    def _row(self, name, compute):
        if name not in self.plan:
            self.plan.add(name, rules.GIVEN_NUMBER, Given(compute(), name))
        return self.plan[name]

    def moment(self, side=1):
        return self._row(f"M{side}", lambda: self.of.moment(self.phi, side or 1))

    @property
    def inertia(self):
        return self._row("J", lambda: self.of.inertia(self.phi))

    @property
    def others(self):
        return self._row("J_II", lambda: self.of.inertia(self.phi) - self.of.crank_inertia)

    @property
    def slope(self):
        h = 1e-5
        return self._row("dJ/dφ", lambda: (self.of.inertia(self.phi + h) - self.of.inertia(self.phi - h)) / (2 * h))


class AsSteps:
    """What a flywheel asks of a linkage, besides ``moment``, ``inertia``, ``phi``, ``labels``, ``crank_inertia``."""

    crank_plans = ()

    @property
    def kept(self):
        return self.__dict__.setdefault("_kept", {})

    @property
    def numbered(self):
        return self.__dict__.setdefault("_numbered", Rows(self, "", self.phi[:-1], self.labels))

    @property
    def crank(self):
        return Step("J_кр", rules.GIVEN_NUMBER, (self.crank_inertia,))

    @property
    def force_steps(self):
        plan, forces = self.numbered.plan, self.forces_at(self.phi[:-1])
        return tuple(plan[name] if name in plan else plan.add(name, rules.GIVEN_NUMBER, Given(row, name))
                     for name, row in forces.items())

    def at(self, where, phi, labels=None):
        found = self.kept.get(where)
        if found is None or not np.array_equal(found.phi, phi):
            found = self.kept[where] = Rows(self, f"@{where}", phi, labels or tuple(map(str, range(np.size(phi)))))
        return found
