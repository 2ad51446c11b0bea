"""Mesh intake: what is refused, what is repaired, and that nothing is silent."""

import copy
import json
import pickle
from itertools import pairwise
from pathlib import Path

import mesh_samples
import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from mesh_samples import box, corner_set, joined, l_prism, real_mesh

from drake_haptics.common.errors import MeshError
from drake_haptics.geometry.mesh.mesh import Mesh, load_mesh


def codes(mesh):
    return {finding.code: finding.count for finding in mesh.report.findings}


# What is refused.


@pytest.mark.parametrize(
    ("vertices", "triangles", "message"),
    [
        (np.zeros((0, 3)), np.zeros((0, 3), int), "no triangles"),
        (np.zeros((3, 3)), np.zeros((0, 3), int), "no triangles"),
        (np.zeros((3, 2)), [[0, 1, 2]], r"shape \(n, 3\)"),
        (np.eye(3), [[0, 1, 2, 0]], r"shape \(m, 3\)"),
        (np.eye(3), [0, 1, 2], r"shape \(m, 3\)"),
        (np.eye(3), [[0.0, 1.0, 2.0]], "integer indices"),
        (np.eye(3) * 1j, [[0, 1, 2]], "real numbers"),
        (np.eye(3).astype(str), [[0, 1, 2]], "real numbers"),
        ([[0, 0], [1]], [[0, 1, 2]], "array"),
        (np.eye(3), [[0, 1, 3]], "triangle 0 names vertex 3"),
        (np.eye(3), [[0, 1, 2], [0, -1, 2]], "triangle 1 names vertex -1"),
        (np.zeros((0, 3)), [[0, 1, 2]], "only 0 vertices"),
        (np.diag([1, np.nan, 1]), [[0, 1, 2]], "vertices is NaN.*vertex 1"),
        (np.diag([1, 1, -np.inf]), [[0, 1, 2]], "vertices is NaN.*vertex 2"),
        (np.eye(3) * 1e200, [[0, 1, 2]], "state the unit"),
        (np.eye(3), [[0, 0, 1], [2, 2, 2]], "all 2 triangles are degenerate"),
        (np.outer([0, 1, 2], [1, 1, 1]), [[0, 1, 2]], "degenerate"),
    ],
)
def test_unusable_arrays_are_refused_by_name(vertices, triangles, message):
    with pytest.raises(MeshError, match=message) as refusal:
        Mesh.from_arrays(vertices, triangles, name="the part")
    assert str(refusal.value).startswith("the part: ")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"unit": "furlong"}, "unknown unit 'furlong'.*mm"),
        ({"scale": 0.0}, "positive"),
        ({"scale": float("nan")}, "positive"),
        ({"unit": "mm", "scale": 0.001}, "one of them"),
    ],
)
def test_a_wrong_unit_is_refused(tmp_path, options, message):
    np.savez(tmp_path / "box.npz", V=box()[0], F=box()[1])
    with pytest.raises(MeshError, match=message):
        load_mesh(tmp_path / "box.npz", **options)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"unit": ["mm"]}, "unit must be a text or None, is of type list"),
        ({"scale": "0.001"}, "scale must be a number or None, is the str '0.001'"),
        ({"scale": [1.0, 1.0, -1.0]}, "scale must be a number or None"),
    ],
)
def test_a_unit_of_the_wrong_type_is_refused_by_name(tmp_path, options, message):
    np.savez(tmp_path / "box.npz", V=box()[0], F=box()[1])
    with pytest.raises(TypeError, match=message):
        load_mesh(tmp_path / "box.npz", **options)


# What is accepted as it is.


def test_a_clean_box_passes_unchanged_and_read_only():
    V, F = box((0.1, 0.2, 0.3))
    mesh = Mesh.from_arrays(V, F, strict=True)
    assert mesh.report.findings == ()
    np.testing.assert_array_equal(mesh.vertices, V)
    np.testing.assert_array_equal(mesh.triangles, F)
    assert mesh.triangles.dtype == np.int32 and mesh.vertices.dtype == np.float64
    (component,) = mesh.components
    assert component.closed and component.solid and component.orientable
    assert component.volume == pytest.approx(0.006)
    assert component.area == pytest.approx(0.22)
    assert component.bounds == ((0, 0, 0), (0.1, 0.2, 0.3))
    assert mesh.solid.all() and not mesh.component_of_triangle.any()
    for array in (mesh.vertices, mesh.triangles, mesh.solid):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    V[0] = 7  # the caller's array is not ours
    assert mesh.vertices[0, 0] == 0


# What is repaired.


def test_inverted_solid_is_turned_outward():
    V, F = l_prism()
    mesh = Mesh.from_arrays(V, F[:, ::-1])
    assert codes(mesh) == {"inverted-winding": 1}
    assert corner_set(mesh.vertices, mesh.triangles) == corner_set(V, F)
    assert mesh.components[0].volume == pytest.approx(3)


def test_vertices_are_joined_only_if_bit_equal():
    V, F = box()
    soup = V[F.ravel()]
    soup[soup == 0] = np.where(np.arange((soup == 0).sum()) % 2, -0.0, 0.0)
    mesh = Mesh.from_arrays(soup, np.arange(36).reshape(-1, 3))
    assert codes(mesh) == {"duplicate-vertices": 28}
    assert mesh.report.solids == 1
    soup[0] = np.nextafter(soup[0], 2)
    torn = Mesh.from_arrays(soup, np.arange(36).reshape(-1, 3))
    assert torn.report.solids == 0 and codes(torn)["holes"] > 0


def test_unused_vertices_are_dropped():
    V, F = box()
    mesh = Mesh.from_arrays(np.concatenate([[[9, 9, 9]], V]), F + 1)
    assert codes(mesh) == {"unused-vertices": 1}
    np.testing.assert_array_equal(mesh.vertices, V)


def test_a_sheet_written_for_both_sides_becomes_one_sheet():
    V = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    F = np.array([[0, 1, 2], [0, 2, 3]])
    mesh = Mesh.from_arrays(V, np.concatenate([F, F[:, ::-1]]))
    assert codes(mesh) == {"opposite-faces": 2, "holes": 4}
    np.testing.assert_array_equal(mesh.triangles, F)


def test_the_wall_between_glued_solids_goes():
    mesh = Mesh.from_arrays(*joined(box(), box(at=(1, 0, 0))))
    assert codes(mesh)["inner-walls"] == 2
    assert mesh.report.components == mesh.report.solids == 1
    assert mesh.report.volume == pytest.approx(2)


def test_a_zero_area_triangle_leaves_no_crack():
    """An edge of a box is split on one side only; a sliver bridges the crack."""
    V, F = box()
    a, b, c = F[0]
    V = np.concatenate([V, [(V[a] + V[b]) / 2]])
    F = np.concatenate([[[a, 8, c], [8, b, c], [a, b, 8]], F[1:]])
    mesh = Mesh.from_arrays(V, F)
    assert codes(mesh) == {"zero-area-faces": 1}
    assert mesh.report.solids == 1 and len(mesh.triangles) == 14
    assert mesh.report.volume == pytest.approx(1)
    assert mesh.report.area == pytest.approx(6)


def test_a_chain_of_zero_area_triangles_leaves_no_crack():
    V, F = box()
    a, b, c = F[0]
    shares = np.linspace(0, 1, 7)[1:-1, None]
    V = np.concatenate([V, V[a] + shares * (V[b] - V[a])])
    along = [a, *range(8, 13), b]
    fan = [(p, q, c) for p, q in pairwise(along)]
    slivers = [(a, along[i + 1], along[i]) for i in range(1, 6)]
    mesh = Mesh.from_arrays(V, np.concatenate([fan, slivers, F[1:]]))
    assert codes(mesh) == {"zero-area-faces": 5}
    assert mesh.report.solids == 1 and mesh.report.area == pytest.approx(6)


@pytest.mark.parametrize(
    "copied", [copy.deepcopy, lambda m: pickle.loads(pickle.dumps(m))]
)
def test_a_copy_is_read_only_too(copied):
    mesh = copied(Mesh.from_arrays(*box()))
    arrays = (mesh.vertices, mesh.triangles, mesh.component_of_triangle, mesh.solid)
    assert not any(array.flags.writeable for array in arrays)


def test_a_mesh_may_be_named_by_its_path():
    mesh = Mesh.from_arrays(*box(), name=Path("box.obj"))
    assert json.loads(json.dumps(mesh.report.to_dict()))["source"] == "box.obj"


# What is left as it is, by name.


def test_holes_are_counted_and_left_open():
    V, F = box()
    mesh = Mesh.from_arrays(V, F[[0, 1, 4, 5, 6, 7, 8, 9, 10, 11]])
    assert codes(mesh) == {"holes": 4}
    assert not mesh.components[0].closed and mesh.components[0].volume is None
    assert not mesh.solid.any() and mesh.report.one_sided_triangles == 10
    assert "one-sided" in mesh.report.verdict


def test_solids_that_share_an_edge_stay_two_solids():
    V, F = joined(box(), box(at=(1, 1, 0)))
    soup = V[F.ravel()]
    mesh = Mesh.from_arrays(soup, np.arange(len(soup)).reshape(-1, 3))
    assert codes(mesh)["non-manifold-edges"] == 1
    assert mesh.report.components == mesh.report.solids == 2
    parts = [
        set(mesh.triangles[mesh.component_of_triangle == c].ravel()) for c in (0, 1)
    ]
    assert not parts[0] & parts[1]


def test_a_fin_does_not_open_the_solid_it_stands_on():
    V, F = box()
    V = np.concatenate([V, [[0.5, 0.5, 2]]])
    mesh = Mesh.from_arrays(V, np.concatenate([F, [[*F[2][:2], 8]]]))
    assert codes(mesh)["non-manifold-edges"] == 1
    assert mesh.report.solids == 1 and mesh.report.one_sided_triangles == 1


def test_a_moebius_strip_has_one_side():
    n = 12
    angle = np.arange(n) * 2 * np.pi / n
    radial = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    across = 0.2 * (
        np.cos(angle / 2)[:, None] * radial + np.sin(angle / 2)[:, None] * [0, 0, 1]
    )
    V = np.concatenate([radial - across, radial + across])
    quads = [(i, i + 1, i + 1 + n, i + n) for i in range(n - 1)]
    quads.append((n - 1, n, 0, 2 * n - 1))
    F = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    mesh = Mesh.from_arrays(V, F)
    assert codes(mesh)["not-orientable"] == 1
    assert not mesh.components[0].orientable and not mesh.solid.any()


def test_a_sheet_folded_on_itself_is_no_solid():
    V = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    mesh = Mesh.from_arrays(V, [[0, 1, 2], [0, 2, 3], [1, 0, 3], [1, 3, 2]])
    assert codes(mesh) == {"no-volume": 1}
    assert mesh.components[0].closed and not mesh.solid.any()


@pytest.mark.parametrize(
    ("size", "questioned"), [(9, 0), (11, 1), (2e-3, 0), (9e-4, 1)]
)
def test_an_unusual_size_is_questioned(size, questioned):
    mesh = Mesh.from_arrays(*box((size, size / 2, size / 3)), strict=True)
    assert codes(mesh).get("suspicious-size", 0) == questioned


def test_a_unit_that_the_file_states_is_not_ignored_silently(tmp_path, monkeypatch):
    trimesh.Trimesh(*box(), process=False).export(tmp_path / "box.ply")
    monkeypatch.setattr(trimesh.Scene, "units", "millimeters")
    assert "unit-ignored" in codes(load_mesh(tmp_path / "box.ply"))
    assert "unit-ignored" not in codes(load_mesh(tmp_path / "box.ply", unit="m"))


# Nested shells.


def shells(outer_sign, inner_sign):
    outer, inner = box(), box((0.5, 0.5, 0.5), at=(0.25, 0.25, 0.25))
    outer = (outer[0], outer[1][:, ::outer_sign])
    return joined(outer, (inner[0], inner[1][:, ::inner_sign]))


@pytest.mark.parametrize("first", [0, 1])
@pytest.mark.parametrize(
    ("signs", "volume", "cavity", "code"),
    [
        ((1, 1), 1.125, False, None),  # a body inside a body
        ((1, -1), 0.875, True, None),  # the wall of a cavity
        ((-1, 1), 0.875, True, "inverted-winding"),  # a hollow body inside out
        ((-1, -1), 1.125, False, "inverted-winding"),  # two bodies inside out
    ],
)
def test_nested_shells(first, signs, volume, cavity, code):
    V, F = shells(*signs)
    mesh = Mesh.from_arrays(V, np.roll(F, 12 * first, axis=0))
    assert mesh.report.volume == pytest.approx(volume)
    assert mesh.components[1 - first].cavity is cavity
    assert not mesh.components[first].cavity
    assert mesh.solid.all()
    assert (code in codes(mesh)) == (code is not None)
    assert ("cavities" in codes(mesh)) is cavity


def test_a_body_in_a_cavity_is_a_body():
    inner = box((0.1, 0.1, 0.1), at=(0.45, 0.45, 0.45))
    V, F = joined(shells(1, -1), (inner[0], inner[1][:, ::-1]))
    mesh = Mesh.from_arrays(V, F)
    assert [component.cavity for component in mesh.components] == [False, True, False]
    assert mesh.report.volume == pytest.approx(0.875 + 0.001)


# Strictness.


def test_strict_refuses_what_needs_repair_and_names_it():
    V, F = box()
    with pytest.raises(MeshError, match=r"strict.*written more than once"):
        Mesh.from_arrays(V, np.concatenate([F, F[:1]]), strict=True)
    with pytest.raises(MeshError, match="open edges"):
        Mesh.from_arrays(V, F[1:], strict=True)
    soup = V[F.ravel()]  # how STL files are: nothing is wrong with the surface
    Mesh.from_arrays(soup, np.arange(36).reshape(-1, 3), strict=True)


# Whatever the disorder, the same solid.


@settings(max_examples=60)
@given(seed=st.integers(0, 2**32 - 1), sample=st.sampled_from(["box", "l_prism"]))
def test_disorder_is_repaired_to_the_same_solid(seed, sample):
    """Faces permuted, rotated, some turned over, some written again either way."""
    random = np.random.default_rng(seed)
    V, F = getattr(mesh_samples, sample)()
    want = corner_set(V, F)
    turned = random.random(len(F)) < 0.3
    dirty = np.where(turned[:, None], F[:, ::-1], F)
    extra = dirty[random.integers(0, len(F), random.integers(0, 6))]
    extra = np.where(random.random((len(extra), 1)) < 0.5, extra, extra[:, ::-1])
    dirty = np.concatenate([dirty, extra])
    dirty = np.take_along_axis(
        dirty, (np.arange(3) + random.integers(0, 3, (len(dirty), 1))) % 3, axis=1
    )
    dirty = random.permutation(dirty)
    if random.random() < 0.5:
        V, dirty = V[dirty.ravel()], np.arange(3 * len(dirty)).reshape(-1, 3)
    mesh = Mesh.from_arrays(V, dirty)
    assert corner_set(mesh.vertices, mesh.triangles) == want
    assert mesh.report.solids == mesh.report.components == 1


@settings(max_examples=60)
@given(
    V=st.lists(
        st.tuples(*[st.sampled_from([0.0, -0.0, 1.0, 0.5, 1e-300, 1e8])] * 3),
        min_size=1,
        max_size=8,
    ),
    F=st.lists(st.tuples(*[st.integers(0, 7)] * 3), max_size=30),
)
def test_any_arrays_are_taken_in_or_refused_with_a_reason(V, F):
    try:
        mesh = Mesh.from_arrays(V, np.array(F, dtype=int).reshape(-1, 3))
    except MeshError:
        return
    assert np.isfinite(mesh.vertices).all()
    assert set(mesh.triangles.ravel()) == set(range(len(mesh.vertices)))
    corners = mesh.vertices[mesh.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.linalg.norm(normals, axis=1) > 0).all()


# Real meshes: figures counted by others, see LICENSES.md beside them.


def test_a_raw_scan():
    mesh = load_mesh(real_mesh("bunny_scan_raw.ply"))
    found = codes(mesh)
    assert found["duplicate-faces"] + found["opposite-faces"] == 87
    assert len(mesh.triangles) == 16301 - 87
    assert mesh.report.solids == 0 and not mesh.solid.any()
    largest = max(mesh.components, key=lambda component: component.triangles)
    assert largest.triangles > 0.98 * len(mesh.triangles)


def test_open_sheets():
    mesh = load_mesh(real_mesh("fcl_env.obj"), unit="mm")
    assert codes(mesh)["holes"] == 1856
    assert mesh.report.components == 85 and len(mesh.triangles) == 2180


def test_a_branching_surface():
    mesh = load_mesh(real_mesh("fcl_rob.obj"), unit="mm")
    assert codes(mesh)["non-manifold-edges"] == 27
    assert len(mesh.triangles) == 216


def test_a_tooth_is_two_bodies_one_inside_the_other():
    mesh = load_mesh(real_mesh("tooth.ply"), scale=4e-5)
    assert [component.solid for component in mesh.components] == [True, True]
    assert not any(component.cavity for component in mesh.components)
    assert mesh.report.volume / 4e-5**3 == pytest.approx(1.564e7, rel=1e-3)


def test_two_organs():
    mesh = load_mesh(real_mesh("digestive_24846.ply"), strict=True)
    assert mesh.report.solids == 2 and len(mesh.triangles) == 24846
    assert mesh.report.volume == pytest.approx(0.003067, rel=1e-3)


def test_slivers_of_a_gear_leave_it_closed():
    mesh = load_mesh(real_mesh("gear_small.npz"))
    assert set(codes(mesh)) == {"zero-area-faces"}
    assert mesh.report.solids == 1
    assert mesh.report.volume == pytest.approx(3.475e-6, rel=1e-3)
