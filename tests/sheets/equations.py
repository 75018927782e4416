"""Do the formulas on sheets come out? Each is worked out from its lettering with a pocket calculator, as those of the note are.

Usage: python -m tests.sheets.equations [--ciphers N --seed S] [--lang L] [PROJECT ...]; without names all of
them: shipped projects, those of the tests, and N ciphers. Prints every formula that does not give what stands behind its sign of
equality, to half a unit of the last digit, then how many there are; ends with 1 when there is one.

Nothing here knows the program's trees or values; how a line is read is in :mod:`tests.note.printed_formulas`.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Iterator
from multiprocessing import Pool

from tests.labels import add_options, chosen
from tests.note.printed_formulas import Equality, equalities
from tmm_sheets import catalogue
from tmm_sheets.project import Project
from tmm_sheets.sheets.composed import Composed
from tmm_sheets.sheets.sheet import every
from tmm_sheets.words import on_paper

_GOES_ON = re.compile(r"[=+−·]\s")
"""How the next line of a broken formula begins."""
_INDEX = re.compile(r"_(?:\{((?:[^{}]|\{[^{}]*\})*)\}|([\w′″]+))")
_POWER = re.compile(r"\^(?:\{((?:[^{}]|\{[^{}]*\})*)\}|([\w.,]+|\*))")
_BORDER = re.compile(r";\s+|:\s+|,\s\s*(?=[^\d\s])|\s[<>≤≥≈]\s|(?<![=+−·/])\s\((?=[^\d\s−(|])|\.\s|\.$")
"""What parts a formula from the next one, from words before it or from a remark behind it."""
_UNIT = re.compile(r"(?<=[\d)|])\s((?:\(м|\(m|[^\W\d_]|%)[^=;\s_]*?)\s*(?=$|=)")


def formulas(sheet: Composed) -> Iterator[str]:
    """Lines with a sign of equality, as markup; what is broken over several is one."""
    line, height = "", 0.0
    for group in sheet.groups:
        if group.kind != "lettering":
            continue
        text = group.text.replace("\u00a0", " ").strip()
        size = sheet.drawing.marks[group.first].height  # type: ignore[union-attr]
        if line and size == height and (_GOES_ON.match(text) or line.endswith(("=", "+", "−", "·"))):
            line += f" {text}"
            continue
        if "=" in line:
            yield line
        line, height = text, size
    if "=" in line:
        yield line


def read(markup: str) -> Iterator[str]:
    """The formulas of a line as :func:`~tests.note.printed_formulas.equalities` reads them."""
    text = _INDEX.sub(lambda m: f"_{{{m[1] or m[2]}}}", markup)
    text = _POWER.sub(lambda m: f"^({m[1] or m[2]})", text).replace("[", "(").replace("]", ")")
    text = re.sub(r"\|(\w+–[^|]*)\|", r"L_{\1}", text)  # a segment between two points
    text = re.sub(r"\|([^|]*)\|", r"abs(\1)", text)
    for part in _parts(text):
        if "=" in part and "…" not in part:
            yield _UNIT.sub(lambda m: f" ⟦{m[1].strip()}⟧ ", part)


def _parts(text: str) -> Iterator[str]:
    """What stands between borders, none of them within brackets."""
    begin = depth = 0
    for m in re.finditer(rf"[()]|{_BORDER.pattern}", text):
        if m[0] == "(":
            depth += 1
        elif m[0] == ")":
            depth -= 1
        if depth < 0 or (not depth and m[0] not in "()"):
            yield text[begin : m.start()]
            begin, depth = m.end(), 0
    yield text[begin:]


def judged(sheet: Composed) -> tuple[list[Equality], list[str]]:
    """Equalities between numbers on a sheet, and what holds no letter and could not be read."""
    found: list[Equality] = []
    unread: list[str] = []
    for line in formulas(sheet):
        for part in read(line):
            equal, not_read = equalities(part)
            found += equal
            unread += [f"{u} in {line}" for u in not_read]
    return found, unread


def _project(asked: tuple[str, str]) -> tuple[str, str, list[tuple[int, Equality]], list[str]]:
    name, language = asked
    with on_paper(language):
        sheets = every(Project(catalogue.read(name))).drawn
    found = {n: judged(sheet) for n, sheet in sheets.items()}
    return name, language, [(n, e) for n, (equal, _) in found.items() for e in equal], [u for _, us in found.values() for u in us]


def main() -> int:
    """Print what does not come out; 1 when there is anything."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    add_options(parser, 8)
    asked = parser.parse_args()
    total = wrong = 0
    with Pool(2) as pool:
        for name, language, found, unread in pool.imap(_project, [(name, asked.lang) for name in chosen(asked)]):
            total += len(found)
            for n, e in found:
                if not e.holds:
                    wrong += 1
                    print(f"{name} {language} {n}: {e.left} = {e.right}: {e.units:.2f} units of the last digit", flush=True)
            for u in unread:
                wrong += 1
                print(f"{name} {language}: not read: {u}", flush=True)
    print(f"{total} equalities on sheets worked out; {wrong} do not come out")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
