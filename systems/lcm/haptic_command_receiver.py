"""Receives LCM commands to a haptic device, and checks them by its gate."""

from __future__ import annotations

import copy
from dataclasses import dataclass, replace

import numpy as np
from pydrake.common.value import AbstractValue, Value
from pydrake.systems.framework import BasicVector, Context, LeafSystem, State

from drake_haptics import _core
from drake_haptics.common.value_checks import check_positive
from drake_haptics.device.backend import Fault, GateState
from drake_haptics.device.gate import GateStatus
from drake_haptics.device.lcm.haptic_messages import lcmt_haptic_command

_UINT32 = (1 << 32) - 1


@dataclass(frozen=True, eq=False)
class _Memory:
    """The state: the gate, its last decision, and the last message."""

    gate: _core.DeviceGate
    status: GateStatus
    seen: lcmt_haptic_command

    def __deepcopy__(self, memo: object) -> _Memory:
        """Returns a copy; only the gate can change."""
        return _Memory(copy.deepcopy(self.gate), self.status, self.seen)


class HapticCommandReceiver(LeafSystem):
    """Passes the wrench of an `lcmt_haptic_command` to a device through a gate.

    The message comes from Drake's `LcmSubscriberSystem`. Every device has the same gate
    (gate.h): force ramps up, never exceeds the limits, and ramps down when messages
    stop or are damaged, or when the handle is too fast.

    .. pydrake_system::

        name: HapticCommandReceiver
        input_ports:
        - lcmt_haptic_command
        - X_BH
        - V_BH
        output_ports:
        - F_Ho_B
        - gate_status

    * `X_BH` (7) is the handle's pose [qw qx qy qz x y z] in the device's base, m.
    * `V_BH` (6) is its spatial velocity [ω; v] there, rad/s and m/s.
    * `F_Ho_B` (6) is the wrench [τ; f] to show on the handle at Ho, N·m and N.
    * `gate_status` (abstract) is the `GateStatus`.

    The state is the gate, which an unrestricted update advances every period from 0 s
    on; the outputs depend on it alone. Its clock is the time of the Context.
    """

    def __init__(
        self,
        period_s: float,
        *,
        max_force_N: float,
        max_torque_Nm: float,
        max_ttl_s: float = 0.1,
    ):
        """Constructs the system.

        Args:
            period_s: The device's tick, s.
            max_force_N: Largest force ever shown, N.
            max_torque_Nm: Largest torque ever shown, N·m.
            max_ttl_s: Longest time that a command holds without a newer one, s.

        Raises:
            ValueError: A time or a limit is out of range.
        """
        super().__init__()
        check_positive(period_s=period_s)
        gate = _core.DeviceGate(
            max_force_N=max_force_N, max_torque_Nm=max_torque_Nm, max_ttl_s=max_ttl_s
        )
        self._idle = GateStatus(max_force_N=max_force_N, max_torque_Nm=max_torque_Nm)
        self._command = self.DeclareAbstractInputPort(
            "lcmt_haptic_command", Value[object](lcmt_haptic_command())
        )
        self._X_BH = self.DeclareVectorInputPort("X_BH", 7)
        self._V_BH = self.DeclareVectorInputPort("V_BH", 6)
        self._memory = self.DeclareAbstractState(
            Value[object](_Memory(gate, self._idle, lcmt_haptic_command()))
        )
        from_state = {self.abstract_state_ticket(self._memory)}
        self._F_Ho_B = self.DeclareVectorOutputPort(
            "F_Ho_B", 6, self._calc_F, from_state
        )
        self._gate_status = self.DeclareAbstractOutputPort(
            "gate_status",
            lambda: Value[object](GateStatus()),
            self._calc_gate_status,
            from_state,
        )
        self.DeclarePeriodicUnrestrictedUpdateEvent(period_s, 0.0, self._update)

    def _update(self, context: Context, state: State) -> None:
        now_ns = round(1e9 * context.get_time())
        value = state.get_mutable_abstract_state(int(self._memory))
        memory = value.get_value()
        gate, command = memory.gate, self._command.Eval(context)
        # The subscriber keeps a message until the next one, and begins with an empty
        # one, which is skipped. So is a session number that does not fit into a gate's
        # 32 bits.
        if command is not memory.seen and 0 < command.session <= _UINT32:
            gate.receive(now_ns, _pack(command))
        F_Ho_B = gate.step(now_ns, self._X_BH.Eval(context), self._V_BH.Eval(context))
        status = replace(
            self._idle,
            F_Ho_B=F_Ho_B,
            session=gate.session,
            command_sequence=gate.command_sequence,
            rejected=gate.rejected,
            state=GateState(gate.state),
            fault=Fault(gate.fault),
        )
        value.set_value(_Memory(gate, status, command))

    def _calc_F(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._get_status(context).F_Ho_B)

    def _calc_gate_status(self, context: Context, output: AbstractValue) -> None:
        output.set_value(self._get_status(context))

    def _get_status(self, context: Context) -> GateStatus:
        """Returns the last decision of the gate."""
        return context.get_abstract_state(int(self._memory)).get_value().status


def _pack(command: lcmt_haptic_command) -> bytes:
    """Returns the packet of a message, for the gate to check."""
    return _core.pack_command(
        session=command.session,
        sequence=command.sequence & _UINT32,
        time_ns=0,
        F_Ho_B=np.array(command.wrench),
        state_sequence=0,
        ttl_us=max(command.time_to_live, 0),
        enable=command.enable,
    )
