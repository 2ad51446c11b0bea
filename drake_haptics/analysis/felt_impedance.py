"""Calculates the impedance of a virtual scene at the device's handle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drake_haptics.analysis.delay_margin import find_shown_wrench
from drake_haptics.analysis.held_loop import HeldLoop
from drake_haptics.analysis.jobs.blas_threads import on_one_blas_thread
from drake_haptics.bounds.held_handle import (
    calc_handle_jacobian,
    find_arm,
    read_joint_damping,
)
from drake_haptics.common.one_line import one_line
from drake_haptics.systems.arm.hand_impedance import HAND_GRIPS


@dataclass(frozen=True)
class FeltImpedance:
    """The wrench that resists displacements of the handle, as a discrete system.

    The input is the sampled displacement (6,) of the handle, [rotation vector (rad);
    translation (m)] about its origin. The output is the wrench (6,) [N·m; N] against
    it. The velocity that the coupling damps is the backward difference of the
    displacements, as from encoders.

    A force that is not the gradient of a potential drives a hand that moves in circles,
    however slowly, and no damper makes it passive: at frequency ω it would take K_c/ω.
    Penalty forces of meshes have a small part of this kind, since the normal does not
    turn exactly as the depth changes. That part of the stiffness is separate (`curl`),
    and so is the part that looks like it only because rotations do not commute (a
    torque fixed in the world does not turn with the handle).

    Attributes:
        A: (n, n) state matrix.
        B: (n, 6) input matrix.
        C: (6, n) output matrix.
        D: (6, 6) feedthrough matrix, without `curl` and the part of the torque.
        period_s: T, s.
        curl: (6, 6) antisymmetric part of the stiffness at standstill.
        handle_damping: (6, 6) damping of the device's joints and of the hand, at the
            handle, N·m·s/rad and N·s/m.
    """

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: np.ndarray
    period_s: float
    curl: np.ndarray
    handle_damping: np.ndarray

    __repr__ = one_line


@on_one_blas_thread
def calc_felt_impedance(loop: HeldLoop) -> FeltImpedance:
    """Calculates the impedance that a loop shows at the handle.

    Args:
        loop: The loop of a scene with a simulated device.

    Raises:
        ValueError: The arm is singular at the equilibrium.
    """
    linear = loop.linearization
    n_c = loop.context.num_continuous_states()
    n_q = n_c // 2
    scene = loop.haptic.scene
    plant, handle = find_arm(scene, loop.haptic.loop.device)
    context = plant.GetMyContextFromRoot(loop.context)
    J_WH = calc_handle_jacobian(plant, handle, context)
    try:
        per_displacement = np.linalg.inv(J_WH)
    except np.linalg.LinAlgError as error:
        raise ValueError(
            "the arm is singular where it is held: hold the scene at another time"
        ) from error
    T = linear.period_s
    # Discrete rows of A are the update itself: the state does not change in between.
    update = linear.A[n_c:]
    by_displacement = (update[:, :n_q] + update[:, n_q:n_c] / T) @ per_displacement
    by_last = -update[:, n_q:n_c] / T @ per_displacement
    shown = find_shown_wrench(linear.state_names[n_c:])
    # The state ends with the last displacement.
    A = np.block([[update[:, n_c:], by_last], [np.zeros((6, len(update) + 6))]])
    B = np.vstack([by_displacement, np.eye(6)])
    C, D = -A[shown], -B[shown]
    antisymmetric = _calc_antisymmetric_stiffness(A, B, C, D)
    torque = linear.state[n_c:][shown][:3]
    grip = HAND_GRIPS[scene.hand.grip]
    of_hand = np.zeros(6)
    if grip is not None:
        of_hand[:3] = grip.rotational_damping_Nms_per_rad
        of_hand[3:] = grip.damping_Ns_per_m
    return FeltImpedance(
        A=A,
        B=B,
        C=C,
        D=D - antisymmetric,
        period_s=T,
        curl=antisymmetric - _calc_torque_part(torque),
        handle_damping=per_displacement.T
        @ np.diag(read_joint_damping(plant))
        @ per_displacement
        + np.diag(of_hand),
    )


def _calc_antisymmetric_stiffness(
    A: np.ndarray, B: np.ndarray, C: np.ndarray, D: np.ndarray
) -> np.ndarray:
    """Returns the antisymmetric part of H(1), the stiffness at standstill (6, 6)."""
    # If friction sticks, I - A is singular, but the displacement is still determined.
    settled = np.linalg.lstsq(np.eye(len(A)) - A, B, rcond=1e-10)[0]
    stiffness = C @ settled + D
    return (stiffness - stiffness.T) / 2.0


def _calc_torque_part(torque: np.ndarray) -> np.ndarray:
    """Returns the stiffness that a torque adds because rotations do not commute.

    At the rotation vector θ a potential's torque is -∂U + ½ θ × τ to first order: the
    inverse left Jacobian of SO(3), transposed.
    """
    x, y, z = torque / 2.0
    part = np.zeros((6, 6))
    part[:3, :3] = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]
    return part
