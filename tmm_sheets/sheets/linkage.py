"""How links look: bars, blocks and guides of a mechanism in one position."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from tmm_sheets.construction.step import Step
from tmm_sheets.drawing import symbols
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.sheets.frame import Frame

if TYPE_CHECKING:
    from tmm_sheets.mechanism.groups.hints import Outline
    from tmm_sheets.mechanism.model import Mechanism
    from tmm_sheets.methods.linkage.positions import Positions


@dataclass(frozen=True)
class Shape:
    """What is drawn for one link: a bar through points, or a block at a point along a direction.

    ``over`` are the points of blocks that slide along the bar, which reaches to them; ``arms`` are further lines by the names
    of their ends: guides of the link that do not lie along its bar. ``carried`` is, for a block with a slot of its own, the
    point of the stone in it and the slot's direction.
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
        """Points whose line tells the direction of a bar: its ends, or foot and stone of a rocker beside its pivot."""
        return (self.bar[0], self.bar[-1]) if len(self.bar) > 1 else (self.arms[1][0], self.arms[1][1])


def shapes(pos: Positions) -> list[Shape]:
    """Shapes of all links, crank first."""
    m = pos.mechanism
    c = m.crank
    found = [_bar(m, c.link, (c.pivot, c.pin))]
    for g in m.groups:
        found += [_shape(pos, outline) for outline in g.kind.outlines(pos, g)]
    return found


def _shape(pos: Positions, o: Outline) -> Shape:
    if o.bar:
        bar = _bar(pos.mechanism, o.link, o.bar, o.aim)
        return replace(bar, arms=(*o.arms, *bar.arms))
    return Shape(o.link, block=o.block, along=o.along, slot=o.slot, carried=_carried(pos, o.link) if o.slotted else None)


def _bar(m: Mechanism, link: str, base: tuple[str, ...], aim: str | None = None) -> Shape:
    """A link through its hinges and the points its guides start from; ``aim`` is a point its line passes besides."""
    guides = [g for g in m.guides.values() if g.link == link]
    hinges = [p.name for p in m.points if p.link == link and any(p.name in g.outer for g in m.groups)]
    starts = [p.name for p in m.points if p.link == link and any(p.name == g.through for g in guides)]
    bar = tuple(dict.fromkeys((*base, *hinges, *starts)))
    over, arms = [], []
    for guide in guides:
        along = not guide.direction and guide.through in base and guide.towards in (*base, aim)
        for g in m.groups:
            if g.inner and guide.name in g.guides:
                over += [g.inner] * along
                arms += [(str(guide.through), g.inner)] * (not along)
    return Shape(link, bar, over=tuple(over), arms=tuple(arms))


def _carried(pos: Positions, link: str) -> tuple[str, Step] | None:
    """The stone that slides in a block and the direction of its slot."""
    m = pos.mechanism
    slots = (name for name, guide in m.guides.items() if guide.link == link)
    return next(((str(g.inner), pos.guide_directions[name]) for name in slots for g in m.groups if name in g.guides), None)


def bar_points(pos: Positions, shape: Shape, k: int) -> list[complex]:
    """Points of a bar in order along it (a rocker's end may lie beyond or before the block)."""
    p = [complex(pos.points[name].at(k)) for name in (*shape.bar, *shape.over)]
    if len(p) == 1:
        return [complex(pos.points[name].at(k)) for name in shape.ends]
    u = p[1] - p[0]
    if abs(u) == 0:
        return p
    return sorted(p, key=lambda z: ((z - p[0]) * np.conj(u)).real)


_PLAIN = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")


def indexed(name: str) -> str:
    """Name of a point in lettering markup: what follows its letter is the index."""
    name = name.translate(_PLAIN)
    return f"{name[0]}_{{{name[1:]}}}" if name[1:] else name


def crank_pins(pos: Positions) -> tuple[str, ...]:
    """Points of the crank that carry groups, its pin first."""
    return shapes(pos)[0].bar[1:]


def clear_of_crank(pos: Positions, k: int) -> complex:
    """Unit vector from the crank's pivot into the widest angle between its arms, opposite a single arm."""
    m = pos.mechanism
    pivot = complex(pos.points[m.crank.pivot].at(k))
    arms = sorted(float(np.angle(complex(pos.points[name].at(k)) - pivot)) for name in crank_pins(pos))
    gaps = [(b - a, (a + b) / 2) for a, b in zip(arms, [*arms[1:], arms[0] + 2 * np.pi], strict=True)]
    middle = max(gaps, key=lambda gap: round(gap[0], 9))[1]
    return complex(np.cos(middle), np.sin(middle))


def outlines(pos: Positions, shape: Shape, k: int) -> list[list[complex]]:
    """Lines a link is drawn with: one bar, spokes of a crank with several pins, or the sides of a plate; and its arms."""
    arms = [[complex(pos.points[name].at(k)) for name in arm] for arm in shape.arms]
    p = [complex(pos.points[name].at(k)) for name in shape.bar]
    if len(p) == 1:
        return arms
    size = max(abs(z - p[0]) for z in p)
    u = p[1] - p[0]
    if len(p) == 2 or not abs(u) or max(abs(((z - p[0]) * np.conj(u)).imag) for z in p) < 1e-6 * size * abs(u):
        return [bar_points(pos, shape, k), *arms]
    if shape.bar[0] == pos.mechanism.crank.pivot and shape.link == pos.mechanism.crank.link:
        return [[p[0], z] for z in p[1:]] + arms
    middle = sum(p) / len(p)
    ring = sorted(p, key=lambda z: np.angle((z - middle) / (p[0] - middle)) % (2 * np.pi))
    return [[a, b] for a, b in zip(ring, [*ring[1:], ring[0]], strict=True)] + arms


def draw(canvas: Canvas, pos: Positions, k: int, frame: Frame, style: str, only: Iterable[str] | None = None) -> None:
    """Links of the mechanism at position ``k``: with all symbols in style main, as bare lines otherwise."""
    wanted = set(pos.mechanism.links if only is None else only)
    drawn = [s for s in shapes(pos) if s.link in wanted]
    # A dict, not a set: the order of the marks must be the same in every run.
    names = dict.fromkeys(name for s in drawn for name in (*s.bar, s.block or "") if name)
    at = {name: frame(complex(pos.points[name].at(k))) for name in names}
    if style != "main":
        _draw_bare(canvas, pos, drawn, at, frame, k, style)
        return
    for s in drawn:
        if s.bar:
            for line in outlines(pos, s, k):
                symbols.bar(canvas, [frame(z) for z in line], at.values(), style)
        elif s.block is not None and s.along is not None:
            _draw_block(canvas, pos, s, frame, k, style)
    _draw_pairs(canvas, pos, at, style, whole=only is None)


def _draw_bare(canvas: Canvas, pos: Positions, drawn: Iterable[Shape], at: Mapping[str, complex], frame: Frame, k: int,
               style: str) -> None:
    """Bars as lines, interrupted at fixed pivots only, and small blocks; a ram's body would hide those of other positions."""
    pivots = [z for name, z in at.items() if name in pos.mechanism.fixed]
    for s in drawn:
        if s.bar:
            for line in outlines(pos, s, k):
                p = [frame(z) for z in line]
                symbols.bar(canvas, (p[0], p[-1]), pivots, style)
        elif s.block is not None and s.along is not None and s.slot is None:
            symbols.block(canvas, at[s.block], complex(s.along.at(k)), style, (4.0, 2.4))


def _draw_block(canvas: Canvas, pos: Positions, s: Shape, frame: Frame, k: int, style: str) -> None:
    """A block with its slot, or a ram, and what is fastened to it."""
    assert s.block is not None
    assert s.along is not None
    if s.slot is not None:
        _ram(canvas, frame, pos, s, k, style)
    else:
        centre = frame(complex(pos.points[s.block].at(k)))
        symbols.block(canvas, centre, complex(s.along.at(k)), style, block_size(pos, s, frame))
        if s.carried is not None:
            _slot(canvas, pos, s, frame, k, style)
    _arms(canvas, pos, s, frame, k, style)


def _draw_pairs(canvas: Canvas, pos: Positions, at: Mapping[str, complex], style: str, *, whole: bool) -> None:
    """Hinges and fixed pivots; of single groups only those pivots that are pairs of the mechanism."""
    m = pos.mechanism
    for name, z in at.items():
        if name in m.fixed:
            if whole or name == m.crank.pivot or any(name in g.outer for g in m.groups):
                symbols.pivot(canvas, z, _base_direction(pos, name))
        elif not _is_block_of_ram(pos, name):
            symbols.hinge(canvas, z, style)


RAM = 21.0
"""Half length of the body of a kind 5 group's guided link, mm."""


def block_size(pos: Positions, s: Shape, frame: Frame) -> tuple[float, float]:
    """Length along its guide and width of a block, mm: one with a slot or with a stone at its pin is larger."""
    if s.carried is not None:
        name, direction = s.carried
        way = ((pos.points[name].value - pos.points[str(s.block)].value) * np.conj(direction.value)).real
        return 18.0, 2 * (float(np.nanmax(np.abs(way))) / frame.scale.mu + symbols.BLOCK[0] / 2 + 2.0)
    m = pos.mechanism
    if any(len(sliders) > 1 and link == s.link and m.guides[guide].link == m.frame
           for sliders in (g.kind.sliders(g) for g in m.groups) for link, guide in sliders):
        return 1.6 * symbols.BLOCK[0], 1.7 * symbols.BLOCK[1]
    return symbols.BLOCK


def _slot(canvas: Canvas, pos: Positions, s: Shape, frame: Frame, k: int, style: str) -> None:
    """Walls of the slot in a block, through its whole width."""
    assert s.carried is not None
    v = complex(s.carried[1].at(k))
    z = frame(complex(pos.points[s.carried[0]].at(k)))
    centre = frame(complex(pos.points[str(s.block)].at(k)))
    z += ((centre - z) * np.conj(v)).real * v
    half, wall = block_size(pos, s, frame)[1] / 2, symbols.BLOCK[1] / 2 * 1j * v
    for side in (1, -1):
        canvas.line(z + side * wall - half * v, z + side * wall + half * v, style)


def _arms(canvas: Canvas, pos: Positions, s: Shape, frame: Frame, k: int, style: str) -> None:
    """What ties a point of a block that lies along its guide beside it, its centre of mass for one, to the block."""
    assert s.along is not None
    z, u = frame(complex(pos.points[str(s.block)].at(k))), complex(s.along.at(k))
    half = RAM if s.slot is not None else block_size(pos, s, frame)[0] / 2
    for p in pos.mechanism.points:
        way = frame(complex(pos.points[p.name].at(k))) - z
        along = (way * np.conj(u)).real
        if p.link == s.link and abs(way - along * u) < 1e-6 and abs(along) > half:
            canvas.line(z + np.sign(along) * half * u, z + way, style)


def _is_block_of_ram(pos: Positions, name: str) -> bool:
    return any(g.kind.ram(g) and g.inner == name for g in pos.mechanism.groups)


def _base_direction(pos: Positions, name: str) -> complex:
    """A fixed pivot's base stands away from the mechanism: below, unless everything hangs under it."""
    ys = [p.imag for p in pos.mechanism.fixed.values()]
    mine = pos.mechanism.fixed[name].imag
    return 1j if len(ys) > 1 and mine == max(ys) and mine > min(ys) and name != pos.mechanism.crank.pivot else -1j


def _ram(canvas: Canvas, frame: Frame, pos: Positions, s: Shape, k: int, style: str) -> None:
    """Guided link of a kind 5 group: a body on the guide with the slot in which the block slides."""
    assert s.block is not None
    assert s.along is not None
    assert s.slot is not None
    g = next(g for g in pos.mechanism.groups if s.link in g.links)
    z, pin = frame(complex(pos.points[s.block].at(k))), frame(complex(pos.points[g.outer[0]].at(k)))
    u, v = complex(s.along.at(k)), complex(s.slot.at(k))
    if ((pin - z) * np.conj(v)).real < 0:
        v = -v
    reach = max(((pin - z) * np.conj(v)).real + 9.0, 16.0)
    half, thick, wall = RAM, 5.0, symbols.BLOCK[1] / 2
    for side in (1, -1):
        canvas.line(z + side * wall * u + thick * v, z + side * wall * u + reach * v, style)
        canvas.line(z + side * wall * u + thick * v, z + side * half * u + thick * v, style)
        canvas.line(z + side * half * u + thick * v, z + side * half * u - thick * v, style)
    canvas.line(z - half * u - thick * v, z + half * u - thick * v, style)


def draw_guides(canvas: Canvas, pos: Positions, k: int, frame: Frame, only: Iterable[str] | None = None) -> None:
    """Fixed guides of the blocks and rams, hatched on the side away from the link."""
    m = pos.mechanism
    wanted = set(m.links if only is None else only)
    for g in m.groups:
        if g.kind.ram(g) in wanted and m.guides[g.guides[0]].link == m.frame:
            z, u = frame(complex(pos.points[str(g.inner)].at(k))), complex(pos.guide_directions[g.guides[0]].at(k))
            for end, side in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
                a, b = sorted((z + end * 10.0 * u, z + end * 19.5 * u), key=lambda p: (p * np.conj(u)).real)
                symbols.fixed_guide(canvas, a + side * 6.2j * u, b + side * 6.2j * u, side, "axis")
        for link, name in g.kind.sliders(g):
            if link not in wanted or m.guides[name].link != m.frame:
                continue
            z, u = frame(complex(pos.points[str(g.inner)].at(k))), complex(pos.guide_directions[name].at(k))
            length, width = block_size(pos, next(s for s in shapes(pos) if s.link == link), frame)
            half, gap = length / 2 + 6.0, width / 2 + 0.4
            for side in (1, -1):
                symbols.fixed_guide(canvas, z - half * u + side * gap * 1j * u, z + half * u + side * gap * 1j * u, side)
