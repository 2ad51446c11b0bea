"""The camera sees what happens, and pages open or say why not."""

import logging
import socket

import numpy as np
import pytest

from drake_haptics.builder import BuildHapticDiagram
from drake_haptics.errors import UserError
from drake_haptics.scene import Pose, load_scene
from drake_haptics.scene_library import list_scenes
from drake_haptics.stage import (
    CAMERAS,
    aim_camera,
    find_framed_points,
    open_meshcat,
    set_stage,
)

# Half of the vertical angle of Meshcat's camera.
HALF_VIEW_DEG = 37.5


class CameraKeeper:
    """Takes the place of Meshcat and keeps the camera's pose."""

    def SetProperty(self, path, name, value):
        """Nothing of this is checked here."""

    def SetCameraPose(self, camera_in_world, target_in_world):
        """Keeps it."""
        self.p_WCamera = np.array(camera_in_world)
        self.p_WTarget = np.array(target_in_world)

    def angles_deg(self, points):
        """Angles of points (n, 3) off the middle of the picture, degrees."""
        axis = self.p_WTarget - self.p_WCamera
        rays = points - self.p_WCamera
        cosine = rays @ axis / np.linalg.norm(rays, axis=1) / np.linalg.norm(axis)
        return np.rad2deg(np.arccos(np.clip(cosine, -1, 1)))


@pytest.mark.parametrize("name", list_scenes())
def test_the_whole_scene_is_in_the_picture(name):
    haptic = BuildHapticDiagram(load_scene(list_scenes()[name]))
    camera = CameraKeeper()
    set_stage(camera, haptic)
    points = [haptic.environment[0].mesh.vertices]
    for waypoint in haptic.scene.hand.path.waypoints:
        X_WT = Pose(waypoint.position_m, waypoint.rpy_deg).to_rigid_transform()
        points.append(X_WT.multiply(haptic.tool.mesh.vertices.T).T)
    # In the picture, and not lost in it.
    assert HALF_VIEW_DEG / 2 < camera.angles_deg(np.vstack(points)).max()
    assert camera.angles_deg(np.vstack(points)).max() < HALF_VIEW_DEG


@pytest.mark.parametrize("view", CAMERAS)
def test_every_view_holds_the_scene_in_what_is_free(view):
    haptic = BuildHapticDiagram(load_scene(list_scenes()["cup_spoon"]))
    points = [haptic.environment[0].mesh.vertices]
    for waypoint in haptic.scene.hand.path.waypoints:
        X_WT = Pose(waypoint.position_m, waypoint.rpy_deg).to_rigid_transform()
        points.append(X_WT.multiply(haptic.tool.mesh.vertices.T).T)
    camera, framed = CameraKeeper(), find_framed_points(haptic)
    for within in (1.0, 0.5):
        aim_camera(camera, framed, view, within)
        share = np.tan(np.deg2rad(camera.angles_deg(np.vstack(points)).max()))
        assert 0.6 * within < share / np.tan(np.deg2rad(HALF_VIEW_DEG)) < within


def test_views_look_from_where_they_are_named_for():
    haptic = BuildHapticDiagram(load_scene(list_scenes()["sphere_pen"]))
    camera = CameraKeeper()
    for view, way in [("front", (0, -1, 0)), ("side", (1, 0, 0)), ("top", (0, 0, 1))]:
        aim_camera(camera, find_framed_points(haptic), view)
        from_target = camera.p_WCamera - camera.p_WTarget
        np.testing.assert_allclose(
            from_target / np.linalg.norm(from_target), way, atol=2e-3
        )


def test_bad_views_are_refused():
    points = np.eye(3)
    with pytest.raises(ValueError, match=r"view must be one of fit.*'back'"):
        aim_camera(CameraKeeper(), points, "back")
    with pytest.raises(ValueError, match=r"within must be from 0.1 to 1, is nan"):
        aim_camera(CameraKeeper(), points, "fit", float("nan"))


def test_of_large_surroundings_only_what_is_near_is_framed():
    scene = load_scene(list_scenes()["sphere_pen"])
    near = CameraKeeper()
    set_stage(near, BuildHapticDiagram(scene))
    scene.environment[0].scale = 50.0
    scene.environment[0].pose.position_m = [0.0, 0.0, -0.040 * 49]
    far = CameraKeeper()
    set_stage(far, BuildHapticDiagram(scene))
    distance = [np.linalg.norm(c.p_WCamera - c.p_WTarget) for c in (near, far)]
    assert distance[1] < 3 * distance[0]


def test_the_terminal_stays_quiet(capfd):
    open_meshcat()
    assert capfd.readouterr().err == ""
    assert logging.getLogger("drake").level == logging.WARNING


def test_a_taken_port_is_a_users_error():
    with socket.socket() as taken:
        taken.bind(("localhost", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with pytest.raises(UserError, match=str(port)):
            open_meshcat(port)
