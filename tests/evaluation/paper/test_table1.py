"""Table 1's rows are what `decompose` itself reports, and what is missing is told."""

import numpy as np
import pytest
from shapes import SHAPES
from shapes.organ import make_organ

from drake_haptics.evaluation.models import MODELS, OWN, find_sources
from drake_haptics.evaluation.paper.published import TABLE_1
from drake_haptics.evaluation.paper.table1 import measure_table1
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import Mesh

OWN_SHAPES = {
    "Torus": SHAPES["torus"],
    "Cup": SHAPES["cup"],
    "Spoon": SHAPES["spoon"],
    "Hammer": SHAPES["hammer"],
    "Digestive System": make_organ,
}


@pytest.fixture(scope="module")
def rows():
    return measure_table1(None, lambda what, share: None)


def test_rows_are_in_the_papers_order_with_its_numbers(rows):
    assert [r.model for r in rows] == [p.model for p in TABLE_1] == list(MODELS)
    assert [(r.paper_pieces, r.paper_triangles) for r in rows] == [
        (67, 2000),
        (190, 500),
        (78, 336),
        (425, 1692),
        (9098, 31240),
        (9913, 24846),
    ]


def test_figures_are_those_of_the_decomposition(rows):
    for row in rows:
        if row.model == "Armadillo":
            continue
        surface = OWN_SHAPES[row.model]()
        mesh = Mesh.from_arrays(surface.vertices, surface.triangles)
        pieces = decompose(mesh).pieces
        solid = [p for p in pieces if p.dimension == 3]
        assert row.source == OWN
        assert row.triangles == len(surface.triangles)
        assert row.pieces == len(pieces)
        assert row.flat_pieces == len(pieces) - len(solid)
        virtual = sum(int((~np.asarray(p.facet_original)).sum()) for p in solid)
        assert row.virtual_facets == virtual
        assert row.seconds > 0.0


def test_a_model_without_a_shape_is_told(rows):
    (armadillo,) = [r for r in rows if r.model == "Armadillo"]
    assert armadillo.source == "" and armadillo.pieces == 0


def test_a_mesh_that_is_there_has_a_row_of_its_own(tmp_path):
    spoon = SHAPES["spoon"]()
    lines = [f"v {x} {y} {z}" for x, y, z in spoon.vertices]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in spoon.triangles]
    (tmp_path / "spoon_336.obj").write_text("\n".join(lines) + "\n")
    assert find_sources("Spoon", tmp_path) == [OWN, "spoon_336.obj"]
    assert find_sources("Armadillo", tmp_path) == []
    shown = []
    rows = measure_table1(tmp_path, lambda what, share: shown.append((what, share)))
    own, real = (r for r in rows if r.model == "Spoon")
    assert (own.source, real.source) == (OWN, "spoon_336.obj")
    assert real.pieces == own.pieces and real.triangles == own.triangles
    shares = [share for _, share in shown]
    assert shares == sorted(shares) and shares[-1] == 1.0
