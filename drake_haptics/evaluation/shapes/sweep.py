"""Tubes swept along bent paths."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from drake_haptics.evaluation.shapes.surface import Surface, loft

# Two bends may follow each other at once.
_NO_LENGTH_M = 1e-9


@dataclass(frozen=True)
class Path:
    """A smooth path, sampled.

    Attributes:
        points: (n, 3), m.
        tangents: (n, 3) unit vectors along the path.
    """

    points: np.ndarray
    tangents: np.ndarray

    def frames(self, normal: np.ndarray) -> np.ndarray:
        """Returns (n, 3, 3) frames that turn about the path no more than they must.

        Args:
            normal: (3,) the first frame's x axis lies in the plane of this vector and
                the first tangent, and on the same side.

        Returns:
            Rotations whose columns are x, y and the tangent.
        """
        x = normal - (normal @ self.tangents[0]) * self.tangents[0]
        frames = [_frame(x, self.tangents[0])]
        for before, after in pairwise(self.tangents):
            # The least turn that takes one tangent to the next.
            axis, cosine = np.cross(before, after), before @ after
            x = frames[-1][:, 0]
            x = cosine * x + np.cross(axis, x) + axis * (axis @ x) / (1 + cosine)
            frames.append(_frame(x, after))
        return np.array(frames)


def rounded_path(
    corners: np.ndarray,
    bend_radius: float,
    *,
    bend_steps: int,
    step: float = np.inf,
) -> Path:
    """Returns the path along straight lines with rounded corners.

    Args:
        corners: (k, 3) ends and corners, m. The lines between them must be long
            enough for the bends.
        bend_radius: of the arcs at the corners, m.
        bend_steps: steps per quarter turn of an arc, at least one per arc.
        step: the longest step on a straight line, m.
    """
    corners = np.asarray(corners, dtype=float)
    directions = np.diff(corners, axis=0)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    points, tangents = [corners[0]], [directions[0]]

    def go_straight(end: np.ndarray, direction: np.ndarray) -> None:
        start = points[-1]
        length = np.linalg.norm(end - start)
        if length < _NO_LENGTH_M:
            return
        count = max(1, int(np.ceil(length / step - 1e-9)))
        for k in range(1, count + 1):
            points.append(start + (end - start) * k / count)
            tangents.append(direction)

    for corner, before, after in zip(
        corners[1:-1], directions[:-1], directions[1:], strict=True
    ):
        angle = np.arccos(np.clip(before @ after, -1, 1))
        inset = bend_radius * np.tan(angle / 2)
        go_straight(corner - inset * before, before)
        inward = after - (after @ before) * before
        inward /= np.linalg.norm(inward)
        start = points[-1]
        count = max(1, round(bend_steps * angle / (np.pi / 2)))
        for turn in angle * np.arange(1, count + 1) / count:
            c, s = np.cos(turn), np.sin(turn)
            points.append(start + bend_radius * (s * before + (1 - c) * inward))
            tangents.append(c * before + s * inward)
    go_straight(corners[-1], directions[-1])
    return Path(np.array(points), np.array(tangents))


def sweep_tube(path: Path, normal: np.ndarray, radius: float, count: int) -> Surface:
    """Returns a round solid along a path, with flat ends.

    Args:
        path: the axis.
        normal: (3,) direction of the first vertex, as in `Path.frames`.
        radius: m.
        count: vertices around the axis.
    """
    angle = 2 * np.pi * np.arange(count) / count
    section = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    rings = (
        p + section @ frame[:, :2].T
        for p, frame in zip(path.points, path.frames(normal), strict=True)
    )
    return loft(path.points[0], rings, path.points[-1])


def _frame(x: np.ndarray, z: np.ndarray) -> np.ndarray:
    """A rotation with the tangent z and x made normal to it."""
    x = x - (x @ z) * z
    x = x / np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])
