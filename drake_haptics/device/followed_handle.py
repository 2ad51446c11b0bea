"""A virtual handle that follows the pose of an input such as a mouse or sliders.

The motion is a critically damped follower of a goal, in closed form, whose speed never
exceeds a limit.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from drake_haptics.device.backend import DeviceCommand, DeviceReading, GateState
from drake_haptics.device.rotation_vector import (
    calc_angular_velocity,
    calc_rate,
    invert,
    multiply,
    normalize,
    to_quaternion,
    to_rotation_vector,
)

# λ. The handle lags 2/λ, 50 ms, behind a steady motion: less is felt as steps of the
# input, more as a rubber band.
_RATE_PER_S = 40.0
# A fast hand, but not so fast that a tool would pass through an object.
_MAX_SPEED_M_PER_S = 0.5
_MAX_TURN_RAD_PER_S = 6.0
# The runner turns at this share of the limit; a rotation vector's rate exceeds the
# angular velocity by up to a hundredth, for a lag of 0.5 rad. It is 0.3 rad at most.
_TURN_SHARE = 0.98


@dataclass(frozen=True)
class Pursuit:
    """One motion of any number of coordinates to a goal.

    A runner leaves the origin at time 0 with a constant velocity u, reaches its goal at
    time T and stops there. The follower obeys

        ẍ = λ² (s − x) − 2 λ ẋ

    with the runner's position s. That is two equal first-order lags in series, so that
    from rest, and from any state after such a run, `|ẋ| ≤ |u|` at all times.

    Attributes:
        start: x at time 0.
        start_velocity: ẋ at time 0, 1/s.
        run_velocity: u, 1/s.
        run_s: T, s.
    """

    start: Sequence[float]
    start_velocity: Sequence[float]
    run_velocity: Sequence[float]
    run_s: float

    @staticmethod
    def to_goal(
        start: Sequence[float],
        start_velocity: Sequence[float],
        goal: Sequence[float],
        speed: float,
    ) -> Pursuit:
        """Returns the run to a goal, straight and at a speed, 1/s."""
        distance = math.hypot(*goal)
        share = speed / distance if distance > 0.0 else 0.0
        run_velocity = [share * x for x in goal]
        return Pursuit(start, start_velocity, run_velocity, distance / speed)

    def calc_runner(self, time_s: float) -> list[float]:
        """Returns s at a time, s."""
        run_s = min(time_s, self.run_s)
        return [run_s * u for u in self.run_velocity]

    def calc(self, time_s: float) -> tuple[list[float], list[float]]:
        """Returns x and ẋ at a time, at least 0 s, exactly."""
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
        """Returns x and ẋ while the runner runs; x settles 2u/λ behind it."""
        lag_s = 2.0 / _RATE_PER_S
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
        rate = _RATE_PER_S
        decay = math.exp(-rate * time_s)
        slopes = [w + rate * z for z, w in zip(offset, change, strict=True)]
        return (
            [decay * (z + b * time_s) for z, b in zip(offset, slopes, strict=True)],
            [
                decay * (w - rate * time_s * b)
                for w, b in zip(change, slopes, strict=True)
            ],
        )


class PoseFilter:
    """Follows a goal pose smoothly, within limits of speed.

    A slider or a mouse gives poses 10 to 60 times per second, in steps; a loop needs
    pose and velocity 1000 times per second. A runner moves straight to each new goal at
    the largest speed, turning about one axis, and the handle follows the runner with
    critical damping (see `Pursuit`): its speed is continuous and never exceeds the
    limit, and its velocity is the derivative of its pose.

    Rotations do the same by their rotation vector relative to the runner when the goal
    was set. The solution is in closed form, so that it does not depend on when or how
    often it is evaluated.
    """

    def __init__(self, X_BH: np.ndarray):
        """Starts at rest at a pose (7,) [qw qx qy qz x y z], m.

        Raises:
            ValueError: The pose is not finite or has no quaternion.
        """
        # Origins of the two pursuits' coordinates.
        self._q_B, self._p_B = _split(X_BH)
        self._time_s = -math.inf
        rest = Pursuit([0.0] * 3, [0.0] * 3, [0.0] * 3, 0.0)
        self._turn = self._move = rest

    def set_goal(self, X_BG: np.ndarray, time_s: float) -> None:
        """Moves to another pose from now on.

        Args:
            X_BG: (7,) goal [qw qx qy qz x y z], m; the quaternion of any length.
            time_s: Present time, s; a time before that of the last goal counts as that.

        Raises:
            ValueError: The pose is not finite or has no quaternion.
        """
        q_BG, p_BG = _split(X_BG)
        time_s = max(time_s, self._time_s)
        since_s = self._since(time_s)

        p, v = self._move.calc(since_s)
        run = self._move.calc_runner(since_s)
        origin = [o + s for o, s in zip(self._p_B, run, strict=True)]
        self._move = Pursuit.to_goal(
            [x - s for x, s in zip(p, run, strict=True)],
            v,
            [g - o for g, o in zip(p_BG, origin, strict=True)],
            _MAX_SPEED_M_PER_S,
        )
        self._p_B = origin

        r, change = self._turn.calc(since_s)
        w = calc_angular_velocity(r, change)
        q_BH = multiply(to_quaternion(r), self._q_B)
        run = self._turn.calc_runner(since_s)
        q_B = normalize(multiply(to_quaternion(run), self._q_B))
        r = to_rotation_vector(multiply(q_BH, invert(q_B)))
        self._turn = Pursuit.to_goal(
            r,
            calc_rate(r, w),
            to_rotation_vector(multiply(q_BG, invert(q_B))),
            _TURN_SHARE * _MAX_TURN_RAD_PER_S,
        )
        self._q_B = q_B
        self._time_s = time_s

    def calc(self, time_s: float) -> tuple[np.ndarray, np.ndarray]:
        """Returns the pose and the velocity of the handle.

        Args:
            time_s: Time, s; a time before that of the last goal counts as that.

        Returns:
            X_BH (7,) [qw qx qy qz x y z], m, with a unit quaternion, and V_BH (6,)
            [ω; v], rad/s and m/s.
        """
        since_s = self._since(time_s)
        p, v = self._move.calc(since_s)
        r, change = self._turn.calc(since_s)
        q_BH = multiply(to_quaternion(r), self._q_B)
        p_BH = [o + x for o, x in zip(self._p_B, p, strict=True)]
        return (np.array(q_BH + p_BH), np.array(calc_angular_velocity(r, change) + v))

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


class FollowedHandle(PoseFilter):
    """The handle of a backend whose input device has no handle.

    Force does not move such a handle; it is only displayed.
    """

    def __init__(self, X_BH: np.ndarray):
        """Starts at rest at a pose (7,) [qw qx qy qz x y z], m, showing no force.

        Raises:
            ValueError: The pose is not finite or has no quaternion.
        """
        super().__init__(X_BH)
        self._sequence = 0
        self._gate = GateState.IDLE
        self._F_Ho_B = np.zeros(6)
        self._released = False

    @property
    def gate(self) -> GateState:
        """Active from the first wrench until `release`."""
        return self._gate

    @property
    def F_Ho_B(self) -> np.ndarray:
        """(6,) wrench [τ; f] that is shown now, N·m and N."""
        return self._F_Ho_B

    def show(self, command: DeviceCommand) -> None:
        """Shows a wrench from now on; shows zero if it is not finite.

        After `release` it shows none.
        """
        if self._released:
            return
        self._gate = GateState.ACTIVE
        F_Ho_B = np.array(command.F_Ho_B, dtype=float)
        self._F_Ho_B = F_Ho_B if np.isfinite(F_Ho_B).all() else np.zeros(6)

    def release(self) -> None:
        """Shows no force from now on."""
        self._released = True
        self._gate = GateState.IDLE
        self._F_Ho_B = np.zeros(6)

    def read(self, time_s: float, buttons: int = 0) -> DeviceReading:
        """Returns the present reading."""
        self._sequence += 1
        X_BH, V_BH = self.calc(time_s)
        return DeviceReading(
            sequence=self._sequence,
            time_s=time_s,
            X_BH=X_BH,
            V_BH=V_BH,
            F_Ho_B=self._F_Ho_B,
            buttons=buttons,
            gate=self._gate,
        )
