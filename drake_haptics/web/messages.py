"""Defines the messages between the loop and its page.

The loop sends its ticks in packets: a header, and a row for each tick since the last
packet. They are plain doubles, so that recording a tick is one call that allocates
nothing and accepts any number. A page sends requests in JSON; few are allowed, because
pages are not trusted.
"""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

# First byte of packets; that of JSON text is a brace.
KIND = b"#"
# Names of gates on the page, by number in a packet.
GATES = ("idle", "active", "fault", "simulated", "waiting")
ACTIVE, SIMULATED, WAITING = map(GATES.index, ("active", "simulated", "waiting"))
# Names of faults, by number of `drake_haptics.device.backend.Fault`.
FAULTS = ("", "stale", "not finite", "overspeed", "clock", "device")

# Kind, gate, fault, stages of shed load; ticks skipped; clock, silence, s; camera's
# R_WC row by row and p_WC, m; handle's p_WH, m.
_HEAD = struct.Struct("=cBBBI2d12d3d")
# Time, s; then `RunStatistics.latest`; then the lateness of the tick, s.
_TICK = struct.Struct("=14d")
_MOST_TICKS = 512
_LARGEST_PACKET = _HEAD.size + _MOST_TICKS * _TICK.size
# Largest size of packets and of JSON text.
LARGEST_DATAGRAM = 1 << 16
NOT_KNOWN = math.nan


@dataclass(frozen=True)
class Tick:
    """The record of a tick, with NaN for unknown values.

    Attributes:
        time_s: Simulated time, s.
        tick_s: Clock time of its work, s.
        query_s: Clock time of its contact query, s.
        contacts: Number of contacts before clustering.
        clusters: Number of clusters.
        distance_m: Distance of the nearest contact, m, negative if it penetrates;
            infinite without a contact.
        tau_W: (3,) torque on the handle, N·m.
        f_W: (3,) force on the handle, N.
        late_s: Lateness of its beginning, s.
    """

    time_s: float
    tick_s: float
    query_s: float
    contacts: float
    clusters: float
    distance_m: float
    tau_W: tuple[float, float, float]
    f_W: tuple[float, float, float]
    late_s: float


@dataclass(frozen=True)
class Telemetry:
    """A packet.

    Attributes:
        gate: State of the gate, one of `GATES`.
        fault: Fault of the device, one of `FAULTS`.
        silent_s: Time for which the device's driver has sent nothing new, s.
        shed: Number of stages of work that were dropped.
        skipped: Number of ticks lost to stalls since the run began.
        clock_s: The loop's clock, s.
        R_WC: (9,) axes of the camera x right, y down, z away, row by row.
        p_WC: (3,) position of the camera, m.
        p_WH: (3,) position of the handle, m.
        ticks: Ticks since the last packet.
    """

    gate: str
    fault: str
    silent_s: float
    shed: int
    skipped: int
    clock_s: float
    R_WC: tuple[float, ...]
    p_WC: tuple[float, ...]
    p_WH: tuple[float, ...]
    ticks: list[Tick]


@dataclass(frozen=True)
class Outlook:
    """The state that the page gets with the ticks, 30 times per second.

    Attributes:
        gate: Index into `GATES`.
        p_WH: (3,) position of the handle, m.
        fault: Index into `FAULTS`.
        silent_s: Time for which the device's driver has sent nothing new, s.
        shed: Number of stages of work that are dropped.
        skipped: Number of ticks lost to stalls since the run began.
    """

    gate: int
    p_WH: Sequence[float]
    fault: int = 0
    silent_s: float = 0.0
    shed: int = 0
    skipped: int = 0


class TickBuffer:
    """Buffers the loop's ticks until they are sent.

    If they are not taken for long, the latest are left out.
    """

    def __init__(self) -> None:
        self._bytes = bytearray(_LARGEST_PACKET)
        self._view = memoryview(self._bytes)
        self._end = _HEAD.size

    def note(self, time_s: float, latest: Sequence[float], late_s: float) -> None:
        """Records a tick at a simulated time, with `RunStatistics.latest` (12,)."""
        if self._end < _LARGEST_PACKET:
            _TICK.pack_into(self._bytes, self._end, time_s, *latest, late_s)
            self._end += _TICK.size

    def take(
        self, outlook: Outlook, clock_s: float, camera: Sequence[float]
    ) -> memoryview:
        """Returns the packet, valid until the next `note`, and begins the next one.

        The clock is the loop's; the camera is R_WC (9,) row by row and p_WC (3,), m.
        """
        counts = outlook.gate, outlook.fault, outlook.shed, outlook.skipped
        times_s = clock_s, outlook.silent_s
        _HEAD.pack_into(self._bytes, 0, KIND, *counts, *times_s, *camera, *outlook.p_WH)
        packet = self._view[: self._end]
        self._end = _HEAD.size
        return packet


def read_telemetry(packet: bytes) -> Telemetry:
    """Returns the content of a packet."""
    _, gate, fault, shed, skipped, clock_s, silent_s, *places = _HEAD.unpack_from(
        packet
    )
    rows = _TICK.iter_unpack(memoryview(packet)[_HEAD.size :])
    return Telemetry(
        gate=GATES[gate],
        fault=FAULTS[fault],
        silent_s=silent_s,
        shed=shed,
        skipped=skipped,
        clock_s=clock_s,
        R_WC=tuple(places[:9]),
        p_WC=tuple(places[9:12]),
        p_WH=tuple(places[12:]),
        ticks=[_read_tick(row) for row in rows],
    )


def _read_tick(row: tuple[float, ...]) -> Tick:
    """Returns the content of a row."""
    time_s, tick_s, query_s, contacts, clusters, distance_m, *wrench, _, late_s = row
    tau_x, tau_y, tau_z, f_x, f_y, f_z = wrench
    return Tick(
        time_s=time_s,
        tick_s=tick_s,
        query_s=query_s,
        contacts=contacts,
        clusters=clusters,
        distance_m=distance_m,
        tau_W=(tau_x, tau_y, tau_z),
        f_W=(f_x, f_y, f_z),
        late_s=late_s,
    )


# Largest step of a message, in heights of the view or in half turns.
_LARGEST_STEP = 1.0
_LARGEST_NUMBER = 1e300
_LONGEST_NAME = 64

TAKE = "take"
"""Request to become the page that drives, which any page may send."""

SEEN = "seen"
"""Report of the last frame that a page has shown, which any page may send."""

REFUSED = "refused"
"""The loop gets {REFUSED: 1} for a message that is not allowed."""


def _is_number(value: object) -> bool:
    """Returns whether a value is a finite number, not a Boolean."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    # This is also False for NaN.
    return abs(value) <= _LARGEST_NUMBER


def _is_step(value: object) -> bool:
    return _is_number(value) and abs(value) <= _LARGEST_STEP  # type: ignore[arg-type]


def _are_steps(value: object) -> bool:
    return isinstance(value, list) and len(value) == 3 and all(map(_is_step, value))


def _is_name(value: object) -> bool:
    return isinstance(value, str) and len(value) <= _LONGEST_NAME


def _is_switch(value: object) -> bool:
    return isinstance(value, bool)


# The arguments of each verb. A name that ends with "?" is optional.
_VERBS: Mapping[str, Mapping[str, Callable[[object], bool]]] = {
    # By (right, up, away), in heights of the view at the handle's depth.
    "move": {"by": _are_steps},
    # By (right, up, roll), in half turns: its front goes right and up, and it rolls
    # clockwise.
    "turn": {"by": _are_steps},
    "home": {},
    TAKE: {},
    SEEN: {"number": _is_number},
    # The state that answers a request has its number.
    "set": {"key": _is_name, "to": _is_number, "number?": _is_number},
    "choose": {"key": _is_name, "to": _is_name},
    "effect": {"name": _is_name, "on": _is_switch, "number?": _is_number},
    "handle": {"to": _is_name},
    # Recovers a device from a fault, or lets a waiting one show its force.
    "resume": {},
    "view": {"name": _is_name, "on": _is_switch, "number?": _is_number},
    "camera": {"to": _is_name, "within?": _is_number},
    "reset": {},
    "restart": {},
}


def read_page_request(text: str | bytes) -> dict[str, Any] | None:
    """Returns a page's request; None if it is not exactly one of those allowed.

    A message is JSON text: {"do": verb} with the arguments of the verb, such as {"do":
    "move", "by": [0.1, 0, 0]}. Whether a key or name exists is not checked.

    Args:
        text: Received message; bytes are always refused.
    """
    if isinstance(text, bytes):
        return None
    try:
        asked = json.loads(text)
    except (ValueError, RecursionError):
        return None
    if not isinstance(asked, dict) or not isinstance(asked.get("do"), str):
        return None
    parts = _VERBS.get(asked["do"])
    if parts is None:
        return None
    checks = {name.rstrip("?"): check for name, check in parts.items()}
    needed = {name for name in parts if not name.endswith("?")}
    given = set(asked) - {"do"}
    if not needed <= given <= set(checks):
        return None
    if not all(checks[name](asked[name]) for name in given):
        return None
    return asked
