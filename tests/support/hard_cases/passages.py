"""What a hard case consists of, and the helpers that make one."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation


@dataclass
class Passage:
    """Two vertex sets (m), and poses X_WA, X_WB (n, 4, 4) that are asked in order."""

    A: np.ndarray
    B: np.ndarray
    X_WA: np.ndarray
    X_WB: np.ndarray


HARD_CASES: dict[str, Callable[[], Iterator[Passage]]] = {}


def hard_case(name: str) -> Callable:
    """Registers a generator of passages under its name in the table."""

    def register(make: Callable[[], Iterator[Passage]]) -> Callable:
        HARD_CASES[name] = make
        return make

    return register


def pose(p: object = (0, 0, 0), rotvec: object = (0, 0, 0)) -> np.ndarray:
    """A pose (4, 4) from a position (m) and a rotation vector (rad)."""
    X = np.eye(4)
    if np.any(rotvec):
        X[:3, :3] = Rotation.from_rotvec(np.asarray(rotvec, float)).as_matrix()
    X[:3, 3] = p
    return X


def random_pose(rng: np.random.Generator, spread: float = 0.0) -> np.ndarray:
    """Any rotation, and a position of that spread (m)."""
    rotvec = Rotation.from_quat(rng.normal(size=4)).as_rotvec()
    return pose(spread * rng.normal(size=3), rotvec)


def moved(
    A: np.ndarray,
    B: np.ndarray,
    poses: list[np.ndarray],
    X_WB: np.ndarray | None = None,
) -> Passage:
    """A moves; B stays, at the identity if no pose is given."""
    X_WA = np.array(poses)
    still = np.eye(4) if X_WB is None else X_WB
    return Passage(A, B, X_WA, np.broadcast_to(still, X_WA.shape))


def seen_from(passage: Passage, X_WF: np.ndarray) -> Passage:
    """The same passage with its world posed by X_WF: no number stays round."""
    return Passage(passage.A, passage.B, X_WF @ passage.X_WA, X_WF @ passage.X_WB)


def both_ways(passage: Passage) -> Iterator[Passage]:
    """The passage, with the bodies exchanged, and both in a world at a slant."""
    swapped = Passage(passage.B, passage.A, passage.X_WB, passage.X_WA)
    slant = pose([0.3, -0.2, 0.7], [0.4, -1.1, 0.8])
    for each in (passage, swapped):
        yield each
        yield seen_from(each, slant)


NEAR_ZERO = [s * d for d in (0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3) for s in (1, -1)]


def kissing(
    A: np.ndarray, B: np.ndarray, at: object, n: object, rotvec: object = (0, 0, 0)
) -> Iterator[Passage]:
    """A at position `at` (m), moved along n by amounts near zero."""
    poses = [pose(np.add(at, d * np.asarray(n)), rotvec) for d in NEAR_ZERO]
    yield from both_ways(moved(A, B, poses))


def wander(
    A: np.ndarray, B: np.ndarray, seed: int, reach: float, count: int = 12
) -> Iterator[Passage]:
    """Random poses of both, so that about half of them overlap."""
    rng = np.random.default_rng(seed)
    X_WA = np.array([random_pose(rng, reach) for _ in range(count)])
    X_WB = np.array([random_pose(rng) for _ in range(count)])
    yield Passage(A, B, X_WA, X_WB)
    yield Passage(B, A, X_WB, X_WA)
