"""Planetary stages: schemes, ratio, efficiency, conditions (manual 003, 2.1 to 2.4), and the search for their tooth numbers."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import pi, sin, sqrt
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction.expression import Reals, primitive
from tmm_sheets.errors import CannotBuild
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.task.seldom_tables import ReducerTable


Driver = Literal["sun", "ring", "carrier"]


@dataclass(frozen=True)
class Scheme:
    """How the wheels of a planetary stage lie: signs of the pairs 1-2 and 3-4, one wheel or a block, who may drive.

    ``least_simple`` is the least ratio of the simple stage.
    """

    signs: tuple[int, int]
    single: bool
    drivers: tuple[Driver, ...]
    least_simple: float

    @property
    def wheels(self) -> int:
        """Number of wheels of a stage: sun, satellite, ring; or two central wheels and a block of two satellites."""
        return 3 if self.single else 4


SCHEMES: Mapping[str, Scheme] = {
    "single row": Scheme((1, -1), True, ("sun", "ring"), 1.2),
    "external-internal": Scheme((1, -1), False, ("sun",), 1.5),
    "two external": Scheme((1, 1), False, ("carrier",), 1.5),
    "two internal": Scheme((-1, -1), False, ("carrier",), 1.5),
}


def inner_ratio(signs: tuple[int, int], z: Sequence[Any]) -> Reals:
    """Ratio of wheel 1 to wheel 4 with the carrier stopped; tooth numbers z1 .. z4, numbers or arrays."""
    return signs[0] * signs[1] * (z[1] * z[3]) / (z[0] * z[2])


def stage_ratio(inner: Reals, driver: str) -> Reals:
    """Input speed over output speed: sun 1 to carrier, ring 4 to carrier (the other one fixed), or carrier to wheel 1."""
    if driver == "carrier":
        with np.errstate(divide="ignore"):
            return 1 / (1 - inner)
    return 1 - inner if driver == "sun" else 1 - 1 / inner


EFFICIENCY: Mapping[str, Callable[[Any, Any], Any]] = {
    "sun": lambda inner, both: (1 + both * np.abs(inner)) / (1 + np.abs(inner)),
    "ring": lambda inner, both: (1 + both * (1 / np.abs(inner))) / (1 + 1 / np.abs(inner)),
    "carrier, i < 1": lambda inner, both: (1 - inner) / (1 - inner * both),
    "carrier, i > 1": lambda inner, both: both * (inner - 1) / (inner - both),
}
"""Efficiency of a stage, whose power goes through the meshes alone, by what drives it: of its inner ratio, and of the efficiency of
its two pairs with the carrier stopped."""


def efficiency_case(inner: float, driver: str) -> str:
    """Which of the formulas of :data:`EFFICIENCY` holds."""
    return driver if driver != "carrier" else f"carrier, i {'<' if inner < 1 else '>'} 1"


def internal_pairs(signs: tuple[int, int]) -> tuple[tuple[int, int], ...]:
    """Satellite and ring, numbers of wheels from 0, of the internal pairs of a stage."""
    return tuple((satellite, ring) for satellite, ring, sign in ((1, 0, signs[0]), (2, 3, signs[1])) if sign < 0)


def assembles(signs: tuple[int, int], z: Sequence[Any], satellites: int) -> Reals:
    """True where ``satellites`` identical blocks can be put in at equal angles."""
    return (z[0] * z[2] - signs[0] * signs[1] * z[1] * z[3]) % (satellites * np.gcd(z[1], z[2])) == 0


def neighbours_clear(signs: tuple[int, int], z: Sequence[Any], satellites: int, addendum: float) -> Reals:
    """True where the tip circles of neighbouring satellites stay clear of each other."""
    return (z[0] + signs[0] * z[1]) * sin(pi / satellites) > np.maximum(z[1], z[2]) + 2 * addendum


@primitive("least ring", "real")
def least_ring(satellite: int, addendum: float, alpha: float = pi / 9) -> int:
    """Least tooth number of a ring with which a satellite meshes without interference, no shifts; 0 when there is none.

    Two conditions of an internal pair: the ring's tip ends on the satellite's involute, and the tips do not meet outside
    the line of action (J. E. Shigley; KHK, gear technical reference, internal gears).
    """
    satellite = int(satellite)
    top = satellite * sin(alpha) ** 2 - 2 * addendum  # the first condition has no solution below, and an asymptote there
    for ring in range(satellite + 1, 100 * satellite if top > 0 else satellite + 200):
        if _meshes_inside(satellite, ring, addendum, alpha):
            return ring
    return 0


def _meshes_inside(z1: int, z2: int, ha: float, alpha: float) -> bool:
    rb1, rb2 = z1 / 2 * np.cos(alpha), z2 / 2 * np.cos(alpha)
    ra1, ra2, a = z1 / 2 + ha, z2 / 2 - ha, (z2 - z1) / 2
    if ra2 <= rb2 or sqrt((ra2 - rb2) * (ra2 + rb2)) < a * sin(alpha):
        return False
    cos1, cos2 = (ra2**2 - ra1**2 - a**2) / (2 * a * ra1), (a**2 + ra2**2 - ra1**2) / (2 * a * ra2)
    if cos1 >= 1 or cos2 >= 1:
        return True  # the tip circles do not meet at all
    if cos1 <= -1 or cos2 <= -1:
        return False
    inv, inv1, inv2 = (np.tan(v) - v for v in (alpha, np.arccos(rb1 / ra1), np.arccos(rb2 / ra2)))
    return bool((np.arccos(cos1) + inv1 - inv) * z1 / z2 + inv - inv2 >= np.arccos(cos2))


Ints = npt.NDArray[np.int64]
Known = tuple[int | None, int | None, int | None, int | None]

TIERS = (0.01, 0.02)
"""Deviations of the ratio that are preferred to any larger one, before the permitted one itself."""
RUNNERS_UP = 5
"""Tooth sets kept beside the chosen one."""
MOST_TEETH = (120, 150)
"""Largest tooth number of a sun, a satellite or wheel 1, for one stage and for two, which need slower ones each."""
GREATEST_SIMPLE = 4.0
"""Greatest ratio of the simple stage."""
BOUNDS = (36, 48, 64, 90)
"""Tooth numbers up to which sets are tried, one after the other, until no larger wheel can do better."""


@dataclass(frozen=True)
class ToothSet:
    """Tooth numbers of the planetary stage (z1 .. z4, in a single row z2 = z3) and of the simple one (1 and 1 without), and
    results.

    ``deviation`` is relative, against the ratio asked for; ``height`` that of the whole reducer over its pitch circles, m.
    """

    stage: tuple[int, int, int, int]
    pinion: int
    wheel: int
    ratio: float
    deviation: float
    height: float


@dataclass(frozen=True)
class _Task:
    """The search's input in its own terms: wheels 1 .. 4 of the stage, pinion and wheel of the simple one."""

    scheme: Scheme
    driver: Driver
    stages: int
    ratio: float
    given: Known
    pinion: int
    wheel: int | None
    span: tuple[float, float]
    data: ReducerTable

    @property
    def most(self) -> int:
        """Largest number of teeth of wheels 1 to 3."""
        return self.data.most_teeth or MOST_TEETH[self.stages - 1]

    def height(self, largest: Any, wheel: Any) -> Any:
        """Height of the reducer over its pitch circles, m: ``largest`` is the planetary stage's diameter in modules."""
        d = self.data
        stage = largest * d.module / 2
        if d.simple_module is None:
            return 2 * stage + 0 * wheel
        one, two = self.pinion * d.simple_module / 2, wheel * d.simple_module / 2
        if d.simple == "before":
            return np.maximum(stage, two) + np.maximum(stage, two + 2 * one)
        return np.maximum(stage, one) + np.maximum(stage, one + 2 * two)

    def wheels(self) -> Ints:
        """Tooth numbers of the large wheel of the simple stage."""
        if self.wheel is not None:
            return np.array([self.wheel])
        least, most = np.ceil(self.pinion * self.span[0] - 1e-9), np.floor(self.pinion * self.span[1] + 1e-9)
        return np.arange(int(least), min(int(most), self.most) + 1)

    def coaxial(self, largest: int) -> list[Ints]:
        """All stages with wheels of at most ``largest`` teeth whose central wheels have one axis."""
        d, s = self.data, self.scheme.signs
        r1, r2, r3 = (np.arange(d.least_teeth, largest + 1) if g is None else np.array([g]) for g in self.given[:3])
        if self.scheme.single:
            z1, z2 = (v.ravel() for v in np.meshgrid(r1, r2, indexing="ij"))
            z3 = z2
        else:
            z1, z2, z3 = (v.ravel() for v in np.meshgrid(r1, r2, r3, indexing="ij"))
        z4 = z1 + s[0] * z2 - s[1] * z3
        ok = z4 >= d.least_teeth if self.given[3] is None else z4 == self.given[3]
        if not self.scheme.single:
            ok &= z2 != z3  # one wheel would do
        return self._filtered((z1, z2, z3, z4), ok)

    def candidates(self, largest: int, reach: float) -> list[Ints]:
        """All stages with wheels of at most ``largest`` teeth that meet the conditions and may come within ``reach``."""
        d, s = self.data, self.scheme.signs
        z = self.coaxial(largest)
        z = self._filtered(z, neighbours_clear(s, z, d.satellites, d.addendum))
        wheels = self.wheels()
        if not len(wheels):
            return [v[:0] for v in z]
        total = abs(stage_ratio(inner_ratio(s, z), self.driver)) ** self.stages
        z = self._filtered(z, (total * (wheels[-1] / self.pinion) >= self.ratio * (1 - reach))
                           & (total * (wheels[0] / self.pinion) <= self.ratio * (1 + reach)))
        z = self._filtered(z, assembles(s, z, d.satellites))
        return self.free_of_interference(z) if d.strict_internal else z

    def free_of_interference(self, z: list[Ints]) -> list[Ints]:
        """Those stages whose rings are large enough to mesh with their satellites."""
        for satellite, ring in internal_pairs(self.scheme.signs):
            teeth = range(int(z[satellite].max(initial=0)) + 1)
            least = np.array([least_ring(v, self.data.addendum) or 10**6 for v in teeth])
            z = self._filtered(z, z[ring] >= least[z[satellite]])
        return z

    @staticmethod
    def _filtered(z: Sequence[Ints], keep: Any) -> list[Ints]:
        return [v[keep] for v in z]

    def ranked(self, largest: int, count: int) -> list[ToothSet]:
        """The first ``count`` permitted sets: tier of the deviation, then height, then deviation, then tooth numbers."""
        d = self.data
        z, i, j, ratio = self.pairs(largest, d.tolerance)
        off = abs(ratio / self.ratio - 1).round(12)
        tier = np.searchsorted((*TIERS, d.tolerance), off - 1e-9)
        height = self.height((z[0] + self.scheme.signs[0] * z[1] + np.maximum(z[1], z[2]))[i], self.wheels()[j]).round(9)
        best = np.arange(len(i))
        if len(i) > count:
            # Only what can be among the first is worth sorting.
            last = np.partition(tier, count - 1)[count - 1]
            best = np.flatnonzero(tier <= last)
            edge = tier[best] == last
            within = height[best[edge]]
            need = count - int((~edge).sum())
            best = best[~edge | (height[best] <= np.partition(within, need - 1)[need - 1])]
        order = np.lexsort((z[2][i[best]], z[1][i[best]], z[0][i[best]], off[best], height[best], tier[best]))
        return [self.set_of(z, i[k], j[k], ratio[k], height[k]) for k in best[order[:count]]]

    def nearest(self) -> ToothSet | None:
        """The set nearest to the ratio of all that meet the conditions."""
        z, i, j, ratio = self.pairs(self.most, 1.0)
        if not len(i):
            return None
        k = int(np.argmin(abs(ratio / self.ratio - 1)))
        return self.set_of(z, i[k], j[k], ratio[k], float("nan"))

    def pairs(self, largest: int, reach: float) -> tuple[list[Ints], Ints, Ints, npt.NDArray[np.float64]]:
        """Stages, and for each set within ``reach`` of the ratio the number of its stage, of its wheel, and its ratio."""
        z = self.candidates(largest, reach)
        total = abs(stage_ratio(inner_ratio(self.scheme.signs, z), self.driver)) ** self.stages
        order = np.argsort(total, kind="stable")
        simple = self.wheels() / self.pinion
        low = np.searchsorted(total[order], self.ratio * (1 - reach) * (1 - 1e-12) / simple, "left")
        high = np.searchsorted(total[order], self.ratio * (1 + reach) * (1 + 1e-12) / simple, "right")
        i = np.concatenate([order[a:b] for a, b in zip(low, high, strict=True)] or [order[:0]])
        j = np.repeat(np.arange(len(simple)), high - low)
        return z, i, j, total[i] * simple[j]

    def set_of(self, z: Sequence[Ints], i: int, j: int, ratio: float, height: float) -> ToothSet:
        """One set of the search as plain numbers."""
        one, two, three, four = (int(v[i]) for v in z)
        return ToothSet((one, two, three, four), self.pinion, int(self.wheels()[j]), float(ratio), float(ratio) / self.ratio - 1,
                        float(height))


def _sets(task: _Task) -> list[ToothSet]:
    """The best tooth sets, permitted ones first.

    A larger wheel 1 to 3 makes a larger stage: by its own teeth at least, and those of two more wheels where it meshes
    outside. Once the best sets are smaller than any stage with a larger wheel can be, those need not be tried.
    """
    found: list[ToothSet] = []
    wheels = task.wheels()
    least = min((task.data.least_teeth, *(g for g in task.given if g is not None)))
    around = 2 * least if task.scheme.signs[0] > 0 else 0
    for largest in (*(b for b in BOUNDS if b < task.most), task.most):
        found = task.ranked(largest, RUNNERS_UP + 1)
        settled = [t for t in found if abs(t.deviation) <= TIERS[0] and t.height <= task.height(largest + 1 + around, wheels[0])]
        if len(settled) == RUNNERS_UP + 1:
            break
    return found


def stage_numbers(data: ReducerTable, k: int) -> tuple[str, str, str, str]:
    """Numbers of wheels 1 to 4 of planetary stage ``k`` in the reducer; in a single row wheels 2 and 3 are one."""
    scheme = SCHEMES[data.scheme]
    first = (3 if data.simple == "before" else 1) + k * scheme.wheels
    block, last = (1, 2) if scheme.single else (2, 3)
    return str(first), str(first + 1), str(first + block), str(first + last)


def simple_numbers(data: ReducerTable) -> tuple[str, ...]:
    """Numbers of pinion and wheel of the simple stage; none without one."""
    if data.simple == "none":
        return ()
    first = 1 if data.simple == "before" else data.stages * SCHEMES[data.scheme].wheels + 1
    return str(first), str(first + 1)


def named_teeth(data: ReducerTable, teeth: ToothSet) -> dict[str, int]:
    """Tooth numbers of a set by name, "z1" ..; equal stages are named once."""
    simple = dict(zip(simple_numbers(data), (teeth.pinion, teeth.wheel), strict=False))
    out = dict(zip(stage_numbers(data, 0), teeth.stage, strict=True)) | simple
    return {f"z{n}": out[n] for n in sorted(out, key=int)}


def search(data: ReducerTable) -> list[ToothSet]:
    """The chosen tooth set and its runners-up.

    Raises
    ------
    CannotBuild
        naming the nearest set when none is within the tolerance.
    """
    scheme = SCHEMES[data.scheme]
    asked = data.ratio if data.ratio is not None else data.input_speed / (data.output_speed or data.input_speed)
    spans = [data.simple_ratio] if data.simple_ratio is not None else [(scheme.least_simple, GREATEST_SIMPLE)]
    if data.simple == "none":
        spans = [(1.0, 1.0)]
    if data.simple_ratio is None and data.simple == "before":
        spans.append((1.0, GREATEST_SIMPLE))  # an output nearly as fast as a planetary stage can make it needs that
    given, (pinion, wheel) = _given(data)
    tasks = [_Task(scheme, data.driver or scheme.drivers[0], data.stages, asked, given, pinion, wheel, (span[0], span[1]), data)
             for span in spans]
    for task in tasks:
        found = _sets(task)
        if found:
            return found
    hint = (tell("give another number of satellites, or a simple stage") if data.simple == "none" else
            tell("give another pinion, number of satellites or range simple_ratio of the simple stage"))
    nearest = tasks[-1].nearest()
    if nearest is None:
        raise CannotBuild(tell("reducer: no tooth set meets coaxiality, assembly and neighbourhood near the ratio {asked:.4g}"
                               ).format(asked=asked), hint)
    teeth = ", ".join(f"{name} = {z}" for name, z in named_teeth(data, nearest).items())
    raise CannotBuild(
        tell("reducer: no tooth set within {tolerance:g} % of the ratio {asked:.4g}; the nearest, {teeth}, gives {ratio:.4g} "
             "({deviation:+.1f} %)").format(tolerance=data.tolerance * 100, asked=asked, teeth=teeth, ratio=nearest.ratio,
                                            deviation=nearest.deviation * 100), hint)


def _given(data: ReducerTable) -> tuple[Known, tuple[int, int | None]]:
    """Given tooth numbers of wheels 1 to 4, of the pinion and of its wheel (1 and 1 without a simple stage)."""
    names = [f"z{n}" for n in stage_numbers(data, 0)]
    pair = [f"z{n}" for n in simple_numbers(data)]
    known = list(dict.fromkeys((*names, *pair)))
    unknown = [name for name in data.teeth if name not in known]
    if unknown:
        raise CannotBuild(tell("reducer: teeth has {unknown}; here are {known}").format(unknown=", ".join(unknown),
                                                                                       known=", ".join(known)),
                          tell("equal stages have the tooth numbers of the first") if data.stages > 1 else "")
    one, two, three, four = (data.teeth.get(name) for name in names)
    if not pair:
        return (one, two, three, four), (1, 1)
    if pair[0] not in data.teeth:
        raise CannotBuild(tell("reducer: teeth has no {pinion}, the pinion of the simple stage").format(pinion=pair[0]),
                          tell("write teeth = {{ {pinion} = 12 }}").format(pinion=pair[0]))
    return (one, two, three, four), (data.teeth[pair[0]], data.teeth.get(pair[1]))
