"""Builds closed triangle surfaces from rings of vertices, with exact topology."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

# Shipped coordinates are rounded to a nanometer, so that the last digit of a
# platform's sine does not show in the files.
_DECIMALS = 9
# A quad whose corners are closer to a plane than this needs no choice of diagonal.
_FLAT_M = 1e-7
# Two bends may follow each other at once.
_NO_LENGTH_M = 1e-9


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
            path: The file to write.
            title: One line for the head of the file.
        """
        lines = [
            f"# {title}",
            "# Units: meters. Made by: python docs/generate/make_meshes.py",
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
            near: The ring that the surface comes from.
            far: The ring that it advances to.
            holes: Columns i whose quad (near[i], near[i+1], ...) is left open.

        Raises:
            ValueError: The rings differ in length.
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
            ring: The ring to close.
            apex: Index of the vertex in its middle.
            at_start: True where the surface begins, False where it ends.
        """
        for i, a in enumerate(ring):
            b = ring[(i + 1) % len(ring)]
            self._triangles.append((b, a, apex) if at_start else (a, b, apex))

    def add_tube(
        self,
        sections: Iterable[np.ndarray],
        *,
        rim: Sequence[int] | None = None,
        start: Iterable[float] | None = None,
        end: Iterable[float] | None = None,
        holes: Callable[[int], Collection[int]] = lambda row: (),
    ) -> list[Sequence[int]]:
        """Adds rings with bands between them and returns the rings.

        Args:
            sections: (n, 3) points of each ring, m.
            rim: A ring of the surface that the tube goes on from, row 0.
            start: (3,) point where the tube begins, m. Defaults to an open beginning.
            end: (3,) point where it ends, m. Defaults to an open end.
            holes: Function that returns the columns that the band after a row leaves
                open.
        """
        rings = [] if rim is None else [rim]
        rings += map(self.add_ring, sections)
        if start is not None:
            self.add_fan(rings[0], self.add_vertex(start), at_start=True)
        for row, (near, far) in enumerate(pairwise(rings)):
            self.add_band(near, far, holes(row))
        if end is not None:
            self.add_fan(rings[-1], self.add_vertex(end), at_start=False)
        return rings

    def build(self) -> Surface:
        """Returns the surface made so far, without vertices that no triangle uses."""
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
    builder.add_tube(sections, start=start, end=end)
    return builder.build()


def revolve(profile: Sequence[tuple[float, float]], count: int) -> Surface:
    """Revolves an open profile about z into a closed solid.

    Args:
        profile: (radius, z) pairs, m, from the lowest point of the axis to the highest;
            the first and last radius are 0, the others positive.
        count: Vertices around the axis.
    """
    (_, bottom), *walls, (_, top) = profile
    return loft((0, 0, bottom), (circle(r, z, count) for r, z in walls), (0, 0, top))


def opening_loop(rings: Sequence[Sequence[int]], columns: Sequence[int]) -> list[int]:
    """Returns the rim of an opening, a ring for a branch that leaves the surface.

    It runs counterclockwise about the outward normal; for a branch that arrives, run
    through it backwards. The quads between the rings are to be left open: `holes` of
    `SurfaceBuilder.add_band` are `columns` without the last.

    Args:
        rings: The rings that the opening begins and ends at, and those between, in the
            order of the surface's advance.
        columns: Columns of those rings, from one side of the opening to the other.
    """
    first, last = columns[0], columns[-1]
    return [
        *(rings[0][c] for c in columns[:-1]),
        *(ring[last] for ring in rings[:-1]),
        *(rings[-1][c] for c in columns[:0:-1]),
        *(ring[first] for ring in rings[:0:-1]),
    ]


@dataclass(frozen=True)
class SmoothPath:
    """A smooth path, sampled.

    Attributes:
        points: (n, 3), m.
        tangents: (n, 3) unit vectors along the path.
    """

    points: np.ndarray
    tangents: np.ndarray

    def frames(self, normal: np.ndarray) -> np.ndarray:
        """Returns (n, 3, 3) frames that turn about the path no more than they must.

        Args:
            normal: (3,) direction of the first frame's x axis, which lies in the plane
                of this vector and the first tangent, and on the same side.

        Returns:
            Rotations whose columns are x, y and the tangent.
        """
        x = normal - (normal @ self.tangents[0]) * self.tangents[0]
        frames = [_make_frame(x, self.tangents[0])]
        for before, after in pairwise(self.tangents):
            # The least turn that takes one tangent to the next.
            axis, cosine = np.cross(before, after), before @ after
            x = frames[-1][:, 0]
            x = cosine * x + np.cross(axis, x) + axis * (axis @ x) / (1 + cosine)
            frames.append(_make_frame(x, after))
        return np.array(frames)


def rounded_path(
    corners: np.ndarray, bend_radius: float, *, bend_steps: int, step: float = np.inf
) -> SmoothPath:
    """Returns the path along straight lines with rounded corners.

    Args:
        corners: (k, 3) ends and corners, m. The lines between them must be long
            enough for the bends.
        bend_radius: Radius of the arcs at the corners, m.
        bend_steps: Steps per quarter turn of an arc, at least one per arc.
        step: The longest step on a straight line, m.
    """
    corners = np.asarray(corners, dtype=float)
    directions = np.diff(corners, axis=0)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    points, tangents = [corners[0]], [directions[0]]

    def go_straight(end: np.ndarray, direction: np.ndarray) -> None:
        start = points[-1]
        length = np.linalg.norm(end - start)
        if length < _NO_LENGTH_M:
            return
        count = max(1, int(np.ceil(length / step - 1e-9)))
        for k in range(1, count + 1):
            points.append(start + (end - start) * k / count)
            tangents.append(direction)

    for corner, before, after in zip(
        corners[1:-1], directions[:-1], directions[1:], strict=True
    ):
        angle = np.arccos(np.clip(before @ after, -1, 1))
        inset = bend_radius * np.tan(angle / 2)
        go_straight(corner - inset * before, before)
        inward = after - (after @ before) * before
        inward /= np.linalg.norm(inward)
        start = points[-1]
        count = max(1, round(bend_steps * angle / (np.pi / 2)))
        for turn in angle * np.arange(1, count + 1) / count:
            c, s = np.cos(turn), np.sin(turn)
            points.append(start + bend_radius * (s * before + (1 - c) * inward))
            tangents.append(c * before + s * inward)
    go_straight(corners[-1], directions[-1])
    return SmoothPath(np.array(points), np.array(tangents))


def sweep_tube(
    path: SmoothPath, normal: np.ndarray, radius: float, count: int
) -> Surface:
    """Returns a round solid along a path, with flat ends.

    Args:
        path: The axis.
        normal: (3,) direction of the first vertex, as in `SmoothPath.frames`.
        radius: Radius, m.
        count: Vertices around the axis.
    """
    angle = 2 * np.pi * np.arange(count) / count
    section = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    rings = (
        p + section @ frame[:, :2].T
        for p, frame in zip(path.points, path.frames(normal), strict=True)
    )
    return loft(path.points[0], rings, path.points[-1])


def _make_frame(x: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Returns a rotation with the tangent z and x made normal to it."""
    x = x - (x @ z) * z
    x = x / np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])
