"""Drives an arm as a UDP device: socket, gate, statistics and the loop of ticks."""

from __future__ import annotations

import errno
import gc
import math
import secrets
import socket
import time
from collections import Counter, deque
from collections.abc import Callable, Iterator
from typing import Any, Protocol

import numpy as np

from drake_haptics import _core
from drake_haptics.common.errors import HapticsError
from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.common.value_checks import check_positive
from drake_haptics.device.backend import DeviceReading, Fault, GateState

Peer = tuple[str, int]
"""Host and port."""

# Longer than any packet of the protocol; a longer one is truncated, and refused.
_BUFFER_BYTES = 2048
# Largest number of packets that a tick reads: a host sends one or two, and a flood must
# not delay the next tick.
_MAX_PACKETS_PER_TICK = 64
_WRAP = 1 << 32
# Only Linux has this clock.
_SUSPENDED_CLOCK: int | None = getattr(time, "CLOCK_BOOTTIME", None)
# Verdicts whose sender is answered. The last two only occur while no force is shown,
# and their sender must learn why.
_ANSWERED = frozenset({"accepted", "not_disabled_first", "at_fault"})
# A host that is silent for longer has gone, or its address was forged.
_FORGETS_AFTER_NS = 5_000_000_000
# Largest number of faults that are listed with their times; all are counted.
_MAX_LISTED = 1000
# The gate scales a vector down to its limit, up to round-off.
_ROUNDING = 1.0 + 1e-12


def read_clock_ns() -> int:
    """Returns the time, ns, of a clock that continues while the machine is suspended.

    So commands from before a suspension are stale after it. Systems without such a
    clock use their monotonic one.
    """
    if _SUSPENDED_CLOCK is None:
        return time.monotonic_ns()
    return time.clock_gettime_ns(_SUSPENDED_CLOCK)


class DrivenArm(Protocol):
    """The interface of an arm that a driver drives."""

    def start(self) -> None:
        """Is called once, before the first tick that may show a wrench."""

    def step(self, F_Ho_B: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Shows a wrench for a period.

        Args:
            F_Ho_B: (6,) wrench [τ; f] on the handle at Ho, N·m and N, within limits.

        Returns:
            X_BH (7,) = [qw qx qy qz x y z], m, and V_BH (6,) = [ω; v], rad/s and
            m/s, at the end of it.
        """


class DeviceDriver:
    """Serves an arm to one host at a time over the UDP protocol.

    Every tick receives commands, lets the gate decide what is shown, moves the arm, and
    sends the host one state. Nothing waits for the host. The protocol is that of
    docs/device-protocol.md.

    Args:
        arm: Arm to drive, at rest.
        max_force_N: Largest force that is ever shown, N.
        max_torque_Nm: Largest torque, N·m.
        max_ttl_s: Longest time that a command is shown without a newer one, s.
        rate_hz: Ticks per second, Hz.
        bind: IPv4 address to listen at; only this machine can reach 127.0.0.1.
        port: UDP port to listen at; 0 lets the system choose.
        clock_ns: Reads a clock that never goes back and runs during suspension, ns.

    Raises:
        HapticsError: The address or port is not available.
        ValueError: A limit or the rate is out of range.
    """

    def __init__(
        self,
        arm: DrivenArm,
        *,
        max_force_N: float,
        max_torque_Nm: float,
        max_ttl_s: float,
        rate_hz: float,
        bind: str,
        port: int,
        clock_ns: Callable[[], int] = read_clock_ns,
    ):
        check_positive(rate_hz=rate_hz)
        self._arm = arm
        self._limits = (max_force_N, max_torque_Nm)
        self._gate = _core.DeviceGate(
            max_force_N=max_force_N, max_torque_Nm=max_torque_Nm, max_ttl_s=max_ttl_s
        )
        self._rate_hz = rate_hz
        self._pace = RealTimePacer(1.0 / rate_hz)
        self._largest_late_s = 0.0
        self._clock_ns = clock_ns
        self._start_ns = clock_ns()
        self._statistics = DriverStatistics(max_force_N, max_torque_Nm)
        # Tells a host that the driver was restarted.
        self._boot = 1 + secrets.randbelow(_WRAP - 1)
        self._peer: Peer | None = None
        self._heard_ns = 0
        self._arm_started = False
        self._stops = False
        self._reading = self._move_arm(np.zeros(6), GateState.IDLE, Fault.NONE)
        self._socket = DriverSocket(bind, port)

    @property
    def address(self) -> Peer:
        """The host and port at which it listens."""
        return self._socket.address

    @property
    def url(self) -> str:
        """Address for hosts, "udp://host:port"."""
        host, port = self.address
        # If it listens at all addresses, the machine's name is given.
        return f"udp://{socket.gethostname() if host == '0.0.0.0' else host}:{port}"

    @property
    def pace(self) -> RealTimePacer:
        """The pacer of the ticks."""
        return self._pace

    @property
    def reading(self) -> DeviceReading:
        """The last reading of the device."""
        return self._reading

    @property
    def packets(self) -> dict[str, int]:
        """Number of packets by verdict of the gate."""
        return {name: count for name, count in self._gate.counts.items() if count}

    def stop(self) -> None:
        """Ends `run` after the current tick."""
        self._stops = True

    def run(
        self, duration_s: float | None = None, on_tick: Callable[[], None] | None = None
    ) -> None:
        """Serves in real time, and always ends at zero force.

        Args:
            duration_s: Duration, s. Defaults to serving until `stop`.
            on_tick: Function that is called after every tick.
        """
        # Collecting garbage over all objects of a simulation takes many ticks.
        gc.collect()
        gc.freeze()
        self._pace = RealTimePacer(1.0 / self._rate_hz)
        end_s = math.inf if duration_s is None else time.monotonic() + duration_s
        try:
            while not self._stops and time.monotonic() < end_s:
                self._largest_late_s = max(self._largest_late_s, self._pace.wait())
                self.tick()
                if on_tick is not None:
                    on_tick()
        finally:
            gc.unfreeze()
            self._end()

    def _end(self) -> None:
        """Shows no force, tells the host and closes the port, whatever the arm does."""
        fault = Fault(self._gate.fault)
        try:
            self._show(np.zeros(6), GateState.FAULT if fault else GateState.IDLE, fault)
        finally:
            self._socket.close()

    def tick(self) -> None:
        """Performs one tick."""
        gate, reading = self._gate, self._reading
        now_ns = self._clock_ns()
        for packet, sender in self._socket.receive(_MAX_PACKETS_PER_TICK):
            if gate.receive(now_ns, packet) in _ANSWERED:
                self._peer, self._heard_ns = sender, now_ns
            # A packet may end a fault that the previous one caused.
            self._statistics.note_fault(self._to_s(now_ns), gate.fault)
        if now_ns - self._heard_ns > _FORGETS_AFTER_NS:
            self._peer = None
        F_Ho_B = gate.step(now_ns, reading.X_BH, reading.V_BH)
        self._show(F_Ho_B, GateState(gate.state), Fault(gate.fault))

    def _show(self, F_Ho_B: np.ndarray, gate: GateState, fault: Fault) -> None:
        """Shows a wrench by the arm, records it and tells the host."""
        if gate == GateState.ACTIVE and not self._arm_started:
            self._arm_started = True
            self._arm.start()
        self._reading = self._move_arm(F_Ho_B, gate, fault)
        self._statistics.add_tick(self._reading)
        if self._peer is not None:
            self._socket.send(self._pack(self._reading), self._peer)

    def _move_arm(
        self, F_Ho_B: np.ndarray, gate: GateState, fault: Fault
    ) -> DeviceReading:
        """Returns the device's reading after a period under a wrench."""
        X_BH, V_BH = self._arm.step(F_Ho_B)
        return DeviceReading(
            sequence=(self._statistics.ticks + 1) % _WRAP,
            time_s=self._to_s(self._clock_ns()),
            X_BH=X_BH,
            V_BH=V_BH,
            F_Ho_B=F_Ho_B,
            gate=gate,
            fault=fault,
        )

    def _to_s(self, time_ns: int) -> float:
        """Returns the time since the driver began, s."""
        return 1e-9 * (time_ns - self._start_ns)

    def _pack(self, reading: DeviceReading) -> bytes:
        """Returns a reading as a state packet of the protocol."""
        gate = self._gate
        return _core.pack_state(
            sequence=reading.sequence,
            time_ns=self._clock_ns(),
            X_BH=reading.X_BH,
            V_BH=reading.V_BH,
            F_Ho_B=reading.F_Ho_B,
            boot=self._boot,
            # A driver that ends serves nobody, though its gate is not told so.
            session=gate.session if reading.gate == GateState.ACTIVE else 0,
            command_sequence=gate.command_sequence,
            buttons=reading.buttons,
            rejected=gate.rejected % _WRAP,
            max_force_N=self._limits[0],
            max_torque_Nm=self._limits[1],
            gate=reading.gate,
            fault=reading.fault,
        )

    def to_dict(self) -> dict[str, Any]:
        """Returns the figures under names that say their units.

        Those of `DriverStatistics.to_dict`, and `duration_s`, `rate_hz`,
        `force_limit_N`, `torque_limit_Nm`, `packets` (their number by the gate's
        verdict) and `lateness_us` (`p50`, `p99` and `p99_9` of the latest minute,
        `max` of all and `skipped`, the number of ticks lost to stalls).
        """
        p50, p99, p99_9 = (1e6 * late_s for late_s in self._pace.calc_lateness())
        return {
            "duration_s": self._reading.time_s,
            "rate_hz": self._rate_hz,
            "force_limit_N": self._limits[0],
            "torque_limit_Nm": self._limits[1],
            "packets": self.packets,
            "lateness_us": {
                "p50": p50,
                "p99": p99,
                "p99_9": p99_9,
                "max": 1e6 * self._largest_late_s,
                "skipped": self._pace.skipped,
            },
            **self._statistics.to_dict(),
        }


class DriverStatistics:
    """Loads and faults of a driver."""

    def __init__(self, max_force_N: float, max_torque_Nm: float):
        self._limits = (max_torque_Nm, max_force_N)
        self._largest = (0.0, 0.0)
        self._ticks = 0
        self._limit_violations = 0
        self._non_finite = 0
        self._fault = Fault.NONE
        self._faults: Counter[str] = Counter()
        self._recoveries: Counter[str] = Counter()
        self._listed: deque[dict[str, Any]] = deque(maxlen=_MAX_LISTED)

    @property
    def ticks(self) -> int:
        """Number of ticks so far."""
        return self._ticks

    def add_tick(self, reading: DeviceReading) -> None:
        """Counts a tick."""
        F_Ho_B = reading.F_Ho_B.tolist()
        self._ticks += 1
        torque, force = math.hypot(*F_Ho_B[:3]), math.hypot(*F_Ho_B[3:])
        if not math.isfinite(torque + force):
            self._non_finite += 1
        else:
            self._largest = (
                max(self._largest[0], torque),
                max(self._largest[1], force),
            )
        within = (
            torque <= self._limits[0] * _ROUNDING
            and force <= self._limits[1] * _ROUNDING
            and (reading.gate == GateState.ACTIVE or torque == force == 0.0)
        )
        self._limit_violations += not within
        self.note_fault(reading.time_s, reading.fault)

    def note_fault(self, time_s: float, fault: int) -> None:
        """Records whether the device is at fault; also between ticks.

        Args:
            time_s: Time since the driver began, s.
            fault: A `Fault`, or its number.
        """
        if fault == self._fault:
            return
        fault = Fault(fault)
        if fault == Fault.NONE:
            self._recoveries[self._fault.name] += 1
        else:
            self._faults[fault.name] += 1
            self._listed.append({"time_s": round(time_s, 4), "fault": fault.name})
        self._fault = fault

    def to_dict(self) -> dict[str, Any]:
        """Returns the figures under names that say their units.

        `limit_violations` counts ticks with more than the limits, with a wrench that
        is not finite, or with any at all while the gate is not active.
        """
        return {
            "ticks": self._ticks,
            "max_torque_Nm": self._largest[0],
            "max_force_N": self._largest[1],
            "limit_violations": self._limit_violations,
            "non_finite_values": self._non_finite,
            "faults": dict(self._faults),
            "recoveries": dict(self._recoveries),
            "fault_times": list(self._listed),
        }


class DriverSocket:
    """Receives commands and sends states.

    Args:
        host: IPv4 address to listen at; only this machine can reach 127.0.0.1.
        port: Port to listen at; 0 lets the system choose.

    Raises:
        HapticsError: The address or port is not available.
    """

    def __init__(self, host: str, port: int):
        if not host:  # it would mean every address of this machine
            raise HapticsError("bind is empty: give an address, such as 127.0.0.1")
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        try:
            self._socket.bind((host, port))
        except (OSError, TypeError, OverflowError) as error:  # the last two: no address
            self._socket.close()
            raise HapticsError(_explain(error, host, port)) from error

    @property
    def address(self) -> Peer:
        """The host and port at which it listens."""
        host, port = self._socket.getsockname()
        return host, port

    def receive(self, most: int) -> Iterator[tuple[bytes, Peer]]:
        """Yields the received packets and their senders, oldest first.

        Args:
            most: Largest number of packets; the others are left for the next call.
        """
        for _ in range(most):
            try:
                yield self._socket.recvfrom(_BUFFER_BYTES)
            except BlockingIOError:
                return
            except ConnectionError:
                continue  # some systems report here that a state was not received

    def send(self, packet: bytes, peer: Peer) -> None:
        """Sends a packet, which may be lost."""
        try:
            self._socket.sendto(packet, peer)
        except OSError:
            pass  # the network is down: without commands the gate ends the force

    def close(self) -> None:
        """Closes the port; may be called again."""
        self._socket.close()


def _explain(error: Exception, host: str, port: int) -> str:
    """Returns advice about an address that is not available."""
    if isinstance(error, OverflowError):
        return f"port must be from 0 to 65535, is {port}"
    if not isinstance(error, OSError):
        error = OSError(str(error))
    if error.errno == errno.EADDRINUSE:
        return (
            f"port {port} is taken, perhaps by another `drake-haptics device`:"
            " end that, or choose another (0: any free one)"
        )
    if error.errno == errno.EACCES:
        return f"port {port} needs rights that you lack: choose one from 1024 on"
    return (
        f"bind {host}: {error.strerror or error}; give an IPv4 address of this machine,"
        " such as 127.0.0.1"
    )
