"""The price list is complete: no public option without a row."""

import dataclasses
import types
import typing

import pytest

from drake_haptics.evaluation.accuracy.knobs import (
    AS_IT_IS,
    KNOBS,
    list_few_settings,
    list_settings,
    make_reference,
)
from drake_haptics.geometry.parsing.model_file import is_model_file
from drake_haptics.scene.library import find_scene, list_scenes
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import GravityParameters, Scene
from drake_haptics.scene.validation import check_values

SCENES = [
    name
    for name, path in list_scenes().items()
    if load_scene(path).contact.law == "penalty"
]
# A key, or a part with all that is in it: why no accuracy is bought or sold with it.
NOT_KNOBS = {
    "description": "is for people",
    "tool.mesh": "is what is held",
    "tool.scale": "is its size",
    "tool.center": "is where its frame is",
    "tool.mass_kg": "is its mass",
    "tool.grasp": "is how it is held",
    "environment.name": "is for people",
    "environment.mesh": "is what is there",
    "environment.scale": "is its size",
    "environment.center": "is where its frame is",
    "environment.pose": "is where it stands",
    "environment.material": "is what it is made of",
    "contact.law": "is another model; the study is of the penalty law alone",
    "contact.skin_m": "is of the constraint law",
    "contact.stiffness_N_per_m": "is how hard things are; every value takes as long",
    "contact.damping_Ns_per_m": "is how things bounce; every value takes as long",
    "coupling": "is how firmly the handle holds the tool; every value takes as long",
    "device.preset": "is the device",
    "device.base": "is where it stands",
    "device.max_force_N": "is what it may show",
    "device.max_torque_Nm": "is what it may show",
    "device.servo_rate_hz": "is of the constraint law",
    "device.twin": "is what a simulated device has of a real one's faults",
    "hand": "is who holds it, and where it goes",
    "effects.shading.crease_angle_deg": "is which edges are meant to be sharp",
    "effects.friction.coefficient": "is how rough things are",
    "effects.friction.break_away_m": "is how they give way before they slip",
    "effects.braking.damping_Ns_per_m": "is how firmly it brakes",
    "effects.braking.distance_m": "is where it begins to brake",
    "effects.gravity.acceleration_m_per_s2": "is where on earth the scene is",
    "effects.passivity.max_damping_Ns_per_m": "is how firmly energy is taken",
    "effects.passivity.max_rotational_damping_Nms_per_rad": "is the same in rotation",
    "effects.passivity.reserve_J": "is how much energy is the scene's own",
}


def _walk_keys(schema, where=""):
    """Yields every key of a scene file, of parts that may be missing too."""
    for name, hint in typing.get_type_hints(schema).items():
        key = f"{where}{name}"
        yield key
        kinds = typing.get_args(hint) or (hint,)
        assert typing.get_origin(hint) in (None, list, types.UnionType, typing.Union)
        for kind in kinds:
            if dataclasses.is_dataclass(kind):
                yield from _walk_keys(kind, f"{key}.")


def _load(name):
    return load_scene(find_scene(name))


def _list_knob_keys():
    scenes = [_load(name) for name in SCENES]
    # No shipped object is a model file, of which alone round shapes are known.
    model = next(scene.tool.mesh for scene in scenes if is_model_file(scene.tool.mesh))
    scenes.append(_load("cup_spoon"))
    scenes[-1].environment[0].mesh = model
    changes = [s.changes for scene in scenes for s in list_settings(scene)]
    return {key for each in changes for key in each}


def _is_told(key, knob_keys):
    parts = key.split(".")
    beginnings = {".".join(parts[: i + 1]) for i in range(len(parts))}
    return key in knob_keys or bool(beginnings & NOT_KNOBS.keys())


def test_every_key_is_a_knob_or_says_why_not():
    keys = list(_walk_keys(Scene))
    knob_keys = _list_knob_keys()
    # A part whose every key is told of is told of.
    leaves = [
        key for key in keys if not any(other.startswith(f"{key}.") for other in keys)
    ]
    untold = [key for key in leaves if not _is_told(key, knob_keys)]
    assert untold == []
    # Each effect is a knob as a whole as well.
    assert {
        key for key in keys if key.count(".") == 1 and key.startswith("effects.")
    } <= (knob_keys)


def test_no_line_is_of_a_key_that_is_gone():
    keys = set(_walk_keys(Scene))
    knob_keys = _list_knob_keys()
    assert (knob_keys | NOT_KNOBS.keys()) - keys == set()
    assert knob_keys & NOT_KNOBS.keys() == set()


@pytest.mark.parametrize("name", SCENES)
def test_every_setting_is_a_possible_scene(name):
    scene = _load(name)
    assert list_settings(scene)[0] == AS_IT_IS
    for setting in list_settings(scene):
        check_values(setting.apply(scene))


@pytest.mark.parametrize("name", SCENES)
def test_every_knob_has_the_scenes_own_setting_once(name):
    scene = _load(name)
    for list_knob in KNOBS:
        settings = list_knob(scene)
        changed = [setting.apply(scene) for setting in settings]
        for i, one in enumerate(changed):
            assert all(one != other for other in changed[:i]), settings
        if changed:
            assert changed.count(scene) == 1, settings


@pytest.mark.parametrize("name", SCENES)
def test_every_setting_of_a_knob_sets_its_key_and_leaves_the_scene(name):
    scene = _load(name)
    before = dataclasses.asdict(scene)
    for setting in list_settings(scene)[1:]:
        assert setting.knob in setting.changes, setting
    assert dataclasses.asdict(scene) == before


def test_values_of_ones_own_are_among_the_settings():
    scene = _load("cup_spoon")
    scene.device.rate_hz = 800.0
    scene.contact.clustering, scene.contact.cluster_size_m = "octree", 7e-3
    scene.contact.tolerance_m = 0.0
    scene.contact.max_walk_steps, scene.contact.query_rate_hz = 3, 160.0
    scene.device.tick_budget_us = 300.0
    scene.tool.max_triangles = 100
    scene.tool.decomposition, scene.tool.decomposition_error_m = "merged", 2e-4
    scene.effects.gravity = GravityParameters([0.0, 1.0, -3.0])
    for list_knob in KNOBS:
        settings = list_knob(scene)
        if settings:
            assert [s.apply(scene) for s in settings].count(scene) == 1, settings
    rates = [s.label for s in list_settings(scene) if s.knob == "device.rate_hz"]
    assert rates == ["2000 Hz", "1000 Hz", "800 Hz", "500 Hz", "250 Hz"]


@pytest.mark.parametrize("name", ["rubbed_sphere", "cup_spoon"])
def test_an_effect_is_there_and_not_there(name):
    scene = _load(name)
    for effect in ("shading", "friction", "braking", "gravity", "passivity"):
        with_it, without = (
            setting.apply(scene)
            for setting in list_settings(scene)
            if setting.knob == f"effects.{effect}"
        )
        assert getattr(without.effects, effect) is None
        assert getattr(with_it.effects, effect) is not None
        check_values(without)


def test_labels_have_values_with_units():
    settings = list_settings(_load("cup_spoon"))
    for setting in settings:
        for key, value in setting.changes.items():
            if key.endswith("_m") and value is not None:
                assert f"{1e3 * value:.3g} mm" in setting.label
            if key.endswith("_hz") and value is not None:
                assert f"{value:g} Hz" in setting.label


def test_few_settings_have_one_of_each_knob():
    scene = _load("cup_spoon")
    knobs = [setting.knob for setting in list_few_settings(scene)]
    assert len(set(knobs)) == len(knobs)
    assert set(knobs) == {setting.knob for setting in list_settings(scene)}


def test_the_reference_is_exact_whatever_the_scene():
    scene = _load("cup_spoon")
    scene.environment[0].decomposition = "hull"
    scene.tool.decomposition, scene.tool.decomposition_error_m = "merged", 2e-4
    scene.tool.max_triangles = 100
    scene.contact.tolerance_m = 0.7e-3
    exact = make_reference(scene).apply(scene)
    assert exact.tool.decomposition == exact.environment[0].decomposition == "surface"
    assert exact.tool.decomposition_error_m is exact.tool.max_triangles is None
    assert exact.contact == scene.contact
    assert exact.effects == scene.effects
