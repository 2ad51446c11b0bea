"""The constraint law's step as a LeafSystem: state, outputs and derivatives."""

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
    DiscreteValues,
    EventStatus,
    State,
)

from drake_haptics._core import (
    AutoDiffVector,
    ConstraintStepper,
    ConstraintStepResult,
    ContactServo,
    ContactSet,
    CouplingGains,
    joined_coupling_wrench,
)
from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose
from drake_haptics.systems.contact.contact_query import (
    ContactObject,
    differentiate_poses,
    differentiate_velocities,
)
from drake_haptics.systems.framework.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
    join,
    take,
)
from drake_haptics.systems.tool.haptic_tool import STATE_NAMES
from drake_haptics.systems.tool.virtual_coupling import coupling_wrench, gains_to_vector


@dataclass(frozen=True, eq=False)
class ConstraintWrench:
    """The wrenches of the contacts of a step. Immutable.

    Attributes:
        contacts: (n,) contacts that push.
        lambda_N: (n,) force along the normal of each, N; not negative.
        F_To_W: (6,) wrench on the tool at its origin in the world, [N·m; N].
        F_objects_W: (m, 6) wrench on each object at its origin in the world, [N·m; N].
    """

    contacts: ContactSet
    lambda_N: np.ndarray
    F_To_W: np.ndarray
    F_objects_W: np.ndarray

    @property
    def f_cluster_W(self) -> np.ndarray:
        """(n, 3) force of each contact on the tool, N; each contact is a cluster."""
        return self.lambda_N[:, None] * self.contacts.nhat_BA_W

    def __deepcopy__(self, memo: object) -> ConstraintWrench:
        """Returns itself, so that copies of a Context share it."""
        return self


class _ConstraintStep(DifferentiableSystem):
    """The state of a `ConstraintToolStep`, and all its outputs from one step."""

    undifferentiated = frozenset({"contacts", "contact_wrench", "wrench_model"})

    def __init__(
        self,
        make_stepper: Callable[[CouplingGains], ConstraintStepper],
        objects: Sequence[ContactObject],
        gains: CouplingGains,
        X_HT: RigidTransform,
        X_WT: RigidTransform,
        tick_s: float,
        step_s: float,
        wrench_names: Sequence[str],
        plant: MultibodyPlant | None,
        start_servo: Callable[[ConstraintStepper], ContactServo] | None,
    ):
        """Constructs the system; see `ConstraintToolStep` for the arguments.

        `make_stepper` makes the step of the core, of `step_s`, with gains of the
        coupling.
        """
        super().__init__()
        self._make_stepper = make_stepper
        self._objects = tuple(objects)
        self._q_HT = pose_to_vector(X_HT)
        self._step_s = step_s
        # Invalid arguments fail here, not at the first tick.
        stepper = make_stepper(gains)
        self._num_anchors = stepper.num_anchors
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
        if self._num_anchors > 0:
            self.DeclareDiscreteState(self._num_anchors)
            self.no_derivatives = (
                "takes friction into its step: take effects.friction out, or take"
                " contact.law: penalty"
            )
        # What a Context remembers of the last search.
        self._stepper = self.DeclareObjectCacheEntry(
            "stepper", self._prepare_stepper, {self.pa_ticket()}
        )
        from_all = {self.all_input_ports_ticket(), self.xd_ticket(), self.pa_ticket()}
        # Outputs and update of a tick share one result of the core.
        self._result = self.DeclareObjectCacheEntry(
            "result", self._calc_result, from_all
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
            "wrench_model", 78, self._calc_wrench_model, from_all
        )
        if self._num_anchors > 0:
            self.DeclareAbstractOutputPort(
                "friction_force", Value[object], self._calc_friction_force, from_result
            )
            self.DeclareVectorOutputPort(
                "friction_model", 78, self._calc_friction_model, from_result
            )
        if start_servo is not None:
            self._servo = start_servo(stepper)
            # As in `DeviceIo`, the state is read before all updates, and the end of a
            # tick tells the servo that the loop still runs.
            self.DeclarePeriodicUnrestrictedUpdateEvent(tick_s, 0.0, self._follow)
            self.DeclarePeriodicPublishEvent(tick_s, 0.0, self._renew)
            return
        if plant is not None:
            self.DeclareInitializationDiscreteUpdateEvent(self._start)
        if plant is not None and plant.has_sampled_output_ports():
            # Unrestricted like the plant's update, after which a discrete one would
            # run.
            self.DeclarePeriodicUnrestrictedUpdateEvent(
                self._step_s,
                0.0,
                lambda context, state: self._update(
                    context, state.get_mutable_discrete_state()
                ),
            )
        else:
            self.DeclarePeriodicDiscreteUpdateEvent(self._step_s, 0.0, self._update)

    def _prepare_stepper(self, context: Context, value: AbstractValue) -> None:
        """Makes the stepper of a Context, or sets its gains."""
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
        """Returns the sum (6,) of the input wrenches on the tool, [τ; f] at To in W."""
        F_To_W = np.zeros(6)
        for port in self._wrenches:
            if port.HasValue(context):
                F_To_W += port.Eval(context)[:6]
        return F_To_W

    def _read_anchors(self, context: Context) -> np.ndarray:
        """Returns the anchors of friction at the beginning of the tick."""
        if self._num_anchors == 0:
            return np.zeros(0)
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
            return take(wrenches, slice(78) if port == "coupling" else slice(78, 84))
        step = self._differentiate_step(at)
        if port == "F_To_W":
            return take(step, slice(13, 19))
        rows = [19 + 6 * i + k for i in self._motions for k in range(6)]
        return take(step, rows)

    def differentiate_update(self, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the next state with its derivatives."""
        return take(self._differentiate_step(at), slice(13))

    def _differentiate_coupling(self, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the wrenches (84,) of `coupling_wrench`."""
        gains = at.hold(gains_to_vector(at.parameters[self._gains]))
        return joined_coupling_wrench(
            join([at["X_WH"], at["V_WH"], at.state, gains, at.hold(self._q_HT)])
        )

    def _differentiate_step(self, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns next state, wrench on the tool and on each object."""
        # A new stepper, so that the result is a function of the Context alone.
        stepper = self._make_stepper(at.parameters[self._gains])
        return stepper.differentiate(
            at.state,
            at["X_WH"],
            at["V_WH"],
            take(at.sum_wrench_models(self._wrenches), slice(6)),
            differentiate_poses(self._objects, at),
            differentiate_velocities(self._objects, at),
        )

    def list_state_names(self) -> list[str]:
        """Returns a name for each number of the state."""
        return list(STATE_NAMES)

    def _update(self, context: Context, next_state: DiscreteValues) -> None:
        result = self._eval_result(context)
        next_state.set_value(0, np.concatenate([result.q_WT, result.V_WT]))
        if self._num_anchors > 0:
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
        F = self._contact_wrench.Eval(context).F_To_W + K @ (self._step_s * result.V_WT)
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
