"""A gate with a clock to turn by hand, and hosts that speak to it in packets.

The packets are those of `struct_host`, written from the documented layout.
"""

from __future__ import annotations

import numpy as np
from struct_host import pack_command

from drake_haptics import _core
from drake_haptics.device.backend import Fault, GateState

X_BH = np.array([1.0, 0, 0, 0, 0, 0, 0])
AT_REST = np.zeros(6)
MS = 1_000_000
MAX_FORCE_N, MAX_TORQUE_NM = 8.5, 0.188


class GateRig:
    """The gate of a Premium 1.5, ticked at 1 kHz from time zero.

    Attributes:
        gate: The gate.
        ms: Time of the gate, ms.
        forces: Forces shown along z in each tick, N.
    """

    def __init__(self, **limits: float) -> None:
        self.gate = _core.DeviceGate(
            **{"max_force_N": MAX_FORCE_N, "max_torque_Nm": MAX_TORQUE_NM} | limits
        )
        self.ms = 0
        self.forces: list[float] = []
        self.sequences: dict[int, int] = {}

    @property
    def state(self) -> GateState:
        """State of the gate: whether it shows force."""
        return GateState(self.gate.state)

    @property
    def fault(self) -> Fault:
        """Reason of its fault."""
        return Fault(self.gate.fault)

    def packet(
        self,
        force_z: float = 5.0,
        *,
        enable: bool = True,
        session: int = 1,
        sequence: int | None = None,
        wrench: tuple[float, ...] | None = None,
        ttl_s: float = 0.02,
    ) -> bytes:
        """Returns a session's next command."""
        if sequence is None:
            sequence = self.sequences.get(session, 0) + 1
        self.sequences[session] = sequence
        return pack_command(
            session=session,
            sequence=sequence,
            wrench=wrench or (0.0, 0.0, 0.0, 0.0, 0.0, force_z),
            enable=enable,
            ttl_s=ttl_s,
        )

    def receive(self, packet: bytes) -> str:
        """Gives the gate any bytes; returns the verdict."""
        return self.gate.receive(self.ms * MS, packet)

    def send(self, *args: float, **command: object) -> str:
        """Sends the session's next command; returns the verdict."""
        return self.receive(self.packet(*args, **command))  # type: ignore[arg-type]

    def step(self, V_BH: np.ndarray = AT_REST, X: np.ndarray = X_BH) -> np.ndarray:
        """Ends the tick; returns the wrench that it shows."""
        F = self.gate.step(self.ms * MS, X, V_BH)
        self.forces.append(float(F[5]))
        self.ms += 1
        return F

    def run(self, ticks: int, *args: float, **command: object) -> None:
        """Sends a command in each of a number of ticks."""
        for _ in range(ticks):
            self.send(*args, **command)
            self.step()

    def wait(self, ticks: int) -> None:
        """Lets a number of ticks pass without a word of a host."""
        for _ in range(ticks):
            self.step()

    def activate(self, **command: object) -> None:
        """Brings the gate to full force."""
        assert self.send(enable=False) == "accepted"
        self.run(201, **command)
        assert self.state is GateState.ACTIVE
        assert self.gate.scale == 1.0
