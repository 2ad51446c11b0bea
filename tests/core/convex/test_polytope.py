"""Convex hulls against qhull, and the invariants of a polytope."""

import copy
import pickle

import numpy as np
import pytest
import trimesh
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from drake_haptics import _core


def polytope(points):
    return _core.ConvexPolytope(np.asarray(points, dtype=float))


def grid(n):
    """n³ points of the unit cube."""
    axes = np.meshgrid(*[np.linspace(0, 1, n)] * 3)
    return np.stack(axes, axis=-1).reshape(-1, 3)


def rotation(seed):
    return Rotation.random(random_state=seed).as_matrix()


def round_off(points):
    """A bound of distances that are zero but for round-off, m."""
    return 1e-11 * np.ptp(points, axis=0).max() + 1e-14 * np.abs(points).max()


def volume(piece):
    inner = piece.vertices - piece.centroid
    fans = [(f[0], f[i], f[i + 1]) for f in piece.facets for i in range(1, len(f) - 1)]
    return np.linalg.det(inner[np.array(fans)]).sum() / 6


def assert_valid(piece, points):
    """The surface is closed, convex, and has all points behind it."""
    tolerance = round_off(points)
    assert len(piece.vertices) - len(piece.edges) + len(piece.facets) == 2
    heights = points @ piece.facet_normals.T - piece.facet_offsets
    assert heights.max() <= tolerance
    np.testing.assert_allclose(np.linalg.norm(piece.facet_normals, axis=1), 1)
    for loop, normal in zip(piece.facets, piece.facet_normals, strict=True):
        corners = piece.vertices[loop]
        steps = np.roll(corners, -1, axis=0) - corners
        turns = np.cross(steps, np.roll(steps, -1, axis=0)) @ normal
        assert turns.min() > -tolerance * np.ptp(points, axis=0).max()
    assert piece.facet_original.all() and piece.edge_original.all()


@pytest.mark.parametrize("count", [4, 5, 10, 100, 1000])
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("aspect", [1.0, 1e3, 1e6])
def test_random_hulls_agree_with_qhull(count, scale, aspect):
    rng = np.random.default_rng(count)
    shape = scale * np.array([1, aspect**-0.5, 1 / aspect])
    points = rng.normal(size=(count, 3)) * shape
    piece = polytope(points)
    reference = ConvexHull(points)
    assert_valid(piece, points)
    assert {*map(tuple, piece.vertices)} == {*map(tuple, points[reference.vertices])}
    assert volume(piece) == pytest.approx(reference.volume, rel=1e-9)


@pytest.mark.parametrize("seed", range(20))
def test_coplanar_points_merge_into_the_facets_of_a_box(seed):
    rng = np.random.default_rng(seed)
    size = 10.0 ** rng.uniform(-6, 6)
    offset = size * 10.0 ** rng.uniform(-3, 5) * rng.normal(size=3)
    points = rng.permutation(size * grid(7) @ rotation(seed).T + offset)
    piece = polytope(points)
    assert (len(piece.vertices), len(piece.edges), len(piece.facets)) == (8, 12, 6)
    assert_valid(piece, points)


@pytest.mark.parametrize("seed", range(10))
def test_a_needle_keeps_its_six_facets(seed):
    points = grid(5) * [1, 1e-3, 1e-6] @ rotation(seed).T
    piece = polytope(points)
    assert (len(piece.vertices), len(piece.facets)) == (8, 6)
    assert_valid(piece, points)


def test_a_cube_a_million_meters_away_is_the_same_cube():
    points = grid(4) + 1e6
    piece = polytope(points)
    assert len(piece.vertices) == 8
    assert volume(piece) == pytest.approx(1, rel=1e-9)


def test_a_fine_sphere_does_not_melt():
    points = np.random.default_rng(1).normal(size=(5000, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    assert len(polytope(points).vertices) == 5000


def test_a_flat_set_is_a_polygon_with_two_sides():
    square = grid(6) * [1, 1, 0] @ rotation(3).T
    piece = polytope(square)
    assert piece.dimension == 2
    assert len(piece.vertices) == len(piece.edges) == 4
    front, back = piece.facets
    assert front[0] == back[0] and front[1:] == back[:0:-1]
    np.testing.assert_array_equal(piece.facet_normals[0], -piece.facet_normals[1])
    np.testing.assert_array_equal(piece.edge_facets, [[0, 1]] * 4)
    assert_valid(piece, square)


@pytest.mark.parametrize("thickness, dimension", [(1e-14, 2), (1e-9, 3)])
def test_flatness_is_relative_to_the_size(thickness, dimension):
    for scale in (1e-6, 1.0, 1e6):
        points = scale * grid(2) * [1, 1, thickness]
        assert polytope(points).dimension == dimension


def test_a_fine_disc_keeps_its_rim():
    angles = np.linspace(0, 2 * np.pi, 10_000, endpoint=False)
    rim = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=-1)
    assert len(polytope(rim).vertices) == 10_000


def test_duplicates_change_nothing():
    points = np.random.default_rng(5).normal(size=(40, 3))
    once, often = polytope(points), polytope(np.repeat(points, 3, axis=0))
    np.testing.assert_array_equal(once.vertices, often.vertices)
    assert len(once.facets) == len(often.facets)


@pytest.mark.parametrize("distance", [1e-16, 1e-13, 1e-11])
def test_vertices_nearly_twice_count_once(distance):
    rng = np.random.default_rng(8)
    points = rng.normal(size=(40, 3))
    once = polytope(points)
    twice = polytope([*points, *(points + distance * rng.uniform(-1, 1, (40, 3)))])
    np.testing.assert_array_equal(once.vertices, twice.vertices)


def test_vertices_keep_the_order_of_the_input():
    points = np.random.default_rng(6).normal(size=(200, 3))
    rank = {tuple(p): i for i, p in enumerate(points)}
    order = [rank[tuple(v)] for v in polytope(points).vertices]
    assert order == sorted(order)


@pytest.mark.parametrize(
    "points", [np.zeros((0, 3)), [[0, np.nan, 0]], [[0, 0, np.inf]], [[1e200, 0, 0]]]
)
def test_bad_points_are_refused(points):
    with pytest.raises(ValueError):
        polytope(points)


def test_the_one_point_that_is_bad_is_named():
    points = grid(2)
    points[5, 1] = np.nan
    with pytest.raises(ValueError, match=r"^vertices\[5\] holds .* not finite"):
        polytope(points)


@pytest.mark.parametrize(
    "bad", [None, "cube", [], [1.0, 2.0, 3.0], np.eye(3, dtype=complex), [[1], [2, 3]]]
)
def test_what_is_no_array_of_points_is_refused(bad):
    with pytest.raises(ValueError, match=r"^vertices must be an "):
        _core.ConvexPolytope(bad)


def test_any_real_array_will_do():
    points = grid(3)
    whole = polytope(points)
    for same in (points.tolist(), np.asfortranarray(points), np.repeat(points, 2, 0)):
        np.testing.assert_array_equal(
            _core.ConvexPolytope(same).vertices, whole.vertices
        )
    corners = (2 * points).astype(np.int8)
    assert len(_core.ConvexPolytope(corners).vertices) == 8


def test_a_polytope_is_pickled_by_its_vertices():
    for points in (np.random.default_rng(8).normal(size=(50, 3)), grid(2) * [1, 1, 0]):
        whole = polytope(points)
        again = pickle.loads(pickle.dumps(whole))
        np.testing.assert_array_equal(again.vertices, whole.vertices)
        assert again.facets == whole.facets
        assert copy.deepcopy(whole) is whole


def test_a_piece_of_a_surface_is_not_pickled_without_it():
    box = trimesh.creation.box()
    open_box = box.faces[:-1].astype(np.int32)
    pieces = _core.decompose_surface(
        box.vertices, open_box, np.zeros(len(open_box), dtype=np.uint8)
    ).pieces
    with pytest.raises(TypeError, match="save the Decomposition"):
        pickle.dumps(pieces[0])


def test_wrong_shapes_and_indices_are_refused():
    with pytest.raises(ValueError, match=r"vertices .* shape \(4, 2\)"):
        _core.ConvexPolytope(np.zeros((4, 2)))
    for vertex in (-1, 8):
        with pytest.raises(IndexError):
            polytope(grid(2)).ring(vertex)
