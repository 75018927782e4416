"""What a student may have done otherwise: the mistakes that are made with recorded rules, each as changes that can be replayed.

A mistake is read off the rule of a step, never off its name: where a vector is laid off it may be laid off backwards, where a line
crosses another it may be drawn parallel for perpendicular, where there are two intersections the other one may be taken.

A :class:`Change` says of one step, at one position or at all, how it was done instead of its rule; :func:`replay` draws the
construction with such changes and gives any step's value then. Nothing is linear and no method is written a second time: what
follows is done by the rules of the record from what was drawn. Used so::

    errors = Errors([(plan, mu), ...])                      # plans that are on paper, for lengths of links to be kept
    k = plan["k"]                                           # Coriolis' acceleration, a vector laid off from its first argument
    value = replay(errors, [Change(k, laid_off_backwards, at=2)])
    value(plan["d5"])[2]                                    # where d5 came to lie at position 2

Changes of several mistakes go into one replay, a point that was displaced as well (:func:`displaced`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from inspect import signature
from typing import Any, Literal, get_args

import numpy as np

from tmm_sheets.compare import codes
from tmm_sheets.compare.codes import Number, Own, Remark, Sentence, joined
from tmm_sheets.construction import rules
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.protocol import letter_of
from tmm_sheets.construction.step import Rule, Step, value_at
from tmm_sheets.methods.linkage import forces, loads, motion, zhukovsky
from tmm_sheets.words import marked

Again = Callable[..., Any]
"""The step's own rule on other values of its arguments."""
Done = Callable[[Again, Sequence[Any]], Any]
"""How a step was done instead: from its own rule and the values of its arguments as they were drawn, for all positions."""


@dataclass(frozen=True)
class Change:
    """A step done otherwise than its rule says, at position number ``at`` or, without, at all of them."""

    step: Step
    done: Done
    at: int | None = None

    def made(self, again: Again, values: Sequence[Any], usual: Any) -> Any:
        """The step's value with this change; ``usual`` is that without it."""
        other = np.asarray(self.done(again, values))
        if self.at is None or not np.ndim(usual):
            return np.broadcast_to(other, np.shape(usual))[()]
        found = np.array(usual, dtype=np.result_type(usual, other))
        found[self.at] = other[self.at] if other.ndim else other
        return found


def replay(errors: Errors, changes: Iterable[Change]) -> Callable[[Step], Any]:
    """The construction with steps done otherwise: a function that gives any step's value then; NaN where it cannot be drawn."""
    by_step: dict[Step, list[Change]] = {}
    for change in changes:
        by_step.setdefault(change.step, []).append(change)

    def otherwise(step: Step, of_step: Sequence[Change]) -> Callable[[list[Any]], Any]:
        def done(values: list[Any]) -> Any:
            def again(*now: Any) -> Any:
                return errors.replayed(step, list(now))

            made = again(*values)
            for change in of_step:
                made = change.made(lambda *now, made=made: made if _same(now, values) else again(*now), values, made)
            return made

        return done

    return errors.redrawn({step: otherwise(step, of_step) for step, of_step in by_step.items()})


def _same(now: Sequence[Any], values: Sequence[Any]) -> bool:
    """True when the rule is asked for what changes before this one have made of the same arguments."""
    return len(now) == len(values) and all(a is b for a, b in zip(now, values, strict=True))


# --- ways to do a step otherwise -------------------------------------------------------------------------------------------


def opposite(again: Again, values: Sequence[Any]) -> Any:
    """With the other sign."""
    return -again(*values)


def laid_off(times: float) -> Done:
    """A vector laid off so many times as long from the point it begins at."""
    return lambda again, values: values[0] + times * (again(*values) - values[0])


laid_off_backwards = laid_off(-1.0)
"""A vector laid off the other way."""


def argument(i: int, other: Callable[[Any], Any]) -> Done:
    """With another value of argument number ``i``."""
    return lambda again, values: again(*values[:i], other(values[i]), *values[i + 1:])


def displaced(by: Any) -> Done:
    """Drawn off by so much, at each position by as much as is told of it."""
    def done(again: Again, values: Sequence[Any]) -> Any:
        made = np.asarray(again(*values))
        return made + (by if made.dtype.kind == "c" else by.real)

    return done


def of_position(k: int) -> Done:
    """With what belongs to another position."""
    return lambda again, values: np.asarray(again(*values))[k]


Kind = Literal["coriolis", "normal", "sense", "parallel", "intersection", "inertia", "force", "moment", "left out", "radii",
               "mirror", "crank", "neighbour", "scale"]
KINDS = get_args(Kind)
"""Kinds of mistakes, the more usual ones first."""
TOLD = 3
"""Mistakes that are told of those that cannot be told apart."""
RARITY: Mapping[str, float] = {"both parallel": 1.0, "crank": 2.0, "across": 2.0, "upside down": 2.0, "vector scale": 2.0}
"""Price of what is done more rarely than the rest, mm of ink that it must explain more; by the key of its words."""

LINKAGE = ("positions", "velocities", "accelerations", "loads", "moments", "lever")
"""Plans whose steps are tried, besides the force polygons."""
WORDS: Mapping[str, str] = {
    "coriolis": marked("the Coriolis acceleration, the vector to {step}, is laid off the other way"),
    "normal": marked("the normal acceleration, the vector to {step}, is laid off outwards instead of towards the centre"),
    "tangential": marked("the tangential acceleration, the vector to {step}, is laid off against ε"),
    "turning": marked("the sense of {step} is the other one"),
    "crank velocity": marked("the velocity of the crank pin, the vector to {step}, is laid off against the rotation"),
    "crank": marked("the crank turns the other way: point {step} is on the other side at every position"),
    "parallel": marked("for point {step} a line is drawn parallel to {other} instead of perpendicular"),
    "perpendicular": marked("for point {step} a line is drawn perpendicular to {other} instead of parallel"),
    "both parallel": marked("for point {step} both lines are drawn parallel instead of perpendicular, or the other way round"),
    "left out": marked("the vector to {step} is left out"),
    "side left out": marked("in the force polygon {other} is left out, before point {step}"),
    "radii exchanged": marked("the radii of the arcs to {step} are exchanged"),
    "intersection": marked("point {step} is the other intersection"),
    "assembly": marked("point {step} is the other intersection at every position: the other assembly"),
    "inertia": marked("the force of inertia {step} is taken along the acceleration instead of against it"),
    "inertia moment": marked("the moment of the inertia forces {step} is taken along ε instead of against it"),
    "force": marked("the force {step} is taken in the other sense"),
    "laid off": marked("in the force polygon {other} is laid off the other way, as the side to {step}"),
    "reaction": marked("{step} is taken in the sense of {other}, not opposite to it"),
    "component": marked("the component {step} is taken in the other sense"),
    "moment": marked("in the equation of moments {step} the moment of {other} has the wrong sign"),
    "across": marked("the plan is mirrored, left and right exchanged"),
    "upside down": marked("the plan is mirrored, top and bottom exchanged"),
    "plan scale": marked("all lengths of this plan are {other} times the exact ones: another scale factor?"),
    "computed scale": marked("what is computed from this plan is {other} times as large: another scale factor was taken"),
    "vector scale": marked("the vector to {step} is laid off {other} times as long: another scale factor"),
    "row": marked("that is the number of {other}: written into the wrong row?"),
    "positions": marked("the numbers of positions {other} are written into each other's rows"),
    "row before": marked("the column is shifted by a row: in {other} stands the number of the row before each"),
    "row after": marked("the column is shifted by a row: in {other} stands the number of the row after each"),
    "position before": marked("in {other} stands the number of the position before each"),
    "position after": marked("in {other} stands the number of the position after each"),
    "position": marked("for {step} the number of position {other} is taken"),
    "number": marked("for {step} the number of {other} is taken"),
    "drawn twice": marked("this is the plan of position {other}"),
    "numbering": marked("the positions are numbered from another start: {other}, and so on"),
    "unit": marked("the numbers are written in {other}"),
    "mechanism across": marked("the mechanism is drawn mirrored, left and right exchanged, and all plans with it"),
    "mechanism upside down": marked("the mechanism is drawn mirrored, top and bottom exchanged, and all plans with it"),
}
"""How they are told; ``step`` is where the mistake was made, ``other`` what it was mistaken for or done with."""
EVERYWHERE = Sentence("built-otherwise", marked("{mistake}, at every position"))


def built_otherwise(words: str, **fields: Any) -> Remark:
    """A mistake by the key of its words."""
    return Sentence("built-otherwise", WORDS[words])(**fields)


@dataclass(frozen=True)
class Hypothesis:
    """One mistake: its kind, the key of its words, the step it was made in, the changes to replay.

    ``at`` is the number of the position, None where it was made at every one; ``other`` what stands in the words besides.
    ``on_paper`` is the plan whose lengths are right all the same: only what was made of them is not. ``everywhere`` is what might
    have been done otherwise at one position only.
    """

    kind: Kind
    words: str
    step: Step
    changes: tuple[Change, ...]
    at: int | None = None
    other: str | Remark = ""
    on_paper: str = ""
    everywhere: bool = False

    @property
    def remark(self) -> Remark:
        """The mistake."""
        done = built_otherwise(self.words, step=letter_of(self.step), other=self.other)
        return EVERYWHERE(mistake=done) if self.everywhere else done

    def said(self) -> str:
        """The mistake as it is told to the reader."""
        return self.remark.said()

    def at_every_position(self) -> Hypothesis | None:
        """The mistake at every position; None if it already is, or cannot be."""
        if self.at is None or self.kind == "neighbour" or not np.ndim(self.step.value):
            return None
        return replace(self, changes=tuple(replace(change, at=None) for change in self.changes), at=None, everywhere=True)


def hypotheses(steps: Iterable[Step], k: int, labels: Sequence[str] = (), whole: Iterable[Step] = ()) -> Iterator[Hypothesis]:
    """Mistakes that can be made in some steps of the linkage at position number ``k``, and at every position.

    ``labels`` are those of the positions of these plans; steps of other plans, or with other positions, are left alone. ``whole``
    are all steps of their plans, where ``steps`` are some only: a plan is mirrored as a whole.
    """
    some = [s for s in steps if (s.plan in LINKAGE or s.plan.startswith("force-")) and np.shape(s.value) in ((), (len(labels),))]
    for step in some:
        yield from _of_step(step, k)
        # A computed number taken from the column of a neighbouring position.
        beside = {(k - 1) % len(labels), (k + 1) % len(labels)} - {k} if step.rule in COMPUTED and np.ndim(step.value) else ()
        yield from (Hypothesis("neighbour", "position", step, (Change(step, of_position(at), k),), k, Own(labels[at]))
                    for at in beside)
    by_plan: dict[str, list[Step]] = {}
    for step in some:
        by_plan.setdefault(step.plan, []).append(step)
    for name, of_plan in by_plan.items():
        yield from _other_angular_quantities(of_plan, k)
        if name in MIRRORED:
            yield from _mirrored([s for s in whole if s.plan == name] or of_plan, k)


def any_of(mistakes: Iterable[Hypothesis]) -> Remark:
    """Mistakes that cannot be told from each other."""
    done = joined((h.remark for h in mistakes), codes.OR)
    assert done is not None
    return done


# --- one step --------------------------------------------------------------------------------------------------------------

BACKWARDS: Mapping[Rule, tuple[Kind, str]] = {
    motion.CORIOLIS: ("coriolis", "coriolis"), motion.NORMAL: ("normal", "normal"),
    motion.TANGENTIAL: ("sense", "tangential"),
}
"""Vectors laid off from a point of their plan."""
FACTORS = (0.1, 0.2, 0.5, 2.0, 5.0, 10.0)
"""What scale factors differ by that are taken for each other."""
OTHER_SIGN: Mapping[Rule, tuple[Kind, str]] = {
    motion.ANGULAR_VELOCITY: ("sense", "turning"), motion.ANGULAR_ACCELERATION: ("sense", "turning"),
    motion.CRANK_VELOCITY: ("sense", "crank velocity"),
    forces.INERTIA: ("inertia", "inertia"), forces.COUPLE: ("inertia", "inertia moment"),
    forces.WEIGHT: ("force", "force"), loads.FORCE: ("force", "force"),
    forces.TANGENTIAL: ("force", "component"),
}
REACTIONS = (forces.OPPOSITE,)
MIRRORED = ("velocities", "accelerations")
"""Plans with a pole, about which they may be mirrored."""


def _of_step(step: Step, k: int) -> Iterator[Hypothesis]:
    """Mistakes that the rule of one step can be done with."""
    rule = step.rule
    if rule in BACKWARDS:
        kind, words = BACKWARDS[rule]
        yield Hypothesis(kind, words, step, (Change(step, laid_off_backwards, k),), k)
        yield Hypothesis("left out", "left out", step, (Change(step, laid_off(0.0), k),), k)
    if (rule in BACKWARDS or rule is rules.SHIFT) and isinstance(step.args[1], Step):
        yield from (Hypothesis("scale", "vector scale", step, (Change(step, laid_off(times), k),), k, Number(f"{times:g}"))
                    for times in FACTORS)
    if rule in OTHER_SIGN:
        kind, words = OTHER_SIGN[rule]
        yield Hypothesis(kind, words, step, (Change(step, opposite, k),), k)
    if rule is rules.SHIFT and isinstance(step.args[1], Step):
        yield Hypothesis("force", "laid off", step, (Change(step, laid_off_backwards, k),), k, letter_of(step.args[1]))
        yield Hypothesis("left out", "side left out", step, (Change(step, laid_off(0.0), k),), k, letter_of(step.args[1]))
    if rule in REACTIONS:
        yield Hypothesis("force", "reaction", step, (Change(step, opposite, k),), k, letter_of(step.args[0]))
    if rule is rules.LINE_LINE:
        some = [i for i in (1, 3) if isinstance(step.args[i], Step)]
        yield from (_turned(step, i, k) for i in some)
        if len(some) == 2:
            both = Change(step, lambda again, v: again(v[0], 1j * v[1], v[2], 1j * v[3], *v[4:]), k)
            yield Hypothesis("parallel", "both parallel", step, (both,), k)
    if rule is rules.ARC_ARC:
        exchanged = Change(step, lambda again, v: again(v[0], v[3], v[2], v[1], *v[4:]), k)
        yield Hypothesis("radii", "radii exchanged", step, (exchanged,), k)
    if rule is rules.LAY_OFF and np.ndim(step.value):
        first = float(value_at(step.args[2], 0))
        yield Hypothesis("crank", "crank", step, (Change(step, argument(2, lambda phi: 2 * first - phi)),))
    names = list(signature(rule.compute).parameters)
    if "side" in names:
        other = argument(names.index("side"), lambda side: -side)
        yield Hypothesis("intersection", "intersection", step, (Change(step, other, k),), k)
        if np.ndim(step.value):
            yield Hypothesis("intersection", "assembly", step, (Change(step, other),))
    yield from _moments(step, k)


def _turned(step: Step, i: int, k: int) -> Hypothesis:
    """A line drawn parallel for perpendicular, or the other way round."""
    line: Step = step.args[i]
    change = Change(step, argument(i, lambda u: 1j * u), k)
    if line.rule is rules.TURN:
        return Hypothesis("parallel", "parallel", step, (change,), k, letter_of(line.args[0]))
    return Hypothesis("parallel", "perpendicular", step, (change,), k, letter_of(line))


def of_other_positions(steps: Sequence[Step], k: int, labels: Sequence[str]) -> Iterator[Hypothesis]:
    """The plan of another position drawn, or measured, for that of position ``k``; ``steps`` are its points."""
    some = [s for s in steps if np.size(s.value) == len(labels) > 1]
    for other, label in enumerate(labels) if some else ():
        if other != k:
            changes = tuple(Change(s, of_position(other), k) for s in some)
            yield Hypothesis("neighbour", "drawn twice", some[-1], changes, k, Own(label))


def _moments(step: Step, k: int) -> Iterator[Hypothesis]:
    """One term of an equation of moments with the wrong sign: a force or a couple."""
    if step.rule is forces.MOMENTS:
        terms = [i for i in range(1, len(step.args)) if i % 3 != 1]
    elif step.rule is zhukovsky.BALANCE:
        terms = list(range(4, len(step.args), 2))
    else:
        return
    for i in terms:
        term = step.args[i]
        if isinstance(term, Step) and complex(value_at(term, k)):
            yield Hypothesis("moment", "moment", step, (Change(step, argument(i, lambda x: -x), k),), k, letter_of(term))


# --- a number of a neighbour -----------------------------------------------------------------------------------------------

TURNING = (motion.ANGULAR_VELOCITY, motion.ANGULAR_ACCELERATION)
COMPUTED = (*TURNING, forces.INERTIA, forces.COUPLE, loads.FORCE, loads.MOMENT)


def _other_angular_quantities(steps: Sequence[Step], k: int) -> Iterator[Hypothesis]:
    """The angular velocity or acceleration of another link taken."""
    for rule in TURNING:
        of_rule = [s for s in steps if s.rule is rule]
        for step in of_rule:
            for other in of_rule:
                if other is not step:
                    yield Hypothesis("neighbour", "number", step, (Change(step, _takes_instead(other), k),), k, letter_of(other))


def _takes_instead(other: Step) -> Done:
    return lambda again, values: other.value


# --- a whole plan ----------------------------------------------------------------------------------------------------------


def _mirrored(steps: Sequence[Step], k: int) -> Iterator[Hypothesis]:
    """A plan drawn as its own mirror image about its pole: all lengths are right in it, what is taken from it is not."""
    here = {id(s) for s in steps}
    moved = [s for s in steps if s.rule.gives in ("point", "vector")]
    last = moved[-1] if moved else None
    for words, mirror in (("across", lambda z: -np.conj(z)), ("upside down", np.conj)):
        changes = tuple(Change(s, _seen_through(s, here, mirror, mirror), k) for s in moved)
        changes += tuple(Change(s, _sense_from(s, here, mirror), k) for s in steps if s.rule in TURNING)
        if last is not None:
            yield Hypothesis("mirror", words, last, changes, k)


def computed_with(steps: Sequence[Step], times: float) -> Hypothesis:
    """Numbers taken from a plan with another scale factor than it is drawn with: ``times`` as large, all its lengths right."""
    here = {id(s) for s in steps}
    moved = [s for s in steps if s.rule.gives in ("point", "vector")]
    changes = tuple(Change(s, _seen_through(s, here, lambda z: times * z, lambda z: z / times)) for s in moved)
    return Hypothesis("scale", "computed scale", moved[-1], changes, other=Number(f"{times:.3g}"),
                      on_paper=moved[-1].plan)


def _seen_through(step: Step, here: set[int], to: Callable[[Any], Any], back: Callable[[Any], Any]) -> Done:
    """Done from the plan's own points as they would lie without a mirror, or to another scale, and seen through it then."""
    return lambda again, values: to(again(*_back(step, values, here, back)))


def _sense_from(step: Step, here: set[int], mirror: Callable[[Any], Any]) -> Done:
    """A number whose size comes from lengths, which are right, and whose sense from how they lie."""
    return lambda again, values: np.copysign(again(*_back(step, values, here, mirror)), again(*values))


def _back(step: Step, values: Sequence[Any], here: set[int], mirror: Callable[[Any], Any]) -> list[Any]:
    """Values of the arguments with the plan's own points as they would lie unmirrored."""
    own = [isinstance(a, Step) and id(a) in here and a.rule.gives in ("point", "vector") for a in step.args]
    return [mirror(v) if mine else v for v, mine in zip(values, own, strict=False)]
