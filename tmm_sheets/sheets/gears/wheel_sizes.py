"""View for room left beside a reducer or a train: tooth numbers and diameters of its wheels."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tmm_sheets.numbers import number
from tmm_sheets.sheets.components.listed import Table
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.methods.gears.train import Train
    from tmm_sheets.project import Project


def _title(project: Project) -> str:
    data = _train(project).data
    return tr("Wheels without shift, h_a^{{*}} = {addendum}, c^{{*}} = {clearance}").format(
        addendum=number(data.addendum), clearance=number(data.clearance))


def rows(train: Train) -> list[list[str]]:
    """Heading and a row for each wheel; no rows with shifts."""
    head = [tr("Wheel"), "z", *(tr("{symbol}, mm").format(symbol=symbol) for symbol in ("d", "d_a", "d_f"))]
    if any(train.teeth(m) != train.teeth(train.stage(m)[0]) for m in train.meshes):
        return [head]
    found, data = dict[str, list[str]](), train.data
    for m in train.meshes:
        for name, out in ((m.central, m.sign), (m.planet, 1)):
            z, over, module = data.teeth[name], 2 * out, 1e3 * (m.module or data.module)
            d = (z, z + over * data.addendum, z - over * (data.addendum + data.clearance))
            found[name] = [name, str(z), *(number(module * teeth, 5) for teeth in d)]
    return [head, *(found[name] for name in train.wheels)]


def _train(project: Project) -> Train:
    return project.train if project.variant.train is not None else project.reducer


table = Table(_title, lambda project, canvas: rows(_train(project)), (0.2,) * 5)
"""Every wheel with its tooth number and its pitch, tip and root diameters, mm, as they are without shifts (GOST 16532).

None for a train that needs shifts.
"""
