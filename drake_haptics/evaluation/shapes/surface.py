"""Closed triangle surfaces built from rings of vertices, with exact topology."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

# Shipped coordinates are rounded to a nanometre, so that the last digit of a
# platform's sine does not show in the files.
_DECIMALS = 9
# A quad whose corners are closer to a plane than this needs no choice of diagonal.
_FLAT_M = 1e-7


@dataclass(frozen=True)
class Surface:
    """A closed triangle surface, wound so that normals point out of the solid.

    Attributes:
        vertices: (n, 3) coordinates in the shape's own frame, m.
        triangles: (m, 3) int32 indices into `vertices`.
    """

    vertices: np.ndarray
    triangles: np.ndarray

    def write_obj(self, path: Path, title: str) -> None:
        """Writes the surface as a Wavefront OBJ file.

        Args:
            path: the file to write.
            title: one line for the head of the file.
        """
        lines = [
            f"# {title}",
            "# Units: meters. Made by: python -m drake_haptics.shapes",
        ]
        lines += [f"v {x:.9f} {y:.9f} {z:.9f}" for x, y, z in self.vertices]
        lines += [f"f {a} {b} {c}" for a, b, c in self.triangles + 1]
        path.write_text("\n".join(lines) + "\n", encoding="ascii")


class SurfaceBuilder:
    """Collects vertices and the bands and caps between rings of them.

    A ring is a closed sequence of vertex indices. It runs counterclockwise about the
    direction in which the surface advances (right-hand rule), which makes every band
    and cap face outwards.
    """

    def __init__(self) -> None:
        self._vertices: list[np.ndarray] = []
        self._triangles: list[tuple[int, int, int]] = []

    def add_vertex(self, p: Iterable[float]) -> int:
        """Adds one vertex at `p` (3,) m and returns its index."""
        self._vertices.append(np.round(np.asarray(tuple(p), dtype=float), _DECIMALS))
        return len(self._vertices) - 1

    def add_ring(self, points: np.ndarray) -> list[int]:
        """Adds `points` (n, 3) m and returns their indices, a ring."""
        return [self.add_vertex(p) for p in points]

    def add_band(
        self, near: Sequence[int], far: Sequence[int], holes: Collection[int] = ()
    ) -> None:
        """Joins two rings of equal length by a band of quads.

        Args:
            near: the ring the surface comes from.
            far: the ring it advances to.
            holes: columns i whose quad (near[i], near[i+1], ...) is left open.

        Raises:
            ValueError: the rings differ in length.
        """
        if len(near) != len(far):
            raise ValueError(f"rings of unlike sizes: {len(near)} and {len(far)}")
        count = len(near)
        for i in set(range(count)) - set(holes):
            j = (i + 1) % count
            self._add_quad(near[i], near[j], far[j], far[i])

    def add_fan(self, ring: Sequence[int], apex: int, *, at_start: bool) -> None:
        """Closes a ring by triangles to an apex.

        Args:
            ring: the ring to close.
            apex: index of the vertex in its middle.
            at_start: True where the surface begins, False where it ends.
        """
        for i, a in enumerate(ring):
            b = ring[(i + 1) % len(ring)]
            self._triangles.append((b, a, apex) if at_start else (a, b, apex))

    def build(self) -> Surface:
        """Returns the surface made so far, without the vertices no triangle uses."""
        used, triangles = np.unique(self._triangles, return_inverse=True)
        return Surface(
            vertices=np.array(self._vertices)[used],
            triangles=triangles.reshape(-1, 3).astype(np.int32),
        )

    def _add_quad(self, a: int, b: int, c: int, d: int) -> None:
        """Splits a quad along the diagonal that folds outwards.

        A bent quad can be a ridge or a valley. A ridge stays convex, so the convex
        decomposition needs fewer pieces.
        """
        p_a, p_b, p_c, p_d = (self._vertices[i] for i in (a, b, c, d))
        normal = np.cross(p_c - p_a, p_d - p_b)
        bend = normal @ (p_a + p_c - p_b - p_d) / 2 / np.linalg.norm(normal)
        if bend >= -_FLAT_M:
            self._triangles += [(a, b, c), (a, c, d)]
        else:
            self._triangles += [(a, b, d), (b, c, d)]


def circle(radius: float, z: float, count: int) -> np.ndarray:
    """Returns (count, 3) points, m, counterclockwise about +z at height `z`, m."""
    angle = 2 * np.pi * np.arange(count) / count
    return np.column_stack(
        [radius * np.cos(angle), radius * np.sin(angle), np.full(count, z)]
    )


def loft(
    start: Iterable[float], sections: Iterable[np.ndarray], end: Iterable[float]
) -> Surface:
    """Joins sections into a closed solid with a point at either end.

    Args:
        start: (3,) the point where the surface begins, m.
        sections: (n, 3) rings, m, counterclockwise about the direction of advance.
        end: (3,) the point where it ends, m.
    """
    builder = SurfaceBuilder()
    rings = [builder.add_ring(section) for section in sections]
    builder.add_fan(rings[0], builder.add_vertex(start), at_start=True)
    for near, far in pairwise(rings):
        builder.add_band(near, far)
    builder.add_fan(rings[-1], builder.add_vertex(end), at_start=False)
    return builder.build()


def revolve(profile: Sequence[tuple[float, float]], count: int) -> Surface:
    """Revolves an open profile about z into a closed solid.

    Args:
        profile: (radius, z) pairs, m, from the lowest point of the axis to the highest;
            the first and last radius are 0, the others positive.
        count: vertices around the axis.
    """
    (_, bottom), *walls, (_, top) = profile
    return loft((0, 0, bottom), (circle(r, z, count) for r, z in walls), (0, 0, top))
