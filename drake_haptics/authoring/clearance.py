"""Finds how much room a tool has in what encloses it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from pydrake.math import RigidTransform

from drake_haptics import _core
from drake_haptics.common.pose_vector import pose_to_vector


@dataclass(frozen=True)
class Clearance:
    """The least room that a tool has.

    Attributes:
        distance_m: Largest distance from all surfaces at once that the tool can be
            moved to, m: half the play between two walls.
        objects: Indices of the objects that leave no more.
    """

    distance_m: float
    objects: tuple[int, ...]


def find_clearance(
    tool: _core.ConvexPieces,
    objects: Sequence[tuple[_core.ConvexPieces, RigidTransform]],
    poses: Iterable[RigidTransform],
    distance_m: float,
) -> Clearance | None:
    """Returns the least clearance of a tool, if it is less than some distance.

    A tool that is moved by x is at least dᵢ + nᵢ·x from the piece of contact i, since
    the distance of convex pieces is convex in x. So no translation of at most the
    tool's own size brings it farther from all pieces than the largest s with
    s ≤ dᵢ + nᵢ·x: a linear program. What lets the tool out on one side, as the floor,
    a corner or a cone does, leaves s as large as one likes.

    Args:
        tool: Its pieces, in its frame T.
        objects: Pieces of each object and its pose X_WO.
        poses: Poses X_WT to look at; those in which the tool overlaps an object are
            left out: there it will not be.
        distance_m: What the tool should be able to keep, m.
    """
    # Two walls that leave less than that on each side are nearer than twice as much,
    # wherever between them the tool is.
    tracker = _core.SceneTracker(tool, [body for body, _ in objects], 2 * distance_m)
    for i, (_, X_WO) in enumerate(objects):
        tracker.set_object_pose(i, pose_to_vector(X_WO))
    size_m = float(np.linalg.norm(np.ptp(tool.vertices, axis=0)))
    least: Clearance | None = None
    for X_WT in poses:
        tracker.reset()
        contacts = tracker.query(pose_to_vector(X_WT))
        if contacts.least_distance < 0.0:
            continue
        found = _find_room(contacts, size_m, distance_m)
        if found is not None and (least is None or found.distance_m < least.distance_m):
            least = found
    return least


def _find_room(
    contacts: _core.ContactSet, size_m: float, distance_m: float
) -> Clearance | None:
    """Returns the clearance among contacts if it is less than `distance_m`."""
    n_W, d = contacts.nhat_BA_W, contacts.distance
    if len(d) < 2 or _can_leave(n_W, d, size_m, distance_m):
        return None
    from scipy.optimize import linprog

    # Of (x, s) as shares of the distance, so that all numbers are near 1.
    solved = linprog(
        [0.0, 0.0, 0.0, -1.0],
        A_ub=np.column_stack([-n_W, np.ones(len(d))]),
        b_ub=d / distance_m,
        bounds=[(-size_m / distance_m, size_m / distance_m)] * 3 + [(None, None)],
    )
    room_m = -float(solved.fun) * distance_m
    if room_m >= distance_m:
        return None
    holding = solved.ineqlin.marginals < 0
    return Clearance(
        room_m, tuple(sorted(set(contacts.object_index[holding].tolist())))
    )


def _can_leave(
    n_W: NDArray[np.float64], d: NDArray[np.float64], size_m: float, distance_m: float
) -> bool:
    """Tells whether a move along the mean normal leads away from all surfaces."""
    way = n_W.mean(axis=0)
    length = float(np.linalg.norm(way))
    if length < np.finfo(float).eps:
        return False
    return bool(np.all(d + size_m / length * (n_W @ way) >= distance_m))
