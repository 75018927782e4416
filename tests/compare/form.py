"""The one form of the JSON of ``compare``, whatever was compared: what is wrong with a tree."""

from collections.abc import Iterator
from numbers import Real
from typing import Any

from tmm_sheets.compare.codes import CODES
from tmm_sheets.words import LANGUAGES

VERDICTS = {"green": "green", "amber": "amber", "red": "red", "not-judged": "not_judged"}
"""Key of the summary that counts each."""
TEXT, NUMBER, PLACE = "a text", "a number", "two numbers"
KEYS = {
    "id": TEXT, "code": TEXT, "verdict": TEXT, "view": TEXT, "plan": TEXT, "step": TEXT, "position": TEXT, "said": TEXT,
    "turn_rad": NUMBER, "growth": NUMBER, "length_mm": NUMBER, "tolerance_mm": NUMBER, "measured": NUMBER, "expected": NUMBER,
    "shift_mm": PLACE, "at_mm": PLACE,
}
"""What a key of a finding holds where it applies."""
WHOLE = {"schema", "source", "project", "lang", "start", "findings", "unclaimed", "summary"}
GONE = {"numbers", "elements", "extra", "looks", "built"}
"""Lists of the first form."""


def faults(tree: dict[str, Any]) -> Iterator[str]:
    """What a tree has that the form does not allow, or lacks."""
    if tree["schema"] != 2 or tree["source"] not in ("measured", "cad", "photo") or tree["lang"] not in LANGUAGES:
        yield f"{tree['schema']} {tree['source']} {tree['lang']}"
    yield from (f"no {key}" for key in WHOLE - tree.keys())
    yield from (f"{key} of the first form" for key in GONE & tree.keys())
    if ("sheet" in tree) == (tree["source"] == "measured"):
        yield "the sheet"
    ids = [f"f{k}" for k in range(1, len(tree["findings"]) + 1)]
    follows = {name for f in tree["findings"] for name in f.get("follows", ())}
    for f, expected in zip(tree["findings"], ids, strict=True):
        yield from _finding(f, expected)
        if set(f.get("follows", ())) - set(ids) or f["id"] in f.get("follows", ()):
            yield f"{f['id']} follows from {f['follows']}"
    if set(tree["start"]) - set(ids) or len(set(tree["start"])) < len(tree["start"]) or follows - set(tree["start"]):
        yield f"start {tree['start']}"
    for x in tree["unclaimed"]:
        if x["kind"] not in ("line", "arc", "text", "fill", "ink") or not _is(x["length_mm"], NUMBER) or not _is(x["at_mm"], PLACE):
            yield f"unclaimed {x}"
    for verdict, key in VERDICTS.items():
        if tree["summary"][key] != sum(f["verdict"] == verdict for f in tree["findings"]):
            yield f"summary, {key}"
    if not isinstance(tree["summary"]["views_missing"], int):
        yield "summary, views_missing"


def _finding(f: dict[str, Any], expected: str) -> Iterator[str]:
    if f["id"] != expected or f["code"] not in CODES or f["verdict"] not in VERDICTS or not f.get("said"):
        yield f"{f}"
    yield from (f"{f['id']}: {key} is not {kind}" for key, kind in KEYS.items() if key in f and not _is(f[key], kind))
    yield from (f"{f['id']}: {key} does not apply" for key, value in f.items() if value is None or value == "")
    if (f["code"] == "right") != (f["verdict"] == "green") and f["verdict"] == "green":
        yield f"{f['id']}: green, but {f['code']}"


def _is(value: Any, kind: str) -> bool:
    if kind == PLACE:
        return isinstance(value, list) and len(value) == 2 and all(_is(x, NUMBER) for x in value)
    return isinstance(value, str) if kind == TEXT else isinstance(value, Real) and not isinstance(value, bool)


def of_elements(tree: dict[str, Any]) -> list[dict[str, Any]]:
    """The findings on elements of the sheet, in the order of their numbers."""
    return [f for f in tree["findings"] if "element" in f]
