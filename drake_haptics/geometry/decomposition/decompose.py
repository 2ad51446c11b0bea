"""Decomposes a mesh into the convex pieces between which contacts are found."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np

from drake_haptics import _core
from drake_haptics.common.errors import HapticsError
from drake_haptics.common.one_line import count
from drake_haptics.geometry.decomposition.approximate import (
    check_error,
    coacd_hulls,
    coacd_parameters,
    merge_patches,
)
from drake_haptics.geometry.decomposition.pieces import (
    ConvexHulls,
    MergedPatches,
    PatchLabels,
    PieceData,
)
from drake_haptics.geometry.decomposition.report import DecompositionReport
from drake_haptics.geometry.decomposition.storage import (
    cache_key,
    load_cached,
    read_decomposition,
    store_cached,
    write_decomposition,
)
from drake_haptics.geometry.mesh.mesh import Mesh

Method = Literal["surface", "merged", "hull", "coacd"]
METHODS: tuple[Method, ...] = get_args(Method)
Progress = Callable[[float], None]

# Distance, relative to the mesh's size, within which a facet of CoACD's pieces counts
# as on the mesh, because CoACD remeshes.
_ON_MESH = 5e-3

# Share of the progress for finding the exact pieces before merging.
_EXACT_SHARE = 0.2


@dataclass(frozen=True, eq=False)
class Decomposition:
    """A mesh and its convex pieces.

    Attributes:
        mesh: The mesh.
        core: The pieces in the form of the core.
        method: Method by which they were made.
        report: Counts and time.
    """

    mesh: Mesh
    core: _core.ConvexPieces
    method: Method
    report: DecompositionReport
    _data: PieceData

    @property
    def pieces(self) -> list[_core.ConvexPolytope]:
        """The convex pieces; facets that are not on the mesh are marked."""
        return self.core.pieces

    def __repr__(self) -> str:
        pieces = count(len(self.core.pieces), "piece")
        return (
            f"Decomposition({self.report.source!r}, {pieces}, method={self.method!r})"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        # The core's part is rebuilt from the content of a file.
        return _assemble, (self.mesh, self.method, self._data, self.report.from_cache)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes mesh and pieces to an .npz file, atomically.

        Raises:
            OSError: The file cannot be written.
        """
        write_decomposition(Path(path), self.mesh, self.method, self._data)

    @staticmethod
    def load(path: str | os.PathLike[str]) -> Decomposition:
        """Reads a file of `save`.

        Raises:
            DecompositionFileError: The file is damaged, of another kind or of another
                version of the format.
            OSError: The file cannot be opened.
        """
        mesh, method, data = read_decomposition(Path(path))
        return _assemble(mesh, _checked_method(method), data, from_cache=True)


def decompose(
    mesh: Mesh,
    method: Method = "surface",
    *,
    error_m: float | None = None,
    progress: Progress | None = None,
    cache: bool = True,
) -> Decomposition:
    """Cuts a mesh into convex pieces.

    Args:
        mesh: Mesh from `load_mesh` or `Mesh.from_arrays`.
        method: "surface" covers the mesh exactly: patches grow while they are convex
            and their hulls stay inside the solid (Kim, Otaduy, Lin and Manocha 2003,
            section 5.3.1). A solid that differs from its hull only by round-off gives
            one piece: pieces may leave the solid by 1e-6 of the mesh's size, or by more
            in a mesh far from its origin in single precision. Pieces of a surface that
            bounds no solid are one-sided. "merged" joins such pieces within `error_m`,
            see `drake_haptics.geometry.decomposition.approximate`. "hull" is one convex
            hull for each component, all of which is felt: it fills hollows. "coacd"
            approximates solids by few pieces (optional extra); it fills cavities.
        error_m: Largest departure of a piece from the mesh, m; only for "merged".
        progress: Function that is called repeatedly with the share done, from 0 to 1.
            An exception that it raises ends the work and is passed on.
        cache: Whether to use and store results on disk; see
            `drake_haptics.common.disk_cache`.

    Raises:
        HapticsError: `mesh` is not a `Mesh`, the method is unknown, or its error or its
            optional package is missing.
        TypeError: `error_m` is not a number.
    """
    if not isinstance(mesh, Mesh):
        raise HapticsError(
            f"mesh must be a Mesh, got {type(mesh).__name__}; see load_mesh() and "
            f"Mesh.from_arrays()"
        )
    method = _checked_method(method)
    check_error(method, error_m)
    if error_m is not None:
        error_m = float(error_m)  # JSON has no numbers of NumPy
    report_share = progress or (lambda share: None)
    parameters = _parameters(method, error_m)
    key = cache_key(mesh, method, parameters) if cache else ""
    data = load_cached(key, mesh) if cache else None
    from_cache = data is not None
    if data is None:
        if error_m is not None:
            exact = decompose(
                mesh, progress=lambda s: report_share(_EXACT_SHARE * s), cache=cache
            )
            data = merge_patches(
                mesh,
                np.array(exact.core.piece_of_triangle, dtype=np.int32),
                error_m,
                lambda s: report_share(_EXACT_SHARE + (1 - _EXACT_SHARE) * s),
            )
        else:
            data = _find_pieces(mesh, method, report_share)
        if cache:
            store_cached(key, data)
    report_share(1.0)
    return _assemble(mesh, method, data, from_cache)


def _checked_method(method: str) -> Method:
    if method not in METHODS:
        known = ", ".join(METHODS)
        raise HapticsError(f"unknown decomposition method {method!r}; known: {known}")
    return method


def _parameters(method: Method, error_m: float | None) -> dict[str, Any]:
    if error_m is not None:
        return {"error_m": error_m}
    if method == "hull":
        return {"facets": "all felt"}
    return coacd_parameters() if method == "coacd" else {}


def _find_pieces(mesh: Mesh, method: Method, progress: Progress) -> PieceData:
    start = time.perf_counter()
    if method == "surface":

        def step(share: float) -> bool:
            progress(share)
            return True

        core = _core.decompose_surface(mesh.vertices, mesh.triangles, mesh.solid, step)
        seconds = time.perf_counter() - start
        return PatchLabels(np.array(core.piece_of_triangle, dtype=np.int32), seconds)
    if method == "hull":
        hulls = [_points(mesh, index) for index in range(len(mesh.components))]
    else:
        hulls = coacd_hulls(mesh, progress)
    size_m = float(np.linalg.norm(mesh.report.extent))
    # A hull replaces the solid: all of it is felt, or a tool would fall into hollows.
    tolerance = math.inf if method == "hull" else _ON_MESH * size_m
    return ConvexHulls.of(hulls, tolerance, time.perf_counter() - start)


def _points(mesh: Mesh, component: int) -> np.ndarray:
    triangles = mesh.triangles[mesh.component_of_triangle == component]
    return mesh.vertices[np.unique(triangles)]


def _assemble(
    mesh: Mesh, method: Method, data: PieceData, from_cache: bool
) -> Decomposition:
    core = data.assemble(mesh)
    solid_pieces = [piece for piece in core.pieces if piece.dimension == 3]
    num_flat = len(core.pieces) - len(solid_pieces)
    originals = [np.asarray(piece.facet_original) for piece in solid_pieces]
    report = DecompositionReport(
        source=mesh.report.source,
        method=method,
        triangles=len(mesh.triangles),
        one_sided_triangles=mesh.report.one_sided_triangles,
        pieces=len(core.pieces),
        flat_pieces=num_flat,
        facets=sum(map(len, originals)) + num_flat,
        virtual_facets=sum(int((~original).sum()) for original in originals),
        seconds=data.seconds,
        from_cache=from_cache,
        departure_m=data.departure_m if isinstance(data, MergedPatches) else None,
    )
    return Decomposition(mesh, core, method, report, data)
