"""What device and hand are at the handle, and the bounds that follow."""

import warnings

import numpy as np
import pytest
from box_scenes import over_a_plate
from pydrake.multibody.math import SpatialForce
from pydrake.multibody.plant import ExternallyAppliedSpatialForce

from drake_haptics.bounds.held_handle import calc_held_handle
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.validation import SceneWarning
from drake_haptics.systems.arm.hand_impedance import NOMINAL_GRIP

START = (0.0, 0.0, 0.0, 0.05)


def test_a_coupling_beyond_its_bounds_is_warned_of_by_key_and_bound(tmp_path):
    scene = over_a_plate(tmp_path, [START])
    with warnings.catch_warnings():
        warnings.simplefilter("error", SceneWarning)
        BuildHapticDiagram(scene)
    scene.coupling.stiffness_N_per_m = 1e5
    with pytest.warns(
        SceneWarning, match=r"coupling\.stiffness_N_per_m is 100000, but stable only"
    ):
        BuildHapticDiagram(scene)


def test_the_least_inertia_at_the_handle_is_that_of_a_push(tmp_path):
    # The published figures of the arm (models/devices), and the hand's on top.
    scene = over_a_plate(tmp_path, [START])
    device = BuildHapticDiagram(scene).loop.device
    plant = device.GetSubsystemByName("simulated_arm").GetSubsystemByName("arm")
    handle = plant.GetBodyByName("handle")
    held = calc_held_handle(plant, handle, NOMINAL_GRIP)
    # Truth: the acceleration that Drake gives a push, in many directions.
    context = plant.CreateDefaultContext()
    port = plant.get_applied_spatial_force_input_port()
    apparent = []
    for direction in np.random.default_rng(1).normal(size=(200, 3)):
        n = direction / np.linalg.norm(direction)
        push = ExternallyAppliedSpatialForce()
        push.body_index = handle.index()
        push.F_Bq_W = SpatialForce(np.zeros(3), n)
        port.FixValue(context, [push])
        A = handle.EvalSpatialAccelerationInWorld(context)
        apparent.append(1.0 / (n @ A.translational()))
    assert held.mass_kg <= min(apparent) <= 1.02 * held.mass_kg
    assert held.damping_Ns_per_m > NOMINAL_GRIP.damping_Ns_per_m
