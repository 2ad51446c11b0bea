"""Convex surface decomposition: what must hold for every mesh."""

import numpy as np
import pytest
import trimesh
from mesh_samples import box, joined, l_prism, real_mesh
from scipy.spatial.transform import Rotation
from surface_distance import distances, winding_numbers

from drake_haptics import _core

# What decomposition.cc allows: facets lie on the mesh, and hulls in the solid,
# within this share of the mesh's size.
SURFACE = 1e-6


def arrays(V, F):
    return np.asarray(V, dtype=float), np.asarray(F, dtype=np.int32)


def of_trimesh(mesh):
    return arrays(mesh.vertices, mesh.faces)


def u_prism():
    """A prism over a U: two concave edges."""
    outline = [(0, 0), (3, 0), (3, 2), (2, 2), (2, 1), (1, 1), (1, 2), (0, 2)]
    V = [(x, y, z) for z in (0, 1) for x, y in outline]
    caps = [(0, 1, 4), (0, 4, 5), (0, 5, 6), (0, 6, 7), (1, 2, 3), (1, 3, 4)]
    F = [(a, c, b) for a, b, c in caps] + [(a + 8, b + 8, c + 8) for a, b, c in caps]
    for i in range(8):
        j = (i + 1) % 8
        F += [(i, j, j + 8), (i, j + 8, i + 8)]
    return arrays(V, F)


def hollow_box():
    """A box with a closed cavity: two components, the inner one wound inward."""
    V, F = box((0.5, 0.5, 0.5), at=(0.25, 0.25, 0.25))
    return arrays(*joined(box(), (V, F[:, ::-1])))


def load(name):
    path = real_mesh(name)
    if path.suffix == ".npz":
        arrays_of_file = np.load(path)
        mesh = trimesh.Trimesh(arrays_of_file["V"], arrays_of_file["F"], process=False)
    else:
        mesh = trimesh.load(path, process=False)
    mesh.merge_vertices()
    mesh.update_faces(mesh.nondegenerate_faces())
    mesh.remove_unreferenced_vertices()
    return of_trimesh(mesh)


SHAPES = {
    "box": lambda: arrays(*box()),
    "L": lambda: arrays(*l_prism()),
    "U": u_prism,
    "hollow box": hollow_box,
    "sphere": lambda: of_trimesh(trimesh.creation.icosphere(subdivisions=3)),
    "torus": lambda: of_trimesh(trimesh.creation.torus(1.0, 0.3)),
    "tube": lambda: of_trimesh(trimesh.creation.annulus(0.9, 1.0, 2.0, sections=24)),
    "cup": lambda: load("cup_500.obj"),
    "spoon": lambda: load("spoon_336.obj"),
    "real torus": lambda: load("torus_2000.obj"),
    "hammer": lambda: load("hammer_1692.obj"),
    "mug": lambda: load("mug.stl"),
    "tooth": lambda: load("tooth.ply"),
}


def decompose(V, F, solid=True):
    return _core.decompose_surface(V, F, np.full(len(F), solid, dtype=np.uint8))


def area_vectors(V, F):
    return np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]) / 2


def areas(V, F):
    return np.linalg.norm(area_vectors(V, F), axis=1)


def facet_area(corners):
    fan = np.cross(corners[1:-1] - corners[0], corners[2:] - corners[0])
    return np.linalg.norm(fan.sum(axis=0)) / 2


@pytest.fixture(params=SHAPES, scope="module")
def decomposed(request):
    V, F = SHAPES[request.param]()
    return V, F, decompose(V, F)


def test_each_triangle_is_in_one_piece(decomposed):
    _, F, result = decomposed
    labels = result.piece_of_triangle
    assert labels.shape == (len(F),)
    np.testing.assert_array_equal(np.unique(labels), np.arange(len(result.pieces)))


def test_pieces_are_hulls_of_their_triangles(decomposed):
    V, F, result = decomposed
    size = np.linalg.norm(np.ptp(V, axis=0))
    for i, piece in enumerate(result.pieces):
        corners = V[F[result.piece_of_triangle == i]].reshape(-1, 3)
        assert {*map(tuple, piece.vertices)} <= {*map(tuple, corners)}
        heights = corners @ piece.facet_normals.T - piece.facet_offsets
        assert heights.max() <= SURFACE * size


def assert_original_facets_are_the_triangles(V, F, result):
    """Each triangle lies in an original facet, and they have the same area."""
    size = np.linalg.norm(np.ptp(V, axis=0))
    vectors, area = area_vectors(V, F), areas(V, F)
    for i, piece in enumerate(result.pieces):
        mine = np.flatnonzero(result.piece_of_triangle == i)
        if piece.dimension == 1:  # a needle, which has no facet
            assert len(mine) == 1
            continue
        original = np.flatnonzero(piece.facet_original)
        normals = piece.facet_normals[original]
        heights = V[F[mine]] @ normals.T - piece.facet_offsets[original]
        near = np.abs(heights).max(axis=1) <= SURFACE * size
        facing = vectors[mine] @ normals.T > 0
        assert (near & facing).any(axis=1).all()
        on_facets = sum(facet_area(piece.vertices[piece.facets[f]]) for f in original)
        slack = SURFACE * size * np.linalg.norm(np.ptp(piece.vertices, axis=0))
        assert abs(on_facets - area[mine].sum()) <= 1e-3 * on_facets + 4 * slack


def assert_hulls_lie_in_the_solid(V, F, result):
    size = np.linalg.norm(np.ptp(V, axis=0))
    rng = np.random.default_rng(0)
    pieces = [p for p in result.pieces if p.dimension == 3]
    if len(pieces) > 100:
        pieces = [pieces[i] for i in rng.choice(len(pieces), 100, replace=False)]
    points = [
        rng.dirichlet(np.full(len(p.vertices), 0.5)) @ p.vertices
        for p in pieces
        for _ in range(max(3, 100 // len(pieces)))
    ]
    outside = np.array(points)[winding_numbers(points, V, F) < 0.5]
    assert distances(outside, V, F).max(initial=0) <= SURFACE * size


def test_original_facets_are_the_triangles(decomposed):
    assert_original_facets_are_the_triangles(*decomposed)


def test_hulls_lie_in_the_solid(decomposed):
    assert_hulls_lie_in_the_solid(*decomposed)


def test_a_mesh_full_of_rounding_loses_no_triangle():
    """Coordinates with six decimals, needles, and a bore of narrow strips."""
    V, F = load("socket_round_8mm.npz")
    result = decompose(V, F)
    assert_original_facets_are_the_triangles(V, F, result)
    assert_hulls_lie_in_the_solid(V, F, result)
    assert sum(piece.dimension < 2 for piece in result.pieces) <= 2


def test_distances_do_not_fail_at_needles():
    """The nearest triangle is a needle of aspect 1e-9, with a bend below it."""
    V = np.array([[0, 0, 0], [1, 0, 0], [0.4, 1e-9, 0], [0.5, 1, -1]])
    F = np.array([[0, 1, 2], [2, 1, 3], [2, 3, 0]])
    points = [[0.7, 0, 1e-6], [0.5, -1e-3, 0], [-1, 0, 0]]
    np.testing.assert_allclose(distances(points, V, F), [1e-6, 1e-3, 1], rtol=1e-3)


def test_features_beyond_the_mesh_are_virtual(decomposed):
    """Edges are original exactly next to original facets, and only they bear wings."""
    _, _, result = decomposed
    for piece in result.pieces:
        beside = piece.facet_original[piece.edge_facets].any(axis=1)
        np.testing.assert_array_equal(piece.edge_original, beside)
        wings = np.linalg.norm(piece.edge_wings.reshape(-1, 2, 3), axis=2)
        np.testing.assert_allclose(wings, np.stack([beside] * 2, axis=1), atol=1e-9)
        if piece.dimension == 2:
            assert piece.facet_original[0]


def test_rings_are_the_edges_of_the_whole_mesh(decomposed):
    V, F, result = decomposed
    rank = {tuple(v): i for i, v in enumerate(V)}
    ends = [set() for _ in V]
    for a, b, c in F:
        ends[a] |= {b, c}
        ends[b] |= {c, a}
        ends[c] |= {a, b}
    for piece in result.pieces[:60]:
        for i, vertex in enumerate(piece.vertices):
            v = rank[tuple(vertex)]
            along = V[sorted(ends[v])] - vertex
            along /= np.linalg.norm(along, axis=1, keepdims=True)
            np.testing.assert_allclose(piece.ring(i), along, atol=1e-12)


def test_labels_make_the_same_pieces_and_runs_agree(decomposed):
    V, F, result = decomposed
    again = decompose(V, F)
    np.testing.assert_array_equal(again.piece_of_triangle, result.piece_of_triangle)
    assembled = _core.assemble_surface_pieces(V, F, result.piece_of_triangle)
    for a, b in zip(assembled.pieces, result.pieces, strict=True):
        np.testing.assert_array_equal(a.vertices, b.vertices)
        np.testing.assert_array_equal(a.facet_original, b.facet_original)
        np.testing.assert_array_equal(a.edge_wings, b.edge_wings)


@pytest.mark.parametrize("name, vertices", [("box", 8), ("sphere", 642)])
def test_a_convex_solid_is_one_hull(name, vertices):
    (piece,) = decompose(*SHAPES[name]()).pieces
    assert len(piece.vertices) == vertices
    assert piece.facet_original.all() and piece.edge_original.all()


@pytest.mark.parametrize(
    "name, triangles, published",
    [("cup", 500, 190), ("spoon", 336, 78), ("hammer", 1692, 425)],
)
def test_piece_counts_are_near_the_papers(name, triangles, published):
    """Table 1 of the paper, whose meshes had as many triangles but differed."""
    V, F = SHAPES[name]()
    assert len(F) == triangles
    assert len(decompose(V, F).pieces) <= 1.25 * published


NOISES = {
    "single precision": lambda V: V.astype(np.float32),
    "single precision, far away": lambda V: (V + 20).astype(np.float32) - 20.0,
    "eight decimals": lambda V: np.round(0.05 * V, 8) / 0.05,
}


@pytest.mark.parametrize("noise", NOISES)
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(
    "solid",
    [
        trimesh.creation.cylinder(0.5, 1.0, sections=300),
        trimesh.creation.icosphere(subdivisions=4, radius=0.5),
        trimesh.creation.box((1, 0.5, 0.2)).subdivide().subdivide(),
    ],
    ids=["cylinder", "sphere", "fine box"],
)
def test_a_convex_solid_is_one_hull_in_spite_of_rounding(solid, noise, seed):
    turn = Rotation.random(random_state=seed).as_matrix()
    exact = np.asarray(solid.vertices) @ turn.T
    V, F = arrays(NOISES[noise](exact), solid.faces)
    if "far" in noise:
        V += 20
    (piece,) = decompose(V, F).pieces
    assert piece.facet_original.all() and piece.edge_original.all()
    heights = V @ piece.facet_normals.T - piece.facet_offsets
    size = np.linalg.norm(np.ptp(V, axis=0))
    assert heights.max() <= SURFACE * size
    assert -heights.max(axis=1).min() <= (5 if "far" in noise else 1) * SURFACE * size


def test_the_real_peg_is_one_hull():
    (piece,) = decompose(*load("peg_round_8mm.npz")).pieces
    assert piece.facet_original.all()


@pytest.mark.parametrize("depth, pieces", [(2e-7, 1), (1e-5, None)])
def test_a_dent_is_noise_below_a_millionth(depth, pieces):
    V, F = of_trimesh(trimesh.creation.box().subdivide())
    middle = np.argmin(np.linalg.norm(V - [0.5, 0, 0], axis=1))
    V = V.copy()
    V[middle, 0] -= depth * np.sqrt(3)
    found = len(decompose(V, F).pieces)
    assert found == pieces if pieces else found > 1


def test_a_convex_solid_with_noise_keeps_its_cavity():
    outer = trimesh.creation.icosphere(subdivisions=3)
    inner = trimesh.creation.icosphere(subdivisions=1, radius=0.5)
    shell = joined(
        (outer.vertices, outer.faces), (inner.vertices, inner.faces[:, ::-1])
    )
    V, F = arrays(shell[0].astype(np.float32), shell[1])
    assert len(decompose(V, F).pieces) > 1


def split_edge(V, F, a, b, shift):
    """A corner on edge ab of one side's triangle; a needle closes the other side."""
    (side,) = (
        i for i, t in enumerate(F) if (a, b) in zip(t, np.roll(t, -1), strict=True)
    )
    (c,) = set(F[side]) - {a, b}
    new = len(V)
    V = np.vstack([V, (V[a] + V[b]) / 2 + shift])
    F = np.vstack([np.delete(F, side, axis=0), [[a, new, c], [new, b, c], [a, b, new]]])
    return arrays(V, F)


@pytest.mark.parametrize("height", [0.0, 1e-9, 1e-7])
def test_a_needle_joins_the_patch_beside_it(height):
    V, F = l_prism()
    split = split_edge(V, F, *F[0][:2], [0, 0, height])
    assert trimesh.Trimesh(*split, process=False).is_watertight
    pieces = decompose(*split).pieces
    assert all(piece.dimension >= 2 for piece in pieces)
    assert len(pieces) == len(decompose(*arrays(V, F)).pieces)


@pytest.mark.parametrize("height", [3.2e-7, 5e-7])
def test_a_needle_behind_a_needle_joins_too(height):
    """Both too high to be in the patch's plane, too thin to have one of their own."""
    V, F = l_prism()
    a, b = F[0][:2]
    once = split_edge(V, F, a, b, [0, 0, -height])
    twice = split_edge(*once, a, len(once[0]) - 1, [0, 0, height])
    assert trimesh.Trimesh(*twice, process=False).is_watertight
    assert all(piece.dimension >= 2 for piece in decompose(*twice).pieces)


def test_a_needle_on_its_own_is_a_segment_that_can_be_touched():
    V, F = arrays([[0, 0, 0], [1, 0, 0], [0.4, 1e-9, 0]], [[0, 1, 2]])
    (needle,) = decompose(V, F, solid=False).pieces
    assert needle.dimension == 1 and needle.edge_original.all()
    ball = _core.ConvexPolytope(np.array(trimesh.creation.icosphere().vertices))
    pair = _core.ConvexPair(ball, needle)
    for height, distance in [(1.5, 0.5), (0.25, -0.75), (-0.25, -0.75)]:
        X_WA = np.eye(4)
        X_WA[:3, 3] = [0.5, 0, height]
        contact = pair.query(X_WA, np.eye(4))
        assert contact.distance == pytest.approx(distance, abs=0.03)
        assert np.linalg.norm(contact.nhat_BA_W) == pytest.approx(1)


def test_labels_of_no_convex_patch_lose_no_triangle():
    V, F = arrays(*l_prism())
    result = _core.assemble_surface_pieces(V, F[:-2], np.zeros(len(F) - 2, np.int32))
    area = areas(V, F[:-2])
    for i, piece in enumerate(result.pieces):
        on_facets = sum(
            facet_area(piece.vertices[piece.facets[f]])
            for f in np.flatnonzero(piece.facet_original)
        )
        assert on_facets == pytest.approx(area[result.piece_of_triangle == i].sum())


def test_a_thin_wall_is_not_filled():
    """The wall of a tube is 0.1 thick: no piece spans its bore."""
    V, F = SHAPES["tube"]()
    for piece in decompose(V, F).pieces:
        if piece.dimension == 3:
            assert np.linalg.norm(piece.centroid[:2]) > 0.8


def test_a_second_solid_is_no_obstacle_but_a_cavity_is():
    inner = box((0.5, 0.5, 0.5), at=(0.25, 0.25, 0.25))
    assert len(decompose(*arrays(*joined(box(), inner))).pieces) == 2
    assert len(decompose(*hollow_box()).pieces) > 6


def test_a_planar_patch_has_no_notch_and_no_hole():
    """A frame of eight triangles: its largest convex part is no frame."""
    outer = np.array([(0, 0), (3, 0), (3, 3), (0, 3)], dtype=float)
    V = np.array([(x, y, 0.0) for x, y in [*outer, *(outer / 3 + 1)]])
    F = np.array(
        [
            t
            for i in range(4)
            for j in [(i + 1) % 4]
            for t in ((i, j, j + 4), (i, j + 4, i + 4))
        ]
    )
    V, F = arrays(V, F)
    result = decompose(V, F, solid=False)
    area = areas(V, F)
    for i, piece in enumerate(result.pieces):
        covered = area[result.piece_of_triangle == i].sum()
        assert facet_area(piece.vertices[piece.facets[0]]) == pytest.approx(covered)


def test_surfaces_without_inside_give_flat_pieces():
    V, F = arrays(*box())
    result = decompose(V, F[2:], solid=False)
    assert len(result.pieces) == 5
    for piece in result.pieces:
        assert piece.dimension == 2
        assert piece.facet_original.tolist() == [True, False]


@pytest.mark.parametrize("seed", range(5))
def test_random_triangles_are_survived(seed):
    """Soup, degenerate triangles and repeated ones: any answer but a crash."""
    rng = np.random.default_rng(seed)
    V = rng.integers(0, 3, size=(12, 3)).astype(float)
    F = rng.integers(0, 12, size=(60, 3)).astype(np.int32)
    for solid in (True, False):
        result = decompose(V, F, solid)
        assert len(result.piece_of_triangle) == 60


def test_adopted_pieces_know_what_lies_on_the_mesh():
    V, F = arrays(*l_prism())
    halves = [box((2, 1, 1))[0], box((1, 1, 1), at=(0, 1, 0))[0]]
    result = _core.adopt_convex_pieces(V, F, halves, 1e-6)
    low, high = result.pieces
    np.testing.assert_array_equal(result.piece_of_triangle, -1)
    # The wall between the halves is virtual; of the lower one's top, half is mesh.
    for piece, normal in ((low, [0, 1, 0]), (high, [0, -1, 0])):
        virtual = np.flatnonzero(~piece.facet_original)
        np.testing.assert_allclose(piece.facet_normals[virtual], [normal], atol=1e-12)
        assert piece.edge_original.all()


def test_an_adopted_piece_inside_is_all_virtual():
    inside = box((0.5, 0.5, 0.5), at=(0.25, 0.25, 0.25))[0]
    (piece,) = _core.adopt_convex_pieces(*arrays(*box()), [inside], 1e-3).pieces
    assert not piece.facet_original.any() and not piece.edge_original.any()


def test_progress_is_told_and_can_stop():
    V, F = arrays(*l_prism())
    solid = np.ones(len(F), dtype=np.uint8)
    shares = []
    _core.decompose_surface(V, F, solid, lambda s: shares.append(s) or True)
    assert shares[-1] == 1 and shares == sorted(shares)
    with pytest.raises(RuntimeError):
        _core.decompose_surface(V, F, solid, lambda s: False)

    def fail(share):
        raise KeyError("mine")

    with pytest.raises(KeyError):
        _core.decompose_surface(V, F, solid, fail)


@pytest.mark.parametrize("index", [-1, 12, 2**31 - 1])
def test_bad_indices_are_refused(index):
    V, F = arrays(*l_prism())
    F = F.copy()
    F[3, 1] = index
    solid, labels = np.ones(len(F), np.uint8), np.zeros(len(F), np.int32)
    with pytest.raises(ValueError):
        _core.decompose_surface(V, F, solid)
    with pytest.raises(ValueError):
        _core.assemble_surface_pieces(V, F, labels)
    with pytest.raises(ValueError):
        _core.adopt_convex_pieces(V, F, [V], 1e-6)


def test_bad_values_are_refused():
    V, F = arrays(*l_prism())
    V = V.copy()
    V[0, 1] = np.nan
    with pytest.raises(ValueError):
        decompose(V, F)
    with pytest.raises(ValueError):
        decompose(V[:0], F[:0])


def test_a_piece_outlives_its_decomposition():
    piece = decompose(*SHAPES["L"]()).pieces[0]
    assert np.isfinite(piece.vertices).all()
