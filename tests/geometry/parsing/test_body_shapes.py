"""Shapes of a plant's bodies become pieces in the frame of the body."""

import numpy as np
import pytest
import trimesh
from pydrake.geometry import (
    Box,
    Capsule,
    Convex,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    Mesh,
    MeshcatCone,
    Role,
    Sphere,
)
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, CoulombFriction
from pydrake.multibody.tree import SpatialInertia
from pydrake.systems.framework import DiagramBuilder

from drake_haptics.common.errors import MeshError
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import load_mesh
from drake_haptics.geometry.parsing.body_shapes import (
    decompose_body,
    find_body_geometries,
)

X_BG = RigidTransform(RollPitchYaw(0.3, -0.5, 1.1), [0.1, -0.2, 0.05])
COLOR = [0.5, 0.5, 0.5, 1.0]


def make_body(*shapes, X_BG=X_BG, visual=()):
    """Returns what `decompose_body` takes, of a body with these shapes."""
    builder = DiagramBuilder()
    plant, scene_graph = AddMultibodyPlantSceneGraph(builder, 0.0)
    body = plant.AddRigidBody("thing", SpatialInertia.SolidCubeWithDensity(1e3, 0.1))
    for n, shape in enumerate(shapes):
        plant.RegisterCollisionGeometry(
            body, X_BG, shape, f"part{n}", CoulombFriction()
        )
    for n, shape in enumerate(visual):
        plant.RegisterVisualGeometry(body, X_BG, shape, f"look{n}", COLOR)
    plant.Finalize()
    return plant, scene_graph.model_inspector(), body


def write_ring(folder):
    path = folder / "ring.obj"
    trimesh.creation.annulus(0.02, 0.04, 0.01, sections=16).export(path)
    return path


def mesh_of(decomposition):
    return trimesh.Trimesh(
        decomposition.vertices, decomposition.triangles, process=False
    )


@pytest.mark.parametrize(
    ("shape", "volume", "error_area"),
    [
        (Box(0.1, 0.2, 0.3), 0.006, 0.0),
        (Sphere(0.05), 4 / 3 * np.pi * 0.05**3, 4 * np.pi * 0.05**2),
        (Ellipsoid(0.05, 0.03, 0.04), 4 / 3 * np.pi * 6e-5, 4 * np.pi * 0.05**2),
        (Cylinder(0.05, 0.2), np.pi * 0.05**2 * 0.2, 2 * np.pi * 0.05 * 0.2),
        (
            Capsule(0.05, 0.2),
            np.pi * 0.05**2 * 0.2 + 4 / 3 * np.pi * 0.05**3,
            2 * np.pi * 0.05 * 0.2 + 4 * np.pi * 0.05**2,
        ),
    ],
    ids=lambda value: type(value).__name__,
)
def test_a_convex_shape_is_one_closed_piece_of_its_volume(shape, volume, error_area):
    decomposition = decompose_body(*make_body(shape), chord_error_m=2e-4)
    assert len(decomposition.pieces) == 1
    assert decomposition.pieces[0].facet_original.all()
    mesh = mesh_of(decomposition)
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(volume, abs=2e-4 * error_area + 1e-12)


def test_shapes_are_posed_in_the_body():
    box = Box(0.1, 0.2, 0.3)
    decomposition = decompose_body(*make_body(box))
    p_GV = X_BG.inverse() @ np.asarray(decomposition.pieces[0].vertices).T
    np.testing.assert_allclose(
        np.abs(p_GV), np.tile([[0.05], [0.1], [0.15]], 8), atol=1e-15
    )


def test_a_mesh_keeps_its_hole(tmp_path):
    """Drake's own contact would fill it."""
    path = write_ring(tmp_path)
    ring = decompose_body(*make_body(Mesh(path, scale3=np.array([2.0, 2.0, 1.0]))))
    truth = load_mesh(path)
    assert len(ring.pieces) == len(decompose(truth).pieces) > 1
    assert mesh_of(ring).volume == pytest.approx(4 * truth.report.volume, rel=1e-6)
    p_GV = (X_BG.inverse() @ np.asarray(ring.vertices).T).T
    radius = np.hypot(p_GV[:, 0], p_GV[:, 1])
    assert radius.min() == pytest.approx(0.04, abs=1e-6)
    assert radius.max() == pytest.approx(0.08, abs=1e-6)


def test_a_convex_is_the_hull_of_its_mesh(tmp_path):
    solid = decompose_body(*make_body(Convex(write_ring(tmp_path), scale=2.0)))
    assert len(solid.pieces) == 1
    p_GV = (X_BG.inverse() @ np.asarray(solid.vertices).T).T
    assert np.hypot(p_GV[:, 0], p_GV[:, 1]).min() == pytest.approx(0.08, abs=1e-6)


def test_shapes_of_one_body_are_united_each_whole(tmp_path):
    """Also where one is inside another, or two share a face."""
    inside, outside, beside = Box(0.1, 0.1, 0.1), Sphere(0.2), Box(0.1, 0.1, 0.1)
    plant, inspector, body = make_body(
        inside, outside, Mesh(write_ring(tmp_path)), beside
    )
    whole = decompose_body(plant, inspector, body)
    alone = [
        decompose_body(*make_body(shape))
        for shape in (inside, outside, Mesh(write_ring(tmp_path)), beside)
    ]
    assert len(whole.pieces) == sum(len(part.pieces) for part in alone)
    for piece, expected in zip(
        whole.pieces, [piece for part in alone for piece in part.pieces], strict=True
    ):
        np.testing.assert_array_equal(piece.vertices, expected.vertices)
        np.testing.assert_array_equal(piece.facet_original, expected.facet_original)
    assert mesh_of(whole).volume == pytest.approx(
        sum(mesh_of(part).volume for part in alone)
    )


def test_the_role_chooses_the_shapes():
    plant, inspector, body = make_body(Box(1, 1, 1), visual=[Sphere(0.1)])
    seen = decompose_body(plant, inspector, body, role=Role.kIllustration)
    assert len(seen.vertices) > 8
    assert len(decompose_body(plant, inspector, body).vertices) == 8
    assert [
        inspector.GetName(i) for i in find_body_geometries(plant, inspector, body)
    ] == ["part0"]


def test_a_body_without_shapes_of_the_role_is_named():
    given = make_body(visual=[Sphere(0.1)])
    with pytest.raises(
        ValueError, match=r"'thing' has no shape with the role prox.*kIl"
    ):
        decompose_body(*given)
    with pytest.raises(ValueError, match=r"role illustration.*kProximity"):
        decompose_body(*make_body(Sphere(0.1)), role=Role.kIllustration)


def test_a_role_that_nothing_is_touched_by_is_refused():
    with pytest.raises(ValueError, match=r"role must be .*kPerception"):
        decompose_body(*make_body(Sphere(0.1)), role=Role.kPerception)


def test_what_cannot_be_touched_is_refused_by_name():
    with pytest.raises(ValueError, match=r"part0' of body 'thing': .*large Box"):
        decompose_body(*make_body(HalfSpace()))
    with pytest.raises(ValueError, match=r"look0' of body 'thing': .*MeshcatCone"):
        decompose_body(*make_body(visual=[MeshcatCone(1.0)]), role=Role.kIllustration)


def test_a_mesh_that_cannot_be_read_is_a_mesh_error_with_its_name(tmp_path):
    path = tmp_path / "empty.obj"
    path.write_text("")
    given = make_body(visual=[Mesh(path)])
    with pytest.raises(MeshError, match=r"look0' of body 'thing': .*empty\.obj"):
        decompose_body(*given, role=Role.kIllustration)
    given = make_body(visual=[Convex(path)])
    with pytest.raises(MeshError, match="look0' of body 'thing': has no convex hull"):
        decompose_body(*given, role=Role.kIllustration)


def test_what_has_no_volume_has_nothing_to_be_inside_of():
    with pytest.raises(ValueError, match="has no volume"):
        decompose_body(*make_body(Ellipsoid(0.1, 0.1, 1e-17)))


def test_a_convex_of_points_needs_no_faces():
    corners = np.array([[0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
    given = make_body(
        Convex(points=corners, label="tetrahedron"), X_BG=RigidTransform()
    )
    piece = decompose_body(*given).pieces[0]
    found = sorted(map(tuple, np.asarray(piece.vertices).tolist()))
    assert found == sorted(map(tuple, corners.T.tolist()))


def test_progress_goes_from_shape_to_shape(tmp_path):
    ring = Mesh(write_ring(tmp_path))
    shares = []
    decompose_body(*make_body(ring, ring), progress=shares.append)
    assert shares == sorted(shares)
    assert 0.5 in shares
    assert shares[-1] == 1.0
