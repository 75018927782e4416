"""The table of views: all that arrangements name is in it, and all that it names is there."""

import tomllib
from dataclasses import fields

import pytest

from tmm_sheets import catalogue, resources
from tmm_sheets.errors import BadInput
from tmm_sheets.project import Project
from tmm_sheets.sheets import composition
from tmm_sheets.sheets.views import VIEWS, ViewKind, arrangement, function

FUNCTIONS = [f.name for f in fields(ViewKind) if f.name not in ("shows", "every", "stands", "picture", "plan", "name")]
ARRANGEMENTS = sorted((resources.template("sheets")).glob("*.toml"))


def test_what_the_table_names_is_there():
    for name, view in VIEWS.items():
        for field in FUNCTIONS:
            assert not getattr(view, field) or callable(function(getattr(view, field))), (name, field)
        assert not view.every or VIEWS[view.every].parts, name


def test_every_offered_view_tells_its_sizes_and_every_view_is_used():
    used = set()
    for path in ARRANGEMENTS:
        data = tomllib.loads(path.read_text("utf-8"))
        assert all(VIEWS[view["draw"]].sizes for view in data.get("offer", []))
        used |= {view["draw"] for kind in ("view", "offer") for view in data.get(kind, [])}
    # The others are graphs of a column or stand for views that an arrangement has.
    assert VIEWS.keys() - used == {"flywheel.force_graph", "flywheel.moments", "flywheel.works"} | {
        view.every for view in VIEWS.values() if view.every} - used


def test_an_unknown_view_is_refused_with_the_nearest_one(tmp_path, monkeypatch):
    (tmp_path / "mine.toml").write_text('title = "A"\n[[view]]\ndraw = "kinematics.position_plan"\nbox = [20, 5, 400, 500]\n')
    monkeypatch.setattr("tmm_sheets.sheets.views.template", lambda name: tmp_path / name.removeprefix("sheets/"))
    with pytest.raises(BadInput, match=r'there is no view "kinematics\.position_plan"') as raised:
        arrangement("mine")
    assert "kinematics.position_plans" in str(raised.value.problems[0].hint)


def test_a_sheet_without_a_kind_of_view_is_not_arranged_for_it(monkeypatch):
    project = Project(catalogue.read("lugansk/shaper"))
    assert composition.placed_where(project, 1, lambda kind: kind.scale)
    monkeypatch.setattr(composition, "arranged", lambda *_: pytest.fail("arranged"))
    assert composition.placed_where(project, 3, lambda kind: kind.scale) == []
