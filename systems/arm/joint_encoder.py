"""Simulates encoders on an arm's motors and the motion that a driver computes."""

from __future__ import annotations

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Context, DiscreteValues, LeafSystem, State

from drake_haptics._core import ArmDynamics
from drake_haptics.common.value_checks import check_at_least, check_positive


class JointEncoder(LeafSystem):
    """Counts the motors' angles and estimates the handle's pose and velocity.

    At each tick the angle of each motor is rounded to the step Δ of its encoder. The
    speed is the difference of counted angles over a window of W ticks, a moving average
    of W backward differences: it comes in steps of Δ/(W T) and is late by W T/2.

    .. pydrake_system::

        name: JointEncoder
        input_ports:
        - arm_state
        output_ports:
        - handle_state

    * `arm_state` (12) is [q; v] of the arm's plant, rad and rad/s; v is not used.
    * `handle_state` (13) is [X_WH; V_WH] of the counted angles and estimated speeds:
      pose [qw qx qy qz x y z], m, and spatial velocity [ω; v], rad/s and m/s, in the
      world.

    The state is the handle's (13) and the counted angles of the last W + 1 ticks,
    newest first, 6 each. An unrestricted update writes it every period from 0 s on.
    Drake calls it before all discrete updates of the same time, so that counting adds
    no tick of delay. At initialization the window is filled with the first count.
    """

    no_derivatives = "rounds angles: leave device.twin.encoder out"

    def __init__(
        self,
        plant: MultibodyPlant,
        arm: ArmDynamics,
        period_s: float,
        joint_per_motor: np.ndarray,
        step_rad: np.ndarray,
        velocity_window: int,
    ):
        """Constructs the system.

        Args:
            plant: Finalized plant of the arm, at its default angles before the first
                tick.
            arm: Kinematics of the arm.
            period_s: The tick T, s.
            joint_per_motor: S (6, 6) in q = S q_motor, invertible.
            step_rad: (6,) angle Δ of each motor after its gear per count, rad.
            velocity_window: Window W of the speed, ticks, at least 1.

        Raises:
            ValueError: The period or a step is not positive, or the window is empty.
        """
        super().__init__()
        check_positive(period_s=period_s, step_rad=step_rad)
        check_at_least(1, velocity_window=velocity_window)
        self._arm = arm
        self._num_kept = velocity_window + 1
        self._window_s = velocity_window * period_s
        self._S = np.array(joint_per_motor, dtype=float)
        self._motor_per_joint = np.linalg.inv(self._S)
        self._step_rad = np.array(step_rad, dtype=float)
        self._arm_state = self.DeclareVectorInputPort("arm_state", 12)
        counted = self._count(plant.GetPositions(plant.CreateDefaultContext()))
        window = np.tile(counted, (self._num_kept, 1))
        self._handle = self.DeclareDiscreteState(self._calc_handle_state(window))
        self._window = self.DeclareDiscreteState(window.ravel())
        self.DeclareInitializationDiscreteUpdateEvent(self._fill)
        self.DeclarePeriodicUnrestrictedUpdateEvent(period_s, 0.0, self._sample)
        self.DeclareStateOutputPort("handle_state", self._handle)

    def _count(self, q: np.ndarray) -> np.ndarray:
        """Returns the motors' angles (6,) as their encoders count them."""
        counts = np.round(self._motor_per_joint @ q / self._step_rad)
        return counts * self._step_rad

    def _calc_handle_state(self, window: np.ndarray) -> np.ndarray:
        """Returns the handle's state (13,) for counted angles, newest first."""
        speeds = (window[0] - window[-1]) / self._window_s
        return self._arm.calc_handle_state(
            np.concatenate([self._S @ window[0], self._S @ speeds])
        )

    def _fill(self, context: Context, next_state: DiscreteValues) -> None:
        counted = self._count(self._arm_state.Eval(context)[:6])
        self._write(next_state, np.tile(counted, (self._num_kept, 1)))

    def _sample(self, context: Context, state: State) -> None:
        kept = context.get_discrete_state(int(self._window)).value().reshape(-1, 6)
        counted = self._count(self._arm_state.Eval(context)[:6])
        self._write(state.get_mutable_discrete_state(), np.vstack([counted, kept[:-1]]))

    def _write(self, values: DiscreteValues, window: np.ndarray) -> None:
        handle_state = self._calc_handle_state(window)
        values.get_mutable_vector(int(self._handle)).SetFromVector(handle_state)
        values.get_mutable_vector(int(self._window)).SetFromVector(window.ravel())
