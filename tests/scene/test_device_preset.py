"""Presets: those that are shipped, and a user's file."""

import numpy as np
import pytest
from box_scenes import TOOL_HALF_HEIGHT, over_a_plate
from chai3d_specifications import find_specification
from other_arm import PRESET, write_preset

from drake_haptics.analysis.coupling_design import suggest_coupling
from drake_haptics.common.errors import SceneError
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.device_preset import (
    DevicePreset,
    list_device_presets,
    load_device_preset,
)
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import DeviceImperfections, EncoderParameters
from drake_haptics.simulation.run import run

PREMIUM = "phantom_premium_1_5_6dof"


@pytest.mark.parametrize("name", list_device_presets())
def test_the_figures_are_those_of_the_source_for_the_device_of_that_name(name):
    preset = load_device_preset(name)
    row = find_specification(preset.description)
    assert f"CHAI3D 3.2.0, {row['file']} (revision {row['revision']})" in preset.source
    for key, field, may_be_unknown in [
        ("max_force_N", "maxLinearForce", False),
        ("max_torque_Nm", "maxAngularTorque", False),
        ("max_stiffness_N_per_m", "maxLinearStiffness", True),
        ("max_rotational_stiffness_Nm_per_rad", "maxAngularStiffness", True),
        ("max_damping_Ns_per_m", "maxLinearDamping", True),
        ("max_rotational_damping_Nms_per_rad", "maxAngularDamping", True),
        ("workspace_radius_m", "workspaceRadius", False),
    ]:
        figure = float(row[field])
        expected = None if may_be_unknown and figure == 0.0 else figure
        assert getattr(preset, key) == expected, key
    assert preset.actuated_axes == (6 if row["actuatedRotation"] == "true" else 3)
    assert preset.has_model == (name == PREMIUM)


def test_a_preset_is_found_by_its_path_too():
    assert load_device_preset(list_device_presets()[PREMIUM]) == load_device_preset(
        PREMIUM
    )


def test_no_two_presets_are_one_device():
    descriptions = [
        load_device_preset(name).description for name in list_device_presets()
    ]
    models = [find_specification(words)["modelName"] for words in descriptions]
    assert len(set(models)) == len(models)


def test_the_motors_of_the_premium_are_those_of_its_public_model():
    motors = load_device_preset(PREMIUM).motors
    gears = np.array([13.3, 11.2, 11.2])
    np.testing.assert_allclose(motors.peak_torque_Nm[:3], 0.129 * gears, rtol=1e-3)
    np.testing.assert_allclose(
        motors.continuous_torque_Nm[:3], 0.0286 * gears, rtol=1e-2
    )
    np.testing.assert_allclose(
        motors.encoder_step_rad[:3], 2 * np.pi / 4000 / gears, rtol=5e-3
    )
    assert motors.joint_per_motor[2] == [0, -1, 1, 0, 0, 0]


def test_a_device_without_a_model_is_not_simulated(tmp_path):
    scene = over_a_plate(tmp_path, [(0.0, 0.0, 0.0, 0.05)])
    scene.device.preset = "omega_6"
    with pytest.raises(SceneError, match=r"omega\.6 .*run SCENE --device ADDRESS"):
        BuildHapticDiagram(scene)
    with pytest.raises(SceneError, match="gives a model"):
        suggest_coupling("omega_6", 1000.0)


SCENE = """
tool: {{mesh: {cube}, mass_kg: 0.1}}
environment: [{{name: plate, mesh: {plate}}}]
device: {{preset: arms/my_arm.yaml, twin: {{encoder: {{}}}}}}
hand:
  path:
    waypoints:
    - {{time_s: 0, position_m: [0, 0, 0.05]}}
    - {{time_s: 0.6, position_m: [0, 0, {z}]}}
"""


def test_an_arm_of_ones_own_is_felt_like_the_shipped_one(tmp_path):
    # The preset is relative to the scene, its model relative to the preset.
    write_preset(tmp_path / "arms")
    parts = over_a_plate(tmp_path, [(0.0, 0.0, 0.0, 0.05)])
    path = tmp_path / "scene.yaml"
    path.write_text(
        SCENE.format(
            cube=parts.tool.mesh,
            plate=parts.environment[0].mesh,
            z=0.01 + TOOL_HALF_HEIGHT - 0.01,
        )
    )
    scene = load_scene(path)
    assert scene.device.twin == DeviceImperfections(encoder=EncoderParameters())
    haptic = BuildHapticDiagram(scene)
    assert haptic.loop.device.max_force_N == 5.0
    arm = haptic.loop.device.GetSubsystemByName("simulated_arm")
    assert arm.GetSubsystemByName("arm").HasBodyNamed("jib")
    # The hand, of 300 N/m, is stopped 1 cm early.
    assert 1.0 < run(haptic, 0.9).to_dict()["max_force_N"] < 4.0


def test_a_preset_that_was_edited_is_read_again(tmp_path):
    path = write_preset(tmp_path)
    load_device_preset(str(path)).motors.encoder_step_rad[0] = 7.0
    assert load_device_preset(str(path)).motors.encoder_step_rad[0] == 1e-4
    path.write_text(PRESET.replace("max_force_N: 5.0", "max_force_N: 6.25"))
    assert load_device_preset(str(path)).max_force_N == 6.25


def test_a_coupling_is_suggested_for_an_arm_of_ones_own(tmp_path):
    design = suggest_coupling(str(write_preset(tmp_path)), 1000.0)
    assert design.coupling.stiffness_N_per_m > 0.0


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ("max_force_N: 5.0", "max_force: 5.0", "max_force: unknown key; did you mean"),
        ("max_force_N: 5.0", "max_force_N: 0", r"max_force_N must be positive, is 0"),
        ("max_force_N: 5.0", "", r"max_force_N must be positive, is 0"),
        ("max_force_N: 5.0", "max_force_N: .inf", "max_force_N: expected a finite"),
        ("max_torque_Nm: 0.1", "max_torque_Nm: -1", "max_torque_Nm must not be neg"),
        ("radius_m: 0.1", "radius_m: 0", "workspace_radius_m must be positive"),
        ("-0.08]", "]", "workspace_center_m"),
        ("-0.08]", "-0.08, 1]", "workspace_center_m needs 3 numbers, is"),
        ("motors:", "actuated_axes: 5\nmotors:", "actuated_axes must be 3 or 6, is 5"),
        ("motors:", "actuated_axes: 3\nmotors:", "max_torque_Nm must be 0 on 3"),
        ("motors:", "actuated_axes: 6.5\nmotors:", "expected a whole number"),
        ("2e-4]", "]", r"motors\.encoder_step_rad"),
        ("2e-4]", "0]", r"motors\.encoder_step_rad\[5\] must be positive, is 0"),
        ("motors:", "motors:\n  coulomb_friction_Nm: [1]", "needs 6 numbers"),
        ("motors:", "motors:\n  joint_per_motor: [[1]]", "needs 6 rows of 6 numbers"),
        (
            "motors:",
            f"motors:\n  joint_per_motor: {[[0.0] * 6] * 6}",
            "must be invertible",
        ),
        ("my_arm.sdf", "no_arm.sdf", r"model does not exist: .*no_arm\.sdf"),
        ("source: measured", "source: [", "cannot be read as YAML"),
    ],
)
def test_what_is_wrong_in_a_preset_is_named_with_file_and_key(
    tmp_path, old, new, complaint
):
    assert PRESET.count(old) == 1 or old == "2e-4]"
    path = write_preset(tmp_path, PRESET.replace(old, new))
    with pytest.raises(SceneError, match=rf"my_arm\.yaml: .*{complaint}"):
        load_device_preset(str(path))


def test_a_preset_file_that_is_not_there_is_named():
    with pytest.raises(SceneError, match=r"nowhere\.yaml: .*cannot be opened: No such"):
        load_device_preset("nowhere.yaml")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('name="base"', 'name="foot"'),
        ('<joint name="grip_joint" type="revolute">', '<joint name="j" type="fixed">'),
        ("</sdf>", ""),
    ],
)
def test_a_model_that_is_no_arm_is_named(tmp_path, old, new):
    preset = write_preset(tmp_path)
    model = tmp_path / "my_arm.sdf"
    assert old in model.read_text()
    model.write_text(model.read_text().replace(old, new))
    scene = over_a_plate(tmp_path, [(0.0, 0.0, 0.0, 0.05)])
    scene.device.preset = str(preset)
    with pytest.raises(SceneError, match=r"my_arm\.sdf"):
        BuildHapticDiagram(scene)


def test_an_unknown_link_is_named(tmp_path):
    text = PRESET.replace("handle_link: grip", "handle_link: knob")
    scene = over_a_plate(tmp_path, [(0.0, 0.0, 0.0, 0.05)])
    scene.device.preset = str(write_preset(tmp_path, text))
    with pytest.raises(SceneError, match=r"my_arm\.sdf: .*knob"):
        BuildHapticDiagram(scene)


def test_the_defaults_are_no_device():
    assert not DevicePreset().has_model
