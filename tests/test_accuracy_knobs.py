"""The price list is complete: no public option without a row."""

import dataclasses
import types
import typing

import pytest

from drake_haptics.accuracy.knobs import (
    AS_IT_IS,
    KNOBS,
    list_few_settings,
    list_settings,
    make_reference,
)
from drake_haptics.accuracy.not_knobs import NOT_KNOBS
from drake_haptics.scene import Scene, load_scene
from drake_haptics.scene_check import check_values
from drake_haptics.scene_library import find_scene, list_scenes

SCENES = list(list_scenes())


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


def _is_told(key, knob_keys):
    parts = key.split(".")
    beginnings = {".".join(parts[: i + 1]) for i in range(len(parts))}
    return key in knob_keys or bool(beginnings & NOT_KNOBS.keys())


def test_every_key_is_a_knob_or_says_why_not():
    keys = list(_walk_keys(Scene))
    knob_keys = {key for knob in KNOBS for key in knob.keys}
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
    knob_keys = {key for knob in KNOBS for key in knob.keys}
    assert (knob_keys | NOT_KNOBS.keys()) - keys == set()
    assert knob_keys & NOT_KNOBS.keys() == set()


@pytest.mark.parametrize("name", SCENES)
def test_every_setting_is_another_possible_scene(name):
    scene = _load(name)
    settings = list_settings(scene)
    assert settings[0] == AS_IT_IS and settings[0].apply(scene) == scene
    changed = [setting.apply(scene) for setting in settings]
    for one in changed:
        check_values(one)
    for i, one in enumerate(changed):
        assert all(one != other for other in changed[:i]), settings[i]


@pytest.mark.parametrize("name", SCENES)
def test_every_knob_sets_its_own_keys_only(name):
    scene = _load(name)
    before = dataclasses.asdict(scene)
    for knob in KNOBS:
        for setting in knob.list_settings(scene):
            assert set(setting.changes) & set(knob.keys), setting
            assert dataclasses.asdict(scene) == before


def test_the_scene_has_a_setting_of_every_effect():
    changed = {s.knob: s for s in list_settings(_load("rubbed_sphere"))}
    for name in ("shading", "friction", "braking", "gravity", "passivity"):
        assert changed[f"effects.{name}"].label == f"no {name}"
        assert changed[f"effects.{name}"].changes[f"effects.{name}"] is None
    added = {s.knob: s for s in list_settings(_load("cup_spoon"))}
    applied = added["effects.gravity"].apply(_load("cup_spoon"))
    assert applied.effects.gravity.acceleration_m_per_s2 == [0.0, 0.0, -9.81]


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
    scene.tool.decomposition = scene.environment[0].decomposition = "hull"
    scene.contact.tolerance_m = 0.7e-3
    exact = make_reference(scene).apply(scene)
    assert exact.tool.decomposition == exact.environment[0].decomposition == "surface"
    assert exact.contact == scene.contact
    assert exact.effects == scene.effects
