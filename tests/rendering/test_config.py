"""A configuration, in code or in YAML, adds what the same arguments add."""

import numpy as np
import pytest
from plant_scenes import over_a_slab
from pydrake.geometry import Box
from pydrake.math import RigidTransform

from drake_haptics import (
    ApplyHapticRenderingConfig,
    ContactParameters,
    Effects,
    FrictionParameters,
    HapticRenderingConfig,
    Material,
    SceneError,
    load_haptic_rendering_config,
)
from drake_haptics.scene.validation import SceneWarning

CUBE = Box(0.04, 0.04, 0.04)
YAML = """
tool_body: tool
environment: [slab]
contact: {tolerance_m: 1e-3, stiffness_N_per_m: 1e3, damping_Ns_per_m: 3.0}
materials:
  slab: {stiffness_N_per_m: 2e3}
effects:
  friction: {coefficient: 0.4}
X_HT: {position_m: [0, 0, 0.1]}
name: config
"""
ARGUMENTS = {
    "environment": ["slab"],
    "contact": ContactParameters(
        tolerance_m=1e-3, stiffness_N_per_m=1e3, damping_Ns_per_m=3.0
    ),
    "materials": {"slab": Material(stiffness_N_per_m=2e3)},
    "effects": Effects(friction=FrictionParameters(coefficient=0.4)),
}


def load(folder, text=YAML):
    (folder / "rendering.yaml").write_text(text)
    return load_haptic_rendering_config(folder / "rendering.yaml")


def read_force(scene, rendering):
    """Returns the wrench on a tool that is pressed into the slab and moves along it."""
    scene.start(tool=RigidTransform([0, 0, 0.0199]))
    scene.simulator.AdvanceTo(0.05)
    return scene.read(rendering, "F_To_W")


def test_a_file_gives_the_values_that_stand_in_it_and_defaults(tmp_path):
    config = load(tmp_path)
    assert {name: getattr(config, name) for name in ARGUMENTS} == ARGUMENTS
    assert config.coupling is None and config.chord_error_m == 1e-4
    np.testing.assert_array_equal(
        config.X_HT.to_rigid_transform().translation(), [0, 0, 0.1]
    )


def test_it_adds_what_the_arguments_add(tmp_path):
    by_file, by_arguments = over_a_slab(CUBE), over_a_slab(CUBE)
    rendering = ApplyHapticRenderingConfig(
        load(tmp_path), by_file.builder, by_file.plant, by_file.scene_graph
    )
    assert rendering.get_name() == "config"
    same = by_arguments.render(**ARGUMENTS)
    F = read_force(by_file, rendering)
    assert F[5] > 0.1
    np.testing.assert_array_equal(F, read_force(by_arguments, same))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("tool_body: tool", "", "rendering.yaml: tool_body must name a body"),
        ("tool_body", "tol_body", "tol_body: unknown key; did you mean 'tool_body'"),
        ("name: config", "role: looks", "role must be one of proximity, illustr"),
        ("{coefficient: 0.4}", "0.4", "effects.friction: expected keys, found 0.4"),
        ("{stiffness_N_per_m: 2e3}", "soft", "materials.slab: expected keys, found"),
        ("environment: [slab]", "environment: slab", "environment: expected a list"),
    ],
)
def test_a_wrong_key_is_named(tmp_path, old, new, message):
    with pytest.raises(SceneError, match=message):
        load(tmp_path, YAML.replace(old, new))


@pytest.mark.parametrize(
    ("wrong", "error", "message"),
    [
        ({"role": "looks"}, SceneError, "role must be one of"),
        ({"X_HT": RigidTransform()}, TypeError, r"^X_HT must be a .*\.Pose, is "),
        ({"X_HT": None}, TypeError, r"^X_HT must be a .*\.Pose, is "),
    ],
)
def test_a_wrong_value_is_named_in_code_too(wrong, error, message):
    scene = over_a_slab(CUBE)
    with pytest.raises(error, match=message):
        ApplyHapticRenderingConfig(
            HapticRenderingConfig(tool_body="tool", **wrong),
            scene.builder,
            scene.plant,
            scene.scene_graph,
        )


def test_a_warning_names_the_line_of_the_caller():
    scene = over_a_slab(CUBE)
    stiff = ContactParameters(stiffness_N_per_m=1e9)
    with pytest.warns(SceneWarning, match="time_step") as caught:
        ApplyHapticRenderingConfig(
            HapticRenderingConfig(tool_body="tool", contact=stiff),
            scene.builder,
            scene.plant,
            scene.scene_graph,
        )
    assert {warning.filename for warning in caught} == {__file__}
