"""Angular velocity from the orientations that a sensor gives one after the other."""

from __future__ import annotations

import math
from collections.abc import Sequence

from drake_haptics.device.rotation_vector import invert, multiply, to_rotation_vector

# Orientations that stay the same for so long are those of a handle at rest.
_REST_S = 0.05


class TurnRate:
    """Differences of successive orientations, smoothed by a first-order low-pass.

    A sensor that is slower than the loop repeats itself: only a new orientation makes
    a new difference, over the time since the last new one. Between two the rate is
    held, until 0.05 s have passed without any.

    The rate lags behind by the filter's time constant and half a sensor's period.

    Args:
        time_constant_s: Of the low-pass, s.

    Raises:
        ValueError: The time constant is not positive.
    """

    def __init__(self, time_constant_s: float):
        if not time_constant_s > 0.0:
            raise ValueError(f"time_constant_s must be positive, is {time_constant_s}")
        self._time_constant_s = time_constant_s
        self._time_s = -math.inf
        self._orientation: tuple[float, ...] | None = None
        self._rate = [0.0, 0.0, 0.0]

    def update(self, orientation: Sequence[float], time_s: float) -> list[float]:
        """Takes the sensor's word and returns the rate.

        Args:
            orientation: (4,) unit quaternion [qw qx qy qz] of the handle in B.
            time_s: When it came, s; rises.

        Returns:
            (3,) ω of the handle in B, rad/s.
        """
        q = tuple(orientation)
        elapsed_s = time_s - self._time_s
        if self._orientation is None or elapsed_s > _REST_S:
            # The first one, or the first after a rest: no difference means anything.
            self._rate = [0.0, 0.0, 0.0]
            if q != self._orientation:
                self._orientation, self._time_s = q, time_s
        elif q != self._orientation and elapsed_s > 0.0:
            turn = to_rotation_vector(multiply(q, invert(self._orientation)))
            share = -math.expm1(-elapsed_s / self._time_constant_s)
            self._rate = [
                rate + share * (angle / elapsed_s - rate)
                for rate, angle in zip(self._rate, turn, strict=True)
            ]
            self._orientation, self._time_s = q, time_s
        return list(self._rate)
