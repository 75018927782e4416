"""Machines of the transport universities (manual 003): ``transport/<machine>@<cipher>``.

The cipher chooses a column for every row of the manual's tables; a project file is filled in with the numbers, each with
the table, letter and column it comes from. Where the figures are lost, arrangements and loads are taken as
templates/schemes/transport_*.toml and variants/transport/loads.toml have them.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from math import acos, cos, degrees, radians, sin
from typing import TYPE_CHECKING, Any

from tmm_sheets import resources, spelling
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.task import headings
from tmm_sheets.task.filling import filled
from tmm_sheets.task.misprint import Misprint
from tmm_sheets.words import marked, tell, tell_n

if TYPE_CHECKING:
    from tmm_sheets.task.variant import Variant

MACHINES = ("diesel", "press", "compressor", "crusher")
GRAVITY = 9.81
POSITIONS = 12
SWEEP = 720
"""Crank angles per turn at which the conditions of assembly are looked at; every twelfth part is one of them."""

# --- cipher ---------------------------------------------------------------------------------------------------------

LOOK_ALIKE = str.maketrans("ABCEHKMOPTXY", "АВСЕНКМОРТХУ")
"""Latin capitals that stand for the Cyrillic letters of the same shape."""
LATIN = {"Т": "Т", "ЕРS": "ЭПС", "V": "В", "SDМ": "СДМ"}
"""Latin spellings of the specialties, after :data:`LOOK_ALIKE`."""


@dataclass(frozen=True)
class Cipher:
    """A student's cipher: ``text`` as it is printed, ``digits`` by letter а..ж."""

    text: str
    speciality: str
    digits: Mapping[str, int]

    def __str__(self) -> str:
        return "".join(map(str, self.digits.values()))


def cipher(text: str) -> Cipher:
    """Digits of a cipher such as ``01-Т-27``: year of admission, specialty (either alphabet), number.

    Raises
    ------
    BadInput
        when it is no cipher.
    """
    rule = _data("cipher")
    found = re.fullmatch(r"\s*([0-9]{1,4})\s*[-–—]\s*([^\W\d_]{1,6})\s*[-–—]\s*([0-9]{1,12})\s*", text)
    if found is None:
        raise BadInput(tell('not a cipher: "{text}"').format(text=text), hint=tell(
            "expected year of admission, specialty and number, for example 01-Т-27 (letters of either alphabet)"))
    year, letters, number = found.groups()
    name = letters.upper().translate(LOOK_ALIKE)
    speciality = LATIN.get(name, name)
    count = rule["count"]
    last = number[-count:].ljust(count, rule["padding"])
    digits = dict(zip(rule["letters"], map(int, year[-1] + last + last), strict=True))
    return Cipher(f"{year}-{speciality}-{number}", speciality, digits)


# --- tables ---------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Value:
    """A number of the project: as it is written there, as a number where it is one, and where it comes from."""

    text: str
    number: float
    source: str


@cache
def _data(name: str) -> dict[str, Any]:
    path = resources.variants() / "transport" / f"{name}.toml"
    return tomllib.loads(path.read_text(encoding="utf-8"))


def chosen(rows: Iterable[Mapping[str, Any]], digits: Mapping[str, int], corrected: bool = False) -> dict[str, Value]:
    """Value of every row in the column its letter has in the cipher."""
    found = {}
    for row in rows:
        column = digits[row["letter"]]
        value = row["values"][column]
        source = f"003, table {row['table']}, {row.get('symbol', row['key'])}: letter {row['letter']}, column {column}"
        if "printed_letter" in row:
            source += f"; printed letter {row['printed_letter'] or 'lost'}"
        if "note" in row:
            source += f"; {row['note']}"
        suggested = row.get("suggested", {}).get(str(column))
        if suggested is not None and corrected:
            source += f"; printed {value}, suspected misprint"
            value = suggested
        found[row["key"]] = Value(str(value), value if isinstance(value, int | float) else 0.0, source)
    return found


@dataclass(frozen=True)
class Doubt(Misprint):
    """A misprint with the table and the column where it stands."""

    table: str
    column: int

    def warning(self) -> str:
        """One line about it."""
        said = (
            tell("table {table}, {symbol}, column {column}: {printed}{unit} is probably a misprint of {suggested}{unit} "
                 "({reason}); {value:g} is used") if self.corrected else
            tell("table {table}, {symbol}, column {column}: {printed}{unit} is probably a misprint of {suggested}{unit} "
                 "({reason}); {value:g} is kept; --corrected takes the other one"))
        return said.format(
            table=self.table, symbol=self.symbol, column=self.column, printed=self.printed, unit=self.unit and f" {self.unit}",
            suggested=self.suggested, reason=tell(self.reason), value=self.suggested if self.corrected else self.printed,
        )  # fmt: skip


def misprints(rows: Iterable[Mapping[str, Any]], digits: Mapping[str, int], corrected: bool) -> Iterator[Doubt]:
    """The suspected misprints among the values that the cipher chooses."""
    for row in rows:
        column = digits[row["letter"]]
        suggested = row.get("suggested", {}).get(str(column))
        if suggested is not None:
            yield Doubt(row.get("symbol", row["key"]), row.get("unit", ""), Decimal(str(row["values"][column])),
                        Decimal(str(suggested)), row["misprint"], corrected, row["table"], column)


# --- reading --------------------------------------------------------------------------------------------------------


def names() -> tuple[str, ...]:
    """The four machines, each with a cipher."""
    examples = _data("cipher")["examples"]
    return tuple(f"transport/{machine}@{examples[machine]}" for machine in MACHINES)


def heading(name: str) -> dict[str, Any]:
    """Table ``[project]`` of a machine and a cipher.

    Raises
    ------
    BadInput
        when there is no such cipher.
    """
    machine, _, code = name.removeprefix("transport/").partition("@")
    return headings.of(_scheme(f"transport_{machine}"), _named(machine, cipher(code)))


def read(name: str, corrected: bool = False) -> Variant:
    """Project of a machine and a cipher, e.g. ``transport/diesel@01-Т-27``.

    Raises
    ------
    BadInput
        when there is no such machine or cipher.
    CannotBuild
        when the lengths that the cipher chooses make no mechanism.
    """
    from tmm_sheets.task import variant

    text, warnings, doubts = project_file(name, corrected)
    return variant.parse(text, name, warnings, doubts)


def project_file(name: str, corrected: bool = False) -> tuple[str, tuple[str, ...], tuple[Doubt, ...]]:
    """Text of the project file of a machine and a cipher, what is doubtful in it, the misprints among that.

    Raises
    ------
    BadInput
        when the machine is unknown or there is no cipher.
    """
    machine, at, code = name.removeprefix("transport/").partition("@")
    if machine not in MACHINES:
        near = spelling.near(machine, MACHINES)
        raise BadInput(tell('unknown machine "{machine}" of manual 003').format(machine=machine),
                       hint=tell("did you mean {near}?").format(near=f"transport/{near[0]}") if near else
                       tell("known are {known}").format(known=", ".join(MACHINES)))
    example = _data("cipher")["examples"][machine]
    if not at:
        raise BadInput(tell("transport/{machine} needs a cipher").format(machine=machine),
                       hint=tell("write for example {name}").format(name=f"transport/{machine}@{example}"))
    student = cipher(code)
    data = _data(machine)
    values = chosen(data["row"], student.digits, corrected)
    notes = []
    if student.speciality != data["speciality"]:
        notes.append(tell("the ciphers of specialty {own} have this machine, not those of {given}").format(
            own=data["speciality"], given=student.speciality))
    doubts = (*misprints(data["row"], student.digits, corrected), *misprints(_data("cam")["row"], student.digits, corrected))
    notes += [doubt.warning() for doubt in doubts]
    values |= DERIVED[machine](values)
    refuse(machine, values)
    notes += NOTES[machine](values)
    values |= {key: Value(value, 0.0, "") for key, value in (_named(machine, student) | {"digits": str(student)}).items()}
    cam = chosen(_data("cam")["row"], student.digits, corrected)
    parts = [_filled(scheme, values | {"n_cam": cam["n"]})
             for scheme in (f"transport_{machine}", f"transport_reducer_{machine}", "transport_gear")]
    return "".join((*parts, _cam(cam))), tuple(notes), doubts


def _named(machine: str, student: Cipher) -> dict[str, str]:
    """What is filled into the heading."""
    return {"name": f"transport/{machine}@{student.text}", "cipher": student.text}


def _scheme(name: str) -> str:
    return resources.template(f"schemes/{name}.toml").read_text(encoding="utf-8")


def _filled(scheme: str, values: Mapping[str, Value]) -> str:
    return filled(_scheme(scheme), values)


def _derived(**numbers: tuple[float, str]) -> dict[str, Value]:
    return {key: Value(f"{number!r}", number, source) for key, (number, source) in numbers.items()}


def _loads(machine: str) -> dict[str, Value]:
    """Diagrams and bores taken by us, as text of the project file."""
    return {key: Value(_toml(value), value if isinstance(value, int | float) else 0.0, "taken by us (принято)")
            for key, value in _data("loads")[machine].items()}


def _toml(value: Any) -> str:
    if isinstance(value, list):
        return "[" + ", ".join(map(_toml, value)) + "]"
    return f'"{value}"' if isinstance(value, str) else repr(value)


# --- machines -------------------------------------------------------------------------------------------------------


def _masses(values: Mapping[str, Value], unit: float, *links: int) -> dict[str, Value]:
    """Masses of links whose weights are given in ``unit`` newtons."""
    name = {1.0: "N", 1000.0: "kN"}[unit]
    return _derived(**{f"m{i}": (values[f"G{i}"].number * unit / GRAVITY,
                                 f"G/g, G = {values[f'G{i}'].text} {name}: {values[f'G{i}'].source}") for i in links})


def _cylinders(values: Mapping[str, Value]) -> dict[str, Value]:
    theta, source = values["theta"].number, values["theta"].source
    return _derived(left=(90 + theta / 2, source), right=(90 - theta / 2, source), half=(theta / 2, source))


def _of_diesel(values: Mapping[str, Value]) -> dict[str, Value]:
    ab, ad, bd = (values[key].number for key in ("l_AB", "l_AD", "l_BD"))
    if ad + bd <= ab:
        raise CannotBuild(tell(
            "triangle ABD of the main rod is impossible: l_AD + l_BD <= l_AB, {ad} + {bd} <= {ab} "
            "({lack} too short); it fails at every position, the first is 12").format(
                ad=_mm(ad), bd=_mm(bd), ab=_mm(ab), lack=_mm(ab - ad - bd)))
    if abs(bd - ad) >= ab:
        raise CannotBuild(tell(
            "triangle ABD of the main rod is impossible: |l_BD - l_AD| >= l_AB, |{bd} - {ad}| >= {ab} "
            "({excess} too long); it fails at every position, the first is 12").format(
                ad=_mm(ad), bd=_mm(bd), ab=_mm(ab), excess=_mm(abs(bd - ad) - ab)))
    alpha = degrees(acos((ab * ab + ad * ad - bd * bd) / (2 * ab * ad)))
    rule = f"angle BAD by the law of cosines from l_AB = {ab:g}, l_AD = {ad:g}, l_BD = {bd:g}; {values['l_BD'].source}"
    return _cylinders(values) | _masses(values, 1.0, 2, 3, 4, 5) | _derived(alpha=(alpha, rule)) | _loads("diesel")


def _of_press(values: Mapping[str, Value]) -> dict[str, Value]:
    return _masses(values, 1.0, 1, 2, 3, 4, 5) | _loads("press")


def _of_compressor(values: Mapping[str, Value]) -> dict[str, Value]:
    return _cylinders(values) | _masses(values, 1.0, 2, 3, 4, 5) | _loads("compressor")


def _of_crusher(values: Mapping[str, Value]) -> dict[str, Value]:
    return _masses(values, 1000.0, 2, 3, 4, 5) | _loads("crusher")


DERIVED: dict[str, Callable[[Mapping[str, Value]], dict[str, Value]]] = {
    "diesel": _of_diesel, "press": _of_press, "compressor": _of_compressor, "crusher": _of_crusher,
}
"""What follows from a machine's table: masses, angles, loads."""


def _mm(length: float) -> str:
    return tell("{length:.4g} mm").format(length=1000 * length)


# --- conditions of assembly -----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Condition:
    """A condition of assembly in the manual's symbols: it fails where ``lack`` (m, at every angle) is positive.

    ``worst`` is the greatest lack of the whole turn; where it is known exactly, zero already is a failure (the links stretch
    or fold flat and lock).
    """

    said: str
    lack: Any
    worst: float | None = None

    @property
    def fails(self) -> bool:
        """Whether it fails anywhere."""
        return bool((self.lack > 0).any()) if self.worst is None else self.worst >= 0


@dataclass(frozen=True)
class TurnOfMachine:
    """Points of a machine over one turn from position 12 on (m, world frame, shape (SWEEP,)), conditions in order of attachment."""

    points: dict[str, Any]
    conditions: tuple[Condition, ...]

    @property
    def failure(self) -> Condition | None:
        """The first condition that fails; those of the links attached after it cannot be judged."""
        return next((c for c in self.conditions if c.fails), None)


def turn(machine: str, numbers: Mapping[str, float]) -> TurnOfMachine:
    """Assemble a machine at :data:`SWEEP` crank angles of one turn."""
    import numpy as np

    phi = 2 * np.pi / SWEEP * np.arange(SWEEP)
    with np.errstate(invalid="ignore"):
        return ASSEMBLED[machine](numbers["l_OA"] * 1j * np.exp(-1j * phi), numbers)


def _slider(start: Any, length: float, axis: complex) -> tuple[Any, Any]:
    """End of a rod on a line through O along the unit vector ``axis``, and by how much the rod is too short."""
    turned = start * axis.conjugate()
    return axis * (turned.real + (length**2 - turned.imag**2) ** 0.5), abs(turned.imag) - length


def _hinge(p: Any, r: float, q: complex, s: float, side: int) -> tuple[Any, Any, Any]:
    """Third corner of a triangle, left (+1) of the line from ``p`` to ``q``, and by how much they are too far and too near."""
    d = abs(q - p)
    along = (d * d + r * r - s * s) / (2 * d)
    corner = p + (along + 1j * side * (r * r - along * along) ** 0.5) * (q - p) / d
    return corner, d - r - s, abs(r - s) - d


def _turn_of_diesel(a: Any, n: Mapping[str, float]) -> TurnOfMachine:
    b, short3 = _slider(a, n["l_AB"], _axis(90 + n["theta"] / 2))
    d = a + (b - a) / n["l_AB"] * n["l_AD"] * _axis(-n["alpha"])
    c, short5 = _slider(d, n["l_DC"], _axis(90 - n["theta"] / 2))
    return TurnOfMachine({"A": a, "B": b, "D": d, "C": c}, (
        Condition(marked("max|y_A| > l_AB (slider 3: A lies farther from the axis of cylinder 6 than AB reaches)"), short3),
        Condition(marked("max|y_D| > l_DC (slider 5: D lies farther from the axis of cylinder 7 than DC reaches)"), short5)))


def _turn_of_compressor(a: Any, n: Mapping[str, float]) -> TurnOfMachine:
    b, short3 = _slider(a, n["l_AB"], _axis(90 - n["theta"] / 2))
    c, short5 = _slider(a, n["l_AC"], _axis(90 + n["theta"] / 2))
    return TurnOfMachine({"A": a, "B": b, "C": c}, (
        Condition(marked("max|y_A| > l_AB (slider 3: A lies farther from the axis of cylinder 6 than AB reaches)"), short3),
        Condition(marked("max|y_A| > l_AC (slider 5: A lies farther from the axis of cylinder 7 than AC reaches)"), short5)))


def _turn_of_press(a: Any, n: Mapping[str, float]) -> TurnOfMachine:
    d = complex(-n["X"], n["Y"])
    b, *lacks = _hinge(a, n["l_AB"], d, n["l_BD"], 1)
    c, short = _slider(b - d.real, n["l_BC"], -1j)
    return TurnOfMachine({"A": a, "B": b, "C": c + d.real}, (
        *_four_bar(n, d, lacks),
        Condition(marked("max|x_B - x_D| > l_BC (slider 5: B lies farther from the guide than BC reaches)"), short)))


def _turn_of_crusher(a: Any, n: Mapping[str, float]) -> TurnOfMachine:
    d, e = complex(n["X1"], -n["Y1"]), complex(-n["X2"], n["Y2"])
    b, *lacks = _hinge(a, n["l_AB"], d, n["l_BD"], -1)
    c, far, near = _hinge(b, n["l_BC"], e, n["l_EC"], 1)
    return TurnOfMachine({"A": a, "B": b, "C": c}, (
        *_four_bar(n, d, lacks),
        Condition(marked("|BE| > l_BC + l_EC (group 4-5: B lies farther from E than BC and EC reach)"), far),
        Condition(marked("|BE| < |l_EC - l_BC| (group 4-5: B lies nearer to E than BC and EC can come)"), near)))


def _four_bar(n: Mapping[str, float], d: complex, lacks: Iterable[Any]) -> tuple[Condition, Condition]:
    """Conditions under which the crank of the four-bar O-A-B-D turns all the way round."""
    far, near = lacks
    lack = far + (near - far) * (near > far)
    rod, crank, frame, rocker = n["l_AB"], n["l_OA"], abs(d), n["l_BD"]
    return (
        Condition(
            marked("l_AB + l_OA >= |OD| + l_BD (four-bar O-A-B-D locks: crank and rod outstretched are too long)"),
            lack,
            rod + crank - frame - rocker,
        ),
        Condition(
            marked("l_AB - l_OA <= ||OD| - l_BD| (four-bar O-A-B-D locks: crank folded over the rod leaves too little)"),
            lack,
            abs(frame - rocker) - rod + crank,
        ),
    )


ASSEMBLED: dict[str, Callable[[Any, Mapping[str, float]], TurnOfMachine]] = {
    "diesel": _turn_of_diesel, "press": _turn_of_press, "compressor": _turn_of_compressor, "crusher": _turn_of_crusher,
}
"""Assembly of each machine from the crank pin A at every angle and the numbers of its table."""


def refuse(machine: str, values: Mapping[str, Value]) -> None:
    """Refuse dimensions that fail a condition.

    Raises
    ------
    CannotBuild
        naming the condition, by how much it fails, and where first in the sense of rotation.
    """
    condition = turn(machine, _numbers(values)).failure
    if condition is None:
        return
    lack = condition.lack
    step = SWEEP // POSITIONS
    numbered = [k for k in range(POSITIONS) if lack[k * step] > 0]
    worst = int(lack.argmax())
    amount = float(lack[worst]) if condition.worst is None else condition.worst
    refusal = (tell("{condition}: by {amount}, first at position {position}") if numbered else
               tell("{condition}: by {amount}, {angle:g} deg after position 12, between the numbered positions"))
    raise CannotBuild(refusal.format(condition=tell(condition.said), amount=_mm(amount), angle=360 * worst / SWEEP,
                                     position=(numbered[0] or POSITIONS) if numbered else ""),
                      tell("the lengths that this cipher chooses make no mechanism: ask for another column of the table"))


def _numbers(values: Mapping[str, Value]) -> dict[str, float]:
    return {key: value.number for key, value in values.items()}


def _axis(angle: float) -> complex:
    """Unit vector under an angle in degrees."""
    return complex(cos(radians(angle)), sin(radians(angle)))


# --- notes ----------------------------------------------------------------------------------------------------------


def _signs(machine: str, values: Mapping[str, Value], pistons: Mapping[str, tuple[str, complex, Callable[[float, bool], float]]]
           ) -> Iterator[str]:
    """Where the sign found from a piston's velocity is another one than the manual's list has."""
    import numpy as np

    points = turn(machine, _numbers(values)).points
    listed = _data("loads")["signs"][machine]
    for link, (point, axis, excess) in pistons.items():
        way = (points[point] * np.conj(axis)).real
        speed = np.roll(way, 1) - np.roll(way, -1)
        share = (way.max() - way) / np.ptp(way)
        differ = []
        for k in range(1, POSITIONS + 1):
            i = k * SWEEP // POSITIONS % SWEEP
            dead = abs(speed[i]) < 1e-3 * np.abs(speed).max()
            driving = excess(float(share[i]), bool(speed[i] > 0)) * speed[i] > 0
            if not dead and driving != (k in listed[link]):
                differ.append((tell("{k} (driving)") if driving else tell("{k} (resisting)")).format(k=k))
        if differ:
            yield tell_n("piston {link}: the force has the sign of the piston's velocity; the manual's list has the other one at "
                         "position {positions}",
                         "piston {link}: the force has the sign of the piston's velocity; the manual's list has the other one at "
                         "positions {positions}", len(differ)).format(link=link, positions=", ".join(differ))


def _diesel_notes(values: Mapping[str, Value]) -> Iterator[str]:
    left, right = _axis(values["left"].number), _axis(values["right"].number)
    yield from _signs("diesel", values, {"3": ("B", left, lambda x, down: 1.0), "5": ("C", right, lambda x, down: 1.0)})


def _compressor_notes(values: Mapping[str, Value]) -> Iterator[str]:
    loads = _data("loads")["compressor"]

    def excess(stage: int) -> Callable[[float, bool], float]:
        def over(share: float, down: bool) -> float:
            pairs = loads[f"stage{stage}_{'down' if down else 'up'}"]
            x, p = [pair[0] for pair in pairs], [float(pair[1].split()[0]) for pair in pairs]
            i = max(i for i in range(len(x) - 1) if x[i] <= share)
            return float(p[i] + (p[i + 1] - p[i]) * (share - x[i]) / (x[i + 1] - x[i]) - loads["ambient"])

        return over

    left, right = _axis(values["left"].number), _axis(values["right"].number)
    yield from _signs("compressor", values, {"3": ("B", right, excess(1)), "5": ("C", left, excess(2))})


def _press_notes(values: Mapping[str, Value]) -> Iterator[str]:
    b = turn("press", _numbers(values)).points["B"]
    if (b.real + values["X"].number).max() > 0:
        yield tell("the toggle crosses the straight line: the slider has two lowest positions in one turn; "
                   "its working stroke ends at the first of them")


def _crusher_notes(values: Mapping[str, Value]) -> Iterator[str]:
    yield from ()


NOTES: dict[str, Callable[[Mapping[str, Value]], Iterator[str]]] = {
    "diesel": _diesel_notes, "press": _press_notes, "compressor": _compressor_notes, "crusher": _crusher_notes,
}
"""What is worth telling about a machine beside its numbers."""


# --- cam ------------------------------------------------------------------------------------------------------------

FOLLOWERS = {"а": "translating", "б": "oscillating"}
CLOSURES = {"силовое": ("force", "rise"), "геометрическое": ("geometric", "both")}
"""Closure in the project file, and the phases whose pressure angle is limited: with force closure the rise only."""


def _cam(values: dict[str, Value]) -> str:
    """``[cam]`` from the values of table 2.9."""
    closure, limit = CLOSURES[values["closure"].text]
    law = _data("cipher")["laws"][values["law"].text]
    values |= {
        "law": Value(law, 0.0, values["law"].source), "closure": Value(closure, 0.0, values["closure"].source),
        "limit": Value(limit, 0.0, f"{values['closure'].text} замыкание"),
    }
    values |= _derived(J=(values["J_1e4"].number * 1e-4, values["J_1e4"].source))
    return _filled(f"transport_cam_{FOLLOWERS[values['scheme'].text]}", values)
