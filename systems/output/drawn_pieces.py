"""The convex pieces of a mesh in Meshcat, sent a little at a time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from pydrake.geometry import Meshcat

from drake_haptics._core import ConvexPolytope
from drake_haptics.common.colors import VIRTUAL_FACET, piece_color
from drake_haptics.geometry.decomposition.pieces import each_facet

# So many facets are sent in one go: what a tick does not notice, and a page that
# has some hundred thousand of them still takes.
_SHEET = 128


class DrawnPieces:
    """Facets of pieces below a path: `pieces`, on the mesh, and `virtual`.

    Each folder holds sheets of a few facets. They stay where they were sent, so that
    to show or hide a folder later is one property.
    """

    def __init__(
        self,
        meshcat: Meshcat,
        path: str,
        pieces: Sequence[ConvexPolytope],
        alpha: float,
    ):
        """Sends nothing yet.

        Args:
            meshcat: Where to draw.
            path: Folder in the scene tree.
            pieces: What to draw, in the frame of the folder.
            alpha: Opacity of the facets on the mesh.
        """
        self._meshcat = meshcat
        self._path = path
        self._pieces = pieces
        self._alpha = alpha

    def send(self) -> Iterator[None]:
        """Sends all facets as it is iterated over."""
        # Corners and colors that wait for a sheet to be full, by kind.
        waiting: dict[bool, list[tuple[np.ndarray, np.ndarray]]] = {True: [], False: []}
        sent = {True: 0, False: 0}
        for index, original, corners in each_facet(self._pieces):
            color = piece_color(index) if original else VIRTUAL_FACET
            sheet = waiting[original]
            sheet.append((corners, np.tile(color[:3], (len(corners), 1))))
            if len(sheet) >= _SHEET:
                self._send_sheet(original, sent[original], sheet)
                sent[original] += 1
                sheet.clear()
            yield
        for original, sheet in waiting.items():
            if sheet:
                self._send_sheet(original, sent[original], sheet)
                yield

    def _send_sheet(
        self, original: bool, number: int, sheet: list[tuple[np.ndarray, np.ndarray]]
    ) -> None:
        """Sends some facets as one mesh."""
        path = f"{self._path}/{'pieces' if original else 'virtual'}/{number}"
        corners = np.concatenate([points for points, _ in sheet])
        colors = np.concatenate([color for _, color in sheet])
        faces = np.arange(len(corners), dtype=np.int32).reshape(-1, 3)
        self._meshcat.SetTriangleColorMesh(
            path,
            np.asfortranarray(corners.T),
            np.asfortranarray(faces.T),
            np.asfortranarray(colors.T),
        )
        alpha = self._alpha if original else VIRTUAL_FACET[3]
        if alpha < 1.0:
            self._meshcat.SetProperty(path, "opacity", alpha)
