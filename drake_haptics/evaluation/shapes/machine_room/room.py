"""A room of many objects made of few shapes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from drake_haptics.evaluation.shapes.surface import Surface


@dataclass(frozen=True)
class PlacedShape:
    """An object of the room.

    Attributes:
        name: unique.
        shape: key of its surface in `MachineRoom.shapes`.
        X_WO: (4, 4) pose of the surface's frame in the room.
    """

    name: str
    shape: str
    X_WO: np.ndarray


@dataclass(frozen=True)
class MachineRoom:
    """Shapes, and objects that are placed copies of them.

    Attributes:
        shapes: surfaces by name, each in its own frame.
        objects: in the order in which they were placed.
    """

    shapes: dict[str, Surface]
    objects: tuple[PlacedShape, ...]

    @property
    def num_triangles(self) -> int:
        """Triangles of all objects together."""
        return sum(len(self.shapes[o.shape].triangles) for o in self.objects)


class RoomBuilder:
    """Collects placed shapes; makes each shape once."""

    def __init__(self) -> None:
        self._shapes: dict[str, Surface] = {}
        self._objects: list[PlacedShape] = []
        self._num_of_kind: dict[str, int] = {}

    def place(
        self, make: Callable[..., Surface], sizes: Sequence[float], X_WO: np.ndarray
    ) -> None:
        """Places what `make(*sizes)` returns at the pose X_WO (4, 4).

        Args:
            make: a generator named make_<kind>.
            sizes: its arguments: lengths, m, rounded to 1 mm, so that shapes are
                shared; and counts, which are ints.
            X_WO: the pose.
        """
        kind = make.__name__.removeprefix("make_")
        sizes = [s if isinstance(s, int) else round(s, 3) for s in sizes]
        labels = (str(s) if isinstance(s, int) else f"{1e3 * s:.0f}mm" for s in sizes)
        shape = "_".join([kind, *labels])
        if shape not in self._shapes:
            self._shapes[shape] = make(*sizes)
        count = self._num_of_kind[kind] = self._num_of_kind.get(kind, 0) + 1
        self._objects.append(PlacedShape(f"{kind}_{count:03d}", shape, X_WO))

    def build(self) -> MachineRoom:
        """Returns the room made so far."""
        return MachineRoom(dict(self._shapes), tuple(self._objects))


def pose(
    origin: Sequence[float] | np.ndarray,
    z: Sequence[float] | np.ndarray = (0, 0, 1),
    x: Sequence[float] | np.ndarray = (1, 0, 0),
) -> np.ndarray:
    """Returns X_WO (4, 4) from an origin, m, and the directions of two axes.

    Args:
        origin: (3,) m.
        z: (3,) unit.
        x: (3,) unit, normal to z.
    """
    X = np.eye(4)
    X[:3, 2], X[:3, 0] = z, x
    X[:3, 1] = np.cross(X[:3, 2], X[:3, 0])
    X[:3, 3] = origin
    return X
