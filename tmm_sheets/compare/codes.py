"""What a comparison can find: a closed list of codes, fixed words for programs, with the sentences they stand for.

A finding carries a :class:`Remark`, a sentence with what is to be filled in; it is put into the reader's language only when it is
told. Sentences that say the same of different things share a code. What was done otherwise in a construction has its sentences
where the mistakes are (``diagnosis/hypotheses.py``).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from tmm_sheets.numbers import told
from tmm_sheets.words import marked, marked_n, tell, tell_n

CODES: Mapping[str, str] = {
    "built-otherwise": "something usual was done otherwise in the construction; `kind` and `mistake` say what, `step` where",
    "point-moved": "a point of a plan lies elsewhere; `step` is the point",
    "step-off": "a step that is no point on paper was drawn or computed off; `step` says which",
    "another-mechanism": "so much is wrong that something else was drawn",
    "another-plan": "lines under a title are not those of the plan it names, or not all of them",
    "view-missing": "a view with lines of its own was not found",
    "table-missing": "a table, text or detail was not found as it is on the sheet",
    "missing": "the element is not there; amber: it is not seen, and may be there",
    "arrow-reversed": "the arrow has its head at the other end",
    "no-arrow-head": "the arrow has no head",
    "text": "lettering or a number says something else",
    "unit": "the number is right in another unit",
    "factor": "the number is twice, ten times .. what it should be",
    "sense": "the number has the other sign, the direction or rotation the other sense",
    "own-numbers": "the number does not follow from the student's own ones that it was made of",
    "throughout": "a quantity is off at several positions, and nothing before it explains that",
    "displaced": "the element lies elsewhere, or a part of it does",
    "turned": "the line is turned",
    "radius": "the circle or arc has another radius",
    "size": "the curve is larger or smaller as a whole",
    "length": "the line is too long or too short",
    "incomplete": "parts of the element are not there",
    "not-filled": "the area is not filled or not hatched",
    "line-style": "lines are drawn in another type of line",
    "line-width": "lines are drawn in another width of line",
    "number": "the number is another one",
    "as-built": "the element is where a mistake before it leads to",
    "degenerate": "not judged: the construction degenerates, so that there is no tolerance",
    "not-drawn": "not judged: the view leaves out all of the kind",
    "not-compared": "not judged: in a view that stands elsewhere, or has another scale, it may be anywhere",
    "not-measurable": "not judged: hidden, or not to be told from others near it",
    "right": "it is as it should be",
}
"""What each code means; of several things that are wrong with one element the first in this order is its code."""
_RANK = {code: k for k, code in enumerate(CODES)}
LEFT_OUT = "…"
"""What stands in place of what is one student's own."""


class Own(str):
    """What differs from student to student where the same was done: a position, a number of times."""

    __slots__ = ()


class Number(Own):
    """A number as a computer writes it; the reader's decimal sign comes when it is told."""

    __slots__ = ()


@dataclass(frozen=True)
class Remark:
    """A sentence with what is filled in, in nobody's language yet.

    Attributes
    ----------
    code : one of :data:`CODES`
    text : the English sentence, or its forms for one and for many
    fields : what is filled in, by name: texts, numbers, other remarks
    parts, between : of a remark that consists of others, these and what stands between them
    """

    code: str
    text: str | tuple[str, str] = ""
    fields: tuple[tuple[str, Any], ...] = ()
    parts: tuple[Remark, ...] = ()
    between: str = ", "

    def said(self, own: bool = True) -> str:
        """The remark as the reader reads it; without the student's ``own`` numbers where many are told together."""
        if self.parts:
            return tell(self.between).join(dict.fromkeys(part.said(own) for part in self.parts))
        fields = {name: _filled(value, own) for name, value in self.fields}
        if isinstance(self.text, str):
            return tell(self.text).format(**fields)
        return tell_n(*self.text, int(dict(self.fields)["n"])).format(**fields)

    @property
    def alike(self) -> Remark:
        """The remark without the student's own numbers, alike for all who made the mistake."""
        fields = tuple((name, value.alike if isinstance(value, Remark) else LEFT_OUT if isinstance(value, Own) else value)
                       for name, value in self.fields)
        return Remark(self.code, self.text, fields,
                      tuple(part.alike for part in self.parts), self.between)


def _filled(value: Any, own: bool) -> Any:
    if isinstance(value, Remark):
        return value.said(own)
    if isinstance(value, Own) and not own:
        return LEFT_OUT
    return told(value) if isinstance(value, Number) else value


def joined(remarks: Iterable[Remark | None], between: str = ", ") -> Remark | None:
    """Remarks on one thing as one, with the code that comes first in :data:`CODES`; None of none."""
    some = [r for r in remarks if r is not None]
    if len(some) < 2:
        return some[0] if some else None
    return Remark(min((r.code for r in some), key=lambda code: _RANK.get(code, len(CODES))), parts=tuple(some), between=between)


OR = marked("; or: ")
"""What stands between mistakes that cannot be told from each other."""


@dataclass(frozen=True)
class Sentence:
    """A sentence that says what a code stands for; called with what is to be filled in it makes a remark."""

    code: str
    text: str | tuple[str, str]

    def __call__(self, **fields: Any) -> Remark:
        """The remark with these fields."""
        return Remark(self.code, self.text, tuple(fields.items()))


def sentences() -> Mapping[str, list[str | tuple[str, str]]]:
    """The English sentences of each code that has any here, in their order; those with a number by both their forms."""
    found: dict[str, list[str | tuple[str, str]]] = {code: [] for code in CODES}
    for value in globals().values():
        for one in value.values() if isinstance(value, dict) else (value,):
            if isinstance(one, Sentence):
                found[one.code].append(one.text)
    return found


# --- a whole drawing, a view ------------------------------------------------------------------------------------------------

ANOTHER_MECHANISM = Sentence("another-mechanism", marked(
    "So many mistakes: was another variant drawn, or with other scale factors than stated?"))
ANOTHER_PLAN = Sentence("another-plan", marked_n(
    "this is not the plan of position {position}: {n} line does not fit",
    "this is not the plan of position {position}: {n} lines do not fit"))
LINES_DO_NOT_FIT = Sentence("another-plan", marked_n("{n} line does not fit", "{n} lines do not fit"))
NO_INK_UNDER_TITLE = Sentence("view-missing", marked('"{view}": nothing under this title is such a plan'))
VIEW_MISSING = Sentence("view-missing", marked('view "{view}": it was not found in the drawing'))
TABLE_MISSING = Sentence("table-missing", marked("not found as on the sheet, of tables, texts and details: {views}"))

# --- where something lies ---------------------------------------------------------------------------------------------------

SHIFTED = {
    (0, 1): Sentence("displaced", marked("{by} mm too far up")), (0, -1): Sentence("displaced", marked("{by} mm too far down")),
    (1, 0): Sentence("displaced", marked("{by} mm too far right")), (-1, 0): Sentence("displaced", marked("{by} mm too far left")),
    (1, 1): Sentence("displaced", marked("{by} mm too far up and right")),
    (-1, 1): Sentence("displaced", marked("{by} mm too far up and left")),
    (1, -1): Sentence("displaced", marked("{by} mm too far down and right")),
    (-1, -1): Sentence("displaced", marked("{by} mm too far down and left")),
}
"""What a shift is said to be, by its signs to the right and upwards."""
ALONG_ITSELF = Sentence("displaced", marked("{by} mm along itself"))
FARTHEST = Sentence("displaced", marked("up to {by} mm off at {place}"))
OFF_BY = Sentence("displaced", marked("off by up to {by} mm"))
TIP_OFF = Sentence("displaced", marked("the tip is {by} mm off"))
DOT_BESIDE = Sentence("displaced", marked("a dot like it stands beside, and none is seen here: {how}"))
LINE_BESIDE = Sentence("displaced", marked("in one stroke with others, but a line like it lies beside: {how}"))
LETTERING_BESIDE = Sentence("displaced", marked("not in its place: what stands {how} may be it"))
AS_FOLLOWS = Sentence("as-built", marked("up to {by} mm off, as follows from the mistake"))
VANISHED = Sentence("as-built", marked("without length, as follows from the mistake"))

# --- turn, length, radius ---------------------------------------------------------------------------------------------------

TURNED = {1: Sentence("turned", marked("turned by {by}° counter-clockwise")),
          -1: Sentence("turned", marked("turned by {by}° clockwise"))}
TOO_LONG = {1: Sentence("length", marked("{by} mm too long")), -1: Sentence("length", marked("{by} mm too short"))}
LINE_TOO_LONG = {1: Sentence("length", marked("{line} is {by} mm too long")),
                 -1: Sentence("length", marked("{line} is {by} mm too short"))}
TOO_LONG_AT = Sentence("length", marked("{by} mm too long at {place}"))
TOO_SHORT_AT = Sentence("length", marked("too short: {size} mm missing at {place}"))
END = {
    (0, 1): Sentence("length", marked("{by} mm too long at its beginning")),
    (0, -1): Sentence("length", marked("{by} mm too short at its beginning")),
    (1, 1): Sentence("length", marked("{by} mm too long at its end")),
    (1, -1): Sentence("length", marked("{by} mm too short at its end")),
}
"""What an end is said to be: the first or the second, too long or too short."""
OF_RADIUS = {1: Sentence("radius", marked("radius {by} mm too large ({found} for {wanted})")),
             -1: Sentence("radius", marked("radius {by} mm too small ({found} for {wanted})"))}
OTHER_CIRCLE = Sentence("radius", marked("another circle lies about its centre: {how}"))
GROWN = {1: Sentence("size", marked("{by} mm too large in {size} mm")),
         -1: Sentence("size", marked("{by} mm too small in {size} mm"))}

# --- what is not there, or otherwise ----------------------------------------------------------------------------------------

MISSING = Sentence("missing", marked("missing"))
TEXT_MISSING = Sentence("missing", marked('text "{text}" missing'))
DOT_MISSING = Sentence("missing", marked("the dot is missing"))
NO_LETTERING = Sentence("missing", marked("no lettering here"))
ONLY_COVERED = Sentence("missing", marked("not seen where no other line covers it"))
HALF_SEEN = Sentence("missing", marked(
    "ink in parts of its place only: it was left out, lies elsewhere, or pieces of it are seen"))
THIN_NOT_SEEN = Sentence("missing", marked("not seen; lines as thin as it are in pieces in this picture"))
IN_PIECES = Sentence("incomplete", marked("only pieces of it are seen"))
PART_OF_LETTERING = Sentence("incomplete", marked("part of the lettering is not here"))
PART_MISSING = Sentence("incomplete", marked("{size} mm of it missing"))
GAP = Sentence("incomplete", marked("a gap: {size} mm missing at {place}"))
NOT_FILLED = Sentence("not-filled", marked("not filled"))
NOT_HATCHED = Sentence("not-filled", marked("not hatched"))
POINTS_BACK = Sentence("arrow-reversed", marked("points the other way"))
ARROW_POINTS_BACK = Sentence("arrow-reversed", marked("the arrow points the other way"))
HEAD_AT_BEGINNING = Sentence("arrow-reversed", marked(
    "an arrow head at its beginning, where none belongs: it or one in a stroke with it points the other way"))
NO_HEAD = Sentence("no-arrow-head", marked("no arrow head"))
NO_HEAD_HERE = Sentence("no-arrow-head", marked("no arrow head here"))
HEADS_NOT_READ = Sentence("not-compared", marked("heads not read in this view"))
THIN_LINE_ONLY = Sentence("no-arrow-head", marked("only a thin line here, and no arrow head"))
SAYS = Sentence("text", marked('reads "{found}" instead of "{wanted}"'))
OTHER_LETTERS = Sentence("text", marked('the letters are not those of "{text}"'))
READ_AS = Sentence("text", marked("read as {found} instead of {wanted}"))
LINE_TYPE = Sentence("line-style", marked("drawn {found} instead of {wanted}"))
ALL_CONTINUOUS = Sentence("line-style", marked("drawn continuous, as everything in the drawing"))
TOO_THIN = Sentence("line-width", marked("drawn thin, {width} mm, where main lines are {main} mm"))
TOO_THICK = Sentence("line-width", marked("drawn thick, {width} mm, where {least} to {most} mm would be thin"))

# --- measured numbers -------------------------------------------------------------------------------------------------------

POINT_MOVED = Sentence("point-moved", marked("point {point} lies {distance} mm off"))
STARTS_WITH = Sentence("step-off", marked("it starts with {step}"))
THROUGHOUT = Sentence("throughout", marked_n(
    "off at {n} position, and nothing before it explains that: computed or read in another way?",
    "off at {n} positions, and nothing before it explains that: computed or read in another way?"))
INSTEAD = Sentence("number", marked("{measured} instead of {exact}"))
INSTEAD_BY = Sentence("number", marked("{measured} instead of {exact}, {times} times the tolerance"))
BY_CHANCE = Sentence("number", marked_n(
    "one of {n} number may be off so far by chance", "one of {n} numbers may be off so far by chance"))
SIGN = Sentence("sense", marked("the sign is wrong"))
TURNS_BACK = Sentence("sense", marked("it turns the other way"))
POINTS_OTHER_WAY = Sentence("sense", marked("it points the other way"))
AS_IF_IN = Sentence("unit", marked("as if in {unit}"))
TIMES = Sentence("factor", marked("{times} times the exact value"))
OWN_GIVES = Sentence("own-numbers", marked("does not follow from your own {numbers}: that gives {value}"))

# --- not judged, right ------------------------------------------------------------------------------------------------------

DEGENERATES = Sentence("degenerate", marked("the construction degenerates here: no tolerance"))
NOT_DRAWN = Sentence("not-drawn", marked("not drawn in this view"))
OTHER_SCALE = Sentence("not-compared", marked("a symbol in a view of another scale"))
SYMBOL_ELSEWHERE = Sentence("not-compared", marked("a symbol at a point that lies elsewhere"))
LEADS_ELSEWHERE = Sentence("not-compared", marked("leads to another view, which stands elsewhere"))
TOO_NEAR = Sentence("not-measurable", marked("not measurable: too near to others"))
EATEN = Sentence("not-measurable", marked("not measurable: eaten by the black and white picture"))
HIDDEN = Sentence("not-measurable", marked("hidden in the picture"))
OFF_THE_PAPER = Sentence("not-measurable", marked("there it runs off the paper, so it cannot be looked for"))
IN_REACH = Sentence("right", marked("within a pencil's reach"))
IN_REACH_SHARED = Sentence("right", marked("within a pencil's reach, with others in one stroke"))
A_LITTLE_ASIDE = Sentence("right", marked("a little aside, no more than its kind may be"))
THERE = Sentence("right", marked("there"))
