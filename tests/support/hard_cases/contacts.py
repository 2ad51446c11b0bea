"""Hard cases of touching: coplanar, parallel and kissing features."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hard_cases.bodies import box, cone, cube, roof, tetrahedron
from hard_cases.passages import (
    NEAR_ZERO,
    Passage,
    both_ways,
    hard_case,
    kissing,
    moved,
    pose,
)


@hard_case("coplanar faces")
def coplanar() -> Iterator[Passage]:
    """Boxes side by side whose tops lie in one plane, at gaps near zero."""
    for other in (cube(), box(0.5, 0.7, 1.0), box(1.0, 1.0, 0.25)):
        top = 1 - other[:, 2].max()
        reach = 1 + other[:, 0].max()
        poses = [pose([reach + d, 0.2, top]) for d in NEAR_ZERO]
        yield from both_ways(moved(other, cube(), poses))


@hard_case("parallel faces")
def parallel_faces() -> Iterator[Passage]:
    """Boxes with two faces parallel at any yaw, apart and up to half way in."""
    rng = np.random.default_rng(1)
    for gap in (0.5, 1e-3, -1e-3, -0.2, -0.5):
        poses = [
            pose([*rng.uniform(-1, 1, 2), 1.4 + gap], [0, 0, rng.uniform(0, 6)])
            for _ in range(8)
        ]
        yield from both_ways(moved(box(0.3, 0.5, 0.4), cube(), poses))


@hard_case("parallel edges")
def parallel_edges() -> Iterator[Passage]:
    """A roof whose ridge is parallel to a cube's edges, over faces and over edges."""
    on_face = [pose([0.1, 0.2, 1 + d]) for d in NEAR_ZERO]
    yield from both_ways(moved(roof(), cube(), on_face))
    beside = [pose([0.1, y, 2**0.5 + d]) for y in (0, 1e-9, 0.1) for d in NEAR_ZERO]
    on_edge = pose(rotvec=[np.pi / 4, 0, 0])
    yield from both_ways(moved(roof(), cube(), beside, on_edge))
    slightly = [
        pose([0.1, 0.2, 1 + d], [0, t, t])
        for t in (1e-14, 1e-11, 1e-8, 1e-5)
        for d in (0.1, 0.0, -0.1)
    ]
    yield from both_ways(moved(roof(), cube(), slightly))


@hard_case("kissing vertex–vertex")
def vertex_vertex() -> Iterator[Passage]:
    """Corner on corner."""
    yield from kissing(cube(), cube(), [2, 2, 2], [1, 1, 1])
    yield from kissing(cube(), cube(), [2, 2, 2], [1, 0, 0])
    yield from kissing(cone(), cone(), [0, 0, 0], [0, 0, 1])
    tips = [pose([0, 0, d]) for d in NEAR_ZERO]
    yield from both_ways(moved(cone(), cone(), tips, pose(rotvec=[np.pi, 0, 0])))


@hard_case("kissing vertex–edge")
def vertex_edge() -> Iterator[Passage]:
    """Corner on edge."""
    yield from kissing(cone(), cube(), [0.25, 1, 1], [0, 0, 1])
    yield from kissing(cone(), cube(), [0.25, 1, 1], [0, 1, 1])


@hard_case("kissing vertex–face")
def vertex_face() -> Iterator[Passage]:
    """Corner on face, in its middle and at its rim."""
    yield from kissing(cone(), cube(), [0.25, 0.5, 1], [0, 0, 1])
    yield from kissing(cone(), cube(), [1, 0.5, 1], [0, 0, 1])
    yield from kissing(tetrahedron(), cube(), [0.5, 0.25, 2], [0, 0, 1])


@hard_case("kissing edge–edge")
def edge_edge() -> Iterator[Passage]:
    """Edges that cross, at right angles and nearly parallel, and edges end to end."""
    for yaw in (np.pi / 2, 1.0, 1e-3, 1e-6, 1e-9):
        across = [pose([0.2, 0, d]) for d in NEAR_ZERO]
        X_WB = pose(rotvec=[0, 0, yaw]) @ pose(rotvec=[np.pi, 0, 0])
        yield from both_ways(moved(roof(), roof(), across, X_WB))
    yield from kissing(cube(), cube(), [0, 2, 2], [0, 1, 1])
    yield from kissing(cube(), cube(), [0.5, 2, 2], [0, 0, 1])


@hard_case("kissing edge–face")
def edge_face() -> Iterator[Passage]:
    """Edge on face, inside it, across its rim and along its rim."""
    yield from kissing(roof(), cube(), [0.25, 0.5, 1], [0, 0, 1])
    yield from kissing(roof(), cube(), [0.75, 0.5, 1], [0, 0, 1], [0, 0, 0.5])
    yield from kissing(roof(), cube(), [0, 1, 1], [0, 0, 1])


@hard_case("kissing face–face")
def face_face() -> Iterator[Passage]:
    """Face on face at zero: aligned, turned, and sharing an edge only."""
    yield from kissing(cube(), cube(), [0, 0, 2], [0, 0, 1])
    yield from kissing(cube(), cube(), [0.5, -0.25, 2], [0, 0, 1], [0, 0, 0.7])
    yield from kissing(cube(), cube(), [2, 0, 2], [0, 0, 1])
