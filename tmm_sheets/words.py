"""Words in the languages of the program, from the catalogues in ``templates/locale``.

A text stands in the code in English and is looked up when it is said. There are two languages at a time: the one of the paper
(:func:`tr`: sheets, protocol, what is told about them), which the project chooses, and the one of the person at the machine
(:func:`tell`: messages, reports, ``--help``), which the locale chooses; ``--lang`` sets both. Keys, ids and names of steps are no
words and never change. A text of a project file that is in no catalogue (somebody's own title) stands as it is.
"""

from __future__ import annotations

import gettext
import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from contextvars import ContextVar
from functools import cache, lru_cache
from typing import Any, TypeVar

from tmm_sheets.resources import folder

T = TypeVar("T")
CODE = "en"
"""Language that the code itself is written in."""


LOCALE = os.path.join(folder("templates"), "locale")
"""Folder of the catalogues."""


def languages(place: str | os.PathLike[str]) -> tuple[str, ...]:
    """Languages of a folder of catalogues, the code's own last; a file that lies there too is none."""
    found = {entry.name for entry in os.scandir(place) if entry.is_dir() and entry.name[:1].islower()}
    return (*sorted(found - {CODE}), CODE)


LANGUAGES = languages(LOCALE)
"""Languages that there are catalogues of: a folder is a language."""
SHEETS, MESSAGES = "ru", CODE
"""Language of sheets when neither project nor command tells one, and of messages when the locale names none of them."""
DOMAIN = "tmm_sheets"

_paper = ContextVar("paper", default=SHEETS)
_reader = ContextVar("reader", default=MESSAGES)
_asked = ContextVar("asked", default="")
paper = _paper.get
"""Language of what stands on the paper."""
set_paper = _paper.set
"""The paper's language from here on: for a command that has one project."""
reader = _reader.get
"""Language of messages and reports."""
set_reader = _reader.set
"""The reader's language from here on."""
asked = _asked.get
"""Language of the paper that the person asked for; empty for none."""
ask_paper = _asked.set
"""Language that the person asks for whatever a project says; empty for none."""


@cache
def _catalogue(language: str) -> gettext.NullTranslations:
    return gettext.translation(DOMAIN, LOCALE, [language], fallback=True)


@contextmanager
def meanwhile(variable: ContextVar[T], value: T) -> Iterator[None]:
    """A variable has another value meanwhile."""
    token = variable.set(value)
    try:
        yield
    finally:
        variable.reset(token)


def on_paper(language: str) -> AbstractContextManager[None]:
    """The paper's language meanwhile."""
    return meanwhile(_paper, language)


def of_project(language: str | None) -> str:
    """Language of a project's sheets: the one asked for, its own, or Russian."""
    return _asked.get() or language or SHEETS


def of_locale(environment: Mapping[str, str] = os.environ) -> str:
    """The first of our languages among those that a locale asks for, in the order in which programs ask the variables.

    Windows sets none of them unless told to; what the system speaks is asked there.
    """
    for name in ("LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG"):
        asked = environment.get(name, "")
        if asked:
            return _first(asked.split(":"))
    if os.name == "nt":
        import locale

        return _first([locale.getlocale()[0] or ""])
    return MESSAGES


def _first(asked: Sequence[str]) -> str:
    for name in asked:
        short = name.replace("-", "_").split("_")[0].split(".")[0].lower()
        if short in LANGUAGES:
            return short
        for language in reversed(LANGUAGES) if len(short) > 3 else ():  # Windows writes the name out; one without words is English
            if short == name_of(language).lower():
                return language
    return MESSAGES


class CatalogueText(str):
    """A text of a catalogue: the numbers that are filled in are written as its language writes them.

    This is the one place where a sentence gets its decimal comma: whoever says something fills in numbers as they are, and what
    was put together elsewhere (what stands in a file or has to be typed) as texts.
    """

    __slots__ = ("language",)
    language: str

    def format(self, *args: object, **fields: object) -> str:
        """The text with its fields filled in."""
        sign = decimal_sign(self.language)
        if sign == ".":
            return super().format(*args, **fields)
        from decimal import Decimal

        signed = {key: _Signed(value, sign) if isinstance(value, float | Decimal) else value for key, value in fields.items()}
        return super().format(*[_Signed(value, sign) if isinstance(value, float | Decimal) else value for value in args], **signed)


class _Signed:
    """A number that is written with the decimal sign of a language."""

    def __init__(self, number: Any, sign: str) -> None:
        self.number, self.sign = number, sign

    def __format__(self, spec: str) -> str:
        return format(self.number, spec).replace(".", self.sign)


def _text(text: str, language: str) -> CatalogueText:
    found = CatalogueText(text)
    found.language = language
    return found


def marked(text: str) -> str:
    """The text itself, marked for the catalogues: what is defined once (a rule's wording) and said later."""
    return text


def marked_n(one: str, many: str) -> tuple[str, str]:
    """The forms of a text with a number, marked for the catalogues."""
    return one, many


def tr(text: str) -> str:
    """The text as it stands on the paper; fields in braces stay for ``format``."""
    language = _paper.get()
    return _text(_catalogue(language).gettext(text), language) if text else text


def tr_in(context: str, text: str) -> str:
    """A text of the paper that other languages say differently elsewhere; ``context`` tells the translator where it stands."""
    return _text(_catalogue(_paper.get()).pgettext(context, text), _paper.get())


def tr_n(one: str, many: str, n: int) -> str:
    """The form that goes with ``n``, on the paper."""
    return _text(_catalogue(_paper.get()).ngettext(one, many, n), _paper.get())


def tell(text: str) -> str:
    """The text as the person at the machine reads it."""
    language = _reader.get()
    return _text(_catalogue(language).gettext(text), language) if text else text


def tell_n(one: str, many: str, n: int) -> str:
    """The form that goes with ``n``, in a message."""
    return _text(_catalogue(_reader.get()).ngettext(one, many, n), _reader.get())


_FILLED = (marked("задание {task}, вариант {variant}"), marked("шифр {cipher}"), marked("ТММ.КП.{number}"))
"""Texts of shipped schemes that are filled in."""


@cache
def _fields(text: str) -> re.Pattern[str]:
    return re.compile(re.sub(r"\\{(\w+)\\}", r"(?P<\1>.+)", re.escape(text)))


def of_file(text: str, say: Callable[[str], str] = tr) -> str:
    """A text of a project file: what shipped files say in the language of ``say``, anybody's own as it stands."""
    for pattern in _FILLED:
        if match := _fields(pattern).fullmatch(text):
            return say(pattern).format(**match.groupdict())
    return say(text)


def either(said: Sequence[str]) -> str:
    """Words of a message one of which is meant."""
    return tell("{several} or {last}").format(several=", ".join(said[:-1]), last=said[-1]) if said[1:] else "".join(said)


def both(said: Sequence[str]) -> str:
    """Words of a message that are meant together."""
    return tell("{several} and {last}").format(several=", ".join(said[:-1]), last=said[-1]) if said[1:] else "".join(said)


@lru_cache(1024)
def every(text: str) -> tuple[str, ...]:
    """The text in all languages: what somebody may have written who has another one than the reader."""
    return tuple(dict.fromkeys(_catalogue(language).gettext(text) for language in LANGUAGES)) if text else ()


@cache
def of_language(context: str, text: str, language: str) -> str:
    """What a catalogue says of its own language; ``text`` is what is true of English."""
    return _catalogue(language).pgettext(context, text)


def decimal_sign(language: str = "") -> str:
    """What stands before the decimals in a language; on the paper if none is told."""
    return of_language("decimal sign", ".", language or _paper.get())


def name_of(language: str) -> str:
    """English name of a language."""
    return of_language("English name of the language", "English", language)


def is_latin(language: str) -> bool:
    """Whether a language is written in the letters of most symbols."""
    return of_language("script: Latin, Cyrillic, Greek", "Latin", language) == "Latin"


def plural_form(forms: Sequence[str], n: int, language: str) -> str:
    """The form that goes with a number by the rule of a catalogue; of other numbers of forms the last for all but one."""
    rule, count = _plurals(language)
    return forms[rule(n)] if len(forms) == count else forms[0 if n == 1 else -1]


@cache
def _plurals(language: str) -> tuple[Callable[[int], int], int]:
    rule: Callable[[int], int] = getattr(_catalogue(language), "plural", lambda n: int(n != 1))
    return rule, len({rule(n) for n in range(200)})


# --- remarks ---------------------------------------------------------------------------------------------------------------


class Remark:
    """A text of the catalogues, or its two forms of which ``count`` chooses one, with its numbers and names.

    In words of the person at the machine: kept as what it is about, put into words when it is told. A value may be a remark itself.
    """

    def __init__(self, text: str | tuple[str, str], values: Mapping[str, Any] | None = None, count: int = 0) -> None:
        self.text, self.values, self.count = text, values or {}, count

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Remark) and vars(self) == vars(other)

    def __str__(self) -> str:
        said = tell(self.text) if isinstance(self.text, str) else tell_n(*self.text, self.count)
        return said.format(**{name: str(value) if isinstance(value, Remark) else value for name, value in self.values.items()})
