"""Where figures and tables stand: after the paragraph that speaks of them, in its subsection, with as little of a page left empty
as can be.

A figure that does not fit on its page lets the text of its subsection go on before it. What is tied together, as a formula and the
"where" behind it, lets nothing in between. Both writers print the order that is found here, from heights that the PDF has.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from tmm_sheets.note.document import (
    Block,
    Contents,
    Figure,
    Formula,
    Heading,
    NewPage,
    NumberedTable,
    Paragraph,
    Reference,
    Sheet,
    Symbol,
    Text,
    Where,
)

PAGE = 262.5
"""Height of the text on a page, mm; a little less than there is."""
PITCH, BETWEEN = 4.55, 2.02
"""From one line to the next, and the room between two lines, mm."""
TOGETHER = 20
"""Rows of a table up to which it stays on one page."""
SIZES = (0.95, 0.9, 0.85)
"""Sizes in which a figure is tried, as shares of its own, beside the one that fills a page."""

SMALLER, PASSED, NEXT_PAGE, FAR, BROKEN, HALF = 60.0, 3.0, 12.0, 4000.0, 90.0, 0.5
"""What it costs, in mm of a page left empty: a figure smaller by its whole size, a block of text between a figure and its
paragraph, a figure on the page after, each page more, a table on two pages; what a page more costs as a share of its height."""
KEPT = 6
"""Arrangements of the same beginning that are followed."""


def tied(b: Block, after: Block) -> bool:
    """Whether nothing may stand between two blocks: a sentence goes on, or letters of a formula are told."""
    if isinstance(b, Heading) or isinstance(after, Where):
        return True
    if isinstance(after, Formula) and not after.number:
        return isinstance(b, Formula | Where)
    if isinstance(after, Paragraph) and _begin(after.text)[:1].islower():
        return True
    return isinstance(b, Paragraph) and b.look in ("plain", "item") and _end(b.text)[-1:] not in ".!?…"


def sticky(b: Block, after: Block) -> bool:
    """Whether no page may end between two blocks."""
    if isinstance(b, Paragraph):
        return tied(b, after) and not (b.look == "item" and isinstance(after, Paragraph))
    return isinstance(b, Heading) or (isinstance(b, Formula) and isinstance(after, Where))


def _begin(text: Text) -> str:
    return str(text[0]) if text and not isinstance(text[0], Symbol) else "A"


def _end(text: Text) -> str:
    return str(text[-1]).rstrip() if text and not isinstance(text[-1], Symbol) else ""


def pinned(b: Block) -> bool:
    """Whether a block begins a page or fills one."""
    return isinstance(b, Contents | NewPage | Sheet) or (isinstance(b, Heading) and b.level == 1)


def kind(b: Block) -> str:
    """The kind of a block by which there is room above and below it; empty for what has a page of its own."""
    kinds = {Paragraph: "paragraph", Formula: "formula", Where: "where", NumberedTable: "table", Figure: "figure"}
    return ("section", "heading")[b.level - 1] if isinstance(b, Heading) else kinds.get(type(b), "")


@dataclass(frozen=True)
class Measured:
    """How high some blocks are, mm.

    ``heights``: of each without the room round it. ``room``: above and below by the kind of block; between two blocks there is the
    greater one, at the ends of a page none.
    """

    heights: tuple[float, ...]
    room: Mapping[str, Sequence[float]]


@dataclass(frozen=True)
class _Slice:
    """Something that no page parts, with the room above and below it, mm."""

    above: float
    height: float
    below: float

    def joined(self, after: _Slice) -> _Slice:
        """Both, as one that no page parts."""
        return _Slice(self.above, self.height + max(self.below, after.above) + after.height, after.below)


def arranged(blocks: Sequence[Block], measured: Measured) -> list[Block]:
    """Blocks with figures and tables moved to where they stand best.

    Parameters
    ----------
    blocks
        As the templates give them.
    measured
        Their heights.
    """
    made: list[Block] = []
    section: list[tuple[Block, _Slice]] = []
    for b, height in [*zip(blocks, measured.heights, strict=True), (NewPage(), 0.0)]:
        if pinned(b):
            made += _section(section)
            section = []
        above, below = measured.room.get(kind(b), (0.0, 0.0))
        section.append((b, _Slice(above, height, below)))
    return [*made, *(b for b, _ in section[:-1])]


@dataclass
class _Chunk:
    """Blocks of text that are tied together, as slices between which a page may end."""

    blocks: list[Block] = field(default_factory=list)
    slices: list[_Slice] = field(default_factory=list)


@dataclass(frozen=True)
class _Floating:
    """A figure or table: it may stand after chunk ``after``, not after chunk ``last``."""

    block: Figure | NumberedTable
    size: _Slice
    after: int
    last: int

    @property
    def least(self) -> _Slice:
        """The smallest of its sizes; of a long table its beginning."""
        if isinstance(self.block, Figure):
            return replace(self.size, height=self.size.height - self.block.high * (1 - self.block.least))
        rows = len(self.block.rows)
        return replace(self.size, height=self.size.height / rows * 5) if rows > TOGETHER else self.size

    def ways(self, room: float) -> Iterator[tuple[Figure | NumberedTable, _Slice, float]]:
        """The ways in which it may be printed whole, with the size and what it costs; one fills the room of a page."""
        yield self.block, self.size, 0.0
        if isinstance(self.block, Figure):
            fitting = 1 - (self.size.above + self.size.height - room) / self.block.high
            for share in sorted({*(s for s in SIZES if s >= self.block.least), fitting}):
                if self.block.least <= share < 1.0:
                    size = replace(self.size, height=self.size.height - self.block.high * (1 - share))
                    yield self.block.sized(share), size, SMALLER * (1 - share)


@dataclass(frozen=True)
class _State:
    """An arrangement of the beginning of a section: the page, how far down it is, the room that is left below, mm."""

    page: int = 0
    y: float = 0.0
    below: float = 0.0
    cost: float = 0.0
    due: float = 0.0
    """the least that is still to be paid for what has not come yet."""
    spoken: tuple[tuple[int, int, int], ...] = ()
    """pages of the paragraphs that speak of what has not come yet: kind, which, page."""
    made: tuple[Block, ...] = ()
    before: _State | None = None

    @property
    def depth(self) -> float:
        return self.page * PAGE + self.y

    @property
    def worth(self) -> float:
        return self.cost + self.due + HALF * self.depth

    def fits(self, s: _Slice) -> bool:
        """Whether something has its place on the page."""
        return self.y == 0 or self.y + max(self.below, s.above) + s.height <= PAGE

    def put(self, made: Sequence[Block], slices: Iterable[_Slice], cost: float = 0.0) -> _State:
        """With more blocks on the page."""
        page, y, below = self.page, self.y, self.below
        for s in slices:
            top = y + max(below, s.above)
            if y > 0 and top + s.height > PAGE:
                cost += PAGE - y
                page, y = page + 1, s.height
            else:
                y = top + s.height if y > 0 else s.height
            below = s.below
        return _State(page, y, below, self.cost + cost, 0.0, self.spoken, tuple(made), self)

    def owing(self, floating: Sequence[Sequence[_Floating]]) -> _State:
        """With what has to be paid for figures and tables that will come too late already."""
        due = 0.0
        for kind, which, page in self.spoken:
            least = floating[kind][which].least
            due += FAR * max(self.page + (not self.fits(least)) - page - 1, 0)
        return replace(self, due=due) if due else self


def _section(section: Sequence[tuple[Block, _Slice]]) -> list[Block]:
    """The blocks of a section, arranged."""
    if not any(isinstance(b, Figure | NumberedTable) for b, _ in section):
        return [b for b, _ in section]
    state: _State | None = _found(section)
    made: list[Block] = []
    while state is not None:
        made[:0] = state.made
        state = state.before
    return made


def _found(section: Sequence[tuple[Block, _Slice]]) -> _State:
    """The best arrangement of a section: its beginnings, by what of it stands already, grow by one block after another."""
    chunks, floating = _parted(section)
    figures, tables = ([f for f in floating if isinstance(f.block, kind)] for kind in (Figure, NumberedTable))
    states: dict[tuple[int, int, int], list[_State]] = {(0, 0, 0): [_State()]}
    for total in range(len(chunks) + len(floating)):
        for key in [k for k in states if sum(k) == total]:
            found = _best(states.pop(key))
            for to, state in (x for s in found for x in _next(s, key, chunks, (figures, tables))):
                states.setdefault(to, []).append(state.owing((figures, tables)))
    return _best(states[len(chunks), len(figures), len(tables)])[0]


def _best(states: list[_State]) -> list[_State]:
    """Those that no other one beats in both depth and cost, the most promising ones."""
    found: list[_State] = []
    for s in sorted(states, key=lambda s: (s.worth, s.depth)):
        if all(s.depth < t.depth or s.cost + s.due < t.cost + t.due for t in found):
            found.append(s)
        if len(found) == KEPT:
            break
    return found


def _next(
    state: _State, key: tuple[int, int, int], chunks: list[_Chunk], floating: tuple[list[_Floating], list[_Floating]]
) -> Iterator[tuple[tuple[int, int, int], _State]]:
    """The arrangements that go on from one: by the next chunk of text, the next figure, the next table."""
    i = key[0]
    due = [f[key[k + 1]] for k, f in enumerate(floating) if key[k + 1] < len(f)]
    if i < len(chunks) and all(f.last > i - 1 for f in due):
        chunk = chunks[i]
        waiting = sum(f.after < i for k, fs in enumerate(floating) for f in fs[key[k + 1]:])
        page = state.page + (not state.fits(chunk.slices[0]))
        new = tuple((k, n, page) for k, fs in enumerate(floating) for n, f in enumerate(fs) if f.after == i)
        to = state.put(chunk.blocks, chunk.slices, PASSED * waiting)
        yield (i + 1, *key[1:]), replace(to, spoken=(*state.spoken, *new))
    for k, fs in enumerate(floating):
        n = key[k + 1]
        if n == len(fs) or fs[n].after >= i:
            continue
        f = fs[n]
        page = next((p for kind, which, p in state.spoken if (kind, which) == (k, n)), 0)
        rest = tuple(x for x in state.spoken if x[:2] != (k, n))
        moved = (i, key[1] + 1, key[2]) if k == 0 else (i, key[1], key[2] + 1)
        for block, size, cost in f.ways(PAGE - state.y):
            to = state.put([block], [size], cost)
            away = to.page - page
            if n + 1 < len(fs) and getattr(fs[n + 1].block, "further", False):
                rest = (*(x for x in rest if x[:2] != (k, n + 1)), (k, n + 1, to.page))
            to = replace(to, cost=to.cost + NEXT_PAGE * min(away, 1) + FAR * max(away - 1, 0), spoken=rest)
            yield moved, to
        if isinstance(f.block, NumberedTable) and (broken := _broken(f, state)) is not None:
            yield moved, replace(broken, spoken=rest)


def _broken(f: _Floating, state: _State) -> _State | None:
    """A long table that goes on on the next page; None where it has to stay on one."""
    assert isinstance(f.block, NumberedTable)
    rows = len(f.block.rows) - 1
    if rows < TOGETHER or state.fits(f.size):
        return None
    row = (f.size.height - HEAD) / (rows + 1)
    first = int((PAGE - state.y - f.size.above - HEAD) / row) - 1
    whole = int((PAGE - AGAIN) / row) - 1
    if not 3 <= first <= rows - 3:
        return None
    parts = (first, *(min(whole, rows - done) for done in range(first, rows, whole)))
    heights = [(AGAIN if i else HEAD) + row * (n + 1) for i, n in enumerate(parts)]
    return state.put([replace(f.block, parts=parts)], [replace(f.size, height=h) for h in heights], BROKEN)


HEAD, AGAIN = 10.0, 6.0
"""Height of the number and the title of a table, and of the line that says that it goes on, mm."""


def _parted(section: Sequence[tuple[Block, _Slice]]) -> tuple[list[_Chunk], list[_Floating]]:
    """Chunks of text, and what may stand between them."""
    texts = [(b, size) for b, size in section if not isinstance(b, Figure | NumberedTable)]
    chunks: list[_Chunk] = []
    of_block: list[int] = []
    for k, (b, size) in enumerate(texts):
        if not k or not tied(texts[k - 1][0], b):
            chunks.append(_Chunk())
        chunk = chunks[-1]
        slices = _slices(b, size)
        if chunk.blocks and sticky(chunk.blocks[-1], b):
            slices[0] = chunk.slices.pop().joined(slices[0])
        chunk.blocks.append(b)
        chunk.slices += slices
        of_block.append(len(chunks) - 1)
    heads = [of_block[k] for k, (b, _) in enumerate(texts) if isinstance(b, Heading)]
    floating: list[_Floating] = []
    before = -1
    for block, size in section:
        if not isinstance(block, Figure | NumberedTable):
            before += 1
            continue
        target = f"{'figure' if isinstance(block, Figure) else 'table'}:{block.number}"
        place = of_block[before] if before >= 0 else -1
        spoken = [of_block[k] for k, (t, _) in enumerate(texts) if isinstance(t, Paragraph)
                  and any(isinstance(x, Reference) and x.target == target for x in t.text)]
        goes_on = isinstance(block, Figure) and block.further
        after = floating[-1].after if goes_on else _anchor(spoken, place, heads)
        floating.append(_Floating(block, size, after, min([x for x in heads if x > after], default=len(chunks)) - 1))
    return chunks, floating


def _anchor(spoken: list[int], place: int, heads: list[int]) -> int:
    """The chunk after which a figure may stand: the first in its subsection that speaks of it, or the one before it."""
    def part(chunk: int) -> int:
        return sum(x <= chunk for x in heads)

    here = [k for k in spoken if part(k) == part(place)]
    return here[0] if here else spoken[0] if spoken else place


def _slices(b: Block, size: _Slice) -> list[_Slice]:
    """A block in parts between which a page may end: two lines of a paragraph stay together at its ends."""
    if isinstance(b, Paragraph) and (n := round((size.height + BETWEEN) / PITCH)) > 3:
        line = PITCH - BETWEEN
        head = size.height - (n - 2) * PITCH
        return [_Slice(size.above, head, BETWEEN), *[_Slice(BETWEEN, line, BETWEEN)] * (n - 4),
                _Slice(BETWEEN, 2 * PITCH - BETWEEN, size.below)]  # fmt: skip
    if isinstance(b, Where) and len(b.rows) > 1:
        n = len(b.rows)
        row = (size.height + ROWS) / n - ROWS
        return [_Slice(size.above if not i else ROWS, row, size.below if i == n - 1 else ROWS) for i in range(n)]
    return [size]


ROWS = 1.3
"""Room between the rows of "where", mm."""
