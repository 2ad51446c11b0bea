"""Random walks of micrometers around poses in contact."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from press_rig import LARGEST_FORCE_N, Gains

from drake_haptics import _core

STEP_M = 1e-6
EPISODE_STEPS = 2000
# Share of the walk's direction that a step keeps: it turns within a millimeter.
_KEPT = 0.999
_LEASH_M = 2e-3
_APPROACH_STEP_M = 1e-4
_LONGEST_APPROACH_M = 40e-3


@dataclass(frozen=True)
class Home:
    """The start of an episode: a pose without contact, and the way to it.

    Attributes:
        X_WT: (4, 4) pose of the tool.
        push_W: (3,) unit direction in which it comes.
    """

    X_WT: np.ndarray
    push_W: np.ndarray


@dataclass(frozen=True, eq=False)
class WalkScene:
    """A tool and a solid that rests at the world's origin.

    Attributes:
        name: Name for people.
        tool: Pieces of the tool.
        points_T: (n, 3) vertices of the tool's hull, m.
        solid: Pieces of the solid.
        gains: Gains of the contacts.
        draw_home: Function that draws a random home.
        turn_rad: Largest turn of the tool from it.
    """

    name: str
    tool: _core.ConvexPieces
    points_T: np.ndarray
    solid: _core.ConvexPieces
    gains: Gains
    draw_home: Callable[[np.random.Generator], Home]
    turn_rad: float = 0.1

    @property
    def p_TM(self) -> np.ndarray:
        """(3,) the middle of the tool, about which torques are taken, m."""
        return (self.points_T.min(axis=0) + self.points_T.max(axis=0)) / 2

    @property
    def size_m(self) -> float:
        """L: the largest distance of a point of the tool from its middle, m."""
        return float(np.linalg.norm(self.points_T - self.p_TM, axis=1).max())


def calc_rotation(rotvec: np.ndarray) -> np.ndarray:
    """Returns the rotation (3, 3) by Rodrigues' formula."""
    angle = float(np.linalg.norm(rotvec))
    x, y, z = rotvec
    S = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    half = np.sinc(angle / (2 * np.pi))
    return np.eye(3) + np.sinc(angle / np.pi) * S + 0.5 * half * half * S @ S


def calc_compression(contacts: _core.ContactSet, tolerance_m: float) -> np.ndarray:
    """Returns the compression of each contact inside the tolerance, m."""
    return np.maximum(0.0, tolerance_m - contacts.distance)


def _approach(
    scene: WalkScene, tracker: _core.SceneTracker, home: Home, target_m: float
) -> np.ndarray | None:
    """Moves to a contact compressed by `target_m`; None if that is not possible."""
    tracker.reset()
    X = home.X_WT.copy()
    if len(tracker.query(X)):
        return None
    for _ in range(round(_LONGEST_APPROACH_M / _APPROACH_STEP_M)):
        X[:3, 3] += _APPROACH_STEP_M * home.push_W
        contacts = tracker.query(X)
        if (
            calc_compression(contacts, scene.gains.tolerance_m).max(initial=0)
            > target_m
        ):
            return X
    return None


@dataclass(frozen=True)
class Tick:
    """A step of a walk.

    Attributes:
        begins: Whether it is the first of an episode.
        X_WT: (4, 4) pose of the tool.
        contacts: Contacts at that pose.
        tracker: Tracker that found them, as it is now; copies keep its memory.
    """

    begins: bool
    X_WT: np.ndarray
    contacts: _core.ContactSet
    tracker: _core.SceneTracker


def walk(scene: WalkScene, steps: int, seed: int = 0) -> Iterator[Tick]:
    """Walks around random poses in contact, EPISODE_STEPS steps around each.

    The walk is steered by the deepest contact, so that this stays between the tolerance
    and the depth that carries the largest force of a press; it is the same however the
    contacts are used.
    """
    rng = np.random.default_rng(seed)
    t, deepest_m = (
        scene.gains.tolerance_m,
        LARGEST_FORCE_N / scene.gains.stiffness_N_per_m,
    )
    tracker = _core.SceneTracker(scene.tool, [scene.solid], t)
    done = 0
    while done < steps:
        home = scene.draw_home(rng)
        X = _approach(scene, tracker, home, rng.uniform(0.0, deepest_m))
        if X is None:
            continue
        M = scene.p_TM
        start, R_start = X[:3, :3] @ M + X[:3, 3], X[:3, :3].copy()
        out, course = -home.push_W, rng.normal(size=6)
        for i in range(min(EPISODE_STEPS, steps - done)):
            contacts = tracker.query(X)
            yield Tick(i == 0, X.copy(), contacts, tracker)
            course = _KEPT * course + np.sqrt(1 - _KEPT**2) * rng.normal(size=6)
            turn, move = course[:3].copy(), course[3:].copy()
            compression = calc_compression(contacts, t)
            if len(contacts):
                out = contacts.nhat_BA_W[np.argmax(compression)].copy()
            if compression.max(initial=0) > deepest_m:
                move += (1.0 - min(0.0, move @ out)) * out
            elif not compression.any():
                move -= (1.0 + max(0.0, move @ out)) * out
            p_WM = X[:3, :3] @ M + X[:3, 3]
            move -= 2 * _beyond(p_WM - start, _LEASH_M)
            turn -= 2 * _beyond(calc_turn(X[:3, :3] @ R_start.T), scene.turn_rad)
            X[:3, :3] = calc_rotation(STEP_M / scene.size_m * turn) @ X[:3, :3]
            X[:3, 3] = p_WM + STEP_M * move - X[:3, :3] @ M
        done += EPISODE_STEPS


def calc_turn(R: np.ndarray) -> np.ndarray:
    """Returns the rotation vector of a small turn, to first order."""
    return 0.5 * np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])


def _beyond(x: np.ndarray, leash: float) -> np.ndarray:
    """Returns the part of x beyond the leash, in lengths of it."""
    length = float(np.linalg.norm(x))
    return x / leash * max(0.0, 1 - leash / length) if length > leash else 0 * x
