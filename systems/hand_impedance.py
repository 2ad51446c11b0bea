"""The hand that holds a simulated arm, and what the arm's handle does."""

from __future__ import annotations

import math

import numpy as np
from pydrake.common.value import AbstractValue, Value
from pydrake.math import RigidTransform
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import JacobianWrtVariable, RigidBody
from pydrake.systems.framework import (
    BasicVector,
    Context,
    InputPort,
    LeafSystem,
    OutputPort,
    ValueProducer,
)

from drake_haptics._core import CouplingGains, coupling_wrench
from drake_haptics.pose_vector import pose_to_vector
from drake_haptics.systems.hand_path import HandPath
from drake_haptics.systems.scratch import declare_scratch, get_scratch

_AT_ORIGIN = np.zeros(3)


class HandImpedance(LeafSystem):
    """A hand as a six-axis spring and damper that follows a path.

    It draws the handle to X_WP X_PH, with P the frame of the path, and passes on
    the wrench that the device's motors show. Both act in continuous time as
    generalized forces, τ = Jᵀ (F_hand + F_applied), which is one evaluation and one
    vector port, where applied spatial forces would be many.

    .. pydrake_system::

        name: HandImpedance
        input_ports:
        - arm_state
        - F_applied
        output_ports:
        - generalized_force
        - X_WH
        - V_WH

    * `arm_state` is [q; v] of the arm's plant.
    * `F_applied` (6) is the wrench [τ; f] on the handle at its origin in the world,
      N·m and N.
    * `generalized_force` is for the plant, N·m.
    * `X_WH` (7) is the handle's pose [qw qx qy qz x y z] in the world, m.
    * `V_WH` (6) is its spatial velocity [ω; v] in the world, rad/s and m/s.

    All outputs raise FloatingPointError where the arm's state is not finite.
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
            plant: The arm, finalized, with as many velocities as positions.
            handle: Its body that is held.
            path: Where the hand wants P to go.
            X_PH: Where it wants the handle in P.
            gains: Of the hand; None lets go.
        """
        super().__init__()
        self._plant = plant
        self._handle = handle
        self._handle_frame = handle.body_frame()
        self._world_frame = plant.world_frame()
        self._path = path
        self._q_PH = pose_to_vector(X_PH)
        self._gains = gains
        self._num_positions = plant.num_positions()
        num_velocities = plant.num_velocities()
        self._arm_state = self.DeclareVectorInputPort(
            "arm_state", self._num_positions + num_velocities
        )
        self._F_applied = self.DeclareVectorInputPort("F_applied", 6)
        self._plant_context = declare_scratch(
            self, "plant_context", plant.CreateDefaultContext
        )
        self._kinematics = self.DeclareCacheEntry(
            "kinematics",
            ValueProducer(Value[object], self._calc_kinematics),
            {self._arm_state.ticket()},
        )
        self._generalized_force = self.DeclareVectorOutputPort(
            "generalized_force",
            num_velocities,
            self._calc_generalized_force,
            {self._kinematics.ticket(), self._F_applied.ticket(), self.time_ticket()},
        )
        self._X_WH = self.DeclareVectorOutputPort(
            "X_WH", 7, self._calc_X_WH, {self._kinematics.ticket()}
        )
        self._V_WH = self.DeclareVectorOutputPort(
            "V_WH", 6, self._calc_V_WH, {self._kinematics.ticket()}
        )

    def get_arm_state_input_port(self) -> InputPort:
        """Returns the input `arm_state`."""
        return self._arm_state

    def get_applied_wrench_input_port(self) -> InputPort:
        """Returns the input `F_applied`."""
        return self._F_applied

    def get_generalized_force_output_port(self) -> OutputPort:
        """Returns the output `generalized_force`."""
        return self._generalized_force

    def get_handle_pose_output_port(self) -> OutputPort:
        """Returns the output `X_WH`."""
        return self._X_WH

    def get_handle_velocity_output_port(self) -> OutputPort:
        """Returns the output `V_WH`."""
        return self._V_WH

    def _calc_kinematics(self, context: Context, kinematics: AbstractValue) -> None:
        """Sets (X_WH as a vector, V_WH, Jᵀ)."""
        state = self._arm_state.Eval(context)
        # The plant would end the interpreter.
        if not math.isfinite(sum(state.tolist())):
            raise FloatingPointError("the arm's state is not finite")
        plant = self._plant
        plant_context = get_scratch(self._plant_context, context)
        plant.SetPositionsAndVelocities(plant_context, state)
        J_WH = plant.CalcJacobianSpatialVelocity(
            plant_context,
            JacobianWrtVariable.kV,
            self._handle_frame,
            _AT_ORIGIN,
            self._world_frame,
            self._world_frame,
        )
        X_WH = pose_to_vector(plant.EvalBodyPoseInWorld(plant_context, self._handle))
        kinematics.set_value((X_WH, J_WH @ state[self._num_positions :], J_WH.T))

    def _calc_generalized_force(self, context: Context, output: BasicVector) -> None:
        q_WH, V_WH, J_WH_transposed = self._kinematics.Eval(context)
        F_W = self._F_applied.Eval(context)
        if self._gains is not None:
            q_WP, V_WP = self._path.calc(context.get_time())
            F_W = (
                F_W
                + coupling_wrench(q_WP, V_WP, self._q_PH, q_WH, V_WH, self._gains)[:6]
            )
        output.SetFromVector(J_WH_transposed @ F_W)

    def _calc_X_WH(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._kinematics.Eval(context)[0])

    def _calc_V_WH(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._kinematics.Eval(context)[1])
