"""Draws arrows and convex pieces in Meshcat that can be moved and recorded."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence

import numpy as np
from pydrake.geometry import Meshcat, Rgba
from pydrake.math import RigidTransform, RotationMatrix

from drake_haptics._core import ConvexPolytope
from drake_haptics.common.colors import VIRTUAL_FACET, piece_color
from drake_haptics.geometry.decomposition.pieces import each_facet

_SIDES = 12
Profile = tuple[tuple[float, float], ...]
"""(radius, height) of an arrow of length 1 along z, from its tail to its tip."""

SHORT_ARROW: Profile = ((0.0, 0.0), (0.075, 0.0), (0.075, 0.6), (0.2, 0.6), (0.0, 1.0))
"""An arrow that shows a place and a direction."""

LONG_ARROW: Profile = ((0.0, 0.0), (0.05, 0.0), (0.05, 0.7), (0.14, 0.7), (0.0, 1.0))
"""A slim arrow whose length shows a magnitude."""

DOUBLE_ARROW: Profile = (
    *((0.0, 0.0), (0.04, 0.0), (0.04, 0.48), (0.11, 0.48)),
    *((0.03, 0.74), (0.11, 0.74), (0.0, 1.0)),
)
"""An arrow with two heads, for torques."""

# Facets per message: few enough that no tick is late, and many enough that a page can
# display some hundred thousand of them.
_SHEET = 128


# Parts of a pose, m and of unit vectors, that no picture shows.
_STILL = 1e-6


class MovingParts:
    """Places and scales parts of a Meshcat's scene, but only those that have changed.

    A page draws a picture whenever it is sent something, which without a graphics card
    takes most of a processor. At rest there is nothing to draw.

    Attributes:
        meshcat: The Meshcat.
        records: Whether everything is sent, because a recording needs every frame.
    """

    def __init__(self, meshcat: Meshcat):
        """Starts with nothing sent."""
        self.meshcat = meshcat
        self.records = False
        self._poses: dict[str, RigidTransform] = {}
        self._scales: dict[str, np.ndarray] = {}

    def place(self, path: str, X: RigidTransform, time_s: float) -> None:
        """Places a part in its parent."""
        last = self._poses.get(path)
        if self.records or last is None or not X.IsNearlyEqualTo(last, _STILL):
            self._poses[path] = RigidTransform(X)
            self.meshcat.SetTransform(path, X, time_s)

    def scale(self, path: str, scale: list[float], time_s: float) -> None:
        """Scales a part, to another scale than zero."""
        last = self._scales.get(path)
        if self.records or last is None or not np.allclose(last, scale, _STILL, 0.0):
            self._scales[path] = np.array(scale)
            self.meshcat.SetProperty(path, "scale", scale, time_s)


class ArrowPool:
    """A fixed number of arrows, made once, then moved, scaled, shown and hidden.

    A Meshcat recording holds poses and properties over time but no geometry, so every
    arrow must exist from the start.

    A slot is placed, and the folder `arrow` in it is scaled: a pose that the page
    receives resets the scale of the same node. The folder has one arrow per color, of
    which at most one is visible. A key stays in the same slot, so that a recording,
    which interpolates between frames, does not sweep arrows across the scene.
    """

    def __init__(
        self,
        parts: MovingParts,
        path: str,
        capacity: int,
        colors: Sequence[Rgba],
        profile: Profile = SHORT_ARROW,
    ):
        """Sends the arrows to Meshcat, hidden.

        Args:
            parts: Parts of the Meshcat to draw in.
            path: Folder of the arrows in the scene tree.
            capacity: Number of arrows that can be visible at once.
            colors: Colors that an arrow can have.
            profile: Outline of an arrow of length 1.
        """
        self._parts, self._meshcat = parts, parts.meshcat
        self._num_colors = len(colors)
        self._slots = [f"{path}/{i}" for i in range(capacity)]
        self._slot_of_key: dict[Hashable, int] = {}
        # Color shown in each slot; None where hidden.
        self._shown: list[int | None] = [None] * capacity
        vertices, triangles = _make_arrow(profile)
        for slot in self._slots:
            for color, rgba in enumerate(colors):
                arrow = f"{slot}/arrow/{color}"
                self._meshcat.SetTriangleMesh(arrow, vertices, triangles, rgba)
                self._meshcat.SetProperty(arrow, "visible", False)

    def draw(
        self,
        keys: Sequence[Hashable],
        p_WTip: np.ndarray,
        vectors_W: np.ndarray,
        colors: Sequence[int] | np.ndarray,
        time_s: float,
    ) -> Iterator[None]:
        """Shows only these arrows, or the first ones if there are too many.

        Each step of the iteration sends at most one message to the page.

        Args:
            keys: (n,) distinct keys of what the arrows represent.
            p_WTip: (n, 3) tips, m.
            vectors_W: (n, 3) vectors from tail to tip, m, none of them zero.
            colors: (n,) indices into the pool's colors.
            time_s: Time in the recording, s.
        """
        keys = keys[: len(self._slots)]
        self._assign_slots(keys)
        yield
        visible: list[int | None] = [None] * len(self._slots)
        for key, p, vector, color in zip(keys, p_WTip, vectors_W, colors, strict=False):
            i = self._slot_of_key[key]
            visible[i] = int(color)
            X_WArrow = RigidTransform(
                RotationMatrix.MakeFromOneVector(vector, 2), p - vector
            )
            self._parts.place(self._slots[i], X_WArrow, time_s)
            yield
            length = float(np.linalg.norm(vector))
            self._parts.scale(f"{self._slots[i]}/arrow", [length] * 3, time_s)
            yield
        for i, shown in enumerate(visible):
            if shown != self._shown[i]:
                self._show(i, shown, time_s)
                yield

    def write_visibility(self, time_s: float) -> None:
        """Sends the visibility again, for the first frame of a recording."""
        for slot, shown in zip(self._slots, self._shown, strict=True):
            for color in range(self._num_colors):
                self._meshcat.SetProperty(
                    f"{slot}/arrow/{color}", "visible", color == shown, time_s
                )

    def _assign_slots(self, keys: Sequence[Hashable]) -> None:
        """Keeps the slots of known keys, and gives free ones to new keys."""
        kept = {k: self._slot_of_key[k] for k in keys if k in self._slot_of_key}
        free = iter(sorted(set(range(len(self._slots))) - set(kept.values())))
        self._slot_of_key = {k: kept[k] if k in kept else next(free) for k in keys}

    def _show(self, slot: int, color: int | None, time_s: float) -> None:
        """Shows another color of a slot, or hides the slot."""
        for changed, visible in ((self._shown[slot], False), (color, True)):
            if changed is not None:
                path = f"{self._slots[slot]}/arrow/{changed}"
                self._meshcat.SetProperty(path, "visible", visible, time_s)
        self._shown[slot] = color


def _make_arrow(profile: Profile) -> tuple[np.ndarray, np.ndarray]:
    """Returns vertices (3, n) and triangles (3, m) of an arrow of length 1 along z."""
    angle = 2 * np.pi * np.arange(_SIDES) / _SIDES
    rings = [
        np.column_stack([r * np.cos(angle), r * np.sin(angle), np.full(_SIDES, z)])
        for r, z in profile
    ]
    triangles = []
    for ring in range(len(profile) - 1):
        for i in range(_SIDES):
            a, b = ring * _SIDES + i, ring * _SIDES + (i + 1) % _SIDES
            triangles += [(a, b, b + _SIDES), (a, b + _SIDES, a + _SIDES)]
    return (
        np.asfortranarray(np.vstack(rings).T),
        np.asfortranarray(np.array(triangles, dtype=np.int32).T),
    )


class DrawnPieces:
    """Facets of pieces in two folders: `pieces`, on the mesh, and `virtual`.

    Facets are sent in sheets and stay in Meshcat, so that one property shows or hides a
    folder.
    """

    def __init__(
        self,
        meshcat: Meshcat,
        path: str,
        pieces: Sequence[ConvexPolytope],
        alpha: float,
    ):
        """Sends nothing yet."""
        self._meshcat = meshcat
        self._path = path
        self._pieces = pieces
        self._alpha = alpha

    def send(self) -> Iterator[None]:
        """Sends all facets, some at each step of the iteration."""
        # Corners and colors that wait until a sheet is full, by kind.
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
