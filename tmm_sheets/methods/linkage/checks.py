"""Does the mechanism assemble all the way round, and if not: where, by how much, and what would help.

The conditions of assembly are those of the kinds of groups.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_sheets.construction.expression import Floats
from tmm_sheets.construction.step import Plan
from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.groups.contexts import SWEEP, TOUCH, AssemblyLimit
from tmm_sheets.mechanism.model import Mechanism, StructuralGroup
from tmm_sheets.methods.linkage.cycle import Cycle
from tmm_sheets.methods.linkage.motion import Watched
from tmm_sheets.methods.linkage.positions import Passages, Positions
from tmm_sheets.numbers import in_a_row, of_reader
from tmm_sheets.words import Remark, marked, marked_n, tell, tell_n

ASSEMBLY = "assembly"
CLOSE = 0.02
"""Share of the crank length (sine) below which a minimum between the angles of the sweep is looked at more closely."""


NEAR_DEAD = 1e-4
"""Share of the crank length within which a group that turns round comes to its dead position: no machine is made better."""


@dataclass(frozen=True)
class DeadPosition:
    """A group that is stretched or folded at some crank angles, degrees: from there it can go on in two ways.

    In its change points one of them goes on smoothly; it ``passes`` them if it comes back to its side after a turn.
    """

    group: str
    angles: tuple[float, ...]
    passes: bool = False

    def __str__(self) -> str:
        return str(self.remark)

    @property
    def remark(self) -> Remark:
        """It as it is told."""
        angles = in_a_row(of_reader(f"{angle:.1f}") for angle in sorted(round(angle, 1) % 360 for angle in self.angles))
        said = Remark(marked_n(
            "group {group} is stretched or folded at crank angle {angles} deg and can go on from there in two ways: it is drawn "
            "on the same side all round, where its links turn back at once",
            "group {group} is stretched or folded at crank angles {angles} deg and can go on from there in two ways: it is drawn "
            "on the same side all round, where its links turn back at once"),
            {"group": self.group, "angles": angles}, len(self.angles))
        advice = Remark(marked('to go on smoothly, write branch = "follow" in the group') if self.passes
                        else marked("change a length, or let the crank swing"))
        return Remark("{said}; {advice}", {"said": said, "advice": advice})


def check_turn(mechanism: Mechanism, moving: str = "") -> None:
    """Assemble the mechanism all round the turn, before its positions are numbered; see :func:`check_assembly`.

    Asked for what is ``moving`` and has no speed at some angle, a group that comes to its dead position is refused as well.

    Raises
    ------
    CannotBuild
        naming the groups that do not assemble, or come to a dead position.
    """
    unnumbered = Cycle((), np.empty(0), 0.0, mechanism.crank.sense, 2 * np.pi, None, None, Plan("cycle", "", ""))
    passed = check_assembly(mechanism, unnumbered)
    if moving and passed:
        raise CannotBuild("\n".join(map(str, passed)),
                          tell("the strokes of {moving} cannot be found: it turns back at once there, or has no speed; change a "
                               "length, or tell nothing of strokes (output, working_sense, stroke)").format(moving=moving))


def check_assembly(mechanism: Mechanism, cycle: Cycle) -> tuple[DeadPosition, ...]:
    """Assemble the mechanism at its numbered positions and all round the turn; the groups that pass a dead position on the way.

    Raises
    ------
    CannotBuild
        naming every group that does not assemble, the positions or crank angles (world frame, counter-clockwise from the
        x axis), the lack in millimetres and what to try.
    """
    limits = [(g, limit) for g in mechanism.groups for limit in g.kind.limits(mechanism, g)]
    search = _Search(mechanism, cycle, [limit for _, limit in limits])
    failures = [(search.failure(i, g), limit) for i, (g, limit) in enumerate(limits)]
    said = [message for message, _ in failures if message]
    hints = [limit.hint(search.asked_turn()) for message, limit in failures if message]
    if said:
        # What lies upstream decides what the groups after it need: only the first advice is sure.
        raise CannotBuild("\n".join(said), hints[0])
    numbered = search.watched.positions(cycle.phi)
    missing = numbered.plan.check(numbered.value, cycle.labels)
    if missing:
        name, labels = missing
        raise CannotBuild(tell("{point} cannot be constructed at positions {labels}").format(point=name, labels=", ".join(labels)))
    passed: dict[tuple[str, bool], list[float]] = {}
    for i, (g, limit) in enumerate(limits):
        changes = np.degrees(Passages(mechanism).angles(g))
        for angle in search.dead(i) if limit.measured else ():
            change = bool(np.any(np.abs(np.mod(changes - angle + 180.0, 360.0) - 180.0) < CHANGE))
            if not (change and g.follow):
                passed.setdefault(("-".join(g.links), change), []).append(angle)
    closed = {"-".join(g.links): cycle.swings or len(Passages(mechanism).angles(g)) % 2 == 0 for g in mechanism.groups}
    return tuple(DeadPosition(group, tuple(sorted(angles)), change and closed[group]) for (group, change), angles in passed.items())


CHANGE = 0.1
"""Degrees within which the search for the narrowest places finds a change point."""


def check_followed(mechanism: Mechanism, cycle: Cycle) -> None:
    """See that a group that follows comes back to its side after a turn: else no angle of the crank tells how it stands.

    Raises
    ------
    CannotBuild
        when a group passes an odd number of change points.
    """
    for g in mechanism.groups:
        angles = Passages(mechanism).angles(g) if g.follow and not cycle.swings else ()
        if len(angles) % 2:
            message = tell_n('group {group} with branch = "follow" passes a change point at crank angle {angles} deg: after a turn '
                             "of the crank it stands on the other side",
                             'group {group} with branch = "follow" passes change points at crank angles {angles} deg: after a turn '
                             "of the crank it stands on the other side", len(angles))
            raise CannotBuild(message.format(group="-".join(g.links),
                                             angles=in_a_row(of_reader(f"{angle:.1f}") for angle in np.degrees(angles) % 360)),
                              tell("let the crank swing (end in [cycle]), change a length, or leave branch out"))


@dataclass(frozen=True)
class End:
    """End of a swing: crank angle, degrees, None for none; number of the limit that ends it; what it lacks 1 degree beyond, m."""

    angle: float | None
    limit: int
    lack: float = np.nan


@dataclass(frozen=True)
class SwingLimits:
    """How far a crank that swings could go: its crank angles, degrees, the groups that end it there, and why."""

    angles: tuple[float | None, float | None]
    groups: tuple[str, str]
    reasons: tuple[str, str]


def swing_limits(mechanism: Mechanism, cycle: Cycle) -> SwingLimits:
    """Limits of the swing of a crank, backwards from its first position and on from its last."""
    limits = [(g, limit) for g in mechanism.groups for limit in g.kind.limits(mechanism, g)]
    ends = _Search(mechanism, cycle, [limit for _, limit in limits]).swing()
    groups = tuple("" if end.limit < 0 else "-".join(limits[end.limit][0].links) for end in ends)
    reasons = tuple("" if end.limit < 0 or np.isnan(end.lack) else limits[end.limit][1].say(end.lack) for end in ends)
    return SwingLimits((ends[0].angle, ends[1].angle), (groups[0], groups[1]), (reasons[0], reasons[1]))


class _Search:
    """Margins of all limits over the turn, one column per angle."""

    def __init__(self, mechanism: Mechanism, cycle: Cycle, limits: list[AssemblyLimit]) -> None:
        self.watched = Watched(mechanism, ASSEMBLY)
        self.cycle = cycle
        self.limits = limits
        step = 2 * np.pi / SWEEP
        turned = np.concatenate((cycle.turned, step * np.arange(SWEEP)))
        self.whole_turn, margins = self._margins(turned)
        self.numbered = margins[:, : len(cycle.turned)]
        extra, found = self._narrow_places(step, margins[:, len(cycle.turned):])
        order = np.argsort(np.concatenate((np.mod(turned, 2 * np.pi), extra)), kind="stable")
        self.turned = np.concatenate((np.mod(turned, 2 * np.pi), extra))[order]
        self.margins = np.concatenate((margins, found), axis=1)[:, order]
        # Of a crank that swings only its swing counts; how far it could go is told from the whole turn.
        self.asked = self.turned <= cycle.period + TOUCH if cycle.swings else np.full(self.turned.shape, True)

    def asked_turn(self) -> Positions:
        """Positions over the way asked for: what is advised need not hold where a crank that swings never comes."""
        if not self.cycle.swings:
            return self.whole_turn
        there_and_back = 1.0 - np.abs(2.0 * np.arange(SWEEP) / SWEEP - 1.0)  # closed, as the whole turn is
        return self._margins(self.cycle.period * there_and_back)[0]

    def _margins(self, turned: Floats) -> tuple[Positions, Floats]:
        pos = self.watched.positions(self.cycle.world(turned))
        with np.errstate(invalid="ignore"):
            rows = [np.broadcast_to(limit.margin(pos), turned.shape) for limit in self.limits]
        return pos, np.array(rows, dtype=np.float64).reshape(len(rows), len(turned))

    def _narrow_places(self, step: float, margins: Floats) -> tuple[Floats, Floats]:
        """Angles about the small minima between the angles of the sweep, and all margins there."""
        close = np.array([CLOSE * limit.unit for limit in self.limits]).reshape(-1, 1)
        low = (margins >= 0) & (margins < close) & (margins <= np.roll(margins, 1, 1)) & (margins <= np.roll(margins, -1, 1))
        changing = np.ptp(np.nan_to_num(margins), axis=1, keepdims=True) > 0
        which, where = np.nonzero(low & changing)
        centres = step * where
        extra, found = np.empty(0), np.empty((len(self.limits), 0))
        offsets = np.linspace(-1, 1, 33)
        while len(centres) and step > TOUCH / 16:
            turned = centres[:, None] + step * offsets
            _, m = self._margins(turned.ravel())
            extra, found = np.concatenate((extra, np.mod(turned.ravel(), 2 * np.pi))), np.concatenate((found, m), axis=1)
            own = m.reshape(len(self.limits), *turned.shape)[which, np.arange(len(which))]
            best = np.argmin(np.where(np.isnan(own), np.inf, own), axis=1)
            centres, step = turned[np.arange(len(which)), best], step / 16
        return extra, found

    def failure(self, i: int, group: StructuralGroup) -> str:
        """What to say about limit ``i``, of a group; nothing when it holds wherever the groups before it assemble."""
        limit, margin = self.limits[i], self.margins[i]
        fails = (margin < 0) & self.asked
        if not fails.any():
            return ""
        labels = [label for label, m in zip(self.cycle.labels, self.numbered[i], strict=True) if m < 0]
        reachable = self._assembles(self.margins, i)
        worst = int(np.nanargmin(np.where(self.asked, margin, np.nan)))
        said = {"group": "-".join(group.links), "why": limit.say(float(-margin[worst]))}
        if limit.measured and not fails[self.asked].all():
            said["why"] = tell("{why} at worst ({place})").format(why=said["why"], place=self._place(worst, i))
        if fails[self.asked].all():
            text = tell("group {group} does not assemble at any position: {why}").format(**said)
        elif labels:
            text = tell_n("group {group} does not assemble at position {places}: {why}",
                          "group {group} does not assemble at positions {places}: {why}",
                          len(labels)).format(places=", ".join(labels), **said)
        else:
            ranges = self._ranges(fails, i)
            text = tell_n("group {group} does not assemble at crank angle {places}: {why}",
                          "group {group} does not assemble at crank angles {places}: {why}",
                          2 if "." in ranges.replace(".", "", 1) else 1).format(places=ranges, **said)
        if limit.measured and reachable.any():
            text = tell("{message}; reachable crank angles: {ranges}").format(message=text, ranges=self._ranges(reachable, i))
        return text

    def swing(self) -> tuple[End, End]:
        """Where the crank's swing could end at the most, backwards and on, and the limits that end it."""
        every = len(self.limits) - 1
        holds = self._assembles(self.margins, every)
        if holds.all():
            return End(None, -1), End(None, -1)
        found = []
        for step in (-1, 1):
            at = int(np.flatnonzero(self.asked)[0 if step < 0 else -1])
            while holds[(at + step) % len(holds)]:
                at = (at + step) % len(holds)
            beyond = np.array([(at + step) % len(holds)])
            edge = float(self._edges(np.array([at]), beyond, every, holds, 40)[0])
            past = self._margins(np.array([edge + step * np.radians(1.0)]))[1][:, 0]
            ends = int(np.flatnonzero(~(past >= 0))[0]) if (~(past >= 0)).any() else -1
            # Counted on from the swing itself: it may begin beyond a whole turn's zero.
            way = edge - 2 * np.pi if step < 0 and edge > self.cycle.period else edge
            found.append(End(float(np.degrees(self.cycle.world(way))), ends, float(-past[ends]) if ends >= 0 else np.nan))
        return found[0], found[1]

    def dead(self, i: int) -> tuple[float, ...]:
        """Crank angles at which limit ``i`` is reached and holds again behind, degrees; not the ends of a swing."""
        margin, near = self.margins[i], NEAR_DEAD * self.limits[i].unit
        reached = np.flatnonzero((margin < near) & self.asked)
        if not len(reached) or not np.nanmax(margin) > near:
            return ()
        turned = self.turned[reached]
        apart = np.split(reached, np.flatnonzero(np.diff(turned) > np.radians(1.0)) + 1)
        if len(apart) > 1 and turned[0] + 2 * np.pi - turned[-1] < np.radians(1.0):
            apart = [np.concatenate((apart.pop(), apart[0])), *apart[1:]]
        ends = set(np.flatnonzero(self.asked)[[0, -1]].tolist()) if self.cycle.swings else set()
        return tuple(self._degrees(self.turned[of[np.argmin(margin[of])]]) for of in apart if not ends & set(of.tolist()))

    @staticmethod
    def _assembles(margins: Floats, i: int) -> Any:
        """True where limit ``i`` and all before it hold (NaN: a group before it does not assemble)."""
        return np.all(margins[: i + 1] >= 0, axis=0)

    def _place(self, worst: int, i: int) -> str:
        low = np.nanmin(self.numbered[i]) if np.isfinite(self.numbered[i]).any() else np.inf
        if low <= self.margins[i][worst]:
            return tell("position {label}").format(label=self.cycle.labels[int(np.nanargmin(self.numbered[i]))])
        return tell("crank angle {angle:.1f} deg").format(angle=self._degrees(self.turned[worst]))

    def _degrees(self, turned: float) -> float:
        """World angle of the crank, 0 to 360 degrees."""
        return float(np.mod(np.degrees(self.cycle.world(turned)), 360.0))

    def _ranges(self, mask: Any, i: int) -> str:
        """Crank angles where ``mask`` holds, as ranges in degrees with sharpened ends."""
        if mask.all():
            return tell("all")
        starts = np.flatnonzero(mask & ~np.roll(mask, 1))
        ends = np.flatnonzero(mask & ~np.roll(mask, -1))
        if ends[0] < starts[0]:
            ends = np.roll(ends, -1)
        low = self._edges(starts, np.mod(starts - 1, len(mask)), i, mask)
        high = self._edges(ends, np.mod(ends + 1, len(mask)), i, mask)
        if self.cycle.sense < 0:
            low, high = high[::-1], low[::-1]
        texts = []
        for a, b in zip(low, high, strict=True):
            first, last = self._degrees(a), self._degrees(b)
            if last < first:
                first -= 360
            both = [of_reader(f"{angle:.1f}") for angle in (first, last)]
            texts.append(of_reader(f"{np.mod(first, 360):.1f}") if both[0] == both[1] else "..".join(both))
        if len(texts) > 4:
            more = len(texts) - 3
            said = tell_n("{ranges}, {n} more range deg", "{ranges}, {n} more ranges deg", more)
            return said.format(ranges=in_a_row(texts[:3]), n=more)
        return tell("{ranges} deg").format(ranges=in_a_row(texts))

    def _edges(self, inside: Any, outside: Any, i: int, mask: Any, halvings: int = 10) -> Floats:
        """Angles at the ends of ranges, halved until they are sharp to 0.001 degrees, or more often."""
        a: Floats = self.turned[inside]
        b: Floats = a + np.mod(self.turned[outside] - a + np.pi, 2 * np.pi) - np.pi
        failing = bool((self.margins[i][mask] < 0).all())
        for _ in range(halvings):
            middle = (a + b) / 2
            _, m = self._margins(middle)
            holds = m[i] < 0 if failing else self._assembles(m, i)
            a, b = np.where(holds, middle, a), np.where(holds, b, middle)
        return a
