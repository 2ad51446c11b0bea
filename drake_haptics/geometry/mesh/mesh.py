"""Loads a mesh from a file or arrays, and computes its mass properties.

A mesh that cannot be used raises a `MeshError`; every other defect is repaired or left
as it is, and named in the mesh's report. Self-intersections are not detected, because
only the surface counts.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_haptics._core import RigidToolDynamics
from drake_haptics.common.errors import MeshError
from drake_haptics.common.one_line import count
from drake_haptics.common.value_checks import check_positive
from drake_haptics.geometry.mesh.checks import (
    check_branching,
    check_components,
    check_folds,
    check_holes,
    check_size,
    checked_arrays,
)
from drake_haptics.geometry.mesh.concave_polygons import triangulate_concave_polygons
from drake_haptics.geometry.mesh.reader import read_mesh_file
from drake_haptics.geometry.mesh.repair import (
    distinct_faces,
    drop_unused_vertices,
    equal_vertices,
    join_open_parts,
    remove_zero_area_faces,
    separate_components,
)
from drake_haptics.geometry.mesh.report import Finding, Findings, MeshReport, Severity
from drake_haptics.geometry.mesh.units import meters_per_unit
from drake_haptics.geometry.mesh.winding import Winding, wind_components


@dataclass(frozen=True)
class Component:
    """A connected part of a mesh.

    Attributes:
        triangles: Number of its triangles.
        closed: Whether every edge has a triangle on both sides, coherently wound.
        orientable: Whether it has two sides.
        solid: Whether it bounds a solid: closed, with volume, and wound outward (away
            from the material, so the wall of a cavity faces into the cavity).
        cavity: Whether it is the wall of a cavity in another component.
        volume: Volume, m³, negative for a cavity; None unless closed.
        area: Area, m².
        bounds: Corners of the box, ((x, y, z) lowest, (x, y, z) highest), m.
    """

    triangles: int
    closed: bool
    orientable: bool
    solid: bool
    cavity: bool
    volume: float | None
    area: float
    bounds: tuple[tuple[float, float, float], tuple[float, float, float]]


@dataclass(frozen=True, eq=False)
class Mesh:
    """A triangle mesh that passed the intake; all arrays are read-only.

    Attributes:
        vertices: (n, 3) float64 vertices, m.
        triangles: (m, 3) int32 indices, counter-clockwise seen from outside.
        component_of_triangle: (m,) int32 component of each triangle.
        solid: (m,) uint8, 1 where the triangle's component bounds a solid.
        components: Components in order of their first triangles.
        report: Report on what was found and done.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int32]
    component_of_triangle: NDArray[np.int32]
    solid: NDArray[np.uint8]
    components: tuple[Component, ...]
    report: MeshReport

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        for value in state.values():
            if isinstance(value, np.ndarray):
                value.flags.writeable = False  # pickles and deep copies have no flags

    def __repr__(self) -> str:
        size_mm = " × ".join(f"{1e3 * side:.4g}" for side in self.report.extent)
        return (
            f"Mesh({self.report.source!r}, "
            f"{count(len(self.vertices), 'vertex', 'vertices')}, "
            f"{count(len(self.triangles), 'triangle')}, {size_mm} mm)"
        )

    @staticmethod
    def from_arrays(
        vertices: Any,
        triangles: Any,
        *,
        name: str | os.PathLike[str] = "mesh",
        strict: bool = False,
    ) -> Mesh:
        """Makes a mesh from arrays.

        Args:
            vertices: (n, 3) real numbers, m.
            triangles: (m, 3) integers, indices of vertices.
            name: Name for messages, or the path that the arrays are of.
            strict: Whether to refuse a mesh that has a defect, repairable or not.

        Raises:
            MeshError: The arrays have wrong shapes or types, a number that is not
                finite, an index out of range, or no triangle with an area; or `strict`
                is set and there is a defect.
        """
        findings = Findings()
        return _take_in(vertices, triangles, os.fspath(name), 1.0, findings, strict)


def load_mesh(
    path: str | os.PathLike[str],
    *,
    unit: str | None = None,
    scale: float | None = None,
    strict: bool = False,
) -> Mesh:
    """Reads a mesh file, and merges the placed parts of a scene.

    Args:
        path: Any format that trimesh reads, or .npz with V (n, 3) and F (m, 3);
            `package://...` names a file of this package or of Drake.
        unit: Length unit of the file, such as "mm" or "in".
        scale: Meters per unit of the file, instead of `unit`. Without either, the file
            is in meters.
        strict: Whether to refuse a mesh that has a defect, repairable or not.

    Raises:
        MeshError: The file cannot be read, or for the reasons in `Mesh.from_arrays`.
        TypeError: The unit is not a text, or the scale not a number.
    """
    factor = meters_per_unit(unit, scale)
    raw = read_mesh_file(path)
    findings = Findings()
    if raw.parts > 1:
        findings.add(
            "scene",
            Severity.NOTE,
            raw.parts,
            f"the file is a scene of {raw.parts} placed geometries",
            "merged into one mesh, each where it is placed",
        )
    stated = unit is not None or scale is not None
    return _take_in(
        raw.vertices,
        raw.triangles,
        os.fspath(path),
        factor,
        findings,
        strict,
        None if stated else raw.unit,
    )


def _take_in(
    vertices: Any,
    triangles: Any,
    name: str,
    factor: float,
    findings: Findings,
    strict: bool,
    ignored_unit: str | None = None,
) -> Mesh:
    try:
        V, F = checked_arrays(vertices, triangles, factor)
        num_unused = len(V) - len(np.unique(F))
        twin = equal_vertices(V)
        F = F[distinct_faces(twin[F], findings)]
        F = join_open_parts(F, twin, findings)
        F = remove_zero_area_faces(V, F, findings)
        F = triangulate_concave_polygons(V, F, findings)
    except MeshError as error:
        raise MeshError(f"{name}: {error}") from None
    findings.add(
        "unused-vertices",
        Severity.NOTE,
        num_unused,
        count(
            num_unused,
            "vertex belongs to no triangle",
            "vertices belong to no triangle",
        ),
        "dropped",
    )
    V, F = drop_unused_vertices(V, F)
    check_branching(F, findings)
    winding = wind_components(V, F, findings)
    V, F = separate_components(V, winding.triangles, winding.component)
    check_holes(F, winding.component, findings)
    thick = winding.solid | ~winding.closed
    check_folds(V, F, thick[winding.component], findings)
    check_components(winding.orientable, winding.closed, winding.solid, findings)
    extent = V.max(axis=0) - V.min(axis=0)
    check_size(extent, factor, ignored_unit, findings)
    mesh = _freeze(V, F, winding, name, factor, extent, findings)
    if strict and mesh.report.unclean:
        raise MeshError(mesh.report.refusal)
    return mesh


def _freeze(
    V: np.ndarray,
    F: np.ndarray,
    winding: Winding,
    name: str,
    factor: float,
    extent: np.ndarray,
    findings: Findings,
) -> Mesh:
    components = _describe_components(V, F, winding)
    solid = winding.solid[winding.component]
    x, y, z = extent.tolist()
    report = MeshReport(
        source=name,
        meters_per_unit=factor,
        vertices=len(V),
        triangles=len(F),
        components=len(components),
        solids=sum(c.solid for c in components),
        one_sided_triangles=int((~solid).sum()),
        extent=(x, y, z),
        area=float(winding.area.sum()),
        volume=float(winding.volume[winding.solid].sum()),
        findings=tuple(findings),
    )
    return Mesh(
        _read_only(V, np.float64),
        _read_only(F, np.int32),
        _read_only(winding.component, np.int32),
        _read_only(solid, np.uint8),
        components,
        report,
    )


def _describe_components(
    V: np.ndarray, F: np.ndarray, winding: Winding
) -> tuple[Component, ...]:
    k = len(winding.closed)
    low = np.full((k, 3), np.inf)
    high = np.full((k, 3), -np.inf)
    of_corner = np.repeat(winding.component, 3)
    np.minimum.at(low, of_corner, V[F.ravel()])
    np.maximum.at(high, of_corner, V[F.ravel()])
    count = np.bincount(winding.component, minlength=k)
    return tuple(
        Component(
            triangles=int(count[c]),
            closed=bool(winding.closed[c]),
            orientable=bool(winding.orientable[c]),
            solid=bool(winding.solid[c]),
            cavity=bool(winding.cavity[c]),
            volume=float(winding.volume[c]) if winding.closed[c] else None,
            area=float(winding.area[c]),
            bounds=(tuple(low[c].tolist()), tuple(high[c].tolist())),
        )
        for c in range(k)
    )


def _read_only(array: np.ndarray, dtype: Any) -> np.ndarray:
    result = np.array(array, dtype=dtype, order="C")  # a copy
    result.flags.writeable = False
    return result


def continue_report(
    mesh: Mesh, before: Mesh, finding: Finding, error_m: float = 0.0
) -> Mesh:
    """Returns a mesh that was made of another one, with its findings and one more.

    Args:
        mesh: The mesh.
        before: Mesh of which it was made, whose unit and error stay.
        finding: Finding that says what was done.
        error_m: Distance between both surfaces, m.
    """
    report = replace(
        mesh.report,
        meters_per_unit=before.report.meters_per_unit,
        findings=(*before.report.findings, finding),
        decimation_error_m=before.report.decimation_error_m + error_m,
    )
    return replace(mesh, report=report)


def make_tool_dynamics(mesh: Mesh, mass_kg: float) -> RigidToolDynamics:
    """Returns the dynamics of a tool with a mesh's shape, for `AddHapticLoop`.

    Args:
        mesh: Mesh of uniform density, as for `calc_mass_properties`.
        mass_kg: Mass, kg.

    Raises:
        ValueError: The mass is not positive.
        MeshError: The mesh is as thin as a line, about which it has no inertia.
    """
    p_TTcm, I_TTcm_T = calc_mass_properties(mesh, mass_kg)
    try:
        return RigidToolDynamics(mass_kg, p_TTcm, I_TTcm_T)
    except ValueError as error:
        raise MeshError(
            f"{mesh.report.source}: as a tool of {mass_kg:g} kg, {error}. Is the mesh"
            " as thin as a line, or its scale wrong?"
        ) from error


def calc_mass_properties(mesh: Mesh, mass_kg: float) -> tuple[np.ndarray, np.ndarray]:
    """Returns mass, center of mass and rotational inertia of a mesh.

    A mesh that bounds solids has a uniform density; one that is open anywhere is a
    shell with a uniform density per area.

    Args:
        mesh: The mesh, in a frame M.
        mass_kg: Mass, kg.

    Returns:
        p_MMcm (3,), m, and I_MMcm_M (3, 3), kg·m².

    Raises:
        ValueError: The mass is not positive.
    """
    check_positive(mass_kg=mass_kg)
    # Near the mesh, since about a far origin all digits would cancel: at a multiple of
    # a power of two, by which vertices move without rounding.
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    size = 2.0 ** np.ceil(np.log2((high - low).max()))
    middle = size * np.round((low + high) / 2.0 / size)
    a, b, c = np.swapaxes((mesh.vertices - middle)[mesh.triangles], 0, 1)
    corner_sum = a + b + c
    if mesh.solid.all():
        # Tetrahedra from there, signed (their fourth corner is 0).
        weight = np.einsum("ni,ni->n", np.cross(a, b), c) / 6.0
        first = corner_sum / 4.0
        second = 1.0 / 20.0
    else:
        weight = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2.0
        first = corner_sum / 3.0
        second = 1.0 / 12.0
    weight = weight * (mass_kg / weight.sum())
    center = weight @ first / mass_kg
    # The second moment of a simplex from its vertices and their sum.
    moment = np.zeros((3, 3))
    for corner in (a, b, c, corner_sum):
        moment += second * np.einsum("n,ni,nj->ij", weight, corner, corner)
    moment -= mass_kg * np.outer(center, center)
    return middle + center, np.trace(moment) * np.eye(3) - moment
