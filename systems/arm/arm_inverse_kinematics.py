"""Joint angles of a simulated arm for a pose of its handle."""

from __future__ import annotations

import numpy as np
from pydrake.math import RigidTransform
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import JacobianWrtVariable, RigidBody

_MAX_ITERATIONS = 100
_LARGEST_STEP_RAD = 0.3
# rad and m; Newton steps near the answer cost one more for the last digits, which
# stiff springs at the handle would turn into forces.
_TOLERANCE = 1e-12
# Of the Jacobian with lengths in units of the arm's own: below this, some motion of
# the handle needs ten times the joint speed of the easiest one.
_ARM_LENGTH_M = 0.2
_SMALLEST_SINGULAR_VALUE = 0.1


class UnreachableError(ValueError):
    """A pose that an arm cannot take, or only at the edge of its reach."""


def solve_arm_positions(
    plant: MultibodyPlant,
    handle: RigidBody,
    X_WH: RigidTransform,
    q_guess: np.ndarray,
) -> np.ndarray:
    """Returns joint positions that put the handle at a pose, by Newton steps.

    Args:
        plant: The arm, finalized, six joints.
        handle: Its body that is held.
        X_WH: The pose.
        q_guess: Where to start, rad; decides which of several answers is found.

    Raises:
        UnreachableError: There is none near the guess, or the arm is singular there.
    """
    context = plant.CreateDefaultContext()
    q = np.array(q_guess, dtype=float)
    for _ in range(_MAX_ITERATIONS):
        plant.SetPositions(context, q)
        X_WN = plant.EvalBodyPoseInWorld(context, handle)
        turn = (X_WH.rotation() @ X_WN.rotation().inverse()).ToAngleAxis()
        error = np.concatenate(
            [
                turn.angle() * turn.axis(),
                X_WH.translation() - X_WN.translation(),
            ]
        )
        J = plant.CalcJacobianSpatialVelocity(
            context,
            JacobianWrtVariable.kQDot,
            handle.body_frame(),
            np.zeros(3),
            plant.world_frame(),
            plant.world_frame(),
        )
        # Lengths in units of the arm's make the six rows comparable.
        J[3:] /= _ARM_LENGTH_M
        error[3:] /= _ARM_LENGTH_M
        if np.linalg.norm(error) < _TOLERANCE:
            if np.linalg.svd(J, compute_uv=False)[-1] < _SMALLEST_SINGULAR_VALUE:
                raise UnreachableError("the arm is at the edge of its reach or gimbal")
            return q
        damping = 1e-4 * min(1.0, float(np.linalg.norm(error)))
        step = np.linalg.solve(J.T @ J + damping * np.eye(len(q)), J.T @ error)
        q += step * min(1.0, _LARGEST_STEP_RAD / float(np.max(np.abs(step))))
    raise UnreachableError("the arm does not reach that far")
