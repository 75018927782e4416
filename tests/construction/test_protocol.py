"""The protocol: every step of the shaper's position 2 is a whole sentence with the right millimetres."""

import re

import numpy as np
import pytest

from tests import project_files as files
from tests.few import seldom
from tests.methods.linkage import truth
from tests.note.printed_formulas import equalities
from tests.sheets import equations
from tmm_sheets import catalogue, protocols
from tmm_sheets.construction import rules
from tmm_sheets.construction.protocol import sentence, sentences, sizes_of
from tmm_sheets.construction.scale import Scale
from tmm_sheets.construction.step import Plan, Rule, Step
from tmm_sheets.numbers import fixed
from tmm_sheets.project import Project

K = 2
SCALES = {"m": Scale("μ_l", 0.006, "м/мм"), "m/s": Scale("μ_V", 0.02, "м·с^{−1}/мм"), "m/s2": Scale("μ_a", 0.05, "м·с^{−2}/мм"),
          "N": Scale("μ_F", 40, "Н/мм")}


@pytest.fixture(scope="module")
def project():
    return files.project(files.from_file("lugansk/shaper"), files.NOMINAL)


@pytest.fixture(scope="module")
def plans(project):
    s = project.study
    found = [project.cycle.plan, s.positions.plan, s.velocities.plan, s.accelerations.plan, s.loads[2], s.forces.plan,
             *(p.plan for p in s.forces.plans.values()), s.lever.plan]
    # The force analysis adds its contact point to the position plan: everything is recorded before anything is said.
    assert s.forces.balancing is not None
    return {plan.name: plan for plan in found}


def said(plan):
    return list(sentences(plan, K, SCALES[plan.unit].mm))


def test_every_step_is_a_whole_sentence(plans):
    assert len(plans) == 12
    for name, plan in plans.items():
        told = said(plan)
        assert len(told) == len(plan.steps)
        for step, text in zip(plan, told, strict=True):
            assert re.search(r"[.]$", text), (name, text)
            plain = re.sub(r" \([\d,]+ мм\)| \(кориолисово\)", "", text)
            assert not re.search(r"[{}()]|nan|None|inf|  |: \.|= [.,;]", plain), text
            # The result is named, but for directions ("turn by 90 degrees") and arms, which are said of their force.
            assert step.name in text or step.rule.gives in ("direction", "length"), (name, step, text)
            # Russian numbers: decimal comma, true minus.
            assert not re.search(r"\d\.\d|-\d", text), text


@pytest.mark.parametrize(
    ("plan", "text"),
    [
        ("positions", "Из точки A радиусом 13,3 мм проведём окружность и под углом 126,0° отметим на ней точку B."),
        ("positions", "На прямой CB от точки C радиусом 94,3 мм сделаем засечку: точка D."),
        ("positions", "На прямой CB от точки C радиусом 47,2 мм сделаем засечку: точка S3."),
        ("positions",
         "Через точку D параллельно n5–n5 проведём прямую до пересечения с x–x в точке S5."),
        ("dead-positions", "Из точки C проведём касательную к окружности с центром A и радиусом 13,3 мм; точка касания B′."),
        ("velocities", "ω2 = −1,627."),
        ("loads", "Вес G5 = m·g = 80·9,81 = 784,8 Н, вниз."),
        ("force-5", "Замкнём план: F54 = |1–2|·μ_F = 2981,6 Н."),
        ("force-1", "Замкнём план: F10 = |4–1|·μ_F = 4085,1 Н."),
        ("moments", "Плечо h50 = 18,9 мм из уравнения моментов."),
    ],
)
def test_sentences(plans, plan, text):
    assert text in said(plans[plan])


def test_millimetres_of_the_velocity_and_acceleration_plans(project, plans):
    """Every segment is the length of the true vector in the scale of its plan."""
    z, v, a, omega3, epsilon3 = truth.shaper_motion(project.cycle.phi[K], project.mechanism.crank.omega)
    r = z["B"] + 0.26j
    speeds = {"b": v["B"], "b3": 1j * omega3 * r, "d": v["D"], "s3": v["S3"], "d5": v["S5"]}
    b3 = (1j * epsilon3 - omega3**2) * r
    pulls = {"πb": a["B"], "πb3": b3, "πn": -(omega3**2) * r, "bk": 2j * omega3 * (speeds["b3"] - v["B"]), "πd": a["D"],
             "πs3": a["S3"], "πd5": a["S5"], "nb3": 1j * epsilon3 * r, "dd5": a["S5"] - a["D"]}
    pulls["kb3"] = b3 - a["B"] - pulls["bk"]
    pairs = {f"p{letter}": z for letter, z in speeds.items()} | {"bb3": speeds["b3"] - v["B"], "dd5": v["S5"] - v["D"]}
    for name, mu, true in (("velocities", 0.02, pairs), ("accelerations", 0.05, pulls)):
        found = dict(m for text in said(plans[name]) for m in re.findall(r"\|(\w+)\| = ([\d,]+) мм", text))
        assert found == {letters: fixed(abs(vector) / mu, 1) for letters, vector in true.items()}


def test_lengths_laid_off_in_the_force_plans(project, plans):
    """Each force laid off is its newtons over the scale."""
    newtons = {f"{name}": step for name, step in project.study.forces.reactions.items()}
    compared = 0
    for name in ("force-5", "force-4", "force-3", "force-1"):
        for symbol, mm in (m for text in said(plans[name]) for m in re.findall(r"отложим (F\d\d) \(([\d,]+) мм\)", text)):
            assert mm == fixed(abs(newtons[symbol].at(K)) / 40, 1)
            compared += 1
    assert compared == 4


# --- arithmetic ------------------------------------------------------------------------------------------------------

NUMBER = r"(?:\((?:−?[\d,]+)\)|−?\d[\d,]*)"
STATED = (
    (r"Сложим ординаты ({n}) мм и ({n}) мм с их знаками: \S+ = ({n}) мм", lambda a, b, c: a + b - c),
    (r"Пересчитаем ординату ({n}) мм из масштаба μ_A = ({n}) .*μ_E = ({n}) .* = ({n}) мм", lambda a, b, c, d: a * b / c - d),
    (r"Ординату ({n}) мм графика J_II.* = ({n})·({n})²/\(2·({n})\): \S+ = ({n}) мм",
     lambda a, b, c, d, e: a * b * c**2 / 2 / d - e),
    (r" = ({n}) мм·({n}) Дж/мм = ({n}) Дж", lambda a, b, c: a * b - c),
    (r"От конца ординаты ({n}) мм отложим вниз ({n}) мм: остаётся \S+ = ({n}) мм", lambda a, b, c: a - b - c),
    (r"К ординате S ({n}) мм прибавим ординату S'' ({n}) мм: ордината \S+ = ({n}) мм", lambda a, b, c: a + b - c),
    (r"К радиусу ({n}) мм прибавим запас Δr = ({n}) мм: \S+ = ({n}) мм", lambda a, b, c: a + b - c),
    (r"площадью ({n}) мм² .*ширины ({n}) мм; его высота \S+ = ({n}) мм", lambda a, b, c: a - b * c),
    (r"Вес \S+ = m·g = ({n})·({n}) = ({n}) Н", lambda a, b, c: a * b - c),
    (r"Коэффициент перекрытия \S+ = ({n})° / ({n})° = ({n})", lambda a, b, c: a - b * c),
    (r"ω1 = ({n}) \+ ({n})·y = ({n}) рад/с", None),
)
"""Sentences that state a sum or a product, and what has to vanish."""


def read(text):
    """A printed number, and half a unit of its last place."""
    plain = text.strip("()").replace(",", ".").replace("−", "-")
    return float(plain), 0.5 * 10.0 ** -len(plain.partition(".")[2])


def holds(relation, texts):
    values, halves = zip(*map(read, texts), strict=True)
    rest = relation(*values)
    allowed = 0.0
    for i, half in enumerate(halves):
        moved = (*values[:i], values[i] + half, *values[i + 1:])
        allowed += abs(relation(*moved) - rest)
    return abs(rest) <= allowed * (1 + 1e-3) + 1e-9


@pytest.mark.parametrize("name", [
    "lugansk/shaper", seldom("lugansk/engine"), seldom("press"), seldom("sixbar/3:1"), seldom("transport/diesel@01-Т-27"),
    "lugansk/cam_flat", seldom("lugansk/cam_rocker")])
def test_the_arithmetic_of_all_sentences(name):
    """Every sum and product that a sentence states is right within the rounding of its numbers, signs included."""
    checked, ordinate, project = 0, "", Project(catalogue.read(name))
    for line in protocols.lines(project, None):
        if "измерим ординату y = " in line:
            ordinate = re.search(rf"y = ({NUMBER}) мм", line)[1]
        for wording, relation in STATED:
            found = re.search(wording.replace("{n}", NUMBER), line)
            if found and relation is not None:
                assert holds(relation, found.groups()), line
                checked += 1
            elif found:
                assert holds(lambda mean, mu, omega, y: mean + mu * y - omega, (*found.groups(), ordinate)), line
                checked += 1
    for plan in (plan for plans in project.plans.values() for plan in (plans or {}).values()):
        for step in (step for step in plan if not step.rule.wording and step.say is None):
            text = re.sub("[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+", lambda m: f"^{{{m[0].translate(LOWERED)}}}",
                          sentence(step, len(plan.labels) // 2, float, plan.unit, sizes_of(plan)))
            stated = [e for part in equations.read(text) for e in equalities(part)[0]]
            assert [e for e in stated if not e.holds] == [], text
            checked += len(stated)
    assert checked >= 10


LOWERED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789−")


def test_what_is_said_beside_a_couple_of_inertia():
    """M = -J eps: the sign of the moment is against that of the acceleration said before."""
    said = list(protocols.lines(Project(catalogue.read("lugansk/engine")), None))
    epsilon = {m[1]: read(m[2])[0] for line in said if (m := re.search(rf"ε(\d) = ({NUMBER}) рад/с²", line))}
    couples = {m[1]: read(m[2])[0] for line in said if (m := re.search(rf"Mи(\d) = −J·ε = ({NUMBER}) Н·м", line))}
    assert couples.keys() == {"2", "4"}
    assert all(couples[k] * epsilon[k] < 0 for k in couples)


def test_nothing_but_rounding_is_said_to_be_nothing():
    """At the dead position of the slotted link of 3:1 all accelerations and moments about its pivot vanish by symmetry."""
    v = catalogue.read("sixbar/3:1")
    for label in ("0", "12"):
        project = Project(v.model_copy(update={"cycle": v.cycle.model_copy(update={"force_position": label})}))
        said = "\n".join(protocols.lines(project, None))
        assert "со знаком ε3 = 0 рад/с²" in said
        assert re.search(r"dJ/dφ = tg ψ·μ_J/μ_φ = tg 0°·[\d,]+/[\d,]+ = 0 кг·м²", said)
        assert not re.search(r"0,0{7}|−0(?![\d,])|−0,0+(?!\d)", said)


# --- single steps ----------------------------------------------------------------------------------------------------


def test_the_wording_of_a_step_may_say_more_than_its_rule():
    plan = Plan("p", "План", "m")
    b = plan.add("B", rules.GIVEN, 3j, say="Отметим шарнир {name} кулисы.")
    assert sentence(b, 0, float) == "Отметим шарнир B кулисы."


def test_kinds_of_arguments():
    rule = Rule("r", lambda p, length, angle, n, v: v, ("point", "length", "angle", "number", "vector"), "vector",
                "{name}: {0} {1} {2} {3} {4} {value}")
    a, v = Step("A", rules.GIVEN, (0j,)), Step("v", rules.GIVEN, (np.array([3 + 4j, 6 + 8j]),))
    step = Step("R", rule, (a, 0.5, np.pi / 6, 0.25, v))
    assert sentence(step, 1, lambda x: 2 * x) == "R: A 1,0 мм 30,0° 0,25 v (20,0 мм) 20,0 мм"
    # An ordinate keeps its sign, a length has none; a negative number behind an arithmetic sign stands in parentheses.
    signed = Rule("r", lambda y, r, n: y, ("ordinate", "length", "number"), "ordinate", "{name} = {0} + {1}·{2} = {value}")
    assert sentence(Step("y", signed, (-3.0, -3.0, -2.0)), 0, lambda x: 2 * x) == "y = −6,0 мм + 6,0 мм·(−2) = −6,0 мм"
    # A plan nobody draws says its own unit.
    assert sentence(step, 1, float, "м/с") == "R: A 0,5 м/с 30,0° 0,25 v (10 м/с) 10 м/с"


def test_a_step_that_cannot_be_built_says_a_dash():
    length = Step("l", rules.DISTANCE, (0j, complex("nan")))
    assert sentence(length, 0, float) == "Измерим отрезок  = —."
