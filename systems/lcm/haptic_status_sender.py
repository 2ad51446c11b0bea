"""Sends the LCM status of a haptic device."""

from __future__ import annotations

import secrets

from pydrake.common.value import AbstractValue, Value
from pydrake.systems.framework import Context, LeafSystem

from drake_haptics.common.value_checks import check_positive
from drake_haptics.device.gate import GateStatus
from drake_haptics.device.lcm.haptic_messages import (
    lcmt_haptic_status,
    number_period,
    to_int32,
)


class HapticStatusSender(LeafSystem):
    """Makes the `lcmt_haptic_status` of a device for Drake's `LcmPublisherSystem`.

    .. pydrake_system::

        name: HapticStatusSender
        input_ports:
        - X_BH
        - V_BH
        - gate_status
        - buttons
        output_ports:
        - lcmt_haptic_status

    * `X_BH` (7) is the handle's pose [qw qx qy qz x y z] in the device's base, m.
    * `V_BH` (6) is its spatial velocity [ω; v] there, rad/s and m/s.
    * `gate_status` (abstract) is that of the device's `HapticCommandReceiver`.
    * `buttons` (1) has bit i set while button i is held; if it is not connected, there
      are no buttons.

    The sequence number is that of the period that contains the Context's time, so
    publish once per period. Use a new system for each run: sequence numbers that start
    again at 0 s would be old ones.
    """

    def __init__(self, period_s: float):
        """Constructs the system.

        Args:
            period_s: Time from message to message, s.

        Raises:
            ValueError: The period is not positive.
        """
        super().__init__()
        check_positive(period_s=period_s)
        self._period_s = period_s
        self._boot = secrets.randbelow(2**32 - 1) + 1
        self._X_BH = self.DeclareVectorInputPort("X_BH", 7)
        self._V_BH = self.DeclareVectorInputPort("V_BH", 6)
        self._gate_status = self.DeclareAbstractInputPort(
            "gate_status", Value[object](GateStatus())
        )
        self._buttons = self.DeclareVectorInputPort("buttons", 1)
        self._message = self.DeclareAbstractOutputPort(
            "lcmt_haptic_status",
            lambda: Value[object](lcmt_haptic_status()),
            self._calc_message,
        )

    def _calc_message(self, context: Context, output: AbstractValue) -> None:
        gate = self._gate_status.Eval(context)
        buttons = 0.0
        if self._buttons.HasValue(context):
            buttons = self._buttons.Eval(context)[0]
        output.set_value(
            lcmt_haptic_status(
                utime=round(1e6 * context.get_time()),
                boot=self._boot,
                sequence=number_period(context.get_time(), self._period_s),
                session=gate.session,
                command_sequence=gate.command_sequence,
                pose=tuple(self._X_BH.Eval(context).tolist()),
                velocity=tuple(self._V_BH.Eval(context).tolist()),
                wrench=tuple(gate.F_Ho_B.tolist()),
                max_force=gate.max_force_N,
                max_torque=gate.max_torque_Nm,
                buttons=to_int32(int(buttons)),
                rejected=to_int32(gate.rejected),
                gate=int(gate.state),
                fault=int(gate.fault),
            )
        )
