"""Converts a wrench into torques of an arm's motors, within their limits."""

from __future__ import annotations

import numpy as np
from pydrake.systems.framework import BasicVector, Context

from drake_haptics._core import ArmDynamics, AutoDiffVector
from drake_haptics.common.value_checks import check_positive
from drake_haptics.systems.framework.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
)


class MotorTorque(DifferentiableSystem):
    """Jacobian-transpose actuation by motors of limited torque.

    τ_motor = clamp(Sᵀ J_WHᵀ F_Ho_W_rendered), where each amplifier clamps its own motor
    and q = S q_motor; the joints get τ = S⁻ᵀ τ_motor. A wrench within the limits of all
    motors arrives as it is. Otherwise J_WH⁻ᵀ S⁻ᵀ τ_motor arrives, whose direction
    differs from that of the commanded wrench.

    .. pydrake_system::

        name: MotorTorque
        input_ports:
        - arm_state
        - F_Ho_W_rendered
        output_ports:
        - generalized_force

    * `arm_state` (12) is [q; v] of the arm's plant, rad and rad/s.
    * `F_Ho_W_rendered` (6) is the wrench [τ; f] on the handle at its origin in the
      world, N·m and N.
    * `generalized_force` (6) is for the plant, N·m.

    Motors at their limit contribute nothing to its derivative.
    """

    def __init__(
        self, arm: ArmDynamics, joint_per_motor: np.ndarray, peak_torque_Nm: np.ndarray
    ):
        """Constructs the system.

        Args:
            arm: Kinematics of the arm without a hand.
            joint_per_motor: S (6, 6), invertible.
            peak_torque_Nm: (6,) peak torque of each motor after its gear, positive,
                N·m.

        Raises:
            ValueError: A torque is not positive.
        """
        super().__init__()
        check_positive(peak_torque_Nm=peak_torque_Nm)
        self._arm = arm
        self._to_motors = np.array(joint_per_motor, dtype=float).T
        self._to_joints = np.linalg.inv(self._to_motors)
        self._peak_torque_Nm = np.array(peak_torque_Nm, dtype=float)
        self._arm_state = self.DeclareVectorInputPort("arm_state", 12)
        self._F_Ho_W_rendered = self.DeclareVectorInputPort("F_Ho_W_rendered", 6)
        self.DeclareVectorOutputPort(
            "generalized_force",
            6,
            self._calc_generalized_force,
            {self._arm_state.ticket(), self._F_Ho_W_rendered.ticket()},
        )

    def _calc_generalized_force(self, context: Context, output: BasicVector) -> None:
        # Only a hand depends on time, and this arm has no hand.
        torque = self._arm.calc_joint_torques(
            0.0, self._arm_state.Eval(context), self._F_Ho_W_rendered.Eval(context)
        )
        output.SetFromVector(self._to_joints @ self._limit(self._to_motors @ torque))

    def _limit(self, motor_torque: np.ndarray) -> np.ndarray:
        """Returns torques (6,) of motors, each within its limit."""
        return np.clip(motor_torque, -self._peak_torque_Nm, self._peak_torque_Nm)

    def differentiate(self, port: str, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the generalized force with its derivatives."""
        torque = self._arm.calc_joint_torques(
            at.hold(np.zeros(1)), at["arm_state"], at["F_Ho_W_rendered"]
        )
        asked = self._to_motors @ torque.value
        slope = self._to_motors @ torque.gradient
        slope[np.abs(asked) > self._peak_torque_Nm] = 0.0
        return AutoDiffVector(
            self._to_joints @ self._limit(asked), self._to_joints @ slope
        )
