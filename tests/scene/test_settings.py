"""Single values of a scene, set by their keys."""

import shutil

import pytest
from box_scenes import over_a_plate

from drake_haptics.scene.settings import change_scene
from drake_haptics.scene.validation import SceneError


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
    assert change_scene(scene, ["environment.scale=2"]).environment[0].scale == 2.0
    # Nothing else changes, nor does the scene that was given.
    assert scene.hand.grip == "nominal"
    assert changed.tool == scene.tool
    assert change_scene(scene, []) == scene


def test_an_effect_that_is_not_there_is_made(scene):
    changed = change_scene(scene, ["effects.friction.coefficient=0.7"])
    assert changed.effects.friction.coefficient == 0.7
    assert change_scene(changed, ["effects.friction="]) == scene
    # Nor is one made to take something out of it.
    assert change_scene(scene, ["effects.friction.coefficient="]) == scene


def test_settings_that_need_each_other_count_together(scene):
    size, kind = "contact.cluster_size_m=1e-3", "contact.clustering=octree"
    assert change_scene(scene, [size, kind]) == change_scene(scene, [kind, size])


@pytest.mark.parametrize("name", ["stiffness_N_per_m", "damping_Ns_per_m"])
def test_a_value_that_all_materials_override_is_refused(scene, name):
    setting = f"contact.{name}=9"
    own = change_scene(scene, [f"environment.material.{name}=5"])
    with pytest.raises(
        SceneError, match=rf"^contact.{name} does nothing.*environment.material.{name}"
    ):
        change_scene(own, [setting])
    freed = change_scene(own, [setting, f"environment.material.{name}="])
    assert getattr(freed.contact, name) == 9.0


def test_files_are_found_from_the_current_folder(scene, tmp_path, monkeypatch):
    (tmp_path / "deep").mkdir()
    other = shutil.copy(scene.tool.mesh, tmp_path / "deep" / "other.obj")
    monkeypatch.chdir(tmp_path / "deep")
    assert change_scene(scene, ["tool.mesh=other.obj"]).tool.mesh == str(other)
    preset = change_scene(scene, ["device.preset=../arm.yaml"]).device.preset
    assert preset == str(tmp_path / "arm.yaml")


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("contact.stiffness_N_per_m", "KEY=VALUE"),
        ("contact.stifness_N_per_m=1", r"did you mean 'contact\.stiffness_N_per_m'"),
        ("break_away_m=1", "did you mean 'effects.friction.break_away_m'"),
        ("cantact.depth=global", "did you mean 'contact.depth'"),
        ("xyzzy=1", "every-key.yaml"),
        ("tool.mesh=nowhere.obj", "tool.mesh: .*nowhere.obj: no such file"),
        ("contact.stiffness_N_per_m=much", "expected a finite number"),
        ("contact.stiffness_N_per_m=-1", "contact.stiffness_N_per_m"),
        ("contact.stiffness_N_per_m=[", "cannot be read as YAML"),
        (
            "environment[3].scale=2",
            r"environment\[3\].scale: there is nothing at 3; the last is 0",
        ),
        ("contact[0]=2", "nothing at 0"),
        ("environment.weight=2", "not a key of a scene"),
        ("contact.tolerance_m.deep=2", "not a key of a scene"),
        ("effects.breaking=", "did you mean 'effects.braking"),
        ("=3", "not a key"),
        ("a..b=3", "not a key"),
        ("contact=3", "expected keys"),
        ("effects.friction={coefficient:0.2}", "YAML wants a space after the colon"),
    ],
)
def test_what_cannot_be_set_is_named(scene, setting, words):
    with pytest.raises(SceneError, match=words):
        change_scene(scene, [setting])
