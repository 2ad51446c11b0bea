"""Questions about scenes: each is asked where it applies, and none elsewhere."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from box_scenes import PLATE_TOP, over_a_plate, write

from drake_haptics.authoring.plausibility import check_plausibility
from drake_haptics.device.backend import DeviceBackend, DeviceReading
from drake_haptics.geometry.mesh.report import length
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.device_preset import load_device_preset
from drake_haptics.scene.library import list_scenes
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import EnvironmentObject, Pose, Scene, Tool, Waypoint

PRESS = [(0.0, 0.0, 0.0, 0.03), (1.0, 0.0, 0.0, 0.005)]


def ask(scene, **settings):
    return check_plausibility(BuildHapticDiagram(scene, **settings))


@pytest.mark.parametrize("name", list_scenes())
def test_nothing_is_asked_about_what_comes_along(name):
    assert ask(load_scene(list_scenes()[name])) == []


def test_millimeters_taken_for_meters_are_asked_for(tmp_path):
    scene = over_a_plate(tmp_path, PRESS)
    assert ask(scene) == []
    size_m = 1e3 * max(trimesh.load(scene.environment[0].mesh).extents)
    big = trimesh.load(scene.environment[0].mesh)
    scene.environment[0].mesh = write(tmp_path, "big", big.apply_scale(1e3))
    (question,) = [q for q in ask(scene) if "big.obj" in q]
    assert f"is {size_m:.4g} m wide" in question and "in mm:" in question
    assert "environment[0].scale: 0.001" in question
    scene.environment[0].scale = 1e-3
    assert ask(scene) == []


def test_a_scale_too_small_is_asked_for(tmp_path):
    scene = over_a_plate(tmp_path, PRESS)
    scene.tool.scale = 1e-3
    (question,) = [q for q in ask(scene) if q.startswith("tool:")]
    assert "20 µm wide" in question and question.endswith("tool.scale: 1")


def test_a_mesh_with_a_hole_is_asked_for(tmp_path):
    scene = over_a_plate(tmp_path, PRESS)
    cube = trimesh.load(scene.tool.mesh)
    cube.update_faces(np.arange(len(cube.faces)) > 0)
    scene.tool.mesh = write(tmp_path, "torn", cube)
    (question,) = ask(scene)
    assert question.startswith("tool: torn.obj is open: 11 of 11 triangles bound no")


def test_a_mesh_that_has_lost_its_shape_is_asked_for(tmp_path):
    scene = over_a_plate(tmp_path, PRESS)
    # A ball of 20 mm; its 36 triangles are up to 3 mm from it.
    scene.tool.mesh = write(tmp_path, "ball", trimesh.creation.icosphere(3, 0.01))
    for max_triangles, tolerance_m, is_asked in [
        (600, 1e-3, False),
        (36, 1e-3, True),
        (36, 4e-3, False),
    ]:
        scene.tool.max_triangles = max_triangles
        scene.contact.tolerance_m = tolerance_m
        asked = [question for question in ask(scene) if "decimated" in question]
        assert bool(asked) == is_asked
        if asked:
            assert asked[0].startswith("tool: ball.obj is decimated from 1,280 to 36")
            assert asked[0].endswith("take a larger max_triangles")


def test_a_tolerance_in_millimeters_is_asked_for(tmp_path):
    scene = over_a_plate(tmp_path, PRESS)
    scene.contact.tolerance_m = 2.0
    assert [q for q in ask(scene) if q.startswith("contact.tolerance_m: is 2 m")]


def test_a_mesh_far_from_its_origin_is_asked_for(tmp_path):
    scene = over_a_plate(tmp_path, PRESS)
    cube = trimesh.load(scene.tool.mesh)
    middle = cube.bounds.mean(axis=0)
    # A handle that begins at its end is as meant.
    for name, away_m, is_asked in [("end", 0.01, False), ("far", 0.3, True)]:
        moved = cube.copy()
        moved.apply_translation(np.array([away_m, 0.0, 0.0]) - middle)
        scene.tool.mesh = write(tmp_path, name, moved)
        asked = [question for question in ask(scene) if "origin" in question]
        assert bool(asked) == is_asked
    assert "far.obj is 290 mm beside the mesh" in asked[0]
    # What the question names answers it.
    assert "tool.center: true" in asked[0]
    scene.tool.center = True
    assert not [question for question in ask(scene) if "origin" in question]


def test_a_path_that_passes_all_objects_is_asked_for(tmp_path):
    # The cube's lower face comes down to 0.5 mm above the plate, and to 3 mm,
    # which is more than the tolerance of 2 mm.
    near = over_a_plate(tmp_path, [(0.0, 0.0, 0.0, 0.03), (1.0, 0.0, 0.0, 0.0105)])
    assert ask(near) == []
    far = over_a_plate(tmp_path, [(0.0, 0.0, 0.0, 0.03), (1.0, 0.0, 0.0, 0.013)])
    (question,) = ask(far)
    assert "within reach where the hand's path" in question
    assert "the nearest is 3 mm away" in question


def test_a_tool_that_starts_deep_is_asked_for(tmp_path):
    # 20 kN/m show the device's largest force, 8.5 N, at 0.425 mm.
    light = over_a_plate(tmp_path, [(0.0, 0.0, 0.0, 0.0097), (1.0, 0.0, 0.0, 0.02)])
    assert ask(light) == []
    deep = over_a_plate(tmp_path, [(0.0, 0.0, 0.0, 0.005), (1.0, 0.0, 0.0, 0.02)])
    (question,) = ask(deep)
    assert "starts 5 mm deep in 'plate'" in question


@pytest.mark.parametrize("budget_us", [None, 500.0])
def test_the_depth_that_a_tool_starts_at_is_that_of_the_run(budget_us):
    # A hammer through the wall of a cup: the least way out of one of the pieces that
    # overlap is 20 mm long, but it is no way out of the cup.
    meshes = "package://drake_haptics/models/meshes"
    scene = Scene(
        tool=Tool(mesh=f"{meshes}/hammer.obj"),
        environment=[EnvironmentObject(name="cup", mesh=f"{meshes}/cup.obj")],
    )
    scene.hand.path.waypoints = [Waypoint(0.0, [0.01, 0.01, 0.01])]
    scene.device.tick_budget_us = budget_us
    haptic = BuildHapticDiagram(scene)
    (question,) = [q for q in check_plausibility(haptic) if "the tool starts" in q]
    port = haptic.loop.found_contacts
    root = haptic.diagram.CreateDefaultContext()
    X_WT = haptic.loop.haptic_tool.GetOutputPort("X_WT").Eval(
        haptic.loop.haptic_tool.GetMyContextFromRoot(root)
    )
    np.testing.assert_allclose(X_WT, [1, 0, 0, 0, 0.01, 0.01, 0.01], atol=1e-12)
    contacts = port.Eval(port.get_system().GetMyContextFromRoot(root))
    assert f"starts {length(-contacts.least_distance)} deep in 'cup'" in question


def test_a_tool_inside_a_solid_whose_surface_is_far_is_asked_for(tmp_path):
    scene = over_a_plate(tmp_path, PRESS)
    # A hull is felt all over; the pieces of a bowl's surface are not.
    bowl = trimesh.creation.annulus(0.2, 0.6, 0.8)
    scene.environment = [
        EnvironmentObject(
            "bowl", write(tmp_path, "bowl", bowl), pose=Pose([0.4, 0.0, 0.03])
        )
    ]
    assert any("the tool starts" in q and "'bowl'" in q for q in ask(scene))


class Still(DeviceBackend):
    """A device whose handle rests."""

    is_placed = True
    p_BH = (0.0, 0.0, 0.0)

    def read(self):
        """Tells that it rests."""
        X_BH = np.array([1.0, 0.0, 0.0, 0.0, *self.p_BH])
        return DeviceReading(0, 0.0, X_BH, np.zeros(6), np.zeros(6))

    def write(self, command):
        """Shows nothing."""

    def close(self):
        """Has nothing to close."""


def test_objects_beyond_the_workspace_of_a_device_are_asked_for(tmp_path):
    scene = over_a_plate(tmp_path, PRESS)
    device = Still()
    device.p_BH = load_device_preset(scene.device.preset).workspace_center_m
    assert ask(scene, device=device) == []
    far = replace(scene.environment[0], pose=Pose([0.0, 0.0, -1.0]))
    scene.environment = [far]
    (question,) = ask(scene, device=device)
    assert "the device's workspace" in question


def test_a_handle_outside_the_presets_workspace_is_asked_for(tmp_path):
    scene = over_a_plate(tmp_path, PRESS)
    other = Still()
    center = load_device_preset(scene.device.preset).workspace_center_m
    other.p_BH = (center[0] + 0.35, *center[1:])
    (question,) = ask(scene, device=other)
    assert "the handle is 350 mm from the middle" in question
    assert "radius is 120 mm" in question and "phantom_premium" in question


def test_more_force_than_the_device_is_rated_for_is_asked_for(tmp_path):
    scene = over_a_plate(tmp_path, PRESS)
    scene.device.max_force_N = 50.0
    (question,) = ask(scene)
    assert "device.max_force_N is 50: more than the 8.5 N" in question
    scene.device.max_force_N = 8.5
    assert ask(scene) == []


@pytest.mark.parametrize(
    ("height_m", "words"), [(0.005, "starts 5 mm deep in 'plate'"), (0.0085, "")]
)
def test_a_device_whose_handle_is_in_an_object_is_asked_for(tmp_path, height_m, words):
    # From half of the cube's height on it is in the plate; 2 mm are the tolerance.
    scene = over_a_plate(tmp_path, PRESS)
    device = Still()
    device.p_BH = load_device_preset(scene.device.preset).workspace_center_m
    X_BW = BuildHapticDiagram(scene, device=device).X_WB.inverse()
    device.p_BH = X_BW @ [0.0, 0.0, PLATE_TOP + height_m]
    questions = ask(scene, device=device)
    assert len(questions) == bool(words)
    for question in questions:
        assert words in question and "lead the device's handle" in question
