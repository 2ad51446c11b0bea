"""Reads triangles from files, without checks or repairs."""

from __future__ import annotations

import codecs
import hashlib
import io
import logging
import os
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache, partial
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from drake_haptics.common.disk_cache import load_entry, replace_file, store_entry
from drake_haptics.common.errors import MeshError
from drake_haptics.common.files import describe_missing, resolve_package_url
from drake_haptics.common.one_line import count
from drake_haptics.geometry.mesh.topology import unite_surfaces
from drake_haptics.geometry.mesh.units import unit_of_name

# Sizes in a binary STL: header with the number of triangles, and a triangle.
_STL_HEADER = 84
_STL_TRIANGLE = 50
# Number of bytes that show whether a file is text.
_TEXT = 1000


@dataclass(frozen=True)
class RawMesh:
    """The content of a file, in the file's unit.

    Attributes:
        vertices: (n, 3) positions in the file's unit.
        triangles: (m, 3) vertex indices.
        parts: Number of placed geometries that were merged.
        unit: Unit that the file states; None if it states none.
    """

    vertices: np.ndarray
    triangles: np.ndarray
    parts: int = 1
    unit: str | None = None


def read_mesh_file(path: str | os.PathLike[str]) -> RawMesh:
    """Reads all triangles of a file, applying the transforms of scenes.

    Args:
        path: Any format that trimesh reads (obj, stl, ply, off, glb, gltf, ...), or
            .npz with arrays V (n, 3) and F (m, 3); `package://...` names one of this
            package or of Drake.

    Raises:
        MeshError: The file is absent, unreadable or has no triangles.
    """
    path = Path(resolve_package_url(path))
    if not path.exists():
        raise MeshError(describe_missing(path))
    if path.is_dir():
        raise MeshError(f"{path}: is a folder; name a mesh file inside it")
    try:
        with open(path, "rb") as stream:
            is_empty = not stream.read(1)
    except OSError as error:
        raise MeshError(f"{path}: cannot be opened: {error.strerror}") from error
    if is_empty:
        raise MeshError(f"{path}: is empty (0 bytes): export it again")
    if path.suffix.lower() == ".npz":
        return _read_npz(path)
    return _read_with_trimesh(path)


def _read_npz(path: Path) -> RawMesh:
    try:
        # Unlike `numpy.load`, this reads nothing but an archive.
        with open(path, "rb") as stream, np.lib.npyio.NpzFile(stream) as archive:
            names = archive.files
            arrays = {key: archive[key] for key in ("V", "F") if key in names}
    except Exception as error:  # damaged archives raise various errors
        raise MeshError(
            f"{path}: cannot be read as .npz ({type(error).__name__}: {error}); the"
            f" file is damaged or is not what its name says: export it again"
        ) from error
    missing = [key for key in ("V", "F") if key not in arrays]
    if missing:
        raise MeshError(
            f"{path}: holds no array {' and no array '.join(missing)}; a mesh "
            f"in .npz needs V (n, 3) and F (m, 3), this one has "
            f"{', '.join(names) or 'nothing'}"
        )
    return RawMesh(arrays["V"], arrays["F"])


def _read_with_trimesh(path: Path) -> RawMesh:
    """Reads a file by trimesh, or from the cache what it once read of these bytes.

    The import of trimesh takes as long as the rest of a run's start.
    """
    try:
        path.name.encode()  # whoever prints the name does so, too
    except UnicodeEncodeError as error:
        shown = os.fsencode(path).decode(errors="backslashreplace")
        raise MeshError(f"{shown}: its name is not UTF-8: rename the file") from error
    suffix = path.suffix.lower()
    if suffix in (".gltf", ".glb"):  # may have their numbers in other files
        return _parse(path, path)
    data = path.read_bytes()
    if suffix == ".obj":
        data = _plain_obj(data)
    settings = f"{_source_digest()} {version('trimesh')} {suffix} "
    key = f"triangles-{hashlib.sha256(settings.encode() + data).hexdigest()}"
    raw = load_entry(key, _load_triangles)
    if raw is None:
        raw = _parse(path, io.BytesIO(data))
        store_entry(key, partial(_store_triangles, raw))
    return raw


@cache
def _source_digest() -> str:
    """Returns a hash of this folder's modules, of which some help to read a file."""
    sources = sorted(Path(__file__).parent.glob("*.py"))
    return hashlib.sha256(b"".join(map(Path.read_bytes, sources))).hexdigest()


def _load_triangles(entry: Path) -> RawMesh:
    with np.load(entry) as archive:
        parts, unit = int(archive["parts"]), str(archive["unit"])
        return RawMesh(archive["V"], archive["F"], parts, unit or None)


def _store_triangles(raw: RawMesh, entry: Path) -> None:
    buffer = io.BytesIO()
    np.savez(
        buffer, V=raw.vertices, F=raw.triangles, parts=raw.parts, unit=raw.unit or ""
    )
    replace_file(entry, buffer.getbuffer())


def _plain_obj(data: bytes) -> bytes:
    """Returns an OBJ file as trimesh reads it: Unix line ends, no tabs, no BOM."""
    data = data.removeprefix(codecs.BOM_UTF8)
    for other, plain in ((b"\r\n", b"\n"), (b"\r", b"\n"), (b"\t", b" ")):
        data = data.replace(other, plain)
    return data


def _parse(path: Path, source: Path | io.BytesIO) -> RawMesh:
    import trimesh

    formats = trimesh.available_formats()
    if path.suffix.lower().lstrip(".") not in formats:
        raise MeshError(
            f"{path}: trimesh reads no format {path.suffix or '(no suffix)'} here; "
            f"it reads {', '.join(sorted(formats))} and this program .npz. Convert "
            f"the file, or install the reader that trimesh asks for. SDF, URDF and "
            f"MJCF models are read only where a scene file names one as `mesh`"
        )
    try:
        with _silent_trimesh():
            scene = trimesh.load_scene(source, file_type=path.suffix, process=False)
    except Exception as error:  # trimesh's readers raise various errors
        raise MeshError(
            f"{path}: cannot be read as {path.suffix} "
            f"({type(error).__name__}: {error}); the file is damaged or is not what "
            f"its name says: export it again"
        ) from error
    return _merge_scene(path, scene)


@contextmanager
def _silent_trimesh() -> Iterator[None]:
    """Keeps trimesh from logging what our error says."""
    logger = logging.getLogger("trimesh")
    level = logger.level
    logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        logger.setLevel(level)


def _describe_missing_triangles(path: Path) -> str:
    """Returns why trimesh finds no triangles in a file.

    It treats an incomplete STL file, and a binary OBJ file, as one without facets.
    """
    data = path.read_bytes()
    # The number of triangles in a binary file has a zero byte below 16 million.
    is_text = b"\0" not in data[:_TEXT]
    if path.suffix.lower() == ".obj" and not is_text:
        return "is a binary file, not OBJ text: its content is not what its name says"
    if path.suffix.lower() != ".stl":
        return "has no triangles; point clouds and curves have no surface"
    if is_text:
        if not data.lstrip().lower().startswith(b"solid"):
            return "is a text file, not an STL: its content is not what its name says"
        if b"endsolid" not in data.lower():
            return (
                "is cut off: a text STL ends with 'endsolid': export or copy it again"
            )
    elif len(data) < _STL_HEADER:
        return f"is cut off after {count(len(data), 'byte')}: export or copy it again"
    else:
        (promised,) = struct.unpack_from("<I", data, _STL_HEADER - 4)
        size = _STL_HEADER + _STL_TRIANGLE * promised
        if size != len(data):
            fault = "is cut off" if size > len(data) else "is damaged"
            return (
                f"{fault}: its header promises {count(promised, 'triangle')}, which are"
                f" {count(size, 'byte')}, and the file has {len(data):,}: export or"
                " copy it again"
            )
    return "has no triangles"


def _merge_scene(path: Path, scene: Any) -> RawMesh:
    parts: list[tuple[np.ndarray, np.ndarray]] = []
    for node in scene.graph.nodes_geometry:
        X_WG, name = scene.graph[node]
        geometry = scene.geometry[name]
        faces = getattr(geometry, "faces", None)
        if faces is None or len(faces) == 0:
            continue  # point clouds and paths have no triangles
        p_GV = np.asarray(geometry.vertices, dtype=np.float64)
        F = np.asarray(faces, dtype=np.int64)
        if not np.array_equal(X_WG, np.eye(4)):
            p_GV = p_GV @ X_WG[:3, :3].T + X_WG[:3, 3]
            if np.linalg.det(X_WG[:3, :3]) < 0:
                F = F[:, ::-1]  # a reflection reverses the winding
        if F.min() < 0 or F.max() >= len(p_GV):
            raise MeshError(
                f"{path}: a triangle names vertex "
                f"{int(F.max() if F.max() >= len(p_GV) else F.min())}, but there are "
                f"only {count(len(p_GV), 'vertex', 'vertices')}; the file is damaged:"
                " export it again"
            )
        parts.append((p_GV, F))
    if not parts:
        raise MeshError(f"{path}: {_describe_missing_triangles(path)}")
    return RawMesh(*unite_surfaces(parts), len(parts), unit_of_name(scene.units))
