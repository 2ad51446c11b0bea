"""Makes of what the loop noted what the page shows, 30 times a second."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from typing import Any

from drake_haptics.web.camera_view import (
    find_in_view,
    measure_height,
    turn_into_view,
)
from drake_haptics.web.telemetry import Telemetry, Tick
from drake_haptics.web.trace import Trace

# Times are those of so many latest ticks, rates those of so many seconds.
_LATEST = 1000
_RATE_SPAN_S = 1.0
_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


class FrameMaker:
    """Averages and counts over packets; see `make`."""

    def __init__(self, shed_stages: Sequence[str] = ()):
        """Starts with no tick.

        Args:
            shed_stages: Names of what is left out in ticks that take too long.
        """
        self._shed_stages = shed_stages
        self._trace = Trace()
        self._tick_s: deque[float] = deque(maxlen=_LATEST)
        self._late_s: deque[float] = deque(maxlen=_LATEST)
        # Clock time, simulated time, s, and ticks so far, at each packet.
        self._packets: deque[tuple[float, float, int]] = deque()
        self._ticks = 0

    def make(self, packet: Telemetry) -> dict[str, Any]:
        """Returns a frame for the page, without whether it drives.

        What is not known is None. Vectors `f` and `tau` are right, up and near in the
        page's picture, and so are the world's `axes`; `handle` is right and up of its
        middle in heights of it, which is `height_m` there.
        """
        for tick in packet.ticks:
            self._trace.add(tick.time_s, math.hypot(*tick.f_W), math.hypot(*tick.tau_W))
            self._tick_s.append(tick.tick_s)
            self._late_s.append(tick.late_s)
        frame: dict[str, Any] = {
            "trace": self._trace.take(),
            "gate": packet.gate,
            "fault": packet.fault,
            "silent_s": packet.silent_s,
            "skipped": packet.skipped,
            "shed": list(self._shed_stages[: packet.shed]),
            "handle": find_in_view(packet.p_WH, packet.R_WC, packet.p_WC),
            "height_m": measure_height(packet.p_WH, packet.R_WC, packet.p_WC),
            "axes": {
                name: turn_into_view(axis, packet.R_WC) for name, axis in _AXES.items()
            },
            "late_us": _describe(self._late_s, {"p50": 0.5, "p99": 0.99, "max": 1.0}),
            "tick_us": _describe(
                self._tick_s, {"median": 0.5, "p99": 0.99, "max": 1.0}
            ),
            **_describe_contact(packet.ticks),
        }
        if packet.ticks:
            last = packet.ticks[-1]
            frame |= {
                "time_s": last.time_s,
                "f": turn_into_view(last.f_W, packet.R_WC),
                "tau": turn_into_view(last.tau_W, packet.R_WC),
                "f_W": list(last.f_W),
                "tau_W": list(last.tau_W),
                **self._calc_rates(packet, last.time_s),
            }
        return frame

    def _calc_rates(self, packet: Telemetry, time_s: float) -> dict[str, float | None]:
        """Returns ticks per second, and simulated seconds per second."""
        self._ticks += len(packet.ticks)
        packets = self._packets
        if packets and time_s < packets[-1][1]:
            packets.clear()  # The scene began anew.
        packets.append((packet.clock_s, time_s, self._ticks))
        while packets[-1][0] - packets[0][0] > _RATE_SPAN_S and len(packets) > 2:
            packets.popleft()
        clock_s, ran_s, ticks = (
            b - a for a, b in zip(packets[0], packets[-1], strict=True)
        )
        if clock_s <= 0.0:
            return {"rate_hz": None, "real_time": None}
        return {"rate_hz": ticks / clock_s, "real_time": ran_s / clock_s}


def _describe_contact(ticks: Sequence[Tick]) -> dict[str, float | None]:
    """Returns the last tick's counts, and the least distance of all ticks, m.

    That is negative where something penetrates.
    """
    found: dict[str, float | None] = dict.fromkeys(("contacts", "clusters", "gap_m"))
    if ticks and not math.isnan(ticks[-1].contacts):
        found["contacts"] = int(ticks[-1].contacts)
        found["clusters"] = int(ticks[-1].clusters)
        least_m = min(tick.distance_m for tick in ticks)
        if least_m < math.inf:
            found["gap_m"] = least_m
    return found


def _describe(
    seconds: Sequence[float], shares: dict[str, float]
) -> dict[str, float] | None:
    """Returns quantiles, µs, by their names; None of what is not known."""
    ordered = sorted(x for x in seconds if not math.isnan(x))
    if not ordered:
        return None
    last = len(ordered) - 1
    return {name: 1e6 * ordered[round(share * last)] for name, share in shares.items()}
