"""What the site has beside docs/: the READMEs as first pages, the reference of the API, the living page (hooks of mkdocs).

``make site`` runs mkdocs in an environment of its own; this module is told there and nowhere else.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
FIRST = {"index.md": "README.md", "ru/index.md": "README.ru.md"}
"""Pages of the site that are papers of the repository."""
MODULES = ("tmm_sheets.api",)
LIVING = '\n<iframe src="living.html" title="The living sheet" style="width:100%;height:80vh;border:1px solid"></iframe>\n'


def moved(text: str, page: str) -> str:
    """A paper with its links as they lead from a page of the site; files that are on no page stay names."""
    up = "../" * page.count("/")

    def link(match: re.Match[str]) -> str:
        place, hash_, anchor = match[2].partition("#")
        for own, paper in FIRST.items():
            if place == paper:
                return f"{match[1]}({up}{own}{hash_}{anchor})"
        if place.startswith("docs/") and place.endswith((".md", ".png", ".svg")):
            return f"{match[1]}({up}{place.removeprefix('docs/')}{hash_}{anchor})"
        if place.startswith("templates/pictures/"):
            return f"{match[1]}({up}pictures/{Path(place).name})"
        return match[0] if re.match(r"[a-z]+:|#", match[2]) else match[1].removeprefix("!").strip("[]")

    return re.sub(r"(!?\[[^\]]*\])\(([^)\s]+)\)", link, text)


LINK = re.compile(r"(\]\()([^)\s#:]+)(?=[)#])")


def beside(place: str, page: str) -> str:
    """Place in the site of a file of the repository that a page links to; empty where it is none, or a page of docs/ itself."""
    target = (ROOT / "docs" / page).parent.joinpath(place).resolve()
    own = target.relative_to(ROOT) if target.is_file() and target.is_relative_to(ROOT) else Path("docs")
    return f"files/{own.as_posix()}" if own.parts[0] != "docs" or own.parts[1:2] == ("examples",) else ""


def on_files(files: Any, config: Any) -> Any:
    """Add the pages that are not in docs/, and the files that those in it link to."""
    from mkdocs.structure.files import File

    docs = ROOT / "docs"
    pages = {path.relative_to(docs).as_posix(): path.read_text("utf-8") for path in docs.rglob("*.md")}
    linked = {beside(place, page) for page, text in pages.items() for _, place in LINK.findall(text)}
    for place in sorted(linked - {""}):
        files.append(File.generated(config, place, abs_src_path=str(ROOT / place.removeprefix("files/"))))
    for page, paper in FIRST.items():
        files.append(File.generated(config, page, content=moved((ROOT / paper).read_text("utf-8"), page)))
    files.append(File.generated(config, "api.md", content="# API\n\n" + "\n".join(f"::: {name}\n" for name in MODULES)))
    for picture in (ROOT / "templates" / "pictures").iterdir():
        files.append(File.generated(config, f"pictures/{picture.name}", abs_src_path=str(picture)))
    return files


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """A page with its links to files of the repository; the living sheet itself on its page."""
    up, own = "../" * page.file.src_uri.count("/"), page.file.src_uri
    if own not in FIRST:
        markdown = LINK.sub(lambda m: f"{m[1]}{up}{found}" if (found := beside(m[2], own)) else m[0], markdown)
    return markdown.replace("\n## ", f"{LIVING}\n## ", 1) if page.file.src_uri == "page.md" else markdown


def on_post_build(config: Any) -> None:
    """Write the living sheet."""
    program = os.environ.get("TMM_SHEETS_PYTHON", sys.executable)
    living = Path(config["site_dir"]) / "living.html"
    command = [program, "-m", "tmm_sheets", "page", "lugansk/shaper", "-o", living]
    subprocess.run(command, check=True, cwd=ROOT, stdout=subprocess.DEVNULL)
