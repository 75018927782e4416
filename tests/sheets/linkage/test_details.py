"""A crowd of letters goes into an enlarged detail, and nothing is named twice or by nobody; one rule says what is dense."""

from types import SimpleNamespace

import numpy as np
import pytest

from tmm_sheets.box import Box
from tmm_sheets.construction.scale import Scale
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Arc, Fill, Line, PlacedFrame
from tmm_sheets.sheets.linkage import details

PLACE = Box(100.0, 100.0, 200.0, 196.0)


def lever(*anchors, view="kinetics.lever"):
    """A lever with a letter at each of these points, mm, an arrow over all of them and a title."""
    canvas = Canvas()
    canvas.scales["lever"] = Scale("μ_V", 0.01, "(m/s)/mm")
    canvas.begin(Box(300.0, 100.0, 500.0, 300.0), "", view)
    canvas.title(Box(300.0, 100.0, 500.0, 300.0), "lever")
    pen = canvas.tracing("vector", "lever/b")
    pen.arrow(400 + 200j, 420 + 200j, "vector")
    pen.arrow(400 + 200j, 400 + 280j, "vector")
    canvas.tracing("construction", "lever/h").line(380 + 190j, 440 + 190j, "thin")
    canvas.tracing("point", "lever/p").dot(400 + 200j, 0.9)
    for k, at in enumerate(anchors):
        canvas.label(400 + 200j + at, f"h_{{{k}}}", height=2.5)
    canvas.begin(Box(600.0, 100.0, 700.0, 200.0), "", "other")
    canvas.label(401 + 200j, "other")
    return canvas


def row(count, step=2.0):
    return [step * k for k in range(count)]


@pytest.mark.parametrize(("anchors", "crowded"), [
    ([], 0), ([0.0], 0), (row(5), 0), (row(6), 6), ([0.0] * 9, 9), (row(9, 30.0), 0), ([*row(9), 60.0], 9),
    ([*row(10, 1.0), *(80 + z for z in row(9, 1.0))], 10),  # of two crowds the thicker
], ids=["none", "one", "few", "many", "coincident", "apart", "one far off", "two crowds"])  # fmt: skip
def test_what_is_a_crowd(anchors, crowded):
    canvas = lever(*anchors)
    found = details.crowds(canvas, ())
    assert [len(crowd.labels) for crowd in found] == [crowded] * bool(crowded)
    assert bool(details.dense_sizes(None, canvas, {})) is bool(crowded)
    for crowd in found:
        assert all(abs(label.anchor - crowd.centre) < crowd.reach for label in crowd.labels)


@pytest.mark.parametrize(("view", "found"), [("kinetics.lever", 1), ("kinetics.group", 1), ("kinetics.crank", 1), ("other", 0)])
def test_schemes_of_forces_have_their_crowds_alike(view, found):
    assert len(details.crowds(lever(*row(9), view=view), ())) == found


def test_a_polygon_has_corners_and_no_crowd():
    canvas = lever(*row(9))
    assert not details.crowds(canvas, {label.part for label in canvas.labels})


def test_nothing_on_the_sheet_nothing_dense():
    assert details.dense_sizes(None, Canvas(), {}) == []


def test_what_is_drawn_or_found_no_room_is_not_asked_again():
    canvas = lever(*row(9), *(80j + z for z in row(8)))
    canvas.labels[-1:] = []
    part = canvas.labels[0].part
    below = [label for label in canvas.labels if label.anchor.imag > 260]
    canvas.parts.append(canvas.parts[part])
    canvas.labels[:] = [label._replace(part=len(canvas.parts) - 1) if label in below else label for label in canvas.labels]
    first, second = details.crowds(canvas, ())
    assert details.nth_dense_place(None, canvas, {"nth": 1}) == [first]
    assert details.nth_dense_place(None, canvas, {"nth": 2}) == [second]
    canvas.begin(PLACE, "", details.VIEW)
    details.dense(None, canvas, PLACE, {"nth": 1})
    assert details.nth_dense_place(None, canvas, {"nth": 2})[0].centre == second.centre
    assert details.nth_dense_place(None, canvas, {"nth": 3}) == []


def test_letters_go_into_the_detail_and_its_lines_are_the_levers_enlarged():
    canvas = lever(*row(9), 60.0)
    before, lines = list(canvas.labels), len(canvas.marks)
    (found,) = details.crowds(canvas, ())
    details.dense(None, canvas, PLACE, {})
    assert sorted(label.text for label in canvas.labels) == sorted([*(label.text for label in before), "I"])
    half, middle = 40.0, PLACE.x0 + found.beside + 40.0 + 1j * (PLACE.y0 + 40.0)
    times = found.times(half)
    moved = {label.text: label for label in canvas.labels if abs(label.anchor - middle) < half}
    assert moved.keys() == {label.text for label in found.labels}
    for was in found.labels:
        assert abs(moved[was.text].anchor - middle - times * (was.anchor - found.centre)) < 1e-9
        assert moved[was.text].height == 3.5
    assert "".join(m.text for m in canvas.marks[lines:] if hasattr(m, "text")).startswith(f"I ({times:g}:1)".replace(".", ","))
    drawn = [m for m in canvas.marks[lines:] if isinstance(m, Line) and m.style in ("vector", "thin")]
    assert all(abs(z - middle) < half + 1e-9 for m in drawn for z in (m.a, m.b))
    tips = [m.points[0] for m in canvas.marks[lines:] if isinstance(m, Fill) and len(m.points) == 3]
    at = middle + times * (420 + 200j - found.centre)
    assert [abs(tip - at) < 1e-9 for tip in tips] == ([True] if abs(at - middle) < half else [])  # the other is outside
    circles = [m for m in canvas.marks[lines:] if isinstance(m, Arc)]
    assert [round(m.radius * f, 6) for m, f in zip(circles, (1, times), strict=True)] == [half, half]


@pytest.mark.parametrize(("points", "joined", "found"), [
    ([], [], []), ([0], [], []), ([0, 3], [], []), ([0, 6.9, 3.5], [], ["abc"]), ([0, 7.1, 3.5], [], []), ([0, 0.1, 0.2], [], []),
    ([0, 0.1, 6], [], []), ([0, 1], [], []), ([0, 1], ["ab"], ["ab"]), ([0, 2.1], ["ab"], []),
    ([0, 3, 3j, 1, 60, 63, 66], [], ["abcd", "efg"]),
], ids=["none", "one", "two", "three", "wider", "coincident", "two places", "near", "near and joined", "not near",
        "two crowds"])  # fmt: skip
def test_which_corners_have_no_room_for_their_letters(points, joined, found):
    named = {chr(ord("a") + k): complex(z) for k, z in enumerate(points)}
    crowds = details.points_together(named, tuple(details.Vector("F", *ends) for ends in joined))
    assert [names for names in map("".join, crowds) if not any(set(names) < set(other) for other in crowds)] == found


@pytest.mark.parametrize(("signs", "drawn", "left"), [
    ((), ["a"], None), (("a",), ["a"], []), (("a", "b"), ["a"], ["b"]), (("b",), ["a"], ["b"])])  # fmt: skip
def test_what_a_detail_draws_is_not_about_zero(signs, drawn, left):
    canvas = Canvas()
    canvas.begin(PLACE, "plan")
    canvas.note(PLACE, "≈ 0: ", signs)
    canvas.begin(PLACE, "another")
    canvas.note(PLACE, "≈ 0: ", ("a",))
    vectors, points = tuple(details.Vector(sign, "1", "2") for sign in drawn), {"1": 0j, "2": 1 + 0j}
    frame, scale = PlacedFrame(0, "plan", "", 0j, (1.0, 1.0)), Scale("μ_F", 1.0, "N/mm")
    corner = details.Corner(0, 0.5 + 0j, 0.5, scale, None, frame, 0, vectors, points, ("1", "2"))
    details.no_more_zero(canvas, corner)
    assert [note.said for note in canvas.notes] == [*([] if left == [] else [f"≈ 0: {', '.join(left or [])}"]), "≈ 0: a"]


@pytest.mark.parametrize(("tail", "head", "read"), [
    (40 + 0j, 0.5j, False),         # runs beside the other one from where both begin
    (40 + 4j, 0.5j, True),          # is apart farther out
    (40 + 0j, 1 + 0j, True),        # on one line with it
    (1 + 0.5j, 0.5j, False),        # all of it in the circle
    (-40 + 0j, 0.5j, True),         # comes from the other side
])  # fmt: skip
def test_a_name_leaves_a_plan_where_its_vector_is_one_of_a_bundle(tail, head, read):
    points = {"1": 40 + 0j, "2": 0j, "3": tail, "4": head}
    vectors = details.Vector("F", "1", "2"), details.Vector("G", "3", "4")
    frame, scale = PlacedFrame(0, "plan", "", 0j, (1.0, 1.0)), Scale("μ_F", 1.0, "N/mm")
    corner = details.Corner(0, 0j, 0.5, scale, None, frame, 0, vectors, points, ("2", "4"))
    assert corner._is_read(vectors[1], 2.0) is read


def test_details_are_numbered_as_they_stand_there():
    canvas = Canvas()
    assert details.next_name(canvas) == "I"
    for title in ("План сил", "I (5:1)", "II (2,5:1)"):
        canvas.begin(PLACE, title)
    assert details.next_name(canvas) == "III"
    assert np.unique(details.NAMES).size == len(details.NAMES)


class Drawn(dict):
    """A plan as it is read here: its points by name, in mm."""

    name, labels = "plan", ("0",)

    def __init__(self, points):
        super().__init__({n: SimpleNamespace(name=n, path=f"plan/{n}", symbol="", at=lambda k, z=z: z) for n, z in points.items()})


@pytest.mark.parametrize(("points", "lettered", "told"), [
    ({"p": 0, "a": 40, "b": 40j}, "pab", []),
    ({"p": 0, "a": 40, "b": 43, "c": 43 + 3j}, "pabc", [3]),
    ({"p": 0, "a": 40, "b": 43, "c": 43 + 3j}, "pab", []),             # a letter that is not drawn
    ({"p": 0, "a": 40, "b": 43, "c": 43 + 0.1j}, "pabc", []),          # two in one place have one letter
    ({"p": 0, "a": 40, "b": 43, "c": 43 + 3j, "d": 42 + 2j, "e": 3 + 1j, "f": 3 - 1j}, "pabcdef", [4]),
], ids=["none", "one", "not drawn", "coincident", "many"])  # fmt: skip
@pytest.mark.parametrize("enlarged", [False, True])
def test_what_is_dense_and_in_no_detail_is_told(points, lettered, told, enlarged, monkeypatch):
    plan, canvas = Drawn(points), Canvas()
    canvas.begin(PLACE, "Plan of velocities")
    canvas.scales["plan"] = Scale("μ_V", 1.0, "(m/s)/mm")
    frame = canvas.placed("plan", "0", 120 + 120j, 1.0)
    for name in lettered:
        at = complex(canvas.frames[frame](complex(points[name])))
        canvas.tracing("text", f"plan/{name}", "0", frame).label(at, name)
    vectors = [("V", plan["p"], step) for step in plan.values() if step is not plan["p"]]
    monkeypatch.setattr(details, "polygons_of", lambda project: {"plan": (plan, vectors)})
    if enlarged:
        for it in details.dense_corners(canvas, details.polygons_of(None), details.whole_polygons(canvas, ["plan"])):
            canvas.window(it.centre, it.reach + 1.5)
    found = [remark.values["count"] for remark in details.unread(None, 1, canvas)]
    assert found == ([] if enlarged else told)


@pytest.mark.parametrize(("anchors", "told"), [([], []), (row(5), []), (row(6), [6]), ([0.0] * 9, []), (row(9, 30.0), [])],
                         ids=["none", "few", "many", "coincident", "apart"])
def test_a_crowd_of_letters_in_no_detail_is_told(anchors, told):
    canvas = lever(*anchors)
    assert [remark.values["count"] for remark in details.unread(None, 1, canvas)] == told
    if told:
        canvas.begin(PLACE, "", details.VIEW)
        details.dense(None, canvas, PLACE, {})
        assert details.unread(None, 1, canvas) == []


def test_nothing_dense_on_a_sheet_without_plans():
    assert details.unread(None, 1, Canvas()) == []
