"""Reads the triangles of a mesh that Drake knows by file or holds in memory."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from pydrake.common import MemoryFile
from pydrake.geometry import InMemoryMesh, MeshSource

from drake_haptics.common.errors import MeshError
from drake_haptics.geometry.mesh.reader import RawMesh, read_mesh_file

# glTF's y axis is up; Drake turns it to its own z.
_Y_UP = (".gltf", ".glb")
_R_DRAKE_GLTF = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


def read_mesh_source(source: MeshSource, scale3: np.ndarray) -> RawMesh:
    """Reads a mesh as Drake places it in the frame of its geometry.

    Args:
        source: Names a file, or holds it.
        scale3: (3,) meters per unit of the file, along each axis.

    Returns:
        The triangles, m, counter-clockwise seen from outside if the file's are.

    Raises:
        MeshError: The file cannot be read or has no triangles.
    """
    raw = _read(source)
    vertices, triangles = raw.vertices, raw.triangles
    if source.extension() in _Y_UP:
        vertices = vertices @ _R_DRAKE_GLTF.T
    if np.prod(scale3) < 0.0:
        triangles = triangles[:, ::-1]  # a mirror turns the winding round
    return RawMesh(vertices * scale3, triangles)


def _read(source: MeshSource) -> RawMesh:
    if source.is_path():
        return read_mesh_file(source.path())
    with TemporaryDirectory() as folder:
        path = _write(source.in_memory(), Path(folder))
        try:
            return read_mesh_file(path)
        except MeshError as error:
            # The file is gone when the message is read.
            raise MeshError(
                str(error).replace(str(path), source.description())
            ) from error


def _write(mesh: InMemoryMesh, folder: Path) -> Path:
    """Writes a mesh in memory, and the files that it names, for a reader of files."""
    for name, file in mesh.supporting_files.items():
        if not (folder / name).resolve().is_relative_to(folder.resolve()):
            raise MeshError(f"names the file {name!r} outside of its folder")
        contents = (
            file.contents() if isinstance(file, MemoryFile) else file.read_bytes()
        )
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(contents)
    path = folder / f"mesh{mesh.mesh_file.extension()}"
    path.write_bytes(mesh.mesh_file.contents())
    return path
