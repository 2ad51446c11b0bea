"""Samples, limits and holds the wrench on a device."""

from __future__ import annotations

import numpy as np
from pydrake.systems.framework import Context, Diagram, DiscreteValues

from drake_haptics._core import AutoDiffVector, limit_coupling, limit_wrench
from drake_haptics.common.value_checks import check_at_least, check_positive
from drake_haptics.systems.framework.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
)
from drake_haptics.systems.framework.vector_ports import BuildAround

# Values of the port `status`.
SHOWN_AS_ASKED = 0.0
LIMITED = 1.0
NOT_FINITE = 2.0


class RenderedForceHold(Diagram):
    """Zero-order hold of the wrench on a device, within the device's limits.

    Force and torque are limited each by its norm, keeping its direction. A wrench
    that is not finite is shown as zero. This is the one sample of delay in the
    haptic loop.

    .. pydrake_system::

        name: RenderedForceHold
        input_ports:
        - F_Ho_W_commanded
        - coupled_motions
        output_ports:
        - F_Ho_W_rendered
        - status

    `F_Ho_W_commanded` and `F_Ho_W_rendered` are wrenches [τ; f], N·m and N. `status`
    (1) describes the last sample: 0 rendered as commanded, 1 limited, 2 not finite.

    `coupled_motions` (39) is `motions_and_gains` of the `VirtualCoupling` that commands
    the wrench; it need not be connected. With it the core computes that wrench and its
    limits in one call, bit for bit as `F_Ho_W_commanded` has it, which then serves for
    derivatives.

    The state is one discrete group (7), [F_Ho_W_rendered; status], updated every period
    from 0 s on; it depends on nothing before the sample.
    """

    def __init__(self, period_s: float, max_force_N: float, max_torque_Nm: float):
        """Constructs the system.

        Args:
            period_s: The tick, s.
            max_force_N: Largest norm of the force, N.
            max_torque_Nm: Largest norm of the torque, N·m.

        Raises:
            ValueError: The period is not positive or a limit is negative or not
                finite.
        """
        super().__init__()
        check_positive(period_s=period_s)
        check_at_least(0, max_force_N=max_force_N, max_torque_Nm=max_torque_Nm)
        sample = _LimitedSample(period_s, max_force_N, max_torque_Nm)
        BuildAround(self, "sample", sample, {"F_Ho_W_rendered": 6, "status": 1})


_STATE_NAMES = "tau_x tau_y tau_z f_x f_y f_z status".split()


class _LimitedSample(DifferentiableSystem):
    """The state of a `RenderedForceHold`, and its update."""

    undifferentiated = frozenset({"coupled_motions"})

    def __init__(self, period_s: float, max_force_N: float, max_torque_Nm: float):
        super().__init__()
        self._max_force_N = max_force_N
        self._max_torque_Nm = max_torque_Nm
        self._eval_F_Ho_W_commanded = self.DeclareVectorInputPort(
            "F_Ho_W_commanded", 6
        ).Eval
        coupled = self.DeclareVectorInputPort("coupled_motions", 39)
        self._is_coupled, self._eval_coupled = coupled.HasValue, coupled.Eval
        self.DeclareStateOutputPort("shown", self.DeclareDiscreteState(7))
        self.DeclarePeriodicDiscreteUpdateEvent(period_s, 0.0, self._update)

    def _update(self, context: Context, next_state: DiscreteValues) -> None:
        limits = self._max_torque_Nm, self._max_force_N
        if self._is_coupled(context):
            shown = limit_coupling(self._eval_coupled(context), *limits)
        else:
            shown = limit_wrench(self._eval_F_Ho_W_commanded(context), *limits)
        next_state.set_value(shown)

    def differentiate(self, port: str, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the state."""
        return at.state

    def differentiate_update(self, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the rendered wrench with its derivatives; the status has none."""
        asked = at["F_Ho_W_commanded"]
        gradient = np.zeros((7, at.num_derivatives))
        if np.isfinite(asked.value).all():
            for rows, largest in [
                (slice(0, 3), self._max_torque_Nm),
                (slice(3, 6), self._max_force_N),
            ]:
                part = asked.value[rows]
                gradient[rows] = _limit_slope(part, largest) @ asked.gradient[rows]
        shown = limit_wrench(asked.value, self._max_torque_Nm, self._max_force_N)
        return AutoDiffVector(shown, gradient)

    def list_state_names(self) -> list[str]:
        """Returns a name for each number of the state."""
        return list(_STATE_NAMES)


def _limit_slope(vector: np.ndarray, largest: float) -> np.ndarray:
    """Returns the derivative (3, 3) of a vector that is shortened to `largest`."""
    norm = float(np.linalg.norm(vector))
    if norm <= largest:
        return np.eye(3)
    direction = vector / norm
    return largest / norm * (np.eye(3) - np.outer(direction, direction))
