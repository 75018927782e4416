"""The running of an uneven crank in JavaScript against the flywheel in Python, of machines by chance and of odd ones."""

from dataclasses import dataclass

import numpy as np
import pytest

from tests.few import few
from tests.living import javascript
from tests.methods.flywheel.as_steps import AsSteps
from tmm_sheets.construction.arithmetic import continuous_argmax
from tmm_sheets.methods.flywheel.wheel_methods import flywheel
from tmm_sheets.task.schema import FlywheelTable

pytestmark = javascript.needed
MODULES = javascript.modules("digits", "primitives", "strokes", "searches", "flywheel")
SERIES = """
const series = (c, t) => c.reduce((sum, [a, b], k) => sum + a * Math.cos(k * t) + b * Math.sin(k * t), 0);
"""


def series(c, t):
    """Fourier series with coefficients of cosines and sines, shape (n, 2)."""
    k = np.arange(len(c))
    return np.cos(np.multiply.outer(t, k)) @ c[:, 0] + np.sin(np.multiply.outer(t, k)) @ c[:, 1]


@pytest.mark.parametrize("n", few((1_000, 10_000), 1_000))
def test_the_greatest_value(n, tmp_path):
    """Smooth functions, corners on samples, level ones, straight ones, one sample that is greater than the others."""
    rng = np.random.default_rng(3)
    samples, c = np.linspace(0, 2 * np.pi, 61), rng.normal(size=(n, 4, 2)) / np.arange(1, 5)[:, None]
    c[::7] = 0
    corner, height = rng.choice(samples, n), rng.normal(size=n) * (rng.random(n) < 0.3)
    slope = rng.normal(size=n) * (rng.random(n) < 0.2)

    def f(i):
        return lambda t: series(c[i], t) + height[i] * np.abs(t - corner[i]) + slope[i] * t

    own = [float(f(i)(np.array([continuous_argmax(f(i), samples)]))[0]) for i in range(n)]
    run = MODULES + SERIES + """
    const result = ({ samples, c, corner, height, slope }) => c.map((one, i) =>
      greatest((t) => series(one, t) + height[i] * Math.abs(t - corner[i]) + slope[i] * t, samples));
    """
    found = javascript.run(run, {"samples": samples.tolist(), "c": c.tolist(), "corner": corner.tolist(),
                                 "height": height.tolist(), "slope": slope.tolist()}, tmp_path)
    size = np.abs(c).sum(axis=(1, 2)) + 7 * (np.abs(height) + np.abs(slope))
    np.testing.assert_array_less(np.abs(np.array(found) - own), 1e-12 * size + 1e-300)


@dataclass(frozen=True)
class Machine(AsSteps):
    """Moments and a moment of inertia by series; a moment more, of either sign, acts from one of the ``breaks`` to the other."""

    moments: np.ndarray
    jump: float
    breaks: tuple[float, ...]
    inertias: np.ndarray
    crank_inertia: float
    phi: np.ndarray
    omega1: float = 12.0
    resisting: bool = True
    forces_are_moments: bool = False
    moments_beside: tuple[str, ...] = ()

    @property
    def labels(self):
        return tuple(map(str, range(len(self.phi) - 1)))

    @property
    def period(self):
        return float(self.phi[-1])

    def moment(self, phi, side=1):
        first, last = self.breaks
        phi = np.asarray(phi, dtype=float)
        acts = ((phi > first) & (phi < last)) | ((phi == first) & (side > 0)) | ((phi == last) & (side < 0))
        return series(self.moments, phi) + np.where(acts, self.jump, 0.0)

    def inertia(self, phi):
        return series(self.inertias, np.asarray(phi))

    def forces_at(self, phi, side=1):
        return {"F_5": np.abs(self.moment(phi, side)) + 1.0}


def machine(rng, odd):
    """A machine by chance; an odd one has no inertia but the crank's, no smooth moment, or a break in a position."""
    turns = int(rng.choice((1, 1, 2)))
    phi = np.append(np.sort(rng.choice(720, int(rng.integers(5, 14)), replace=False)) * turns / 720 * 2 * np.pi, 2 * np.pi * turns)
    phi[0] = 0.0
    inertias = 0.1 * rng.normal(size=(4, 2)) * (odd != 0)
    inertias[0] = 1.0, 0.0
    moments = rng.normal(size=(4, 2)) * (odd != 1) * 30
    breaks = phi[1:3] if odd == 2 else np.sort(rng.uniform(0, phi[-1], 2))
    return Machine(moments, float(rng.normal()) * 50, tuple(map(float, breaks)), inertias, float(rng.uniform(0, 0.4)), phi)


SIZES = {"density": "7300 kg/m3", "width_ratio": 0.2, "thickness_ratio": 0.1}


@pytest.mark.parametrize("n", few((12, 400), 12))
@pytest.mark.parametrize("method", ["wittenbauer", "mertsalov"])
def test_the_running_of_a_crank(n, method, tmp_path):
    """The constant moment and what turns with the crank, of a flywheel that is asked and of a given one."""
    rng = np.random.default_rng(8)
    cases, own = [], []
    for i in range(n):
        m, given = machine(rng, i % 4), i % 5 == 4
        asked = {"inertia": "3 kg m2"} if given else SIZES | {"delta": 0.04}
        found = flywheel(m, FlywheelTable.model_validate({"method": method, **asked}))
        own.append([float(found.driving_plan["M"].value), float(found.first_plan["J_вр"].value)])
        wheel = {"method": method, "crank": m.crank_inertia, "omega": m.omega1, "alone": False, **(
            {"added": 3.0} if given else {"delta": 0.04})}
        cases.append({"wheel": wheel, "phi": m.phi[:-1].tolist(), "breaks": m.breaks, "period": m.period,
                      "moments": m.moments.tolist(), "jump": m.jump, "inertias": m.inertias.tolist()})
    run = MODULES + SERIES + """
    const result = (cases) => cases.map(({ wheel, phi, breaks, period, moments, jump, inertias }) => {
      const [first, last] = breaks;
      const acts = (t, side) => (t > first && t < last) || (t === first && side > 0) || (t === last && side < 0);
      const moment = (t, side) => series(moments, t) + (acts(t, side) ? jump : 0);
      const { M, J } = runningOf(wheel, phi, breaks, period, moment, (t) => series(inertias, t));
      return [M, J];
    });
    """
    found = javascript.run(run, cases, tmp_path)
    np.testing.assert_allclose(found, own, rtol=1e-12, atol=1e-12 * 100)
