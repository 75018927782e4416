"""The numbers of a project file that make a wish least, within bounds: what is tried, how it is computed, what came of it.

A number that is tried is one that can be written: with as many decimals as make a thousand steps of its range or more. So the file
that is written gives the very numbers that are told.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from io import BytesIO
from itertools import product
from math import floor, inf, isfinite, log10, nan
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from tmm_sheets import results
from tmm_sheets.construction.function import Function
from tmm_sheets.construction.program import rows_of
from tmm_sheets.construction.step import Reported, part_of, value_of
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.numbers import NOISE, listed, of_reader
from tmm_sheets.optimising.wishes import Bound, Values, Wish, bound, wish
from tmm_sheets.project import Project
from tmm_sheets.result_files import leaves
from tmm_sheets.task import edited_text, units
from tmm_sheets.words import tell

KINEMATIC = ("positions", "velocities", "accelerations")
"""Parts whose numbers at a crank angle follow from the lengths alone: one function gives them for other lengths."""
OF_LINKAGE = (*KINEMATIC, "forces", "cycle")
"""Parts that are told of positions."""
POSITIONS = 120
"""Crank angles of a turn at which results are looked at."""
TRIES = 400
STEPS = 1000
"""Steps of a range, at least."""


@dataclass(frozen=True)
class Varied:
    """A number of the project file and its range, in its unit; ``decimals`` it is written with, ``whole`` of a whole number."""

    name: str
    low: float
    high: float
    unit: str
    decimals: int
    whole: bool

    def at(self, share: float) -> float:
        """The number at a share of the range, as it can be written."""
        return min(max(round(self.low + share * (self.high - self.low), self.decimals), self.low), self.high)

    def value(self, x: float) -> Any:
        """The number as it stands in the file."""
        if not self.unit:
            return int(x) if self.whole else x
        return f"{self.text(x)} {self.unit}"

    def text(self, x: float) -> str:
        """Its digits."""
        return f"{x:.{max(self.decimals, 0)}f}".rstrip("0").rstrip(".") if self.decimals > 0 else f"{x:.0f}"

    def si(self, x: float) -> float:
        """The number in SI."""
        return units.si(f"{self.text(x)} {self.unit}")


@dataclass(frozen=True)
class Trial:
    """What came of some numbers: the wish, by how much bounds are missed altogether, why there is nothing (else empty)."""

    numbers: tuple[float, ...]
    value: float
    missed: float
    refused: str = ""

    @property
    def key(self) -> tuple[float, float]:
        """The less the better: bounds go before the wish."""
        return (self.missed, self.value) if isfinite(self.value) and isfinite(self.missed) else (inf, inf)


@dataclass(frozen=True)
class Optimum:
    """What a search came to.

    Attributes
    ----------
    varied, wish, most, bounds : what was looked for; ``most`` where the wish was to be greatest
    trials : all that were made, in their order; the values of a wish to be greatest have the other sign
    best : that of them which is best
    now : what the project has as it is; None where a number that is varied does not stand in its file
    by_function : whether one function computed them
    """

    varied: tuple[Varied, ...]
    wish: Wish
    most: bool
    bounds: tuple[Bound, ...]
    trials: tuple[Trial, ...]
    best: Trial
    now: Trial | None
    by_function: bool

    @property
    def changes(self) -> dict[str, Any]:
        """The best numbers, as the file has them."""
        return {v.name: v.value(x) for v, x in zip(self.varied, self.best.numbers, strict=True)}

    def said(self) -> list[str]:
        """The outcome for people, a line each."""
        sign = -1 if self.most else 1
        rows = []
        for k, v in enumerate(self.varied):
            before = "" if self.now is None else of_reader(f"{v.text(self.now.numbers[k])} -> ")
            spread = of_reader(f"{v.text(v.low)}..{v.text(v.high)}")
            rows.append((v.name, f"{before}{of_reader(v.text(self.best.numbers[k]))} {v.unit}".rstrip(), f"({spread})"))
        before = "" if self.now is None or not isfinite(self.now.value) else f"{listed(sign * self.now.value)} -> "
        rows.append((self.wish.text, f"{before}{listed(sign * self.best.value)}", tell("most") if self.most else tell("least")))
        rows += [(b.text, tell("kept"), "") for b in self.bounds]
        widths = [max(len(row[k]) for row in rows) for k in range(3)]
        lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]
        return [*lines, tell("{n} tries, {lost} of them cannot be built; {how}").format(
            n=len(self.trials), lost=sum(bool(t.refused) for t in self.trials),
            how=tell("by one function") if self.by_function else tell("each a project made anew"))]

    def svg(self) -> bytes:
        """The search as a picture: a diagram for each number that was varied, with the best marked, and the tries in order."""
        from matplotlib import rc_context
        from matplotlib.figure import Figure

        sign = -1 if self.most else 1
        found = [t for t in self.trials if isfinite(t.value)]
        kept, missed = [t for t in found if not t.missed], [t for t in found if t.missed]
        figure = Figure(figsize=(4.5 * (len(self.varied) + 1), 4), layout="constrained")
        axes = figure.subplots(1, len(self.varied) + 1, sharey=True, squeeze=False)[0]

        def values(some: list[Trial]) -> list[float]:
            return [sign * t.value for t in some]

        for k, v in enumerate(self.varied):
            axes[k].plot([t.numbers[k] for t in missed], values(missed), "x", color="0.7", markersize=4,
                         label=tell("misses a bound"))
            axes[k].plot([t.numbers[k] for t in kept], values(kept), ".", color="tab:blue", label=tell("tried"))
            axes[k].plot(self.best.numbers[k], sign * self.best.value, "o", color="tab:red", fillstyle="none",
                         markersize=9, label=tell("best"))
            axes[k].set(xlabel=", ".join(filter(None, (v.name, v.unit))), xlim=(v.low, v.high))
        best, so_far = [], self.trials[0]
        for t in self.trials:
            so_far = min(so_far, t, key=lambda one: one.key)
            best.append(sign * so_far.value if isfinite(so_far.value) and not so_far.missed else float("nan"))
        axes[-1].step(range(1, len(best) + 1), best, where="post", color="tab:red")
        axes[-1].set(xlabel=tell("tries"))
        axes[0].set(ylabel=self.wish.text)
        if kept:  # far outliers among the others leave nothing to be seen
            low, high = min(values(kept)), max(values(kept))
            axes[0].set_ylim(low - 0.05 * (high - low or 1), high + 0.05 * (high - low or 1))
        for ax in axes:
            ax.grid(linewidth=0.4, alpha=0.6)
        axes[0].legend(fontsize="small")
        buffer = BytesIO()
        with rc_context({"svg.hashsalt": self.wish.text, "svg.fonttype": "none"}):
            figure.savefig(buffer, format="svg", metadata={"Date": None})
        return buffer.getvalue()


def varied(text: str, data: Mapping[str, Any]) -> Varied:
    """Read ``crank.length=70..90 mm``; ``data`` are the tables of the project file.

    Raises
    ------
    BadInput
        when it cannot be read.
    """
    name, sign, spread = (part.strip() for part in text.partition("="))
    low, dots, high = spread.partition("..")
    first, unit_of_low = units.split(low)
    last, unit = units.split(high)
    a, b = (units.si(number) if number else nan for number in (first, last))
    if not (name and sign and dots and isfinite(b - a)) or unit_of_low not in ("", unit):
        raise BadInput(tell("{text}: expected a name and a range").format(text=text),
                       tell("for example {wish}").format(wish='"crank.length=70..90 mm"'))
    if not a < b:
        raise BadInput(tell("{text}: the range is empty").format(text=text), tell("write the less of both first"))
    own = edited_text.at(data, name)
    digits, own_unit = units.split(own)
    if digits and units.quantity_of(own_unit) != units.quantity_of(unit):
        said = tell("{text}: expected a range in a unit such as that of {own}, which the file has")
        raise BadInput(said.format(text=text, own=own))
    whole = isinstance(own, int) and not isinstance(own, bool) and a == int(a) and b == int(b)
    return Varied(name, a, b, unit, 0 if whole else max(0, -floor(log10((b - a) / STEPS))), whole)


def optimum(project: Project, changed: Callable[[Mapping[str, Any]], Project], vary: Sequence[str], aim: str, *, most: bool = False,
            subject_to: Iterable[str] = (), positions: int = POSITIONS, tries: int = TRIES,
            say: Callable[[int], None] = lambda n: None) -> Optimum:
    """Look for the numbers that make a wish least.

    Parameters
    ----------
    project
        the project as it is.
    changed
        makes one with other values at some keys of its file.
    vary
        numbers and ranges, see :func:`varied`.
    aim, most, subject_to
        the wish, whether it is to be greatest, and bounds (:mod:`~tmm_sheets.optimising.wishes`).
    positions
        crank angles of a turn at which results are looked at.
    tries
        how many numbers may be tried.
    say
        told how many were.

    Raises
    ------
    BadInput
        when something that is asked cannot be read.
    CannotBuild
        when nothing that was tried can be built and keeps the bounds.
    """
    some = tuple(varied(text, project.variant.data) for text in vary)
    count = Counter(edited_text.key_path(v.name) for v in some)
    if twice := [v.name for v in some if count[edited_text.key_path(v.name)] > 1]:
        raise BadInput(tell("{name} is varied twice").format(name=twice[0]), tell("give one range for each number"))
    if not some:
        raise BadInput(tell("nothing is varied"), tell("for example {wish}").format(wish='--vary "crank.length=70..90 mm"'))
    known = Known(project, positions)
    wishes = wish(aim, known.names), tuple(bound(text, known.names) for text in subject_to)
    names = tuple(dict.fromkeys(name for w in (wishes[0], *(w for b in wishes[1] for w in (b.left, b.right))) for name in w.names))

    def found(way: Whole) -> Optimum:
        return Asked(some, *wishes, most, way, tries, say).run()

    quick = Quick(known, some, changed, names)
    if quick.ready and quick.keeps((best := found(quick)).best.numbers):
        return best
    return found(Whole(known, some, changed, names))


class Known:
    """The results of the project as it is, and the crank angles that results are looked at."""

    def __init__(self, project: Project, positions: int) -> None:
        self.project, self.positions = project, positions
        told = results.told(project, None, refused={})
        self.names = [name for name, value in leaves(told) if not name.startswith(("scales.", "condition."))]

    @cached_property
    def angles(self) -> tuple[float, ...]:
        """Crank angles, rad."""
        return tuple(value_of(results.told(self.project, ["positions"], positions=self.positions)["cycle"]["phi"]).tolist())

    def told(self, project: Project, names: Iterable[str]) -> dict[str, Any]:
        """Results by their names, whose numbers are the steps they come from."""
        parts = dict.fromkeys("positions" if (part := name.partition(".")[0]) == "cycle" else part for name in names)
        return dict(leaves(results.told(project, parts, phi=self.angles if {*parts} & {*OF_LINKAGE} else None)))


class Whole:
    """Numbers of a project made anew for each try."""

    def __init__(self, known: Known, some: Sequence[Varied], changed: Callable[[Mapping[str, Any]], Project],
                 names: Sequence[str]) -> None:
        self.known, self.some, self.changed, self.names = known, some, changed, names

    def values(self, numbers: Sequence[float]) -> Values:
        """The results of some numbers; CannotBuild, BadInput when they have none."""
        return self.of(self.project(numbers))

    def project(self, numbers: Sequence[float]) -> Project:
        """The project with some numbers."""
        return self.changed({v.name: v.value(x) for v, x in zip(self.some, numbers, strict=True)})

    def of(self, project: Project) -> Values:
        """The results of a project."""
        told = self.known.told(project, self.names)
        return {name: getattr(told.get(name), "value", told.get(name)) for name in self.names}


class Quick(Whole):
    """Numbers by one function of the crank angle and what is varied, made of the steps of the project as it is.

    What a search found stays in it as it was. Hence it is relied on only where it gives, at the ends of all ranges, what a project
    made anew gives.
    """

    ready = False

    def __init__(self, known: Known, some: Sequence[Varied], changed: Callable[[Mapping[str, Any]], Project],
                 names: Sequence[str]) -> None:
        super().__init__(known, some, changed, names)
        if {name.partition(".")[0] for name in names} - {*KINEMATIC} or any(v.whole for v in some):
            return
        told = known.told(known.project, names)
        self.told = {name: told[name] for name in names if isinstance(told[name], Reported)}
        steps = {name: reported.step for name, reported in self.told.items()}
        rows = rows_of(steps.values(), len(known.angles))
        try:
            self.function = Function(steps, rows, [v.name for v in some])
        except CannotBuild:
            return
        self.rows = [*map(value_of, rows)]
        low, high = tuple(v.low for v in self.some), tuple(v.high for v in self.some)
        ends = [low, high, (low[0], *high[1:]), tuple(v.at(0.5) for v in self.some)]
        self.ready = len(self.told) == len(names) and all(map(self.agrees, ends))

    def values(self, numbers: Sequence[float]) -> Values:
        """The results of some numbers; NaN where they have none."""
        found = self.function(*self.rows, given={v.name: v.si(x) for v, x in zip(self.some, numbers, strict=True)})
        return {name: part_of(found[name], of.part) for name, of in self.told.items()}

    def keeps(self, numbers: Sequence[float]) -> bool:
        """Whether some numbers can be built, all round the turn, and give what the function says."""
        try:
            _ = self.project(numbers).study
        except (BadInput, CannotBuild):
            return False
        return self.agrees(numbers)

    def agrees(self, numbers: Sequence[float]) -> bool:
        """Whether a project made anew gives the same; where none can be made, whether there is nothing either."""
        quick = self.values(numbers)
        try:
            whole = super().values(numbers)
        except (BadInput, CannotBuild):
            return True
        return all(np.allclose(quick[name], whole[name], NOISE, NOISE * np.max(np.abs(whole[name]))) for name in self.names)


class Asked:
    """Tries, each made once."""

    def __init__(self, some: tuple[Varied, ...], aim: Wish, bounds: tuple[Bound, ...], most: bool, way: Whole, tries: int,
                 say: Callable[[int], None]) -> None:
        self.some, self.aim, self.bounds, self.most, self.way, self.tries, self.say = some, aim, bounds, most, way, tries, say
        self.made: dict[tuple[float, ...], Trial] = {}

    def run(self) -> Optimum:
        """The search; CannotBuild when nothing keeps the bounds.

        Raises
        ------
        CannotBuild
            when no try can be built.
        """
        search(lambda x: self.trial(tuple(v.at(s) for v, s in zip(self.some, x.tolist(), strict=True))).key,
                      len(self.some), self.tries)
        best = min(self.made.values(), key=lambda t: t.key)
        if best.key[0] > 0:
            reason = next((t.refused for t in self.made.values() if t.refused), "")
            if best.refused or not isfinite(best.missed):
                raise CannotBuild(tell("nothing that was tried can be built"), reason)
            raise CannotBuild(tell("nothing that was tried keeps the bounds"),
                              tell("nearest come {numbers}").format(numbers=", ".join(
                                  f"{v.name} = {v.value(x)}" for v, x in zip(self.some, best.numbers, strict=True))))
        trials = tuple(self.made.values())
        return Optimum(self.some, self.aim, self.most, self.bounds, trials, best, self._given_trial(), isinstance(self.way, Quick))

    def trial(self, numbers: tuple[float, ...]) -> Trial:
        """What comes of some numbers."""
        if numbers not in self.made:
            self.made[numbers] = self._tried(numbers, lambda: self.way.values(numbers))
            self.say(len(self.made))
        return self.made[numbers]

    def _tried(self, numbers: tuple[float, ...], values: Callable[[], Values]) -> Trial:
        try:
            found = values()
        except (BadInput, CannotBuild) as e:
            return Trial(numbers, inf, inf, str(e))
        with np.errstate(all="ignore"):
            value = self.aim(found) * (-1 if self.most else 1)
            return Trial(numbers, value, sum(b.missed(found) for b in self.bounds), "" if isfinite(value) else
                         tell("{wish} is not defined").format(wish=self.aim.text))

    def _given_trial(self) -> Trial | None:
        """The project as it is."""
        numbers = []
        for v in self.some:
            digits, unit = units.split(edited_text.at(self.way.known.project.variant.data, v.name))
            if not digits or units.quantity_of(unit) != units.quantity_of(v.unit):
                return None
            numbers.append(round(units.si(f"{digits} {unit}") / units.si(f"1 {v.unit}"), 12))
        return self._tried(tuple(numbers), lambda: self.way.of(self.way.known.project))


# --- the search --------------------------------------------------------------------------------------------------------


Point = NDArray[np.float64]
Key = TypeVar("Key", bound=tuple[float, ...])
STARTS = 3
"""Best points that a simplex is begun from."""
SMALL = 1e-3
"""Size of a simplex, as a share of the box, at which it has come to an end."""
SMALLEST = 1 / 4096
"""The least step, as a share of the box."""


class Enough(Exception):
    """So many points as may be asked have been."""


def search(ask: Callable[[Point], Key], dimensions: int, tries: int) -> None:
    """Ask for points of the unit box until no better one is found; ``ask`` keeps them, and may end the search by ``Enough``.

    Parameters
    ----------
    ask
        how good a point is, of shape (dimensions,): the least is best.
    dimensions
        of the box.
    tries
        how many points may be asked.
    """
    left = tries

    def counted(x: Point) -> Key:
        nonlocal left
        if left <= 0:
            raise Enough
        left -= 1
        return ask(x)

    try:
        # All over the box, its corners with them: a quarter of the tries, 17 along a line at most.
        along = min(17, max(3, int((tries / 4) ** (1 / dimensions))))
        first = [np.array(at) for at in product(np.linspace(0.0, 1.0, along), repeat=dimensions)]
        size = 1 / (along - 1)
        asked = sorted(((counted(x), n) for n, x in enumerate(first)))
        best = asked[0][0], first[asked[0][1]]
        for _, n in asked[:STARTS]:
            best = min(best, _simplex(counted, first[n], size / 2), key=lambda found: found[0])
        while (again := _simplex(counted, best[1], size / 4))[0] < best[0]:
            best = again
        _steps(counted, *best)
    except Enough:
        pass


def _steps(ask: Callable[[Point], Key], key: Key, at: Point) -> None:
    """Steps from a point to better ones, half as long where none is better."""
    ways = [np.array(way) for way in product((-1.0, 0.0, 1.0), repeat=len(at)) if any(way)] if len(at) < 4 else [
        *np.eye(len(at)), *-np.eye(len(at))]
    step = 8 * SMALL
    while step >= SMALLEST:
        for way in ways:
            x = np.clip(at + step * way, 0.0, 1.0)
            if (new := ask(x)) < key:
                key, at = new, x
                break
        else:
            step /= 2


def _simplex(ask: Callable[[Point], Key], start: Point, size: float) -> tuple[Key, Point]:
    """Nelder and Mead's search from a point."""
    inward = np.where(start > 0.5, -size, size)
    points = [start, *(start + step for step in np.diag(inward))]
    keys = [ask(x) for x in points]
    while True:
        order = sorted(range(len(points)), key=lambda k: keys[k])
        points, keys = [points[k] for k in order], [keys[k] for k in order]
        if np.ptp(points, axis=0).max() < SMALL:
            return keys[0], points[0]
        middle = np.mean(points[:-1], axis=0)

        def moved(by: float, middle: Point = middle, worst: Point = points[-1]) -> tuple[Key, Point]:
            x = np.clip(middle + by * (middle - worst), 0.0, 1.0)
            return ask(x), x

        new = moved(1.0)
        if new[0] < keys[0]:
            new = min(new, moved(2.0), key=lambda found: found[0])
        elif not new[0] < keys[-2]:
            new = moved(0.5) if new[0] < keys[-1] else moved(-0.5)
        if new[0] < keys[-1]:
            keys[-1], points[-1] = new
        else:
            points[1:] = [(x + points[0]) / 2 for x in points[1:]]
            keys[1:] = [ask(x) for x in points[1:]]
