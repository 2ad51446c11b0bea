"""The stage on which Meshcat shows a scene: page, background, camera."""

from __future__ import annotations

import logging
import socket

import numpy as np
from pydrake.geometry import Meshcat, MeshcatParams
from pydrake.math import RigidTransform

from drake_haptics.builder import HapticDiagram
from drake_haptics.colors import BACKGROUND_BOTTOM, BACKGROUND_TOP
from drake_haptics.errors import UserError
from drake_haptics.scene import Pose

# From where the camera looks: from the right front, above.
_VIEW = np.array([0.48, -0.74, 0.47])
# More than half the angle of Meshcat's camera, since objects do not fill the sphere
# around them.
_HALF_VIEW_RAD = np.deg2rad(46.0)


def open_meshcat(port: int | None = None) -> Meshcat:
    """Opens a page without Drake's messages on the terminal.

    Args:
        port: TCP port of the page; None takes the first free one from 7000 on.

    Raises:
        UserError: The port cannot be had.
    """
    logging.getLogger("drake").setLevel(logging.WARNING)
    # Drake gives no reason where it fails, so ask the system first.
    if port is not None:
        with socket.socket() as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                probe.bind(("localhost", port))
            except (OSError, OverflowError) as error:
                raise UserError(f"port {port} cannot be used: {error}") from error
    try:
        return Meshcat(MeshcatParams(host="localhost", port=port))
    except RuntimeError as error:
        raise UserError(f"Meshcat cannot open a page: {error}") from error


def set_stage(meshcat: Meshcat, haptic: HapticDiagram) -> None:
    """Points the camera at where tool and objects meet, on a plain background.

    Of large surroundings only what is within a tool's size of the hand's path is
    framed.
    """
    meshcat.SetProperty("/Background", "top_color", list(BACKGROUND_TOP[:3]))
    meshcat.SetProperty("/Background", "bottom_color", list(BACKGROUND_BOTTOM[:3]))
    meshcat.SetProperty("/Grid", "visible", False)
    meshcat.SetProperty("/Axes", "visible", False)
    low, high = _framed_box(haptic)
    middle = (low + high) / 2
    radius = float(np.linalg.norm(high - low)) / 2
    distance = radius / np.sin(_HALF_VIEW_RAD)
    meshcat.SetCameraPose(middle + distance * _VIEW / np.linalg.norm(_VIEW), middle)


def _framed_box(haptic: HapticDiagram) -> tuple[np.ndarray, np.ndarray]:
    """Returns the corners, m, of a box around what happens."""
    waypoints = haptic.scene.hand.path.waypoints
    vertices = haptic.tool.mesh.vertices
    start = _transform(Pose(waypoints[0].position_m, waypoints[0].rpy_deg), vertices)
    path = np.array([waypoint.position_m for waypoint in waypoints])
    points = np.vstack([start, path])
    low, high = points.min(axis=0), points.max(axis=0)
    margin = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    for item, decomposition in zip(
        haptic.scene.environment, haptic.environment, strict=True
    ):
        corners = _transform(item.pose, decomposition.mesh.vertices)
        within = np.all((corners > low - margin) & (corners < high + margin), axis=1)
        points = np.vstack([points, corners[within]])
    return points.min(axis=0), points.max(axis=0)


def _transform(pose: Pose, points: np.ndarray) -> np.ndarray:
    """Returns points (n, 3) of a frame in the frame that its pose is given in."""
    X: RigidTransform = pose.to_rigid_transform()
    return points @ X.rotation().matrix().T + X.translation()
