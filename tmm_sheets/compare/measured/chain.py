"""Judging measured numbers, and the first step where a chain of errors starts.

The numbers are taken in the order of drawing. What an earlier mistake does to a later number is told by drawing again with it: if
what remains of a deviation is within tolerance, the number follows from that mistake and is not accused on its own. Otherwise a
new chain starts, with what explains most of what is left (:mod:`~tmm_sheets.compare.measured.mistake_search`): something done
otherwise, or a step drawn off. A number whose deviation explains nothing else was read or computed wrong.

Before that the table is read as it was meant (:func:`whole_table`).
Another unit, the mechanism drawn as in a mirror, positions numbered from another start: each makes most numbers of its kind wrong
at once, and none of them follows from any step. The table is read as it was meant then, and judged so.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from math import atan, degrees, hypot, isfinite, radians, tan
from statistics import NormalDist

import numpy as np

from tmm_sheets.compare import codes
from tmm_sheets.compare.codes import Number, Own, Remark, Sentence, joined
from tmm_sheets.compare.diagnosis.hypotheses import TOLD, Hypothesis, Kind
from tmm_sheets.compare.elements import grouped
from tmm_sheets.compare.measured import measurable as units
from tmm_sheets.compare.measured.evidence import CURVED, REACH, Evidence, Explanation, JudgedValue, Place, place_of
from tmm_sheets.compare.measured.measurable import CALCULATED, Measurable, Measurables, angle_apart
from tmm_sheets.compare.measured.measured_file import FilledTable, MeasuredLine, factor_of
from tmm_sheets.compare.measured.mistake_search import explanation
from tmm_sheets.compare.measured.recomputation import OwnNumbers, OwnValue
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.step import Step, value_at
from tmm_sheets.numbers import rounded
from tmm_sheets.words import marked

NEARLY_ALL = 0.85
"""Share of the numbers it concerns that a mistake of the whole table must explain: of three or fewer all."""
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
    found = [(count, whole) for whole in (*_units(judged), *_mirrored(judged), *_numbered(judged, labels), *_rescaled(judged))
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
             and abs(j.off(j.line.value) - j.off(meant[j.entry.id])) > 2 * REACH * j.tolerance]
    good = sum(abs(j.off(meant[j.entry.id])) <= REACH * j.tolerance < abs(j.deviation) for j in shown)
    return good if LEAST <= good >= NEARLY_ALL * len(shown) else 0


def _whole(kind: Kind, words: str, some: Sequence[JudgedValue], meant: Sequence[float], other: str | Remark = "",
           times: float = 1.0) -> Iterator[SystematicError]:
    step = next((j.entry.terms[-1][0] for j in some if j.entry.terms), None)
    if step is not None:
        yield SystematicError(Hypothesis(kind, words, step, (), other=other),
                              {j.entry.id: value for j, value in zip(some, meant, strict=True)}, times)


def _units(judged: Sequence[JudgedValue]) -> Iterator[SystematicError]:
    """All numbers of one unit written in another; lengths also those of one plan, where no scale factor is so far off."""
    for unit, some in grouped(judged, lambda j: j.entry.unit).items():
        plans = [*grouped(some, lambda j: j.entry.plan).values()]
        for other, times in units.OTHERS.get(unit, ()):
            for group in ([some] if len(plans) > 1 or times != units.SCALE else []) + (plans if times < units.SCALE else []):
                said = UNIT(unit=Remark("", other), own=Remark("", unit))
                yield from _whole("scale", "unit", group, [j.line.value / times for j in group], said, 1 / times)


def _mirrored(judged: Sequence[JudgedValue]) -> Iterator[SystematicError]:
    """The mechanism, and with it all plans, drawn as in a mirror."""
    some = [j for j in judged if j.entry.kind in ("angle", "sense")]
    if len({j.entry.plan for j in some}) > 1:
        for words, half in (("mechanism across", 180.0), ("mechanism upside down", 0.0)):
            yield from _whole("mirror", words, some, [half * (j.entry.kind == "angle") - j.line.value for j in some])


def _numbered(judged: Sequence[JudgedValue], labels: Sequence[str]) -> Iterator[SystematicError]:
    """Positions numbered from another start: the rows of each have the numbers of another, as far on for all."""
    numbered = grouped((j for j in judged if j.entry.label in labels), lambda j: (j.entry.plan, j.entry.title, j.entry.quantity))
    rows = {row: {j.entry.label: j for j in some} for row, some in numbered.items()}
    for by in range(1, len(labels)) if len({plan for plan, _, _ in rows}) > 1 else ():
        after = {at: labels[(k + by) % len(labels)] for k, at in enumerate(labels)}  # the position whose numbers its rows have
        before = {now: at for at, now in after.items()}
        meant = [(j, of[before[at]].line.value if before[at] in of else j.exact) for of in rows.values()
                 for at, j in of.items() if before[at] in of or (after[at] in of and abs(
                     of[after[at]].off(j.line.value)) <= REACH * of[after[at]].tolerance)]
        yield from _whole("neighbour", "numbering", [j for j, _ in meant], [value for _, value in meant],
                          ROWS(position=Own(labels[0]), other=Own(labels[by])))


def _rescaled(judged: Sequence[JudgedValue]) -> Iterator[SystematicError]:
    """The lengths of a plan to another scale factor than stated: all so many times as long."""
    lengths = (j for j in judged if j.entry.kind == "length" and j.entry.scale and j.line.factor is None)
    for some in grouped(lengths, lambda j: j.entry.scale).values():
        value, exact, tolerance = np.array([(j.off(j.line.value) + j.exact, j.exact, j.tolerance) for j in some]).T
        long = np.abs(exact) > LONG_ENOUGH * tolerance
        if long.sum() < SCALED:
            continue
        # The lengths are not equally exact: of what each tells the best, then all that agree with it together.
        told = value[long] / exact[long]
        agree = np.abs(value - told[:, None] * exact) <= REACH * tolerance * np.maximum(told[:, None], 1.0)
        weight = np.where(agree[agree.sum(1).argmax()], exact / tolerance**2, 0.0)
        times = float(weight @ value / (weight @ exact))
        # A long side drawn a little wrong makes a plan a little smaller, too, but not all of it.
        like = abs(times - 1) <= SIMILAR_SCALES and (np.abs(value - times * exact) > tolerance * max(times, 1.0)).any()
        if times > 0 and abs(times - 1) > APART and not like:
            yield from _whole("scale", "plan scale", some, [j.line.value / times for j in some], Number(f"{times:.3g}"), 1 / times)


SCALED, LONG_ENOUGH = 4, 5.0
"""Lengths of a plan from which a wrong scale factor is recognised, of so many tolerances at least."""
SIMILAR_SCALES, APART = 0.15, 0.01
"""Difference of two scale factors, as a share, below which all lengths must tell of it, and below which they are one."""
WHOLES = 3
"""Mistakes with the whole table that are looked for."""
MOST = 10
"""Mistakes that are looked for; where there are more, another mechanism was drawn."""
ANOTHER, FIRST_TRIED = 1 / 3, 1
"""Share of red numbers from which on, where the first mistakes looked for leave half of that, it is another variant."""
SHARE = 0.5
"""Share of the tolerance that a mistake must make of a number to explain it."""
LONG = 10.0
"""Length in mm that a pencil can draw: one that has a larger error than itself comes from a degenerate construction."""
ANY_WAY = 60.0
"""Tolerance of an angle, degrees, with which it may be any."""
CHANCE = 1e-3
"""How often a file without any mistake may be accused of one."""
EXACT = 1e-6
"""Tolerance of what is neither drawn nor computed: numbers of teeth."""


def judge(filled: FilledTable, found: Measurables, pencil: float, reading: float) -> list[JudgedValue]:
    """Judge every filled line, in the order of the sheets."""
    errors = found.errors(filled.factors, pencil, reading)
    numbers = {name: i for i, name in enumerate(found.entries)}
    # In the order of the sheets, so that steps are numbered plan after plan as they are drawn.
    lines = sorted(filled.lines, key=lambda line: numbers[line.entry.id])
    written = judged = [_judged(line, found, filled.factors, errors, reading) for line in lines]
    labels = next((plan.labels for plan, _ in found.plans if plan.name == "positions"), ())
    wholes: list[SystematicError] = []
    while len(wholes) < WHOLES and (whole := whole_table(judged, labels)) is not None:
        wholes.append(whole)
        lines = [whole.line(line) for line in lines]
        judged = [_judged(line, found, filled.factors, errors, reading) for line in lines]
    computed = _check_arithmetic(judged, filled, found)
    # What was computed rightly from other numbers of the file is no witness of its own: it is as wrong as they are.
    if judged:
        own = OwnNumbers(judged, errors)
        left = [j for j in judged if id(j) not in computed]
        _against_own(own, {id(j) for j in left})
        _chains(Evidence(left, errors, labels), own, computed)
    for j in judged:
        if id(j) in computed and j.verdict != "green":
            origin = _origin(j, computed)
            j.follows = origin if origin is not j else None
        if j.verdict == "red" and not j.starts and j.follows is None:
            j.noted = j.noted or codes.BY_CHANCE(n=len(judged))
    mark(judged, wholes, written)
    return judged


def _origin(j: JudgedValue, computed: Mapping[int, list[JudgedValue]]) -> JudgedValue:
    """The number in which the error of another one starts: that which it follows from or, of the numbers it was rightly computed
    from, the worst one; itself where nothing else is known to be wrong.
    """
    wrong = [n for n in computed.get(id(j), ()) if n.verdict != "green"]
    if j.follows is None and wrong:
        return _origin(max(wrong, key=lambda n: abs(n.deviation) / n.tolerance), computed)
    return j.follows or j


def _judged(line: MeasuredLine, found: Measurables, factors: Mapping[str, float], errors: Errors, reading: float) -> JudgedValue:
    e = line.entry
    ratio = found.scales[e.scale].mu / factor_of(line, found.scales, factors) if e.scale else 1.0
    size = ratio if e.kind == "length" else 1.0
    error, rows = errors.of_sum(e.terms)
    # On diagrams the pencil's millimetres stay what they are, whatever the ordinates mean.
    error *= size if e.scale not in found.on_paper else 1 / ratio if e.kind == "result" else 1.0
    rows = [(s, k, g * size) for s, k, g in rows if _depends_noticeably(s, k, g * size, error, errors)]
    exact = e.value * size if e.slope is None else _tilted(e.value, e.slope, found, factors)
    read = e.reading * reading / (ratio if e.kind == "result" else 1.0)
    # A ruler is read no better than its reading is written.
    written = line.half_digit if e.terms or e.calculated else 0.0
    own = hypot(max(read, written), e.calculated * exact)
    tolerance = hypot(error, own, _of_squares(e, errors, reading, ratio))
    if e.kind == "sense":
        # One way or the other: of what turns by less than its own error neither is wrong.
        tolerance, rows = 0.5 if tolerance < 0.5 else float("inf"), []
    # What cannot be drawn, and what is so badly conditioned that its error is as large as itself.
    elif not isfinite(tolerance) or tolerance > {"length": max(abs(exact), LONG), "angle": ANY_WAY}.get(e.kind, tolerance):
        tolerance = float("inf")
    judged = JudgedValue(line, exact, e.off(line.value, exact), max(tolerance, EXACT), rows, size=size, reading=own,
                         order=max((errors.order(s) for s, _, _ in e.terms), default=len(found.entries)))
    judged.noted = _noted(judged, line.value if e.signed else abs(line.value), tolerance)
    return judged


def _depends_noticeably(step: Step, k: int, g: complex, error: float, errors: Errors) -> bool:
    """False for what a number depends on by nothing but rounding: a thousandth of the step does a millionth of the error."""
    most = max(errors.error_at(step, k), 1e-3 * abs(complex(value_at(step, k))))
    return isfinite(abs(g)) and abs(g) * most > 1e-6 * error


def _of_squares(e: Measurable, errors: Errors, reading: float, ratio: float) -> float:
    """Error of the squares of an energy beyond their gradient; ``reading`` in mm, ``ratio`` of the scale factors."""
    return sum(2 * factor * (errors.error_at(step, k) ** 2 + (per_mm / ratio * reading) ** 2)
               for factor, step, k, per_mm in e.squares)


def _noted(judged: JudgedValue, measured: float, tolerance: float) -> Remark | None:
    """What is recognised at sight: a degenerate construction, a wrong sign, a slip of the pen."""
    if tolerance == float("inf"):
        return codes.DEGENERATES()
    if judged.verdict != "red":
        return None
    if judged.entry.kind == "sense":
        return codes.TURNS_BACK()
    if judged.entry.kind == "angle":
        opposite = abs(angle_apart(judged.deviation, 180.0, sense=True))
        return codes.POINTS_OTHER_WAY() if judged.entry.signed and opposite <= judged.tolerance else None
    if judged.entry.signed and abs(-measured - judged.exact) <= tolerance:
        return codes.SIGN()
    return _slip(measured, judged.exact, tolerance, judged.entry.unit)


def _tilted(angle: float, slope: tuple[str, str], found: Measurables, factors: Mapping[str, float]) -> float:
    """Angle of a line of a diagram, degrees, when its axes have other scale factors."""
    x, y = (factors.get(key, found.scales[key].mu) / found.scales[key].mu for key in slope)
    return degrees(atan(tan(radians(angle)) * x / y))


def _slip(measured: float, exact: float, tolerance: float, unit: str) -> Remark | None:
    """Slips of the pen that are recognised at sight: another unit, a factor of two or ten."""
    slips = [(factor, codes.AS_IF_IN(unit=Remark("", other))) for other, factor in units.OTHERS.get(unit, ())
             if factor != units.SCALE]
    slips += [(factor, codes.TIMES(times=Number(f"{factor:g}"))) for factor in (10.0, 0.1, 2.0, 0.5, 100.0, 0.01, 1000.0, 0.001)]
    return next((remark for factor, remark in slips if abs(measured / factor - exact) <= tolerance and abs(exact) > 3 * tolerance),
                None)


# --- arithmetic --------------------------------------------------------------------------------------------------------------


def _check_arithmetic(judged: list[JudgedValue], filled: FilledTable, found: Measurables) -> dict[int, list[JudgedValue]]:
    """Compute results again from the numbers they should have come from: only rounding may stand between them.

    A result that is exact but for rounding is right, wherever it came from. Returns the numbers that each result, by its id(),
    was rightly computed from.
    """
    computed: dict[int, list[JudgedValue]] = {}
    by_id = {j.entry.id: j for j in judged}
    for result, check in found.checks.items():
        j = by_id.get(result)
        needs = [by_id[name] for name in check.needs if name in by_id]
        if j is None or len(needs) != len(check.needs):
            continue
        mu = [factor_of(n.line, found.scales, filled.factors) if found.is_drawn(n.entry) else 1.0 for n in needs]
        values = [n.line.value * times for n, times in zip(needs, mu, strict=True)]
        expected = check.compute(*values)
        # Where large parts leave little, rounding these counts.
        parts = [expected]
        allowed = j.line.half_digit
        for i, n in enumerate(needs):
            near, none = ([*values[:i], x, *values[i + 1:]] for x in (values[i] + n.line.half_digit * mu[i], 0.0))
            allowed += abs(check.compute(*near) - expected)
            with suppress(ZeroDivisionError):
                parts.append(expected - check.compute(*none))
        allowed += CALCULATED * max(map(abs, parts))
        apart = j.line.value - expected if j.entry.signed else abs(j.line.value) - abs(expected)
        if abs(apart) <= allowed:
            # Rounding of numbers that are in order makes none wrong.
            computed |= {id(j): needs} if j.verdict != "red" or any(n.verdict != "green" for n in needs) else {}
        elif abs(j.deviation) > CALCULATED * abs(j.exact) + j.line.half_digit:
            j.inconsistent = True
            j.noted = joined((j.noted, _contradicts_own_numbers(needs, expected)), "; ")
    return computed


def _contradicts_own_numbers(own: Iterable[JudgedValue], value: float) -> Remark:
    """That a number does not follow from some of the student's own, which give another value."""
    numbers = joined(Remark("", "{quantity} = {value}", (
        ("quantity", j.entry.quantity), ("value", Number(rounded(j.line.value, 5))))) for j in own)
    return codes.OWN_GIVES(numbers=numbers, value=Number(rounded(value, 4)))


# --- chains -------------------------------------------------------------------------------------------------------------------


def _chains(evidence: Evidence, own: OwnNumbers, computed: Mapping[int, list[JudgedValue]]) -> None:
    """Explain the red numbers one after another in the order of drawing, each by the mistake that explains most along with it."""
    judged = evidence.judged
    open_ = np.array([j.verdict == "red" for j in judged])
    beyond, tried = _beyond_chance(len(judged)), 0
    most_is_wrong = open_.mean() > ANOTHER if len(open_) else False
    while open_.any():
        if most_is_wrong and tried > FIRST_TRIED and open_.mean() > ANOTHER / 2:
            for i in np.flatnonzero(open_).tolist():
                judged[i].starts, judged[i].follows = True, None
            return  # no mistake explains that: another variant
        first = min(np.flatnonzero(open_), key=lambda i: (judged[i].order, i))
        start = judged[first]
        open_[first] = False
        start.follows = None if start.off_own else _own_reason(own, start, computed)
        if start.follows is not None or (not start.off_own and abs(start.deviation) <= beyond * start.tolerance):
            continue
        start.starts = True
        tried += 1
        found = explanation(evidence, int(first), most_is_wrong) if tried <= MOST else None
        if found is not None:
            open_[_tell_mistake(evidence, start, found, beyond)] = False
            if found.then is not None and (second := _shows(evidence, start, found.then)) is not None:
                second.starts, second.follows = True, None
                open_[[judged.index(second), *_tell_mistake(evidence, second, found.then, beyond)]] = False
    for j in judged:
        if j.verdict == "red" and not j.starts and j.follows is None:
            j.follows = _own_reason(own, j, computed)


def _tell_mistake(evidence: Evidence, start: JudgedValue, found: Explanation, beyond: float) -> list[int]:
    """Tell a mistake at the number it was looked for; the numbers that follow from it."""
    start.mistake, start.wrong = found.mistake, found.wrong
    return list(_follow(evidence, start, found, beyond))


def _shows(evidence: Evidence, start: JudgedValue, found: Explanation) -> JudgedValue | None:
    """The number that shows most of the second of two mistakes, where that was made if one does; None where none does."""
    by = np.where(np.isfinite(found.shares), np.abs(found.shares), 0.0) / evidence.tolerance
    judged, at = evidence.judged, found.wrong[0].at
    label = start.entry.label if at is None else evidence.labels[at]
    others = [i for i, j in enumerate(judged) if j.verdict == "red" and not j.starts and j.entry.label == label]
    best = max(others, key=lambda i: (evidence.proves(judged[i], found.wrong[0]) and by[i] > 1, float(by[i])), default=None)
    return judged[best] if best is not None and by[best] > 1 else None


def _follow(evidence: Evidence, start: JudgedValue, found: Explanation, beyond: float) -> Iterator[int]:
    """Take from all numbers what a mistake makes of them; those that are in order then follow from the number it starts with."""
    before_all, after_all = evidence.left.copy(), evidence.after(found.shares)
    evidence.accept(found)
    for i, (j, share, doubt) in enumerate(zip(evidence.judged, found.shares, found.doubt, strict=True)):
        before, after = before_all[i], after_all[i]
        if not evidence.reached(found, i) or (j.verdict == "green" and abs(before) <= j.tolerance) or not isfinite(share):
            continue  # the mistake did not reach it, or with it nothing could be drawn
        uncertain = abs(before) > j.tolerance and evidence.uncertain(i, after)
        if found.wrong and abs(after) > abs(before) and not uncertain:
            continue  # it was gone on with otherwise
        evidence.left[i] = after
        # What is left need not be better than other numbers: amber is accused of nothing.
        allowed = (beyond if j.verdict == "red" else 1) * hypot(j.tolerance, float(doubt))
        explained = abs(evidence.left[i]) <= allowed and abs(share) > SHARE * j.tolerance and abs(evidence.left[i]) < abs(before)
        explained = explained or uncertain
        surely = abs(share) > 2 * j.tolerance and abs(after) <= j.tolerance
        if explained and (found.wrong or surely) and j.off_own and j is not start:
            # Not from his own numbers by the rule, but by what he did instead or where he drew it.
            j.off_own = j.starts = False
            j.noted = None
        if explained and not j.starts:
            yield i
            if j.follows is None:
                j.follows = start


def _beyond_chance(count: int) -> float:
    """Deviation in tolerances that none of so many numbers has by chance; a tolerance is what is kept nineteen times of twenty."""
    normal = NormalDist()
    return max(2.0, normal.inv_cdf(1 - CHANCE / (2 * max(count, 1))) / normal.inv_cdf(0.975))


def _own_reason(own: OwnNumbers, j: JudgedValue, computed: Mapping[int, list[JudgedValue]]) -> JudgedValue | None:
    """The mistake that a red number follows from by the student's own earlier numbers; None when it does not follow from them."""
    made = own.value(j)
    if made is None or not isfinite(made.tolerance) or abs(j.deviation - made.expected) > 2 * hypot(
            made.tolerance, CURVED * made.expected):
        return None
    for earlier, part in made.reasons:
        origin = _origin(earlier, computed)
        if (origin.starts or origin is not earlier) and abs(part) > SHARE * abs(made.expected):
            return origin
    return None


def _against_own(own: OwnNumbers, left: set[int]) -> None:
    """Accuse what does not follow from the student's own numbers that it was drawn or computed from, also where a pencil might
    have made it; but not what is right although they are wrong, nor what stands on a point that was seen wrong before.
    """
    beyond = _beyond_chance(len(own.judged))
    seen: set[Place] = set()
    for j in own.judged:
        judgeable = id(j) in left and isfinite(j.tolerance) and not j.inconsistent and not j.entry.is_way
        made = own.value(j) if judgeable else None
        if made is not None and seen.isdisjoint(made.known_in_part) and _contradicts(j, made, beyond):
            j.off_own = j.starts = True
            j.noted = _contradicts_own_numbers([m for m, _ in made.reasons[:TOLD]], j.exact + made.expected)
        if j.verdict == "red":
            seen |= {place_of(step, k) for step, k, _ in j.entry.terms}


def _contradicts(j: JudgedValue, made: OwnValue, beyond: float) -> bool:
    """Whether a number does not follow from those it was made of; a right one is no mistake where they are wrong."""
    apart, doubt = abs(j.deviation - made.expected), CURVED * made.expected
    # Of a point or a force that is off only one direction was measured.
    half_known = any(m.verdict == "red" and np.iscomplexobj(step.value) for m, _ in made.reasons for step, _, _ in m.entry.terms)
    return apart > beyond * max(hypot(j.reading, doubt), hypot(made.tolerance, doubt)) and not half_known and (
        j.verdict == "red" or all(m.verdict == "green" for m, _ in made.reasons))
