"""Build the lettering from the stroke font.

``type_b.json`` has strokes and advances, ``TMMSheetsB.ttf`` the same outlined, ``tmm_sheets_b.lff`` the same for LibreCAD.

Run ``python templates/fonts/build.py`` after a change of the ``.lff`` files; needs fontTools and shapely (extra ``fonts``).
``lc_opengost-br.lff`` is the font as it was published, ``added.lff`` what it lacks and the marks that letters with accents are
made of.
All come from one set of polylines and one table of advances, so that PDF (outlines) and DXF or a plotter (strokes)
set every letter at the same place. GOST 2.304 type B: d = h/10; here h = 700 units, d = 70 units, 1000 units to the em.
"""

from __future__ import annotations

import cmath
import json
import math
import re
import sys
import unicodedata
from pathlib import Path

HERE = Path(__file__).resolve().parent
CAP = 700  # units: height h of a capital letter
D = CAP / 10  # stroke width of type B
GAP = 2 * D  # between letters (GOST 2.304, a)
WORD = 6 * D  # between words (GOST 2.304, e)
UNIT = CAP / 9  # the stroke fonts have capital letters 9 units high, stroke width included
SLANT = math.tan(math.radians(15))
STROKE_CHORD = 0.004 * CAP  # greatest distance of a polyline from its arc: 0.02 mm in letters 5 mm high
OUTLINE_CHORD = 0.001 * CAP
DOT = 0.36  # least length of a dot's stroke in LFF units: a dot as small as the pen drowns beside a line
OUTLINE = 2  # the outlines are twice as fine as the table: 2000 units to the em

WIDTH = {"З": 5, "з": 4, "8": 5, "Ҙ": 5, "ҙ": 4}  # letters the stroke font makes wider than GOST 2.304 does, in d
SAME = {"Ə": "Ә", "ə": "ә", "Ω": "Ω", "µ": "μ", "∆": "Δ", "·": "∙", "ϕ": "φ", "\u2011": "-", "\u2010": "-"}
SOURCES = ("lc_opengost-br.lff", "added.lff")
ABOVE = "\u0300\u0301\u0302\u0303\u0304\u0306\u0307\u0308\u030a\u030b\u030c\u0312"  # combining marks
COMMA_ABOVE, COMMA_BELOW, CEDILLA, OGONEK = "\u0312\u0326\u0327\u0328"
LIFT, X_HEIGHT, FOOT = 2.7, 7.0, 0.5  # LFF units: of a mark over a capital; small letters without stem are lower; feet are lower
COMPOSED = "ĄąĘęÅåŮů"  # the stroke font has their ogonek apart from the letter, their ring upon it
LATIN = [chr(c) for c in range(0xC0, 0x180) if chr(c) not in "×÷"] + list("ƏəȘșȚțẀẁẂẃẄẅẞỲỳ")
CYRILLIC = [chr(c) for c in (*range(0x400, 0x410), *range(0x450, 0x460))] + list("ӘәҒғҚқҢңӨөҰұҮүҺһҖҗҲҳҶҷҠҡҘҙҪҫ")
KEEP = (
    [chr(c) for c in range(0x21, 0x7F)]
    + list("«»°±²³·×÷µ½¼¾§")
    + [chr(c) for c in range(0x391, 0x3CA) if c not in (0x3A2, 0x3AA, 0x3AB, 0x3AC, 0x3AD, 0x3AE, 0x3AF, 0x3B0)]
    + [chr(c) for c in range(0x410, 0x450)]
    + LATIN
    + CYRILLIC
    + list("Ґґ–—‘’“”„…′″‴№∅∆∇−∙√∝∞∟∠∥∫∮≈≠≡≤≥⊥∑→←↑↓ℓΩϕ∼≅∘⁰¹⁴⁵⁶⁷⁸⁹₀₁₂₃₄₅₆₇₈₉ªº¡¿©®™€‰•‹›‚\u2010\u2011")
)


def arc(a: complex, b: complex, bulge: float, sagitta: float) -> list[complex]:
    """Points of an arc after ``a`` up to ``b``; bulge = tan of a quarter of the angle, positive counter-clockwise."""
    angle = 4 * math.atan(bulge)
    chord = b - a
    radius = abs(chord) / 2 / abs(math.sin(angle / 2))
    centre = (a + b) / 2 + 1j * chord / 2 / math.tan(angle / 2)
    n = max(math.ceil(abs(angle) / (2 * math.acos(max(1 - sagitta / (radius * UNIT), 0)))), 2)
    return [*(centre + (a - centre) * cmath.rect(1, angle * i / n) for i in range(1, n)), b]


def polyline(text: str, sagitta: float) -> list[complex]:
    """One polyline of an LFF file."""
    points: list[complex] = []
    for word in text.split(";"):
        x, y, *rest = word.split(",")
        p = complex(float(x), float(y))
        curved = rest and points and p != points[-1]
        points += arc(points[-1], p, float(rest[0][1:]), sagitta) if curved else [p]
    if len(points) == 2 and abs(points[1] - points[0]) < DOT:
        middle = sum(points) / 2
        points = [middle, middle + 1j * DOT]
    return points


def read(sagitta: float) -> dict[str, list[list[complex]]]:
    """Glyphs of the LFF files as centre lines in LFF units, arcs cut into chords, and those made of a letter and a mark."""
    glyphs: dict[str, list[list[complex]]] = {}
    strokes: list[list[complex]] = []
    for line in (line for name in SOURCES for line in (HERE / name).read_text(encoding="utf-8").splitlines()):
        if head := re.match(r"\[#?([0-9a-fA-F]+)\]", line):
            strokes = glyphs[chr(int(head[1], 16))] = []
        elif copied := re.match(r"C([0-9a-fA-F]+)", line):
            strokes.extend(glyphs[chr(int(copied[1], 16))])
        elif line and not line.startswith("#"):
            strokes.append(polyline(line, sagitta))
    made = [c for c in LATIN if c in COMPOSED or (c not in glyphs and c not in SAME)]
    return glyphs | {char: composed(char, glyphs) for char in made}


def composed(char: str, glyphs: dict[str, list[list[complex]]]) -> list[list[complex]]:
    """A letter with its mark: the mark over or under the middle, an ogonek at the last foot."""
    base, mark = unicodedata.normalize("NFD", char)
    if base in "GKLNRTgklnrt" and mark == CEDILLA:  # so it is called, but Latvian and Romanian have a comma
        mark = COMMA_ABOVE if base == "g" else COMMA_BELOW
    if mark in ABOVE:
        base = {"i": "ı", "j": "ȷ"}.get(base, base)
    points = [p for s in glyphs[base] for p in s]
    left, right = (end(p.real for p in points) for end in (min, max))
    at = complex((left + right) / 2, LIFT if mark in ABOVE and max(p.imag for p in points) > X_HEIGHT else 0)
    if mark == OGONEK:
        at = complex(max(p.real for p in points if p.imag < FOOT), 0)
    return [*glyphs[base], *([p + at for p in s] for s in glyphs[mark])]


def table(glyphs: dict[str, list[list[complex]]]) -> dict[str, tuple[int, list[list[complex]]]]:
    """Advance and centre lines of every glyph in whole units, not slanted; ink starts at x = 0."""
    out: dict[str, tuple[int, list[list[complex]]]] = {" ": (round(WORD - GAP), []), "\u00a0": (round(WORD - GAP), [])}
    for char in KEEP:
        strokes = glyphs[SAME.get(char, char)]
        left, right = (end(p.real for s in strokes for p in s) for end in (min, max))
        unit = (WIDTH[char] - 1) * D / (right - left) if char in WIDTH else UNIT
        placed = [[complex(round((p.real - left) * unit + D / 2), round(p.imag * UNIT)) for p in s] for s in strokes]
        right = max(p.real for s in placed for p in s) + D / 2
        out[char] = (round(right + GAP), placed)
    return out


def write_table(glyphs: dict[str, tuple[int, list[list[complex]]]], path: Path) -> None:
    """``type_b.json``: character -> [advance, strokes "x,y x,y ...;x,y ..."]."""
    rows = {
        char: [advance, ";".join(" ".join(f"{p.real:.0f},{p.imag:.0f}" for p in s) for s in strokes)]
        for char, (advance, strokes) in sorted(glyphs.items())
    }
    body = ",\n".join(f"  {json.dumps(c, ensure_ascii=False)}: {json.dumps(r)}" for c, r in rows.items())
    head = {
        "source": "lc_opengost-br.lff and added.lff, SIL Open Font License 1.1, see OFL.txt; made by build.py",
        "cap": CAP,
        "stroke": round(D),
        "slant": SLANT,
    }
    lines = [f" {json.dumps(k)}: {json.dumps(v)}" for k, v in head.items()]
    path.write_text("{\n" + ",\n".join([*lines, f' "glyphs": {{\n{body}\n }}']) + "\n}\n", encoding="utf-8")


APART = 80.0
"""Distance of letters in LibreCAD, in units: of all it moves fewest letters of a sheet by more than half a millimetre."""


def write_lff(glyphs: dict[str, tuple[int, list[list[complex]]]], path: Path) -> None:
    """The strokes slanted, as LibreCAD reads them.

    LibreCAD has no advances: to it a letter is as wide as its ink reaches, and the next one follows at one distance for all. So
    each letter is moved in its cell until it ends that far before the next begins, 0.3 mm in the mean in letters 3.5 mm high.
    """
    lines = ["# Format:            LibreCAD Font 1", "# Version:           1.1", f"# Name:              {path.stem}",
             "# Encoding:          UTF-8", f"# LetterSpacing:     {APART / UNIT:g}",
             f"# WordSpacing:       {(WORD - GAP) / UNIT:g}",
             "# LineSpacingFactor: 1.02", "# Author:            stranger573 <stranger573@mail.ru>; made by build.py",
             "# License:           SIL OPEN FONT LICENSE Version 1.1"]  # fmt: skip
    for char, (advance, strokes) in sorted(glyphs.items()):
        if strokes:
            slanted = [[p + SLANT * p.imag for p in s] for s in strokes]
            move = advance - APART - max(p.real for s in slanted for p in s)
            lines += ["", f"[{ord(char):04x}] {char}"]
            lines += [";".join(f"{(p.real + move) / UNIT:.3f},{p.imag / UNIT:.3f}" for p in s) for s in slanted]
    path.write_text("\n".join([*lines, ""]), encoding="utf-8")


def write_ttf(glyphs: dict[str, tuple[int, list[list[complex]]]], path: Path) -> None:
    """Outline the strokes with a round pen d wide, slant them and write a TrueType font."""
    from fontTools.fontBuilder import FontBuilder
    from fontTools.pens.ttGlyphPen import TTGlyphPen
    from shapely import MultiLineString, Point, affinity, unary_union
    from shapely.geometry.polygon import orient

    outlines, metrics, cmap = {}, {}, {}
    names = [".notdef"]
    for char, (advance, strokes) in sorted(glyphs.items()):
        name = f"u{ord(char):04X}"
        names.append(name)
        cmap[ord(char)] = name
        pen = TTGlyphPen(None)
        shapes = []
        for s in strokes:
            xy = [(p.real, p.imag) for p in s]
            line = MultiLineString([xy]) if len(set(xy)) > 1 else Point(xy[0])
            # The pen is round before the slant, as that of a plotter is after it: the strokes are slanted first.
            shapes.append(affinity.affine_transform(line, [1, SLANT, 0, 1, 0, 0]).buffer(D / 2, quad_segs=8))
        ink = unary_union(shapes).simplify(0.3) if shapes else None
        for part in getattr(ink, "geoms", [ink] if ink is not None else []):
            whole = orient(part, -1.0)
            for ring in (whole.exterior, *whole.interiors):
                points = [(round(x * OUTLINE), round(y * OUTLINE)) for x, y in ring.coords[:-1]]
                pen.moveTo(points[0])
                for p in points[1:]:
                    pen.lineTo(p)
                pen.closePath()
        outlines[name] = pen.glyph()
        metrics[name] = advance * OUTLINE
    box = TTGlyphPen(None)
    box.moveTo((140, 0))
    for corner in ((140, 1400), (840, 1400), (840, 0)):
        box.lineTo(corner)
    box.closePath()
    outlines[".notdef"], metrics[".notdef"] = box.glyph(), 980
    font = FontBuilder(1000 * OUTLINE, isTTF=True)
    font.setupGlyphOrder(names)
    font.setupCharacterMap(cmap)
    font.setupGlyf(outlines)
    glyf = font.font["glyf"]
    font.setupHorizontalMetrics({n: (a, getattr(glyf[n], "xMin", 0) or 0) for n, a in metrics.items()})
    font.setupHorizontalHeader(ascent=1900, descent=-600)
    font.setupNameTable(
        {
            "copyright": "Copyright (c) 2014, stranger573, with Reserved Font Name lc_opengost-br. Outlines of its strokes.",
            "familyName": "TMM Sheets B",
            "styleName": "Italic",
            "uniqueFontIdentifier": "TMM Sheets B Italic 1.0",
            "fullName": "TMM Sheets B Italic",
            "version": "Version 1.000",
            "psName": "TMMSheetsB-Italic",
            "licenseDescription": "SIL Open Font License, Version 1.1",
            "licenseInfoURL": "https://openfontlicense.org",
        }
    )
    heights = {"sCapHeight": CAP * OUTLINE, "sxHeight": round(0.7 * CAP * OUTLINE)}
    font.setupOS2(sTypoAscender=1900, sTypoDescender=-600, usWinAscent=1900, usWinDescent=600, fsSelection=1, **heights)
    font.setupPost(italicAngle=-15.0)
    font.font["head"].macStyle = 2
    font.font["head"].created = font.font["head"].modified = 3786912000  # 2024-01-01: the same bytes every time
    font.font.recalcTimestamp = False
    font.save(path)


def main() -> None:
    """Write the files beside this script, or into the folder given."""
    out = Path(sys.argv[1]) if len(sys.argv) > 1 else HERE
    strokes = table(read(STROKE_CHORD))
    outlines = table(read(OUTLINE_CHORD))
    write_table(strokes, out / "type_b.json")
    write_lff(strokes, out / "tmm_sheets_b.lff")
    # The finer chords of a round letter may reach one unit further; the advances must be the table's.
    write_ttf({c: (strokes[c][0], s) for c, (_, s) in outlines.items()}, out / "TMMSheetsB.ttf")


if __name__ == "__main__":
    main()
