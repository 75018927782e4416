"""``list``: the shipped projects."""

from __future__ import annotations

import click

from tmm_sheets import quoting, words
from tmm_sheets.errors import CannotBuild
from tmm_sheets.localized_cli import argument, command, option
from tmm_sheets.words import tell


@command("list")
@argument("word", required=False)
@option("--json", "as_json", is_flag=True, help="As JSON.")
def run(word: str | None, as_json: bool) -> None:
    """List the shipped projects; with a WORD those that have it in their names or titles."""
    from tmm_sheets import catalogue

    entries = catalogue.found(word) if word else catalogue.entries()
    if not entries:
        raise CannotBuild(tell('no shipped project has "{word}" in its name or title').format(word=word),
                          tell("{command} shows the shipped projects").format(command=quoting.command("list")))
    if as_json:
        import json
        from dataclasses import asdict

        click.echo(json.dumps([asdict(e) for e in entries], ensure_ascii=False, indent=1))
        return
    width = max((len(e.name) for e in entries), default=0)
    for e in entries:
        called = ", ".join(words.of_file(text, tell) for text in (e.title, e.variant) if text)
        click.echo(
            tell("{project}  {title}; sheets: {sheets}").format(
                project=f"{e.name:{width}}", title=called, sheets=", ".join(e.sheets)
            )
        )
