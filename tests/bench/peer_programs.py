"""The mechanisms of the comparison in terms of pylinkage, kinepy and mechanism, through their documented interfaces.

Positions of turning pairs are compared, and the velocities and accelerations the programs give for them. Lengths stand here a
second time, as users of those programs would write them; the truth that judges the results takes them from the mechanism itself.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib import import_module, metadata
from itertools import product
from math import pi
from typing import Any

import numpy as np
import numpy.typing as npt
from mpmath import mp

from tmm_sheets import quoting
from tmm_sheets.errors import CannotBuild
from tmm_sheets.lab.bench import truth
from tmm_sheets.mechanism.model import Mechanism

PointArrays = dict[str, Any]
"""Complex arrays by the name of a point: positions, velocities or accelerations, one for each crank angle."""
Runs = dict[str, Callable[[], PointArrays]]
"""A run for each quantity."""


@dataclass(frozen=True)
class Turn:
    """One turn of the crank in ``n`` equal steps from 0; ``angles`` in rad, without the closing one."""

    n: int
    angles: npt.NDArray[np.float64]

    @property
    def step(self) -> float:
        """Angle between two positions, rad."""
        return 2 * pi / self.n


class PeerProgram(ABC):
    """A program that moves linkages.

    Raises
    ------
    CannotBuild
        On construction, when it is not installed.
    """

    name = ""

    @abstractmethod
    def prepare(self, mechanism: str, m: Mechanism, turn: Turn) -> Runs:
        """Set a mechanism up for one turn of the crank; a run for each quantity the program gives.

        Raises
        ------
        CannotBuild
            With the reason, when the program cannot express the mechanism.
        """


def _library(name: str) -> Any:
    try:
        return import_module(name)
    except ImportError as e:
        if e.name == name:
            raise CannotBuild(f"not installed: {quoting.install('peers')}") from None
        raise


def _version(name: str) -> str:
    try:
        return f"{name} {metadata.version(name)}"
    except metadata.PackageNotFoundError:
        return name


# --- pylinkage --------------------------------------------------------------------------------------------------------


class Pylinkage(PeerProgram):
    """pylinkage steps from position to position, compiled if numba is installed."""

    name = _version("pylinkage")

    def __init__(self) -> None:
        self.library = _library("pylinkage")
        self.compiled = self.library._numba_compat.HAS_NUMBA and not import_module("numba").config.DISABLE_JIT
        self.name += " + numba" if self.compiled else ""

    def prepare(self, mechanism: str, m: Mechanism, turn: Turn) -> Runs:
        """Components of the mechanism one step before the turn begins, and a run for each quantity.

        Raises
        ------
        CannotBuild
            when the library has no such groups.
        """
        with mp.workdps(30):
            before = truth.state(m, mp.mpf(-m.crank.sense * turn.step)).points
        at = {k: complex(z) for k, z in before.items()}
        components = self._components(mechanism, m, turn, at)
        linkage = import_module("pylinkage.simulation").Linkage(list(components.values()))
        linkage.set_input_velocity(components[m.crank.pin], m.crank.omega)
        start = [(at[k].real, at[k].imag) for k in components]

        def run(which: int) -> PointArrays:
            linkage.set_coords(start)
            if self.compiled:
                found = linkage.step_fast_with_kinematics(turn.n)[which] if which else linkage.step_fast(turn.n)
            elif which:
                found = np.array([step[which] for step in linkage.step_with_derivatives(turn.n)], dtype=float)
            else:
                found = np.array(list(linkage.step(turn.n)), dtype=float)
            return {k: found[:, i, 0] + 1j * found[:, i, 1] for i, k in enumerate(components)}

        return {quantity: partial(run, k) for k, quantity in enumerate(("positions", "velocities", "accelerations"))}

    @staticmethod
    def _components(mechanism: str, m: Mechanism, turn: Turn, at: dict[str, complex]) -> PointArrays:
        """Components by the names of their points; ``at`` has their places, to which those the guides pass through are added."""
        ground, dyads = import_module("pylinkage.components").Ground, import_module("pylinkage.dyads")
        c, found = m.crank, {k: ground(z.real, z.imag, name=k) for k, z in m.fixed.items()}
        found[c.pin] = import_module("pylinkage.actuators").Crank(
            found[c.pivot], c.length, angular_velocity=c.sense * turn.step, initial_angle=-c.sense * turn.step, name=c.pin)

        def here(name: str) -> dict[str, Any]:
            return {"x": at[name].real, "y": at[name].imag, "name": name}

        def slider(name: str, pivot: str, rod: float, height: float) -> None:
            at["left"], at["right"] = height * 1j, 1 + height * 1j
            found["left"], found["right"] = ground(0.0, height, name="left"), ground(1.0, height, name="right")
            found[name] = dyads.RRPDyad(found[pivot], found["left"], found["right"], rod, **here(name))

        if mechanism == "six-bar shaper":
            raise CannotBuild("no component for a line that keeps its direction through a moving point, as the ram's slot")
        if mechanism == "slider-crank":
            slider("C", "B", 0.35, -0.02)
            return found
        found["C"] = dyads.RRRDyad(found["B"], found["D"], 0.35, 0.25, **here("C"))
        if mechanism == "six-bar":
            found["E"] = dyads.FixedDyad(found["D"], found["C"], 0.4, 0.0, name="E")
            slider("F", "E", 0.5, 0.3)
        elif mechanism == "six-bar with a turning guide":
            found["F"] = dyads.RRPDyad(found["E"], found["D"], found["C"], 0.25, **here("F"))
        return found


# --- kinepy -----------------------------------------------------------------------------------------------------------


class Kinepy(PeerProgram):
    """kinepy solves all positions at once; its own tool takes differences of them for velocities and accelerations."""

    name = _version("kinepy")

    def __init__(self) -> None:
        self.library = _library("kinepy")
        self.units, self.tools = import_module("kinepy.units"), import_module("kinepy.tools")

    def prepare(self, mechanism: str, m: Mechanism, turn: Turn) -> Runs:
        """Solids and joints in metres, and a run for each quantity."""
        self.units.set_unit_system(self.units.SI)
        system = self.library.System()
        motor, points = self._solids(mechanism, m, system)
        system.pilot(motor)
        system.compile()
        self._choose_signs(system, m, points)
        # Forward differences lack the last position, second differences the last two.
        angles = m.crank.sense * turn.step * np.arange(turn.n + 2)
        time = (turn.n + 1) * turn.step / m.crank.speed

        def run(order: int) -> PointArrays:
            system.solve_kinematics(angles if order else angles[:turn.n])
            found = {}
            for k, point in points.items():
                value = point()
                # Its second_derivative squares a wrong step; the first derivative is taken twice instead.
                for quantity in (self.units.LENGTH, self.units.SPEED)[:order]:
                    value = self.tools.derivative(value, time, phy=quantity)
                found[k] = value[0, :turn.n] + 1j * value[1, :turn.n]
            return found

        return {quantity: partial(run, k) for k, quantity in enumerate(("positions", "velocities", "accelerations"))}

    @staticmethod
    def _choose_signs(system: Any, m: Mechanism, points: dict[str, Callable[[], Any]]) -> None:
        """Choose the signs that assemble the mechanism as it is given; which sign means which side varies from run to run."""
        with mp.workdps(30):
            goal = {k: complex(z) for k, z in truth.state(m, mp.mpf(0)).points.items()}
        off: dict[tuple[int, ...], float] = {}
        count: int = len(system._object.signs)
        for signs in product((1, -1), repeat=count):
            system.change_signs(list(signs))
            system.solve_kinematics(np.zeros(1))
            off[signs] = sum(abs(complex(*point()[:, 0]) - goal[k]) for k, point in points.items())
        best = min(off, key=lambda tried: (off[tried] != off[tried], off[tried]))  # what does not assemble is NaN
        system.change_signs(list(best))

    @staticmethod
    def _solids(mechanism: str, m: Mechanism, s: Any) -> tuple[Any, dict[str, Callable[[], Any]]]:
        """The driven joint, and for each point a function that gives its coordinates."""
        crank, two, three = s.add_solid("1"), s.add_solid("2"), s.add_solid("3")
        motor = s.add_revolute(s.ground, crank)
        joints = {"B": s.add_revolute(crank, two, (m.crank.length, 0.0))}
        points: dict[str, Callable[[], Any]] = {}
        if mechanism == "slider-crank":
            joints["C"] = s.add_revolute(two, three, (0.35, 0.0))
            s.add_prismatic(s.ground, three, d1=-0.02)
        elif mechanism != "four-bar":
            four, five = s.add_solid("4"), s.add_solid("5")
        if mechanism == "six-bar shaper":
            s.add_prismatic(two, three)
            s.add_revolute(s.ground, three, (0.0, -0.26))
            joints["D"] = s.add_revolute(three, four, (0.566, 0.0))
            s.add_prismatic(four, five, pi / 2, 0.0, pi / 2, 0.0)
            s.add_prismatic(s.ground, five, d1=0.33)
            points["S5"] = lambda: five.origin
        elif mechanism != "slider-crank":
            joints["C"] = s.add_revolute(two, three, (0.35, 0.0), (0.25, 0.0))
            s.add_revolute(s.ground, three, (0.4, 0.0))
        if mechanism == "six-bar":
            joints["E"] = s.add_revolute(three, four, (0.4, 0.0))
            joints["F"] = s.add_revolute(four, five, (0.5, 0.0))
            s.add_prismatic(s.ground, five, d1=0.3)
        elif mechanism == "six-bar with a turning guide":
            s.add_revolute(s.ground, four, (0.55, 0.0))
            joints["F"] = s.add_revolute(four, five, (0.25, 0.0))
            s.add_prismatic(three, five)
        return motor, {**{k: partial(getattr, joint, "point") for k, joint in joints.items()}, **points}


# --- mechanism --------------------------------------------------------------------------------------------------------


class Loops(PeerProgram):
    """mechanism closes vector loops by iteration, position by position, with scipy's fsolve."""

    name = _version("mechanism")

    def __init__(self) -> None:
        self.library = _library("mechanism")

    def prepare(self, mechanism: str, m: Mechanism, turn: Turn) -> Runs:
        """Vectors and loops, and a run for each quantity."""
        angles = m.crank.sense * turn.angles
        speeds, zeros = np.full(turn.n, m.crank.omega), np.zeros(turn.n)

        def run(quantity: str, motion: Any, joints: dict[str, Any]) -> PointArrays:
            motion.iterate()
            return {k: getattr(joint, f"x_{quantity}") + 1j * getattr(joint, f"y_{quantity}") for k, joint in joints.items()}

        runs: Runs = {}
        for order, quantity in enumerate(("positions", "velocities", "accelerations")):
            vectors, joints, loops, guess = self._model(mechanism, m)
            motion = self.library.Mechanism(
                vectors=vectors, origin=joints[m.crank.pivot], loops=loops, pos=angles, vel=speeds if order else None,
                acc=zeros if order > 1 else None, guess=(guess, np.ones(len(guess)), np.ones(len(guess))))
            runs[quantity] = partial(run, quantity, motion, joints)
        return runs

    def _model(self, mechanism: str, m: Mechanism) -> tuple[list[Any], dict[str, Any], Callable[..., Any], Any]:
        """Vectors, joints, loop equations and a guess of the unknowns at the first position."""
        joints = {k: self.library.Joint(k) for k in "ABCDEFGO"}
        vectors: list[Any] = []

        def vector(ends: str, r: float | None = None, theta: float | None = None) -> Any:
            vectors.append(self.library.Vector(joints=(joints[ends[0]], joints[ends[1]]), r=r, theta=theta))
            return vectors[-1]

        crank = vector("AB", m.crank.length)
        if mechanism == "slider-crank":
            rod, slide, foot = vector("BC", 0.35), vector("OC", theta=0.0), vector("AO", 0.02, -pi / 2)

            def loops(x: Any, i: Any) -> Any:
                return crank(i) + rod(x[0]) - slide(x[1]) - foot()

            guess = [0.0, 0.45]
        elif mechanism == "six-bar shaper":
            frame, slot, rocker = vector("AC", 0.26, -pi / 2), vector("CB"), vector("CD", 0.566)
            ram_slot, rise, ram = vector("DE", theta=pi / 2), vector("CO", 0.59, pi / 2), vector("OE", theta=0.0)

            def loops(x: Any, i: Any) -> Any:
                first = frame() + slot(x[0], x[1]) - crank(i)
                return np.concatenate((first, rocker(x[1]) + ram_slot(x[2]) - ram(x[3]) - rise()))

            guess = [0.27, 1.27, 0.05, 0.17]
            joints["S5"] = joints["E"]
        else:
            coupler, rocker, frame = vector("BC", 0.35), vector("DC", 0.25), vector("AD", 0.4, 0.0)

            def four_bar(x: Any, i: Any) -> Any:
                return crank(i) + coupler(x[0]) - rocker(x[1]) - frame()

            loops, guess = four_bar, [0.78, 1.77]
        if mechanism == "six-bar":
            arm, rod, slide, rise = vector("DE", 0.4), vector("EF", 0.5), vector("OF", theta=0.0), vector("DO", 0.3, pi / 2)

            def loops(x: Any, i: Any) -> Any:
                return np.concatenate((four_bar(x, i), arm(x[1]) + rod(x[2]) - slide(x[3]) - rise()))

            guess = [*guess, -0.19, 0.41]
        elif mechanism == "six-bar with a turning guide":
            slide, rod, base = vector("DF"), vector("EF", 0.25), vector("DE", 0.15, 0.0)

            def loops(x: Any, i: Any) -> Any:
                return np.concatenate((four_bar(x, i), slide(x[2], x[1]) - base() - rod(x[3])))

            guess = [*guess, 0.17, 2.4]
        used = {joint for v in vectors for joint in v.joints}
        return vectors, {k: joint for k, joint in joints.items() if joint in used}, loops, np.array(guess)


PROGRAMS: tuple[type[PeerProgram], ...] = (Pylinkage, Kinepy, Loops)
