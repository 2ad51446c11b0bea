"""Many contacts at once in chosen places and directions, by one real query."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from contact_samples import IDENTITY, box, decomposed, hull, spike
from mesh_samples import joined
from scipy.spatial.transform import Rotation

from drake_haptics import _core

# So far apart that nothing of one site is within reach of another.
SITE_SPACING_M = 0.2


@dataclass(frozen=True)
class Site:
    """A slab that stands somewhere of its own, and the bodies pressed into it.

    Attributes:
        R: Orientation of the slab; its top faces along z.
        tips: (n, 3) tips of spikes, in the site's frame: the last number is the
            distance.
        cubes: (n, 4) x, y and distance of the lowest corner of cubes (m), and tilt
            (rad).
        object: Index of the object that the slab belongs to.
    """

    R: Rotation
    tips: np.ndarray
    cubes: np.ndarray
    object: int = 0


def _cube(x: float, y: float, distance: float, tilt: float) -> _core.ConvexPieces:
    corners = np.array(list(product((-2e-3, 2e-3), (-2e-3, 2e-3), (0, 4e-3))))
    corners = Rotation.from_rotvec([tilt, 0.3 * tilt, 0]).apply(corners)
    corners[:, 2] -= corners[:, 2].min()
    return hull(corners + np.array([x, y, distance]))


def _placed(
    parts: Sequence[tuple[_core.ConvexPieces, Rotation, np.ndarray]],
) -> _core.ConvexPieces:
    """One body of many, each turned and moved."""
    moved = ((R.apply(part.vertices) + p, part.triangles) for part, R, p in parts)
    return decomposed(*joined(*moved))


def scatter(sites: Sequence[Site], tolerance: float) -> _core.ContactSet:
    """The contacts of all sites, one for each spike and each cube within reach."""
    slab = box([0.04, 0.04, 0.02], [0, 0, -0.01])
    tool, slabs = [], [[] for _ in range(1 + max(site.object for site in sites))]
    for i, site in enumerate(sites):
        at = SITE_SPACING_M * np.array([i % 4, i // 4 % 4, i // 16])
        slabs[site.object].append((slab, site.R, at))
        tool += [(spike(tip), site.R, at) for tip in site.tips]
        tool += [(_cube(*cube), site.R, at) for cube in site.cubes]
    objects = [_placed(parts) for parts in slabs]
    return _core.SceneTracker(_placed(tool), objects, tolerance).query(IDENTITY)


def random_sites(
    rng: np.random.Generator, count: int, t: float, num_objects: int = 1
) -> list[Site]:
    """Sites of a few presses each, many alike in direction, depth or place."""
    base = Rotation.random(random_state=int(rng.integers(1 << 31)))
    sites = []
    for i in range(count):
        angle = rng.choice([0.0, 0.02, 0.04, 0.5, np.pi / 2, np.pi])
        axis = rng.normal(size=3)
        turn = Rotation.from_rotvec(angle * axis / np.linalg.norm(axis))
        depth = rng.uniform(-0.8, 0.9) * t
        num_tips, num_cubes = rng.integers(0, 4), rng.integers(0, 3)
        tips = np.column_stack(
            [
                rng.uniform(-1, 1, (num_tips, 2)) * rng.choice([0.5 * t, 0.012]),
                depth + rng.choice([0, 0.03, 0.4]) * t * rng.normal(size=num_tips),
            ]
        )
        cubes = np.column_stack(
            [
                rng.uniform(-0.015, 0.015, (num_cubes, 2)),
                depth + 0.03 * t * rng.normal(size=num_cubes),
                rng.choice([0, 0.01, 0.03, 0.06], num_cubes),
            ]
        )
        if num_tips + num_cubes == 0:
            tips = np.array([[0, 0, depth]])
        sites.append(Site(turn * base, tips, cubes, i % num_objects))
    return sites
