"""The last gate before a device: samples, limits and holds a wrench."""

from __future__ import annotations

import math

from pydrake.systems.framework import (
    BasicVector,
    Context,
    DiscreteValues,
    InputPort,
    LeafSystem,
    OutputPort,
)

# Values of the port `status`.
SHOWN_AS_ASKED = 0.0
LIMITED = 1.0
NOT_FINITE = 2.0


class DisplayForceHold(LeafSystem):
    """Zero-order hold of the wrench on a device, within the device's limits.

    Force and torque are limited each by its norm, keeping its direction. A wrench
    that is not finite is shown as zero. This is the one sample of delay in the
    haptic loop.

    .. pydrake_system::

        name: DisplayForceHold
        input_ports:
        - F_display
        output_ports:
        - F_applied
        - status

    `F_display` and `F_applied` are wrenches [τ; f], N·m and N. `status` (1) tells of
    the last sample: 0 shown as asked, 1 limited, 2 not finite.

    The state is one discrete group (7), [F_applied; status], updated every period
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
        if not period_s > 0.0:
            raise ValueError(f"period_s must be positive, is {period_s}")
        for name, limit in [
            ("max_force_N", max_force_N),
            ("max_torque_Nm", max_torque_Nm),
        ]:
            if not (limit >= 0.0 and math.isfinite(limit)):
                raise ValueError(f"{name} must be finite and not negative, is {limit}")
        self._max_force_N = max_force_N
        self._max_torque_Nm = max_torque_Nm
        self._F_display = self.DeclareVectorInputPort("F_display", 6)
        state = self.DeclareDiscreteState(7)
        from_state = {self.discrete_state_ticket(state)}
        self._F_applied = self.DeclareVectorOutputPort(
            "F_applied", 6, self._calc_F_applied, from_state
        )
        self._status = self.DeclareVectorOutputPort(
            "status", 1, self._calc_status, from_state
        )
        self.DeclarePeriodicDiscreteUpdateEvent(period_s, 0.0, self._update)

    def get_display_wrench_input_port(self) -> InputPort:
        """Returns the input `F_display`."""
        return self._F_display

    def get_applied_wrench_output_port(self) -> OutputPort:
        """Returns the output `F_applied`."""
        return self._F_applied

    def get_status_output_port(self) -> OutputPort:
        """Returns the output `status`."""
        return self._status

    def _calc_F_applied(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(context.get_discrete_state_vector().value()[:6])

    def _calc_status(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(context.get_discrete_state_vector().value()[6:])

    def _update(self, context: Context, next_state: DiscreteValues) -> None:
        wrench = self._F_display.Eval(context).tolist()
        torque, torque_limited = _limit(wrench[:3], self._max_torque_Nm)
        force, force_limited = _limit(wrench[3:], self._max_force_N)
        if not (torque_limited or force_limited):
            shown = [*wrench, SHOWN_AS_ASKED]
        elif all(map(math.isfinite, wrench)):
            shown = [*torque, *force, LIMITED]
        else:
            shown = [0.0] * 6 + [NOT_FINITE]
        next_state.set_value(shown)


def _limit(vector: list[float], largest: float) -> tuple[list[float], bool]:
    """Returns the vector, shortened to `largest` if longer, and whether it was."""
    norm = math.hypot(*vector)
    if norm <= largest:
        return vector, False
    # Divided first: the norm of huge values may be infinite, their ratios are not.
    return [largest * (x / norm) for x in vector], True
