"""Derivatives of shaded normals against differences of what doubles answer."""

from __future__ import annotations

import copy

import numpy as np
import pytest
import trimesh
from autodiff_check import REACH, derivative_errors, seeded
from contact_samples import IDENTITY
from shading_rig import T, core_of, shading
from touching_poses import touching_pose

from drake_haptics import _core

BALL = trimesh.creation.icosphere(2, 0.02)
TORUS = trimesh.creation.torus(0.04, 0.015, 24, 16)
CAN = trimesh.creation.cylinder(0.015, 0.03, sections=24)
CUBE = trimesh.creation.box([0.02] * 3)
STEP = 1e-6


class Shaded:
    """A tool that touches an object, as a function of both poses."""

    def __init__(
        self,
        tool: _core.ConvexPieces,
        body: _core.ConvexPieces,
        rng: np.random.Generator,
    ):
        """Brings two random vertices together."""
        self.bodies = tool, body
        self.shade = shading(tool, body)
        self.tracker = _core.SceneTracker(tool, [body], T)
        self.x = np.concatenate([touching_pose(rng, tool, body, T), IDENTITY])
        # So that no derivative hides behind a pose of zeros and ones.
        turn, way = rng.normal(size=4), rng.normal(size=3)
        self.x = np.concatenate([moved(turn, way, q) for q in np.split(self.x, 2)])
        self.tracker.set_object_pose(0, self.x[7:])
        self.tracker.query(self.x[:7])

    def query(self, x: np.ndarray) -> _core.ContactSet:
        """What the tracker answers near the first touch."""
        tracker = copy.deepcopy(self.tracker)
        tracker.set_object_pose(0, x[7:])
        return tracker.query(x[:7])

    def normals(self, x: np.ndarray) -> np.ndarray:
        """(3 n,) as the doubles have them."""
        shaded = self.shade.shade(self.query(x), x[:7], x[None, 7:])
        return shaded.nhat_BA_W.ravel()

    def features(self, x: np.ndarray) -> list[list[int]]:
        """Which pieces touch, and with what."""
        contacts = self.query(x)
        pieces = [contacts.piece_A, contacts.piece_B]
        return np.column_stack(
            [*pieces, contacts.feature_A, contacts.feature_B]
        ).tolist()

    def differentiate(self) -> tuple[_core.AutoDiffVector, np.ndarray]:
        """Returns the shaded normals, and the gradient of those that are not."""
        contacts, X_WT, X_WO = self.differentiate_query()
        shaded = self.shade.shade(contacts, X_WT, X_WO)
        return shaded.nhat_BA_W, contacts.nhat_BA_W.gradient

    def differentiate_query(
        self,
    ) -> tuple[_core.AutoDiffContactSet, _core.AutoDiffVector, _core.AutoDiffVector]:
        """Returns the contacts and both poses, with derivatives by both."""
        X = seeded(self.x)
        X_WT, X_WO = (
            _core.AutoDiffVector(X.value[rows], X.gradient[rows])
            for rows in (slice(0, 7), slice(7, 14))
        )
        tool, body = self.bodies
        contacts = _core.differentiate_contacts(
            self.query(self.x), T, tool, X_WT, [body], [X_WO]
        )
        return contacts, X_WT, X_WO


def moved(turn: np.ndarray, way: np.ndarray, q: np.ndarray) -> np.ndarray:
    """A pose vector turned about the world's origin and moved; of the turn's length."""
    w, v = turn[0], turn[1:]
    p = q[4:] + 2 * np.cross(v, np.cross(v, q[4:]) + w * q[4:]) / (turn @ turn)
    vector = w * q[1:4] + q[0] * v + np.cross(v, q[1:4])
    return np.concatenate([[w * q[0] - v @ q[1:4]], vector, p + way])


@pytest.mark.parametrize(
    ("tool", "body"),
    [(BALL, TORUS), (CAN, BALL), (TORUS, CAN), (CUBE, TORUS), (BALL, CUBE)],
    ids=["ball-torus", "can-ball", "torus-can", "cube-torus", "ball-cube"],
)
def test_normals_turn_as_the_differences_say(
    tool: trimesh.Trimesh, body: trimesh.Trimesh
) -> None:
    rng = np.random.default_rng(0)
    cores = core_of(tool), core_of(body)
    checked = turned = 0
    for _ in range(25):
        state = Shaded(*cores, rng)
        here = state.features(state.x)
        reach = 1.01 * REACH * STEP * np.eye(14)
        if not here or any(
            state.features(state.x + sign * by) != here
            for by in reach
            for sign in (-1, 1)
        ):
            continue
        answer, unshaded = state.differentiate()
        np.testing.assert_array_equal(answer.value, state.normals(state.x))
        # One contact at a time: one may be at a kink, as between two triangles.
        blocks = {str(i): slice(3 * i, 3 * i + 3) for i in range(len(here))}
        errors = derivative_errors(state.normals, answer, state.x, STEP, blocks)
        assert max(errors.values(), default=0.0) < 1e-6
        checked += len(errors)
        turned += sum(
            not np.allclose(unshaded[blocks[i]], answer.gradient[blocks[i]], rtol=1e-3)
            for i in errors
        )
    assert checked >= 20
    assert turned >= 10


def test_what_has_no_derivatives_by_these_variables_is_refused() -> None:
    state = Shaded(core_of(CUBE), core_of(BALL), np.random.default_rng(1))
    contacts, X_WT, X_WO = state.differentiate_query()
    by_other = seeded(X_WO.value)
    with pytest.raises(ValueError, match="by the same variables"):
        state.shade.shade(contacts, X_WT, by_other)
    with pytest.raises(ValueError, match="variables of the contacts"):
        state.shade.shade(contacts, by_other, by_other)
    with pytest.raises(ValueError, match="7 numbers"):
        state.shade.shade(contacts, seeded(np.zeros(6)), X_WO)
