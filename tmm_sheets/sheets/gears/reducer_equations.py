"""View of what a reducer is counted by: ratio, conditions and speeds, in letters and in numbers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from tmm_sheets.numbers import fixed, number
from tmm_sheets.sheets.components.listed import Lines
from tmm_sheets.words import marked, tr

if TYPE_CHECKING:
    from tmm_sheets.methods.gears.reducer import Reducer
    from tmm_sheets.methods.gears.reducer_stages import Stage


def unsigned(ratio: float) -> str:
    """A ratio without its sign, as a factor of one that has none."""
    return fixed(ratio, 3) if ratio > 0 else f"|{fixed(ratio, 3)}|"


def _lines(r: Reducer) -> Iterator[str]:
    chosen, held = ({step.name: step.value for step in plan} for plan in (r.sets[0], r.conditions))
    stage = r.stages[0]
    first, second = stage.signs
    one, two, three, four = (w.number for w in stage.wheels)
    z = [f"z_{{{n}}}" for n in (one, two, three, four)]
    teeth = [str(w.teeth) for w in stage.wheels]
    together = "" if first * second > 0 else "−"
    inner = f"i_{{{one}{four}}}^{{H}}"

    def of(a: int, b: int, over: list[str]) -> str:
        """A quotient of two of them, or of the products of all where the satellites are of two kinds."""
        return f"{together}{over[3]}/{over[0]}" if stage.single else f"{together}{over[a]}·{over[3]}/({over[0]}·{over[b]})"

    # Where the carrier drives, the ratio is the reciprocal of a small difference.
    i = number(chosen["i14"], 7 if stage.driver == "carrier" else 5)
    yield f"{inner} = {of(1, 2, z)} = {of(1, 2, teeth)} = {i}"
    within = f"({i})" if chosen["i14"] < 0 else i
    enters, leaves = {"sun": (one, "H"), "ring": (four, "H"), "carrier": ("H", one)}[stage.driver]
    ratio = f"u_{{{enters}{leaves}}}"
    letters, counted = {"sun": (f"1 − {inner}", f"1 − {within}"), "ring": (f"1 − 1/{inner}", f"1 − 1/{within}"),
                        "carrier": (f"1/(1 − {inner})", f"1/(1 − {within})")}[stage.driver]
    yield f"{ratio} = {letters} = {counted} = {fixed(chosen['u_stage'], 3)}"
    count = len(r.stages)
    parts = [f"|{ratio}|" + (f"^{{{count}}}" if count > 1 else "")]
    values = [unsigned(chosen["u_planetary"])]
    if r.simple:
        pinion, wheel = r.simple
        parts.append(f"z_{{{wheel.number}}}/z_{{{pinion.number}}}")
        values.append(f"{wheel.teeth}/{pinion.teeth}")
    if len(parts) > 1 or count > 1:
        yield f"u = {'·'.join(parts)} = {'·'.join(values)} = {fixed(chosen['u'], 3)}"
    signs = ["+" if s > 0 else "−" for s in (first, second)]
    yield tr("Coaxiality: {letters}; {numbers}").format(
        letters=f"{z[0]} {signs[0]} {z[1]} = {z[3]} {signs[1]} {z[2]}",
        numbers=f"{teeth[0]} {signs[0]} {teeth[1]} = {teeth[3]} {signs[1]} {teeth[2]} = {held['coaxiality_left']}")
    join = "−" if together == "" else "+"
    divisor = tr("gcd({one}; {two})")
    letters, counted = ((f"({z[0]} {join} {z[3]})/q", f"({teeth[0]} {join} {teeth[3]})/{held['q']}") if stage.single else
                        (f"({z[0]}·{z[2]} {join} {z[1]}·{z[3]})/(q·{divisor.format(one=z[1], two=z[2])})",
                         f"({teeth[0]}·{teeth[2]} {join} {teeth[1]}·{teeth[3]})/({held['q']}·"
                         f"{divisor.format(one=teeth[1], two=teeth[2])})"))
    yield tr("Assembly: {letters} = {numbers}").format(letters=letters, numbers=f"{counted} = {number(held['assembly'], 6)}")
    larger = max(stage.wheels[1:3], key=lambda w: w.teeth)
    yield tr("Neighbourhood: {letters}").format(
        letters=f"({z[0]} {signs[0]} {z[1]})·sin(180°/q) > z_{{{larger.number}}} + 2h_a^{{*}}")
    yield (f"{held['coaxiality_left']}·sin(180°/{held['q']}) = {fixed(held['between'], 2)} > {larger.teeth} + "
           f"2·{number(held['ha'])} = {fixed(held['width'], 2)}")
    yield from _speeds(stage, ratio, inner, within, fixed(chosen["u_stage"], 3))


def _speeds(stage: Stage, ratio: str, inner: str, within: str, u: str) -> Iterator[str]:
    """Speeds of the links of the stage, positive as the input's, rpm."""
    one, two, _, four = stage.wheels
    carrier = stage.carrier if len(stage.carrier) == 1 else f"H_{stage.carrier[1:]}"
    n = {name: number(float(step.value), 5) for name, step in (("1", one.n), ("2", two.n), ("4", four.n), ("H", stage.n_H))}
    h, first = f"n_{{{carrier}}}", f"n_{{{one.number}}}"
    if stage.driver == "carrier":
        yield f"{first} = {h}·(1 − {inner}) = {n['H']}·(1 − {within}) = {n['1']} " + tr("rpm")
    else:
        entry, value = (first, n["1"]) if stage.driver == "sun" else (f"n_{{{four.number}}}", n["4"])
        yield f"{h} = {entry}/{ratio} = {value}/{u} = {n['H']} " + tr("rpm")
    sign = "−" if stage.signs[0] > 0 else "+"
    subtracted = f"({n['H']})" if float(stage.n_H.value) < 0 else n["H"]
    yield (f"n_{{{two.number}}} = {h} {sign} ({first} − {h})·z_{{{one.number}}}/z_{{{two.number}}} = {n['H']} {sign} "
           f"({n['1']} − {subtracted})·{one.teeth}/{two.teeth} = {n['2']} " + tr("rpm"))


of_stage = Lines(marked("The reducer in numbers"), lambda project, canvas: _lines(project.reducer))
"""Ratio, conditions and speeds of a planetary stage, and the ratio of the whole reducer."""
