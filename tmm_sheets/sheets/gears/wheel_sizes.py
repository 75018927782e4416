"""View for room left beside a reducer or a train: tooth numbers and diameters of its wheels."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.numbers import number
from tmm_sheets.sheets.components.listed import Table
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.methods.gears.reducer import Reducer
    from tmm_sheets.methods.gears.train import Train
    from tmm_sheets.project import Project

ADDENDUM, CLEARANCE = 1.0, 0.25
"""Coefficients of the basic rack (GOST 13755) where the task says nothing of it."""


class _Wheel(NamedTuple):
    """A wheel: tooth number, module in m, 1 or -1 for a ring, coefficients of its rack."""

    name: str
    teeth: int
    module: float
    out: int
    rack: tuple[float, float]


def _title(project: Project) -> str:
    addendum, clearance = _wheels(project)[0].rack
    return tr("Wheels without shift, h_a^{{*}} = {addendum}, c^{{*}} = {clearance}").format(
        addendum=number(addendum), clearance=number(clearance))


def _rows(project: Project, canvas: Canvas) -> list[list[str]]:
    head = [tr("Wheel"), "z", *(tr("{symbol}, mm").format(symbol=symbol) for symbol in ("d", "d_a", "d_f"))]
    return [head, *map(_row, _wheels(project))]


def _row(wheel: _Wheel) -> list[str]:
    addendum, clearance = wheel.rack
    d, tip, root = wheel.teeth, 2 * wheel.out * addendum, -2 * wheel.out * (addendum + clearance)
    return [wheel.name, str(wheel.teeth), *(number(1e3 * wheel.module * teeth, 5) for teeth in (d, d + tip, d + root))]


def _wheels(project: Project) -> list[_Wheel]:
    found = _of_train(project.train) if project.variant.train is not None else _of_reducer(project.reducer)
    return sorted({wheel.name: wheel for wheel in found}.values(), key=lambda wheel: (int(wheel.name.rstrip("′")), wheel.name))


def _of_train(train: Train) -> Iterator[_Wheel]:
    if train.warnings:
        return
    for m in train.meshes:
        for name, out in ((m.central, m.sign), (m.planet, 1)):
            yield _Wheel(name, train.data.teeth[name], train.data.module, out, (ADDENDUM, CLEARANCE))


def _of_reducer(reducer: Reducer) -> Iterator[_Wheel]:
    rack = reducer.data.addendum, reducer.data.clearance
    for stage in reducer.stages:
        signs = stage.signs[0], 1, 1, stage.signs[1]
        for wheel, out in zip(stage.wheels, signs, strict=True):
            yield _Wheel(wheel.number, int(wheel.teeth), wheel.diameter / wheel.teeth, out, rack)
    for wheel in reducer.simple or ():
        yield _Wheel(wheel.number, int(wheel.teeth), wheel.diameter / wheel.teeth, 1, rack)


table = Table(_title, _rows, (0.2,) * 5)
"""Every wheel with its tooth number and its pitch, tip and root diameters, mm, as they are without shifts (GOST 16532).

None for a train that needs shifts.
"""
