"""Makes a scene for two meshes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from drake_haptics.common.errors import SceneError
from drake_haptics.common.files import resolve_package_url
from drake_haptics.geometry.mesh.mesh import Mesh, load_mesh
from drake_haptics.geometry.mesh.placement import TouchMap, center, find_origin_beside
from drake_haptics.geometry.mesh.report import length
from drake_haptics.geometry.mesh.units import METERS_PER_UNIT, guess_unit
from drake_haptics.scene.schema import (
    ContactParameters,
    EnvironmentObject,
    HandParameters,
    HandPathParameters,
    Pose,
    Scene,
    Tool,
    Waypoint,
)
from drake_haptics.systems.arm.hand_impedance import NOMINAL_GRIP

_PRESS_N = 2.0
_LARGEST_TOOL_M = 1.0
# In larger environments coordinates are too coarse for contacts of micrometers.
_LARGEST_ENVIRONMENT_M = 1e3
_SMALLEST_EXTENT_M = 2e-3
# The path stays well inside a workspace of 12 cm radius.
_CLEARANCE_M = 0.03
_LARGEST_CIRCLE_M = 0.025
_SMALLEST_CIRCLE_M = 1e-3
_LARGEST_RISE_M = 0.03
_CIRCLE_POINTS = 16
_APPROACH_S = 1.5
_CIRCLE_STEP_S = 0.4
# Digits of positions and times in a scene: a nanometer, a microsecond.
_DECIMALS_M = 9
_DECIMALS_S = 6


def make_scene_for_meshes(
    tool_path: str | Path,
    environment_path: str | Path,
    *,
    tool_scale: float = 1.0,
    environment_scale: float = 1.0,
) -> Scene:
    """Makes a scene of two meshes.

    The environment's frame is the world's. The tool starts above its middle, comes
    down, touches, and scrapes in a circle forever, pressed by the hand's spring with a
    few newtons. A tool whose mesh is far from its origin is centered (`tool.center`).

    Args:
        tool_path: Mesh of the tool.
        environment_path: Mesh of the environment.
        tool_scale: Meters per unit of the tool's file.
        environment_scale: Meters per unit of the environment's file.

    Raises:
        SceneError: The tool does not fit into the device's workspace.
        drake_haptics.common.errors.MeshError: A mesh cannot be used.
    """
    tool_path = Path(resolve_package_url(tool_path))
    environment_path = Path(resolve_package_url(environment_path))
    tool = load_mesh(tool_path, scale=tool_scale)
    environment = load_mesh(environment_path, scale=environment_scale)
    _check_extent("tool", tool_path, tool, tool_scale, _LARGEST_TOOL_M)
    _check_extent(
        "environment",
        environment_path,
        environment,
        environment_scale,
        _LARGEST_ENVIRONMENT_M,
    )
    is_far = find_origin_beside(tool) is not None
    if is_far:
        tool = center(tool)
    tip = _find_tip(tool)
    # The handle is above the tip, at half the tool's height, so that pressing down
    # hardly turns it.
    grip_point = tip.copy()
    grip_point[2] = (tool.vertices[:, 2].min() + tool.vertices[:, 2].max()) / 2.0
    tolerance = min(
        ContactParameters().tolerance_m,
        *(0.02 * float(np.linalg.norm(m.report.extent)) for m in (tool, environment)),
    )
    return Scene(
        description=f"{tool_path.name} scrapes {environment_path.name}",
        tool=Tool(
            mesh=str(tool_path.resolve()),
            scale=tool_scale,
            center=is_far,
            grasp=Pose(position_m=_round_position(-grip_point)),
        ),
        environment=[
            EnvironmentObject(
                name="environment",
                mesh=str(environment_path.resolve()),
                scale=environment_scale,
            )
        ],
        contact=ContactParameters(tolerance_m=float(f"{tolerance:.2g}")),
        hand=HandParameters(grip="nominal", path=_make_path(tool, environment, tip)),
    )


def _check_extent(
    name: str, path: Path, mesh: Mesh, scale: float, largest_m: float
) -> None:
    """Refuses a size that cannot be felt, most often because of a wrong unit."""
    extent = max(mesh.report.extent)
    if _SMALLEST_EXTENT_M <= extent <= largest_m:
        return
    unit = guess_unit(extent / scale, _SMALLEST_EXTENT_M, _LARGEST_TOOL_M)
    hint = (
        f". {name}_scale={0.1 * scale / extent:.2g} makes it 100 mm long"
        if unit is None
        else f". If {path.name} is in {unit}: {name}_scale={METERS_PER_UNIT[unit]:g}"
    )
    raise SceneError(
        f"the {name} {path.name} is {length(extent)} long, and must be between"
        f" {length(_SMALLEST_EXTENT_M)} and {length(largest_m)}{hint}"
    )


def _find_tip(tool: Mesh) -> np.ndarray:
    """Returns the middle of the tool's lowest end, in its frame, m."""
    z = tool.vertices[:, 2]
    low = z <= z.min() + 0.01 * np.ptp(z)
    return tool.vertices[low].mean(axis=0)


def _find_place(environment: Mesh) -> np.ndarray:
    """Returns x and y of the upward-facing place nearest to the middle, m."""
    a, b, c = np.swapaxes(environment.vertices[environment.triangles], 0, 1)
    normal = np.cross(b - a, c - a)
    up = normal[:, 2] > 0.5 * np.linalg.norm(normal, axis=1)
    if not up.any():
        up[:] = True
    centroid = ((a + b + c) / 3.0)[up]
    middle = (environment.vertices.min(axis=0) + environment.vertices.max(axis=0)) / 2.0
    distance = np.linalg.norm((centroid - middle)[:, :2], axis=1)
    return centroid[distance.argmin(), :2]


def _make_path(tool: Mesh, environment: Mesh, tip: np.ndarray) -> HandPathParameters:
    """Returns a path that comes down, scrapes in a circle, and goes up again."""
    place = _find_place(environment) - tip[:2]
    radius = min(_LARGEST_CIRCLE_M, 0.2 * min(environment.report.extent[:2]))
    angles = np.linspace(0.0, 2.0 * np.pi, _CIRCLE_POINTS + 1)
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    touch_map = TouchMap(tool, environment, place, radius)
    while True:
        touch = np.array([touch_map.calc_height(radius * p) for p in circle])
        seen = np.isfinite(touch)
        if not seen.any():
            raise SceneError("the tool, lowered onto the environment, misses it")
        # With nothing below, the hand continues at the height of the rest.
        touch[~seen] = touch[seen].mean()
        if np.ptp(touch) <= _LARGEST_RISE_M:
            break
        # At the edge of a cliff no circle is small enough, so press in place.
        radius = 0.5 * radius if radius > _SMALLEST_CIRCLE_M else 0.0
    xy = place + radius * circle
    press = _PRESS_N / NOMINAL_GRIP.stiffness_N_per_m
    above = [*xy[0], touch[0] + _CLEARANCE_M]
    times = _APPROACH_S + _CIRCLE_STEP_S * np.arange(len(xy))
    around = [
        Waypoint(round(float(t), _DECIMALS_S), _round_position([*p, z - press]))
        for t, p, z in zip(times, xy, touch, strict=True)
    ]
    end = round(float(times[-1]) + _APPROACH_S, _DECIMALS_S)
    start = _round_position(above)
    return HandPathParameters(
        periodic=True, waypoints=[Waypoint(0.0, start), *around, Waypoint(end, start)]
    )


def _round_position(position: ArrayLike) -> list[float]:
    """Returns a position (3,), m, rounded."""
    # Adding 0 turns -0.0 into 0.0.
    return (np.asarray(position).round(_DECIMALS_M) + 0.0).tolist()
