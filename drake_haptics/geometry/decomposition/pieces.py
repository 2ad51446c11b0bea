"""Represents convex pieces of a mesh as data to store and as triangles to draw."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from drake_haptics import _core
from drake_haptics.common.colors import VIRTUAL_FACET, piece_color
from drake_haptics.geometry.mesh.mesh import Mesh


@dataclass(frozen=True, eq=False)
class PatchLabels:
    """Pieces that are patches of the mesh's surface.

    Attributes:
        piece_of_triangle: (m,) int32 in [0, number of pieces).
        seconds: Time that the search took, s.
    """

    piece_of_triangle: np.ndarray
    seconds: float

    def assemble(self, mesh: Mesh) -> _core.ConvexPieces:
        """Makes the pieces without a search."""
        return _core.assemble_surface_pieces(
            mesh.vertices, mesh.triangles, self.piece_of_triangle
        )

    def fits(self, mesh: Mesh) -> bool:
        """Returns whether the labels can belong to the mesh."""
        return _are_labels(self.piece_of_triangle, len(mesh.triangles))


@dataclass(frozen=True, eq=False)
class MergedPatches:
    """Pieces that are hulls of several patches of the mesh's surface.

    Attributes:
        piece_of_triangle: (m,) int32 patch of each triangle.
        group_of_piece: (k,) int32 group of each patch: patches of one group are one
            piece.
        error_m: Allowed departure from the mesh, m.
        departure_m: Bound on the actual largest departure, m.
        seconds: Time that the search took, s.
    """

    piece_of_triangle: np.ndarray
    group_of_piece: np.ndarray
    error_m: float
    departure_m: float
    seconds: float

    def assemble(self, mesh: Mesh) -> _core.ConvexPieces:
        """Makes the pieces without a search."""
        return _core.assemble_merged_pieces(
            mesh.vertices,
            mesh.triangles,
            mesh.solid,
            self.piece_of_triangle,
            self.group_of_piece,
            self.error_m,
        )

    def fits(self, mesh: Mesh) -> bool:
        """Returns whether the labels can belong to the mesh."""
        labels = self.piece_of_triangle
        return (
            _are_labels(labels, len(mesh.triangles))
            and _are_labels(self.group_of_piece, int(labels.max()) + 1)
            and 0.0 <= self.error_m < np.inf
        )


def _are_labels(labels: np.ndarray, count: int) -> bool:
    """Returns whether an array has `count` labels from 0 without gaps."""
    if labels.dtype != np.int32 or labels.shape != (count,) or labels.min() < 0:
        return False
    return bool((np.bincount(labels, minlength=1) > 0).all())


@dataclass(frozen=True, eq=False)
class ConvexHulls:
    """Pieces that are hulls of points.

    Attributes:
        hull_points: (p, 3) points of all hulls, m.
        hull_start: (k + 1,) int32: hull i has the points from hull_start[i] to
            hull_start[i + 1].
        tolerance: Distance within which a hull's facet counts as on the mesh, m;
            infinite if the hulls replace the mesh.
        seconds: Time that it took to make them, s.
    """

    hull_points: np.ndarray
    hull_start: np.ndarray
    tolerance: float
    seconds: float

    @staticmethod
    def of(hulls: list[np.ndarray], tolerance: float, seconds: float) -> ConvexHulls:
        """Packs the points of hulls, each (n_i, 3)."""
        start = np.cumsum([0, *map(len, hulls)]).astype(np.int32)
        points = np.ascontiguousarray(np.concatenate(hulls), dtype=np.float64)
        return ConvexHulls(points, start, tolerance, seconds)

    def assemble(self, mesh: Mesh) -> _core.ConvexPieces:
        """Makes the pieces, and finds which of their facets are on the mesh."""
        hulls = [
            self.hull_points[a:b]
            for a, b in zip(self.hull_start[:-1], self.hull_start[1:], strict=True)
        ]
        return _core.adopt_convex_pieces(
            mesh.vertices, mesh.triangles, hulls, self.tolerance
        )

    def fits(self, mesh: Mesh) -> bool:
        """Returns whether the hulls are well formed; they may fit any mesh."""
        return bool(
            self.hull_points.dtype == np.float64
            and self.hull_points.ndim == 2
            and self.hull_points.shape[1] == 3
            and np.isfinite(self.hull_points).all()
            and self.hull_start.dtype == np.int32
            and self.hull_start.ndim == 1
            and len(self.hull_start) >= 2
            and self.hull_start[0] == 0
            and self.hull_start[-1] == len(self.hull_points)
            and (np.diff(self.hull_start) > 0).all()
            and self.tolerance > 0
        )


PieceData = PatchLabels | MergedPatches | ConvexHulls


@dataclass(frozen=True, eq=False)
class ColoredTriangles:
    """Triangles that share no vertices, so that shading is flat.

    Attributes:
        vertices: (3 k, 3), m.
        colors: (3 k, 3) red, green, blue in [0, 1].
        piece: (3 k,) piece of each vertex.
    """

    vertices: np.ndarray
    colors: np.ndarray
    piece: np.ndarray

    @property
    def faces(self) -> np.ndarray:
        """(k, 3) indices into the vertices."""
        return np.arange(len(self.vertices)).reshape(-1, 3)


def cut_fans(facets: Iterable[Sequence[int]]) -> np.ndarray:
    """Returns the triangles (k, 3) int32 of facets with these vertices in order."""
    fans = [(loop[0], a, b) for loop in facets for a, b in pairwise(loop[1:])]
    return np.array(fans, dtype=np.int32)


def each_facet(
    pieces: Sequence[_core.ConvexPolytope],
) -> Iterator[tuple[int, bool, np.ndarray]]:
    """Yields the facets of pieces to draw.

    Only the front of a flat piece is drawn, because its back is in the same place.

    Yields:
        The index of the piece, whether the facet is on the mesh (a virtual one is
        not), and the corners (3 k, 3) of its triangles, m.
    """
    for index, piece in enumerate(pieces):
        points = np.asarray(piece.vertices)
        sides = list(zip(piece.facets, piece.facet_original, strict=True))
        for loop, original in sides if piece.dimension == 3 else sides[:1]:
            yield index, original, points[cut_fans([loop]).ravel()]


def piece_surfaces(
    pieces: list[_core.ConvexPolytope],
) -> tuple[ColoredTriangles, ColoredTriangles]:
    """Returns the facets on the mesh, colored by piece, and the virtual ones."""
    facets = list(each_facet(pieces))
    palette = np.array([piece_color(i)[:3] for i in range(len(pieces))])

    def gather(original: bool) -> tuple[np.ndarray, np.ndarray]:
        own = [(points, index) for index, kind, points in facets if kind == original]
        vertices = np.concatenate([np.empty((0, 3)), *(points for points, _ in own)])
        owners = [index for points, index in own for _ in points]
        return vertices, np.array(owners, dtype=int)

    (on_mesh, piece), (virtual, other) = gather(True), gather(False)
    gray = np.tile(VIRTUAL_FACET[:3], (len(virtual), 1))
    return (
        ColoredTriangles(on_mesh, palette[piece], piece),
        ColoredTriangles(virtual, gray, other),
    )
