"""One student's project: every plan, diagram and profile as a lazy property; nothing is imported before it is asked for."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from tmm_sheets.errors import CannotBuild, together
from tmm_sheets.task.variant import LINKAGE as LINKAGE, PARTS as PARTS, Variant
from tmm_sheets.words import marked, tell

if TYPE_CHECKING:
    from tmm_sheets.construction.step import Plan, SearchCount
    from tmm_sheets.mechanism.groups.three_legs import Course
    from tmm_sheets.mechanism.groups.triad import TriadGroup
    from tmm_sheets.mechanism.model import Mechanism
    from tmm_sheets.methods.cams.cam_profile import Cam
    from tmm_sheets.methods.flywheel.flywheel import Flywheel
    from tmm_sheets.methods.flywheel.reduced import Reduced
    from tmm_sheets.methods.gears.gear_pair import GearPair
    from tmm_sheets.methods.gears.reducer import Reducer
    from tmm_sheets.methods.gears.train import Train
    from tmm_sheets.methods.linkage.checks import DeadPosition, SwingLimits
    from tmm_sheets.methods.linkage.cycle import Cycle
    from tmm_sheets.methods.linkage.forces import GearForce, InputForce
    from tmm_sheets.methods.linkage.friction import Coefficients
    from tmm_sheets.methods.linkage.loads import Loads
    from tmm_sheets.methods.linkage.positions import Passages
    from tmm_sheets.methods.linkage.study import Motion, Study
    from tmm_sheets.methods.linkage.synthesis import Synthesis
    from tmm_sheets.task.assembly import Givens
    from tmm_sheets.task.units import Printed


PLANNED = ("synthesis", "cycle", "driver", "applied", "study", "motion", "reduced", "flywheel", "reducer", "gear", "train", "cam")
"""Parts of a project that construct something, each with its ``plans``."""


class Project:
    """A task with its numbers; the methods are run when somebody reads their results."""

    def __init__(self, variant: Variant) -> None:
        self.variant = variant
        self.shown = set[int]()
        """Numbers of the sheets whose steps are made."""
        self.arranged = dict[int, Any]()
        """Arrangements of the sheets with their views in place, by number (:mod:`tmm_sheets.sheets.composition`)."""
        self.expected = dict[Any, Any]()
        """What is read with the figures of the sheets and needs room there: forms of equations, enlarged details."""

    @property
    def sheets(self) -> tuple[str, ...]:
        """Names of the sheets' arrangements, in order."""
        return self.variant.sheets

    def on_sheets(self, names: Sequence[str]) -> Project:
        """The project on sheets of these arrangements: what it has found stays found."""
        other, v = copy(self), self.variant
        other.variant = v.model_copy(update={"project": v.project.model_copy(update={"sheets": list(names)})})
        other.shown, other.arranged = set(), {}
        return other

    @property
    def parts(self) -> tuple[str, ...]:
        """What the project has results and views of, by the tables of its file; forces where something loads its links."""
        return self.variant.parts

    @property
    def balancing(self) -> str:
        """Name of the force or moment that drives the crank, or the input: a moment on the crank where the file does not tell."""
        given = self.variant.balancing
        return given.name if given is not None else "Mур" if self.variant.input is None else "Fур"

    @property
    def diagrams(self) -> tuple[str, ...]:
        """Points and links whose motion is drawn over the crank angle: those named, the output, or what the last group drives.

        Of an output that does not slide on the frame the link that carries it.

        Raises
        ------
        CannotBuild
            when there is no [cycle].
        """
        cycle = self._section("cycle")
        if cycle.diagrams:
            return tuple(cycle.diagrams)
        m = self.mechanism
        driven = [g for g in m.groups if g.inner == cycle.output] if cycle.output else m.groups
        if not driven:
            return (cycle.output,) if cycle.output else ()
        g = driven[-1]
        if len(g.links) > 2:
            # Of several legs the last one that is held in the frame; the link that they carry where none is.
            held = {link: pair for pair in m.pairs for link in pair.links if link in g.links and m.frame in pair.links}
            last = next((link for link in reversed(g.links) if link in held), g.links[0])
            return (held[last].name.rstrip("′″") if last in held and held[last].motion == "translation" else last,)
        slides = any(point == g.inner and m.guides[guide].link == m.frame for point, guide in g.kind.guided(g))
        return (str(g.inner) if slides else g.links[1],)

    def _section(self, name: str) -> Any:
        section = getattr(self.variant, name)
        if section is None:
            raise CannotBuild(
                tell("the project has no [{name}]").format(name=name),
                tell("add the table [{name}] to the project file or leave its sheet out").format(name=name),
            )
        return section

    @property
    def given(self) -> tuple[Printed, ...]:
        """Quantities as the task prints them; none where the file does not say."""
        from tmm_sheets.task import units

        return tuple(units.printed(self.variant.given))

    @cached_property
    def mechanism(self) -> Mechanism:
        """Links, pairs and Assur groups."""
        from tmm_sheets.task.assembly import mechanism_of

        return mechanism_of(self.variant, self.synthesis if self.variant.synthesis is not None else None)

    def way_of_assembly(self, g: TriadGroup) -> Course:
        """Ways of assembly of a group of class III, and the one that is taken, round the turn."""
        import numpy as np

        from tmm_sheets.methods.linkage.positions import FOLLOWED, position_plan

        return position_plan(self.mechanism, np.array([g.when]), purpose=FOLLOWED, until=g).course(g)

    @cached_property
    def synthesis(self) -> Synthesis:
        """Lengths found from conditions.

        Raises
        ------
        CannotBuild
            when there is no [synthesis].
        """
        from tmm_sheets.methods.linkage.synthesis import Synthesis
        from tmm_sheets.task.assembly import points_of_synthesis

        crank = self.variant.crank
        return Synthesis(self._section("synthesis"), (crank.speed or 0.0) if crank is not None else 0.0,
                         points_of_synthesis(self.variant))

    @cached_property
    def cycle(self) -> Cycle:
        """Numbered positions of one turn.

        Raises
        ------
        CannotBuild
            when there is no [cycle], or the mechanism has none of this form.
        """
        from tmm_sheets.methods.linkage.numbering import dead_cycle, even_cycle, swing_cycle

        c = self._section("cycle")
        if c.start == "input":
            from tmm_sheets.methods.linkage.drive import input_cycle

            return input_cycle(self.mechanism, c.positions, zero=c.zero)
        if c.end is not None:
            return swing_cycle(self.mechanism, c.start, c.end, c.positions, zero=c.zero, extra=c.extra)
        if c.start == "dead":
            k = c.coefficient if c.division == "nominal" else None
            return dead_cycle(self.mechanism, c.output, c.working_sense, c.working, c.idle, k, c.turns)
        return even_cycle(self.mechanism, c.start, c.positions, zero=c.zero, turns=c.turns, extra=c.extra, output=c.output,
                          working_sense=c.working_sense)

    def parts_of_cycle(self, count: int) -> Any:
        """Angles turned from position 0, rad, at ``count`` places equally far apart; both ends of a swing or a stroke are such."""
        import numpy as np

        cycle = self.cycle
        if self.mechanism.drive is not None and count > 1:
            from tmm_sheets.methods.linkage.drive import input_cycle

            return input_cycle(self.mechanism, count - 1).turned
        return (cycle.period / max(count - 1, 1) if cycle.swings else cycle.period / count) * np.arange(count)

    @cached_property
    def applied(self) -> Loads:
        """Technological forces and moments."""
        from tmm_sheets.task.assembly import applied_of

        return applied_of(self.variant, self.mechanism, self.cycle)

    def abscissae(self, turned: Any) -> Any:
        """What graphs are plotted over: angles that the crank has turned, rad, or behind an input how far that has gone then, m.

        Over the angle the link that an input turns would have nothing but straight lines.
        """
        if self.mechanism.drive is None:
            return turned
        from tmm_sheets.methods.linkage.drive import places_of

        here, first = (places_of(self.mechanism, self.cycle.world(angle)) for angle in (turned, 0.0))
        return abs(here - first)

    @cached_property
    def driver(self) -> GearForce | InputForce | None:
        """Gear force on the crank shaft, or force on an input; None when a pure moment balances the crank."""
        from tmm_sheets.methods.linkage.forces import GearForce, InputForce

        if self.mechanism.drive is not None:
            return InputForce(self.balancing, self.mechanism.drive)
        b: Any = self.variant.balancing
        if b is None or b.kind == "moment":
            return None
        of = self._givens
        return GearForce.of_gear(b.name, of.number(b.module, "m", "m", "balancing", "module"),
                                 of.number(b.teeth, "z_1", "", "balancing", "teeth"),
                                 of.number(b.pressure_angle, "α", "rad", "balancing", "pressure_angle"),
                                 of.number(b.mate, "", "rad", "balancing", "mate"))

    @cached_property
    def friction(self) -> Coefficients | None:
        """Coefficients of friction and radii of journals; None when the pairs have no friction."""
        f = self.variant.friction
        if f is None:
            return None
        from tmm_sheets.methods.linkage.friction import Coefficients

        of = self._givens
        return Coefficients(of.number(f.turning, "f_{t}", "", "friction", "turning"),
                            of.number(f.sliding, "f_{s}", "", "friction", "sliding"),
                            {name: of.number(r, f"r_{{{name}}}", "m", "friction", "radii", name) for name, r in f.radii.items()})

    @property
    def gravity(self) -> float:
        """Free fall, m/s2."""
        return self._givens.number(self.variant.forces.gravity, "g", "m/s2", "forces", "gravity")

    @property
    def _givens(self) -> Givens:
        from tmm_sheets.task.assembly import Givens

        return Givens(self.variant)

    @cached_property
    def study(self) -> Study:
        """Kinematics and forces at the numbered positions; raises :class:`CannotBuild` when they do not all assemble."""
        _ = self.dead_positions
        return self.study_at(self.cycle.turned, self.cycle.labels, "")

    def study_at(self, turned: Any, labels: tuple[str, ...], purpose: str = marked("curves between the positions")) -> Study:
        """Kinematics and forces at any crank angles (rad turned from position 0); ``purpose`` is empty for what is told itself.

        Raises
        ------
        CannotBuild
            when the angle does not tell how the links stand.
        """
        from tmm_sheets.methods.linkage.checks import check_followed
        from tmm_sheets.methods.linkage.study import Study

        check_followed(self.mechanism, self.cycle)
        crank = self.variant.crank
        uneven = crank is not None and crank.angular_acceleration == "flywheel"
        return Study(self.mechanism, self.cycle, turned, labels, self.gravity, lambda: self.applied, self.driver,
                     (lambda: self.flywheel) if uneven else None, purpose, self.friction)

    @cached_property
    def motion(self) -> Motion:
        """Motion of the outputs for the kinematic diagrams."""
        from tmm_sheets.methods.linkage.study import Motion

        return Motion(self.study, self.study_at)

    @cached_property
    def course(self) -> Study:
        """The study over the whole cycle, close together; at a dead point, where the load is switched, twice: curves end there."""
        import numpy as np

        edges = [0.0, *(b for b in self.reduced.breaks if 0 < b < self.cycle.period), self.cycle.period]
        turned = self.motion.turned
        every = np.concatenate([np.concatenate(([a + 1e-9], turned[(turned > a + 1e-6) & (turned < b - 1e-6)], [b - 1e-9]))
                                for a, b in pairwise(edges)])
        return self.study_at(every, tuple(["" for _ in every]))

    @cached_property
    def force_index(self) -> int:
        """Number of the position of the force analysis, the highlighted plan: the first unless told.

        Not one in a change point, where reactions grow beyond all bounds, unless told either.

        Raises
        ------
        CannotBuild
            when there is no [cycle], or no position of the label it names.
        """
        told = self._section("cycle").force_position
        if told is None and self.variant.loaded:
            return int(self._change_points.within(self.cycle.phi).argmin())
        return self.cycle.index(told or self.cycle.labels[0], "[cycle] force_position: ")

    @property
    def _change_points(self) -> Passages:
        from tmm_sheets.methods.linkage.positions import Passages

        return Passages(self.mechanism)

    @property
    def turning_back(self) -> dict[str, list[float]]:
        """Crank angles, degrees from 0 to 360, at which links of groups turn back at once, by the groups' names."""
        import numpy as np

        found = {g.name: self._change_points.angles(g) for g in self.mechanism.groups if not g.follow}
        return {name: sorted((np.degrees(angles).round(1) % 360).tolist()) for name, angles in found.items() if angles}

    @cached_property
    def unbounded(self) -> bool:
        """True where reactions grow beyond all bounds at the position of the force analysis."""
        k = self.force_index
        return bool(self._change_points.within(self.cycle.phi)[k]) and not bool(self.study.forces.bounded()[k])

    def check_forces(self) -> None:
        """Look whether the position of the force analysis has reactions.

        Raises
        ------
        CannotBuild
            when they grow beyond all bounds there, as in a change point.
        """
        if self.unbounded:
            k, bounded = self.force_index, self.study.forces.bounded()
            labels = self.cycle.labels
            said = tell("position {label}: reactions grow beyond all bounds, links that carry them lie in one line; no force plan "
                        "can be drawn there").format(label=labels[k])
            others = [label for label, there in zip(labels, bounded, strict=True) if there]
            hint = tell('take another position for the forces in [cycle], for example force_position = "{label}"')
            raise CannotBuild("\n".join((said, *map(str, self.dead_positions))), hint.format(label=others[0]) if others else "")

    @cached_property
    def reduced(self) -> Reduced:
        """Reduced moment and reduced moment of inertia."""
        study = self.study  # assembled all round the turn
        from tmm_sheets.methods.flywheel.reduced import Reduced

        f = self.variant.flywheel
        gravity = self.gravity if f is not None and f.weights else 0.0
        return Reduced(self.mechanism, self.cycle, self.applied, gravity, lambda: study.velocities)

    @cached_property
    def flywheel(self) -> Flywheel:
        """Flywheel by the energy-mass curve.

        Raises
        ------
        CannotBuild
            when nothing loads the links, or none of them has a mass.
        """
        if not self.applied:
            raise CannotBuild(
                tell("a flywheel needs a technological force or moment"), tell("add [[force]] or [[moment]] to the project file")
            )
        from tmm_sheets.methods.flywheel.wheel_methods import flywheel

        if self.cycle.swings:
            raise CannotBuild(tell("a crank that only swings has no flywheel: no cycle in which its energy comes back"),
                              tell("leave [flywheel] and its sheet out"))
        return flywheel(self.reduced, self._section("flywheel"))

    @cached_property
    def gear(self) -> GearPair:
        """Gear pair.

        Raises
        ------
        CannotBuild
            when there is no [gear], or with everything that forbids the pair.
        """
        from tmm_sheets.methods.gears.gear_pair import gear_pair, settled

        section = self._section("gear")
        return gear_pair(settled(section, self.reducer if section.teeth == "reducer" else None))

    @cached_property
    def reducer(self) -> Reducer:
        """Planetary reducer: the chosen tooth numbers with everything that follows.

        Raises
        ------
        CannotBuild
            when there is no [reducer], or no tooth numbers meet its conditions.
        """
        from tmm_sheets.methods.gears.reducer import reducer

        return reducer(self._section("reducer"))

    @cached_property
    def train(self) -> Train:
        """Train of gears with given speeds.

        Raises
        ------
        CannotBuild
            when there is no [train], or its speeds or tooth numbers do not fit.
        """
        from tmm_sheets.methods.gears.train import train

        return train(self._section("train"))

    @cached_property
    def cam(self) -> Cam:
        """Cam and follower.

        Raises
        ------
        CannotBuild
            when there is no [cam], or none can be built from it.
        """
        from tmm_sheets.methods.cams.cam_profile import cam

        return cam(self._section("cam"))

    @property
    def made(self) -> tuple[str, ...]:
        """Parts that somebody has asked for."""
        made = vars(self)
        return tuple(part for part in self.parts if part in (vars(made.get("study", self)) if part in LINKAGE else made))

    @property
    def plans(self) -> dict[str, dict[str, Plan] | None]:
        """Plans of every part by their names, in the order of construction; None for a part that nobody has asked for."""
        made = vars(self)
        return {part: _plans_of(made[part]) if part in made else None for part in PLANNED}

    @property
    def searches(self) -> tuple[SearchCount, ...]:
        """What was looked for with plans that nobody draws, and how many it took."""
        return tuple(self.mechanism.searches.values()) if "mechanism" in vars(self) else ()

    def check(self) -> None:
        """Assemble everything the project describes; raises :class:`CannotBuild` naming what fails, where and by how much."""
        refused: dict[str, CannotBuild] = {}
        for part in self.parts:
            try:
                if part == "positions":
                    _ = self.study, self.force_index
                    for name in self.diagrams:
                        _ = self.motion.link(name) if name in self.mechanism.links else self.motion.point(name)
                elif part == "forces" and "positions" not in refused:
                    _ = self.applied
                    if self.friction is not None:
                        _ = self.study.forces  # it may jam
                    self.check_forces()
                elif part == "cam":
                    self.cam.check()
                elif part in ("gear", "reducer", "train"):
                    getattr(self, part)
            except CannotBuild as e:
                refused[part] = e
        if refused:
            raise together(refused, "built", others=False)

    @cached_property
    def swing_limits(self) -> SwingLimits | None:
        """How far a crank that only swings could go; None for one that turns round, or goes as far as an input drives it."""
        from tmm_sheets.methods.linkage.checks import swing_limits

        return swing_limits(self.mechanism, self.cycle) if self.cycle.swings and self.mechanism.drive is None else None

    @cached_property
    def dead_positions(self) -> tuple[DeadPosition, ...]:
        """Assemble the mechanism all round the turn; the groups that pass a dead position on the way."""
        from tmm_sheets.methods.linkage.checks import check_assembly

        return check_assembly(self.mechanism, self.cycle)


def _plans_of(made: Any) -> dict[str, Plan]:
    """Plans of a part that was made; none of one that turns out not to be buildable: whoever asks for its results is told."""
    try:
        return dict(getattr(made, "plans", {}))
    except CannotBuild:
        return {}
