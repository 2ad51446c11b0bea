"""Makes a motion that a hand could make of poses that come now and then."""

from __future__ import annotations

import math

import numpy as np

from drake_haptics.device.pursuit import Pursuit
from drake_haptics.device.rotation_vector import (
    calc_angular_velocity,
    calc_rate,
    invert,
    multiply,
    normalize,
    to_quaternion,
    to_rotation_vector,
)

# How far turning may lag behind its goal, rad: a rotation vector is then nearly
# proportional to what it stands for.
_LONGEST_LAG_RAD = 0.5
# The runner turns at this share of the limit; a rotation vector's rate exceeds the
# angular velocity by up to a hundredth, for a lag as long as that.
_TURN_SHARE = 0.98


class PoseFilter:
    """Follows a goal pose smoothly and never faster than it may.

    A slider or a mouse gives poses 10 to 60 times a second, in steps; a loop asks for
    pose and velocity 1000 times a second. A runner goes straight to each new goal at
    the largest speed, turning about one axis, and the handle follows the runner,
    critically damped (see `Pursuit`): its speed has no jumps and never exceeds the
    limit, and its velocity is the derivative of its pose.

    Rotations do the same by their rotation vector from where the runner was when the
    goal was set. The solution is in closed form: what is asked for, and when, changes
    nothing, and no gap is too long.
    """

    def __init__(
        self,
        X_BH: np.ndarray,
        *,
        rate_per_s: float,
        max_speed_m_per_s: float,
        max_turn_rad_per_s: float,
    ):
        """Starts at rest.

        Args:
            X_BH: (7,) pose [qw qx qy qz x y z], m.
            rate_per_s: λ, 1/s; the handle is 2/λ behind a steady motion.
            max_speed_m_per_s: Largest speed of Ho, m/s.
            max_turn_rad_per_s: Largest rate of turning, rad/s.

        Raises:
            ValueError: The pose is not finite or has no quaternion, a number is not
                positive, or the handle could lag behind by more than 0.5 rad.
        """
        for name, value in [
            ("rate_per_s", rate_per_s),
            ("max_speed_m_per_s", max_speed_m_per_s),
            ("max_turn_rad_per_s", max_turn_rad_per_s),
        ]:
            if not (value > 0.0 and math.isfinite(value)):
                raise ValueError(f"{name} must be positive and finite, is {value}")
        most = _LONGEST_LAG_RAD * rate_per_s / 2.0
        if max_turn_rad_per_s > most:
            raise ValueError(
                f"max_turn_rad_per_s must be at most rate_per_s / 4 = {most:g},"
                f" is {max_turn_rad_per_s}"
            )
        self._rate_per_s = rate_per_s
        self._max_speed_m_per_s = max_speed_m_per_s
        self._max_turn_rad_per_s = _TURN_SHARE * max_turn_rad_per_s
        # Origins of the two pursuits' coordinates.
        self._q_B, self._p_B = _split(X_BH)
        self._time_s = -math.inf
        rest = Pursuit(rate_per_s, [0.0] * 3, [0.0] * 3, [0.0] * 3, 0.0)
        self._turn = self._move = rest

    def set_goal(self, X_BG: np.ndarray, time_s: float) -> None:
        """Heads for another pose from now on.

        Args:
            X_BG: (7,) goal [qw qx qy qz x y z], m; the quaternion of any length.
            time_s: Now, s; a time before the last goal's is taken as that.

        Raises:
            ValueError: The pose is not finite or has no quaternion.
        """
        q_BG, p_BG = _split(X_BG)
        time_s = max(time_s, self._time_s)
        since_s = self._since(time_s)
        rate = self._rate_per_s

        p, v = self._move.calc(since_s)
        run = self._move.calc_runner(since_s)
        origin = [o + s for o, s in zip(self._p_B, run, strict=True)]
        self._move = Pursuit.to_goal(
            rate,
            [x - s for x, s in zip(p, run, strict=True)],
            v,
            [g - o for g, o in zip(p_BG, origin, strict=True)],
            self._max_speed_m_per_s,
        )
        self._p_B = origin

        r, change = self._turn.calc(since_s)
        w = calc_angular_velocity(r, change)
        q_BH = multiply(to_quaternion(r), self._q_B)
        run = self._turn.calc_runner(since_s)
        q_B = normalize(multiply(to_quaternion(run), self._q_B))
        r = to_rotation_vector(multiply(q_BH, invert(q_B)))
        self._turn = Pursuit.to_goal(
            rate,
            r,
            calc_rate(r, w),
            to_rotation_vector(multiply(q_BG, invert(q_B))),
            self._max_turn_rad_per_s,
        )
        self._q_B = q_B
        self._time_s = time_s

    def calc(self, time_s: float) -> tuple[np.ndarray, np.ndarray]:
        """Returns where the handle is, and how it moves.

        Args:
            time_s: When, s; a time before the last goal's is taken as that.

        Returns:
            X_BH (7,) [qw qx qy qz x y z], m, with a unit quaternion, and V_BH (6,)
            [ω; v], rad/s and m/s.
        """
        since_s = self._since(time_s)
        p, v = self._move.calc(since_s)
        r, change = self._turn.calc(since_s)
        q_BH = multiply(to_quaternion(r), self._q_B)
        p_BH = [o + x for o, x in zip(self._p_B, p, strict=True)]
        return (
            np.array(q_BH + p_BH),
            np.array(calc_angular_velocity(r, change) + v),
        )

    def _since(self, time_s: float) -> float:
        """Returns the time since the last goal, s; 0 before the first one."""
        return max(time_s - self._time_s, 0.0) if self._time_s > -math.inf else 0.0


def _split(X: np.ndarray) -> tuple[list[float], list[float]]:
    """Returns the unit quaternion and the position of a pose.

    Raises:
        ValueError: It is not finite or has no quaternion.
    """
    values = np.asarray(X, dtype=float)
    if values.shape != (7,) or not np.isfinite(values).all():
        raise ValueError(f"a pose must be 7 finite numbers, is {X}")
    if not np.linalg.norm(values[:4]) > 1e-6:
        raise ValueError(f"a pose's quaternion must not be zero, is {values[:4]}")
    numbers = values.tolist()
    return normalize(numbers[:4]), numbers[4:]
