"""A plant with haptic rendering inside diagrams inside diagrams moves as by itself."""

from __future__ import annotations

import numpy as np
import pytest
from plant_scenes import PLANTS, PlantScene, over_a_slab
from pydrake.geometry import Box
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Diagram, DiagramBuilder

from drake_haptics.scene.schema import ContactParameters, Effects, FrictionParameters

X_WCUBE = RigidTransform(RollPitchYaw(0.3, 0.2, 0.1), [0.0, 0.0, 0.05])


def make_scene(config: str) -> PlantScene:
    """A cube above a slab, with friction."""
    scene = over_a_slab(Box(0.04, 0.04, 0.04), "cube", config=PLANTS[config])
    scene.render(
        "cube",
        contact=ContactParameters(stiffness_N_per_m=2e3, damping_Ns_per_m=5.0),
        effects=Effects(friction=FrictionParameters()),
    )
    return scene


def fall(diagram: Diagram, scenes: list[PlantScene]) -> list[np.ndarray]:
    """Simulates 0.3 s; returns the state of each scene's plant."""
    simulator = Simulator(diagram)
    root = simulator.get_mutable_context()
    contexts = [scene.plant.GetMyMutableContextFromRoot(root) for scene in scenes]
    for scene, context in zip(scenes, contexts, strict=True):
        cube = scene.plant.GetBodyByName("cube")
        scene.plant.SetFloatingBaseBodyPoseInWorldFrame(context, cube, X_WCUBE)
    simulator.AdvanceTo(0.3)
    return [
        scene.plant.GetPositionsAndVelocities(context)
        for scene, context in zip(scenes, contexts, strict=True)
    ]


@pytest.mark.parametrize("config", ["sampled", "unsampled"])
def test_two_in_nested_diagrams_move_as_one_alone(config):
    """To the last bit, side by side and two levels deep."""
    alone = make_scene(config)
    [expected] = fall(alone.builder.Build(), [alone])
    scenes = [make_scene(config) for _ in range(2)]
    outer = DiagramBuilder()
    for n, scene in enumerate(scenes):
        middle = DiagramBuilder()
        middle.AddNamedSystem("inner", scene.builder.Build())
        outer.AddNamedSystem(f"middle{n}", middle.Build())
    for found in fall(outer.Build(), scenes):
        np.testing.assert_array_equal(found, expected)
    assert abs(expected[6]) < 0.05 and np.ptp(expected) > 0.0


def test_a_continuous_one_moves_as_alone():
    """Within the accuracy of an integrator that sees a larger state."""
    alone = make_scene("continuous")
    [expected] = fall(alone.builder.Build(), [alone])
    scene = make_scene("continuous")
    outer = DiagramBuilder()
    outer.AddSystem(scene.builder.Build())
    [found] = fall(outer.Build(), [scene])
    np.testing.assert_allclose(found, expected, atol=1e-9)
