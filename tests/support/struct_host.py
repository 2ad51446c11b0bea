"""A host of the device's UDP protocol, written from its documented layout alone.

As a program it is the host of a two-process test, which can be killed and paused:

    python tests/support/struct_host.py PORT SECONDS FORCE

It enables the device, asks for FORCE newtons along z after every state for so many
seconds and then disables it.
"""

import dataclasses
import math
import random
import select
import socket
import struct
import sys
import time
import zlib

HEADER = "<4sBBHIIQ"  # magic, version, kind, size, session, sequence, time_ns
STATE = struct.Struct(HEADER + "7d6d6dIIIIffBBHI")
COMMAND = struct.Struct(HEADER + "6dIIII")
IDLE, ACTIVE, FAULT = 0, 1, 2
FAULTS = ["NONE", "STALE", "NOT_FINITE", "OVERSPEED", "CLOCK", "DEVICE"]
ENABLE = 1
# The slowest test machine may stall for as long without a fault: the longest life that
# a gate allows.
TTL_S = 1.0
# For those whose commands are meant to go stale.
SHORT_TTL_S = 0.3


@dataclasses.dataclass(frozen=True)
class State:
    """A state packet."""

    session: int
    sequence: int
    time_ns: int
    X_BH: tuple
    V_BH: tuple
    F_Ho_B: tuple
    boot: int
    command_sequence: int
    buttons: int
    rejected: int
    max_force_N: float
    max_torque_Nm: float
    gate: int
    fault: str

    @property
    def torque_Nm(self):
        """Norm of the torque shown."""
        return math.hypot(*self.F_Ho_B[:3])

    @property
    def force_N(self):
        """Norm of the force shown."""
        return math.hypot(*self.F_Ho_B[3:])


def is_whole(packet):
    """Tells whether a packet's checksum is that of its bytes."""
    return packet[-4:] == struct.pack("<I", zlib.crc32(packet[:-4]))


def unpack_state(packet):
    """Returns the state, after a check of every field that is fixed."""
    assert len(packet) == STATE.size == 208
    values = STATE.unpack(packet)
    magic, version, kind, size, session, sequence, time_ns = values[:7]
    assert (magic, version, kind, size) == (b"DHAP", 1, 1, 208)
    assert is_whole(packet)
    assert values[-2] == 0
    return State(
        session,
        sequence,
        time_ns,
        values[7:14],
        values[14:20],
        values[20:26],
        *values[26:33],
        FAULTS[values[33]],
    )


def pack_command(
    *, session, sequence, wrench, enable=True, ttl_s=TTL_S, answers=0, time_ns=0
):
    """Returns a command packet; the wrench is [τ; f]."""
    body = COMMAND.pack(
        b"DHAP",
        1,
        2,
        COMMAND.size,
        session,
        sequence & 0xFFFFFFFF,
        time_ns,
        *wrench,
        answers,
        round(1e6 * ttl_s),
        ENABLE if enable else 0,
        0,
    )
    return body[:-4] + struct.pack("<I", zlib.crc32(body[:-4]))


class StructHost:
    """One end of the link; every call sends or takes what there is, without a thread.

    Args:
        port: Port of the device, or of a relay to it.
        session: Number of this host's run.
        sequence: Number of its first command.

    Attributes:
        state: Newest state that has come; None before the first.
        damaged: Number of packets that had a wrong checksum.
    """

    def __init__(self, port, *, session=None, sequence=0):
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.connect(("127.0.0.1", port))
        self._socket.setblocking(False)
        self.session = session or random.getrandbits(31) + 1
        self.sequence = sequence
        self.state = None
        self.damaged = 0

    def close(self):
        """Gives the socket up, without a word to the device."""
        self._socket.close()

    def send(self, force_z=0.0, *, wrench=None, enable=True, session=None, **more):
        """Sends a command under the next number; returns the packet."""
        packet = pack_command(
            session=session or self.session,
            sequence=self.sequence,
            wrench=wrench or (0.0, 0.0, 0.0, 0.0, 0.0, force_z),
            enable=enable,
            answers=self.state.sequence if self.state else 0,
            time_ns=time.monotonic_ns(),
            **more,
        )
        self.sequence += 1
        self.send_bytes(packet)
        return packet

    def send_bytes(self, packet):
        """Sends anything."""
        try:
            self._socket.send(packet)
        except (ConnectionRefusedError, BlockingIOError):
            pass  # nobody listens yet or any more, or the flood is too fast

    def receive(self, timeout_s=0.0):
        """Takes all states that have come; returns the newest that ever came whole."""
        select.select([self._socket], [], [], timeout_s)
        try:
            while True:
                packet = self._socket.recv(4096)
                if is_whole(packet):
                    self.state = unpack_state(packet)
                else:
                    self.damaged += 1
        except (BlockingIOError, ConnectionRefusedError):
            return self.state

    def exchange(self, until, *, bound_s=120.0, **command):
        """Answers states with commands until a state is as wanted; returns that state.

        Args:
            until: Function of a state that tells whether to end.
            bound_s: Time after which it fails, s.
            command: Arguments of `send`.
        """
        end_s = time.monotonic() + bound_s
        while time.monotonic() < end_s:
            self.send(**command)
            before = self.state
            state = self.receive(0.05)
            if state is not None and state is not before and until(state):
                return state
        raise TimeoutError(f"not reached; the last state was {self.state}")

    def disable(self):
        """Takes the device to idle, from wherever it is."""
        self.state = None
        return self.exchange(lambda state: state.gate == IDLE, enable=False)

    def enable(self, force_z=0.0, **more):
        """Takes a device to full force, from wherever it is.

        Args:
            force_z: Force, N, within the device's limit.
            more: Arguments of `send`.

        Returns:
            The first state there.
        """
        full = force_z * (1.0 - 1e-9)
        while True:
            self.disable()
            state = self.exchange(
                lambda state: (
                    state.gate == FAULT
                    or (state.gate == ACTIVE and state.force_N >= full)
                ),
                force_z=force_z,
                **more,
            )
            # A machine that stalls on the way there is no failure of the device.
            if state.fault != "STALE":
                return state


def main():
    """Runs the host."""
    port, duration_s, force = int(sys.argv[1]), float(sys.argv[2]), float(sys.argv[3])
    host = StructHost(port)
    try:
        host.enable(force, ttl_s=SHORT_TTL_S)
        print("active", flush=True)
        end_s = time.monotonic() + duration_s
        host.exchange(
            lambda _: time.monotonic() > end_s,
            bound_s=duration_s + 60,
            force_z=force,
            ttl_s=SHORT_TTL_S,
        )
    finally:
        host.disable()
        host.close()


if __name__ == "__main__":
    main()
