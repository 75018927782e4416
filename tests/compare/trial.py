"""Many simulated photographs with planted errors: what the comparison finds, what it makes up, how well it rectifies, what it
costs.

Usage: python -m tests.compare.trial [-n 200] [--first 0] [--errors 4] [--minutes M] [--time] [--show] [--photographs FOLDER]

With --photographs the simulated photographs are kept in a folder, or taken from there: half of the time goes into them.
"""

import argparse
import pickle
import resource
import sys
import tempfile
from collections import Counter, defaultdict
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter, process_time
from typing import Any

import numpy as np

from tests.compare.simulation import Planted, resample, shoot
from tmm_sheets import catalogue
from tmm_sheets.compare.elements import elements
from tmm_sheets.compare.photo import image, tracing
from tmm_sheets.compare.photo.judging import LOOSE_STYLES, judge
from tmm_sheets.compare.photo.photograph import read
from tmm_sheets.compare.photo.rectification import rectify
from tmm_sheets.errors import CannotBuild
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed

GRID = (np.linspace(20, 836, 41)[None, :] + 1j * np.linspace(5, 589, 31)[:, None]).ravel()
BINS = ((1, 1.5), (1.5, 2), (2, 3), (3, 5))


@dataclass
class Photograph:
    """What is known of a simulated photograph: the file's bytes, where GRID is in it, its pixels per mm there, what was planted."""

    data: bytes
    places: Any
    scale: Any
    planted: list[Planted]


def photograph(seed, sheet, errors, folder=None):
    """The photograph of a seed, from ``folder`` if it is there, else taken and kept there."""
    kept = folder / f"{seed}-{errors}.pickle" if folder else None
    if kept and kept.exists():
        return pickle.loads(kept.read_bytes())
    shot = shoot(sheet.drawing, seed, errors)
    scale = np.abs(shot.place(GRID + 0.5) - shot.place(GRID - 0.5))
    out = Photograph(shot.data, shot.place(GRID), scale, shot.planted)
    if kept:
        folder.mkdir(parents=True, exist_ok=True)
        kept.write_bytes(pickle.dumps(out))
    return out


def position_errors(m, shot):
    """Distance between where places of the sheet are in the picture and are thought to be, in mm of the sheet."""
    return np.abs(m.to_picture(GRID) - shot.places) / shot.scale


def judged(found, known, pencil=0.25):
    traces, extra = tracing.trace(known, found.ink)
    return [judge(t, pencil, found.uncertainty, found.soft) for t in traces], extra


def near(z, extra, room=4.0):
    """Share of the points z within the boxes of extra ink: lines that cross it cut a line into several."""
    inside = [(np.abs(z.real - x.middle.real) < x.width / 2 + room) & (np.abs(z.imag - x.middle.imag) < x.height / 2 + room)
              for x in extra]  # fmt: skip
    return float(np.any(inside, axis=0).mean()) if inside else 0.0


def unseen(f, p):
    """Whether the comparison says of itself that it cannot see the planted error: too near to others, or the end hidden by them."""
    t = f.trace
    if p.kind == "size" and t.status == "measured" and t.element.kind == "line" and f.verdict == "green":
        return bool(np.isnan(t.ends[int(np.abs(t.element.points - p.ought[-1]).argmin())]))
    return t.status == "small" or f.unknown


class Tally:
    def __init__(self):
        self.found = defaultdict(Counter)  # (kind, size class) -> outcome
        self.elements = Counter()
        self.false = Counter()
        self.errors = []
        self.refused = []
        self.sheets = 0
        self.examples = []

    def add(self, label, sheet, shot, found, findings, extra):
        """Count what became of the planted errors, and what was made up."""
        self.errors.append(position_errors(found.map, shot))
        of_mark = {id(m): f for f in findings for m in f.trace.element.marks}
        touched = set()
        for p in shot.planted:
            if p.kind == "extra":
                hit = near(resample(p.drawn), extra) > 0.5
                self.found["extra", "15-60 mm"]["red" if hit else "missed"] += 1
            else:
                f = of_mark[id(sheet.drawing.marks[p.mark])]
                touched.add(id(f))
                self.add_planted(label, p, f)
        for f in findings:
            if id(f) not in touched and f.trace.status not in ("small", "lettering"):
                self.add_untouched(label, f)
        for x in extra:
            if not any(p.drawn is not None and near(resample(p.drawn), [x]) > 0 for p in shot.planted):
                self.false["extra ink"] += 1
                self.examples.append(f"false {label}: extra {x.width:.0f} x {x.height:.0f} at {x.middle:.0f}")

    def add_planted(self, label, p, f):
        """An error in an element, and what was found of it."""
        e = f.trace.element
        size = "" if p.kind == "missing" else next((f"{a}-{b} mm" for a, b in BINS if p.size <= b), "")
        kind = p.kind
        if p.kind == "size" and e.kind == "line":
            kind = "size, thin line" if e.style in LOOSE_STYLES else "size, line"
        outcome = "dense" if unseen(f, p) else f.verdict if f.verdict != "green" else "missed"
        self.found[kind, size][outcome] += 1
        if outcome == "missed" and "thin" not in kind:
            self.examples.append(f"missed {label}: {p.kind} {p.size:.1f} element {e.number} {f.what} {f.deviation:.2f}")

    def add_untouched(self, label, f):
        """An element without a planted error."""
        e = f.trace.element
        self.elements["dense" if f.unknown else "judged"] += 1
        if f.verdict != "green":
            self.false[f.verdict] += 1
            self.examples.append(f"false {label}: {f.verdict} element {e.number} {e.kind} {e.style} {f.what}")

    def merge(self, other):
        for key, c in other.found.items():
            self.found[key] += c
        for name in ("elements", "false", "errors", "refused", "examples", "sheets"):
            setattr(self, name, getattr(self, name) + getattr(other, name))

    def report(self):
        print(f"{self.sheets} sheets, {len(self.refused)} refused {self.refused}")
        if not self.errors:
            return
        e = np.concatenate(self.errors)
        worst = np.array([x.max() for x in self.errors])
        print(f"position error, mm: median {np.median(e):.2f}, 95 % {np.percentile(e, 95):.2f}, worst {e.max():.2f}; "
              f"worst place of a sheet: median {np.median(worst):.2f}, above 0.8 on {int((worst > 0.8).sum())} sheets")
        print("planted errors        size        n   red  amber  missed  not measurable")
        total = Counter()
        for (kind, size), c in sorted(self.found.items()):
            print(f"{kind:20} {size:9} {sum(c.values()):4} {c['red']:5} {c['amber']:6} {c['missed']:7} {c['dense']:8}")
            total += c
        print(f"{'all':30} {sum(total.values()):4} {total['red']:5} {total['amber']:6} {total['missed']:7} {total['dense']:8}")
        n = self.elements["judged"]
        print(f"elements without error: {n} judged, {self.elements['dense']} not measurable; false: {self.false['red']} red "
              f"({100 * self.false['red'] / n:.2f} %), {self.false['amber']} amber ({100 * self.false['amber'] / n:.2f} %), "
              f"{self.false['extra ink']} places of extra ink; {self.false['red'] / len(self.errors):.2f} red a sheet")


def timing():
    """Seconds and memory of one 12 Mpx photograph, everything from the file to the overlay."""
    project = Project(catalogue.read("press"))
    shot = shoot(composed(project, 1).drawing, 1, 4, megapixels=12.0)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "photo.jpg"
        path.write_bytes(shot.data)
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        start, work = perf_counter(), process_time()
        image.compare(project, 1, path)
        after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        print(f"one 12 Mpx photograph: {perf_counter() - start:.1f} s, {process_time() - work:.1f} s of the processor; peak memory "
              f"{before / 1e6:.2f} GB before (the simulation), {after / 1e6:.2f} GB after")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-n", type=int, default=200)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--errors", type=int, default=4)
    parser.add_argument("--minutes", type=float, default=600.0, help="stop after so long")
    parser.add_argument("--time", action="store_true")
    parser.add_argument("--show", action="store_true", help="tell every miss and false alarm")
    parser.add_argument("--save", type=Path, help="keep what was counted, to be merged")
    parser.add_argument("--photographs", type=Path, help="folder of simulated photographs")
    parser.add_argument("--merge", type=Path, nargs="+", help="report what several runs have kept")
    options = parser.parse_args()
    if options.merge:
        tally = Tally()
        for path in options.merge:
            tally.merge(pickle.loads(path.read_bytes()))
        tally.report()
        if options.show:
            print("\n".join(tally.examples))
        return
    if options.time:
        timing()
        return
    names = catalogue.shipped()
    tally = Tally()
    start = perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "photo.jpg"
        for seed in range(options.first, options.first + options.n):
            rng = np.random.default_rng([seed, 1])
            project = Project(catalogue.read(names[seed % len(names)]))
            n = int(rng.integers(len(project.variant.sheets))) + 1
            sheet = composed(project, n)
            shot = photograph(seed, sheet, options.errors, options.photographs)
            path.write_bytes(shot.data)
            print(f"{seed} at {perf_counter() - start:.0f} s", file=sys.stderr)
            label = f"{project.variant.project.name} {n} seed {seed}"
            known = elements(sheet)
            tally.sheets += 1
            try:
                found = rectify(read(path), known, path)
                if not found.check.acceptable:
                    raise CannotBuild(f"fit {found.check}")
            except CannotBuild as e:
                tally.refused.append(f"{label}: {e.args[0]}")
                continue
            tally.add(label, sheet, shot, found, *judged(found, known))
            if options.save:
                options.save.write_bytes(pickle.dumps(tally))
            if perf_counter() - start > 60 * options.minutes:
                break
    tally.report()
    if options.show:
        print("\n".join(tally.examples))


if __name__ == "__main__":
    main()
