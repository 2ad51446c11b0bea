"""The organ is a closed, branching tube as complex as the paper's, and cuts well."""

import numpy as np
import pytest
import trimesh
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from shapes.organ import make_organ
from surface_crossings import crossing_edges

from drake_haptics import decompose
from drake_haptics.geometry.mesh.mesh import Mesh
from drake_haptics.geometry.mesh.topology import winding_numbers
from drake_haptics.models import FOLDER

# The digestive system in Table 1 of Kim, Otaduy, Lin and Manocha.
PAPER_TRIANGLES, PAPER_PIECES = 24_846, 9_913


@pytest.fixture(scope="module")
def organ():
    return make_organ()


@pytest.fixture(scope="module")
def mesh(organ):
    return trimesh.Trimesh(organ.vertices, organ.triangles, process=False)


def test_it_has_as_many_triangles_as_the_papers(organ):
    assert len(organ.triangles) == pytest.approx(PAPER_TRIANGLES, rel=0.02)


def test_it_bounds_one_solid(mesh):
    assert mesh.is_watertight and mesh.is_winding_consistent
    assert mesh.body_count == 1
    assert mesh.euler_number == 2
    assert mesh.area_faces.min() > 1e-8  # 0.01 mm²: no sliver
    assert len(np.unique(mesh.vertices, axis=0)) == len(mesh.vertices)
    assert (mesh.extents < [0.31, 0.14, 0.38]).all()
    # A tube of about 10 mm and one of about 24 mm, 1.7 m and 0.8 m long.
    assert 0.0014 < mesh.volume < 0.0022


def test_it_does_not_cross_itself(organ, mesh):
    edges = mesh.edges_unique[::20]
    assert crossing_edges(organ.vertices, organ.triangles, edges) == []


def test_it_is_folded_and_branches(organ, mesh):
    """At half height a cut meets both sides of the colon and the bowel between."""
    above = organ.vertices[:, 2] > 0.04
    cut = above[organ.triangles].any(axis=1) & ~above[organ.triangles].all(axis=1)
    near, far = mesh.face_adjacency[cut[mesh.face_adjacency].all(axis=1)].T
    links = coo_array((np.ones(len(near)), (near, far)), shape=(len(cut), len(cut)))
    _, loop = connected_components(links, directed=False)
    middles = [
        mesh.triangles_center[cut & (loop == k)].mean(axis=0)
        for k in np.unique(loop[cut])
    ]
    x = np.sort([p[0] for p in middles])
    assert len(x) >= 4
    assert x[0] < -0.09 and x[-1] > 0.09 and abs(x[1:-1]).max() < 0.07


def test_it_is_curved_everywhere(mesh):
    """Nothing flat: no two neighbors of more than a few share a plane."""
    flat = mesh.face_adjacency_angles < 1e-5
    assert flat.mean() < 0.01


def test_it_is_the_same_each_time(organ):
    again = make_organ()
    np.testing.assert_array_equal(again.vertices, organ.vertices)
    np.testing.assert_array_equal(again.triangles, organ.triangles)


def test_it_is_cut_into_pieces_of_many_triangles_within_the_solid(organ):
    surface = Mesh.from_arrays(organ.vertices, organ.triangles)
    pieces = decompose(surface, cache=False)
    assert len(pieces.pieces) < PAPER_PIECES / 4
    labels = np.array(pieces.core.piece_of_triangle)
    np.testing.assert_array_equal(np.unique(labels), np.arange(len(pieces.pieces)))
    rng = np.random.default_rng(0)
    points = [
        rng.dirichlet(np.full(len(p.vertices), 0.5)) @ p.vertices
        for p in pieces.pieces[::5]
        if p.dimension == 3
    ]
    inside = winding_numbers(np.array(points), organ.vertices, organ.triangles) > 0.5
    assert inside.all()


def test_the_shipped_organ_is_what_the_code_makes(organ):
    shipped = trimesh.load(FOLDER / "evaluation" / "organ.obj", process=False)
    np.testing.assert_array_equal(shipped.faces, organ.triangles)
    # Another platform's sine may round the last nanometer differently.
    np.testing.assert_allclose(shipped.vertices, organ.vertices, atol=2e-9)
