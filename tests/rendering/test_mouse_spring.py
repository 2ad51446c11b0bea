"""Meshcat's mouse pulls beside haptic contact, whichever was added first."""

from __future__ import annotations

import numpy as np
import pytest
from meshcat_page import MeshcatPage
from plant_scenes import G, PlantScene, over_a_slab
from pydrake.geometry import Box, Meshcat
from pydrake.math import RigidTransform
from pydrake.visualization import ApplyVisualizationConfig, VisualizationConfig

from drake_haptics import AddAppliedSpatialForce
from drake_haptics.scene.schema import ContactParameters

pytestmark = pytest.mark.skipif(
    not hasattr(VisualizationConfig(), "mouse_interaction_stiffness"),
    reason="this Drake's Meshcat has no mouse spring: it came after Drake 1.56",
)

MASS, SIDE_M, PULL_M = 0.1, 0.04, 0.01
STIFFNESS_PER_S2 = 400.0
CONTACT = ContactParameters(stiffness_N_per_m=2e3, damping_Ns_per_m=5.0)
REST_M = SIDE_M / 2.0 + CONTACT.tolerance_m - MASS * G / CONTACT.stiffness_N_per_m


def add_mouse(scene: PlantScene, meshcat: Meshcat) -> None:
    """Adds Drake's visualization with a mouse spring."""
    config = VisualizationConfig()
    config.mouse_interaction_stiffness = STIFFNESS_PER_S2
    ApplyVisualizationConfig(config, scene.builder, meshcat=meshcat)


@pytest.mark.parametrize("first", ["mouse", "rendering"])
def test_the_mouse_pulls_beside_contact(first):
    """Its force is mass times stiffness times the pull; contact bears the weight."""
    cube = Box(SIDE_M, SIDE_M, SIDE_M)
    scene = over_a_slab(cube, "cube", mass=MASS, side=SIDE_M)
    meshcat = Meshcat()
    plant, builder = scene.plant, scene.builder
    if first == "mouse":
        add_mouse(scene, meshcat)
    rendering = scene.render("cube", contact=CONTACT)
    if first == "rendering":
        # As docs/compose.md has it.
        forces = rendering.GetOutputPort("applied_spatial_force")
        builder.Disconnect(forces, plant.get_applied_spatial_force_input_port())
        add_mouse(scene, meshcat)
        AddAppliedSpatialForce(builder, plant, forces)
    scene.start(cube=RigidTransform([0.0, 0.0, REST_M]))
    scene.simulator.AdvanceTo(0.01)
    with MeshcatPage(meshcat) as page:
        page.send_drag("/drake/proximity/cube", [0, 0, REST_M], [0, 0, REST_M + PULL_M])
        scene.simulator.AdvanceTo(0.011)
        applied = plant.get_applied_spatial_force_input_port().Eval(scene.context)
        assert {int(force.body_index) for force in applied} == {
            int(plant.GetBodyByName("cube").index())
        }
        total = np.sum([force.F_Bq_W.translational() for force in applied], axis=0)
        # The cube has hardly begun to move within one step.
        pull_N = MASS * STIFFNESS_PER_S2 * PULL_M
        assert total == pytest.approx([0.0, 0.0, MASS * G + pull_N], abs=0.05 * pull_N)
        contact = scene.read(rendering, "F_To_W")
        assert contact[5] == pytest.approx(MASS * G, rel=0.05)
        scene.simulator.AdvanceTo(1.0)
        # Contact bears what the mouse does not: the cube has risen by as much.
        raised_m = REST_M + pull_N / CONTACT.stiffness_N_per_m
        assert scene.pose("cube").translation()[2] == pytest.approx(raised_m, abs=1e-5)
        page.send_drag("", [], [])
        scene.simulator.AdvanceTo(2.0)
    assert scene.pose("cube").translation()[2] == pytest.approx(REST_M, abs=1e-5)
