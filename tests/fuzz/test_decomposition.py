"""Meshes of any arrays: refused with a reason, or cut into pieces that cover them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from fuzz_strategies import point_sets, wrong_points
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from drake_haptics import HapticsError, Mesh, decompose

TETRAHEDRON = np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])


def faces(count: int) -> st.SearchStrategy[np.ndarray]:
    """(m, 3) indices of `count` vertices, few of which make a sound surface."""
    shapes = st.tuples(st.integers(1, 12), st.just(3))
    indices = st.integers(0, count - 1)
    return shapes.flatmap(lambda s: hnp.arrays(np.int32, s, elements=indices))


@given(st.data())
def test_pieces_cover_any_mesh_that_is_taken(data: Any) -> None:
    V = data.draw(point_sets())
    F = data.draw(faces(len(V)))
    try:
        mesh = Mesh.from_arrays(V, F)
    except HapticsError as error:
        assert str(error)
        return
    result = decompose(mesh, cache=False)
    size = np.ptp(mesh.vertices, axis=0).max()
    allowed = 3e-5 * size + 1e-14 * np.abs(mesh.vertices).max()
    labels = np.asarray(result.core.piece_of_triangle)
    assert len(labels) == len(mesh.triangles)
    for t, piece in enumerate(labels):
        hull = result.pieces[piece]
        corners = mesh.vertices[mesh.triangles[t]]
        heights = corners @ np.asarray(hull.facet_normals).T - hull.facet_offsets
        assert np.isfinite(heights).all()
        assert heights.max(initial=0) <= allowed


@given(wrong_points())
def test_wrong_vertices_are_refused(vertices: object) -> None:
    with pytest.raises(HapticsError):
        Mesh.from_arrays(vertices, TETRAHEDRON)


@given(
    st.one_of(
        wrong_points(),
        st.sampled_from(
            [
                TETRAHEDRON.astype(float),
                TETRAHEDRON + 1,
                TETRAHEDRON - 1,
                TETRAHEDRON.astype(np.int64) << 40,
                TETRAHEDRON.astype(np.uint64) - np.uint64(1),
            ]
        ),
    )
)
def test_wrong_triangles_are_refused(triangles: object) -> None:
    corners = np.concatenate([np.zeros((1, 3)), np.eye(3)])
    with pytest.raises(HapticsError):
        Mesh.from_arrays(corners, triangles)
