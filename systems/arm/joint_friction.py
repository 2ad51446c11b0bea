"""Simulates dry friction of an arm's motors."""

from __future__ import annotations

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import BasicVector, Context, DiscreteValues, LeafSystem

from drake_haptics.common.value_checks import check_at_least, check_positive

# Angular frequency of a joint on its bristles times the tick: the largest that an
# integrator of second order follows well with one step per tick.
_STIFFNESS = 0.4
_DAMPING_RATIO = 0.7


class JointFriction(LeafSystem):
    """Coulomb and viscous friction of each motor.

    An elastic bristle with a slider in series and a damper beside it (Prandtl's
    element, as in the elastoplastic model of Dupont, Hayward, Armstrong and Altpeter,
    IEEE TAC 47(5), 2002), per motor:

        τ = −clamp(k (q − w) + d q̇, ±τ_c) − b q̇,

    with the anchor w, which at every tick follows the motor so far that `|k (q − w)| ≤
    τ_c`. So a damped spring holds a motor below its breakaway torque without creep or
    chatter; above it the motor slides against τ_c. In continuous time the element never
    returns more energy than its spring has stored.

    A motor moves by τ_c/k before it slides. k is as large as one step of the integrator
    per tick can follow: k = (0.4/T)² times the inertia that the motor moves while all
    other motors are free.

    .. pydrake_system::

        name: JointFriction
        input_ports:
        - arm_state
        output_ports:
        - generalized_force

    * `arm_state` (12) is [q; v] of the arm's plant, rad and rad/s.
    * `generalized_force` (6) is for the plant, N·m.

    The state is one discrete group (6), w, updated every period from 0 s on.
    """

    no_derivatives = "sticks or slides: leave device.twin.friction out"

    def __init__(
        self,
        plant: MultibodyPlant,
        period_s: float,
        joint_per_motor: np.ndarray,
        coulomb_Nm: np.ndarray,
        viscous_Nms_per_rad: np.ndarray,
    ):
        """Constructs the system.

        Args:
            plant: Finalized plant of the arm. At its default angles no bristle is
                stretched, and its inertia is taken there.
            period_s: The tick T, s.
            joint_per_motor: S (6, 6) in q = S q_motor, invertible.
            coulomb_Nm: (6,) dry friction τ_c of each motor after its gear, N·m.
            viscous_Nms_per_rad: (6,) viscous friction b of each motor, N·m·s/rad.

        Raises:
            ValueError: The period is not positive or a friction is negative.
        """
        super().__init__()
        check_positive(period_s=period_s)
        check_at_least(
            0, coulomb_Nm=coulomb_Nm, viscous_Nms_per_rad=viscous_Nms_per_rad
        )
        S = np.array(joint_per_motor, dtype=float)
        self._motor_per_joint = np.linalg.inv(S)
        self._coulomb_Nm = np.array(coulomb_Nm, dtype=float)
        self._viscous = np.array(viscous_Nms_per_rad, dtype=float)
        context = plant.CreateDefaultContext()
        M = S.T @ plant.CalcMassMatrix(context) @ S
        inertia = 1.0 / np.diag(np.linalg.inv(M))
        swing = _STIFFNESS / period_s
        self._stiffness = swing**2 * inertia
        self._damping = 2.0 * _DAMPING_RATIO * swing * inertia
        self._break_away = self._coulomb_Nm / self._stiffness
        self._arm_state = self.DeclareVectorInputPort("arm_state", 12)
        anchors = self.DeclareDiscreteState(
            self._motor_per_joint @ plant.GetPositions(context)
        )
        self.DeclarePeriodicDiscreteUpdateEvent(period_s, 0.0, self._pull_anchors)
        self.DeclareVectorOutputPort(
            "generalized_force",
            6,
            self._calc_generalized_force,
            {self._arm_state.ticket(), self.discrete_state_ticket(anchors)},
        )

    @property
    def break_away_rad(self) -> np.ndarray:
        """(6,) angle that each motor moves before it slides, rad after its gear."""
        return self._break_away.copy()

    def calc_stored_energy(self, context: Context) -> float:
        """Returns the energy that the bristles can give back, J.

        Args:
            context: Context of this system.
        """
        stretch = np.abs(self._calc_motor_state(context)[0] - self._read(context))
        # A bristle that is stretched beyond its limit slides back to it.
        held = np.minimum(stretch, self._break_away)
        beyond = self._coulomb_Nm * (stretch - held)
        return float((0.5 * self._stiffness * held**2 + beyond).sum())

    def _calc_motor_state(self, context: Context) -> np.ndarray:
        """Returns angles and speeds of the motors after their gears, (2, 6)."""
        state = self._arm_state.Eval(context).reshape(2, 6)
        return state @ self._motor_per_joint.T

    def _read(self, context: Context) -> np.ndarray:
        return context.get_discrete_state_vector().value()

    def _pull_anchors(self, context: Context, next_state: DiscreteValues) -> None:
        angles = self._calc_motor_state(context)[0]
        stretch = angles - self._read(context)
        next_state.set_value(
            angles - np.clip(stretch, -self._break_away, self._break_away)
        )

    def _calc_generalized_force(self, context: Context, output: BasicVector) -> None:
        angles, speeds = self._calc_motor_state(context)
        bristle = self._stiffness * (angles - self._read(context))
        dry = np.clip(
            bristle + self._damping * speeds, -self._coulomb_Nm, self._coulomb_Nm
        )
        output.SetFromVector(-self._motor_per_joint.T @ (dry + self._viscous * speeds))
