"""Pages of finished notes: where figures, tables and "where" stand, read off the files as a reader sees them.

    python -m tests.note.check_pages                             # every shipped project, Russian, Ukrainian, English
    python -m tests.note.check_pages lugansk/shaper --lang ru    # one
    python -m tests.note.check_pages --share 8                   # every eighth of them, each in one of the languages

The PDF is read line by line with the places of its words, the DOCX paragraph by paragraph; nothing here knows the program's tree.
"""

from __future__ import annotations

import argparse
import io
import re
import sys
import xml.etree.ElementTree as ET
import zipfile
from collections import Counter
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

LANGUAGES = ("ru", "uk", "en")
SAID = {
    "ru": {"figure": r"Рис\.", "table": "Таблица", "where": "где", "continued": r"Продолжение таблицы", "part": "лист"},
    "uk": {"figure": r"Рис\.", "table": "Таблиця", "where": "де", "continued": r"Продовження таблиці", "part": "аркуш"},
    "en": {"figure": r"Fig\.", "table": "Table", "where": "where", "continued": r"Continuation of table", "part": "sheet"},
}
"""Words as they are printed."""
SPOKEN = {"figure": r"(?:рис|[Ff]ig)\.", "table": r"(?:табли\w+|tables?)"}
NUMBERS = r"\d+(?:\.\d+)?"
FRAME = (19.5, 4.5, 205.5, 292.5)
"""Inside of the frame, mm from the lower left corner, with half the width of its line."""
MITRE = 5000.0
"""As large as pdfium reckons a picture with a sharp corner in a line, whose mitre nobody draws, mm."""
HEADING = 12.5
"""Size of letters from which on a line is a heading, pt."""
SPACE = 0.4
"""Between pieces of a line that are not one word, mm."""
HYPHEN = re.compile(r" ?[\x02\ufffe\u2010-]$")
"""How a line ends that parts a word."""
FULL = 0.6
"""Share of a page that is filled, below which it is told as half empty; the last one of a section is not asked."""

KINDS = {
    "unsaid": "nothing refers to it",
    "before": "stands before what refers to it",
    "elsewhere": "in another subsection than its reference",
    "far": "two or more pages from its reference",
    "disorder": "numbers out of order",
    "cut": "something stands between a formula and its \"where\"",
    "parted": "a page ends between a formula and its \"where\"",
    "uncontinued": "a table goes on without \"continued\"",
    "outside": "something crosses the frame",
    "clipped": "ink of a picture is cut at its edge",
    "empty": "a page within a section is less than 60 % full",
}
"""Kinds of fault; ``empty`` is no fault but a price."""
FAULTS = tuple(k for k in KINDS if k != "empty")


@dataclass(frozen=True)
class Event:
    """Something on the page that the rules speak of: ``kind`` heading, figure, part, table, continued,
    formula, where, speaks, page; ``label`` its number."""

    page: int
    kind: str
    label: str


@dataclass(frozen=True)
class Fault:
    """A fault with its kind and where it is."""

    kind: str
    where: str


# --- the PDF


@dataclass(frozen=True)
class Line:
    """A line of a page, mm from the lower left corner; ``parts`` are its pieces with their left ends."""

    y: float
    x0: float
    x1: float
    size: float
    text: str
    parts: tuple[tuple[float, str], ...]


def lines_of(page: Any) -> list[Line]:
    """Lines of the text of a page from the top, without its stamp."""
    import pypdfium2.raw as raw

    textpage = page.get_textpage()
    mm = 25.4 / 72
    found: list[list[tuple[float, float, float, float, str]]] = []
    for i in range(textpage.count_rects()):
        left, low, right, high = textpage.get_rect(i)
        text = textpage.get_text_bounded(left, low, right, high).replace("\r\n", " ")
        if not text.strip() or high * mm < 20:
            continue
        piece = (left * mm, low * mm, right * mm, high * mm, text)
        row = next((r for r in found[-8:] if abs(middle(r[0]) - middle(piece)) < 1.6), None)
        if row is None:
            found.append([piece])
        else:
            row.append(piece)
    made = []
    for row in found:
        row.sort()
        x, y = row[0][0] / mm, (row[0][1] + row[0][3]) / 2 / mm
        k = textpage.get_index(x, y, 4, 4)
        size = raw.FPDFText_GetFontSize(textpage, k) if k is not None and k >= 0 else 0.0
        joined = row[0][4] + "".join((" " if b[0] - a[2] > SPACE else "") + b[4] for a, b in pairwise(row))
        text = re.sub(r" (?=[,.;:])", "", re.sub(r"[\s\u00a0\u00ad\u2060]+", " ", joined)).strip()
        made.append(Line(max(map(middle, row)), row[0][0], max(p[2] for p in row), size, text, tuple((p[0], p[4]) for p in row)))
    return sorted(made, key=lambda line: -line.y)


def middle(piece: tuple[float, float, float, float, str]) -> float:
    """Height of the middle of a piece of text."""
    return (piece[1] + piece[3]) / 2


def events_of_pdf(data: bytes, language: str) -> tuple[list[Event], list[Fault]]:
    """Events of a PDF in the order of its pages from top to bottom, and the faults of single pages."""
    import pypdfium2

    said = SAID[language]
    document = pypdfium2.PdfDocument(data)
    events: list[Event] = []
    faults: list[Fault] = []
    heads: dict[str, list[str]] = {}
    last = ""
    filled: list[tuple[int, float]] = []
    for n in range(1, len(document) - 1):  # without the title page and the reminders
        page = document[n]
        lines = lines_of(page)
        if sum(bool(re.search(r"[. ]{8,}\d+$", line.text)) for line in lines) > 4:
            continue  # contents
        faults += [Fault("outside", f"p. {n + 1}: {what}") for what in outside(page, lines)]
        events.append(Event(n + 1, "page", str(n + 1)))
        text = ""
        at: list[int] = []
        filled.append((n + 1, min((line.y for line in lines), default=297.0)))
        first = True
        for line in lines:
            continued = re.fullmatch(rf"(?:{said['continued']}) ({NUMBERS})", line.text)
            if first and last and not continued and line.text in heads.get(last, ()) and len(line.text) > 3:
                faults.append(Fault("uncontinued", f"p. {n + 1}: {last}"))
            if line.size >= HEADING:
                heading = re.match(rf"({NUMBERS}) \D", line.text)
                if heading or not re.fullmatch(r"[\d .,]*", line.text):
                    events.append(Event(n + 1, "heading", heading[1] if heading else line.text))
            elif caption := re.match(rf"{said['figure']} ({NUMBERS})\. ", line.text):
                events.append(Event(n + 1, "figure", caption[1]))
            elif caption := re.fullmatch(rf"{said['figure']} ({NUMBERS}), {said['part']} \d+", line.text):
                events.append(Event(n + 1, "part", caption[1]))
            elif (table := re.fullmatch(rf"{said['table']} ({NUMBERS})", line.text)) and line.x1 > 190:
                events.append(Event(n + 1, "table", table[1]))
                last, heads[table[1]] = table[1], []
            elif continued:
                events.append(Event(n + 1, "continued", continued[1]))
            else:
                if line.parts[0][1].strip() == said["where"] and line.x0 < 25.5 and line.parts[1][0] - line.x0 > 9:
                    events.append(Event(n + 1, "where", ""))
                if (number := re.fullmatch(rf"\(({NUMBERS})\)", line.parts[-1][1].strip())) and line.x1 > 192:
                    events.append(Event(n + 1, "formula", number[1]))
                if last and len(heads[last]) < 5:
                    heads[last].append(line.text)
                whole = HYPHEN.sub("", line.text)
                text += whole if whole != line.text else whole + "\n"
                at += [len(events)] * (len(text) - len(at))
            first = False
        spoken = [(at[m.start()], Event(n + 1, "speaks", label)) for m, label in references(text)]
        for where, event in sorted(spoken, key=lambda x: x[0], reverse=True):
            events.insert(where, event)
    sections = {e.page for e in events if e.kind == "heading" and not re.fullmatch(r"\d+\.\d+", e.label)}
    for (number, low), (after, _) in pairwise(filled):
        if after not in sections and after == number + 1 and (share := (286.0 - low) / 262.0) < FULL:
            faults.append(Fault("empty", f"p. {number}: {share:.0%}"))
    return events, faults


def references(text: str) -> Iterator[tuple[re.Match[str], str]]:
    """What a text refers to: each number after the word, "fig. 3.5, 3.6" too."""
    for kind, word in SPOKEN.items():
        for m in re.finditer(rf"{word}\s+({NUMBERS}(?:,\s+{NUMBERS})*)", text):
            for number in re.findall(NUMBERS, m[1]):
                yield m, f"{kind}:{number}"


def outside(page: Any, lines: Iterable[Line]) -> Iterator[str]:
    """What of a page crosses its frame: lines of text, pictures and rules."""
    import pypdfium2.raw as raw

    for line in lines:
        if line.x0 < FRAME[0] or line.x1 > FRAME[2]:
            yield line.text[:40]
    mm = 25.4 / 72
    for item in page.get_objects(filter=(raw.FPDF_PAGEOBJ_PATH, raw.FPDF_PAGEOBJ_FORM), max_depth=1):
        x0, y0, x1, y1 = (v * mm for v in item.get_bounds())
        if max(x1 - x0, y1 - y0) > MITRE:
            continue
        if x0 < FRAME[0] or y0 < FRAME[1] or x1 > FRAME[2] or y1 > FRAME[3]:
            yield f"a picture or rule at {x0:.0f}..{x1:.0f} x {y0:.0f}..{y1:.0f}"


# --- the DOCX

_W = "{http://schemas.openxmlformats.org/wordprocessingml/2006/main}"


def events_of_docx(data: bytes, language: str) -> list[Event]:
    """Events of a DOCX in the order of its paragraphs, all on page 0: where its pages end Word alone knows."""
    said = SAID[language]
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        body = ET.fromstring(archive.read("word/document.xml"))
    events: list[Event] = []
    for p in body.iter(f"{_W}p"):
        style = p.find(f"{_W}pPr/{_W}pStyle")
        name = style.get(f"{_W}val", "") if style is not None else ""
        text = "".join("\t" if x.tag == f"{_W}tab" else x.text or "" for x in p.iter() if x.tag in (f"{_W}t", f"{_W}tab"))
        text = text.replace("\u00a0", " ")
        if name.startswith("Heading"):
            heading = re.match(rf"({NUMBERS}) ", text)
            events.append(Event(0, "heading", heading[1] if heading else text))
        elif caption := re.match(rf"{said['figure']} ({NUMBERS})\. ", text):
            events.append(Event(0, "figure", caption[1]))
        elif caption := re.fullmatch(rf"{said['figure']} ({NUMBERS}), {said['part']} \d+", text):
            events.append(Event(0, "part", caption[1]))
        elif table := re.fullmatch(rf"{said['table']} ({NUMBERS})", text):
            events.append(Event(0, "table", table[1]))
        elif text.startswith(said["where"] + "\t"):
            events.append(Event(0, "where", ""))
        elif number := re.search(rf"\t\(({NUMBERS})\)$", text):
            events.append(Event(0, "formula", number[1]))
        else:
            events += [Event(0, "speaks", label) for _, label in references(text)]
    return events


_NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
_DRAWN = {"M": 2, "L": 2, "A": 7}
"""Numbers behind a command of a path; the last two are where it leads."""


def clipped(data: bytes) -> Iterator[Fault]:
    """Pictures of a DOCX that hold ink outside of what they show; it has the drawings of all that are not turned."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        for name in archive.namelist():
            if not re.search(r"media/fig-.*\.svg$", name):
                continue
            picture = ET.fromstring(archive.read(name))
            _, _, width, height = map(float, picture.get("viewBox", "").split())
            for x, y in _points(picture):
                if not (0 <= x <= width and 0 <= y <= height):
                    yield Fault("clipped", f"{name}: {x / 1000:.0f}, {y / 1000:.0f} mm of {width / 1000:.0f} x {height / 1000:.0f}")
                    break


def _points(picture: ET.Element) -> Iterator[tuple[float, float]]:
    """Where the lines of a picture lead."""
    for path in picture.iter("{http://www.w3.org/2000/svg}path"):
        for command, numbers in re.findall(r"([A-Za-z])([^A-Za-z]*)", path.get("d", "")):
            found = [float(v) for v in _NUMBER.findall(numbers)]
            size = _DRAWN.get(command, 0)
            assert command in "zZ" or (size and len(found) % size == 0), command
            for k in range(0, len(found), size or 1):
                yield found[k + size - 2], found[k + size - 1]


# --- the rules


def faults_of(events: list[Event]) -> Iterator[Fault]:
    """What of the rules some events break."""
    section = ""
    spoken: dict[str, list[tuple[int, int, str]]] = {}
    places: list[tuple[int, Event, str]] = []
    held = ""
    since: list[str] = []
    page = 0
    order: dict[str, list[str]] = {"figure": [], "table": []}
    for i, e in enumerate(events):
        if e.kind == "heading":
            section = e.label
        if e.kind == "speaks":
            spoken.setdefault(e.label, []).append((i, e.page, section))
        if e.kind == "part":
            before = next(x for x in reversed(events[:i]) if x.kind in ("figure", "part"))
            if before.label != e.label or e.page - before.page > 1:
                yield Fault("far", f"figure {e.label} goes on on p. {e.page}")
        if e.kind in order:
            places.append((i, e, section))
            order[e.kind].append(e.label)
        if e.kind == "where":
            between = [x for x in since if x != "page"]
            if between or not held:
                yield Fault("cut", f"p. {e.page}: {held} – {', '.join(between)}")
            elif since:
                yield Fault("parted", f"p. {e.page}: {held}")
        if e.kind == "formula":
            held, since = e.label, []
        elif e.kind in ("figure", "part", "table", "heading", "page", "continued"):
            since.append(e.kind)
        page = e.page
    del page
    for kind, labels in order.items():
        for numbered in (True, False):  # those of the parts without a number are counted by themselves
            for before, after in pairwise([x for x in labels if ("." in x) is numbered]):
                if _key(before) >= _key(after):
                    yield Fault("disorder", f"{kind} {after} after {before}")
    for i, e, own in places:
        who = f"{e.kind} {e.label}, p. {e.page}"
        said = spoken.get(f"{e.kind}:{e.label}", [])
        if not said:
            yield Fault("unsaid", who)
            continue
        if min(said)[0] > i:
            yield Fault("before", who)
        if all(place != own for _, _, place in said):
            yield Fault("elsewhere", f"{who} in {own}, spoken of in {said[0][2]}")
        if all(abs(page - e.page) > 1 for _, page, _ in said):
            yield Fault("far", f"{who}, spoken of on {said[0][1]}")


def _key(label: str) -> tuple[int, ...]:
    return tuple(map(int, label.split(".")))


# --- notes


def judged(name: str, language: str, formats: tuple[str, ...]) -> dict[str, Any]:
    """The faults of the note of a project by the format of its file, and how many figures and pages it has."""
    from tests.note.opened import opened
    from tmm_sheets import words
    from tmm_sheets.note import note as writing

    with words.on_paper(language):
        made = writing.write(opened(name), formats)
    found: dict[str, Any] = {"name": name, "language": language, "pages": made.pages}
    if "pdf" in formats:
        events, faults = events_of_pdf(made.files["note.pdf"], language)
        found["figures"] = sum(e.kind == "figure" for e in events)
        found["tables"] = sum(e.kind == "table" for e in events)
        found["continued"] = sum(e.kind == "continued" for e in events)
        found["pdf"] = [*faults, *faults_of(events)]
    if "docx" in formats:
        word = made.files["note.docx"]
        found["docx"] = [*clipped(word), *faults_of(events_of_docx(word, language))]
    return found


def main(arguments: list[str]) -> int:
    """Judge the notes asked for; 1 when one has a fault."""
    from tmm_sheets import catalogue

    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("projects", nargs="*", help="all shipped ones unless named")
    parser.add_argument("--lang", action="append", choices=LANGUAGES)
    parser.add_argument("--format", default="pdf,docx")
    parser.add_argument("--share", type=int, default=1, help="every so many projects only, in one language each")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--brief", action="store_true", help="the counts alone")
    a = parser.parse_args(arguments)
    names = a.projects or list(catalogue.shipped())
    languages = a.lang or LANGUAGES
    asked = [(n, language) for n in names for language in languages]
    if a.share > 1:
        asked = [(n, languages[i % len(languages)]) for i, n in enumerate(names[:: a.share])]
    formats = tuple(a.format.split(","))
    total: dict[str, Counter[str]] = {form: Counter() for form in formats}
    counts: Counter[str] = Counter()
    with ProcessPoolExecutor(a.processes) as pool:
        for found in pool.map(judged, *zip(*asked, strict=True), [formats] * len(asked)):
            counts.update({k: found.get(k, 0) for k in ("pages", "figures", "tables", "continued")} | {"notes": 1})
            for form in formats:
                total[form].update(f.kind for f in found[form])
                for f in [] if a.brief else found[form]:
                    print(f"{found['name']} {found['language']} {form}: {KINDS[f.kind]}: {f.where}", flush=True)
    print(", ".join(f"{counts[k]} {k}" for k in ("notes", "pages", "figures", "tables", "continued")))
    for form in formats:
        print(f"{form}: " + (", ".join(f"{n} {k}" for k, n in total[form].most_common()) or "nothing"))
    return int(any(total[form][k] for form in formats for k in FAULTS))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
