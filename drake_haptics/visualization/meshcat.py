"""Opens Meshcat, aims its camera, and writes recordings."""

from __future__ import annotations

import html
import json
import socket
from importlib.resources import files
from pathlib import Path

import numpy as np
from pydrake.geometry import Meshcat, MeshcatParams
from pydrake.math import RigidTransform

from drake_haptics.common.colors import (
    BACKGROUND_BOTTOM,
    BACKGROUND_TOP,
    FORCE_INK,
    TORQUE_INK,
    make_legend,
    write_css,
)
from drake_haptics.common.errors import HapticsError
from drake_haptics.common.web_page import extend_page
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.scene.schema import Pose

# Directions from which the camera looks, by view. Exactly vertical ones would leave the
# up direction undefined.
_VIEWS = {
    "fit": (0.48, -0.74, 0.47),
    "front": (0.0, -1.0, 0.0),
    "side": (1.0, 0.0, 0.0),
    "top": (0.0, -1e-3, 1.0),
}
CAMERAS = tuple(_VIEWS)
# Half the angle of Meshcat's camera is 37.5 degrees; the rest is margin.
_HALF_VIEW_RAD = np.deg2rad(35.0)
_PLAYER = "recording_player.html"
# Mark in the player that is replaced by its numbers.
_TRACES = "/* the traces */"


def start_meshcat(port: int | None = None) -> Meshcat:
    """Starts a Meshcat on this computer.

    Args:
        port: TCP port of the page; None takes the first free one from 7000 on.

    Raises:
        HapticsError: The port is not available.
    """
    # Drake's error has no reason, so ask the system first.
    if port is not None:
        with socket.socket() as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                probe.bind(("localhost", port))
            except (OSError, OverflowError) as error:
                raise HapticsError(f"port {port} cannot be used: {error}") from error
    try:
        # The run's page shows the real-time rate.
        return Meshcat(
            MeshcatParams(host="localhost", port=port, show_stats_plot=False)
        )
    except RuntimeError as error:
        raise HapticsError(f"Meshcat cannot open a page: {error}") from error


def configure_camera(meshcat: Meshcat, haptic: HapticDiagram) -> None:
    """Aims the camera at where tool and objects meet, and sets a plain background."""
    meshcat.SetProperty("/Background", "top_color", list(BACKGROUND_TOP[:3]))
    meshcat.SetProperty("/Background", "bottom_color", list(BACKGROUND_BOTTOM[:3]))
    meshcat.SetProperty("/Grid", "visible", False)
    meshcat.SetProperty("/Axes", "visible", False)
    aim_camera(meshcat, find_framed_points(haptic), "fit")


def aim_camera(
    meshcat: Meshcat, p_WP: np.ndarray, view: str, within: float = 1.0
) -> None:
    """Aims the camera at where tool and objects meet.

    Args:
        meshcat: Meshcat whose camera is aimed.
        p_WP: (n, 3) points to show, m, such as those of `find_framed_points`.
        view: One of `CAMERAS`.
        within: Share of the picture's height, about its middle, that must contain them.

    Raises:
        ValueError: There is no such view, or the share is not from 0.1 to 1.
    """
    if view not in _VIEWS:
        raise ValueError(f"view must be one of {', '.join(CAMERAS)}, is {view!r}")
    if not 0.1 <= within <= 1.0:
        raise ValueError(f"within must be from 0.1 to 1, is {within}")
    backwards = np.array(_VIEWS[view]) / np.linalg.norm(_VIEWS[view])
    right = np.cross([0.0, 0.0, 1.0], backwards)
    right /= np.linalg.norm(right)
    R_CW = np.vstack([right, np.cross(backwards, right), backwards])
    p_CP = p_WP @ R_CW.T
    middle = (p_CP.min(axis=0) + p_CP.max(axis=0)) / 2
    # The least distance at which the view cone contains every point.
    across = np.linalg.norm(p_CP[:, :2] - middle[:2], axis=1)
    slope = within * np.tan(_HALF_VIEW_RAD)
    distance = float(np.max(p_CP[:, 2] - middle[2] + across / slope))
    target = R_CW.T @ middle
    meshcat.SetCameraPose(target + distance * backwards, target)


def find_framed_points(haptic: HapticDiagram) -> np.ndarray:
    """Returns points (n, 3) of the world, m, that must be in the picture.

    Of large objects only the part within a tool's size of the hand's path is included.
    """
    vertices = haptic.tool.mesh.vertices
    tool = np.vstack(
        [
            _transform(Pose(waypoint.position_m, waypoint.rpy_deg), vertices)
            for waypoint in haptic.scene.hand.path.waypoints
        ]
    )
    size = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    low, high = tool.min(axis=0) - size, tool.max(axis=0) + size
    framed = [tool]
    for item, decomposition in zip(
        haptic.scene.environment, haptic.environment, strict=True
    ):
        mesh = decomposition.mesh
        corners = _transform(item.pose, mesh.vertices)
        framed.append(corners[np.all((corners > low) & (corners < high), axis=1)])
        # A large facet may have no corner in the framed part.
        facets = corners[mesh.triangles]
        is_large = np.ptp(facets, axis=1).max(axis=1) > size
        is_near = np.all((facets.max(1) > low) & (facets.min(1) < high), axis=1)
        framed += [clip_facet(facet, low, high) for facet in facets[is_large & is_near]]
    return np.vstack(framed)


def clip_facet(p_WF: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Returns the corners (n, 3) of a flat convex facet's part in a box.

    It uses Sutherland and Hodgman's algorithm, which clips by each plane of the box in
    turn.

    Args:
        p_WF: (k, 3) corners of the facet in order, m.
        low: (3,) least coordinates of the box, m.
        high: (3,) largest coordinates, m.
    """
    for axis, bound, sign in [
        *((axis, low[axis], 1.0) for axis in range(3)),
        *((axis, high[axis], -1.0) for axis in range(3)),
    ]:
        inside = sign * (p_WF[:, axis] - bound)
        beyond, p_WNext = np.roll(inside, -1), np.roll(p_WF, -1, axis=0)
        crosses = (inside >= 0.0) != (beyond >= 0.0)
        share = np.divide(
            inside, inside - beyond, out=np.zeros_like(inside), where=crosses
        )
        p_WCut = p_WF + share[:, np.newaxis] * (p_WNext - p_WF)
        kept = np.stack([inside >= 0.0, crosses], axis=1)
        p_WF = np.stack([p_WF, p_WCut], axis=1)[kept]
    return p_WF


def _transform(pose: Pose, points: np.ndarray) -> np.ndarray:
    """Returns points (n, 3) of a frame in the frame of its pose."""
    X: RigidTransform = pose.to_rigid_transform()
    return points @ X.rotation().matrix().T + X.translation()


def write_recording(
    meshcat: Meshcat,
    path: Path,
    title: str,
    felt: np.ndarray,
    *,
    max_force_N: float,
    max_torque_Nm: float,
    has_friction: bool = False,
) -> None:
    """Writes the page as one self-contained HTML file.

    Below the scene are plots of force and torque over time, and playback controls.

    Args:
        meshcat: Meshcat whose recording has been published.
        path: The file to write.
        title: Heading of the legend.
        felt: (n, 3) times, forces and torques of `HapticVisualizer.recorded_sizes`.
        max_force_N: The device's largest force, N.
        max_torque_Nm: The device's largest torque, N·m.
        has_friction: Whether friction is drawn.

    Raises:
        OSError: The file cannot be written.
    """
    rows = "".join(
        f'<div><span style="display:inline-block;width:0.8em;height:0.8em;'
        f"margin-right:0.6em;border-radius:50%;background:{row['color']}"
        f'"></span>{html.escape(row["label"])}</div>'
        for row in make_legend(has_friction)
    )
    legend = (
        '<div id="legend" style="position:fixed;left:1.2em;top:1.2em;'
        "max-width:19em;padding:0.7em 1em;font:12px/1.55 sans-serif;color:#333;"
        'background:rgba(255,255,255,0.75);border-radius:0.5em">'
        f"<b>{html.escape(title)}</b>{rows}"
        "<div>small arrows: contacts; large ones: forces of clusters</div></div>"
    )
    time_s, force_N, torque_Nm = felt.T
    traces = {
        "time_s": time_s.round(6).tolist(),
        "force": force_N.round(4).tolist(),
        "torque": (1e3 * torque_Nm).round(2).tolist(),
        "of": {
            "force": {"color": write_css(FORCE_INK), "limit": max_force_N},
            "torque": {"color": write_css(TORQUE_INK), "limit": 1e3 * max_torque_Nm},
        },
    }
    player = (
        files("drake_haptics.visualization")
        .joinpath(_PLAYER)
        .read_text(encoding="utf-8")
    )
    player = player.replace(_TRACES, json.dumps(traces), 1)
    page = extend_page(meshcat.StaticHtml(), legend + player)
    path.write_text(page, encoding="utf-8")
