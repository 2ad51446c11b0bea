"""The viewer: every facet drawn once, in its color, on a page that stands alone."""

from contextlib import closing

import numpy as np
import pytest
from mesh_samples import box, l_prism

from drake_haptics import _core
from drake_haptics.common.colors import VIRTUAL_FACET, piece_color
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.decomposition.pieces import piece_surfaces
from drake_haptics.geometry.decomposition.viewer import DecompositionViewer
from drake_haptics.geometry.mesh.mesh import Mesh


def area(drawn):
    a, b, c = drawn.vertices[drawn.faces].swapaxes(0, 1)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


@pytest.fixture(scope="module")
def hull_of_l():
    return decompose(Mesh.from_arrays(*l_prism()), "hull", cache=False)


def test_a_box_is_drawn_as_its_six_sides():
    result = decompose(Mesh.from_arrays(*box()), cache=False)
    on_mesh, virtual = piece_surfaces(result.pieces)
    assert area(on_mesh) == pytest.approx(6) and len(on_mesh.faces) == 12
    assert len(virtual.vertices) == 0
    np.testing.assert_allclose(on_mesh.colors, [piece_color(0)[:3]] * 36)


def test_facets_that_are_not_on_the_mesh_are_drawn_apart():
    V, F = l_prism()
    pieces = _core.adopt_convex_pieces(V, F.astype(np.int32), [V], 1e-9).pieces
    on_mesh, virtual = piece_surfaces(pieces)
    across_notch, floor = 2**0.5, 3.5
    assert area(virtual) == pytest.approx(across_notch + 2 * floor)
    assert area(on_mesh) == pytest.approx(2 + 2 + 1 + 1)
    assert (virtual.colors == VIRTUAL_FACET[:3]).all()
    assert set(virtual.piece) == {0}


def test_a_flat_piece_is_drawn_once():
    V, F = box()
    result = decompose(Mesh.from_arrays(V, F[:2]), cache=False)
    on_mesh, virtual = piece_surfaces(result.pieces)
    assert area(on_mesh) == pytest.approx(1) and len(virtual.faces) == 0
    assert result.report.virtual_facets == 0 and result.report.facets == 1


def test_the_page_stands_alone(hull_of_l, tmp_path, capsys):
    with closing(DecompositionViewer(hull_of_l)) as viewer:
        assert viewer.url.startswith("http://")
        viewer.write_html(tmp_path / "page.html")
    assert capsys.readouterr().out == ""  # stdout may be somebody's JSON
    page = (tmp_path / "page.html").read_text()
    assert page.lstrip().lower().startswith("<!doctype html>")
    assert 'src="http' not in page and "src='http" not in page
    assert len(page) > 100_000  # the drawing code is inside
    assert 'content="width=device-width' in page[:1000]
    assert "convex piece" in page and "left: in place" in page
