"""Motions in another frame, against Drake's own transforms."""

import numpy as np
import pytest
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.multibody.math import SpatialVelocity

from drake_haptics._core import FrameChange
from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose


@pytest.mark.parametrize("seed", range(20))
def test_a_motion_is_the_one_that_drake_tells(seed):
    rng = np.random.default_rng(seed)
    X_AB, X_BH = (
        RigidTransform(RollPitchYaw(rng.uniform(-3, 3, 3)), rng.normal(size=3))
        for _ in range(2)
    )
    V_BH = rng.normal(size=6)
    change = FrameChange(pose_to_vector(X_AB))
    motion = change.change_motion(pose_to_vector(X_BH), V_BH)
    assert vector_to_pose(motion[:7]).IsNearlyEqualTo(X_AB @ X_BH, 1e-14)
    assert np.linalg.norm(motion[:4]) == pytest.approx(1.0, abs=1e-15)
    V_AH = SpatialVelocity(V_BH).Rotate(X_AB.rotation()).get_coeffs()
    np.testing.assert_allclose(motion[7:], V_AH, atol=1e-14)
    # A wrench is turned as a velocity is.
    np.testing.assert_allclose(change.change_wrench_back(V_AH), V_BH, atol=1e-14)


def test_slopes_give_in_either_frame_the_wrench_of_the_other():
    rng = np.random.default_rng(3)
    X_AB = RigidTransform(RollPitchYaw(0.3, -0.9, 2.0), [1.0, 2.0, 3.0])
    change = FrameChange(pose_to_vector(X_AB))
    slopes_A = rng.normal(size=(2, 6, 6))
    motion_B = rng.normal(size=6)
    motion_A = SpatialVelocity(motion_B).Rotate(X_AB.rotation()).get_coeffs()
    for in_A, in_B in zip(
        slopes_A, change.change_slopes_back(slopes_A.ravel()), strict=True
    ):
        wrench_B = change.change_wrench_back(in_A @ motion_A)
        np.testing.assert_allclose(in_B @ motion_B, wrench_B, atol=1e-13)


def test_a_pose_that_is_none_is_refused():
    with pytest.raises(ValueError, match="X_AB"):
        FrameChange(np.zeros(7))


def test_a_motion_that_is_not_finite_stays_so():
    change = FrameChange(np.array([1.0, 0, 0, 0, 0, 0, 0]))
    assert np.isnan(change.change_motion(np.full(7, np.nan), np.zeros(6))[:7]).all()


def test_a_reading_is_its_motion_and_then_its_numbers():
    rng = np.random.default_rng(5)
    X_AB = RigidTransform(RollPitchYaw(0.3, -0.9, 2.0), [1.0, 2.0, 3.0])
    change = FrameChange(pose_to_vector(X_AB))
    X_BH, V_BH, F_Ho_B = rng.normal(size=7), rng.normal(size=6), rng.normal(size=6)
    X_BH[:4] /= np.linalg.norm(X_BH[:4])
    told = [2**40, 0.25, 5, 3, 1]
    reading = change.change_reading(X_BH, V_BH, F_Ho_B, *told)
    motion = change.change_motion(X_BH, V_BH)
    assert reading.tolist() == [*motion, *X_BH, *V_BH, *F_Ho_B, *told]
    for i in range(6):
        V_BH[i] = [np.nan, np.inf][i % 2]
        with pytest.raises(FloatingPointError, match="not finite"):
            change.change_reading(X_BH, V_BH, F_Ho_B, *told)
        V_BH[i] = 0.0
