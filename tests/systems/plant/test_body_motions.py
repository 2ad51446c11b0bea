"""Poses and velocities of the bodies that take part, with their derivatives."""

import numpy as np
import pytest
from plant_scenes import PLANTS, PlantScene
from pydrake.autodiffutils import ExtractGradient, ExtractValue, InitializeAutoDiff
from pydrake.math import RigidTransform, RollPitchYaw

from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.systems.plant.body_motions import BodyMotions

OUTPUTS = ("X_WT", "V_WT", "X_WO_cart", "V_WO_cart")


def make_scene(config=PLANTS["continuous"]):
    """Returns a plant of three bodies, of which two are asked for, out of order."""
    scene = PlantScene(config)
    bodies = [scene.add(name) for name in ("cart", "other", "tool")]
    scene.finalize()
    motions = scene.builder.AddSystem(
        BodyMotions(bodies[2].index(), {"cart": bodies[0].index()})
    )
    plant, connect = scene.plant, scene.builder.Connect
    connect(plant.get_body_poses_output_port(), motions.GetInputPort("body_poses"))
    connect(
        plant.get_body_spatial_velocities_output_port(),
        motions.GetInputPort("body_spatial_velocities"),
    )
    return scene.start(), motions


def random_state(plant, seed):
    rng = np.random.default_rng(seed)
    x = rng.normal(size=plant.num_multibody_states())
    for i in range(3):
        x[7 * i : 7 * i + 4] /= np.linalg.norm(x[7 * i : 7 * i + 4])
    return x


@pytest.mark.parametrize("config", PLANTS.values(), ids=PLANTS)
def test_each_body_is_read_in_its_own_place(config):
    scene, motions = make_scene(config)
    scene.plant.SetPositionsAndVelocities(scene.context, random_state(scene.plant, 0))
    for body, suffix in [("tool", "T"), ("cart", "O_cart")]:
        q = scene.read(motions, f"X_W{suffix}")
        expected = pose_to_vector(scene.pose(body))
        np.testing.assert_allclose(q, expected, atol=1e-15)
        np.testing.assert_array_equal(
            scene.read(motions, f"V_W{suffix}"), scene.velocity(body)
        )


def test_the_velocity_is_that_of_the_pose():
    scene, motions = make_scene()
    X = RigidTransform(RollPitchYaw(0.4, -0.2, 2.0), [0.1, 0.2, 0.3])
    scene.plant.SetFloatingBaseBodyPoseInWorldFrame(
        scene.context, scene.plant.GetBodyByName("tool"), X
    )
    V = np.array([1.0, -2.0, 0.5, 0.3, 0.1, -0.4])
    scene.plant.SetVelocities(scene.context, [*np.zeros(12), *V])
    np.testing.assert_allclose(scene.read(motions, "V_WT"), V)
    q = scene.read(motions, "X_WT")
    w, xyz = q[0], q[1:4]
    # q' = 1/2 ω q in quaternions.
    change = 0.5 * np.array([-V[:3] @ xyz, *(w * V[:3] + np.cross(V[:3], xyz))])
    h = 1e-6
    step = RigidTransform(RollPitchYaw(*(h * V[:3])).ToRotationMatrix() @ X.rotation())
    moved = pose_to_vector(step)[:4]
    np.testing.assert_allclose((moved - q[:4]) / h, change, atol=1e-5)


@pytest.mark.parametrize("seed", range(3))
def test_derivatives_agree_with_central_differences(seed):
    scene, motions = make_scene()
    x = random_state(scene.plant, seed)

    def outputs(x):
        # A quaternion that is not normalized is not a pose: move on the sphere.
        scene.plant.SetPositionsAndVelocities(scene.context, x)
        return np.concatenate([scene.read(motions, name) for name in OUTPUTS])

    diagram = scene.diagram.ToAutoDiffXd()
    twins = {system.get_name(): system for system in diagram.GetSystems()}
    plant, twin = twins[scene.plant.get_name()], twins[motions.get_name()]
    root = diagram.CreateDefaultContext()
    direction = np.random.default_rng(seed + 100).normal(size=len(x))
    for i in range(3):
        q = x[7 * i : 7 * i + 4]
        direction[7 * i : 7 * i + 4] -= q * (q @ direction[7 * i : 7 * i + 4])
    plant.SetPositionsAndVelocities(
        plant.GetMyMutableContextFromRoot(root),
        InitializeAutoDiff(x, direction.reshape(-1, 1)).ravel(),
    )
    found = np.concatenate(
        [
            twin.GetOutputPort(name).Eval(twin.GetMyContextFromRoot(root))
            for name in OUTPUTS
        ]
    ).reshape(-1, 1)
    np.testing.assert_allclose(ExtractValue(found).ravel(), outputs(x), atol=1e-14)
    h = 1e-6
    expected = (outputs(x + h * direction) - outputs(x - h * direction)) / (2 * h)
    gradient = ExtractGradient(found).ravel()
    np.testing.assert_allclose(gradient, expected, rtol=1e-6, atol=1e-8)
    assert (np.abs(gradient) > 1e-3).sum() > 20
