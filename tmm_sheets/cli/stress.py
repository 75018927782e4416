"""``stress``: hard random mechanisms."""

from __future__ import annotations

import click

from tmm_sheets.errors import CannotBuild
from tmm_sheets.localized_cli import command, option
from tmm_sheets.words import tell


@command("stress")
@option("--cases", type=click.IntRange(1), default=900, show_default=True, metavar="N", help="How many random mechanisms.")
@option("--seed", type=click.IntRange(0), default=0, show_default=True, metavar="S", help="Seed of the random numbers.")
@option("--case", "single", type=click.IntRange(0), metavar="N", help="Only this case of the seed, again.")
def run(cases: int, seed: int, single: int | None) -> None:
    """Try hard random mechanisms: the worst of every invariant against its bound."""
    from tmm_sheets.lab.stress import report
    from tmm_sheets.progress import Progress

    if single is not None:
        worst = report.run_one(seed, single)
    else:
        with Progress() as progress:
            worst = report.run(
                cases, seed, lambda case: progress.say(tell("case {case} of {cases} ...").format(case=case, cases=cases))
            )
    click.echo(report.table(worst, seed))
    failed = report.exceeded(worst)
    if failed:
        raise CannotBuild(
            tell("bound exceeded: {invariants}").format(invariants=", ".join(failed)), tell("the table names a case that shows it")
        )
