"""Triangles to draw the convex pieces of a decomposition with."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from drake_haptics import _core
from drake_haptics.common.colors import VIRTUAL_FACET, piece_color


@dataclass(frozen=True, eq=False)
class ColoredTriangles:
    """Triangles that share no vertices, so that each is shaded flat.

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


def each_facet(
    pieces: Sequence[_core.ConvexPolytope],
) -> Iterator[tuple[int, bool, np.ndarray]]:
    """Yields the facets of pieces that are to be drawn, one by one.

    Of a flat piece only the front is drawn: its back is in the same place.

    Yields:
        The index of the piece, whether the facet is on the mesh (a virtual one is
        not), and the corners (3 k, 3) of its triangles, m.
    """
    for index, piece in enumerate(pieces):
        points = np.asarray(piece.vertices)
        sides = list(zip(piece.facets, piece.facet_original, strict=True))
        for loop, original in sides if piece.dimension == 3 else sides[:1]:
            fan = np.array([(loop[0], *pair) for pair in pairwise(loop[1:])])
            yield index, original, points[fan.ravel()]


def piece_surfaces(
    pieces: list[_core.ConvexPolytope],
) -> tuple[ColoredTriangles, ColoredTriangles]:
    """Returns the facets on the mesh, a color for each piece, and the virtual ones."""
    corners: tuple[list[np.ndarray], list[np.ndarray]] = ([], [])
    owners: tuple[list[int], list[int]] = ([], [])
    for index, original, points in each_facet(pieces):
        kind = 0 if original else 1
        corners[kind].append(points)
        owners[kind].append(index)
    palette = np.array([piece_color(i)[:3] for i in range(len(pieces))])
    surfaces = []
    for kind in (0, 1):
        vertices = np.concatenate([np.empty((0, 3)), *corners[kind]])
        counts = [len(points) for points in corners[kind]]
        piece_of = np.repeat(np.array(owners[kind], dtype=int), counts)
        colors = palette[piece_of] if kind == 0 else np.empty_like(vertices)
        if kind == 1:
            colors[:] = VIRTUAL_FACET[:3]
        surfaces.append(ColoredTriangles(vertices, colors, piece_of))
    return surfaces[0], surfaces[1]
