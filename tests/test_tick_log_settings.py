"""Single values of a scene, set by their keys."""

import pytest
from box_scenes import over_a_plate

from drake_haptics.scene_check import SceneError
from drake_haptics.tick_log.scene_settings import change_scene


@pytest.fixture
def scene(tmp_path):
    return over_a_plate(tmp_path, [(0.0, 0.0, 0.0, 0.03)])


def test_numbers_texts_and_lists_are_set(scene):
    changed = change_scene(
        scene,
        [
            "contact.stiffness_N_per_m=4e3",
            "hand.grip=firm",
            "environment[0].pose.position_m=[0.1, 0, 0]",
            "hand.path.waypoints[0].position_m[2]=0.05",
        ],
    )
    assert changed.contact.stiffness_N_per_m == 4000.0
    assert changed.hand.grip == "firm"
    assert changed.environment[0].pose.position_m == [0.1, 0.0, 0.0]
    assert changed.hand.path.waypoints[0].position_m == [0.0, 0.0, 0.05]
    # Nothing else changes, nor does the scene that was given.
    assert scene.hand.grip == "nominal"
    assert changed.tool == scene.tool
    assert change_scene(scene, []) == scene


def test_an_effect_that_is_not_there_is_made(scene):
    changed = change_scene(scene, ["effects.friction.coefficient=0.7"])
    assert changed.effects.friction.coefficient == 0.7
    assert change_scene(changed, ["effects.friction="]) == scene


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("contact.stiffness_N_per_m", "KEY=VALUE"),
        ("contact.stifness_N_per_m=1", "did you mean 'stiffness_N_per_m'"),
        ("contact.stiffness_N_per_m=much", "expected a finite number"),
        ("contact.stiffness_N_per_m=-1", "contact.stiffness_N_per_m"),
        ("contact.stiffness_N_per_m=[", "cannot be read as YAML"),
        ("environment[3].scale=2", r"environment\[3\].scale: there is nothing at 3"),
        ("contact[0]=2", "nothing at 0"),
        ("environment.scale=2", "nothing at 'scale'"),
        ("contact.tolerance_m.deep=2", "nothing at 'deep'"),
        ("effects.braking=", "nothing at 'braking'"),
        ("=3", "no key"),
        ("a..b=3", "no key"),
        ("contact=3", "expected keys"),
    ],
)
def test_what_cannot_be_set_is_named(scene, setting, words):
    with pytest.raises(SceneError, match=words):
        change_scene(scene, [setting])
