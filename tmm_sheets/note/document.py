"""The document tree of a note: what stands in it, without a word of how it is set.

Text is a tuple of :data:`Inline`; numbers are nodes that know the step they come from, formulas are trees (see
:mod:`~tmm_sheets.construction.formula`). Sections, formulas, figures and tables have their numbers already: both writers print the
same.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, fields, is_dataclass, replace
from typing import Any, ClassVar, Literal

from tmm_sheets.construction.formula import Node, letters, letters_of


@dataclass(frozen=True)
class NumberInText:
    """A number of the record as it is written: ``text`` with at most ``digits`` significant digits, and its ``unit`` in words.

    ``step`` is "plan/name" of the step it is the value of, or the path of a given number; ``position`` the label of the position;
    ``value`` the number itself in the step's unit. No digits: a number that a sentence of that step says.
    """

    text: str
    step: str
    value: float
    position: str = ""
    digits: int = 4
    unit: str = ""

    def __str__(self) -> str:
        """Number and unit, not to be parted at the end of a line."""
        return f"{self.text}\u00a0{self.unit}" if self.unit and self.unit not in ("°",) else self.text + self.unit


@dataclass(frozen=True)
class Symbol:
    """Letters in the text, set as in a formula."""

    node: Node


@dataclass(frozen=True)
class Reference:
    """The number of a figure, table, formula or source in the text; ``target`` is "figure:4.2", empty for a source."""

    text: str
    target: str = ""

    def __str__(self) -> str:
        """The number as it is written."""
        return self.text


Inline = str | NumberInText | Symbol | Reference
Text = tuple[Inline, ...]
Rows = tuple[tuple[Text, ...], ...]
"""A table: its head, then its rows."""


def lettered(name: str) -> Symbol:
    """Letters in the text from lettering markup, or from the name of a step."""
    return Symbol(letters(letters_of(name)))


def enumerated(texts: Iterable[Text], sign: str = ", ") -> Text:
    """Texts one after another with a sign between them."""
    return tuple(x for i, text in enumerate(texts) for x in ((sign, *text) if i else text))


@dataclass(frozen=True)
class ShownFormula:
    """A formula as a section offers it to its template: what is shown, and the letters that are to be explained."""

    letters: Node
    numbers: Node | None = None
    explained: tuple[tuple[str, str], ...] = ()
    """letters in markup, each with its unit in words."""


@dataclass(frozen=True)
class Heading:
    """Title of a section: level 1 begins a page; ``number`` is empty for introduction, conclusions and the like."""

    level: int
    number: str
    text: str

    @property
    def said(self) -> str:
        """Number and title."""
        return f"{self.number}  {self.text}" if self.number else self.text


@dataclass(frozen=True)
class Paragraph:
    """Running text; ``look`` says whether it is one of a list, or stands in the middle of the line."""

    text: Text
    look: Literal["plain", "item", "centre", "right"] = "plain"


@dataclass(frozen=True)
class Formula:
    """A formula on its own line, ``number`` at the right margin; ``lines`` stand one under another."""

    lines: tuple[Node, ...]
    number: str = ""


@dataclass(frozen=True)
class Explained:
    """A letter of a formula, what it means, its unit in words."""

    symbol: Node
    meaning: Text
    unit: str


@dataclass(frozen=True)
class Where:
    """What the letters of the formulas before mean: "где", a letter a line."""

    word: str
    rows: tuple[Explained, ...]


WORD = 12
"""Letters in a cell of a table from which on it holds words."""


@dataclass(frozen=True)
class NumberedTable:
    """A table under its number and title; the first row is its head. ``parts``: rows on each of its pages, none of a whole one."""

    number: str
    title: str
    rows: Rows
    parts: tuple[int, ...] = ()

    @property
    def worded(self) -> bool:
        """Whether the first column holds words, not numbers or letters: it is set from the left."""
        return any(isinstance(x, str) and len(x) > WORD for row in self.rows[1:] for x in row[0][:1])


@dataclass(frozen=True)
class Figure:
    """A picture with its caption; ``svg`` is its drawing, ``width`` and ``height`` mm on the page, ``turned`` by 90 degrees.

    ``least``: how small it may be made, as a share of this size, and be read. ``part``: of a picture over several pages the first,
    second ...; they have one number.
    """

    number: str
    title: str
    name: str
    svg: bytes = field(repr=False)
    width: float = 0.0
    height: float = 0.0
    turned: bool = False
    least: float = 1.0
    part: int = 0

    @property
    def further(self) -> bool:
        """Whether it goes on with the figure before."""
        return self.part > 1

    @property
    def file(self) -> str:
        """Name of its file."""
        return f"fig-{self.number.replace('.', '-')}" + (f"-{self.part}" if self.further else "")

    @property
    def on_page(self) -> tuple[float, float]:
        """Width and height of the drawing on the page before it is turned, mm."""
        return self.width, self.height

    @property
    def high(self) -> float:
        """Height of the picture as it stands on the page, mm."""
        return self.width if self.turned else self.height

    def sized(self, share: float) -> Figure:
        """The figure, reduced."""
        return replace(self, width=self.width * share, height=self.height * share, least=self.least / share)


@dataclass(frozen=True)
class Sheet:
    """A finished sheet in the appendices, on a page of its own."""

    number: str
    title: str
    name: str
    svg: bytes = field(repr=False)
    width: float = 0.0
    height: float = 0.0
    turned: ClassVar = True

    @property
    def file(self) -> str:
        """Name of its file."""
        return f"sheet-{self.number}"

    @property
    def on_page(self) -> tuple[float, float]:
        """Width and height of the drawing on the page before it is turned, mm."""
        return SHEET, SHEET * self.height / self.width


SHEET = 224.0
"""Width of a sheet on its page, mm."""


@dataclass(frozen=True)
class Contents:
    """Contents with page numbers under a heading without number."""

    title: str


@dataclass(frozen=True)
class NewPage:
    """The next block begins a page."""


Block = Heading | Paragraph | Formula | Where | NumberedTable | Figure | Sheet | Contents | NewPage


@dataclass(frozen=True)
class Frame:
    """Words of the stamps, forms 2 and 2a (GOST 2.104), by their fields; ``short``: not all pages have frame and stamp."""

    fields: dict[str, str]
    words: dict[str, str]
    short: bool = False

    def on(self, first: int, last: int, all_: int) -> bool:
        """Whether one of the pages from ``first`` to ``last`` has a frame, in a note of ``all_`` pages: the short way of manual
        003 is to draw it on the first three after the title page and on the last two.
        """
        return first > 1 and (not self.short or first <= 1 + FRAMED[0] or last > all_ - FRAMED[1])


FRAMED = (3, 2)
"""Pages with a frame in the short way: so many after the title page, and so many at the end."""


@dataclass(frozen=True)
class Note:
    """A whole note: its title page, what is before the contents, the body, and the page of what only the student can fill in."""

    language: str
    title: str
    author: str
    front: tuple[Block, ...]
    title_page: dict[str, Any]
    body: tuple[Block, ...]
    frame: Frame
    reminders: tuple[Block, ...] = ()
    first_page: int = 1
    problems: tuple[str, ...] = ()
    """what the project has and the note could not tell, with the reasons."""

    def blocks(self) -> Iterator[Block]:
        """Everything between title page and reminders."""
        yield from self.front
        yield from self.body


def plain_text(text: Iterable[Inline]) -> str:
    """Text without its letters."""
    return "".join(str(x) for x in text if not isinstance(x, Symbol))


def changed(value: Any, change: Callable[[Any], Any]) -> Any:
    """A block, or what stands in one, with every formula and number changed."""
    if isinstance(value, Node | NumberInText):
        return change(value)
    if isinstance(value, tuple):
        return tuple(changed(x, change) for x in value)
    if is_dataclass(value) and not isinstance(value, type):
        return replace(value, **{f.name: changed(getattr(value, f.name), change) for f in fields(value)})
    return value


def numbers(blocks: Iterable[Block]) -> list[NumberInText]:
    """All numbers of the record that some blocks show, those of formulas too."""
    found: list[NumberInText] = []

    def seen(x: Any) -> Any:
        found.extend(x.numbers() if isinstance(x, Node) else [x])
        return x

    changed(tuple(blocks), seen)
    return found
