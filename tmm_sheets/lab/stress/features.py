"""Scenes of whole project files whose features are mixed at random, against the powers of everything that moves.

Lever and force plans share the forces of inertia: where these are wrong both are. What they cannot share is the change of the
kinetic energy, and what is known without them: the constant moment where the crank runs as its flywheel lets it, the work of a
force over strokes of known length.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import acos, asin, cos, sin, sqrt
from typing import Any

import numpy as np

from tmm_sheets.construction.step import value_of
from tmm_sheets.lab.stress.invariants import Residual, State, cross, dot, energy, powers, slopes
from tmm_sheets.methods.linkage.forces import InputForce
from tmm_sheets.project import Project
from tmm_sheets.task.variant import parse

Draw = Callable[[float, float], float]


@dataclass(frozen=True)
class Body:
    """A mechanism on the crank AB: its tables; the stroke of link 3, rad where it ``turns``, else m.

    ``sliding`` tells how fast its block slides, m/s; ``input`` the place of link 3 as an input beside a middle of its stroke, rad
    of the crank, m.
    """

    tables: str
    way: float
    sliding: Callable[[State], Any] = lambda s: 0.0
    input: Callable[[float], float] = float
    turns: bool = True


def _slider(r: float, draw: Draw) -> Body:
    rod, off = r * draw(2.5, 5), r * draw(-0.6, 0.6)
    tables = f"""[points]
A = ["0 m", "0 m"]
[[guide]]
name = "x"
through = ["0 m", "{off} m"]
[[group]]
kind = 2
links = ["2", "3"]
outer = ["B"]
inner = "C"
length = "{rod} m"
guide = "x"
"""
    return Body(tables, sqrt((rod + r) ** 2 - off**2) - sqrt((rod - r) ** 2 - off**2), lambda s: np.abs(s.v["C"]),
                lambda turned: sqrt(rod**2 - (off - r * cos(turned)) ** 2) - r * sin(turned), turns=False)


def _rocker(r: float, draw: Draw) -> Body:
    rod, out, base = (r * draw(2.5, 3) for _ in range(3))
    tables = f"""[points]
A = ["0 m", "0 m"]
D = ["{base} m", "0 m"]
[[group]]
kind = 1
links = ["2", "3"]
outer = ["B", "D"]
inner = "C"
lengths = ["{rod} m", "{out} m"]
"""
    near, far = (acos((base**2 + out**2 - (rod + sign * r) ** 2) / (2 * base * out)) for sign in (-1, 1))
    return Body(tables, far - near)


def _slotted(r: float, draw: Draw) -> Body:
    base = r * draw(1.5, 4)
    tables = f"""[points]
A = ["0 m", "0 m"]
D = ["0 m", "{-base} m"]
[[group]]
kind = 3
links = ["2", "3"]
outer = ["B", "D"]
[[point]]
name = "C"
link = "3"
from = "D"
towards = "B"
distance = "{base * draw(0.5, 2)} m"
"""
    return Body(tables, 2 * asin(r / base), lambda s: np.abs(dot(s.v["B"], s.u["3"])),
                lambda turned: sqrt(r**2 + base**2 + 2 * r * base * sin(turned)))


@dataclass(frozen=True)
class Features:
    """A project file with what is known of it: ``work`` of its load over the cycle, J, its friction (``journal`` in m)."""

    project: Project
    body: Body
    work: float
    journal: float
    guide: float


def drawn(rng: np.random.Generator, given: str, running: str) -> Features:
    """A project file with any mixture of features: driven by an input or not (empty), its crank's angular acceleration."""
    def draw(low: float, high: float) -> float:
        return float(rng.uniform(low, high))

    def one_of(*values: Any) -> Any:
        return values[int(rng.integers(len(values)))]

    r = draw(0.05, 0.2)
    body = (_slider if given == "slider" else _slotted if given == "cylinder" else one_of(_slider, _rocker, _slotted))(r, draw)
    turning, sliding = (0.0, 0.0) if given else one_of((0.0, 0.0), (0.1, 0.0), (0.0, 0.1), (0.1, 0.1))
    turns, stroke, drives, load = one_of(1, 2), one_of("working", "both"), one_of(-1, 1), draw(100, 1000)
    text = f'''schema = 1
[project]
name = "own/features"
title = "-"
sheets = ["kinematics_forces"]
[crank]
link = "1"
pivot = "A"
pin = "B"
length = "{r} m"
{"" if given else f"""angular_acceleration = "{running}"
speed = "{draw(5, 20)} rad/s"
sense = "{one_of("clockwise", "counter-clockwise")}" """}
{body.tables}
[[point]]
name = "S1"
link = "1"
from = "A"
towards = "B"
distance = "{r * draw(0.3, 2)} m"
angle = "{draw(-180, 180)} deg"
[forces]
gravity = "{one_of(0.0, 9.81)} m/s2"
'''
    for link, centre in (("1", one_of("A", "B", "S1")), ("2", "B"), ("3", "C")):
        text += f'[[link]]\nname = "{link}"\nmass = "{draw(1, 20)} kg"\ncentre = "{centre}"\ninertia = "{draw(0, 0.2)} kg m2"\n'
    if given:
        ends = [body.input(draw(low, high)) for low, high in ((-1, -0.3), (0.3, 1))][::drives]
        text += f'''[input]
link = "3"
start = "{ends[0]} m"
end = "{ends[1]} m"
speed = "{draw(0.1, 1)} m/s"
acceleration = "{draw(-2, 2)} m/s2"
side = -1
[[force]]
name = "F1"
link = "1"
point = "B"
direction = "{draw(0, 360)} deg"
value = "{load} N"
[cycle]
start = "input"
positions = 6
[balancing]
kind = "input force"
name = "Fb"
'''
        return Features(Project(parse(text, "features.toml")), body, 0.0, 0.0, 0.0)
    way = "along" if drives > 0 else "against"
    at = '[[moment]]\nname = "M3"' if body.turns else '[[force]]\nname = "F3"\npoint = "C"\nsense = "+x"'
    text += f'''{at}
link = "3"
direction = "{way} motion"
stroke = "{stroke}"
value = "{load} {"N m" if body.turns else "N"}"
[cycle]
start = "{draw(0, 360)} deg"
positions = 8
turns = {turns}
[flywheel]
method = "{one_of("wittenbauer", "mertsalov")}"
delta = {draw(0.02, 0.1)}
density = "7300 kg/m3"
width_ratio = 0.2
thickness_ratio = 0.12
weights = {one_of("true", "false")}
[balancing]
'''
    text += one_of('kind = "moment"\nname = "Mb"\n', f'kind = "gear force"\nname = "Fg"\nmodule = "5 mm"\nteeth = 40\n'
                   f'pressure_angle = "20 deg"\nmate = "{draw(-180, 180)} deg"\n')
    text += one_of("", f'[flywheel.motor]\nname = "M"\npower = "15 kW"\nsynchronous = "1000 rpm"\nrated = "975 rpm"\n'
                   f'efficiency = 0.9\nrotor_inertia = "{draw(0, 0.002)} kg m2"\n')
    if turning or sliding:
        radii = f'radii = {{ A = "{r / 4} m", B = "{r / 4} m" }}\n' if turning else ""
        text += f"[friction]\nturning = {turning}\nsliding = {sliding}\n{radii}"
    work = drives * load * body.way * (1 if stroke == "working" else 2) * turns
    return Features(Project(parse(text, "features.toml")), body, work, turning * r / 4, float(np.sin(np.arctan(sliding))))


def features(rng: np.random.Generator, make: Callable[..., State]) -> Iterator[Residual]:
    """Projects whose crank runs as the flywheel lets it, evenly or as given, and as an input drives it."""
    even = "0 rad/s2" if rng.random() < 0.5 else f"{rng.uniform(-40, 40)} rad/s2"
    for given, running in (("", "flywheel"), ("", even), (str(rng.choice(("slider", "cylinder"))), "")):
        yield from balance(drawn(rng, given, running), make)


def balance(of: Features, make: Callable[..., State]) -> Iterator[Residual]:
    """Every power of a project against the change of its energy, position by position and over the cycle."""
    project, study = of.project, of.project.study
    m = study.mechanism
    s = make(m, value_of(study.cycle.angles(study.turned)))
    omega = s.omega["1"]
    drive, uneven = m.drive, study.running is not None
    added = 0.0 if not uneven else max(project.flywheel.J_flywheel, 0.0) + project.flywheel.J_rotor

    other, slope = slopes(s, np.arange(len(s.phi)), 0.01)
    kinetic = energy(s)[0] + added * omega**2 / 2
    rate = drive.acceleration / drive.speed if drive else study.accelerations.epsilon["1"].value / omega
    change = slope(energy(other)[0]) * omega + 2 * kinetic * rate
    loads, couples, _ = study.loads
    loaded = sum((dot(s.spread(x.vector), s.spread(study.velocities.points[x.at.name])) for of_link in loads.values()
                  for x in of_link if x.role == "applied"), 0.0)
    loaded = loaded + sum(s.spread(x) * s.omega["3"] for x in couples.get("3", ()) if x.name == "M3")
    weights = -sum(project.gravity * link.mass * s.v[str(link.centre)].imag for link in m.links.values())
    size = {name: np.abs(s.spread(step)) for name, step in study.forces.reactions.items()}
    lost = of.journal * (size["F10"] * np.abs(omega) + size["F21"] * np.abs(s.omega["2"] - omega))
    lost = lost + of.guide * (size["F32"] if of.body.turns else size["F30"]) * of.body.sliding(s)
    driving = _driving(of, s)
    scale = np.abs(driving) + np.abs(loaded) + np.abs(weights) + lost + np.abs(2 * kinetic * rate) + powers(s)
    yield "power of a project = change of its energy", np.abs(driving + loaded + weights - lost - change) / scale
    if drive is not None:
        return
    wheel = project.flywheel
    done = float(wheel.area_plan["M"].value) * project.cycle.period
    yield "energy over the turn", np.array([abs(done + of.work) / abs(of.work)])
    if uneven:
        assert project.variant.flywheel is not None
        constant = float(wheel.driving_plan["M"].value) * np.abs(omega)
        beside = lost - (0.0 if project.variant.flywheel.weights else weights)
        yield "moment of an uneven crank is constant", np.abs(driving - beside - constant) / scale


def _driving(of: Features, s: State) -> Any:
    """Power of what drives, by the force plans, W."""
    study, driver = of.project.study, of.project.driver
    found = s.spread(study.forces.balancing)
    if isinstance(driver, InputForce):
        drive = driver.drive
        ahead = np.sign(drive.place[1] - drive.place[0]) * drive.speed
        return dot(found, s.u["3"] if of.body.turns else 1.0 + 0j) * ahead
    return (found if driver is None else cross(driver.radius * np.exp(1j * driver.mate), found)) * s.omega["1"]
