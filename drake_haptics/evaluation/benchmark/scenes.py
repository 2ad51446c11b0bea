"""The scenes that are measured: those of the paper's Table 1, and larger ones."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from drake_haptics.common.errors import UserError
from drake_haptics.evaluation.benchmark.scene_motion import make_touches
from drake_haptics.evaluation.benchmark.scene_problem import SceneProblem
from drake_haptics.evaluation.shapes import SHAPES, Surface
from drake_haptics.evaluation.shapes.hand_tools import make_wrench
from drake_haptics.evaluation.shapes.machine_room import make_machine_room, wrench_path
from drake_haptics.evaluation.shapes.organ import make_organ
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import Mesh, load_mesh

# The armadillo has no unit; at this scale it is 250 mm tall.
_ARMADILLO_SCALE = 0.25


# Real meshes, of which a folder need not have all.
_FILES = (
    "cup_500.obj",
    "spoon_336.obj",
    "torus_2000.obj",
    "hammer_1692.obj",
    "armadillo_31240.stl",
    "digestive_24846.ply",
)


def scene_makers(
    motions: int, meshes: Path | None = None
) -> dict[str, Callable[[], SceneProblem]]:
    """Returns scene name -> a function that makes it.

    Args:
        motions: how many motions each has.
        meshes: a folder of real meshes (cup_500.obj, spoon_336.obj, torus_2000.obj,
            hammer_1692.obj, armadillo_31240.stl, digestive_24846.ply); those that it
            lacks are replaced by the package's own shapes, and the armadillo is left
            out without it.

    Raises:
        UserError: The folder has none of them.
    """
    if meshes is not None and not any((meshes / file).exists() for file in _FILES):
        raise UserError(f"the folder {meshes} has none of {', '.join(_FILES)}")
    cup = _source("cup", meshes, "cup_500.obj")
    spoon = _source("spoon", meshes, "spoon_336.obj")
    torus = _source("torus", meshes, "torus_2000.obj")
    hammer = _source("hammer", meshes, "hammer_1692.obj")
    organ = _mesh_file(meshes, "digestive_24846.ply") or (
        lambda: _mesh(make_organ(), "organ")
    )
    armadillo = _mesh_file(meshes, "armadillo_31240.stl", _ARMADILLO_SCALE)

    def touching(
        name: str, tool: Callable[[], Mesh], target: Callable[[], Mesh]
    ) -> Callable[[], SceneProblem]:
        def make() -> SceneProblem:
            pieces, others = decompose(tool()), decompose(target())
            ways = make_touches(pieces, others, motions, seed=len(name))
            return SceneProblem(name, pieces, [others], np.eye(4)[None], ways)

        return make

    makers = {
        name: touching(name, tool, target)
        for name, tool, target in (
            ("spoon on cup", spoon, cup),
            ("torus on torus", torus, torus),
            ("torus on hammer", torus, hammer),
            ("spoon on organ", spoon, organ),
        )
    }
    if armadillo is not None:
        makers["spoon on armadillo"] = touching("spoon on armadillo", spoon, armadillo)
    makers["peg in hole"] = lambda: _peg_in_hole(motions)
    makers["wrench in machine room"] = lambda: _machine_room(motions)
    return makers


def _peg_in_hole(motions: int) -> SceneProblem:
    peg, torus = (decompose(_mesh(SHAPES[n](), n)) for n in ("peg", "torus"))
    phase = np.linspace(0, 2 * np.pi, 1000)
    inside = np.clip(1.5 * np.sin(phase / 2), 0, 1)
    ways = []
    for k in range(motions):
        # Down through the hole, once round its wall 0.2 mm deep, and up again. The
        # hole is 44 mm wide, the peg 24 mm.
        X = np.tile(np.eye(4), (len(phase), 1, 1))
        aside_m = 0.0102 * np.clip(3 * inside - 2, 0, 1)
        X[:, 0, 3] = aside_m * np.cos(phase + k)
        X[:, 1, 3] = aside_m * np.sin(phase + k)
        X[:, 2, 3] = 0.020 - 0.065 * np.clip(2 * inside, 0, 1)
        ways.append(X)
    return SceneProblem("peg in hole", peg, [torus], np.eye(4)[None], ways)


def _machine_room(motions: int) -> SceneProblem:
    room = make_machine_room()
    shapes = {
        name: decompose(_mesh(surface, name)) for name, surface in room.shapes.items()
    }
    return SceneProblem(
        name="wrench in machine room",
        tool=decompose(_mesh(make_wrench(), "wrench")),
        objects=[shapes[placed.shape] for placed in room.objects],
        X_WO=np.array([placed.X_WO for placed in room.objects]),
        motions=[wrench_path(3000)] * min(motions, 1),
    )


def _mesh(surface: Surface, name: str) -> Mesh:
    return Mesh.from_arrays(surface.vertices, surface.triangles, name=name)


def _mesh_file(
    folder: Path | None, file: str, scale: float | None = None
) -> Callable[[], Mesh] | None:
    if folder is None or not (folder / file).exists():
        return None
    return lambda: load_mesh(folder / file, scale=scale)


def _source(shape: str, folder: Path | None, file: str) -> Callable[[], Mesh]:
    return _mesh_file(folder, file) or (lambda: _mesh(SHAPES[shape](), shape))
