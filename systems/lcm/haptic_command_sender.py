"""Sends LCM commands to a haptic device."""

from __future__ import annotations

import secrets

from pydrake.common.value import AbstractValue, Value
from pydrake.systems.framework import (
    Context,
    LeafSystem,
)

from drake_haptics.common.value_checks import check_positive
from drake_haptics.device.lcm.haptic_messages import (
    lcmt_haptic_command,
    number_period,
)

_LONGEST_TTL_S = 10.0
# Long enough for one message to get through at any rate of a haptic loop.
_RELEASED_UNTIL_S = 0.05


class HapticCommandSender(LeafSystem):
    """Makes the `lcmt_haptic_command` of a host for Drake's `LcmPublisherSystem`.

    .. pydrake_system::

        name: HapticCommandSender
        input_ports:
        - F_Ho_B
        - enable
        output_ports:
        - lcmt_haptic_command

    * `F_Ho_B` (6) is the wrench [τ; f] to show on the handle at Ho in the device's
      base, N·m and N.
    * `enable` (1) enables force above one half; if it is not connected, force is always
      enabled. A device recovers from a fault when force is disabled and enabled again.

    A device accepts force only from a host that has sent a disabled command before, so
    all messages before 0.05 s are disabled.

    The sequence number is that of the period that contains the Context's time, so
    publish once per period. Use a new system for each run: sequence numbers that start
    again at 0 s would be old ones.
    """

    def __init__(self, period_s: float, *, ttl_s: float = 0.1):
        """Constructs the system.

        Args:
            period_s: Time from message to message, s.
            ttl_s: Time that a wrench holds without a newer one, s.

        Raises:
            ValueError: A time is out of range.
        """
        super().__init__()
        check_positive(period_s=period_s)
        if not 0.0 < ttl_s <= _LONGEST_TTL_S:
            raise ValueError(f"ttl_s must be in (0, {_LONGEST_TTL_S:g}], is {ttl_s}")
        self._period_s = period_s
        self._time_to_live = round(1e6 * ttl_s)
        self._session = secrets.randbelow(2**32 - 1) + 1
        self._F_Ho_B = self.DeclareVectorInputPort("F_Ho_B", 6)
        self._enable = self.DeclareVectorInputPort("enable", 1)
        self._message = self.DeclareAbstractOutputPort(
            "lcmt_haptic_command",
            lambda: Value[object](lcmt_haptic_command()),
            self._calc_message,
        )

    def _calc_message(self, context: Context, output: AbstractValue) -> None:
        enable = context.get_time() >= _RELEASED_UNTIL_S
        if self._enable.HasValue(context):
            enable &= bool(self._enable.Eval(context)[0] > 0.5)
        output.set_value(
            lcmt_haptic_command(
                utime=round(1e6 * context.get_time()),
                session=self._session,
                sequence=number_period(context.get_time(), self._period_s),
                time_to_live=self._time_to_live,
                enable=enable,
                wrench=tuple(self._F_Ho_B.Eval(context).tolist()),
            )
        )
