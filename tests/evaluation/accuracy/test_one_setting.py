"""Settings come back from a command line as they were, and mistakes are told."""

import shlex

import pytest

from drake_haptics.common.errors import HapticsError
from drake_haptics.evaluation.accuracy.setting import (
    Setting,
    format_setting,
    read_setting,
)
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.validation import check_values


@pytest.fixture
def scene():
    return load_scene(find_scene("rubbed_sphere"))


CHANGES = [
    {},
    {"contact.tolerance_m": 5e-4},
    {"contact.tolerance_m": 1e-17, "contact.depth": "global"},
    {"effects.friction": None},
    {"hand.path.periodic": True, "tool.max_triangles": 200},
    {"tool.mesh": "a name with 'quotes' & $signs"},
    {"tool.mesh": "12"},
    {"tool.mesh": "null"},
    {"tool.grasp.rpy_deg": [0.0, 1.5, -3.0]},
]


@pytest.mark.parametrize("changes", CHANGES)
def test_a_setting_comes_back_from_a_shell(changes):
    options = shlex.split(format_setting(Setting("k", "l", changes)))
    assert set(options[::2]) == {"--only"}
    back = read_setting(options[1::2])
    assert back.changes == changes
    assert [type(v) for v in back.changes.values()] == [
        type(v) for v in changes.values()
    ]


def test_a_known_setting_brings_its_words():
    known = [Setting("contact.tolerance_m", "0.5 mm", {"contact.tolerance_m": 5e-4})]
    assert read_setting(["contact.tolerance_m=0.0005"], known) is known[0]
    other = read_setting(["contact.tolerance_m=0.0006"], known)
    assert (other.knob, other.label) == ("contact.tolerance_m", "0.0006")


@pytest.mark.parametrize("words", [["contact.depth"], ["scene", "a=1"], [""]])
def test_a_word_that_is_no_setting(words):
    with pytest.raises(HapticsError, match="is not of the form KEY=VALUE"):
        read_setting(words)


def test_a_key_that_is_there_twice():
    with pytest.raises(HapticsError, match=r"contact\.depth is given twice"):
        read_setting(["contact.depth=global", "contact.depth=tracked"])


@pytest.mark.parametrize(
    ("word", "complaint"),
    [
        ('effects.gravity={"g": 9.8}', r"effects\.gravity\.g"),
        ("environment.0.x=1", "environment.0.x: is not a key of a scene"),
        ("effects.friction=null", "friction_coefficient means nothing without"),
        ("environment.scale=[1]", r"environment\[0\].scale: expected a finite number"),
    ],
)
def test_a_setting_that_makes_no_scene(scene, word, complaint):
    with pytest.raises(HapticsError, match=complaint):
        check_values(read_setting([word]).apply(scene))


def test_a_setting_is_applied_to_a_copy(scene):
    setting = read_setting(["environment.scale=2", "contact.tolerance_m=0"])
    changed = setting.apply(scene)
    assert [item.scale for item in changed.environment] == [2]
    assert changed.contact.tolerance_m == 0
    assert scene.contact.tolerance_m == 1e-3 and scene.environment[0].scale == 1.0


def test_an_effect_that_the_scene_leaves_out_is_made():
    bare = load_scene(find_scene("sphere_pen"))
    for word in (
        "effects.friction.coefficient=0.3",
        'effects.friction={"coefficient": 0.3}',
    ):
        assert read_setting([word]).apply(bare).effects.friction.coefficient == 0.3
