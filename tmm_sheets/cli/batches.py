"""What is said while several projects are made, and when that is stopped."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import click

from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.output.batch import Outcome


def come_of(running: Iterable[Outcome], total: int) -> tuple[list[Outcome], KeyboardInterrupt | None]:
    """Outcomes of a batch as they come, with a bar; and what told it to end before."""
    from tmm_sheets.progress import Bar

    done: list[Outcome] = []
    try:
        with Bar(total) as bar:
            for outcome in running:
                done.append(outcome)
                bar.step(bool(outcome.problem))
    except KeyboardInterrupt as e:
        return done, e
    return done, None


def say_stopped(left: int, total: int) -> None:
    """Tell how many of a batch are left after Ctrl-C."""
    said = tell("stopped, {n} of {total} projects left; the same command goes on from there")
    click.echo(said.format(n=left, total=total), err=True)
