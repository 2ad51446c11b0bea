"""The camera sees what happens, and pages open or say why not."""

import logging
import socket
from dataclasses import replace

import numpy as np
import pytest
import trimesh

from drake_haptics.cli.endings import failures_in_words
from drake_haptics.common.errors import HapticsError
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.library import list_scenes
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import Pose
from drake_haptics.visualization.meshcat import (
    CAMERAS,
    aim_camera,
    clip_facet,
    configure_camera,
    find_framed_points,
    start_meshcat,
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
    configure_camera(camera, haptic)
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
    configure_camera(near, BuildHapticDiagram(scene))
    scene.environment[0].scale = 50.0
    scene.environment[0].pose.position_m = [0.0, 0.0, -0.040 * 49]
    far = CameraKeeper()
    configure_camera(far, BuildHapticDiagram(scene))
    distance = [np.linalg.norm(c.p_WCamera - c.p_WTarget) for c in (near, far)]
    assert distance[1] < 3 * distance[0]


def test_a_table_of_two_facets_is_in_the_middle_of_its_picture(tmp_path):
    """None of its corners is near the tool."""
    table = tmp_path / "table.obj"
    box = trimesh.creation.box((0.6, 0.4, 0.02))
    table.write_text(trimesh.exchange.obj.export_obj(box, include_normals=False))
    scene = load_scene(list_scenes()["sphere_pen"])
    scene.environment[0].mesh, scene.environment[0].scale = str(table), 1.0
    scene.environment[0].pose.position_m = [0.1, 0.05, 0.03]
    framed = find_framed_points(BuildHapticDiagram(scene))
    tool = find_framed_points(
        BuildHapticDiagram(replace(scene, environment=[distant(scene)]))
    )
    # As much of the table as is framed at one side is so at the other.
    before, after = tool.min(axis=0) - framed.min(axis=0), framed.max(0) - tool.max(0)
    np.testing.assert_allclose(before[:2], after[:2], rtol=1e-9)
    assert (before[:2] > 0.01).all()


def distant(scene):
    """The scene's object out of the picture."""
    return replace(scene.environment[0], pose=Pose([5.0, 0.0, 0.0]))


@pytest.mark.parametrize("seed", range(5))
def test_a_facet_is_clipped_to_what_is_in_the_box(seed):
    """Against points of the facet: all in the box are in the hull of what is left."""
    rng = np.random.default_rng(seed)
    facet = rng.normal(size=(3, 3))
    low, high = np.full(3, -0.4), np.full(3, 0.5)
    left = clip_facet(facet, low, high)
    assert ((left > low - 1e-12) & (left < high + 1e-12)).all()
    shares = rng.dirichlet(np.ones(3), size=4000)
    points = shares @ facet
    points = points[((points > low) & (points < high)).all(axis=1)]
    assert (len(left) > 2 and len(points) > 10) or not len(points)
    for way in rng.normal(size=(20, 3)) if len(points) else ():
        assert (points @ way).max() <= (left @ way).max() + 1e-12
        # And no more than that is left.
        assert (left @ way).max() <= (points @ way).max() + 0.2


def test_a_page_leaves_drakes_log_as_it_is(caplog):
    logger = logging.getLogger("drake")
    before = logger.level, list(logger.filters)
    start_meshcat()
    assert (logger.level, logger.filters) == before


def test_on_the_terminal_drakes_warning_of_two_pages_is_not_shown(capsys):
    with failures_in_words(debug=False):
        start_meshcat()
        logger = logging.getLogger("drake")
        logger.warning(
            "More than one meshcat client is attempting to broadcast its camera pose."
            " The"
        )
        logger.warning("something else")
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err == "Warning: something else\n"


def test_a_taken_port_is_a_users_error():
    with socket.socket() as taken:
        taken.bind(("localhost", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with pytest.raises(HapticsError, match=str(port)):
            start_meshcat(port)
