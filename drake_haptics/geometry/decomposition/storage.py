"""How decompositions are stored: their pieces, alone or with their mesh."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from drake_haptics.common.errors import DecompositionFileError
from drake_haptics.geometry.decomposition.archive import read_archive, write_archive
from drake_haptics.geometry.decomposition.piece_data import (
    ConvexHulls,
    MergedPatches,
    PatchLabels,
    PieceData,
)
from drake_haptics.geometry.mesh.mesh import Component, Mesh
from drake_haptics.geometry.mesh.report import MeshReport


def write_pieces(path: Path, key: str, pieces: PieceData) -> None:
    """Writes an entry of the cache."""
    facts, arrays = _pack_pieces(pieces)
    write_archive(path, {"key": key, **facts}, arrays)


def read_pieces(path: Path, key: str, mesh: Mesh) -> PieceData:
    """Reads an entry of the cache.

    Raises:
        DecompositionFileError: if it is damaged or not the entry of that key.
        OSError: if it cannot be opened.
    """
    facts, arrays = read_archive(path)
    if facts.get("key") != key:
        raise DecompositionFileError(f"{path}: is the entry of another mesh")
    return _unpack_pieces(path, facts, arrays, mesh)


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
    """Reads what `write_decomposition` wrote.

    Returns:
        The mesh, the method and the pieces.

    Raises:
        DecompositionFileError: if the file is not such a one or is damaged.
        OSError: if it cannot be opened.
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
    if isinstance(pieces, PatchLabels):
        return (
            {"kind": "patches", "seconds": pieces.seconds},
            {"piece_of_triangle": pieces.piece_of_triangle},
        )
    if isinstance(pieces, MergedPatches):
        return (
            {
                "kind": "merged",
                "seconds": pieces.seconds,
                "error_m": pieces.error_m,
                "departure_m": pieces.departure_m,
            },
            {
                "piece_of_triangle": pieces.piece_of_triangle,
                "group_of_piece": pieces.group_of_piece,
            },
        )
    return (
        {"kind": "hulls", "seconds": pieces.seconds, "tolerance": pieces.tolerance},
        {"hull_points": pieces.points, "hull_start": pieces.start},
    )


def _unpack_pieces(
    path: Path, facts: dict[str, Any], arrays: dict[str, np.ndarray], mesh: Mesh
) -> PieceData:
    pieces: PieceData
    if facts["kind"] == "patches":
        pieces = PatchLabels(arrays["piece_of_triangle"], facts["seconds"])
    elif facts["kind"] == "merged":
        pieces = MergedPatches(
            arrays["piece_of_triangle"],
            arrays["group_of_piece"],
            facts["error_m"],
            facts["departure_m"],
            facts["seconds"],
        )
    else:
        pieces = ConvexHulls(
            arrays["hull_points"],
            arrays["hull_start"],
            facts["tolerance"],
            facts["seconds"],
        )
    if not pieces.fits(mesh):
        raise DecompositionFileError(f"{path}: its pieces do not fit its mesh")
    return pieces
