"""A remark in words of the person at the machine: kept as what it is about, put into words when it is told."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from tmm_sheets.words import tell, tell_n


@dataclass(frozen=True)
class Remark:
    """A text of the catalogues, or its two forms of which ``count`` chooses one, with its numbers and names.

    A value may be a remark itself.
    """

    text: str | tuple[str, str]
    values: dict[str, Any] = field(default_factory=dict)
    count: int = 0

    def __str__(self) -> str:
        said = tell(self.text) if isinstance(self.text, str) else tell_n(*self.text, self.count)
        return said.format(**{name: str(value) if isinstance(value, Remark) else value for name, value in self.values.items()})
