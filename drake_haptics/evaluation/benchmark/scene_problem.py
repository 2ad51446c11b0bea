"""A tool, objects and a motion, for the benchmarks of whole scenes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drake_haptics.geometry.decomposition.decompose import Decomposition


@dataclass(frozen=True)
class SceneProblem:
    """What all libraries are asked in a scene.

    Attributes:
        name: of the scene.
        tool: in convex pieces.
        objects: in convex pieces.
        X_WO: (k, 4, 4) poses of the objects, at rest.
        motions: (n, 4, 4) poses of the tool a millisecond apart, several times.
        tolerance_m: contacts up to this distance are asked for.
    """

    name: str
    tool: Decomposition
    objects: list[Decomposition]
    X_WO: np.ndarray
    motions: list[np.ndarray]
    tolerance_m: float = 0.002

    @property
    def num_triangles(self) -> int:
        """Triangles of all meshes."""
        meshes = [self.tool, *self.objects]
        return sum(len(d.mesh.triangles) for d in meshes)

    @property
    def num_pieces(self) -> tuple[int, int]:
        """Convex pieces of the tool and of all objects."""
        return len(self.tool.pieces), sum(len(d.pieces) for d in self.objects)


@dataclass(frozen=True)
class SceneAnswers:
    """A library's answers along a motion.

    Attributes:
        num_contacts: (n,) pairs of pieces within the tolerance.
        nearest_m: (n,) smallest signed distance of any, at most the tolerance, m.
        seconds: (n,) what each tick cost inside the library, s.
    """

    num_contacts: np.ndarray
    nearest_m: np.ndarray
    seconds: np.ndarray
