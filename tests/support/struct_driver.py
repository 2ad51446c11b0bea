"""A driver that knows only the layout of the packets, by `struct` and `zlib`.

    python tests/support/struct_driver.py

serves as a process of its own: prints its port and sends 500 states per second once a
host has spoken. When a byte has come in, it prints another as soon as the host has
answered a hundred states in a row with no force, and ends.
"""

import select
import socket
import struct
import time
import zlib
from dataclasses import dataclass, field, replace

IDLE, ACTIVE, FAULT = range(3)
STATE_SIZE, COMMAND_SIZE = 208, 88


@dataclass
class SentState:
    """The fields of a state packet."""

    sequence: int = 0
    session: int = 0
    time_ns: int = 0
    X_BH: tuple = (1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    V_BH: tuple = (0.0,) * 6
    F_Ho_B: tuple = (0.0,) * 6
    boot: int = 7
    command_sequence: int = 0
    buttons: int = 0
    rejected: int = 0
    max_force_N: float = 8.5
    max_torque_Nm: float = 0.5
    gate: int = IDLE
    fault: int = 0

    def pack(self):
        """Returns the packet."""
        head = struct.pack(
            "<4sBBHIIQ",
            b"DHAP",
            *(1, 1, STATE_SIZE),
            *(self.session, self.sequence % 2**32, self.time_ns),
        )
        body = struct.pack("<19d", *self.X_BH, *self.V_BH, *self.F_Ho_B)
        tail = struct.pack(
            "<IIIIffBBH",
            *(self.boot, self.command_sequence, self.buttons, self.rejected),
            *(self.max_force_N, self.max_torque_Nm, self.gate, self.fault, 0),
        )
        packet = head + body + tail
        return packet + struct.pack("<I", zlib.crc32(packet))


@dataclass(frozen=True)
class GotCommand:
    """The fields of a command packet."""

    session: int
    sequence: int
    time_ns: int
    F_Ho_B: tuple
    state_sequence: int
    ttl_us: int
    enable: bool


def unpack_command(packet):
    """Returns the fields; asserts that the packet is one."""
    assert len(packet) == COMMAND_SIZE
    assert zlib.crc32(packet[:-4]) == struct.unpack("<I", packet[-4:])[0]
    magic, version, kind, size, session, sequence, ns = struct.unpack(
        "<4sBBHIIQ", packet[:24]
    )
    assert (magic, version, kind, size) == (b"DHAP", 1, 2, COMMAND_SIZE)
    wrench = struct.unpack("<6d", packet[24:72])
    state_sequence, ttl_us, flags = struct.unpack("<III", packet[72:84])
    assert flags in (0, 1)
    return GotCommand(session, sequence, ns, wrench, state_sequence, ttl_us, flags == 1)


@dataclass
class StructDriver:
    """A driver's socket, stepped by hand. Use it as a context manager.

    Attributes:
        state: State that is sent next; `sequence` rises by itself.
    """

    host: str = "127.0.0.1"
    state: SentState = field(default_factory=SentState)
    peer: tuple | None = None

    def __post_init__(self):
        """Binds a free port."""
        family = socket.AF_INET6 if ":" in self.host else socket.AF_INET
        self.socket = socket.socket(family, socket.SOCK_DGRAM)
        self.socket.bind((self.host, 0))
        self.port = self.socket.getsockname()[1]

    def __enter__(self):
        """Returns itself."""
        return self

    def __exit__(self, *_):
        """Closes the socket."""
        self.socket.close()

    def receive(self, timeout_s=120.0):
        """Returns the next command, and answers to its sender from now on."""
        self.socket.settimeout(timeout_s)
        packet, self.peer = self.socket.recvfrom(512)
        return unpack_command(packet)

    def receive_all(self):
        """Returns the commands that have come."""
        commands = []
        while True:
            try:
                commands.append(self.receive(1e-6))
            except (TimeoutError, BlockingIOError):
                return commands

    def send(self, **changes):
        """Sends the next state; returns its number."""
        self.state = replace(self.state, **changes)
        sent = replace(self.state, time_ns=time.monotonic_ns())
        self.socket.sendto(sent.pack(), self.peer)
        self.state = replace(self.state, sequence=sent.sequence + 1)
        return sent.sequence % 2**32

    def exchange(self, **changes):
        """Sends the next state and returns the command that answers it."""
        sequence = self.send(**changes)
        while True:
            command = self.receive()
            if command.state_sequence == sequence:
                return command


def main():
    """Serves until a stalled host shows nothing, or for a minute."""
    silent = 0
    with StructDriver() as driver:
        print(driver.port, flush=True)
        driver.receive(60.0)
        end = time.monotonic() + 60.0
        while time.monotonic() < end:
            driver.send()
            stalls = bool(select.select([0], [], [], 0.002)[0])
            for command in driver.receive_all():
                driver.state.gate = ACTIVE if command.enable else IDLE
                shows_none = command.enable and not any(command.F_Ho_B)
                silent = silent + 1 if stalls and shows_none else 0
            if silent >= 100:
                print("silent", flush=True)
                return


if __name__ == "__main__":
    main()
