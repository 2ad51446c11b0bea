"""Forces from several sources all act on the plant."""

import numpy as np
import pytest
from pydrake.common.value import Value
from pydrake.multibody.math import SpatialForce
from pydrake.multibody.plant import (
    AddMultibodyPlantSceneGraph,
    ExternallyAppliedSpatialForce,
)
from pydrake.multibody.tree import SpatialInertia
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantValueSource

from drake_haptics import AddAppliedSpatialForce

MASS = 2.0


@pytest.fixture
def scene():
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, 0.0)
    body = plant.AddRigidBody("body", SpatialInertia.SolidSphereWithMass(MASS, 0.1))
    plant.mutable_gravity_field().set_gravity_vector(np.zeros(3))
    plant.Finalize()
    return builder, plant, body


def push(builder, body, f):
    """Returns the output of a source that pushes a body with the force f (3,) N."""
    force = ExternallyAppliedSpatialForce()
    force.body_index = body.index()
    force.F_Bq_W = SpatialForce(np.zeros(3), f)
    return builder.AddSystem(ConstantValueSource(Value([force]))).get_output_port()


def acceleration(builder, plant, body):
    diagram = builder.Build()
    context = plant.GetMyContextFromRoot(diagram.CreateDefaultContext())
    return body.EvalSpatialAccelerationInWorld(context).translational()


def test_one_force_is_connected_as_it_is(scene):
    builder, plant, body = scene
    AddAppliedSpatialForce(builder, plant, push(builder, body, [4.0, 0, 0]))
    assert len(builder.GetSystems()) == 3
    np.testing.assert_allclose(acceleration(*scene), [2.0, 0, 0])


@pytest.mark.parametrize("count", [2, 3, 5])
def test_all_forces_act(scene, count):
    builder, plant, body = scene
    for k in range(count):
        AddAppliedSpatialForce(builder, plant, push(builder, body, [0, 10.0**k, 0]))
    expected = sum(10.0**k for k in range(count)) / MASS
    np.testing.assert_allclose(acceleration(*scene), [0, expected, 0])


def test_a_force_that_the_user_connected_stays(scene):
    builder, plant, body = scene
    builder.Connect(
        push(builder, body, [0, 0, 6.0]), plant.get_applied_spatial_force_input_port()
    )
    AddAppliedSpatialForce(builder, plant, push(builder, body, [4.0, 0, 0]))
    np.testing.assert_allclose(acceleration(*scene), [2.0, 0, 3.0])


def test_an_exported_port_cannot_be_shared(scene):
    builder, plant, body = scene
    builder.ExportInput(plant.get_applied_spatial_force_input_port(), "applied")
    with pytest.raises(ValueError, match=r"'plant': its port .* is exported"):
        AddAppliedSpatialForce(builder, plant, push(builder, body, [4.0, 0, 0]))
