"""Concave polygons of a file are triangulated as they are, not as fans."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_haptics.geometry import Mesh, load_mesh
from drake_haptics.geometry.mesh.report import Severity

ARROW = [(0, 0), (1, 0), (0.2, 0.2), (0, 1)]
# Two of its corners lie within a side.
ANGLE = [(0, 0), (2, 0), (4, 0), (4, 1), (1, 1), (1, 3), (0, 3), (0, 1)]


def area_of(corners):
    """The area of a polygon, by the shoelace formula."""
    x, y = np.array(corners, dtype=float).T
    return (x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


def prism(corners, first):
    """Vertices and polygons of a prism of height 1, whose caps begin at a corner."""
    corners, n = [*corners[first:], *corners[:first]], len(corners)
    vertices = [(x, y, z) for z in (0, 1) for x, y in corners]
    caps = [[0, *range(n - 1, 0, -1)], [*range(n, 2 * n)]]
    sides = [[i, j, j + n, i + n] for i, j in pairwise([*range(n), 0])]
    return vertices, caps + sides


def write_obj(path, vertices, faces):
    lines = ["v " + " ".join(map(str, v)) for v in vertices]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
    path.write_text("\n".join(lines))


def write_ply(path, vertices, faces):
    lines = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}"]
    lines += [f"property double {name}" for name in "xyz"]
    lines += [f"element face {len(faces)}"]
    lines += ["property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(map(str, v)) for v in vertices]
    lines += [" ".join(map(str, (len(face), *face))) for face in faces]
    path.write_text("\n".join(lines) + "\n")


def counts(mesh):
    return {finding.code: finding.count for finding in mesh.report.findings}


def assert_is_prism(mesh, corners):
    """One solid whose triangles do not lie on each other."""
    area = area_of(corners)
    length = sum(
        np.linalg.norm(np.subtract(p, q)) for p, q in pairwise([*corners, corners[0]])
    )
    assert mesh.report.solids == 1
    assert mesh.report.vertices == 2 * len(corners)
    assert mesh.report.volume == pytest.approx(area)
    assert mesh.report.area == pytest.approx(2 * area + length)
    assert not any(f.severity is Severity.DEFECT for f in mesh.report.findings)


@pytest.mark.parametrize("write", [write_obj, write_ply])
@pytest.mark.parametrize("corners", [ARROW, ANGLE], ids=["arrow", "angle"])
def test_its_notch_is_not_filled_whichever_corner_is_first(tmp_path, corners, write):
    found = set()
    for first in range(len(corners)):
        path = tmp_path / f"prism{first}.{write.__name__[-3:]}"
        write(path, *prism(corners, first))
        mesh = load_mesh(path)
        assert_is_prism(mesh, corners)
        found.add(counts(mesh).get("concave-polygons", 0))
    assert found == {0, 2}


@given(st.data())
def test_polygons_with_many_notches(data):
    n = data.draw(st.integers(5, 24))
    radii = data.draw(st.lists(st.floats(0.3, 3), min_size=n, max_size=n))
    angle = np.arange(n) * 2 * np.pi / n
    corners = (np.array(radii) * [np.cos(angle), np.sin(angle)]).T.tolist()
    turn = np.linalg.qr(np.random.default_rng(n).normal(size=(3, 3)))[0]
    turn[0] *= np.sign(np.linalg.det(turn))
    vertices, faces = prism(corners, data.draw(st.integers(0, n - 1)))
    fans = [(f[0], p, q) for f in faces for p, q in pairwise(f[1:])]
    assert_is_prism(Mesh.from_arrays(np.array(vertices) @ turn.T, fans), corners)


def test_a_face_with_a_hole_keeps_it():
    """The square's fan is folded by hand: two triangles lie on those beside them."""
    outer = [(0, 0), (3, 0), (3, 3), (0, 3)]
    inner = [(1, 1), (1, 2), (2, 2), (2, 1)]
    ring = [
        [0, 1, 7],
        [0, 7, 4],
        [1, 2, 6],
        [1, 6, 7],
        [2, 3, 5],
        [2, 5, 6],
        [3, 0, 4],
        [3, 4, 5],
    ]
    V = np.array([(*p, 0) for p in outer + inner], dtype=float)
    straight = Mesh.from_arrays(V, ring)
    # The quad 0, 1, 2, 7 is concave at 7: cut from 0 it lies on itself.
    ring[0], ring[3] = [0, 1, 2], [0, 2, 7]
    ring[2] = [2, 6, 7]
    mesh = Mesh.from_arrays(V, ring)
    assert counts(mesh)["concave-polygons"] == 1
    assert "folds" not in counts(mesh)
    assert mesh.report.area == pytest.approx(straight.report.area) == 8


def test_a_fold_that_is_no_polygon_is_left_and_named():
    """A pleat in a strip: its outline crosses itself."""
    V = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0)]
    mesh = Mesh.from_arrays(
        np.array(V, dtype=float), [[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]]
    )
    assert counts(mesh)["folds"] == 1 and "concave-polygons" not in counts(mesh)


def test_an_edge_of_two_others_gets_no_third_triangle():
    """The arrow could only be cut along an edge that a roof above it has."""
    V = [(*p, 0) for p in ARROW] + [(1, 0, 1), (0, 1, 1)]
    roof = [[0, 2, 5], [2, 0, 4]]
    mesh = Mesh.from_arrays(np.array(V, dtype=float), [[0, 1, 3], [1, 2, 3], *roof])
    assert counts(mesh)["folds"] == 1
    assert "concave-polygons" not in counts(mesh)
    assert "non-manifold-edges" not in counts(mesh)
