"""About how high blocks are on the page, and figures put where they fit: what Word, which floats no figures, needs to be told."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import ceil

from tmm_sheets.note.document import Block, Contents, Figure, Formula, Heading, NewPage, Paragraph, Sheet, Table, Where
from tmm_sheets.note.formula import Fraction, Node
from tmm_sheets.note.phrases import plain_text

PAGE = 258.0
"""Height of the text on a page, mm."""
LINE, WIDE = 4.1, 104.0
"""Height of a line, mm, and how many characters stand in one."""


def height(b: Block) -> float:
    """About how high a block is, mm."""
    if isinstance(b, Heading):
        return 14.0 if b.level == 1 else 10.5
    if isinstance(b, Paragraph):
        return LINE * ceil((len(plain_text(b.text)) + 6 * sum(not isinstance(x, str) for x in b.text)) / WIDE)
    if isinstance(b, Table):
        return 16.0 + 4.9 * len(b.rows)
    if isinstance(b, Figure):
        return (b.width if b.turned else b.height) + 9.0
    if isinstance(b, Formula):
        return sum(10.0 if _high(line) else 5.6 for line in b.lines)
    return 4.3 * len(b.rows) if isinstance(b, Where) else 10.0


def _high(node: Node) -> bool:
    return isinstance(node, Fraction) or any(map(_high, node.parts()))


def floated(blocks: Iterable[Block]) -> Iterator[Block]:
    """The blocks with each figure that does not fit on its page put at the top of the next one, the text going on before it."""
    waiting: list[Figure] = []
    y = 0.0
    for b in blocks:
        if isinstance(b, Sheet | Contents | NewPage) or (isinstance(b, Heading) and b.level == 1):
            yield from waiting
            waiting.clear()
            y = 0.0
        if isinstance(b, Figure) and (waiting or y + height(b) > PAGE):
            waiting.append(b)
            continue
        if waiting and y + height(b) > PAGE:
            y = 0.0
            while waiting and y + height(waiting[0]) <= PAGE:
                y += height(waiting[0])
                yield waiting.pop(0)
        y = y + height(b) if y + height(b) <= PAGE else height(b)
        yield b
    yield from waiting
