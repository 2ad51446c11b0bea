"""Steps the tool as a rigid body, implicitly."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.common.value import Value
from pydrake.math import RigidTransform
from pydrake.systems.framework import Context, Diagram, DiscreteValues

from drake_haptics._core import AutoDiffVector, RigidToolDynamics
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.common.value_checks import check_positive
from drake_haptics.systems.framework.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
)
from drake_haptics.systems.framework.vector_ports import BuildAround


class HapticTool(Diagram):
    """A free rigid body that linearized backward Euler moves once per tick.

    The step takes each force with its stiffness and damping, so that contact of
    any stiffness is stable (Otaduy and Lin 2006): with the sum of all models
    [F; K; B], (M + h B + h² K) dV = h (F - h K V).

    .. pydrake_system::

        name: HapticTool
        input_ports:
        - <name of each wrench>
        - contact_chain (with the chain)
        - motions_and_gains (with the chain)
        output_ports:
        - X_WT
        - V_WT

    Each wrench is a wrench model (78) as `PenaltyForce` documents it; one that is
    not connected counts as zero.

    * `contact_chain` is that of `ContactQuery`, `motions_and_gains` (39) that of
      `VirtualCoupling`. With them the core computes the first two wrenches, those of
      the coupling and of the contacts, within the step, bit for bit as the inputs have
      them; those inputs then serve for inspection and for derivatives.

    * `X_WT` (7) is the pose [qw qx qy qz x y z] in the world, m.
    * `V_WT` (6) is the spatial velocity [ω; v] of the tool's origin in the
      world, rad/s and m/s.

    The state is one discrete group (13), [X_WT; V_WT], updated every period
    from 0 s on.
    """

    def __init__(
        self,
        dynamics: RigidToolDynamics,
        period_s: float,
        wrench_names: Sequence[str],
        X_WT: RigidTransform,
        *,
        enable_chain: bool = False,
    ):
        """Constructs the system.

        Args:
            dynamics: Mass and inertia of the tool.
            period_s: The tick, s.
            wrench_names: A name for each input port.
            X_WT: Default pose of the tool, which starts at rest.
            enable_chain: Whether coupling and contacts are computed within the step;
                they are the first two wrenches then.

        Raises:
            ValueError: The period is not positive.
        """
        super().__init__()
        check_positive(period_s=period_s)
        self._dynamics = dynamics
        self._period_s = period_s
        step = _ImplicitStep(dynamics, period_s, wrench_names, X_WT, enable_chain)
        BuildAround(self, "step", step, {"X_WT": 7, "V_WT": 6})

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
        """Period at which Drake steps the tool, s, which is the tick."""
        return self._period_s


STATE_NAMES = "qw qx qy qz x y z wx wy wz vx vy vz".split()


class _ImplicitStep(DifferentiableSystem):
    """The state of a `HapticTool`, and its update."""

    undifferentiated = frozenset({"contact_chain", "motions_and_gains"})

    def __init__(
        self,
        dynamics: RigidToolDynamics,
        period_s: float,
        wrench_names: Sequence[str],
        X_WT: RigidTransform,
        enable_chain: bool,
    ):
        super().__init__()
        self._dynamics = dynamics
        self._period_s = period_s
        self._wrenches = [
            self.DeclareVectorInputPort(name, 78) for name in wrench_names
        ]
        # Coupling and contacts come from the chain, if there is one.
        self._read = self._wrenches[2:] if enable_chain else self._wrenches
        self._eval_read = [port.Eval for port in self._read]
        self._has_free = False
        state = self.DeclareDiscreteState(
            np.concatenate([pose_to_vector(X_WT), np.zeros(6)])
        )
        self._eval_state = self.DeclareStateOutputPort("state", state).Eval
        update = self._update
        if enable_chain:
            self._eval_chain = self.DeclareAbstractInputPort(
                "contact_chain", Value[object]()
            ).Eval
            self._eval_joined = self.DeclareVectorInputPort(
                "motions_and_gains", 39
            ).Eval
            update = self._update_chained
        self.DeclarePeriodicDiscreteUpdateEvent(period_s, 0.0, update)

    def _update(self, context: Context, next_state: DiscreteValues) -> None:
        next_state.set_value(
            self._dynamics.step(
                self._eval_state(context), self._read_wrenches(context), self._period_s
            )
        )

    def _update_chained(self, context: Context, next_state: DiscreteValues) -> None:
        next_state.set_value(
            self._eval_chain(context).step_tool(
                self._eval_joined(context),
                self._dynamics,
                self._period_s,
                self._read_wrenches(context),
            )
        )

    def _read_wrenches(self, context: Context) -> list[np.ndarray]:
        """Returns the wrench models that are read and connected."""
        # Asking which are connected takes as long as reading them, and an exception
        # longer than a tick: a free one is met once.
        if not self._has_free:
            try:
                return [eval_wrench(context) for eval_wrench in self._eval_read]
            except RuntimeError:
                self._has_free = True
        return [port.Eval(context) for port in self._read if port.HasValue(context)]

    def differentiate(self, port: str, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the state."""
        return at.state

    def differentiate_update(self, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the next state with its derivatives."""
        wrench_model = at.sum_wrench_models(self._wrenches)
        return self._dynamics.step(at.state, wrench_model, self._period_s)

    def list_state_names(self) -> list[str]:
        """Returns a name for each number of the state."""
        return list(STATE_NAMES)
