"""Hard cases of number: scales, offsets, tiny depths; and teleports."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.spatial import ConvexHull

from hard_cases.bodies import ball, blob, cube, disc, polygon
from hard_cases.passages import (
    Passage,
    both_ways,
    hard_case,
    kissing,
    moved,
    pose,
    random_pose,
    wander,
)


def scaled(passage: Passage, factor: float) -> Passage:
    """The passage in another unit of length."""
    X_WA, X_WB = passage.X_WA.copy(), passage.X_WB.copy()
    X_WA[:, :3, 3] *= factor
    X_WB[:, :3, 3] *= factor
    return Passage(factor * passage.A, factor * passage.B, X_WA, X_WB)


def mixture(seed: int) -> Iterator[Passage]:
    """A bit of everything: random poses of random bodies, cubes near zero."""
    rng = np.random.default_rng(seed)
    yield from wander(blob(rng), blob(rng), seed, 1.0)
    yield from kissing(cube(), cube(), [0.5, -0.25, 2], [0, 0, 1], [0, 0, 0.7])


for _exponent in (-6, -3, 3, 6):

    @hard_case(f"scale 1e{_exponent} m")
    def scale(factor: float = 10.0**_exponent) -> Iterator[Passage]:
        """Both bodies in that size."""
        for passage in mixture(5):
            yield scaled(passage, factor)


@hard_case("sizes 1e-6 against 1e6 m")
def unlike_sizes() -> Iterator[Passage]:
    """A grain at a mountain: near its faces, edges and corners."""
    for ratio in (1e3, 1e6):
        rng = np.random.default_rng(6)
        for A in (cube(1 / ratio), blob(rng) / ratio):
            poses = [
                pose([x * ratio, y * ratio, ratio + z / ratio], rng.normal(size=3))
                for x, y in ((0.3, 0.4), (1, 0.2), (1, 1))
                for z in (-2, -0.5, 0.0, 0.5, 2, 10)
            ]
            yield from both_ways(moved(A, cube(ratio), poses))


@hard_case("offset 1e6 m")
def offset() -> Iterator[Passage]:
    """Both bodies a thousand kilometers from the origin."""
    for passage in mixture(7):
        X_WA, X_WB = passage.X_WA.copy(), passage.X_WB.copy()
        for X in (X_WA, X_WB):
            X[:, :3, 3] += [1e6, -1e6, 1e6]
        yield Passage(passage.A, passage.B, X_WA, X_WB)


@hard_case("depth 1e-12 m")
def tiny_depths() -> Iterator[Passage]:
    """Random bodies brought to within 1e-12 m of touching, by the exact distance."""
    rng = np.random.default_rng(8)
    for _ in range(10):
        A, B = blob(rng), blob(rng)
        X_WA, X_WB = random_pose(rng), random_pose(rng)
        X_WA[:3, 3] = brought_to_touch(A, B, X_WA, X_WB, rng.normal(size=3))
        poses = []
        for d in (1e-12, -1e-12, 1e-13, -1e-13, 1e-11, -1e-11, 1e-14, -1e-14):
            X = X_WA.copy()
            X[:3, 3] += d * X[:3, 3] / np.linalg.norm(X[:3, 3])
            poses.append(X)
        yield Passage(A, B, np.array(poses), np.array([X_WB] * len(poses)))


def brought_to_touch(
    A: np.ndarray, B: np.ndarray, X_WA: np.ndarray, X_WB: np.ndarray, along: np.ndarray
) -> np.ndarray:
    """Where on a ray from B's origin A's origin is when they touch, to round-off."""
    a, b = A @ X_WA[:3, :3].T, B @ X_WB[:3, :3].T
    hull = ConvexHull((b[:, None] - a[None]).reshape(-1, 3))
    n, offset = hull.equations[:, :3], hull.equations[:, 3]
    rate = n @ along
    return along * (-offset[rate > 0] / rate[rate > 0]).min()


@hard_case("teleports")
def teleports() -> Iterator[Passage]:
    """Each pose far from the last one in place and in turn."""
    rng = np.random.default_rng(9)
    for A, B in (
        (blob(rng), blob(rng)),
        (cube(), ball(1)),
        (disc(), cube()),
        (polygon(), cube()),
    ):
        poses = [
            random_pose(rng, 10.0 ** rng.uniform(-3, 3 if k % 2 else 0))
            for k in range(40)
        ]
        yield moved(A, B, poses)
