"""A story as one self-contained page: no script, no other file, pictures as SVG in it."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterator
from html import escape
from itertools import zip_longest
from urllib.parse import quote

import numpy as np

from tmm_sheets.compare.numbering import numbered
from tmm_sheets.compare.story import Story, StoryPicture, StoryTable, ToldMistake, clipped
from tmm_sheets.drawing.marks import Points
from tmm_sheets.words import reader, tell

STYLE = """
:root { color-scheme: light; }
body { font: 15px/1.45 system-ui, sans-serif; color: #1c1c1c; max-width: 1100px; margin: 1.5rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; margin: 0 0 .4rem; } h2 { font-size: 1.15rem; margin: 2rem 0 .6rem; border-bottom: 1px solid #bbb; }
p, li { margin: .2rem 0; } .about { color: #444; }
article { display: flex; flex-wrap: wrap; gap: 1rem; border-left: 5px solid #c00; background: #fafafa; }
article { margin: .8rem 0; padding: .6rem 1rem; }
article.amber { border-color: #e58a00; } article div { flex: 1 1 22rem; } article h3 { font-size: 1rem; margin: 0; }
article .where { color: #555; } svg { background: #fff; border: 1px solid #ddd; flex: 0 1 auto; max-width: 100%; height: auto; }
.scroll { overflow-x: auto; } table { border-collapse: collapse; margin: .4rem 0; font-size: .88rem; }
th, td { border: 1px solid #ccc; padding: .15rem .5rem; text-align: left; vertical-align: top; } th { background: #eee; }
tr.red td { background: #fde4e4; } tr.amber td { background: #fff3dc; }
.key span { display: inline-block; width: 1.6em; height: 0; border-top: 3px solid; vertical-align: middle; margin: 0 .3em 0 1em; }
@media print { article { break-inside: avoid; } }
"""
OURS, THEIRS, WRONG = "#0072b2", "#737373", "#d00000"
"""Colours of the exact lines, the drawn ones, and what is wrong."""
LONGEST = 430.0
"""Longer side of a picture, CSS pixels."""


def html(story: Story, folder: str = ".") -> bytes:
    """The page, UTF-8; ``folder`` is where from it the pages are that its tables lead to."""
    body = "\n".join(_parts(story, folder))
    return (f'<!DOCTYPE html>\n<html lang="{reader()}">\n<head>\n<meta charset="utf-8">\n'
            '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
            f"<title>{escape(story.title)}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n{body}\n</body>\n</html>\n").encode()


def _parts(story: Story, folder: str) -> Iterator[str]:
    yield f"<h1>{escape(story.title)}</h1>"
    yield from (f'<p class="about">{escape(line)}</p>' for line in story.about)
    if story.mistakes:
        yield f"<h2>{escape(tell('What is wrong'))}</h2>"
        if any(m.picture is not None for m in story.mistakes):
            key = ((OURS, tell("exact")), (THEIRS, tell("drawn")), (WRONG, tell("wrong")))
            yield '<p class="key">' + "".join(f'<span style="border-color:{c}"></span>{escape(said)}' for c, said in key) + "</p>"
        yield from map(_mistake, story.mistakes)
    yield from (_table(table, folder) for table in story.tables)
    if story.unjudged:
        yield f"<h2>{escape(tell('What could not be judged, and why'))}</h2>\n<ul>"
        yield from (f"<li>{escape(line)}</li>" for line in story.unjudged)
        yield "</ul>"


def _mistake(m: ToldMistake) -> str:
    details = "".join(f"<li>{escape(line)}</li>" for line in m.details)
    said = (f'<div><p class="where">{escape(m.where)}</p><h3>{escape(m.again or m.what)}</h3>'
            + (f"<ul>{details}</ul>" if details else "") + "</div>")
    return f'<article class="{m.verdict}">{said}{_picture(m.picture) if m.picture is not None else ""}</article>'


def _table(table: StoryTable, folder: str) -> str:
    head = "".join(f"<th>{escape(c)}</th>" for c in table.head)
    rows = "\n".join((f'<tr class="{verdict}">' if verdict else "<tr>") + "".join(
        f'<td><a href="{escape(quote(f"{folder}/{page}"))}">{escape(c)}</a></td>' if page and k == 1 else f"<td>{escape(c)}</td>"
        for k, c in enumerate(row)) + "</tr>" for row, verdict, page in zip_longest(table.rows, table.verdicts, table.pages))
    return (f"<h2>{escape(table.title)}</h2>\n<div class=\"scroll\"><table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{rows}\n"
            "</tbody></table></div>")


def _picture(p: StoryPicture) -> str:
    box = p.box
    scale = min(LONGEST / max(box.width, box.height, 1.0), 6.0)
    wide, high = box.width * scale, box.height * scale

    def x(z: complex) -> float:
        return (z.real - box.x0) * scale

    def y(z: complex) -> float:
        return (box.y1 - z.imag) * scale

    def path(lines: tuple[Points, ...], colour: str, width: float) -> str:
        d = "".join("M" + "L".join(f"{x(z):.1f} {y(z):.1f}" for z in line.tolist()) for line in clipped(lines, box))
        return f'<path d="{d}" fill="none" stroke="{colour}" stroke-width="{width}" stroke-linejoin="round"/>' if d else ""

    marks = "".join(f'<circle cx="{x(at):.1f}" cy="{y(at):.1f}" r="{r * scale:.1f}" fill="none" stroke="{WRONG}"'
                    ' stroke-opacity=".5"/>' for at, r, _ in p.places)
    for one in numbered(p.places, 13 / scale, box):
        if one.leader is not None:
            marks += path((np.array(one.leader),), WRONG, 0.6)
        marks += f'<text x="{x(one.at):.1f}" y="{y(one.at):.1f}" font-size="13" fill="{WRONG}">{escape(one.text)}</text>'
    photo = ""
    if p.photo is not None:
        b = p.photo.box
        photo = (f'<image x="{x(complex(b.x0, 0)):.1f}" y="{y(complex(0, b.y1)):.1f}" width="{b.width * scale:.1f}"'
                 f' height="{b.height * scale:.1f}" href="data:image/png;base64,{b64encode(p.photo.png).decode("ascii")}"/>')
    return (f'<svg width="{wide:.0f}" height="{high:.0f}" viewBox="0 0 {wide:.1f} {high:.1f}" role="img">{photo}'
            f"{path(p.theirs, THEIRS, 1.6)}{path(p.ours, OURS, 0.9)}{path(p.wrong, WRONG, 2.0)}{marks}</svg>")
