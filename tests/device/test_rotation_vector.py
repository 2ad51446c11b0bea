"""Rotation vectors in plain numbers agree with SciPy and with differences."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from drake_haptics.device import rotation_vector as rv

# Around the change from the series to the formula, and up to half a turn.
ANGLES = [0.0, 1e-12, 0.99e-4, 1.01e-4, 0.1, 1.0, 3.0, np.pi - 1e-9]


def draw(rng, angle):
    """A rotation vector of an angle, rad."""
    axis = rng.normal(size=3)
    return angle * axis / np.linalg.norm(axis)


@pytest.fixture
def rng():
    return np.random.default_rng(1)


@pytest.mark.parametrize("angle", ANGLES)
def test_a_quaternion_is_scipys_and_goes_back(rng, angle):
    r = draw(rng, angle)
    q = rv.to_quaternion(r)
    expected = Rotation.from_rotvec(r).as_quat(scalar_first=True)
    np.testing.assert_allclose(q, expected, atol=1e-15)
    np.testing.assert_allclose(rv.to_rotation_vector(q), r, atol=1e-15, rtol=1e-14)
    # The other quaternion of the same rotation.
    back = rv.to_rotation_vector([-x for x in q])
    np.testing.assert_allclose(back, r, atol=1e-15, rtol=1e-14)


def test_the_product_is_scipys(rng):
    a, b = Rotation.random(2, random_state=rng)
    product = rv.multiply(a.as_quat(scalar_first=True), b.as_quat(scalar_first=True))
    expected = (a * b).as_quat(scalar_first=True)
    np.testing.assert_allclose(product, expected, atol=1e-15)
    undone = rv.multiply(product, rv.invert(product))
    np.testing.assert_allclose(undone, [1, 0, 0, 0], atol=1e-15)


@pytest.mark.parametrize("angle", ANGLES)
def test_the_angular_velocity_is_that_of_the_turning_frame(rng, angle):
    r, rate = draw(rng, angle), rng.normal(size=3)
    step = 1e-6
    before, after = (Rotation.from_rotvec(r + s * step * rate) for s in (-1, 1))
    expected = (after * before.inv()).as_rotvec() / (2 * step)
    w = rv.calc_angular_velocity(r, rate)
    np.testing.assert_allclose(w, expected, atol=1e-8)
    assert np.linalg.norm(w) <= np.linalg.norm(rate) * (1 + 1e-15)
    np.testing.assert_allclose(
        rv.calc_rate(r, w), rate, atol=1e-7 if angle > 3 else 1e-13
    )
