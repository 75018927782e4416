"""Simulated photographs of sheets with a layout of their own: what ``compare --image --views`` finds and what it makes up.

Usage: python -m tests.compare.views_trial [--projects NAME:SHEET ...] [--seeds N] [--errors 4] [--leave-out K] [--keep FOLDER]

Views change places on the sheet and take the size that fits there; symbols, heads and lettering keep theirs. ``--leave-out`` drops
the first K of the moved views from the file of views.
"""

import argparse
import tempfile
from collections import Counter
from dataclasses import replace
from pathlib import Path
from time import perf_counter

import numpy as np

from tests.compare.form import of_elements
from tests.compare.simulation import shoot
from tmm_sheets import catalogue
from tmm_sheets.compare.elements import elements
from tmm_sheets.compare.photo import image
from tmm_sheets.compare.placing import links
from tmm_sheets.drawing.marks import Arc, Fill, Line, Polyline, Text
from tmm_sheets.errors import CannotBuild
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed

PROJECTS = ("press:1", "lugansk/shaper:2", "lugansk/engine:1", "sixbar/3:1:1", "lugansk/cam_rocker:1",
            "transport/compressor@09-В-5:1")
SYMBOL = 12.0  # mm: what is no larger and is no line keeps its size
HINGE = 2.6  # mm, radius of a circle that does
CLICK = 0.4  # mm by which a clicked point is missed


def movable(known):
    """Views that are drawn to a scale: lines rather than words."""
    views = dict.fromkeys(e.view for e in known if e.view.n)
    mine = {v: [e for e in known if e.view == v] for v in views}
    return [v for v, es in mine.items() if sum(e.kind != "text" for e in es) > max(8, sum(e.kind == "text" for e in es))]


def new_places(views, rng):
    """(scale, shift) of each view: into the place of another one, as large as it fits there, or smaller in its own."""
    ratio = {(v, w): min((w.box.x1 - w.box.x0) / (v.box.x1 - v.box.x0), (w.box.y1 - w.box.y0) / (v.box.y1 - v.box.y0))
             for v in views for w in views}  # fmt: skip
    rng.shuffle(views)
    target = {}
    for v in views:
        fits = [w for w in views if w != v and v not in target and w not in target and min(ratio[v, w], ratio[w, v]) > 0.55]
        if fits:
            w = fits[int(rng.integers(len(fits)))]
            target |= {v: w, w: v}
    found = {}
    for v in views:
        w = target.get(v, v)
        size = min(0.95 * ratio[v, w], 1.5) if w != v else rng.uniform(0.7, 0.95)
        found[v] = (size, w.box.centre - size * v.box.centre)
    return found


def moved(mark, element, size, shift):
    """A mark drawn elsewhere and in another size; what is a symbol keeps its own."""
    def by(z):
        return size * z + shift

    z = element.points
    small = element.radius <= HINGE if element.kind == "circle" else np.hypot(np.ptp(z.real), np.ptp(z.imag)) < SYMBOL
    small &= element.kind != "line"
    if small or element.kind == "text" or (element.kind in ("hatch", "fill")):
        middle = complex((z.real.min() + z.real.max()) / 2, (z.imag.min() + z.imag.max()) / 2)
        size, shift = 1.0, by(middle) - middle
    if isinstance(mark, Fill) and len(element.marks) > 1 and element.kind in ("line", "arc"):
        tip = complex(mark.points[0])  # a head keeps its size and goes with its tip
        return mark._replace(points=np.asarray(mark.points) + by(tip) - tip)
    if isinstance(mark, Line):
        return mark._replace(a=size * mark.a + shift, b=size * mark.b + shift)
    if isinstance(mark, Arc):
        return mark._replace(centre=size * mark.centre + shift, radius=size * mark.radius)
    if isinstance(mark, Text):
        return mark._replace(at=mark.at + shift if size == 1 else size * mark.at + shift)
    assert isinstance(mark, Polyline | Fill)
    return mark._replace(points=size * np.asarray(mark.points) + shift)


def two_points(view, known):
    """The ends of lines of a view that are farthest apart."""
    z = np.concatenate([e.points[[0, -1]] for e in known if e.view == view and e.kind == "line" and e.length > 8])
    i, j = np.unravel_index(np.abs(z[:, None] - z[None, :]).argmax(), (len(z), len(z)))
    return complex(z[i]), complex(z[j])


def rearranged(sheet, known, places):
    """The marks of a sheet in another layout, without the lines between views, which nobody draws there, and the same in ours."""
    of_mark = {id(m): e for e in known for m in e.marks}
    leading = links(known)
    exact = [m for m in sheet.drawing.marks if not (of_mark[id(m)].view in places and of_mark[id(m)].number in leading)]
    marks = tuple(moved(m, of_mark[id(m)], *places[of_mark[id(m)].view]) if of_mark[id(m)].view in places else m for m in exact)
    return marks, [of_mark[id(m)] for m in exact]


def file_of_views(views, known, places, place, rng):
    """A file for --views with two clicked points of each view; ``place`` takes the sheet to the picture."""
    text = ""
    for v in views:
        size, shift = places[v]
        ours = two_points(v, known)
        theirs = [place(np.array([size * z + shift + CLICK * complex(*rng.normal(0, 1, 2))]))[0] for z in ours]
        text += (f'[[view]]\nname = "{v.name}"\nours = {[[z.real, z.imag] for z in ours]}\n'
                 f"theirs = {[[float(z.real), float(z.imag)] for z in theirs]}\n")
    return text


def meets(extra, planted):
    """Whether extra ink of a report is where an error was drawn."""
    return planted.drawn is not None and any(
        abs(extra["at_mm"][0] - z.real) < extra["width_mm"] / 2 + 4 and abs(extra["at_mm"][1] - z.imag) < extra["height_mm"] / 2 + 4
        for z in np.atleast_1d(planted.drawn))


def outcomes(label, tree, planted, element_of, known):
    """What became of the planted errors, and what was made up; told line by line."""
    bad = {e["number"]: e for e in of_elements(tree) if e["verdict"] in ("amber", "red")}
    dense = {e["number"] for e in of_elements(tree) if e["status"] == "dense"}
    spoiled = set()
    counted = Counter()
    for p in planted:
        if p.mark is None:
            hit = any(meets(x, p) for x in tree["unclaimed"])
            counted["found" if hit else "missed"] += 1
            if not hit:
                print(f"  missed: {label} extra line {p.size:.0f} mm about {p.drawn.mean():.0f}")
            continue
        e = element_of[p.mark]
        spoiled.add(e.number)
        outcome = "found" if e.number in bad else "not measurable" if e.number in dense else "missed"
        counted[outcome] += 1
        if outcome == "missed":
            print(f"  missed: {label} {p.kind} {p.size:.1f} element {e.number} {e.kind} {e.style} of view {e.view.name!r}")
    for number in bad.keys() - spoiled:
        e = known[number - 1]
        counted[f"false {bad[number]['verdict']}"] += 1
        print(f"  false: {label} {bad[number]['verdict']} element {number} {e.kind} {e.style} {e.length:.0f} mm of "
              f"{e.view.name!r}: {bad[number]['said']}")
    for x in tree["unclaimed"]:
        if not any(meets(x, p) for p in planted):
            counted["false extra"] += 1
            print(f"  false extra: {label} {x}")
    return counted


def trial(key, n, seed, errors, leave_out, keep, told):
    project = Project(catalogue.read(key))
    sheet = composed(project, n)
    known = elements(sheet)
    rng = np.random.default_rng([seed, n])
    views = movable(known)
    places = new_places(views, rng)
    marks, element_of = rearranged(sheet, known, places)
    shot = shoot(replace(sheet.drawing, marks=marks), seed, errors)
    (keep / "photo.jpg").write_bytes(shot.data)
    (keep / "views.toml").write_text(file_of_views(views[leave_out:], known, places, shot.place, rng), encoding="utf-8")
    start = perf_counter()
    try:
        report = image.compare(project, n, keep / "photo.jpg", keep / "views.toml")
    except CannotBuild as e:
        print(f"{key} {n} seed {seed}: refused: {e}")
        told["refused"] += 1
        return
    seconds = perf_counter() - start
    for name, data in report.files.items():
        (keep / name).write_bytes(data)
    (keep / "report.txt").write_text("\n".join((*report.notes, report.text)), encoding="utf-8")
    judged = sum(report.tree["count"][c] for c in ("green", "amber", "red"))
    counted = outcomes(f"{key} {n}", report.tree, shot.planted, element_of, known)
    print(f"{key} {n} seed {seed}: {len(views)} views moved, {judged} judged, tolerance {report.tree['tolerance']}, "
          f"{dict(counted)}, {seconds:.1f} s; {[note for note in report.notes if 'fitted' not in note]}", flush=True)
    told.update(counted)
    told["judged"] += judged


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--projects", nargs="+", default=PROJECTS)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--errors", type=int, default=4)
    parser.add_argument("--leave-out", type=int, default=0)
    parser.add_argument("--keep", type=Path)
    options = parser.parse_args()
    told = Counter()
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(options.first, options.first + options.seeds):
            for name in options.projects:
                key, _, n = name.rpartition(":")
                keep = (options.keep or Path(folder)) / f"{key.replace('/', '-').replace(':', '-')}-{n}-{seed}"
                keep.mkdir(parents=True, exist_ok=True)
                trial(key, int(n), seed, options.errors, options.leave_out, keep, told)
    print(dict(told))


if __name__ == "__main__":
    main()
