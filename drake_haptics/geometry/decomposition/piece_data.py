"""What is stored of a decomposition: enough to make its pieces again at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drake_haptics import _core
from drake_haptics.geometry.mesh.mesh import Mesh


@dataclass(frozen=True, eq=False)
class PatchLabels:
    """Pieces that are patches of the mesh's surface.

    Attributes:
        piece_of_triangle: (m,) int32 in [0, number of pieces).
        seconds: that the search took, s.
    """

    piece_of_triangle: np.ndarray
    seconds: float

    def assemble(self, mesh: Mesh) -> _core.Decomposition:
        """Makes the pieces, without the search."""
        return _core.assemble_surface_pieces(
            mesh.vertices, mesh.triangles, self.piece_of_triangle
        )

    def fits(self, mesh: Mesh) -> bool:
        """Tells whether the labels can belong to the mesh."""
        return _are_labels(self.piece_of_triangle, len(mesh.triangles))


@dataclass(frozen=True, eq=False)
class MergedPatches:
    """Pieces that are hulls of several patches of the mesh's surface.

    Attributes:
        piece_of_triangle: (m,) int32 of the patches.
        group_of_piece: (k,) int32: patches of one group are one piece.
        error_m: allowed departure from the mesh, m.
        departure_m: bound on the largest departure that there is, m.
        seconds: that the search took, s.
    """

    piece_of_triangle: np.ndarray
    group_of_piece: np.ndarray
    error_m: float
    departure_m: float
    seconds: float

    def assemble(self, mesh: Mesh) -> _core.Decomposition:
        """Makes the pieces, without the search."""
        return _core.assemble_merged_pieces(
            mesh.vertices,
            mesh.triangles,
            mesh.solid,
            self.piece_of_triangle,
            self.group_of_piece,
            self.error_m,
        )

    def fits(self, mesh: Mesh) -> bool:
        """Tells whether the labels can belong to the mesh."""
        labels = self.piece_of_triangle
        return (
            _are_labels(labels, len(mesh.triangles))
            and _are_labels(self.group_of_piece, int(labels.max()) + 1)
            and 0.0 <= self.error_m < np.inf
        )


def _are_labels(labels: np.ndarray, count: int) -> bool:
    """Whether an array is one of `count` numbers from 0 without gaps."""
    if labels.dtype != np.int32 or labels.shape != (count,) or labels.min() < 0:
        return False
    return bool((np.bincount(labels, minlength=1) > 0).all())


@dataclass(frozen=True, eq=False)
class ConvexHulls:
    """Pieces that were made elsewhere, as the points that they are the hulls of.

    Attributes:
        points: (p, 3) of all hulls, m.
        start: (k + 1,) int32: hull i has the points start[i] to start[i + 1].
        tolerance: within which a hull's facet is on the mesh, m; infinite where the
            hulls take the place of the mesh.
        seconds: that making them took, s.
    """

    points: np.ndarray
    start: np.ndarray
    tolerance: float
    seconds: float

    @staticmethod
    def of(hulls: list[np.ndarray], tolerance: float, seconds: float) -> ConvexHulls:
        """Packs the hulls' points, each (n_i, 3)."""
        start = np.cumsum([0, *map(len, hulls)]).astype(np.int32)
        points = np.ascontiguousarray(np.concatenate(hulls), dtype=np.float64)
        return ConvexHulls(points, start, tolerance, seconds)

    def assemble(self, mesh: Mesh) -> _core.Decomposition:
        """Makes the pieces and finds out which of their facets are on the mesh."""
        hulls = [
            self.points[a:b]
            for a, b in zip(self.start[:-1], self.start[1:], strict=True)
        ]
        return _core.adopt_convex_pieces(
            mesh.vertices, mesh.triangles, hulls, self.tolerance
        )

    def fits(self, mesh: Mesh) -> bool:
        """Tells whether the hulls are well formed; they may fit any mesh."""
        return bool(
            self.points.dtype == np.float64
            and self.points.ndim == 2
            and self.points.shape[1] == 3
            and np.isfinite(self.points).all()
            and self.start.dtype == np.int32
            and self.start.ndim == 1
            and len(self.start) >= 2
            and self.start[0] == 0
            and self.start[-1] == len(self.points)
            and (np.diff(self.start) > 0).all()
            and self.tolerance > 0
        )


PieceData = PatchLabels | MergedPatches | ConvexHulls
