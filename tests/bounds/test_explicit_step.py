"""How stiff a spring may be on a body that moves in explicit steps."""

import numpy as np
import pytest
from plant_scenes import PLANTS, PlantScene
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.tree import RevoluteJoint, SpatialInertia

from drake_haptics.bounds.explicit_step import (
    calc_explicit_stiffness,
    calc_largest_point_mobility,
    calc_spatial_mobility,
    check_explicit_stiffness,
)

STEP = 1e-3
CORNERS = 0.02 * np.array([[1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [0.0, 0.0, 0.5]])


def spectral_radius(mass, stiffness, damping):
    """Of v' = v - h (K x + B v) / m, x' = x + h v'."""
    to_v = np.array([-STEP * stiffness / mass, 1 - STEP * damping / mass])
    return np.abs(np.linalg.eigvals([[1, 0] + STEP * to_v, to_v])).max()


@pytest.mark.parametrize("damping", [0.0, 1.0, 40.0, 150.0])
def test_the_bound_is_where_a_mass_on_a_spring_begins_to_grow(damping):
    bound = calc_explicit_stiffness(0.1, damping, STEP)
    assert spectral_radius(0.1, bound, damping) == pytest.approx(1.0, abs=1e-6)
    assert spectral_radius(0.1, 0.99 * bound, damping) <= 1.0 + 1e-9
    assert spectral_radius(0.1, 1.01 * bound, damping) > 1.001


def test_a_damper_that_is_too_strong_leaves_nothing():
    assert calc_explicit_stiffness(0.1, 201.0, STEP) < 0.0
    assert spectral_radius(0.1, 0.0, 201.0) > 1.0


def test_a_free_body_gives_way_most_at_its_farthest_corner():
    scene = PlantScene()
    body = scene.add("body", mass=0.2, side=0.04)
    plant = scene.finalize().plant
    inertia = 0.2 * 0.04**2 / 6
    expected = 1 / 0.2 + 3 * 0.02**2 / inertia
    found = calc_largest_point_mobility(plant, body, CORNERS)
    assert found == pytest.approx(expected)
    # Wherever it starts, and however it is turned.
    turned = RigidTransform(RotationMatrix.MakeXRotation(0.7), [1.0, 2.0, 3.0])
    plant.SetDefaultFloatingBaseBodyPose(body, turned)
    found = calc_largest_point_mobility(plant, body, CORNERS)
    assert found == pytest.approx(expected)


def test_a_body_on_a_hinge_moves_about_it_only():
    scene = PlantScene()
    arm = scene.plant.AddRigidBody("arm", SpatialInertia.SolidSphereWithMass(0.3, 0.01))
    world = scene.plant.world_frame()
    scene.plant.AddJoint(RevoluteJoint("hinge", world, arm.body_frame(), [0, 1, 0]))
    plant = scene.finalize().plant
    inertia = 0.4 * 0.3 * 0.01**2
    mobility = calc_spatial_mobility(plant, arm)
    np.testing.assert_allclose(
        mobility, np.diag([0, 1 / inertia, 0, 0, 0, 0]), atol=1e-9 / inertia
    )
    reach = np.array([[0.1, 5.0, 0.2]])
    found = calc_largest_point_mobility(plant, arm, reach)
    assert found == pytest.approx((0.1**2 + 0.2**2) / inertia)


def test_what_is_fixed_does_not_give_way():
    scene = PlantScene()
    slab = scene.add_slab()
    assert calc_largest_point_mobility(scene.finalize().plant, slab, CORNERS) == 0.0
    assert check_explicit_stiffness("slab", 1e9, 0.0, [0.0], STEP) is None


def test_bodies_at_both_ends_of_a_contact_give_way_together():
    assert check_explicit_stiffness("it", 1.9e5, 0.0, [10.0, 10.0], STEP) is None
    sentence = check_explicit_stiffness("it", 2.1e5, 0.0, [10.0, 10.0], STEP)
    for part in ("it: stiffness 210000 N/m", "0.05 kg", "2e+05 N/m", "time_step"):
        assert part in sentence


def test_where_no_stiffness_is_stable_none_is_proposed():
    sentence = check_explicit_stiffness("it", 10.0, 300.0, [10.0], STEP)
    assert "a stiffness below" not in sentence
    # 2 m / h of 0.1 kg and 1 ms; as much does not hold the softest spring.
    assert "4 m < 2 B h" in sentence and "a damping below 2 m/h = 200" in sentence
    assert check_explicit_stiffness("it", 10.0, 199.0, [10.0], STEP) is None


def test_a_continuous_plant_has_the_same_mobility():
    found = []
    for config in PLANTS.values():
        scene = PlantScene(config)
        body = scene.add("body")
        found.append(calc_largest_point_mobility(scene.finalize().plant, body, CORNERS))
    assert len(set(found)) == 1
