"""The key `contact.law`: its names, what each law leaves out, and what is said."""

import math
import re

import pytest

from drake_haptics import SceneError, find_scene, list_scenes, load_scene
from drake_haptics.loop.contact import find_skins
from drake_haptics.scene.contact_law import (
    calc_first_touch,
    check_constraint_law,
    make_overlap_warning,
)
from drake_haptics.scene.schema import (
    BrakingParameters,
    ContactParameters,
    Effects,
    FrictionParameters,
    GravityParameters,
    Material,
    PassivityParameters,
    ShadingParameters,
)
from drake_haptics.scene.settings import change_scene
from drake_haptics.scene.validation import calc_skin_speed, check_rendering

CONSTRAINT = ContactParameters(law="constraint", skin_m=2e-4)
OF_PENALTY = {"shading": ShadingParameters(), "braking": BrakingParameters()}


def test_a_scene_is_by_the_penalty_law_unless_it_says_otherwise():
    assert ContactParameters().law == "penalty"
    laws = {name: load_scene(path).contact.law for name, path in list_scenes().items()}
    assert laws.pop("peg_in_hole") == laws.pop("nut_on_bolt") == "constraint"
    assert set(laws.values()) == {"penalty"}


def test_a_wrong_name_is_corrected():
    scene = load_scene(find_scene("cup_spoon"))
    with pytest.raises(SceneError, match="did you mean 'constraint'"):
        change_scene(scene, ["contact.law=constrain"])


@pytest.mark.parametrize("key", ["contact.skin_m", "environment[0].material.skin_m"])
def test_a_skin_is_above_zero(key):
    scene = load_scene(find_scene("peg_in_hole"))
    with pytest.raises(SceneError, match=r"skin_m must be positive, is 0\.0"):
        change_scene(scene, [f"{key}=0"])


def test_one_key_changes_the_law_and_back():
    for path in list_scenes().values():
        scene = load_scene(path)
        if any(getattr(scene.effects, name) is not None for name in OF_PENALTY):
            continue
        other = {"penalty": "constraint", "constraint": "penalty"}[scene.contact.law]
        changed = change_scene(scene, [f"contact.law={other}"])
        assert changed.contact.law == other
        again = change_scene(changed, [f"contact.law={scene.contact.law}"])
        assert again.contact == scene.contact


@pytest.mark.parametrize("name", OF_PENALTY)
def test_an_effect_on_springs_is_refused_by_name(name):
    effects = Effects(**{name: OF_PENALTY[name]})
    with pytest.raises(SceneError, match=rf"^effects\.{name} does nothing under"):
        check_constraint_law(CONSTRAINT, effects, sheds_load=False, materials={})


def test_all_that_does_nothing_is_named_at_once():
    scene = load_scene(find_scene("rubbed_sphere"))
    with pytest.raises(SceneError) as refused:
        change_scene(scene, ["contact.law=constraint", "device.tick_budget_us=400"])
    for key in [*(f"effects.{name}" for name in OF_PENALTY), "device.tick_budget_us"]:
        assert key in str(refused.value)
    assert "gravity" not in str(refused.value)
    slow = ContactParameters(law="constraint", query_rate_hz=500.0)
    with pytest.raises(SceneError, match=r"contact\.query_rate_hz"):
        check_constraint_law(slow, Effects(), sheds_load=False, materials={})


@pytest.mark.parametrize("gain", ["stiffness_N_per_m", "damping_Ns_per_m"])
def test_a_material_that_gives_way_is_refused_by_name(gain):
    scene = load_scene(find_scene("peg_in_hole"))
    key = f"environment[0].material.{gain}"
    with pytest.raises(SceneError, match=rf"^{re.escape(key)} does nothing under"):
        change_scene(scene, [f"{key}=10"])
    change_scene(scene, [f"{key}=10", "contact.law=penalty"])


def test_effects_that_need_no_spring_are_kept():
    effects = Effects(
        friction=FrictionParameters(),
        gravity=GravityParameters(),
        passivity=PassivityParameters(),
    )
    check_constraint_law(CONSTRAINT, effects, sheds_load=False, materials={})


def test_a_plant_takes_either_law_with_what_it_has():
    for contact in (ContactParameters(), CONSTRAINT):
        check_rendering(contact, {}, Effects(), None)
    slow = ContactParameters(law="constraint", query_rate_hz=500.0)
    with pytest.raises(SceneError, match=r"query_rate_hz does nothing"):
        check_rendering(slow, {}, Effects(), None)


def test_each_object_can_have_its_skin():
    materials = [Material(), Material(skin_m=5e-5)]
    assert find_skins(CONSTRAINT, materials) == [2e-4, 5e-5]


def test_contact_begins_at_the_skin_and_no_speed_skips_it():
    assert calc_first_touch(CONSTRAINT) == 2e-4
    assert calc_first_touch(ContactParameters()) == ContactParameters().tolerance_m
    assert calc_skin_speed(CONSTRAINT, 1e-3) == math.inf
    assert calc_skin_speed(ContactParameters(tolerance_m=1e-3), 1e-3) == 1.0


def test_only_an_overlap_is_asked_about():
    assert make_overlap_warning(0.0) == make_overlap_warning(-1e-4) == ""
    assert "2 mm deep" in make_overlap_warning(2e-3)
