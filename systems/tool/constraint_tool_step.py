"""Steps the tool as a rigid body that constraints keep apart from objects."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from pydrake.math import RigidTransform
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Context, Diagram

from drake_haptics._core import (
    ConstraintStepper,
    ContactServo,
    ConvexPieces,
    CouplingGains,
    RigidToolDynamics,
)
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.common.value_checks import check_positive
from drake_haptics.systems.contact.contact_query import ContactObject, check_objects
from drake_haptics.systems.framework.vector_ports import BuildAround
from drake_haptics.systems.tool.constraint_step import _ConstraintStep


class ConstraintToolStep(Diagram):
    """A free rigid body that is pulled to the handle and kept apart from objects.

    Under the constraint law it replaces `ContactQuery`, `ContactClustering`,
    `PenaltyForce`, `VirtualCoupling` and `HapticTool` together. Each pair of convex
    pieces that may come near in the tick gives a row: the distance of the pair after
    the step, to first order in the tool's motion, must not be less than the skin. The
    motion is the one that minimizes the energy of inertia, coupling and applied
    wrenches under all rows (core/constraint/constraint_step.h). A fast tick is divided
    until no motion is longer than the distance up to which rows are found, so that the
    tool passes through nothing, however thin or soft. A tool that begins in overlap is
    moved out slowly.

    .. pydrake_system::

        name: ConstraintToolStep
        input_ports:
        - X_WH
        - V_WH
        - X_WO_<name of each object that moves>
        - V_WO_<name of each object that moves>
        - <name of each wrench>
        output_ports:
        - X_WT
        - V_WT
        - F_Ho_W_commanded
        - contacts
        - contact_wrench
        - F_To_W
        - F_O_W (with objects that move)
        - coupling
        - wrench_model
        - friction_force (with friction)
        - friction_model (with friction)

    Poses are [qw qx qy qz x y z] in the world, m; `V_WH`, `V_WT` and `V_WO_<name>` are
    spatial velocities [ω; v] of the frame's origin, rad/s and m/s. Each other input is
    a wrench model (78) as `PenaltyForce` documents it, of which the wrench alone
    counts, like that of `ToolGravity`; an input that is not connected counts as zero.

    * `X_WT` (7) and `V_WT` (6) are the tool's pose and velocity, as in `HapticTool`.
    * `F_Ho_W_commanded` (6) is the wrench [τ; f] on the handle at its origin in the
      world, N·m and N, as in `VirtualCoupling`.
    * `contacts` is a `drake_haptics.ContactSet` of the rows that push in the tick that
      begins: a pair of flush pieces has several.
    * `contact_wrench` is their `ConstraintWrench`.
    * `F_To_W` (6) is their wrench [τ; f] on the tool at its origin, averaged over the
      tick.
    * `F_O_W` (6 for each object that moves) are the wrenches on those objects,
      including friction.
    * `wrench_model` (78) is [F; K; B] of the contacts: as the tool moves by δ in the
      tick they push with F - K δ; B is zero. K is that of the rows that push.
    * `coupling` (78) is that of `VirtualCoupling`.
    * `friction_force` is the `drake_haptics._core.FrictionStep` of `contacts`, and
      `friction_model` (78) its [F; K; B] on the tool, as in `StickSlipFriction`.

    Friction takes part in the same step: where the tool sticks it is held at an anchor,
    and it slides where the normal forces of the same tick cannot hold it
    (core/constraint/row_friction.h).

    The state is a discrete group (13), [X_WT; V_WT], and with friction a second one (8
    for each object), the anchors, both updated every period from 0 s on, or read from a
    servo that steps the tool. At the end of each tick the system tells that servo that
    the loop still runs. A Context remembers the search of the last tick, which never
    changes a result by more than round-off.

    The gains of the coupling are an abstract parameter of the Context; see `set_gains`.
    Outputs have no derivatives with respect to them, and none at all with friction.
    Under AutoDiffXd the features stay the same, a row that just begins to push counts
    as pushing, and `contacts`, `contact_wrench` and `wrench_model` have no value.
    """

    def __init__(
        self,
        tool: ConvexPieces,
        objects: Sequence[ContactObject],
        skin_m: Sequence[float],
        dynamics: RigidToolDynamics,
        gains: CouplingGains,
        X_HT: RigidTransform,
        X_WT: RigidTransform,
        period_s: float,
        wrench_names: Sequence[str] = (),
        plant: MultibodyPlant | None = None,
        *,
        coefficient: Sequence[float] = (),
        break_away_m: float = 1e-4,
        servo_period_s: float | None = None,
        start_servo: Callable[[ConstraintStepper], ContactServo] | None = None,
    ):
        """Constructs the system.

        Args:
            tool: Convex pieces of the tool, in its frame.
            objects: Objects that the tool can meet.
            skin_m: Distance δ that the tool keeps from each object, m.
            dynamics: Mass and inertia of the tool.
            gains: Default gains of the spring and the damper.
            X_HT: Pose of the tool in the handle at which the spring rests.
            X_WT: Default pose of the tool, which starts at rest.
            period_s: The tick, s.
            wrench_names: A name for each input of another wrench.
            plant: Plant with a body that is the handle: `Simulator.Initialize` puts the
                tool there, and the system's update sees the plant as the plant's own
                update does. Defaults to none.
            coefficient: Friction coefficient μ for each object. Defaults to no
                friction.
            break_away_m: Displacement of the tool before it slides, m.
            servo_period_s: Period at which the tool is stepped, s. If it is shorter
                than the tick, only tool and handle move between ticks. Defaults to the
                tick.
            start_servo: Function that starts a thread to step the tool instead, with a
                stepper of that period. The state at each tick is then that of the
                thread. Defaults to none.

        Raises:
            ValueError: The period, a skin or the break-away is not positive, a
                coefficient is negative, there is not one for each object, there is no
                object, a name is used twice, or `start_servo` is given with an object
                that moves.
        """
        super().__init__()
        check_positive(period_s=period_s)
        check_objects(objects)
        if start_servo is not None and any(item.X_WO is None for item in objects):
            raise ValueError("start_servo: the objects must rest")
        self._dynamics = dynamics
        self._period_s = period_s
        self._X_HT = X_HT
        step_s = servo_period_s or period_s
        self._step_period_s = period_s if start_servo is not None else step_s
        resting = {
            i: pose_to_vector(item.X_WO)
            for i, item in enumerate(objects)
            if item.X_WO is not None
        }

        def make_stepper(gains: CouplingGains) -> ConstraintStepper:
            stepper = ConstraintStepper(
                tool,
                [item.decomposition for item in objects],
                skin_m,
                dynamics,
                gains,
                pose_to_vector(X_HT),
                step_s,
                coefficient,
                break_away_m,
            )
            for i, X_WO in resting.items():
                stepper.set_object_pose(i, X_WO, np.zeros(6))
            return stepper

        self._step = _ConstraintStep(
            make_stepper,
            objects,
            gains,
            X_HT,
            X_WT,
            period_s,
            step_s,
            wrench_names,
            plant,
            start_servo,
        )
        BuildAround(self, "step", self._step, {"X_WT": 7, "V_WT": 6})

    @property
    def dynamics(self) -> RigidToolDynamics:
        """Mass and inertia."""
        return self._dynamics

    @property
    def period_s(self) -> float:
        """The tick, s."""
        return self._period_s

    @property
    def step_period_s(self) -> float:
        """Period at which Drake steps the tool, s, at most the tick."""
        return self._step_period_s

    @property
    def X_HT(self) -> RigidTransform:
        """Pose of the tool in the handle at which the spring rests."""
        return self._X_HT

    def get_gains(self, context: Context) -> CouplingGains:
        """Returns the gains of the spring and the damper.

        Args:
            context: Context of this system.
        """
        own = self.GetSubsystemContext(self._step, context)
        gains: CouplingGains = own.get_abstract_parameter(0).get_value()
        return gains

    def set_gains(self, context: Context, gains: CouplingGains) -> None:
        """Changes the gains, from now on.

        Args:
            context: Context of this system.
            gains: Gains of the spring and the damper.

        Raises:
            TypeError: The gains are not `CouplingGains`.
        """
        if not isinstance(gains, CouplingGains):
            raise TypeError(f"gains must be CouplingGains, is {type(gains).__name__}")
        if gains != self.get_gains(context):
            own = self.GetMutableSubsystemContext(self._step, context)
            own.get_mutable_abstract_parameter(0).set_value(gains)
