"""The coupling of a scene on a device that is really held: every shipped preset."""

import warnings

import pytest
from box_scenes import over_a_plate
from fake_device import ScriptedDevice
from other_arm import PRESET, write_preset

from drake_haptics.bounds.held_handle import check_real_coupling, check_scene_coupling
from drake_haptics.cockpit.scene_changes import CouplingAdvice
from drake_haptics.common.errors import SceneError
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.loop.simulated_device import make_hand_path, make_simulated_device
from drake_haptics.scene.device_preset import list_device_presets, load_device_preset
from drake_haptics.scene.schema import ForceDelayParameters
from drake_haptics.scene.validation import SceneWarning

PREMIUM = "phantom_premium_1_5_6dof"
START = (0.0, 0.0, 0.0, 0.05)


class Unfelt(ScriptedDevice):
    """A handle without motors."""

    shows_force = False


def build(scene, device=None):
    """Builds a scene with a device; returns what was warned of."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", SceneWarning)
        BuildHapticDiagram(scene, device=device or ScriptedDevice())
    return [str(one.message) for one in caught if one.category is SceneWarning]


def is_rated(sentence):
    return "is rated for" in sentence


@pytest.mark.parametrize("stiffness", [800.0, 30_000.0])
@pytest.mark.parametrize("preset", list_device_presets())
def test_a_coupling_beyond_the_rating_of_any_preset_is_warned_of(
    tmp_path, preset, stiffness
):
    scene = over_a_plate(tmp_path, [START])
    assert scene.coupling.stiffness_N_per_m == 800.0
    scene.device.preset = preset
    scene.coupling.stiffness_N_per_m = stiffness
    said = [s for s in build(scene) if s.startswith("coupling.stiffness_N_per_m")]
    rated = load_device_preset(preset)
    assert any(map(is_rated, said)) == (stiffness > rated.max_stiffness_N_per_m)
    if stiffness == 30_000.0:
        assert f"{rated.max_stiffness_N_per_m:g} N/m" in said[0]
        assert rated.description in said[0] and "is 30000" in said[0]


@pytest.mark.parametrize(
    ("key", "rating"),
    [
        ("stiffness_N_per_m", 1000.0),
        ("damping_Ns_per_m", 5.0),
        ("rotational_stiffness_Nm_per_rad", 0.3),
        ("rotational_damping_Nms_per_rad", 0.004),
    ],
)
def test_each_rating_holds_by_itself_and_up_to_its_figure(tmp_path, key, rating):
    scene = over_a_plate(tmp_path, [START])
    scene.device.preset = "phantom_premium_3_0_6dof"
    scene.coupling.rotational_stiffness_Nm_per_rad = 0.3
    setattr(scene.coupling, key, rating)
    assert build(scene) == []
    setattr(scene.coupling, key, 1.001 * rating)
    (sentence,) = build(scene)
    assert sentence.startswith(f"coupling.{key} is ")
    assert f"is rated for {rating:g} " in sentence


def test_the_twin_is_held_in_the_loosest_grip_whatever_the_scene_names(tmp_path):
    scene = over_a_plate(tmp_path, [START])
    scene.coupling.rotational_stiffness_Nm_per_rad = 0.3
    for grip in ("light", "nominal", "firm", "none"):
        scene.hand.grip = grip
        (sentence,) = build(scene)
        assert sentence.startswith("coupling.damping_Ns_per_m is 2: not passive")
        assert sentence.endswith(
            "(in a light grip, assuming no delay, because device.twin.delay is not"
            " given)"
        )
    # The hand's 1 N·s/m and some of the arm's bear 0.9: 0.5 + 800 / 2000.
    scene.coupling.damping_Ns_per_m = 0.5
    assert build(scene) == []
    # The delay of the way to it counts, a tick here.
    scene.device.twin.delay = ForceDelayParameters(samples=1)
    (sentence,) = build(scene)
    assert "Colgate" in sentence
    assert sentence.endswith("(in a light grip, with a delay of 1 ms)")


def test_a_path_that_the_device_need_not_follow_hides_no_warning(tmp_path):
    scene = over_a_plate(tmp_path, [(0.0, 0.0, 0.0, 0.05), (1.0, 9.0, 0.0, 0.05)])
    with pytest.raises(SceneError, match=r"hand\.path"):
        BuildHapticDiagram(scene)
    scene.coupling.stiffness_N_per_m = 30_000.0
    said = build(scene)
    assert any(map(is_rated, said)) and any("Gil" in sentence for sentence in said)


def test_a_model_that_is_no_arm_is_an_error_on_a_real_device_too(tmp_path):
    scene = over_a_plate(tmp_path, [START])
    text = PRESET.replace("handle_link: grip", "handle_link: knob")
    scene.device.preset = str(write_preset(tmp_path, text))
    with pytest.raises(SceneError, match=r"my_arm\.sdf: .*knob"):
        build(scene)


def test_a_handle_without_motors_is_not_warned_of(tmp_path):
    scene = over_a_plate(tmp_path, [START])
    scene.device.preset = "touch"
    scene.coupling.stiffness_N_per_m = 30_000.0
    assert build(scene, Unfelt()) == []


def test_the_page_warns_by_the_ratings_where_there_is_no_twin(tmp_path):
    scene = over_a_plate(tmp_path, [START])
    scene.device.preset = "touch"
    advice = CouplingAdvice(scene)
    for is_real in (False, True):
        (bound,) = advice.check(scene, is_real=is_real)
        assert bound.key == "stiffness_N_per_m" and "400 N/m" in bound.words
    scene.coupling.stiffness_N_per_m = 400.0
    assert CouplingAdvice(scene).check(scene, is_real=True) == []


def test_the_page_warns_of_a_real_device_as_a_run_does(tmp_path):
    """In the loosest grip, whatever grip the scene names for its simulated hand."""
    scene = over_a_plate(tmp_path, [START])
    scene.hand.grip = "firm"
    advice = CouplingAdvice(scene)
    assert advice.has_hand
    said = [bound.sentence for bound in advice.check(scene, is_real=True)]
    assert said == check_real_coupling(scene)
    assert any("in a light grip" in sentence for sentence in said)
    simulated = advice.check(scene, is_real=False)
    assert not any("light" in bound.sentence for bound in simulated)
    assert len(simulated) < len(said)


def test_the_page_warns_of_a_simulated_device_as_a_run_does(tmp_path):
    """Also where a servo computes the wrench more often than the loop ticks."""
    scene = over_a_plate(tmp_path, [START])
    scene.coupling.stiffness_N_per_m, scene.coupling.damping_Ns_per_m = 15_000.0, 0.0
    device = make_simulated_device(scene, make_hand_path(scene.hand.path))
    broken = {}
    for servo_rate_hz in (None, 4000.0):
        scene.device.servo_rate_hz = servo_rate_hz
        bounds = CouplingAdvice(scene).check(scene, is_real=False)
        said = [bound.sentence for bound in bounds]
        assert said == check_scene_coupling(scene, device)
        broken[servo_rate_hz] = [words for words in said if "Colgate" in words]
    assert broken[None] and not broken[4000.0]


def test_why_the_simulated_hand_cannot_hold_the_handle_is_said(tmp_path):
    scene = over_a_plate(tmp_path, [START, (0.1, 5.0, 0.0, 0.05)])
    with pytest.warns(SceneWarning, match=r"simulated hand cannot .*: hand\.path"):
        advice = CouplingAdvice(scene)
    assert not advice.has_hand
