"""``sixbar/T:V``: task T = 1..10, variant V = 1..5 of manual 001, six-bar mechanisms with 24 positions.

The tables are ``variants/sixbar/taskTT.toml``, the mechanisms ``templates/schemes/sixbar_TT.toml`` under the common head
``templates/schemes/sixbar.toml``. Suspected misprints of the tables are told with the value that is suggested instead.
"""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass
from decimal import Decimal
from string import Template
from typing import TYPE_CHECKING, Any

from tmm_sheets import resources
from tmm_sheets.errors import BadInput
from tmm_sheets.task import headings
from tmm_sheets.task.misprint import Misprint
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.task.variant import Variant

TASKS, VARIANTS = range(1, 11), range(1, 6)


@dataclass(frozen=True)
class Doubt(Misprint):
    """A misprint with how certain it is."""

    certainty: str

    def warning(self) -> str:
        """One line about it."""
        said = (tell("{symbol} = {printed} {unit} is a suspected misprint ({certainty}), suggested {suggested} {unit}: {reason}; "
                     "the suggested value is used") if self.corrected else
                tell("{symbol} = {printed} {unit} is a suspected misprint ({certainty}), suggested {suggested} {unit}: {reason}; "
                     "the printed value is used, --corrected takes {suggested}"))
        return said.format(symbol=self.symbol, printed=self.printed, unit=self.unit, certainty=tell(self.certainty),
                           suggested=self.suggested, reason=tell(self.reason))


def names() -> tuple[str, ...]:
    """All fifty projects."""
    return tuple(f"sixbar/{task}:{variant}" for task in TASKS for variant in VARIANTS)


def heading(name: str) -> dict[str, Any]:
    """Table ``[project]`` of ``sixbar/T:V``.

    Raises
    ------
    BadInput
        when there is no such task or variant.
    """
    task, number = _parts(name)
    table = tomllib.loads(headings.first(_table(task)))
    return headings.of(_scheme("sixbar"), _named(task, number, table))


def read(name: str, corrected: bool = False) -> Variant:
    """Project of ``sixbar/T:V``.

    Raises
    ------
    BadInput
        when there is no such task or variant.
    """
    from tmm_sheets.task import variant

    task, number = _parts(name)
    text, misprints = project_file(task, number, corrected)
    return variant.parse(text, name, tuple(m.warning() for m in misprints), misprints)


def _parts(name: str) -> tuple[int, int]:
    match = re.fullmatch(r"sixbar/(\d{1,2}):(\d)", name)
    if match is None:
        raise BadInput(tell('there is no project "{name}"').format(name=name),
                       hint=tell("write sixbar/task:variant, for example sixbar/3:2"))
    task, number = int(match[1]), int(match[2])
    for value, known, refusal, hint in (
        (task, TASKS, tell("{name}: there is no task {n}"), tell("tasks are {first} to {last}")),
        (number, VARIANTS, tell("{name}: there is no variant {n}"), tell("variants are {first} to {last}")),
    ):  # fmt: skip
        if value not in known:
            raise BadInput(refusal.format(name=name, n=value), hint=hint.format(first=known[0], last=known[-1]))
    return task, number


def project_file(task: int, number: int, corrected: bool = False) -> tuple[str, tuple[Doubt, ...]]:
    """Text of the project file of a variant, and its misprints."""
    table = tomllib.loads(_table(task), parse_float=Decimal)
    values = {symbol: Decimal(row[number - 1]) for symbol, row in table["values"].items()} | table.get("dash", {})
    sources = {symbol: f"001, task {task}, variant {number}: {symbol}" for symbol in values}
    for symbol in table.get("dash", {}):
        sources[symbol] += " is a dash"
    for symbol, note in table.get("note", {}).items():
        sources[symbol] += f", {note}"
    misprints = _misprints(table, number, corrected)
    for m in misprints:
        if corrected:
            values[m.symbol] = m.suggested
            sources[m.symbol] += f", printed {m.printed}, suspected misprint ({m.certainty})"
        else:
            sources[m.symbol] += f", suspected misprint ({m.certainty}) for {m.suggested}"
    fields = {
        **{symbol: str(value) for symbol, value in values.items()},
        **{f"{symbol}_source": source for symbol, source in sources.items()},
        **{key: str(value) for key, value in _derived(task, values).items()},
        **{key: value if isinstance(value, str) else str(value).replace("'", '"') for key, value in table["cycle"].items()},
        **_named(task, number, table), "number": f"{task:02d}.{number:02d}",
    }  # fmt: skip
    parts = map(_scheme, ("sixbar", f"sixbar_{task:02d}"))
    return Template("\n".join(parts)).substitute(fields), misprints


def _table(task: int) -> str:
    return (resources.variants() / f"sixbar/task{task:02d}.toml").read_text(encoding="utf-8")


def _scheme(name: str) -> str:
    return resources.template(f"schemes/{name}.toml").read_text(encoding="utf-8")


def _named(task: int, number: int, table: dict[str, Any]) -> dict[str, str]:
    """What is filled into the heading."""
    return {"name": f"sixbar/{task}:{number}", "title": table["title"], "task": str(task), "variant": str(number)}


def _misprints(table: dict[str, Any], number: int, corrected: bool) -> tuple[Doubt, ...]:
    return tuple(
        Doubt(m["quantity"], table["unit"][m["quantity"]], Decimal(table["values"][m["quantity"]][number - 1]),
              Decimal(m["suggested"]), m["reason"], corrected, m["certainty"])
        for m in table.get("misprint", []) if m["variant"] == number
    )  # fmt: skip


def _derived(task: int, d: dict[str, Decimal]) -> dict[str, Decimal]:
    """Coordinates (m) that follow from the table: height of the guide of link 5, place of the pivot of rocker 5."""
    if task in (1, 2, 3):
        return {"guide_y": d["b"] - d["a"]}
    if task == 4:
        return {"guide_y": d["b"] + d["a"]}
    if task in (8, 9):
        return {"pivot_x": (d["l2"] ** 2 - d["r"] ** 2).sqrt()}
    return {}
