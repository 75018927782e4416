"""``roster``: the work of a whole group, for each student."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from tmm_sheets import kept, words
from tmm_sheets.cli import opening
from tmm_sheets.cli.batches import come_of, say_stopped
from tmm_sheets.cli.options import CORRECTED, DASK, JOBS, NO_CACHE, REMAKE, formats_of, titled
from tmm_sheets.errors import CannotBuild
from tmm_sheets.localized_cli import argument, command, option


@command("roster")
@argument("table", metavar="FILE", type=click.Path(path_type=Path))
@option("--task", default="", metavar="PROJECT", help="Task of those for whom the table names none, or a machine for its ciphers.")
@CORRECTED
@titled
@formats_of("dxf,pdf")
@option("-o", "--output", type=click.Path(path_type=Path), default=Path("out"), show_default=True, metavar="DIR",
        help="Folder with one for each student.")
@REMAKE
@JOBS
@DASK
@NO_CACHE
def run(table: Path, task: str, corrected: bool, formats: tuple[str, ...], output: Path, force: bool, jobs: int | None,
        scheduler: str | None) -> None:
    """Make the work of a whole group: for each student of a CSV FILE sheets, note, living page, a table to fill in."""
    from tmm_sheets import files
    from tmm_sheets.output import batch, build_store
    from tmm_sheets.output import roster as rosters
    from tmm_sheets.output.building import Order
    from tmm_sheets.output.object_store import place

    students = rosters.read(table, task)
    output = place(output)
    build_store.check(output)
    settings: dict[str, dict[str, Any]] = {"pdf": {"date": files.source_date()}}
    order = Order((), formats, settings, corrected, force, False, False, words.asked(), words.reader(), kept.used(),
                  opening.names())
    works = [batch.Task(s.project, s.folder, s.student, s.group) for s in students]
    came, stopped = come_of(batch.on(works, order, output, jobs, scheduler), len(works))
    done = {outcome.folder: outcome for outcome in came}
    written, hand = opening.put(output, rosters.lists(students, done, output), force)
    for s in students:
        if s.renamed:
            click.echo(s.renamed, err=True)
        for warning in done[s.folder].warnings if s.folder in done else ():
            click.echo(f"{s.student}: {warning}", err=True)
    for line in hand:
        click.echo(line, err=True)
    click.echo(rosters.told(students, done))
    for path in written:
        click.echo(path)
    if stopped is not None:
        say_stopped(len(students) - len(done), len(students))
        raise stopped
    failed = [s for s in students if done[s.folder].problem]
    if failed:
        raise CannotBuild("\n".join(f"{s.student}: {done[s.folder].problem}" for s in failed))
