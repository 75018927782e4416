"""Results of a project as numbers: the tree that ``solve`` writes as JSON. Nothing is drawn, only what is asked is computed.

SI units; only ``gear``, ``reducer`` and ``train`` in millimetres. World frame: x right, y up, origin at the crank pivot, angles
counter-clockwise.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from tmm_sheets.construction.step import Part, Plan, Reported, Step, part_of, value_of
from tmm_sheets.errors import BadInput, CannotBuild, together
from tmm_sheets.numbers import Sizes, clean, in_a_row, listed
from tmm_sheets.project import LINKAGE, Project
from tmm_sheets.result_files import leaves, plain_numbers, row
from tmm_sheets.words import tell, tell_n

if TYPE_CHECKING:
    from tmm_sheets.methods.linkage.friction import Friction
    from tmm_sheets.methods.linkage.study import Study

SCHEMA = 1
"""Version of the tree; raised when a key changes its meaning."""


def assemble(
    project: Project, parts: Iterable[str] | None, *, phi: tuple[float, ...] | None = None, positions: int | None = None,
    refused: dict[str, CannotBuild] | None = None,
) -> dict[str, Any]:
    """The results tree in plain numbers; see :func:`told`."""
    return plain_numbers(told(project, parts, phi=phi, positions=positions, refused=refused))  # type: ignore[no-any-return]


def told(
    project: Project, parts: Iterable[str] | None, *, phi: tuple[float, ...] | None = None, positions: int | None = None,
    refused: dict[str, CannotBuild] | None = None,
) -> dict[str, Any]:
    """The results tree, whose numbers are the steps they come from (:class:`~tmm_sheets.construction.step.Told`).

    Parameters
    ----------
    project
        the project.
    parts
        names of its parts (see :attr:`Project.parts`), or "scales" of its plans; None for all it has.
    phi
        crank angles in the world frame, rad; by default the project's numbered positions.
    positions
        that many equal parts of the cycle instead, from position 0 on in the sense of rotation.
    refused
        takes the parts that cannot be computed with the reasons; the tree then has the others, and the reasons as ``not_computed``.

    Raises
    ------
    BadInput
        when a part is asked for that the project does not have.
    CannotBuild
        when a part cannot be computed and there is no ``refused`` to take it, or nothing else was asked for.
    """
    asked = _asked(project, parts)
    tree: dict[str, Any] = {
        "schema": SCHEMA, "project": project.variant.project.name, "variant": project.variant.project.variant,
    }  # fmt: skip
    lost: dict[str, CannotBuild] = {}
    scales: dict[str, Any] = {}
    if set(asked) & {*LINKAGE, "flywheel"}:
        m = project.mechanism
        groups = [{"links": list(g.links), "class": g.kind.grade, "order": g.kind.order, "kind": g.kind.number} for g in m.groups]
        tree["structure"] = {"W": m.mobility, "class": m.grade, "groups": groups, "formula": m.structure}
    linkage = [name for name in LINKAGE if name in asked]
    if linkage:
        _put_linkage(project, tree, linkage, _study(project, phi, positions, linkage, lost), lost)
    plans = set(linkage or project.parts) & set(LINKAGE) - {"forces", *lost}
    if plans and (parts is None or "scales" in asked):  # a sheet is arranged for them
        with _noting_losses(lost, "scales"):
            scales |= _drawn_scales(project, plans, by_angle=phi is not None or positions is not None)
    for name in ("flywheel", "gear", "reducer", "train", "cam"):
        if name in asked:
            with _noting_losses(lost, name):
                tree[name] = _flywheel(project, scales) if name == "flywheel" else getattr(project, name).results()
    if scales:
        tree["scales"] = scales
    if lost:
        if refused is None or lost.keys() >= set(asked):
            raise together(lost, "computed", others=False)
        refused |= lost
        tree["not_computed"] = {name: str(reason) for name, reason in lost.items()}
    return tree


def _asked(project: Project, parts: Iterable[str] | None) -> tuple[str, ...]:
    """Parts that are asked for: of a project, all unless told; BadInput names one that it does not have."""
    there = project.parts
    asked = there if parts is None else tuple(parts)
    for part in asked:
        if part not in (*there, "scales"):
            raise BadInput(
                tell('{project} has no part "{part}"').format(project=project.variant.called, part=part),
                hint=tell("it has {parts}").format(parts=", ".join(there)),
            )
    return asked


@contextmanager
def _noting_losses(lost: dict[str, CannotBuild], *parts: str) -> Iterator[None]:
    """Note that parts cannot be computed, and go on with the others."""
    try:
        yield
    except CannotBuild as e:
        lost |= dict.fromkeys(parts, e)


def _put_linkage(project: Project, tree: dict[str, Any], asked: list[str], found: tuple[Study, list[int]] | None,
                 lost: dict[str, CannotBuild]) -> None:
    """Kinematics and forces, with the condition of the plans they come from."""
    if found is None:
        return
    study, chosen = found
    angle, crank = study.positions.angle, study.mechanism.crank.link
    tree["cycle"] = {
        "labels": list(study.labels),
        "phi": Reported(angle) if isinstance(angle, Step) else study.positions.phi,
        "omega1": Reported(study.velocities.omega[crank]),
        "epsilon1": Reported(study.accelerations.epsilon[crank]),
        **({} if study.mechanism.drive is None else {"input": Reported(study.place_of_input)}),
    }
    for name in asked:
        with _noting_losses(lost, name):
            tree[name] = _section(project, study, name, chosen)
    there = [name for name in asked if name not in lost]
    if len(study.labels) > MANY:
        _evaluate_together(study, tree, there)
    tree["condition"] = _condition(study, there, chosen)


MANY = 4096
"""Positions from which on all is computed by one function, and nothing but what is told is kept."""


def _evaluate_together(study: Study, tree: dict[str, Any], asked: list[str]) -> None:
    """Evaluate what is told, and the condition of its plans, by one function; a rule without a formula is left to its step."""
    from tmm_sheets.construction import condition, function
    parts = {key: tree[key] for key in ("cycle", *asked)}
    told = [value.step for _, value in leaves(parts) if hasattr(value, "step")]
    plans = [plan for name in asked for plan in _plans_of(study, name)]
    with suppress(CannotBuild):
        function.fill([*told, *(step for plan in plans for step in condition.steps(plan).values())], len(study.labels))


def swept(project: Project, parts: Iterable[str], name: str, values: Sequence[float], phi: tuple[float, ...]) -> dict[
        str, tuple[Step, Any]]:
    """Results of the linkage for other values of a given number, all crank angles of one value after those of another.

    One function gives them, which the project as it is proves: the first of the values is its own, and not among the results.

    Raises
    ------
    CannotBuild
        when nothing is made of a given of that name, or what the project has under it is found and not given.
    """
    import numpy as np

    from tmm_sheets.construction.function import Function
    from tmm_sheets.construction.program import rows_of

    known = told(project, parts, phi=phi)
    steps = {path: x for path, x in leaves({part: known[part] for part in parts}) if isinstance(x, Reported)}
    rows = rows_of([x.step for x in steps.values()], len(phi))
    function = Function({path: x.step for path, x in steps.items()}, rows, [name])
    own, *several = [function(*map(value_of, rows), given={name: value}) for value in values]
    if not all(np.allclose(own[path], x.step.value, rtol=1e-9, equal_nan=True) for path, x in steps.items()):
        raise CannotBuild(tell("{name}: the file does not give this number, it is found").format(name=name))
    return {path: (x.step, part_of(np.concatenate([found[path] for found in several]), x.part)) for path, x in steps.items()}


def _plans_of(study: Study, part: str) -> list[Plan]:
    """The plans whose crossings tell the condition of a part."""
    return [fp.plan for fp in study.forces.plans.values()] if part == "forces" else [getattr(study, part).plan]


def _drawn_scales(project: Project, plans: set[str], *, by_angle: bool) -> dict[str, Any]:
    """Scale factors the sheets draw these plans with; none where one asked angle by angle, or its forces, cannot be drawn."""
    from tmm_sheets.sheets import composition

    try:
        found = composition.scales(project, plans)
    except CannotBuild:
        if by_angle or project.unbounded:
            return {}
        raise
    return {symbol: {"value": scale.mu, "unit": _latin(scale.unit), "where": f"sheet {sheet}"}
            for symbol, (scale, sheet) in found.items()}


def _latin(unit: str) -> str:
    """Unit of a scale factor as the results write it: the sheets have it in Russian."""
    for russian, latin in (("рад", "rad"), ("Дж", "J"), ("кг", "kg"), ("мм", "mm"), ("Н", "N"), ("м", "m"), ("с", "s"),
                           ("²", "2"), ("·", "*")):  # fmt: skip
        unit = unit.replace(russian, latin)
    return unit


def remarks(project: Project, tree: dict[str, Any]) -> list[str]:
    """What has to be said beside the numbers: groups that turn back at once in a change point, and what is not defined there."""
    if "cycle" not in tree and "flywheel" not in tree:
        return []
    told: list[str] = []
    with suppress(CannotBuild):  # angles that are asked for may be reached where the whole turn is not
        told += map(str, project.dead_positions)
    for name in (part for part in LINKAGE if part in tree):
        labels = tree[name].get("label", tree["cycle"]["labels"])
        lost = [labels[k] for k in _undefined(tree[name].get("reactions", tree[name]), len(labels))]
        if lost:
            shown = ", ".join(lost[:MOST]) + (" .." if len(lost) > MOST else "")
            if name == "forces":
                said = tell_n("position {labels}: reactions grow beyond all bounds (null), links that carry them lie in one line",
                              "positions {labels}: reactions grow beyond all bounds (null), links that carry them lie in one line",
                              len(lost))
            else:
                said = tell_n("position {labels}: {part} not defined (null)", "positions {labels}: {part} not defined (null)",
                              len(lost))
            told.append(said.format(labels=shown, part=name))
    return told


MOST = 8
"""Most positions that are named in a message."""


def _undefined(table: dict[str, Any], count: int) -> list[int]:
    """Positions at which some quantity of a table has no value."""
    import numpy as np

    lost = np.zeros(count, dtype=bool)
    for _, value in leaves(table):
        numbers = row(value)
        if numbers is not None and len(numbers) == count:
            lost |= ~np.isfinite(numbers).reshape(count, -1).all(axis=1)
    return [int(k) for k in np.flatnonzero(lost)]


def listing(tree: dict[str, Any]) -> str:
    """The tree as plain text for people: a heading for each part, a line for each quantity, six significant digits."""
    lines = []
    for key, value in tree.items():
        if key == "not_computed":
            continue  # that is a message, not a result
        if isinstance(value, dict):
            lines += ["", f"[{key}]", *_rows(value, "")]
        else:
            lines.append(f"{key}: {value}")
    return "\n".join(lines)


NATURAL = {"difference_percent": 100.0, "pressure_angle": 1.0}
"""Natural magnitude of quantities that may be nothing but rounding throughout: percent, rad."""


def _rows(table: dict[str, Any], prefix: str, alike: Sizes | None = None) -> Iterable[str]:
    """A line for each entry; ``alike`` is the size of quantities of the same kind."""
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _rows(value, f"{prefix}{key}.", _alike(table, key))
        else:
            yield f"{prefix}{key} = {_short(_without_rounding(key, value, alike))}"


def _alike(table: dict[str, Any], key: str) -> Sizes | None:
    """Size of quantities of the kind of ``table[key]``: of its own rows; forces and moments are compared with all reactions."""
    forces = [table[k] for k in ("reactions", "couples", "balancing") if k in table]
    of = forces if forces and key != "arms" else [table[key]]
    rows = [v for found in of for v in found.values() if isinstance(v, list)]
    return _sizes(rows) if rows else None


def _sizes(rows: list[Any]) -> Sizes:
    return Sizes([_largest(x) for x in v] if isinstance(v, list) else v for v in rows)


def _without_rounding(key: str, value: Any, alike: Sizes | None) -> Any:
    """A row with zeros where its numbers are nothing but rounding beside those of the same kind."""
    if not (isinstance(value, list) and value and isinstance(value[0], float | list)):
        return value

    def cleaned(v: Any, kind: float) -> Any:
        return [cleaned(x, kind) for x in v] if isinstance(v, list) else clean(v, kind) if isinstance(v, float) else v

    kind = _sizes([NATURAL[key]]) if key in NATURAL else alike or _sizes([value])
    return [cleaned(v, kind.at(i)) for i, v in enumerate(value)]


def _largest(value: Any) -> float:
    """Greatest magnitude in nested lists; 0.0 where there is no number."""
    if isinstance(value, list):
        return max(map(_largest, value), default=0.0)
    return abs(value) if isinstance(value, float) else 0.0


def _short(value: Any) -> str:
    if isinstance(value, list):
        if value and isinstance(value[0], dict):
            return "; ".join(map(_short, value))
        inner = [_short(v) for v in (value if len(value) <= 24 else [*value[:12], "...", *value[-2:]])]
        return f"({in_a_row(inner)})" if value and isinstance(value[0], float) and len(value) == 2 else " ".join(inner)
    if isinstance(value, dict):
        return ", ".join(f"{k} {_short(v)}" for k, v in value.items())
    if value is None:
        return "-"
    return listed(value) if isinstance(value, float) else str(value)


# --- parts ----------------------------------------------------------------------------------------------------------


def _study(project: Project, phi: tuple[float, ...] | None, positions: int | None, asked: list[str],
           lost: dict[str, CannotBuild]) -> tuple[Study, list[int]] | None:
    """Linkage at the angles asked for, and the positions the forces are told for; None when it does not assemble."""
    import numpy as np

    with _noting_losses(lost, *asked):
        if phi is None and positions is None:
            return project.study, [project.force_index]
        cycle = project.cycle
        turned: Any = (project.parts_of_cycle(positions) if positions is not None else
                       cycle.sense * (np.asarray(phi, dtype=float) - cycle.start))
        return project.study_at(turned, tuple(str(i) for i in range(len(turned))), ""), list(range(len(turned)))
    return None
@dataclass(frozen=True)
class Spread(Reported):
    """A step told for some of ``count`` positions, all unless ``rows`` says which; the same for each where it depends on none."""

    count: int = 1
    rows: tuple[int, ...] | None = None

    @property
    def value(self) -> Any:
        """The numbers, one entry for each position."""
        import numpy as np

        spread = np.broadcast_to(super().value, (self.count,))
        return spread if self.rows is None else spread[list(self.rows)]


def _all(study: Study, steps: Mapping[str, Step], part: Part = "") -> dict[str, Reported]:
    return {name: Spread(step, part, (), len(study.labels)) for name, step in steps.items()}


_MOTION: dict[str, Callable[[Study], dict[str, Mapping[str, Step]]]] = {
    "positions": lambda s: {"points": s.positions.points, "angles": s.positions.directions,
                            "special": {name: special.step for name, special in s.positions.special.items()}},
    "velocities": lambda s: {"points": s.velocities.points, "omega": s.velocities.omega, "sliding": s.sliding.velocities,
                             "special": s.velocities.special},
    "accelerations": lambda s: {"points": s.accelerations.points, "epsilon": s.accelerations.epsilon,
                                "coriolis": s.sliding.coriolis, "special": s.accelerations.special},
}
"""Steps of the parts of a linkage that are told of points and links; of those at the end there may be none."""


def _section(project: Project, study: Study, name: str, chosen: list[int]) -> dict[str, Any]:
    """A part of the linkage in the tree: points and links without those of the frame."""
    if name == "forces":
        return _forces(project, study, chosen)
    return {key: _all(study, {name: step for name, step in steps.items() if name != study.mechanism.frame} if key in (
        "omega", "epsilon") else steps, "angle" if key == "angles" else "") for key, steps in _MOTION[name](study).items()
        if steps or key not in ("special", "sliding", "coriolis")}


def _forces(project: Project, study: Study, chosen: list[int]) -> dict[str, Any]:
    f, lever, balance = study.forces, study.lever, study.balance
    labels = tuple(study.labels[k] for k in chosen)
    rows = None if len(chosen) == len(study.labels) else tuple(chosen)

    def told(step: Step | None, part: Part = "") -> Any:
        return None if step is None else Spread(step, part, labels, len(study.labels), rows)

    return {
        "label": list(labels),
        "reactions": {name: told(step) for name, step in f.reactions.items()},
        "couples": {name: told(step) for name, step in f.couples.items()},
        **({"couple_points": f.couple_points} if f.couples else {}),
        "arms": {name: told(step, "abs") for name, step in f.arms.items()},
        "balancing": {
            "kind": "moment" if study.driver is None else "force",
            "name": project.balancing,
            "kinetostatics": told(f.balancing if lever.line is None else balance["along"]),
            "lever": told(lever.balancing),
            "difference_percent": told(balance["Δ"]),
        },
        **({"friction": _friction(f.friction, told)} if f.friction is not None else {}),
    }


def _friction(of: Friction, told: Callable[..., Any]) -> dict[str, Any]:
    """Friction in the pairs: circles and moments of the turning ones, deviations of the sliding ones, powers of all."""
    return {
        "approximations": of.power_plan["n"],
        "radii": dict(of.radii),
        "moments": {f"M{index}": told(step) for index, step in of.moments.items()},
        "deviations": {f"F{index}": told(of.deviations[index]) for index in of.sliding},
        "powers": {index: told(step) for index, step in of.powers.items()},
        "power": told(of.total),
        "on_crank": told(of.on_crank),
    }


def _condition(study: Study, asked: list[str], chosen: list[int]) -> dict[str, Any]:
    """Condition number of each plan, the worst of its crossings, at each position; of forces at those they are told for."""
    from tmm_sheets.construction import condition

    found = {name: condition.of_plans(_plans_of(study, name), len(study.labels)) for name in asked}
    if "forces" in found:
        found["forces"] = found["forces"][chosen]
    return found


def _flywheel(project: Project, scales: dict[str, Any]) -> dict[str, Any]:
    f = project.flywheel
    for symbol, scale in (("mu_phi", f.scales.angle), ("mu_F", f.scales.force), ("mu_M", f.scales.moment),
                          ("mu_A", f.scales.work), ("mu_E", f.scales.energy), ("mu_dE", f.scales.excess),
                          ("mu_J", f.scales.inertia)):  # fmt: skip
        if scale is not None:
            scales[symbol] = {"value": scale.mu, "unit": _latin(scale.unit), "where": "flywheel"}
    return f.results()
