"""Draws a haptic loop in Meshcat, in views that can be shown or hidden."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from types import MappingProxyType

import numpy as np
from pydrake.geometry import Cylinder, Meshcat, Rgba, Sphere
from pydrake.math import RigidTransform, RotationMatrix

from drake_haptics._core import ClusterSet, ContactSet, ConvexPieces, FrictionStep
from drake_haptics.common import colors
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.output.meshcat_shapes import (
    DOUBLE_ARROW,
    LONG_ARROW,
    ArrowPool,
    DrawnPieces,
    MovingParts,
)

_ROOT = "/haptics"
_MAX_CONTACTS = 64
_MAX_CLUSTERS = 16
# Objects are translucent, because much of the contact is inside them.
_ENVIRONMENT_ALPHA = 0.45
# Lengths as shares of the tool's size (the diagonal of its box), so that tools of any
# size give a readable picture.
_CONTACT_ARROW = 0.06
# Length of the arrow of the device's largest force or torque.
_LONGEST_ARROW = 1 / 3
_SHORTEST_ARROW = 0.05
_GRIP_RADIUS = 0.022
_LINE_RADIUS = 0.006
# Opacity of the tool while virtual facets are shown, which are inside it.
_TOOL_SEEN_THROUGH = 0.35
# Folders that a view shows or hides, below the root.
_FOLDERS = {
    "ghost": ("handle", "grip", "coupling"),
    "contacts": ("contacts",),
    "forces": ("force", "torque", "clusters", "friction"),
}
# A smaller force, N, or torque, N·m, has no direction.
_NO_SIZE = 1e-6
# A shorter line has no direction.
_NO_LENGTH_M = 1e-9
PICTURE_VIEWS = MappingProxyType(
    {
        "pieces": "Convex pieces",
        "virtual": "Virtual facets",
        "ghost": "Handle's ghost",
        "contacts": "Contacts",
        "forces": "Forces",
    }
)
"""Names of the views, and their labels.

`pieces` colors each convex piece; `virtual` shows, translucent, the facets of pieces
that are not on the mesh; `ghost` shows where the handle wants the tool, with the
coupling; `contacts` are the small arrows, `forces` the large ones.
"""

SHOWN_AT_FIRST = frozenset({"ghost", "contacts", "forces"})
"""Views that are shown at first."""


class HapticPicture:
    """The objects of the picture, made once, then moved, scaled, shown and hidden.

    All of them are below "/haptics" in the scene tree: `tool`, `handle`, `grip`,
    `coupling`, `force`, `torque`, `contacts`, `clusters`, `friction` and
    `objects/<name>`.

    Most methods that draw return an iterator, so that a frame can be drawn in slices.

    Attributes:
        parts: The parts that move.
    """

    def __init__(
        self,
        meshcat: Meshcat,
        tool: ConvexPieces,
        objects: Sequence[ContactObject],
        X_HT: RigidTransform,
        *,
        max_force_N: float,
        max_torque_Nm: float,
        has_friction: bool,
    ):
        """Sends the geometry.

        Args:
            meshcat: Meshcat to draw in.
            tool: The tool, in its frame T.
            objects: Objects that the tool meets; those that never move are placed.
            X_HT: Pose of the tool in the handle at rest.
            max_force_N: Force that has the longest arrow, N.
            max_torque_Nm: Torque that has the longest arrow, N·m.
            has_friction: Whether there is friction to draw.
        """
        self._meshcat = meshcat
        self.parts = MovingParts(meshcat)
        # An earlier loop may have left its friction in this Meshcat.
        meshcat.Delete(f"{_ROOT}/friction")
        self._wanted = set(SHOWN_AT_FIRST)
        self._shown = SHOWN_AT_FIRST
        self._pieces = {"tool": DrawnPieces(meshcat, f"{_ROOT}/tool", tool.pieces, 1.0)}
        self._pieces_are_sent = False
        self._X_HT = X_HT
        self._p_TH = X_HT.inverse().translation()
        self._size_m = float(np.linalg.norm(np.ptp(tool.vertices, axis=0)))
        self._send_mesh("tool", tool, Rgba(*colors.TOOL))
        self._send_mesh("handle", tool, Rgba(*colors.HANDLE_GHOST))
        environment = Rgba(*colors.ENVIRONMENT[:3], _ENVIRONMENT_ALPHA)
        for item in objects:
            path = f"objects/{item.name}"
            self._pieces[path] = DrawnPieces(
                meshcat,
                f"{_ROOT}/{path}",
                item.decomposition.pieces,
                _ENVIRONMENT_ALPHA,
            )
            self._send_mesh(path, item.decomposition, environment)
            if item.X_WO is not None:
                meshcat.SetTransform(f"{_ROOT}/{path}", item.X_WO)
        line = Rgba(*colors.COUPLING_LINE)
        meshcat.SetObject(f"{_ROOT}/grip", Sphere(_GRIP_RADIUS * self._size_m), line)
        meshcat.SetObject(
            f"{_ROOT}/coupling/line", Cylinder(_LINE_RADIUS * self._size_m, 1.0), line
        )
        # Too short to be seen until handle and tool move apart.
        meshcat.SetProperty(f"{_ROOT}/coupling/line", "scale", [1.0, 1.0, _NO_LENGTH_M])
        self._max_force_N, self._max_torque_Nm = max_force_N, max_torque_Nm
        self._force = ArrowPool(self.parts, f"{_ROOT}/force", 1, [line], LONG_ARROW)
        self._torque = ArrowPool(
            self.parts, f"{_ROOT}/torque", 1, [Rgba(*colors.TORQUE)], DOUBLE_ARROW
        )
        pair = [Rgba(*colors.NEAR_CONTACT), Rgba(*colors.PENETRATING_CONTACT)]
        self._contacts = ArrowPool(self.parts, f"{_ROOT}/contacts", _MAX_CONTACTS, pair)
        self._clusters = ArrowPool(
            self.parts, f"{_ROOT}/clusters", _MAX_CLUSTERS, pair, LONG_ARROW
        )
        pair = [Rgba(*colors.STICKING_CONTACT), Rgba(*colors.SLIDING_CONTACT)]
        most = _MAX_CLUSTERS if has_friction else 0
        self._friction = ArrowPool(
            self.parts, f"{_ROOT}/friction", most, pair, LONG_ARROW
        )

    def show(self, view: str, visible: bool) -> None:
        """Requests that `draw_views` show or hide a view.

        Raises:
            ValueError: There is no such view.
        """
        check_view(view)
        (self._wanted.add if visible else self._wanted.discard)(view)

    def draw_views(self) -> Iterator[None]:
        """Shows and hides the views for which `show` was called."""
        if self._wanted == self._shown:
            return
        if not self._pieces_are_sent and self._wanted & {"pieces", "virtual"}:
            for path, pieces in self._pieces.items():
                # Hidden until all facets are sent, and then if the view is no longer
                # wanted.
                self._set_visible(f"{path}/pieces", False)
                self._set_visible(f"{path}/virtual", False)
                yield from pieces.send()
            self._pieces_are_sent = True
        # Read here, because `show` may be called while pieces are sent.
        wanted = frozenset(self._wanted)
        changed = wanted ^ self._shown
        for view in sorted(changed & _FOLDERS.keys()):
            for folder in _FOLDERS[view]:
                self._set_visible(folder, view in wanted)
            yield
        if changed & {"pieces", "virtual"}:
            for path in self._pieces:
                self._show_facets(path, wanted)
                yield
        self._shown = wanted

    def _show_facets(self, path: str, wanted: frozenset[str]) -> None:
        """Shows the surface or the pieces of a mesh, with or without virtual facets."""
        has_pieces, has_virtual = "pieces" in wanted, "virtual" in wanted
        self._set_visible(f"{path}/<object>", not has_pieces)
        self._set_visible(f"{path}/pieces", has_pieces)
        self._set_visible(f"{path}/virtual", has_virtual)
        if path == "tool":
            alpha = _TOOL_SEEN_THROUGH if has_virtual else 1.0
            for part in ("<object>", "pieces"):
                self._meshcat.SetProperty(
                    f"{_ROOT}/tool/{part}", "modulated_opacity", alpha
                )

    def _set_visible(self, path: str, visible: bool) -> None:
        """Shows or hides a folder; in a recording, for its whole duration."""
        self._meshcat.SetProperty(f"{_ROOT}/{path}", "visible", visible)

    def place_object(self, name: str, X_WO: RigidTransform, time_s: float) -> None:
        """Places an object that moves."""
        self.parts.place(f"{_ROOT}/objects/{name}", X_WO, time_s)

    def place_tool(
        self, X_WH: RigidTransform, X_WT: RigidTransform, time_s: float
    ) -> Iterator[None]:
        """Places the tool, its ghost in the handle, and the line that couples them."""
        self.parts.place(f"{_ROOT}/tool", X_WT, time_s)
        yield
        self.parts.place(f"{_ROOT}/handle", X_WH @ self._X_HT, time_s)
        self.parts.place(f"{_ROOT}/grip", X_WH, time_s)
        yield
        p_WH = X_WH.translation()
        line = X_WT @ self._p_TH - p_WH
        length = float(np.linalg.norm(line))
        if length > _NO_LENGTH_M:
            X_WLine = RigidTransform(
                RotationMatrix.MakeFromOneVector(line, 2), p_WH + line / 2
            )
            self.parts.place(f"{_ROOT}/coupling", X_WLine, time_s)
            # On a child of the node with the pose, for the reason in ArrowPool.
            path = f"{_ROOT}/coupling/line"
            self.parts.scale(path, [1.0, 1.0, length], time_s)

    def draw_display_wrench(
        self, p_WH: np.ndarray, F_H_W: np.ndarray, time_s: float
    ) -> Iterator[None]:
        """Draws the wrench on the hand at the handle.

        Args:
            p_WH: (3,) position of the handle, m: tip of the force, tail of the torque.
            F_H_W: (6,) wrench [τ; f], N·m and N.
            time_s: Time in the recording, s.
        """
        tau_W, f_W = F_H_W[None, :3], F_H_W[None, 3:]
        yield from self._draw_forces(
            self._force, ["force"], p_WH[None], f_W, [0], time_s
        )
        vector = self._scale_arrows(tau_W, self._max_torque_Nm)
        shown = np.flatnonzero(vector.any(axis=1))
        yield from self._torque.draw(
            ["torque"][: len(shown)],
            p_WH + vector[shown],
            vector[shown],
            [0] * len(shown),
            time_s,
        )

    def draw_contacts(self, contacts: ContactSet, time_s: float) -> Iterator[None]:
        """Draws a small arrow for each contact; only for the deepest if too many.

        The arrow points along the normal and ends at the contact's point, so that it is
        in the object, which is translucent, and not in the tool, which is opaque.
        """
        distance = contacts.distance
        order = np.argsort(distance)[:_MAX_CONTACTS]
        keys = list(
            zip(
                contacts.object_index[order].tolist(),
                contacts.piece_A[order].tolist(),
                contacts.piece_B[order].tolist(),
                strict=True,
            )
        )
        yield
        length = _CONTACT_ARROW * self._size_m
        yield from self._contacts.draw(
            keys,
            contacts.p_WC[order],
            length * contacts.nhat_BA_W[order],
            distance[order] < 0,
            time_s,
        )

    def draw_clusters(
        self, clusters: ClusterSet, f_cluster_W: np.ndarray, time_s: float
    ) -> Iterator[None]:
        """Draws the force (k, 3) N of each cluster, pushing at its point."""
        keys = list(range(len(clusters)))
        penetrating = clusters.distance < 0
        yield from self._draw_forces(
            self._clusters, keys, clusters.p_WC, f_cluster_W, penetrating, time_s
        )

    def draw_friction(
        self, clusters: ClusterSet, friction: FrictionStep, time_s: float
    ) -> Iterator[None]:
        """Draws the friction of each cluster; dark if it sticks, light if it slides."""
        keys = list(range(len(clusters)))
        yield from self._draw_forces(
            self._friction,
            keys,
            clusters.p_WC,
            friction.f_cluster_W,
            friction.sliding,
            time_s,
        )

    def write_visibility(self, time_s: float) -> None:
        """Sends the visibility again, for the first frame of a recording."""
        pools = (self._force, self._torque, self._contacts)
        for pool in (*pools, self._clusters, self._friction):
            pool.write_visibility(time_s)

    def _draw_forces(
        self,
        pool: ArrowPool,
        keys: Sequence[object],
        p_W: np.ndarray,
        f_W: np.ndarray,
        colors_of: Sequence[int] | np.ndarray,
        time_s: float,
    ) -> Iterator[None]:
        """Draws forces as arrows, except those too small to have a direction."""
        vectors = self._scale_arrows(f_W, self._max_force_N)
        felt = np.flatnonzero(vectors.any(axis=1))
        yield
        yield from pool.draw(
            [keys[i] for i in felt.tolist()],
            p_W[felt],
            vectors[felt],
            np.asarray(colors_of)[felt],
            time_s,
        )

    def _scale_arrows(self, v_W: np.ndarray, largest: float) -> np.ndarray:
        """Returns arrows (n, 3), m, for vectors (n, 3); 0 without a direction."""
        size = np.linalg.norm(v_W, axis=1, keepdims=True)
        # A device without motors for torques has a limit of zero.
        share = np.divide(size, largest, out=np.zeros_like(size), where=largest > 0.0)
        share = np.clip(_LONGEST_ARROW * share, _SHORTEST_ARROW, _LONGEST_ARROW)
        scale = np.divide(share, size, out=np.zeros_like(size), where=size > _NO_SIZE)
        return self._size_m * scale * v_W

    def _send_mesh(self, name: str, mesh: ConvexPieces, rgba: Rgba) -> None:
        """Sends the surface of a decomposition."""
        self._meshcat.SetTriangleMesh(
            f"{_ROOT}/{name}",
            np.asfortranarray(mesh.vertices.T),
            np.asfortranarray(mesh.triangles.T),
            rgba,
        )


def check_view(view: str) -> None:
    """Checks the name of a view.

    Raises:
        ValueError: There is no such view.
    """
    if view not in PICTURE_VIEWS:
        known = ", ".join(PICTURE_VIEWS)
        raise ValueError(f"view must be one of {known}, is {view!r}")
