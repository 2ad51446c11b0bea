"""The path along which a simulated hand moves the tool."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.math import RigidTransform
from pydrake.trajectories import PiecewisePolynomial

from drake_haptics._core import PosePath
from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose

# Neighboring quaternions are interpolated along their chord; beyond this angle
# the speed of turning along it would vary too much.
_LARGEST_TURN_DEG = 120.0


class HandPath:
    """A smooth pose X_WP over time that passes through waypoints without overshoot.

    Positions and quaternions follow the shape-preserving cubic (Fritsch and Carlson
    1980), so that the speed is continuous and the pose is constant between two equal
    waypoints. The core evaluates them, because the simulated arm needs them several
    times per tick.
    """

    def __init__(
        self,
        times_s: Sequence[float],
        poses: Sequence[RigidTransform],
        *,
        periodic: bool = False,
    ):
        """Constructs the path.

        Args:
            times_s: Times of the waypoints, increasing from 0, s.
            poses: Poses X_WP at these times.
            periodic: Whether the path repeats after the last time, at which the pose
                must be the first one. Otherwise the path begins and ends at rest and
                stays at its end.

        Raises:
            ValueError: The times do not rise from 0, a pose is not finite, neighbors
                are turned by 120° or more, or a periodic path does not close.
        """
        if len(times_s) != len(poses) or not len(poses):
            raise ValueError("a path needs a time for each of one or more poses")
        times = np.array(times_s, dtype=float)
        # Drake ends the program for times that are as good as equal, or no numbers.
        rises = np.all(np.diff(times) >= np.finfo(float).eps)
        if times[0] != 0.0 or not rises or not np.isfinite(times[-1]):
            raise ValueError("times must rise from 0 s")
        samples = np.array([pose_to_vector(X) for X in poses])
        if not np.isfinite(samples).all():
            raise ValueError("the poses must be finite")
        samples = _align_signs(samples)
        if periodic and len(poses) < 3:
            raise ValueError("a periodic path needs three waypoints or more")
        if periodic and not poses[0].IsNearlyEqualTo(poses[-1], 1e-6):
            raise ValueError("a periodic path must end at the pose it starts with")
        self._duration_s = float(times[-1])
        cubics = _fit(times, samples, periodic)
        if periodic:
            self._core = PosePath(times[:-1].tolist(), cubics, self._duration_s)
        else:
            rest = np.zeros((1, 4, 7))
            rest[0, 0] = samples[-1]
            self._core = PosePath(times.tolist(), np.vstack([cubics, rest]), np.inf)

    @property
    def duration_s(self) -> float:
        """Time of the last waypoint, s."""
        return self._duration_s

    @property
    def start(self) -> RigidTransform:
        """X_WP at the start."""
        return vector_to_pose(self.calc(0.0)[0])

    @property
    def core(self) -> PosePath:
        """The path in the form that the core evaluates."""
        return self._core

    def calc(self, time_s: float) -> tuple[np.ndarray, np.ndarray]:
        """Returns X_WP as [qw qx qy qz x y z] and V_WP = [ω; v] at a time.

        Args:
            time_s: Time, not negative, s.

        Returns:
            The pose (7,), m, and the spatial velocity (6,) at P's origin in the
            world, rad/s and m/s.
        """
        return self._core.evaluate(time_s)


def _align_signs(samples: np.ndarray) -> np.ndarray:
    """Chooses q or -q, whichever is nearer to the waypoint before."""
    smallest = np.cos(np.deg2rad(_LARGEST_TURN_DEG) / 2.0)
    for i in range(1, len(samples)):
        cosine = samples[i, :4] @ samples[i - 1, :4]
        if abs(cosine) <= smallest:
            raise ValueError(
                f"waypoints {i - 1} and {i} are turned by {_LARGEST_TURN_DEG:g}° or"
                " more: put another between them"
            )
        if cosine < 0.0:
            samples[i, :4] *= -1.0
    return samples


def _fit(times: np.ndarray, samples: np.ndarray, periodic: bool) -> np.ndarray:
    """Returns the cubic of each segment: (segments, 4 powers, 7)."""
    if len(times) == 1:
        return np.zeros((0, 4, 7))
    breaks = times
    if periodic:
        # One more segment at each end gives the seam a slope as at any other waypoint.
        # After a whole turn the quaternion is -q.
        sign = np.ones(7)
        sign[:4] = np.sign(samples[0, :4] @ samples[-1, :4])
        before, after = samples[-2] * sign, samples[1] * sign
        breaks = np.concatenate(
            [[times[-2] - times[-1]], times, [times[-1] + times[1]]]
        )
        samples = np.vstack([before, samples, after])
    spline = PiecewisePolynomial.CubicShapePreserving(
        breaks, samples.T, zero_end_point_derivatives=not periodic
    )
    factorials = [1.0, 1.0, 2.0, 6.0]
    return np.array(
        [
            [
                spline.EvalDerivative(t, power).ravel() / factorials[power]
                for power in range(4)
            ]
            for t in times[:-1]
        ]
    )
