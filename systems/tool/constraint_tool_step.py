"""The tool as a rigid body whose step keeps it a skin apart from all it meets."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from pydrake.common.value import AbstractValue, Value
from pydrake.math import RigidTransform
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import (
    BasicVector,
    Context,
    Diagram,
    DiagramBuilder,
    DiscreteValues,
    EventStatus,
    State,
    ValueProducer,
)

from drake_haptics._core import (
    AutoDiffVector,
    ConstraintStepper,
    ConstraintStepResult,
    ContactServo,
    ContactSet,
    ConvexPieces,
    CouplingGains,
    RigidToolDynamics,
    joined_coupling_wrench,
)
from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.framework.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
    export_parts,
)
from drake_haptics.systems.tool.haptic_tool import STATE_NAMES
from drake_haptics.systems.tool.virtual_coupling import coupling_wrench, gains_to_vector

# What is known before the first step. (A Value of Drake 1.58 cannot hold None.)
_NOTHING = "nothing"


@dataclass(frozen=True, eq=False)
class ConstraintWrench:
    """The wrenches of the contacts of a step. Immutable.

    Attributes:
        contacts: (n,) those that push.
        lambda_N: (n,) force along the normal of each, N; not negative.
        F_To_W: (6,) wrench on the tool at its origin in the world, [N·m; N].
        F_objects_W: (m, 6) wrench on each object at its origin, the same.
    """

    contacts: ContactSet
    lambda_N: np.ndarray
    F_To_W: np.ndarray
    F_objects_W: np.ndarray

    @property
    def f_cluster_W(self) -> np.ndarray:
        """(n, 3) force of each contact on the tool, N: each is by itself."""
        return self.lambda_N[:, None] * self.contacts.nhat_BA_W

    def __deepcopy__(self, memo: object) -> ConstraintWrench:
        """Returns itself, so that it crosses into copies of a Context."""
        return self


class ConstraintToolStep(Diagram):
    """A free rigid body that is drawn to the handle and kept apart from objects.

    It stands for `ContactQuery`, `ContactClustering`, `PenaltyForce`,
    `VirtualCoupling` and `HapticTool` together, by the constraint law. Of each pair of
    convex pieces that may come near in the tick there is a row: what the pair's
    distance will be, to first order in the tool's motion, must not be less than the
    skin. The motion is the one that minimizes the energy of inertia, coupling and
    applied wrenches under all rows (core/constraint/constraint_step.h). A fast tick is
    divided until no motion is longer than what the rows see, so that the tool passes
    through nothing, however thin or soft. What begins in overlap is led out slowly.

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
    counts, as for `ToolGravity`'s; one that is not connected counts as zero.

    * `X_WT` (7) and `V_WT` (6) are the tool's, as of `HapticTool`.
    * `F_Ho_W_commanded` (6) is the wrench [τ; f] on the handle at its origin in the
      world, N·m and N, as of `VirtualCoupling`.
    * `contacts` is a `drake_haptics.ContactSet` of the rows that push in the tick that
      begins: a pair of pieces has several where it is flush.
    * `contact_wrench` is their `ConstraintWrench`.
    * `F_To_W` (6) is their wrench [τ; f] on the tool at its origin, mean of the tick.
    * `F_O_W` (6 for each object that moves) are the wrenches on those objects, those of
      friction among them.
    * `wrench_model` (78) is [F; K; B] of the contacts: what they push with as the tool
      moves by δ in the tick is F - K δ; B is zero. K is that of the rows that push.
    * `coupling` (78) is that of `VirtualCoupling`.
    * `friction_force` is the `drake_haptics._core.FrictionStep` of `contacts`, and
      `friction_model` (78) its [F; K; B] on the tool, as of `StickSlipFriction`.

    Friction takes part in the same step: where the tool sticks it hangs on an anchor,
    and slides where the normal forces of this very tick do not hold it
    (core/constraint/row_friction.h).

    The state is a discrete group (13), [X_WT; V_WT], and with friction a second one
    (8 for each object), the anchors, both updated every period from 0 s on, or read
    from a servo that steps the tool; it is told at the end of each tick that the loop
    goes on. What the search knows from the last tick is the memory of a Context, and
    never changes an answer by more than round-off.

    The gains of the coupling are an abstract parameter of the Context; see
    `set_gains`. Outputs have no derivatives by them, and none at all with friction.
    Under AutoDiffXd the features that face each other stay, a row that just begins to
    push does push, and `contacts`, `contact_wrench` and `wrench_model` have no value.
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
            objects: What it can meet.
            skin_m: δ, the distance that it keeps from each object, m.
            dynamics: Mass and inertia.
            gains: Of the spring and the damper, in a Context that says no other.
            X_HT: Pose of the tool in the handle at which the spring rests.
            X_WT: Default pose; the tool starts at rest.
            period_s: The tick, s.
            wrench_names: A name for each input of another wrench.
            plant: One with a body that is the handle: `Simulator.Initialize` puts the
                tool there, and its update sees the plant as the plant's own does.
            coefficient: μ of friction with each object. Defaults to no friction.
            break_away_m: How far the tool gives way before it slides, m.
            servo_period_s: How often the tool is stepped between ticks, s. Defaults to
                at every tick. Nothing moves but it and the handle then.
            start_servo: Starts a thread that steps the tool instead, by a stepper of
                that period. The state is that thread's at each tick then.

        Raises:
            ValueError: The period, a skin or the break-away is not positive, a
                coefficient is negative, there is not one for each object, there is no
                object, or a name is used twice.
        """
        super().__init__()
        if not period_s > 0.0:
            raise ValueError(f"period_s must be positive, is {period_s}")
        if not objects:
            raise ValueError("objects must not be empty")
        if len({item.name for item in objects}) < len(objects):
            raise ValueError("two objects have the same name")
        self._dynamics = dynamics
        self._period_s = period_s
        self._X_HT = X_HT
        builder = DiagramBuilder()
        self._step = builder.AddNamedSystem(
            "step",
            _ConstraintStep(
                tool,
                objects,
                skin_m,
                dynamics,
                gains,
                X_HT,
                X_WT,
                period_s,
                wrench_names,
                plant,
                coefficient,
                break_away_m,
                servo_period_s,
                start_servo,
            ),
        )
        step = self._step
        for port in map(step.get_input_port, range(step.num_input_ports())):
            builder.ExportInput(port, port.get_name())
        export_parts(builder, step.GetOutputPort("state"), {"X_WT": 7, "V_WT": 6})
        for port in map(step.get_output_port, range(step.num_output_ports())):
            if port.get_name() != "state":
                builder.ExportOutput(port, port.get_name())
        builder.BuildInto(self)

    @property
    def dynamics(self) -> RigidToolDynamics:
        """Mass and inertia."""
        return self._dynamics

    @property
    def period_s(self) -> float:
        """The tick, s."""
        return self._period_s

    @property
    def X_HT(self) -> RigidTransform:
        """Pose of the tool in the handle at which the spring rests."""
        return self._X_HT

    def get_gains(self, context: Context) -> CouplingGains:
        """Returns the gains of the spring and the damper.

        Args:
            context: Of this system.
        """
        own = self.GetSubsystemContext(self._step, context)
        gains: CouplingGains = own.get_abstract_parameter(0).get_value()
        return gains

    def set_gains(self, context: Context, gains: CouplingGains) -> None:
        """Changes the gains, from now on.

        Args:
            context: Of this system.
            gains: Of the spring and the damper.

        Raises:
            TypeError: They are no `CouplingGains`.
        """
        if not isinstance(gains, CouplingGains):
            raise TypeError(f"gains must be CouplingGains, is {type(gains).__name__}")
        if gains != self.get_gains(context):
            own = self.GetMutableSubsystemContext(self._step, context)
            own.get_mutable_abstract_parameter(0).set_value(gains)


class _ConstraintStep(DifferentiableSystem):
    """The state of a `ConstraintToolStep`, and all of its outputs from one step."""

    undifferentiated = frozenset({"contacts", "contact_wrench", "wrench_model"})

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
        wrench_names: Sequence[str],
        plant: MultibodyPlant | None,
        coefficient: Sequence[float],
        break_away_m: float,
        servo_period_s: float | None,
        start_servo: Callable[[ConstraintStepper], ContactServo] | None,
    ):
        super().__init__()
        self._coefficient = np.array(coefficient, dtype=float)
        self._break_away_m = break_away_m
        self._q_HT = pose_to_vector(X_HT)
        self._tool = tool
        self._objects = tuple(objects)
        self._skin_m = np.array(skin_m, dtype=float)
        self._dynamics = dynamics
        self._period_s = servo_period_s or period_s
        # Wrong arguments are refused here, and not at the first tick.
        num_anchors = self._make_stepper(gains).num_anchors
        self._gains = self.DeclareAbstractParameter(Value[object](gains))
        self._X_WH = self.DeclareVectorInputPort("X_WH", 7)
        self._V_WH = self.DeclareVectorInputPort("V_WH", 6)
        self._motions = {
            i: (
                self.DeclareVectorInputPort(f"X_WO_{item.name}", 7),
                self.DeclareVectorInputPort(f"V_WO_{item.name}", 6),
            )
            for i, item in enumerate(objects)
            if item.X_WO is None
        }
        self._wrenches = [
            self.DeclareVectorInputPort(name, 78) for name in wrench_names
        ]
        state = self.DeclareDiscreteState(
            np.concatenate([pose_to_vector(X_WT), np.zeros(6)])
        )
        if num_anchors > 0:
            self.DeclareDiscreteState(num_anchors)
            self.no_derivatives = (
                "takes friction into its step: take effects.friction out, or take"
                " contact.law: penalty"
            )
        # The memory of a Context.
        self._stepper = self.DeclareCacheEntry(
            description="stepper",
            value_producer=ValueProducer(
                allocate=lambda: Value[object](_NOTHING), calc=self._prepare_stepper
            ),
            prerequisites_of_calc={self.pa_ticket()},
        )
        from_all = {self.all_input_ports_ticket(), self.xd_ticket(), self.pa_ticket()}
        # Outputs and update of a tick share one answer of the core.
        self._result = self.DeclareCacheEntry(
            description="result",
            value_producer=ValueProducer(
                allocate=lambda: Value[object](_NOTHING), calc=self._calc_result
            ),
            prerequisites_of_calc=from_all,
        )
        from_result = {self._result.ticket()}
        self.DeclareStateOutputPort("state", state)
        self.DeclareVectorOutputPort(
            "F_Ho_W_commanded", 6, self._calc_F_Ho_W_commanded, from_result
        )
        self.DeclareAbstractOutputPort(
            "contacts", Value[object], self._calc_contacts, from_result
        )
        self._contact_wrench = self.DeclareAbstractOutputPort(
            "contact_wrench", Value[object], self._calc_contact_wrench, from_result
        )
        self.DeclareVectorOutputPort("F_To_W", 6, self._calc_F_To_W, from_result)
        if self._motions:
            self.DeclareVectorOutputPort(
                "F_O_W", 6 * len(self._motions), self._calc_F_O_W, from_result
            )
        self.DeclareVectorOutputPort(
            "coupling",
            78,
            self._calc_coupling,
            {
                self._X_WH.ticket(),
                self._V_WH.ticket(),
                self.xd_ticket(),
                self.pa_ticket(),
            },
        )
        self.DeclareVectorOutputPort(
            "wrench_model",
            78,
            self._calc_wrench_model,
            from_all,
        )
        if num_anchors > 0:
            self.DeclareAbstractOutputPort(
                "friction_force",
                Value[object],
                self._calc_friction_force,
                from_result,
            )
            self.DeclareVectorOutputPort(
                "friction_model", 78, self._calc_friction_model, from_result
            )
        if start_servo is not None:
            if self._motions:
                raise ValueError("a servo steps a tool among objects that rest")
            self._servo = start_servo(self._make_stepper(gains))
            # As `DeviceIo` does: read before all updates, and say at the end of a tick
            # that the loop goes on.
            self.DeclarePeriodicUnrestrictedUpdateEvent(period_s, 0.0, self._follow)
            self.DeclarePeriodicPublishEvent(period_s, 0.0, self._renew)
            return
        if plant is not None:
            self.DeclareInitializationDiscreteUpdateEvent(self._start)
        if plant is not None and plant.has_sampled_output_ports():
            # As the plant's: a discrete update would come after it.
            self.DeclarePeriodicUnrestrictedUpdateEvent(
                self._period_s,
                0.0,
                lambda context, state: self._update(
                    context, state.get_mutable_discrete_state()
                ),
            )
        else:
            self.DeclarePeriodicDiscreteUpdateEvent(self._period_s, 0.0, self._update)

    def _make_stepper(self, gains: CouplingGains) -> ConstraintStepper:
        stepper = ConstraintStepper(
            self._tool,
            [item.decomposition for item in self._objects],
            self._skin_m,
            self._dynamics,
            gains,
            self._q_HT,
            self._period_s,
            self._coefficient,
            self._break_away_m,
        )
        for i, item in enumerate(self._objects):
            if item.X_WO is not None:
                stepper.set_object_pose(i, pose_to_vector(item.X_WO), np.zeros(6))
        return stepper

    def _prepare_stepper(self, context: Context, value: AbstractValue) -> None:
        """Makes the stepper of a Context, or tells it of other gains."""
        gains = context.get_abstract_parameter(self._gains).get_value()
        stepper = value.get_value()
        if isinstance(stepper, ConstraintStepper):
            stepper.set_gains(gains)
        else:
            value.set_value(self._make_stepper(gains))

    def _calc_result(self, context: Context, value: AbstractValue) -> None:
        stepper: ConstraintStepper = self._stepper.Eval(context)
        for i, (X_WO, V_WO) in self._motions.items():
            stepper.set_object_pose(i, X_WO.Eval(context), V_WO.Eval(context))
        state = context.get_discrete_state(0).value()
        value.set_value(
            stepper.step(
                state[:7],
                state[7:],
                self._X_WH.Eval(context),
                self._V_WH.Eval(context),
                self._sum_wrenches(context),
                self._read_anchors(context),
            )
        )

    def _sum_wrenches(self, context: Context) -> np.ndarray:
        """Returns (6,) what else pushes the tool, [τ; f] at To in the world."""
        F_To_W = np.zeros(6)
        for port in self._wrenches:
            if port.HasValue(context):
                F_To_W += port.Eval(context)[:6]
        return F_To_W

    def _read_anchors(self, context: Context) -> np.ndarray:
        """Returns the anchors of friction at the tick's beginning."""
        if len(self._coefficient) == 0:
            return self._coefficient
        anchors: np.ndarray = context.get_discrete_state(1).value()
        return anchors

    def _eval_result(self, context: Context) -> ConstraintStepResult:
        return self._result.Eval(context)

    def differentiate(self, port: str, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns a vector output with its derivatives."""
        if port == "state":
            return at.state
        if port in ("coupling", "F_Ho_W_commanded"):
            wrenches = self._differentiate_coupling(at)
            return _take(wrenches, slice(78) if port == "coupling" else slice(78, 84))
        step = self._differentiate_step(at)
        if port == "F_To_W":
            return _take(step, slice(13, 19))
        rows = [19 + 6 * i + k for i in self._motions for k in range(6)]
        return _take(step, rows)

    def differentiate_update(self, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the next state with its derivatives."""
        return _take(self._differentiate_step(at), slice(13))

    def _differentiate_coupling(self, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the wrenches (84,) of `coupling_wrench`."""
        gains = gains_to_vector(at.parameters[self._gains])
        parts = [
            at["X_WH"],
            at["V_WH"],
            at.state,
            AutoDiffVector(gains, np.zeros((len(gains), at.num_derivatives))),
        ]
        joined = AutoDiffVector(
            np.concatenate([part.value for part in parts]),
            np.vstack([part.gradient for part in parts]),
        )
        return joined_coupling_wrench(joined, self._q_HT)

    def _differentiate_step(self, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns next state, wrench on the tool and on each object."""

        def hold(value: np.ndarray) -> AutoDiffVector:
            return AutoDiffVector(value, np.zeros((len(value), at.num_derivatives)))

        X_WO, V_WO = [], []
        for item in self._objects:
            if item.X_WO is None:
                X_WO.append(at[f"X_WO_{item.name}"])
                V_WO.append(at[f"V_WO_{item.name}"])
            else:
                X_WO.append(hold(pose_to_vector(item.X_WO)))
                V_WO.append(hold(np.zeros(6)))
        models = [
            at[port.get_name()] for port in self._wrenches if port.get_name() in at
        ]
        F_To_W = AutoDiffVector(
            sum((model.value[:6] for model in models), np.zeros(6)),
            sum(
                (model.gradient[:6] for model in models),
                np.zeros((6, at.num_derivatives)),
            ),
        )
        # A new one, so that the answer is a function of the Context alone.
        stepper = self._make_stepper(at.parameters[self._gains])
        return stepper.differentiate(
            at.state, at["X_WH"], at["V_WH"], F_To_W, X_WO, V_WO
        )

    def list_state_names(self) -> list[str]:
        """Returns a name for each number of the state."""
        return list(STATE_NAMES)

    def _update(self, context: Context, next_state: DiscreteValues) -> None:
        result = self._eval_result(context)
        next_state.set_value(0, np.concatenate([result.q_WT, result.V_WT]))
        if len(self._coefficient) > 0:
            next_state.set_value(1, result.friction.next_state)

    def _start(self, context: Context, next_state: DiscreteValues) -> None:
        X_WT = vector_to_pose(self._X_WH.Eval(context)) @ vector_to_pose(self._q_HT)
        V_WH = self._V_WH.Eval(context)
        arm = X_WT.translation() - self._X_WH.Eval(context)[4:]
        V_WT = V_WH + np.concatenate([np.zeros(3), np.cross(V_WH[:3], arm)])
        next_state.set_value(0, np.concatenate([pose_to_vector(X_WT), V_WT]))

    def _follow(self, context: Context, state: State) -> None:
        state.get_mutable_discrete_state(0).set_value(self._servo.tool_state)

    def _renew(self, context: Context) -> EventStatus:
        gains = context.get_abstract_parameter(self._gains).get_value()
        self._servo.renew(gains, self._sum_wrenches(context))
        return EventStatus.Succeeded()

    def _calc_F_Ho_W_commanded(self, context: Context, output: BasicVector) -> None:
        output.set_value(self._eval_result(context).F_Ho_W_commanded)

    def _calc_contacts(self, context: Context, output: AbstractValue) -> None:
        output.set_value(self._eval_result(context).contacts)

    def _calc_contact_wrench(self, context: Context, output: AbstractValue) -> None:
        result = self._eval_result(context)
        contacts, lambda_N = result.contacts, result.lambda_N
        f_W = lambda_N[:, None] * contacts.nhat_BA_W
        p_WTo = context.get_discrete_state(0).value()[4:7]
        tau_W = np.cross(contacts.p_WCa - p_WTo, f_W)
        output.set_value(
            ConstraintWrench(
                contacts,
                lambda_N,
                np.concatenate([tau_W.sum(axis=0), f_W.sum(axis=0)]),
                result.F_Oo_W,
            )
        )

    def _calc_F_To_W(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._contact_wrench.Eval(context).F_To_W)

    def _calc_F_O_W(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(
            self._eval_result(context).F_Oo_W[list(self._motions)].ravel()
        )

    def _calc_wrench_model(self, context: Context, output: BasicVector) -> None:
        result = self._eval_result(context)
        K = result.contact_stiffness
        F = self._contact_wrench.Eval(context).F_To_W + K @ (
            self._period_s * result.V_WT
        )
        output.SetFromVector(np.concatenate([F, K.ravel(), np.zeros(36)]))

    def _calc_friction_force(self, context: Context, output: AbstractValue) -> None:
        output.set_value(self._eval_result(context).friction)

    def _calc_friction_model(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._eval_result(context).friction.wrench_model)

    def _calc_coupling(self, context: Context, output: BasicVector) -> None:
        state = context.get_discrete_state(0).value()
        wrenches = coupling_wrench(
            self._X_WH.Eval(context),
            self._V_WH.Eval(context),
            self._q_HT,
            state[:7],
            state[7:],
            context.get_abstract_parameter(self._gains).get_value(),
        )
        output.SetFromVector(wrenches[:78])


def _take(vector: AutoDiffVector, rows: slice | list[int]) -> AutoDiffVector:
    """Returns some entries of a vector."""
    return AutoDiffVector(vector.value[rows], vector.gradient[rows])
