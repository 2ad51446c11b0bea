"""Shows a decomposition in the browser, without Drake."""

from __future__ import annotations

import contextlib
import io
import math
import os
from collections.abc import Callable

import meshcat
import meshcat.geometry
import meshcat.transformations
import numpy as np

from drake_haptics.common.colors import BACKGROUND_BOTTOM, BACKGROUND_TOP, VIRTUAL_FACET
from drake_haptics.common.one_line import count
from drake_haptics.common.web_page import extend_page
from drake_haptics.geometry.decomposition.decompose import Decomposition
from drake_haptics.geometry.decomposition.pieces import ColoredTriangles, piece_surfaces

# Largest extent of the drawn mesh, m, since the camera suits objects of about a meter.
_DRAWN_EXTENT_M = 1.5
# Displacement of the pieces of the exploded copy, relative to their distance from the
# middle.
_EXPLOSION = 0.5
# Position of the camera, m; y is up in its frame. Half of its view's height is the
# tangent times the distance.
_CAMERA_M = (2.4, 0.9, 0.0)
_TANGENT = math.tan(math.radians(75.0 / 2.0))
# Shows both copies on a page that is narrower than they are, such as a phone's.
_FIT = """<script>
function fit() {{
  viewer.camera.zoom = Math.min(1, innerWidth / innerHeight / {aspect:.3f});
  viewer.camera.updateProjectionMatrix();
  viewer.set_dirty();
}}
addEventListener("resize", fit);
fit();
</script>"""


class DecompositionViewer:
    """Shows a decomposition on a web page.

    On the left are the colored pieces in place, and on the right the same pieces moved
    apart, with their virtual facets (those that are not on the mesh) in translucent
    gray. The page's controls can hide each.

    Args:
        decomposition: The decomposition to show.
    """

    def __init__(self, decomposition: Decomposition) -> None:
        with contextlib.redirect_stdout(io.StringIO()):  # it prints its address
            self._meshcat = meshcat.Visualizer()
        fit = _FIT.format(aspect=self._draw(decomposition))
        pieces = count(len(decomposition.pieces), "convex piece")
        self._caption = (
            '<div style="position:fixed;left:1.2em;top:1.2em;padding:0.7em 1em;'
            "font:12px/1.55 sans-serif;color:#333;background:rgba(255,255,255,0.75);"
            f'border-radius:0.5em"><b>{pieces}</b><br>left: in place<br>'
            f"right: moved apart, in gray what is not on the mesh</div>{fit}"
        )

    def close(self) -> None:
        """Stops the web server; an open page remains."""
        server = self._meshcat.window.server_proc
        server.terminate()
        server.communicate()

    @property
    def url(self) -> str:
        """The address of the page."""
        return str(self._meshcat.url())

    def write_html(self, path: str | os.PathLike[str]) -> None:
        """Writes the page as one self-contained file."""
        with open(path, "w", encoding="utf-8") as stream:
            stream.write(extend_page(self._meshcat.static_html(), self._caption))

    def _draw(self, decomposition: Decomposition) -> float:
        """Draws both copies; returns the width of the view that they need.

        Returns:
            Width over height.
        """
        on_mesh, virtual = piece_surfaces(decomposition.pieces)
        vertices = decomposition.mesh.vertices
        low, high = vertices.min(axis=0), vertices.max(axis=0)
        middle = (low + high) / 2
        scale = _DRAWN_EXTENT_M / float((high - low).max())
        depth, width, _ = (high - low) * scale
        centroids = np.array([piece.centroid for piece in decomposition.pieces])

        def in_place(drawn: ColoredTriangles) -> np.ndarray:
            return (drawn.vertices - middle) * scale

        def exploded(drawn: ColoredTriangles) -> np.ndarray:
            outward = (centroids - middle)[drawn.piece] * _EXPLOSION
            return (drawn.vertices + outward - middle) * scale

        self._set_scene()
        root = self._meshcat["drake_haptics"]
        gap = width * (1 + _EXPLOSION / 2) / 2 + 0.15
        self._add(root["in place"], on_mesh, in_place, -gap)
        self._add(root["apart"]["facets on the mesh"], on_mesh, exploded, gap)
        self._add(root["apart"]["virtual facets"], virtual, exploded, gap)
        farthest = gap + width * (1 + _EXPLOSION) / 2
        nearest = math.hypot(*_CAMERA_M) - depth * (1 + _EXPLOSION) / 2
        return float(farthest / (nearest * _TANGENT))

    def _set_scene(self) -> None:
        background = self._meshcat["/Background"]
        background.set_property("top_color", list(BACKGROUND_TOP[:3]))
        background.set_property("bottom_color", list(BACKGROUND_BOTTOM[:3]))
        for path in ("/Grid", "/Axes"):
            self._meshcat[path].set_property("visible", False)
        camera = self._meshcat["/Cameras/default/rotated/<object>"]
        camera.set_property("position", list(_CAMERA_M))

    def _add(
        self,
        node: meshcat.Visualizer,
        drawn: ColoredTriangles,
        place: Callable[[ColoredTriangles], np.ndarray],
        y: float,
    ) -> None:
        if len(drawn.vertices) == 0:
            return
        translucent = node.path.lower().endswith("virtual facets")
        material = meshcat.geometry.MeshPhongMaterial(
            vertexColors=True,
            transparent=translucent,
            opacity=VIRTUAL_FACET[3] if translucent else 1.0,
        )
        geometry = meshcat.geometry.TriangularMeshGeometry(
            place(drawn), drawn.faces, color=drawn.colors
        )
        node.set_object(geometry, material)
        node.set_transform(meshcat.transformations.translation_matrix([0, y, 0]))
