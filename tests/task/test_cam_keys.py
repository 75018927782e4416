"""Keys of [cam]: what each follower, law and closure must, may and must not have."""

import pytest

from tests import project_files
from tmm_sheets.errors import BadInput
from tmm_sheets.task import variant
from tmm_sheets.task.cam_table import EXAMPLES, FOLLOWER_KEYS

COMMON = {"law": '"sine"', "rise": '"100 deg"', "fall": '"70 deg"'}


def text(follower, **keys):
    lines = {"follower": f'"{follower}"'} | COMMON | {k: EXAMPLES[k] for k in FOLLOWER_KEYS[follower][0]} | keys
    return project_files.text() + "[cam]\n" + "\n".join(f"{k} = {v}" for k, v in lines.items() if v is not None)


def problems(source):
    with pytest.raises(BadInput) as e:
        variant.parse(source, "x.toml")
    return [(p.field, p.message, p.hint) for p in e.value.problems]


@pytest.mark.parametrize("follower", FOLLOWER_KEYS)
def test_a_follower_needs_its_keys_only(follower):
    cam = variant.parse(text(follower), "x.toml").cam
    assert cam.follower == follower
    assert (cam.parts, cam.closure, cam.spring_factor, cam.preload) == (8, "force", 1.75, 0.3)
    for key in FOLLOWER_KEYS[follower][0]:
        ((field, message, _),) = problems(text(follower, **{key: None}))
        assert field == f"cam.{key}"
        assert message.startswith(f'missing; follower = "{follower}" needs it, for example {key} = ')


def test_several_things_wrong_with_a_key_are_told_in_one_order():
    keys = ("pressure_angle", "arm", "swing", "eccentricity", "roller", "curvature_share", "rotation", "limit", "centre",
            "follower_inertia")
    found = problems(text("flat", **dict.fromkeys(keys, '"nonsense"')))
    assert [field for field, _, _ in found] == [f"cam.{key}" for key in keys for _ in range(2)]
    assert all("has no such key" in message for _, message, _ in found[1::2])
    assert not any("has no such key" in message for _, message, _ in found[::2])


@pytest.mark.parametrize(("follower", "key", "value"), [
    ("flat", "pressure_angle", '"30 deg"'), ("flat", "roller", '"5 mm"'), ("translating roller", "arm", '"90 mm"'),
    ("oscillating roller", "stroke", '"10 mm"'), ("oscillating roller", "eccentricity", '"1 mm"'),
    ("translating roller", "rotation", '"opposite"'), ("translating roller", "follower_inertia", '"0.1 kg m2"')])
def test_keys_of_other_followers_are_refused(follower, key, value):
    ((field, message, hint),) = problems(text(follower, **{key: value}))
    assert (field, message) == (f"cam.{key}", f'follower = "{follower}" has no such key')
    assert hint == f"its own keys are {', '.join((*FOLLOWER_KEYS[follower][0], *FOLLOWER_KEYS[follower][1]))}"


@pytest.mark.parametrize(("keys", "field", "said"), [
    ({"law": '"table"'}, "cam.table", 'law = "table" needs it'),
    ({"fall_law": '"table"'}, "cam.fall_table", 'fall_law = "table" needs it'),
    ({"table": "[[0, 1], [1, -1]]"}, "cam.table", 'with law = "table" only'),
    ({"law": '"table"', "table": "[[0.1, 1], [1, -1]]"}, "cam.table", "from 0 to 1, not from 0.1 to 1"),
    ({"law": '"table"', "table": "[[0, 1], [0.6, 0], [0.5, 0], [1, -1]]"}, "cam.table", "rise from pair to pair"),
    ({"law": '"sinus"'}, "cam.law", "sine"), ({"parts": "7"}, "cam.parts", "even number"),
    ({"parts": "2"}, "cam.parts", "4 or more"),
    ({"parts": "40"}, "cam.parts", "12 at most"), ({"preload": "1.2"}, "cam.preload", "between 0 and 1"),
    ({"spring_factor": "0.5"}, "cam.spring_factor", "from 1 to 5"),
    ({"closure": '"magnetic"'}, "cam.closure", "geometric"),
    ({"follower_mass": '"0 kg"'}, "cam.follower_mass", "greater than zero"),
    ({"speed": '"0 rpm"'}, "cam.speed", "greater than zero")])
def test_wrong_values_are_said(keys, field, said):
    found = problems(text("translating roller", **keys))
    assert field in {f for f, _, _ in found}
    assert any(said in message + hint for _, message, hint in found)


def test_second_disc_needs_a_roller():
    ((field, message, _),) = problems(text("flat", closure='"geometric"'))
    assert field == "cam.closure"
    assert "needs a roller" in message


def test_diagram_is_read():
    source = text("flat", law='"table"', table="[[0, 1], [0.5, 1], [0.5, -1], [1, -1]]", fall_law='"cosine"')
    cam = variant.parse(source, "x.toml").cam
    assert cam.diagram("table") == ([0.0, 0.5, 0.5, 1.0], [1.0, 1.0, -1.0, -1.0])
    assert cam.fall_law == "cosine"
