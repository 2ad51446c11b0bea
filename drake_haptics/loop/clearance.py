"""Finds the clearance of a tool between objects, and a skin that fits it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from pydrake.math import RigidTransform
from pydrake.solvers import ClpSolver, LinearConstraint, MathematicalProgram

from drake_haptics import _core
from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose
from drake_haptics.loop.contact import find_skins
from drake_haptics.loop.simulated_device import make_hand_path
from drake_haptics.scene.contact_law import LARGEST_DEFAULT_SKIN_M, is_constraint
from drake_haptics.scene.schema import ContactParameters, HandPathParameters, Scene

# Number of poses on the hand's path at which the clearance is measured.
_PLACES = 100
# Largest number of moves that lead a tool out of objects into which it is pressed.
_MOVES = 3
# Cost of a move per length relative to the share, and tolerance of the share.
_WAY, _ROUNDING = 1e-5, 1e-6


@dataclass(frozen=True)
class Clearance:
    """The least clearance of a tool.

    Attributes:
        share: Largest share of the required distances that the tool can keep from all
            surfaces at once. For one distance it is half the play between two walls,
            divided by the distance.
        objects: Indices of the objects that limit the share.
    """

    share: float
    objects: tuple[int, ...]


def find_clearance(
    tool: _core.ConvexPieces,
    objects: Sequence[tuple[_core.ConvexPieces, RigidTransform]],
    poses: Iterable[RigidTransform],
    kept_m: Sequence[float],
) -> Clearance | None:
    """Returns the least clearance of a tool, or None if it is sufficient.

    A tool that is moved by x is at least dᵢ + nᵢ·x from the piece of contact i, since
    the distance of convex pieces is convex in x. So no translation of at most the
    tool's own size brings it farther from all pieces than by the largest share s of the
    distances δᵢ that should be kept, with s δᵢ ≤ dᵢ + nᵢ·x: a linear program. Objects
    that let the tool out on one side, such as a floor, a corner or a cone, leave s
    unbounded.

    Poses at which the tool overlaps an object do not count, since the tool will not be
    there. If it overlaps at all tight places, because a hand presses it, the same
    program leads it out to nearby poses.

    Args:
        tool: Pieces of the tool, in its frame T.
        objects: Pieces of each object and its pose X_WO.
        poses: Poses X_WT at which to measure the clearance.
        kept_m: Distance that the tool should be able to keep from each object, m.
    """
    # Two walls that leave less than this on each side are both within twice as much,
    # wherever the tool is between them.
    tracker = _core.SceneTracker(tool, [body for body, _ in objects], 2 * max(kept_m))
    kept = np.array(kept_m)
    for i, (_, X_WO) in enumerate(objects):
        tracker.set_object_pose(i, pose_to_vector(X_WO))
    size_m = float(np.linalg.norm(np.ptp(tool.vertices, axis=0)))
    pressed: list[NDArray[np.float64]] = []

    def ask(q_WT: NDArray[np.float64]) -> tuple[NDArray[np.float64], Clearance | None]:
        contacts = tracker.query(q_WT)
        x_W, found = _find_room(contacts, size_m, kept[contacts.object_index])
        if contacts.least_distance > 0.0:
            return np.zeros(3), found
        return x_W, None

    found = []
    for X_WT in poses:
        q_WT = pose_to_vector(X_WT)
        x_W, room = ask(q_WT)
        found.append(room)
        if np.any(x_W):
            pressed.append(q_WT + np.concatenate([np.zeros(4), x_W]))
    rooms = [room for room in found if room is not None]
    if not rooms:
        # The tool may have less room in this orientation than in the one that it will
        # take.
        for q_WT in pressed:
            for _ in range(_MOVES):
                x_W, room = ask(q_WT)
                if not np.any(x_W):
                    break
                q_WT[4:] += x_W
            if room is not None:
                rooms.append(room)
    return min(rooms, key=lambda room: room.share, default=None)


def sample_path(parameters: HandPathParameters) -> list[RigidTransform]:
    """Returns densely sampled poses X_WT along a hand's path."""
    path = make_hand_path(parameters)
    times = np.linspace(0.0, path.duration_s, _PLACES)
    return [vector_to_pose(path.calc(t)[0]) for t in times]


def fit_skin(
    scene: Scene,
    tool: _core.ConvexPieces,
    objects: Sequence[tuple[_core.ConvexPieces, RigidTransform]],
) -> ContactParameters:
    """Returns a scene's contact parameters, with a skin if the scene gives none.

    The skin is that of `find_skins`, or the largest share of it that the tool can keep
    on the hand's path.

    Args:
        scene: Scene with the contact parameters.
        tool: Pieces of the tool, in its frame T.
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
    """Returns a positive number rounded down to two digits."""
    digit = 10.0 ** (math.floor(math.log10(value)) - 1)
    # A value of two digits may be a little less by round-off.
    return float(f"{digit * math.floor(value / digit * (1.0 + 1e-12)):.2g}")


def _find_room(
    contacts: _core.ContactSet, size_m: float, kept_m: NDArray[np.float64]
) -> tuple[NDArray[np.float64], Clearance | None]:
    """Returns the shortest move that keeps all contacts at their distances `kept_m`.

    If no move keeps the full distances, the move keeps the largest possible share of
    each, and the `Clearance` has that share.
    """
    n_W, d = contacts.nhat_BA_W, contacts.distance
    stay = np.zeros(3)
    if len(d) < 2 or _can_leave(n_W, d, size_m, kept_m):
        return stay, None
    distance_m = float(kept_m.max())
    # Solved for (x, -x, s) in units of the distance, so that all numbers are near 1.
    program = MathematicalProgram()
    unknowns = program.NewContinuousVariables(7)
    program.AddLinearCost([_WAY] * 6 + [-1.0], unknowns)
    apart = LinearConstraint(
        np.column_stack([-n_W, n_W, kept_m / distance_m]),
        np.full(len(d), -np.inf),
        d / distance_m,
    )
    rows = program.AddConstraint(apart, unknowns)
    program.AddBoundingBoxConstraint(
        [0.0] * 6 + [-np.inf], [size_m / distance_m] * 6 + [1.0], unknowns
    )
    solved = ClpSolver().Solve(program)
    assert solved.is_success()  # a small enough share is kept anywhere
    x = solved.GetSolution(unknowns)
    x_W = distance_m * (x[:3] - x[3:6])
    share = float(x[6])
    if share >= 1.0 - _ROUNDING:
        return x_W, None
    holding = solved.GetDualSolution(rows) < 0.0
    objects = tuple(sorted(set(contacts.object_index[holding].tolist())))
    return x_W, Clearance(share, objects)


def _can_leave(
    n_W: NDArray[np.float64],
    d: NDArray[np.float64],
    size_m: float,
    kept_m: NDArray[np.float64],
) -> bool:
    """Returns whether a move along the mean normal frees the tool of all surfaces."""
    way = n_W.mean(axis=0)
    length = float(np.linalg.norm(way))
    if length < np.finfo(float).eps:
        return False
    return bool(np.all(d + size_m / length * (n_W @ way) >= kept_m))
