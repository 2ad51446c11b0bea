"""Decimation: few triangles, still the same solid, and an error that is true."""

import numpy as np
import pytest
from mesh_samples import box, joined, real_mesh
from shapes import SHAPES
from surface_distance import distances

from drake_haptics import _core
from drake_haptics.common.errors import MeshError
from drake_haptics.geometry.mesh.decimation import decimate
from drake_haptics.geometry.mesh.mesh import Mesh, load_mesh
from drake_haptics.geometry.mesh.report import Severity


def shape(name):
    surface = SHAPES[name]()
    return Mesh.from_arrays(surface.vertices, surface.triangles, name=name)


def sample(mesh, count):
    """Corners, and points spread evenly over the area."""
    rng = np.random.default_rng(0)
    corners = mesh.vertices[mesh.triangles]
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = np.linalg.norm(np.cross(a, b), axis=1)
    t = rng.choice(len(corners), count, p=area / area.sum())
    u = np.sort(rng.random((2, count, 1)), axis=0)
    inner = corners[t, 0] + u[0] * a[t] + (u[1] - u[0]) * b[t]
    return np.concatenate([mesh.vertices, inner])


@pytest.mark.parametrize("name", ["cup", "torus", "hammer"])
@pytest.mark.parametrize("share", [0.5, 0.2])
def test_a_solid_stays_a_solid_and_the_error_is_that_of_dense_samples(name, share):
    mesh = shape(name)
    count = int(share * len(mesh.triangles))
    fewer = decimate(mesh, count)
    assert 0.9 * count <= len(fewer.triangles) <= count
    assert fewer.solid.all() and len(fewer.components) == 1
    assert fewer.report.source == name
    known = set(map(tuple, mesh.vertices))
    assert all(tuple(v) in known for v in fewer.vertices)
    sampled = max(
        distances(sample(fewer, 700), mesh.vertices, mesh.triangles).max(),
        distances(sample(mesh, 700), fewer.vertices, fewer.triangles).max(),
    )
    error_m = fewer.report.decimation_error_m
    assert sampled <= error_m <= 1.25 * sampled


def test_the_error_of_a_mesh_that_is_decimated_twice_is_from_the_first():
    mesh = shape("torus")
    count = len(mesh.triangles)
    fewer = decimate(decimate(mesh, count // 2), count // 2 - 10)
    between_m = _core.surface_distance(
        mesh.vertices, mesh.triangles, fewer.vertices, fewer.triangles
    )
    assert fewer.report.decimation_error_m >= between_m


def test_the_error_between_two_planes_is_their_distance():
    V, F = box()
    F = F.astype(np.int32)
    lifted = _core.surface_distance(V, F[:2], V - np.array([0.25, 0.0, 0.0]), F[:2])
    assert lifted == pytest.approx(0.25, rel=0.05) and lifted >= 0.25
    # The middle of a square's diagonal is farthest from its three other sides.
    tent = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 0.3]])
    roof = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]], dtype=np.int32)
    floor = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32)
    height = _core.surface_distance(tent, roof, tent[:4].copy(), floor)
    assert 0.3 <= height <= 0.3 * 1.05


def test_what_has_few_triangles_already_is_left_alone():
    mesh = Mesh.from_arrays(*box())
    assert decimate(mesh, 12) is mesh
    assert mesh.report.decimation_error_m == 0.0


def test_the_report_tells_what_was_done():
    report = decimate(shape("cup"), 200).report
    (finding,) = (f for f in report.findings if f.code == "decimated")
    assert "from 504 to 200 triangles" in finding.message
    assert "mm of the original" in finding.action
    assert finding.severity is Severity.NOTE
    assert not report.unclean


def test_an_error_that_is_large_beside_the_mesh_is_asked_about():
    mesh = shape("cup")
    report = decimate(mesh, 20).report
    (finding,) = (f for f in report.findings if f.code == "decimated")
    assert report.decimation_error_m > 0.2 * max(mesh.report.extent)
    assert finding.severity is Severity.QUESTION
    assert finding.action.endswith(
        "mm wide; to keep its shape, take a larger max_triangles"
    )
    assert type(report).from_dict(report.to_dict()) == report


def test_too_few_for_all_solids_is_refused_with_the_nearest_count_that_works():
    mesh = Mesh.from_arrays(*joined(box(), box(at=(3, 0, 0)), box(at=(6, 0, 0))))
    with pytest.raises(MeshError, match=r"mesh: cannot .* to 5 triangles .*") as caught:
        decimate(mesh, 5)
    nearest = int(str(caught.value).split("max_triangles = ")[1].split(",")[0])
    assert 5 < nearest <= 36
    assert len(decimate(mesh, nearest).components) == 3


def test_every_refusal_names_a_count_that_works():
    spoon, refused = shape("spoon"), 0
    for count in range(4, 30):
        try:
            assert len(decimate(spoon, count).triangles) <= count
        except MeshError as error:
            refused += 1
            nearest = int(str(error).split("max_triangles = ")[1].split(",")[0])
            assert count < nearest
            assert len(decimate(spoon, nearest).triangles) <= nearest
    assert refused


def test_fewer_than_four_triangles_are_no_solid():
    with pytest.raises(ValueError, match="max_triangles must be 4 or more, is 3"):
        decimate(shape("cup"), 3)


def test_triangles_are_counted_in_whole_numbers():
    mesh = Mesh.from_arrays(*box())
    with pytest.raises(TypeError, match="max_triangles must be a whole number"):
        decimate(mesh, 8.0)
    with pytest.raises(TypeError, match=r"mesh must be a .*Mesh, is of type tuple"):
        decimate(box(), 8)


def test_a_flat_sheet_keeps_its_outline():
    x, y = np.meshgrid(np.arange(6.0), np.arange(6.0))
    V = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    F = [
        t
        for i in range(5)
        for j in range(5)
        for a in [6 * i + j]
        for t in ((a, a + 1, a + 7), (a, a + 7, a + 6))
    ]
    fewer = decimate(Mesh.from_arrays(V, np.array(F)), 4)
    assert len(fewer.triangles) <= 4 and not fewer.solid.any()
    assert fewer.report.area == pytest.approx(25.0)
    assert fewer.report.decimation_error_m <= 1e-3


def test_a_real_mesh():
    mesh = load_mesh(real_mesh("armadillo_31240.stl"))
    fewer = decimate(mesh, 1000)
    assert fewer.solid.all() and not fewer.report.unclean
    size = np.linalg.norm(mesh.report.extent)
    assert 0 < fewer.report.decimation_error_m < 0.03 * size
