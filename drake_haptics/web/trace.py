"""A trace that a page can draw: fewer points than ticks, and no peak lost."""

from __future__ import annotations

import math

TRACE_STEP_S = 4e-3


class Trace:
    """Thins ticks: of each `TRACE_STEP_S` of simulated time the largest values."""

    def __init__(self) -> None:
        self._step = -math.inf
        self._largest: tuple[float, float] | None = None
        self._done: list[tuple[float, float]] = []

    def add(self, time_s: float, force_N: float, torque_Nm: float) -> None:
        """Adds a tick.

        Args:
            time_s: Simulated time, s; where it goes back, the scene began anew.
            force_N: Norm of the force, N.
            torque_Nm: Norm of the torque, N·m.
        """
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
