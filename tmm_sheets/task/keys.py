"""Keys of a project file as they are told to who writes one: what each takes, in which units, its default, what it means.

All of it follows from the types of ``schema.py`` and from the strings under the keys, which are looked for here alone: a command
starts no slower for them.
"""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Iterator, Mapping
from functools import cache
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, NamedTuple, Union, get_args, get_origin, get_type_hints

from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from tmm_sheets.task import messages, schema, units, variant
from tmm_sheets.task.values import MOST, Checks
from tmm_sheets.words import either, marked, tell


class Key(NamedTuple):
    """A key: its name, what it takes, its units, what is taken where it is left out, what it means."""

    name: str
    takes: str
    units: tuple[str, ...]
    left_out: str
    means: str


def tables() -> dict[str, list[dict[str, Any]]]:
    """Keys of every table by the table's name, "flywheel.motor" for one in another, "" for what stands in none."""
    return {name: [key._asdict() for key in keys_of(model)] for name, model in models()}


def models(name: str = "", model: type[schema.Table] = variant.Variant) -> Iterator[tuple[str, type[schema.Table]]]:
    """A table by its name, and those in it."""
    yield name, model
    for key, field in model.model_fields.items():
        if (inner := messages.table_of(field.annotation)) is not None:
            yield from models(f"{name}.{key}".lstrip("."), inner)


def texts() -> Iterator[str]:
    """What is told of keys and stands in strings and docstrings alone, for the catalogues."""
    for _, model in models():
        yield from meanings(model).values()
        for hint in get_type_hints(model, include_extras=True).values():
            yield from (heading(v.func) for v in validators(hint) if not made_with(v))


def validators(hint: Any) -> Iterator[Any]:
    """Validators of a type and of those that it is made of."""
    args = get_args(hint)
    yield from args[1:] if get_origin(hint) is Annotated and args[1] is not schema.LATER else ()
    for inner in args[:1] if get_origin(hint) is Annotated else args:
        yield from validators(inner)


def keys_of(model: type[schema.Table]) -> Iterator[Key]:
    """Every key of a table."""
    hints = get_type_hints(model, include_extras=True)
    for name, field in model.model_fields.items():
        takes = value(hints[name])
        units_of = tuple(spaced(unit) for q in quantities(hints[name]) for unit in q.units if unit and unit.isascii())
        yield Key(field.alias or name, takes, units_of, default(hints[name], field), meaning(model, name, takes))
@cache
def meanings(model: type[schema.Table]) -> dict[str, str]:
    """What the strings under the keys of a table say, by key."""
    (tree,) = ast.parse(inspect.getsource(model)).body
    assert isinstance(tree, ast.ClassDef)
    found, before = {}, None
    for node in tree.body:
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and before is not None:
            found[before] = " ".join(str(node.value.value).split())
        before = node.target.id if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) else None
    return found


def meaning(model: type[schema.Table], name: str, takes: str) -> str:
    """Description (what a message about a missing key says) and the string under the key, without what ``takes`` says already."""
    description, said = model.model_fields[name].description or "", meanings(model).get(name, "")
    described = quoted(tell(description))
    news = described.replace(",", " or") != takes.replace(",", " or")
    return "; ".join(filter(None, (described if news else "", tell(said))))


def quoted(description: str) -> str:
    """A description with its examples set as code."""
    text, for_example, shown = description.partition("for example ")
    return re.sub(r'("[^"]*")', r"`\1`", text) + for_example + " or ".join(f"`{x}`" for x in shown.split(" or ") if x)


def value(hint: Any) -> str:
    """What a key takes, in words, from its type."""
    origin, args = get_origin(hint), get_args(hint)
    if origin is Annotated:
        return value(args[0]) if args[1] is schema.LATER else restricted(args[0], args[1:])
    if origin in (Union, UnionType):
        return either([value(a) for a in args if a is not NoneType])
    if origin is Literal:
        return either([f'`"{a}"`' if isinstance(a, str) else f"`{a}`" for a in args])
    if origin is dict:
        return tell("{values}, by name").format(values=plural(value(args[1])))
    if origin is tuple:
        return tell(marked("list of {values}") if args[-1] is ... else marked("two {values}")).format(values=plural(value(args[0])))
    plain = {bool: marked("`true` or `false`"), str: marked("text"), int: marked("whole number"), float: marked("number"),
             Any: marked("value"), NoneType: ""}
    table = marked("table")
    return tell(plain.get(hint, table))


def plural(text: str) -> str:
    """Several of what a key takes, in English; other languages say it as it is."""
    return re.sub(r"^(whole )?([a-z]+)", r"\1\2s", text) if not text.startswith("two") else text


def restricted(base: Any, validators: tuple[Any, ...]) -> str:
    """Value of a type with validators: the named ones tell by their docstring, the others by what they were made with."""
    said = []
    for v in validators:
        given = made_with(v)
        if not given:
            said.append(tell(heading(v.func)))
        elif "words" in given:
            said.append(either([*(f'`"{word}"`' for word in given["words"]), tell(given["quantity"].name)]))
        elif "word" in given:
            said.append(either([f'`"{given["word"]}"`', value(base)]))
        elif "wording" in given:
            expected = tell(given["wording"]).removeprefix(tell("expected {what}").partition("{")[0])
            said.append(re.sub(r"^an? ", "", expected))
        elif "quantity" in given and not any(isinstance(o, Checks) for o in validators):
            said.append(tell(given["quantity"].name))
        elif "least" in given:
            few, many = marked("whole number from {least} to {most}"), marked("whole number, {least} or more")
            said.append(tell(many if given["most"] == MOST else few).format(least=given["least"], most=given["most"]))
    return ", ".join(dict.fromkeys(said))


def heading(validator: Any) -> str:
    """First line of a validator's docstring, as part of a sentence."""
    first = (inspect.getdoc(validator) or "").split("\n")[0].rstrip(".")
    return re.sub(r"^(An? )?([A-Z])", lambda m: m[2].lower(), first)
def made_with(validator: Any) -> Mapping[str, Any]:
    """What a validator holds in its closure: quantity, wording, least, word; nothing for a named function."""
    return inspect.getclosurevars(validator.func).nonlocals


def default(hint: Any, field: FieldInfo) -> str:
    """What is taken where a key is left out."""
    if field.default is PydanticUndefined:
        return tell("needed")
    if field.default in (None, (), {}, "") or isinstance(field.default, schema.Table):
        return "–"
    if isinstance(field.default, bool):
        return f"`{str(field.default).lower()}`"
    if isinstance(field.default, tuple):
        return f"`[{', '.join(f'{x:g}' for x in field.default)}]`"
    if isinstance(field.default, str):
        return f'`"{field.default}"`'
    return f"`{field.default:g}`" if field.default == 0 or not unit(hint) else f'`"{field.default:g} {unit(hint)}"`'


def unit(hint: Any) -> str:
    """SI unit of a key; empty for a pure number."""
    return next((name for q in quantities(hint) for name, f in q.units.items() if f.si("1") == 1), "")


def quantities(hint: Any) -> list[units.Quantity]:
    """The quantity that a type reads, of a list that of its members; one at most."""
    return [given["quantity"] for v in validators(hint) if "quantity" in (given := made_with(v))][:1]


def spaced(name: str) -> str:
    """A unit as people write it: kg m2, N mm."""
    return re.sub(r"^(kg|кг|g|г|k?N|к?Н)(?=[mм])", r"\1 ", name)
