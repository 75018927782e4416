"""Views of the moment equations of the force study, in letters and in numbers: of the groups and of Zhukovsky's lever."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import reduce
from itertools import product
from math import inf
from operator import mul
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.construction.equation import Quantity, equation
from tmm_sheets.construction.expression import Argument, Constant
from tmm_sheets.construction.indices import pair_index
from tmm_sheets.construction.scale import Scale
from tmm_sheets.construction.step import Step, symbol
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import broken, letter
from tmm_sheets.numbers import clean, is_zero
from tmm_sheets.sheets.border_solver import UNDER, Form as Needed
from tmm_sheets.sheets.components.listed import Form, Formulas
from tmm_sheets.sheets.linkage.kinetic_frames import BAR, arm_sign, balancing_sign, flat, on_lever
from tmm_sheets.sheets.linkage.link_marks import indexed
from tmm_sheets.sheets.player import extent, once
from tmm_sheets.words import SHEETS, marked, on_paper, tr

if TYPE_CHECKING:
    from tmm_sheets.mechanism.model import StructuralGroup
    from tmm_sheets.project import Project

SENSES = {False: marked("(in the sense of ω_1)"), True: marked("(against ω_1)")}
"""What is said of a balancing moment that is held back, or not: equations take it as it is drawn, as it acts."""
WIDTHS = (inf, 210.0, 165.0, 130.0, 105.0, 88.0)
"""Widths at which equations are broken, mm."""
LETTERS = ((3.5, 6.0), (2.5, 4.5))
"""Heights of their letters and distances of their lines that are tried, mm; room is made for the first."""
EDGES = 6.0
"""What a place has beside them, both sides together, mm."""
HEAD = 12.0
"""What their title takes where they stand apart from the figures, mm."""
FEWER = 1.2
"""What a figure over every text that says less counts for."""


class Term(NamedTuple):
    """A term of a sum of moments: its letters, its sign, and its numbers: a force (N) with its arm (m), or a couple (N m)."""

    letters: str
    sign: float
    values: tuple[float, ...]


@once
def of_group(project: Project, g: StructuralGroup) -> list[list[str]]:
    """Equations of a group, with those of its guides' reactions if there is room; none for a group without any."""
    return _not_empty(group_equations(project, g, guides) for guides in ((True, False) if g.guides else (False,)))


@once
def of_crank(project: Project) -> list[list[str]]:
    """The equation that gives the balancing moment."""
    return _not_empty([crank_equation(project)])


@once
def of_lever(project: Project) -> list[list[str]]:
    """The equation of the lever, every other of its arms with a digit more than it has at a usual size."""
    points = extent([complex(step.at(project.force_index)) for step in project.study.lever.points.values()])
    texts = at_scale(project, Scale("μ_V", max(points.width, points.height) / USUAL or 1.0, ""))
    return [[letters, numbers + "0" * (numbers.count("·") // 2), *more] for letters, numbers, *more in texts]


def at_scale(project: Project, scale: Scale) -> list[list[str]]:
    """The equation of the lever at its scale factor."""
    return _not_empty([lever_lines(project, scale)])


def _not_empty(texts: Iterable[Iterable[str]]) -> list[list[str]]:
    """The texts that say anything."""
    return [lines for text in texts if (lines := [*text])]


USUAL = 80.0
"""Size of a lever for whose arms room is reserved, mm."""


TITLES = {"moments": marked("Equations of moments"), "moments of the lever": marked("Equation of the lever")}
"""What the equations of a plan are called in the files."""


def room(project: Project, of: Callable[..., list[list[str]]], *about: Any) -> list[Needed]:
    """What equations need of a place in the language of most sheets: scale factors must not depend on words."""
    of(project, *about)  # steps that are made for them speak the language of the paper
    height, step = LETTERS[0]
    with on_paper(SHEETS):
        # Each equation in one line, then broken: rather a text that says less than smaller letters.
        parts = ((n, tuple([part for line in lines for part in broken(line, width, height)]))
                 for n, lines in enumerate(of(project, *about)) for width in WIDTHS)
        return [Needed(*Form([[*lines]], height, step, 0.0).size, FEWER ** n) for n, lines in dict.fromkeys(parts)]


def draw(canvas: Canvas, box: Box, under: Box | None, texts: Sequence[list[str]], of: str = "moments") -> None:
    """Write equations in what a figure leaves free ``under`` what of its ``box`` it takes: the first of the texts with room there.

    What the fullest of them says besides is owed to the sheet.
    """
    if under is None:
        return
    place = under._replace(y1=box.y0 - UNDER)
    form, said = next((found for found in _forms(texts, [place.width - EDGES]) if found[0].fits(place)), (None, list[str]()))
    canvas.owed |= {line: box for line in texts[0] if line not in said}
    if form is not None:
        canvas.begin(place, tr(TITLES[of]))
        canvas.of = of
        at = complex(place.centre.real - form.size[0] / 2 + EDGES / 2, place.y1 - 0.8 * form.pitch)
        canvas.lines(at, form.columns[0], form.pitch, form.height)


def _forms(texts: Sequence[list[str]], widths: Iterable[float]) -> Iterator[tuple[Form, list[str]]]:
    """Forms of some texts broken at these widths, mm, without room for a title: the largest letters first."""
    for (height, step), lines, width in product(LETTERS, texts, widths):
        yield Form([[part for line in lines for part in broken(line, width, height)]], height, step, 0.0), lines


def _equations_without_room(canvas: Canvas) -> Iterator[Form]:
    """Forms of the equations that had no room under their figures; none where all stand there."""
    least = letter(tr(TITLES["moments"]), 5.0).width
    yield from (form._replace(head=HEAD, least=least) for form, _ in _forms([[*canvas.owed]] if canvas.owed else [], WIDTHS))


owed = Formulas(TITLES["moments"], "moments", lambda project, canvas: _equations_without_room(canvas))
"""The equations that had no room under their figures."""


def settle(canvas: Canvas) -> None:
    """Say at the first figure without its equations where they are read, if the sheet has no room or no view for them."""
    if all(part.draw != "kinetics.moments" for part in canvas.parts):
        canvas.note(next(iter(canvas.owed.values())), tr("{equations}: in the note").format(equations=tr(TITLES["moments"])))


def group_equations(project: Project, g: StructuralGroup, guides: bool = False) -> Iterator[str]:
    """Equations of moments that give parts of a group's reactions: letters, then numbers."""
    k, forces, pos = project.force_index, project.study.forces, project.study.positions
    parts = [part for part in forces.from_moments if part.link in g.links]
    for part in parts:
        total, centre, at = part.vector.args
        sign, arm = f"F_{{{pair_index(part.link, part.source)}}}^τ", f"l_{{{part.at}{part.centre}}}"
        length = float(forces.positions.plan.length(centre, at).at(k))
        # The scheme of a class III group shows the arms about its special point: others say what they are about.
        about = "" if g.kind.grade == 2 else f"^{part.centre}"
        # Sums of the moments on two links about their common hinge are told apart by the link.
        several = sum(other.centre == part.centre for other in parts) > 1
        name = f"{{{part.centre}({part.link})}}" if several else indexed(part.centre)
        yield from _solved(project, name, total, (sign, arm, length), part.vector, about)
    if guides:
        yield from _guided(project, g)
    if (about := g.kind.about(g)) in pos.special:
        point, third = pos.special[about].step, pos.special[about].third
        if (normal := forces.about_special(point)) is not None:
            m = project.mechanism
            pair = pair_index(third.link, m.guides[third.guide].link if third.guide else m.owner(third.outer))
            sign = f"F_{{{pair}}}" if third.guide else f"F_{{{pair}}}^n"
            length = abs(float(forces.arm_about(point, normal.args[2], normal).at(k)))
            yield from _solved(project, f"{{{about}}}", normal.args[0], (sign, arm_sign(sign), length), normal)


def crank_equation(project: Project) -> Iterator[str]:
    """The equation of the balancing moment, or of the force of a gear."""
    k, forces, crank, name = project.force_index, project.study.forces, project.mechanism.crank, balancing_sign(project)
    if project.driver is not None and project.driver.wheel is None:
        return
    total, *acting = forces.balancing.args
    if project.driver is not None:
        arm = abs(float(forces.arm_about(acting[0], acting[1], forces.balancing).at(k)))
        yield from _solved(project, indexed(crank.pivot), total, (name, arm_sign(name), arm), forces.balancing)
    elif terms := list(_terms(project, total)) if np.isfinite(total.at(k)) else []:
        moment = float(project.study.balance["M"].at(k))
        sense = -crank.sense if moment < 0 else crank.sense
        yield tr("ΣM_{centre} = {sum} = 0").format(centre=indexed(crank.pivot), sum=_sum([Term(name, sense, ()), *terms]))
        solved = [term._replace(sign=-sense * term.sign) for term in terms]
        yield f"{_worked_out(solved, Quantity(name, abs(moment), 'N*m'))} {tr(SENSES[moment < 0])}"


def _guided(project: Project, g: StructuralGroup) -> Iterator[str]:
    """Couples of the reactions of a group's guides, and the arms at which they act; none for one through its hinge."""
    k, forces, guides = project.force_index, project.study.forces, project.mechanism.guides
    for pair in (pair_index(link, guides[guide].link) for guide in g.guides for link in g.links):
        couple = forces.couples.get(f"F{pair}")
        if couple is None or not np.isfinite(value := float(couple.at(k))) or is_zero(value, forces.moment_size(k)):
            continue
        total = couple.args[0]
        terms = list(_terms(project, total))
        centre, sign = indexed(total.args[0].name), f"M_{{{pair}}}"
        yield from _passed_on_couples(project, total)
        yield tr("ΣM_{centre} = {sum} = 0").format(centre=centre, sum=_sum([Term(sign, 1.0 if value > 0 else -1.0, ()), *terms]))
        result = Quantity(sign, abs(value), "N*m")
        yield _worked_out(terms, result, lambda total, _: abs(total)) if len(terms) > 1 else \
            _worked_out([terms[0]._replace(sign=1.0)], result)
        force, arm = complex(forces.reactions[f"F{pair}"].at(k)), forces.arms.get(f"h{pair}")
        if arm is not None and np.isfinite(arm.at(k)) and not is_zero(force, forces.force_size(k)):
            yield equation(lambda m, f: m / f, (Quantity(sign, abs(value)), Quantity(f"F_{{{pair}}}", abs(force))),
                           Quantity(f"h_{{{pair}}}", abs(float(arm.at(k))), "m"))


def _passed_on_couples(project: Project, total: Step) -> Iterator[str]:
    """Couples in a sum that a block passes on from its own loads, such as friction in its hinge: the scheme shows only these."""
    k, own = project.force_index, [id(couple) for couple in project.study.forces.couples.values()]
    for couple in total.args[3::3]:
        if isinstance(couple, Step) and couple.args and id(couple.args[0]) in own and (
                terms := list(_terms(project, couple.args[0].args[0]))):
            yield _worked_out(terms, Quantity(f"{symbol(couple.symbol or couple.name).replace(BAR, '')} = {_sum(terms)}",
                                              float(couple.at(k)), "N*m"))


def _solved(project: Project, centre: str, total: Step, own: tuple[str, str, float], found: Step,
            about: str = "") -> Iterator[str]:
    """An equation of moments in letters, and what it gives in numbers.

    ``own`` are sign, arm and its length, m, of the unknown; ``about`` stands above the arms of the others.
    """
    k, (sign, arm, length) = project.force_index, own
    if not np.isfinite(total.at(k)) or not (terms := list(_terms(project, total, about))):
        return
    # The unknown turns counter-clockwise about the centre where the others together turn clockwise.
    turning = -1.0 if float(total.at(k)) > 0 else 1.0
    yield tr("ΣM_{centre} = {sum} = 0").format(centre=centre, sum=_sum([Term(f"{sign}·{arm}", turning, ()), *terms]))
    yield _worked_out(terms, Quantity(sign, abs(complex(found.at(k))), "N"), lambda total, arm: abs(total) / arm, length)


def lever_lines(project: Project, scale: Scale) -> list[str]:
    """Sum of the moments about the pole of Zhukovsky's lever: letters, then numbers; arms in mm as they are drawn."""
    k, study, mm = project.force_index, project.study, scale.mm
    least, own = study.forces.force_size(k) * project.mechanism.crank.speed, study.lever.hung[-1]
    by_moment = project.driver is None
    terms = []
    for force in on_lever(project, k):
        arm, size = float(force.arm.at(k)), abs(force.vector)
        if force.step is not own.force and not is_zero(size * arm, least):
            sign = force.symbol.replace(BAR, "")
            terms.append(Term(f"{sign}·h_{{{flat(force.symbol)}}}", float(np.sign(arm)), (size, float(mm(abs(arm))))))
    name = flat(balancing_sign(project)) if by_moment else flat(own.symbol)
    sign = f"F_{{{name}}}" if by_moment else own.symbol.replace(BAR, "")
    arm, value = float(own.arm.at(k)), abs(complex(own.force.at(k)))
    if by_moment:
        moment, length = float(study.balance["M_р"].at(k)), project.mechanism.crank.length
        arm, value = abs(complex(own.at.at(k))) * (1.0 if moment < 0 else -1.0), abs(moment) / length
    if not terms or not np.isfinite(arm):
        return []
    turning = float(np.sign(arm))
    own_term = Term(f"{sign}·h_{{{name}}}", turning, ())
    solved = [term._replace(sign=-turning * term.sign) for term in terms]
    result = Quantity(sign, clean(value, study.forces.force_size(k)), "N")
    said = [tr("ΣM_p = {sum} = 0").format(sum=_sum([own_term, *terms])),
            _worked_out(solved, result, lambda total, last: total / last, float(mm(abs(arm))))]
    if by_moment:
        m = project.mechanism.crank
        found = Quantity(balancing_sign(project), clean(abs(moment), study.forces.moment_size(k)), "N*m")
        said.append(f"{equation(mul, (result, Quantity(f'l_{{{m.pivot}{m.pin}}}', m.length)), found)} {tr(SENSES[moment < 0])}")
    return said


def _terms(project: Project, total: Step, about: str = "") -> Iterator[Term]:
    """Terms of a sum of moments at the analysed position, without those that are nothing; ``about`` stands above their arms."""
    k, forces = project.force_index, project.study.forces
    letters = {id(load.vector): load.symbol for loads in forces.loads.values() for load in loads}
    letters |= {id(part): f"{symbol(name)}^τ" for name, part in forces.parts.items()}
    least = forces.moment_size(k)
    for at, vector, couple in zip(total.args[1::3], total.args[2::3], total.args[3::3], strict=True):
        if isinstance(vector, Step):
            force, length = abs(complex(vector.at(k))), float(forces.arm_about(total.args[0], at, vector).at(k))
            sign = letters.get(id(vector), symbol(vector.name)).replace(BAR, "")
            if np.isfinite(length) and not is_zero(force * length, least):  # a force of nothing has no arm
                yield Term(f"{sign}·{arm_sign(sign)}{about}", 1.0 if length > 0 else -1.0, (force, abs(length)))
        if isinstance(couple, Step) and not is_zero(value := float(couple.at(k)), least):
            yield Term(symbol(couple.symbol or couple.name).replace(BAR, ""), 1.0 if value > 0 else -1.0, (abs(value),))


def _sum(terms: Sequence[Term]) -> str:
    """Terms with their signs, in letters."""
    signs = (("−" if n == 0 else " − ") if term.sign < 0 else " + " if n else "" for n, term in enumerate(terms))
    return "".join(sign + term.letters for sign, term in zip(signs, terms, strict=True))


def _worked_out(terms: Sequence[Term], result: Quantity, of_sum: Callable[[Any, Any], Any] = lambda total, last: total,
                last: float = 1.0) -> str:
    """What a sum gives, in numbers; ``of_sum`` makes the whole formula of it and of a ``last`` number."""
    values = dict.fromkeys((*[value for term in terms for value in term.values], last))  # what is alike is written alike
    at = {value: Argument(n) for n, value in enumerate(values)}
    total: Any = Constant(0.0)
    for term in terms:
        product = reduce(mul, map(at.__getitem__, term.values))
        total = total + product if term.sign > 0 else total - product
    return equation(of_sum(total, at[last]), [Quantity("", value) for value in values], result, in_letters=False)
