"""Motions in another frame, against Drake's own transforms."""

import numpy as np
import pytest
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.multibody.math import SpatialVelocity

from drake_haptics.frame_change import FrameChange
from drake_haptics.pose_vector import pose_to_vector, vector_to_pose


@pytest.mark.parametrize("seed", range(20))
def test_a_motion_is_the_one_that_drake_tells(seed):
    rng = np.random.default_rng(seed)
    X_AB, X_BH = (
        RigidTransform(RollPitchYaw(rng.uniform(-3, 3, 3)), rng.normal(size=3))
        for _ in range(2)
    )
    V_BH = rng.normal(size=6)
    change = FrameChange(X_AB)
    motion = change.change_motion(pose_to_vector(X_BH), V_BH)
    assert vector_to_pose(motion[:7]).IsNearlyEqualTo(X_AB @ X_BH, 1e-14)
    assert np.linalg.norm(motion[:4]) == pytest.approx(1.0, abs=1e-15)
    V_AH = SpatialVelocity(V_BH).Rotate(X_AB.rotation()).get_coeffs()
    np.testing.assert_allclose(motion[7:], V_AH, atol=1e-14)
    np.testing.assert_allclose(change.turn @ V_BH, V_AH, atol=1e-14)
