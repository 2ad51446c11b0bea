"""Hard cases of overlap: one body inside another, and about one center."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hard_cases.bodies import ball, blob, box, cone, cube, disc, tetrahedron
from hard_cases.passages import Passage, both_ways, hard_case, moved, pose, random_pose


@hard_case("containment")
def containment() -> Iterator[Passage]:
    """A small body anywhere inside a large one."""
    rng = np.random.default_rng(2)
    for A, B in (
        (cube(0.1), cube()),
        (ball(1, 0.1), box(1, 2, 3)),
        (cone(8, 0.05, 0.1), ball(1)),
        (blob(rng) * 0.1, disc()),
    ):
        poses = [random_pose(rng, 0.2) for _ in range(12)]
        yield from both_ways(moved(A, B, poses))


def about_center(
    A: np.ndarray, B: np.ndarray, turn: object = (0, 0, 0)
) -> Iterator[Passage]:
    """A at B's center exactly, and within fractions of round-off about it."""
    poses = [pose(rotvec=turn)] + [
        pose(np.roll([s * d, 0, 0], k), turn)
        for d in (1e-17, 1e-15, 1e-12, 1e-9, 1e-3)
        for s in (1, -1)
        for k in range(3)
    ]
    yield from both_ways(moved(A, B, poses))


@hard_case("concentric cubes")
def concentric_cubes() -> Iterator[Passage]:
    """Identical cubes, and cubes turned against each other, at one center."""
    yield from about_center(cube(), cube())
    yield from about_center(cube(), cube(), [0, 0, np.pi / 4])
    yield from about_center(cube(), cube(), [0.3, 0.5, -0.2])
    yield from about_center(cube(0.5), cube())


@hard_case("concentric balls")
def concentric_balls() -> Iterator[Passage]:
    """Identical and unlike balls at one center."""
    yield from about_center(ball(0), ball(0))
    yield from about_center(ball(0), ball(0, 0.5), [0.1, 0.2, 0.3])
    yield moved(ball(1), ball(1), [pose(), pose([1e-9, 0, 0]), pose([0, 1e-3, 0])])


@hard_case("concentric boxes")
def concentric_boxes() -> Iterator[Passage]:
    """Identical boxes, discs and tetrahedra at one center."""
    yield from about_center(box(1, 0.5, 0.25), box(1, 0.5, 0.25))
    yield from about_center(box(1, 0.5, 0.25), box(1, 0.5, 0.25), [0, 0, np.pi / 2])
    yield from about_center(disc(8), disc(8))
    yield from about_center(tetrahedron(), tetrahedron())
