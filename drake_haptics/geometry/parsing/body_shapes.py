"""Makes convex pieces of the shapes of a plant's body."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from pydrake.common import MemoryFile
from pydrake.geometry import (
    Box,
    Capsule,
    Convex,
    Cylinder,
    Ellipsoid,
    GeometryId,
    HalfSpace,
    InMemoryMesh,
    Mesh,
    MeshcatCone,
    MeshSource,
    Role,
    SceneGraphInspector,
    Shape,
    Sphere,
)
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import RigidBody

from drake_haptics import _core
from drake_haptics.common.errors import MeshError
from drake_haptics.geometry.decomposition.decompose import Progress, decompose
from drake_haptics.geometry.decomposition.pieces import cut_fans
from drake_haptics.geometry.mesh.mesh import Mesh as IntakeMesh
from drake_haptics.geometry.mesh.reader import RawMesh, read_mesh_file
from drake_haptics.geometry.mesh.round_shapes import (
    make_box_corners,
    make_capsule_corners,
    make_cylinder_corners,
    make_ellipsoid_corners,
)
from drake_haptics.geometry.mesh.topology import unite_surfaces

_ROLE_NAMES = {Role.kProximity: "proximity", Role.kIllustration: "illustration"}
# glTF's y axis is up; Drake rotates it to z.
_Y_UP = (".gltf", ".glb")
_R_DRAKE_GLTF = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


def find_body_geometries(
    plant: MultibodyPlant,
    inspector: SceneGraphInspector,
    body: RigidBody,
    role: Role = Role.kProximity,
) -> list[GeometryId]:
    """Returns the geometries of a body that have a role, in order of registration."""
    frame_id = plant.GetBodyFrameIdIfExists(body.index())
    return [] if frame_id is None else list(inspector.GetGeometries(frame_id, role))


def decompose_body(
    plant: MultibodyPlant,
    inspector: SceneGraphInspector,
    body: RigidBody,
    *,
    role: Role = Role.kProximity,
    chord_error_m: float = 1e-4,
    progress: Progress | None = None,
) -> _core.ConvexPieces:
    """Returns all shapes of a body as one set of convex pieces in the body's frame.

    A `Mesh` keeps its true, possibly non-convex shape, unlike in Drake's point contact,
    which uses its convex hull; `decompose` cuts it into pieces. `Box` is exact,
    `Convex` the hull of its points, and `Sphere`, `Cylinder`, `Capsule` and `Ellipsoid`
    are convex polytopes (`drake_haptics.geometry.mesh.round_shapes`): one piece each.
    Overlapping shapes of a body keep their surfaces.

    Args:
        plant: Plant that is registered with a scene graph.
        inspector: Inspector of that scene graph's model.
        body: Body of the plant.
        role: Role of the shapes that count: proximity or illustration.
        chord_error_m: Largest distance between round shapes and the polytopes that
            approximate them, m.
        progress: Function that is called while meshes are decomposed, with the share
            done, from 0 to 1.

    Raises:
        ValueError: The body has no such shapes, one of them is unbounded or only drawn,
            the role is not supported, or the chord error is out of range. A mesh that
            cannot be used is a `MeshError`.
    """
    if role not in _ROLE_NAMES:
        raise ValueError(f"role must be kProximity or kIllustration, is {role.name}")
    geometries = find_body_geometries(plant, inspector, body, role)
    if not geometries:
        other = "kIllustration" if role == Role.kProximity else "kProximity"
        raise ValueError(
            f"body {body.name()!r} has no shape with the role {_ROLE_NAMES[role]}: give"
            f" it a {'collision' if role == Role.kProximity else 'visual'} geometry, or"
            f" use role=Role.{other}"
        )
    parts = []
    for n, geometry_id in enumerate(geometries):
        shape = inspector.GetShape(geometry_id)
        step = _share_of_all(progress, n, len(geometries)) if progress else None
        try:
            parts.append(
                _decompose_shape(
                    shape,
                    inspector.GetPoseInFrame(geometry_id).GetAsMatrix4(),
                    chord_error_m,
                    step,
                )
            )
        except ValueError as error:
            where = f"{inspector.GetName(geometry_id)!r} of body {body.name()!r}"
            kind = MeshError if isinstance(error, MeshError) else ValueError
            raise kind(f"geometry {where}: {error}") from error
    return parts[0] if len(parts) == 1 else _unite(parts)


def _share_of_all(progress: Progress, done: int, count: int) -> Progress:
    return lambda share: progress((done + share) / count)


def _decompose_shape(
    shape: Shape, X_BG: np.ndarray, chord_error_m: float, progress: Progress | None
) -> _core.ConvexPieces:
    """Returns the pieces of one shape at X_BG (4, 4)."""
    if not isinstance(shape, Mesh):
        p_GV = _find_corners(shape, chord_error_m)
        return _make_convex(p_GV @ X_BG[:3, :3].T + X_BG[:3, 3])
    raw = read_mesh_source(shape.source(), shape.scale3())
    mesh = IntakeMesh.from_arrays(
        raw.vertices, raw.triangles, name=shape.source().description()
    )
    # Cut in the mesh's frame, so that the pieces are cached for all poses.
    pieces = decompose(mesh, progress=progress).core
    return _core.assemble_surface_pieces(
        pieces.vertices @ X_BG[:3, :3].T + X_BG[:3, 3],
        pieces.triangles,
        pieces.piece_of_triangle,
    )


def _find_corners(shape: Shape, chord_error_m: float) -> np.ndarray:
    """Returns points (n, 3) in the shape's frame whose hull approximates it, m."""
    find: dict[type, Callable[..., np.ndarray]] = {
        Convex: _find_hull_corners,
        Box: lambda s: make_box_corners(s.size()),
        Sphere: lambda s: make_ellipsoid_corners((s.radius(),) * 3, chord_error_m),
        Ellipsoid: lambda s: make_ellipsoid_corners(
            (s.a(), s.b(), s.c()), chord_error_m
        ),
        Cylinder: lambda s: make_cylinder_corners(
            s.radius(), s.length(), chord_error_m
        ),
        Capsule: lambda s: make_capsule_corners(s.radius(), s.length(), chord_error_m),
    }
    if isinstance(shape, HalfSpace):
        raise ValueError("is a HalfSpace, which is infinite: use a large Box instead")
    if isinstance(shape, MeshcatCone):
        raise ValueError("is a MeshcatCone, which is only drawn: use a Mesh instead")
    if type(shape) not in find:
        known = ", ".join(kind.__name__ for kind in (Mesh, *find))
        raise ValueError(f"is a {type(shape).__name__}; known shapes are {known}")
    return find[type(shape)](shape)


def _find_hull_corners(shape: Convex) -> np.ndarray:
    """Returns the corners (n, 3) of the hull that Drake finds."""
    try:
        hull = shape.GetConvexHull()
    except RuntimeError as error:
        raise MeshError(f"has no convex hull: {error}") from error
    return np.array([hull.vertex(i) for i in range(hull.num_vertices())])


def _make_convex(corners: np.ndarray) -> _core.ConvexPieces:
    """Returns the hull of points (n, 3), m, as one piece."""
    hull = _core.ConvexPolytope(corners)
    if hull.dimension < 3:
        raise ValueError("has no volume, so that nothing can be inside of it")
    triangles = cut_fans(hull.facets)
    return _core.assemble_surface_pieces(
        hull.vertices, triangles, np.zeros(len(triangles), dtype=np.int32)
    )


def _unite(parts: list[_core.ConvexPieces]) -> _core.ConvexPieces:
    """Returns all pieces as those of one object."""
    vertices, triangles = unite_surfaces(
        [(part.vertices, part.triangles) for part in parts]
    )
    first = np.cumsum([0, *(len(part.pieces) for part in parts)])
    pieces = [part.piece_of_triangle + k for part, k in zip(parts, first, strict=False)]
    return _core.assemble_surface_pieces(
        vertices, triangles.astype(np.int32), np.concatenate(pieces).astype(np.int32)
    )


def read_mesh_source(source: MeshSource, scale3: np.ndarray) -> RawMesh:
    """Reads a mesh as Drake places it in the frame of its geometry.

    Args:
        source: Source that names or contains a file.
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
        triangles = triangles[:, ::-1]  # a reflection reverses the winding
    return RawMesh(vertices * scale3, triangles)


def _read(source: MeshSource) -> RawMesh:
    if source.is_path():
        return read_mesh_file(source.path())
    with TemporaryDirectory() as folder:
        path = _write(source.in_memory(), Path(folder))
        try:
            return read_mesh_file(path)
        except MeshError as error:
            # The temporary file no longer exists when the message is read.
            raise MeshError(
                str(error).replace(str(path), source.description())
            ) from error


def _write(mesh: InMemoryMesh, folder: Path) -> Path:
    """Writes a mesh in memory, and the files that it names, to a folder."""
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
