"""Are the notes right? The finished document of every shipped project in three languages, read as a strict teacher reads it.

Usage: python -m tests.note.check_notes [--lang L] [PROJECT ...]; a name may end in a star, without names all
shipped projects. Prints every fault with its project, language and place, then how many formulas were worked out; ends with 1 when
there is a fault.

Content (``content_faults``), judged by the document tree alone: no field, cell or name of a row is empty, no brace or sign of
markup is left, every unit is one of the language, a number has the form of the word that goes with it, every formula gives what
stands behind its sign of equality (``printed_formulas``), "where" stands right behind its formula, every letter of a formula is
explained with its unit, every number of the task that a formula uses stands in the task, the conclusion has a result, and some
section speaks of every sheet, no angular velocity has two signs.

Where all of it comes to stand on pages is judged by ``check_pages``.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from fnmatch import fnmatch
from itertools import pairwise
from multiprocessing import Pool
from typing import Any, NamedTuple

from tests.note.printed_formulas import equalities, line_of
from tmm_sheets import catalogue, words
from tmm_sheets.construction.formula import Barred, Figures, FormulaRow, Letters, Node, Scripts
from tmm_sheets.note import composing, phrases
from tmm_sheets.note.alphabets import equation
from tmm_sheets.note.document import (
    Figure,
    Formula,
    Heading,
    Note,
    NumberedTable,
    NumberInText,
    Paragraph,
    Sheet,
    Symbol,
    Text,
    Where,
)
from tmm_sheets.project import Project

SHARE = ("lugansk/shaper", "lugansk/engine", "transport/crusher@12-СДМ-1908", "sixbar/3:2", "screen")
"""Projects whose notes show every kind of section: read by ``make test``."""


class Fault(NamedTuple):
    """What is wrong, and where: number of the section and the text it stands in."""

    kind: str
    place: str
    text: str


# --- the tree as text

def said(text: Text) -> str:
    """A text with its letters in a line."""
    return "".join(line(x.node) if isinstance(x, Symbol) else str(x) for x in text)


def line(node: Node) -> str:
    """A formula in one line, read off the equation of Word."""
    return line_of(equation(node))


def lines(block: Formula) -> str:
    """A formula broken into lines as one, without the signs that are repeated."""
    parts = [x for i, of in enumerate(block.lines) for x in _items(of)[bool(i):]]
    return line(FormulaRow(tuple(parts)))


def _items(node: Node) -> tuple[Node, ...]:
    return node.items if isinstance(node, FormulaRow) else (node,)


def texts(block: Any) -> Iterator[Text]:
    """Running texts of a block."""
    if isinstance(block, Paragraph):
        yield block.text
    elif isinstance(block, NumberedTable):
        yield (block.title,)
        for row in block.rows:
            yield from row
    elif isinstance(block, Where):
        for row in block.rows:
            yield row.meaning
    elif isinstance(block, Heading):
        yield (block.text,)
    elif isinstance(block, Figure):
        yield (block.title,)


# --- what is looked for

def empty(block: Any) -> Iterator[str]:
    """Fields that came out empty: nothing before a sign of a sentence, between brackets, in a cell, behind a word for a number."""
    for text in texts(block):
        told = said(text)
        if not told.strip():
            yield f"empty: {block!r:.90}"
        elif m := re.search(r".{0,25}(?:[ \u00a0][.,;)]|\(\)|«»|\(\s|,,|\.\.|[,;:]\.|(?<!_)  ).{0,5}", told):
            yield m[0]
        elif re.search(r"(?:^|\s)(?:рис|табл|fig)\.\s*(?:$|[^\d\s\u00a0])|(?:таблиц[аеу]|table)\s*(?:$|\.)", told):
            yield told[-60:]
    if isinstance(block, NumberedTable) and any(len(row) != len(block.rows[0]) for row in block.rows):
        yield f"table {block.number}: rows of different length"


def unnamed(block: Any) -> Iterator[str]:
    """Rows of a table whose first cell names nothing."""
    if isinstance(block, NumberedTable):
        for row in block.rows:
            if said(row[0]).strip(" –-—") == "":
                yield f"table {block.number}: {' | '.join(map(said, row))}"


_MARKUP = re.compile(r"[{}$\\@]|%(?:if|each|end|formula)|_[^\W_]|\^|\[\[|\]\]|\bNone\b|\bnan\b|\d[eE][+−-]?\d|\w\.\w+_\w")


def braces(block: Any) -> Iterator[str]:
    """What is left of the markup, of a template or of Python."""
    for text in texts(block):
        for x in text:
            if isinstance(x, str) and (m := _MARKUP.search(x)):
                yield x[max(m.start() - 20, 0) : m.end() + 20]
            if (isinstance(x, NumberInText) and re.search(r"[^\d\s.,·⁰¹²³⁴⁵⁶⁷⁸⁹⁻−°′″∞–]", x.text)
                    and x.text != composing.PAGES.text):
                yield x.text
    if isinstance(block, Formula):
        for of in block.lines:
            for m in re.finditer(r"[a-z]{4,}|[$\\@]|[a-z]\.[a-z]|column", _without_functions(line(of))):
                yield f"{m[0]} in {line(of)[:80]}"


def _without_functions(text: str) -> str:
    return re.sub(r"arc(?:sin|cos|tg|tan)|_\{(?:[^{}]|\{[^}]*\})*\}|⟦[^⟧]*⟧", "", text)


def units(block: Any, language: str) -> Iterator[str]:
    """Units that the language does not have; in Russian and Ukrainian no unit has a Latin letter."""
    known = {u.strip() for u in phrases.words(language)["units"].values()} | {"", "%", "°", "–"}
    found: list[str] = []
    for text in texts(block):
        found += [x.unit for x in text if isinstance(x, NumberInText)]
        for x in text:
            if isinstance(x, Symbol):
                found += re.findall("⟦([^⟧]*)⟧", line(x.node))
    if isinstance(block, Formula):
        found += [u for of in block.lines for u in re.findall("⟦([^⟧]*)⟧", line(of))]
    if isinstance(block, Where):
        found += [row.unit for row in block.rows]
    if isinstance(block, NumberedTable):
        for cell in block.rows[0]:
            head = said(cell)
            if isinstance(cell[0], Symbol) and ", " in head:
                found.append(head.rpartition(", ")[2])
        heads = [said(cell) for cell in block.rows[0]]
        if heads[2:3] == [phrases.words(language)["task"]["head"][2]]:
            found += [said(row[2]) for row in block.rows[1:]]
    yield from (u for u in found if u.strip("\u00a0 ") not in known)


def scripts(block: Any, language: str) -> Iterator[str]:
    """Words in another alphabet than that of the language: Latin words in Russian and Ukrainian, Cyrillic ones in English."""
    for text in texts(block):
        for x in text:
            if isinstance(x, str):
                told = re.sub(r"\d+-\w+-\d+|[«“][^»”]*[»”]", "", x)  # a cipher, a name that somebody gave
                yield from (m[0] for m in re.finditer(_FOREIGN[language], told) if not re.fullmatch("[IVX]+|sin|cos|tg", m[0]))


_FOREIGN = {
    "en": r"[А-Яа-яЁёІіЇїЄє]\w*",
    "uk": r"\w*[ыэъёЫЭЪЁ]\w*|\b[A-Za-z]{3,}\b",
    "ru": r"\w*[іїєґІЇЄҐ]\w*|\b[A-Za-z]{3,}\b",
}


def _forms(language: str) -> dict[str, tuple[str, ...]]:
    """The forms of the words that templates count, by each form."""
    found: dict[str, tuple[str, ...]] = {}
    for name in phrases.names(language):
        for m in re.finditer(r"\{#[\w.]+ ([^{}]*)\}", phrases.text_of(language, name)):
            forms = tuple(m[1].split("|"))
            found |= dict.fromkeys(forms, forms)
    return found


def plurals(block: Any, language: str) -> Iterator[str]:
    """Numbers beside a form of a word that goes with another number (rule of CLDR)."""
    forms = _forms(language)
    for text in texts(block):
        told = said(text).replace("\u00a0", " ")
        for form, all_ in forms.items():
            for m in re.finditer(rf"(?<![\d,.–])(\d+) {re.escape(form)}(?!\w)", told):
                if all_[_category(int(m[1]), language, len(all_))] != form:
                    yield m[0]


def _category(n: int, language: str, forms: int) -> int:
    if language == "en" or forms == 2:
        one = n == 1 if language == "en" else n % 10 == 1 and n % 100 != 11
        return 0 if one else forms - 1
    if n % 10 == 1 and n % 100 != 11:
        return 0
    return 1 if 2 <= n % 10 <= 4 and not 12 <= n % 100 <= 14 else 2


def euphony(block: Any) -> Iterator[str]:
    """In Ukrainian: the short "and" behind a consonant."""
    for text in texts(block):
        yield from (m[0] for m in re.finditer(r"\w*[бвгґджзклмнпрстфхцчшщь] й \w+", said(text)))


def formulas(block: Any) -> Iterator[str]:
    """Formulas that do not give what stands behind their sign of equality, worked out from what is printed."""
    if isinstance(block, Formula):
        found, unread = equalities(lines(block))
        yield from (f"{e.units:.2f} units of the last digit: {e.left} = {e.right}" for e in found if not e.holds)
        yield from (f"not read: {u}" for u in unread)


def where(blocks: list[Any]) -> Iterator[str]:
    """Explanations that do not stand right behind a formula with a number."""
    for before, block in pairwise(blocks):
        if isinstance(block, Where) and not (isinstance(before, Formula) and before.number):
            yield said(block.rows[0].meaning)


def atoms(node: Node) -> Iterator[str]:
    """Letters with their indices, one after another; a power is no part of its letter."""
    if isinstance(node, Scripts) and isinstance(node.base, Letters | Barred):
        power = isinstance(node.above, Figures) or (isinstance(node.above, FormulaRow) and isinstance(node.above.items[0], Figures))
        yield line(Scripts(node.base, node.below, None if power else node.above))
    elif isinstance(node, Letters | Barred):
        yield line(node)
    else:
        for part in node.parts():
            yield from atoms(part)


CONSTANTS = {"π", "d"}
"""Letters that need no words: a number, the sign of a derivative."""


def unexplained(blocks: list[Any]) -> Iterator[str]:
    """Letters of formulas with numbers that no line under "where" has explained so far."""
    explained = set(CONSTANTS)
    of_index: set[str] = set()  # letters of which one is explained for all indices
    for block, after in pairwise([*blocks, None]):
        if isinstance(block, Where):
            continue
        if isinstance(after, Where):
            explained |= {a.rstrip("′″") for row in after.rows for a in atoms(row.symbol)}
            of_index |= {line(row.symbol)[0] for row in after.rows if re.search("индекс|індекс|index", said(row.meaning))}
        if isinstance(block, Formula) and _has_numbers(blocks, block):
            missing = [a for of in block.lines for a in atoms(of)
                       if a.rstrip("′″") not in explained and a[0] not in of_index and "̅" not in a]
            if missing:
                yield f"{', '.join(dict.fromkeys(missing))} in {lines(block)[:90]}"
                explained |= set(missing)


def _has_numbers(blocks: list[Any], block: Formula) -> bool:
    """Whether numbers stand in a formula or in the one right after it."""
    at = next(i for i, b in enumerate(blocks) if b is block)
    later = [b for b in blocks[at + 1 : at + 3] if isinstance(b, Formula) and not b.number]
    return any(True for b in (block, *later) for of in b.lines for _ in of.numbers())


DIMENSIONLESS = re.compile(
    "(коэффициент(?! жёстк)|число|заданное|доля|наименьш(ее|ий) (число|коэффициент)|степень|отношение|передаточное|КПД|"
    "эвольвентный|удельное|целое|разность, равная|относительное|аналог ускорения)|.*в модулях|то же справа")
"""How the meanings begin of what has no unit, in Russian: the other languages say the same of the same numbers."""


def without_unit(block: Any) -> Iterator[str]:
    """Letters explained without the unit that they have."""
    if isinstance(block, Where):
        yield from (said(r.meaning) for r in block.rows if not r.unit and not DIMENSIONLESS.match(said(r.meaning)))


GIVEN = re.compile(r"[a-z]\w*(\[\d+\])?(\.[\w\[\]]+)+")
OURS = ("scales.", "structure.", "note.", "cycle", "forces.gravity")
"""Givens that are chosen and told where they are used."""


def untold(note: Note) -> Iterator[str]:
    """Numbers of the project file that formulas use and the task does not give."""
    tables = (b for b in note.front if isinstance(b, NumberedTable))
    task = {x.step for b in tables for row in b.rows for cell in row for x in cell if isinstance(x, NumberInText)}
    told = {x.step for b in note.blocks() for text in texts(b) for x in text
            if isinstance(x, NumberInText) and GIVEN.fullmatch(x.step)}
    used = {x.step for b in note.blocks() if isinstance(b, Formula) for of in b.lines for x in of.numbers()}
    yield from sorted(u for u in used if GIVEN.fullmatch(u) and not u.startswith(OURS) and u not in task | told)


def misnumbered(blocks: list[Any]) -> Iterator[str]:
    """Tables, figures and formulas that bear the number of another section than that they stand in."""
    section = ""
    for block in blocks:
        if isinstance(block, Heading) and (block.level == 1 or not block.number):
            section = block.number
        if isinstance(block, NumberedTable | Figure | Formula) and block.number:
            head, dot, _ = block.number.strip("()").rpartition(".")
            if head != section or bool(dot) != bool(section):
                yield f"{type(block).__name__} {block.number} in section {section or 'without number'}"


def inconclusive(note: Note) -> Iterator[str]:
    """Conclusions without a result, and sheets that no section speaks of."""
    own = phrases.text_of(note.language, "conclusion").splitlines()[0].removeprefix("=! ")
    blocks = list(note.body)
    at = next(i for i, b in enumerate(blocks) if isinstance(b, Heading) and b.text == own)
    if not (isinstance(blocks[at + 2], Paragraph) and blocks[at + 2].look == "item"):
        yield f"{own}: no result"
    told = " ".join(said(text) for b in blocks[:at] for text in texts(b))
    for sheet in (b for b in blocks if isinstance(b, Sheet)):
        if not re.search(rf"(?:лист|аркуш|sheet)\w*\s+(?:\d+\D{{1,5}})*{sheet.number}\b", told, re.IGNORECASE):
            yield f"sheet {sheet.number} is spoken of nowhere"


def two_signs(note: Note) -> Iterator[str]:
    """Angular velocities and accelerations that have one sign in a table and the other in a formula, bars left out."""
    found: dict[tuple[str, str], set[bool]] = {}
    for block in note.blocks():
        numbers: Iterable[NumberInText] = ()
        if isinstance(block, Formula) and "abs(" not in lines(block):
            numbers = (x for of in block.lines for x in of.numbers())
        elif isinstance(block, NumberedTable):
            numbers = (x for row in block.rows for cell in row for x in cell if isinstance(x, NumberInText))
        for x in numbers:
            if x.value and re.fullmatch(r"(velocities/ω|accelerations/ε)\w+", x.step):
                found.setdefault((x.step, x.position), set()).add(x.value > 0)
    yield from (f"{step} in position {position}" for (step, position), signs in found.items() if len(signs) > 1)


_EXPRESSION = re.compile(
    r"(?<![\w|/·.,)′^])([\d(−][\d,.°′″·+−()/ ×]*) = (−?[\d,.]++(?:°(?:[\d,.]+′)?(?:[\d,.]+″)?)?+)(?!\s?[·/²³(])")


def sums_in_words(block: Any) -> Iterator[str]:
    """Equalities of numbers within sentences that do not hold."""
    for text in texts(block):
        for m in _EXPRESSION.finditer(said(text).replace("\u00a0", " ")):
            found, _ = equalities(m[0].rstrip(".,"))
            yield from (f"{e.left} = {e.right}" for e in found if not e.holds)


def content_faults(note: Note) -> Iterator[Fault]:
    """Everything that is wrong with the text of a note."""
    blocks = list(note.blocks())
    language = note.language
    place = ""
    for block in (*blocks, *note.reminders):
        if isinstance(block, Heading):
            place = f"{block.number} {block.text}".strip()
        for kind, found in (
            ("empty", () if _is_source(block) else empty(block)), ("unnamed row", unnamed(block)),
            ("markup", braces(block)), ("unit", units(block, language)),
            ("alphabet", () if _is_source(block) or block in note.reminders else scripts(block, language)),
            ("plural", plurals(block, language)),
            ("euphony", euphony(block) if language == "uk" else ()),
            ("formula", formulas(block)), ("sum", sums_in_words(block)),
            ("no unit", without_unit(block) if language == "ru" else ()),
        ):  # fmt: skip
            yield from (Fault(kind, place, text) for text in found)
    yield from (Fault("where", "", text) for text in where(blocks))
    yield from (Fault("unexplained", "", text) for text in unexplained(blocks))
    yield from (Fault("not in the task", "", text) for text in untold(note))
    yield from (Fault("numbering", "", text) for text in misnumbered(blocks))
    yield from (Fault("sign", "", text) for text in two_signs(note))
    yield from (Fault("conclusion", "", text) for text in inconclusive(note))
    yield from (Fault("problem", "", text) for text in note.problems)


def _is_source(block: Any) -> bool:
    return isinstance(block, Paragraph) and bool(re.match(r"\d+\. ", said(block.text)))


# --- the command

def counted(note: Note) -> int:
    """How many equalities between numbers a note has."""
    return sum(len(equalities(lines(b))[0]) for b in note.blocks() if isinstance(b, Formula))


def judged(asked: tuple[str, str]) -> tuple[str, str, list[Fault], int]:
    """Faults of the note of a project in a language, and how many formulas it has."""
    name, language = asked
    project = Project(catalogue.read(name))
    with words.on_paper(language):
        note = composing.compose(project)
    return name, language, list(content_faults(note)), counted(note)


def names(patterns: Iterable[str]) -> list[str]:
    """Shipped projects that match, and files."""
    patterns = list(patterns)
    found = [n for n in catalogue.shipped() if not patterns or any(fnmatch(n, p) for p in patterns)]
    return found + [p for p in patterns if p not in found and not any(c in p for c in "*?[")]


def main() -> int:
    """Print the faults; 1 when there are any."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("project", nargs="*")
    parser.add_argument("--lang", action="append", choices=words.LANGUAGES)
    arguments = parser.parse_args()
    languages = arguments.lang or words.LANGUAGES
    work = [(name, language) for name in names(arguments.project) for language in languages]
    kinds: Counter[str] = Counter()
    equal = 0
    with Pool(2) as pool:
        for name, language, found, n in pool.imap(judged, work):
            equal += n
            for fault in found:
                kinds[fault.kind] += 1
                print(f"{name} {language}: {fault.kind}: {fault.text} [{fault.place}]", flush=True)
    print(f"{len(work)} notes, {equal} formulas worked out; faults: {dict(kinds) or 'none'}")
    return 1 if kinds else 0


if __name__ == "__main__":
    sys.exit(main())
