"""Test the wrench's derivatives against differences of the whole chain.

A difference asks the query again at each displaced pose. Where it answers with other
features, or other contacts push, there is no derivative to compare with.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from contact_samples import box
from contact_state import KV, METHODS, K, State, T, random_states
from scipy.spatial.transform import Rotation

from drake_haptics import _core

STEP = 2e-7
FAR = np.array([0.3, -0.2, 0.5])


def wrench(state: State) -> np.ndarray:
    return state.wrench().F_To_W


def differences(
    state: State, move: Callable[[np.ndarray], State], step: float
) -> np.ndarray | None:
    """The derivative (6, 6), or nothing where features change."""
    columns, features = [], state.features()
    for e in np.eye(6):
        ahead, behind = move(step * e), move(-step * e)
        if not ahead.features() == behind.features() == features:
            return None
        columns.append((wrench(ahead) - wrench(behind)) / (2 * step))
    return np.array(columns).T


def error(found: np.ndarray, expected: np.ndarray) -> float:
    return float(np.abs(found - expected).max() / np.abs(expected).max())


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    "name", ["box on box", "spoon in cup", "peg in torus", "cup on block"]
)
def test_by_the_pose_of_the_tool(pairs, name: str, method: str) -> None:
    """To 1e-6, but for states at a kink: an edge that lies in a face to round-off.

    Of some hundred states one or two are. The step of the difference itself costs
    the most where a vertex is near a vertex or an edge: there the normal turns by
    1 / distance.
    """
    errors = []
    for state in random_states(*pairs[name], method, 40):
        move = differences(state, lambda by, s=state: s.displaced(0, by), STEP)
        if move is not None:
            errors.append(error(state.jacobian().by_X[0], move))
    assert len(errors) >= 35
    errors.sort()
    assert np.median(errors) < 1e-8
    assert errors[-2] < 1e-6
    assert errors[-1] < 1e-3


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("body", [1, 2])
def test_by_the_pose_of_an_object(pairs, method: str, body: int) -> None:
    """Far from the world's origin too."""
    checked = 0
    for near in random_states(*pairs["spoon in cup"], method, 15):
        far = near.q.copy()
        far[:, 4:] += FAR
        for state in (near, replace(near, q=far)):
            move = differences(state, lambda by, s=state: s.displaced(body, by), STEP)
            if move is None or not np.abs(move).max() > 0:
                continue
            found = state.jacobian().by_X[body]
            assert error(found, move) < 2e-6
            checked += 1
    assert checked >= 15


@pytest.mark.parametrize("method", METHODS)
def test_by_the_velocities(pairs, method: str) -> None:
    """The force is linear in them where no contact turns from approach to departure."""
    for state in random_states(*pairs["peg in torus"], method, 15):
        found = state.jacobian()
        for body in range(3):
            move = differences(state, lambda by, s=state, b=body: s.faster(b, by), 1e-6)
            np.testing.assert_allclose(found.by_V[body], move, atol=1e-6)
        # The wrench model's B is minus that by the tool's velocity.
        contacts = state.contacts
        model = _core.penalty_force(
            state.cluster(contacts),
            state.q[0, 4:],
            state.V[0],
            state.q[1:, 4:],
            state.V[1:],
            K,
            KV,
        ).wrench_model
        np.testing.assert_allclose(found.by_V[0], -model[42:].reshape(6, 6), atol=1e-12)


def test_one_vertex_on_a_face_is_the_frozen_model_and_what_turns() -> None:
    """K of the wrench model, less the torque's change as the arm turns."""
    tool, ground = box([0.02, 0.02, 0.02]), box([0.2, 0.2, 0.02], [0, 0, -0.01])
    R = Rotation.from_rotvec([0.5, 0.4, 0.1])
    corner = np.array([0.01, 0.01, 0.01]) * np.sign(R.inv().apply([0, 0, -1]))
    arm = R.apply(corner)
    x, y, z, w = R.as_quat()
    q = np.array([[w, x, y, z, 0, 0, 1e-3 - arm[2]], [1, 0, 0, 0, 0, 0, 0]])
    tracker = _core.SceneTracker(tool, [ground], T)
    state = State((tool, ground), tracker, "shared", q, np.zeros((2, 6)))
    found = state.jacobian()
    up = np.array([0, 0, 1.0])
    G = np.concatenate([np.cross(arm, up), up])
    expected = -K[0] * np.outer(G, G)
    # The vertex turns with the tool: d(r × n) = (δ × r) × n, a force 1 mm thick.
    for i, e in enumerate(np.eye(3)):
        expected[:3, i] += K[0] * 1e-3 * np.cross(np.cross(e, arm), up)
    np.testing.assert_allclose(found.by_X[0], expected, atol=1e-9)
    # Moved together nothing changes but the direction of what is seen.
    shift = np.eye(6)
    p = q[0, 4:]
    shift[3:, :3] = -np.array([[0, -p[2], p[1]], [p[2], 0, -p[0]], [-p[1], p[0], 0]])
    together = found.by_X[0] + found.by_X[1] @ np.linalg.inv(shift)
    np.testing.assert_allclose(together[:, 3:], 0, atol=1e-9)


def test_a_face_exactly_flush_has_a_finite_answer() -> None:
    tool, ground = box([0.02, 0.02, 0.02]), box([0.2, 0.2, 0.02], [0, 0, -0.01])
    for height in (-1e-3, 1e-3):
        q = np.array([[1, 0, 0, 0, 0, 0, 0.01 + height], [1, 0, 0, 0, 0, 0, 0]])
        tracker = _core.SceneTracker(tool, [ground], T)
        found = State((tool, ground), tracker, "shared", q, np.zeros((2, 6))).jacobian()
        assert np.isfinite(found.by_X[0]).all()
        np.testing.assert_allclose(
            found.by_X[0][3:, 3:], np.diag([0, 0, -K[0]]), atol=1e-6
        )
        # The layer resists rocking, to either side.
        assert found.by_X[0][0, 0] < 0
        assert found.by_X[0][1, 1] < 0


def test_nothing_near_changes_nothing(pairs) -> None:
    tool, solid = pairs["box on box"]
    q = np.array([[1.0, 0, 0, 0, 0, 0, 1], [1, 0, 0, 0, 0, 0, 0]])
    tracker = _core.SceneTracker(tool, [solid], T)
    for method in METHODS:
        found = State((tool, solid), tracker, method, q, np.zeros((2, 6))).jacobian()
        assert not found.by_X.any()
