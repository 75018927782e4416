"""What can be measured on the sheets of a project, and the results that follow: one entry for each number a student can check.

An entry knows its exact value and how that changes with the steps of the construction; the error analysis of these very steps gives
its tolerance.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from math import degrees, isfinite, pi
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from tmm_sheets.construction import rules
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.protocol import letter_of, spoken
from tmm_sheets.construction.scale import Scale
from tmm_sheets.construction.step import Step, value_at
from tmm_sheets.task import units as quantities
from tmm_sheets.words import every, marked, tell

if TYPE_CHECKING:
    from tmm_sheets.construction.step import Plan

# --- units: said in the reader's language, read in any ----------------------------------------------------------------------------

MILLIMETRES, DEGREES, METRES, TURNS = marked("mm"), "°", marked("m"), marked("rpm")
SPEED, ANGULAR_SPEED, ACCELERATION, ANGULAR_ACCELERATION = marked("m/s"), marked("rad/s"), marked("m/s²"), marked("rad/s²")
FORCE, MOMENT, MASS, INERTIA, ENERGY = marked("N"), marked("N·m"), marked("kg"), marked("kg·m²"), marked("kg·m²/s²")

SCALE = 0.1
"""Times as long as they should be that lengths may be in another unit, or drawn to another scale factor."""
OTHERS: Mapping[str, tuple[tuple[str, float], ...]] = {
    MILLIMETRES: ((METRES, 1e-3), (marked("cm"), SCALE)), DEGREES: ((marked("rad"), 1 / degrees(1)),),
    SPEED: ((marked("mm/s"), 1e3),), ACCELERATION: ((marked("mm/s²"), 1e3),), ANGULAR_SPEED: ((TURNS, 30 / pi),),
    FORCE: ((marked("kgf"), 1 / 9.81), (marked("kN"), 1e-3)), MOMENT: ((marked("N·mm"), 1e3), (marked("kgf·m"), 1 / 9.81)),
}
"""Units that are written by mistake for each, and how many times as large a number is in them."""


def unit_times(unit: str, own: str) -> float:
    """How many units ``own`` one of the stated units has.

    Raises
    ------
    ValueError
        if they measure different things.
    """
    stated = re.sub(r"[().]", "", unit)
    if not stated or "?" in unit or quantities.common(stated) in map(quantities.common, every(own)):
        return 1.0  # a code page without superscripts writes м/с?
    if quantities.quantity_of(stated) != (quantities.quantity_of(own) or None):
        raise ValueError(unit)
    return quantities.si(f"1 {stated}") / quantities.si(f"1 {own}")


# --- what is measured -----------------------------------------------------------------------------------------------------------

Kind = Literal["length", "angle", "result", "sense"]
Term = tuple[Step, int, complex]
PROTRACTOR = 57.3
"""Radius of a protractor, mm: an error of reading on its rim is that many times less in radians."""
CALCULATED = 0.005
"""What a number computed with three digits may be off by, as a share of it."""
SHORT = 5.0
"""Length in mm below which the direction of a vector is not asked for."""
RESTS = 0.02
"""Share of its greatest speed below which something rests."""
RESULTS = "results"
"""In place of a plan's name for what is computed from the measured lengths."""

_PLAIN = str.maketrans({
    "ω": "omega", "ε": "epsilon", "π": "pi", "ψ": "psi", "φ": "phi", "α": "alpha", "ρ": "rho", "δ": "delta", "Δ": "d", "μ": "mu",
    "τ": "t", "∠": "angle-", "′": "'", "’": "'", "`": "'", "″": "''", "–": "-", "—": "-", "−": "-", "\u0305": "", "{": "", "}": "",
    " ": "", "и": "i", "у": "u", "п": "p", "д": "d", "н": "n", "т": "t",
    **dict(zip("АВСЕОКМНРТХаеорсхк", "ABCEOKMHPTXaeopcxk", strict=True)),
})


def plain(name: str) -> str:
    """An id in ASCII: Greek letters by name, Russian ones that look like Latin as these; no code page can spoil it."""
    return name.translate(_PLAIN)


@dataclass(frozen=True)
class Measurable:
    """One quantity.

    Parameters
    ----------
    id
        plan, number of the position (not where there is one construction only) and quantity, with slashes between.
    plan, title
        name of the plan, and what the student knows it by.
    label
        number of the position.
    quantity
        as it stands on the plan, in the language of the sheets: |pb3|, V_D.
    unit
        of the number to be written, by its English name.
    kind
        a length on paper, an angle, a result, or the sense something turns in: +1 counter-clockwise, -1 clockwise.
    value
        exact value in that unit, for lengths with the scale factor of the sheets.
    terms
        gradient of the value by the steps it follows from directly, in the unit of the value per unit of the step.
    scale
        key of the scale factor of a length, or of the lengths a result is read from; "" where it has none.
    reading
        how many times the error of reading a ruler enters the value, in its unit, with the scale factor of the sheets.
    calculated
        further error of the value as a share of it.
    head
        the step that a length is drawn or measured for: where an error would lie.
    signed
        False where a magnitude is asked for; of an angle, where a line is meant that points neither way.
    slope
        of an angle on a diagram: keys of the scale factors of its abscissa and ordinate, which its tangent depends on.
    squares
        of an energy, which has no gradient where a point rests: factor, step, position, reading error per mm of each square.
    main
        False for what is asked for only where everything is.
    of
        the value from those of the steps of its terms; None where it grows by its gradient.
    """

    id: str
    plan: str
    title: str
    label: str
    quantity: str
    unit: str
    kind: Kind
    value: float
    terms: tuple[Term, ...] = ()
    scale: str = ""
    reading: float = 0.0
    calculated: float = 0.0
    head: Step | None = None
    signed: bool = False
    slope: tuple[str, str] | None = None
    squares: tuple[tuple[float, Step, int, float], ...] = ()
    main: bool = True
    of: Callable[..., float] | None = None

    def off(self, value: float, exact: float) -> float:
        """How far a number that is written so is off: without its sign where a magnitude is asked for, of angles the short way."""
        if self.kind == "angle":
            return angle_apart(value, exact, self.signed)
        return (value if self.signed else abs(value)) - exact

    @property
    def is_way(self) -> bool:
        """True for what tells only where a vector points or which way something turns."""
        return self.kind == "sense" or (self.kind == "angle" and len(self.terms) > 1)

    @property
    def steps(self) -> str:
        """Names of the steps it is measured between."""
        return " ".join(dict.fromkeys(letter_of(step) for step, _, _ in self.terms if not step.name.startswith("∂")))


@dataclass(frozen=True)
class Check:
    """How a result is computed from other numbers of the same file: ``compute`` takes them in the order of ``needs``.

    Lengths come multiplied by their scale factor.
    """

    needs: tuple[str, ...]
    compute: Callable[..., float]


@dataclass
class Measurables:
    """All of a project: entries by id, scale factors by key, and the plans with the key of the factor each is drawn with.

    ``on_paper`` are the keys of plans whose unit is the millimetre: there a scale factor only tells what the ordinates mean.
    ``notes`` say what is left out because it cannot be drawn.
    """

    entries: dict[str, Measurable] = field(default_factory=dict)
    scales: dict[str, Scale] = field(default_factory=dict)
    plans: list[tuple[Plan, str]] = field(default_factory=list)
    on_paper: set[str] = field(default_factory=set)
    notes: list[str] = field(default_factory=list)
    checks: dict[str, Check] = field(default_factory=dict)

    def check(self, result: str, needs: Iterable[str], compute: Callable[..., float]) -> None:
        """Note how a result follows from other numbers."""
        self.checks.setdefault(plain(result), Check(tuple(map(plain, needs)), compute))

    def mu(self, name: str) -> float:
        """Scale factor of a length; 1 for what is no length."""
        entry = self.entries[name]
        return self.scales[entry.scale].mu if self.is_drawn(entry) else 1.0

    @staticmethod
    def is_drawn(entry: Measurable) -> bool:
        """True for a length that has a scale factor."""
        return entry.kind == "length" and bool(entry.scale)

    def errors(self, factors: Mapping[str, float], pencil: float, reading: float) -> Errors:
        """Error analysis of all plans, drawn with other scale factors where these say so."""
        return Errors([(plan, 1.0 if plan.unit == "mm" else factors.get(key, self.scales[key].mu)) for plan, key in self.plans],
                      pencil, reading)

    def add(self, entry: Measurable) -> None:
        """Take an entry in, unless there is nothing to measure; of two with one id the first counts."""
        nothing = entry.kind == "result" and entry.value == 0 and not entry.reading and not entry.calculated
        if isfinite(entry.value) and not nothing:
            if entry.kind == "result" and not entry.calculated and entry.terms:
                entry = replace(entry, calculated=CALCULATED)
            self.entries.setdefault(plain(entry.id), replace(entry, id=plain(entry.id)))


def scale_of(plan: Plan, scales: Mapping[str, Scale], key: str = "") -> float:
    """Unit of a plan per millimetre of paper."""
    return 1.0 if plan.unit == "mm" else scales[key or plan.name].mu


def on_plan(plan: Plan, k: int, name: str, quantity: str, kind: Kind, value: float, terms: tuple[Term, ...], moves: bool = True,
            **more: Any) -> Measurable:
    """A number read off a plan at a position: a length with a ruler, mm, or an angle with a protractor, degrees."""
    label = plan.labels[k] if len(plan.labels) > 1 and moves else ""
    unit, reading = (MILLIMETRES, 1.0) if kind == "length" else (DEGREES, degrees(1 / PROTRACTOR))
    return Measurable("/".join(filter(None, (plan.name, label, name))), plan.name, plan.title, label, quantity, unit, kind, value,
                      terms, reading=reading, **more)


def length(plan: Plan, scales: Mapping[str, Scale], k: int, tail: Step, head: Step, name: str, main: bool = True) -> Measurable:
    """Distance of two points on paper, mm."""
    mu = scale_of(plan, scales)
    away = complex(value_at(head, k) - value_at(tail, k))
    u = away / abs(away) if away else 1 + 0j
    return on_plan(plan, k, name, f"|{name}|", "length", abs(away) / mu, ((tail, k, -u / mu), (head, k, u / mu)), scale=plan.name,
                   head=max(tail, head, key=lambda step: [*plan.steps].index(step.name)), main=main,
                   of=lambda a, b: abs(b - a) / mu)


def direction(*ends: complex) -> float:
    """Direction of a vector from one point to another, or from the pole, degrees counter-clockwise from the x axis."""
    return degrees(np.angle(ends[-1] - sum(ends[:-1]))) % 360


def way(plan: Plan, scales: Mapping[str, Scale], k: int, tail: Step, head: Step, name: str) -> Iterator[Measurable]:
    """Direction of a vector on paper; nothing of one too short to lay a protractor to."""
    away = complex(value_at(head, k) - value_at(tail, k))
    if abs(away) > SHORT * scale_of(plan, scales):
        turn = 1j * away / abs(away) ** 2 * degrees(1)
        # Where lines were crossed to find a point it tells which way they went.
        yield on_plan(plan, k, f"∠{name}", f"∠{name}", "angle", direction(away), ((tail, k, -turn), (head, k, turn)), signed=True,
                      main=rules.LINE_LINE in (head.rule, tail.rule), of=direction)


def sense(title: str, label: str, quantity: str, k: int, step: Step, main: bool) -> Iterator[Measurable]:
    """Which way something turns, +1 counter-clockwise; nothing of what does not, or hardly."""
    value = float(value_at(step, k))
    if abs(value) > RESTS * np.max(np.abs(step.value)):
        said = tell("sense of {quantity}: +1 counter-clockwise, −1 clockwise").format(quantity=quantity)
        yield Measurable(f"{RESULTS}/{label}/sense-{quantity}", RESULTS, title, label, said, "", "sense", float(np.sign(value)),
                         ((step, k, complex(1 / abs(value))),), signed=True, main=main, of=lambda x: float(np.sign(x.real)))


def measured_step(plan: Plan, scales: Mapping[str, Scale], k: int, step: Step, name: str = "", key: str = "", called: str = "",
                  **more: Any) -> Measurable:
    """A step that is a length, an angle or, of a diagram, a point whose ordinate is measured; ``called`` so on paper."""
    called = called or (spoken(name) if name else letter_of(step))
    more |= {"head": step, "moves": np.ndim(step.value) > 0}
    value, point = complex(value_at(step, k)), step.rule.gives == "point"
    if step.rule.gives in ("angle", "inclination"):
        return on_plan(plan, k, name or step.name, called, "angle", degrees(value.real), ((step, k, complex(degrees(1))),), **more)
    mu = scale_of(plan, scales, key)
    return on_plan(plan, k, name or step.name, called, "length", (value.imag if point else value.real) / mu,
                   ((step, k, (1j if point else 1 + 0j) / mu),), scale=key or plan.name, signed=True, **more)


def result(title: str, label: str, name: str, unit: str, value: float, terms: tuple[Term, ...], called: str = "",
           **more: Any) -> Measurable:
    """A result at a position, ``called`` so where its letter is not its name."""
    return Measurable(f"{RESULTS}/{label}/{name}", RESULTS, title, label, called or name, unit, "result", value, terms, **more)


def size(title: str, label: str, name: str, unit: str, k: int, step: Step, called: str = "", main: bool = True) -> Measurable:
    """Magnitude of a vector from the pole or of a number as a result."""
    value = complex(value_at(step, k))
    return result(title, label, name, unit, abs(value), ((step, k, value / abs(value) if value else 1 + 0j),), called, head=step,
                  main=main, of=abs)


def magnitude(entry: Measurable) -> Measurable:
    """An entry without its sign."""
    sign = -1 if entry.value < 0 else 1
    return replace(entry, signed=False, value=abs(entry.value), terms=tuple((s, k, sign * g) for s, k, g in entry.terms))


def angle_apart(a: float, b: float, sense: bool = False) -> float:
    """Difference of two angles in degrees, the short way round; a line drawn the other way is the same one without ``sense``."""
    half = 180.0 if sense else 90.0
    return (a - b + half) % (2 * half) - half


def scalar(found: Measurables, title: str, name: str, value: Any, unit: str, terms: Iterable[Term] = (), *, scale: str = "",
           reading: float = 0.0, signed: bool = True, part: str = "", main: bool = True) -> None:
    """A result of the whole project; its id begins with its ``part`` where another one has a result of that name, too."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        exact = isinstance(value, int)
        key = f"{part}-{name}" if plain(f"{RESULTS}/{name}") in found.entries else name
        entry = Measurable(f"{RESULTS}/{key}", RESULTS, title, "", name, unit, "result", float(value), tuple(terms), scale,
                           calculated=0.0 if exact else CALCULATED, reading=reading, signed=True, main=main)
        found.add(entry if signed else magnitude(entry))

