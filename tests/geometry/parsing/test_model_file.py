"""Robot models as meshes."""

import numpy as np
import pytest

from drake_haptics.common.errors import MeshError
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import calc_mass_properties
from drake_haptics.geometry.parsing.model_file import is_model_file, load_model_mesh

# A crank: a box, and a ball on a pin that stands 0.1 m beside it.
_CRANK = """<?xml version="1.0"?>
<sdf version="1.9"><model name="crank">
  <link name="arm">
    <collision name="box">
      <geometry><box><size>0.04 0.06 0.02</size></box></geometry>
    </collision>
    <visual name="drawn">
      <geometry><box><size>1 1 1</size></box></geometry>
    </visual>
  </link>
  <link name="knob">
    <pose>0.1 0 0.03 0 0 0</pose>
    <collision name="ball">
      <geometry><sphere><radius>0.015</radius></sphere></geometry>
    </collision>
  </link>
  <joint name="pin" type="revolute">
    <parent>arm</parent><child>knob</child>
    <axis><xyz>0 0 1</xyz></axis>
  </joint>
</model></sdf>"""


@pytest.fixture
def crank(tmp_path):
    path = tmp_path / "crank.sdf"
    path.write_text(_CRANK)
    return path


def test_every_link_is_where_its_joint_puts_it(crank):
    mesh = load_model_mesh(crank)
    box, ball = 0.04 * 0.06 * 0.02, 4.0 / 3.0 * np.pi * 0.015**3
    p_MMcm, _ = calc_mass_properties(mesh, 1.0)
    expected = ball * np.array([0.1, 0.0, 0.03]) / (box + ball)
    np.testing.assert_allclose(p_MMcm, expected, atol=2e-4)
    assert len(decompose(mesh, cache=False).pieces) == 2
    np.testing.assert_allclose(mesh.vertices.min(axis=0), [-0.02, -0.03, -0.01])


def test_round_shapes_keep_the_chord_error(crank):
    for chord_error_m in (1e-3, 1e-5):
        mesh = load_model_mesh(crank, chord_error_m=chord_error_m)
        of_ball = mesh.vertices[mesh.vertices[:, 0] > 0.05]
        radii = np.linalg.norm(of_ball - [0.1, 0.0, 0.03], axis=1)
        assert np.abs(radii - 0.015).max() <= chord_error_m * 1.001


def test_scale_is_of_all_lengths(crank):
    full, half = load_model_mesh(crank), load_model_mesh(crank, scale=0.5)
    np.testing.assert_allclose(half.vertices, 0.5 * full.vertices)


@pytest.mark.parametrize("scale", [-1.0, 0.0, np.nan])
def test_a_scale_that_turns_surfaces_inside_out_or_flat_is_refused(crank, scale):
    with pytest.raises(MeshError, match="scale must be a positive number of meters"):
        load_model_mesh(crank, scale=scale)


def test_a_mirrored_mesh_keeps_its_outside(tmp_path):
    """The roof is open, so that no closed volume tells its outside."""
    roof = "v 0 0 0\nv 1 0 0\nv 1 1 1\nv 0 1 1\nf 1 2 3\nf 1 3 4\n"
    (tmp_path / "roof.obj").write_text(roof)
    for factors, outside in (("1 1 1", 1), ("-1 1 1", 1), ("1 1 -1", -1)):
        shape = f'<mesh filename="roof.obj" scale="{factors}"/>'
        (tmp_path / "roof.urdf").write_text(
            '<robot name="r"><link name="l"><collision><geometry>'
            f"{shape}</geometry></collision></link></robot>"
        )
        mesh = load_model_mesh(tmp_path / "roof.urdf")
        a, b, c = np.swapaxes(mesh.vertices[mesh.triangles], 0, 1)
        assert (outside * np.cross(b - a, c - a)[:, 2] > 0.0).all(), factors


def test_what_cannot_be_used_is_said(tmp_path):
    with pytest.raises(MeshError, match="no such file"):
        load_model_mesh(tmp_path / "absent.urdf")
    broken = tmp_path / "broken.sdf"
    broken.write_text("<sdf")
    with pytest.raises(MeshError, match=r"broken\.sdf: Drake cannot parse it"):
        load_model_mesh(broken)
    empty = tmp_path / "empty.urdf"
    empty.write_text('<robot name="r"><link name="l"/></robot>')
    with pytest.raises(MeshError, match="no collision shape"):
        load_model_mesh(empty)


@pytest.mark.parametrize(
    ("name", "expected"),
    [("a.urdf", True), ("a.SDF", True), ("a.xml", True), ("a.obj", False)],
)
def test_model_files_are_known_by_their_suffix(name, expected):
    assert is_model_file(name) is expected
