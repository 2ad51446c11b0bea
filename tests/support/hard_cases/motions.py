"""Hard motions of a pair: passages whose poses follow each other closely."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hard_cases.bodies import ball, blob, box, cone, cube, disc, roof
from hard_cases.passages import Passage, both_ways, hard_case, moved, pose


@hard_case("tumbling through alignment")
def tumbling() -> Iterator[Passage]:
    """A cube over and in a cube, turning through the poses where faces are parallel."""
    near = np.array([1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-15])
    angles = [*-near, 0.0, *near[::-1]]
    for axis in ([1, 0, 0], [0.6, 0.8, 0], [0.5, 0.3, 0.2]):
        for height in (2.5, 2.0, 1.9, 1.0):
            poses = [pose([0.1, 0.2, height], t * np.array(axis)) for t in angles]
            yield from both_ways(moved(cube(), cube(), poses))


@hard_case("precessing disc")
def precessing() -> Iterator[Passage]:
    """A disc that wobbles on a plate like a coin, above it and pressed into it."""
    plate = box(2, 2, 0.5)
    for tilt in (1e-9, 1e-6, 1e-3, 0.05):
        for height in (0.61, 0.6, 0.59):
            poses = [
                pose([0, 0, height], [tilt * np.cos(t), tilt * np.sin(t), 0])
                for t in np.linspace(0, 2 * np.pi, 33)
            ]
            yield moved(disc(), plate, poses)
            yield moved(disc(), plate, [X @ pose(rotvec=[0, 0, 0.01]) for X in poses])


@hard_case("sliding over an edge")
def over_an_edge() -> Iterator[Passage]:
    """A cube, a ball and a roof, pressed in, slide over a cube's edge and corner."""
    for A, low in ((cube(0.3), 0.3), (ball(1, 0.3), 0.3), (roof(0.3, 0.2, 0.2), 0.0)):
        for depth in (1e-3, 0.05):
            for y in (0.1, 1.0):
                poses = [
                    pose([x, y, 1 + low - depth], [0.0, 0.0, 0.3])
                    for x in np.linspace(0.5, 1.5, 25)
                ]
                yield moved(A, cube(), poses)
                tilted = [X @ pose(rotvec=[0.2, 0.3, 0]) for X in poses]
                yield moved(A, cube(), tilted)


@hard_case("tight peg in hole")
def peg() -> Iterator[Passage]:
    """A peg beside each wall of a hole at micrometers of clearance, rocking in it."""
    rng = np.random.default_rng(10)
    clearance = 1e-6
    pegs = (box(0.01, 0.01, 0.05), disc(16, 0.01, 0.05))
    wall = box(0.02, 0.005, 0.03)
    for body in pegs:
        reach = body[:, 1].max() + 0.005 + clearance
        poses = []
        for z in np.linspace(0.07, 0, 40):
            lateral = rng.uniform(-1.5, 1.5, 2) * clearance
            tilt = rng.uniform(-1, 1, 3) * clearance / 0.05
            poses.append(pose([*lateral, z], tilt))
        for quarter in range(4):
            turn = pose(rotvec=[0, 0, quarter * np.pi / 2])
            yield moved(body, wall, poses, turn @ pose([0, reach, 0]))


@hard_case("thin plate pushed through")
def plate() -> Iterator[Passage]:
    """A thin plate goes into a cube and out at the other side, flat and on edge."""
    for thin in (1e-2, 1e-6):
        leaf = box(0.5, 0.5, thin)
        for turn in ([0, 0, 0], [0, np.pi / 2, 0], [0.1, 0.2, 0.3]):
            poses = [pose([0.05, 0.02, z], turn) for z in np.linspace(1.7, -1.7, 69)]
            yield moved(leaf, cube(), poses)
            yield moved(cone(), leaf, poses)


@hard_case("through the symmetric center")
def through_center() -> Iterator[Passage]:
    """A body goes straight through the center of its like."""
    for A, B in (
        (cube(), cube()),
        (ball(0), ball(0)),
        (disc(8), disc(8)),
        (cube(0.5), cube()),
    ):
        for line in ([1, 0, 0], [1, 1, 0], [1, 0.3, 0.2]):
            u = np.array(line) / np.linalg.norm(line)
            way = np.linspace(-2.5, 2.5, 41)
            yield moved(A, B, [pose(s * u) for s in way])
            yield moved(A, B, [pose(s * u, [0.1 * s, 0.2, 0]) for s in way])


@hard_case("grazing")
def grazing() -> Iterator[Passage]:
    """Bodies pass over a cube's top, and along its edge, at nearly no distance."""
    for A in (ball(1, 0.5), cube(0.5), cone()):
        lowest = -A[:, 2].min()
        for d in (1e-3, 1e-9, 1e-12, 0.0, -1e-12, -1e-9):
            for y in (0.2, 1.0):
                poses = [pose([x, y, 1 + lowest + d]) for x in np.linspace(-2, 2, 25)]
                yield moved(A, cube(), poses)


@hard_case("micrometer jitter")
def jitter() -> Iterator[Passage]:
    """A resting body shakes by micrometers in place and microradians in turn."""
    rng = np.random.default_rng(11)
    for A in (cube(0.05), disc(16, 0.05, 0.01), blob(rng) * 0.05):
        rest = -A[:, 2].min() + 1
        for level in (1e-6, 0.0, -1e-6, -1e-3):
            poses = [
                pose(
                    rng.normal(size=3) * 1e-6 + [0.3, 0.2, rest + level],
                    1e-6 * rng.normal(size=3),
                )
                for _ in range(60)
            ]
            yield moved(A, cube(), poses)
