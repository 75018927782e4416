"""The lesson of a polygon: its vector equations, and what is drawn one thing after another, each with its question and its size.

A lesson is told without numbers. The page puts in those of the crank angle and of the given lengths: values of steps, and products
of them. Vectors of which all is known come first, each line of an unknown length right behind the vector it begins at, then the
point where the lines cross, the rate of turning that follows from it, points by similarity.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from itertools import takewhile
from typing import TYPE_CHECKING, Any, NamedTuple

from tmm_sheets.construction import protocol, rules
from tmm_sheets.construction.step import Plan, Step
from tmm_sheets.mechanism.groups.contexts import CLOSE
from tmm_sheets.methods.linkage import motion
from tmm_sheets.note.sections.kinematics import vector_equations
from tmm_sheets.words import marked, tr

if TYPE_CHECKING:
    from tmm_sheets.project import Project
    from tmm_sheets.record.step_index import StepIndex

ROTATION = marked("A point of a turning link moves across the line to the centre, by ω·l.")


class Laid(NamedTuple):
    """A vector of known size: its title and why it is so, the power of the rate of turning and which argument that is.

    ``ends`` are the arguments that are the ends of what it is times; it stands ``across`` that, turned by a quarter.
    """

    title: str
    why: str
    power: int
    rate: int
    ends: tuple[int, int]
    across: bool = True


LAID = {
    motion.CRANK_VELOCITY: Laid(marked("Velocity of the crank pin"), ROTATION, 1, 2, (0, 1)),
    motion.RIGID: Laid(marked("Velocity of rotation"), ROTATION, 1, 1, (2, 3)),
    motion.NORMAL: Laid(marked("Normal acceleration"),
                     marked("A point that goes round a centre is drawn to it, the more the faster: ω²·l."), 2, 1, (2, 3), False),
    motion.TANGENTIAL: Laid(marked("Tangential acceleration"),
                         marked("The link turns faster and faster: its point gains ε·l across the link."), 1, 1, (2, 3)),
    motion.CORIOLIS: Laid(marked("Coriolis acceleration"),
                       marked("The block slides on a link that turns: half comes from the turning of its velocity, "
                              "half from the growing radius."), 1, 1, (2, 3)),
}
OTHERS = {
    "force": (marked("Force"), ""),
    "line": (marked("Direction without length"),
             marked("The direction is known from the pair or the link, the length is not: a line, underlined once.")),
    "meet": (marked("The lines cross"), marked("Two directions give two lengths: both are measured on the plan.")),
    "similar": (marked("Similarity"),
                marked("The figure of a link and that of its vectors are similar and lettered the same way round.")),
    "rate": (marked("How the link turns"), marked("The vector put to its point on the mechanism shows the sense of turning.")),
    "close": (marked("The polygon closes"), marked("A link in balance has a closed polygon of forces.")),
    "draw": (marked("Construction"), ""),
}
"""Titles of other stops, and why what is drawn is so."""
SIGNS = {
    "n": marked("is normal: towards the centre of rotation"),
    "τ": marked("is tangential: across the link, where its turning speeds up or slows down"),
    "к": marked("is the Coriolis acceleration: of a block on a link that turns"),
    "r": marked("is relative: along the line on which the block slides"),
}
"""What signs above accelerations mean."""
COINCIDENT = re.compile(r"_\{?([A-Z])(\d)\}?$")
"""Index of the vector of a point of a numbered link."""
RATES = (motion.ANGULAR_VELOCITY, motion.ANGULAR_ACCELERATION)


def lessons(project: Project, index: StepIndex, known: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Lessons of the plans of velocities, accelerations and forces whose steps the page computes; ``known`` are the ids of these.

    Each has ``plan``, ``equations`` (``end``, a step, ``head``, a symbol, and ``sides`` of terms: ``symbol``, ``tail``, ``head``,
    ``times`` it is underlined) and ``stops``, see :class:`_Lesson`.
    """
    study = project.study
    found = [_Lesson(index, of.plan, _of_motion(project, of.plan)) for of in (study.velocities, study.accelerations)]
    if "forces" in vars(study):
        found += [_Lesson(index, one.plan, [(None, "0", [one.sides])]) for one in study.forces.plans.values()]
    made = [lesson.told() for lesson in found]
    return [one for one in made if one["stops"] and all(stop["step"] in known for stop in one["stops"])]


Sides = list[list[tuple[str, Step, Step, bool]]]
"""Sums of vectors: symbol, ends, whether its length is sought."""


def _of_motion(project: Project, plan: Plan) -> list[tuple[Step | None, str, Sides]]:
    """Vector equations of a plan as the note has them, with the ends of each vector."""
    ends = {s.symbol: (s.tail, s.head) for s in plan.segments}
    found: list[tuple[Step | None, str, Sides]] = []
    for one in vector_equations(project, plan):
        sides = [[(symbol, *ends.get(symbol, (side.start, one.step)), symbol in side.rest) for symbol in (*side.path, *side.rest)]
                 for side in one.sums(str(plan.pole))]
        if sides:
            found.append((one.step, one.head, sides))
    return found


class _Lesson:
    """One plan.

    A stop has the ``step`` it draws, its ``kind``, the ``tail`` of what is drawn, ``ends`` where that is a vector or a side, is
    ``across`` if it is turned by a quarter against ``along``, the two points or the direction it is taken from, its ``title``,
    ``say``, a sentence, ``why`` it is so, and what its size is made of.
    """

    def __init__(self, index: StepIndex, plan: Plan, equations: list[tuple[Step | None, str, Sides]]) -> None:
        self.index, self.plan, self.equations = index, plan, equations

    def told(self) -> dict[str, Any]:
        """The lesson as it stands in the page."""
        stops: list[dict[str, Any]] = []
        for step in self.plan:
            if step.rule is rules.LINE_LINE:
                for start, along in ((step.args[0], step.args[1]), (step.args[2], step.args[3])):
                    stops.insert(self._step_told_after(stops, start), self._line(step, start, along))
            if (one := self._stop(step)) is not None:
                if one["kind"] in ("lay", "similar"):
                    one["ends"] = [one["tail"], one["step"]]
                stops.append(one)
        pole = self.plan.pole
        return {"plan": self.plan.name, "pole": "" if pole is None else self.index.id(self.plan[pole]), "stops": stops,
                "equations": self._filled(stops), "symbols": list(self._symbols())}

    def _symbols(self) -> Iterator[tuple[str, str]]:
        """What letters of the equations stand for: the pole, points of links that lie in others, signs above vectors."""
        if self.plan.pole is not None:
            yield str(self.plan.pole), tr("is the pole: the vectors of all points begin there; points at rest lie in it")
        for _, head, _ in self.equations:
            if (of := COINCIDENT.search(head)) is not None:
                yield of[1] + of[2], tr("is the point of link {n} that is at {of} now").format(n=of[2], of=of[1])
        terms = (symbol for _, _, sides in self.equations for side in sides for symbol, *_ in side)
        met = {symbol.rpartition("^")[2]: symbol for symbol in terms if "^" in symbol}
        yield from ((met[sign], tr(words)) for sign, words in SIGNS.items() if sign in met)

    def _filled(self, stops: list[dict[str, Any]]) -> list[dict[str, Any]]:
        """The equations, each term with the numbers of the stops that draw it, and the line of its unknown length, or -1.

        The stops get their ``equation``: the last of which something is drawn beyond what those before it were made of; lines
        the number of the stop ``until`` which they have no end.
        """
        drawn = {stop["step"]: n for n, stop in reversed(list(enumerate(stops))) if stop["kind"] != "line"}
        closed = {tuple(stop["ends"]): n for n, stop in enumerate(stops) if stop["kind"] == "close"}
        lines = {frozenset((stop["tail"], stop["step"])): n for n, stop in reversed(list(enumerate(stops)))
                 if stop["kind"] == "line"}
        met = -1
        found: list[dict[str, Any]] = []
        for stop in stops:
            stop |= {"equation": 0, "until": drawn.get(stop["step"], -1)}
            if stop["kind"] == "rate":  # what turns the link lies on the line across it
                head, along = stop["ends"][1], stop["along"]
                stop["tail"] = next((line["tail"] for line in stops if line["kind"] == "line" and line["across"]
                                     and (line["step"], line["along"]) == (head, along)), stop["tail"])
                stop["ends"] = [stop["tail"], head]
        for end, head, sides in self.equations:
            told = [[self._term(side, drawn, closed, lines) for side in terms] for terms in sides]
            begins = [n for side in told for term in side for n in (term["drawn"], term["line"]) if n > met]
            for stop in stops[min(begins, default=len(stops)):]:
                stop["equation"] = len(found)
            met = drawn.get(self.index.id(end), -1) if end is not None else -1
            found.append({"end": self.index.id(end) if end is not None else "", "drawn": met, "head": head, "sides": told})
        return found

    def _term(self, term: tuple[str, Step, Step, bool], drawn: Mapping[str, int], closed: Mapping[tuple[str, ...], int],
              lines: Mapping[frozenset[str], int]) -> dict[str, Any]:
        symbol, tail, head, sought = term
        ends = self.index.id(tail), self.index.id(head)
        return {"symbol": symbol, "tail": ends[0], "head": ends[1], "times": 1 if sought else 2,
                "line": lines.get(frozenset(ends), -1), "drawn": closed.get(ends, max(drawn.get(end, -1) for end in ends))}

    def _step_told_after(self, stops: list[dict[str, Any]], start: Step) -> int:
        """Where a line is told: behind its beginning, if only vectors of the same equation were laid off since; else now."""
        since = takewhile(lambda stop: stop["kind"] == "lay", reversed(stops))
        return next((len(stops) - n for n, stop in enumerate(since) if stop["step"] == self.index.id(start)), len(stops))

    def _line(self, step: Step, start: Step, along: Step) -> dict[str, Any]:
        across = along.rule is rules.TURN
        of = along.args[0] if across else along
        assert isinstance(of, Step)
        points, name = [a for a in of.args if isinstance(a, Step)], protocol.letter_of(of)
        told = tr("Through {point} perpendicular to {line} draw a line: its length is not known yet.") if across else tr(
            "Through {point} parallel to {line} draw a line: its length is not known yet.")
        ray = len(points) == 2 and all(a.rule.gives == "point" for a in points)
        return _kind("line") | {
            "step": self.index.id(step), "tail": self.index.id(start), "direction": self.index.id(along), "across": across,
            "along": [self.index.id(a) for a in points] if ray else [], "name": name,
            "say": told.format(point=protocol.letter_of(start), line=name)}

    def _stop(self, step: Step) -> dict[str, Any] | None:
        """A stop of a step that draws something or gives a rate of turning; none of others."""
        args = [self.index.id(a) if isinstance(a, Step) else "" for a in step.args]
        stop: dict[str, Any] = {"step": self.index.id(step), "say": protocol.sentence_of_any_angle(step)}
        rule = step.rule
        if rule in LAID:
            laid, tail = LAID[rule], args[0] if rule is not motion.CRANK_VELOCITY else self.index.id(self.plan[str(self.plan.pole)])
            a, b = laid.ends
            letter = next((s.symbol for s in self.plan.segments if s.head is step and self.index.id(s.tail) == tail), "")
            return stop | {"kind": "lay", "title": tr(laid.title), "why": tr(laid.why), "tail": tail, "across": laid.across,
                           "along": [args[a], args[b]], "letter": letter, "rate": args[laid.rate], "power": laid.power,
                           "twice": rule is motion.CORIOLIS,
                           "name": f"{protocol.letter_of(step.args[a])}{protocol.letter_of(step.args[b])}"}
        if rule is rules.SHIFT:
            return stop | _kind("force") | {"kind": "lay", "tail": args[0], "across": False, "along": [], "force": args[1]}
        if rule is rules.LINE_LINE:
            return stop | _kind("meet") | {"of": [self.index.id(s.tail) for s in self.plan.segments if s.head is step]}
        if rule is motion.SIMILAR:
            names = [protocol.letter_of(a) for a in step.args]
            return stop | _kind("similar") | {"tail": args[0], "to": args[1], "places": args[2:], "names": names}
        if rule in RATES and all(args):
            return stop | _kind("rate") | {"along": args[:2], "tail": args[2], "ends": args[2:4],
                                           "name": f"{protocol.letter_of(step.args[0])}{protocol.letter_of(step.args[1])}"}
        if rule is CLOSE:
            return stop | _kind("close") | {"tail": args[0], "ends": args[:2]}
        return stop | _kind("draw") if rule.helpers is not None and rule.gives in ("point", "vector", "force") else None


def _kind(kind: str) -> dict[str, Any]:
    title, why = OTHERS[kind]
    return {"kind": kind, "title": tr(title), "why": tr(why) if why else ""}


def lesson_words() -> dict[str, str]:
    """Texts of the lesson by their keys: its own, questions of "Where will it go?", and answers to guesses, most of them wrong."""
    return {
        "lesson": tr("Lesson"),
        "mechanism": tr("Mechanism"),
        "which plan": tr("Which plan"),
        "step {n} of {all}": tr("Step {n} / {all}"),
        "begin": tr("What is known stands in the equation twice underlined, what has a direction only once. Press › and draw it."),
        "a millimetre": tr("A millimetre of the plan is {value}."),
        "segment": tr("|{name}| = {mm} mm"),
        "the same point": tr("Point {name} falls on {other}: nothing to draw."),
        "lecture": tr("Lecture"),
        "copy link": tr("Link, QR"),
        "copied": tr("The link is copied"),
        "no code": tr("When the page is on a web server, a QR code for phones stands here."),
        "film": tr("Film"),
        "film of the plan": tr("Play the lesson and keep it as a film (WebM)"),
        "no film here": tr("This browser cannot make a film"),
        "nothing found": tr("Nothing found"),
        "with other numbers": tr("with other numbers than the project's"),
        "guess": tr("Where will it go?"),
        "check": tr("Check"),
        "show it": tr("Show"),
        "score": tr("Right at first: {r} of {n}"),
        "your vector": tr("your vector: {mm} mm"),
        "your line": tr("your line: {deg}°"),
        "ask lay": tr("Where will the vector go from {point}? Drag its end."),
        "ask line": tr("How will the line pass through {point}? Turn it."),
        "ask similar": tr("Where on the plan is {head}? Drag the end of the vector."),
        "ask rate": tr("Which sense has {rate}?"),
        "clockwise": tr("clockwise"),
        "counter-clockwise": tr("counter-clockwise"),
        "grip of the guess": tr("Your guess: arrows left and right turn it, up and down change its length"),
        "right": tr("Right: off by {deg}° and {mm} mm, a pencil's reach."),
        "right line": tr("Right: off by {deg}°."),
        "right sense": tr("Right."),
        "direction right": tr("The direction is right."),
        "normal out": tr("The normal acceleration points to the centre {centre}, not outwards."),
        "nothing across": tr("Across {line} nothing is laid off: {rate} = const, nothing tangential."),
        "normal across": tr("Across {line} goes the tangential one; the normal goes along, to {centre}."),
        "wrong centre": tr("{point} turns about {centre}, not about {other}."),
        "not squared": tr("But that is ω·l, a velocity: here ω is squared."),
        "other rate": tr("But {other} was taken; here it is {rate}."),
        "other length": tr("But {other} was taken; here it is {line}."),
        "against": tr("Turned against {rate}: the link turns {sense}."),
        "not turned": tr("That is {line} itself: turn it by 90° in the sense of {rate}."),
        "no two": tr("But the two is missing: a = 2·ω·V."),
        "slide across": tr("It slides along {line}: parallel to it."),
        "tangent along": tr("Along {line} lies the normal one; the tangential goes across."),
        "rotation along": tr("The link turns: its point moves across {line}, not along."),
        "force across": tr("Across {line} lies the tangential part; this one lies along."),
        "force along": tr("A guide presses across {line}, not along."),
        "other link": tr("That is the direction of {other}; here {line} gives it."),
        "not on ray": tr("{names} are on one line, so are {ends}."),
        "other side": tr("The other way round: the order of {names} is that of {ends}."),
        "similar figures": tr("The figure of a link and that of its vectors are similar and lettered the same way round."),
        "ratio inverse": tr("Ratio upside down: |{ends}| : |{to}| = {names}."),
        "sense wrong": tr("Put {vector} at {point}: it turns the link the other way."),
        "force against": tr("The force acts the other way."),
        "zero": tr("Here the vector is zero: {why}. Shrink the arrow to a point."),
        "too long": tr("But {n} times too long: divide by the scale factor."),
        "too short": tr("But {n} times too short: divide by the scale factor."),
        "off": tr("Off by {deg}°: along or across which link?"),
        "off force": tr("Off by {deg}°: parallel to the force on the mechanism."),
    }
