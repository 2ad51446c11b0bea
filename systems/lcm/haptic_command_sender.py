"""Sends LCM commands to a haptic device."""

from __future__ import annotations

import math
import secrets

from pydrake.common.value import AbstractValue, Value
from pydrake.systems.framework import Context, DiscreteValues, LeafSystem

from drake_haptics.common.value_checks import check_positive
from drake_haptics.device.lcm.haptic_messages import (
    lcmt_haptic_command,
    lcmt_haptic_status,
    number_period,
)
from drake_haptics.device.lcm.lcm_device import SILENT_S

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
        - lcmt_haptic_status
        output_ports:
        - lcmt_haptic_command

    * `F_Ho_B` (6) is the wrench [τ; f] to show on the handle at Ho in the device's
      base, N·m and N.
    * `enable` (1) enables force above one half; if it is not connected, force is always
      enabled. A device recovers from a fault when force is disabled and enabled again.

    * `lcmt_haptic_status` is the device's, from Drake's `LcmSubscriberSystem`. Connect
      it: without it the system cannot know that a device has fallen silent, and enables
      forces that are computed from an old pose of the handle.

    With `lcmt_haptic_status`, force is disabled before the first message, and after
    0.25 s without a new one until `enable` has been low and high again, as `LcmDevice`
    needs `recover`.

    A device accepts force only from a host that has sent a disabled command before, so
    all messages before 0.05 s are disabled.

    The sequence number is that of the period that contains the Context's time, so
    publish once per period. Use a new system for each run: sequence numbers that start
    again at 0 s would be old ones.

    The state is one discrete group (3): the number of the last status, the time at
    which it came, s, and whether the device has fallen silent. It is updated every
    period from 0 s on.
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
        self._status = self.DeclareAbstractInputPort(
            "lcmt_haptic_status", Value[object](lcmt_haptic_status())
        )
        self.DeclareDiscreteState([0.0, -math.inf, 0.0])
        self.DeclarePeriodicDiscreteUpdateEvent(period_s, 0.0, self._update)
        self._message = self.DeclareAbstractOutputPort(
            "lcmt_haptic_command",
            lambda: Value[object](lcmt_haptic_command()),
            self._calc_message,
        )

    def _is_enabled(self, context: Context) -> bool:
        """Returns whether the input `enable` does not disable force."""
        if not self._enable.HasValue(context):
            return True
        return bool(self._enable.Eval(context)[0] > 0.5)

    def _update(self, context: Context, next_state: DiscreteValues) -> None:
        if not self._status.HasValue(context):
            return
        number, heard_s, was_silent = context.get_discrete_state(0).value()
        status, now_s = self._status.Eval(context), context.get_time()
        if status.sequence != number:
            number, heard_s = status.sequence, now_s
        # Before the first message there is no silence yet.
        fell_silent = math.isfinite(heard_s) and now_s - heard_s > SILENT_S
        is_silent = (was_silent or fell_silent) and self._is_enabled(context)
        next_state.set_value(0, [number, heard_s, float(is_silent)])

    def _is_heard(self, context: Context) -> bool:
        """Returns whether the device sends, or cannot be heard."""
        if not self._status.HasValue(context):
            return True
        _, heard_s, is_silent = context.get_discrete_state(0).value()
        return bool(context.get_time() - heard_s <= SILENT_S and not is_silent)

    def _calc_message(self, context: Context, output: AbstractValue) -> None:
        enable = (
            context.get_time() >= _RELEASED_UNTIL_S
            and self._is_enabled(context)
            and self._is_heard(context)
        )
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
