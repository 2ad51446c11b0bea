"""Loads the meshes of a scene and cuts them into convex pieces."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import cast

from drake_haptics.common.errors import SceneError
from drake_haptics.geometry.decomposition.decompose import (
    Decomposition,
    Method,
    decompose,
)
from drake_haptics.geometry.mesh.decimation import decimate
from drake_haptics.geometry.mesh.mesh import Mesh, load_mesh
from drake_haptics.geometry.mesh.placement import center
from drake_haptics.geometry.parsing.model_file import (
    DEFAULT_CHORD_ERROR_M,
    is_model_file,
    load_model_mesh,
)
from drake_haptics.scene.schema import EnvironmentObject, Scene, Tool


def cut_scene(
    scene: Scene,
    known: Sequence[tuple[Tool | EnvironmentObject, Decomposition]] = (),
    progress: Callable[[str, float], None] | None = None,
) -> tuple[Decomposition, tuple[Decomposition, ...]]:
    """Returns the pieces of a scene's tool, and of each object in its order.

    Args:
        scene: Scene that names meshes and methods.
        known: Tools and objects that are already cut, with their pieces, which are used
            again for any that would be cut in the same way.
        progress: Function that is called with the name of the object and the share done
            in [0, 1].

    Raises:
        SceneError: A key does not apply to its mesh.
        MeshError: A mesh cannot be used.
    """

    def cut(name: str, item: Tool | EnvironmentObject) -> Decomposition:
        for other, pieces in known:
            if _describe_cut(other) == _describe_cut(item):
                return pieces
        return decompose(
            _load_mesh(item),
            cast(Method, item.decomposition),
            error_m=item.decomposition_error_m,
            progress=partial(progress, name) if progress else None,
        )

    return (
        cut("tool", scene.tool),
        tuple(cut(item.name, item) for item in scene.environment),
    )


def _describe_cut(item: Tool | EnvironmentObject) -> tuple[object, ...]:
    """Returns all values that determine the pieces of an object."""
    return (
        item.mesh,
        item.scale,
        item.center,
        item.max_triangles,
        item.chord_error_m,
        item.decomposition,
        item.decomposition_error_m,
    )


def _load_mesh(item: Tool | EnvironmentObject) -> Mesh:
    """Reads the mesh of an object with the accuracy that the scene asks for."""
    if is_model_file(item.mesh):
        chord_error_m = item.chord_error_m or DEFAULT_CHORD_ERROR_M
        mesh = load_model_mesh(
            item.mesh, scale=item.scale, chord_error_m=chord_error_m / item.scale
        )
    elif item.chord_error_m is not None:
        raise SceneError(
            f"{item.mesh}: chord_error_m is for models with round shapes"
            f" (SDF, URDF, MJCF); a mesh file has none"
        )
    else:
        mesh = load_mesh(item.mesh, scale=item.scale)
    if item.center:
        mesh = center(mesh)
    return mesh if item.max_triangles is None else decimate(mesh, item.max_triangles)
