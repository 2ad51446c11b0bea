"""The mesh report: complete as data, readable as text."""

import json

import numpy as np
import pytest
from mesh_samples import box, joined

from drake_haptics.geometry.mesh.mesh import Mesh
from drake_haptics.geometry.mesh.report import MeshReport, Severity, length


@pytest.fixture
def dirty():
    V, F = joined(box((0.1, 0.1, 0.1)), box((0.1, 0.1, 0.1), at=(0.2, 0, 0)))
    F = np.concatenate([F[:-1], F[:1]])  # a hole in the second, a face twice
    return Mesh.from_arrays(V, F, name="two boxes").report


def test_data_survive_json(dirty):
    data = json.loads(json.dumps(dirty.to_dict(), allow_nan=False))
    assert MeshReport.from_dict(data) == dirty
    assert data["components"] == 2 and data["solids"] == 1
    assert data["one_sided_triangles"] == 11
    np.testing.assert_allclose(data["extent_m"], (0.3, 0.1, 0.1))
    assert data["volume_m3"] == pytest.approx(1e-3)
    assert {f["code"]: f["severity"] for f in data["findings"]} == {
        "duplicate-faces": "repaired",
        "holes": "defect",
        "many-parts": "note",
    }


def test_text_names_every_finding_and_what_was_done(dirty):
    text = str(dirty)
    assert text.startswith("two boxes\n")
    flat = " ".join(text.split())
    for finding in dirty.findings:
        assert f"{finding.message}: {finding.action} [{finding.code}]" in flat
    assert "300 mm x 100 mm x 100 mm" in flat
    # One of them is a solid, in which depth may be asked for.
    assert "Not looked for: places where the surface passes through itself" in flat
    assert "Usable in part as a solid: 1 of 2 parts" in flat
    assert max(map(len, text.splitlines())) <= 100


def test_the_worst_comes_first(dirty):
    first_words = [line.split()[0] for line in str(dirty).splitlines() if line]
    severities = [word for word in first_words if word in list(Severity)]
    assert severities == ["defect", "repaired", "note"]


def test_only_repairs_and_defects_are_unclean(dirty):
    assert [f.code for f in dirty.unclean] == ["duplicate-faces", "holes"]
    assert all(f.severity is not Severity.NOTE for f in dirty.unclean)


@pytest.mark.parametrize(
    ("triangles", "words"),
    [(slice(0, 12), "one solid"), (slice(1, 12), "open surface")],
)
def test_verdict(triangles, words):
    V, F = box()
    assert words in Mesh.from_arrays(V, F[triangles]).report.verdict


@pytest.mark.parametrize(
    ("size_m", "surface", "volume"),
    [
        (2.0, "24 m²", "8 m³"),
        (0.1, "0.06 m²", "0.001 m³"),
        (0.02, "24 cm²", "8 cm³"),
        (0.002, "24 mm²", "8 mm³"),
    ],
)
def test_areas_and_volumes_are_in_units_that_people_use(size_m, surface, volume):
    text = str(Mesh.from_arrays(*box((size_m,) * 3)).report)
    assert f"1 part, {surface}\n" in text
    assert f"volume   {volume}\n" in text


@pytest.mark.parametrize(("count", "words"), [(1, "m.fill_holes()"), (6, "MeshLab")])
def test_holes_come_with_what_closes_them(count, words):
    V, F = box()
    (finding,) = Mesh.from_arrays(V, F[count:]).report.findings
    assert words in finding.action
    assert "1 rim of holes or sheets in 1 part" in finding.message


def test_triangles_whose_corners_differ_by_round_off_come_with_what_joins_them():
    V, F = box()
    corners = V[F].reshape(-1, 3)
    corners = corners + 1e-9 * np.arange(corners.size).reshape(-1, 3)
    mesh = Mesh.from_arrays(corners, np.arange(len(corners)).reshape(-1, 3))
    assert "Merge Close Vertices" in mesh.report.findings[0].action


@pytest.mark.parametrize(
    ("meters", "text"),
    [(0, "0 m"), (1.5, "1.5 m"), (0.25, "250 mm"), (2e-3, "2 mm"), (5e-5, "50 µm")],
)
def test_length(meters, text):
    assert length(meters) == text


def test_the_verdict_names_cavities_beside_the_solids_that_have_them():
    inner, inward = box((0.1, 0.1, 0.1), at=(0.1, 0.1, 0.1))
    V, F = joined(box((0.3, 0.3, 0.3)), (inner, inward[:, ::-1]))
    verdict = Mesh.from_arrays(V, F).report.verdict
    assert verdict.startswith("Usable as one solid with a cavity: closed,")
    assert verdict.endswith("cavity walls inward.")
    twice = Mesh.from_arrays(*joined((V, F), (V + 2.0, F))).report.verdict
    assert twice.startswith("Usable as 2 solids with 2 cavities: closed,")
