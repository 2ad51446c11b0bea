"""How a point follows another that runs to its goal, in closed form."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Pursuit:
    """One run to a goal, of any number of coordinates that belong together.

    A runner leaves the origin at time 0 with a constant velocity u, reaches its goal
    at time T and stands there. The follower obeys

        ẍ = λ² (s − x) − 2 λ ẋ

    with the runner's place s. That is two equal first-order lags in series, so that
    from rest, and from any state that such a run has left, `|ẋ| ≤ |u|` at all times.

    Attributes:
        rate_per_s: λ, 1/s.
        start: x at time 0.
        start_velocity: ẋ at time 0, 1/s.
        run_velocity: u, 1/s.
        run_s: T, s.
    """

    rate_per_s: float
    start: Sequence[float]
    start_velocity: Sequence[float]
    run_velocity: Sequence[float]
    run_s: float

    @staticmethod
    def to_goal(
        rate_per_s: float,
        start: Sequence[float],
        start_velocity: Sequence[float],
        goal: Sequence[float],
        speed: float,
    ) -> Pursuit:
        """Returns the run to a goal, straight and at a speed, 1/s."""
        distance = math.hypot(*goal)
        share = speed / distance if distance > 0.0 else 0.0
        return Pursuit(
            rate_per_s,
            start,
            start_velocity,
            [share * x for x in goal],
            distance / speed,
        )

    def calc_runner(self, time_s: float) -> list[float]:
        """Returns s at a time, s."""
        run_s = min(time_s, self.run_s)
        return [run_s * u for u in self.run_velocity]

    def calc(self, time_s: float) -> tuple[list[float], list[float]]:
        """Returns x and ẋ at a time from 0 s on, exactly."""
        running_s = min(time_s, self.run_s)
        place, velocity = self._calc_running(running_s)
        standing_s = time_s - running_s
        if standing_s == 0.0:
            return place, velocity
        goal = self.calc_runner(running_s)
        offset = [x - s for x, s in zip(place, goal, strict=True)]
        offset, velocity = self._settle(offset, velocity, standing_s)
        return [s + z for s, z in zip(goal, offset, strict=True)], velocity

    def _calc_running(self, time_s: float) -> tuple[list[float], list[float]]:
        """Returns x and ẋ while the runner runs: it settles 2u/λ behind it."""
        lag_s = 2.0 / self.rate_per_s
        run = self.run_velocity
        offset = [x + lag_s * u for x, u in zip(self.start, run, strict=True)]
        change = [v - u for v, u in zip(self.start_velocity, run, strict=True)]
        offset, change = self._settle(offset, change, time_s)
        behind_s = time_s - lag_s
        return (
            [behind_s * u + z for u, z in zip(run, offset, strict=True)],
            [u + z for u, z in zip(run, change, strict=True)],
        )

    def _settle(
        self, offset: Sequence[float], change: Sequence[float], time_s: float
    ) -> tuple[list[float], list[float]]:
        """Returns z and ż of z̈ + 2λż + λ²z = 0 after a time."""
        rate = self.rate_per_s
        decay = math.exp(-rate * time_s)
        slopes = [w + rate * z for z, w in zip(offset, change, strict=True)]
        return (
            [decay * (z + b * time_s) for z, b in zip(offset, slopes, strict=True)],
            [
                decay * (w - rate * time_s * b)
                for w, b in zip(change, slopes, strict=True)
            ],
        )
