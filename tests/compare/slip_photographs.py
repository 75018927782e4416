"""Photographs of sheets on which something usual was done otherwise: is it named?

``python -m tests.compare.slip_photographs [PICTURES] [--seed N] [--first I] [--sound] [--keep FOLDER]`` takes so many. On each
sheet one of :mod:`tests.compare.hypotheses` was done and all plans follow from it; it is drawn by the pencil of
:mod:`tests.foreign`, lies on that trial's tables, is folded, shaded and photographed there. With ``--sound`` nothing is done
otherwise, but lines are wrong one by one, as there: whatever is named then is named wrongly.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

import numpy as np

from tests.compare.own_layouts import Drawn, draws_alike, shaped_views, slipped
from tests.foreign import scene
from tests.foreign.drawing import Mark
from tmm_sheets.catalogue import read
from tmm_sheets.compare.diagnosis.hypotheses import Hypothesis, hypotheses
from tmm_sheets.compare.elements import Element, ElementView, KnownSheet, known_sheet
from tmm_sheets.compare.findings import FindingRecord
from tmm_sheets.compare.photo import image
from tmm_sheets.compare.photo.photo_report import image_report
from tmm_sheets.compare.placing import Placing
from tmm_sheets.compare.report_pages import page
from tmm_sheets.drawing.ink import letters
from tmm_sheets.drawing.marks import Text
from tmm_sheets.errors import CannotBuild
from tmm_sheets.project import Project

SHEETS = (("lugansk/shaper", 1), ("lugansk/engine", 1), ("press", 2), ("sixbar/3:2", 1), ("transport/diesel@01-Т-27", 1),
          ("sixbar/6:3", 1), ("sixbar/9:1", 1), ("press", 1))
DIFFICULTIES = ("plain", "wood", "gradient", "folds", "pale", "turned", "noise", "notebook")
ON = 0.03
"""Distance within which a line goes through a point, mm."""


def followed(drawn: Drawn, known: KnownSheet) -> list[Element]:
    """The whole sheet, helper lines too: what runs through points of a plan goes with them."""
    by_number = {e.number: e for e in drawn.elements}
    points: dict[object, dict[complex, complex]] = {}
    for e in known.elements:
        if e.view in drawn.built and e.role == "vector" and e.kind == "line" and e.number in by_number:
            points.setdefault(e.view, {}).update(zip(e.points.tolist(), by_number[e.number].points.tolist(), strict=True))
    out = []
    for e in known.elements:
        if e.view not in drawn.built:
            out.append(e)
        elif e.kind == "line" and e.role == "construction":
            out.append(replace(e, points=along(e.points, points.get(e.view, {}))))
        elif e.number in by_number:
            out.append(by_number[e.number])
    return out


def along(line: np.ndarray, points: dict[complex, complex]) -> np.ndarray:
    """A line through points that have gone elsewhere."""
    u = (line[1] - line[0]) / abs(line[1] - line[0])
    at_line = ((((z - line[0]) / u), z) for z in points)
    on = sorted(((w.real, z) for w, z in at_line if abs(w.imag) < ON), key=lambda x: x[0])
    on = [(at, z) for at, z in on if -1 < at < abs(line[1] - line[0]) + 1]
    if not on:
        return line
    (_, first), (_, last) = on[0], on[-1]
    turn = (points[last] - points[first]) / (last - first) if abs(last - first) > 1 else 1.0
    turn = turn / abs(turn) if abs(turn) > 1e-6 else 1.0
    return points[first] + (line - first) * turn


def marks_of(elements: list[Element], was: dict[int, Element]) -> list[Mark]:
    """The elements as the foreign trial's pencil draws them."""
    out = []

    def mark(e: Element, kind: str, points: np.ndarray, **more: object) -> None:
        xy = np.stack((np.real(points), np.imag(points)), axis=-1)
        out.append(Mark(len(out), kind, str(e.view.n), e.role, e.style, xy, **more))  # type: ignore[arg-type]

    for e in elements:
        if e.kind == "text":
            by = e.points[0] - was[e.number].points[0]
            for m in e.marks:
                if isinstance(m, Text):
                    strokes = tuple(np.stack((p.real, p.imag), axis=-1) for p in (q + by for q in letters(m)))
                    mark(e, "text", np.array([m.at + by]), string=m.text, height=m.height, letters=strokes)
            lines = [p + by for p in e.pieces]
        else:
            filled = e.kind == "fill" or (e.kind == "circle" and e.fills)
            lines = list(e.pieces) if e.kind == "hatch" else [] if filled else [e.points]
        for p in lines:
            mark(e, e.kind if e.kind in ("line", "circle") else "curve", np.array([e.centre]) if e.kind == "circle" else p,
                 radius=e.radius)
        for f in e.fills:
            mark(e, "fill", f)
    return out


def shot(number: int, seed: int, sound: bool, folder: Path) -> tuple[Path, Project, KnownSheet, Drawn | None, str]:
    """The photograph of a number; None and no picture where the slip would not show."""
    name, n = SHEETS[number % len(SHEETS)]
    project = Project(read(name))
    known = known_sheet(project, n)
    drawn = Drawn(elements=list(known.elements), places={v: Placing() for v in shaped_views(known)})
    if not sound:
        drawn.slip = slipped(name, known, drawn, (1000 * seed + number, 15))
        if drawn.slip is None or not drawn.built:
            return folder, project, known, None, name
    what = scene.Scene(number, DIFFICULTIES[(number + number // len(SHEETS)) % len(DIFFICULTIES)], seed)
    what.traits = {what.difficulty}
    was = {e.number: e for e in known.elements}
    marks = marks_of(followed(drawn, known), was)
    random = what.random
    marks, wrong = scene.mistakes.plant(marks, int(random.choice((0, 2, 3, 4))), random) if sound else (marks, [])
    picture, truth = scene.taken(what, marks, marks, wrong, random)
    return scene.save(picture, truth, folder), project, known, drawn, f"{name} {n} {what.difficulty}"


def main() -> None:
    """Take photographs and count what is named."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("pictures", nargs="?", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--sound", action="store_true", help="nothing is done otherwise, lines are wrong one by one")
    parser.add_argument("--keep", type=Path, help="folder for pictures and reports")
    options = parser.parse_args()
    count: Counter[str] = Counter()
    with TemporaryDirectory() as made:
        folder = options.keep or Path(made)
        for number in range(options.first, options.first + options.pictures):
            file, project, known, drawn, title = shot(number, options.seed, options.sound, folder)
            if drawn is None:
                count["not shown"] += 1
                continue
            start = perf_counter()
            try:
                seen = image.examine(project, known.n, file)
            except CannotBuild as e:
                count["refused"] += 1
                print(number, title, "refused:", str(e)[:90], flush=True)
                continue
            taken = perf_counter() - start
            if options.keep:
                told = image_report(title, known.n, file, seen.found, seen.findings, seen.extra, 0.25, (), built=seen.built)
                (folder / f"{number:03d}.txt").write_text(told.text, encoding="utf-8")
                (folder / f"{number:03d}.html").write_bytes(page(told, ".html", title))
            outcome = judged(project, known, drawn, seen.built)
            count[outcome] += 1
            said = {v.name: b.remark.said() for v, b in seen.built.items()}
            print(number, title, f"{taken:.1f} s:", outcome, drawn.slip or "-", said, flush=True)
    print(dict(count))


def judged(project: Project, known: KnownSheet, drawn: Drawn, built: Mapping[ElementView, FindingRecord]) -> str:
    """What was told of a photograph."""
    told = [b for b in built.values() if "kind" in b.beside]
    if drawn.slip is None:
        return "sound, named" if built else "sound, nothing named"
    if any(b.beside["kind"] == drawn.slip.kind and b.step in {s.path for s in drawn.slip.ways} for b in told):
        return "named"
    if any(draws_alike(project, known, h, drawn) for b in told for h in meant(project, b)):
        return "named as what draws the same"
    return "named wrongly" if told else "told as a point" if built else "not named"


def meant(project: Project, b: FindingRecord) -> list[Hypothesis]:
    """The mistakes that are listed so."""
    plan = next(plan for some in project.plans.values() for plan in (some or {}).values() if plan.name == b.plan)
    k = plan.labels.index(b.position) if b.position in plan.labels else 0
    said = b.beside["kind"], b.beside["mistake"], b.step
    return [h for h in hypotheses(plan, k, plan.labels) if (h.kind, h.words, h.step.path) == said]


if __name__ == "__main__":
    main()
