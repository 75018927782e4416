"""What can be measured on the sheets of a project, and the results that follow: one entry for each number a student can check.

An entry knows its exact value and how that changes with the steps of the construction; the error analysis of these very steps gives
its tolerance.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from math import degrees, isfinite, pi
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.protocol import letter_of, spoken
from tmm_sheets.construction.scale import Scale
from tmm_sheets.construction.step import Step, value_at
from tmm_sheets.words import marked, tell

if TYPE_CHECKING:
    from tmm_sheets.construction.step import Plan

# --- units: said in the reader's language, read in any ----------------------------------------------------------------------------

MILLIMETRES, DEGREES, METRES, TURNS = marked("mm"), "°", marked("m"), marked("rpm")
SPEED, ANGULAR_SPEED, ACCELERATION, ANGULAR_ACCELERATION = marked("m/s"), marked("rad/s"), marked("m/s²"), marked("rad/s²")
FORCE, MOMENT, MASS, INERTIA, ENERGY = marked("N"), marked("N·m"), marked("kg"), marked("kg·m²"), marked("kg·m²/s²")

_RADIAN = degrees(1)
SCALE = 0.1
"""Times as long as they should be that lengths may be in another unit, or drawn to another scale factor."""
OTHERS: Mapping[str, tuple[tuple[str, float], ...]] = {
    MILLIMETRES: ((METRES, 1e-3), (marked("cm"), SCALE)), DEGREES: ((marked("rad"), 1 / _RADIAN),),
    SPEED: ((marked("mm/s"), 1e3),), ACCELERATION: ((marked("mm/s²"), 1e3),), ANGULAR_SPEED: ((TURNS, 30 / pi),),
    FORCE: ((marked("kgf"), 1 / 9.81), (marked("kN"), 1e-3)), MOMENT: ((marked("N·mm"), 1e3), (marked("kgf·m"), 1 / 9.81)),
}
"""Units that are written by mistake for each, and how many times as large a number is in them."""
_LENGTHS: Mapping[str, float] = {"mm": 1.0, "cm": 10.0, "m": 1000.0}
_ANGLES: Mapping[str, float] = {"°": 1.0, "deg": 1.0, "rad": _RADIAN}
_LATIN: Mapping[str, str] = {
    "м": "m", "с": "s", "рад": "rad", "Н": "N", "кг": "kg", "мм": "mm", "см": "cm", "об": "rev", "мин": "min", "хв": "min",
    "Дж": "J", "град": "deg", "кН": "kN",
}
"""Russian and Ukrainian units."""
_CYRILLIC = re.compile("|".join(sorted(_LATIN, key=len, reverse=True)))


def latin(unit: str) -> str:
    """One spelling of a unit in any language: Latin letters, no spaces, dots and brackets."""
    bare = re.sub(r"[\s·⋅*^()?.]+", "", unit).replace("²", "2").replace("³", "3")
    bare = _CYRILLIC.sub(lambda name: _LATIN[name[0]], bare)
    return "rev/min" if bare == "rpm" else bare


def unit_times(unit: str, own: str) -> float:
    """How many units ``own`` one of the stated units has.

    Raises
    ------
    ValueError
        if they measure different things.
    """
    stated, wanted = latin(unit), latin(own)
    if not stated or stated == wanted or "?" in unit:  # a code page without superscripts writes м/с?
        return 1.0
    for table in (_LENGTHS, _ANGLES):
        if stated in table and wanted in table:
            return table[stated] / table[wanted]
    if unit.strip().startswith(("к", "k")) and latin(unit.strip()[1:]) == wanted:
        return 1000.0
    raise ValueError(unit)


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

    @property
    def is_distance(self) -> bool:
        """True for the distance of two points."""
        return len(self.terms) == 2 and not self.signed and self.terms[0][2] == -self.terms[1][2]

    @property
    def is_size(self) -> bool:
        """True for the magnitude of a force."""
        return len(self.terms) == 1 and not self.signed and self.terms[0][0].rule.gives == "force"

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


def length(plan: Plan, scales: Mapping[str, Scale], k: int, tail: Step, head: Step, name: str, key: str = "") -> Measurable:
    """Distance of two points on paper, mm."""
    key = key or plan.name
    mu = 1.0 if plan.unit == "mm" else scales[key].mu
    away = complex(value_at(head, k) - value_at(tail, k))
    u = away / abs(away) if away else 1 + 0j
    label = plan.labels[k] if len(plan.labels) > 1 else ""
    terms = ((tail, k, -u / mu), (head, k, u / mu))
    entry_id = "/".join(filter(None, (plan.name, label, name)))
    names = list(plan.steps)
    last = max(tail, head, key=lambda step: names.index(step.name))
    return Measurable(entry_id, plan.name, plan.title, label, f"|{name}|", MILLIMETRES, "length", abs(away) / mu, terms, key, 1.0,
                      head=last)


def way(plan: Plan, scales: Mapping[str, Scale], k: int, tail: Step, head: Step, name: str) -> Measurable | None:
    """Direction of a vector on paper, degrees counter-clockwise from the x axis; None of one too short to lay a protractor to."""
    away = complex(value_at(head, k) - value_at(tail, k))
    mu = 1.0 if plan.unit == "mm" else scales[plan.name].mu
    if not abs(away) > SHORT * mu:
        return None
    label = plan.labels[k] if len(plan.labels) > 1 else ""
    turn = 1j * away / abs(away) ** 2 * degrees(1)
    entry_id = "/".join(filter(None, (plan.name, label, f"∠{name}")))
    return Measurable(entry_id, plan.name, plan.title, label, f"∠{name}", DEGREES, "angle", degrees(np.angle(away)) % 360,
                      ((tail, k, -turn), (head, k, turn)), reading=degrees(1 / PROTRACTOR), signed=True)


def sense(title: str, entry_id: str, label: str, quantity: str, k: int, step: Step) -> Measurable | None:
    """Which way something turns, +1 counter-clockwise; None of what does not, or hardly."""
    value = float(value_at(step, k))
    if not abs(value) > RESTS * np.max(np.abs(step.value)):
        return None
    said = tell("sense of {quantity}: +1 counter-clockwise, −1 clockwise").format(quantity=quantity)
    return Measurable(entry_id, RESULTS, title, label, said, "", "sense", float(np.sign(value)),
                      ((step, k, complex(1 / abs(value))),), signed=True)


def measured_step(plan: Plan, scales: Mapping[str, Scale], k: int, step: Step, name: str = "", key: str = "",
                  called: str = "") -> Measurable:
    """A step that is a length, an angle or, of a diagram, a point whose ordinate is measured; ``called`` so on paper."""
    key = key or plan.name
    label = plan.labels[k] if len(plan.labels) > 1 and np.ndim(step.value) else ""
    called = called or (spoken(name) if name else letter_of(step))
    name = name or step.name
    entry_id = "/".join(filter(None, (plan.name, label, name)))
    value = complex(value_at(step, k))
    if step.rule.gives in ("angle", "inclination"):
        return Measurable(entry_id, plan.name, plan.title, label, called, DEGREES, "angle", degrees(value.real),
                          ((step, k, complex(degrees(1))),), reading=degrees(1 / PROTRACTOR), head=step)
    mu = 1.0 if plan.unit == "mm" else scales[key].mu
    along = 1j if step.rule.gives == "point" else 1 + 0j
    real = value.imag if step.rule.gives == "point" else value.real
    return Measurable(entry_id, plan.name, plan.title, label, called, MILLIMETRES, "length", real / mu,
                      ((step, k, along / mu),), key, 1.0, head=step, signed=True)


def size(title: str, entry_id: str, label: str, quantity: str, unit: str, k: int, step: Step,
         by: Step | None = None) -> Measurable:
    """Magnitude of a vector from the pole or of a number as a result."""
    value = complex(value_at(step, k))
    u = value / abs(value) if value else 1 + 0j
    return Measurable(entry_id, RESULTS, title, label, quantity, unit, "result", abs(value), ((step, k, u),), head=by)


def magnitude(entry: Measurable) -> Measurable:
    """The same entry asked for without its sign."""
    if entry.value >= 0:
        return replace(entry, signed=False)
    return replace(entry, signed=False, value=-entry.value, terms=tuple((s, k, -g) for s, k, g in entry.terms))


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

