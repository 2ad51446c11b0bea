"""Stores decompositions in files with checksums, and in the cache."""

from __future__ import annotations

import hashlib
import io
import json
from dataclasses import asdict, fields
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from drake_haptics import _core
from drake_haptics.common.disk_cache import load_entry, replace_file, store_entry
from drake_haptics.common.errors import DecompositionFileError
from drake_haptics.geometry.decomposition.pieces import (
    ConvexHulls,
    MergedPatches,
    PatchLabels,
    PieceData,
)
from drake_haptics.geometry.mesh.mesh import Component, Mesh
from drake_haptics.geometry.mesh.report import MeshReport

FORMAT_NAME = "drake_haptics decomposition"
FORMAT_VERSION = 1
# Pieces are stored by the names of their fields.
_KINDS: dict[str, type[PieceData]] = {
    "patches": PatchLabels,
    "merged": MergedPatches,
    "hulls": ConvexHulls,
}


def cache_key(mesh: Mesh, method: str, parameters: dict[str, Any]) -> str:
    """Returns a hash of everything on which the pieces depend.

    It includes the compiled core, so that a changed core never finds pieces of another
    one.
    """
    settings = [FORMAT_VERSION, _core_digest(), method, parameters]
    sha = hashlib.sha256(json.dumps(settings, sort_keys=True).encode())
    for array in (mesh.vertices, mesh.triangles, mesh.solid):
        sha.update(f"{array.dtype} {array.shape}".encode())
        sha.update(np.ascontiguousarray(array).tobytes())
    return sha.hexdigest()


@cache
def _core_digest() -> str:
    return hashlib.sha256(Path(_core.__file__).read_bytes()).hexdigest()


def load_cached(key: str, mesh: Mesh) -> PieceData | None:
    """Returns the pieces in the cache under the key; None if there are no usable ones.

    Args:
        key: Key by `cache_key`.
        mesh: Mesh of the pieces.
    """

    def read(path: Path) -> PieceData:
        facts, arrays = read_archive(path)
        if facts.get("key") != key:
            raise DecompositionFileError(f"{path}: is the cache entry of another mesh")
        return _unpack_pieces(path, facts, arrays, mesh)

    return load_entry(key, read)


def store_cached(key: str, pieces: PieceData) -> None:
    """Stores pieces in the cache under the key, replacing an existing entry."""
    facts, arrays = _pack_pieces(pieces)
    store_entry(key, lambda path: write_archive(path, {"key": key, **facts}, arrays))


def write_decomposition(path: Path, mesh: Mesh, method: str, pieces: PieceData) -> None:
    """Writes a decomposition together with its mesh."""
    facts, arrays = _pack_pieces(pieces)
    facts |= {
        "method": method,
        "components": [asdict(component) for component in mesh.components],
        "mesh_report": mesh.report.to_dict(),
    }
    arrays |= {
        "vertices": mesh.vertices,
        "triangles": mesh.triangles,
        "component_of_triangle": mesh.component_of_triangle,
        "solid": mesh.solid,
    }
    write_archive(path, facts, arrays)


def read_decomposition(path: Path) -> tuple[Mesh, str, PieceData]:
    """Reads a file of `write_decomposition`.

    Raises:
        DecompositionFileError: The file is of another kind or is damaged.
        OSError: It cannot be opened.
    """
    facts, arrays = read_archive(path)
    if "mesh_report" not in facts:
        raise DecompositionFileError(
            f"{path}: is an entry of the cache, which holds no mesh; make a file with: "
            f"drake-haptics decompose MESH --out FILE"
        )
    try:
        mesh = Mesh(
            arrays["vertices"],
            arrays["triangles"],
            arrays["component_of_triangle"],
            arrays["solid"],
            tuple(_component(data) for data in facts["components"]),
            MeshReport.from_dict(facts["mesh_report"]),
        )
        return mesh, facts["method"], _unpack_pieces(path, facts, arrays, mesh)
    except (KeyError, TypeError) as error:
        raise DecompositionFileError(f"{path}: is incomplete ({error})") from error


def _component(data: dict[str, Any]) -> Component:
    low, high = data["bounds"]
    return Component(**{**data, "bounds": (tuple(low), tuple(high))})


def _pack_pieces(pieces: PieceData) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    (kind,) = (name for name, of in _KINDS.items() if isinstance(pieces, of))
    facts: dict[str, Any] = {"kind": kind}
    arrays: dict[str, np.ndarray] = {}
    for name, value in vars(pieces).items():
        (arrays if isinstance(value, np.ndarray) else facts)[name] = value
    return facts, arrays


def _unpack_pieces(
    path: Path, facts: dict[str, Any], arrays: dict[str, np.ndarray], mesh: Mesh
) -> PieceData:
    kind, stored = _KINDS[facts["kind"]], {**facts, **arrays}
    pieces = kind(**{field.name: stored[field.name] for field in fields(kind)})
    if not pieces.fits(mesh):
        raise DecompositionFileError(f"{path}: its pieces do not fit its mesh")
    return pieces


def write_archive(
    path: Path, facts: dict[str, Any], arrays: dict[str, np.ndarray]
) -> None:
    """Writes facts (JSON data) and arrays to an .npz file, atomically.

    Raises:
        OSError: The file cannot be written.
    """
    header = {"format": FORMAT_NAME, "version": FORMAT_VERSION, **facts}
    text = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
    entries = {"facts": text, **arrays}
    digest = np.frombuffer(_digest(entries), dtype=np.uint8)
    buffer = io.BytesIO()
    np.savez(buffer, digest=digest, **entries)  # type: ignore[arg-type]
    replace_file(path, buffer.getbuffer())


def read_archive(path: Path) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """Reads a file of `write_archive`; the arrays are read-only.

    Raises:
        DecompositionFileError: The file is damaged, of another kind or of another
            version of the format.
        OSError: The file cannot be opened.
    """
    with open(path, "rb") as stream:
        data = stream.read()
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            entries = {name: archive[name] for name in archive.files}
        digest = entries.pop("digest").tobytes()
        facts = json.loads(entries["facts"].tobytes())
        name, version = facts["format"], facts["version"]
    except Exception as error:  # damaged archives raise various errors
        raise DecompositionFileError(
            f"{path}: is not a decomposition file, or is damaged "
            f"({type(error).__name__}); make it again with: drake-haptics decompose"
        ) from error
    if name != FORMAT_NAME or version != FORMAT_VERSION:
        raise DecompositionFileError(
            f"{path}: has format {name!r} version {version!r}, this program reads "
            f"version {FORMAT_VERSION}; make it again with: drake-haptics decompose"
        )
    if digest != _digest(entries):
        raise DecompositionFileError(
            f"{path}: is damaged (its content does not match its checksum); make it "
            f"again with: drake-haptics decompose"
        )
    del entries["facts"]
    for array in entries.values():
        array.flags.writeable = False
    return facts, entries


def _digest(entries: dict[str, np.ndarray]) -> bytes:
    sha = hashlib.sha256()
    for name in sorted(entries):
        sha.update(f"{name} {entries[name].dtype} {entries[name].shape}".encode())
        sha.update(np.ascontiguousarray(entries[name]).tobytes())
    return sha.digest()
