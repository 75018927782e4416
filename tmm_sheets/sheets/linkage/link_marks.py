"""How links look: bars, blocks and guides of a mechanism in one position."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tmm_sheets.construction.step import Step
from tmm_sheets.drawing import symbols
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box, Points
from tmm_sheets.sheets.components import listed
from tmm_sheets.sheets.player import PlayerStage, once
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.mechanism.groups.contexts import Outline
    from tmm_sheets.mechanism.model import Mechanism
    from tmm_sheets.methods.linkage.positions import Positions
    from tmm_sheets.project import Project


@dataclass(frozen=True)
class Shape:
    """What is drawn for one link: a bar through points, or a block at a point along a direction.

    ``over`` are the points of blocks that slide along the bar, which reaches to them; ``arms`` are further lines by the names
    of their ends: guides of the link that do not lie along its bar. ``carried`` is, for a block with a slot of its own, the
    point of the slider block in it and the slot's direction.
    """

    link: str
    bar: tuple[str, ...] = ()
    block: str | None = None
    along: Step | None = None
    slot: Step | None = None
    over: tuple[str, ...] = ()
    arms: tuple[tuple[str, str], ...] = ()
    carried: tuple[str, Step] | None = None

    @property
    def ends(self) -> tuple[str, str]:
        """Points whose line tells the direction of a bar: its ends, or foot and slider block of a rocker beside its pivot."""
        return (self.bar[0], self.bar[-1]) if len(self.bar) > 1 else (self.arms[1][0], self.arms[1][1])


@once
def shapes(pos: Positions) -> list[Shape]:
    """Shapes of all links, crank first."""
    m, c = pos.mechanism, pos.mechanism.crank
    return [_bar(m, c.link, (c.pivot, c.pin)), *(_shape(pos, outline) for g in m.groups for outline in g.kind.outlines(pos, g))]


def _shape(pos: Positions, o: Outline) -> Shape:
    if o.bar:
        shape = _bar(pos.mechanism, o.link, o.bar, o.aim)
        return replace(shape, bar=(*shape.bar, *_far_centre(pos, shape)), arms=(*o.arms, *shape.arms))
    return Shape(o.link, block=o.block, along=o.along, slot=o.slot, carried=_carried(pos, o.link) if o.slotted else None)


def _bar(m: Mechanism, link: str, base: tuple[str, ...], aim: str | None = None) -> Shape:
    """A link through its hinges, the points its guides start from and those that are traced; ``aim``: its line passes there too."""
    guides = [g for g in m.guides.values() if g.link == link]
    hinges = [p.name for p in m.points if p.link == link and any(p.name in g.outer for g in m.groups)]
    starts = [p.name for p in m.points if p.link == link and any(p.name == g.through for g in guides)]
    bar = tuple(dict.fromkeys((*base, *hinges, *starts, *traced(m, link))))
    over, arms = [], []
    for guide in guides:
        along = not guide.direction and guide.through in base and guide.towards in (*base, aim)
        for point in (point for g in m.groups for point, name in g.kind.guided(g) if name == guide.name):
            over += [point] * along
            arms += [(str(guide.through), point)] * (not along)
    return Shape(link, bar, over=tuple(over), arms=tuple(arms))


def centres(m: Mechanism) -> set[str]:
    """Centres of mass that nothing hangs on."""
    used = {name for g in m.groups for name in g.outer} | {guide.through for guide in m.guides.values()}
    return {p.name for p in m.points} & {link.centre for link in m.links.values()} - used


def _far_centre(pos: Positions, shape: Shape) -> tuple[str, ...]:
    """The centre of mass of a link that lies beyond all its other points: a link reaches to the farthest of them."""
    m, base = pos.mechanism, np.asarray(pos.points[shape.bar[0]].value)
    name = m.links[shape.link].centre
    if name not in centres(m) or name in shape.bar:
        return ()
    others = [float(np.nanmax(np.abs(np.asarray(pos.points[p].value) - base)))
              for p in (*shape.bar, *shape.over, *(end for arm in shape.arms for end in arm))]
    return (name,) if np.nanmin(np.abs(np.asarray(pos.points[name].value) - base)) > max(others) else ()


@once
def drawn_points(pos: Positions) -> dict[str, Step]:
    """Points of the mechanism: a fixed one of the file that carries nothing is none."""
    m = pos.mechanism
    used = {m.crank.pivot} | {name for g in m.groups for name in g.outer} | {guide.through for guide in m.guides.values()}
    return {name: step for name, step in pos.points.items() if name in used or name not in m.fixed}


def traced(m: Mechanism, link: str) -> list[str]:
    """Points of a link that nothing hangs on and that are nobody's centre of mass: they are there for their paths."""
    used = {link.centre for link in m.links.values()} | {name for g in m.groups for name in g.outer} | \
        {guide.through for guide in m.guides.values()}
    return [p.name for p in m.points if p.link == link and p.name not in used]


def _carried(pos: Positions, link: str) -> tuple[str, Step] | None:
    """The slider block that slides in a block and the direction of its slot."""
    m = pos.mechanism
    slots = (name for name, guide in m.guides.items() if guide.link == link)
    return next(((point, pos.guide_directions[name]) for name in slots for g in m.groups
                 for point, guide in g.kind.guided(g) if guide == name), None)


def along_bar(s: PlayerStage, pos: Positions, shape: Shape) -> tuple[str, ...]:
    """Points of a bar in order along it (a rocker's end may lie beyond or before the block)."""
    names = (*shape.bar, *shape.over)
    if len(names) == 1:
        return shape.ends
    p = {name: s.at(pos.points[name]) for name in names}
    u = p[names[1]] - p[names[0]]
    return tuple(sorted(names, key=lambda name: ((p[name] - p[names[0]]) * np.conj(u)).real)) if abs(u) > 0 else names


_PLAIN = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")


def indexed(name: str) -> str:
    """Name of a point in lettering markup: what follows its letter is the index, a prime stands behind it."""
    name = name.translate(_PLAIN)
    plain = name.rstrip("′″")
    return f"{plain[0]}_{{{plain[1:]}}}{name[len(plain):]}" if plain[1:] else name


def tell_signs(project: Project, canvas: Canvas, box: Box) -> None:
    """Ask once a sheet for the words by which the signs of angular velocities and accelerations are to be read."""
    m = project.mechanism
    said = tr("ω, ε: “+” is counter-clockwise")
    if m.shown_sense(m.crank.link) < 0:
        said = tr("{said}, of link {link} its sense of rotation").format(said=said, link=m.crank.link)
    if all(note.said != said for note in canvas.notes):
        canvas.note(box, said)


class SignedTable(listed.Upright):
    """An upright table that says what the signs of its angular velocities and accelerations mean."""

    def __call__(self, project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
        """Draw it."""
        title, rows = self.of(project, options)
        listed.draw_upright(canvas, box, title, rows)
        if any(name[:1] in ("ω", "ε") for name in rows[0]):
            tell_signs(project, canvas, box)


def crank_pins(pos: Positions) -> tuple[str, ...]:
    """Points of the crank that carry groups, its pin first."""
    return shapes(pos)[0].bar[1:]


def number_links(s: PlayerStage, pos: Positions, only: Collection[str] | None = None, share: float = 0.0) -> None:
    """Numbers of the links beside their bars, at this ``share`` of them or about the middle, and at their blocks."""
    for shape in (shape for shape in shapes(pos) if only is None or shape.link in only):
        link = pos.directions[shape.link]
        if shape.bar:
            names = along_bar(s, pos, shape)
            a, b = s.at(pos.points[names[0]]), s.at(pos.points[names[-1]])
            at = a + (share or (0.62 if len(names) > 2 else 0.5)) * (b - a)
            s.letters(link, shape.link, 1j * (b - a), 5.0, 1.4, at, on=[pos.points[names[0]], pos.points[names[-1]]])
        elif shape.block is not None:
            block = pos.points[shape.block]
            s.letters(link, shape.link, complex(s.value(link)), 5.0, 6.0, s.at(block), on=[block], along=link)


def clear_of_crank(s: PlayerStage, pos: Positions) -> complex:
    """Unit vector from the crank's pivot into the widest angle between its arms, opposite a single arm."""
    pivot = s.at(pos.points[pos.mechanism.crank.pivot])
    return widest_gap(s.at(pos.points[name]) - pivot for name in crank_pins(pos))


def widest_gap(lines: Iterable[complex], digits: int = 15) -> complex:
    """Unit vector into the widest angle between lines from one point; those alike to so many digits are one."""
    angles = sorted({round(float(np.angle(z)), digits) for z in lines if abs(z) > 0})
    gaps = [(b - a, (a + b) / 2) for a, b in zip(angles, [*angles[1:], angles[0] + 2 * np.pi], strict=True)]
    middle = max(gaps, key=lambda gap: round(gap[0], 9))[1]
    return complex(np.cos(middle), np.sin(middle))


def outlines(s: PlayerStage, pos: Positions, shape: Shape) -> list[tuple[str, ...]]:
    """Points of the lines a link is drawn with: one bar, spokes of a crank with several pins, or the sides of a plate; its arms."""
    names = shape.bar
    if len(names) == 1:
        return list(shape.arms)
    p = {name: complex(s.value(pos.points[name])) for name in names}
    z = list(p.values())
    size, u = max([abs(q - z[0]) for q in z]), z[1] - z[0]
    if len(z) == 2 or not abs(u) or max(abs(((q - z[0]) * np.conj(u)).imag) for q in z) < 1e-6 * size * abs(u):
        return [along_bar(s, pos, shape), *shape.arms]
    if names[0] == pos.mechanism.crank.pivot and shape.link == pos.mechanism.crank.link:
        return [*((names[0], name) for name in names[1:]), *shape.arms]
    middle = sum(z) / len(z)
    ring = sorted(names, key=lambda name: np.angle((p[name] - middle) / (z[0] - middle)) % (2 * np.pi))
    sides: list[tuple[str, ...]] = [*zip(ring, (*ring[1:], ring[0]), strict=True)]
    return sides + list(shape.arms)


BEYOND = 0.04
"""How far a slotted link runs on beyond the farthest place of its slider block, in parts of its length."""


class FreeEnd(NamedTuple):
    """An end of a line of a link without a hinge: the arm that runs to it, empty for the bar; its places, m, at the positions."""

    arm: tuple[str, ...]
    at: Points


@once
def free_ends(pos: Positions) -> dict[str, list[FreeEnd]]:
    """Ends of bars and arms along which slider blocks slide: they keep their lengths all round the turn.

    With its centre of mass between the blocks a bar is uniform (manual 001: l_O3S3 is half of the rocker), unless that is too short
    for them.
    """
    found: dict[str, list[FreeEnd]] = {}
    for shape in (shape for shape in shapes(pos) if shape.link not in _cylinder(pos)):
        u = np.asarray(pos.directions[shape.link].value)
        lines: list[tuple[str, ...]] = [*shape.arms, *([] if shape.arms else [(*shape.bar, *shape.over)])]
        ends = []
        for line in lines:
            base = np.asarray(pos.points[line[0]].value) if shape.bar else np.asarray(0j)
            centre = None if shape.arms else _centre(pos, shape, base, u)
            ends += [FreeEnd(line if shape.arms else (), base + end * u) for end in _ends_of(pos, line, base, u, centre)]
        if ends:
            found[shape.link] = ends
    return found


def _ends_of(pos: Positions, names: tuple[str, ...], base: Points, u: Points, centre: float | None) -> list[complex]:
    """Places of the free ends of a line through some points, from its base and turned with its link; none if it is not straight."""
    ways = [(np.asarray(pos.points[name].value) - base) * np.conj(u) for name in names] if len(names) > 1 else []
    far = max((complex(np.ravel(way)[np.nanargmax(np.abs(way))]) for way in ways), key=abs, default=0j)
    along = far / abs(far) if far else 1.0
    along = along if abs(along.imag) > 1e-6 else 1.0  # a bar is read along its link, also backwards
    ways = [way * np.conj(along) for way in ways]
    if not far or any(np.nanmax(np.abs(way.imag)) > 1e-6 * abs(far) for way in ways):
        return []
    sliding = [way.real for way in ways if np.ptp(way.real) > 1e-6 * abs(far)]
    fixed = [float(np.mean(way.real)) for way in ways if np.ptp(way.real) <= 1e-6 * abs(far)]
    return [end * along for end in _ends(fixed, sliding, centre) if end is not None]


def _centre(pos: Positions, shape: Shape, base: Points, u: Points) -> float | None:
    """Place of a link's centre of mass along its bar, None if it is off the bar, or at its pivot."""
    name = pos.mechanism.links[shape.link].centre
    if name is None:
        return None
    way = (np.asarray(pos.points[name].value) - base) * np.conj(u)
    here = float(np.mean(way.real))
    return here if np.max(np.abs(way - here)) < 1e-6 * abs(here) else None


def _ends(fixed: list[float], sliding: list[NDArray[np.float64]], centre: float | None) -> tuple[float | None, float | None]:
    """Places of the free ends of a bar with its fixed points and its slider blocks, whose places vary, along it."""
    if not sliding:
        return None, None
    low, high = (float(f([f(way) for way in sliding])) for f in (np.min, np.max))
    before, behind = low < min(fixed) - 1e-9, high > max(fixed) + 1e-9
    pad = BEYOND * (max(high, *fixed) - min(low, *fixed))
    first, last = (low - pad if before else min(fixed)), (high + pad if behind else max(fixed))
    if centre is not None and first < centre < last:
        first, last = min(first, 2 * centre - last) if before else first, max(last, 2 * centre - first) if behind else last
    return first if before else None, last if behind else None


def draw(s: PlayerStage, pos: Positions, style: str, only: Collection[str] | None = None) -> None:
    """Links of the mechanism at a position: with all symbols in style main, as bare lines otherwise.

    A link looks the same whatever is drawn: a slotted one has its full length also alone.
    """
    ends, cylinder = free_ends(pos), _cylinder(pos)
    drawn = [shape for shape in shapes(pos) if only is None or shape.link in only]
    # A dict, not a set: the order of the marks must be the same in every run.
    at = {name: s.at(pos.points[name]) for shape in drawn for name in (*shape.bar, shape.block or "") if name}
    free = [*centres(pos.mechanism), *(name for shape in drawn for name in traced(pos.mechanism, shape.link))]
    gaps = [name for name in at if name not in free] if style == "main" else [name for name in at if name in pos.mechanism.fixed]
    for shape in drawn:
        if shape.link in cylinder:
            _draw_of_cylinder(s, pos, shape.link, style)
        elif shape.bar:
            _draw_bar(s, pos, shape, [at[name] for name in gaps], style, ends.get(shape.link, []))
        elif shape.along is not None:
            _draw_block(s, pos, shape, style)
    if style == "main":
        _draw_pairs(s, pos, at, whole=only is None)


def _cylinder(pos: Positions) -> tuple[str, ...]:
    """Links of the cylinder that drives the mechanism: its rod, and the part that the rod slides in; none without one."""
    drive = pos.mechanism.drive
    return () if drive is None or drive.slides else drive.group.links


def _draw_of_cylinder(s: PlayerStage, pos: Positions, link: str, style: str) -> None:
    """Rod with its piston, or the part that it slides in, which is open at the rod's end; as bare lines the axis alone."""
    drive = pos.mechanism.drive
    assert drive is not None
    (rod, _), line = drive.group.links, pos.directions[link]
    far, pin = s.at(pos.points[drive.far]), s.at(pos.points[pos.mechanism.crank.pin])
    if style != "main":
        if link != rod:
            s.line(line, far, pin, style, "link")
        return
    u = (pin - far) / abs(pin - far)
    across, least = CYLINDER * 1j * u, min(drive.place) / s.frame.mu[1]
    bottom, mouth = far + 0.08 * least * u, far + 0.85 * least * u
    stroke = abs(drive.place[1] - drive.place[0]) / s.frame.mu[1]
    piston = max(abs(pin - far) - least - max(stroke - 0.65 * least, 0.0), 0.0) + 0.15 * least
    if link == rod:
        at = far + min(piston, 0.8 * least) * u
        s.line(line, at, pin - symbols.HINGE * u, style, "link")
        s.line(line, at + 0.9 * across, at - 0.9 * across, style, "link")
        return
    walls = (bottom + across, mouth + across), (bottom - across, mouth - across)
    lips = ((mouth + side * across, mouth + side * 0.3 * across) for side in (1, -1))
    for a, b in ((far + symbols.HINGE * u, bottom), (bottom + across, bottom - across), *walls, *lips):
        s.line(line, a, b, style, "link")


CYLINDER = 3.0
"""Half of the width of a cylinder, mm."""


def _draw_bar(s: PlayerStage, pos: Positions, shape: Shape, hinges: list[complex], style: str,
              ends: Iterable[FreeEnd]) -> None:
    """A bar interrupted at hinges, in a bare plan from end to end; ``ends`` are free ones beyond its points."""
    if style == "main":
        _corners(s, pos, shape)
    for line in outlines(s, pos, shape):
        pen = s.pen(pos.directions[shape.link], "link", *[pos.points[name] for name in line])
        points = [s.at(pos.points[name]) for name in (line if style == "main" else (line[0], line[-1]))]
        symbols.bar(pen, points, hinges, style)
        for end in (end for end in ends if (end.arm or line) == line and (end.arm or line not in shape.arms)):
            free = complex(s.frame(complex(end.at[s.k or 0])))
            nearest = min(points, key=lambda z: abs(z - free))
            gap = symbols.HINGE if any(abs(nearest - hinge) < symbols.HINGE for hinge in hinges) else 0.0
            # Its last point keeps its place beside the first that is named.
            base = (end.arm or line)[0] if end.arm or not shape.bar else shape.bar[0]
            on = [pos.points[name] for name in (base, *(name for name in line if name != base))]
            pen = s.pen(pos.directions[shape.link], "symbol", *on, along=pos.directions[shape.link],
                        name=f"{on[0].name}–{on[1].name}")
            pen.line(nearest + gap * (free - nearest) / abs(free - nearest), free, style)


def _corners(s: PlayerStage, pos: Positions, shape: Shape) -> None:
    """Marks of rigid angles between the bar of a link and its arms: without them they would be read as two links in a hinge.

    None at a line that is shorter than the mark, which would only blot out the hinges at its ends.
    """
    lines, done = outlines(s, pos, shape), set[frozenset[tuple[str, ...]]]()
    for arm in shape.arms:
        for end, far in (arm, arm[::-1]):
            z = s.at(pos.points[end])
            beside = [(line, name) for line in lines if line != arm and end in line for name in line if name != end]
            u = s.at(pos.points[far]) - z
            ways = [(line, s.at(pos.points[name]) - z) for line, name in beside]
            if abs(u) <= symbols.CORNER or not (ways := [(line, v) for line, v in ways if abs(v) > symbols.CORNER]):
                continue
            line, v = min(ways, key=lambda way: round(abs(float(np.angle(way[1] / u))), 9))
            if frozenset((arm, line)) not in done:
                done.add(frozenset((arm, line)))
                link = pos.directions[shape.link]
                symbols.rigid_corner(s.pen(link, "symbol", pos.points[end], along=link, name=f"{end}–{far}"), z, u, v)


def _draw_block(s: PlayerStage, pos: Positions, shape: Shape, style: str) -> None:
    """A block with its slot, or a ram, and what is fastened to it; small and alone in a bare plan."""
    block = pos.points[str(shape.block)]
    pen = s.pen(block, "symbol", block, along=pos.directions[shape.link])
    if shape.slot is not None:
        _ram(pen, s, pos, shape, style)
        half = RAM
    else:
        size = block_size(pos, shape, s) if style == "main" else (4.0, 2.4)
        half = size[0] / 2
        symbols.block(pen, s.at(block), complex(s.value(pos.directions[shape.link])), style, size)
        if shape.carried is not None and style == "main":
            _slot(pen, s, pos, shape, style)
    if style == "main":
        _arms(s, pos, shape, half)


def _draw_pairs(s: PlayerStage, pos: Positions, at: Mapping[str, complex], *, whole: bool) -> None:
    """Hinges, small circles at traced points, and fixed pivots; of single groups only those that are pairs of the mechanism.

    The point of a ram where guide and slot meet is a hinge only where a group hangs on it.
    """
    m = pos.mechanism
    free = [name for link in m.links for name in traced(m, link)]
    for name, z in ((name, z) for name, z in at.items() if name not in centres(m)):
        pen = s.pen(pos.points[name], "symbol")
        if name in m.fixed:
            if whole or name == m.crank.pivot or any(name in g.outer for g in m.groups):
                symbols.pivot(pen, z, _base_direction(pos, name))
        elif name in free:
            symbols.hinge(pen, z, "thin", 0.7)
        elif not any(g.kind.ram(g) and g.inner == name for g in m.groups) or any(name in g.outer for g in m.groups):
            symbols.hinge(pen, z)


RAM = 21.0
"""Half length of the body of a kind 5 group's guided link, mm."""


def block_size(pos: Positions, shape: Shape, s: PlayerStage) -> tuple[float, float]:
    """Length along its guide and width of a block, mm: one with a slot or with a slider block at its pin is larger."""
    if shape.carried is not None:
        name, direction = shape.carried
        way = ((pos.points[name].value - pos.points[str(shape.block)].value) * np.conj(direction.value)).real
        return 18.0, 2 * (float(np.nanmax(np.abs(way))) / s.frame.mu[1] + symbols.BLOCK[0] / 2 + 2.0)
    m = pos.mechanism
    if any(len(sliders) > 1 and link == shape.link and m.guides[guide].link == m.frame
           for sliders in (g.kind.sliders(g) for g in m.groups) for link, guide in sliders):
        return 1.6 * symbols.BLOCK[0], 1.7 * symbols.BLOCK[1]
    return symbols.BLOCK


def _slot(canvas: Canvas, s: PlayerStage, pos: Positions, shape: Shape, style: str) -> None:
    """Walls of the slot in a block, through its whole width."""
    assert shape.carried is not None
    name, direction = shape.carried
    v = complex(s.value(direction))
    z = s.at(pos.points[name])
    z += ((s.at(pos.points[str(shape.block)]) - z) * np.conj(v)).real * v
    half, wall = block_size(pos, shape, s)[1] / 2, symbols.BLOCK[1] / 2 * 1j * v
    for side in (1, -1):
        canvas.line(z + side * wall - half * v, z + side * wall + half * v, style)


def _arms(s: PlayerStage, pos: Positions, shape: Shape, half: float) -> None:
    """What ties a point of a block that lies along its guide beside it, its centre of mass for one, to the block."""
    z, u = s.at(pos.points[str(shape.block)]), complex(s.value(pos.directions[shape.link]))
    for p in pos.mechanism.points:
        way = s.at(pos.points[p.name]) - z
        along = (way * np.conj(u)).real
        if p.link == shape.link and abs(way - along * u) < 1e-6 and abs(along) > half:
            pen = s.pen(pos.points[p.name], "link", pos.points[str(shape.block)], pos.points[p.name])
            pen.line(z + np.sign(along) * half * u, z + way, "main")


def _base_direction(pos: Positions, name: str) -> complex:
    """A fixed pivot's base stands away from the mechanism: below, unless everything hangs under it."""
    ys = [p.imag for p in pos.mechanism.fixed.values()]
    mine = pos.mechanism.fixed[name].imag
    return 1j if len(ys) > 1 and mine == max(ys) and mine > min(ys) and name != pos.mechanism.crank.pivot else -1j


def _ram(canvas: Canvas, s: PlayerStage, pos: Positions, shape: Shape, style: str) -> None:
    """Guided link of a kind 5 group: a body on the guide with the slot in which the block slides; in a bare plan their middles."""
    g = next(g for g in pos.mechanism.groups if shape.link in g.links)
    z, pin = s.at(pos.points[str(shape.block)]), s.at(pos.points[g.outer[0]])
    assert shape.slot is not None
    u, v = complex(s.value(pos.directions[shape.link])), complex(s.value(shape.slot))
    if ((pin - z) * np.conj(v)).real < 0:
        v = -v
    reach = max(((pin - z) * np.conj(v)).real + 9.0, 16.0)
    half, thick, wall, line = RAM, 5.0, symbols.BLOCK[1] / 2, canvas.line
    if style != "main":
        line(z - half * u, z + half * u, style)
        line(z, z + reach * v, style)
        return
    walls = s.pen(pos.points[str(shape.block)], "symbol", pos.points[str(shape.block)], pos.points[g.outer[0]])
    for side in (1, -1):
        walls.line(z + side * wall * u + thick * v, z + side * wall * u + reach * v, style)
        line(z + side * wall * u + thick * v, z + side * half * u + thick * v, style)
        line(z + side * half * u + thick * v, z + side * half * u - thick * v, style)
    line(z - half * u - thick * v, z + half * u - thick * v, style)


def draw_guides(s: PlayerStage, pos: Positions, only: Collection[str] | None = None) -> None:
    """Fixed guides of the blocks and rams, hatched on the side away from the link."""
    m = pos.mechanism
    for g in m.groups:
        ram = g.kind.ram(g)
        for link, name in (*([(ram, g.guides[0])] if ram else []), *g.kind.sliders(g)):
            if (only is None or link in only) and m.guides[name].link == m.frame:
                pen = s.pen(pos.guide_directions[name], "symbol")
                z, u = s.at(pos.points[g.kind.block(g, link)]), complex(s.value(pos.guide_directions[name]))
                if link == ram:
                    _guide(pen, z, u, ((10.0, 19.5), (-19.5, -10.0)), 6.2, "axis")
                else:
                    length, width = block_size(pos, next(shape for shape in shapes(pos) if shape.link == link), s)
                    _guide(pen, z, u, ((-length / 2 - 6.0, length / 2 + 6.0),), width / 2 + 0.4, "main")


def _guide(canvas: Canvas, z: complex, u: complex, stretches: Iterable[tuple[float, float]], gap: float, style: str) -> None:
    """Both walls of a guide along ``u``, over stretches from ``z`` on, mm."""
    for a, b in stretches:
        for side in (1, -1):
            symbols.fixed_guide(canvas, z + a * u + side * gap * 1j * u, z + b * u + side * gap * 1j * u, side, style)
