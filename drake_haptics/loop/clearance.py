"""Finds how much room a tool has in what encloses it, and a skin that fits there."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from pydrake.math import RigidTransform

from drake_haptics import _core
from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose
from drake_haptics.loop.contact import find_skins
from drake_haptics.loop.simulated_device import make_hand_path
from drake_haptics.scene.contact_law import LARGEST_DEFAULT_SKIN_M, is_constraint
from drake_haptics.scene.schema import ContactParameters, HandPathParameters, Scene

# So many places of the hand's path are looked at.
_PLACES = 100


@dataclass(frozen=True)
class Clearance:
    """How much room a tool has where it has least.

    Attributes:
        share: Of the distances to be kept, the largest that the tool can be moved to
            from all surfaces at once: for one distance it is half the play between two
            walls, divided by it.
        objects: Indices of the objects that leave no more.
    """

    share: float
    objects: tuple[int, ...]


def find_clearance(
    tool: _core.ConvexPieces,
    objects: Sequence[tuple[_core.ConvexPieces, RigidTransform]],
    poses: Iterable[RigidTransform],
    kept_m: Sequence[float],
) -> Clearance | None:
    """Returns the least clearance of a tool, if it is less than it should be.

    A tool that is moved by x is at least dᵢ + nᵢ·x from the piece of contact i, since
    the distance of convex pieces is convex in x. So no translation of at most the
    tool's own size brings it farther from all pieces than by the largest share s of
    what should be kept, δᵢ, with s δᵢ ≤ dᵢ + nᵢ·x: a linear program. What lets the
    tool out on one side, as the floor, a corner or a cone does, leaves s as large as
    one likes.

    Args:
        tool: Its pieces, in its frame T.
        objects: Pieces of each object and its pose X_WO.
        poses: Poses X_WT to look at; those in which the tool touches an object are
            left out: there it will not be.
        kept_m: The distance that the tool should be able to keep from each object, m.
    """
    # Two walls that leave less than that on each side are nearer than twice as much,
    # wherever between them the tool is.
    tracker = _core.SceneTracker(tool, [body for body, _ in objects], 2 * max(kept_m))
    kept = np.array(kept_m)
    for i, (_, X_WO) in enumerate(objects):
        tracker.set_object_pose(i, pose_to_vector(X_WO))
    size_m = float(np.linalg.norm(np.ptp(tool.vertices, axis=0)))
    least: Clearance | None = None
    for X_WT in poses:
        tracker.reset()
        contacts = tracker.query(pose_to_vector(X_WT))
        if contacts.least_distance <= 0.0:
            continue
        found = _find_room(contacts, size_m, kept[contacts.object_index])
        if found is not None and (least is None or found.share < least.share):
            least = found
    return least


def sample_path(parameters: HandPathParameters) -> list[RigidTransform]:
    """Returns poses X_WT along a hand's path, so many that a tool's way is known."""
    path = make_hand_path(parameters)
    times = np.linspace(0.0, path.duration_s, _PLACES)
    return [vector_to_pose(path.calc(t)[0]) for t in times]


def fit_skin(
    scene: Scene,
    tool: _core.ConvexPieces,
    objects: Sequence[tuple[_core.ConvexPieces, RigidTransform]],
) -> ContactParameters:
    """Returns a scene's contact with the skin that is not given.

    It is that of `find_skins`, or as much of it as the tool can keep on the hand's
    path.

    Args:
        scene: Whose contact it is.
        tool: Its pieces, in its frame T.
        objects: Pieces of each object and its pose X_WO.
    """
    contact = scene.contact
    if not is_constraint(contact) or contact.skin_m is not None:
        return contact
    skins = find_skins(contact, [item.material for item in scene.environment])
    found = find_clearance(tool, objects, sample_path(scene.hand.path), skins)
    share = 1.0 if found is None else found.share
    return replace(contact, skin_m=round_down(share * LARGEST_DEFAULT_SKIN_M))


def round_down(value: float) -> float:
    """Returns a positive number with two digits, the second not rounded up."""
    digit = 10.0 ** (math.floor(math.log10(value)) - 1)
    # What has two digits already may be a little less by round-off.
    return float(f"{digit * math.floor(value / digit * (1.0 + 1e-12)):.2g}")


def _find_room(
    contacts: _core.ContactSet, size_m: float, kept_m: NDArray[np.float64]
) -> Clearance | None:
    """Returns the clearance among contacts if it is less than `kept_m` of each."""
    n_W, d = contacts.nhat_BA_W, contacts.distance
    if len(d) < 2 or _can_leave(n_W, d, size_m, kept_m):
        return None
    distance_m = kept_m.max()
    from scipy.optimize import linprog

    # Of (x, s) as shares of the distance, so that all numbers are near 1.
    solved = linprog(
        [0.0, 0.0, 0.0, -1.0],
        A_ub=np.column_stack([-n_W, kept_m / distance_m]),
        b_ub=d / distance_m,
        bounds=[(-size_m / distance_m, size_m / distance_m)] * 3 + [(None, None)],
    )
    share = -float(solved.fun)
    if share >= 1.0:
        return None
    holding = solved.ineqlin.marginals < 0
    return Clearance(share, tuple(sorted(set(contacts.object_index[holding].tolist()))))


def _can_leave(
    n_W: NDArray[np.float64],
    d: NDArray[np.float64],
    size_m: float,
    kept_m: NDArray[np.float64],
) -> bool:
    """Whether a move along the mean normal leads away from all surfaces."""
    way = n_W.mean(axis=0)
    length = float(np.linalg.norm(way))
    if length < np.finfo(float).eps:
        return False
    return bool(np.all(d + size_m / length * (n_W @ way) >= kept_m))
