"""Hard cases of shape: slivers, flat hulls, near-duplicates, great aspect."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator

import numpy as np

from hard_cases.bodies import FLAT, blob, box, cube
from hard_cases.passages import (
    NEAR_ZERO,
    Passage,
    both_ways,
    hard_case,
    moved,
    pose,
    wander,
)


@hard_case("slivers")
def slivers() -> Iterator[Passage]:
    """Needle and blade tetrahedra down to a thickness of 1e-9 of their length."""
    for seed, thin in enumerate((1e-3, 1e-6, 1e-9)):
        blade = np.array([[0, 0, 0], [1, 0, 0], [0.5, 0.5, 0], [0.5, 0.2, thin]])
        needle = np.array([[0, 0, 0], [1, 0, 0], [1, thin, 0], [1, 0, thin]])
        cap = np.array([[0, 0, 0], [1, 0, 0], [0.5, thin, 0], [0.5, 0, thin]])
        for A, B in itertools.combinations((blade, needle, cap, cube(0.5)), 2):
            yield from wander(A, B, seed, 0.3)
        yield from wander(blade, blade, seed + 10, 0.2)


def flat_case(first: str, second: str) -> Callable[[], Iterator[Passage]]:
    """All relations of two flat hulls."""

    def make() -> Iterator[Passage]:
        A = FLAT[first]
        B = cube() if second == "solid" else FLAT[second]
        yield from wander(A, B, 3, 0.3, 16)
        # In one plane, overlapping, touching and beside each other; then crossing it.
        slides = [pose([x, 0.05, 0]) for x in (0, 0.3, 1.0, 2.5)]
        slides += [pose([x, 0, 0], [0, 0, np.pi]) for x in (0, 0.7, 1.4, 1.5, 1.6, 3)]
        slides += [pose([0.1, 0, z]) for z in NEAR_ZERO]
        slides += [
            pose([0, 0, 0.2 * z], [t, 0, 0])
            for z in (-1, 0, 1)
            for t in (1e-12, 1e-6, 0.5, np.pi / 2)
        ]
        yield from both_ways(moved(A, B, slides))

    return make


for _first, _second in itertools.combinations_with_replacement(FLAT, 2):
    hard_case(f"flat: {_first}–{_second}")(flat_case(_first, _second))
for _first in FLAT:
    hard_case(f"flat: {_first}–solid")(flat_case(_first, "solid"))


@hard_case("near-duplicate vertices")
def near_duplicates() -> Iterator[Passage]:
    """Each vertex twice, at distances from a micrometer down to round-off."""
    rng = np.random.default_rng(4)
    for k, apart in enumerate((1e-6, 1e-9, 1e-12, 1e-15, 1e-16)):
        A = np.concatenate([cube(), cube() + apart * rng.normal(size=(8, 3))])
        B = blob(rng, 7)
        B = np.concatenate([B, B + apart * rng.normal(size=B.shape)])
        yield from wander(A, B, k, 1.2)
        yield from wander(A, cube(), k, 1.2)
        poses = [pose([0.3, 0.1, 2 + d]) for d in NEAR_ZERO]
        yield from both_ways(moved(A, cube(), poses))


@hard_case("aspect 1e6")
def aspect() -> Iterator[Passage]:
    """Rods and plates a million times as long as they are thick."""
    rod, plate = box(1, 1e-6, 1e-6), box(1, 1, 1e-6)
    for k, (A, B) in enumerate(
        ((rod, rod), (rod, plate), (plate, plate), (rod, cube(0.5)), (plate, cube(0.5)))
    ):
        yield from wander(A, B, k, 0.3)
        poses = [pose([0.1, 0.05, z]) for z in (0, 1e-7, 1e-6, 2e-6, 3e-6, 1e-3)]
        poses += [pose([0.1, 0.05, 1e-6], [0, t, 0.1]) for t in (1e-9, 1e-6, 1e-3)]
        yield from both_ways(moved(A, B, poses))
