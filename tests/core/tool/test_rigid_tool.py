"""Test the implicit tool against mechanics and against its stability promise."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from drake_haptics import _core

MASS = 0.1
INERTIA = np.diag([2e-5, 4e-5, 5e-5])
H = 1e-3


def model(F: object = (0,) * 6, K: object = None, B: object = None) -> np.ndarray:
    K = np.zeros((6, 6)) if K is None else np.asarray(K)
    B = np.zeros((6, 6)) if B is None else np.asarray(B)
    return np.concatenate([np.asarray(F, float), K.ravel(), B.ravel()])


def at_rest() -> np.ndarray:
    state = np.zeros(13)
    state[0] = 1
    return state


def test_a_constant_force_gives_newtons_acceleration() -> None:
    tool = _core.RigidToolDynamics(MASS, np.zeros(3), INERTIA)
    state = at_rest()
    for _ in range(100):
        state = tool.step(state, model([0, 0, 0, 1.0, -2.0, 0.5]), H)
    t = 100 * H
    np.testing.assert_allclose(state[10:], np.array([1, -2, 0.5]) / MASS * t)
    np.testing.assert_allclose(
        state[4:7], np.array([1, -2, 0.5]) / MASS * t * (t + H) / 2
    )


def test_a_torque_about_a_principal_axis_turns_the_tool_by_half_a_t_squared() -> None:
    tool = _core.RigidToolDynamics(MASS, np.zeros(3), INERTIA)
    state = at_rest()
    tau = 1e-4
    for _ in range(200):
        state = tool.step(state, model([0, 0, tau, 0, 0, 0]), H)
    t = 200 * H
    angle = Rotation.from_quat(np.roll(state[:4], -1)).as_rotvec()
    np.testing.assert_allclose(angle, [0, 0, tau / 5e-5 * t * (t + H) / 2])
    assert np.linalg.norm(state[:4]) == pytest.approx(1, abs=1e-14)


def test_an_eccentric_tool_pushed_at_its_center_of_mass_does_not_turn() -> None:
    c = np.array([0.03, -0.02, 0.05])
    tool = _core.RigidToolDynamics(MASS, c, INERTIA)
    f = np.array([0.3, 0.2, -0.4])
    state = at_rest()
    for _ in range(50):
        state = tool.step(state, model(np.concatenate([np.cross(c, f), f])), H)
    np.testing.assert_allclose(state[7:10], 0, atol=1e-12)
    np.testing.assert_allclose(state[10:], f / MASS * 50 * H)


def test_a_free_spin_about_an_eccentric_frame_keeps_the_center_at_rest() -> None:
    c = np.array([0.02, 0.0, 0.0])
    tool = _core.RigidToolDynamics(MASS, c, INERTIA)
    w = np.array([0, 0, 5.0])
    state = at_rest()
    state[7:10] = w
    state[10:] = -np.cross(w, c)  # the center of mass stands still
    h = 1e-4
    for _ in range(2000):
        state = tool.step(state, model(), h)
    R = Rotation.from_quat(np.roll(state[:4], -1))
    np.testing.assert_allclose(state[4:7] + R.apply(c), c, atol=2e-4)
    np.testing.assert_allclose(state[7:10], w, rtol=1e-3)


@pytest.mark.parametrize("stiffness", [1e2, 1e4, 1e6, 1e9])
def test_contact_of_any_stiffness_settles_at_any_rate(stiffness: float) -> None:
    """A corner on a wall; explicit steps fail above 4 m / h² = 4e5 N/m."""
    tool = _core.RigidToolDynamics(MASS, np.zeros(3), INERTIA)
    r = np.array([0.01, 0.02, -0.03])
    n = np.array([0, 0, 1.0])
    G = np.concatenate([np.cross(r, n), n])
    coupling = np.diag([2, 2, 2, 1000, 1000, 1000.0])
    damping = np.diag([4e-3, 4e-3, 4e-3, 2, 2, 2.0])
    state = at_rest()
    state[10:] = [0, 0, -0.2]
    speeds = []
    for _ in range(4000):
        turn = Rotation.from_quat(np.roll(state[:4], -1)).as_rotvec()
        delta = np.concatenate([turn, state[4:7]])
        F = -stiffness * G * (G @ delta) - coupling @ delta - damping @ state[7:]
        F += [0, 0, 0, 0, 0, -1.0]
        K = stiffness * np.outer(G, G) + coupling
        state = tool.step(state, model(F, K, damping), H)
        speeds.append(np.abs(state[7:]).max())
    assert speeds[-1] < 1e-6
    assert np.isfinite(state).all()


def test_bodies_that_cannot_be_are_refused() -> None:
    for mass in (0.0, -1.0, np.nan):
        with pytest.raises(ValueError, match="mass"):
            _core.RigidToolDynamics(mass, np.zeros(3), INERTIA)
    for inertia in (np.zeros((3, 3)), -INERTIA, np.full((3, 3), np.nan)):
        with pytest.raises(ValueError, match="inertia"):
            _core.RigidToolDynamics(MASS, np.zeros(3), inertia)


def test_several_wrenches_move_the_tool_as_their_sum() -> None:
    tool = _core.RigidToolDynamics(MASS, np.array([0.01, 0.0, 0.0]), INERTIA)
    rng = np.random.default_rng(0)
    parts = [rng.normal(size=78) for _ in range(3)]
    together = tool.step(at_rest(), sum(parts), H)
    np.testing.assert_allclose(tool.step(at_rest(), parts, H), together, rtol=1e-12)
    np.testing.assert_array_equal(
        tool.step(at_rest(), [], H), tool.step(at_rest(), model(), H)
    )
