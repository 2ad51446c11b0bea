"""What a haptic device told over LCM, as vectors."""

from __future__ import annotations

from collections.abc import Callable

from pydrake.common.value import Value
from pydrake.systems.framework import (
    BasicVector,
    Context,
    InputPort,
    LeafSystem,
    OutputPort,
)

from drake_haptics.device.lcm.haptic_messages import lcmt_haptic_status
from drake_haptics.device.lcm.status_check import find_flaw

# What is told before the first message.
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
        - F_BH
        - gate
        - fault

    * `X_BH` (7) is the handle's pose [qw qx qy qz x y z] in the device's base, m.
    * `V_BH` (6) is its spatial velocity [ω; v] there, rad/s and m/s.
    * `F_BH` (6) is the wrench [τ; f] that the device shows at Ho, N·m and N.
    * `gate` (1) and `fault` (1) are a `GateState` and a `Fault`.

    Before the first message the handle rests at the identity and the gate is idle. A
    message with a number that is not finite, or no unit quaternion, raises ValueError:
    a loop must not go on with it.
    """

    def __init__(self) -> None:
        super().__init__()
        self._status = self.DeclareAbstractInputPort(
            "lcmt_haptic_status", Value[object](lcmt_haptic_status())
        )
        for name, field, size in [
            ("X_BH", "pose", 7),
            ("V_BH", "velocity", 6),
            ("F_BH", "wrench", 6),
            ("gate", "gate", 1),
            ("fault", "fault", 1),
        ]:
            self.DeclareVectorOutputPort(
                name, size, self._make_calc(field), {self._status.ticket()}
            )

    def get_status_input_port(self) -> InputPort:
        """Returns the input `lcmt_haptic_status`."""
        return self._status

    def get_handle_pose_output_port(self) -> OutputPort:
        """Returns the output `X_BH`."""
        return self.GetOutputPort("X_BH")

    def get_handle_velocity_output_port(self) -> OutputPort:
        """Returns the output `V_BH`."""
        return self.GetOutputPort("V_BH")

    def get_shown_wrench_output_port(self) -> OutputPort:
        """Returns the output `F_BH`."""
        return self.GetOutputPort("F_BH")

    def get_gate_output_port(self) -> OutputPort:
        """Returns the output `gate`."""
        return self.GetOutputPort("gate")

    def get_fault_output_port(self) -> OutputPort:
        """Returns the output `fault`."""
        return self.GetOutputPort("fault")

    def _make_calc(self, field: str) -> Callable[[Context, BasicVector], None]:
        """Returns what calculates the port of a field."""

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
