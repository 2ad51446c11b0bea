"""Forces from several sources all act on the plant."""

import numpy as np
import pytest
from plant_scenes import PLANTS, PlantScene, make_push

from drake_haptics import AddAppliedSpatialForce

MASS = 2.0


@pytest.fixture
def scene():
    scene = PlantScene(PLANTS["continuous"])
    body = scene.add("body", mass=MASS)
    scene.finalize(gravity=0.0)
    return scene.builder, scene.plant, body


def acceleration(builder, plant, body):
    diagram = builder.Build()
    context = plant.GetMyContextFromRoot(diagram.CreateDefaultContext())
    return body.EvalSpatialAccelerationInWorld(context).translational()


def test_one_force_is_connected_as_it_is(scene):
    builder, plant, body = scene
    AddAppliedSpatialForce(builder, plant, make_push(builder, body, [4.0, 0, 0]))
    assert len(builder.GetSystems()) == 3
    np.testing.assert_allclose(acceleration(*scene), [2.0, 0, 0])


@pytest.mark.parametrize("count", [2, 3, 5])
def test_all_forces_act(scene, count):
    builder, plant, body = scene
    for k in range(count):
        AddAppliedSpatialForce(
            builder, plant, make_push(builder, body, [0, 10.0**k, 0])
        )
    expected = sum(10.0**k for k in range(count)) / MASS
    np.testing.assert_allclose(acceleration(*scene), [0, expected, 0])


def test_a_force_that_the_user_connected_stays(scene):
    builder, plant, body = scene
    builder.Connect(
        make_push(builder, body, [0, 0, 6.0]),
        plant.get_applied_spatial_force_input_port(),
    )
    AddAppliedSpatialForce(builder, plant, make_push(builder, body, [4.0, 0, 0]))
    np.testing.assert_allclose(acceleration(*scene), [2.0, 0, 3.0])


def test_an_exported_port_cannot_be_shared(scene):
    builder, plant, body = scene
    builder.ExportInput(plant.get_applied_spatial_force_input_port(), "applied")
    with pytest.raises(ValueError, match=r"'plant': its port .* is exported"):
        AddAppliedSpatialForce(builder, plant, make_push(builder, body, [4.0, 0, 0]))
