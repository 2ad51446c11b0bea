"""Decomposition: the right pieces, the same after a file, errors with reasons."""

import copy
import dataclasses
import itertools
import pickle

import numpy as np
import pytest
from mesh_samples import box, joined, l_prism, real_mesh

from drake_haptics import SceneTracker
from drake_haptics.common.errors import DecompositionFileError, HapticsError
from drake_haptics.geometry.decomposition import decompose as decomposition
from drake_haptics.geometry.decomposition.decompose import Decomposition, decompose
from drake_haptics.geometry.decomposition.storage import read_archive, write_archive
from drake_haptics.geometry.mesh.mesh import Mesh, load_mesh


def contains(piece, points, tolerance):
    """Whether the piece's facets have all the points behind them."""
    heights = points @ np.asarray(piece.facet_normals).T - piece.facet_offsets
    return bool((heights <= tolerance).all())


def same_pieces(a, b):
    return len(a.pieces) == len(b.pieces) and all(
        np.array_equal(p.vertices, q.vertices)
        and np.array_equal(p.facet_original, q.facet_original)
        for p, q in zip(a.pieces, b.pieces, strict=True)
    )


def through_pickle(value):
    return pickle.loads(pickle.dumps(value))


def test_a_convex_solid_gives_one_hull_without_virtual_facets():
    result = decompose(Mesh.from_arrays(*box()), cache=False)
    (piece,) = result.pieces
    assert piece.dimension == 3 and len(piece.facets) == 6
    assert result.report.virtual_facets == result.report.flat_pieces == 0
    assert result.report.one_sided_triangles == 0


def test_a_surface_is_covered_and_no_piece_fills_the_notch():
    mesh = Mesh.from_arrays(*l_prism())
    result = decompose(mesh, cache=False)
    assert len(result.pieces) > 1
    labels = np.asarray(result.core.piece_of_triangle)
    for index, piece in enumerate(result.pieces):
        corners = mesh.vertices[mesh.triangles[labels == index]].reshape(-1, 3)
        assert len(corners) and contains(piece, corners, 1e-12)
        if piece.dimension == 3:
            assert not contains(piece, np.array([[1.5, 1.5, 0.5]]), 0)
            assert not contains(piece, np.array([[1.01, 1.01, 0.5]]), 0)


def test_the_hull_of_each_part_fills_its_notch():
    V, F = joined(l_prism(), box(at=(5, 0, 0)))
    result = decompose(Mesh.from_arrays(V, F), "hull", cache=False)
    assert len(result.pieces) == 2
    l_hull = next(p for p in result.pieces if len(p.vertices) != 8)
    assert contains(l_hull, np.array([[1.4, 1.4, 0.5]]), 0)
    # The facet across the notch is felt, and floor and ceiling, which are on the mesh
    # only in part.
    assert np.asarray(l_hull.facet_original).all()


def test_a_tool_does_not_fall_through_a_hull_with_notches():
    hull = decompose(Mesh.from_arrays(*l_prism()), "hull", cache=False)
    top = max(piece.vertices[:, 2].max() for piece in hull.pieces)
    cube = decompose(Mesh.from_arrays(*box(at=(0, 0, 0), size=(0.2, 0.2, 0.2))))
    tracker = SceneTracker(cube, [hull], 0.01)
    for gap in np.linspace(0.009, -0.005, 15):
        contacts = tracker.query([1, 0, 0, 0, 0.4, 0.4, top + gap])
        assert contacts.distance.min() == pytest.approx(gap, abs=1e-12)


def test_coacd_fills_a_solid_with_few_pieces():
    pytest.importorskip("coacd")
    mesh = Mesh.from_arrays(*l_prism())
    result = decompose(mesh, "coacd", cache=False)
    assert 2 <= len(result.pieces) <= 4
    inside = np.array([[0.5, 0.5, 0.5], [1.5, 0.5, 0.5], [0.5, 1.5, 0.5]])
    for point in inside:
        assert any(contains(piece, point[None], 1e-6) for piece in result.pieces)
    assert not any(
        contains(piece, np.array([[1.7, 1.7, 0.5]]), 0) for piece in result.pieces
    )


def test_without_coacd_the_error_says_what_to_install(monkeypatch):
    def missing(name):
        raise decomposition.coacd_parameters.__globals__["PackageNotFoundError"](name)

    monkeypatch.setattr(
        "drake_haptics.geometry.decomposition.approximate.version", missing
    )
    with pytest.raises(HapticsError, match=r"pip install 'drake_haptics\[coacd\]'"):
        decompose(Mesh.from_arrays(*box()), "coacd", cache=False)


def test_an_unknown_method_is_refused():
    with pytest.raises(HapticsError, match=r"'convex'.*surface, merged, hull, coacd"):
        decompose(Mesh.from_arrays(*box()), "convex")


@pytest.mark.parametrize("bad", [None, "cup.obj", box()])
def test_what_is_no_mesh_is_refused(bad):
    with pytest.raises(HapticsError, match=r"^mesh must be a Mesh, got .* load_mesh"):
        decompose(bad)


def test_a_decomposition_says_what_it_is():
    result = decompose(Mesh.from_arrays(*l_prism(), name="prism"), cache=False)
    count = len(result.pieces)
    assert repr(result) == f"Decomposition('prism', {count} pieces, method='surface')"


def test_an_open_surface_is_reported_as_one_sided():
    V, F = box()
    report = decompose(Mesh.from_arrays(V, F[2:]), cache=False).report
    assert report.one_sided_triangles == 10
    assert "bound no solid" in str(report)


def test_progress_rises_to_one():
    shares = []
    mesh = load_mesh(real_mesh("power_drill.stl"))
    decompose(mesh, progress=shares.append, cache=False)
    assert shares[-1] == 1 and len(shares) >= 2
    assert all(0 <= a <= b <= 1 for a, b in itertools.pairwise(shares))


def test_an_exception_from_progress_stops_the_work_and_comes_out():
    mesh = load_mesh(real_mesh("power_drill.stl"))

    def interrupt(share):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        decompose(mesh, progress=interrupt, cache=False)


@pytest.mark.parametrize("name", ["digestive_24846.ply", "bunny_scan_raw.ply"])
def test_a_large_real_mesh(name):
    mesh = load_mesh(real_mesh(name))
    result = decompose(mesh, cache=False)
    labels = np.asarray(result.core.piece_of_triangle)
    assert labels.shape == (len(mesh.triangles),)
    assert set(labels) == set(range(len(result.pieces)))
    assert len(result.pieces) <= len(mesh.triangles) * (0.3 if mesh.solid.all() else 1)
    component = np.zeros(len(result.pieces), dtype=int)
    component[labels] = mesh.component_of_triangle  # a piece stays in one component
    np.testing.assert_array_equal(component[labels], mesh.component_of_triangle)
    if not mesh.solid.any():
        assert result.report.flat_pieces == result.report.pieces


# Files.


@pytest.mark.parametrize("method", ["surface", "hull"])
def test_a_file_brings_back_mesh_pieces_and_reports(tmp_path, method):
    V, F = joined(l_prism(), box(at=(5, 0, 0)))
    V, F = V, np.concatenate([F[:-1], F[:1]])  # with a hole and a duplicate
    saved = decompose(Mesh.from_arrays(V, F, name="it"), method, cache=False)
    saved.save(tmp_path / "it.npz")
    loaded = Decomposition.load(tmp_path / "it.npz")
    assert same_pieces(saved, loaded) and loaded.method == method
    assert loaded.report == dataclasses.replace(saved.report, from_cache=True)
    assert loaded.mesh.report == saved.mesh.report
    assert loaded.mesh.components == saved.mesh.components
    for name in ("vertices", "triangles", "component_of_triangle", "solid"):
        a, b = getattr(saved.mesh, name), getattr(loaded.mesh, name)
        assert a.dtype == b.dtype and not b.flags.writeable
        np.testing.assert_array_equal(a, b)


@pytest.mark.parametrize("method", ["surface", "hull"])
@pytest.mark.parametrize("duplicate", [copy.deepcopy, through_pickle])
def test_a_copy_has_the_same_pieces(method, duplicate):
    result = decompose(Mesh.from_arrays(*l_prism()), method, cache=False)
    copied = duplicate(result)
    assert same_pieces(result, copied) and copied.report == result.report
    np.testing.assert_array_equal(copied.mesh.vertices, result.mesh.vertices)


def test_a_damaged_file_is_refused_wherever_the_damage_is(tmp_path):
    path = tmp_path / "it.npz"
    decompose(Mesh.from_arrays(*box()), cache=False).save(path)
    whole = path.read_bytes()
    for length in range(0, len(whole), 97):
        path.write_bytes(whole[:length])
        with pytest.raises(DecompositionFileError, match=r"it\.npz"):
            Decomposition.load(path)
    good = Decomposition.load
    for position in range(0, len(whole), 31):
        flipped = bytearray(whole)
        flipped[position] ^= 0x10
        path.write_bytes(flipped)
        try:  # zip has bytes that mean nothing, such as times: those may pass
            loaded = good(path)
        except DecompositionFileError:
            continue
        np.testing.assert_array_equal(loaded.mesh.vertices, box()[0])


def test_a_save_that_fails_names_the_file_and_leaves_nothing(tmp_path):
    result = decompose(Mesh.from_arrays(*box()), cache=False)
    (tmp_path / "it.npz").mkdir()
    with pytest.raises(OSError, match=r"it\.npz'$"):
        result.save(tmp_path / "it.npz")
    assert [path.name for path in tmp_path.iterdir()] == ["it.npz"]


def test_foreign_files_are_refused(tmp_path):
    path = tmp_path / "it.npz"
    np.savez(path, V=box()[0], F=box()[1])
    with pytest.raises(DecompositionFileError, match="is not a decomposition file"):
        Decomposition.load(path)
    decompose(Mesh.from_arrays(*box()), cache=False).save(path)
    facts, arrays = read_archive(path)
    write_archive(path, {**facts, "version": 99}, arrays)
    with pytest.raises(DecompositionFileError, match=r"version 99.*reads version 1"):
        Decomposition.load(path)
    labels = arrays["piece_of_triangle"]
    for wrong in (labels[:-1], labels - 1, labels + 5, labels.astype(float)):
        write_archive(path, facts, {**arrays, "piece_of_triangle": wrong})
        with pytest.raises(DecompositionFileError, match="do not fit"):
            Decomposition.load(path)
    with pytest.raises(FileNotFoundError):
        Decomposition.load(tmp_path / "absent.npz")
