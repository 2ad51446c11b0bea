"""Centered meshes: they are where the same mesh would be if its file were centered."""

import numpy as np
import pytest
import trimesh

from drake_haptics.geometry.mesh.decimation import decimate
from drake_haptics.geometry.mesh.mesh import Mesh
from drake_haptics.geometry.mesh.placement import center, find_origin_beside
from drake_haptics.scene.geometry import cut_scene
from drake_haptics.scene.schema import EnvironmentObject, Scene, Tool

CYLINDER = "package://drake/examples/kuka_iiwa_arm/models/objects/simple_cylinder.urdf"
# Exact in binary, so that moving there and back rounds nothing away.
AWAY = np.array([8.0, -4.0, 2.0])


def make_block():
    block = trimesh.creation.box([0.5, 0.25, 0.125])
    return np.array(block.vertices), np.array(block.faces)


def test_the_middle_of_the_box_comes_to_the_origin():
    vertices, triangles = make_block()
    far = Mesh.from_arrays(vertices + AWAY, triangles, name="far")
    near = Mesh.from_arrays(vertices, triangles)
    centered = center(far)
    np.testing.assert_array_equal(centered.vertices, near.vertices)
    np.testing.assert_array_equal(centered.triangles, near.triangles)
    assert centered.components == near.components
    assert centered.report.source == "far"
    (finding,) = centered.report.findings
    assert finding.code == "centered" and "(8, -4, 2) m" in finding.message


def test_what_was_found_before_stays_in_the_report():
    vertices, triangles = make_block()
    open_box = Mesh.from_arrays(vertices, triangles[:-1])
    found = [finding.code for finding in open_box.report.findings]
    assert found
    centered = [finding.code for finding in center(open_box).report.findings]
    assert centered == [*found, "centered"]


def test_a_decimated_mesh_that_is_centered_keeps_its_error():
    ball = trimesh.creation.icosphere(2)
    few = decimate(Mesh.from_arrays(ball.vertices + AWAY, ball.faces), 100)
    assert 0.0 < few.report.decimation_error_m
    assert center(few).report.decimation_error_m == few.report.decimation_error_m


@pytest.mark.parametrize(
    ("x", "beside"),
    # Half the block is 0.25 m long, a tenth of its diagonal 57 mm.
    [(0.0, None), (0.25, None), (0.3, None), (0.31, 0.06), (8.0, 7.75)],
)
def test_an_origin_is_beside_the_mesh_where_it_is_far_out_of_its_box(x, beside):
    vertices, triangles = make_block()
    found = find_origin_beside(
        Mesh.from_arrays(vertices + np.array([x, 0, 0]), triangles)
    )
    assert found == (None if beside is None else pytest.approx(beside))


def test_tool_and_objects_of_a_scene_are_centered_where_they_say_so(tmp_path):
    vertices, triangles = make_block()
    file = tmp_path / "far.npz"
    np.savez(file, V=1e3 * (vertices + AWAY), F=triangles)
    for is_centered, middle in [(False, AWAY), (True, np.zeros(3))]:
        shape = {"scale": 1e-3, "center": is_centered}
        tool = Tool(mesh=str(file), **shape)
        thing = EnvironmentObject(name="thing", mesh=str(file), **shape)
        for pieces in cut(tool, thing):
            box = pieces.mesh.vertices.min(axis=0), pieces.mesh.vertices.max(axis=0)
            np.testing.assert_allclose(np.mean(box, axis=0), middle, atol=1e-12)
            np.testing.assert_allclose(np.ptp(box, axis=0), [0.5, 0.25, 0.125])


def test_a_model_file_is_centered_and_reduced_too():
    shape = {"center": True, "max_triangles": 100, "decomposition": "hull"}
    tool = Tool(mesh=CYLINDER, **shape)
    thing = EnvironmentObject(name="thing", mesh=CYLINDER, **shape)
    for pieces in cut(tool, thing):
        assert len(pieces.mesh.triangles) <= 100
        codes = [finding.code for finding in pieces.mesh.report.findings]
        assert codes == ["centered", "decimated"]


def cut(tool, thing):
    made, (other,) = cut_scene(Scene(tool=tool, environment=[thing]))
    return made, other
