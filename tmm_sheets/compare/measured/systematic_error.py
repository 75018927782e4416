"""What was done otherwise with a whole table, before its numbers are judged one by one.

Another unit, the mechanism drawn as in a mirror, positions numbered from another start: each makes most numbers of its kind wrong
at once, and none of them follows from any step. The table is read as it was meant then, and judged so.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tmm_sheets.compare.codes import Own, Remark, Sentence
from tmm_sheets.compare.diagnosis.hypotheses import Hypothesis, Kind
from tmm_sheets.compare.measured import measured_units as units
from tmm_sheets.compare.measured.judged import JudgedValue
from tmm_sheets.compare.measured.measurable import angle_apart
from tmm_sheets.compare.measured.measured_file import MeasuredLine
from tmm_sheets.words import marked

REACH = 2.0
"""Tolerances beyond which a number is off, and within which it is explained."""
FEW, MOST = 4, 0.85
"""Fewer numbers than this must all be explained, more of them to this share."""
POSITIONS = "positions"
"""Name of the plan of the positions."""
UNIT = Sentence("unit", marked("{unit}, not {own}"))
ROWS = Sentence("built-otherwise", marked("in the rows of position {position} stand the numbers of position {other}"))
LEAST = 2
"""Numbers that a mistake of the whole table must explain at the least."""


@dataclass(frozen=True)
class SystematicError:
    """A mistake with the whole table, and what the numbers it concerns were meant to be, by their ids; what ``times`` their last
    digit is.
    """

    mistake: Hypothesis
    meant: Mapping[str, float]
    times: float = 1.0

    def line(self, line: MeasuredLine) -> MeasuredLine:
        """A line as it was meant."""
        value = self.meant.get(line.entry.id)
        return line if value is None else replace(line, value=value, half_digit=line.half_digit * self.times)


def whole_table(judged: Sequence[JudgedValue], labels: Sequence[str]) -> SystematicError | None:
    """The mistake with the whole table that explains most numbers; None without. ``labels`` are those of the positions."""
    plans = [j for j in judged if j.entry.plan != POSITIONS]  # else the crank only turns the other way
    found = [(count, whole) for whole in (*_units(judged), *_mirrored(judged), *_numbered(judged, labels))
             if (count := _explained(judged, whole.meant)) and (whole.mistake.kind != "mirror" or _explained(plans, whole.meant))]
    return max(found, key=lambda x: x[0])[1] if found else None


def mark(judged: Sequence[JudgedValue], wholes: Sequence[SystematicError], written: Sequence[JudgedValue]) -> None:
    """Tell the mistakes at the first number each explains; the others follow from it. ``written`` are the numbers as they were
    judged without.
    """
    for place, whole in enumerate(wholes):
        of = [(j, was) for j, was in zip(judged, written, strict=True) if j.entry.id in whole.meant]
        # What is wrong besides is told besides, by what it was meant to be.
        explained = [(j, was) for j, was in of if j.verdict != "red" and not j.starts]
        shown = [j for j, was in explained if was.verdict == "red"]
        for j, was in of:
            j.line = was.line
        for j, was in explained:
            j.deviation, j.noted, j.inconsistent = was.deviation, None, False
            j.follows = shown[0] if shown and was.verdict != "green" else None
        if shown:
            first = shown[0]
            first.starts, first.wrong, first.mistake, first.follows = True, (whole.mistake,), None, None
            first.order = place - len(wholes)  # before anything that was drawn


def _explained(judged: Sequence[JudgedValue], meant: Mapping[str, float]) -> int:
    """How many numbers are in order as they were meant, and were not so; none where not nearly all are."""
    shown = [j for j in judged if j.entry.id in meant and np.isfinite(j.tolerance)
             and abs(_off(j, j.line.value) - _off(j, meant[j.entry.id])) > 2 * REACH * j.tolerance]
    good = sum(abs(_off(j, meant[j.entry.id])) <= REACH * j.tolerance < abs(j.deviation) for j in shown)
    return good if LEAST <= good >= (len(shown) if len(shown) < FEW else MOST * len(shown)) else 0


def _off(j: JudgedValue, value: float) -> float:
    """How far a number is off if it is written so."""
    if j.entry.kind == "angle":
        return angle_apart(value, j.exact, j.entry.signed)
    return (value if j.entry.signed else abs(value)) - j.exact


def _whole(kind: Kind, words: str, some: Sequence[JudgedValue], meant: Sequence[float], other: str | Remark = "",
           times: float = 1.0) -> Iterator[SystematicError]:
    step = next((j.entry.terms[-1][0] for j in some if j.entry.terms), None)
    if step is not None:
        ids = [j.entry.id for j in some]
        yield SystematicError(Hypothesis(kind, words, step, (), other=other), dict(zip(ids, meant, strict=True)), times)


def _units(judged: Sequence[JudgedValue]) -> Iterator[SystematicError]:
    """All numbers of one unit written in another; lengths also those of one plan, where no scale factor is so far off."""
    of_unit: dict[str, list[JudgedValue]] = defaultdict(list)
    of_plan: dict[tuple[str, str], list[JudgedValue]] = defaultdict(list)
    for j in judged:
        of_unit[j.entry.unit].append(j)
        of_plan[j.entry.unit, j.entry.plan].append(j)
    for unit, some in of_unit.items():
        for other, times in units.OTHERS.get(unit, ()):
            plans = [of for (u, _), of in of_plan.items() if u == unit]
            for group in ([some] if len(plans) > 1 or times != units.SCALE else []) + (plans if times < units.SCALE else []):
                said = UNIT(unit=Remark("", other), own=Remark("", unit))
                yield from _whole("scale", "unit", group, [j.line.value / times for j in group], said, 1 / times)


def _mirrored(judged: Sequence[JudgedValue]) -> Iterator[SystematicError]:
    """The mechanism, and with it all plans, drawn as in a mirror."""
    some = [j for j in judged if j.entry.kind in ("angle", "sense")]
    if len({j.entry.plan for j in some}) > 1:
        for words, half in (("mechanism across", 180.0), ("mechanism upside down", 0.0)):
            meant = [half - j.line.value if j.entry.kind == "angle" else -j.line.value for j in some]
            yield from _whole("mirror", words, some, meant)


def _numbered(judged: Sequence[JudgedValue], labels: Sequence[str]) -> Iterator[SystematicError]:
    """Positions numbered from another start: the rows of each have the numbers of another, as far on for all."""
    rows: dict[tuple[str, str, str], dict[str, JudgedValue]] = defaultdict(dict)
    for j in judged:
        if j.entry.label in labels:
            rows[j.entry.plan, j.entry.title, j.entry.quantity][j.entry.label] = j
    if len({plan for plan, _, _ in rows}) < 2:
        return
    for by in range(1, len(labels)):
        after = {at: labels[(k + by) % len(labels)] for k, at in enumerate(labels)}  # the position whose numbers its rows have
        before = {now: at for at, now in after.items()}
        meant = [(j, of[before[at]].line.value if before[at] in of else j.exact) for of in rows.values()
                 for at, j in of.items() if before[at] in of or (after[at] in of and _is(j, of[after[at]]))]
        yield from _whole("neighbour", "numbering", [j for j, _ in meant], [value for _, value in meant],
                          ROWS(position=Own(labels[0]), other=Own(labels[by])))


def _is(j: JudgedValue, other: JudgedValue) -> bool:
    """Whether a row has the number of another."""
    return abs(_off(other, j.line.value)) <= REACH * other.tolerance
