"""A whole plant with haptic rendering converts to AutoDiffXd, gradients and all."""

from itertools import product

import numpy as np
import pytest
from plant_scenes import PLANTS, G, PlantScene
from pydrake.autodiffutils import ExtractGradient, ExtractValue, InitializeAutoDiff
from pydrake.geometry import Box, Sphere
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.multibody.tree import PrismaticJoint
from pydrake.systems.framework import InputPortSelection, OutputPortSelection
from pydrake.systems.primitives import Linearize

from drake_haptics.scene.schema import BrakingParameters, ContactParameters, Effects

CONTACT = ContactParameters(stiffness_N_per_m=1e3, damping_Ns_per_m=3.0)
K, MASS = 1e3, 0.1
CUBE = Box(0.04, 0.04, 0.04)


def make_scene(effects):
    """Returns a tilted cube that presses with a corner on a slab and a ball."""
    scene = PlantScene(PLANTS["continuous"])
    scene.add("tool", CUBE, mass=0.1)
    scene.add("cart", Sphere(0.03), mass=0.2)
    scene.add_slab()
    scene.finalize()
    rendering = scene.render(contact=CONTACT, effects=effects)
    turned = RollPitchYaw(0.5, 0.4, 0.2)
    corners = 0.02 * np.array(list(product((-1, 1), repeat=3)))
    lowest = (corners @ turned.ToRotationMatrix().matrix().T)[:, 2].min()
    scene.start(
        tool=RigidTransform(turned, [0, 0, -lowest + 1e-3]),
        cart=RigidTransform([0.057, 0.003, 0.035]),
    )
    return scene, rendering


def change_of_velocity(scene, x):
    scene.plant.SetPositionsAndVelocities(scene.context, x)
    return scene.read(scene.plant, "generalized_acceleration")


@pytest.mark.parametrize("braked", [False, True])
def test_accelerations_in_contact_agree_with_central_differences(braked):
    scene, rendering = make_scene(
        Effects(braking=BrakingParameters() if braked else None)
    )
    plant = scene.plant
    x = plant.GetPositionsAndVelocities(scene.context).copy()
    nq = plant.num_positions()
    # On their way into contact, so that damping counts.
    x[nq:] = [0.1, -0.2, 0.3, 0.05, 0.02, -0.1, 0.2, 0.1, 0.0, -0.08, 0.0, 0.0]
    touched = {c.object_index for c in contacts_at(scene, rendering, x)}
    assert touched == {0, 1}
    direction = np.random.default_rng(0).normal(size=len(x))
    for start in (0, 7):
        q = x[start : start + 4]
        direction[start : start + 4] -= q * (q @ direction[start : start + 4])
    diagram = scene.diagram.ToAutoDiffXd()
    twin = diagram.GetSubsystemByName(plant.get_name())
    root = diagram.CreateDefaultContext()
    context = twin.GetMyMutableContextFromRoot(root)
    twin.SetPositionsAndVelocities(
        context, InitializeAutoDiff(x, direction.reshape(-1, 1)).ravel()
    )
    found = twin.GetOutputPort("generalized_acceleration").Eval(context)
    found = found.reshape(-1, 1)
    np.testing.assert_allclose(
        ExtractValue(found).ravel(), change_of_velocity(scene, x), rtol=1e-9, atol=1e-9
    )
    h = 1e-7
    expected = (
        change_of_velocity(scene, x + h * direction)
        - change_of_velocity(scene, x - h * direction)
    ) / (2 * h)
    if braked:
        braking = rendering.GetSubsystemByName("pre_contact_braking")
        assert np.linalg.norm(scene.read(braking, "F_O_W")) > 0.01
    gradient = ExtractGradient(found).ravel()
    np.testing.assert_allclose(
        gradient, expected, rtol=1e-6, atol=1e-6 * np.abs(expected).max()
    )
    assert (np.abs(gradient) > 1.0).all()


def contacts_at(scene, rendering, x):
    scene.plant.SetPositionsAndVelocities(scene.context, x)
    contacts = scene.read(rendering, "contacts")
    return [contacts[i] for i in range(len(contacts)) if contacts.distance[i] < 2e-3]


def add_slider(config):
    """Returns a cube that slides along z on a slab, at rest, and its rendering."""
    scene = PlantScene(config)
    tool = scene.add("tool", CUBE, mass=MASS)
    scene.add_slab()
    scene.plant.AddJoint(
        PrismaticJoint(
            "z", scene.plant.world_frame(), tool.body_frame(), [0.0, 0.0, 1.0]
        )
    )
    scene.finalize()
    scene.render(contact=ContactParameters(stiffness_N_per_m=K, damping_Ns_per_m=0.0))
    scene.start()
    rest = 0.02 + 2e-3 - MASS * G / K
    scene.plant.SetPositions(scene.context, [rest])
    return scene


@pytest.mark.parametrize("name", ["continuous", "unsampled"])
def test_drake_linearizes_contact_to_the_spring_that_it_is(name):
    scene = add_slider(PLANTS[name])
    linear = Linearize(
        scene.diagram,
        scene.root,
        InputPortSelection.kNoInput,
        OutputPortSelection.kNoOutput,
    )
    h, w2 = 1e-3, K / MASS
    expected = {
        "continuous": [[0.0, 1.0], [-w2, 0.0]],
        "unsampled": [[1.0 - h * h * w2, h], [-h * w2, 1.0]],
    }[name]
    np.testing.assert_allclose(linear.A(), expected, rtol=1e-9, atol=1e-9)
