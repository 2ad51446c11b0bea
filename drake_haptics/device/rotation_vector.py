"""Calculates with rotation vectors, quaternions and angular velocities as lists.

NumPy would be slower for three numbers. A rotation vector r is axis times angle, rad; a
quaternion is [w x y z]. The formulas are those of Solà, Deray and Atchuthan, "A micro
Lie theory for state estimation in robotics", 2018, for the left Jacobian: R_AB(t) =
exp(r(t)) R_AB(0) turns at ω in A.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

# Below this angle, rad, series are exact to round-off.
_SMALL_RAD = 1e-4
_TIME_CONSTANT_S = 0.01
# A handle whose orientation stays the same for this long is at rest.
_REST_S = 0.05


def to_quaternion(r: Sequence[float]) -> list[float]:
    """Returns the unit quaternion (4,) of a rotation vector (3,), rad."""
    angle = math.hypot(*r)
    if angle < _SMALL_RAD:
        share = 0.5 - angle * angle / 48.0
    else:
        share = math.sin(angle / 2.0) / angle
    return [math.cos(angle / 2.0), *(share * x for x in r)]


def to_rotation_vector(q: Sequence[float]) -> list[float]:
    """Returns the rotation vector (3,), of π rad at most, of a unit quaternion (4,)."""
    sign = -1.0 if q[0] < 0.0 else 1.0
    sine = math.hypot(*q[1:])
    if sine < _SMALL_RAD:
        share = 2.0 + sine * sine / 3.0
    else:
        share = 2.0 * math.atan2(sine, abs(q[0])) / sine
    return [sign * share * x for x in q[1:]]


def multiply(a: Sequence[float], b: Sequence[float]) -> list[float]:
    """Returns the product (4,) of two quaternions."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return [
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    ]


def invert(q: Sequence[float]) -> list[float]:
    """Returns the inverse (4,) of a unit quaternion."""
    return [q[0], -q[1], -q[2], -q[3]]


def normalize(q: Sequence[float]) -> list[float]:
    """Returns a normalized quaternion (4,); it must not be zero."""
    norm = math.hypot(*q)
    return [x / norm for x in q]


def calc_angular_velocity(r: Sequence[float], rate: Sequence[float]) -> list[float]:
    """Returns ω (3,) = J(r) ṙ, rad/s, J being the left Jacobian. `|ω| ≤ |ṙ|`."""
    angle = math.hypot(*r)
    if angle < _SMALL_RAD:
        first, second = 0.5, 1.0 / 6.0
    else:
        first = 2.0 * (math.sin(angle / 2.0) / angle) ** 2
        second = (1.0 - math.sin(angle) / angle) / angle**2
    return _add_crosses(r, rate, first, second)


def calc_rate(r: Sequence[float], w: Sequence[float]) -> list[float]:
    """Returns ṙ (3,) = J(r)⁻¹ ω, rad/s, for a rotation of less than 2π."""
    angle = math.hypot(*r)
    if angle < _SMALL_RAD:
        second = 1.0 / 12.0
    else:
        half = angle / 2.0
        second = (1.0 - half / math.tan(half)) / angle**2
    return _add_crosses(r, w, -0.5, second)


def _add_crosses(
    r: Sequence[float], v: Sequence[float], first: float, second: float
) -> list[float]:
    """Returns v + first r×v + second r×(r×v)."""
    once = _cross(r, v)
    twice = _cross(r, once)
    return [x + first * y + second * z for x, y, z in zip(v, once, twice, strict=True)]


def _cross(a: Sequence[float], b: Sequence[float]) -> list[float]:
    return [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]


class TurnRate:
    """Estimates angular velocity by smoothed differences of orientations.

    A first-order low-pass smooths the differences. A sensor that is slower than the
    loop repeats values, so only a new orientation gives a difference, over the time
    since the last new one. In between the rate is held, and after 0.05 s it is zero.

    The rate lags behind by the filter's time constant, 10 ms, and half a sensor's
    period.
    """

    def __init__(self) -> None:
        self._time_s = -math.inf
        self._orientation: tuple[float, ...] | None = None
        self._rate = [0.0, 0.0, 0.0]

    def update(self, orientation: Sequence[float], time_s: float) -> list[float]:
        """Adds the sensor's reading and returns the rate.

        Args:
            orientation: (4,) unit quaternion [qw qx qy qz] of the handle in B.
            time_s: Time of the reading, s, which must increase.

        Returns:
            (3,) ω of the handle in B, rad/s.
        """
        q = tuple(orientation)
        elapsed_s = time_s - self._time_s
        if self._orientation is None or elapsed_s > _REST_S:
            # The first one, or the first after a rest, gives no meaningful difference.
            self._rate = [0.0, 0.0, 0.0]
            if q != self._orientation:
                self._orientation, self._time_s = q, time_s
        elif q != self._orientation and elapsed_s > 0.0:
            turn = to_rotation_vector(multiply(q, invert(self._orientation)))
            share = -math.expm1(-elapsed_s / _TIME_CONSTANT_S)
            self._rate = [
                rate + share * (angle / elapsed_s - rate)
                for rate, angle in zip(self._rate, turn, strict=True)
            ]
            self._orientation, self._time_s = q, time_s
        return list(self._rate)
