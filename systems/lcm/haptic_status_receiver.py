"""Receives the LCM status of a haptic device."""

from __future__ import annotations

from collections.abc import Callable

from pydrake.common.value import Value
from pydrake.systems.framework import BasicVector, Context, LeafSystem

from drake_haptics.device.lcm.haptic_messages import find_flaw, lcmt_haptic_status

# The output before the first message.
_AT_REST = lcmt_haptic_status(pose=(1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))


class HapticStatusReceiver(LeafSystem):
    """Splits an `lcmt_haptic_status`, from Drake's `LcmSubscriberSystem`, into ports.

    .. pydrake_system::

        name: HapticStatusReceiver
        input_ports:
        - lcmt_haptic_status
        output_ports:
        - X_BH
        - V_BH
        - F_Ho_B
        - gate
        - fault

    * `X_BH` (7) is the handle's pose [qw qx qy qz x y z] in the device's base, m.
    * `V_BH` (6) is its spatial velocity [ω; v] there, rad/s and m/s.
    * `F_Ho_B` (6) is the wrench [τ; f] that the device shows at Ho, N·m and N.
    * `gate` (1) and `fault` (1) are a `GateState` and a `Fault`.

    Before the first message the handle rests at the identity and the gate is idle. A
    message with a number that is not finite, or whose quaternion is not of unit length,
    raises ValueError, because a loop must not continue with it.
    """

    def __init__(self) -> None:
        super().__init__()
        self._status = self.DeclareAbstractInputPort(
            "lcmt_haptic_status", Value[object](lcmt_haptic_status())
        )
        for name, field, size in [
            ("X_BH", "pose", 7),
            ("V_BH", "velocity", 6),
            ("F_Ho_B", "wrench", 6),
            ("gate", "gate", 1),
            ("fault", "fault", 1),
        ]:
            self.DeclareVectorOutputPort(
                name, size, self._make_calc(field), {self._status.ticket()}
            )

    def _make_calc(self, field: str) -> Callable[[Context, BasicVector], None]:
        """Returns the function that calculates the port of a field."""

        def calc(context: Context, output: BasicVector) -> None:
            status = self._status.Eval(context)
            if status.boot == 0:
                status = _AT_REST
            flaw = find_flaw(status)
            if flaw is not None:
                raise ValueError(f"lcmt_haptic_status: {flaw}")
            value = getattr(status, field)
            output.SetFromVector(value if isinstance(value, tuple) else [value])

        return calc
