"""Reads the contact shapes of SDF, URDF and MJCF files as meshes."""

from __future__ import annotations

import os
from pathlib import Path

from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
from pydrake.multibody.tree import BodyIndex
from pydrake.systems.framework import DiagramBuilder

from drake_haptics.common.errors import MeshError
from drake_haptics.common.files import describe_missing, resolve_package_url
from drake_haptics.geometry.mesh.mesh import Mesh
from drake_haptics.geometry.mesh.topology import unite_surfaces
from drake_haptics.geometry.mesh.units import meters_per_unit
from drake_haptics.geometry.parsing.body_shapes import (
    decompose_body,
    find_body_geometries,
)

DEFAULT_CHORD_ERROR_M = 1e-4

_SUFFIXES = (".sdf", ".urdf", ".xml", ".yaml")


def is_model_file(path: str | os.PathLike[str]) -> bool:
    """Returns whether a file has a suffix of models that Drake's parser reads."""
    return Path(path).suffix.lower() in _SUFFIXES


def load_model_mesh(
    path: str | os.PathLike[str],
    *,
    scale: float = 1.0,
    chord_error_m: float = DEFAULT_CHORD_ERROR_M,
) -> Mesh:
    """Reads the collision shapes of a model as one mesh.

    Joints are at their default positions. Round shapes become polytopes; see
    `drake_haptics.geometry.parsing.body_shapes`.

    Args:
        path: SDF, URDF, MJCF or model directives (.dmd.yaml), which is treated as
            rigid. `package://...` names one of this package or of Drake.
        scale: Factor on all lengths.
        chord_error_m: Largest distance between round shapes and the polytopes that
            approximate them before scaling, m.

    Returns:
        The mesh in the model's frame, m.

    Raises:
        MeshError: The file cannot be parsed or has no collision shape, one of them
            cannot be used, or the scale is not a positive finite number.
    """
    scale = meters_per_unit(None, scale)
    path = Path(resolve_package_url(path))
    if not path.is_file():
        raise MeshError(describe_missing(path))
    builder = DiagramBuilder()
    plant, scene_graph = AddMultibodyPlantSceneGraph(builder, 0.0)
    try:
        Parser(plant).AddModels(str(path))
    except RuntimeError as error:
        raise MeshError(f"{path}: Drake cannot parse it: {error}") from error
    plant.Finalize()
    context = plant.CreateDefaultContext()
    inspector = scene_graph.model_inspector()
    parts = []
    for body in map(plant.get_body, map(BodyIndex, range(plant.num_bodies()))):
        if not find_body_geometries(plant, inspector, body):
            continue
        try:
            part = decompose_body(plant, inspector, body, chord_error_m=chord_error_m)
        except ValueError as error:
            raise MeshError(f"{path}: {error}") from error
        X_WB = plant.EvalBodyPoseInWorld(context, body).GetAsMatrix4()
        p_WV = part.vertices @ X_WB[:3, :3].T + X_WB[:3, 3]
        parts.append((p_WV, part.triangles))
    if not parts:
        raise MeshError(f"{path}: has no collision shape that could be touched")
    vertices, triangles = unite_surfaces(parts)
    return Mesh.from_arrays(scale * vertices, triangles, name=path.name)
