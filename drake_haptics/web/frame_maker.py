"""Converts the loop's packets to frames for the page, 30 times per second.

The page's process runs it, without NumPy. A camera's frame C is Drake's: x right, y
down, z away from the viewer.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from typing import Any

from drake_haptics.web.messages import Telemetry, Tick

# Meshcat's camera has a vertical field of view of 75°.
HEIGHT_PER_DEPTH = 2.0 * math.tan(math.radians(75.0) / 2.0)
# Nearest distance from the camera at which a point is visible, m.
LEAST_DEPTH_M = 0.01


def turn_into_view(v_W: Sequence[float], R_WC: Sequence[float]) -> list[float]:
    """Returns a vector (3,) of the world as right, up and near in the picture.

    Args:
        v_W: The vector, expressed in the world.
        R_WC: (9,) axes of the camera, row by row.
    """
    x, y, z = (sum(R_WC[3 * i + k] * v_W[i] for i in range(3)) for k in range(3))
    return [x, -y, -z]


def find_in_view(
    p_WQ: Sequence[float], R_WC: Sequence[float], p_WC: Sequence[float]
) -> tuple[list[float] | None, float | None]:
    """Returns the place of a point in the view, and the view's height at its depth, m.

    The place is right and up of the middle, in heights of the view. Both are None for a
    point that is not in front of the camera or not finite.

    Args:
        p_WQ: (3,) point, m.
        R_WC: (9,) axes of the camera, row by row.
        p_WC: (3,) position of the camera, m.
    """
    p_CQ_W = [q - c for q, c in zip(p_WQ, p_WC, strict=True)]
    right, up, near = turn_into_view(p_CQ_W, R_WC)
    if not LEAST_DEPTH_M <= -near < math.inf:
        return None, None
    height_m = HEIGHT_PER_DEPTH * -near
    return [right / height_m, up / height_m], height_m


TRACE_STEP_S = 4e-3


class Trace:
    """Reduces ticks to the largest values in each `TRACE_STEP_S` of simulated time."""

    def __init__(self) -> None:
        self._step = -math.inf
        self._largest: tuple[float, float] | None = None
        self._done: list[tuple[float, float]] = []

    def add(self, time_s: float, force_N: float, torque_Nm: float) -> None:
        """Adds a tick; if simulated time goes back, the scene has begun again."""
        step = math.floor(time_s / TRACE_STEP_S + 1e-6)
        if step != self._step:
            if self._largest is not None:
                self._done.append(self._largest)
            self._step, self._largest = step, (force_N, torque_Nm)
            return
        assert self._largest is not None
        self._largest = (
            max(self._largest[0], force_N),
            max(self._largest[1], torque_Nm),
        )

    def take(self) -> dict[str, object]:
        """Returns the steps that are complete since the last call, for a frame."""
        done, self._done = self._done, []
        return {
            "dt_s": TRACE_STEP_S,
            "force_N": [force_N for force_N, _ in done],
            "torque_Nm": [torque_Nm for _, torque_Nm in done],
        }


# Number of latest ticks for times, and number of seconds for rates.
_LATEST = 1000
_RATE_SPAN_S = 1.0
_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


class FrameMaker:
    """Makes frames from packets."""

    def __init__(self, shed_stages: Sequence[str] = ()):
        """Starts with no tick."""
        self._shed_stages = shed_stages
        self._trace = Trace()
        self._tick_s: deque[float] = deque(maxlen=_LATEST)
        self._late_s: deque[float] = deque(maxlen=_LATEST)
        # Clock time, simulated time, s, and ticks so far, at each packet.
        self._packets: deque[tuple[float, float, int]] = deque()
        self._ticks = 0

    def make(self, packet: Telemetry) -> dict[str, Any]:
        """Returns a frame for the page, except for whether that page drives.

        Unknown values are None. Vectors `f` and `tau` are right, up and near in the
        page's picture, and so are the world's `axes`; `handle` is right and up of its
        middle in heights of it, which is `height_m` there.
        """
        for tick in packet.ticks:
            self._trace.add(tick.time_s, math.hypot(*tick.f_W), math.hypot(*tick.tau_W))
            self._tick_s.append(tick.tick_s)
            self._late_s.append(tick.late_s)
        handle, height_m = find_in_view(packet.p_WH, packet.R_WC, packet.p_WC)
        frame: dict[str, Any] = {
            "trace": self._trace.take(),
            "gate": packet.gate,
            "fault": packet.fault,
            "silent_s": packet.silent_s,
            "skipped": packet.skipped,
            "shed": list(self._shed_stages[: packet.shed]),
            "handle": handle,
            "height_m": height_m,
            "axes": {
                name: turn_into_view(axis, packet.R_WC) for name, axis in _AXES.items()
            }
            if math.isfinite(packet.p_WC[0])
            else None,
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
            packets.clear()  # The scene began again.
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

    That is negative if something penetrates.
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
    """Returns quantiles, µs, by name; None without data."""
    ordered = sorted(x for x in seconds if not math.isnan(x))
    if not ordered:
        return None
    last = len(ordered) - 1
    return {name: 1e6 * ordered[round(share * last)] for name, share in shares.items()}
