"""Simulates a hand by the impedance with which it holds a handle; names grips."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from pydrake.math import RigidTransform
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import JacobianWrtVariable, RigidBody
from pydrake.systems.framework import BasicVector, Context

from drake_haptics._core import ArmDynamics, AutoDiffVector, CouplingGains
from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose
from drake_haptics.systems.arm.hand_path import HandPath
from drake_haptics.systems.framework.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
)

_NUM_JOINTS = 6
_LETS_GO = CouplingGains(0.0, 0.0, 0.0, 0.0)
# Angles (rad) and speeds (rad/s) at which the arm is compared with its plant.
_PROBE = np.array([0.3, -0.5, 0.7, 1.1, -0.9, 0.4, 1.0, -2.0, 3.0, 2.0, -1.0, 4.0])
_MAX_DIFFERENCE = 1e-9


@dataclass(frozen=True)
class HandGrip:
    """Mass, damping and stiffness of a hand around a handle.

    Attributes:
        mass_kg: Mass that moves with the handle, kg.
        inertia_kgm2: Rotational inertia about each axis, kg·m².
        stiffness_N_per_m: Stiffness of the spring that pulls the handle to where the
            hand wants it, N/m.
        damping_Ns_per_m: Damping parallel to that spring, N·s/m.
        rotational_stiffness_Nm_per_rad: Rotational stiffness, N·m/rad.
        rotational_damping_Nms_per_rad: Rotational damping, N·m·s/rad.
    """

    mass_kg: float
    inertia_kgm2: float
    stiffness_N_per_m: float
    damping_Ns_per_m: float
    rotational_stiffness_Nm_per_rad: float
    rotational_damping_Nms_per_rad: float

    def make_gains(self) -> CouplingGains:
        """Returns the spring and the damper for the core."""
        return CouplingGains(
            self.stiffness_N_per_m,
            self.damping_Ns_per_m,
            self.rotational_stiffness_Nm_per_rad,
            self.rotational_damping_Nms_per_rad,
        )


# Pen and pinch grasps lie in .05-.3 kg, 1-20 N·s/m, 50-1000 N/m and, in rotation,
# 1e-4-1e-3 kg·m², .002-.05 N·m·s/rad, .1-3 N·m/rad (Hasser and Cutkosky 2002; Israr,
# Choi and Tan 2006). The rotations are chosen in these ranges for damping like that
# of the translations. A light grip is the worst case for stability.
NOMINAL_GRIP = HandGrip(0.2, 3e-4, 300.0, 5.0, 1.0, 0.02)
HAND_GRIPS: dict[str, HandGrip | None] = {
    "none": None,
    "light": HandGrip(0.05, 1e-4, 50.0, 1.0, 0.3, 0.005),
    "nominal": NOMINAL_GRIP,
    "firm": HandGrip(0.3, 1e-3, 1000.0, 15.0, 3.0, 0.05),
}
# The loosest grip to be expected on a real device.
LOOSEST_GRIP = "light"


class HandImpedance(DifferentiableSystem):
    """A hand as a six-axis spring and damper that follows a path.

    It pulls the handle to X_WP X_PH, where P is the frame of the path, and passes on
    the wrench that the device's motors render. Both act in continuous time as
    generalized forces, τ = Jᵀ (F_hand + F_Ho_W_rendered), which takes one call of the
    core and one vector port, where applied spatial forces would take many.

    .. pydrake_system::

        name: HandImpedance
        input_ports:
        - arm_state
        - F_Ho_W_rendered
        output_ports:
        - generalized_force
        - handle_state

    * `arm_state` is [q; v] of the arm's plant.
    * `F_Ho_W_rendered` (6) is the wrench [τ; f] on the handle at its origin in the
      world, N·m and N.
    * `generalized_force` is for the plant, N·m.
    * `handle_state` (13) is [X_WH; V_WH]: the handle's pose [qw qx qy qz x y z], m,
      and its spatial velocity [ω; v], rad/s and m/s, in the world.

    Both outputs raise FloatingPointError where the arm's state is not finite.
    """

    def __init__(
        self,
        plant: MultibodyPlant,
        handle: RigidBody,
        path: HandPath,
        X_PH: RigidTransform,
        gains: CouplingGains | None,
    ):
        """Constructs the system.

        Args:
            plant: Finalized plant of the arm: six revolute joints in a chain.
            handle: Body of the arm that is held, at the end of the chain.
            path: Path along which the hand moves P.
            X_PH: Pose in P at which the hand wants the handle.
            gains: Gains of the hand; None for a hand that lets go.

        Raises:
            ValueError: The arm is not such a chain.
        """
        super().__init__()
        self._arm = make_held_arm(plant, handle, path, X_PH, gains)
        self._arm_state = self.DeclareVectorInputPort("arm_state", 2 * _NUM_JOINTS)
        self._F_Ho_W_rendered = self.DeclareVectorInputPort("F_Ho_W_rendered", 6)
        self._eval_arm_state = self._arm_state.Eval
        self._eval_F_Ho_W_rendered = self._F_Ho_W_rendered.Eval
        from_arm = {self._arm_state.ticket()}
        self.DeclareVectorOutputPort(
            "generalized_force",
            _NUM_JOINTS,
            self._calc_generalized_force,
            from_arm | {self._F_Ho_W_rendered.ticket(), self.time_ticket()},
        )
        self.DeclareVectorOutputPort(
            "handle_state", 13, self._calc_handle_state, from_arm
        )

    def _calc_generalized_force(self, context: Context, output: BasicVector) -> None:
        output.set_value(
            self._arm.calc_joint_torques(
                context.get_time(),
                self._eval_arm_state(context),
                self._eval_F_Ho_W_rendered(context),
            )
        )

    def _calc_handle_state(self, context: Context, output: BasicVector) -> None:
        output.set_value(self._arm.calc_handle_state(self._eval_arm_state(context)))

    def differentiate(self, port: str, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns an output with its derivatives."""
        if port == "handle_state":
            return self._arm.calc_handle_state(at["arm_state"])
        return self._arm.calc_joint_torques(
            at.time_s, at["arm_state"], at["F_Ho_W_rendered"]
        )


def make_held_arm(
    plant: MultibodyPlant,
    handle: RigidBody,
    path: HandPath,
    X_PH: RigidTransform,
    gains: CouplingGains | None,
) -> ArmDynamics:
    """Reads an arm's kinematics from its plant, and checks them against it.

    Args:
        plant: Finalized plant of the arm: six revolute joints in a chain.
        handle: Body of the arm that is held, at the end of the chain.
        path: Path along which the hand moves P.
        X_PH: Pose in P at which the hand wants the handle.
        gains: Gains of the hand; None for a hand that lets go.

    Raises:
        ValueError: The arm is not such a chain.
    """
    if (plant.num_positions(), plant.num_velocities()) != (_NUM_JOINTS, _NUM_JOINTS):
        raise ValueError(f"the arm must have {_NUM_JOINTS} revolute joints")
    context = plant.CreateDefaultContext()

    def kinematics(state: np.ndarray) -> tuple[RigidTransform, np.ndarray]:
        plant.SetPositionsAndVelocities(context, state)
        J_WH = plant.CalcJacobianSpatialVelocity(
            context,
            JacobianWrtVariable.kV,
            handle.body_frame(),
            np.zeros(3),
            plant.world_frame(),
            plant.world_frame(),
        )
        return plant.EvalBodyPoseInWorld(context, handle), J_WH

    X_WH, J_WH = kinematics(np.zeros(2 * _NUM_JOINTS))
    arm = ArmDynamics(
        J_WH, pose_to_vector(X_WH), path.core, pose_to_vector(X_PH), gains or _LETS_GO
    )
    X_WH, J_WH = kinematics(_PROBE)
    handle_state = arm.calc_handle_state(_PROBE)
    V_difference = handle_state[7:] - J_WH @ _PROBE[_NUM_JOINTS:]
    if (
        not vector_to_pose(handle_state[:7]).IsNearlyEqualTo(X_WH, _MAX_DIFFERENCE)
        or np.abs(V_difference).max() > _MAX_DIFFERENCE
    ):
        raise ValueError("the arm must be one chain of revolute joints to the handle")
    return arm
