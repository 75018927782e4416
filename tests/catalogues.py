"""The catalogues of words: collected from the program, brought up to date, compiled; ``make messages``.

``python -m tests.catalogues --add FILE.json`` puts translations in: {"English text": {"ru": "...", "uk": "..."}}, where the forms
of a plural are a list, in the order of the catalogue's header, and a text with a context is "context|text"; one of click is
"click|text".
"""

import json
import re
import sys
import tomllib
from collections.abc import Iterator
from datetime import UTC, datetime
from functools import cache
from inspect import cleandoc
from io import BytesIO
from pathlib import Path

import click
from babel.messages.catalog import Catalog
from babel.messages.extract import extract_from_file
from babel.messages.mofile import write_mo
from babel.messages.pofile import read_po, write_po

from tmm_sheets.task import keys
from tmm_sheets.words import DOMAIN, LANGUAGES, name_of

ROOT = Path(__file__).parents[1]
LOCALE = ROOT / "templates" / "locale"
KEYWORDS = {"tr": None, "tell": None, "marked": None, "tr_in": ((1, "c"), 2), "of_language": ((1, "c"), 2), "tr_n": (1, 2),
            "tell_n": (1, 2), "marked_n": (1, 2)}
CYRILLIC = re.compile("[\u0400-\u04ff]")
NEVER = datetime(2026, 1, 1, tzinfo=UTC)
"""Date in the headers: a catalogue depends on its texts only."""
CLICK = "messages"
"""Domain of click's own words: gettext's default one, which click asks. English needs none."""
READ = {
    "project": ("title", "variant"), "title_block": ("institution", "group"), "link": ("title",),
    "misprint": ("reason",), "remark": ("say",),
}  # fmt: skip
"""Keys of shipped files that a person reads, by table."""


@cache
def of_program() -> tuple[tuple[str, str | tuple[str, ...], str | None], ...]:
    """Texts of the source: file, text (or the forms of a plural), context."""
    return tuple((path.relative_to(ROOT).as_posix(), text, context) for path in sorted((ROOT / "tmm_sheets").rglob("*.py"))
                 for _, text, _, context in extract_from_file("python", path, KEYWORDS))


def of_keys() -> Iterator[tuple[str, str, None]]:
    """What the keys of a project file mean, and what its own types take."""
    for text in keys.texts():
        yield "tmm_sheets/task/schema.py", text, None


def of_commands() -> Iterator[tuple[str, str, None]]:
    """Help of the commands and their options."""
    from tmm_sheets.cli import commands

    for command in (commands, *commands.every().values()):
        for spoken in (command, *(p for p in command.params if isinstance(p, click.Option))):
            if spoken.help:
                yield f"tmm_sheets/cli/{command.name}.py", cleandoc(spoken.help), None


def of_projects() -> Iterator[tuple[str, str, None]]:
    """What shipped projects say on their sheets and of themselves, in the language of their files; not what schemes fill in."""
    for path in sorted((ROOT / "variants").rglob("*.toml")):
        text = re.sub(r"(?m)^\$\w+\s*$", "", path.read_text("utf-8"))  # rows that are filled in whole, and numbers
        tree = tomllib.loads(re.sub(r'"[^"\n]*"|\$\w+', lambda found: "0" if found[0][0] == "$" else found[0], text))
        for part in (tree, *tree.get("machine", {}).values()):
            if part is not tree:
                yield path.relative_to(ROOT).as_posix(), part["title"], None
            for table, read in READ.items():
                found = part.get(table, {})
                for row in found if isinstance(found, list) else [found]:
                    for said in (row.get(key) for key in read):
                        if isinstance(said, str) and said and "$" not in said:
                            yield path.relative_to(ROOT).as_posix(), said, None


def of_templates() -> Iterator[tuple[str, str, None]]:
    """Titles and codes of arrangements, descriptions of layers and of line types."""
    templates = ROOT / "templates"
    for path in sorted((templates / "sheets").glob("*.toml")):
        tree = tomllib.loads(path.read_text("utf-8"))
        yield from ((path.relative_to(ROOT).as_posix(), tree[key], None) for key in ("title", "code") if key in tree)
    for name in ("layers", "linetypes"):
        for row in tomllib.loads((templates / f"{name}.toml").read_text("utf-8")).values():
            yield f"templates/{name}.toml", row["description"], None


def of_title_blocks() -> Iterator[tuple[str, str, str]]:
    """Words printed in title blocks, and those that :mod:`~tmm_sheets.drawing.title_block` puts there itself."""
    path = ROOT / "templates" / "title_blocks.json"
    for form, block in json.loads(path.read_text("utf-8")).items():
        for cell in block["cells"] if form != "about" else ():
            if cell[2]:
                yield path.relative_to(ROOT).as_posix(), cell[2], "title block"
    yield "tmm_sheets/drawing/paper.py", "Head", "title block"


def of_languages() -> Iterator[tuple[str, str, None]]:
    """English names of the languages."""
    for language in LANGUAGES:
        yield "templates/locale", name_of(language), None


def collected() -> Catalog:
    """Every text there is, without translations."""
    found = Catalog(domain=DOMAIN, project="tmm-sheets", version="", charset="utf-8", creation_date=NEVER, revision_date=NEVER)
    every = (*of_program(), *of_commands(), *of_keys(), *of_title_blocks(), *of_projects(), *of_templates(), *of_languages())
    for file, text, context in every:
        found.add(text, locations=[(file, None)], context=context)
    return found


def of_click() -> Catalog:
    """Words of click itself: help, wrong usage."""
    found = Catalog(domain=CLICK, project="tmm-sheets", version="", charset="utf-8", creation_date=NEVER, revision_date=NEVER)
    for path in sorted(Path(click.__file__).parent.glob("*.py")):
        for _, text, _, _ in extract_from_file("python", path, {"_": None, "gettext": None, "ngettext": (1, 2)}):
            found.add(text)
    return found


def path_of(language: str, suffix: str = "po", domain: str = DOMAIN) -> Path:
    return LOCALE / language / "LC_MESSAGES" / f"{domain}.{suffix}"


def read(language: str, domain: str = DOMAIN) -> Catalog:
    """The catalogue as it stands in its file; a new one where there is none."""
    path = path_of(language, domain=domain)
    if not path.exists():
        return Catalog(language, domain=domain)
    with path.open("rb") as file:
        return read_po(file, language, domain)


def updated(language: str, template: Catalog) -> Catalog:
    """Texts of the template with the translations there were; what nobody says any more is gone."""
    old = read(language, str(template.domain))
    new = Catalog(language, domain=template.domain, project="tmm-sheets", version="", fuzzy=False, creation_date=NEVER,
                  revision_date=NEVER,
                  header_comment=f"# {language}: words of tmm_sheets; make messages brings it up to date.")
    for message in template:
        if message.id:
            kept = old.get(message.id[0] if message.pluralizable else message.id, message.context)
            new.add(message.id, kept.string if kept is not None else None, context=message.context)
    if template.domain == CLICK:  # other versions of click say other things
        for message in old:
            if message.id and message.string and message.id not in new:
                new.add(message.id, message.string)
    return new


def as_po(catalogue: Catalog) -> bytes:
    out = BytesIO()
    write_po(out, catalogue, width=132, sort_output=True, no_location=True)
    return out.getvalue()


def as_mo(catalogue: Catalog) -> bytes:
    out = BytesIO()
    write_mo(out, catalogue)
    return out.getvalue()


def write(language: str, catalogue: Catalog, domain: str = DOMAIN) -> None:
    path_of(language).parent.mkdir(parents=True, exist_ok=True)
    path_of(language, domain=domain).write_bytes(as_po(catalogue))
    path_of(language, "mo", domain).write_bytes(as_mo(catalogue))


def problems(catalogue: Catalog) -> list[str]:
    """Texts whose translations have other fields or an odd number of braces of markup."""
    found = []
    for message in catalogue:
        said = [s for s in (message.string if isinstance(message.string, tuple) else (message.string,)) if s]
        meant = message.id if isinstance(message.id, tuple) else (message.id,)
        if message.id and not all(any(_shape(s) == _shape(m) for m in meant) for s in said):
            found.append(str(message.id))
    return found


def _shape(text: str) -> tuple[set[str], int]:
    """Fields of a text, and how many braces open that do not close."""
    fields = re.findall(r"(?<![{_^])\{[a-z]\w*(?:![rsa])?(?::[^{}]*)?(?=\})", text)
    return {field[1:] for field in fields}, text.count("{") - text.count("}")


def missing(catalogue: Catalog) -> list[str]:
    """Texts without a translation; in English only those need one that are Russian, from somebody's file."""
    return [str(m.id) for m in catalogue if m.id and not all(m.string if isinstance(m.string, tuple) else (m.string,))
            and (str(catalogue.locale) != "en" or (not str(m.id).isascii() and CYRILLIC.search(str(m.id))))]


def add(catalogue: Catalog, table: dict, language: str) -> None:
    for message in catalogue:
        if message.id:
            key = message.id[0] if message.pluralizable else message.id
            context = "click" if catalogue.domain == CLICK else message.context
            said = table.get(f"{context}|{key}" if context else key, {}).get(language)
            if said:
                message.string = tuple(said) if isinstance(said, list) else said


def main(arguments: list[str]) -> None:
    table: dict = {}
    for path in arguments[1:] if arguments[:1] == ["--add"] else []:
        table |= json.loads(Path(path).read_text("utf-8"))
    for template in (collected(), of_click()):
        domain = str(template.domain)
        for language in LANGUAGES if domain == DOMAIN else LANGUAGES[:-1]:
            catalogue = updated(language, template)
            add(catalogue, table, language)
            write(language, catalogue, domain)
            left = missing(catalogue)
            print(f"{language}: {len(catalogue)} texts of {domain}, {len(left)} without a translation", *left[:8], sep="\n  ")


if __name__ == "__main__":
    main(sys.argv[1:])
