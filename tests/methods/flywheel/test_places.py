"""Masses and moments of inertia keep the places that they have in the project file, whatever the order of its links."""

import pytest

from tests.project_files import from_file, project
from tmm_sheets.construction.step import GivenNumber


@pytest.mark.parametrize("turned_over", [False, True])
def test_masses_have_the_places_of_the_file(turned_over):
    data = from_file("lugansk/shaper")
    links = data["link"][::-1] if turned_over else data["link"]
    p = project(data | {"link": links})
    places = {table["name"]: i for i, table in enumerate(links)}
    found = set()
    r = p.reduced.numbered
    _ = r.inertia, p.reduced.crank, p.study.loads[2]
    for plan in (r.plan, p.reduced.crank_plan, p.study.loads[2]):
        for step in (*plan.auxiliaries.values(), *plan):
            for a in step.args:
                if isinstance(a, GivenNumber) and a.name.startswith("link["):
                    link = a.symbol.strip("J_{}Sm")
                    key = a.name.partition(".")[2]
                    assert a.name == f"link[{places[link]}].{key}"
                    assert p.variant.link[places[link]].name == link
                    assert float(a) == getattr(p.variant.link[places[link]], key)
                    found.add(a.name)
    assert len(found) >= 5


def test_a_crank_that_the_file_does_not_list_has_no_place_in_it():
    data = from_file("lugansk/shaper")
    p = project(data | {"link": [table for table in data["link"] if table["name"] != "1"]})
    assert not any(getattr(a, "name", "").startswith("link[") for a in p.reduced.crank.args)
    assert p.reduced.crank_inertia == 0
