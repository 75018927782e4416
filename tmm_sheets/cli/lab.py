"""``bench``, ``stress``: error and time of the methods, hard random mechanisms."""

from __future__ import annotations

from pathlib import Path

import click

from tmm_sheets import files
from tmm_sheets.errors import CannotBuild
from tmm_sheets.localized_cli import command, option
from tmm_sheets.progress import Progress
from tmm_sheets.words import tell


@command("bench")
@option("--json", "target", metavar="FILE", help="Also write the table as JSON, to standard output for -.")
@option("--plot", "folder", type=click.Path(path_type=Path), metavar="DIR", help="Also draw log-log diagrams, SVG.")
@option("--quick", is_flag=True, help="A few small runs only: tries the benchmark out.")
@option("--summary", is_flag=True, help="The first and the last run of each method only, in Markdown.")
def run_bench(target: str | None, folder: Path | None, quick: bool, summary: bool) -> None:
    """Measure every method: error against a truth of 30 digits or more, and time."""
    from tmm_sheets.lab.bench import records

    if folder is not None:
        files.check_folder(folder)
    with Progress() as progress:
        found = records.run(quick, progress.doing)
    text = (records.summary if summary else records.table)(found)
    click.echo(text, err=target == "-")
    made: dict[Path, bytes] = {}
    if target == "-":
        click.echo(records.as_json(found))
    elif target is not None:
        made[Path(target)] = (records.as_json(found) + "\n").encode()
    if folder is not None:
        made |= {folder / name: data for name, data in records.diagrams(found).items()}
    files.write_all(made)


@command("stress")
@option("--cases", type=click.IntRange(1), default=900, show_default=True, metavar="N", help="How many random mechanisms.")
@option("--seed", type=click.IntRange(0), default=0, show_default=True, metavar="S", help="Seed of the random numbers.")
@option("--case", "single", type=click.IntRange(0), metavar="N", help="Only this case of the seed, again.")
def run_stress(cases: int, seed: int, single: int | None) -> None:
    """Try hard random mechanisms: the worst of every invariant against its bound."""
    from tmm_sheets.lab.stress import cases as stressed

    if single is not None:
        worst = stressed.run(1, seed, first=single, million=False)
    else:
        with Progress() as progress:
            worst = stressed.run(
                cases, seed, lambda case: progress.say(tell("case {case} of {cases} ...").format(case=case, cases=cases))
            )
    click.echo(stressed.table(worst, seed))
    failed = stressed.exceeded(worst)
    if failed:
        raise CannotBuild(
            tell("bound exceeded: {invariants}").format(invariants=", ".join(failed)), tell("the table names a case that shows it")
        )
