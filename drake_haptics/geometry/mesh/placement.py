"""Centers meshes at their origin, and lowers one mesh until it touches another."""

from __future__ import annotations

import numpy as np

from drake_haptics.geometry.mesh.mesh import Mesh, continue_report
from drake_haptics.geometry.mesh.report import Finding, Severity, length

# Number of nodes across the smaller mesh, unless that makes too many.
_NODES_ACROSS = 100
_MAX_NODES = 1 << 20
# Distance of a sensible origin from the mesh, relative to the diagonal.
_FAR_ORIGIN = 0.1


class TouchMap:
    """Heights at which a tool that is lowered near a place first touches.

    Both meshes become height fields on one grid: the environment's top and the tool's
    bottom. The heights are accurate to about the slope times the spacing, which is
    enough for a soft hand.
    """

    def __init__(self, tool: Mesh, environment: Mesh, place: np.ndarray, reach: float):
        """Constructs the map.

        Args:
            tool: Tool in its frame T, which keeps the world's orientation.
            environment: Environment in the world.
            place: (2,) x and y of T's origin in the world, m.
            reach: Largest offset from there, m.
        """
        widths = [max(mesh.report.extent[:2]) for mesh in (tool, environment)]
        low = tool.vertices[:, :2].min(axis=0)
        size = np.ptp(tool.vertices[:, :2], axis=0)
        area = float(np.prod(size + 2.0 * reach))
        self._spacing = max(min(widths) / _NODES_ACROSS, np.sqrt(area / _MAX_NODES))
        self._place = place
        self._margin = int(np.ceil(reach / self._spacing)) + 1
        shape = np.ceil(size / self._spacing).astype(int) + 2
        self._bottom = _rasterize(
            tool.vertices * [1.0, 1.0, -1.0], tool.triangles, low, self._spacing, shape
        )
        self._top = _rasterize(
            environment.vertices,
            environment.triangles,
            place + low - self._margin * self._spacing,
            self._spacing,
            shape + 2 * self._margin,
        )

    def calc_height(self, offset: np.ndarray) -> float:
        """Returns the tool's height at first touch, coming from above.

        Args:
            offset: (2,) x and y of T's origin relative to the place, m, within the
                reach.

        Returns:
            z of T's origin in the world, m; -inf if the tool misses.
        """
        i, j = self._margin + np.rint(offset / self._spacing).astype(int)
        rows, columns = self._bottom.shape
        below = self._top[i : i + rows, j : j + columns]
        return float(np.max(below + self._bottom))


def _rasterize(
    vertices: np.ndarray,
    triangles: np.ndarray,
    low: np.ndarray,
    spacing: float,
    shape: np.ndarray,
) -> np.ndarray:
    """Returns the largest z over each node of a grid; -inf where there is no triangle.

    Args:
        vertices: (n, 3) vertices.
        triangles: (m, 3) vertex indices.
        low: (2,) x and y of the first node.
        spacing: Spacing of the nodes, in x and y.
        shape: (2,) number of nodes in x and y.
    """
    heights = np.full(shape, -np.inf)
    scaled = (vertices[:, :2] - low) / spacing
    # Vertices go to their nearest node, so that a tip between nodes is not missed.
    nearest = np.rint(scaled).astype(int)
    on_grid = np.all((nearest >= 0) & (nearest < shape), axis=1)
    np.maximum.at(heights, tuple(nearest[on_grid].T), vertices[on_grid, 2])
    corners = scaled[triangles]
    first = np.maximum(np.ceil(corners.min(axis=1)).astype(int), 0)
    last = np.minimum(np.floor(corners.max(axis=1)).astype(int), shape - 1)
    for t in np.flatnonzero(np.all(first <= last, axis=1)):
        _raise_to_triangle(
            heights, corners[t], vertices[triangles[t], 2], first[t], last[t]
        )
    return heights


def _raise_to_triangle(
    heights: np.ndarray,
    corners: np.ndarray,
    z: np.ndarray,
    first: np.ndarray,
    last: np.ndarray,
) -> None:
    """Raises the nodes inside a triangle to its plane.

    Args:
        heights: The grid.
        corners: (3, 2) corners in units of the grid.
        z: (3,) heights of the corners.
        first: (2,) lowest node of the triangle's box.
        last: (2,) highest node.
    """
    edges = corners[1:] - corners[0]
    double_area = np.linalg.det(edges)
    if abs(double_area) < 1e-12:
        return
    i, j = np.mgrid[first[0] : last[0] + 1, first[1] : last[1] + 1]
    x, y = i - corners[0, 0], j - corners[0, 1]
    v = (x * edges[1, 1] - y * edges[1, 0]) / double_area
    w = (y * edges[0, 0] - x * edges[0, 1]) / double_area
    inside = (v >= 0.0) & (w >= 0.0) & (v + w <= 1.0)
    plane = z[0] + v * (z[1] - z[0]) + w * (z[2] - z[0])
    block = heights[first[0] : last[0] + 1, first[1] : last[1] + 1]
    np.maximum(block, np.where(inside, plane, -np.inf), out=block)


def center(mesh: Mesh) -> Mesh:
    """Returns the mesh moved so that the middle of its box is at the origin.

    Its report has the finding "centered" with the displacement.

    Args:
        mesh: Mesh from `load_mesh` or `Mesh.from_arrays`.
    """
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    middle = (low + high) / 2.0
    # Round-off may merge two vertices, so the mesh is checked again.
    moved = Mesh.from_arrays(
        mesh.vertices - middle, mesh.triangles, name=mesh.report.source
    )
    place = ", ".join(f"{x:.4g}" for x in middle)
    finding = Finding(
        "centered",
        Severity.NOTE,
        1,
        f"the middle of the mesh was at ({place}) m",
        "moved to the origin",
    )
    return continue_report(moved, mesh, finding)


def find_origin_beside(mesh: Mesh) -> float | None:
    """Returns the distance of the origin from the mesh's bounding box, m.

    It is None if the origin is in or near the box, as for a tool that is held at its
    end.
    """
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    beside_m = float(np.linalg.norm(np.maximum(np.maximum(low, -high), 0.0)))
    is_far = beside_m > _FAR_ORIGIN * float(np.linalg.norm(high - low))
    return beside_m if is_far else None


def describe_origin_beside(name: str, beside_m: float) -> str:
    """Returns that the origin of a mesh is far from it."""
    return f"the origin of {name} is {length(beside_m)} beside the mesh"
