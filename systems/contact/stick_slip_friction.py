"""Holds the tool by friction where it touches."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.common.value import AbstractValue, Value
from pydrake.systems.framework import BasicVector, Context, DiscreteValues

from drake_haptics._core import (
    AutoDiffFrictionStep,
    AutoDiffVector,
    FrictionStep,
    StickSlipModel,
)
from drake_haptics.common.value_checks import check_positive
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.framework.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
    join,
)

_NOTHING_MOVES = np.zeros(0)


class StickSlipFriction(DifferentiableSystem):
    """Friction of the clusters, after Hayward and Armstrong (2000; paper, 4.4.2).

    Each contact has an adhesion point and is pulled back to it by a force that grows
    with the displacement z and with the normal force N. It sticks up to the static
    limit, r μ N after `break_away_m`, and slides at μ N. The force is a function of
    displacement only: at rest nothing creeps. Contacts pass their adhesion on from tick
    to tick, so that the force does not jump where they merge, split or cross a seam,
    and no change of the normal force creates energy. The formulas are in
    `core/law/friction_law.h` and `core/law/friction_tracking.h`.

    .. pydrake_system::

        name: StickSlipFriction
        input_ports:
        - clusters
        - contact_wrench
        - X_WT
        - X_WO_<name of each object that moves>
        - V_WT (with the chain)
        - contact_chain (with the chain)
        output_ports:
        - wrench_model
        - friction_force

    Poses are [qw qx qy qz x y z] in the world, m.

    * `clusters` is a `drake_haptics._core.ClusterSet`.
    * `contact_wrench` is their `drake_haptics._core.PenaltyWrench`, whose forces are
      the normal forces.
    * `contact_chain` is that of `ContactQuery`, with which the core finds clusters and
      friction in one call, without the ports `clusters` and `contact_wrench`.
    * `wrench_model` (78) is [F; K; B] on the tool at its origin, as `PenaltyForce`
      documents it. B is zero: the implicit step damps contacts that stick.
    * `friction_force` is the `drake_haptics._core.FrictionStep` with the force on the
      tool at each cluster, whether it slides, and the elastic energy.

    The outputs are a function of the inputs now and of the state, without a sample of
    delay. The state is one discrete group, [X_WT (7); X_WO (7) of each object that
    moves; 32 slots of object, p_WC (3), nhat_BA_W (3), z_W (3), load (N), grip]: the
    poses and the strongest contacts of the last tick, updated every period from 0 s
    on. A slot without a load is empty.

    Under AutoDiffXd `clusters`, `contact_wrench` and `friction_force` are an
    `AutoDiffClusterSet`, an `AutoDiffPenaltyWrench` and an `AutoDiffFrictionStep` of
    `drake_haptics._core`. Derivatives are those of the branch taken: of each contact as
    it sticks or slides now, of its grip as it wears or is restored, and of its load,
    which is kept where the normal force N falls and follows where N grows; the force
    is smooth there, K and the grip have a kink. At no displacement, where the length of
    z has a kink, that length does not change.
    """

    undifferentiated = frozenset({"V_WT", "contact_chain"})

    def __init__(
        self,
        objects: Sequence[ContactObject],
        *,
        period_s: float,
        coefficient: Sequence[float],
        break_away_m: float,
        static_ratio: float = 1.2,
        reach_m: float = 5e-3,
        enable_chain: bool = False,
    ):
        """Constructs the system.

        Args:
            objects: Objects of the `ContactQuery`, in the same order.
            period_s: The tick, s.
            coefficient: Sliding coefficient μ of each object; at 0 the object has no
                friction.
            break_away_m: Displacement of a contact before it slips, m.
            static_ratio: Ratio r of the static to the sliding coefficient.
            reach_m: Displacement of a contact between ticks at which it keeps half of
                its friction, m.
            enable_chain: Whether there are the ports `V_WT` and `contact_chain`; the
                objects must rest then.

        Raises:
            ValueError: The period, `break_away_m` or `reach_m` is not positive, a
                coefficient is negative, there is not one for each object,
                `static_ratio` is below 1, or an object of a chain moves.
        """
        super().__init__()
        check_positive(period_s=period_s)
        self._model = StickSlipModel(
            list(coefficient),
            [item.X_WO is None for item in objects],
            static_ratio,
            break_away_m,
            reach_m,
        )
        self._clusters = self.DeclareAbstractInputPort("clusters", Value[object]())
        self._contact_wrench = self.DeclareAbstractInputPort(
            "contact_wrench", Value[object]()
        )
        self._X_WT = self.DeclareVectorInputPort("X_WT", 7)
        self._X_WO = [
            self.DeclareVectorInputPort(f"X_WO_{item.name}", 7)
            for item in objects
            if item.X_WO is None
        ]
        calc_step = self._calc_step
        if enable_chain:
            if self._X_WO:
                raise ValueError("enable_chain: the objects must rest")
            self._V_WT = self.DeclareVectorInputPort("V_WT", 6)
            self._chain = self.DeclareAbstractInputPort(
                "contact_chain", Value[object]()
            )
            calc_step = self._calc_chained_step
        self.DeclareDiscreteState(self._model.state_size)
        from_all = {self.all_input_ports_ticket(), self.xd_ticket()}
        # Output and update of a tick share one result of the core.
        self._step = self.DeclareObjectCacheEntry("step", calc_step, from_all)
        from_step = {self._step.ticket()}
        self._wrench_model = self.DeclareVectorOutputPort(
            "wrench_model", 78, self._calc_wrench_model, from_step
        )
        self._friction_force = self.DeclareAbstractOutputPort(
            "friction_force", Value[object], self._calc_friction_force, from_step
        )
        self.DeclarePeriodicDiscreteUpdateEvent(period_s, 0.0, self._update)

    def differentiate(
        self, port: str, at: AutoDiffPoint
    ) -> AutoDiffVector | AutoDiffFrictionStep:
        """Returns the wrench model or the step with its derivatives."""
        step = self._differentiate_step(at)
        return step.wrench_model if port == "wrench_model" else step

    def differentiate_update(self, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the next state with its derivatives."""
        return self._differentiate_step(at).next_state

    def _differentiate_step(self, at: AutoDiffPoint) -> AutoDiffFrictionStep:
        q_WO = [at.hold(_NOTHING_MOVES), *(at[port.get_name()] for port in self._X_WO)]
        return self._model.step(
            at.state, at["clusters"], at["contact_wrench"], at["X_WT"], join(q_WO)
        )

    def _calc_step(self, context: Context, step: AbstractValue) -> None:
        poses = [port.Eval(context) for port in self._X_WO]
        step.set_value(
            self._model.step(
                context.get_discrete_state_vector().value(),
                self._clusters.Eval(context),
                self._contact_wrench.Eval(context),
                self._X_WT.Eval(context),
                np.concatenate(poses) if poses else _NOTHING_MOVES,
            )
        )

    def _calc_chained_step(self, context: Context, step: AbstractValue) -> None:
        step.set_value(
            self._chain.Eval(context).find_friction(
                self._model,
                context.get_discrete_state_vector().value(),
                self._X_WT.Eval(context),
                self._V_WT.Eval(context),
            )
        )

    def _eval_step(self, context: Context) -> FrictionStep:
        return self._step.Eval(context)

    def _calc_wrench_model(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._eval_step(context).wrench_model)

    def _calc_friction_force(self, context: Context, output: AbstractValue) -> None:
        output.set_value(self._eval_step(context))

    def _update(self, context: Context, next_state: DiscreteValues) -> None:
        next_state.set_value(self._eval_step(context).next_state)
