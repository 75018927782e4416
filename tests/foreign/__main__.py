"""The foreign trial: takes pictures, runs `compare` on each and prints a table by difficulty.

    python -m tests.foreign --pictures 400 --seed 1 --jobs 2 [-o DIR] [--only wood,folds] [--keep] [--first I --count N] [--most 12]

With -o outcomes are kept in DIR/outcomes.jsonl, line by line: a trial that was broken off goes on where it stopped.
`--take` only takes the pictures, `--judge FILE ...` only judges some that were kept.
"""

from __future__ import annotations

import argparse
import json
import statistics
from collections import Counter
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from contextlib import nullcontext
from dataclasses import asdict
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tests.foreign import drawing, judge, scene

Row = dict[str, Any]
WORDS = (*judge.FOUND, "green", "silent", "unjudged", "same")


def _one(number: int, seed: int, only: tuple[str, ...], folder: Path, keep: bool, take: bool, most: float) -> Row | None:
    """Take a picture and judge it."""
    what = scene.scene(number, seed, only)
    drawings = folder / "drawings"
    file = folder / "pictures" / f"{number:03d}_{what.difficulty}.jpg"
    if not (file.exists() and file.with_suffix(".json").exists()):
        file = scene.save(*scene.take(what, drawings, most), folder / "pictures")
    if take:
        return None
    outcome = asdict(judge.judge(file, drawings, folder / "reports" if keep else None))
    if not keep:
        file.unlink()
        file.with_suffix(".json").unlink()
    return outcome


def _cell(values: Iterable[float | None], form: str, how: Any) -> str:
    there = [value for value in values if value is not None]
    return format(how(there), form) if there else "-"


def _seen(row: Row) -> list[Row]:
    """Mistakes that should be found: large enough, and they show; digits are not read and stand only in the table of kinds."""
    return [
        mistake
        for mistake in row["mistakes"]
        if mistake["size"] >= judge.VISIBLE and mistake["kind"] != "digits swapped" and mistake["said"] != "same"
    ]


def _line(name: str, rows: list[Row]) -> str:
    """A line of the table."""
    states = Counter(row["state"] for row in rows)
    judged = [row for row in rows if row["state"] == "judged"]
    sound, accused = sum(row["sound"] for row in judged), sum(row["false_red"] for row in judged)
    visible = [mistake for row in judged for mistake in _seen(row)]
    missed, open_ = (sum(mistake["said"] in words for mistake in visible) for words in (("green", "silent"), ("unjudged",)))
    share = f"{100 * accused / sound:.2f}" if sound else "-"
    median = _cell((row["median"] for row in judged), ".3f", statistics.median)
    most, worst = (_cell((row[key] for row in judged), ".2f", max) for key in ("most", "worst"))
    seconds = _cell((row["seconds"] for row in rows), ".1f", statistics.median)
    return (
        f"{name:<12}{len(rows):>5}{states['refused']:>9}{states['wrong fit']:>7}{states['broken']:>8}{median:>9}{most:>8}{worst:>8}"
        f"{share:>9}{missed:>6} of {len(visible):<4}{open_:>5}{seconds:>7}"
    )


def table(rows: list[Row]) -> str:
    """All of it: by difficulty, by kind of mistake, what was refused why, what was fitted wrongly."""
    head = (
        ("n", 5),
        ("refused", 9),
        ("wrong", 7),
        ("broken", 8),
        ("median", 9),
        ("95 %", 8),
        ("worst", 8),
        ("red, %", 9),
        ("missed", 9),
        ("open", 9),
        ("s", 7),
    )
    lines = [" " * 12 + "".join(f"{word:>{width}}" for word, width in head)]
    present = sorted({row["difficulty"] for row in rows}, key=scene.DIFFICULTIES.index)
    lines += [_line(name, [row for row in rows if row["difficulty"] == name]) for name in present]
    lines += [_line("all", rows), "", f"{'mistakes of fitted pictures':<28}" + "".join(f"{word:>11}" for word in WORDS)]
    said = Counter((mistake["kind"], mistake["said"]) for row in rows if row["state"] == "judged" for mistake in row["mistakes"])
    for kind in sorted({kind for kind, _ in said}):
        lines.append(f"  {kind:<26}" + "".join(f"{said[kind, word]:>11}" for word in WORDS))
    for state in ("wrong fit", "broken", "refused"):
        lines += ["", state] if any(row["state"] == state for row in rows) else []
        lines += [
            f"  {row['name']} ({row['project']} {row['sheet']}), matched {row['matched']}, red {row['false_red']}: {row['reason']}"
            for row in rows
            if row["state"] == state
        ]
    return "\n".join(lines)


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.foreign", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--pictures", type=int, default=400)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("-o", "--output", type=Path)
    parser.add_argument("--only", default="", help="difficulties, separated by commas: " + ", ".join(scene.DIFFICULTIES))
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int)
    parser.add_argument("--most", type=float, default=12.0, help="megapixels at most")
    parser.add_argument("--keep", action="store_true", help="keep pictures and reports")
    parser.add_argument("--take", action="store_true", help="only take the pictures")
    parser.add_argument("--judge", type=Path, nargs="+", help="only judge these pictures")
    asked = parser.parse_args()
    only = tuple(part for part in asked.only.split(",") if part)
    if unknown := set(only) - set(scene.DIFFICULTIES):
        parser.error(f"no such difficulty: {', '.join(sorted(unknown))}; there are {', '.join(scene.DIFFICULTIES)}")
    with TemporaryDirectory() if asked.output is None else nullcontext(asked.output) as folder:
        trial(asked, only, Path(folder))


def trial(asked: argparse.Namespace, only: tuple[str, ...], folder: Path) -> None:
    """Take pictures, judge them, or both."""
    folder.mkdir(parents=True, exist_ok=True)
    if asked.judge:
        print(
            table(
                [
                    asdict(judge.judge(file, folder / "drawings", folder / "reports" if asked.keep else None))
                    for file in asked.judge
                ]
            )
        )
        return
    numbers = range(asked.first, min(asked.pictures, asked.first + asked.count) if asked.count is not None else asked.pictures)
    log = folder / "outcomes.jsonl"
    rows = [json.loads(line) for line in log.read_text(encoding="utf-8").splitlines()] if log.exists() else []
    done = {row["name"] for row in rows}
    left = [number for number in numbers if f"{number:03d}_{scene.scene(number, asked.seed, only).difficulty}" not in done]
    for project, sheet in {scene.scene(number, asked.seed, only).sheet for number in left}:
        drawing.read(project, sheet, folder / "drawings")  # before processes want them at once
    work = partial(
        _one, seed=asked.seed, only=only, folder=folder, keep=asked.keep or asked.take, take=asked.take, most=asked.most
    )
    with ProcessPoolExecutor(asked.jobs) as pool, log.open("a", encoding="utf-8") as out:
        for row in pool.map(work, left):
            if row is not None:
                rows.append(row)
                out.write(json.dumps(row, ensure_ascii=False) + "\n")
                out.flush()
    if rows:
        print(table(sorted(rows, key=lambda row: row["name"])))


if __name__ == "__main__":
    main()
