"""Files named by the package they come with, wherever a mesh is loaded."""

import hashlib
from pathlib import Path

import numpy as np
import pytest

from drake_haptics import (
    BuildHapticDiagram,
    MeshError,
    Scene,
    load_mesh,
    make_scene_for_meshes,
)
from drake_haptics.common.files import resolve_package_url
from drake_haptics.geometry.parsing.model_file import load_model_mesh
from drake_haptics.loop.outputs import make_log_header
from drake_haptics.scene.schema import (
    EnvironmentObject,
    HandParameters,
    HandPathParameters,
    Tool,
    Waypoint,
)

MODELS = Path(__file__).parents[2] / "models"
PEG = "package://drake_haptics/models/meshes/peg.obj"
BLOCK = "package://drake_haptics/models/meshes/block.obj"
ARM = "package://drake_haptics/models/devices/phantom_premium_1_5_6dof.sdf"


@pytest.fixture
def scene():
    """A scene made in Python: no file, no folder."""
    return Scene(
        tool=Tool(mesh=PEG),
        environment=[EnvironmentObject(name="block", mesh=BLOCK)],
        hand=HandParameters(
            path=HandPathParameters(waypoints=[Waypoint(0.0, [0.0, 0.0, 0.1])])
        ),
    )


def test_a_path_stays_as_it_is():
    for file in ("a/b.obj", "/a//b.obj", "../package/x.obj"):
        assert resolve_package_url(file) == file
    assert resolve_package_url(Path("a/b.obj")) == "a/b.obj"


def test_a_mesh_of_this_package_is_the_file_in_its_folder():
    found = load_mesh(PEG)
    there = load_mesh(MODELS / "meshes" / "peg.obj")
    np.testing.assert_array_equal(found.vertices, there.vertices)


def test_a_file_of_drake_is_found():
    path = Path(resolve_package_url("package://drake/.drake-find_resource-sentinel"))
    assert path.is_file()


def test_a_scene_made_in_python_takes_package_meshes(scene):
    haptic = BuildHapticDiagram(scene)
    there = load_mesh(MODELS / "meshes" / "peg.obj")
    np.testing.assert_array_equal(haptic.tool.mesh.vertices, there.vertices)


def test_two_package_meshes_make_a_scene():
    scene = make_scene_for_meshes(PEG, BLOCK)
    assert Path(scene.tool.mesh).samefile(MODELS / "meshes" / "peg.obj")


def test_a_log_knows_what_the_mesh_was(scene):
    hashes = make_log_header(scene).mesh_sha256
    peg = (MODELS / "meshes" / "peg.obj").read_bytes()
    assert hashlib.sha256(peg).hexdigest() in hashes.values()
    assert all(Path(path).is_file() for path in hashes)


@pytest.mark.parametrize("load", [load_mesh, load_model_mesh])
def test_what_is_wrong_is_said(load):
    with pytest.raises(MeshError, match=r"no package 'drak'; known: .*drake_haptics"):
        load("package://drak/models/peg.sdf")
    with pytest.raises(MeshError, match=r"did you mean 'phantom_premium_1_5_6dof.sdf'"):
        load(ARM.replace("premium", "premum"))
