"""Plans a hand's exploration of objects with a tool, and builds its haptic loop."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from pydrake.math import RigidTransform
from pydrake.systems.framework import DiagramBuilder

from drake_haptics._core import SceneTracker
from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose
from drake_haptics.geometry.decomposition.decompose import Decomposition
from drake_haptics.geometry.mesh.mesh import make_tool_dynamics
from drake_haptics.loop.builder import AddHapticLoop, HapticDiagram
from drake_haptics.scene.schema import ContactParameters, CouplingParameters, Scene
from drake_haptics.systems.arm.hand_path import HandPath
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.device.haptic_device import HapticDevice
from drake_haptics.systems.device.replayed_handle import ReplayedHandle

# Speed of a hand that explores with a tool.
_SPEED_M_S = 0.10
_TURN_RAD_S = 1.0
_SHORTEST_S = 0.06
_SEARCH_STEP_M = 0.002
PERIOD_S = 1e-3
# Limits of the paper's device.
_MAX_FORCE_N, _MAX_TORQUE_NM = 8.5, 0.515


@dataclass(frozen=True)
class Place:
    """A place at which the tool approaches, and the hand's aim beyond first touch.

    Attributes:
        X_WT: Pose of the tool before the approach, free of contact.
        toward_W: (3,) unit direction of the approach.
        press_m: Distance beyond first touch at which the hand aims, m; negative to stay
            off.
    """

    X_WT: RigidTransform
    toward_W: np.ndarray
    press_m: float


def plan_exploration(
    tool: Decomposition,
    objects: Sequence[ContactObject],
    places: Sequence[Place],
    reach_m: float,
) -> HandPath:
    """Returns a path X_WT through one or more places, at a hand's speed.

    It stays below about 0.15 m/s and 1.5 rad/s. The tool may travel `reach_m` before it
    touches an object; objects are at rest.

    Raises:
        ValueError: The tool begins in contact at a place, or misses the objects.
    """
    search = SceneTracker(tool, [o.decomposition for o in objects], _SEARCH_STEP_M)
    for i, item in enumerate(objects):
        assert item.X_WO is not None
        search.set_object_pose(i, item.X_WO)
    poses = [_press(search, place, reach_m) for place in places]
    times = [0.0]
    for a, b in pairwise(poses):
        move_m = float(np.linalg.norm(b.translation() - a.translation()))
        turn_rad = abs((a.rotation().inverse() @ b.rotation()).ToAngleAxis().angle())
        step_s = max(_SHORTEST_S, move_m / _SPEED_M_S, turn_rad / _TURN_RAD_S)
        times.append(times[-1] + step_s)
    return HandPath(times, poses)


def _press(search: SceneTracker, place: Place, reach_m: float) -> RigidTransform:
    """Returns the pose at which the hand aims."""
    R_WT, start_W = place.X_WT.rotation(), place.X_WT.translation()
    along_m = 0.0
    while along_m < reach_m:
        X_WT = RigidTransform(R_WT, start_W + along_m * place.toward_W)
        nearest_m = search.query(X_WT).least_distance
        if np.isfinite(nearest_m):
            if along_m == 0.0 and nearest_m < 0.0:
                raise ValueError(f"the tool begins in contact at {start_W}")
            aim_m = along_m + nearest_m + place.press_m
            return RigidTransform(R_WT, start_W + aim_m * place.toward_W)
        along_m += _SEARCH_STEP_M / 2
    raise ValueError(f"the tool passes by from {start_W} along {place.toward_W}")


@dataclass(frozen=True)
class Scenario:
    """A tool, the objects that it meets, and the path of the hand.

    Attributes:
        figure: Corresponding chart of the paper, such as "11-(a)"; empty if there is
            none.
        p_TH: (3,) position of the handle in the tool's frame, m.
        path: Path of the poses at which the hand aims the tool.
    """

    name: str
    figure: str
    tool: Decomposition
    mass_kg: float
    p_TH: np.ndarray
    objects: tuple[ContactObject, ...]
    path: HandPath
    contact: ContactParameters


def build_loop(scenario: Scenario, seconds: float) -> HapticDiagram:
    """Builds the loop of a scenario with a handle that follows its path.

    The handle does not yield, as in a firm hand, but the coupling does.
    """
    X_TH = RigidTransform(scenario.p_TH)
    X_WH, V_WH = sample_handle(scenario.path, X_TH, seconds)
    device = HapticDevice(
        ReplayedHandle(X_WH, V_WH, PERIOD_S),
        period_s=PERIOD_S,
        max_force_N=_MAX_FORCE_N,
        max_torque_Nm=_MAX_TORQUE_NM,
    )
    builder = DiagramBuilder()
    loop = AddHapticLoop(
        builder,
        device=device,
        tool=scenario.tool.core,
        tool_dynamics=make_tool_dynamics(scenario.tool.mesh, scenario.mass_kg),
        objects=scenario.objects,
        contact=scenario.contact,
        coupling=CouplingParameters(),
        X_HT=X_TH.inverse(),
        X_WT=scenario.path.start,
        period_s=PERIOD_S,
        in_one_call=False,  # query and force are timed separately
    )
    return HapticDiagram(
        diagram=builder.Build(),
        scene=Scene(description=scenario.name, contact=scenario.contact),
        period_s=PERIOD_S,
        loop=loop,
        tool=scenario.tool,
        environment=(),
        visualizer=None,
    )


def sample_handle(
    path: HandPath, X_TH: RigidTransform, seconds: float
) -> tuple[np.ndarray, np.ndarray]:
    """Returns the handle's motion along a path.

    Returns:
        Poses X_WH (n, 7) and velocities V_WH (n, 6), tick by tick.
    """
    ticks = round(seconds / PERIOD_S) + 1
    X_WH, V_WH = np.empty((ticks, 7)), np.empty((ticks, 6))
    for k in range(ticks):
        q_WT, V_WT = path.calc(k * PERIOD_S)
        X_WT = vector_to_pose(q_WT)
        p_TH_W = X_WT.rotation() @ X_TH.translation()
        X_WH[k] = pose_to_vector(X_WT @ X_TH)
        V_WH[k, :3] = V_WT[:3]
        V_WH[k, 3:] = V_WT[3:] + np.cross(V_WT[:3], p_TH_W)
    return X_WH, V_WH
