"""Merged pieces: fewer, within the error, and no way through."""

import copy
from functools import cache

import numpy as np
import pytest
from hull_truth import deepest_outside, deepest_surface
from mesh_samples import box, joined, l_prism
from press_rig import GAINS, sample_presses
from press_tools import make_tools
from press_verdict import judge
from shapes import SHAPES
from solid_surface import Overlap, Surface
from surface_distance import distances

from drake_haptics import _core
from drake_haptics.common.errors import HapticsError
from drake_haptics.geometry.decomposition.decompose import Decomposition, decompose
from drake_haptics.geometry.mesh.mesh import Mesh


def shape(name):
    surface = SHAPES[name]()
    return Mesh.from_arrays(surface.vertices, surface.triangles, name=name)


@cache
def merged(name, error_m):
    return decompose(shape(name), "merged", error_m=error_m, cache=False)


def wavy_sheet():
    """An open surface over 0.1 m x 0.1 m with waves of 2 mm."""
    x, y = np.meshgrid(np.linspace(0, 0.1, 12), np.linspace(0, 0.1, 12))
    z = 2e-3 * np.sin(70 * x) * np.cos(50 * y)
    V = np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)
    F = [
        t
        for i in range(11)
        for j in range(11)
        for a in [12 * i + j]
        for t in ((a, a + 1, a + 13), (a, a + 13, a + 12))
    ]
    return Mesh.from_arrays(V, np.array(F))


def notched_block(depth):
    """A block of 1 m x 1 m x 1 m with a notch 0.2 m wide across its top."""
    outline = np.array(
        [(0, 0), (1, 0), (1, 1), (0.6, 1), (0.6, 1 - depth), (0.4, 1 - depth),
         (0.4, 1), (0, 1)]
    )  # fmt: skip
    V = np.array([(x, y, z) for y in (0.0, 1.0) for x, z in outline])
    cap = [(0, 1, 4), (1, 2, 3), (1, 3, 4), (0, 4, 5), (0, 5, 7), (5, 6, 7)]
    sides = [
        t
        for i, j in zip(range(8), (*range(1, 8), 0), strict=True)
        for t in ((i, i + 8, j + 8), (i, j + 8, j))
    ]
    F = np.array([*cap, *(tuple(k + 8 for k in t[::-1]) for t in cap), *sides])
    return Mesh.from_arrays(V, F)


@pytest.mark.parametrize(
    ("name", "error_m", "most"),
    [("torus", 1e-3, 20), ("cup", 2e-3, 45), ("spoon", 1e-3, 30), ("hammer", 5e-4, 20)],
)
def test_few_pieces_depart_by_no_more_than_the_error(name, error_m, most):
    result = merged(name, error_m)
    assert len(result.pieces) <= most
    departure_m = result.report.departure_m
    assert 0 < departure_m <= error_m
    # Dense samples, by triangles and planes alone.
    outside, buried = deepest_outside(result, 400), deepest_surface(result)
    assert max(outside, buried) <= departure_m * (1 + 1e-9)
    assert max(outside, buried) >= 0.3 * departure_m  # the bound says something


def test_nothing_is_cut_away():
    result = merged("torus", 1e-3)
    mesh, labels = result.mesh, np.asarray(result.core.piece_of_triangle)
    for index, piece in enumerate(result.pieces):
        corners = mesh.vertices[mesh.triangles[labels == index]].reshape(-1, 3)
        height = corners @ np.asarray(piece.facet_normals).T - piece.facet_offsets
        assert height.max() <= 1e-9


def test_every_triangle_lies_below_a_facet_that_carries_contact():
    error_m = 1e-3
    result = merged("torus", error_m)
    mesh, labels = result.mesh, np.asarray(result.core.piece_of_triangle)
    corners = mesh.vertices[mesh.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    for index, piece in enumerate(result.pieces):
        original = np.asarray(piece.facet_original)
        n = np.asarray(piece.facet_normals)[original]
        own = labels == index
        depth = (
            np.asarray(piece.facet_offsets)[original] - corners[own].mean(axis=1) @ n.T
        )
        facing = normals[own] @ n.T > 0.5
        assert (np.where(facing, depth, np.inf).min(axis=1) <= error_m).all()


def test_without_an_error_the_exact_pieces_remain():
    mesh = shape("cup")
    exact = decompose(mesh, cache=False)
    same = decompose(mesh, "merged", error_m=0.0, cache=False)
    assert same.report.departure_m == 0.0
    assert len(same.pieces) == len(exact.pieces)
    tool = decompose(shape("spoon"), cache=False).core
    q = np.array([1.0, 0, 0, 0, 0, 0, 0])
    for z in np.linspace(0.0, 0.08, 9):
        q[6] = z
        deepest = [
            min(
                _core.SceneTracker(tool, [part.core], 2e-3).query(q).distance, default=1
            )
            for part in (exact, same)
        ]
        assert deepest[0] == pytest.approx(deepest[1], abs=1e-12)


@pytest.mark.parametrize(("depth", "pieces"), [(0.04, 1), (0.06, None)])
def test_a_notch_is_filled_if_it_is_as_shallow_as_the_error(depth, pieces):
    mesh = notched_block(depth)
    assert mesh.report.volume == pytest.approx(1 - 0.2 * depth)
    result = decompose(mesh, "merged", error_m=0.05, cache=False)
    if pieces:
        (piece,) = result.pieces
        assert np.asarray(piece.facet_original).all()
        assert result.report.departure_m == pytest.approx(depth, rel=0.06)
    else:
        middle = np.array([[0.5, 0.5, 0.999]])
        for piece in result.pieces:
            if piece.dimension == 3:
                normals = np.asarray(piece.facet_normals)
                assert (middle @ normals.T - piece.facet_offsets).max() > 0


def test_a_cavity_is_not_filled():
    # Its walls are near the hull of the walls, and all of it is hollow.
    V, F = joined(box((0.5,) * 3, (-0.25,) * 3), box((0.1,) * 3, (-0.05,) * 3))
    F[12:] = F[12:, ::-1]
    mesh = Mesh.from_arrays(V, F)
    assert any(c.cavity for c in mesh.components)
    result = decompose(mesh, "merged", error_m=0.04, cache=False)
    for piece in result.pieces:
        if piece.dimension == 3:
            assert np.asarray(piece.facet_offsets).min() < 1e-9  # not the middle


def test_an_open_sheet_stays_one_sided_and_near():
    mesh = wavy_sheet()
    error_m = 1e-3
    exact = decompose(mesh, cache=False)
    result = decompose(mesh, "merged", error_m=error_m, cache=False)
    assert len(result.pieces) < 0.5 * len(exact.pieces)
    rng = np.random.default_rng(0)
    for piece in result.pieces:
        corners = np.asarray(piece.vertices)
        points = rng.dirichlet(np.full(len(corners), 0.3), 20) @ corners
        assert distances(points, mesh.vertices, mesh.triangles).max() <= error_m
        up = np.asarray(piece.facet_normals)[np.asarray(piece.facet_original)]
        assert len(up) and (up[:, 2] > 0).all()


def test_the_result_is_the_same_again_and_from_a_file(tmp_path):
    first = merged("spoon", 1e-3)
    again = decompose(first.mesh, "merged", error_m=1e-3, cache=False)
    first.save(tmp_path / "spoon.npz")
    loaded = Decomposition.load(tmp_path / "spoon.npz")
    for other in (again, loaded, copy.deepcopy(first)):
        assert other.report.departure_m == first.report.departure_m
        for a, b in zip(first.pieces, other.pieces, strict=True):
            np.testing.assert_array_equal(a.vertices, b.vertices)
            np.testing.assert_array_equal(a.facet_original, b.facet_original)


def test_the_cache_tells_errors_apart(tmp_path, monkeypatch):
    monkeypatch.setenv("DRAKE_HAPTICS_CACHE", str(tmp_path))
    mesh = Mesh.from_arrays(*l_prism())
    assert not decompose(mesh, "merged", error_m=0.1).report.from_cache
    assert decompose(mesh, "merged", error_m=0.1).report.from_cache
    assert not decompose(mesh, "merged", error_m=0.2).report.from_cache


@pytest.mark.parametrize(
    ("method", "error_m", "complaint"),
    [
        ("merged", None, "merged needs an error_m"),
        ("surface", 1e-3, "error_m is for the method merged; surface has none"),
        ("merged", -1.0, "error_m must be zero or more, in m, is -1"),
        ("merged", np.inf, "error_m must be zero or more, in m, is inf"),
    ],
)
def test_an_error_goes_with_the_method(method, error_m, complaint):
    with pytest.raises(HapticsError, match=complaint):
        decompose(Mesh.from_arrays(*box()), method, error_m=error_m)


@pytest.mark.parametrize("number", [np.float32(0.25), np.float64(0.25), np.int64(1)])
def test_an_error_may_be_a_number_of_numpy(tmp_path, monkeypatch, number):
    monkeypatch.setenv("DRAKE_HAPTICS_CACHE", str(tmp_path))
    mesh = Mesh.from_arrays(*l_prism())
    result = decompose(mesh, "merged", error_m=number)
    result.save(tmp_path / "merged.npz")
    again = decompose(mesh, "merged", error_m=float(number))
    assert again.report.from_cache and len(again.pieces) == len(result.pieces)


@pytest.mark.parametrize("number", ["0.001", True, np.ones(3)])
def test_an_error_that_is_not_a_number_is_refused_by_name(number):
    with pytest.raises(TypeError, match="error_m must be a number or None"):
        decompose(Mesh.from_arrays(*box()), "merged", error_m=number)


def test_an_exception_from_progress_stops_the_work():
    def interrupt(share):
        if share > 0.3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        decompose(
            shape("torus"), "merged", error_m=1e-3, progress=interrupt, cache=False
        )


@pytest.mark.parametrize(
    ("name", "error_m", "tool"), [("torus", 1e-3, "ball"), ("spoon", 2e-3, "spike")]
)
def test_no_tool_falls_through_a_seam(name, error_m, tool):
    mesh, pieces = merged(name, error_m).mesh, merged(name, error_m).core
    surface, pressed = Surface(mesh), make_tools()[tool]
    overlap = Overlap(pressed.mesh, surface)
    met = 0
    for motion in ("press", "jab", "slide"):
        for press in sample_presses(mesh, pressed, motion, range(2), 0):
            verdict = judge(press, pressed, surface, pieces, GAINS["default"], overlap)
            if verdict.skipped:
                continue
            met += 1
            assert verdict.finite and not verdict.through
            assert verdict.lost_tick < 0
    assert met >= 4
