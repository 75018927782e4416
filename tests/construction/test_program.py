"""Programs of constructions: every rule can be written, in any language, and gives what its step gives."""

import importlib
import math
import pkgutil

import numpy as np
import pytest

import tmm_sheets
from tests.few import all_hold
from tmm_sheets.construction import arithmetic as ar, rules
from tmm_sheets.construction.expression import Operation, primitive
from tmm_sheets.construction.function import NARROW, Function, Replay, fill
from tmm_sheets.construction.program import GIVEN, NUMBER, REAL, Language, program, written
from tmm_sheets.construction.step import Given, GivenNumber, Rule, Step
from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.groups import two_links
from tmm_sheets.methods.linkage import forces, zhukovsky

ROOMS = ("tmm_sheets.construction", "tmm_sheets.mechanism", "tmm_sheets.methods.linkage", "tmm_sheets.methods.integration")
N = 40
COMPLEX = ("point", "direction", "vector", "force")
POINTS = ar.line_line, ar.arc_arc, ar.arc_line, ar.tangent_point, ar.tangent_direction


def modules():
    for info in pkgutil.walk_packages(tmm_sheets.__path__, "tmm_sheets."):
        if info.name.startswith(ROOMS) and not info.ispkg:
            yield importlib.import_module(info.name)


def rules_of(value):
    """A rule, or those of a table of steps."""
    return [v for row in value.values() for v in row if isinstance(v, Rule)] if isinstance(value, dict) and all(
        isinstance(row, tuple) for row in value.values()) else [value] if isinstance(value, Rule) else []


RULES = list({id(rule): rule for m in modules() for v in vars(m).values() for rule in rules_of(v)}.values())


def operations(tree):
    if isinstance(tree, Operation):
        yield tree
        for part in tree.parts:
            yield from operations(part)


def drawn(rng, kind):
    if kind == "direction":
        return np.exp(1j * rng.uniform(0, 6.3, N))
    if kind in COMPLEX:
        return rng.normal(size=N) + 1j * rng.normal(size=N)
    return rng.uniform(0.5, 2, N) if kind == "length" else rng.normal(size=N)


def rows(*values):
    return [Given(np.asarray(v), f"row {n}") for n, v in enumerate(values)]


def test_every_rule_of_a_linkage_is_a_formula_or_a_primitive():
    assert len(RULES) > 100
    assert [r.name for r in RULES if all(r.tree(n) is None for n in range(9))] == []


def test_every_operation_is_known():
    known = {*REAL, "complex", "conj", "abs", "re", "im", "square"}
    trees = [tree for r in RULES for n in range(9) if (tree := r.tree(n)) is not None]
    found = {o.name for tree in trees for o in operations(tree) if o.function is None}
    assert found <= known


PLAIN = [r for r in RULES if r.takes and r is not two_links.ALONG_TANGENT and r.tree(len(r.takes)) is not None
         and "curve" not in (*r.takes, r.gives)
         and all(o.function is None or o.function.primitive.plain for o in operations(r.tree(len(r.takes))))]


def test_a_rules_function_gives_its_value():
    """On arguments by chance, where they are well conditioned and where nothing can be drawn."""
    assert len(PLAIN) > 100
    all_hold(gives_its_value, PLAIN)


def gives_its_value(rule):
    rng = np.random.default_rng(7)
    args = rows(*(drawn(rng, kind) for kind in rule.takes))
    if rule is rules.UNDER or rule is rules.TURNED_BY:
        args = [*args[:-1], 0.7]  # the angle of a guide is one number
    step = Step("x", rule, tuple(args))
    (own,) = Replay([step], args)([a.value if isinstance(a, Given) else a for a in args])
    given = [a for a in args if isinstance(a, Given)]
    if not given:
        return
    found = Function({"x": step}, given)(*(a.value for a in given))["x"]
    np.testing.assert_array_equal(np.isnan(found), np.isnan(np.broadcast_to(own, N)))
    np.testing.assert_allclose(found, own, rtol=4e-14, atol=1e-14 * np.nanmax(np.abs(own)))


@pytest.mark.parametrize(("rule", "kinds"), [
    (forces.MOMENTS, ("point", "point", "force", "number", "point", "force", "number")),
    (zhukovsky.BALANCE, ("point", "point", "direction", "point", "force")),
    (two_links.ALONG_TANGENT, ("point", "point", "point", "length", "number"))])
def test_rules_of_more_arguments(rule, kinds):
    rng = np.random.default_rng(3)
    args = rows(*(drawn(rng, kind) for kind in kinds))
    step = Step("x", rule, tuple(args))
    with np.errstate(all="ignore"):
        found = Function({"x": step}, args)(*(a.value for a in args))["x"]
    np.testing.assert_allclose(found, step.value, rtol=1e-12)


@pytest.mark.parametrize("move", POINTS, ids=[f.primitive.name for f in POINTS])
def test_a_plain_formula_holds_where_its_guard_says_so(move):
    """Against the exact form, at crossings down to the sine that is relied on."""
    rng = np.random.default_rng(5)
    takes = next(r.takes for r in RULES if (t := r.tree(len(r.takes))) is not None and isinstance(t, Operation)
                 and t.name == move.primitive.name) if move is not ar.tangent_direction else rules.TANGENT.takes
    args = [rng.choice((1.0, -1.0), 2000) if kind == "number" else np.concatenate([drawn(rng, kind) for _ in range(2000 // N)])
            for kind in takes]
    with np.errstate(all="ignore"):
        guard, exact = move.primitive.guard(*args), move(*args)
        plain = move.primitive.plain(*args)
    relied = guard > NARROW**2
    assert relied.sum() > 200
    assert (~np.isnan(exact[relied])).all()
    size = np.max([np.abs(a[relied]) for a in args], axis=0) + np.abs(exact[relied])
    assert (np.abs(plain - exact)[relied] / size).max() < 2e-14
    assert relied[np.isnan(exact)].sum() == 0


class Scalars(Language):
    """The program of one position in plain Python: a second language, as a page would have it."""

    def name(self, number, value):
        if value.does == NUMBER:
            return repr(value.constant) if value.gives == "real" else f"things[{number}]"
        return f"inputs[{value.constant}]" if value.does == GIVEN else f"v{number}"

    def line(self, value, result, operands):
        a, *b = operands
        if value.does in "+-*/":
            return f"{result} = {a} {value.does} {b[0]}"
        if value.does in ("re", "im"):
            return f"{result} = ({a}).{'real' if value.does == 're' else 'imag'}"
        return f"{result} = {'-' if value.does == 'negative' else f'math.{value.does}'}({', '.join(operands)})"


def test_another_language():
    """A crank and two arcs, position by position."""
    phi = Given(np.linspace(0, 6, 25), "crank angles")
    b = Step("B", rules.LAY_OFF, (0j, 0.1, phi))
    c = Step("C", rules.ARC_ARC, (b, 0.35, 0.4 + 0j, 0.25, 1))
    p = program({"C": c}, [phi])
    names, lines = written(p, Scalars())
    for k, angle in enumerate(phi.value.tolist()):
        known = {"math": math, "inputs": [angle]}
        exec("\n".join(lines), known)
        x, y = (eval(names[i], known) for i in p.results["C"])
        assert abs(complex(x, y) - c.at(k)) < 1e-15


def test_chosen_givens():
    """Another crank, another rocker: what steps of those lengths would give; a length for each position as well."""
    phi = Given(np.linspace(0, 6, 25), "crank angles")

    def machine(crank, rocker):
        b = Step("B", rules.LAY_OFF, (0j, GivenNumber(crank, "crank.length"), phi))
        return Step("C", rules.ARC_ARC, (b, 0.35, 0.4 + 0j, GivenNumber(rocker, "group[1].lengths[1]"), 1))

    f = Function({"C": machine(0.1, 0.25)}, [phi], ("crank.length", "group[1].lengths[1]"))
    np.testing.assert_allclose(f(phi.value)["C"], machine(0.1, 0.25).value, rtol=1e-14)
    other = f(phi.value, given={"crank.length": 0.12, "group[1].lengths[1]": 0.3})["C"]
    np.testing.assert_allclose(other, machine(0.12, 0.3).value, rtol=1e-14)
    lengths = np.linspace(0.05, 0.4, 25)  # the longest do not turn round
    each = f(phi.value, given={"crank.length": lengths})["C"]
    np.testing.assert_allclose(each, [machine(r, 0.25).at(k) for k, r in enumerate(lengths)], rtol=1e-14)
    assert 0 < np.isnan(each).sum() < 25


def test_a_given_that_nothing_is_made_of_is_refused():
    phi = Given(np.zeros(3), "crank angles")
    step = Step("B", rules.LAY_OFF, (0j, GivenNumber(0.1, "crank.length"), phi))
    with pytest.raises(CannotBuild, match=r"crank\.size"):
        Function({"B": step}, [phi], ("crank.size",))


def test_a_rule_without_a_formula_is_refused_by_its_name():
    branching = Rule("branches", lambda x: x if np.all(x > 0) else -x, ("number",), "number", "")
    phi = Given(np.zeros(3), "crank angles")
    with pytest.raises(CannotBuild, match='"branches"'):
        Function({"B": Step("B", branching, (phi,))}, [phi])


def test_arithmetic_on_a_table_is_refused():
    phi = Given(np.zeros(3), "crank angles")
    table = Given(np.arange(5.0), "table", over="curve")
    with pytest.raises(CannotBuild, match="table"):
        Function({"B": Step("B", Rule("sum", lambda x, y: x + y, (), "number", ""), (phi, table))}, [phi])


def test_a_primitive_is_called_by_name():
    @primitive("steps of one", "real")
    def floors(x):
        return np.floor(x)

    phi = Given(np.linspace(0, 5, 9), "crank angles")
    step = Step("x", Rule("floors", lambda x: 2 * floors(x), ("number",), "number", ""), (phi,))
    f = Function({"x": step}, [phi])
    assert list(f.program.primitives) == ["steps of one"]
    np.testing.assert_array_equal(f(phi.value)["x"], step.value)


def test_the_same_structure_is_compiled_once():
    phi = Given(np.zeros(3), "crank angles")
    texts = {Function({"B": Step("B", rules.LAY_OFF, (0j, length, phi))}, [phi]).source.text for length in (0.1, 0.2, 7.5)}
    assert len(texts) == 1


def test_fill_leaves_what_is_known():
    phi = Given(np.linspace(0, 1, 5), "crank angles")
    b = Step("B", rules.LAY_OFF, (1j, 0.1, phi))
    ray, still = Step("AB", rules.RAY, (0j, b)), Step("A", rules.GIVEN, (0j,))
    fill([ray, still], 5)
    assert (ray.evaluated, b.evaluated, still.evaluated) == (True, False, False)
    np.testing.assert_allclose(ray.value, b.value / np.abs(b.value), rtol=1e-15)


def test_no_guards_no_positions_no_results():
    phi = Given(np.zeros(0), "crank angles")
    f = Function({"B": Step("B", rules.LAY_OFF, (0j, 0.1, phi))}, [phi])
    assert f(np.zeros(0))["B"].shape == (0,)
    assert Function({}, [phi])(np.zeros(3)) == {}
